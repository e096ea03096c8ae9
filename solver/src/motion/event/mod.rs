//! Event-driven solvers: between two changes of contact the motion is computed in closed form, or
//! as a power series to round-off, and the next change is located instead of being stepped over.
//!
//! There are two of them: `exact` keeps the blade angles in the gaps (the paper's model), `linear`
//! neglects them there (inclined and rubbing tips, restitution). Both use the clock (in this file)
//! and the series and safe steps of `series`.

mod exact;
mod linear;
mod series;

pub use exact::ExactEvents;
pub use linear::LinearEvents;

use crate::motion::{ActiveSet, ContactLog, Failure, FailureReason, Pulse, Rotor};
use crate::numeric::sum::two_sum;
use crate::scene::Scene;
use crate::tolerances::{AN_INSTANT, MOST_EVENTS, MOST_EVENTS_AT_ONCE, MOST_LOOKS};

/// Start of the present stretch, and the present instant \[s\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clock {
    /// Sum of both parts: the second one contains the rounding error of the first.
    start: (f64, f64),
    pub now: f64,
}

impl Clock {
    /// Returns the start of the stretch \[s\].
    pub fn start(&self) -> f64 {
        self.start.0
    }

    /// Returns the time from the start of the stretch to `t` \[s\].
    pub fn elapsed(&self, t: f64) -> f64 {
        ((t - self.start.0) - self.start.1).max(0.0)
    }

    /// Begins a stretch `s` seconds after the start of the previous one.
    pub fn pass(&mut self, s: f64) {
        let (t, low) = self.start;
        self.start = two_sum(t, s + low);
        self.arrive(self.start.0);
    }

    /// Begins a stretch at time `t`.
    pub fn begin_at(&mut self, t: f64) {
        self.start = (t, 0.0);
        self.arrive(t);
    }

    /// Advances the present instant to `t`; never moves it back.
    pub fn arrive(&mut self, t: f64) {
        self.now = self.now.max(t);
    }
}

/// Data of a run that both solvers keep: clock, rotor, pulse, contacts, work counters, and the
/// failure that ended it.
#[derive(Clone, Debug)]
struct Run {
    clock: Clock,
    rotor: Rotor,
    pulse: Pulse,
    log: ContactLog,
    /// Number of events.
    events: u64,
    /// Number of consecutive events, up to the latest, without time between them.
    idle: u32,
    /// Number of steps in the search for events.
    looks: u64,
    /// Deepest penetration \[m\].
    deepest: f64,
    /// Largest blade angle \[rad\].
    widest: f64,
    /// Whether energies, the largest angle and the deepest penetration are recorded.
    checked: bool,
    failure: Option<Failure>,
}

impl Run {
    fn of(scene: &Scene) -> Self {
        Self {
            clock: Clock::default(),
            rotor: Rotor::of(scene),
            pulse: Pulse::of(scene),
            log: ContactLog::default(),
            events: 0,
            idle: 0,
            looks: 0,
            deepest: 0.0,
            widest: 0.0,
            checked: true,
            failure: None,
        }
    }

    /// Ends the run `s` seconds after the start of the stretch.
    fn fail(&mut self, s: f64, reason: FailureReason) -> Failure {
        let t_s = self.clock.start() + s;
        self.clock.arrive(t_s);
        self.failure.get_or_insert(Failure { t_s, reason }).clone()
    }

    /// Counts the end of a stretch that lasted for the phase `phase` \[rad\] and may be an event;
    /// returns the limit that is exceeded, if any.
    fn count(&mut self, phase: f64, is_event: bool) -> Option<FailureReason> {
        self.idle = if phase > AN_INSTANT { 0 } else { self.idle + 1 };
        self.events += u64::from(is_event);
        if self.events > MOST_EVENTS {
            Some(FailureReason::Events)
        } else if self.looks > MOST_LOOKS {
            Some(FailureReason::Looks)
        } else {
            (self.idle > MOST_EVENTS_AT_ONCE).then_some(FailureReason::EventsAtOnce)
        }
    }

    /// Starts the pulse at the present instant.
    fn fire(&mut self) {
        let (now, length) = (self.clock.now, self.pulse.end - self.pulse.start);
        self.pulse = Pulse { start: now, end: now + length, ..self.pulse };
    }

    /// Records that these sides are in contact from the start of the stretch on.
    fn hold(&mut self, active_set: ActiveSet) {
        let (t, before) = (self.clock.start(), self.log.active_set);
        if before != ActiveSet::Nothing && before != active_set {
            // The previous contact lasted until now.
            self.log.touch(t, before);
        }
        self.log.touch(t, active_set);
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
        // The floating-point number 0.1 is 0.1 + 5.55e-18.
        assert!((clock.elapsed(1e5 + 1.0) - (1.0 - 5.551_115_123e-12)).abs() < 1e-15 * 10.0);
        assert_eq!(clock.now, clock.start());
        clock.begin_at(7.0);
        assert!(clock.elapsed(7.5) == 0.5 && clock.now > 7.0);
    }
}
