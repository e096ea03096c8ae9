//! Reader of numbers with units: the list of units by quantity, and SI prefixes. A bare number is
//! in SI units.
//!
//! Examples: `9500rpm`, `1200 rad/s`, `43.4 kN`, `43.4k`, `0.2 mm`, `50us`. Prefix and digits are
//! combined into one decimal number before conversion, so that `50u` equals `50e-6` exactly.

use std::f64::consts::TAU;

use thiserror::Error;

/// Physical quantity of a number. The letter `m` alone is always the metre, never the prefix milli.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Dimensionless: a count or a ratio.
    Plain,
    /// Angular speed or frequency.
    Speed,
    /// Angular acceleration.
    Acceleration,
    /// Force.
    Force,
    /// Length.
    Length,
    /// Time.
    Time,
    /// Velocity.
    Velocity,
    /// Mass.
    Mass,
    /// Stiffness.
    Stiffness,
    /// Moment of inertia.
    Inertia,
    /// Torque.
    Torque,
    /// Torsional stiffness.
    TorsionalStiffness,
    /// Angle.
    Angle,
    /// Power.
    Power,
    /// Energy.
    Energy,
    /// Length divided by the square of an angular speed, as in the loss of clearance `c Omega^2`.
    Growth,
}

use Quantity::{
    Acceleration, Angle, Energy, Force, Growth, Inertia, Length, Mass, Plain, Power, Speed,
    Stiffness, Time, Torque, TorsionalStiffness, Velocity,
};

/// A unit: its quantity, its symbol, and its size in SI units as `factor` times a power of ten. The
/// factor is 1 for decimal units.
struct Unit {
    quantity: Quantity,
    name: &'static str,
    power: i32,
    factor: f64,
    /// Whether SI prefixes are allowed.
    prefixed: bool,
}

const fn unit(quantity: Quantity, name: &'static str, power: i32) -> Unit {
    Unit { quantity, name, power, factor: 1.0, prefixed: true }
}

const fn whole(quantity: Quantity, name: &'static str, factor: f64) -> Unit {
    Unit { quantity, name, power: 0, factor, prefixed: false }
}

/// All units, the SI unit of each quantity first.
const UNITS: &[Unit] = &[
    Unit { quantity: Plain, name: "%", power: -2, factor: 1.0, prefixed: false },
    whole(Speed, "rad/s", 1.0),
    Unit { quantity: Speed, name: "rpm", power: 0, factor: TAU / 60.0, prefixed: true },
    Unit { quantity: Speed, name: "Hz", power: 0, factor: TAU, prefixed: true },
    whole(Acceleration, "rad/s^2", 1.0),
    whole(Acceleration, "rpm/s", TAU / 60.0),
    unit(Force, "N", 0),
    unit(Length, "m", 0),
    unit(Time, "s", 0),
    unit(Velocity, "m/s", 0),
    Unit { quantity: Mass, name: "kg", power: 0, factor: 1.0, prefixed: false },
    unit(Mass, "g", -3),
    Unit { quantity: Mass, name: "t", power: 3, factor: 1.0, prefixed: false },
    unit(Stiffness, "N/m", 0),
    unit(Stiffness, "N/mm", 3),
    Unit { quantity: Inertia, name: "kg m^2", power: 0, factor: 1.0, prefixed: false },
    Unit { quantity: Inertia, name: "kg cm^2", power: -4, factor: 1.0, prefixed: false },
    Unit { quantity: Inertia, name: "kg mm^2", power: -6, factor: 1.0, prefixed: false },
    Unit { quantity: Inertia, name: "g m^2", power: -3, factor: 1.0, prefixed: false },
    unit(Torque, "N m", 0),
    unit(Torque, "N mm", -3),
    unit(TorsionalStiffness, "N m/rad", 0),
    unit(TorsionalStiffness, "N mm/rad", -3),
    unit(Angle, "rad", 0),
    whole(Angle, "deg", TAU / 360.0),
    unit(Power, "W", 0),
    unit(Energy, "J", 0),
    whole(Growth, "m s^2", 1.0),
];

/// SI prefixes and their powers of ten.
const PREFIXES: [(char, i32); 7] =
    [('G', 9), ('M', 6), ('k', 3), ('m', -3), ('u', -6), ('n', -9), ('p', -12)];

