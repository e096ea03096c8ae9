//! Numbers and quantities as text: rounded or exact, with SI prefixes, and limited to the digits
//! that tiny changes of the input do not affect.

use std::cell::Cell;
use std::f64::consts::TAU;

pub use rubscope_solver::numeric::rounding::rounded;
use rubscope_solver::scene::Quantity;

/// Formats a number with at most six significant digits, as `-244.416` or `1.01028e-4`.
pub fn short(x: f64) -> String {
    if x == 0.0 {
        return "0".to_string();
    }
    if !x.is_finite() {
        return "not a number".to_string();
    }
    let scientific = format!("{x:.5e}");
    let (digits, exponent) = scientific.split_once('e').unwrap_or((&scientific, "0"));
    let exponent: i32 = exponent.parse().unwrap_or(0);
    if (-3..6).contains(&exponent) {
        let decimals = usize::try_from(5 - exponent).unwrap_or(0);
        trimmed(&format!("{x:.decimals$}")).to_string()
    } else {
        format!("{}e{exponent}", trimmed(digits))
    }
}

/// Returns the shortest text that reads back as this number.
pub fn exact(x: f64) -> String {
    if x != 0.0 && !(1e-4..1e15).contains(&x.abs()) { format!("{x:e}") } else { x.to_string() }
}

/// Formats a time \[s\] with the prefix that suits it.
pub fn time(seconds: f64) -> String {
    let of = if seconds == 0.0 { 1.0 } else { seconds.abs().clamp(1e-9, 1.0) };
    scaled(seconds, of, 6, "s").join(" ")
}

/// Formats a number with at most `digits` significant digits and its unit, with a suitable SI
/// prefix. Micro is `u`, or `µ` on a screen that is not ASCII.
pub fn with_unit(x: f64, digits: usize, unit: &str) -> String {
    scaled(x, x, digits, unit).join(" ").trim_end().to_string()
}

/// As [`with_unit`], but returns number and unit as two strings, with the SI prefix that suits `of`
/// instead of `x`, so that several numbers can share a unit.
pub fn scaled(x: f64, of: f64, digits: usize, unit: &str) -> [String; 2] {
    let ((x, _), (of, unit)) = (in_shown_unit(x, unit), in_shown_unit(of, unit));
    let scale = SiScale::before(unit, of);
    let shown = rounded(x / scale.factor, digits);
    let number = if unit == RPM { in_tenths(shown) } else { short(shown) };
    [number, scale.prefix.replace('µ', micro()) + unit]
}

thread_local! {
    /// Whether this thread shows speeds in rpm; otherwise in rad/s.
    static IN_RPM: Cell<bool> = const { Cell::new(false) };
    /// How this thread spells the prefix micro.
    static MICRO: Cell<&'static str> = const { Cell::new("u") };
}

/// Makes this thread spell the prefix micro like this.
pub fn spell_micro(sign: &'static str) {
    MICRO.set(sign);
}

/// Makes this thread show speeds in rpm (true) or in rad/s.
pub fn tell_in_rpm(rpm: bool) {
    IN_RPM.set(rpm);
}

/// Returns how this thread spells the prefix micro.
pub fn micro() -> &'static str {
    MICRO.get()
}

/// Returns the unit in which speeds are shown.
pub fn speed_unit() -> &'static str {
    if IN_RPM.get() { RPM } else { RAD_S }
}

/// Converts a speed from rad/s to the unit in which speeds are shown.
pub fn per_speed(omega: f64) -> f64 {
    if IN_RPM.get() { omega * 60.0 / TAU } else { omega }
}

/// Formats a speed \[rad/s\] with its unit: at most six significant digits, or tenths of an rpm.
pub fn speed(omega: f64) -> String {
    with_unit(omega, 6, RAD_S)
}

/// Describes a range of speeds \[rad/s\] with this many significant digits; an end that is `None` is
/// open.
pub fn span(from: Option<f64>, to: Option<f64>, digits: usize) -> String {
    let told = |omega| scaled(omega, omega, digits, RAD_S);
    match (from.map(told), to.map(told)) {
        (None, None) => "at every speed".to_string(),
        (None, Some(to)) => format!("up to {}", to.join(" ")),
        (Some(from), None) => format!("from {}", from.join(" ")),
        (Some([from, _]), Some(to)) => format!("from {from} to {}", to.join(" ")),
    }
}

