//! A wave that slides on one side: step after step the same side closes, and no other
//! (docs/theory.md, section 6). Of rigid blades such a stretch is decided on once, up to
//! the step that may end it, and looked at wherever asked (`side_map`); where blades
//! move, its steps are taken one by one (`sliding`).
//!
//! A step of such a wave of rigid blades is a map of one coordinate (`SideMap`).
//! In the frame of the blades the side stands still: with `zeta = z conj(normal)`
//! one step predicts, where `w = exp(-i nu h)`, `E = w (1 - pull + ratio) - w^2 ratio - 1`,
//!
//! ```text
//! zeta* - zeta[n] = E zeta[n] + w^2 ratio (zeta[n] - zeta[n-1])
//! ```
//!
//! and contact puts its real part back to `-g0`. So `zeta = -g0 + i y`, and `y` obeys a
//! linear recurrence with constant coefficients; the predicted gap, the multiplier and
//! the gaps of the neighbours are affine in `y` and its increment `d = y[n] - y[n-1]`:
//!
//! ```text
//! d[n+1] = e y + m d + k g0        gap* = -e g0 + k y + c d
//! ```
//!
//! Each condition of such a step is an affine function that must stay positive. It has
//! at most one extremum in the stretch of a map power, so that its signs and slopes at
//! both ends say whether it keeps its sign in between.

use std::sync::Arc;

use nalgebra::{SMatrix, SVector};

use super::sliding::{Before, Done, Rules, Sliding, Tips};
use crate::model::ContactPolygon;
use crate::motion::explicit::disk::{Disk, HeldModes};
use crate::motion::explicit::oscillator::{LARGEST, Leap};
use crate::motion::explicit::{Coordinate, Explicit, Oscillator};
use crate::motion::{ActiveSet, Plane};
use crate::tolerances::{LEAP_FOLDS, SHORTEST_BLOCK, SLIDING_WAY};

/// `y`, `y[n] - y[n-1]`, `g0`, and the sum of the `y` of the steps before.
pub(in crate::motion::explicit) type Along = SVector<f64, 4>;

/// The coefficients of a step along a side at one speed of the rotor, sums of small
/// parts that do not cancel.
#[derive(Clone, Copy, Debug)]
pub(in crate::motion::explicit) struct SideStep {
    /// `1 - exp(-i nu h)`.
    pub turned: Plane,
    /// `e`, the real part of `E` above.
    pub stiff: f64,
    /// `k`, less its imaginary part.
    pub push: f64,
    /// One less `m`, the real part of `w^2 ratio`.
    pub lost: f64,
    /// `c`, less its imaginary part.
    pub coriolis: f64,
}

impl SideStep {
    /// For a wave that turns by `turn` \[rad\] a step against the standing frame.
    pub fn new(casing: &Oscillator, turn: f64) -> Self {
        let half = (0.5 * turn).sin();
        // 1 - cos and sin of the turn, and 1 - cos of its double.
        let (versine, sine) = (2.0 * half * half, turn.sin());
        let double = 2.0 * versine * (2.0 - versine);
        let (loss, pull) = (casing.loss, casing.pull);
        Self {
            turned: Plane::new(versine, sine),
            stiff: (1.0 - versine) * (2.0 * versine - pull)
                - loss * versine * (3.0 - 2.0 * versine),
            push: sine * (2.0 * versine + loss * (1.0 - 2.0 * versine) - pull),
            lost: loss + double - loss * double,
            coriolis: 2.0 * (1.0 - loss) * sine * (1.0 - versine),
        }
    }
}

/// Many steps along a side.
#[derive(Clone, Debug)]
pub(in crate::motion::explicit) struct SideMap {
    leap: Leap<4>,
    /// Exponent of the longest leap in which a condition has one extremum.
    longest: usize,
    pub step: SideStep,
    /// Predicted gap of the step that follows.
    gap: Affine,
    /// What must stay positive for the step that follows to close this side and no
    /// other.
    conditions: Vec<Affine>,
}

/// An affine function of where the wave is, and what a step changes of it.
#[derive(Clone, Copy, Debug)]
struct Affine {
    value: Along,
    change: Along,
}

