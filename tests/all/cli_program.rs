//! The program as a whole: help, version, completions, manual, the explorer
//! without a terminal, closed pipes, and exit status.

use std::io::Read;
use std::process::{Command, Stdio};

use crate::cli_support::{refusal, rubscope};

fn printed(arguments: &[&str]) -> String {
    let output = rubscope(arguments);
    assert_eq!(output.status.code(), Some(0), "{arguments:?}");
    assert!(output.stderr.is_empty(), "{arguments:?}");
    String::from_utf8(output.stdout).unwrap()
}

#[test]
fn the_explorer_without_a_terminal_names_the_command_that_needs_none() {
    for arguments in [&[][..], &["paper-nd4"], &["--speed", "-430"]] {
        let message = refusal(arguments);
        assert!(message.contains("terminal") && message.contains("rubscope run"), "{message}");
    }
}

#[test]
fn options_before_a_command_are_explained() {
    assert_eq!(
        refusal(&["--speed", "400", "run"]),
        "rubscope: options come after the command: rubscope run [OPTIONS]"
    );
}

#[test]
fn help_and_version_are_data() {
    assert!(printed(&["--version"]).starts_with("rubscope "));
    let help = printed(&["--help"]);
    for word in ["Usage: rubscope", "run", "scenes", "completions", "man", "--speed", "--set"] {
        assert!(help.contains(word), "{word} is not in {help}");
    }
    assert!(printed(&["run", "--help"]).contains("--samples"));
}

#[test]
fn wrong_usage_is_one_line() {
    for (arguments, found) in [
        (&["run", "--bogus"][..], "'--bogus'"),
        (&["run", "a", "b"], "'b'"),
        (&["run", "--samples", "many", "--out", "a.csv"], "'--samples <COUNT>'"),
        (&["completions", "sh"], "bash"),
        (&["completions"], "<SHELL>"),
        (&["run", "--speed"], "'--speed <SPEED>'"),
        (&["man", "nothing"], "COMMAND = nothing: allowed is one of run,"),
        (&["scenes", "nothing"], "unknown scene nothing; allowed: "),
    ] {
        let message = refusal(arguments);
        assert!(message.contains(found), "{arguments:?} said {message}");
    }
}

#[test]
fn a_file_whose_name_begins_with_a_dash_is_told_how_to_be_named() {
    for arguments in [&["run", "-x.toml"][..], &["-x.toml"], &["map", "merge", "a.csv", "-x.toml"]]
    {
        let told = refusal(arguments);
        let expected = "-x.toml: allowed is ./-x.toml for a file whose name begins with -";
        assert_eq!(told, format!("rubscope: {expected}"), "{arguments:?}");
    }
    // An option that is none stays one.
    assert!(refusal(&["run", "-x"]).contains("unexpected argument '-x' found"));
    assert!(refusal(&["run", "--no.such=1.0"]).contains("unexpected argument '--no.such'"));
}

#[test]
fn control_characters_in_arguments_do_not_reach_the_terminal() {
    let message = refusal(&["run", "a\u{1b}[31m\nb"]);
    assert!(!message.chars().any(char::is_control), "{message:?}");
}

#[test]
fn scenes_are_listed_and_printed_as_files_that_load() {
    let list = printed(&["scenes"]);
    for name in ["paper-nd3", "paper-nd4", "adhesive", "undamped"] {
        assert!(list.lines().any(|line| line.starts_with(name)), "{list}");
        let toml = printed(&["scenes", name]);
        assert!(rubscope_solver::scene::Scene::from_toml(&toml).is_ok(), "{toml}");
    }
}

#[test]
fn completions_and_manual_know_the_commands() {
    for shell in ["bash", "zsh", "fish", "elvish", "powershell"] {
        let text = printed(&["completions", shell]);
        assert!(text.contains("zeta-casing") && text.contains("rubscope"), "{shell}");
    }
    let page = printed(&["man"]);
    assert!(page.contains(".TH rubscope 1") && page.contains(".SH \"EXIT STATUS\""), "{page}");
    assert!(printed(&["man", "run"]).contains("\\-\\-samples"));
    // A command within a command has a page too.
    assert!(printed(&["man", "map", "merge"]).contains(".TH rubscope-map-merge 1"));
    assert!(refusal(&["man", "map", "part"]).contains("COMMAND = part: allowed is one of merge"));
    assert!(
        refusal(&["man", "run", "map"]).contains("COMMAND = map: allowed is nothing after run")
    );
}

