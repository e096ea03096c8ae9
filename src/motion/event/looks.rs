//! Conservative advancement: how far one may go before a gap can close
//! (docs/theory.md, section 7). Going that far, looking again and repeating never
//! passes a contact, however short. No sign is ever tested at samples.

/// Longest time over which `gap + rate t - bend t^2/2` stays above zero, for
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

/// A gap with its first three derivatives now.
#[derive(Clone, Copy, Debug)]
pub(in crate::motion::event) struct Gap {
    pub gap: f64,
    pub rate: f64,
    pub bend: f64,
    pub twist: f64,
}

impl Gap {
    /// The same with round-off added to the gap.
    pub(in crate::motion::event) fn above(self, noise: f64) -> Self {
        Self { gap: self.gap.max(0.0) + noise, ..self }
    }
}

/// Tries of `curved_step`: from the second on they converge quadratically.
const TRIES: usize = 6;

/// As `safe_step`, from three derivatives now and a bound `jounce` on the fourth
/// that holds for `span` seconds, which are finite; never longer than `span`.
///
/// The gap stays above `gap + rate t + bend t^2/2 + twist t^3/6 - jounce t^4/24`,
/// and its second derivative above `bend + twist t - jounce t^2/2`, which is
/// concave: over any part of the span it is least at one of both ends. So one goes
/// along this bound, which costs no sine, as along a motion. A shorter part gives a
/// better bound.
pub(in crate::motion::event) fn curved_step(now: Gap, jounce: f64, span: f64) -> f64 {
    let bend_at = |t: f64| now.bend + t * (now.twist - 0.5 * jounce * t);
    let (mut t, mut end) = (0.0, span);
    let (mut gap, mut rate) = (now.gap, now.rate);
    for _ in 0..TRIES {
        let bend = (-bend_at(t).min(bend_at(end))).max(0.0);
        let left = end - t;
        // A concave bound that is open at both ends is open between them.
        let open = gap >= 0.0 && gap + left * (rate - 0.5 * bend * left) > 0.0;
        let step = if open { left } else { safe_step(gap.max(0.0), rate, bend) };
        if step < left {
            t += step;
            // What converges is not followed to its last digits.
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

/// Longest time over which a gap that starts closed and at rest stays open
/// \[s\]: `gap >= t^2 (bend/2 + twist t/6 - jounce t^2/24)`, from its second and
/// third derivatives now and a bound on the fourth.
pub(in crate::motion::event) fn leaving_step(bend: f64, twist: f64, jounce: f64) -> f64 {
    safe_step(0.5 * bend.max(0.0), twist / 6.0, jounce / 12.0)
}

#[cfg(test)]
mod tests {
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
            // It nearly closes, opens again, and closes then.
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

    #[test]
    fn a_release_is_followed_by_its_third_derivative() {
        assert!((leaving_step(0.0, 2.0, 3.0) - 8.0 / 3.0).abs() < 1e-15);
        assert!(leaving_step(1.0, -2.0, 3.0) > 0.0);
    }
}
