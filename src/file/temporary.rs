//! The file that is written before it takes its place. On Linux it has no name
//! until it is complete, so that not even a kill leaves it behind.

use std::fs::{File, Metadata};
use std::io::{ErrorKind, Result};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use tempfile::NamedTempFile;

use super::{in_place, place};

/// Hidden files of this program that have a name at this moment.
static NAMED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn named() -> MutexGuard<'static, Vec<PathBuf>> {
    NAMED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Removes what unfinished writing would leave behind; for a program that ends
/// while another thread writes. Files without a name need no removal.
pub fn remove_temporaries() {
    for path in named().drain(..) {
        // It may just have taken its place.
        let _ = std::fs::remove_file(path);
    }
}

/// A hidden name that `remove_temporaries` knows.
pub(super) struct Hidden(PathBuf);

impl Hidden {
    fn new(path: PathBuf) -> Self {
        named().push(path.clone());
        Self(path)
    }
}

impl Drop for Hidden {
    fn drop(&mut self) {
        named().retain(|path| *path != self.0);
    }
}

pub(super) enum Temporary {
    #[cfg(target_os = "linux")]
    Unnamed(File),
    Named(NamedTempFile, Hidden),
}

impl Temporary {
    /// A file in the folder of `path`, with mode and owner of the file that it is
    /// to replace, or those of a new file.
    pub(super) fn beside(path: &Path, replaced: Option<&Metadata>) -> Result<Self> {
        let folder = place::folder(path);
        // A folder that is missing has the same word for every kind of file.
        if !folder.metadata()?.is_dir() {
            return Err(ErrorKind::NotADirectory.into());
        }
        #[cfg(target_os = "linux")]
        let temporary = match unnamed::open(folder) {
            Ok(file) => Self::Unnamed(file),
            Err(_) => Self::with_name(folder, replaced)?,
        };
        #[cfg(not(target_os = "linux"))]
        let temporary = Self::with_name(folder, replaced)?;
        if let Some(replaced) = replaced {
            keep_owner(temporary.file(), replaced);
            temporary.file().set_permissions(replaced.permissions())?;
        }
        Ok(temporary)
    }

    fn with_name(folder: &Path, replaced: Option<&Metadata>) -> Result<Self> {
        let mut builder = tempfile::Builder::new();
        let prefix = format!(".rubscope-{}-", std::process::id());
        builder.prefix(&prefix);
        #[cfg(unix)]
        {
            use std::os::unix::fs::PermissionsExt;
            // Never more readable than what it replaces.
            let new = std::fs::Permissions::from_mode(0o666);
            builder.permissions(replaced.map_or(new, Metadata::permissions));
        }
        #[cfg(not(unix))]
        let _ = replaced;
        let file = builder.tempfile_in(folder)?;
        let hidden = Hidden::new(file.path().to_path_buf());
        Ok(Self::Named(file, hidden))
    }

    pub(super) fn file(&self) -> &File {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => file,
            Self::Named(file, _) => file.as_file(),
        }
    }

    pub(super) fn sync(&self) -> Result<()> {
        self.file().sync_all()
    }

    /// Puts the file at `path`, where there must be none.
    pub(super) fn create(self, path: &Path) -> Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => unnamed::link(&file, path)?,
            Self::Named(file, _hidden) => drop(file.persist_noclobber(path)?),
        }
        sync_folder(path);
        Ok(())
    }

    /// Puts the file at `path`, in place of another where there is one.
    pub(super) fn replace(self, path: &Path) -> Result<()> {
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => match unnamed::link(&file, path) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                    unnamed::rename(&file, path)?;
                }
                linked => linked?,
            },
            Self::Named(file, _hidden) => match file.persist(path) {
                Err(failed) if is_mounted(&failed.error) => {
                    in_place::exchange(failed.file.as_file(), path)?;
                }
                persisted => drop(persisted?),
            },
        }
        sync_folder(path);
        Ok(())
    }
}

/// Whether the place is a file that is mounted there, which cannot be renamed.
fn is_mounted(error: &std::io::Error) -> bool {
    matches!(error.kind(), ErrorKind::ResourceBusy | ErrorKind::CrossesDevices)
}

/// The owner stays as far as this is permitted.
#[cfg(unix)]
fn keep_owner(file: &File, replaced: &Metadata) {
    use std::os::unix::fs::{MetadataExt, fchown};
    let (owner, group) = (Some(replaced.uid()), Some(replaced.gid()));
    if fchown(file, owner, group).is_err() {
        let _ = fchown(file, None, group);
    }
}

#[cfg(not(unix))]
fn keep_owner(_: &File, _: &Metadata) {}

/// The new name itself is on the disk after this. Not every file system can do
/// it, and the file is already in its place.
fn sync_folder(path: &Path) {
    let _ = File::open(place::folder(path)).and_then(|folder| folder.sync_all());
}

#[cfg(target_os = "linux")]
mod unnamed {
    use std::os::fd::AsRawFd;
    use std::os::unix::fs::OpenOptionsExt;
    use std::sync::atomic::{AtomicU64, Ordering};

    use rustix::fs::{AtFlags, CWD, OFlags};

    use super::*;

    /// Numbers the hidden names of this program.
    static NEXT: AtomicU64 = AtomicU64::new(0);

    /// A file without a name, which can get one later.
    pub(super) fn open(folder: &Path) -> Result<File> {
        // The descriptor is named through it later.
        Path::new("/proc/self/fd").metadata()?;
        let flags = i32::try_from(OFlags::TMPFILE.bits()).map_err(|_| ErrorKind::Unsupported)?;
        File::options().read(true).write(true).mode(0o666).custom_flags(flags).open(folder)
    }

    pub(super) fn link(file: &File, path: &Path) -> Result<()> {
        let open = format!("/proc/self/fd/{}", file.as_raw_fd());
        Ok(rustix::fs::linkat(CWD, open, CWD, path, AtFlags::SYMLINK_FOLLOW)?)
    }

    /// Replaces another file: the system can do this only with a file that has a
    /// name, so it has a hidden one from one call to the next.
    pub(super) fn rename(file: &File, path: &Path) -> Result<()> {
        loop {
            let number = NEXT.fetch_add(1, Ordering::Relaxed);
            let name = format!(".rubscope-{}-{number}", std::process::id());
            let hidden = Hidden::new(place::folder(path).join(name));
            match link(file, &hidden.0) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => continue,
                linked => linked?,
            }
            let renamed = std::fs::rename(&hidden.0, path);
            if renamed.is_err() {
                let _ = std::fs::remove_file(&hidden.0);
            }
            return match renamed {
                Err(error) if is_mounted(&error) => in_place::exchange(file, path),
                renamed => renamed,
            };
        }
    }
}
