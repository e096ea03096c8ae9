//! Errors of the frequency domain, each in one line with the key, its value and
//! what is allowed.

use crate::scene::keys;
use thiserror::Error;

use crate::model::{ContactPolygon, Machine};

/// An input without meaning in the frequency domain, or a solution that was not found.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum HarmonicError {
    /// Fewer than three sides: neighbouring sides never meet.
    #[error(
        "operation.nodal_diameters = {nodal_diameters}: allowed is one with N' = N/gcd(N, n_d) >= 3 \
         phase groups; a corner needs three sides (N = {blades} gives {sides} here)"
    )]
    NoCorner {
        /// `n_d`.
        nodal_diameters: u32,
        /// `N`.
        blades: u32,
        /// `N'`.
        sides: u32,
    },
    /// Two blades that cannot hold the wave between them.
    #[error("blades = {first},{second}: allowed is {allowed}")]
    Blades {
        /// The first blade as given.
        first: u32,
        /// The second blade as given.
        second: u32,
        /// What would be accepted.
        allowed: String,
    },
    /// A parameter of the frequency domain out of bounds.
    #[error("{key} = {value}: allowed is {allowed}")]
    Refused {
        /// Its name.
        key: &'static str,
        /// As given.
        value: String,
        /// What would be accepted.
        allowed: String,
    },
    /// Newton's method found no equilibrium: blades so soft that the branch
    /// has folded back before this speed.
    #[error(
        "no locked motion at speed = {speed} rad/s: the branch of these blades (softness {softness:e}) \
         ends before it"
    )]
    NotFound {
        /// Rotor speed \[rad/s\].
        speed: f64,
        /// `n_d^2 k_c g0^2/(m_b omega_bd^2)`.
        softness: f64,
    },
    /// The eigenvalues of a motion about an equilibrium overflow, or their
    /// iteration does not converge.
    #[error(
        "speed = {speed}: allowed is one where the eigenvalues of the motion about a steady state \
         can be computed; here its stiffnesses differ by too many powers of ten"
    )]
    Unsettled {
        /// Rotor speed \[rad/s\].
        speed: f64,
    },
}

impl HarmonicError {
    /// Creates the refusal of a value that is not allowed for its key.
    pub fn refused(key: &'static str, value: impl ToString, allowed: impl Into<String>) -> Self {
        Self::Refused { key, value: value.to_string(), allowed: allowed.into() }
    }
}

/// Refuses tips among which no corner is ever held, or of which that is not known.
pub(super) fn no_corner_of_tips() -> HarmonicError {
    let allowed = "tips of which two hold the wave at some speed, with rigid contact and a \
                   clearance that does not change with the speed";
    HarmonicError::refused("bladed_disk", "tips of their own lengths", allowed)
}

/// Refuses tips that are inclined or rub, where only the paper's are taken.
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

/// Refuses what acts on the casing otherwise than the paper's tips; friction that only
/// bends blades is no matter there.
pub(super) fn refuse_tips_on_casing(machine: &Machine, what: &str) -> Result<(), HarmonicError> {
    let allowed = format!("0 with {what}, which is of tips that move with the casing alone");
    if machine.casing_feels_tips() { refuse_tips(machine, &allowed) } else { Ok(()) }
}

/// Refuses an interference fit, in which rigid blades have no place.
pub(super) fn refuse_preload(machine: &Machine) -> Result<(), HarmonicError> {
    let clearance = machine.clearance();
    let allowed = "above 0 for rigid contact (casing.radius_m above bladed_disk.blade_length_m)";
    refuse_unless(clearance > 0.0, "clearance", clearance, allowed)
}

/// Refuses modes of the disk of other diameters than those of the casing: no single
/// harmonic balances them.
pub(super) fn refuse_other_diameters(machine: &Machine) -> Result<(), HarmonicError> {
    let (key, value) = (keys::DISK_DIAMETERS, machine.blade_diameters);
    let allowed = "0 or the nodal diameters of the casing; with others no single harmonic \
                   balances blades and casing";
    refuse_unless(!machine.has_other_diameters(), key, value, allowed)
}

/// Refuses `n_d = 0`: the casing has no travelling wave.
pub(super) fn refuse_no_wave(machine: &Machine) -> Result<(), HarmonicError> {
    let allowed = "1 or more; without nodal diameters there is no travelling wave and no critical \
                   speed";
    refuse_unless(machine.nodal_diameters != 0.0, keys::DIAMETERS, 0, allowed)
}

/// Refuses a polygon whose neighbouring sides never meet.
pub(super) fn refuse_no_corner(polygon: &ContactPolygon) -> Result<(), HarmonicError> {
    let &ContactPolygon { nodal_diameters, blades, sides, .. } = polygon;
    if polygon.has_corners() {
        Ok(())
    } else {
        Err(HarmonicError::NoCorner { nodal_diameters, blades, sides })
    }
}

/// Refuses speeds that are not finite.
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
