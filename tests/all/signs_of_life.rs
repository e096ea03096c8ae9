//! While a command is at work, a line on its terminal moves, and Ctrl-C ends it: every
//! command on every built-in scene either has ended or shows the line.

use std::io::{BufRead, BufReader};
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

use rubscope_solver::scene::BUILTIN;

use crate::pty_support::{Start, Terminal};

/// Every command that computes; SCENE is its scene.
const COMMANDS: [&str; 7] = [
    "run SCENE --out h.csv",
    "hbm SCENE --speed 0:1000:2000",
    "margins SCENE",
    "margins SCENE --target touching_pulse=1e4 --by casing.damping_ratio",
    "precision SCENE --repeat 1",
    "map SCENE --speed 300:500:30 --pulse 1e4:1e6:30 --out m.csv",
    "map SCENE --speed 300:500:30 --pulse 1e4:1e6:30",
];

/// Of these the line must be seen: in any build they take many seconds.
const LONG: [&str; 5] = [
    "map undamped --solver event --model rigid --end 1e6 --speed 300:500:2 --pulse 1e4:2e4:2",
    "run undamped --solver event --model rigid --end 1e6",
    "precision undamped --repeat 1000 --set solver.end_s=20",
    "figures --out .",
    "map --speed 300:500:3000 --pulse 1e4:1e6:3000 --out m.csv",
];

fn is_seen(screen: &vt100::Screen) -> bool {
    screen.contents().contains(|c: char| ('\u{2801}'..='\u{28ff}').contains(&c))
}

fn start(command: &str, folder: &Path) -> Terminal {
    let words: Vec<&str> = command.split(' ').collect();
    Start::command(&words).folder(folder).size(120, 40).open()
}

/// Presses Ctrl-C, which ends it as the signal does, unless it has just ended.
fn interrupt(mut terminal: Terminal, command: &str) {
    terminal.send("\u{3}");
    let status = terminal.ended();
    let code = status.exit_code();
    assert!(status.signal().is_some() || [0, 130].contains(&code), "{command}: {status:?}");
}

#[test]
fn every_command_on_every_scene_ends_or_shows_that_it_is_alive() {
    std::thread::scope(|threads| {
        for command in COMMANDS {
            threads.spawn(move || {
                for scene in BUILTIN {
                    let folder = tempfile::tempdir().unwrap();
                    let command = command.replace("SCENE", scene.name);
                    let mut terminal = start(&command, folder.path());
                    if terminal.ends_before(is_seen) {
                        // Nothing of the line stays.
                        assert!(!is_seen(terminal.parser.screen()), "{command}");
                    } else {
                        interrupt(terminal, &command);
                    }
                }
            });
        }
    });
}

#[test]
fn what_takes_long_shows_that_it_is_alive() {
    for command in LONG {
        let folder = tempfile::tempdir().unwrap();
        let mut terminal = start(command, folder.path());
        assert!(!terminal.ends_before(is_seen), "{command} showed nothing");
        // There is no rate before the first part is done.
        assert!(!terminal.text().contains(" 0/s"), "{command}: {}", terminal.text());
        interrupt(terminal, command);
    }
}

#[test]
fn into_a_pipe_long_work_says_how_far_it_is_every_ten_seconds() {
    let mut command = crate::cli_support::program();
    command.args(LONG[0].split(' ')).stderr(Stdio::piped()).stdout(Stdio::null());
    let began = Instant::now();
    let mut child = command.spawn().unwrap();
    let lines = BufReader::new(child.stderr.take().unwrap()).lines();
    let told: Vec<String> = lines.map(Result::unwrap).take(2).collect();
    child.kill().unwrap();
    child.wait().unwrap();
    assert_eq!(told, [10, 20].map(|after| format!("rubscope: at work, 0 % after {after} s")));
    assert!(began.elapsed() >= Duration::from_secs(20));
}

#[test]
fn a_refusal_stands_alone() {
    let folder = tempfile::tempdir().unwrap();
    for command in ["run --end 0", "run --none", "map --threads 0", "--set casing.damping_ratio=-1"]
    {
        let mut terminal = start(command, folder.path());
        assert_eq!(terminal.wait(), 2, "{command}");
        let text = terminal.text();
        assert!(text.starts_with("rubscope: "), "{text}");
        assert!(!is_seen(terminal.parser.screen()) && !text.contains("at work"), "{text}");
    }
}