impl SideMap {
    /// A casing that goes beyond `farthest` \[m\] is left to single steps.
    pub fn new(polygon: &ContactPolygon, step: SideStep, farthest: f64) -> Self {
        let SideStep { stiff, lost, push, coriolis, .. } = step;
        let keep = 1.0 - lost;
        let change = SMatrix::<f64, 4, 4>::from_row_slice(&[
            stiff, keep, push, 0.0, //
            stiff, -lost, push, 0.0, //
            0.0, 0.0, 0.0, 0.0, //
            1.0, 0.0, 0.0, 0.0,
        ]);
        let affine = |value: Along| Affine { value, change: change.tr_mul(&value) };
        let gap = Along::new(push, coriolis, -stiff, 0.0);
        let next = Along::new(1.0 + stiff, keep, push, 0.0);
        let clearance = Along::new(0.0, 0.0, 1.0, 0.0);
        let mut conditions = vec![affine(-gap)];
        let (sin, cos) = (2.0 * polygon.delta).sin_cos();
        let (open, along) = if polygon.has_corners() {
            // The gap of a neighbour, before and after the push on this side.
            (clearance * (1.0 - cos) + gap * cos.max(0.0), next * sin)
        } else {
            (clearance * (farthest / polygon.clearance), next)
        };
        conditions.extend([1.0, -1.0].map(|sign| affine(open + along * sign)));
        if cos < 0.5 || !polygon.has_corners() {
            // Beside an open neighbour at a small angle no penetration is deep.
            conditions.push(affine(clearance * 0.5 + gap));
        }
        Self {
            leap: Leap::new(change),
            longest: longest(stiff, lost),
            step,
            gap: affine(gap),
            conditions,
        }
    }

    /// The wave `steps` steps on.
    pub fn after(&self, start: Along, steps: u64) -> Along {
        self.leap.apply(start, steps)
    }

    /// Predicted gap of the step that follows, without push \[m\].
    pub fn gap(&self, at: Along) -> f64 {
        self.gap.value.dot(&at)
    }

    /// Sum of the predicted gaps of the steps that follow each point from `from`
    /// up to but without `to`, which is `steps` steps later \[m\].
    pub fn gaps(&self, from: Along, to: Along, steps: u64) -> f64 {
        // Of the increments, the sum is the way between the points before.
        let way = (to[0] - to[1]) - (from[0] - from[1]);
        self.gap.value.dot(&Along::new(to[3] - from[3], way, from[2] * steps as f64, 0.0))
    }

    /// How many steps from here on close this side and no other, up to where that
    /// ends, or to about the longest leap.
    pub fn length(&self, start: Along) -> u64 {
        let holds = |condition: &Affine, at: Along| condition.value.dot(&at) > 0.0;
        if !self.conditions.iter().all(|condition| holds(condition, start)) {
            return 0;
        }
        let (mut at, mut taken) = (start, 1);
        for exponent in (0..=self.longest).rev() {
            let ahead = self.leap.doubled(at, exponent);
            let kept = self.conditions.iter().all(|condition| {
                // With one extremum it may only dip in between if it falls and rises.
                let dips = exponent > 0
                    && condition.change.dot(&at) < 0.0
                    && condition.change.dot(&ahead) > 0.0;
                holds(condition, ahead) && !dips
            });
            if kept {
                at = ahead;
                taken += 1 << exponent;
            }
        }
        taken
    }

    /// The deepest predicted penetration of the steps that follow the points from
    /// `from` up to `to`, which lie within one `length` \[m\].
    pub fn deepest(&self, from: Along, to: Along) -> f64 {
        let falls = |at: Along| self.gap.change.dot(&at) < 0.0;
        let mut deepest = (-self.gap(from)).max(-self.gap(to));
        if falls(from) && !falls(to) {
            let mut at = from;
            for exponent in (0..=self.longest).rev() {
                let ahead = self.leap.doubled(at, exponent);
                if falls(ahead) {
                    at = ahead;
                }
            }
            deepest = deepest.max(-self.gap(self.leap.doubled(at, 0)));
        }
        deepest
    }
}

/// The exponent of the longest leap. Along a side `y` is a sum of two exponentials,
/// of which a combination has one extremum, or a damped cosine, which has one in less
/// than half a period.
fn longest(stiff: f64, lost: f64) -> usize {
    let (trace, root) = (2.0 + stiff - lost, lost * lost + stiff * (4.0 + stiff - 2.0 * lost));
    let steps = if root < 0.0 {
        let angle = (-root).sqrt().atan2(trace);
        0.25 * std::f64::consts::PI / angle
    } else {
        LEAP_FOLDS / (0.5 * (stiff - lost + root.sqrt())).max(f64::MIN_POSITIVE)
    };
    // No leap is longer than the powers that are kept.
    (0..LARGEST - 1).rev().find(|&exponent| (1_u64 << exponent) as f64 <= steps).unwrap_or(0)
}

/// A stretch of sliding, from the step it starts at.
#[derive(Clone, Debug)]
pub(in crate::motion::explicit) struct HeldSide {
    map: Arc<SideMap>,
    pub side: u32,
    start: Along,
    /// Steps that it lasts.
    pub length: u64,
    /// Casing displacement by a unit force in one step \[m/N\].
    compliance: f64,
}

