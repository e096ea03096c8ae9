//! The view `--coincidence`: growth rate of rest near the coincidences, and the limit cycle of
//! blades in contact, against speed.

use super::view::{Request, View};
use crate::sheet::Sheet;
use crate::sheet::number::{per_speed, short, speed, speed_unit};
use crate::sheet::table::{Column, Table, columns};
use rubscope_solver::harmonic::{CoincidencePoint, coincidence, shifted_coincidence};
use rubscope_solver::scene::SceneError;

/// The view `--coincidence`.
pub const COINCIDENCE: View = View {
    rigid: None,
    out_of_round: true,
    ..View::new(
        "coincidence",
        "View: effect of the coincidences: growth rate of rest and the limit cycle, against speed",
        fill,
    )
};

fn fill(request: &Request<'_>, sheet: &mut Sheet<'_>) -> Result<(), SceneError> {
    let Request { scene, machine, speeds, .. } = request;
    let points = coincidence(scene, speeds)?;
    let sense = 1_f64.copysign(request.fastest());
    let markers: Vec<f64> =
        machine.coincidence_speeds().iter().map(|speed| sense * speed).collect();
    let shifted = shifted_coincidence(scene, request.fastest());
    let shown: Vec<String> = markers.iter().map(|speed| short(per_speed(*speed))).collect();
    let mut title = format!("Coincidences (30) at {} {}", shown.join(" and "), speed_unit());
    if let Some(shifted) = shifted {
        title += &format!(", on the lining at {}", speed(shifted));
    }
    title += match scene.clearance() > 0.0 {
        true => "; the wave that lasts once it touches:",
        false => "; growth of rest, and the wave it grows into:",
    };
    sheet.fact("coincidences_rad_s", markers);
    sheet.fact("shifted_coincidence_rad_s", shifted);
    add_points(points, title, sheet);
    Ok(())
}

/// Adds the table of growth rates and limit cycles, and a chart of each.
pub fn add_points<'a>(
    points: impl AsRef<[CoincidencePoint]> + 'a,
    title: impl Into<String>,
    sheet: &mut Sheet<'a>,
) {
    sheet.table("points", title, Table::of(points, CURVE));
    sheet.chart("amplitude of the blades [rad]", &[["blade_amplitude_rad", "|a|"]]);
    sheet.chart("growth of rest [1/s]", &[["growth_1_s", "growth"]]);
}

/// Columns of the growth rate of rest and of the limit cycle.
const CURVE: &[Column<'_, CoincidencePoint>] = &columns! {
    speed_rad_s, growth_1_s, blade_amplitude_rad, casing_amplitude_m, omega_rad_s, bounded,
};
