//! Free flight, many steps at once: the discrete energy bounds how far `|u|` can travel in one
//! step, and how far the tips can rise (docs/theory.md, section 6). So many steps as cannot
//! reach the clearance are one block.

use super::block::{Block, ENDLESS};
use crate::motion::explicit::disk::{Disk, HeldModes};
use crate::motion::explicit::lining::Lining;
use crate::motion::explicit::{Coordinate, Explicit};
use crate::motion::{ActiveSet, EnergyAccount};
use crate::tolerances::{BREAK_STEPS, LARGEST_BLADE_ANGLE, SHORTEST_BLOCK};

impl<B: Disk> Explicit<B> {
    /// Begins a block of steps that cannot touch, if there are enough to be worth it.
    pub(super) fn begin_flight(&mut self) {
        if self.goes_beyond && self.n < self.leaps.flight_tried {
            return;
        }
        let length = self.flight();
        self.leaps.flight_tried = self.n + SHORTEST_BLOCK;
        if length == 0 {
            return;
        }
        // Such a block is longer than the pause that ends a contact.
        if self.record.log.active_set != ActiveSet::Nothing {
            self.end_contact(self.n.max(self.record.last_touch + BREAK_STEPS + 1));
        }
        self.leaps.block = Block::new(length);
    }

    /// Returns the steps that cannot touch; none where they are too few to be worth a block.
    fn flight(&mut self) -> u64 {
        // Beyond it, every side is open and above its target.
        let room = self.tips.least - self.highest_target();
        let distance2 = self.distance2();
        if room <= 0.0 || distance2 >= room * room || !self.is_free() {
            return 0;
        }
        let room = room - self.rise_to_come(&self.blades);
        let (distance, (farthest, longest)) = (distance2.sqrt(), self.casing.reach_of(self.u));
        let length =
            if farthest < room { ENDLESS } else { ((room - distance) / longest).max(0.0) as u64 };
        // Blades that may swing too far are followed step by step.
        let flies =
            length >= self.blades.shortest_block() && self.blades.reach() <= LARGEST_BLADE_ANGLE;
        if flies { length } else { 0 }
    }

    /// Returns whether nothing but their own springs will move casing and blades in flight.
    fn is_free(&self) -> bool {
        let free = !self.drive.pulse_to_come(self.n) && self.drive.excitation.is_none();
        let beyond = || {
            let released = !self.lining.as_ref().is_some_and(Lining::presses);
            released && !self.follows_speed() && self.blades.held_modes().is_some()
        };
        self.scene.solver.shortcuts.flight && free && (!self.goes_beyond || beyond())
    }

    /// Returns a bound on how far tips can still rise in free motion \[m\].
    pub(in crate::motion::explicit) fn rise_to_come(&self, blades: &B) -> f64 {
        let rise = self.tips.rise.abs();
        if rise == 0.0 { 0.0 } else { rise * blades.reach() }
    }

    /// Returns the casing and blades after so many steps of free flight.
    pub(super) fn flown(&self, steps: u64) -> ([Coordinate; 2], B) {
        let mut blades = self.blades.clone();
        blades.skip(steps);
        if let Some(HeldModes { modes, moving: Some(moving) }) = self.blades.held_modes() {
            let skip = |mode, steps| moving.oscillator().skip(mode, steps);
            let before = modes.map(|mode| skip(mode, steps.saturating_sub(1)).increment);
            blades.set_held_modes(modes.map(|mode| skip(mode, steps)), before);
        }
        (self.u.map(|coordinate| self.casing.skip(coordinate, steps)), blades)
    }

    /// Records what free steps beyond the paper did since `before`: what damping took, and
    /// looks at the swing of the tips.
    pub(super) fn log_flight(&mut self, before: u64) {
        let used = self.leaps.block.used();
        if !self.goes_beyond || used == before {
            return;
        }
        if !self.beyond.account.forgone {
            let [from, to] = [before, used].map(|steps| {
                let (u, blades) = self.flown(steps);
                let casing: f64 = u.iter().map(|&at| self.casing.twice_energy(at)).sum();
                [0.5 * casing, blades.energy()]
            });
            self.beyond.account.sums += EnergyAccount {
                casing_loss_j: from[0] - to[0],
                blade_loss_j: from[1] - to[1],
                ..EnergyAccount::default()
            };
        }
        while let Some(n) = self.beyond.look_until(self.n + used) {
            let rises = self.tips.rise != 0.0;
            let swing = if rises { self.flown(n.saturating_sub(self.n)).1.swing() } else { 0.0 };
            let (t, swing) = (self.time_of(n), self.tips.rise.abs() * swing);
            self.beyond.lasting.look_at_tips(t, swing);
        }
    }

    /// Takes so many steps of free flight.
    pub(super) fn take_flight(&mut self, steps: u64) {
        if self.goes_beyond {
            let (before, _) = self.flown(steps - 1);
            self.beyond.before = before.map(|coordinate| coordinate.increment);
            self.beyond.dips = [0.0, if steps == 1 { self.beyond.dips[0] } else { 0.0 }];
            self.leave_lining();
        }
        let (u, ahead) = self.flown(steps);
        let largest = self.blades.peak(steps, self.watch.largest());
        (self.u, self.blades) = (u, ahead);
        let bound = self.blades.look(largest).1;
        self.watch.skipped(largest, bound);
    }
}

#[cfg(test)]
mod tests {
    use crate::motion::explicit::{Explicit, ModalBlades};
    use crate::motion::{ActiveSet, Solver};
    use crate::scene::Scene;

    #[test]
    fn a_contact_that_ends_in_a_flight_is_over_when_plain_steps_say_so() {
        let over = |flies: bool| {
            let mut scene = Scene::base();
            scene.operation.pulse_n = 0.0;
            scene.solver.shortcuts.flight = flies;
            let mut motion = Explicit::<ModalBlades>::new(&scene.checked().unwrap());
            motion.record.touch(0, ActiveSet::Side(4), false);
            motion.advance(motion.time_of(50)).unwrap();
            (motion.contacts().active_set, motion.contacts().since, motion.steps_skipped())
        };
        let [flown, plain] = [over(true), over(false)];
        assert_eq!((flown.0, flown.1), (plain.0, plain.1));
        assert_eq!(plain.0, ActiveSet::Nothing);
        assert!(flown.2 > plain.2, "{flown:?} {plain:?}");
    }

    #[test]
    fn a_flight_of_one_step_keeps_the_dip_before_it_and_a_longer_one_none() {
        let scene = Scene::base().with(&[("contact.restitution", "0.5")]).unwrap();
        let mut motion = Explicit::<ModalBlades>::new(&scene);
        motion.beyond.dips = [1e-9, 2e-9];
        for (steps, dips) in [(1, [0.0, 1e-9]), (2, [0.0; 2]), (9, [0.0; 2])] {
            let mut flown = motion.clone();
            flown.take_flight(steps);
            assert_eq!(flown.beyond.dips, dips, "{steps}");
        }
    }
}
