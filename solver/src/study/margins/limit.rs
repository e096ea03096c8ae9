//! One limit: what it is (`LIMITS`), its value, where the scene stands, and what moves it.

use crate::scene::keys::{OUT_OF_ROUND, PULSE, SPEED};
use serde::{Deserialize, Serialize};
use strum::{AsRefStr, Display, EnumIter, EnumString, VariantNames};

use super::parameters::is_length;

/// Which limit.
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
    /// The critical speed.
    OmegaC,
    /// The speed from which a lock holds by pushes alone.
    OmegaLock,
    /// The speed up to which it does.
    LockEnds,
    /// The speed down to which the paper's equality algorithm holds one.
    OmegaAdhesive,
    /// The dangerous coincidence (31).
    Coincidence,
    /// The other coincidence of (30), of the difference of the frequencies.
    CoincidenceDifference,
    /// The speed from which inclined tips whirl with the casing.
    WhirlOnset,
    /// The speed from which a lock of inclined tips flutters; 0 where it does from rest on.
    FlutterSpeed,
    /// The speed at which growing blades first touch a casing at rest.
    FirstTouch,
    /// The smallest pulse that touches.
    TouchingPulse,
    /// Push of the group a of the lock: minus its multiplier, positive where it pushes.
    PushA,
    /// Push of the group b, likewise.
    PushB,
    /// Torque that holds the lock.
    Torque,
    /// Its power.
    Power,
    /// The largest height of lobes of the casing with which the lock lasts.
    Roundness,
}

/// What a limit is a value of.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub enum Quantity {
    /// Rotor speed.
    #[serde(rename = "speed_rad_s")]
    Speed,
    /// Pulse.
    #[serde(rename = "pulse_n")]
    Pulse,
    /// Force.
    #[serde(rename = "push_n")]
    Push,
    /// Torque.
    #[serde(rename = "torque_nm")]
    Torque,
    /// Power.
    #[serde(rename = "power_w")]
    Power,
    /// Height.
    #[serde(rename = "height_m")]
    Height,
}

/// On which side of a limit the scene stands.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Display)]
#[strum(serialize_all = "lowercase")]
pub enum Side {
    /// The scene has less than the limit.
    Below,
    /// It is at the limit, to nine digits.
    At,
    /// It has more.
    Beyond,
}

/// One limit of a scene.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Limit {
    /// Which.
    pub name: LimitName,
    /// Lobes of the casing that it is of.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub lobes: Option<u32>,
    /// What it is a value of.
    pub quantity: Quantity,
    /// Its value in SI units; none where there is no such limit.
    pub value: Option<f64>,
    /// The value of the scene that it limits; none for loads of the lock. Speeds are
    /// magnitudes.
    pub present: Option<f64>,
    /// `present/value - 1`: how far beyond the limit the scene is, as a part of it;
    /// below zero it is not there yet. `null` in JSON above `MOST_TIMES`.
    #[serde(serialize_with = "shown_margin")]
    pub margin: Option<f64>,
    /// `d ln(value)/d ln(parameter)` of every parameter of the scene; none above
    /// `MOST_SENSITIVE`.
    pub sensitivities: Sensitivities,
    /// What else is to be said, such as why there is no value.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
}

/// The sensitivities of one limit, by the path of the parameter; none where there is
/// no derivative.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Sensitivities(pub Vec<(&'static str, Option<f64>)>);

impl Serialize for Sensitivities {
    fn serialize<S: serde::Serializer>(&self, out: S) -> Result<S::Ok, S::Error> {
        out.collect_map(self.0.iter().copied())
    }
}

impl Sensitivities {
    /// That by one parameter.
    #[must_use]
    pub fn by(&self, path: &str) -> Option<f64> {
        self.0.iter().find(|(by, _)| *by == path)?.1
    }

    /// The parameters that move the limit most, up to `count`, most first. The two
    /// lengths are not among them, but the clearance that they leave: one per cent of
    /// a radius is many clearances.
    #[must_use]
    pub fn strongest(&self, count: usize) -> Vec<(&'static str, f64)> {
        let own = |path| !is_length(path);
        let moving = self.0.iter().filter_map(|&(path, by)| Some((path, by?)));
        let mut moving: Vec<_> =
            moving.filter(|&(path, by)| own(path) && by.abs() > LEAST).collect();
        // Equal ones stay in their order, whatever their last digits.
        moving.sort_by_key(|(_, by)| std::cmp::Reverse((by.abs() / LEAST).round() as u64));
        moving.truncate(count);
        moving
    }
}

/// A sensitivity below which a parameter does not move a limit: a change of a tenth
/// in it is less than the last digit shown.
const LEAST: f64 = 1e-4;

/// A margin above which it says no more than "far beyond", as do its digits: 100 times.
pub const MOST_TIMES: f64 = 99.0;

/// Writes a margin that is not above `MOST_TIMES`.
pub(in crate::study) fn shown_margin<S: serde::Serializer>(
    margin: &Option<f64>,
    out: S,
) -> Result<S::Ok, S::Error> {
    margin.filter(|margin| *margin <= MOST_TIMES).serialize(out)
}

/// Part of a limit within which a scene is at it.
const AT: f64 = 1e-9;

