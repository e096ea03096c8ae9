//! The tables that are made from the program: keys of a scene file, lessons. A document has them between two comments.
//! `RUBSCOPE_WRITE_DOCS=1 cargo test docs` writes them anew.

use rubscope_solver::scene::{KEYS, Scene, Value};

use super::{documents, top};

/// Set to write the tables.
const WRITE: &str = "RUBSCOPE_WRITE_DOCS";

/// The comments around a table.
fn marks(name: &str) -> [String; 2] {
    [format!("<!-- table: {name}; made by {WRITE}=1 cargo test docs -->"), "<!-- end -->".into()]
}

/// One table; no cell may have the sign between two of them.
fn table(header: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    let row = |cells: Vec<String>| {
        assert!(cells.len() == header.len() && cells.iter().all(|cell| !cell.contains('|')));
        format!("| {} |\n", cells.join(" | "))
    };
    let names = row(header.iter().map(ToString::to_string).collect());
    let rule = format!("|{}\n", "---|".repeat(header.len()));
    let rows: String = rows.into_iter().map(row).collect();
    names + &rule + &rows
}

fn code(text: impl std::fmt::Display) -> String {
    format!("`{text}`")
}

fn scene_keys() -> String {
    let base = Scene::base();
    let row = |key: &rubscope_solver::scene::Key| {
        let default = match (key.get)(&base) {
            Value::Text(text) if text.is_empty() => "empty".to_string(),
            value => code(value),
        };
        // The page says that values are numbers.
        let allowed = key.allowed.to_string().replace("a whole number", "whole");
        let allowed = allowed.trim_start_matches("a number ").to_string();
        vec![code(key.path), default, allowed, key.what.into()]
    };
    let header = ["key", "default", "allowed", "what it is"];
    table(&header, KEYS.iter().map(row))
}

/// Every table: its name and its text.
fn tables() -> Vec<(String, String)> {
    let mut found = vec![("scene file".to_string(), scene_keys())];
    found.push(("lessons".into(), super::lessons::sheet()));
    let header = ["", "lesson", "minutes", "needs"];
    found.push(("course".into(), table(&header, super::lessons::course())));
    found
}

#[test]
fn every_table_is_what_the_program_has() {
    let writes = std::env::var_os(WRITE).is_some();
    let mut seen = Vec::new();
    let mut stale = Vec::new();
    for document in documents() {
        let mut text = document.text.clone();
        let before = seen.len();
        for (name, content) in tables() {
            let [begin, end] = marks(&name);
            let Some((above, rest)) = text.split_once(&begin) else { continue };
            let (old, after) = rest.split_once(&end).unwrap();
            seen.push(name.clone());
            let new = format!("\n\n{content}\n");
            if old != new {
                stale.push(format!("{}: {name}", document.name));
                text = format!("{above}{begin}{new}{end}{after}");
            }
        }
        let told = text.matches("<!-- table: ").count();
        assert_eq!(told, seen.len() - before, "{}: a table that nothing makes", document.name);
        if writes && text != document.text {
            std::fs::write(top().join(&document.name), text).unwrap();
        }
    }
    for (name, _) in tables() {
        let count = seen.iter().filter(|seen| **seen == name).count();
        assert_eq!(count, 1, "the documents have the table {name:?} {count} times");
    }
    let said = format!("{} (write them by {WRITE}=1 cargo test docs)", stale.join("; "));
    assert!(writes || stale.is_empty(), "tables that are not what the program has: {said}");
}

#[test]
fn the_exit_status_of_the_manual_is_in_the_documents() {
    let text = super::read("docs/commands.md").text;
    let page = crate::cli_support::text(&["man"]).replace('\\', "");
    let section = page.split(".SH \"EXIT STATUS\"\n").nth(1).unwrap();
    let section = section.split("\n.SH ").next().unwrap();
    let terms = section.lines().filter_map(|line| line.strip_prefix("fB"));
    let terms: Vec<&str> = terms.map(|line| line.trim_end_matches("fR")).collect();
    assert_eq!(terms.len(), 4, "{terms:?}");
    for term in terms {
        assert!(text.contains(&format!("`{term}`")), "{term}");
    }
}
