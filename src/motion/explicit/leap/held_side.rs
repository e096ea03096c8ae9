//! A wave that slides on one side: step after step the same side closes, and no other
//! (docs/theory.md, section 6). Of rigid blades such a stretch is decided on once, up to
//! the step that may end it, and looked at wherever asked (`side_map`); where blades
//! move, its steps are taken one by one (`sliding`).

use std::sync::Arc;

use super::side_map::{Along, SideMap, SideStep};
use super::sliding::{Rules, Sliding};
use crate::motion::explicit::disk::Disk;
use crate::motion::explicit::disk::HeldModes;
use crate::motion::explicit::{Coordinate, Explicit};
use crate::motion::{ActiveSet, Plane};
use crate::tolerances::SHORTEST_BLOCK;

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
        }
        self.leaps.sliding.is_some()
    }

    fn begin_sliding(&self, side: u32) -> Option<Sliding> {
        let HeldModes { modes, moving } = self.blades.held_modes()?;
        if self.neighbours_matter || !self.machine.polygon.has_corners() {
            return None;
        }
        let rules = Rules::new(&self.machine, &self.casing, moving?, self.side_step())?;
        let mut sliding = Sliding::new(rules, moving?, side, self.seen_from(side), modes)?;
        sliding.multiplier = self.rows.first().map_or(0.0, |row| row.lambda);
        Some(sliding)
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
        if done.steps < steps {
            self.end_sliding();
            // Deciding costs as much as some steps.
            self.leaps.slide_tried = self.n + SHORTEST_BLOCK;
        }
    }

    /// Goes on by single steps.
    pub(in crate::motion::explicit) fn end_sliding(&mut self) {
        if let Some(sliding) = self.leaps.sliding.take() {
            (self.u, self.blades) = self.slid(&sliding);
            for row in self.rows.iter_mut().filter(|row| row.side == sliding.side) {
                row.lambda = sliding.multiplier;
            }
        }
    }

    /// Coordinates of a wave that slides.
    pub(in crate::motion::explicit) fn slid(&self, sliding: &Sliding) -> ([Coordinate; 2], B) {
        let mut blades = self.blades.clone();
        if let Some(moving) = self.blades.held_modes().and_then(|blades| blades.moving) {
            blades.set_held_modes(sliding.modes(moving));
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