/// Formats a speed that is already in the shown unit: one decimal, or three below 10.
pub fn in_tenths(speed: f64) -> String {
    let decimals = if speed.abs() < 10.0 { 3 } else { 1 };
    trimmed(&format!("{speed:.decimals$}")).to_string()
}

/// Replaces the speeds marked in a text by their values in the shown unit: `{411.934}` without the
/// unit, `{500 rad/s}` with it, and `{878.635 1/s}` as an angular frequency with its unit.
pub fn with_speeds(text: &str) -> String {
    let told = |(place, part): (usize, &str)| {
        let (number, unit) = part.split_once(' ').unwrap_or((part, ""));
        let Some(omega) = number.parse().ok().filter(|_| place % 2 == 1) else {
            return part.to_string();
        };
        match unit {
            "" => in_tenths(per_speed(omega)),
            RAD_S => format!("{} {}", in_tenths(per_speed(omega)), speed_unit()),
            _ => format!("{} {}", in_tenths(per_frequency(omega)), frequency_unit()),
        }
    };
    text.split(['{', '}']).enumerate().map(told).collect()
}

/// Returns the unit in which angular frequencies are shown: Hz if speeds are in rpm.
pub fn frequency_unit() -> &'static str {
    if IN_RPM.get() { "Hz" } else { RAD_S }
}

/// Converts an angular frequency from rad/s to the unit in which frequencies are shown.
pub fn per_frequency(omega: f64) -> f64 {
    if IN_RPM.get() { omega / TAU } else { omega }
}

/// Converts a number in rad/s to the unit in which speeds are shown; numbers of other units stay.
/// Returns the number and its unit.
pub fn in_shown_unit(x: f64, unit: &str) -> (f64, &str) {
    if unit == RAD_S { (per_speed(x), speed_unit()) } else { (x, unit) }
}

/// Converts a shown number back to `unit`, its SI unit: the inverse of [`in_shown_unit`].
pub fn from_shown(x: f64, unit: &str) -> f64 {
    if unit == RAD_S && IN_RPM.get() { x * (TAU / 60.0) } else { x }
}

/// Appends the unit in which speeds are shown to a typed speed, or to the ends of a typed range, if
/// they have no unit of their own.
pub fn with_typed_unit(text: &str, of: Quantity) -> String {
    if of != Quantity::Speed || !IN_RPM.get() {
        return text.to_string();
    }
    let parts = text.split(':').enumerate().map(|(place, part)| match part.trim_end() {
        // The third part of a range is a count.
        number if place < 2 && Quantity::bare(number).is_some() => {
            format!("{number}{}", speed_unit())
        }
        _ => part.to_string(),
    });
    parts.collect::<Vec<_>>().join(":")
}

const RAD_S: &str = "rad/s";
const RPM: &str = "rpm";

/// Formats a count with its noun: "1 step", "2 steps", "1,000,000 steps".
pub fn count(n: u64, noun: &str) -> String {
    format!("{} {noun}{}", grouped(n), if n == 1 { "" } else { "s" })
}

/// Formats a whole number with commas between thousands.
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let groups = digits.as_bytes().rchunks(3).rev().map(String::from_utf8_lossy);
    groups.collect::<Vec<_>>().join(",")
}

/// Removes trailing zeros after a decimal point.
pub fn trimmed(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

/// An SI prefix, or a change of unit, for one number or a whole axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SiScale {
    /// Size of the shown unit in the base unit, such as 1e3 for `k`. The shown number is the value
    /// divided by it.
    pub factor: f64,
    /// Prefix in front of the unit; may be empty.
    pub prefix: &'static str,
}

/// Factors and their SI prefixes, in increasing order.
const PREFIXES: &[(f64, &str)] = &[
    (1e-15, "f"),
    (1e-12, "p"),
    (1e-9, "n"),
    (1e-6, "µ"),
    (1e-3, "m"),
    (1.0, ""),
    (1e3, "k"),
    (1e6, "M"),
    (1e9, "G"),
];