/// Reason why a text is not a number of the expected quantity.
#[derive(Clone, Debug, Error, PartialEq)]
#[non_exhaustive]
pub enum UnitError {
    /// The text does not begin with a number.
    #[error("no number")]
    NoNumber,
    /// The number contains a comma.
    #[error("a number has a decimal point and no comma")]
    Comma,
    /// The number can be thousands with a point between them.
    #[error("is that {}0 or {}? Write it so", .0, .0.replace('.', ""))]
    Thousands(String),
    /// The unit belongs to another quantity.
    #[error("this is {is}; {}", accepted_units(*.wanted))]
    Other {
        /// Quantity of the given unit.
        is: &'static str,
        /// Expected quantity.
        wanted: Quantity,
    },
    /// The unit is unknown.
    #[error("no unit {unit}; {}", accepted_units(*.wanted))]
    Unknown {
        /// The unit as given.
        unit: String,
        /// Expected quantity.
        wanted: Quantity,
    },
}

impl Quantity {
    /// Returns the quantity of an SI unit as written in the table of keys; `Plain` for any other
    /// text.
    #[must_use]
    pub fn of(unit: &str) -> Self {
        UNITS.iter().find(|known| known.name == unit).map_or(Plain, |known| known.quantity)
    }

    /// Returns the name of the quantity, with an article.
    fn what(self) -> &'static str {
        match self {
            Plain => "a ratio",
            Speed => "a speed or frequency",
            Acceleration => "an angular acceleration",
            Force => "a force",
            Length => "a length",
            Time => "a time",
            Velocity => "a velocity",
            Mass => "a mass",
            Stiffness => "a stiffness",
            Inertia => "a moment of inertia",
            Torque => "a torque",
            TorsionalStiffness => "a torsional stiffness",
            Angle => "an angle",
            Power => "a power",
            Energy => "an energy",
            Growth => "a length over the square of a speed",
        }
    }

    /// Returns the units of the quantity in words: `rad/s, rpm or Hz`.
    #[must_use]
    pub fn units(self) -> String {
        let names: Vec<&str> =
            UNITS.iter().filter(|unit| unit.quantity == self).map(|unit| unit.name).collect();
        match names.as_slice() {
            [first @ .., last] if !first.is_empty() => format!("{} or {last}", first.join(", ")),
            one => one.concat(),
        }
    }

    /// Reads a number of this quantity.
    ///
    /// # Errors
    /// The text is not a number, or its unit is unknown or belongs to another quantity.
    pub fn read(self, text: &str) -> Result<f64, UnitError> {
        let text = text.trim();
        // A bare number, infinities included; the caller checks the range.
        if let Ok(number) = text.parse() {
            return Ok(number);
        }
        // Signs, digits, point and power of ten; an `e` that no power follows belongs to the unit.
        let rest = text.trim_start_matches(|c: char| c.is_ascii_digit() || "+-.eE".contains(c));
        let number = text.strip_suffix(rest).unwrap_or(text).trim_end_matches(['e', 'E', '+', '-']);
        let unit = text.strip_prefix(number).unwrap_or(rest);
        number.parse::<f64>().map_err(|_| UnitError::NoNumber)?;
        let after = unit.strip_prefix(',');
        if after.is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit())) {
            return Err(UnitError::Comma);
        }
        let written = plain(unit);
        // A spreadsheet may have put the point between thousands, as in 9.500 for 9500 rpm.
        if written.eq_ignore_ascii_case("rpm") && may_be_thousands(number) {
            return Err(UnitError::Thousands(number.to_string()));
        }
        let (power, factor) = self.scale(&written).ok_or_else(|| self.refused(&written, unit))?;
        // Parsed as one decimal number, so that it is rounded only once.
        let (digits, given) = number.split_once(['e', 'E']).unwrap_or((number, "0"));
        let power = given.parse().ok().and_then(|given: i32| given.checked_add(power));
        let scaled = power.and_then(|power| format!("{digits}e{power}").parse().ok());
        let scaled: f64 = scaled.ok_or(UnitError::NoNumber)?;
        Ok(if factor == 1.0 { scaled } else { scaled * factor })
    }

    /// Reads a number without a unit; a prefix is allowed: `1200`, `1.2k`. `None` for any other
    /// text, per cent included.
    #[must_use]
    pub fn bare(text: &str) -> Option<f64> {
        let is_part = text.contains('%') || text.contains("percent");
        Plain.read(text).ok().filter(|_| !is_part)
    }

    /// Returns the size, in SI units, of a unit of this quantity with its prefix, or of a prefix
    /// alone, as a power of ten and a factor; `None` for any other text.
    fn scale(self, written: &str) -> Option<(i32, f64)> {
        let of_unit = UNITS.iter().filter(|unit| unit.quantity == self).find_map(|unit| {
            let prefix = written.strip_suffix(plain(unit.name).as_str());
            // RPM, hz and Kg are accepted too, since they cannot mean anything else.
            let prefix = prefix.or_else(|| any_case(unit, written));
            match prefix? {
                "" => Some((unit.power, unit.factor)),
                prefix if unit.prefixed => Some((unit.power + power_of(prefix)?, unit.factor)),
                _ => None,
            }
        });
        // A lone `m` is the metre, not the prefix milli.
        of_unit.or_else(|| (written != "m").then(|| power_of(written)).flatten().map(|p| (p, 1.0)))
    }

    fn refused(self, written: &str, unit: &str) -> UnitError {
        if !written.chars().all(|c| c.is_alphanumeric() || matches!(c, '/' | '%')) {
            return UnitError::NoNumber;
        }
        let other = UNITS.iter().map(|unit| unit.quantity).find(|of| {
            let named = power_of(written).is_none() || written == "m";
            named && of.scale(written).is_some()
        });
        match other {
            Some(other) => UnitError::Other { is: other.what(), wanted: self },
            None => UnitError::Unknown { unit: unit.trim().to_string(), wanted: self },
        }
    }
}

