//! Exit status and messages: 0 done, 1 failed, 2 wrong usage or refused
//! input, 128 + n on signal n. Every message is one line on standard error.

use std::ffi::OsString;
use std::io::{ErrorKind, Write};
use std::sync::{Mutex, PoisonError};

use clap::error::ErrorKind as Usage;
use thiserror::Error;

use super::sign;
use crate::sheet::line::clean;
use rubscope_solver::scene::SceneError;

/// Result of a command: its exit status, or the error that prevented it.
pub type Done = anyhow::Result<Status>;

/// How a command ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Status {
    /// The command succeeded.
    Done,
    /// The computation failed; the output gives the reason.
    Failed,
    /// A signal with this number ended the command.
    Signal(u8),
}

/// Reason, in one line, why input that is not part of the scene is refused, such as an option.
#[derive(Debug, Error)]
#[error("{0}")]
pub struct Refusal(String);

impl Refusal {
    /// Refuses the `value` of `name` (an option or argument as typed), and says what is allowed.
    pub fn of(name: &str, value: impl std::fmt::Display, allowed: impl std::fmt::Display) -> Self {
        Self(SceneError::refused(name, value, allowed.to_string()).to_string())
    }

    /// Refuses the input with this reason.
    pub fn because(reason: impl Into<String>) -> Self {
        Self(reason.into())
    }
}

/// Signal number of SIGPIPE, which is the same on every Unix.
const BROKEN_PIPE: u8 = 13;

/// Prints the notes held back and the error of a command, if any; returns the exit status. If the
/// input was refused, the notes are dropped.
pub fn exit(done: Done) -> u8 {
    if done.is_ok() {
        say_noted();
    }
    let error = match done {
        Ok(Status::Done) => return 0,
        Ok(Status::Failed) => return 1,
        Ok(Status::Signal(number)) => return 128 + number,
        Err(error) => error,
    };
    let closed = |error: &std::io::Error| error.kind() == ErrorKind::BrokenPipe;
    if error.downcast_ref::<std::io::Error>().is_some_and(closed) {
        // The reader closed the output: end silently, as by SIGPIPE.
        return 128 + BROKEN_PIPE;
    }
    if error.is::<SceneError>() || error.is::<Refusal>() {
        // The notes describe a computation that does not take place.
        noted().clear();
        say(&format!("rubscope: {error:#}"));
        return 2;
    }
    say_noted();
    // File errors carry a context; a bare I/O error comes from standard output.
    let place = if error.chain().count() == 1 && error.is::<std::io::Error>() {
        "cannot write standard output: "
    } else {
        ""
    };
    say(&format!("rubscope: {place}{error:#}"));
    1
}

/// Notes held back until the input is known to be valid.
static NOTED: Mutex<Vec<String>> = Mutex::new(Vec::new());

fn noted() -> std::sync::MutexGuard<'static, Vec<String>> {
    NOTED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Adds a note, to be printed once the input is known to be valid. Repeated notes appear once.
pub fn note(line: String) {
    let mut noted = noted();
    if !noted.contains(&line) {
        noted.push(line);
    }
}

/// Prints the notes held back.
pub fn say_noted() {
    let lines = std::mem::take(&mut *noted());
    lines.iter().for_each(|line| say(line));
}

/// Handles what clap returns instead of a command: prints help or the version, or refuses the
/// command line in one line. Returns the exit status.
pub fn usage(error: &clap::Error, arguments: &[OsString]) -> u8 {
    match error.kind() {
        Usage::DisplayHelp | Usage::DisplayVersion => {
            exit(error.print().map(|()| Status::Done).map_err(Into::into))
        }
        _ => {
            let line = file(error, arguments).unwrap_or_else(|| in_one_line(&error.to_string()));
            say(&format!("rubscope: {line}"));
            2
        }
    }
}

/// Returns a message with a hint if clap refuses an unknown option and an argument looks like the
/// name of a file that begins with `-`; otherwise `None`.
fn file(error: &clap::Error, arguments: &[OsString]) -> Option<String> {
    let is_file = |name: &&str| {
        let has_ending = std::path::Path::new(name).extension().is_some();
        let is_value = name.contains('=') || name.parse::<f64>().is_ok();
        name.starts_with('-') && has_ending && !is_value
    };
    let name = arguments.iter().filter_map(|name| name.to_str()).find(is_file);
    let name = name.filter(|_| error.kind() == Usage::UnknownArgument)?;
    Some(format!("{name}: allowed is ./{name} for a file whose name begins with -"))
}

/// Returns the message of clap without its usage block, as one line.
fn in_one_line(message: &str) -> String {
    let kept: Vec<&str> = message
        .lines()
        .map(str::trim)
        .take_while(|line| !line.starts_with("Usage:") && !line.starts_with("For more"))
        .filter(|line| !line.is_empty() && !line.starts_with("tip: to pass"))
        .collect();
    let line = kept.join(" ");
    let line = line.strip_prefix("error: ").unwrap_or(&line);
    format!("{line} (see rubscope --help)")
}

/// Writes one line to standard error. A failure to write is ignored.
pub fn say(line: &str) {
    let _ = sign::aside(|| writeln!(std::io::stderr(), "{}", clean(line)));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn clap_messages_become_one_line() {
        let message = "error: invalid value 'x' for '--color <WHEN>'\n  [possible values: a, b]\n\n\
                       Usage: rubscope [SCENE]\n\nFor more information, try '--help'.\n";
        assert_eq!(
            in_one_line(message),
            "invalid value 'x' for '--color <WHEN>' [possible values: a, b] (see rubscope --help)"
        );
    }

    #[test]
    fn each_kind_of_ending_has_its_status() {
        assert_eq!(exit(Ok(Status::Done)), 0);
        assert_eq!(exit(Ok(Status::Failed)), 1);
        assert_eq!(exit(Ok(Status::Signal(2))), 130);
        assert_eq!(exit(Err(std::io::Error::from(ErrorKind::BrokenPipe).into())), 141);
        assert_eq!(exit(Err(Refusal::because("no").into())), 2);
        assert_eq!(exit(Err(anyhow::anyhow!("disk full"))), 1);
    }
}
