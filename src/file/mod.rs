//! Writing files completely or not at all, and reading them within a limit.
//!
//! A new file is written under no name (Linux) or a hidden one, and takes its
//! place when it is complete and on the disk. So a full disk, a failure or a kill
//! leaves the file that was there before, and no other.

mod place;
mod temporary;

use std::fs::File;
use std::io::{BufWriter, Error, ErrorKind, Result, Write};
use std::path::Path;

use place::Place;
pub use place::check_place;
pub use rubscope_solver::scene::read_text;
pub use temporary::settle;
use temporary::{PRIVATE, Temporary, USUAL};

/// Outcome of writing a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    /// There was no file, or it is a device or a pipe.
    New,
    /// A file was replaced.
    Replaced,
}

/// Replaces the file at `path`, if there is one, by what `write` writes,
/// completely or not at all.
///
/// Mode and, as far as permitted, owner stay; links are followed and stay links.
/// Other hard links keep the old content. A device or a pipe is written to directly.
///
/// # Errors
/// An error of the system or of `write`, a file that is read-only, or a folder that
/// takes no file; what was there is then unchanged.
pub fn replace(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<Written> {
    let (path, replaced) = match Place::of(path)? {
        Place::Stream(path) => {
            fill(&place::open_stream(&path)?, write)?;
            return Ok(Written::New);
        }
        Place::New(path) => (path, None),
        Place::Existing { path, metadata } => (path, Some(metadata)),
    };
    let replaced = replaced.as_ref();
    let temporary = Temporary::beside(&path, replaced, USUAL)?;
    fill(temporary.file(), write)?;
    temporary.finish(replaced)?;
    temporary.replace(&path)?;
    Ok(if replaced.is_some() { Written::Replaced } else { Written::New })
}

/// Creates a file, completely or not at all.
///
/// # Errors
/// `AlreadyExists` where there is anything of this name, also if it came while
/// `write` was at work; an error of the system or of `write`.
pub fn create(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    create_with(path, USUAL, write)
}

/// Same as [`create`], for the user alone: others can never read the file.
///
/// # Errors
/// As `create`.
pub fn create_private(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    create_with(path, PRIVATE, write)
}

fn create_with(
    path: &Path,
    mode: u32,
    write: impl FnOnce(&mut dyn Write) -> Result<()>,
) -> Result<()> {
    if path.symlink_metadata().is_ok() {
        let exists = format!("{} exists", path.display());
        return Err(Error::new(ErrorKind::AlreadyExists, exists));
    }
    let (Place::New(path) | Place::Stream(path) | Place::Existing { path, .. }) = Place::of(path)?;
    let temporary = Temporary::beside(&path, None, mode)?;
    fill(temporary.file(), write)?;
    temporary.finish(None)?;
    temporary.create(&path)
}

fn fill(file: &File, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let mut out = BufWriter::new(file);
    write(&mut out)?;
    out.flush()
}
