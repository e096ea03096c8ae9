//! The computation behind `rubscope map`: threads, progress, signals, and the
//! part file that saves every cell as soon as it is known.

use std::io::Write;
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Duration;

use rayon::prelude::*;

use super::output;
use super::part_file::{PartFile, save_new};
use super::sign;
use super::signals::StopRequest;
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
    pub part: Option<PartFile>,
}

/// Computes the cells of a map; the number of the signal that stopped it.
pub(super) fn compute(
    map: &mut Map,
    shard: Shard,
    kept: &Kept,
    out: &mut dyn Write,
) -> anyhow::Result<Option<u8>> {
    let progress = Progress::default();
    let request = StopRequest::expect();
    let notes = kept.part.as_ref();
    let mut builder = rayon::ThreadPoolBuilder::new();
    if let Some(threads) = kept.threads {
        builder = builder.num_threads(threads);
    }
    let pool = builder.build()?;
    let indices = shard.indices(map.cells.len());
    let is_missing = |&index: &usize| map.cells[index].is_none();
    let missing = pool.install(|| indices.clone().filter(is_missing).count());
    let finished = AtomicBool::new(false);
    std::thread::scope(|scope| {
        scope.spawn(|| watch(&progress, &request, &finished, missing as u64));
        let keep = |index: usize, cell: Cell| {
            if let Some(notes) = notes {
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
    let trouble = notes.and_then(|notes| Some((notes.name(), notes.trouble()?)));
    if let Some((path, error)) = &trouble {
        say(&format!("rubscope: could not save cells in {}: {error}", path.display()));
    }
    let received = request.received();
    drop(request);
    if let Some(number) = received {
        let complete = notes.filter(|_| trouble.is_none()).and_then(PartFile::path);
        stopped(map, complete, out)?;
        return Ok(Some(number));
    }
    if kept.adaptive {
        say_what_was_saved(map);
    }
    Ok(None)
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

/// Saves what is done and prints how to continue. If no part file has all
/// cells, one is written; if that fails, the cells go to standard output.
fn stopped(map: &Map, complete: Option<&Path>, out: &mut dyn Write) -> anyhow::Result<()> {
    let (done, cells) = (map.cells.iter().flatten().count(), map.cells.len());
    let stopped = format!("rubscope: stopped; {done} of {cells} cells are kept");
    if let Some(path) = complete {
        say(&format!("{stopped} in {}: go on with the same command", path.display()));
        return Ok(());
    }
    match save_new(map) {
        Ok(path) => {
            let path = path.display();
            say(&format!("{stopped}: go on with the same command and --resume {path}"));
            Ok(())
        }
        Err((path, error)) => {
            let kept = "its cells are on standard output, to be saved as a part for --resume";
            let print = |out: &mut dyn Write| part::write(map, out).map(drop);
            Err(output::print_instead(&path, error, kept, out, print))
        }
    }
}

/// Updates the bar and handles signals until the cells are done.
fn watch(progress: &Progress, request: &StopRequest, finished: &AtomicBool, cells: u64) {
    let bar = sign::bar(cells, "{spinner} {bar:30} {pos}/{len} cells, {per_sec}, {eta} left");
    while !finished.load(Ordering::Relaxed) {
        if request.received().is_some() {
            progress.stop.store(true, Ordering::Relaxed);
        }
        bar.set_position(progress.done.load(Ordering::Relaxed));
        std::thread::sleep(LOOK.min(Duration::from_millis(1 + cells / 100)));
    }
}