impl SiScale {
    /// Returns the prefix with which a number of this magnitude reads as 1 to 999, within the range
    /// of `PREFIXES`.
    pub fn of(magnitude: f64) -> Self {
        let magnitude = magnitude.abs() * (1.0 + 1e-9);
        let (factor, prefix) = PREFIXES
            .iter()
            .rev()
            .find(|(factor, _)| magnitude >= *factor)
            .copied()
            .unwrap_or(if magnitude > 0.0 { (1e-15, "f") } else { (1.0, "") });
        Self { factor, prefix }
    }

    /// Returns the prefix that suits a number of this magnitude and unit; the empty one for units
    /// that take no prefix.
    pub fn before(unit: &str, magnitude: f64) -> Self {
        if WITH_PREFIX.contains(&unit) { Self::of(magnitude) } else { Self::plain() }
    }

    /// Returns the empty prefix, for angles, speeds and counts.
    pub const fn plain() -> Self {
        Self { factor: 1.0, prefix: "" }
    }

    /// Formats a tick label with as many decimals as the tick spacing `step` needs, or with a power
    /// of ten if it needs more than nine.
    pub fn label(&self, value: f64, step: f64) -> String {
        let (shown, step) = (value / self.factor, step / self.factor);
        match (-step.log10() - 1e-9).ceil() {
            decimals if decimals > 9.0 => short(shown),
            decimals => format!("{shown:.*}", decimals.max(0.0) as usize),
        }
    }
}

/// Units that take a prefix.
const WITH_PREFIX: [&str; 9] = ["m", "s", "N", "N/m", "m/s", "N m/rad", "N m", "W", "J"];

/// Largest number of reliable digits that are counted: as many as are shown.
const MOST: u32 = 6;

/// Number format of one run: shows only the digits that its sensitivity leaves reliable.
#[derive(Debug, Default)]
pub struct Digits {
    /// Whether runs with tiny changes were made, so that the spread of the numbers is known.
    known: bool,
    left_out: Cell<bool>,
    none: Cell<bool>,
}

impl Digits {
    /// Creates the format. If spreads are `known`, a number without one has no reliable digit;
    /// otherwise all digits are shown.
    pub fn of(known: bool) -> Self {
        Self { known, ..Self::default() }
    }

    /// Formats `x` with `show`, rounded to the digits that a deviation of `spread` (in the unit of
    /// `x`) leaves reliable; without any, to one digit after "about". A `spread` of `None` means
    /// that some changed run has no such number.
    pub fn shown(&self, x: f64, spread: Option<f64>, show: impl Fn(f64) -> String) -> String {
        let spread = if self.known { spread.unwrap_or(f64::INFINITY) } else { 0.0 };
        match reliable_digits(x, spread) {
            MOST.. => show(x),
            0 => {
                self.none.set(true);
                format!("about {}", show(rounded(x, 1)))
            }
            some => {
                self.left_out.set(true);
                show(rounded(x, some as usize))
            }
        }
    }

    /// Returns the remark on digits that were left out; `None` if no number so far lost a digit.
    pub fn note(&self) -> Option<&'static str> {
        if self.none.get() {
            Some(
                "A value given as \"about\" has no reliable digit: a tiny change or another step moves it by as much.",
            )
        } else if self.left_out.get() {
            Some("Digits that a tiny change or another step changes are not shown.")
        } else {
            None
        }
    }
}

