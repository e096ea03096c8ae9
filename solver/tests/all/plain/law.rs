//! The two contact laws on predicted gaps. Corrected gaps are `g = g* - W lambda` with
//! `W = C^T [M/h^2 + D/2h]^-1 C`. Rows of `W` that are equal to round-off are left out,
//! because another row has the same effect.

/// Part of its diagonal below which a pivot counts as zero: rows that depend on
/// the rows before them.
const DEPENDENT: f64 = 1e-12;
/// Part of the deepest penetration to which a gap counts as closed.
const CLOSED: f64 = 1e-12;

/// The matrix `W`, row by row.
pub type Matrix = Vec<Vec<f64>>;

/// Cholesky factor of the rows and columns `chosen` of `w`. Err with the place
/// of the first row that depends on those before it.
fn factor(w: &Matrix, chosen: &[usize]) -> Result<Matrix, usize> {
    let mut l: Matrix = Vec::with_capacity(chosen.len());
    for (i, &row) in chosen.iter().enumerate() {
        let mut line = Vec::with_capacity(i + 1);
        for (j, &column) in chosen.iter().enumerate().take(i + 1) {
            let other = if j < i { &l[j] } else { &line };
            let done: f64 = (0..j).map(|k| line[k] * other[k]).sum();
            let rest = w[row][column] - done;
            if j < i {
                line.push(rest / l[j][j]);
            } else if rest > DEPENDENT * w[row][row] {
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
fn solve(l: &Matrix, b: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut x: Vec<f64> = b.collect();
    for i in 0..x.len() {
        let done: f64 = (0..i).map(|k| l[i][k] * x[k]).sum();
        x[i] = (x[i] - done) / l[i][i];
    }
    for i in (0..x.len()).rev() {
        let done: f64 = (i + 1..x.len()).map(|k| l[k][i] * x[k]).sum();
        x[i] = (x[i] - done) / l[i][i];
    }
    x
}

/// Gap of one row after the correction, linearised.
fn after(w: &Matrix, gap: &[f64], lambda: &[f64], row: usize) -> f64 {
    gap[row] - lambda.iter().zip(&w[row]).map(|(value, w)| w * value).sum::<f64>()
}

/// Every row closed as an equality. None where rows contradict each other.
pub fn bilateral(w: &Matrix, gap: &[f64]) -> Option<Vec<f64>> {
    let mut chosen: Vec<usize> = (0..gap.len()).collect();
    let l = loop {
        match factor(w, &chosen) {
            Ok(l) => break l,
            Err(place) => chosen.remove(place),
        };
    };
    let mut lambda = vec![0.0; gap.len()];
    for (&row, value) in chosen.iter().zip(solve(&l, chosen.iter().map(|&row| gap[row]))) {
        lambda[row] = value;
    }
    let deepest = gap.iter().fold(0.0_f64, |most, g| most.max(g.abs()));
    let closed = |row| after(w, gap, &lambda, row).abs() <= 1e-6 * deepest;
    (0..gap.len()).all(closed).then_some(lambda)
}

/// Signorini: `g >= 0`, `lambda <= 0`, `g lambda = 0`, by the active sets of Lawson
/// and Hanson (1974, ch. 23) on pushes `-lambda >= 0`: the deepest row left is closed,
/// and rows that would have to pull for it are released. The corrections are unique
/// even where the multipliers are not. None where no correction opens all gaps.
pub fn unilateral(w: &Matrix, gap: &[f64]) -> Option<Vec<f64>> {
    let rows = gap.len();
    let deepest = gap.iter().fold(0.0_f64, |most, g| most.max(-g));
    let mut lambda = vec![0.0; rows];
    let mut chosen: Vec<usize> = Vec::new();
    for _ in 0..(100 + 20 * rows) {
        let left: Vec<f64> = (0..rows).map(|row| after(w, gap, &lambda, row)).collect();
        let open = (0..rows).filter(|row| !chosen.contains(row));
        let worst = open.min_by(|&a, &b| left[a].total_cmp(&left[b]));
        let Some(entering) = worst.filter(|&row| left[row] < -CLOSED * deepest) else {
            return Some(lambda);
        };
        chosen.push(entering);
        // Each turn releases at least one row.
        loop {
            let target = aim(w, gap, &chosen)?;
            // Part of the way at which a push is used up.
            let used = |place: usize| {
                let (from, to) = (lambda[chosen[place]], target.values[place]);
                let way = if target.is_direction { -to } else { from - to };
                let stops = to > 0.0 || (to == 0.0 && !target.is_direction);
                stops.then(|| (if from == 0.0 { 0.0 } else { from / way }, place))
            };
            let first = (0..chosen.len()).filter_map(used).min_by(|a, b| a.0.total_cmp(&b.0));
            let part = first.map_or(1.0, |(part, _)| part);
            if first.is_none() && target.is_direction {
                return None;
            }
            for (&row, &value) in chosen.iter().zip(&target.values) {
                lambda[row] += part * if target.is_direction { value } else { value - lambda[row] };
            }
            let Some((_, leaving)) = first else { break };
            lambda[chosen[leaving]] = 0.0;
            chosen.remove(leaving);
        }
    }
    None
}

/// The target of the multipliers of the chosen rows.
struct Target {
    values: Vec<f64>,
    /// A direction without end instead of a point: the last row depends on the
    /// others, and its push grows at their expense until one has none left.
    is_direction: bool,
}

fn aim(w: &Matrix, gap: &[f64], chosen: &[usize]) -> Option<Target> {
    match factor(w, chosen) {
        Ok(l) => {
            let values = solve(&l, chosen.iter().map(|&row| gap[row]));
            Some(Target { values, is_direction: false })
        }
        Err(place) if place + 1 == chosen.len() => {
            let (others, last) = (&chosen[..place], chosen[place]);
            // -1 for the new row pushes; the others respond.
            let mut values =
                solve(&factor(w, others).ok()?, others.iter().map(|&row| w[row][last]));
            values.push(-1.0);
            Some(Target { values, is_direction: true })
        }
        Err(_) => None,
    }
}
