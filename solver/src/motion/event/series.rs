//! Truncated power series over a stretch of time, used where a motion has no closed form, and
//! conservative advancement: lower bounds on the time until a gap can close (docs/theory.md,
//! section 7).
//!
//! Advancing by that time and repeating cannot miss a contact, however short, because signs are
//! never tested at sample points. [`value`] and [`gap`] evaluate series, [`safe_step`] and
//! [`curved_step`] give the bounds.

/// Part of the largest term that two of the last terms of a power series may be: the first one
/// dropped is then round-off.
const SERIES_TAIL: f64 = 1e-12;

/// Number of terms. Over a stretch of 0.8 rad of the fastest oscillation the first one dropped is
/// below `0.8^18/18!`, 3e-18.
pub(in crate::motion::event) const TERMS: usize = 18;
/// Length of a stretch, as phase of the fastest oscillation \[rad\].
pub(in crate::motion::event) const STRETCH: f64 = 0.8;

/// Coefficients of `x^n`, where `0 <= x <= 1` is the fraction of the stretch.
pub(in crate::motion::event) type Terms = [f64; TERMS];

/// Returns the value, by Horner's scheme.
pub(in crate::motion::event) fn value(terms: &[f64], x: f64) -> f64 {
    terms.iter().rev().fold(0.0, |value, term| value * x + term)
}

/// Returns the value and the first three derivatives as a gap.
pub(in crate::motion::event) fn gap(terms: &[f64], x: f64) -> Gap {
    let (mut gap, mut rate, mut bend, mut twist) = (0.0, 0.0, 0.0, 0.0);
    for &term in terms.iter().rev() {
        twist = twist * x + bend;
        bend = bend * x + rate;
        rate = rate * x + gap;
        gap = gap * x + term;
    }
    Gap { gap, rate, bend: 2.0 * bend, twist: 6.0 * twist }
}

/// Returns a bound on the magnitude of the fourth derivative over the stretch.
pub(in crate::motion::event) fn jounce(terms: &[f64]) -> f64 {
    let factor = |n: f64| n * (n - 1.0) * (n - 2.0) * (n - 3.0);
    terms.iter().enumerate().skip(4).map(|(n, term)| factor(n as f64) * term.abs()).sum()
}

/// Returns whether the terms decrease fast enough that those dropped are round-off. The last two
/// terms are not examined, because contact forces do not have them: `x^14/14!` at 1e-12 of the
/// largest term leaves 1e-17 in the first term dropped, a geometric decrease 4e-16.
pub(in crate::motion::event) fn ended(terms: &[f64]) -> bool {
    let largest = terms.iter().fold(0.0_f64, |a, b| a.max(b.abs()));
    let last = terms.iter().rev().skip(2).take(2);
    last.into_iter().all(|term| term.abs() <= SERIES_TAIL * largest)
}

/// Returns the longest time over which `gap + rate t - bend t^2/2` stays positive, for
/// `gap, bend >= 0` \[s\].
pub(in crate::motion::event) fn safe_step(gap: f64, rate: f64, bend: f64) -> f64 {
    let root = (rate * rate + 2.0 * bend * gap).sqrt();
    if rate < 0.0 {
        2.0 * gap / (root - rate)
    } else if bend > 0.0 {
        (rate + root) / bend
    } else {
        f64::INFINITY
    }
}

/// A gap and its first three derivatives at one instant.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::motion::event) struct Gap {
    pub gap: f64,
    pub rate: f64,
    pub bend: f64,
    pub twist: f64,
}

impl Gap {
    /// Adds a round-off allowance to the gap.
    pub(in crate::motion::event) fn above(self, noise: f64) -> Self {
        Self { gap: self.gap.max(0.0) + noise, ..self }
    }
}

/// Iterations of [`curved_step`]; they converge quadratically from the second on.
const TRIES: usize = 6;

