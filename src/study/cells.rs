//! The cells of a map in memory: a byte each, so that a large map is limited by
//! its runs and not by its memory.

use std::ops::Index;
use std::sync::atomic::{AtomicU8, Ordering};

use crate::motion::Verdict;

/// One cell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cell {
    /// How the motion lasts.
    pub verdict: Verdict,
    /// Whether a tiny change of the run changes it.
    pub sensitive: bool,
}

/// What a byte means: nothing computed, then each verdict, first plain, then
/// sensitive.
static MEANING: [Option<Cell>; 1 + 2 * KINDS] = {
    let mut meaning = [None; 1 + 2 * KINDS];
    let mut kind = 0;
    while kind < KINDS {
        let verdict = Verdict::ALL[kind];
        meaning[1 + kind] = Some(Cell { verdict, sensitive: false });
        meaning[1 + KINDS + kind] = Some(Cell { verdict, sensitive: true });
        kind += 1;
    }
    meaning
};
const KINDS: usize = Verdict::ALL.len();

/// Cells in order; none where nothing is computed. Threads may set different
/// cells at the same time.
#[derive(Debug)]
pub struct Cells(Vec<AtomicU8>);

impl Cells {
    /// So many cells with nothing computed.
    #[must_use]
    pub fn empty(count: usize) -> Self {
        Self((0..count).map(|_| AtomicU8::new(0)).collect())
    }

    /// How many cells there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Whether there are no cells.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// A cell; none where there is no such place.
    #[must_use]
    pub fn get(&self, index: usize) -> Option<&'static Option<Cell>> {
        MEANING.get(usize::from(self.0.get(index)?.load(Ordering::Relaxed)))
    }

    /// Sets a cell; a place that does not exist takes nothing.
    pub fn set(&self, index: usize, cell: Option<Cell>) {
        let byte = MEANING.iter().position(|meaning| *meaning == cell).unwrap_or_default();
        if let (Some(place), Ok(byte)) = (self.0.get(index), u8::try_from(byte)) {
            place.store(byte, Ordering::Relaxed);
        }
    }

    /// All cells in order.
    pub fn iter(&self) -> impl Iterator<Item = &'static Option<Cell>> + '_ {
        (0..self.len()).filter_map(|index| self.get(index))
    }
}

impl Index<usize> for Cells {
    type Output = Option<Cell>;
    fn index(&self, index: usize) -> &Option<Cell> {
        &MEANING[usize::from(self.0[index].load(Ordering::Relaxed))]
    }
}

impl Clone for Cells {
    fn clone(&self) -> Self {
        let byte = |cell: &AtomicU8| AtomicU8::new(cell.load(Ordering::Relaxed));
        Self(self.0.iter().map(byte).collect())
    }
}

impl PartialEq for Cells {
    fn eq(&self, other: &Self) -> bool {
        self.len() == other.len() && self.iter().eq(other.iter())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_cell_has_a_byte_of_its_own() {
        let cells = Cells::empty(MEANING.len() + 1);
        for (index, meaning) in MEANING.iter().enumerate() {
            cells.set(index, *meaning);
        }
        assert!(cells.iter().zip(&MEANING).all(|(cell, meaning)| cell == meaning));
        assert_eq!((cells[MEANING.len()], cells.get(MEANING.len() + 1)), (None, None));
        assert_eq!(cells.iter().flatten().count(), 2 * KINDS);
        assert_eq!(cells.clone(), cells);
        cells.set(3, None);
        assert!(cells[3].is_none());
    }
}
