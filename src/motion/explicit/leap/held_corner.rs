//! A lock held by both laws alike: step after step the same corner closes.
//! (docs/theory.md, section 6.)
//!
//! In the frame of the blades the casing then follows from the blade angles
//! alone (two gaps are zero), and at constant speed one step maps the blade
//! modes `b = (alpha_c, alpha_s, increments)` to themselves. The map is affine
//! to the square of the blade phase that is left of their vibration, so any
//! number of steps is one small matrix power about the modes at rest. The step
//! is worked out with its small parts apart (`CornerStep`), so that it carries
//! no round-off of the gaps; the map is used only while both multipliers and
//! both predicted gaps keep their signs with room to spare, and where no gap is
//! left: a push turns the sides of soft blades in a long step.

use nalgebra::{SMatrix, SVector};

use super::corner_step::{CornerStep, Stepped};
use super::powers::Leap;
use crate::motion::ActiveSet;
use crate::motion::explicit::disk::Disk;
use crate::motion::explicit::{Coordinate, Explicit};
use crate::tolerances::{
    ANGLE_LOOK, HELD_AFTER, HELD_AGAIN, HELD_CORRECTIONS, HELD_LEFT, HELD_PHASE, HELD_PROBE,
    HELD_ROUNDINGS, ROOM_TO_CHANGE,
};

/// `(alpha_c, alpha_s)` and their increments.
pub(in crate::motion::explicit) type Modes = SVector<f64, 4>;
type StepMap = SMatrix<f64, 4, 4>;

/// The map of a held corner, from one step on.
#[derive(Clone, Debug)]
pub(in crate::motion::explicit) struct HeldCorner {
    step: CornerStep,
    /// Whether a multiplier pulls.
    pub pulls: bool,
    /// Blade modes at rest.
    rest: Modes,
    /// Blade modes at the start, less those at rest.
    start: Modes,
    /// Many steps of the deviation from rest.
    leap: Leap<4>,
    /// Inverse of what one step changes of it; zero for rigid blades.
    unchanged: StepMap,
    /// Multipliers of the step from `b`: value at rest and gradient \[N\].
    multipliers: [(f64, Modes); 2],
    /// Bounds on angle and increment of the deviation from rest.
    swing: (f64, f64),
}

impl HeldCorner {
    /// Values of the two sides, each with its side.
    pub fn by_side(&self, [a, b]: [f64; 2]) -> [Option<(u32, f64)>; 2] {
        let [first, second] = self.step.sides();
        [Some((first, a)), Some((second, b))]
    }

    /// Blade modes after `steps` steps.
    fn modes(&self, steps: u64) -> Modes {
        self.rest + self.leap.apply(self.start, steps)
    }

    /// Multipliers of the step that led to `steps` steps from the start \[N\].
    pub fn multipliers(&self, steps: u64) -> [f64; 2] {
        let from = steps.saturating_sub(1);
        // The step itself knows them to the last digit, at any vibration.
        self.step.from(self.modes(from)).map_or_else(
            || {
                let deviation = self.leap.apply(self.start, from);
                self.multipliers.map(|(value, gradient)| value + gradient.dot(&deviation))
            },
            |step| step.multipliers,
        )
    }

    /// Sums of the multipliers of the steps after `before`, up to `steps` \[N\].
    pub fn sums(&self, before: u64, steps: u64) -> [f64; 2] {
        let [from, to] = [before, steps].map(|steps| self.leap.apply(self.start, steps));
        // The sum of T^k b is (T - 1)^-1 times what they change in all.
        let deviation = self.unchanged * (to - from);
        let count = (steps - before) as f64;
        self.multipliers.map(|(value, gradient)| count * value + gradient.dot(&deviation))
    }

    /// Whether the steps leave next to nothing of their gaps, at rest and as far from it
    /// as the modes swing.
    fn closes(&self, at_rest: &Stepped) -> Option<bool> {
        let part = HELD_LEFT.max(HELD_ROUNDINGS * f64::EPSILON / self.step.sine().powi(2));
        let closed =
            |step: &Stepped| (0..2).all(|k| step.left[k].abs() <= part * at_rest.gaps[k].abs());
        let mut all = closed(at_rest);
        let (angle, increment) = self.swing;
        for (j, swing) in [angle, angle, increment, increment].into_iter().enumerate() {
            for end in [-swing, swing] {
                let mut modes = self.rest;
                modes[j] += end;
                all &= closed(&self.step.from(modes)?);
            }
        }
        Some(all)
    }

    /// The largest blade angle over the first `steps` steps, `least` where none
    /// is larger \[rad\].
    pub fn largest_angle(&self, steps: u64, least: f64) -> f64 {
        let Some(blades) = self.step.blades() else { return least };
        let angle = |k: u64| {
            let modes = self.modes(k);
            blades.largest([modes[0], modes[1]])
        };
        let stride = (ANGLE_LOOK / blades.oscillator().turn()).clamp(1.0, 1e12) as u64;
        let mut most = least.max(angle(0)).max(angle(steps));
        let (mut before, mut here, mut at) = (0.0, angle(0), 0);
        while at < steps {
            // The deviation from rest never grows beyond its bound now.
            let deviation = self.leap.apply(self.start, at);
            let bound = blades.oscillator().reach_of(as_coordinates(deviation)).0;
            if self.rest[0].hypot(self.rest[1]) + bound <= most {
                break;
            }
            let after = angle((at + stride).min(steps));
            // Between looks an angle rises by the square of half a look, at most.
            if here >= before && here >= after && here * (1.0 + ANGLE_LOOK * ANGLE_LOOK) > most {
                let around = [at.saturating_sub(stride), (at + stride).min(steps)];
                most = most.max(top(around, angle));
            }
            (before, here, at) = (here, after, at + stride);
        }
        most
    }
}

