//! Which blades make one constraint row: those that nothing tells apart.

use crate::model::Machine;

/// The rows of a disk. The blades of a row are `row`, `row + rows`, `row + 2 rows` and so
/// on, from 0.
#[derive(Clone, Debug)]
pub(in crate::motion) struct RowTable {
    /// Side of the polygon of each row.
    pub side: Vec<u32>,
    /// Blades of each row.
    pub blades_per_row: u32,
    /// Rows of each side, side after side.
    of_sides: Vec<u32>,
    rows_per_side: usize,
}

impl RowTable {
    /// Rows of `blades_per_row` blades, which divides the blades of a side.
    pub fn new(machine: &Machine, blades_per_row: u32) -> Self {
        let polygon = &machine.polygon;
        let count = polygon.blades / blades_per_row.max(1);
        let side: Vec<u32> = (0..count).map(|row| polygon.side_of_blade(row + 1)).collect();
        let mut of_sides: Vec<u32> = (0..count).collect();
        of_sides.sort_by_key(|&row| side[row as usize]);
        let rows_per_side = count as usize / polygon.sides as usize;
        Self { side, blades_per_row, of_sides, rows_per_side }
    }

    pub fn count(&self) -> usize {
        self.side.len()
    }

    /// Returns how many rows each side has.
    pub fn rows_per_side(&self) -> usize {
        self.rows_per_side
    }

    /// Returns the rows of a side.
    pub fn of_side(&self, side: u32) -> &[u32] {
        let first = side as usize * self.rows_per_side;
        &self.of_sides[first..first + self.rows_per_side]
    }
}

/// Some rows with their numbers, four rows side by side. The last row fills up the last four,
/// without stiffness.
#[derive(Clone, Debug, Default)]
pub(in crate::motion) struct Columns {
    pub index: Vec<u32>,
    pub side: Vec<u32>,
    pub fours: Vec<Four>,
}

/// One number of each of four rows.
pub(in crate::motion) type Lanes = [f64; 4];

/// Four rows side by side, which one pass of vector instructions takes.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::motion) struct Four {
    /// Direction at rest, `cos psi` and `sin psi`.
    pub cosine: Lanes,
    pub sine: Lanes,
    /// `Disk::shape_of`; where not only two modes move, the angle of the row \[rad\] and zero, see
    /// `Disk::amplitudes`.
    pub shape: [Lanes; 2],
    /// Stiffness of the lining under all blades of a row \[N/m\].
    pub stiffness: Lanes,
    /// Push on the blades of a row and its torque in the latest step, and the push in the step
    /// before \[N, N m\].
    pub push: Lanes,
    pub torque: Lanes,
    pub before: Lanes,
    /// Sum of the pushes since it was given to the record \[N\].
    pub impulse: Lanes,
}

impl Columns {
    /// Creates the columns of these rows of a disk under a lining of this stiffness for each
    /// blade, with the directions of their sides and their shapes.
    pub fn of(
        rows: &[u32],
        table: &RowTable,
        stiffness_n_per_m: f64,
        direction: impl Fn(u32) -> (f64, f64),
        shape: impl Fn(u32) -> (f64, f64),
    ) -> Self {
        let side: Vec<u32> = rows.iter().map(|&row| table.side[row as usize]).collect();
        let each = f64::from(table.blades_per_row) * stiffness_n_per_m;
        let mut fours = vec![Four::default(); rows.len().div_ceil(4)];
        for place in 0..4 * fours.len() {
            let (four, lane) = (&mut fours[place / 4], place % 4);
            let row = place.min(rows.len() - 1);
            (four.cosine[lane], four.sine[lane]) = direction(side[row]);
            (four.shape[0][lane], four.shape[1][lane]) = shape(rows[row]);
            four.stiffness[lane] = if row == place { each } else { 0.0 };
        }
        Self { index: rows.to_vec(), side, fours }
    }

    /// Takes the angle of each row from `angle`.
    pub fn put_angles(&mut self, mut angle: impl FnMut(u32) -> f64) {
        let mut last = 0.0;
        for (four, rows) in self.fours.iter_mut().zip(self.index.chunks(4)) {
            for (lane, place) in four.shape[0].iter_mut().enumerate() {
                last = rows.get(lane).map_or(last, |row| angle(*row));
                *place = last;
            }
        }
    }

    /// Returns index and side of each row with one of its numbers.
    pub fn each<T: Copy>(
        &self,
        value: impl Fn(&Four) -> [T; 4] + Clone,
    ) -> impl Iterator<Item = (u32, u32, T)> + Clone {
        let rows = self.index.iter().zip(&self.side);
        rows.zip(self.fours.iter().flat_map(value)).map(|((&row, &side), value)| (row, side, value))
    }
}

/// Returns the sum of four numbers.
pub(in crate::motion) fn total([a, b, c, d]: Lanes) -> f64 {
    (a + b) + (c + d)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn blades_that_nothing_tells_apart_share_their_side() {
        for (diameters, per_row) in [(3, 1), (4, 2), (4, 1), (0, 22), (11, 11)] {
            let mut scene = Scene::base();
            scene.operation.nodal_diameters = diameters;
            let machine = scene.machine();
            let table = RowTable::new(&machine, per_row);
            assert_eq!(table.count() as u32 * per_row, 22);
            for row in 0..table.count() as u32 {
                let side = table.side[row as usize];
                assert!(table.of_side(side).contains(&row));
                for member in 0..per_row {
                    let blade = row + member * table.count() as u32 + 1;
                    assert_eq!(machine.polygon.side_of_blade(blade), side);
                }
            }
        }
    }
}
