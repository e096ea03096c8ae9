//! Exchanges the content of a file that must stay the same file.

use std::fs::File;
use std::io::{Read, Result, Seek, SeekFrom};
use std::path::Path;

/// Gives the file at `path` the content of `complete`. Room for all of it comes
/// first, then what makes it longer: if the disk is full it is found there, and
/// taken back.
pub(super) fn exchange(mut complete: &File, path: &Path) -> Result<()> {
    let file = File::options().write(true).open(path)?;
    let (old, new) = (file.metadata()?.len(), complete.metadata()?.len());
    if let Err(error) = reserve(&file, new) {
        let _ = file.set_len(old);
        return Err(error);
    }
    let copy = |complete: &mut &File, from: u64, to: u64| -> Result<()> {
        complete.seek(SeekFrom::Start(from))?;
        (&file).seek(SeekFrom::Start(from))?;
        std::io::copy(&mut complete.take(to - from), &mut &file)?;
        file.sync_all()
    };
    if new > old
        && let Err(error) = copy(&mut complete, old, new)
    {
        // The error that matters is the first one.
        let _ = file.set_len(old);
        return Err(error);
    }
    copy(&mut complete, 0, old.min(new))?;
    file.set_len(new)?;
    file.sync_all()
}

/// Takes room on the disk, also for the holes of the file. A file system that
/// cannot is believed to need none for what it overwrites.
#[cfg(target_os = "linux")]
fn reserve(file: &File, length: u64) -> Result<()> {
    use rustix::fs::{FallocateFlags, fallocate};
    match fallocate(file, FallocateFlags::empty(), 0, length.max(1)) {
        Err(rustix::io::Errno::NOSPC | rustix::io::Errno::DQUOT | rustix::io::Errno::FBIG) => {
            Err(std::io::ErrorKind::StorageFull.into())
        }
        _ => Ok(()),
    }
}

#[cfg(not(target_os = "linux"))]
fn reserve(_: &File, _: u64) -> Result<()> {
    Ok(())
}
