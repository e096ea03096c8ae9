//! The explorer in lines, as a program: each answer comes before the next line is read, and a
//! reader may leave. What it answers is in `tests/transcripts/lines.txt`.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Stdio};

use crate::cli_support::program;

fn start(arguments: &[&str]) -> Child {
    let mut command = program();
    command.args(["--lines", "--set", "solver.step_s=2e-7", "--end", "20e-3"]).args(arguments);
    command.env("LC_ALL", "C.UTF-8").env("TERM", "dumb");
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

#[test]
fn each_answer_is_there_before_the_next_line_is_asked_for() {
    let mut child = start(&[]);
    let (mut input, out) = (child.stdin.take().unwrap(), child.stdout.take().unwrap());
    let mut answers = BufReader::new(out).lines().map(Result::unwrap);
    assert!(answers.by_ref().take(3).any(|line| line.starts_with("help")));
    for speed in ["450", "440"] {
        writeln!(input, "speed {speed}").unwrap();
        let changed = answers.by_ref().find(|line| line.starts_with("changed")).unwrap();
        assert!(changed.ends_with(&format!("-> {speed} rad/s")), "{changed}");
    }
    drop(input);
    assert_eq!((answers.next(), child.wait().unwrap().code()), (None, Some(0)));
}

#[test]
fn a_reader_that_leaves_ends_it_without_a_word() {
    let mut child = start(&[]);
    drop(child.stdout.take());
    let mut input = child.stdin.take().unwrap();
    // The program may end before it has read all of this.
    let _ = input.write_all("speed 450\nspeed 440\n".repeat(20).as_bytes());
    drop(input);
    let output = child.wait_with_output().unwrap();
    assert_eq!(output.status.code(), Some(141));
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}
