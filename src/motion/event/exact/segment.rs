//! From one segment to the next: finding the event that ends it, moving the
//! start, and what pulse and rotor do from there.

use std::f64::consts::TAU;

use super::Event;
use super::free::Free;
use super::mode::{Mode, Next, What};
use super::parameters::Drive;
use crate::motion::{ActiveSet, Failure, FailureReason, GoOn, Plane};
use crate::tolerances::{AN_INSTANT, LOOKS_UNASKED, MOST_EVENTS, MOST_EVENTS_AT_ONCE, MOST_LOOKS};

/// What a search for the event that ends a segment comes to.
enum Sought {
    /// This event, so many seconds after its start.
    Event(f64, What),
    /// None by the limit.
    Nothing,
    /// It was told not to go on.
    Paused,
}

/// What became of the next event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Passage {
    /// It is passed.
    Passed,
    /// It comes later.
    Later,
    /// The search for it was told not to go on.
    Paused,
}

impl Event {
    /// Seconds from the start of the segment to `t`.
    pub(super) fn elapsed(&self, t: f64) -> f64 {
        self.clock.elapsed(t)
    }

    /// Goes through the next event, if it comes no later than `until`.
    pub(super) fn change(&mut self, until: f64, go_on: GoOn<'_>) -> Result<Passage, Failure> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        let (s, what) = match self.seek(self.elapsed(until), go_on) {
            Sought::Event(s, what) => (s, what),
            Sought::Nothing => return self.failure.clone().map_or(Ok(Passage::Later), Err),
            Sought::Paused => return Ok(Passage::Paused),
        };
        self.check_angles(s)?;
        let rates = self.parameters.omega + self.drive.nu.abs();
        self.idle = if s * rates > AN_INSTANT { 0 } else { self.idle + 1 };
        if what != What::SeriesEnd {
            self.events += 1;
        }
        let reason = if what == What::Gone {
            Some(FailureReason::NoCorner { radius_m: self.parameters.reach })
        } else if what == What::Lost {
            Some(FailureReason::Series)
        } else if self.events > MOST_EVENTS {
            Some(FailureReason::Events)
        } else if self.idle > MOST_EVENTS_AT_ONCE {
            Some(FailureReason::EventsAtOnce)
        } else {
            None
        };
        match reason {
            Some(reason) => _ = self.fail(s, reason),
            None => self.pass(s, what),
        }
        self.failure.clone().map_or(Ok(Passage::Passed), Err)
    }

    /// Ends `advance` at `until`.
    ///
    /// # Errors
    /// Blades went beyond small angles before.
    pub(super) fn arrive(&mut self, until: f64) -> Result<(), Failure> {
        self.check_angles(self.elapsed(until))?;
        self.clock.arrive(until);
        let active_set = self.mode.active_set(&self.parameters);
        if active_set != ActiveSet::Nothing {
            self.log.touch(self.clock.now, active_set);
        }
        Ok(())
    }

    /// Ends the motion `s` seconds into the segment.
    pub(super) fn fail(&mut self, s: f64, reason: FailureReason) -> Failure {
        let t_s = self.clock.start() + s;
        self.clock.arrive(t_s);
        let failure = Failure { t_s, reason };
        self.failure.get_or_insert(failure).clone()
    }

    /// The event that ends the segment, if no later than `limit` seconds after
    /// its start. The looks ahead depend neither on `limit` nor on pauses.
    fn seek(&mut self, limit: f64, go_on: GoOn<'_>) -> Sought {
        let pulse_end = self.pulse_left();
        let series_end = self.mode.length();
        let end = pulse_end.min(series_end);
        loop {
            if let Some((s, what)) = self.found {
                return if s <= limit { Sought::Event(s, what) } else { Sought::Nothing };
            }
            if self.safe > limit {
                return Sought::Nothing;
            }
            if self.safe >= end {
                if !end.is_finite() {
                    return Sought::Nothing;
                }
                let what = if pulse_end <= series_end { What::PulseEnd } else { What::SeriesEnd };
                self.found = Some((end, what));
                continue;
            }
            if self.looks.is_multiple_of(LOOKS_UNASKED) && !go_on() {
                return Sought::Paused;
            }
            self.looks += 1;
            self.all_looks += 1;
            if self.all_looks > MOST_LOOKS {
                self.fail(self.safe, FailureReason::Looks);
                return Sought::Nothing;
            }
            match self.mode.look(&self.parameters, &self.drive, self.safe, end) {
                Next::Until(later) => self.safe = later.min(end),
                Next::Now(what) => self.found = Some((self.safe, what)),
            }
        }
    }

    /// Seconds from the start of the segment to the end of the pulse.
    fn pulse_left(&self) -> f64 {
        if self.drive.pulse == 0.0 { f64::INFINITY } else { self.elapsed(self.pulse.end) }
    }

    /// Books the segment and moves its start by `s`; the mode is left to be
    /// replaced.
    pub(super) fn rebase(&mut self, s: f64, what: Option<What>) {
        if self.checked {
            self.mode.book(&self.parameters, &self.drive, s, &mut self.energy_balance);
            self.widest = self.mode.largest_angle(&self.parameters, &self.drive, s, self.widest);
        }
        self.tips = self.mode.tips(&self.parameters, s);
        let phase = self.drive.phase(s) % TAU;
        if what == Some(What::PulseEnd) {
            self.clock.begin_at(self.pulse.end);
        } else {
            self.clock.pass(s);
        }
        self.drive = self.drive_now(phase);
        self.safe = 0.0;
        self.found = None;
        self.looks = 0;
        self.check_order();
    }

    /// Rotor and pulse from the start of the segment on.
    pub(super) fn drive_now(&self, phase: f64) -> Drive {
        let t = self.clock.start();
        let diameters = self.parameters.machine.nodal_diameters;
        let acting = (self.pulse.start..self.pulse.end).contains(&t);
        Drive {
            phase,
            nu: diameters * self.rotor.speed(t),
            nu_rate: diameters * self.rotor.ramp(),
            pulse: if acting { self.pulse.force / self.parameters.mass } else { 0.0 },
        }
    }

    /// Changes rotor or pulse at the present instant; the casing keeps its
    /// place and its rate in the standing frame.
    pub(super) fn intervene(&mut self, change: impl FnOnce(&mut Self)) {
        self.intervene_scaled(1.0, change);
    }

    /// As `intervene`, with the rate of free flight or along a side multiplied
    /// by `factor`.
    pub(super) fn intervene_scaled(&mut self, factor: f64, change: impl FnOnce(&mut Self)) {
        if self.failure.is_some() {
            return;
        }
        let s = self.elapsed(self.clock.now);
        let side = self.mode.along(&self.parameters, &self.drive, s);
        let (place, mut rate) = self.mode.seen_by_rotor(&self.parameters, &self.drive, s, side);
        if let (Mode::Slide(_) | Mode::Driven(_), Some((side, along))) = (&self.mode, side) {
            let tips = self.mode.tips(&self.parameters, s);
            let (normal, _) = self.parameters.normal(side, &tips);
            rate += Plane::i() * normal * ((factor - 1.0) * along.rate);
        }
        let flight = self.mode.flight(&self.parameters, &self.drive, s);
        let corner = self.mode.corner().filter(|_| !matches!(self.mode, Mode::Rocking { .. }));
        self.rebase(s, None);
        self.clock.begin_at(self.clock.now);
        let nu = self.drive.nu;
        change(self);
        self.drive = self.drive_now(self.drive.phase);
        // The rate against the blades jumps with the speed of the rotor.
        let rate = rate + Plane::i() * place * (nu - self.drive.nu);
        match (flight, corner, side) {
            (Some((u, v)), ..) => self.enter(Mode::Free(Free::new(u, v * factor, self.tips))),
            (_, Some(a), _) => self.meet_corner_at(a, rate),
            (_, _, Some((side, _))) => self.touch(side, place, rate),
            _ => {}
        }
    }
}
