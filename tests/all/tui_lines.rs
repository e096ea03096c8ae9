//! The explorer in lines, as a program: commands by a pipe, answers on standard output.

use std::io::{BufRead, BufReader, Write};
use std::process::{Child, Stdio};

use crate::cli_support::program;

fn start(arguments: &[&str]) -> Child {
    let mut command = program();
    command.args(["--lines", "--set", "solver.step_s=2e-7", "--end", "20e-3"]).args(arguments);
    command.env("LC_ALL", "C.UTF-8").env("TERM", "dumb");
    command.stdin(Stdio::piped()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap()
}

/// What the program says to these lines, and its exit status.
fn told(arguments: &[&str], input: &[u8]) -> (String, Option<i32>) {
    let mut child = start(arguments);
    child.stdin.take().unwrap().write_all(input).unwrap();
    let output = child.wait_with_output().unwrap();
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
    (String::from_utf8(output.stdout).unwrap(), output.status.code())
}

#[test]
fn commands_by_a_pipe_are_answered_until_the_input_ends() {
    let lines = b"speed 400\npulse 20k\nlaw unilateral\nend\nrange 7000:12000\n";
    let (text, status) = told(&[], lines);
    assert_eq!(status, Some(0));
    for words in [
        "LOCKED",
        "ADHESIVE",
        "changed: speed Ω 500 rad/s -> 400 rad/s",
        "changed: pulse F 1 MN -> 20 kN",
        "changed: contact bilateral -> unilateral",
        "done: paused at 20",
        "Was it rpm? Then write 7000rpm:12000rpm.",
    ] {
        assert!(text.contains(words), "no {words} in {text}");
    }
    // The last line needs no end.
    assert!(told(&["rub"], b"quit").0.contains("NOW"));
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

#[test]
fn a_scene_is_saved_by_a_line_and_no_file_is_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mine.toml");
    let save = format!("save {}\n", path.display());
    let (text, _) = told(&[], format!("speed 450\n{save}{save}").as_bytes());
    assert!(text.contains("written: ") && text.contains("exists"), "{text}");
    let scene = rubscope_solver::scene::Scene::load(path.to_str().unwrap()).unwrap();
    assert_eq!(scene.operation.speed_rad_s, 450.0);
}
