//! Round ticks: steps of 1, 2 or 5 times a power of ten, and powers of ten on
//! logarithmic axes.

/// Returns the smallest step of 1, 2 or 5 times a power of ten that divides `span` into at most
/// `most` parts; `None` if `span` is not positive and finite, or `most` is 0.
pub fn nice_step(span: f64, most: usize) -> Option<f64> {
    if !(span.is_finite() && span > 0.0) || most == 0 {
        return None;
    }
    let raw = span / most as f64;
    let power = 10f64.powf(raw.log10().floor());
    // Rounding in the logarithm may put a power of ten in either decade.
    let step = [1.0, 2.0, 5.0, 10.0, 20.0]
        .into_iter()
        .map(|m| m * power)
        .find(|step| *step >= raw * (1.0 - 1e-9))?;
    (step.is_finite() && step > 0.0).then_some(step)
}

/// Returns the round values in `[low, high]`, at most `most + 1`, and their spacing, which is at
/// least `least`: 1 for whole numbers. There are none if the range is empty, reversed or not finite.
pub fn ticks(low: f64, high: f64, most: usize, least: f64) -> (Vec<f64>, f64) {
    let Some(step) = nice_step(high - low, most.max(1)) else { return (Vec::new(), 1.0) };
    let step = step.max(least);
    let slack = 1e-9 * step;
    let first = ((low - slack) / step).ceil();
    let last = ((high + slack) / step).floor();
    // Far from zero, a range narrower than round-off has no ticks.
    if !(last - first).is_finite() || last - first > 1e3 {
        return (Vec::new(), step);
    }
    let count = (last - first).max(-1.0) as i64;
    // Adding zero makes a 0 of -0.
    let value = |k: i64| (first + k as f64) * step + 0.0;
    ((0..=count).map(value).collect(), step)
}

/// Returns ticks of a logarithmic axis between the exponents `low` and `high`, as exponents of ten:
/// whole powers, thinned to about `most`. A range of less than two decades also has ticks at 2 and
/// 5 times each power. There are none if the range is reversed or spans a thousand decades.
pub fn log_ticks(low: f64, high: f64, most: usize) -> Vec<f64> {
    let decades = high - low;
    if !(decades.is_finite() && (0.0..1e3).contains(&decades)) {
        return Vec::new();
    }
    let every = (decades / most.max(1) as f64).ceil().max(1.0);
    let first = (low / every).floor() as i64;
    let last = (high / every).ceil() as i64;
    let within = |x: &f64| (low - 1e-9..=high + 1e-9).contains(x);
    let powers = (first..=last).map(|k| k as f64 * every);
    let parts: &[f64] = if decades < 2.0 { &[1.0, 2.0, 5.0] } else { &[1.0] };
    powers.flat_map(|power| parts.iter().map(move |m| power + m.log10())).filter(within).collect()
}

/// Formats a value of a logarithmic axis, given by its exponent: `10⁵`, or `2·10⁵` between whole
/// powers.
pub fn power_of_ten(exponent: f64) -> String {
    let whole = (exponent + 1e-9).floor();
    let raised =
        |c: char| c.to_digit(10).and_then(|digit| RAISED.get(digit as usize)).unwrap_or(&'⁻');
    let digits: String = format!("{whole}").chars().map(raised).collect();
    match 10_f64.powf(exponent - whole).round() {
        1.0 => format!("10{digits}"),
        factor => format!("{factor}·10{digits}"),
    }
}

/// Formats a number with a power of ten: `2.5·10⁵`, `10⁶`.
pub fn scientific(x: f64) -> String {
    let text = format!("{x:.5e}");
    let (digits, exponent) = text.split_once('e').unwrap_or((&text, "0"));
    let power = power_of_ten(exponent.parse().unwrap_or(0.0));
    match digits.trim_end_matches('0').trim_end_matches('.') {
        "1" => power,
        "-1" => format!("-{power}"),
        digits => format!("{digits}·{power}"),
    }
}

/// Superscripts of the digits.
const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];

/// Returns `count` evenly spaced values from `from` to `to`, with both ends exact; only `from` if
/// `count` is 1.
pub fn linspace(from: f64, to: f64, count: usize) -> Vec<f64> {
    let last = count.saturating_sub(1);
    let between = |part: f64| from * (1.0 - part) + to * part;
    let value = |n: usize| match n {
        0 => from,
        n if n == last => to,
        n => between(n as f64 / last as f64),
    };
    (0..count).map(value).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_number_is_a_multiple_of_a_power_of_ten() {
        let told = [250_000.0, 1e6, -1e6, -3e-4].map(scientific);
        assert_eq!(told, ["2.5·10⁵", "10⁶", "-10⁶", "-3·10⁻⁴"]);
    }

    #[test]
    fn steps_are_round() {
        for (span, most, step) in [(10.0, 5, 2.0), (1.0, 1, 1.0), (0.7, 4, 0.2), (600.0, 7, 100.0)]
        {
            assert!((nice_step(span, most).unwrap() / step - 1.0).abs() < 1e-12, "{span} {most}");
        }
        assert_eq!(
            (nice_step(0.0, 3), nice_step(f64::NAN, 3), nice_step(1.0, 0)),
            (None, None, None)
        );
    }

    #[test]
    fn logarithmic_axes_have_powers_of_ten() {
        assert_eq!(log_ticks(3.0, 7.0, 8), [3.0, 4.0, 5.0, 6.0, 7.0]);
        assert_eq!(log_ticks(-10.0, 0.0, 5), [-10.0, -8.0, -6.0, -4.0, -2.0, 0.0]);
        let names: Vec<String> = log_ticks(4.2, 5.4, 8).into_iter().map(power_of_ten).collect();
        assert_eq!(names, ["2·10⁴", "5·10⁴", "10⁵", "2·10⁵"]);
        assert_eq!(power_of_ten(-12.0), "10⁻¹²");
        assert!(log_ticks(0.0, f64::INFINITY, 5).is_empty());
    }
}
