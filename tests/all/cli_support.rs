//! Runs the program for the tests of its command line.

use std::process::Output;

/// Runs `rubscope` with these arguments and captures its output.
pub fn rubscope(arguments: &[&str]) -> Output {
    assert_cmd::cargo::cargo_bin_cmd!("rubscope").args(arguments).output().unwrap()
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
