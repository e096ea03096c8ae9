//! Where a file can be written, and what is there already.

use std::fs::{File, Metadata};
use std::io::{Error, ErrorKind, Result};
use std::path::{MAIN_SEPARATOR, Path, PathBuf};

use super::temporary::{Temporary, USUAL};

/// Most links from one to the next that are followed, as in the system.
const MOST_LINKS: usize = 40;

/// File that a path names, with links followed.
pub(super) enum Place {
    /// A device, a pipe or an open file of this program: written to directly.
    Stream(PathBuf),
    /// No file yet.
    New(PathBuf),
    /// A file that may be replaced.
    Existing { path: PathBuf, metadata: Metadata },
}

impl Place {
    /// # Errors
    /// No file can have this name, or the file is read-only.
    pub(super) fn of(path: &Path) -> Result<Self> {
        let name = path.as_os_str().to_string_lossy();
        if name.is_empty() {
            return Err(Error::new(ErrorKind::InvalidInput, "the name is empty"));
        }
        if name.ends_with(MAIN_SEPARATOR) || path.file_name().is_none() {
            return Err(Error::from(ErrorKind::IsADirectory));
        }
        let metadata = match path.metadata() {
            Ok(metadata) => metadata,
            Err(error) if error.kind() == ErrorKind::NotFound => {
                return Ok(Self::New(follow(path)?));
            }
            Err(error) => return Err(error),
        };
        if metadata.is_dir() {
            return Err(Error::from(ErrorKind::IsADirectory));
        }
        if let Some(open) = open_here(path) {
            return Ok(Self::Stream(open));
        }
        if !metadata.is_file() {
            return Ok(Self::Stream(path.to_path_buf()));
        }
        // A superuser could replace it all the same: the mode says what is wanted.
        if metadata.permissions().readonly() {
            return Err(Error::new(ErrorKind::PermissionDenied, "the file is read-only"));
        }
        // A folder may allow to replace a file that itself allows no writing.
        File::options().append(true).open(path)?;
        Ok(Self::Existing { path: path.canonicalize()?, metadata })
    }
}

/// Tries whether a file can be written there; nothing that is tried stays.
///
/// # Errors
/// The folder does not exist, is none or takes no file; the path is a folder, or
/// a file that is read-only.
pub fn check_place(path: &Path) -> Result<()> {
    match Place::of(path)? {
        Place::Stream(_) => Ok(()),
        Place::New(path) | Place::Existing { path, .. } => {
            Temporary::beside(&path, None, USUAL).map(drop)
        }
    }
}

/// Returns the folder of a file.
pub(super) fn folder(path: &Path) -> &Path {
    path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// Returns the file that links which lead nowhere would create.
fn follow(path: &Path) -> Result<PathBuf> {
    let mut path = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        match path.read_link() {
            Ok(target) => path = folder(&path).join(target),
            Err(_) => return Ok(path),
        }
    }
    Err(Error::other("too many links"))
}

/// Returns the last link of a path that stands for a file that this program has open, as
/// `/dev/stdout` does: another file of that name would not reach its reader.
fn open_here(path: &Path) -> Option<PathBuf> {
    let mut path = path.to_path_buf();
    for _ in 0..MOST_LINKS {
        if path.starts_with("/proc") || path.starts_with("/dev/fd") {
            return Some(path);
        }
        match path.read_link() {
            Ok(target) => path = folder(&path).join(target),
            Err(_) => return None,
        }
    }
    None
}

/// Opens what is written to directly. Standard output goes on where it is: opened
/// again, a file behind it would be written from its start.
pub(super) fn open_stream(path: &Path) -> Result<File> {
    if path.file_name().is_some_and(|name| name == "1")
        && (path.starts_with("/proc/self/fd") || path.starts_with("/dev/fd"))
    {
        use std::os::fd::AsFd;
        return Ok(File::from(std::io::stdout().as_fd().try_clone_to_owned()?));
    }
    File::options().append(true).open(path)
}
