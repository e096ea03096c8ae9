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

    /// The rows of a side.
    pub fn of_side(&self, side: u32) -> &[u32] {
        let first = side as usize * self.rows_per_side;
        &self.of_sides[first..first + self.rows_per_side]
    }
}

/// Some rows as columns of numbers, one entry a row.
#[derive(Clone, Debug, Default)]
pub(in crate::motion) struct Columns {
    pub index: Vec<u32>,
    pub side: Vec<u32>,
    /// Direction at rest, `cos psi` and `sin psi`.
    pub cosine: Vec<f64>,
    pub sine: Vec<f64>,
    /// `Disk::shape_of`.
    pub shape: [Vec<f64>; 2],
    /// Stiffness of the lining under all blades of a row \[N/m\].
    pub stiffness: Vec<f64>,
    /// Angle of each row \[rad\], unless two modes are all that moves.
    pub angle: Vec<f64>,
    /// Direction with the phase of the blades.
    pub normal: [Vec<f64>; 2],
    /// Depth in the lining \[m\].
    pub depth: Vec<f64>,
    /// Push on the blades of a row and its torque in the latest step, and the push in the step
    /// before \[N, N m\].
    pub push: Vec<f64>,
    pub torque: Vec<f64>,
    pub before: Vec<f64>,
    /// Sum of the pushes since it was given to the record \[N\].
    pub impulse: Vec<f64>,
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
        let (cosine, sine) = side.iter().map(|&side| direction(side)).unzip();
        let shapes: (Vec<f64>, Vec<f64>) = rows.iter().map(|&row| shape(row)).unzip();
        let [zeros, each] = [0.0, f64::from(table.blades_per_row) * stiffness_n_per_m]
            .map(|value| vec![value; rows.len()]);
        Self {
            index: rows.to_vec(),
            side,
            cosine,
            sine,
            shape: shapes.into(),
            stiffness: each,
            angle: zeros.clone(),
            normal: [zeros.clone(), zeros.clone()],
            depth: zeros.clone(),
            push: zeros.clone(),
            torque: zeros.clone(),
            before: zeros.clone(),
            impulse: zeros,
        }
    }

    /// Returns index and side of each row with its entry in a column.
    pub fn each<'a>(
        &'a self,
        column: &'a [f64],
    ) -> impl Iterator<Item = (u32, u32, f64)> + Clone + 'a {
        let rows = self.index.iter().zip(&self.side).zip(column);
        rows.map(|((&index, &side), &value)| (index, side, value))
    }
}

/// Returns the sum of the products of two columns, four sums side by side.
pub(in crate::motion) fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let ((fours, left), (others, more)) = (a.as_chunks::<4>(), b.as_chunks::<4>());
    for (a, b) in fours.iter().zip(others) {
        for lane in 0..4 {
            sums[lane] += a[lane] * b[lane];
        }
    }
    for (sum, (a, b)) in sums.iter_mut().zip(left.iter().zip(more)) {
        *sum += a * b;
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}

/// Returns the sum of a column, added up as `dot` does.
pub(in crate::motion) fn total(column: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    let (fours, left) = column.as_chunks::<4>();
    for four in fours {
        for lane in 0..4 {
            sums[lane] += four[lane];
        }
    }
    sums.iter_mut().zip(left).for_each(|(sum, x)| *sum += x);
    (sums[0] + sums[1]) + (sums[2] + sums[3])
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
