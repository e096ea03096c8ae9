//! The interaction map, the paper's Fig. 8 as a working tool: how the motion
//! lasts over two quantities of a scene, one independent run a cell.
//!
//! Cells are numbered along x first. Every cell is computed from its scene
//! alone, so the result is the same for any number of threads and any order.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::time::Instant;

use rayon::prelude::*;

use super::{Axis, Cell, Cells};
use crate::motion::{GoOn, Verdict, run_to_verdict, run_with_sensitivity};
use crate::scene::{CheckedScene, Scene, SceneError};

/// Most cells of one map, about 4000 x 4000: a byte each in memory, and days of runs.
const MOST_CELLS: usize = 16_000_000;

/// The plan of a map: everything that determines its cells.
#[derive(Clone, Debug, PartialEq)]
pub struct MapPlan {
    /// The scene all cells start from.
    pub scene: Scene,
    /// Columns; rotor speed by default.
    pub x: Axis,
    /// Rows; pulse by default.
    pub y: Axis,
    /// Whether to find the sensitive cells, which takes up to four more runs per cell.
    pub sensitivity: bool,
}

/// A map, whole or in part.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Its plan.
    pub plan: MapPlan,
    /// Cells in order; none if not computed.
    pub cells: Cells,
    /// Whether cells were filled in between others without a run.
    pub adaptive: bool,
    /// Number of cells that were computed by a run.
    pub runs: u64,
    /// Wall time of this computation \[s\].
    pub wall_s: f64,
}

/// Progress and stop flag of a map while it is computed.
#[derive(Debug, Default)]
pub struct Progress {
    /// Cells done so far.
    pub done: AtomicU64,
    /// Set to stop early; finished cells are kept.
    pub stop: AtomicBool,
}

impl MapPlan {
    /// Number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.x.count as usize * self.y.count as usize
    }

    /// Whether there are no cells.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The number of the cell in a column and a row.
    #[must_use]
    pub fn index(&self, column: u32, row: u32) -> usize {
        row as usize * self.x.count as usize + column as usize
    }

    /// The scene of a cell.
    ///
    /// # Errors
    /// A combination of values that is not allowed.
    pub fn scene_of(&self, index: usize) -> Result<CheckedScene, SceneError> {
        let mut scene = self.scene.clone();
        let columns = self.x.count as usize;
        self.x.apply(&mut scene, (index % columns) as u32)?;
        self.y.apply(&mut scene, (index / columns) as u32)?;
        scene.checked()
    }

    /// The first difference of two plans that can change their cells.
    #[must_use]
    pub fn difference(&self, other: &Self) -> Option<&'static str> {
        [
            ("the x axis", self.x != other.x),
            ("the y axis", self.y != other.y),
            ("the scene", self.deciding() != other.deciding()),
            ("whether sensitivity was asked for", self.sensitivity != other.sensitivity),
        ]
        .into_iter()
        .find_map(|(what, differs)| differs.then_some(what))
    }

    /// The scene without what no cell depends on: title, note and view, and the
    /// keys on the axes, which each cell sets.
    fn deciding(&self) -> Scene {
        let Scene { title, note, view, .. } = Scene::base();
        let mut scene = Scene { title, note, view, ..self.scene.clone() };
        for axis in [&self.x, &self.y] {
            // An axis with a key that does not exist changes neither scene.
            let _ = axis.apply(&mut scene, 0);
        }
        scene
    }

    /// Refuses a plan of more cells than fit.
    ///
    /// # Errors
    /// The number of cells, and how many are allowed.
    pub fn check_size(&self) -> Result<(), SceneError> {
        if (1..=MOST_CELLS).contains(&self.len()) {
            return Ok(());
        }
        let size = format!("{} x {} cells", self.x.count, self.y.count);
        Err(SceneError::refused("map", size, format!("from 1 to {MOST_CELLS} cells")))
    }

    /// Refuses a plan with too many cells, with one key twice, or with a corner that is
    /// not a valid scene.
    ///
    /// # Errors
    /// The number of cells, a key on both axes, or the first corner that is refused.
    pub fn check(&self) -> Result<(), SceneError> {
        self.check_size()?;
        if self.x.path == self.y.path {
            let both = format!("{} on both axes", self.x.path);
            let allowed = "two different keys; columns (x) are the speed and rows (y) the \
                           pulse by default";
            return Err(SceneError::refused("map", both, allowed));
        }
        let (columns, cells) = (self.x.count as usize, self.len());
        for corner in [0, columns - 1, cells - columns, cells - 1] {
            self.scene_of(corner)?;
        }
        Ok(())
    }

    /// Computes one cell; none where `go_on` said no on the way. A scene that is
    /// refused counts as failed.
    #[must_use]
    pub fn compute(&self, index: usize, go_on: GoOn<'_>) -> Option<Cell> {
        let Ok(scene) = self.scene_of(index) else {
            return Some(Cell { verdict: Verdict::Failed, sensitive: false });
        };
        let (reached, sensitive) = if self.sensitivity {
            run_with_sensitivity(&scene, go_on)?
        } else {
            (run_to_verdict(&scene, go_on)?, false)
        };
        Some(Cell { verdict: reached.verdict, sensitive })
    }
}

impl Map {
    /// A map with nothing computed.
    #[must_use]
    pub fn empty(plan: MapPlan) -> Self {
        let cells = Cells::empty(plan.len());
        Self { plan, cells, adaptive: false, runs: 0, wall_s: 0.0 }
    }

    /// Computes the given cells that are still missing, in parallel, and passes
    /// each to `keep` as soon as it is ready. Stops early on request.
    pub fn fill(
        &mut self,
        indices: impl IndexedParallelIterator<Item = usize>,
        progress: &Progress,
        keep: &(dyn Fn(usize, Cell) + Sync),
    ) {
        let started = Instant::now();
        let (plan, cells) = (&self.plan, &self.cells);
        let go_on = || !progress.stop.load(Ordering::Relaxed);
        let computed = indices
            .with_max_len(16)
            .filter(|&index| cells[index].is_none() && go_on())
            .filter_map(|index| {
                let cell = plan.compute(index, &go_on)?;
                cells.set(index, Some(cell));
                keep(index, cell);
                progress.done.fetch_add(1, Ordering::Relaxed);
                Some(())
            })
            .count();
        self.runs += computed as u64;
        self.wall_s += started.elapsed().as_secs_f64();
    }

    /// Whether every cell is computed.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.cells.iter().all(Option::is_some)
    }

    /// The cell of a column and a row.
    #[must_use]
    pub fn at(&self, column: u32, row: u32) -> Option<Cell> {
        *self.cells.get(self.plan.index(column, row))?
    }

    /// How many cells have each verdict, and how many are sensitive.
    #[must_use]
    pub fn census(&self) -> ([(Verdict, usize); 8], usize) {
        let cells = || self.cells.iter().flatten();
        let count = Verdict::ALL
            .map(|verdict| (verdict, cells().filter(|cell| cell.verdict == verdict).count()));
        (count, cells().filter(|cell| cell.sensitive).count())
    }
}
