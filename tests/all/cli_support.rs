//! Runs the program for the tests of its command line.

use std::ffi::OsStr;
use std::process::{Command, Output};

/// The program, as a command that hears every signal.
pub fn program() -> Command {
    hearing(env!("CARGO_BIN_EXE_rubscope"))
}

/// A command that hears every signal. Tests that were started by `nohup`, or with `&` in
/// a script, ignore some; what they start would too, and a shell cannot change that. A
/// signal that is caught here is the usual one there, and still does nothing here.
pub fn hearing(program: impl AsRef<OsStr>) -> Command {
    static ONCE: std::sync::Once = std::sync::Once::new();
    ONCE.call_once(|| {
        let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
        let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
        let ignored = ignored.map_or(0, |set| u64::from_str_radix(set.trim(), 16).unwrap());
        for signal in [1, 2, 3, 15].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 1) {
            signal_hook::flag::register(signal, std::sync::Arc::default()).unwrap();
        }
    });
    Command::new(program)
}

/// Runs `rubscope` with these arguments and captures its output.
pub fn rubscope(arguments: &[&str]) -> Output {
    program().args(arguments).output().unwrap()
}

/// The words of a command line.
pub fn words(line: &str) -> Vec<&str> {
    line.split_whitespace().collect()
}

/// What a command that must succeed prints.
pub fn text(arguments: &[&str]) -> String {
    String::from_utf8(ended(program().args(arguments), 0).stdout).unwrap()
}

/// The same of a command that prints JSON.
pub fn json(arguments: &[&str]) -> serde_json::Value {
    serde_json::from_str(&text(arguments)).unwrap()
}

/// Runs a command, which must end with this status.
pub fn ended(command: &mut Command, status: i32) -> Output {
    let output = command.output().unwrap();
    let said = String::from_utf8_lossy(&output.stderr);
    assert_eq!(output.status.code(), Some(status), "{command:?} said {said}");
    output
}

/// The one-line error of a command for refused input.
pub fn refusal(arguments: &[&str]) -> String {
    let output = rubscope(arguments);
    let message = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(2), "{arguments:?} said {message}");
    assert!(output.stdout.is_empty(), "{arguments:?} wrote to standard output");
    assert_eq!(message.lines().count(), 1, "{message}");
    message.trim_end().to_string()
}
