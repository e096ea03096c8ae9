//! Where an amplitude is heading at the end of a run: from its values in the middle of
//! the run, at three quarters and now (docs/theory.md, section 9).

/// Values of an amplitude over a run.
#[derive(Clone, Copy, Debug)]
pub(super) struct Trend {
    /// End of the run \[s\].
    end: f64,
    marks: [Option<f64>; 2],
}

impl Trend {
    /// Of a run to this end \[s\].
    pub fn over(end: f64) -> Self {
        Self { end, marks: [None; 2] }
    }

    /// The largest value of a while until `t` \[s\].
    pub fn see(&mut self, t: f64, value: f64) {
        let [middle, later] = &mut self.marks;
        if t >= 0.5 * self.end {
            middle.get_or_insert(value);
        }
        if t >= 0.75 * self.end {
            later.get_or_insert(value);
        }
    }

    /// Forgets what was before a change on the way.
    pub fn forget(&mut self) {
        self.marks = [None; 2];
    }

    /// Whether enough of the run was seen.
    pub fn is_known(&self) -> bool {
        self.marks[1].is_some()
    }

    /// What the amplitude comes down to if it goes on like this from its value now
    /// (Aitken's rule); none where it does not fall, or where too little of the run was
    /// seen.
    pub fn falls_to(&self, now: f64) -> Option<f64> {
        let [Some(middle), Some(later)] = self.marks else { return None };
        if now >= FALLEN * middle {
            return None;
        }
        let (before, after) = (middle - later, later - now);
        let left = if before > after && after > 0.0 {
            now - after * after / (before - after)
        } else if after <= 0.0 {
            now
        } else {
            0.0
        };
        Some(left.max(0.0))
    }
}

/// Part of its value in the middle of a run below which an amplitude has fallen.
const FALLEN: f64 = 0.98;

#[cfg(test)]
mod tests {
    use super::*;

    /// A run to 1 s of an amplitude, looked at every hundredth.
    fn seen(amplitude: impl Fn(f64) -> f64) -> Option<f64> {
        let mut trend = Trend::over(1.0);
        (0..=100).for_each(|n| trend.see(f64::from(n) / 100.0, amplitude(f64::from(n) / 100.0)));
        trend.falls_to(amplitude(1.0))
    }

    #[test]
    fn what_dies_falls_to_nothing_and_what_settles_to_its_size() {
        assert!(seen(|t| (-3.0 * t).exp()).unwrap() < 1e-3);
        assert!((seen(|t| 0.7 + 2.0 * (-4.0 * t).exp()).unwrap() - 0.7).abs() < 1e-3);
        assert_eq!(seen(|t| 1.0 + t), None);
        assert_eq!(seen(|_| 1.0), None);
        // Faster and faster.
        assert_eq!(seen(|t| 1.0 - t * t), Some(0.0));
        let mut short = Trend::over(1.0);
        short.see(0.3, 1.0);
        assert_eq!(short.falls_to(0.1), None);
    }
}
