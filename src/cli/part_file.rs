//! The part file of a map while it is computed: locked, so that no other map
//! writes there, and every cell in it as soon as it is known.

use std::fs::{File, Metadata, TryLockError};
use std::io::{BufReader, Error, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use anyhow::Context;

use super::status::{Refusal, note};
use crate::file;
use rubscope_solver::study::part::{self, PartWriter};
use rubscope_solver::study::{Cell, Map};

/// A part file that is this map's alone until it is dropped.
pub(super) struct PartFile {
    path: PathBuf,
    writer: PartWriter,
    /// The file, and the first cell that could not be saved there.
    file: Mutex<(File, Option<Error>)>,
}

impl PartFile {
    /// Opens the part file of a map, and adds the cells in it to the map; makes one
    /// where there is none.
    ///
    /// # Errors
    /// A file that another map writes, that holds another map or is no part.
    pub(super) fn open(path: &Path, map: &mut Map) -> anyhow::Result<Self> {
        let shown = path.display();
        let mut file = lock(path)?;
        let writer = if file.metadata()?.len() == 0 {
            start(&mut file, map)
                // Nothing is in it, and no other map can have it.
                .inspect_err(|_| drop(std::fs::remove_file(path)))
                .with_context(|| format!("cannot write {shown}"))?
        } else {
            go_on(&file, path, map)?
        };
        Ok(Self { path: path.to_path_buf(), writer, file: Mutex::new((file, None)) })
    }

    /// The name it was opened with.
    pub(super) fn name(&self) -> &Path {
        &self.path
    }

    /// Where the cells are; none once another program has put a file in that
    /// place.
    pub(super) fn path(&self) -> Option<&Path> {
        let (there, ours) = (self.path.metadata().ok()?, self.file().0.metadata().ok()?);
        same(&ours, &there).then_some(&self.path)
    }

    fn file(&self) -> MutexGuard<'_, (File, Option<Error>)> {
        self.file.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Saves one cell. A full disk must not stop the computation: the first
    /// error is stored and reported at the end.
    pub(super) fn keep(&self, index: usize, cell: Cell) {
        let mut guard = self.file();
        let (file, trouble) = &mut *guard;
        if trouble.is_none() {
            // One write per line: a run that is killed leaves whole lines.
            let mut line = Vec::with_capacity(32);
            let written = self.writer.cell(index, cell, &mut line);
            *trouble = written.and_then(|()| file.write_all(&line)).err();
        }
    }

    /// Why not all cells are in the file.
    pub(super) fn trouble(&self) -> Option<Error> {
        self.file().1.take()
    }

    /// Removes the file, while no other map can have it.
    pub(super) fn remove(self) {
        // The result has its cells: what stays is too much and no loss.
        if let Some(path) = self.path() {
            let _ = std::fs::remove_file(path);
        }
    }
}

/// Writes the cells of a map into a new file that no other run has, and returns
/// its name.
///
/// # Errors
/// An error of the system, and the name.
pub(super) fn save_new(map: &Map) -> Result<PathBuf, (PathBuf, Error)> {
    let process = std::process::id();
    let mut name = "rubscope-map.partial".to_string();
    for number in 1.. {
        let path = PathBuf::from(&name);
        match file::create(&path, |out| part::write(map, out).map(drop)) {
            Ok(()) => return Ok(path),
            Err(error) if error.kind() == ErrorKind::AlreadyExists => {}
            Err(error) => return Err((path, error)),
        }
        name = match number {
            1 => format!("rubscope-map-{process}.partial"),
            _ => format!("rubscope-map-{process}-{number}.partial"),
        };
    }
    Err((PathBuf::from(name), Error::from(ErrorKind::AlreadyExists)))
}

/// Opens and locks the file.
fn lock(path: &Path) -> anyhow::Result<File> {
    let cannot = || format!("cannot write {}", path.display());
    loop {
        match path.metadata() {
            Ok(found) if !found.is_file() => {
                let reason = "a part of a map is a file, not a folder or a device";
                return Err(Error::new(ErrorKind::InvalidInput, reason)).with_context(cannot);
            }
            Ok(found) if found.permissions().readonly() => {
                let reason = "the file is read-only";
                return Err(Error::new(ErrorKind::PermissionDenied, reason)).with_context(cannot);
            }
            _ => {}
        }
        let mut options = File::options();
        let file = options.read(true).append(true).create(true).open(path).with_context(cannot)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => return Err(in_use(path, &file).into()),
            // Some file systems know no locks.
            Err(TryLockError::Error(error)) => {
                note(format!("rubscope: could not lock {}: {error}", path.display()));
                return Ok(file);
            }
        }
        // The map before may have removed it between the two calls.
        if path.metadata().is_ok_and(|there| file.metadata().is_ok_and(|ours| same(&ours, &there)))
        {
            return Ok(file);
        }
    }
}

