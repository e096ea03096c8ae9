//! The blocks of the documents. Every command of a `console` block is run, and
//! its output is compared line by line; every `sh` block that calls the program
//! is run; every `toml` block is a scene. The commands of one document run in
//! one temporary folder, in their order, so that one may use the file of
//! another; a `toml` block with the name of a file (`toml lighter.toml`) is
//! written there.

use std::path::Path;
use std::process::{Command, Output, Stdio};

use rubscope_solver::scene::Scene;

use super::{Block, Document, documents};

/// Lines that begin so are in blocks which are not run, and why.
const NOT_RUN: [(&str, &str); 5] = [
    ("rubscope run again.toml", "needs what Python wrote; the tests of python run it"),
    ("parallel ", "needs GNU parallel; map_cli runs it where there is one"),
    ("#SBATCH", "needs Slurm; tests/slurm.sh runs it"),
    ("sbatch ", "needs Slurm; tests/slurm.sh runs it"),
    ("cargo ", "builds the program, as this test did"),
];

/// The word behind `toml` of a block that is no scene.
const SETTINGS: &str = "settings";

/// Before each script: where the explorer finds no terminal, it has read its
/// options and its scene, which is all that can be asked of it here.
const WITHOUT_A_TERMINAL: &str = r#"
rubscope() {
    command rubscope "$@" 2> .said && return
    status=$?
    cat .said >&2
    grep -q "the explorer needs a terminal" .said && return
    return "$status"
}
"#;

/// A command of a console block and the lines it shows below it.
struct Shown {
    command: String,
    lines: Vec<String>,
}

fn shown(block: &Block) -> Vec<Shown> {
    let mut found: Vec<Shown> = Vec::new();
    for line in block.text.lines() {
        match (line.strip_prefix("$ "), found.last_mut()) {
            (Some(command), _) => {
                found.push(Shown { command: command.to_string(), lines: Vec::new() });
            }
            (None, Some(last)) => last.lines.push(line.to_string()),
            (None, None) => unreachable!("a console block begins with a command: {line}"),
        }
    }
    found
}

/// A line of a map: nine of ten characters must agree, for the same reason.
fn same_picture(shown: &str, printed: &str) -> bool {
    let (shown, printed): (Vec<char>, Vec<char>) =
        (shown.chars().collect(), printed.chars().collect());
    let equal = shown.iter().zip(&printed).filter(|(a, b)| a == b).count();
    shown.len() == printed.len() && 10 * equal >= 9 * shown.len()
}

/// The same words, and numbers within a thousandth: other processors round
/// sines differently, and no statement of the documents depends on a fourth digit.
fn same(shown: &str, printed: &str) -> bool {
    if shown.ends_with('|') {
        return same_picture(shown, printed);
    }
    let words = |line: &str| -> Vec<String> {
        let separate = |c: char| c.is_whitespace() || "(),;:=".contains(c);
        line.split(separate).map(|word| word.trim_end_matches('.').to_string()).collect()
    };
    let (shown, printed) = (words(shown), words(printed));
    shown.len() == printed.len()
        && shown.iter().zip(&printed).all(|(a, b)| match (a.parse::<f64>(), b.parse::<f64>()) {
            (Ok(x), Ok(y)) => (x - y).abs() <= 1e-3 * x.abs(),
            _ => a == b,
        })
}

/// Compares line by line; "..." matches any lines, and costs may differ.
fn matches(shown: &[String], printed: &[&str]) -> bool {
    match (shown.first().map(String::as_str), printed.first()) {
        (None, None) => true,
        (Some("..."), _) => (0..=printed.len()).any(|skip| matches(&shown[1..], &printed[skip..])),
        (Some(line), Some(found)) => {
            let cost = line.starts_with("Cost: ") && found.starts_with("Cost: ");
            (cost || same(line, found)) && matches(&shown[1..], &printed[1..])
        }
        _ => false,
    }
}