#[test]
fn helps_name_every_contact_law_and_defaults_of_their_own_command() {
    for command in ["run", "hbm", "map", "margins", "precision"] {
        let help = printed(&[command, "--help"]);
        for law in ["unilateral: ", "bilateral: ", "smooth: "] {
            assert!(help.contains(law), "{command}: no {law}");
        }
        assert!(help.contains("default: paper-nd3"), "{command}");
    }
}

#[test]
fn the_manual_the_citation_and_the_package_have_the_version_and_date_of_the_change_log() {
    let changes = include_str!("../../CHANGELOG.md");
    let newest = changes.lines().find_map(|line| line.strip_prefix("## [")).unwrap();
    let (version, date) = newest.split_once("] - ").unwrap();
    assert_eq!(version, env!("CARGO_PKG_VERSION"));
    assert!(printed(&["man"]).contains(&format!(".TH rubscope 1 {date} ")));
    let citation = include_str!("../../CITATION.cff");
    assert!(citation.contains(&format!("\nversion: {version}\ndate-released: {date}\n")));
}

#[test]
fn every_manual_page_has_a_full_title_line_and_a_name_section() {
    let refused = refusal(&["man", "nothing"]);
    let names = refused.split("one of ").nth(1).unwrap().split(", ");
    let pages = names.map(Some).chain([None]);
    for name in pages {
        let page = name.map_or_else(|| printed(&["man"]), |name| printed(&["man", name]));
        let title = name.map_or("rubscope".to_string(), |name| format!("rubscope-{name}"));
        // Title, section, date, source and manual, as man-pages(7) has them.
        let line = page.lines().find(|line| line.starts_with(".TH ")).unwrap();
        let rest = line.strip_prefix(&format!(".TH {title} 1 ")).unwrap();
        let (date, rest) = rest.split_once(' ').unwrap();
        let digits = date.split('-').map(|part| part.parse::<u32>().is_ok().then_some(part.len()));
        assert_eq!(digits.collect::<Vec<_>>(), [Some(4), Some(2), Some(2)], "{line}");
        let source = concat!("\"rubscope ", env!("CARGO_PKG_VERSION"), "\"");
        assert_eq!(rest, format!("{source} \"rubscope manual\""), "{line}");
        let mut lines = page.lines().skip_while(|line| *line != ".SH NAME").skip(1);
        let said = lines.next().unwrap();
        let start = format!("{} \\- ", title.replace('-', "\\-"));
        assert!(said.starts_with(&start) && said.len() > start.len() + 10, "{said}");
    }
}

#[test]
fn the_ranges_of_a_map_and_of_a_sweep_are_in_their_help() {
    let help = printed(&["map", "--help"]);
    let line = |option: &str| {
        let found = help.lines().find(|line| line.trim_start().starts_with(option));
        found.unwrap_or_else(|| panic!("no {option} in {help}")).to_string()
    };
    for option in ["--x", "--y"] {
        let forms = "PATH=FROM:TO:COUNT or PATH=log:FROM:TO:COUNT";
        assert!(line(option).contains(forms), "{}", line(option));
    }
    for option in ["--speed", "--pulse"] {
        assert!(line(option).contains("<FROM:TO:COUNT>"), "{}", line(option));
    }
    assert!(printed(&["hbm", "--help"]).contains("or speeds as FROM:TO:COUNT"));
    // The other commands take one speed.
    assert!(!printed(&["run", "--help"]).contains("FROM:TO:COUNT"));
}

#[test]
fn a_closed_pipe_ends_the_program_quietly() {
    let program = env!("CARGO_BIN_EXE_rubscope");
    for arguments in [&["scenes", "paper-nd3"][..], &["completions", "bash"], &["--help"]] {
        let mut child = Command::new(program)
            .args(arguments)
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let mut message = String::new();
        child.stderr.take().unwrap().read_to_string(&mut message).unwrap();
        let status = child.wait().unwrap();
        assert_eq!(message, "", "{arguments:?}");
        // 128 + SIGPIPE, or 0 where everything was written before the pipe closed.
        assert!(matches!(status.code(), Some(0 | 141)), "{arguments:?}: {status}");
    }
}
