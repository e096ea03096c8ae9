//! Which blades make one constraint row: those that nothing tells apart.

use wide::f64x4;

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

/// Up to four numbers, filled up by another.
fn fours(part: &[f64], filling: f64) -> f64x4 {
    let mut four = [filling; 4];
    four[..part.len()].copy_from_slice(part);
    f64x4::from(four)
}

/// Some rows as columns of numbers, four at a time; the last is repeated, of no blade.
#[derive(Clone, Debug, Default)]
pub(in crate::motion) struct Columns {
    pub index: Vec<u32>,
    pub side: Vec<u32>,
    /// Direction of each row at rest, `(cos psi, sin psi)`.
    pub cosine: Vec<f64x4>,
    pub sine: Vec<f64x4>,
    /// `Disk::shape_of` each row.
    pub shapes: [Vec<f64x4>; 2],
    /// Blades of each row.
    pub blades: Vec<f64x4>,
}

impl Columns {
    /// These rows of a disk, with the directions of their sides and their shapes.
    pub fn of(
        rows: &[u32],
        table: &RowTable,
        direction: impl Fn(u32) -> (f64, f64),
        shape: impl Fn(u32) -> (f64, f64),
    ) -> Self {
        let side: Vec<u32> = rows.iter().map(|&row| table.side[row as usize]).collect();
        let column = |of: &dyn Fn(usize) -> f64| -> Vec<f64x4> {
            let values: Vec<f64> = (0..rows.len()).map(of).collect();
            values.chunks(4).map(|part| fours(part, part[part.len() - 1])).collect()
        };
        let each = f64::from(table.blades_per_row);
        Self {
            index: rows.to_vec(),
            cosine: column(&|place| direction(side[place]).0),
            sine: column(&|place| direction(side[place]).1),
            shapes: [column(&|place| shape(rows[place]).0), column(&|place| shape(rows[place]).1)],
            blades: vec![each; rows.len()].chunks(4).map(|part| fours(part, 0.0)).collect(),
            side,
        }
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
}
