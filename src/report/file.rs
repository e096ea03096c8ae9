//! Writes files through a temporary file in the same directory, so that a
//! failure never leaves half a file.

use std::ffi::OsString;
use std::fs::File;
use std::io::{BufWriter, Error, ErrorKind, Result, Write};
use std::path::{Path, PathBuf};

/// Replaces the file at `path` by what `write` writes, completely or not at
/// all. Links are followed; a device or a pipe is written to directly.
///
/// # Errors
/// An error of the system or of `write`; a file at `path` is then unchanged.
pub fn replace(path: &Path, write: impl FnOnce(&mut dyn Write) -> Result<()>) -> Result<()> {
    let path = &path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    if path.is_dir() {
        return Err(Error::from(ErrorKind::IsADirectory));
    }
    if path.exists() && !path.is_file() {
        let mut out = BufWriter::new(File::options().write(true).open(path)?);
        write(&mut out)?;
        return out.flush();
    }
    let temporary = beside(path);
    let written = File::create_new(&temporary).and_then(|file| {
        let mut out = BufWriter::new(file);
        write(&mut out)?;
        out.into_inner()?.sync_all()?;
        std::fs::rename(&temporary, path)
    });
    if written.is_err() {
        // The error that matters is the first one.
        let _ = std::fs::remove_file(&temporary);
    }
    written
}

/// Whether a file can be written there, as far as this is known without writing.
///
/// # Errors
/// The directory does not exist, or the path is a directory itself.
pub fn check_place(path: &Path) -> Result<()> {
    if path.is_dir() {
        return Err(Error::from(ErrorKind::IsADirectory));
    }
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    match parent.map(std::fs::metadata).transpose()? {
        Some(metadata) if !metadata.is_dir() => Err(Error::from(ErrorKind::NotADirectory)),
        _ => Ok(()),
    }
}

fn beside(path: &Path) -> PathBuf {
    let mut name = OsString::from(".");
    name.push(path.file_name().unwrap_or_default());
    name.push(format!(".{}.part", std::process::id()));
    path.with_file_name(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_failure_leaves_the_old_file_and_no_other() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("history.csv");
        replace(&path, |out| out.write_all(b"old")).unwrap();
        let failed = replace(&path, |out| {
            out.write_all(b"new")?;
            Err(Error::other("disk full"))
        });
        assert_eq!(failed.unwrap_err().to_string(), "disk full");
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(std::fs::read_dir(directory.path()).unwrap().count(), 1);
    }

    #[test]
    fn places_that_cannot_take_a_file() {
        let directory = tempfile::tempdir().unwrap();
        assert!(check_place(&directory.path().join("a.csv")).is_ok());
        assert!(check_place(Path::new("a.csv")).is_ok());
        assert!(check_place(&directory.path().join("none").join("a.csv")).is_err());
        assert!(check_place(directory.path()).is_err());
        assert!(replace(directory.path(), |_| Ok(())).is_err());
    }
}
