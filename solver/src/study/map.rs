//! Interaction map: the verdict of every cell over two axes, computed in parallel. A cell takes
//! two bytes of memory, so the time of the runs limits the size of a map.

use std::sync::{Mutex, PoisonError};
use std::time::Instant;

use rayon::prelude::*;

use super::Axis;
use crate::motion::{Certainty, GoOn, Verdict, run_to_verdict, run_with_certainty};
use crate::scene::keys::{CASING_RADIUS, CLEARANCE};
use crate::scene::{Adjustment, CheckedScene, Scene, SceneError, SolverChoice};

/// Largest number of cells, about 4000 x 4000, which take days to compute.
const MOST_CELLS: usize = 16_000_000;

/// Plan of a map: everything that determines its cells.
#[derive(Clone, Debug, PartialEq)]
pub struct MapPlan {
    /// Scene that all cells start from.
    pub scene: Scene,
    /// Axis of the columns; rotor speed by default.
    pub x: Axis,
    /// Axis of the rows; pulse by default.
    pub y: Axis,
    /// Whether to detect sensitive cells, which takes up to four more runs a cell.
    pub sensitivity: bool,
}

/// A map, complete or in part.
#[derive(Clone, Debug, PartialEq)]
pub struct Map {
    /// Plan of the map.
    pub plan: MapPlan,
    /// Cells row by row; `None` if not computed.
    pub cells: Vec<Option<Cell>>,
    /// Number of cells that [`fill`](Self::fill) has computed.
    pub runs: u64,
    /// Wall time that [`fill`](Self::fill) has taken \[s\].
    pub wall_s: f64,
}

impl MapPlan {
    /// Returns the number of cells.
    #[must_use]
    pub fn len(&self) -> usize {
        self.x.count as usize * self.y.count as usize
    }

    /// Returns whether the plan has no cells.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the index of the cell in a column and a row.
    #[must_use]
    pub fn index(&self, column: u32, row: u32) -> usize {
        row as usize * self.x.count as usize + column as usize
    }

    /// Returns the scene of a cell.
    ///
    /// # Errors
    /// The combination of values is not allowed.
    pub fn scene_of(&self, index: usize) -> Result<CheckedScene, SceneError> {
        self.cell(index)?.checked()
    }

    fn cell(&self, index: usize) -> Result<Scene, SceneError> {
        let mut scene = self.scene.clone();
        let columns = self.x.count as usize;
        let mut axes = [(&self.x, index % columns), (&self.y, index / columns)];
        // The clearance is beyond the blade length of the cell.
        axes.sort_by_key(|(axis, _)| axis.path == CLEARANCE);
        axes.iter().try_for_each(|(axis, place)| axis.apply(&mut scene, *place as u32))?;
        Ok(scene)
    }

    /// Changes solver, contact law and model of the scene so that they are compatible with both
    /// axes and with the keys that the user set (`asked`), and checks the plan. Returns what was
    /// changed.
    ///
    /// # Errors
    /// As [`check`](Self::check).
    pub fn make_compatible(
        &mut self,
        asked: impl Fn(&str) -> bool,
    ) -> Result<Vec<Adjustment>, SceneError> {
        let mut made = Vec::new();
        for end in [0, self.len() - 1] {
            let mut cell = self.cell(end)?;
            let is_axis = |key: &str| self.x.path == key || self.y.path == key;
            made.extend(cell.make_compatible(|key| asked(key) || is_axis(key)));
            let SolverChoice { kind, contact, model, .. } = cell.solver;
            self.scene.solver = SolverChoice { kind, contact, model, ..self.scene.solver };
        }
        self.check().map(|()| made)
    }

    fn check_size(&self) -> Result<(), SceneError> {
        if (1..=MOST_CELLS).contains(&self.len()) {
            return Ok(());
        }
        let size = format!("{} x {} cells", self.x.count, self.y.count);
        Err(SceneError::refused("map", size, format!("from 1 to {MOST_CELLS} cells")))
    }

    /// Rejects a plan with too many cells, with the same key on both axes, or with a corner that is
    /// not a valid scene.
    ///
    /// # Errors
    /// States the number of cells, the key, or the first corner that is not valid.
    pub fn check(&self) -> Result<(), SceneError> {
        self.check_size()?;
        if self.x.path == self.y.path {
            let both = format!("{} on both axes", self.x.path);
            let allowed = "two different keys; columns (x) are the speed and rows (y) the \
                           pulse by default";
            return Err(SceneError::refused("map", both, allowed));
        }
        let paths = [self.x.path.as_str(), self.y.path.as_str()];
        if [CLEARANCE, CASING_RADIUS].iter().all(|path| paths.contains(path)) {
            let allowed = "one of them: the radius sets the clearance";
            return Err(SceneError::refused("map", paths.join(" and "), allowed));
        }
        let (columns, cells) = (self.x.count as usize, self.len());
        for corner in [0, columns - 1, cells - columns, cells - 1] {
            self.scene_of(corner)?;
        }
        Ok(())
    }