/// Describes the accepted units in words.
fn accepted_units(quantity: Quantity) -> String {
    format!("it takes {}", quantity.units())
}

/// Returns the prefix before a unit of speed or the kilogram, ignoring case; `None` for another unit,
/// and for text that does not end with the unit.
fn any_case<'a>(unit: &Unit, written: &'a str) -> Option<&'a str> {
    let at = written.len().checked_sub(unit.name.len())?;
    let (prefix, name) = written.split_at_checked(at)?;
    let known = unit.quantity == Speed || unit.name == "kg";
    (known && unit.name.eq_ignore_ascii_case(name)).then_some(prefix)
}

fn power_of(prefix: &str) -> Option<i32> {
    let mut letters = prefix.chars();
    let (letter, None) = (letters.next()?, letters.next()) else { return None };
    PREFIXES.iter().find(|(known, _)| *known == letter).map(|(_, power)| *power)
}

/// Normalises a unit for comparison: no spaces or product signs, ASCII letters, one symbol for each
/// unit.
fn plain(unit: &str) -> String {
    let kept = unit.chars().filter(|c| !c.is_whitespace() && !matches!(c, '·' | '*' | '^'));
    let kept: String = kept
        .map(|c| match c {
            'µ' | 'μ' => 'u',
            '²' => '2',
            other => other,
        })
        .collect();
    match kept.to_lowercase().as_str() {
        "1/min" | "u/min" | "r/min" | "min-1" | "min⁻¹" => "rpm".to_string(),
        "percent" => "%".to_string(),
        _ => kept,
    }
}

