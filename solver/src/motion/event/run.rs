//! What a run keeps besides its motion: clock, rotor, pulse, contacts, work counters, and the failure
//! that ended it.

use super::transitions::AN_INSTANT;
use crate::motion::{ActiveSet, ContactLog, Failure, FailureReason, Pulse, Rotor};
use crate::numeric::sum::two_sum;
use crate::scene::Scene;

/// Largest number of changes of contact in a run: a million take a second, ten seconds with moving
/// blades. Smaller: long bounces fail.
pub const MOST_EVENTS: u64 = 10_000_000;

/// Most stretches of one run: a minute or two of work. An undamped casing that bounces for hours
/// needs them.
pub const MOST_LOOKS: u64 = 100_000_000;

/// Largest number of consecutive changes of contact that take no time. Physical ones are a few; more
/// are an endless loop.
pub const MOST_EVENTS_AT_ONCE: u32 = 1000;

/// Start of the present stretch, and the present instant \[s\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Clock {
    /// Sum of both parts: the second one contains the rounding error of the first.
    start: (f64, f64),
    /// Present instant.
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

/// Data of a run.
#[derive(Clone, Debug)]
pub(super) struct Run {
    pub clock: Clock,
    pub rotor: Rotor,
    pub pulse: Pulse,
    pub log: ContactLog,
    /// Number of events.
    pub events: u64,
    /// Number of consecutive events, up to the latest, without time between them.
    idle: u32,
    /// Number of stretches.
    pub looks: u64,
    /// Deepest penetration \[m\].
    pub deepest: f64,
    /// Largest blade angle \[rad\].
    pub widest: f64,
    /// Failure that ended the run; `None` if it has not failed.
    pub failure: Option<Failure>,
}

impl Run {
    pub(super) fn of(scene: &Scene) -> Self {
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
            failure: None,
        }
    }

    /// Ends the run `s` seconds after the start of the stretch.
    pub(super) fn fail(&mut self, s: f64, reason: FailureReason) -> Failure {
        let t_s = self.clock.start() + s;
        self.clock.arrive(t_s);
        self.failure.get_or_insert(Failure { t_s, reason }).clone()
    }

    /// Counts the end of a stretch that lasted for the phase `phase` \[rad\] and may be an event;
    /// returns the limit that is exceeded, if any.
    pub(super) fn count(&mut self, phase: f64, is_event: bool) -> Option<FailureReason> {
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
    pub(super) fn fire(&mut self) {
        let (now, length) = (self.clock.now, self.pulse.end - self.pulse.start);
        self.pulse = Pulse { start: now, end: now + length, ..self.pulse };
    }

    /// Records that these sides are in contact from the start of the stretch on.
    pub(super) fn hold(&mut self, active_set: ActiveSet) {
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