    /// Computes one cell; `None` if `go_on` stopped it. A scene that is not valid counts as failed.
    #[must_use]
    pub fn compute(&self, index: usize, go_on: GoOn<'_>) -> Option<Cell> {
        let Ok(scene) = self.scene_of(index) else {
            return Some(Cell::of(Verdict::Failed));
        };
        let (reached, certainty) = if self.sensitivity {
            run_with_certainty(&scene, go_on)?
        } else {
            (run_to_verdict(&scene, go_on)?, Certainty::default())
        };
        let doubt = match certainty {
            Certainty { sensitive: true, .. } => Doubt::Sensitive,
            Certainty { depends_on_step: Some(true), .. } => Doubt::Step,
            Certainty { depends_on_step: Some(false), .. } => Doubt::None,
            _ => Doubt::Unexamined,
        };
        Some(Cell { verdict: reached.verdict, doubt })
    }
}

impl Map {
    /// Creates a map without computed cells.
    #[must_use]
    pub fn empty(plan: MapPlan) -> Self {
        let cells = vec![None; plan.len()];
        Self { plan, cells, runs: 0, wall_s: 0.0 }
    }

    /// Computes the missing ones of the given cells in parallel while `go_on` returns true, and
    /// passes each to `keep` as soon as it is ready.
    pub fn fill(
        &mut self,
        indices: impl IndexedParallelIterator<Item = usize>,
        go_on: GoOn<'_>,
        keep: Keep<'_>,
    ) {
        let started = Instant::now();
        let (plan, cells) = (&self.plan, Mutex::new(&mut self.cells));
        let cells = || cells.lock().unwrap_or_else(PoisonError::into_inner);
        let computed = indices
            .with_max_len(16)
            .filter(|&index| cells()[index].is_none() && go_on())
            .filter_map(|index| {
                let cell = plan.compute(index, go_on)?;
                cells()[index] = Some(cell);
                keep(index, cell);
                Some(())
            })
            .count();
        self.runs += computed as u64;
        self.wall_s += started.elapsed().as_secs_f64();
    }

    /// Returns whether every cell is computed.
    #[must_use]
    pub fn is_complete(&self) -> bool {
        self.cells.iter().all(Option::is_some)
    }

    /// Returns the cell of a column and a row; `None` if it is not computed or outside the map.
    #[must_use]
    pub fn at(&self, column: u32, row: u32) -> Option<Cell> {
        *self.cells.get(self.plan.index(column, row))?
    }

    /// Returns the number of cells with each verdict, and the numbers of sensitive and of
    /// step-dependent cells.
    #[must_use]
    pub fn census(&self) -> ([(Verdict, usize); Verdict::ALL.len()], [usize; 2]) {
        let cells = || self.cells.iter().flatten();
        let count = Verdict::ALL
            .map(|verdict| (verdict, cells().filter(|cell| cell.verdict == verdict).count()));
        let having = |doubt| cells().filter(|cell| cell.doubt == doubt).count();
        (count, [having(Doubt::Sensitive), having(Doubt::Step)])
    }
}

/// Result of one cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// Verdict.
    pub verdict: Verdict,
    /// What alters the verdict.
    pub doubt: Doubt,
}

/// What alters the verdict of a cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Doubt {
    /// Neither a tiny change nor another time step.
    None,
    /// A tiny change of the run; another time step was not examined.
    Sensitive,
    /// Another time step.
    Step,
    /// Nothing that was examined, which another time step was not: the solver has none.
    Unexamined,
}

impl Cell {
    /// Creates a cell whose verdict is not doubtful.
    #[must_use]
    pub const fn of(verdict: Verdict) -> Self {
        Self { verdict, doubt: Doubt::Unexamined }
    }

    /// Returns whether the verdict is sensitive or depends on the time step.
    #[must_use]
    pub fn is_doubtful(self) -> bool {
        matches!(self.doubt, Doubt::Sensitive | Doubt::Step)
    }

    /// Returns whether the verdict depends on the time step; `None` if that was not examined.
    #[must_use]
    pub fn depends_on_step(&self) -> Option<bool> {
        matches!(self.doubt, Doubt::None | Doubt::Step).then_some(self.doubt == Doubt::Step)
    }
}

type Keep<'a> = &'a (dyn Fn(usize, Cell) + Sync);
