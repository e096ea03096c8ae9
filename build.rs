//! Says of which commit the program is: `rubscope --version` prints it, and results carry it.
//! Without git, outside a checkout of its own, or where the sources were changed, a hash of the
//! sources tells one program from another; nothing here can make a build fail.

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
    let commit = commit(folder);
    let (hash, _date) = commit.split_once(' ').unwrap_or((&commit, ""));
    println!("cargo::rustc-env=RUBSCOPE_COMMIT={hash}");
    println!("cargo::rustc-env=RUBSCOPE_VERSION={} ({commit})", env!("CARGO_PKG_VERSION"));
    // Where it was and is no more, the package was built in the same target folder.
    let watched = SOURCES.iter().chain([&INFO]).map(Into::into).chain(head(folder));
    for path in watched.filter(|path: &PathBuf| path.exists()) {
        println!("cargo::rerun-if-changed={}", path.display());
    }
}

/// The commit of a folder: from the file that `cargo package` adds, else from git; where there is
/// none, or the sources were changed, with a hash of the sources.
pub fn commit(folder: &Path) -> String {
    let known = match std::fs::read_to_string(folder.join(INFO)) {
        Ok(info) => packaged(folder, &info),
        Err(_) => checked_out(folder),
    };
    known.unwrap_or_else(|| format!("source-{}", hash(folder)))
}

fn packaged(folder: &Path, info: &str) -> Option<String> {
    let (_, rest) = info.split_once("\"sha1\"")?;
    let hash = short(rest.split('"').nth(1)?)?;
    let flat: String = info.split_whitespace().collect();
    Some(hash + &modified(folder, flat.contains("\"dirty\":true")))
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
    Some(format!("{}{} {date}", short(hash)?, modified(folder, changed)))
}

/// What changes when another commit is checked out or made.
fn head(folder: &Path) -> Option<PathBuf> {
    Some(folder.join(git(folder, &["rev-parse", "--git-path", "logs/HEAD"])?))
}

fn modified(folder: &Path, changed: bool) -> String {
    if changed { format!("-modified-{}", hash(folder)) } else { String::new() }
}

/// Digits of a hash (FNV-1a) of the names and contents of the sources.
fn hash(folder: &Path) -> String {
    let mut files = Vec::new();
    SOURCES.iter().for_each(|name| add_files(folder.join(name), &mut files));
    files.sort();
    let mut hash = 0xcbf2_9ce4_8422_2325_u64;
    for file in files {
        let name = file.strip_prefix(folder).unwrap_or(&file).to_string_lossy().into_owned();
        let content = std::fs::read(&file).unwrap_or_default();
        for byte in name.bytes().chain([0]).chain(content).chain([0]) {
            hash = (hash ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
        }
    }
    format!("{hash:016x}").chars().take(DIGITS).collect()
}

fn add_files(path: PathBuf, files: &mut Vec<PathBuf>) {
    match std::fs::read_dir(&path) {
        Ok(entries) => entries.flatten().for_each(|entry| add_files(entry.path(), files)),
        Err(_) if path.is_file() => files.push(path),
        Err(_) => {}
    }
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