/// Returns whether a decimal number is one to three digits, a point and three more, as `9.500`.
fn may_be_thousands(number: &str) -> bool {
    let (whole, decimals) =
        number.trim_start_matches(['+', '-']).split_once('.').unwrap_or_default();
    let is_digits = |text: &str| text.bytes().all(|byte| byte.is_ascii_digit());
    (1..=3).contains(&whole.len())
        && decimals.len() == 3
        && !whole.starts_with('0')
        && is_digits(whole)
        && is_digits(decimals)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::KEYS;

    #[test]
    fn numbers_are_read_as_they_are_written() {
        for (of, text, value) in [
            (Speed, "450", 450.0),
            (Speed, "-430 rad/s", -430.0),
            (Speed, "9500rpm", 9500.0 * (TAU / 60.0)),
            (Speed, "9500 RPM", 9500.0 * (TAU / 60.0)),
            (Speed, "9.5krpm", 9500.0 * (TAU / 60.0)),
            (Speed, "9.500 krpm", 9500.0 * (TAU / 60.0)),
            (Speed, "0.125 rpm", 0.125 * (TAU / 60.0)),
            (Speed, "9500.000 rpm", 9500.0 * (TAU / 60.0)),
            (Speed, "150Hz", 150.0 * TAU),
            (Speed, "0.15 kHz", 150.0 * TAU),
            (Speed, "1.2k", 1200.0),
            (Force, "43.4k", 43.4e3),
            (Force, "43.4 kN", 43.4e3),
            (Force, "1e3k", 1e6),
            (Length, "0.2 mm", 0.2e-3),
            (Length, "20m", 20.0),
            (Length, "100 µm", 1e-4),
            (Time, "50us", 50e-6),
            (Time, "50u", 50e-6),
            (Stiffness, "1.544 MN/m", 1.544e6),
            (Stiffness, "1544 N/mm", 1.544e6),
            (Mass, "250 g", 0.25),
            (Mass, "0.0091 t", 9.1),
            (Mass, "2kg", 2.0),
            (Inertia, "2082.5 kg cm²", 0.20825),
            (TorsionalStiffness, "15 kN·m/rad", 15e3),
            (TorsionalStiffness, "15kNm/rad", 15e3),
            (Torque, "3 Nm", 3.0),
            (Velocity, "5 mm/s", 5e-3),
            (Acceleration, "-400 rad/s^2", -400.0),
            (Plain, "5 %", 0.05),
            (Plain, "0.05", 0.05),
            (Angle, "1 mrad", 1e-3),
        ] {
            assert_eq!(of.read(text), Ok(value), "{text}");
        }
    }

    #[test]
    fn a_bare_number_may_have_a_prefix_and_no_unit() {
        for (text, value) in [("140", 140.0), (" 1.4k", 1400.0), ("-50u", -50e-6), ("1e3", 1e3)] {
            assert_eq!(Quantity::bare(text), Some(value), "{text}");
        }
        for text in ["5 %", "5 percent", "20m", "1.4 kHz", "", "k"] {
            assert_eq!(Quantity::bare(text), None, "{text}");
        }
    }

    #[test]
    fn another_quantity_is_named() {
        for (of, text, told) in [
            (Speed, "43 kN", "this is a force; it takes rad/s, rpm or Hz"),
            (Force, "9500rpm", "this is a speed or frequency; it takes N"),
            (Time, "20m", "this is a length; it takes s"),
            (Length, "50us", "this is a time; it takes m"),
            (Plain, "3 N/m", "this is a stiffness; it takes %"),
            (Speed, "5 furlongs", "no unit furlongs; it takes rad/s, rpm or Hz"),
            (Mass, "5 kkg", "no unit kkg; it takes kg, g or t"),
            (Speed, "fast", "no number"),
            (Force, "1e", "no unit e; it takes N"),
            (Force, "", "no number"),
            (Force, "--3", "no number"),
            (Force, "1.2.3k", "no number"),
            (Speed, "9,500rpm", "a number has a decimal point and no comma"),
            (Length, "0,3mm", "a number has a decimal point and no comma"),
            (Length, "0,", "no number"),
            (Speed, "100:500:5", "no number"),
            (Speed, "9.500 rpm", "is that 9.5000 or 9500? Write it so"),
            (Speed, "-12.000 U/min", "is that -12.0000 or -12000? Write it so"),
        ] {
            assert_eq!(of.read(text).unwrap_err().to_string(), told, "{text}");
        }
    }

    #[test]
    fn every_unit_of_a_key_is_in_the_list() {
        for key in KEYS.iter().filter(|key| key.unit != "-") {
            assert_ne!(Quantity::of(key.unit), Plain, "{} {}", key.path, key.unit);
            assert_eq!(Quantity::of(key.unit).read(&format!("1 {}", key.unit)), Ok(1.0));
        }
    }

    #[test]
    fn every_unit_is_of_one_quantity() {
        for unit in UNITS {
            for other in UNITS.iter().filter(|other| other.quantity != unit.quantity) {
                let written = plain(unit.name);
                assert_eq!(
                    other.quantity.scale(&written),
                    None,
                    "{} {:?}",
                    unit.name,
                    other.quantity
                );
            }
        }
    }
}
