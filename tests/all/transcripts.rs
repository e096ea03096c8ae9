//! What commands print, as files: `tests/transcripts/*.txt`. A case is a command behind `$` and
//! below it its exit status (`? 2`; none for 0) and its whole output, standard error behind
//! standard output. `...` stands for any lines, `[..]` for anything within a line; lines that
//! begin with `##` are comments. A row `rubscope COMMAND | WORDS` is a refusal: status 2, nothing
//! on standard output, and one line with the words. The commands of a file run in one folder.
//!
//! To add a case, write its command and run `RUBSCOPE_TRANSCRIPTS=write cargo test transcripts`,
//! which puts in the output of each case that has none; then read it.

use std::path::Path;
use std::process::{Output, Stdio};

use crate::cli_support::hearing;

/// Numbers may differ by this part between processors; other words may not.
const WITHIN: f64 = 1e-5;

files! {
    "transcripts": files hbm lines machine map margins margins_unusual modes notes notes_beyond precision program
    refusals refusals_keys refusals_maps refusals_runs run survey
}

/// A command and the lines below it.
pub struct Shown {
    pub command: String,
    pub lines: Vec<String>,
}

/// The commands of a text, each with its lines; what is before the first one is left out.
pub fn shown(text: &str) -> Vec<Shown> {
    let mut found: Vec<Shown> = Vec::new();
    for line in text.lines() {
        let lines = found.last_mut().map(|last| &mut last.lines);
        match (line.strip_prefix("$ "), lines) {
            (Some(command), _) => {
                found.push(Shown { command: command.to_string(), lines: Vec::new() });
            }
            (None, Some(lines)) => lines.push(line.to_string()),
            (None, None) => {}
        }
    }
    found
}

/// The same words, and numbers within a part of them.
fn same(shown: &str, printed: &str, within: f64) -> bool {
    if shown.starts_with("Cost: ") && printed.starts_with("Cost: ") {
        return true;
    }
    if let Some((start, rest)) = shown.split_once("[..]") {
        let Some(printed) = printed.strip_prefix(start) else { return false };
        let mut ends = printed.char_indices().map(|(at, _)| at).chain([printed.len()]);
        return ends.any(|at| same(rest, &printed[at..], within));
    }
    // Of a map in a document nine of ten cells must agree, for the same reason.
    if within > WITHIN && shown.ends_with('|') {
        let equal = shown.chars().zip(printed.chars()).filter(|(a, b)| a == b).count();
        return shown.len() == printed.len() && 10 * equal >= 9 * shown.len();
    }
    let words = |line: &str| -> Vec<String> {
        let separate = |c: char| c.is_whitespace() || "(),;:=".contains(c);
        line.split(separate).map(|word| word.trim_end_matches('.').to_string()).collect()
    };
    let (shown, printed) = (words(shown), words(printed));
    shown.len() == printed.len()
        && shown.iter().zip(&printed).all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(x), Ok(y)) if x.is_finite() => (x - y).abs() <= within * x.abs(),
            _ => a == b,
        })
}

/// Compares line by line; `...` stands for any lines.
pub fn matches(shown: &[String], printed: &[&str], within: f64) -> bool {
    match (shown.split_first(), printed.split_first()) {
        (None, None) => true,
        (Some((line, rest)), _) if line == "..." => {
            (0..=printed.len()).any(|skip| matches(rest, &printed[skip..], within))
        }
        (Some((line, rest)), Some((found, more))) => {
            same(line, found, within) && matches(rest, more, within)
        }
        _ => false,
    }
}

/// Runs a script in a folder, with the program in its path.
pub fn bash(script: &str, folder: &Path) -> Output {
    let program = Path::new(env!("CARGO_BIN_EXE_rubscope")).parent().unwrap();
    let search = std::env::var("PATH").unwrap_or_default();
    hearing("bash")
        .args(["-e", "-o", "pipefail", "-c", script])
        .current_dir(folder)
        .env("PATH", format!("{}:{search}", program.display()))
        // What a command writes at home, it writes there.
        .env("HOME", folder)
        .env("XDG_CONFIG_HOME", folder)
        .env("LC_ALL", "C.UTF-8")
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

/// What a command prints, in the form of a file.
fn printed(script: &str, folder: &Path) -> Vec<String> {
    let Output { status, stdout, stderr } = bash(script, folder);
    let status = status.code().unwrap();
    let text = String::from_utf8([stdout, stderr].concat()).unwrap();
    let lines = text.trim_end().lines().map(|line| line.trim_end().to_string());
    (status != 0).then(|| format!("? {status}")).into_iter().chain(lines).collect()
}

/// The words behind `rubscope: ` of a command that is refused, or why it is not.
fn refusal(script: &str, folder: &Path) -> String {
    let output = bash(script, folder);
    let said = String::from_utf8(output.stderr).unwrap();
    let words = said.strip_prefix("rubscope: ").and_then(|words| words.strip_suffix('\n'));
    let alone = (output.status.code(), output.stdout.len()) == (Some(2), 0);
    match words.filter(|words| alone && !words.contains(char::is_control)) {
        Some(words) => words.to_string(),
        None => format!("no refusal but {}: {said:?}", output.status),
    }
}

/// Every case of a file, written again with the output of those that have none.
fn holds(name: &str) {
    let (path, folder) = (crate::table("transcripts", name), tempfile::tempdir().unwrap());
    let text = std::fs::read_to_string(&path).unwrap();
    let write = std::env::var("RUBSCOPE_TRANSCRIPTS").is_ok_and(|word| word == "write");
    let (mut wrong, mut again, mut lines) = (Vec::new(), Vec::new(), text.lines().peekable());
    while let Some(line) = lines.next() {
        again.push(line.to_string());
        if let Some((command, words)) =
            line.split_once(" | ").filter(|_| line.starts_with("rubscope "))
        {
            let said = refusal(command, folder.path());
            if words.is_empty() && write {
                *again.last_mut().unwrap() = format!("{command} | {said}");
            } else if !same(words, &said, WITHIN) {
                wrong.push(format!("{command} said\n{said}"));
            }
        }
        let Some(command) = line.strip_prefix("$ ") else { continue };
        let mut shown = Vec::new();
        while let Some(line) =
            lines.next_if(|line| !line.starts_with("$ ") && !line.starts_with("##"))
        {
            shown.push(line.to_string());
        }
        let found = printed(command, folder.path());
        let kept = shown.iter().rposition(|line| !line.is_empty()).map_or(0, |last| last + 1);
        if kept == 0 && write {
            again.extend(found);
            again.push(String::new());
            continue;
        }
        if !matches(&shown[..kept], &found.iter().map(String::as_str).collect::<Vec<_>>(), WITHIN) {
            wrong.push(format!("{command} printed\n{}", found.join("\n")));
        }
        again.extend(shown);
    }
    if write {
        std::fs::write(path, again.join("\n").trim_end().to_string() + "\n").unwrap();
    }
    assert!(wrong.is_empty(), "{name}: {}", wrong.join("\n\n"));
}