impl Limit {
    /// A limit of this value, at which the scene has `present`.
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

    /// Returns which way a load of the lock acts, or on which side of another limit the
    /// scene stands.
    #[must_use]
    pub fn way(&self) -> String {
        match (self.quantity, self.value) {
            (Quantity::Push, Some(push)) if push < 0.0 => "pulls".to_string(),
            (Quantity::Push, Some(_)) => "pushes".to_string(),
            _ => self.side().map_or_else(String::new, |side| side.to_string()),
        }
    }

    /// Returns the side on which the scene stands.
    #[must_use]
    pub fn side(&self) -> Option<Side> {
        Some(match self.margin? {
            margin if margin.abs() < AT => Side::At,
            margin if margin < 0.0 => Side::Below,
            _ => Side::Beyond,
        })
    }
}

impl LimitName {
    /// Its row in `LIMITS`.
    fn entry(self) -> &'static Entry {
        &LIMITS[self as usize]
    }

    /// What it is a value of.
    #[must_use]
    pub fn quantity(self) -> Quantity {
        self.entry().quantity
    }

    /// Its symbol in formulas.
    #[must_use]
    pub fn symbol(self) -> &'static str {
        self.entry().symbol
    }

    /// Its title in a table: the long one, and that of narrow tables.
    #[must_use]
    pub fn titles(self) -> [&'static str; 2] {
        self.entry().titles
    }

    /// What it is, in a few words.
    #[must_use]
    pub fn what(self) -> &'static str {
        self.entry().what
    }
}

/// What is known of a limit before its value.
struct Entry {
    name: LimitName,
    quantity: Quantity,
    symbol: &'static str,
    titles: [&'static str; 2],
    what: &'static str,
}

const fn entry(
    name: LimitName,
    quantity: Quantity,
    symbol: &'static str,
    titles: [&'static str; 2],
    what: &'static str,
) -> Entry {
    Entry { name, quantity, symbol, titles, what }
}

/// Every limit, in the order of the names.
#[rustfmt::skip]
const LIMITS: [Entry; 15] = {
    use LimitName::*;
    use Quantity::{Pulse, Push, Speed};
    [
        entry(OmegaC, Speed, "Ω_c", ["Ω_c"; 2], "critical speed: above it the wave is pushed outward"),
        entry(OmegaLock, Speed, "Ω_lock", ["Ω_lock"; 2], "from it on both blades of a lock push"),
        entry(LockEnds, Speed, "Ω_ends", ["lock ends"; 2], "up to it both blades of a lock push"),
        entry(OmegaAdhesive, Speed, "Ω_adhesive", ["adhesive limit", "adhesive"], "above it the bilateral law holds, if one blade pulls"),
        entry(Coincidence, Speed, "Ω_coincidence", ["coincidence"; 2], "dangerous coincidence (31), of the sum of frequencies"),
        entry(CoincidenceDifference, Speed, "Ω_difference", ["coincidence (30)", "coinc. (30)"], "coincidence (30) of their difference"),
        entry(WhirlOnset, Speed, "Ω_whirl", ["whirl begins", "whirl"], "above it blades and casing whirl, on a rim of many blades"),
        entry(FlutterSpeed, Speed, "Ω_flutter", ["lock flutters", "flutter"], "from it on a lock of inclined tips flutters"),
        entry(FirstTouch, Speed, "Ω_touch", ["first touch"; 2], "at it blades that grow touch a casing at rest"),
        entry(TouchingPulse, Pulse, "F_touches", ["F that touches", "F touches"], "smallest pulse that touches"),
        entry(PushA, Push, "-λ_a", ["push of group a", "push a"], "push of group a in the lock"),
        entry(PushB, Push, "-λ_b", ["push of group b", "push b"], "push of group b in the lock"),
        entry(Torque, Quantity::Torque, "T", ["torque"; 2], "torque that holds the lock"),
        entry(Power, Quantity::Power, "P", ["power"; 2], "power that the lock takes"),
        entry(Roundness, Quantity::Height, "e_max", ["out of round", "e_max"], "largest height of lobes with which the lock lasts"),
    ]
};

/// Each row is at the place of its name.
const _: () = {
    let mut place = 0;
    while place < LIMITS.len() {
        assert!(LIMITS[place].name as usize == place);
        place += 1;
    }
};

impl Quantity {
    /// Its unit.
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

    /// The key of the scene that it limits.
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
    fn a_scene_is_below_at_or_beyond() {
        assert_eq!(limit(100.0, 50.0).margin, Some(-0.5));
        for (present, side) in [
            (50.0, Side::Below),
            (100.0, Side::At),
            (100.0 * (1.0 - 1e-8), Side::Below),
            (100.0 * (1.0 + 1e-8), Side::Beyond),
            (1e9, Side::Beyond),
        ] {
            assert_eq!(limit(100.0, present).side(), Some(side), "{present:?}");
        }
    }

    #[test]
    fn what_is_no_number_is_no_margin() {
        assert_eq!(limit(0.0, 1.0).margin, None);
        assert_eq!(limit(f64::NAN, 1.0).value, None);
        assert_eq!(limit(f64::INFINITY, 1.0).side(), None);
    }
}
