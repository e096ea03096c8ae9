//! Conservative advancement: how far one may go before a gap can close
//! (docs/theory.md, section 7). Going that far, looking again and repeating never
//! passes a contact, however short. No sign is ever tested at samples.

/// Longest time over which `gap + rate t - bend t^2/2` stays above zero, for
/// `gap, bend >= 0` \[s\].
pub(super) fn safe_step(gap: f64, rate: f64, bend: f64) -> f64 {
    let root = (rate * rate + 2.0 * bend * gap).sqrt();
    if rate < 0.0 {
        2.0 * gap / (root - rate)
    } else if bend > 0.0 {
        (rate + root) / bend
    } else {
        f64::INFINITY
    }
}

/// As `safe_step`, from the second derivative now (`bend`, of either sign) and a
/// bound on the third that holds for `span` seconds; never longer than `span`.
///
/// Over any part `t <= span` the second derivative is at least `bend - jerk t`:
/// a shorter part gives a better bound, so a few are tried and the best is kept.
pub(super) fn curved_step(gap: f64, rate: f64, bend: f64, jerk: f64, span: f64) -> f64 {
    let (mut best, mut part) = (0.0_f64, span);
    for _ in 0..3 {
        let step = safe_step(gap, rate, (jerk * part - bend).max(0.0));
        if step >= part {
            return part.max(best);
        }
        best = best.max(step);
        part = 0.5 * (part + step);
    }
    best
}

/// Longest time over which a gap that starts closed and at rest stays open
/// \[s\]: `gap >= t^2 (bend/2 + twist t/6 - jounce t^2/24)`, from its second and
/// third derivatives now and a bound on the fourth.
pub(super) fn leaving_step(bend: f64, twist: f64, jounce: f64) -> f64 {
    safe_step(0.5 * bend.max(0.0), twist / 6.0, jounce / 12.0)
}

/// A time over which a gap stays open, from its first three derivatives now and a
/// bound on the fourth \[s\]: no term takes more than a quarter of the gap. Longer
/// than `safe_step` where gap, rate and bend nearly vanish at once.
pub(super) fn grazing_step(gap: f64, rate: f64, bend: f64, twist: f64, jounce: f64) -> f64 {
    let part = 0.25 * gap;
    let closing = |term: f64, factorial: f64| {
        if term < 0.0 { part * factorial / -term } else { f64::INFINITY }
    };
    closing(rate, 1.0)
        .min(closing(bend, 2.0).sqrt())
        .min(closing(twist, 6.0).cbrt())
        .min(closing(-jounce, 24.0).sqrt().sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_grazing_step_keeps_the_gap_open() {
        for (rate, bend, twist) in [(0.0, 0.0, 0.0), (-1e-9, 1e-6, -1.0), (1.0, -3.0, 2.0)] {
            let (gap, jounce) = (1e-12, 5.0);
            let t = grazing_step(gap, rate, bend, twist, jounce);
            for part in [0.3, 0.7, 1.0] {
                let s: f64 = part * t;
                let ahead = rate * s + bend * s * s / 2.0 + twist * s.powi(3) / 6.0;
                assert!(gap + ahead - jounce * s.powi(4) / 24.0 >= 0.0);
            }
        }
        // Where all but the fourth derivative vanish it is far longer than without.
        let long = grazing_step(1e-15, 0.0, 0.0, 0.0, 1.0);
        assert!(long > 1e3 * safe_step(1e-15, 0.0, 1.0), "{long}");
    }

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
    fn a_known_curvature_lengthens_the_step_and_keeps_it_safe() {
        // The gap 1 + t - t^3/6 closes at 2.849, the gap 1 - t - t^3/6 at 0.8846.
        let step = curved_step(1.0, 1.0, 0.0, 1.0, 3.0);
        assert!(step > 1.7 && step < 2.849, "{step}");
        let step = curved_step(1.0, -1.0, 0.0, 1.0, 2.0);
        assert!(step > 0.5 && step < 0.8846, "{step}");
        assert!(step >= safe_step(1.0, -1.0, 2.0));
    }

    #[test]
    fn a_release_is_followed_by_its_third_derivative() {
        assert!((leaving_step(0.0, 2.0, 3.0) - 8.0 / 3.0).abs() < 1e-15);
        assert!(leaving_step(1.0, -2.0, 3.0) > 0.0);
    }
}