/// Returns how many digits of `x` are reliable, at most [`MOST`]: `spread` is no more than half a
/// unit of the last one.
fn reliable_digits(x: f64, spread: f64) -> u32 {
    // Zero has no digits to lose.
    if spread == 0.0 || x == 0.0 {
        return MOST;
    }
    let first = x.abs().log10().floor();
    let digits = (first + 1.0 - (2.0 * spread).log10()).floor();
    (1..=MOST).rev().find(|&count| f64::from(count) <= digits).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_digits_and_no_more() {
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (-244.416_23, "-244.416"),
            (1.010_283_04e-4, "1.01028e-4"),
            (0.000_999_999_9, "0.001"),
            (999_999.5, "1e6"),
            (123_456.0, "123456"),
            (-1e12, "-1e12"),
            (f64::NAN, "not a number"),
        ] {
            assert_eq!(short(x), text);
        }
    }

    #[test]
    fn units_take_the_prefix_that_suits() {
        for (x, digits, unit, text) in [
            (3_795.024_727, 6, "N", "3.79502 kN"),
            (-1e6, 6, "N", "-1 MN"),
            (411.933_517, 4, "rad/s", "411.9 rad/s"),
            (4.351_543e-8, 6, "rad", "4.35154e-8 rad"),
            (1e-4, 6, "m", "100 um"),
            (0.05, 6, "", "0.05"),
            (0.0, 6, "N", "0 N"),
        ] {
            assert_eq!(with_unit(x, digits, unit), text);
        }
    }

    #[test]
    fn a_bare_speed_that_is_typed_has_the_unit_in_which_speeds_are_shown() {
        let typed = |text| with_typed_unit(text, Quantity::Speed);
        assert_eq!((typed("4500"), from_shown(450.0, "rad/s")), ("4500".into(), 450.0));
        tell_in_rpm(true);
        for (text, with_unit) in [
            ("4500", "4500rpm"),
            (" -4.5k ", " -4.5krpm"),
            ("0:9e3:51", "0rpm:9e3rpm:51"),
            ("150Hz:9500", "150Hz:9500rpm"),
            ("450 rad/s", "450 rad/s"),
            ("43 kN", "43 kN"),
            ("20m", "20m"),
            ("5 %", "5 %"),
            ("fast", "fast"),
            ("", ""),
        ] {
            assert_eq!(typed(text), with_unit);
        }
        let (force, read) = (with_typed_unit("4500", Quantity::Force), typed("4.5k"));
        let [shown, back] = [450.0, 4500.0].map(|x| (per_speed(x), from_shown(x, "rad/s")));
        tell_in_rpm(false);
        assert_eq!(force, "4500");
        assert_eq!(Quantity::Speed.read(&read), Ok(4500.0 * (TAU / 60.0)));
        assert_eq!(back.1, 4500.0 * (TAU / 60.0));
        assert!((shown.0 * TAU / 60.0 / 450.0 - 1.0).abs() < 1e-15);
    }

    #[test]
    fn times_and_counts_read_well() {
        assert_eq!(time(2.282_19e-4), "228.219 us");
        assert_eq!(time(0.1), "100 ms");
        assert_eq!((time(0.0), time(2.5)), ("0 s".into(), "2.5 s".into()));
        spell_micro("µ");
        let told = [time(2.282_19e-4), with_unit(2.4e-7, 6, "m"), with_unit(1e-4, 6, "m")];
        spell_micro("u");
        assert_eq!(told, ["228.219 µs", "240 nm", "100 µm"]);
        assert_eq!(count(1, "step"), "1 step");
        assert_eq!(count(1_000_000, "step"), "1,000,000 steps");
        assert_eq!(count(999, "impact"), "999 impacts");
    }
}

#[cfg(test)]
mod digits_tests {
    use super::*;

    #[test]
    fn only_digits_that_hold_are_told() {
        for (x, spread, text) in [
            (2.68635e-6, 0.0, "2.68635e-6"),
            (2.68635e-6, 1e-13, "2.68635e-6"),
            (2.68635e-6, 5.33e-9, "2.7e-6"),
            (-244.416, 0.004, "-244.42"),
            (-244.416, 0.006, "-244.4"),
            (-244.416, 0.6, "-240"),
            (2.68635e-6, 1.4e-6, "about 3e-6"),
            (2.68635e-6, f64::INFINITY, "about 3e-6"),
            (0.0, 1e-9, "0"),
        ] {
            assert_eq!(Digits::of(true).shown(x, Some(spread), short), text, "{x} {spread}");
        }
    }

    #[test]
    fn what_was_not_told_is_said() {
        let digits = Digits::of(true);
        assert_eq!((digits.shown(1.25, Some(0.0), short), digits.note()), ("1.25".into(), None));
        let _ = digits.shown(1.25, Some(0.04), short);
        assert!(digits.note().unwrap().contains("not shown"));
        // A number that does not exist in a changed run has no reliable digit.
        let _ = digits.shown(1.25, None, short);
        assert!(digits.note().unwrap().contains("has no reliable digit"));
        assert_eq!(Digits::of(false).shown(1.25, None, short), "1.25");
    }
}
