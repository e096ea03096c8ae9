//! `rubscope --version` says of which commit the program is, where that is known.

#[path = "../../build.rs"]
#[expect(dead_code, reason = "its main is for cargo")]
mod build;

use std::fs;
use std::path::Path;
use std::process::Command;

use crate::cli_support::rubscope;

const HASH: &str = "0123456789abcdef0123456789abcdef01234567";

fn git(folder: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git")
        .current_dir(folder)
        .args(["-c", "user.name=A", "-c", "user.email=a@b", "-c", "commit.gpgsign=false"])
        .args(["-c", "core.hooksPath=/dev/null"])
        .args(arguments)
        .env("GIT_COMMITTER_DATE", "2026-02-03T12:00:00+0000")
        .env_remove("GIT_DIR")
        .env_remove("GIT_WORK_TREE")
        .env_remove("GIT_INDEX_FILE")
        .output()
        .ok()?;
    assert!(output.status.success(), "git {arguments:?}: {output:?}");
    Some(String::from_utf8(output.stdout).unwrap().trim().to_string())
}

#[test]
fn a_package_is_of_the_commit_that_its_file_names() {
    let folder = tempfile::tempdir().unwrap();
    for (info, told) in [
        (format!("{{\"git\": {{\n\"sha1\": \"{HASH}\"}}}}"), Some("012345678")),
        (
            format!("{{\"git\": {{\"sha1\": \"{HASH}\", \"dirty\": true}}}}"),
            Some("012345678-modified"),
        ),
        ("{\"git\": {\"sha1\": \"a\"}}".to_string(), None),
        ("{\"git\": {\"sha1\": \"no hexadecimal\"}}".to_string(), None),
        ("{}".to_string(), None),
        (String::new(), None),
    ] {
        fs::write(folder.path().join(".cargo_vcs_info.json"), &info).unwrap();
        assert_eq!(build::commit(folder.path()).as_deref(), told, "{info}");
    }
}

#[test]
fn a_checkout_is_of_its_commit_and_says_if_the_sources_were_changed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    assert_eq!(build::commit(path), None);
    for (name, text) in [("src/lib.rs", "one"), ("notes.md", "one"), ("vendor/rubscope/a", "one")] {
        let file = path.join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, text).unwrap();
    }
    if git(path, &["init", "--quiet"]).is_none() {
        eprintln!("skipped: there is no git");
        return;
    }
    assert_eq!(build::commit(path), None, "there is no commit yet");
    git(path, &["add", "."]);
    git(path, &["commit", "--quiet", "--message", "one"]);
    let hash = git(path, &["rev-parse", "HEAD"]).unwrap();
    let clean = Some(format!("{} 2026-02-03", &hash[..9]));
    assert_eq!(build::commit(path), clean);
    // What the program is not made of does not change it.
    fs::write(path.join("notes.md"), "two").unwrap();
    assert_eq!(build::commit(path), clean);
    // A copy in the repository of something else is not of that commit.
    assert_eq!(build::commit(&path.join("vendor/rubscope")), None);
    fs::write(path.join("src/new.rs"), "two").unwrap();
    assert_eq!(build::commit(path), Some(format!("{}-modified 2026-02-03", &hash[..9])));
}

#[test]
fn the_program_prints_its_version_and_perhaps_its_commit() {
    let output = rubscope(&["--version"]);
    let printed = String::from_utf8(output.stdout).unwrap();
    assert_eq!(rubscope(&["-V"]).stdout, printed.as_bytes());
    let plain = concat!("rubscope ", env!("CARGO_PKG_VERSION"));
    let rest = printed.trim_end().strip_prefix(plain).unwrap();
    if !rest.is_empty() {
        let commit = rest.strip_prefix(" (").and_then(|rest| rest.strip_suffix(')')).unwrap();
        let hash = &commit[..9];
        assert!(hash.bytes().all(|byte| byte.is_ascii_hexdigit()), "{printed}");
        let (rest, date) = commit[9..].split_once(' ').unwrap_or((&commit[9..], ""));
        assert!(["", "-modified"].contains(&rest), "{printed}");
        assert!(date.is_empty() || date.len() == "2026-02-03".len(), "{printed}");
    }
    // The manual is of a version, whatever the commit.
    let page = String::from_utf8(rubscope(&["man"]).stdout).unwrap();
    assert!(rest.is_empty() || !page.contains(rest), "{page}");
}
