//! Campbell data: lines over speed and the coincidences (30).

use serde::Serialize;

use crate::harmonic::Campbell;
use crate::report::table::{Cell, Table};

/// Campbell data in JSON.
#[derive(Clone, Debug, Serialize)]
pub struct CampbellReport {
    speed_rad_s: Vec<f64>,
    lines: Vec<LineReport>,
    coincidences: Vec<CoincidenceReport>,
}

#[derive(Clone, Debug, Serialize)]
struct LineReport {
    name: String,
    at_standstill_rad_s: f64,
    slope: f64,
    frequency_rad_s: Vec<f64>,
}

#[derive(Clone, Debug, Serialize)]
struct CoincidenceReport {
    casing_rad_s: f64,
    blades_rad_s: f64,
    speed_rad_s: f64,
    dangerous: bool,
}

impl CampbellReport {
    /// At these speeds.
    #[must_use]
    pub fn of(campbell: &Campbell, speeds: &[f64]) -> Self {
        let line = |line: &crate::harmonic::Line| LineReport {
            name: line.name.clone(),
            at_standstill_rad_s: line.intercept,
            slope: line.slope,
            frequency_rad_s: speeds.iter().map(|&speed| line.at(speed)).collect(),
        };
        let coincidences = campbell.coincidences.iter().map(|found| CoincidenceReport {
            casing_rad_s: found.casing,
            blades_rad_s: found.blades,
            speed_rad_s: found.speed,
            dangerous: found.dangerous,
        });
        Self {
            speed_rad_s: speeds.to_vec(),
            lines: campbell.lines.iter().map(line).collect(),
            coincidences: coincidences.collect(),
        }
    }
}

/// The lines over speed, a column each.
#[must_use]
pub fn campbell_table(campbell: &Campbell, speeds: &[f64]) -> Table {
    let mut names = vec!["speed_rad_s"];
    names.extend(campbell.lines.iter().map(|line| line.name.as_str()));
    let mut table = Table::new(&names);
    for &speed in speeds {
        let mut row = vec![Cell::from(speed)];
        row.extend(campbell.lines.iter().map(|line| Cell::from(line.at(speed))));
        table.push(row);
    }
    table
}

/// The four coincidences of Eq. (30).
#[must_use]
pub fn coincidence_table(campbell: &Campbell) -> Table {
    let mut table = Table::new(&["speed_rad_s", "casing_rad_s", "blades_rad_s", "dangerous"]);
    for found in &campbell.coincidences {
        table.push(vec![
            found.speed.into(),
            found.casing.into(),
            found.blades.into(),
            if found.dangerous { "yes" } else { "no" }.into(),
        ]);
    }
    table
}
