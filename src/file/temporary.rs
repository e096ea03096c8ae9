//! The file that is written before it takes its place. On Linux it has no name
//! until it is complete, so that not even a kill leaves it behind.

use std::fs::{File, Metadata};
use std::io::{Error, ErrorKind, Result};
use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError, TryLockError};
use std::time::{Duration, Instant};

use tempfile::NamedTempFile;

use super::place;

/// Hidden files of this program that have a name at this moment.
static NAMED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn named() -> MutexGuard<'static, Vec<PathBuf>> {
    NAMED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The modes of a new file, of which the system takes its mask: one as any other, and one
/// for the user alone.
pub(super) const USUAL: u32 = 0o666;
pub(super) const PRIVATE: u32 = 0o600;

/// Held while a complete file takes its place.
static PLACING: Mutex<()> = Mutex::new(());

/// Locks the placing of files: until the guard is dropped, [`settle`] waits.
fn placing() -> MutexGuard<'static, ()> {
    PLACING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Ends the writing of files before the program ends while another thread writes: waits, no longer
/// than `limit`, until a file that is taking its place is there, and removes what unfinished
/// writing would leave behind. No file takes its place afterwards.
pub fn settle(limit: Duration) {
    let began = Instant::now();
    while let Err(TryLockError::WouldBlock) = PLACING.try_lock().map(std::mem::forget) {
        if began.elapsed() >= limit {
            break;
        }
        std::thread::sleep(Duration::from_millis(1));
    }
    remove_where(|_| true);
}

fn remove_where(chosen: impl Fn(&Path) -> bool) {
    for path in named().extract_if(.., |path| chosen(path)) {
        // It may just have taken its place.
        let _ = std::fs::remove_file(path);
    }
}

/// A hidden name that `settle` knows.
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
    /// Returns a file in the folder of `path`, from the start no more readable than the one that it
    /// is to replace, or with this mode where there is none.
    pub(super) fn beside(path: &Path, replaced: Option<&Metadata>, mode: u32) -> Result<Self> {
        let folder = place::folder(path);
        // A folder that is missing has the same word for every kind of file.
        if !folder.metadata()?.is_dir() {
            return Err(ErrorKind::NotADirectory.into());
        }
        #[cfg(target_os = "linux")]
        let first = match unnamed::open(folder, mode) {
            Ok(file) => return Ok(Self::Unnamed(file)),
            Err(error) => error,
        };
        #[cfg(not(target_os = "linux"))]
        let first = Error::from(ErrorKind::Unsupported);
        // Not every file system knows files without a name. The hidden name is of no
        // interest to the reader of an error.
        Self::with_name(folder, replaced, mode).map_err(|error| {
            if first.kind() == error.kind() { first } else { Error::from(error.kind()) }
        })
    }

    fn with_name(folder: &Path, replaced: Option<&Metadata>, mode: u32) -> Result<Self> {
        let mut builder = tempfile::Builder::new();
        let prefix = format!(".rubscope-{}-", std::process::id());
        builder.prefix(&prefix);
        // Never more readable than what it replaces.
        let new = std::fs::Permissions::from_mode(mode);
        builder.permissions(replaced.map_or(new, Metadata::permissions));
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

    /// Gives the written file mode and owner of the one that it is to replace, and
    /// waits until it is on the disk.
    pub(super) fn finish(&self, replaced: Option<&Metadata>) -> Result<()> {
        if let Some(replaced) = replaced {
            keep_owner(self.file(), replaced);
            self.file().set_permissions(replaced.permissions())?;
        }
        self.file().sync_all()
    }

    /// Puts the file at `path`, where there must be none.
    pub(super) fn create(self, path: &Path) -> Result<()> {
        let _placing = placing();
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
        let _placing = placing();
        match self {
            #[cfg(target_os = "linux")]
            Self::Unnamed(file) => match unnamed::link(&file, path) {
                Err(error) if error.kind() == ErrorKind::AlreadyExists => {
                    unnamed::rename(&file, path)?;
                }
                linked => linked?,
            },
            Self::Named(file, _hidden) => drop(file.persist(path)?),
        }
        sync_folder(path);
        Ok(())
    }
}

/// Keeps the owner as far as this is permitted.
fn keep_owner(file: &File, replaced: &Metadata) {
    let (owner, group) = (Some(replaced.uid()), Some(replaced.gid()));
    if fchown(file, owner, group).is_err() {
        let _ = fchown(file, None, group);
    }
}

/// Writes the new name itself to the disk. Not every file system can do that, and the file is
/// already in its place.
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

    /// Returns a file without a name, which can get one later.
    pub(super) fn open(folder: &Path, mode: u32) -> Result<File> {
        // The descriptor is named through it later.
        Path::new("/proc/self/fd").metadata()?;
        let flags = i32::try_from(OFlags::TMPFILE.bits()).map_err(|_| ErrorKind::Unsupported)?;
        File::options().read(true).write(true).mode(mode).custom_flags(flags).open(folder)
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
            return renamed;
        }
    }
}

#[cfg(test)]
mod tests {
    use std::fs::read_to_string;
    use std::io::Write;

    use super::*;

    /// As on a file system that knows no files without a name.
    fn with_name(folder: &Path, content: &str) -> Temporary {
        let temporary = Temporary::with_name(folder, None, USUAL).unwrap();
        temporary.file().write_all(content.as_bytes()).unwrap();
        temporary
    }

    fn count(folder: &Path) -> usize {
        folder.read_dir().unwrap().count()
    }

    #[test]
    fn a_file_with_a_hidden_name_takes_its_place_too() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        with_name(folder.path(), "one").create(&path).unwrap();
        let refused = with_name(folder.path(), "two").create(&path).unwrap_err();
        assert_eq!(refused.kind(), ErrorKind::AlreadyExists);
        assert_eq!(read_to_string(&path).unwrap(), "one");
        with_name(folder.path(), "three").replace(&path).unwrap();
        assert_eq!(read_to_string(&path).unwrap(), "three");
        // One that is given up leaves nothing.
        drop(with_name(folder.path(), "four"));
        assert_eq!(count(folder.path()), 1);
        assert!(!named().iter().any(|path| path.starts_with(folder.path())));
    }

    #[test]
    fn hidden_names_are_known_to_who_ends_the_program() {
        let folder = tempfile::tempdir().unwrap();
        let _unfinished = with_name(folder.path(), "half");
        assert_eq!(count(folder.path()), 1);
        // Other tests write at the same time.
        remove_where(|path| path.starts_with(folder.path()));
        assert_eq!(count(folder.path()), 0);
    }

    #[test]
    fn a_hidden_name_is_no_more_readable_than_what_it_replaces() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.csv");
        std::fs::write(&path, "secret").unwrap();
        std::fs::set_permissions(&path, PermissionsExt::from_mode(0o600)).unwrap();
        let temporary =
            Temporary::with_name(folder.path(), Some(&path.metadata().unwrap()), USUAL).unwrap();
        let mode = |file: &Temporary| file.file().metadata().unwrap().permissions().mode() & 0o777;
        assert_eq!(mode(&temporary), 0o600);
        // Nor is one for the user alone, from its first moment on.
        assert_eq!(mode(&Temporary::with_name(folder.path(), None, PRIVATE).unwrap()), 0o600);
        assert_eq!(mode(&Temporary::beside(&path, None, PRIVATE).unwrap()), 0o600);
    }
}
