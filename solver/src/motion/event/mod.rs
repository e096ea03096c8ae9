//! Event-driven solvers: between two changes of contact the motion is known in closed
//! form or as a series to round-off, and the next change is found, not stepped over.
//!
//! Two ways to move between events: `exact` in the blade angles (the paper's model), and
//! `linear` in them (inclined and rubbing tips, restitution). Below both
//! are the clock (here), the looks ahead that pass nothing and the series they go by (`series`).

mod exact;
mod linear;
mod series;

pub use exact::ExactEvents;
pub use linear::LinearEvents;

use crate::numeric::sum::two_sum;

/// Start of a stretch and the present instant \[s\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clock {
    /// The second part holds what the first rounds off.
    start: (f64, f64),
    pub now: f64,
}

impl Clock {
    /// The start of the stretch \[s\].
    pub fn start(&self) -> f64 {
        self.start.0
    }

    /// Seconds from the start of the stretch to `t`.
    pub fn elapsed(&self, t: f64) -> f64 {
        ((t - self.start.0) - self.start.1).max(0.0)
    }

    /// A stretch begins `s` seconds after the start of the one before.
    pub fn pass(&mut self, s: f64) {
        let (t, low) = self.start;
        self.start = two_sum(t, s + low);
        self.arrive(self.start.0);
    }

    /// A stretch begins at `t`.
    pub fn begin_at(&mut self, t: f64) {
        self.start = (t, 0.0);
        self.arrive(t);
    }

    /// It is `t` now, or later.
    pub fn arrive(&mut self, t: f64) {
        self.now = self.now.max(t);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_million_stretches_lose_no_digit() {
        let mut clock = Clock::default();
        for _ in 0..1_000_000 {
            clock.pass(0.1);
        }
        // A tenth as a number is 0.1 + 5.55e-18.
        assert!((clock.elapsed(1e5 + 1.0) - (1.0 - 5.551_115_123e-12)).abs() < 1e-15 * 10.0);
        assert_eq!(clock.now, clock.start());
        clock.begin_at(7.0);
        assert!(clock.elapsed(7.5) == 0.5 && clock.now > 7.0);
    }
}
