//! What commands write besides their data: files in the format of their ending.

use std::io::Write;
use std::path::Path;

use super::status::{Refusal, say};
use crate::file::{self, Written};
use anyhow::Context;

/// Returns the ending of the file of `--out`, if it is given: one of these. The place is tried.
///
/// # Errors
/// Another ending, or a path where no file can be written.
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

/// Tries whether a file can be written there.
///
/// # Errors
/// It cannot.
pub fn try_place(path: &Path) -> anyhow::Result<()> {
    file::check_place(path).with_context(|| format!("cannot write {}", path.display()))
}

/// Writes a file, completely or not at all, and prints what is in it, and whether
/// it replaced another. If it cannot be written, its text goes to standard output,
/// so that nothing computed is lost.
///
/// # Errors
/// An error of the system.
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

/// Writes a file; if that fails, its text goes to standard output.
///
/// # Errors
/// An error of the system.
pub fn replace_or_print(
    path: &Path,
    out: &mut dyn Write,
    content: &dyn Fn(&mut dyn Write) -> std::io::Result<()>,
) -> anyhow::Result<Written> {
    // The file may be standard output itself, and comes after what is there.
    out.flush()?;
    file::replace(path, content)
        .map_err(|error| print_instead(path, error, "its text is on standard output", out, content))
}

/// Returns the error of a file that could not be written, after what was meant for it was printed;
/// if that fails too, the error says so.
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

/// Says what is in a file that was written.
pub fn say_written(written: Written, what: &str, shown: &impl std::fmt::Display) {
    say(&match written {
        Written::New => format!("rubscope: wrote {what} to {shown}"),
        Written::Replaced => format!("rubscope: replaced {shown} ({what})"),
    });
}

/// Lets a write beyond the limit of file sizes fail, as on a full disk. Without
/// this the system ends the program there.
pub fn outlive_size_limit() {
    let seen = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
    // If it cannot be had, all else still works.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, seen);
}
