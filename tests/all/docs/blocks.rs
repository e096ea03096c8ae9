//! The blocks of the documents. Every command of a `console` block is run, and
//! its output is compared line by line; every `sh` block that calls the program
//! is run; every `toml` block is a scene. The commands of one document run in
//! one temporary folder, in their order, so that one may use the file of
//! another; a `toml` block with the name of a file (`toml lighter.toml`) is
//! written there.

use std::path::Path;

use rubscope_solver::scene::Scene;

use super::{Block, Document, documents};
use crate::transcripts::{Shown, bash, matches, shown};

/// Lines that begin so are in blocks which are not run, and why.
const NOT_RUN: [(&str, &str); 4] = [
    ("rubscope run again.toml", "needs what Python wrote; the tests of python run it"),
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

/// Part by which numbers may differ: other processors round sines differently, and no statement
/// of the documents depends on a fourth digit.
const WITHIN: f64 = 1e-3;

/// What is wrong with a console block.
fn console(block: &Block, folder: &Path, wrong: &mut Vec<String>) {
    for Shown { command, lines } in shown(&block.text) {
        if !command.starts_with("rubscope") {
            continue;
        }
        let output = bash(&command, folder);
        let failure = ["rubscope:", "Verdict: failed."];
        let refused = lines.iter().any(|line| failure.iter().any(|start| line.starts_with(start)));
        let printed = [output.stdout, output.stderr].concat();
        let printed = String::from_utf8(printed).unwrap();
        let printed: Vec<&str> = printed.lines().collect();
        if !(output.status.success() || refused) || !matches(&lines, &printed, WITHIN) {
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
                let output = bash(&script, folder.path());
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
