//! Numbers in readable form: six significant digits, no trailing zeros, and
//! powers of ten only where the plain form would be long.

use super::prefix::SiScale;
pub use crate::numeric::rounding::rounded;

/// A number in at most six significant digits.
///
/// ```
/// use rubscope::report::number::short;
/// assert_eq!(short(-244.416_23), "-244.416");
/// assert_eq!(short(1.010_283_04e-4), "1.01028e-4");
/// assert_eq!(short(500.0), "500");
/// ```
#[must_use]
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

/// The shortest text that reads back as this number.
#[must_use]
pub fn exact(x: f64) -> String {
    if x != 0.0 && !(1e-4..1e15).contains(&x.abs()) { format!("{x:e}") } else { x.to_string() }
}

/// A time \[s\] in the unit that suits it.
#[must_use]
pub fn time(seconds: f64) -> String {
    let (factor, unit) = match seconds.abs() {
        x if x == 0.0 || x >= 1.0 => (1.0, "s"),
        x if x >= 1e-3 => (1e3, "ms"),
        x if x >= 1e-6 => (1e6, "us"),
        _ => (1e9, "ns"),
    };
    format!("{} {unit}", short(seconds * factor))
}

/// A number in at most so many significant digits, in its unit with the prefix that
/// suits it; in letters of ASCII.
#[must_use]
pub fn with_unit(x: f64, digits: usize, unit: &str) -> String {
    let scale = SiScale::before(unit, x);
    let shown = short(rounded(x / scale.factor, digits));
    format!("{shown} {}{unit}", scale.in_ascii()).trim_end().to_string()
}

/// "1 step", "2 steps", "1,000,000 steps".
#[must_use]
pub fn count(n: u64, noun: &str) -> String {
    format!("{} {noun}{}", grouped(n), if n == 1 { "" } else { "s" })
}

/// A whole number with a comma between thousands.
#[must_use]
pub fn grouped(n: u64) -> String {
    let digits = n.to_string();
    let mut grouped = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            grouped.push(',');
        }
        grouped.push(digit);
    }
    grouped
}

/// Decimal digits without zeros at the end.
#[must_use]
pub fn trimmed(digits: &str) -> &str {
    if digits.contains('.') { digits.trim_end_matches('0').trim_end_matches('.') } else { digits }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn six_digits_and_no_more() {
        for (x, text) in [
            (0.0, "0"),
            (-0.0, "0"),
            (292.878_4, "292.878"),
            (0.004, "0.004"),
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
    fn times_and_counts_read_well() {
        assert_eq!(time(2.282_19e-4), "228.219 us");
        assert_eq!(time(0.1), "100 ms");
        assert_eq!(time(0.0), "0 s");
        assert_eq!(count(1, "step"), "1 step");
        assert_eq!(count(1_000_000, "step"), "1,000,000 steps");
        assert_eq!(count(999, "impact"), "999 impacts");
    }
}
