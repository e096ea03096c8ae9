//! A wave that slides along one side of blades that move: step after step the same side
//! closes, and no other. Its steps are taken one by one by the short loop of `sliding`
//! (docs/theory.md, sections 6 and 10).

use super::sliding::{Before, Done, Rules, Sliding, Tips};
use crate::motion::explicit::disk::{Disk, HeldModes};
use crate::motion::explicit::{Coordinate, Explicit, Oscillator};
use crate::motion::{ActiveSet, Plane};
use crate::tolerances::{SHORTEST_BLOCK, SLIDING_WAY};

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

impl<B: Disk> Explicit<B> {
    /// Returns the side that has closed alone in the two latest steps, if nothing but the blades
    /// acts on the wave.
    fn steady_side(&self) -> Option<u32> {
        let ActiveSet::Side(side) = self.record.log.active_set else { return None };
        let alone = self.leaps.same_sides >= 2 && self.record.last_touch == self.n;
        (alone && self.drive.is_steady(self.n) && self.n >= self.leaps.slide_tried).then_some(side)
    }

    /// Returns whether the wave slides along a side of blades that move; it begins to, if it can.
    pub(in crate::motion::explicit) fn is_sliding(&mut self) -> bool {
        if self.leaps.sliding.is_none()
            && self.scene.solver.shortcuts.slide
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
        if self.neighbours_matter || self.machine.is_uneven() || !self.machine.polygon.has_corners()
        {
            return None;
        }
        let tips = self.goes_beyond.then(|| self.sliding_tips());
        let turn = self.machine.nu(self.drive.speed(self.n)) * self.drive.step;
        let step = SideStep::new(&self.casing, turn);
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

    /// Returns the coordinates of a wave that slides.
    pub(in crate::motion::explicit) fn slid(&self, sliding: &Sliding) -> ([Coordinate; 2], B) {
        let mut blades = self.blades.clone();
        if let Some(moving) = self.blades.held_modes().and_then(|blades| blades.moving) {
            let (modes, before) = sliding.modes(moving);
            blades.set_held_modes(modes, before);
        }
        (self.standing(sliding.side, self.n, sliding.casing()), blades)
    }

    /// Returns `zeta` and `zeta[n] - exp(-i nu h) zeta[n-1]` on a side.
    fn seen_from(&self, side: u32) -> [Plane; 2] {
        let back = self.standing_side(side, self.n).conj();
        let [c, s] = self.u;
        [Plane::new(c.x, s.x) * back, Plane::new(c.increment, s.increment) * back]
    }

    /// Returns the coordinates of which `seen_from` gives these at step `n`.
    fn standing(&self, side: u32, n: u64, seen: [Plane; 2]) -> [Coordinate; 2] {
        let [place, moved] = seen.map(|seen| seen * self.standing_side(side, n));
        [
            Coordinate { x: place.re, increment: moved.re },
            Coordinate { x: place.im, increment: moved.im },
        ]
    }

    /// Returns `exp(i (n_d theta + psi))` of a side at step `n`: its inward normal in the
    /// standing frame.
    fn standing_side(&self, side: u32, n: u64) -> Plane {
        let (c, s) = self.drive.look_at_turn(n);
        let (cos, sin) = self.machine.polygon.direction(side);
        Plane::new(c, s) * Plane::new(cos, sin)
    }
}

#[cfg(test)]
mod tests {
    use crate::motion::explicit::{Explicit, ModalBlades};
    use crate::motion::{ActiveSet, Solver};
    use crate::scene::Scene;

    #[test]
    fn a_steady_side_has_closed_alone_in_the_two_latest_steps() {
        let mut seen = [0, 0];
        for pulse in [2e4, 5e4, 1e5, 2e5] {
            let mut scene = Scene::base();
            scene.solver.step_s = 1e-6;
            scene.solver.shortcuts.slide = false;
            scene.operation.pulse_n = pulse;
            let mut motion = Explicit::<ModalBlades>::new(&scene.checked().unwrap());
            let mut latest = [None; 2];
            for n in 1..5000 {
                motion.advance(1e-6 * f64::from(n)).unwrap();
                let closed = match motion.record.log.active_set {
                    ActiveSet::Side(side) if motion.record.last_touch == motion.n => Some(side),
                    _ => None,
                };
                latest = [closed, latest[0]];
                if let Some(side) = motion.steady_side() {
                    assert_eq!(latest, [Some(side); 2], "{pulse} {n}");
                    seen[0] += 1;
                }
                seen[1] += u32::from(latest[0].is_some() && latest[1].is_none());
            }
        }
        assert!(seen[0] > 3 && seen[1] > 3, "{seen:?}");
    }
}