/// Refuses a place where another map saves its cells; `own` may be there.
///
/// # Errors
/// The file, and the process that has it.
pub(super) fn refuse_locked(path: &Path, own: Option<&PartFile>) -> Result<(), Refusal> {
    let Ok(found) = path.metadata() else { return Ok(()) };
    let is_own = own.is_some_and(|part| part.file().0.metadata().is_ok_and(|m| same(&m, &found)));
    if is_own || !found.is_file() {
        return Ok(());
    }
    match File::open(path) {
        Ok(file) if matches!(file.try_lock_shared(), Err(TryLockError::WouldBlock)) => {
            Err(in_use(path, &file))
        }
        _ => Ok(()),
    }
}

fn in_use(path: &Path, file: &File) -> Refusal {
    let holder = holder(file).map_or_else(String::new, |process| format!(", process {process}"));
    let allowed = "another file, or to wait until that map has ended";
    Refusal::because(format!(
        "{} is in use by another map{holder}: allowed is {allowed}",
        path.display()
    ))
}

#[cfg(unix)]
fn same(one: &Metadata, other: &Metadata) -> bool {
    use std::os::unix::fs::MetadataExt;
    (one.dev(), one.ino()) == (other.dev(), other.ino())
}

#[cfg(not(unix))]
fn same(_: &Metadata, _: &Metadata) -> bool {
    // A file that is open there cannot be removed.
    true
}

/// The process that has locked the file, where the system tells.
#[cfg(target_os = "linux")]
fn holder(file: &File) -> Option<u32> {
    use std::os::unix::fs::MetadataExt;
    // As in `1: FLOCK  ADVISORY  WRITE 2467 fd:00:131 0 EOF`.
    let inode = format!(":{}", file.metadata().ok()?.ino());
    let locks = std::fs::read_to_string("/proc/locks").ok()?;
    let mut holders = locks.lines().filter_map(|line| {
        let words: Vec<&str> = line.split_whitespace().collect();
        let is_ours = words.get(1) == Some(&"FLOCK") && words.get(5)?.ends_with(&inode);
        words.get(4)?.parse().ok().filter(|process| is_ours && *process > 0)
    });
    // Two files of the same number are on two disks: it could be either.
    let found = holders.next();
    found.filter(|_| holders.next().is_none())
}

#[cfg(not(target_os = "linux"))]
fn holder(_: &File) -> Option<u32> {
    None
}

/// Writes the first line and the cells that are known.
fn start(file: &mut File, map: &Map) -> std::io::Result<PartWriter> {
    let mut out = std::io::BufWriter::new(&*file);
    let written = part::write(map, &mut out).and_then(|writer| {
        out.flush()?;
        Ok(writer)
    });
    if written.is_err() {
        drop(out.into_parts());
        // Half a first line would be refused by the next run.
        let _ = file.set_len(0);
    }
    written
}

/// Reads the cells that are there, and cuts off what a kill left incomplete.
fn go_on(file: &File, path: &Path, map: &mut Map) -> anyhow::Result<PartWriter> {
    let shown = path.display();
    let part = part::read_one(shown.to_string(), BufReader::new(file))
        .map_err(|error| Refusal::because(error.to_string()))?;
    let done = part.map.cells.iter().flatten().count();
    if map.plan.difference(&part.map.plan).is_some() {
        let allowed = "to finish that map first, or to remove the file";
        let reason = format!("{shown} holds {done} cells of another map: allowed is {allowed}");
        return Err(Refusal::because(reason).into());
    }
    file.set_len(part.whole).with_context(|| format!("cannot write {shown}"))?;
    note(format!("rubscope: going on from {done} cells in {shown}"));
    (map.cells, map.runs) = (part.map.cells, part.map.runs);
    Ok(part.writer)
}
