//! The rate of the playback: slower near changes of contact and faster between them, and limited so
//! that the wave never turns so far per frame that it seems to stand still or run backward.

use std::f64::consts::TAU;

use super::recorder::in_blade_frame;
use crate::tui::trace::Mark;
use rubscope_solver::motion::{Motion, State};

/// Largest turn of the wave relative to the blades per frame, as a fraction of a full turn.
const TURN: f64 = 0.125;
/// Amplitude of the casing below which the turn of the wave is invisible, in clearances.
const VISIBLE: f64 = 0.02;
/// Time constant of the slowdown: rate = distance to the nearest change / APPROACH \[wall-clock
/// s\].
const APPROACH: f64 = 0.3;
/// Slowest rate, relative to the requested one.
const SLOWEST: f64 = 0.02;
/// Fastest rate, relative to the requested one.
const FASTEST: f64 = 3.0;
/// Changes of contact closer together than this, on average, do not slow the playback \[wall-clock
/// s at the requested rate\].
const SPARSE: f64 = 0.1;

/// Turn of the wave relative to the blades since the last frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct Turned {
    /// Sum of the turns in either direction, each counted as positive \[rad\].
    by: f64,
    /// Phase of the wave in the frame of the blades at the last sample \[rad\]; `None` while its
    /// amplitude is too small to be visible.
    phase: Option<f64>,
}

impl Turned {
    /// Resets the turn: a frame was drawn.
    pub fn drawn(&mut self) {
        self.by = 0.0;
    }

    /// Adds the turn since the last call.
    pub fn follow(&mut self, motion: &Motion, state: &State) {
        let machine = motion.machine();
        let turned = machine.nodal_diameters * motion.rotor().angle(state.t_s);
        let [x, y] = in_blade_frame(state.u, turned);
        let visible = state.amplitude() >= VISIBLE * machine.clearance().abs();
        let phase = visible.then(|| y.atan2(x));
        if let (Some(before), Some(now)) = (self.phase, phase) {
            let by = (now - before).rem_euclid(TAU);
            self.by += by.min(TAU - by);
        }
        self.phase = phase;
    }

    /// Returns whether a further turn by `next` \[rad\] must wait for a frame.
    pub fn must_wait(&self, next: f64) -> bool {
        self.by > 0.0 && self.by + next > TURN * TAU
    }
}

/// Wall-clock time over which the reached rate is averaged \[s\].
const OVER: f64 = 0.5;
/// Relative change below which the displayed rate stays, to avoid flicker.
const NEAR: f64 = 0.1;

/// The rate reached by the playback.
#[derive(Clone, Copy, Debug, Default)]
pub struct Reached {
    /// Wall-clock time since the rate was last averaged \[s\].
    wall: f64,
    /// Simulated time played since then \[s\].
    played: f64,
    /// The displayed rate; `None` before the first average, and while the motion stands.
    shown: Option<f64>,
}

impl Reached {
    /// Adds `played` seconds of simulated time that took `wall` seconds of wall-clock time.
    pub fn add(&mut self, wall: f64, played: f64) {
        (self.wall, self.played) = (self.wall + wall, self.played + played);
        if self.wall < OVER {
            return;
        }
        let rate = self.played / self.wall;
        if self.shown.is_none_or(|shown| (rate - shown).abs() > NEAR * shown) {
            self.shown = Some(rate).filter(|rate| *rate > 0.0);
        }
        (self.wall, self.played) = (0.0, 0.0);
    }

    /// Returns the displayed rate, simulated time over wall-clock time; `None` before the first
    /// average, and while the motion stands.
    pub fn rate(&self) -> Option<f64> {
        self.shown
    }
}

/// Returns the playback rate at the time `now` \[s\]: proportional to the time to the nearest
/// change of contact in `marks`, within limits around the requested `rate`; `rate` itself where
/// the changes are dense.
pub fn rate_at(now: f64, rate: f64, marks: &[Mark]) -> f64 {
    let next = marks.partition_point(|mark| mark.t_s <= now);
    let ahead = marks.get(next).map(|mark| mark.t_s - now);
    let behind = next.checked_sub(1).and_then(|k| marks.get(k)).map(|mark| now - mark.t_s);
    let around = [ahead, behind].into_iter().flatten();
    // Slowing down for closely spaced changes would only make the playback slow throughout.
    let first = next.saturating_sub(2);
    let near: Vec<f64> = marks.iter().skip(first).take(5).map(|mark| mark.t_s).collect();
    let dense = near.len() == 5
        && near.first().zip(near.last()).is_some_and(|(a, b)| b - a < 4.0 * SPARSE * rate);
    if dense {
        return rate;
    }
    let distance = around.fold(f64::INFINITY, f64::min);
    (distance / APPROACH).clamp(SLOWEST * rate, FASTEST * rate)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::trace::Happening;
    use rubscope_solver::motion::ActiveSet;

    fn marks(times: &[f64]) -> Vec<Mark> {
        let what = Happening::Contact(ActiveSet::Nothing, ActiveSet::Side(1));
        times.iter().map(|t_s| Mark { t_s: *t_s, what }).collect()
    }

    #[test]
    fn it_slows_down_before_a_change_and_after_it_and_hurries_between() {
        let marks = marks(&[1e-3, 50e-3]);
        let at = |t| rate_at(t, 5e-3, &marks);
        assert_eq!(at(25e-3), 15e-3);
        assert_eq!(at(1e-3 - 1e-9), 1e-4);
        assert_eq!(at(1e-3 + 1e-9), 1e-4);
        assert!(at(0.7e-3) < at(0.4e-3) && at(1.3e-3) < at(1.6e-3));
        assert_eq!(rate_at(0.0, 5e-3, &[]), 15e-3);
    }

    #[test]
    fn the_rate_reached_is_that_of_the_last_half_second_and_does_not_tremble() {
        let mut reached = Reached::default();
        for (frames, played, shown) in [
            (10, 1e-3, None),
            (20, 1e-3, Some(0.02)),
            (20, 1.05e-3, Some(0.02)),
            (20, 2e-3, Some(0.04)),
        ] {
            (0..frames).for_each(|_| reached.add(0.05, played));
            let rate = reached.rate();
            let near = rate.zip(shown).is_some_and(|(a, b): (f64, f64)| (a / b - 1.0).abs() < 1e-9);
            assert!(near || rate == shown, "{rate:?} {shown:?}");
        }
    }

    #[test]
    fn impacts_like_hail_are_played_as_asked() {
        let times: Vec<f64> = (0..100).map(|k| f64::from(k) * 1e-4).collect();
        assert_eq!(rate_at(5.02e-3, 5e-3, &marks(&times)), 5e-3);
    }
}
