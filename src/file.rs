//! Writing files completely or not at all, and reading them within a limit.
//!
//! The content goes to a hidden file in the same folder, which gets the name once it is
//! complete and on the disk. A signal can leave the hidden file, never half of a named one.

use std::fs::{File, Metadata, Permissions};
use std::io::{BufWriter, Error, ErrorKind, Result, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::Path;

pub use rubscope_solver::scene::{read_bytes, read_text};
use tempfile::NamedTempFile;

/// Outcome of writing a file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Written {
    /// Nothing was replaced: there was no file at the path, or it is a device or a pipe.
    New,
    /// An existing file was replaced.
    Replaced,
}

/// Returns the ending of a file's name in lower case, if it is one of `endings`.
pub fn ending(path: &Path, endings: &[&'static str]) -> Option<&'static str> {
    let given = path.extension()?;
    endings.iter().find(|known| given.eq_ignore_ascii_case(known)).copied()
}

/// Writes a file with what `write` writes, completely or not at all. A file at `path` is replaced:
/// its mode stays, and links to it are followed. A device or a pipe is written to directly.
///
/// # Errors
/// The system or `write` returned an error, the file at `path` is read-only, `path` is a link to
/// nothing, or no file can be created in its folder. What is at `path` is then unchanged.
pub fn replace(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<Written> {
    let Some(old) = existing(path)? else {
        complete(path, None, write)?.persist(path)?;
        return Ok(Written::New);
    };
    if !old.is_file() {
        return fill(File::options().append(true).open(path)?, write).map(|()| Written::New);
    }
    let path = path.canonicalize()?;
    complete(&path, Some(old.permissions()), write)?.persist(&path)?;
    Ok(Written::Replaced)
}

/// Creates a file with what `write` writes, completely or not at all. Replaces nothing.
///
/// # Errors
/// `AlreadyExists` if there is anything at `path`, even if it appeared while `write` was running;
/// otherwise the error of the system or of `write`.
pub fn create(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    if path.symlink_metadata().is_ok() {
        let exists = format!("{} exists", path.display());
        return Err(Error::new(ErrorKind::AlreadyExists, exists));
    }
    complete(path, None, write)?.persist_noclobber(path)?;
    Ok(())
}

/// Checks that a file can be written at `path`, by creating a hidden file next to it and removing
/// it.
///
/// # Errors
/// The folder does not exist, is not a folder, or no file can be created in it; or `path` is a
/// folder, a read-only file or a link to nothing.
pub fn check_place(path: &Path) -> Result<()> {
    match existing(path)? {
        Some(old) if old.is_file() => beside(&path.canonicalize()?, None).map(drop),
        Some(_) => Ok(()),
        None => beside(path, None).map(drop),
    }
}

/// Returns the metadata of what is at `path`, with links followed; `None` if there is nothing.
/// Refuses an empty path, a folder, a read-only file and a link to nothing.
fn existing(path: &Path) -> Result<Option<Metadata>> {
    if path.as_os_str().is_empty() {
        return Err(Error::new(ErrorKind::InvalidInput, "the name is empty"));
    }
    let old = match path.metadata() {
        Ok(old) => old,
        // A new file would take the place of a link to nothing.
        Err(error) if error.kind() == ErrorKind::NotFound && path.is_symlink() => {
            return Err(Error::new(error.kind(), "it is a link to a file that does not exist"));
        }
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
        Err(error) => return Err(error),
    };
    if old.is_dir() {
        return Err(ErrorKind::IsADirectory.into());
    }
    // A superuser could replace it nevertheless, but the mode says that the owner does not want it.
    if old.permissions().readonly() {
        return Err(Error::new(ErrorKind::PermissionDenied, "the file is read-only"));
    }
    Ok(Some(old))
}

/// Creates the hidden file in the folder of `path`, with the mode of the file that it will replace;
/// without one, with the usual mode of a new file.
fn beside(path: &Path, mode: Option<Permissions>) -> Result<NamedTempFile> {
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new("."));
    if path.as_os_str().as_encoded_bytes().ends_with(b"/") {
        return Err(ErrorKind::IsADirectory.into());
    }
    // If the folder is missing, `metadata` returns the system's own error.
    if !folder.metadata()?.is_dir() {
        return Err(ErrorKind::NotADirectory.into());
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".rubscope-").permissions(mode.unwrap_or(Permissions::from_mode(0o666)));
    // The error of `tempfile` names the hidden file, which says nothing to the user.
    builder.tempfile_in(folder).map_err(|error| error.kind().into())
}

/// Writes the hidden file and waits until it is on the disk.
fn complete(
    path: &Path,
    mode: Option<Permissions>,
    write: impl FnOnce(&mut dyn Write) -> Result<()>,
) -> Result<NamedTempFile> {
    let file = beside(path, mode.clone())?;
    fill(file.as_file(), write)?;
    // Creating the file has cleared the bits of the umask, so the old mode is set again.
    mode.map_or(Ok(()), |mode| file.as_file().set_permissions(mode))?;
    file.as_file().sync_all()?;
    Ok(file)
}

fn fill(file: impl Write, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let mut out = BufWriter::new(file);
    write(&mut out)?;
    out.flush()
}
