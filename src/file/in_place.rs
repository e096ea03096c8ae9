//! Exchanges the content of a file that must stay the same file.

use std::fs::File;
use std::io::{Read, Result, Seek, SeekFrom};
use std::path::Path;

/// Gives the file at `path` the content of `complete`. A full disk is found
/// before anything is overwritten: room for all of it is taken first, also for
/// holes, or where the file system cannot do that, what makes it longer is written
/// first and taken back.
pub(super) fn exchange(mut complete: &File, path: &Path) -> Result<()> {
    let file = File::options().write(true).open(path)?;
    let (old, new) = (file.metadata()?.len(), complete.metadata()?.len());
    let mut copy = |from: u64, to: u64| -> Result<()> {
        complete.seek(SeekFrom::Start(from))?;
        (&file).seek(SeekFrom::Start(from))?;
        std::io::copy(&mut complete.take(to - from), &mut &file).map(drop)
    };
    let room = match reserve(&file, new) {
        Ok(true) => Ok(()),
        Ok(false) if new > old => copy(old, new).and_then(|()| file.sync_all()),
        Ok(false) => Ok(()),
        Err(error) => Err(error),
    };
    if room.is_err() {
        // The error that matters is the first one.
        let _ = file.set_len(old);
        return room;
    }
    copy(0, new)?;
    file.set_len(new)?;
    // Last: a slow disk is waited for with the content whole.
    file.sync_all()
}

/// Takes room on the disk; false where the file system does not do that.
#[cfg(target_os = "linux")]
fn reserve(file: &File, length: u64) -> Result<bool> {
    use rustix::fs::{FallocateFlags, fallocate};
    use rustix::io::Errno;
    match fallocate(file, FallocateFlags::KEEP_SIZE, 0, length.max(1)) {
        Ok(()) => Ok(true),
        Err(Errno::NOSPC | Errno::DQUOT) => Err(std::io::ErrorKind::StorageFull.into()),
        Err(_) => Ok(false),
    }
}

#[cfg(not(target_os = "linux"))]
fn reserve(_: &File, _: u64) -> Result<bool> {
    Ok(false)
}
