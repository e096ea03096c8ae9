//! The history of a run as named columns.

use super::table::Table;
use rubscope_solver::motion::Sample;

/// Largest number of values in a history, all columns together: 800 MB. With more, the system may
/// run out of memory and end the program.
pub const HISTORY_VALUES: usize = 100_000_000;

/// Name of a column, and its value in a sample.
type NamedValue = (&'static str, fn(&Sample) -> f64);

/// Columns before the gaps of the individual blades. The multipliers are the sum, the smallest and
/// the largest over the blade groups in contact, and 0 without contact.
const COLUMNS: [NamedValue; 11] = [
    ("t_s", |sample| sample.state.t_s),
    ("theta_rad", |sample| sample.rotor_angle_rad),
    ("speed_rad_s", |sample| sample.rotor_speed_rad_s),
    ("u_c_m", |sample| sample.state.u[0]),
    ("u_s_m", |sample| sample.state.u[1]),
    ("alpha_c_rad", |sample| sample.state.alpha[0]),
    ("alpha_s_rad", |sample| sample.state.alpha[1]),
    ("gap_min_m", |sample| sample.gaps.iter().copied().fold(f64::INFINITY, f64::min)),
    ("multiplier_sum_n", |sample| forces(sample).fold(0.0, |sum, force| sum + force)),
    ("multiplier_min_n", |sample| forces(sample).reduce(f64::min).unwrap_or(0.0)),
    ("multiplier_max_n", |sample| forces(sample).reduce(f64::max).unwrap_or(0.0)),
];

fn forces(sample: &Sample) -> impl Iterator<Item = f64> {
    sample.mean_forces.iter().map(|(_, force)| *force)
}

/// A run as sampled columns. A multiplier (contact force \[N\]) belongs to a blade group; it is the
/// mean since the previous sample, and negative for a push.
#[derive(Clone, Debug, PartialEq)]
pub struct History {
    /// Names of the columns; they end in the SI unit.
    names: Vec<String>,
    /// The values of each sample, one for each column.
    rows: Vec<Vec<f64>>,
}

impl History {
    /// Creates an empty history with one gap column for each of `blades` blades.
    pub fn new(blades: u32) -> Self {
        let gaps = (1..=blades).map(|blade| format!("gap_{blade}_m"));
        let names = COLUMNS.map(|(name, _)| name.to_string()).into_iter().chain(gaps).collect();
        Self { names, rows: Vec::new() }
    }

    /// Returns the largest number of samples that a history with a gap column for each of `blades`
    /// blades can have.
    pub fn most_samples(blades: u32) -> u32 {
        let columns = COLUMNS.len() + blades as usize;
        u32::try_from(HISTORY_VALUES / columns).unwrap_or(u32::MAX)
    }

    /// Adds a sample, which must contain the gaps of all blades, even if the history has no column
    /// for them: the smallest gap is taken from them. A sample with a number that is not finite is
    /// skipped.
    pub fn push(&mut self, sample: &Sample) {
        let row = COLUMNS.iter().map(|(_, value)| value(sample)).chain(sample.gaps.iter().copied());
        let row: Vec<f64> = row.take(self.names.len()).collect();
        if row.iter().all(|value| value.is_finite()) {
            self.rows.push(row);
        }
    }

    /// Returns the table of the samples.
    pub fn table(&self) -> Table<'_> {
        Table::new(self.names.iter().cloned(), self.rows.len(), |row| {
            self.rows[row].iter().map(|value| (*value).into()).collect()
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rubscope_solver::motion::State;

    fn sample(t_s: f64) -> Sample {
        Sample {
            state: State { t_s, u: [0.1, -2.5e-300], ..State::default() },
            rotor_angle_rad: 500.0 * t_s,
            rotor_speed_rad_s: 500.0,
            mean_forces: vec![(15, -100.0), (16, 40.0)],
            gaps: vec![2e-4, 1e-4, 3e-4],
        }
    }

    #[test]
    fn every_number_reads_back_as_itself() {
        let mut history = History::new(3);
        history.push(&sample(0.1 + 0.2));
        history.push(&sample(1.0 / 3.0 * 1e-9));
        let mut text = Vec::new();
        history.table().write_csv(&mut text).unwrap();
        let mut reader = csv::Reader::from_reader(text.as_slice());
        assert_eq!(reader.headers().unwrap(), &history.names);
        let read: Vec<Vec<f64>> = reader.deserialize().map(Result::unwrap).collect();
        assert_eq!((read.len(), read), (2, history.rows));
    }
}
