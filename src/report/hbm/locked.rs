//! The locked motion, which is shown without the option of a view.

use serde_json::{Value, json};

use super::{Answer, LockBeside, Parts, Request, View};
use crate::report::table::{Column, Table, TableCell};
use rubscope_solver::harmonic::{HarmonicError, LockedPoint, Sweep};
use rubscope_solver::model::ContactPolygon;

/// The default view: the locked motion.
pub const LOCKED: View = View {
    option: "",
    help: "",
    always_damped: false,
    one_speed: false,
    lock: LockBeside::Rigid(|_| false),
    answer,
};

/// Returns two tables of the locked motion: a short one for the screen, a full one for files.
fn answer(request: &Request<'_>) -> Result<Answer, HarmonicError> {
    let points = request.sweep.as_ref().map_or(&[][..], |sweep| &sweep.points);
    let tables = vec![(String::new(), Table::of(points, SUMMARY))];
    Ok(Answer { json: Parts::default(), tables, file: Some(Table::of(points, FILE)) })
}

/// Adds the locked motion to the JSON of a view.
pub fn points(json: Parts, polygon: &ContactPolygon, sweep: &Sweep) -> Parts {
    let blades = sweep.corner.sides().map(|side| polygon.blades_of_side(side));
    json.with("missing_rad_s", &sweep.missing)
        .with_rows("points", &sweep.points, |point| with_groups(point, &blades))
}

/// Returns a point as JSON, with its multipliers and angles grouped by side.
fn with_groups(point: &LockedPoint, blades: &[Vec<u32>; 2]) -> Value {
    let mut value = json!(point);
    if let Some(map) = value.as_object_mut() {
        let groups = [0, 1].map(|i| {
            let (multiplier, alpha) = (point.multipliers_n[i], point.alpha_rad[i]);
            json!({ "blades": blades[i], "multiplier_n": multiplier, "alpha_rad": alpha })
        });
        map.shift_remove("multipliers_n");
        map.shift_remove("alpha_rad");
        map.shift_insert(1, "groups".to_string(), json!(groups));
    }
    value
}

/// Returns `locked` for a stable point, or else the kind of its instability.
fn state(point: &LockedPoint) -> TableCell {
    if point.stable { "locked" } else { point.character.as_ref() }.into()
}

/// Columns for the screen.
const SUMMARY: &[Column<'_, LockedPoint>] = &[
    ("speed [rad/s]", |point| point.speed_rad_s.into()),
    ("multiplier a [N]", |point| point.multipliers_n[0].into()),
    ("multiplier b [N]", |point| point.multipliers_n[1].into()),
    ("alpha a [rad]", |point| point.alpha_rad[0].into()),
    ("amplitude [m]", |point| point.amplitude_m.into()),
    ("power [W]", |point| point.power_w.into()),
    ("state", state),
];

/// Columns for files: every number.
pub const FILE: &[Column<'_, LockedPoint>] = &[
    ("speed_rad_s", |point| point.speed_rad_s.into()),
    ("multiplier_a_n", |point| point.multipliers_n[0].into()),
    ("multiplier_b_n", |point| point.multipliers_n[1].into()),
    ("alpha_a_rad", |point| point.alpha_rad[0].into()),
    ("alpha_b_rad", |point| point.alpha_rad[1].into()),
    ("u_cc_m", |point| point.u_cc_m.into()),
    ("u_cs_m", |point| point.u_cs_m.into()),
    ("u_sc_m", |point| point.u_sc_m.into()),
    ("u_ss_m", |point| point.u_ss_m.into()),
    ("amplitude_m", |point| point.amplitude_m.into()),
    ("smallest_gap_m", |point| point.smallest_gap_m.into()),
    ("torque_nm", |point| point.torque_nm.into()),
    ("power_w", |point| point.power_w.into()),
    ("character", |point| point.character.as_ref().into()),
    ("admissible", |point| point.admissible.into()),
    ("stable", |point| point.stable.into()),
    ("residual", |point| point.residual.into()),
];
