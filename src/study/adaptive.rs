//! Adaptive maps: a coarse grid first, then only cells beside a change, down
//! to the resolution of the plan. Cells that were not run take the value of
//! the coarse cell they lie in.

use super::map::{Cell, Map, Progress};

/// Coarsest stride between computed cells.
const COARSEST: usize = 16;

impl Map {
    /// Fills the map adaptively; cells inferred without a run are not counted
    /// in `runs`.
    pub fn fill_adaptively(&mut self, progress: &Progress, keep: &(dyn Fn(usize, Cell) + Sync)) {
        let columns = self.plan.x.count as usize;
        let rows = self.plan.y.count as usize;
        let mut stride = COARSEST.min(columns.max(rows).next_power_of_two());
        self.fill(&grid(columns, rows, stride), progress, keep);
        while stride > 1 {
            let half = stride / 2;
            let wanted: Vec<usize> = grid(columns, rows, half)
                .into_iter()
                .filter(|&index| {
                    self.cells[index].is_none() && self.is_mixed(index, stride, columns, rows)
                })
                .collect();
            self.fill(&wanted, progress, keep);
            self.infer(half, stride, columns, rows);
            stride = half;
        }
    }

    /// Whether the known cells around `index`, one stride away at most, differ.
    fn is_mixed(&self, index: usize, stride: usize, columns: usize, rows: usize) -> bool {
        let (column, row) = (index % columns, index / columns);
        let mut seen: Option<Cell> = None;
        for y in (row / stride).saturating_sub(1)..=row / stride + 2 {
            for x in (column / stride).saturating_sub(1)..=column / stride + 2 {
                let (x, y) = ((x * stride).min(columns - 1), (y * stride).min(rows - 1));
                let Some(cell) = self.cells[y * columns + x] else { continue };
                if cell.sensitive || seen.is_some_and(|seen| seen != cell) {
                    return true;
                }
                seen = Some(cell);
            }
        }
        false
    }

    /// Gives the cells of the finer grid that were not run the value of the
    /// coarse cell before them.
    fn infer(&mut self, half: usize, stride: usize, columns: usize, rows: usize) {
        for index in grid(columns, rows, half) {
            if self.cells[index].is_none() {
                let (column, row) = (index % columns, index / columns);
                let from = (row / stride * stride) * columns + column / stride * stride;
                self.cells[index] = self.cells[from];
            }
        }
    }
}

/// Cells on multiples of `stride`, with the last column and row always in.
fn grid(columns: usize, rows: usize, stride: usize) -> Vec<usize> {
    let line = |count: usize| {
        (0..count).filter(move |&i| i % stride == 0 || i + 1 == count).collect::<Vec<_>>()
    };
    let across = line(columns);
    line(rows)
        .into_iter()
        .flat_map(|row| across.iter().map(move |&column| row * columns + column))
        .collect()
}
