//! Axes: round ticks (steps of 1, 2 or 5), labels with one SI prefix per axis, and ranges that
//! follow the data with hysteresis, so that the scale does not jump.

pub use crate::sheet::number::SiScale;
use crate::sheet::number::{in_shown_unit, in_tenths, per_frequency, per_speed, trimmed};
pub use crate::sheet::ticks::{nice_step, ticks};

/// The axis of a chart: its range and the prefix of its labels. The default has no range, so that
/// nothing is drawn on it.
#[derive(Clone, Copy, Debug, Default)]
pub struct ChartAxis {
    /// Lower end, in SI units or as an exponent of ten.
    pub low: f64,
    /// Upper end, in the unit of `low`.
    pub high: f64,
    /// Prefix or unit of the labels: a label is the value divided by its factor.
    pub scale: SiScale,
    /// What the values are.
    kind: Kind,
}

/// What the values of an axis are.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum Kind {
    /// Numbers in the prefix of the axis.
    #[default]
    Plain,
    /// Whole numbers: no others have ticks.
    Whole,
    /// Speeds or frequencies, with ticks that are round in the shown unit.
    Speeds,
    /// Exponents of powers of ten, labelled with this unit or as in `1e5`.
    Powers(Option<&'static str>),
}

impl ChartAxis {
    /// Creates an axis with the prefix of its largest magnitude.
    pub fn scaled(low: f64, high: f64) -> Self {
        Self { scale: SiScale::of(low.abs().max(high.abs())), ..Self::plain(low, high) }
    }

    /// Creates an axis with round ends that includes zero and all values.
    pub fn around(values: impl Iterator<Item = f64>) -> Self {
        let values = values.filter(|value| value.is_finite());
        let (low, high) = values.fold((0.0_f64, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
        let (low, high) = round_out(low, high, 6);
        Self::scaled(low, high)
    }

    /// Creates an axis without a prefix.
    pub fn plain(low: f64, high: f64) -> Self {
        Self { low, high, scale: SiScale::plain(), kind: Kind::Plain }
    }

    /// Creates an axis of whole numbers.
    pub fn whole(low: f64, high: f64) -> Self {
        Self { kind: Kind::Whole, ..Self::plain(low, high) }
    }

    /// Creates an axis of speeds \[rad/s\], in the unit the user chose.
    pub fn speeds(low: f64, high: f64) -> Self {
        let scale = SiScale { factor: 1.0 / per_speed(1.0), prefix: "" };
        Self { scale, kind: Kind::Speeds, ..Self::plain(low, high) }
    }

    /// Creates an axis of angular frequencies \[rad/s\], in the unit the user chose.
    pub fn frequencies(low: f64, high: f64) -> Self {
        let scale = SiScale { factor: 1.0 / per_frequency(1.0), prefix: "" };
        Self { scale, ..Self::speeds(low, high) }
    }

    /// Creates a logarithmic axis between two exponents of ten, with labels in `unit`, as in
    /// `100 kN`, or such as `1e5`.
    pub fn powers(low: f64, high: f64, unit: Option<&'static str>) -> Self {
        Self { kind: Kind::Powers(unit), ..Self::plain(low, high) }
    }

    /// Returns the round values on the axis, at most `most + 1`, and their spacing; on a
    /// logarithmic axis and one of whole numbers, only whole values.
    pub(super) fn ticks(&self, most: usize) -> (Vec<f64>, f64) {
        if !matches!(self.kind, Kind::Plain | Kind::Speeds) {
            return ticks(self.low, self.high, most, 1.0);
        }
        let unit = if self.kind == Kind::Speeds { self.scale.factor } else { 1.0 };
        let (values, step) = ticks(self.low / unit, self.high / unit, most, 0.0);
        (values.into_iter().map(|value| value * unit).collect(), step * unit)
    }

    /// Returns the label of a tick at `value`; ticks are `step` apart.
    pub(super) fn label(&self, value: f64, step: f64) -> String {
        match self.kind {
            Kind::Powers(Some(unit)) => number(10f64.powi(value.round() as i32), unit),
            Kind::Powers(None) => format!("1e{value:.0}"),
            _ => self.scale.label(value, step),
        }
    }

    /// Returns the value at a fraction of the axis, 0 to 1.
    pub fn at(&self, part: f64) -> f64 {
        self.low + part * (self.high - self.low)
    }

    /// Returns whether the range is finite and not empty.
    pub(super) fn is_sound(&self) -> bool {
        self.low.is_finite() && self.high.is_finite() && self.high > self.low
    }
}

/// Formats a number in the SI unit `unit` with up to seven digits, without trailing zeros, and with
/// a prefix if the unit takes one. Speeds are converted to the unit the user chose; of an rpm they
/// show tenths.
pub fn number(x: f64, unit: &str) -> String {
    let (x, unit) = in_shown_unit(x, unit);
    let scale = SiScale::before(unit, x);
    let shown = x / scale.factor;
    let text = if unit == "rpm" {
        in_tenths(shown)
    } else if shown != 0.0 && !(1e-4..1e7).contains(&shown.abs()) {
        format!("{shown:e}")
    } else {
        let digits = 6 - shown.abs().max(1e-4).log10().floor() as i32;
        trimmed(&format!("{shown:.*}", digits.clamp(0, 9) as usize)).to_string()
    };
    format!("{text} {}{unit}", scale.prefix).trim_end().to_string()
}

/// Formats a number in the SI unit `unit` with four significant digits and a prefix, such as
/// `228.2 µm`.
pub fn readable(value: f64, unit: &str) -> String {
    prefixed(value, 4, unit)
}

/// Formats a simulated time \[s\] with six significant digits, enough to type it in elsewhere.
pub fn instant(t: f64) -> String {
    prefixed(t, 6, "s")
}

/// Formats a number in the SI unit `unit` with `digits` significant digits and a prefix; `-` stands
/// for one that is not finite.
fn prefixed(value: f64, digits: usize, unit: &str) -> String {
    if !value.is_finite() {
        return format!("- {unit}").trim_end().to_string();
    }
    let (value, unit) = in_shown_unit(value, unit);
    let scale = if unit == "rpm" { SiScale::plain() } else { SiScale::of(value) };
    let shown = value / scale.factor;
    let before = 1 + [10.0, 100.0, 1000.0].iter().filter(|limit| shown.abs() >= **limit).count();
    let decimals = digits.saturating_sub(before);
    format!("{shown:.decimals$} {}{unit}", scale.prefix).trim_end().to_string()
}

/// A range with round ends that follows data: it grows at once, and shrinks only when the data has
/// become much smaller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AutoRange {
    /// Lower end of the range.
    pub low: f64,
    /// Upper end of the range.
    pub high: f64,
}

/// A range shrinks when the data covers less than this fraction of it.
const SHRINK_BELOW: f64 = 0.35;

impl AutoRange {
    /// Creates the initial range.
    pub const fn new(low: f64, high: f64) -> Self {
        Self { low, high }
    }

