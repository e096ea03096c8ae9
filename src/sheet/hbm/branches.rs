//! The view `--branches`: every equilibrium, its stability, and the speeds where branches change.

use super::view::{Request, View};
use crate::sheet::Sheet;
use crate::sheet::table::{Column, Table, columns};
use rubscope_solver::harmonic::{
    Branches, Corner, Equilibrium, Form, Kind, Locked, LockedPoint, Threshold,
};
use rubscope_solver::model::{LockWindow, TipCorner};
use rubscope_solver::scene::{SceneError, keys};

pub const BRANCHES: View = View {
    always_damped: false,
    // Rest and sliding on one side exist even if there is no corner to lock in.
    rigid: Some(|error| error.is_of(keys::DIAMETERS)),
    unequal_tips: true,
    ..View::new(
        "branches",
        "View: every equilibrium, its stability, and the thresholds of each branch",
        fill,
    )
};

fn fill(request: &Request<'_>, sheet: &mut Sheet<'_>) -> Result<(), SceneError> {
    let Request { machine, speeds, damped, .. } = request;
    if machine.has_unequal_tips() {
        return corners(request, sheet);
    }
    let branches = Branches::over(machine, speeds, *damped)?;
    let damping = if *damped { "with damping" } else { "without damping" };
    let changes = format!("Where branches change between these speeds, {damping}:");
    sheet.table("thresholds", changes, Table::of(branches.thresholds, THRESHOLDS));
    sheet.table(
        "points",
        "Equilibria of the blade frame:",
        Table::of(branches.states, STATES).shown(8),
    );
    sheet.chart("growth of a disturbance [1/s]", &[["growth_per_s", "growth"]]);
    Ok(())
}

/// A corner of unequal tips at one of the speeds: the blades of its two sides, the corner, the
/// window of rotor speeds in which it holds the wave, and the locked motion at this speed.
type CornerRow = ([Vec<u32>; 2], TipCorner, LockWindow, LockedPoint);

/// Answers for unequal tips: every corner, the speeds at which it holds, and its loads there.
fn corners(request: &Request<'_>, sheet: &mut Sheet<'_>) -> Result<(), SceneError> {
    let Request { machine, speeds, damped, .. } = request;
    let polygon = machine.polygon.clone();
    let mut found: Vec<CornerRow> = Vec::new();
    for corner in machine.tip_corners() {
        for window in machine.windows_of(&corner, request.fastest()) {
            let [a, b] = corner.sides;
            let locked = Locked::new(machine, Corner { a, b }, Form::Modal, *damped)?;
            let blades = || corner.sides.map(|side| polygon.blades_of_side(side));
            let points = locked.sweep(speeds)?.points.into_iter();
            found.extend(points.map(|point| (blades(), corner, window, point)));
        }
    }
    let title = "Every corner of these tips that is held at some speed:";
    sheet.table("points", title, Table::of(found, CORNERS).shown(9));
    Ok(())
}

const CORNERS: &[Column<'_, CornerRow>] = &[
    ("speed_rad_s", |row| row.3.speed_rad_s.into()),
    ("blade_a", |row| row.0[0].first().copied().into()),
    ("blade_b", |row| row.0[1].first().copied().into()),
    ("held_from_rad_s", |row| row.2.from.into()),
    ("held_to_rad_s", |row| row.2.to.into()),
    ("multiplier_a_n", |row| row.3.multipliers_n[0].into()),
    ("multiplier_b_n", |row| row.3.multipliers_n[1].into()),
    ("amplitude_m", |row| row.3.amplitude_m.into()),
    ("character", |row| row.3.character.into()),
    ("smallest_gap_m", |row| row.3.smallest_gap_m.into()),
    ("torque_nm", |row| row.3.torque_nm.into()),
    ("power_w", |row| row.3.power_w.into()),
    ("stable", |row| row.3.stable.into()),
    ("growth_1_s", |row| row.3.growth_1_s.into()),
];

const THRESHOLDS: &[Column<'_, Threshold>] = &columns! {
    speed_rad_s,
    state: |threshold| threshold.kind.into(),
    below, above,
};

const STATES: &[Column<'_, Equilibrium>] = &columns! {
    speed_rad_s,
    state: |state| state.kind.into(),
    character,
    multiplier_a_n: |state| state.contacts.first().map(|contact| contact.multiplier_n).into(),
    multiplier_b_n: |state| state.contacts.get(1).map(|contact| contact.multiplier_n).into(),
    amplitude_m,
    // At rest there is no drive power.
    power_w: |state| (state.kind != Kind::Rest).then_some(state.power_w).into(),
    growth_per_s: |state| growth(state).into(),
    smallest_gap_m, torque_nm, alpha_c_rad, alpha_s_rad, admissible, stable,
};

/// Returns the growth rate of a deviation from an equilibrium \[1/s\], negative if it decays. It is
/// 0 within round-off of the eigenvalues: an undamped motion neither grows nor decays.
fn growth(state: &Equilibrium) -> f64 {
    let fastest = state.eigenvalues_per_s.iter().map(|value| value.norm()).fold(0.0, f64::max);
    if state.growth_per_s.abs() > 1e-13 * fastest { state.growth_per_s } else { 0.0 }
}
