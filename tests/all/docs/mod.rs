//! The documents show what the program does: their commands are run, their
//! scenes are read, their links lead somewhere, and their tables are made from
//! the program.
//!
//! `RUBSCOPE_WRITE_DOCS=1 cargo test docs` writes the tables anew.

mod blocks;
mod fields;
mod lessons;
mod links;
mod numbers;
mod speed;
mod tables;

use std::path::{Path, PathBuf};

/// One document.
pub struct Document {
    /// Its path from the top folder, such as `docs/commands.md`.
    name: String,
    pub text: String,
}

/// A fenced block of a document.
#[derive(Debug)]
pub struct Block {
    /// The line of its fence, from 1.
    line: usize,
    /// The word behind the fence, such as `console`.
    pub language: String,
    /// The second word, such as the name of a file.
    word: String,
    pub text: String,
}

fn top() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR"))
}

pub fn read(name: &str) -> Document {
    let text = std::fs::read_to_string(top().join(name)).unwrap();
    Document { name: name.to_string(), text }
}

/// Every document that there is.
fn documents() -> Vec<Document> {
    let mut names: Vec<String> = ["README.md", "CONTRIBUTING.md", "COMPARE.md"]
        .into_iter()
        .filter(|name| top().join(name).exists())
        .map(String::from)
        .collect();
    let folder = std::fs::read_dir(top().join("docs")).unwrap();
    let mut more: Vec<String> = folder
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .filter(|name| Path::new(name).extension().is_some_and(|end| end == "md"))
        .map(|name| format!("docs/{name}"))
        .collect();
    more.sort();
    names.extend(more);
    names.iter().map(|name| read(name)).collect()
}

impl Document {
    pub fn blocks(&self) -> Vec<Block> {
        let mut blocks: Vec<Block> = Vec::new();
        let mut open = false;
        for (line, text) in (1..).zip(self.text.lines()) {
            match (open, text.strip_prefix("```")) {
                (true, Some(_)) => open = false,
                (false, Some(fence)) => {
                    let (language, word) = fence.split_once(' ').unwrap_or((fence, ""));
                    let (language, word) = (language.to_string(), word.trim().to_string());
                    blocks.push(Block { line, language, word, text: String::new() });
                    open = true;
                }
                (true, None) => {
                    let block = blocks.last_mut().unwrap();
                    block.text.push_str(text);
                    block.text.push('\n');
                }
                (false, None) => {}
            }
        }
        assert!(!open, "{}: a block is not closed", self.name);
        blocks
    }

    /// Whether it says these words, wherever its lines break.
    fn says(&self, words: &str) -> bool {
        self.text.split_whitespace().collect::<Vec<_>>().join(" ").contains(words)
    }

    /// The lines outside blocks, with their numbers from 1.
    fn prose(&self) -> Vec<(usize, &str)> {
        let mut open = false;
        let outside = |&(_, text): &(usize, &str)| {
            let fence = text.starts_with("```");
            open ^= fence;
            !open && !fence
        };
        (1..).zip(self.text.lines()).filter(outside).collect()
    }

    /// The cells of the table under this header, row by row.
    pub fn table(&self, header: &str) -> Vec<Vec<String>> {
        let mut lines = self.text.lines().skip_while(|line| *line != header);
        assert!(lines.next().is_some(), "{}: no table {header}", self.name);
        let cells = |line: &str| -> Vec<String> {
            line.trim_matches('|').split('|').map(|cell| cell.trim().to_string()).collect()
        };
        lines.skip(1).take_while(|line| line.starts_with('|')).map(cells).collect()
    }
}
