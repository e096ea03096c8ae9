//! A few linear equations, by Gauss elimination with partial pivoting: an error of
//! round-off times the condition of the equations, `size^3/3` multiplications, no memory
//! but that of the equations.

/// Gauss elimination with partial pivoting of `size` equations, each followed by
/// its right side, where the solution is afterwards. `None` where they are
/// singular.
pub(crate) fn eliminate(equations: &mut [f64], size: usize) -> Option<()> {
    let width = size + 1;
    for k in 0..size {
        let entry = |row: usize| equations[row * width + k].abs();
        let pivot = (k..size).max_by(|&a, &b| entry(a).total_cmp(&entry(b)))?;
        if pivot != k {
            let (above, below) = equations.split_at_mut(pivot * width);
            above[k * width..(k + 1) * width].swap_with_slice(&mut below[..width]);
        }
        let (above, below) = equations.split_at_mut((k + 1) * width);
        let row = &above[k * width..];
        if row[k] == 0.0 {
            return None;
        }
        for other in below.chunks_exact_mut(width) {
            let factor = other[k] / row[k];
            for (value, above) in other[k..].iter_mut().zip(&row[k..]) {
                *value -= factor * above;
            }
        }
    }
    for k in (0..size).rev() {
        let (above, below) = equations.split_at_mut((k + 1) * width);
        let row = &mut above[k * width..];
        let later = row[k + 1..size].iter().zip(below.chunks_exact(width));
        let known: f64 = later.map(|(factor, other)| factor * other[size]).sum();
        row[size] = (row[size] - known) / row[k];
    }
    Some(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equations_are_solved_and_singular_ones_are_not() {
        let solved = |mut equations: Vec<f64>, size: usize| {
            eliminate(&mut equations, size)?;
            Some((0..size).map(|k| equations[k * (size + 1) + size]).collect::<Vec<f64>>())
        };
        assert_eq!(solved(Vec::new(), 0), Some(Vec::new()));
        // A pivot of zero and one that is small beside the others.
        let equations = vec![0.0, 2.0, 1.0, 7.0, 1e-20, 1.0, 1.0, 5.0, 4.0, 1.0, -1.0, 3.0];
        assert_eq!(solved(equations, 3), Some(vec![1.0, 2.0, 3.0]));
        assert_eq!(solved(vec![1.0, 2.0, 3.0, 2.0, 4.0, 6.0], 2), None);
    }
}
