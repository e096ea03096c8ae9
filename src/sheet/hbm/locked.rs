//! The default view: the locked motion against speed.

use super::view::{Request, View};
use crate::sheet::Sheet;
use crate::sheet::number::speed;
use crate::sheet::table::{Column, Table, columns};
use rubscope_solver::harmonic::{Form, LockedPoint};
use rubscope_solver::scene::SceneError;

/// The view without an option.
pub const LOCKED: View =
    View { always_damped: false, unequal_tips: true, ..View::new("", "", fill) };

fn fill(request: &Request<'_>, sheet: &mut Sheet<'_>) -> Result<(), SceneError> {
    let mut sweep = request.lock()?.sweep(request.speeds)?;
    if request.machine.rigid_blades {
        sweep.points.iter_mut().for_each(|point| point.alpha_rad = [0.0; 2]);
    }
    let sides = sweep.corner.sides();
    let blades = sides.map(|side| request.machine.polygon.blades_of_side(side));
    let damping = match (sweep.damped, sweep.form) {
        (true, _) => "damped",
        (false, Form::Printed) => "undamped as in the paper",
        (false, _) => "undamped",
    };
    let [a, b] = blades
        .each_ref()
        .map(|blades| blades.iter().map(|blade| format!("#{blade}")).collect::<Vec<_>>().join(" "));
    sheet.line(format!(
        "Locked motion held between a: {a} and b: {b}; form {}, {damping}. A negative multiplier \
         pushes; a positive one pulls, which a real contact cannot do.",
        sweep.form
    ));
    if let Some(first) = sweep.missing.first() {
        sheet.line(format!(
            "No locked motion at {} of {} speeds, the first of them {}: the blades are so soft that \
             the branch folds back.",
            sweep.missing.len(),
            request.speeds.len(),
            speed(*first)
        ));
    }
    sheet.fact("missing_rad_s", sweep.missing);
    sheet.fact("blades_a", &blades[0]);
    sheet.fact("blades_b", &blades[1]);
    add_points(sweep.points, sheet);
    Ok(())
}

/// Adds the table of the locked motion, and charts of its multipliers, angles and amplitudes.
pub fn add_points<'a>(points: impl AsRef<[LockedPoint]> + 'a, sheet: &mut Sheet<'a>) {
    sheet.table("points", "", Table::of(points, POINTS).shown(7));
    sheet.chart("multiplier [N]", &[["multiplier_a_n", "λ_a"], ["multiplier_b_n", "λ_b"]]);
    sheet.chart("angle of the blades [rad]", &[["alpha_a_rad", "α_a"], ["alpha_b_rad", "α_b"]]);
    let amplitudes = [["u_cc_m", "u_cc"], ["u_cs_m", "u_cs"], ["amplitude_m", "|u|"]];
    sheet.chart("casing [m]", &amplitudes);
}

const POINTS: &[Column<'_, LockedPoint>] = &columns! {
    speed_rad_s,
    multiplier_a_n: |point| point.multipliers_n[0].into(),
    multiplier_b_n: |point| point.multipliers_n[1].into(),
    alpha_a_rad: |point| point.alpha_rad[0].into(),
    amplitude_m, power_w, character,
    alpha_b_rad: |point| point.alpha_rad[1].into(),
    u_cc_m, u_cs_m, u_sc_m, u_ss_m, smallest_gap_m, torque_nm,
    admissible, stable, growth_1_s, residual,
};