/// Returns a safe step as [`safe_step`] does, from three derivatives now and a bound `jounce` on
/// the fourth that is valid for `span` seconds (finite); at most `span`.
///
/// The gap stays above `gap + rate t + bend t^2/2 + twist t^3/6 - jounce t^4/24`. The second
/// derivative of this bound is `bend + twist t - jounce t^2/2`, which is concave, so its minimum
/// over any part of the span is at an end. The function advances along the bound as along a motion,
/// with shorter parts giving better minima.
pub(in crate::motion::event) fn curved_step(now: Gap, jounce: f64, span: f64) -> f64 {
    let bend_at = |t: f64| now.bend + t * (now.twist - 0.5 * jounce * t);
    let (mut t, mut end) = (0.0, span);
    let (mut gap, mut rate) = (now.gap, now.rate);
    for _ in 0..TRIES {
        let bend = (-bend_at(t).min(bend_at(end))).max(0.0);
        let left = end - t;
        // A concave bound that is positive at both ends is positive between them.
        let open = gap >= 0.0 && gap + left * (rate - 0.5 * bend * left) > 0.0;
        let step = if open { left } else { safe_step(gap.max(0.0), rate, bend) };
        if step < left {
            t += step;
            // Convergence is not continued to the last digits.
            if step < 1e-3 * t {
                break;
            }
            end = 0.5 * (end + t);
        } else if end < span {
            (t, end) = (end, span);
        } else {
            return span;
        }
        let [third, fourth] = [now.twist / 6.0, jounce / 24.0];
        gap = now.gap + t * (now.rate + t * (0.5 * now.bend + t * (third - t * fourth)));
        rate = now.rate + t * (now.bend + t * (3.0 * third - 4.0 * fourth * t));
    }
    t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_of_exponentials() {
        let mut exp = [0.0; TERMS];
        exp[0] = 1.0;
        for n in 1..TERMS {
            exp[n] = exp[n - 1] / n as f64;
        }
        for x in [0.0, 0.3, STRETCH] {
            let Gap { gap: value, rate, bend, .. } = gap(&exp, x);
            // The first missing term of the second derivative is 0.8^16/16!.
            assert!((value - x.exp()).abs() + (rate - x.exp()).abs() < 3e-15);
            assert!((bend - x.exp()).abs() < 5e-15);
        }
        let scaled: Terms = std::array::from_fn(|n| exp[n] * STRETCH.powi(n as i32));
        assert!(ended(&scaled) && !ended(&exp.map(f64::sqrt)) && !ended(&[1.0; TERMS]));
        assert!((jounce(&exp) - 1.0_f64.exp()).abs() < 1e-9);
        let Gap { gap, rate, bend, twist } = gap(&exp, 0.3);
        for derivative in [gap, rate, bend, twist] {
            assert!((derivative - 0.3_f64.exp()).abs() < 1e-13);
        }
    }
}

#[cfg(test)]
mod looks_tests {
    use super::*;

    #[test]
    fn the_bound_is_zero_where_the_step_ends() {
        for (gap, rate, bend) in [(1.0, -2.0, 0.5), (1.0, 2.0, 0.5), (1e-12, -1.0, 3.0)] {
            let t = safe_step(gap, rate, bend);
            let scale = gap + rate.abs() * t;
            assert!((gap + rate * t - 0.5 * bend * t * t).abs() < 1e-15 * scale);
            assert!(t > 0.0);
        }
        assert_eq!(safe_step(1.0, 1.0, 0.0), f64::INFINITY);
        assert_eq!(safe_step(0.0, -1.0, 1.0), 0.0);
        assert_eq!(safe_step(0.0, 0.0, 1.0), 0.0);
    }

    #[test]
    fn known_derivatives_lengthen_the_step_and_keep_it_safe() {
        for (gap, rate, bend, twist, jounce) in [
            (1.0, 1.0, 0.0, -1.0, 0.1),
            (1.0, -1.0, 0.0, 0.0, 1.0),
            (1.0, -3.0, 8.0, -6.0, 0.5),
            // Nearly closes, opens again, and then closes.
            (1.01, -4.0, 8.0, 0.0, 60.0),
            (1e-12, -1.0, 2.0, 30.0, 1.0),
            (1e-3, 0.0, 0.0, -1.0, 1.0),
            (0.0, 1.0, -2.0, 0.0, 0.0),
        ] {
            let now = Gap { gap, rate, bend, twist };
            let bound = |t: f64| {
                gap + rate * t + bend * t.powi(2) / 2.0 + twist * t.powi(3) / 6.0
                    - jounce * t.powi(4) / 24.0
            };
            let first = (1..300_000).map(|k| 1e-5 * f64::from(k)).find(|&t| bound(t) < 0.0);
            let root = first.unwrap_or(3.0);
            let step = curved_step(now, jounce, 3.0);
            let noise = 1e-15 * (gap + rate.abs() * step);
            for k in 0..=1000 {
                let t = step * f64::from(k) / 1000.0;
                assert!(bound(t) >= -noise, "{now:?} {t} of {step}");
            }
            assert!(step > 0.9 * root.min(3.0) - 1e-5, "{now:?}: {step} of {root}");
            assert_eq!(curved_step(now, jounce, 0.1 * step), 0.1 * step);
        }
    }
}
