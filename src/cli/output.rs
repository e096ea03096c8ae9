//! Where the result of a command goes: text or JSON on standard output, and a file whose format
//! follows from its ending.

use std::io::Write;
use std::path::{Path, PathBuf};

use anyhow::Context;
use clap::Args;

use super::status::{Done, Refusal, Status, say};
use crate::file::{self, Written};
use crate::sheet::Sheet;
use crate::sheet::line::listed;
use crate::sheet::table::Table;

/// Endings of the files that a result can be written to.
const ENDINGS: [&str; 3] = ["csv", "json", "svg"];

/// Where a command puts its result.
#[derive(Args, Debug)]
pub struct OutputOptions {
    /// Print the result as JSON
    #[arg(long)]
    json: bool,
    /// Write the result to FILE: .csv (the table), .svg (the picture) or .json
    #[arg(long, value_name = "FILE")]
    out: Option<PathBuf>,
}

impl OutputOptions {
    /// Returns the ending of the file, and checks that a file can be written there; `None` without
    /// a file.
    ///
    /// # Errors
    /// The ending is none of those of a result, or no file can be written.
    pub fn ending(&self) -> anyhow::Result<Option<&'static str>> {
        self.ending_among(&ENDINGS)
    }

    /// As [`Self::ending`], which must be one of `endings`.
    ///
    /// # Errors
    /// As `ending`.
    pub fn ending_among(&self, endings: &[&'static str]) -> anyhow::Result<Option<&'static str>> {
        let Some(path) = &self.out else { return Ok(None) };
        let Some(known) = file::ending(path, endings) else {
            let names = endings.iter().map(|known| format!(".{known}")).collect::<Vec<_>>();
            let is_bare = names.iter().any(|name| path.ends_with(name));
            let before = if is_bare { ", after a name" } else { "" };
            let allowed = format!("a file name ending in {}{before}", listed(&names, "or"));
            return Err(Refusal::of("--out", path.display(), allowed).into());
        };
        try_place(path)?;
        Ok(Some(known))
    }

    /// Writes the file of `--out`; prints the result as text, or as JSON with `--json`.
    ///
    /// # Errors
    /// Standard output or the file could not be written.
    pub fn deliver(&self, sheet: &Sheet, out: &mut dyn Write) -> Done {
        if self.json {
            sheet.write_json(true, out)?;
        }
        if let Some(ending) = self.out.as_deref().and_then(|path| file::ending(path, &ENDINGS)) {
            let rows = format!("{} rows", sheet.file().map_or(0, Table::len));
            self.save(&rows, out, |out| sheet.write_file(ending, out))?;
        }
        if !self.json {
            sheet.write_text(out)?;
        }
        Ok(Status::Done)
    }

    /// Writes `content`, described by `what`, to the file of `--out`, if there is one.
    ///
    /// # Errors
    /// The file could not be written.
    pub fn save(
        &self,
        what: &str,
        out: &mut dyn Write,
        content: impl Fn(&mut dyn Write) -> std::io::Result<()>,
    ) -> anyhow::Result<()> {
        let Some(path) = &self.out else { return Ok(()) };
        let shown = path.display();
        say(&match replace_or_print(path, out, &content)? {
            Written::New => format!("rubscope: wrote {what} to {shown}"),
            Written::Replaced => format!("rubscope: replaced {shown} ({what})"),
        });
        Ok(())
    }
}

/// Checks that a file can be written at `path`.
///
/// # Errors
/// No file can be written at `path`, for the reason in the message.
pub fn try_place(path: &Path) -> anyhow::Result<()> {
    file::check_place(path).with_context(|| format!("cannot write {}", path.display()))
}

/// Writes a file, completely or not at all. If that fails, its content goes to standard output.
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
    file::replace(path, content).map_err(|error| {
        let shown = path.display();
        match content(out).and_then(|()| out.flush()) {
            Ok(()) => {
                let message = format!("cannot write {shown}; its text is on standard output");
                anyhow::Error::from(error).context(message)
            }
            Err(other) => {
                anyhow::anyhow!("cannot write {shown}: {error}; nor standard output: {other}")
            }
        }
    })
}

/// Makes a write beyond the file size limit (`ulimit -f`) fail with an error. By default SIGXFSZ
/// ends the program.
pub fn outlive_size_limit() {
    let seen = std::sync::Arc::new(std::sync::atomic::AtomicBool::new(false));
    // If the handler cannot be installed, only this limit is affected.
    let _ = signal_hook::flag::register(signal_hook::consts::SIGXFSZ, seen);
}
