//! Says of which commit the program is: `rubscope --version` prints it. Without
//! git, or outside a checkout of its own, it is the version alone; nothing here can
//! make a build fail.

use std::path::{Path, PathBuf};
use std::process::Command;

/// What the program is made of. A change of anything else is no reason to build
/// again, and makes no other program.
const SOURCES: [&str; 8] = [
    "src",
    "solver/src",
    "solver/Cargo.toml",
    "presets",
    "assets",
    "build.rs",
    "Cargo.toml",
    "Cargo.lock",
];

/// Where `cargo package` tells the commit.
const INFO: &str = ".cargo_vcs_info.json";

/// Digits of a commit, as many as rustc prints.
const DIGITS: usize = 9;

fn main() {
    // Cargo runs this in the folder of the package.
    let folder = Path::new(".");
    let commit = commit(folder).map_or_else(String::new, |commit| format!(" ({commit})"));
    println!("cargo::rustc-env=RUBSCOPE_VERSION={}{commit}", env!("CARGO_PKG_VERSION"));
    // Where it was and is no more, the package was built in the same target folder.
    let watched = SOURCES.iter().chain([&INFO]).map(Into::into).chain(head(folder));
    for path in watched.filter(|path: &PathBuf| path.exists()) {
        println!("cargo::rerun-if-changed={}", path.display());
    }
}

/// The commit of a folder: from the file that `cargo package` adds, else from git.
pub fn commit(folder: &Path) -> Option<String> {
    match std::fs::read_to_string(folder.join(INFO)) {
        Ok(info) => packaged(&info),
        Err(_) => checked_out(folder),
    }
}

fn packaged(info: &str) -> Option<String> {
    let (_, rest) = info.split_once("\"sha1\"")?;
    let hash = short(rest.split('"').nth(1)?)?;
    let flat: String = info.split_whitespace().collect();
    Some(hash + modified(flat.contains("\"dirty\":true")))
}

fn checked_out(folder: &Path) -> Option<String> {
    // A copy inside the repository of something else is not of its commit.
    if !git(folder, &["rev-parse", "--show-prefix"])?.is_empty() {
        return None;
    }
    let head = git(folder, &["log", "-1", "--format=%H %cs"])?;
    let (hash, date) = head.split_once(' ')?;
    let status = [&["status", "--porcelain", "--"][..], &SOURCES].concat();
    let changed = !git(folder, &status)?.is_empty();
    Some(format!("{}{} {date}", short(hash)?, modified(changed)))
}

/// What changes when another commit is checked out or made.
fn head(folder: &Path) -> Option<PathBuf> {
    Some(folder.join(git(folder, &["rev-parse", "--git-path", "logs/HEAD"])?))
}

fn modified(changed: bool) -> &'static str {
    if changed { "-modified" } else { "" }
}

fn short(hash: &str) -> Option<String> {
    let digits = hash.get(..DIGITS)?;
    digits.bytes().all(|byte| byte.is_ascii_hexdigit()).then(|| digits.to_string())
}

/// What git prints; none if it fails or is not there. It changes nothing.
fn git(folder: &Path, arguments: &[&str]) -> Option<String> {
    let mut git = Command::new("git");
    git.arg("-C").arg(folder).args(arguments).env("GIT_OPTIONAL_LOCKS", "0");
    // A hook of another repository may have set these.
    for name in ["GIT_DIR", "GIT_WORK_TREE", "GIT_INDEX_FILE", "GIT_PREFIX"] {
        git.env_remove(name);
    }
    let output = git.output().ok().filter(|output| output.status.success())?;
    Some(String::from_utf8(output.stdout).ok()?.trim().to_string())
}
