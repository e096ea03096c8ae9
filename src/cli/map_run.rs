//! The computation behind `rubscope map`: threads, progress, signals, and the
//! part file that saves every cell as soon as it is known.

use std::fs::{File, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Duration;

use anyhow::Context;
use rayon::prelude::*;
use signal_hook::consts::{SIGINT, SIGTERM};

use super::output;
use super::status::say;
use crate::study::{Cell, Map, Progress, Shard, part};

/// How often the bar and the signals are checked.
const LOOK: Duration = Duration::from_millis(100);

/// How a map is computed and saved.
pub(super) struct Kept {
    /// Refine only next to changes.
    pub adaptive: bool,
    /// Number of threads.
    pub threads: Option<usize>,
    /// Where cells are saved as soon as they are known.
    pub part: Option<PathBuf>,
}

/// Computes the cells of a map; the number of the signal that stopped it.
pub(super) fn compute(
    map: &mut Map,
    shard: Shard,
    kept: &Kept,
    out: &mut dyn Write,
) -> anyhow::Result<Option<u8>> {
    let progress = Progress::default();
    let signal = Arc::new(AtomicUsize::new(0));
    for number in [SIGINT, SIGTERM] {
        signal_hook::flag::register_usize(number, Arc::clone(&signal), number as usize)?;
    }
    let notes = match &kept.part {
        Some(path) => Some(Notes::open(path, map)?),
        None => None,
    };
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = kept.threads {
        builder = builder.num_threads(threads);
    }
    let pool = builder.build()?;
    let indices = shard.indices(map.cells.len());
    let missing = indices.clone().filter(|&index| map.cells[index].is_none()).count();
    let finished = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| watch(&progress, &signal, &finished, missing as u64));
        let keep = |index: usize, cell: Cell| {
            if let Some(notes) = &notes {
                notes.keep(index, cell);
            }
        };
        pool.install(|| {
            if kept.adaptive {
                map.fill_adaptively(&progress, &keep);
            } else {
                map.fill(indices, &progress, &keep);
            }
        });
        finished.store(true, Ordering::Relaxed);
    });
    let trouble = notes.and_then(Notes::close);
    if let Some((path, error)) = &trouble {
        say(&format!("rubscope: could not save cells in {}: {error}", path.display()));
    }
    match signal.load(Ordering::Relaxed) {
        0 => {
            if kept.adaptive {
                say_what_was_saved(map);
            }
            Ok(None)
        }
        number => {
            stopped(map, kept.part.as_deref().filter(|_| trouble.is_none()), out)?;
            Ok(Some(u8::try_from(number).unwrap_or(1)))
        }
    }
}

/// The cost of an adaptive map, compared with all its cells.
fn say_what_was_saved(map: &Map) {
    let (runs, cells, stride) = (map.runs, map.cells.len() as u64, map.coarsest_stride());
    let saved = cells.saturating_sub(runs);
    let percent = 100 * saved / cells.max(1);
    say(&format!(
        "rubscope: {runs} runs for {cells} cells, {saved} ({percent} %) saved; started with 1 of \
         {stride} columns and rows, every border between verdicts run to the cell"
    ));
}

/// Where cells go if no file was named; never overwrites those of another run.
fn unused_name() -> PathBuf {
    let path = PathBuf::from("rubscope-map.partial");
    if path.exists() {
        PathBuf::from(format!("rubscope-map-{}.partial", std::process::id()))
    } else {
        path
    }
}

/// Saves what is done and prints how to continue. If no part file has all
/// cells, one is written; if that fails, the cells go to standard output.
fn stopped(map: &Map, complete: Option<&Path>, out: &mut dyn Write) -> anyhow::Result<()> {
    let path = complete.map_or_else(unused_name, Path::to_path_buf);
    let done = map.cells.iter().flatten().count();
    if complete.is_none()
        && let Err(error) = crate::file::replace(&path, |out| part::write(map, out))
    {
        part::write(map, out)?;
        let kept = "its cells are on standard output, to be saved as a part for --resume";
        let shown = path.display();
        return Err(anyhow::Error::from(error).context(format!("cannot write {shown}; {kept}")));
    }
    say(&format!(
        "rubscope: stopped; {done} of {} cells are kept: go on with the same command and --resume {}",
        map.cells.len(),
        path.display()
    ));
    Ok(())
}

/// Updates the bar and handles signals until the cells are done.
fn watch(progress: &Progress, signal: &AtomicUsize, finished: &AtomicBool, cells: u64) {
    let bar = output::bar(cells, "{bar:30} {pos}/{len} cells, {per_sec}, {eta} left");
    while !finished.load(Ordering::Relaxed) {
        if signal.load(Ordering::Relaxed) != 0 {
            progress.stop.store(true, Ordering::Relaxed);
        }
        bar.set_position(progress.done.load(Ordering::Relaxed));
        std::thread::sleep(LOOK.min(Duration::from_millis(1 + cells / 100)));
    }
    bar.finish_and_clear();
}

/// The part file during the computation.
struct Notes {
    path: PathBuf,
    file: Mutex<(File, Option<std::io::Error>)>,
}

impl Notes {
    /// Writes the file again with the known cells, which removes a line that a
    /// kill left incomplete.
    fn open(path: &Path, map: &Map) -> anyhow::Result<Self> {
        let cannot = || format!("cannot write {}", path.display());
        crate::file::replace(path, |out| part::write(map, out)).with_context(cannot)?;
        let file = OpenOptions::new().append(true).open(path).with_context(cannot)?;
        Ok(Self { path: path.to_path_buf(), file: Mutex::new((file, None)) })
    }

    fn lock(&self) -> MutexGuard<'_, (File, Option<std::io::Error>)> {
        self.file.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Saves one cell. A full disk must not stop the computation: the first
    /// error is stored and reported at the end.
    fn keep(&self, index: usize, cell: Cell) {
        let mut guard = self.lock();
        let (file, trouble) = &mut *guard;
        if trouble.is_none() {
            // One write per line: a run that is killed leaves whole lines.
            let mut line = Vec::with_capacity(24);
            let written = part::write_cell(index, cell, &mut line);
            *trouble = written.and_then(|()| file.write_all(&line)).err();
        }
    }

    fn close(self) -> Option<(PathBuf, std::io::Error)> {
        let (_, trouble) = self.file.into_inner().unwrap_or_else(PoisonError::into_inner);
        Some((self.path, trouble?))
    }
}