    /// Adapts to data between `low` and `high`; values that are not finite are ignored.
    pub fn follow(&mut self, low: f64, high: f64) {
        if !(low.is_finite() && high.is_finite() && high >= low) {
            return;
        }
        let (width, data) = (self.high - self.low, high - low);
        let outside = low < self.low || high > self.high;
        if outside || data < SHRINK_BELOW * width {
            let margin = 0.05 * data.max(1e-12 * high.abs()).max(f64::MIN_POSITIVE);
            let (low, high) = round_out(low - margin, high + margin, 8);
            if high > low {
                *self = Self { low, high };
            }
        }
    }
}

/// Returns the smallest range that contains `[low, high]` and ends at multiples of the round step
/// that divides it into at most `most` parts.
pub fn round_out(low: f64, high: f64, most: usize) -> (f64, f64) {
    match nice_step(high - low, most) {
        Some(step) => ((low / step).floor() * step, (high / step).ceil() * step),
        None => (low, high),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fastrand::Rng;

    #[test]
    fn numbers_read_as_people_write_them() {
        assert_eq!(number(1e-4, "m"), "100 µm");
        assert_eq!(number(1e6, "N"), "1 MN");
        assert_eq!(number(0.05, ""), "0.05");
        assert_eq!(number(-430.0, "rad/s"), "-430 rad/s");
        assert_eq!(number(1.544e6, "N/m"), "1.544 MN/m");
        assert_eq!(number(0.0, "N"), "0 N");
        assert_eq!(number(1e-7, "s"), "100 ns");
    }

    #[test]
    fn ticks_are_round_and_inside() {
        assert_eq!(
            ticks(0.0, 500.0, 5, 0.0),
            (vec![0.0, 100.0, 200.0, 300.0, 400.0, 500.0], 100.0)
        );
        assert_eq!(ticks(-1.0, 1.0, 4, 0.0).0, vec![-1.0, -0.5, 0.0, 0.5, 1.0]);
        assert_eq!(ticks(0.013, 0.031, 3, 0.0), (vec![0.02, 0.03], 0.01));
        assert!(ticks(1.0, 1.0, 5, 0.0).0.is_empty());
        assert!(ticks(f64::NAN, 1.0, 5, 0.0).0.is_empty());
        assert!(ticks(2.0, 1.0, 5, 0.0).0.is_empty());
    }

    #[test]
    fn labels_show_the_decimals_of_their_step() {
        let micro = SiScale::of(1.0e-4);
        assert_eq!((micro.prefix, micro.label(5e-5, 5e-5).as_str()), ("µ", "50"));
        assert_eq!(SiScale::plain().label(0.25, 0.05), "0.25");
        assert_eq!(SiScale::of(0.02).label(5e-3, 5e-3), "5");
        assert_eq!(readable(2.282e-4, "s"), "228.2 µs");
        assert_eq!(readable(0.0, "s"), "0.000 s");
        assert_eq!(readable(f64::NAN, "s"), "- s");
        assert_eq!(readable(1234.0, ""), "1.234 k");
        assert_eq!(
            (instant(4.890_912e-2), instant(0.0)),
            ("48.9091 ms".into(), "0.00000 s".into())
        );
    }

    #[test]
    fn an_axis_of_speeds_has_round_ticks_in_the_unit_of_speeds() {
        crate::sheet::number::tell_in_rpm(true);
        let axis = ChartAxis::speeds(0.0, 600.0);
        let (values, step) = axis.ticks(5);
        let labels: Vec<String> = values.iter().map(|value| axis.label(*value, step)).collect();
        let shown = (readable(50.0 * std::f64::consts::PI, "rad/s"), number(-100.0, "rad/s"));
        assert!(
            (ChartAxis::frequencies(0.0, 600.0).ticks(6).0[1] - 20.0 * std::f64::consts::TAU).abs()
                < 1e-9
        );
        crate::sheet::number::tell_in_rpm(false);
        assert!(labels.len() > 2, "{labels:?}");
        assert!(labels.iter().all(|label| label.parse::<u32>().unwrap() % 1000 == 0), "{labels:?}");
        assert_eq!(shown, ("1500 rpm".into(), "-954.9 rpm".into()));
        assert_eq!(ChartAxis::speeds(0.0, 600.0).ticks(6).0[1], 100.0);
    }

    #[test]
    fn a_range_grows_at_once_and_shrinks_late() {
        let mut range = AutoRange::new(-1.0, 1.0);
        range.follow(-0.9, 0.9);
        assert_eq!(range, AutoRange::new(-1.0, 1.0));
        range.follow(-0.5, 0.5);
        assert_eq!(range, AutoRange::new(-1.0, 1.0), "half the range is no reason to shrink");
        range.follow(-3.0, 1.0);
        assert!(range.low <= -3.0 && range.high >= 1.0);
        range.follow(-0.1, 0.1);
        assert!(range.high - range.low < 0.5, "{range:?}");
        range.follow(f64::NAN, 5.0);
        assert!(range.high < 5.0);
    }

    #[test]
    fn ticks_of_any_range_are_few_increasing_and_inside() {
        for case in 0..256 {
            println!("case {case}");
            let rng = &mut Rng::with_seed(case);
            let low = 1e12 * (2.0 * rng.f64() - 1.0);
            let span = 1e-9 + 1e12 * rng.f64();
            let most = rng.usize(1..12);
            let (values, step) = ticks(low, low + span, most, 0.0);
            assert!(values.len() <= most + 1, "{low} {span} {most}");
            for pair in values.windows(2) {
                assert!(pair[1] > pair[0], "{low} {span} {most}");
            }
            for value in values {
                // Half a step of tolerance for the round-off of a large offset.
                assert!(value >= low - 0.5 * step && value <= low + span + 0.5 * step);
            }
        }
    }
}
