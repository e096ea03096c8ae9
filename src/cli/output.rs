//! What commands show and write besides their data: a progress bar, and files
//! in the format of their ending.

use std::io::Write;
use std::path::Path;

use anyhow::Context;
use indicatif::{ProgressBar, ProgressStyle};

use super::status::{Refusal, say};
use crate::file::{self, Written};

/// A progress bar on standard error of this length and form.
pub fn bar(length: u64, template: &str) -> ProgressBar {
    let bar = ProgressBar::new(length);
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style);
    }
    bar
}

/// The ending of a file given with `--out`, which must be one of these.
///
/// # Errors
/// Another ending, or a path where no file can be written.
pub fn format(path: &Path, endings: &[&'static str]) -> anyhow::Result<&'static str> {
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
    file::check_place(path).with_context(|| format!("cannot write {}", path.display()))?;
    Ok(known)
}

/// Writes a file, completely or not at all, and prints what is in it, and that it
/// replaced another.
///
/// # Errors
/// An error of the system.
pub fn save(
    path: &Path,
    what: &str,
    content: impl FnOnce(&mut dyn Write) -> std::io::Result<()>,
) -> anyhow::Result<()> {
    let shown = path.display();
    let written = file::replace(path, content).with_context(|| format!("cannot write {shown}"))?;
    say_written(written, what, &shown);
    Ok(())
}

/// Says what is in a file that was written.
pub fn say_written(written: Written, what: &str, shown: &impl std::fmt::Display) {
    say(&match written {
        Written::New => format!("rubscope: wrote {what} to {shown}"),
        Written::Replaced => format!("rubscope: replaced {shown} ({what})"),
    });
}
