//! Every equilibrium over speed, the thresholds of the branches, and the corner
//! branch through its fold.

use serde::Serialize;

use crate::harmonic::{Branches, CornerBranch, Equilibrium, Kind};
use crate::model::Machine;
use crate::report::table::Table;

/// The branches in JSON.
#[derive(Clone, Debug, Serialize)]
pub struct BranchReport {
    thresholds: Vec<ThresholdReport>,
    states: Vec<StateReport>,
}

#[derive(Clone, Debug, Serialize)]
struct ThresholdReport {
    speed_rad_s: f64,
    kind: &'static str,
    below: &'static str,
    above: &'static str,
}

#[derive(Clone, Debug, Serialize)]
struct StateReport {
    speed_rad_s: f64,
    kind: &'static str,
    character: &'static str,
    admissible: bool,
    stable: bool,
    contacts: Vec<ContactReport>,
    amplitude_m: f64,
    alpha_c_rad: f64,
    alpha_s_rad: f64,
    smallest_gap_m: f64,
    torque_nm: f64,
    power_w: f64,
    growth_per_s: f64,
    /// Real and imaginary parts.
    eigenvalues_per_s: Vec<[f64; 2]>,
}

#[derive(Clone, Debug, Serialize)]
struct ContactReport {
    blades: Vec<u32>,
    multiplier_n: f64,
}

impl BranchReport {
    /// Of these branches.
    #[must_use]
    pub fn of(machine: &Machine, branches: &Branches) -> Self {
        let thresholds = branches.thresholds.iter().map(|threshold| ThresholdReport {
            speed_rad_s: threshold.speed,
            kind: threshold.kind.word(),
            below: threshold.from.word(),
            above: threshold.to.word(),
        });
        Self {
            thresholds: thresholds.collect(),
            states: branches.states.iter().map(|state| StateReport::of(machine, state)).collect(),
        }
    }
}

impl StateReport {
    fn of(machine: &Machine, state: &Equilibrium) -> Self {
        let contact = |&(side, multiplier_n): &(u32, f64)| ContactReport {
            blades: machine.rim.blades_of_side(side),
            multiplier_n,
        };
        Self {
            speed_rad_s: state.speed,
            kind: state.kind.word(),
            character: state.character.word(),
            admissible: state.admissible(),
            stable: state.stable(),
            contacts: state.contacts.iter().map(contact).collect(),
            amplitude_m: state.amplitude(),
            alpha_c_rad: state.alpha[0],
            alpha_s_rad: state.alpha[1],
            smallest_gap_m: state.smallest_gap,
            torque_nm: state.torque,
            power_w: state.power,
            growth_per_s: state.growth(),
            eigenvalues_per_s: state.eigenvalues.iter().map(|v| [v.re, v.im]).collect(),
        }
    }
}

/// The speeds where branches appear, vanish or change.
#[must_use]
pub fn threshold_table(branches: &Branches) -> Table {
    let mut table = Table::new(&["speed_rad_s", "state", "below", "above"]);
    for threshold in &branches.thresholds {
        table.push(vec![
            threshold.speed.into(),
            threshold.kind.word().into(),
            threshold.from.word().into(),
            threshold.to.word().into(),
        ]);
    }
    table
}

/// Every equilibrium, a row each.
#[must_use]
pub fn branch_table(branches: &Branches) -> Table {
    let mut table = Table::new(&[
        "speed_rad_s",
        "state",
        "character",
        "multiplier_a_n",
        "multiplier_b_n",
        "amplitude_m",
        "power_w",
        "growth_per_s",
    ]);
    for state in &branches.states {
        let multiplier = |n: usize| state.contacts.get(n).map(|contact| contact.1);
        table.push(vec![
            state.speed.into(),
            state.kind.word().into(),
            state.character.word().into(),
            multiplier(0).into(),
            multiplier(1).into(),
            state.amplitude().into(),
            // At rest nothing is driven.
            (state.kind != Kind::Rest).then_some(state.power).into(),
            growth(state).into(),
        ]);
    }
    table
}

/// Growth for people: undamped motions neither grow nor decay but for rounding.
fn growth(state: &Equilibrium) -> f64 {
    let fastest = state.eigenvalues.iter().map(|value| value.norm()).fold(0.0, f64::max);
    if state.growth().abs() > 1e-13 * fastest { state.growth() } else { 0.0 }
}

/// The corner branch in JSON.
#[derive(Clone, Debug, Serialize)]
pub struct FoldReport {
    fold_rad_s: Option<f64>,
    fold_opening_rad: Option<f64>,
    points: Vec<CornerReport>,
}

#[derive(Clone, Debug, Serialize)]
struct CornerReport {
    speed_rad_s: f64,
    opening_rad: f64,
    amplitude_m: f64,
    multipliers_n: Vec<f64>,
    character: &'static str,
    growth_per_s: f64,
}

impl FoldReport {
    /// Of this branch.
    #[must_use]
    pub fn of(branch: &CornerBranch) -> Self {
        let point = |(opening_rad, state): &(f64, Equilibrium)| CornerReport {
            speed_rad_s: state.speed,
            opening_rad: *opening_rad,
            amplitude_m: state.amplitude(),
            multipliers_n: state.contacts.iter().map(|contact| contact.1).collect(),
            character: state.character.word(),
            growth_per_s: state.growth(),
        };
        Self {
            fold_rad_s: branch.fold.map(|fold| fold.speed),
            fold_opening_rad: branch.fold.map(|fold| fold.opening),
            points: branch.points.iter().map(point).collect(),
        }
    }
}

/// The corner branch, point by point along it.
#[must_use]
pub fn corner_table(branch: &CornerBranch) -> Table {
    let mut table = Table::new(&[
        "speed_rad_s",
        "opening_rad",
        "amplitude_m",
        "multiplier_a_n",
        "multiplier_b_n",
        "growth_per_s",
        "character",
    ]);
    for (opening, state) in &branch.points {
        let multiplier = |n: usize| state.contacts.get(n).map(|contact| contact.1);
        table.push(vec![
            state.speed.into(),
            (*opening).into(),
            state.amplitude().into(),
            multiplier(0).into(),
            multiplier(1).into(),
            state.growth().into(),
            state.character.word().into(),
        ]);
    }
    table
}
