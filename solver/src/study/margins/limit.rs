//! A limit: its description, its value, the position of the scene relative to it, and
//! its sensitivities.

use crate::scene::keys::{OUT_OF_ROUND, PULSE, SPEED};
use serde::{Deserialize, Serialize};
use strum::{AsRefStr, Display, EnumIter, EnumString, VariantNames};

use super::parameters::is_length;

/// Name of a limit, in the order in which they are shown.
#[derive(
    Clone,
    Copy,
    Debug,
    PartialEq,
    Eq,
    Deserialize,
    Serialize,
    AsRefStr,
    Display,
    EnumIter,
    EnumString,
    VariantNames,
)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum LimitName {
    /// Critical speed.
    OmegaC,
    /// Lowest speed at which the paper's equality algorithm holds a lock, with a pull.
    OmegaAdhesive,
    /// Lowest speed at which pushes alone hold a lock.
    OmegaLock,
    /// Highest speed at which pushes alone hold a lock.
    LockEnds,
    /// Dangerous coincidence, Eq. (31).
    Coincidence,
    /// Other coincidence of Eq. (30), that of the frequency difference.
    CoincidenceDifference,
    /// Lowest speed at which inclined tips whirl with the casing.
    WhirlOnset,
    /// Speed above which blades and casing flutter if their contact lasts; 0 if they do from
    /// standstill on. The curvature of large contact forces can still stabilise a lock.
    FlutterSpeed,
    /// Speed at which growing blades first touch the undeformed casing.
    FirstTouch,
    /// Smallest pulse that makes a blade touch.
    TouchingPulse,
    /// Contact force of group a in the lock, positive in compression.
    PushA,
    /// Contact force of group b in the lock, positive in compression.
    PushB,
    /// Torque of the rotor that sustains the lock.
    Torque,
    /// Power of that torque.
    Power,
    /// Largest lobe height of the casing with which the lock persists.
    Roundness,
}

/// Physical quantity of a limit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Quantity {
    /// Rotor speed.
    #[serde(rename = "speed_rad_s")]
    Speed,
    /// Force of the pulse.
    #[serde(rename = "pulse_n")]
    Pulse,
    /// Contact force.
    #[serde(rename = "push_n")]
    Push,
    /// Torque.
    #[serde(rename = "torque_nm")]
    Torque,
    /// Power.
    #[serde(rename = "power_w")]
    Power,
    /// Height of lobes.
    #[serde(rename = "height_m")]
    Height,
}

/// A limit of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Limit {
    /// Name of the limit.
    pub name: LimitName,
    /// Number of casing lobes to which a limit of roundness refers; `None` for all other limits.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lobes: Option<u32>,
    /// Physical quantity of the value.
    pub quantity: Quantity,
    /// Value in SI units; `None` if there is no such limit.
    pub value: Option<f64>,
    /// Value of the scene that is compared with the limit, speeds as magnitudes; `None` for loads
    /// of the lock.
    pub present: Option<f64>,
    /// Margin `present/value - 1`, negative if the scene is below the limit; `None` if one of the
    /// two is missing, or the limit is 0. `null` in JSON above `MOST_TIMES`.
    #[serde(serialize_with = "shown_margin")]
    pub margin: Option<f64>,
    /// Sensitivities `d ln(value)/d ln(parameter)` to every parameter of the scene; `None` above
    /// `MOST_SENSITIVE`.
    pub sensitivities: Sensitivities,
    /// What the closed form neglects, or why there is no value; `None` if there is nothing to say.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// Sensitivities of one limit by the key of the parameter; `None` without a derivative.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sensitivities(pub Vec<(&'static str, Option<f64>)>);

impl Serialize for Sensitivities {
    fn serialize<S: serde::Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        out.collect_map(self.0.iter().copied())
    }
}

impl Sensitivities {
    /// Returns the sensitivity to one parameter; `None` if the scene does not have the parameter,
    /// or if there is no derivative.
    #[must_use]
    pub fn by(&self, path: &str) -> Option<f64> {
        self.0.iter().find(|(by, _)| *by == path)?.1
    }

    /// Returns the parameters with the largest sensitivities, up to `count`, in decreasing order.
    /// The clearance is included instead of the two lengths of which it is the difference: one per
    /// cent of a radius is many clearances.
    #[must_use]
    pub fn strongest(&self, count: usize) -> Vec<(&'static str, f64)> {
        let own = |path| !is_length(path);
        let moving = self.0.iter().filter_map(|&(path, by)| Some((path, by?)));
        let mut moving: Vec<_> =
            moving.filter(|&(path, by)| own(path) && by.abs() > LEAST).collect();
        // Rounding keeps equal sensitivities in their order despite different last digits.
        moving.sort_by_key(|(_, by)| std::cmp::Reverse((by.abs() / LEAST).round() as u64));
        moving.truncate(count);
        moving
    }
}

/// Sensitivities below this are ignored: a change of the parameter by a tenth then alters less than
/// the last displayed digit.
const LEAST: f64 = 1e-4;

/// Largest margin that is reported as a number: the scene is at 100 times the limit. A larger one
/// is shown as `> 100 x`, and is empty in tables for files and `null` in JSON.
pub const MOST_TIMES: f64 = 99.0;