/// Runs a script in a folder, with the program in its path.
fn run(script: &str, folder: &Path) -> Output {
    let program = Path::new(env!("CARGO_BIN_EXE_rubscope")).parent().unwrap();
    let search = std::env::var("PATH").unwrap_or_default();
    Command::new("bash")
        .args(["-e", "-o", "pipefail", "-c", script])
        .current_dir(folder)
        .env("PATH", format!("{}:{search}", program.display()))
        // What a command writes at home, it writes there.
        .env("HOME", folder)
        .env("XDG_CONFIG_HOME", folder)
        .stdin(Stdio::null())
        .output()
        .unwrap()
}

/// What is wrong with a console block.
fn console(block: &Block, folder: &Path, wrong: &mut Vec<String>) {
    for Shown { command, lines } in shown(block) {
        if !command.starts_with("rubscope") {
            continue;
        }
        let output = run(&command, folder);
        let failure = ["rubscope:", "Verdict: failed."];
        let refused = lines.iter().any(|line| failure.iter().any(|start| line.starts_with(start)));
        let printed = [output.stdout, output.stderr].concat();
        let printed = String::from_utf8(printed).unwrap();
        let printed: Vec<&str> = printed.lines().collect();
        if !(output.status.success() || refused) || !matches(&lines, &printed) {
            wrong.push(format!("{command} ({}) printed\n{}", output.status, printed.join("\n")));
        }
    }
}

/// Whether a block of commands calls the program, and can be run anywhere.
fn is_run(block: &Block) -> bool {
    let lines = || block.text.lines().map(str::trim_start);
    let calls = |line: &str| line.split(' ').any(|word| word == "rubscope");
    lines().any(calls)
        && !lines().any(|line| NOT_RUN.iter().any(|(start, _)| line.starts_with(start)))
}

fn toml(block: &Block, folder: &Path) -> Result<(), String> {
    if block.word == SETTINGS {
        let table: Result<toml::Table, _> = block.text.parse();
        return table.map(|_| ()).map_err(|error| error.to_string());
    }
    if !block.word.is_empty() {
        std::fs::write(folder.join(&block.word), &block.text).unwrap();
    }
    Scene::from_toml(&block.text).map(|_| ()).map_err(|error| error.to_string())
}

/// What is wrong with the blocks of a document.
fn check(document: &Document) -> Vec<String> {
    let folder = tempfile::tempdir().unwrap();
    let mut wrong = Vec::new();
    for block in document.blocks() {
        let mut found = Vec::new();
        match block.language.as_str() {
            "console" => console(&block, folder.path(), &mut found),
            "toml" => found.extend(toml(&block, folder.path()).err()),
            "sh" if is_run(&block) => {
                let script = format!("{WITHOUT_A_TERMINAL}{}", block.text);
                let output = run(&script, folder.path());
                if !output.status.success() {
                    let said = String::from_utf8_lossy(&output.stderr);
                    found.push(format!("{}\n{said}", output.status));
                }
            }
            _ => {}
        }
        let place = format!("{}:{}", document.name, block.line);
        wrong.extend(found.into_iter().map(|found| format!("{place}: {found}")));
    }
    wrong
}

#[test]
fn every_block_of_the_documents_is_what_the_program_does() {
    let documents = documents();
    let wrong: Vec<String> = std::thread::scope(|scope| {
        let checks: Vec<_> =
            documents.iter().map(|document| scope.spawn(|| check(document))).collect();
        checks.into_iter().flat_map(|check| check.join().unwrap()).collect()
    });
    assert!(wrong.is_empty(), "{}", wrong.join("\n\n"));
    let count = |language: &str| {
        let blocks = documents.iter().flat_map(Document::blocks);
        blocks.filter(|block| block.language == language).count()
    };
    assert!(count("console") > 10 && count("sh") > 3 && count("toml") > 0);
}