impl HeldSide {
    fn after(&self, steps: u64) -> Along {
        self.map.after(self.start, steps)
    }

    /// Multiplier of the step that led to `steps` steps from the start \[N\].
    pub fn multiplier(&self, steps: u64) -> f64 {
        self.map.gap(self.after(steps.saturating_sub(1))) / self.compliance
    }

    /// Sum of the multipliers of the steps after `before`, up to `steps` \[N\].
    pub fn sum(&self, before: u64, steps: u64) -> f64 {
        let [from, to] = [before, steps].map(|steps| self.after(steps));
        self.map.gaps(from, to, steps - before) / self.compliance
    }

    /// Deepest predicted penetration of those steps \[m\].
    pub fn deepest(&self, before: u64, steps: u64) -> f64 {
        let [from, to] =
            [before, steps.saturating_sub(1).max(before)].map(|steps| self.after(steps));
        self.map.deepest(from, to)
    }
}

impl<B: Disk> Explicit<B> {
    /// The side that has closed alone in the two latest steps, if nothing but the blades
    /// acts on the wave.
    fn steady_side(&self) -> Option<u32> {
        let ActiveSet::Side(side) = self.record.log.active_set else { return None };
        let alone = self.leaps.same_sides >= 2 && self.record.last_touch == self.n;
        (alone && self.drive.is_steady(self.n) && self.n >= self.leaps.slide_tried).then_some(side)
    }

    /// The stretch of steps from now on that close this one side and no other.
    pub(in crate::motion::explicit) fn hold_side(&mut self) -> Option<HeldSide> {
        let side = self.steady_side()?;
        if self.blades.held_modes()?.moving.is_some() {
            return None;
        }
        let map = self.side_map();
        let [zeta, moved] = self.seen_from(side);
        let clearance = self.machine.polygon.clearance;
        // moved = zeta[n] - exp(-i nu h) zeta[n-1]
        let before = Plane::new(-clearance, zeta.im) - moved;
        let step = moved + map.step.turned.conj() * before;
        let start = Along::new(zeta.im, step.im, clearance, 0.0);
        let length = map.length(start);
        let compliance = self.casing.compliance;
        Some(HeldSide { map, side, start, length, compliance })
    }

    /// Whether the wave slides along a side of blades that move; it begins to, if it can.
    pub(in crate::motion::explicit) fn is_sliding(&mut self) -> bool {
        if self.leaps.sliding.is_none()
            && let Some(side) = self.steady_side()
        {
            self.leaps.sliding = self.begin_sliding(side);
            if self.leaps.sliding.is_none() && self.goes_beyond {
                self.leaps.slide_tried = self.n + SHORTEST_BLOCK;
            }
        }
        self.leaps.sliding.is_some()
    }

    fn begin_sliding(&self, side: u32) -> Option<Sliding> {
        let HeldModes { modes, moving } = self.modes_of_sides()?;
        let moving = moving?;
        if self.neighbours_matter || !self.machine.polygon.has_corners() {
            return None;
        }
        let tips = self.goes_beyond.then(|| self.sliding_tips());
        let step = self.side_step();
        let rules = Rules::new(&self.machine, &self.casing, moving, step, tips)?;
        let [c, s] = self.beyond.before;
        let before = Plane::new(c, s) * self.standing_side(side, self.n.saturating_sub(1)).conj();
        let mut sliding = Sliding::new(rules, moving, side, self.seen_from(side), modes, before)?;
        sliding.multiplier = self.rows.iter().map(|row| row.lambda).sum();
        Some(sliding)
    }

    /// What a slide beyond the paper needs at this speed.
    fn sliding_tips(&self) -> Tips {
        let (law, turned) = (self.tips, self.drive.speed(self.n) * self.drive.step);
        let drags = law.casing_friction != 0.0;
        let by_step = self.drive.step / self.machine.tangential_ratio;
        let outrun = if drags { by_step * self.tip_speed() } else { f64::INFINITY };
        Tips {
            law,
            fastest: SLIDING_WAY * self.beyond.long.min(outrun),
            turned,
            radius: self.scene.casing.radius_m,
            length: self.machine.blade_length,
            casing_lost: self.casing.lost(),
            counts: !self.beyond.account.forgone,
        }
    }

