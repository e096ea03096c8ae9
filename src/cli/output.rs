//! Output files of the commands: the format follows from the file ending.

use std::io::Write;
use std::path::Path;

use super::status::{Refusal, say};
use crate::file::{self, Written};
use anyhow::Context;

/// Returns the ending of `path`, which must be in `endings`, and checks that a file can be written.
///
/// # Errors
/// The ending is another one, or no file can be written at `path`.
pub fn format(
    path: Option<&Path>,
    endings: &[&'static str],
) -> anyhow::Result<Option<&'static str>> {
    let Some(path) = path else { return Ok(None) };
    let given = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    let Some(known) = endings.iter().find(|known| known.eq_ignore_ascii_case(given)) else {
        let names: Vec<String> = endings.iter().map(|known| format!(".{known}")).collect();
        let listed = match names.split_last() {
            Some((last, [])) => last.clone(),
            Some((last, others)) => format!("{} or {last}", others.join(", ")),
            None => String::new(),
        };
        let allowed = format!("a file name ending in {listed}");
        return Err(Refusal::of("--out", path.display(), allowed).into());
    };
    try_place(path)?;
    Ok(Some(known))
}

/// Checks that a file can be written at `path`.
///
/// # Errors
/// The reason why it cannot be written.
pub fn try_place(path: &Path) -> anyhow::Result<()> {
    file::check_place(path).with_context(|| format!("cannot write {}", path.display()))
}

/// Writes a file, completely or not at all, and prints `what` it contains and whether it replaced
/// another. If it cannot be written, its text goes to standard output, so that the result of a
/// long computation is not lost.
///
/// # Errors
/// The file could not be written.
pub fn save(
    path: &Path,
    what: &str,
    out: &mut dyn Write,
    content: impl Fn(&mut dyn Write) -> std::io::Result<()>,
) -> anyhow::Result<()> {
    let written = replace_or_print(path, out, &content)?;
    say_written(written, what, &path.display());
    Ok(())
}

/// Writes a file. If that fails, `text` goes to standard output.
///
/// # Errors
/// The file could not be written.
pub fn replace_or_print(
    path: &Path,
    out: &mut dyn Write,
    content: &dyn Fn(&mut dyn Write) -> std::io::Result<()>,
) -> anyhow::Result<Written> {
    // `path` may be standard output itself: what was printed before must come first.
    out.flush()?;
    file::replace(path, content)
        .map_err(|error| print_instead(path, error, "its text is on standard output", out, content))
}

/// Prints the content of a file that could not be written, and returns the error, which also says
/// if printing failed.
pub fn print_instead(
    path: &Path,
    error: std::io::Error,
    kept: &str,
    out: &mut dyn Write,
    print: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> anyhow::Error {
    let shown = path.display();
    match print(out).and_then(|()| out.flush()) {
        Ok(()) => anyhow::Error::from(error).context(format!("cannot write {shown}; {kept}")),
        Err(other) => {
            anyhow::anyhow!("cannot write {shown}: {error}; nor standard output: {other}")
        }
    }
}

/// Reports a written file on standard error.
pub fn say_written(written: Written, what: &str, shown: &impl std::fmt::Display) {
    say(&match written {
        Written::New => format!("rubscope: wrote {what} to {shown}"),
        Written::Replaced => format!("rubscope: replaced {shown} ({what})"),
    });
}

/// Makes a write beyond the file size limit (`ulimit -f`) fail with an error. By default SIGXFSZ
/// ends the program.
pub fn outlive_size_limit() {
    let seen = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
    // If the handler cannot be installed, only this limit is affected.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, seen);
}
