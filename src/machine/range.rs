//! Checks whether a range of speeds without a unit was probably meant in rpm.

use std::f64::consts::TAU;

use rubscope_solver::scene::Scene;

/// Largest plausible speed of blade tips \[m/s\]; metal tips reach about 500. With a larger one, rpm
/// given as rad/s would not be noticed for small machines.
pub(super) const TIP_SPEED: f64 = 800.0;

/// Asks whether a range of speeds that was given without a unit \[rad/s\] was meant in rpm: blade
/// tips do not move so fast, or it contains the speed of the scene only in rpm.
#[must_use]
pub fn range_doubt(scene: &Scene, range: [f64; 2]) -> Option<String> {
    let [from, to] = range;
    let speed = scene.operation.speed_rad_s;
    let tips = from.abs().max(to.abs()) * scene.casing.radius_m;
    let contains = |unit: f64| (from.min(to) * unit..=from.max(to) * unit).contains(&speed);
    let why = if tips > TIP_SPEED {
        format!("moves the blade tips at {tips:.0} m/s; metal ones reach some 500")
    } else if !contains(1.0) && contains(TAU / 60.0) {
        format!("does not contain the speed of the scene, {:.0} rpm", speed * 60.0 / TAU)
    } else {
        return None;
    };
    let (typed, in_rpm) = match from == to {
        true => (from.to_string(), format!("{from}rpm")),
        false => (format!("{from}:{to}"), format!("{from}rpm:{to}rpm")),
    };
    Some(format!("{typed} is in rad/s and {why}. Was it rpm? Then write {in_rpm}."))
}