    /// Slides on, by `steps` steps at most, until another kind of step must be taken.
    pub(in crate::motion::explicit) fn slide(&mut self, steps: u64) {
        let moving = self.blades.held_modes().and_then(|blades| blades.moving);
        let (Some(sliding), Some(moving)) = (&mut self.leaps.sliding, moving) else { return };
        let done = sliding.advance(steps, &mut self.watch, moving);
        let side = sliding.side;
        self.n += done.steps;
        if done.steps > 0 {
            self.record.impulse(side, done.pushes);
            self.record.deepest_predicted = self.record.deepest_predicted.max(done.predicted);
            self.record.keep_touching(self.n, side);
            self.record.touch(self.n, self.record.log.active_set, false);
        }
        if self.goes_beyond {
            self.keep_slide(&done);
        }
        if done.steps < steps {
            self.end_sliding();
            // Deciding costs as much as some steps.
            self.leaps.slide_tried = self.n + SHORTEST_BLOCK;
        }
    }

    /// Keeps what steps along a side beyond the paper did.
    fn keep_slide(&mut self, done: &Done) {
        self.record.deepest = self.record.deepest.max(done.left);
        self.beyond.account.sums += done.flows;
        let swing = self.leaps.sliding.as_ref().map_or(0.0, Sliding::amplitude);
        if let Some(n) = self.beyond.look_until(self.n) {
            let swing = self.tips.rise.abs() * swing;
            self.beyond.lasting.look_at_tips(self.time_of(n), swing);
        }
    }

    /// Goes on by single steps.
    pub(in crate::motion::explicit) fn end_sliding(&mut self) {
        if let Some(sliding) = self.leaps.sliding.take() {
            (self.u, self.blades) = self.slid(&sliding);
            let Before { moved, gaps, .. } = sliding.before;
            let moved = moved * self.standing_side(sliding.side, self.n.saturating_sub(1));
            self.beyond.before = [moved.re, moved.im];
            self.beyond.dips = gaps.map(|gap| f64::max(-gap, 0.0));
            for row in self.rows.iter_mut().filter(|row| row.side == sliding.side) {
                row.lambda = sliding.multiplier;
            }
        }
    }

    /// Coordinates of a wave that slides.
    pub(in crate::motion::explicit) fn slid(&self, sliding: &Sliding) -> ([Coordinate; 2], B) {
        let mut blades = self.blades.clone();
        if let Some(moving) = self.blades.held_modes().and_then(|blades| blades.moving) {
            let (modes, before) = sliding.modes(moving);
            blades.set_held_modes(modes, before);
        }
        (self.standing(sliding.side, self.n, sliding.casing()), blades)
    }

    /// Coefficients of a step along a side at this speed.
    fn side_step(&self) -> SideStep {
        let turn = self.machine.nu(self.drive.speed(self.n)) * self.drive.step;
        SideStep::new(&self.casing, turn)
    }

    /// The map of a side at this speed.
    fn side_map(&mut self) -> Arc<SideMap> {
        let (step, farthest) = (self.side_step(), 0.5 * self.scene.casing.radius_m);
        let make = || Arc::new(SideMap::new(&self.machine.polygon, step, farthest));
        self.leaps.side_map.get_or_insert_with(make).clone()
    }

    /// `zeta` and `zeta[n] - exp(-i nu h) zeta[n-1]` on a side.
    fn seen_from(&self, side: u32) -> [Plane; 2] {
        let back = self.standing_side(side, self.n).conj();
        let [c, s] = self.u;
        [Plane::new(c.x, s.x) * back, Plane::new(c.increment, s.increment) * back]
    }

    /// The coordinates of which `seen_from` gives these at step `n`.
    fn standing(&self, side: u32, n: u64, seen: [Plane; 2]) -> [Coordinate; 2] {
        let [place, moved] = seen.map(|seen| seen * self.standing_side(side, n));
        [
            Coordinate { x: place.re, increment: moved.re },
            Coordinate { x: place.im, increment: moved.im },
        ]
    }

    /// `exp(i (n_d theta + psi))` of a side at step `n`: its inward normal in the
    /// standing frame.
    fn standing_side(&self, side: u32, n: u64) -> Plane {
        let (c, s) = self.drive.look_at_turn(n);
        let (cos, sin) = self.machine.polygon.direction(side);
        Plane::new(c, s) * Plane::new(cos, sin)
    }

    /// Coordinates of the casing `steps` steps into the stretch.
    pub(in crate::motion::explicit) fn along_side(
        &self,
        held: &HeldSide,
        steps: u64,
    ) -> [Coordinate; 2] {
        let at = held.after(steps);
        let (y, step) = (at[0], at[1]);
        let before = Plane::new(-at[2], y - step);
        // zeta[n] - exp(-i nu h) zeta[n-1]
        let moved = Plane::new(0.0, step) + held.map.step.turned * before;
        self.standing(held.side, self.n + steps, [Plane::new(-at[2], y), moved])
    }
}
