//! What the frequency domain refuses, in the words of a scene key and what is allowed.

use crate::model::{ContactPolygon, Machine};
use crate::numeric::rounding::rounded;
use crate::scene::{SceneError, keys, refuse_if};

/// Returns the error for a speed at which eigenvalues overflow, or at which their iteration does not
/// converge \[rad/s\].
pub(super) fn unsettled(speed: f64) -> SceneError {
    let allowed = "a speed at which the eigenvalues of the motion about a steady state can be \
                   computed; here its stiffnesses differ by too many powers of ten";
    SceneError::refused("speed", speed, allowed)
}

/// Returns the error for two blades that are no neighbours in phase, so that they cannot hold a wave
/// between them.
pub(super) fn no_pair([first, second]: [u32; 2], allowed: String) -> SceneError {
    SceneError::refused("blades", format!("{first},{second}"), allowed)
}

/// Returns the error for unequal tips that hold the wave at no speed, or for which no closed form is
/// known.
pub(super) fn no_corner_of_tips() -> SceneError {
    let allowed = "tips of which two hold the wave at some speed, with rigid contact and a \
                   clearance that does not change with speed";
    SceneError::refused("bladed_disk", "unequal tips", allowed)
}

/// Rejects inclined or rubbing tips.
pub(super) fn refuse_tips(machine: &Machine, allowed: &str) -> Result<(), SceneError> {
    let (slope, friction) = (machine.radial_coupling, machine.friction);
    refuse_if(slope != 0.0, keys::RADIAL_COUPLING, slope, allowed)?;
    refuse_if(friction != 0.0, keys::FRICTION, friction, allowed)
}

/// Rejects tips that load the casing in another way than the paper's. Friction that only bends the
/// blades is accepted.
pub(super) fn refuse_tips_on_casing(machine: &Machine, what: &str) -> Result<(), SceneError> {
    let allowed = format!("0 with {what}, whose equations neglect slope and friction of the tips");
    if machine.casing_feels_tips() { refuse_tips(machine, &allowed) } else { Ok(()) }
}

/// Rejects an interference fit, with which rigid contact has no solution.
pub(super) fn refuse_preload(machine: &Machine) -> Result<(), SceneError> {
    let clearance = machine.clearance();
    let allowed = "above 0 for rigid contact (casing.radius_m less bladed_disk.blade_length_m)";
    let value = format!("{} m", rounded(clearance, 9));
    refuse_if(clearance <= 0.0, keys::CLEARANCE, value, allowed)
}

/// Rejects disk modes with other nodal diameters than the casing's: no single harmonic balances
/// both.
pub(super) fn refuse_other_diameters(machine: &Machine) -> Result<(), SceneError> {
    let (key, value) = (keys::DISK_DIAMETERS, machine.blade_diameters);
    let allowed = "0 or the nodal diameters of the casing; with other ones a single harmonic cannot \
                   balance blades and casing";
    refuse_if(machine.has_other_diameters(), key, value, allowed)
}

/// Rejects `n_d = 0`: the casing has no travelling wave.
pub(super) fn refuse_no_wave(machine: &Machine) -> Result<(), SceneError> {
    let allowed = "1 or more; without nodal diameters there is no travelling wave and no critical \
                   speed";
    refuse_if(machine.nodal_diameters == 0.0, keys::DIAMETERS, 0, allowed)
}

/// Rejects a polygon whose neighbouring sides never meet.
pub(super) fn refuse_no_corner(polygon: &ContactPolygon) -> Result<(), SceneError> {
    if polygon.has_corners() {
        return Ok(());
    }
    let &ContactPolygon { nodal_diameters, blades, sides, .. } = polygon;
    let allowed = format!(
        "a number with N' = N/gcd(N, n_d) >= 3 phase groups, because a corner needs three sides; \
         with N = {blades} there are {sides}"
    );
    Err(SceneError::refused(keys::DIAMETERS, nodal_diameters, allowed))
}

/// Rejects speeds that are not finite.
pub(super) fn refuse_endless(speeds: &[f64]) -> Result<(), SceneError> {
    let refused =
        |&speed: &f64| refuse_if(!speed.is_finite(), "speed", speed, "a finite number of rad/s");
    speeds.iter().try_for_each(refused)
}
