//! Every equilibrium, its stability, and where branches change.

use std::rc::Rc;

use serde_json::json;

use super::{Answer, LockBeside, Parts, Request, Rows, View};
use crate::report::table::{Column, Table, TableCell};
use rubscope_solver::harmonic::{Branches, Equilibrium, HarmonicError, Kind, Threshold};

/// View: every equilibrium.
pub const BRANCHES: View = View {
    option: "branches",
    help: "View: every equilibrium, its stability, and the thresholds of each branch",
    range: None,
    always_damped: false,
    one_speed: false,
    // Rest and side are there without corners, too.
    lock: LockBeside::Rigid(|error| matches!(error, HarmonicError::NoCorner { .. })),
    answer,
};

fn answer(request: &Request<'_>) -> Result<Answer, HarmonicError> {
    let Request { machine, speeds, damped, .. } = request;
    let branches = Rc::new(Branches::over(machine, speeds, *damped)?);
    let of = Rc::clone(&branches);
    let rows = Rows::new([branches.speeds(), branches.count], move |place| of.states_at(place));
    let json = Parts::default().with("thresholds", &branches.thresholds).with_rows(
        "states",
        &rows,
        |state| json!(state),
    );
    let damping = if *damped { "with damping" } else { "without damping" };
    let changes = format!("Where branches change between these speeds, {damping}:");
    let tables = vec![
        (changes, Table::of(&branches.thresholds, THRESHOLDS).into()),
        ("Equilibria of the blade frame:".to_string(), rows.table(STATES)),
    ];
    Ok(Answer::of(Parts::default().with_parts("branches", json), tables))
}

/// Columns of the speeds where branches appear, vanish or change.
const THRESHOLDS: &[Column<'_, Threshold>] = &[
    ("speed_rad_s", |threshold| threshold.speed_rad_s.into()),
    ("state", |threshold| threshold.kind.as_ref().into()),
    ("below", |threshold| threshold.below.as_ref().into()),
    ("above", |threshold| threshold.above.as_ref().into()),
];

fn multiplier(state: &Equilibrium, index: usize) -> TableCell {
    state.contacts.get(index).map(|contact| contact.multiplier_n).into()
}

/// Columns of equilibria.
const STATES: &[Column<'_, Equilibrium>] = &[
    ("speed_rad_s", |state| state.speed_rad_s.into()),
    ("state", |state| state.kind.as_ref().into()),
    ("character", |state| state.character.as_ref().into()),
    ("multiplier_a_n", |state| multiplier(state, 0)),
    ("multiplier_b_n", |state| multiplier(state, 1)),
    ("amplitude_m", |state| state.amplitude_m.into()),
    // At rest nothing is driven.
    ("power_w", |state| (state.kind != Kind::Rest).then_some(state.power_w).into()),
    ("growth_per_s", |state| growth(state).into()),
];

/// Returns the growth rate to read: 0 for an undamped motion, which grows or decays only by
/// round-off.
fn growth(state: &Equilibrium) -> f64 {
    let fastest = state.eigenvalues_per_s.iter().map(|value| value.norm()).fold(0.0, f64::max);
    if state.growth_per_s.abs() > 1e-13 * fastest { state.growth_per_s } else { 0.0 }
}
