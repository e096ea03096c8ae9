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

    /// How many rows each side has.
    pub fn rows_per_side(&self) -> usize {
        self.rows_per_side
    }

    /// Whether a side is one row.
    pub fn is_by_side(&self) -> bool {
        self.rows_per_side == 1
    }

    /// The rows of a side.
    pub fn of_side(&self, side: u32) -> &[u32] {
        let first = side as usize * self.rows_per_side;
        &self.of_sides[first..first + self.rows_per_side]
    }
}

/// Some rows as columns of numbers, four at a time; the last is repeated, without
/// stiffness, until they are whole fours.
#[derive(Clone, Debug, Default)]
pub(in crate::motion) struct Columns {
    pub index: Vec<u32>,
    pub side: Vec<u32>,
    pub fours: Vec<Four>,
    pub latest: usize,
}

/// Four rows side by side.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::motion) struct Four {
    /// Direction at rest, `(cos psi, sin psi)`.
    pub cosine: [f64; 4],
    pub sine: [f64; 4],
    /// `Disk::shape_of`.
    pub shape: [[f64; 4]; 2],
    /// Stiffness of the lining under all blades of a row \[N/m\].
    pub stiffness: [f64; 4],
    /// Angle \[rad\] and torque \[N m\] of each row, where there are not only two modes.
    pub angle: [f64; 4],
    pub torque: [f64; 4],
    /// Push on the blades of a row, that of the latest step at the place `latest` and that
    /// of the step before, and the sum of the pushes since it was given to the record
    /// \[N\].
    pub pushes: [[f64; 4]; 2],
    pub impulse: [f64; 4],
}

impl Columns {
    /// These rows of a disk under a lining of this stiffness for each blade, with the
    /// directions of their sides and their shapes.
    pub fn of(
        rows: &[u32],
        table: &RowTable,
        stiffness_n_per_m: f64,
        direction: impl Fn(u32) -> (f64, f64),
        shape: impl Fn(u32) -> (f64, f64),
    ) -> Self {
        let side: Vec<u32> = rows.iter().map(|&row| table.side[row as usize]).collect();
        let each = f64::from(table.blades_per_row) * stiffness_n_per_m;
        let four = |(rows, sides): (&[u32], &[u32])| {
            let last = rows.len() - 1;
            let column = |of: &dyn Fn(usize) -> f64| [0, 1, 2, 3].map(|k: usize| of(k.min(last)));
            Four {
                cosine: column(&|k| direction(sides[k]).0),
                sine: column(&|k| direction(sides[k]).1),
                shape: [column(&|k| shape(rows[k]).0), column(&|k| shape(rows[k]).1)],
                stiffness: [0, 1, 2, 3].map(|k| if k <= last { each } else { 0.0 }),
                ..Four::default()
            }
        };
        let fours = rows.chunks(4).zip(side.chunks(4)).map(four).collect();
        Self { index: rows.to_vec(), side, fours, latest: 0 }
    }

    /// Takes the angle of each row from this; those that pad a four have that of its last.
    pub fn put_angles(&mut self, mut angle: impl FnMut(u32) -> f64) {
        for (four, rows) in self.fours.iter_mut().zip(self.index.chunks(4)) {
            let mut last = 0.0;
            for (k, place) in four.angle.iter_mut().enumerate() {
                if let Some(&row) = rows.get(k) {
                    last = angle(row);
                }
                *place = last;
            }
        }
    }

    /// Index and side of each row, and this value of it.
    pub fn each(
        &self,
        value: impl Fn(&Four) -> [f64; 4] + Clone,
    ) -> impl Iterator<Item = (u32, u32, f64)> + Clone {
        let values = self.fours.iter().flat_map(value);
        let rows = self.index.iter().zip(&self.side);
        rows.zip(values).map(|((&index, &side), value)| (index, side, value))
    }

    /// The push of each row in the latest step \[N\].
    pub fn pushes(&self) -> impl Iterator<Item = (u32, u32, f64)> + Clone {
        self.each(|four| four.pushes[self.latest & 1])
    }

    /// The same in the step before \[N\].
    pub fn before(&self) -> impl Iterator<Item = (u32, u32, f64)> + Clone {
        self.each(|four| four.pushes[(self.latest ^ 1) & 1])
    }

    /// Puts the push of the row at a place in the latest step \[N\].
    pub fn put_push(&mut self, place: usize, push: f64) {
        self.fours[place / 4].pushes[self.latest & 1][place % 4] = push;
    }
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

    #[test]
    fn what_pads_a_four_is_its_last_row_without_stiffness() {
        let table = RowTable::new(&Scene::base().machine(), 1);
        let rows: Vec<u32> = (3..9).collect();
        let shape = |row: u32| (f64::from(row), -f64::from(row));
        let mut columns = Columns::of(&rows, &table, 2.0, |side| (f64::from(side), 0.5), shape);
        columns.put_angles(|row| 0.1 * f64::from(row));
        let [first, last] = [columns.fours[0], columns.fours[1]];
        assert_eq!(first.shape, [[3.0, 4.0, 5.0, 6.0], [-3.0, -4.0, -5.0, -6.0]]);
        assert_eq!((first.stiffness, last.stiffness), ([2.0; 4], [2.0, 2.0, 0.0, 0.0]));
        assert_eq!(last.shape[0], [7.0, 8.0, 8.0, 8.0]);
        assert_eq!(last.angle, [7.0, 8.0, 8.0, 8.0].map(|row| 0.1 * row));
        assert_eq!(last.cosine[1..], [f64::from(table.side[8]); 3]);
    }
}
