//! The tables that are made from the program: keys of the explorer, options of
//! the commands, keys of a scene file. A document has them between two comments.
//! `RUBSCOPE_WRITE_DOCS=1 cargo test docs` writes them anew.

use clap::{Arg, Command, CommandFactory};
use rubscope::cli::{Cli, options::SceneOptions};
use rubscope::tui::command::{self, Binding, Group, keys_text};
use rubscope_solver::scene::{KEYS, Scene, Value};
use strum::IntoEnumIterator;

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

fn keys() -> String {
    let row = |binding: &Binding| {
        let keys: Vec<String> = keys_text(binding).split(", ").map(code).collect();
        vec![keys.join(" "), binding.what.to_string()]
    };
    let mut out = String::new();
    let mut part = |title: &str, bindings: Vec<&Binding>| {
        let rows = table(&["key", "what it does"], bindings.into_iter().map(row));
        out.push_str(&format!("{title}:\n\n{rows}\n"));
    };
    // The screen names the keys of lists and dialogues on its last line.
    for group in Group::iter().filter(|group| group.is_main()) {
        part(group.into(), command::of(group).collect());
    }
    let reading = "While the arrows read a chart (`i`); all other keys as above";
    part(reading, command::of(Group::Reading).collect());
    out.trim_end().to_string() + "\n"
}

/// What the page says of all commands at once.
const OF_MOST: [&str; 4] = ["help", "version", "scene", "json"];

/// The rows of the arguments of a command that pass; nothing where none is an option.
fn arguments(command: &Command, pass: impl Fn(&&Arg) -> bool) -> String {
    let shown = |arg: &&Arg| !OF_MOST.contains(&arg.get_id().as_str());
    let row = |arg: &Arg| {
        let value = arg.get_value_names().map(|names| names[0].to_string());
        let name = match (arg.get_long(), value) {
            (Some(long), Some(value)) if arg.get_action().takes_values() => {
                format!("--{long} {value}")
            }
            (Some(long), _) => format!("--{long}"),
            (None, value) => value.unwrap(),
        };
        // A flag is off by default.
        let takes = arg.get_action().takes_values();
        let defaults = arg.get_default_values().iter().filter(|_| takes);
        let mut default: Vec<String> =
            defaults.map(|value| value.to_string_lossy().into_owned()).collect();
        let help = arg.get_help().unwrap().to_string();
        let help = help.split_whitespace().collect::<Vec<_>>().join(" ");
        // Some say their default in their words.
        let (help, told) = match help.split_once(" [default: ") {
            Some((help, told)) => (help.to_string(), Some(told.trim_end_matches(']').to_string())),
            None => (help, None),
        };
        default.extend(told);
        let default = default.join(", ");
        let help = match (arg.is_required_set(), default.as_str()) {
            (true, _) => help + " (required)",
            (false, "") => help,
            (false, default) => format!("{help} (default: {default})"),
        };
        vec![code(name), help]
    };
    let own: Vec<&Arg> = command.get_arguments().filter(shown).filter(pass).collect();
    if own.iter().all(|arg| arg.get_long().is_none()) {
        return String::new();
    }
    table(&["option", "what it does"], own.into_iter().map(row))
}

/// The options that change the scene, with the keys that they set.
fn scene_options(command: &Command) -> String {
    let row = |arg: &Arg| {
        let long = format!("--{}", arg.get_long().unwrap());
        let help = arg.get_help().unwrap().to_string();
        if !arg.get_action().takes_values() {
            return vec![code(long), String::new(), help];
        }
        let value = &arg.get_value_names().unwrap()[0];
        let keys = SceneOptions::keys();
        let key = keys.iter().find(|(option, _)| *option == long).map(|(_, key)| code(key));
        vec![code(format!("{long} {value}")), key.unwrap_or_else(|| "any".into()), help]
    };
    let own = command.get_arguments().filter(changes_the_scene);
    table(&["option", "key it sets", "what it does"], own.map(row))
}

fn changes_the_scene(arg: &&Arg) -> bool {
    arg.get_help_heading().is_some()
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
    let mut found = vec![("keys".to_string(), keys()), ("scene file".to_string(), scene_keys())];
    found.push(("lessons".into(), super::lessons::sheet()));
    let header = ["", "lesson", "minutes", "needs"];
    found.push(("course".into(), table(&header, super::lessons::course())));
    let mut whole = Cli::command();
    whole.build();
    found.push(("options of every command".into(), scene_options(&whole)));
    let own = |arg: &&Arg| !changes_the_scene(arg);
    found.push(("options of the explorer".into(), arguments(&whole, own)));
    let mut commands: Vec<(String, &Command)> =
        whole.get_subcommands().map(|command| (command.get_name().to_string(), command)).collect();
    while let Some((name, command)) = commands.pop() {
        if name.ends_with("help") {
            continue;
        }
        found.push((format!("options of {name}"), arguments(command, own)));
        let inner = command.get_subcommands();
        commands.extend(inner.map(|inner| (format!("{name} {}", inner.get_name()), inner)));
    }
    found.retain(|(_, text)| !text.is_empty());
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

/// The section of a manual page with this heading.
fn section(heading: &str) -> String {
    let page = crate::cli_support::text(&["man"]);
    let rest = page.split(&format!(".SH {heading}\n")).nth(1).unwrap();
    rest.split("\n.SH ").next().unwrap().replace("\\", "")
}

#[test]
fn variables_and_exit_status_of_the_manual_are_in_the_documents() {
    let text = super::read("docs/commands.md").text;
    let terms = |heading: &str| -> Vec<String> {
        let page = section(heading);
        let bold = page.lines().filter_map(|line| line.strip_prefix("fB"));
        bold.flat_map(|line| {
            line.trim_end_matches("fR").split(", ").map(String::from).collect::<Vec<_>>()
        })
        .collect()
    };
    let [variables, states] = ["ENVIRONMENT", "\"EXIT STATUS\""].map(terms);
    assert!(variables.len() > 8 && states.len() == 4, "{variables:?} {states:?}");
    for term in variables.iter().chain(&states) {
        assert!(text.contains(&format!("`{term}`")), "{term}");
    }
}
