//! The map as it is computed: coarse blocks first, then finer ones in a fixed
//! order, and the run of one cell.

use crate::motion::Verdict;
use crate::study::overlay::{Curve, threshold_curves};
use crate::study::{Cell, Map, MapPlan};

/// Sides of the blocks that one cell stands for, coarse to fine.
const BLOCKS: [u32; 4] = [8, 4, 2, 1];

/// A map that is being computed.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveMap {
    /// Its plan and the cells so far.
    pub map: Map,
    /// Cells that were tried: a cell whose run takes too long stays empty.
    pub tried: usize,
    /// The threshold speeds over the map, where one axis is the speed.
    pub lines: Vec<Curve>,
}

impl LiveMap {
    /// A map with nothing computed.
    pub fn of(plan: MapPlan) -> Self {
        let mut lines = threshold_curves(&plan);
        // Without damping two thresholds are one.
        let double = |line: &Curve, of: &[Curve]| {
            line.name == "Omega_lock"
                && of.iter().any(|c| c.name == "Omega_c" && c.points == line.points)
        };
        let all = lines.clone();
        lines.retain(|line| !line.points.is_empty() && !double(line, &all));
        Self { lines, map: Map::empty(plan), tried: 0 }
    }

    /// What to draw at a cell: its own verdict, or that of the smallest block
    /// around it.
    pub fn shown(&self, column: u32, row: u32) -> Option<Cell> {
        let (x, y) = (self.map.plan.x.count, self.map.plan.y.count);
        BLOCKS
            .iter()
            .rev()
            .find_map(|&block| self.map.at(centre(column, block, x), centre(row, block, y)))
    }

    /// Whether all cells were tried.
    pub fn is_complete(&self) -> bool {
        self.tried >= self.map.cells.len()
    }
}

/// The cell that stands for the block around a cell.
fn centre(cell: u32, block: u32, count: u32) -> u32 {
    (cell - cell % block + block / 2).min(count.saturating_sub(1))
}

/// All cells of a map in the order in which they are computed, and how many of
/// them cover the whole map as the coarsest blocks.
pub fn coarse_first(plan: &MapPlan) -> (Vec<usize>, usize) {
    let (x, y) = (plan.x.count, plan.y.count);
    let mut taken = vec![false; plan.len()];
    let mut order = Vec::with_capacity(plan.len());
    let mut first = 0;
    for block in BLOCKS {
        let side = block as usize;
        for row in (0..y).step_by(side) {
            for column in (0..x).step_by(side) {
                let index = plan.index(centre(column, block, x), centre(row, block, y));
                if let Some(taken) = taken.get_mut(index).filter(|taken| !**taken) {
                    *taken = true;
                    order.push(index);
                }
            }
        }
        if first == 0 {
            first = order.len();
        }
    }
    (order, first)
}

/// The run of one cell.
#[derive(Clone, Debug, PartialEq)]
pub struct CellRun {
    /// The map that the cell is of.
    pub plan: MapPlan,
    /// Its column and row.
    pub cell: [u32; 2],
    /// How the motion lasts.
    pub verdict: Verdict,
    /// Start of the final contact \[s\].
    pub since: Option<f64>,
    /// The groups of blades in contact at the end and their multipliers;
    /// negative is a push \[N\].
    pub contacts: Vec<(Vec<u32>, f64)>,
    /// Impacts in all.
    pub impacts: u64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::tui::views::map::MapChoice;

    #[test]
    fn coarse_cells_come_first_and_every_cell_once() {
        let mut plan = MapChoice::default().plan(&Scene::base()).unwrap();
        for (x, y) in [(81, 41), (11, 41), (1, 1), (8, 3)] {
            (plan.x.count, plan.y.count) = (x, y);
            let (mut order, first) = coarse_first(&plan);
            let mut live = LiveMap::of(plan.clone());
            let cell = Some(Cell { verdict: Verdict::Decay, sensitive: false });
            order.iter().take(first).for_each(|&index| live.map.cells.set(index, cell));
            live.tried = first;
            // They cover the whole map.
            assert!((0..x).all(|column| (0..y).all(|row| live.shown(column, row) == cell)));
            assert!(first <= (x as usize).div_ceil(8) * (y as usize).div_ceil(8));
            order.sort_unstable();
            assert!(order.into_iter().eq(0..plan.len()), "{x} {y}");
        }
    }
}
