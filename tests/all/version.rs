//! Of which commit and of which version the program is, in every place that says it.

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
        (format!("{{\"git\": {{\n\"sha1\": \"{HASH}\"}}}}"), "012345678"),
        (
            format!("{{\"git\": {{\"sha1\": \"{HASH}\", \"dirty\": true}}}}"),
            "012345678-modified-cbf29ce48",
        ),
        ("{\"git\": {\"sha1\": \"a\"}}".to_string(), "source-cbf29ce48"),
        ("{\"git\": {\"sha1\": \"no hexadecimal\"}}".to_string(), "source-cbf29ce48"),
        ("{}".to_string(), "source-cbf29ce48"),
        (String::new(), "source-cbf29ce48"),
    ] {
        // The hash of no sources is the first value of FNV-1a.
        fs::write(folder.path().join(".cargo_vcs_info.json"), &info).unwrap();
        assert_eq!(build::commit(folder.path()), told, "{info}");
    }
}

#[test]
fn a_checkout_is_of_its_commit_and_says_if_the_sources_were_changed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path();
    let source = || build::commit(path).split_once("source-").map(|(_, hash)| hash.to_string());
    assert!(source().is_some());
    for (name, text) in [("src/lib.rs", "one"), ("notes.md", "one"), ("vendor/rubscope/a", "one")] {
        let file = path.join(name);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, text).unwrap();
    }
    // Outside a checkout a hash tells changed sources, and moved ones, from those before.
    let before = source().unwrap();
    fs::write(path.join("src/lib.rs"), "other").unwrap();
    let changed = source().unwrap();
    fs::rename(path.join("src/lib.rs"), path.join("src/main.rs")).unwrap();
    assert!(before != changed && source().unwrap() != changed);
    fs::remove_file(path.join("src/main.rs")).unwrap();
    fs::write(path.join("src/lib.rs"), "one").unwrap();
    fs::write(path.join("notes.md"), "two").unwrap();
    assert_eq!(source().unwrap(), before);
    if git(path, &["init", "--quiet"]).is_none() {
        eprintln!("skipped: there is no git");
        return;
    }
    assert_eq!(source().unwrap(), before, "there is no commit yet");
    git(path, &["add", "."]);
    git(path, &["commit", "--quiet", "--message", "one"]);
    let hash = git(path, &["rev-parse", "HEAD"]).unwrap();
    let clean = format!("{} 2026-02-03", &hash[..9]);
    assert_eq!(build::commit(path), clean);
    // What the program is not made of does not change it.
    fs::write(path.join("notes.md"), "three").unwrap();
    assert_eq!(build::commit(path), clean);
    // A copy in the repository of something else is not of that commit.
    assert_eq!(build::commit(&path.join("vendor/rubscope")), "source-cbf29ce48");
    // Two changes of one commit are two programs.
    let [two, three] = ["two", "three"].map(|text| {
        fs::write(path.join("src/new.rs"), text).unwrap();
        let commit = build::commit(path);
        let rest = commit.strip_prefix(&format!("{}-modified-", &hash[..9])).unwrap();
        assert!(rest.ends_with(" 2026-02-03"), "{commit}");
        rest.to_string()
    });
    assert_ne!(two, three);
}

#[test]
fn the_program_prints_its_version_and_its_commit() {
    let output = rubscope(&["--version"]);
    let printed = String::from_utf8(output.stdout).unwrap();
    assert_eq!(rubscope(&["-V"]).stdout, printed.as_bytes());
    let plain = concat!("rubscope ", env!("CARGO_PKG_VERSION"));
    let rest = printed.trim_end().strip_prefix(plain).unwrap();
    let commit = rest.strip_prefix(" (").and_then(|rest| rest.strip_suffix(')')).unwrap();
    let (commit, date) = commit.split_once(' ').unwrap_or((commit, ""));
    assert_eq!(commit, env!("RUBSCOPE_COMMIT"));
    let parts: Vec<&str> = commit.split('-').collect();
    let is_hash = |part: &&str| part.len() == 9 && part.bytes().all(|b| b.is_ascii_hexdigit());
    let known = match parts[..] {
        [hash] | ["source", hash] => is_hash(&hash),
        [commit, "modified", hash] => is_hash(&commit) && is_hash(&hash),
        _ => false,
    };
    assert!(known && [0, "2026-02-03".len()].contains(&date.len()), "{printed}");
    // The manual is of a version, whatever the commit.
    let page = String::from_utf8(rubscope(&["man"]).stdout).unwrap();
    assert!(!page.contains(rest), "{page}");
}

#[test]
fn the_manual_the_citation_and_the_package_have_the_version_and_date_of_the_change_log() {
    let changes = include_str!("../../CHANGELOG.md");
    let newest = changes.lines().find_map(|line| line.strip_prefix("## [")).unwrap();
    let (version, date) = newest.split_once("] - ").unwrap();
    assert_eq!(version, env!("CARGO_PKG_VERSION"));
    assert!(
        String::from_utf8(rubscope(&["man"]).stdout)
            .unwrap()
            .contains(&format!(".TH rubscope 1 {date} "))
    );
    let citation = include_str!("../../CITATION.cff");
    assert!(citation.contains(&format!("\nversion: {version}\ndate-released: {date}\n")));
}