/// The largest value between two steps of a function with one top.
fn top([mut low, mut high]: [u64; 2], value: impl Fn(u64) -> f64) -> f64 {
    while high > low + 2 {
        let third = (high - low) / 3;
        let [first, second] = [low + third, high - third];
        if value(first) < value(second) { low = first + 1 } else { high = second }
    }
    (low..=high).map(value).fold(0.0, f64::max)
}

impl<B: Disk> Explicit<B> {
    /// Makes the map, if a corner has been held long enough and the map can be
    /// trusted for all later steps.
    pub(in crate::motion::explicit) fn hold_corner(&mut self) -> Option<HeldCorner> {
        let sides = self.steady_corner()?;
        let since = ((self.record.log.since / self.drive.step) as u64).max(self.leaps.hold_tried);
        if self.n < since + HELD_AFTER {
            return None;
        }
        self.leaps.hold_tried = self.n + HELD_AGAIN;
        self.make_map(sides)
    }

    /// The corner in contact in this step, if neither pulse nor ramp nor
    /// excitation acts on it.
    pub(in crate::motion::explicit) fn steady_corner(&self) -> Option<[u32; 2]> {
        let ActiveSet::Corner(a, b) = self.record.log.active_set else { return None };
        (self.drive.is_steady(self.n) && self.record.last_touch == self.n).then_some([a, b])
    }

    fn make_map(&self, sides: [u32; 2]) -> Option<HeldCorner> {
        let now = self.blades.held_modes()?;
        let turn = self.machine.nu(self.drive.speed(self.n)) * self.drive.step;
        let step = CornerStep::new(&self.machine, &self.casing, now.moving, sides, turn);
        let now = as_modes(now.modes);
        let mut rest = now;
        let (change, slopes) = slopes(&step, rest)?;
        let mut unchanged = StepMap::zeros();
        if step.blades().is_some() {
            unchanged = change.try_inverse()?;
            for _ in 0..HELD_CORRECTIONS {
                let correction = unchanged * step.from(rest)?.change;
                rest -= correction;
                if correction.amax() <= f64::EPSILON * rest.amax() {
                    break;
                }
            }
        } else {
            rest = Modes::zeros();
        }
        let at_rest = step.from(rest)?;
        let [a, b] = at_rest.multipliers;
        let start = now - rest;
        let swing = step
            .blades()
            .map_or((0.0, 0.0), |blades| blades.oscillator().reach_of(as_coordinates(start)));
        let held = HeldCorner {
            pulls: a > 0.0 || b > 0.0,
            rest,
            start,
            leap: Leap::new(change),
            unchanged,
            multipliers: [(a, slopes[0]), (b, slopes[1])],
            swing,
            step,
        };
        let [first, second] = at_rest.gaps;
        let kept = self.is_kept(&held, [a, b, first, second], slopes);
        (kept && held.closes(&at_rest)?).then_some(held)
    }

    /// Whether multipliers and predicted gaps never come near a change of sign:
    /// neither at rest nor by the vibration before it.
    fn is_kept(&self, held: &HeldCorner, rest: [f64; 4], slopes: [Modes; 4]) -> bool {
        let (angle, increment) = held.swing;
        if self.machine.nodal_diameters * angle > HELD_PHASE {
            return false;
        }
        (0..4).all(|k| {
            let swing = angle * (slopes[k][0].hypot(slopes[k][1]))
                + increment * (slopes[k][2].hypot(slopes[k][3]));
            let sign_fits = if k < 2 { self.law.pulls() || rest[k] < 0.0 } else { rest[k] < 0.0 };
            sign_fits && rest[k].is_finite() && swing < ROOM_TO_CHANGE * rest[k].abs()
        })
    }

    /// Coordinates `steps` steps into the held corner.
    pub(in crate::motion::explicit) fn held_at(
        &self,
        held: &HeldCorner,
        steps: u64,
    ) -> ([Coordinate; 2], B) {
        let modes = held.modes(steps);
        let mut blades = self.blades.clone();
        blades.set_held_modes(as_coordinates(modes));
        let (c, s) = self.drive.look_at_turn(self.n + steps);
        let (place, change) = held.step.casing(modes);
        let u = [
            Coordinate { x: place.re * c - place.im * s, increment: change.re * c - change.im * s },
            Coordinate { x: place.re * s + place.im * c, increment: change.re * s + change.im * c },
        ];
        (u, blades)
    }
}

/// The map of the deviation from `at`, minus one, and the gradients of multipliers
/// and predicted gaps, by central differences.
fn slopes(step: &CornerStep, at: Modes) -> Option<(StepMap, [Modes; 4])> {
    let mut map = StepMap::zeros();
    let mut slopes = [Modes::zeros(); 4];
    for j in 0..4 {
        let mut shift = Modes::zeros();
        shift[j] = HELD_PROBE;
        let (up, down) = (step.from(at + shift)?, step.from(at - shift)?);
        map.set_column(j, &((up.change - down.change) / (2.0 * HELD_PROBE)));
        for k in 0..2 {
            slopes[k][j] = (up.multipliers[k] - down.multipliers[k]) / (2.0 * HELD_PROBE);
            slopes[2 + k][j] = (up.gaps[k] - down.gaps[k]) / (2.0 * HELD_PROBE);
        }
    }
    Some((map, slopes))
}

fn as_modes([c, s]: [Coordinate; 2]) -> Modes {
    Modes::new(c.x, s.x, c.increment, s.increment)
}

fn as_coordinates(modes: Modes) -> [Coordinate; 2] {
    [
        Coordinate { x: modes[0], increment: modes[2] },
        Coordinate { x: modes[1], increment: modes[3] },
    ]
}
