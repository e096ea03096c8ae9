//! Exchanges the content of a file that must stay the same file.

use std::fs::File;
use std::io::{Read, Result, Seek, SeekFrom};
use std::path::Path;

/// Gives the file at `path` the content of `complete`. What makes it longer comes
/// first, since only that can find the disk full, and is taken back if it does.
pub(super) fn exchange(mut complete: &File, path: &Path) -> Result<()> {
    let file = File::options().write(true).open(path)?;
    let (old, new) = (file.metadata()?.len(), complete.metadata()?.len());
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
