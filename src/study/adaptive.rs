//! Adaptive maps: a coarse grid first, then only cells next to a change, down
//! to the resolution of the plan; then each border is followed to its ends.
//! Cells that were not run take the value of their coarse cell.
//!
//! In the result every cell next to another verdict was run, so a zone that any
//! run hit has the same shape as in the full map. A zone smaller than the
//! coarse grid that no run hit is missed. Only verdicts count as a change:
//! sensitive cells are scattered, and following them would run every cell.

use std::sync::atomic::Ordering;

use rayon::prelude::*;

use super::{Cell, Map, Progress};

/// Coarsest stride between computed cells.
const COARSEST: usize = 8;
/// Least number of coarse cells along the shorter side, if the map has that many.
const FEWEST: usize = 6;

type Keep<'a> = &'a (dyn Fn(usize, Cell) + Sync);

impl Map {
    /// Fills the map adaptively; cells inferred without a run are not counted
    /// in `runs`. If stopped early, only cells that were run remain.
    pub fn fill_adaptively(&mut self, progress: &Progress, keep: Keep<'_>) {
        self.adaptive = true;
        let mut stride = self.coarsest_stride();
        let mut inferred = vec![false; self.cells.len()];
        let coarse: Vec<usize> = self.grid(stride).collect();
        self.fill(coarse.into_par_iter(), progress, keep);
        while stride > 1 && !progress.stop.load(Ordering::Relaxed) {
            let half = stride / 2;
            let wanted: Vec<usize> = self
                .grid(half)
                .filter(|&index| self.cells[index].is_none() && self.is_mixed(index, stride))
                .collect();
            self.fill(wanted.into_par_iter(), progress, keep);
            if !progress.stop.load(Ordering::Relaxed) {
                self.infer(half, stride, &mut inferred);
            }
            stride = half;
        }
        self.follow_borders(&mut inferred, progress, keep);
        if progress.stop.load(Ordering::Relaxed) {
            for (index, _) in inferred.iter().enumerate().filter(|(_, guess)| **guess) {
                self.cells.set(index, None);
            }
        }
    }

    /// The first stride: the largest power of two, up to `COARSEST`, that
    /// leaves `FEWEST` cells along the shorter side.
    #[must_use]
    pub fn coarsest_stride(&self) -> usize {
        let shorter = self.plan.x.count.min(self.plan.y.count) as usize;
        let mut stride = 1;
        while 2 * stride <= COARSEST && 2 * stride * FEWEST <= shorter {
            stride *= 2;
        }
        stride
    }

    /// Runs inferred cells next to another verdict until there are none.
    fn follow_borders(&mut self, inferred: &mut [bool], progress: &Progress, keep: Keep<'_>) {
        while !progress.stop.load(Ordering::Relaxed) {
            let doubtful: Vec<usize> = (0..inferred.len())
                .filter(|&index| inferred[index] && self.is_beside_another(index))
                .collect();
            if doubtful.is_empty() {
                break;
            }
            for &index in &doubtful {
                inferred[index] = false;
                self.cells.set(index, None);
            }
            self.fill(doubtful.into_par_iter(), progress, keep);
        }
    }

    fn is_beside_another(&self, index: usize) -> bool {
        let (columns, rows) = (self.plan.x.count as usize, self.plan.y.count as usize);
        let (column, row) = (index % columns, index / columns);
        let verdict = |index: usize| self.cells[index].map(|cell| cell.verdict);
        let here = verdict(index);
        let across = column.saturating_sub(1)..=(column + 1).min(columns - 1);
        (row.saturating_sub(1)..=(row + 1).min(rows - 1))
            .any(|y| across.clone().any(|x| verdict(y * columns + x) != here))
    }

    /// Whether the verdicts of the coarse cells around `index` differ,
    /// including the neighbours of its own coarse cell.
    fn is_mixed(&self, index: usize, stride: usize) -> bool {
        let (columns, rows) = (self.plan.x.count as usize, self.plan.y.count as usize);
        let (column, row) = (index % columns, index / columns);
        let mut seen = None;
        for y in (row / stride).saturating_sub(1)..=row / stride + 2 {
            for x in (column / stride).saturating_sub(1)..=column / stride + 2 {
                let (x, y) = ((x * stride).min(columns - 1), (y * stride).min(rows - 1));
                let Some(cell) = self.cells[y * columns + x] else { continue };
                if seen.is_some_and(|seen| seen != cell.verdict) {
                    return true;
                }
                seen = Some(cell.verdict);
            }
        }
        false
    }

    /// Gives the cells of the finer grid that were not run the value of the
    /// coarse cell before them.
    fn infer(&self, half: usize, stride: usize, inferred: &mut [bool]) {
        let columns = self.plan.x.count as usize;
        for index in self.grid(half) {
            if self.cells[index].is_none() {
                let (column, row) = (index % columns, index / columns);
                let from = (row / stride * stride) * columns + column / stride * stride;
                self.cells.set(index, self.cells[from]);
                inferred[index] = true;
            }
        }
    }

    /// Cells on multiples of `stride`, with the last column and row always in.
    fn grid(&self, stride: usize) -> impl Iterator<Item = usize> + use<> {
        let line =
            move |count: usize| (0..count).filter(move |&i| i % stride == 0 || i + 1 == count);
        let (columns, rows) = (self.plan.x.count as usize, self.plan.y.count as usize);
        line(rows).flat_map(move |row| line(columns).map(move |column| row * columns + column))
    }
}
