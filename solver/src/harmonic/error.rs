//! Errors of the frequency domain, each in one line with the key, its value and what is allowed.

use thiserror::Error;

use crate::model::{ContactPolygon, Machine};
use crate::numeric::rounding::rounded;
use crate::scene::keys;

/// An input that the frequency domain cannot treat, or a solution that was not found.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum HarmonicError {
    /// The polygon has fewer than three sides, so that neighbouring sides never meet.
    #[error(
        "operation.nodal_diameters = {nodal_diameters}: allowed is a number with N' = N/gcd(N, n_d) \
         >= 3 phase groups, because a corner needs three sides; with N = {blades} there are {sides}"
    )]
    NoCorner {
        /// Nodal diameters `n_d`.
        nodal_diameters: u32,
        /// Number of blades `N`.
        blades: u32,
        /// Number of sides `N'`.
        sides: u32,
    },
    /// The two blades are not neighbours in phase, so that they cannot hold a wave between them.
    #[error("blades = {first},{second}: allowed is {allowed}")]
    Blades {
        /// The first blade as given.
        first: u32,
        /// The second blade as given.
        second: u32,
        /// Allowed pairs, in words.
        allowed: String,
    },
    /// A parameter has a value that is not allowed.
    #[error("{key} = {value}: allowed is {allowed}")]
    Refused {
        /// Name of the parameter.
        key: &'static str,
        /// Value as given.
        value: String,
        /// Allowed values, in words.
        allowed: String,
    },
    /// There is no locked motion: the blades are so soft that the branch folds back before this
    /// speed, or they have grown into the casing.
    #[error(
        "no locked motion at speed = {speed} rad/s: blades this soft (softness {softness:e}) hold no \
         lock there"
    )]
    NotFound {
        /// Rotor speed \[rad/s\].
        speed: f64,
        /// Softness of the blades, `n_d^2 k_c g0^2/(m_b omega_bd^2)`.
        softness: f64,
    },
    /// The eigenvalues of the motion about an equilibrium overflow, or their iteration does not
    /// converge.
    #[error(
        "speed = {speed}: allowed is a speed at which the eigenvalues of the motion about a steady \
         state can be computed; here its stiffnesses differ by too many powers of ten"
    )]
    Unsettled {
        /// Rotor speed \[rad/s\].
        speed: f64,
    },
}

impl HarmonicError {
    /// Creates the error for a value that is not allowed.
    pub fn refused(key: &'static str, value: impl ToString, allowed: impl Into<String>) -> Self {
        Self::Refused { key, value: value.to_string(), allowed: allowed.into() }
    }
}

/// Returns the error for unequal tips that hold the wave at no speed, or for which no closed form is
/// known.
pub(super) fn no_corner_of_tips() -> HarmonicError {
    let allowed = "tips of which two hold the wave at some speed, with rigid contact and a \
                   clearance that does not change with speed";
    HarmonicError::refused("bladed_disk", "unequal tips", allowed)
}

/// Rejects inclined or rubbing tips.
pub(super) fn refuse_tips(machine: &Machine, allowed: &str) -> Result<(), HarmonicError> {
    let (key, value) = if machine.radial_coupling != 0.0 {
        (keys::RADIAL_COUPLING, machine.radial_coupling)
    } else if machine.friction != 0.0 {
        (keys::FRICTION, machine.friction)
    } else {
        return Ok(());
    };
    Err(HarmonicError::refused(key, value, allowed))
}

/// Rejects tips that load the casing in another way than the paper's. Friction that only bends the
/// blades is accepted.
pub(super) fn refuse_tips_on_casing(machine: &Machine, what: &str) -> Result<(), HarmonicError> {
    let allowed = format!("0 with {what}, whose equations neglect slope and friction of the tips");
    if machine.casing_feels_tips() { refuse_tips(machine, &allowed) } else { Ok(()) }
}

/// Rejects an interference fit, with which rigid contact has no solution.
pub(super) fn refuse_preload(machine: &Machine) -> Result<(), HarmonicError> {
    let clearance = machine.clearance();
    let allowed = "above 0 for rigid contact (casing.radius_m less bladed_disk.blade_length_m)";
    let value = format!("{} m", rounded(clearance, 9));
    refuse_unless(clearance > 0.0, keys::CLEARANCE, value, allowed)
}

/// Rejects disk modes with other nodal diameters than the casing's: no single harmonic balances
/// both.
pub(super) fn refuse_other_diameters(machine: &Machine) -> Result<(), HarmonicError> {
    let (key, value) = (keys::DISK_DIAMETERS, machine.blade_diameters);
    let allowed = "0 or the nodal diameters of the casing; with other ones a single harmonic cannot \
                   balance blades and casing";
    refuse_unless(!machine.has_other_diameters(), key, value, allowed)
}

/// Rejects `n_d = 0`: the casing has no travelling wave.
pub(super) fn refuse_no_wave(machine: &Machine) -> Result<(), HarmonicError> {
    let allowed = "1 or more; without nodal diameters there is no travelling wave and no critical \
                   speed";
    refuse_unless(machine.nodal_diameters != 0.0, keys::DIAMETERS, 0, allowed)
}

/// Rejects a polygon whose neighbouring sides never meet.
pub(super) fn refuse_no_corner(polygon: &ContactPolygon) -> Result<(), HarmonicError> {
    let &ContactPolygon { nodal_diameters, blades, sides, .. } = polygon;
    if polygon.has_corners() {
        Ok(())
    } else {
        Err(HarmonicError::NoCorner { nodal_diameters, blades, sides })
    }
}

/// Rejects speeds that are not finite.
pub(super) fn refuse_endless(speeds: &[f64]) -> Result<(), HarmonicError> {
    let refused =
        |&speed| refuse_unless(f64::is_finite(speed), "speed", speed, "a finite number of rad/s");
    speeds.iter().try_for_each(refused)
}

fn refuse_unless(
    is_allowed: bool,
    key: &'static str,
    value: impl ToString,
    allowed: &str,
) -> Result<(), HarmonicError> {
    if is_allowed { Ok(()) } else { Err(HarmonicError::refused(key, value, allowed)) }
}
