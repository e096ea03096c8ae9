//! The two contact laws on predicted gaps, in double-double.
//!
//! Corrected gaps are `g = g* - W lambda` with `W = C^T [M/h^2 + D/2h]^-1 C`.
//! Blades of one phase group at the same angle make rows of `W` that are equal
//! to 8 to 20 digits: 32 digits distinguish them, and rows that are equal even
//! then are left out, because another row has the same effect.

use super::dd::{Dd, ZERO};

/// Part of its diagonal below which a pivot counts as zero: rows that depend on
/// the rows before them. Pivots carry an error of some 1e-31.
const DEPENDENT: f64 = 1e-26;
/// Part of the deepest penetration to which a gap counts as closed.
const CLOSED: f64 = 1e-24;

/// The matrix `W`, row by row.
pub type Matrix = Vec<Vec<Dd>>;

/// Cholesky factor of the rows and columns `chosen` of `w`. Err with the place
/// of the first row that depends on those before it.
fn factor(w: &Matrix, chosen: &[usize]) -> Result<Matrix, usize> {
    let mut l: Matrix = Vec::with_capacity(chosen.len());
    for (i, &row) in chosen.iter().enumerate() {
        let mut line = Vec::with_capacity(i + 1);
        for (j, &column) in chosen.iter().enumerate().take(i + 1) {
            let other = if j < i { &l[j] } else { &line };
            let done: Dd = (0..j).map(|k| line[k] * other[k]).sum();
            let rest = w[row][column] - done;
            if j < i {
                line.push(rest / l[j][j]);
            } else if rest.0 > DEPENDENT * w[row][row].0 {
                line.push(rest.sqrt());
            } else {
                return Err(i);
            }
        }
        l.push(line);
    }
    Ok(l)
}

/// Solves `L L^T x = b`.
fn solve(l: &Matrix, b: &[Dd]) -> Vec<Dd> {
    let n = l.len();
    let mut x = b.to_vec();
    for i in 0..n {
        let done: Dd = (0..i).map(|k| l[i][k] * x[k]).sum();
        x[i] = (x[i] - done) / l[i][i];
    }
    for i in (0..n).rev() {
        let done: Dd = (i + 1..n).map(|k| l[k][i] * x[k]).sum();
        x[i] = (x[i] - done) / l[i][i];
    }
    x
}

/// Every row closed as an equality. None where rows contradict each other.
pub fn bilateral(w: &Matrix, gap: &[Dd]) -> Option<Vec<Dd>> {
    let mut chosen: Vec<usize> = (0..gap.len()).collect();
    let l = loop {
        match factor(w, &chosen) {
            Ok(l) => break l,
            Err(place) => chosen.remove(place),
        };
    };
    let part = solve(&l, &chosen.iter().map(|&row| gap[row]).collect::<Vec<_>>());
    let mut lambda = vec![ZERO; gap.len()];
    for (&row, value) in chosen.iter().zip(part) {
        lambda[row] = value;
    }
    let deepest = gap.iter().fold(0.0_f64, |most, g| most.max(g.0.abs()));
    let consistent =
        (0..gap.len()).all(|row| after(w, gap, &lambda, row).0.abs() <= 1e-18 * deepest);
    consistent.then_some(lambda)
}

/// Gap of one row after the correction, linearised.
fn after(w: &Matrix, gap: &[Dd], lambda: &[Dd], row: usize) -> Dd {
    gap[row] - lambda.iter().enumerate().map(|(j, &value)| w[row][j] * value).sum()
}

/// Signorini: `g >= 0`, `lambda <= 0`, `g lambda = 0`, by the active sets of Lawson
/// and Hanson (1974, ch. 23) on pushes `-lambda >= 0`: the deepest row left is closed,
/// and rows that would have to pull for it are released. The corrections are unique
/// even where the multipliers are not. None where no correction opens all gaps.
pub fn unilateral(w: &Matrix, gap: &[Dd]) -> Option<Vec<Dd>> {
    let rows = gap.len();
    let deepest = gap.iter().fold(0.0_f64, |most, g| most.max(-g.0));
    let mut lambda = vec![ZERO; rows];
    let mut chosen: Vec<usize> = Vec::new();
    for _ in 0..(100 + 20 * rows) {
        let left: Vec<Dd> = (0..rows).map(|row| after(w, gap, &lambda, row)).collect();
        let worst = (0..rows)
            .filter(|row| !chosen.contains(row))
            .min_by(|&a, &b| left[a].0.total_cmp(&left[b].0));
        let Some(entering) = worst.filter(|&row| left[row].0 < -CLOSED * deepest) else {
            return Some(lambda);
        };
        chosen.push(entering);
        // Each turn releases at least one row.
        loop {
            let target = aim(w, gap, &chosen)?;
            let stops = |&place: &usize| {
                let to = target.values[place].0;
                to > 0.0 || (to == 0.0 && !target.is_direction)
            };
            // Part of the way at which a push is used up.
            let share = |place: usize| {
                let (from, to) = (lambda[chosen[place]], target.values[place]);
                if from == ZERO {
                    ZERO
                } else if target.is_direction {
                    -from / to
                } else {
                    from / (from - to)
                }
            };
            let first = (0..chosen.len())
                .filter(stops)
                .map(|place| (share(place), place))
                .min_by(|a, b| a.0.0.total_cmp(&b.0.0));
            let Some((part, leaving)) = first else {
                if target.is_direction {
                    return None;
                }
                for (&row, &value) in chosen.iter().zip(&target.values) {
                    lambda[row] = value;
                }
                break;
            };
            for (&row, &value) in chosen.iter().zip(&target.values) {
                let change = if target.is_direction { value } else { value - lambda[row] };
                lambda[row] += part * change;
            }
            lambda[chosen[leaving]] = ZERO;
            chosen.remove(leaving);
        }
    }
    None
}

/// The target of the multipliers of the chosen rows.
struct Target {
    values: Vec<Dd>,
    /// A direction without end instead of a point: the last row depends on the
    /// others, and its push grows at their expense until one has none left.
    is_direction: bool,
}

fn aim(w: &Matrix, gap: &[Dd], chosen: &[usize]) -> Option<Target> {
    match factor(w, chosen) {
        Ok(l) => {
            let values = solve(&l, &chosen.iter().map(|&row| gap[row]).collect::<Vec<_>>());
            Some(Target { values, is_direction: false })
        }
        Err(place) if place + 1 == chosen.len() => {
            let (others, last) = (&chosen[..place], chosen[place]);
            let l = factor(w, others).ok()?;
            let b: Vec<Dd> = others.iter().map(|&row| w[row][last]).collect();
            // -1 for the new row pushes; the others respond.
            let mut values = solve(&l, &b);
            values.push(Dd::from(-1.0));
            Some(Target { values, is_direction: true })
        }
        Err(_) => None,
    }
}
