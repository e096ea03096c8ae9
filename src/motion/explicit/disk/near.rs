//! Rows of mode shapes of the blades near contact: they are asked for in step
//! after step, and of a large ring all of them would be `N^2` numbers.

use std::sync::Arc;

use super::shapes::Shapes;
use crate::tolerances::ROWS_NEAR;

/// The rows asked for last.
#[derive(Clone, Debug, Default)]
pub(in crate::motion) struct NearRows {
    rows: Vec<(u32, Arc<[f64]>)>,
    /// Place of the oldest, once there are enough.
    oldest: usize,
}

impl NearRows {
    /// The row of a blade (from 0).
    pub fn row<'a>(&'a mut self, shapes: &'a Shapes, blade: u32) -> &'a [f64] {
        if let Some(row) = shapes.kept(blade as usize) {
            return row;
        }
        let place = match self.rows.iter().position(|(known, _)| *known == blade) {
            Some(place) => place,
            None => self.make(shapes, blade),
        };
        &self.rows[place].1
    }

    /// Makes a row, instead of the oldest where there are enough; its place.
    fn make(&mut self, shapes: &Shapes, blade: u32) -> usize {
        let row = (blade, shapes.row(blade as usize).into());
        if self.rows.len() < ROWS_NEAR {
            self.rows.push(row);
            return self.rows.len() - 1;
        }
        let place = self.oldest;
        self.rows[place] = row;
        self.oldest = (place + 1) % ROWS_NEAR;
        place
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_row_is_that_of_its_blade_however_often_and_in_whatever_order() {
        for count in [22, 131, 220] {
            let (shapes, mut near) = (Shapes::new(count), NearRows::default());
            for step in 0..500 {
                let blade = (step * step / 7) % count;
                assert_eq!(near.row(&shapes, blade), shapes.row(blade as usize), "{step}");
            }
            assert!(near.rows.len() <= ROWS_NEAR);
            assert_eq!(near.rows.is_empty(), count == 22);
        }
    }
}