/// Serialises a margin up to `MOST_TIMES`, otherwise `null`.
pub(in crate::study) fn shown_margin<S: serde::Serializer>(
    margin: &Option<f64>,
    out: S,
) -> Result<S::Ok, S::Error> {
    margin.filter(|margin| *margin <= MOST_TIMES).serialize(out)
}

impl Limit {
    /// Creates a limit; `present` is the value of the scene to compare with.
    pub(super) fn new(name: LimitName, value: Option<f64>, present: Option<f64>) -> Self {
        let value = value.filter(|value| value.is_finite());
        let margin = present.zip(value).map(|(present, value)| present / value - 1.0);
        Self {
            name,
            lobes: None,
            quantity: name.quantity(),
            value,
            present,
            margin: margin.filter(|margin| margin.is_finite()),
            sensitivities: Sensitivities::default(),
            note: None,
        }
    }
}

impl LimitName {
    /// Returns the quantity, the symbol, the titles for wide and for narrow tables, and a short
    /// description.
    #[rustfmt::skip]
    fn entry(self) -> (Quantity, &'static str, [&'static str; 2], &'static str) {
        use Quantity::{Pulse, Push, Speed};
        match self {
            Self::OmegaC => (Speed, "Ω_c", ["Ω_c"; 2], "critical speed: above it the wave presses against the blades"),
            Self::OmegaAdhesive => (Speed, "Ω_adhesive", ["adhesive limit", "adhesive"], "above it the bilateral law locks; one group pulls"),
            Self::OmegaLock => (Speed, "Ω_lock", ["Ω_lock"; 2], "lowest speed at which both groups of a lock push"),
            Self::LockEnds => (Speed, "Ω_ends", ["lock ends"; 2], "highest speed at which both groups of a lock push"),
            Self::Coincidence => (Speed, "Ω_coincidence", ["coincidence"; 2], "dangerous coincidence (31), from the sum of both frequencies"),
            Self::CoincidenceDifference => (Speed, "Ω_difference", ["coincidence (30)", "coinc. (30)"], "coincidence (30), from their difference"),
            Self::WhirlOnset => (Speed, "Ω_whirl", ["whirl begins", "whirl"], "above it blades and casing whirl, in the limit of many blades"),
            Self::FlutterSpeed => (Speed, "Ω_flutter", ["lock flutters", "flutter"], "above it blades and casing in lasting contact flutter"),
            Self::FirstTouch => (Speed, "Ω_touch", ["first touch"; 2], "speed at which growing blades reach the casing at rest"),
            Self::TouchingPulse => (Pulse, "F_touches", ["F that touches", "F touches"], "smallest pulse that makes a blade touch"),
            Self::PushA => (Push, "-λ_a", ["push of group a", "push a"], "contact force of group a in the lock"),
            Self::PushB => (Push, "-λ_b", ["push of group b", "push b"], "contact force of group b in the lock"),
            Self::Torque => (Quantity::Torque, "T", ["torque"; 2], "torque of the rotor that sustains the lock"),
            Self::Power => (Quantity::Power, "P", ["power"; 2], "power of that torque"),
            Self::Roundness => (Quantity::Height, "e_max", ["out of round", "e_max"], "largest lobe height with which the lock lasts"),
        }
    }

    /// Returns the physical quantity.
    #[must_use]
    pub fn quantity(self) -> Quantity {
        self.entry().0
    }

    /// Returns the symbol used in formulas.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        self.entry().1
    }

    /// Returns the titles for wide and for narrow tables.
    #[must_use]
    pub fn titles(self) -> [&'static str; 2] {
        self.entry().2
    }

    /// Returns a short description.
    #[must_use]
    pub fn what(self) -> &'static str {
        self.entry().3
    }
}

impl Quantity {
    /// Returns the SI unit.
    #[must_use]
    pub fn unit(self) -> &'static str {
        match self {
            Self::Speed => "rad/s",
            Self::Pulse | Self::Push => "N",
            Self::Torque => "N m",
            Self::Power => "W",
            Self::Height => "m",
        }
    }

    /// Returns the key whose value is compared with the limit; `None` for the loads of a lock.
    #[must_use]
    pub fn path(self) -> Option<&'static str> {
        match self {
            Self::Speed => Some(SPEED),
            Self::Pulse => Some(PULSE),
            Self::Height => Some(OUT_OF_ROUND),
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limit(value: f64, present: f64) -> Limit {
        Limit::new(LimitName::TouchingPulse, Some(value), Some(present))
    }

    #[test]
    fn the_strongest_are_those_that_are_seen_to_move_it() {
        let by = [
            ("casing.radius_m", Some(2e3)),
            ("a", Some(0.5)),
            ("b", Some(-0.500_000_001)),
            ("c", None),
            ("d", Some(-2.0)),
            ("e", Some(2e-4)),
            ("f", Some(0.9e-4)),
        ];
        let all = Sensitivities(by.to_vec());
        let told: Vec<&str> = all.strongest(9).iter().map(|(path, _)| *path).collect();
        assert_eq!(told, ["d", "a", "b", "e"]);
        assert_eq!(all.strongest(1), [("d", -2.0)]);
    }

    #[test]
    fn what_is_no_number_is_no_margin() {
        assert_eq!(limit(0.0, 1.0).margin, None);
        assert_eq!(limit(f64::NAN, 1.0).value, None);
        assert_eq!(limit(f64::INFINITY, 1.0).margin, None);
        assert_eq!(limit(100.0, 50.0).margin, Some(-0.5));
    }
}
