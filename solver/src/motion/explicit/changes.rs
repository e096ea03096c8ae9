//! A motion that goes on with another machine: other parameters from the latest step on, another
//! speed at once, or a machine that changes along a ramp (docs/theory.md, section 10).
//!
//! Displacements and increments go on as they are, so that positions and the mean rates of the last
//! step have no jump. Under a ramp the force of a step is that of blades as stiff as at its
//! beginning, and contact aims at the gap at its end. What either gives to the blades is work of
//! the rotor or of their growth. Where other tips or another clearance close a gap of rigid
//! contact, the casing gives way.

use std::sync::Arc;

use super::row::{TipLaw, Tips};
use super::{Explicit, Oscillator, long_step};
use crate::motion::{Change, Failure, FailureReason, Plane};
use crate::scene::CheckedScene;

/// Number of times that displacements are reduced after a sudden loss of clearance: each pass leaves
/// an error of second order in the blade angles.
const GIVE_WAY: usize = 4;

impl Explicit {
    /// From the latest step on, moves with the parameters of a scene, if that is live. Time,
    /// coordinates, rates, rotor, the pulse under way and the record of contacts stay.
    pub(super) fn take_parameters(&mut self, scene: &CheckedScene) {
        if *scene == *self.scene || !Change::is_live(&self.scene, scene) {
            return;
        }
        self.begin_change();
        let (stored, deepest) = (self.stored(), self.deepest());
        self.scene = Arc::new(scene.clone());
        let speed = self.drive.speed(self.n);
        self.machine = scene.machine().at(speed).into_owned();
        self.disk = self.disk.with_parameters(scene, &self.machine);
        self.casing = Oscillator::of_casing(&self.machine, self.drive.step);
        (self.law, self.restitution) = (scene.solver.contact, scene.contact.restitution);
        self.tips = TipLaw::at(&self.machine, speed);
        self.long_step = long_step(scene, &self.machine);
        // Gaps of earlier steps may change by as much as the clearance.
        self.dips = [self.machine.clearance().abs(); 2];
        let tips = Arc::new(Tips::new(&self.machine, &self.disk));
        self.drive.set_parameters(self.n, scene, tips.lobes);
        let old = std::mem::replace(&mut self.tips_of_rows, tips);
        if old.rows.len() != self.tips_of_rows.rows.len() {
            self.rows.clear();
        }
        self.begin_closing();
        self.give_way(deepest);
        self.press_again(&old);
        self.ledger.start += self.stored() - stored;
    }

    /// Sets speed and acceleration of the rotor from the latest step on.
    pub(super) fn take_speed(&mut self, speed: f64, ramp: f64) {
        self.begin_change();
        self.drive.set_speed(self.n, speed, ramp);
        if !self.machine.changes_with_speed() {
            return;
        }
        let deepest = self.deepest();
        self.machine.turn_at(speed);
        self.ledger.sums.rotor_work_j += self.disk.stiffen(self.machine.stiffened_by());
        self.begin_closing();
        if self.tips.clearance == self.machine.clearance() {
            return;
        }
        let stored = self.stored();
        self.tips = TipLaw::at(&self.machine, speed);
        self.dips = [self.machine.clearance().abs(); 2];
        self.give_way(deepest);
        let tips = self.tips_of_rows.clone();
        self.press_again(&tips);
        self.ledger.sums.growth_work_j += self.stored() - stored;
        if let Err(reason) = self.check_room(speed) {
            self.record.end_contact(self.n);
            let t_s = self.drive.time_of(self.n);
            self.failure.get_or_insert(Failure { t_s, reason });
        }
    }

    /// Discards cached data that a change by the user makes invalid.
    pub(super) fn begin_change(&mut self) {
        self.lasting.change(self.drive.time_of(self.n));
        self.forget();
    }

    /// Discards cached data that a new state makes invalid.
    pub(super) fn forget(&mut self) {
        self.strides.forget();
        self.stride = None;
        self.changed = self.n;
    }

    /// Returns whether the machine changes from step to step.
    #[inline]
    pub(super) fn follows_speed(&self) -> bool {
        self.machine.changes_with_speed() && self.drive.rotor.ramp() != 0.0
    }

    /// Updates the machine from the beginning of a step on a ramp to its end.
    ///
    /// # Errors
    /// Rigid blades have grown into the casing.
    #[inline(never)]
    pub(super) fn follow_ramp(&mut self) -> Result<(), FailureReason> {
        self.ledger.sums.rotor_work_j += self.disk.stiffen(self.machine.stiffened_by());
        let (before, speed) = (self.tips.clearance, self.drive.speed(self.n + 1));
        let short = before - self.tips.least;
        self.machine.turn_at(speed);
        self.tips.clearance = self.machine.clearance();
        self.tips.least = self.tips.clearance - short;
        self.closed = [before - self.tips.clearance, self.closed[0]];
        self.check_room(speed)
    }

    fn check_room(&self, speed_rad_s: f64) -> Result<(), FailureReason> {
        let has_room = self.lining.is_some() || self.tips.least > 0.0 || self.machine.has_room();
        if has_room { Ok(()) } else { Err(FailureReason::Closed { speed_rad_s }) }
    }

    /// Sets the loss of clearance over the last two steps, as if the present ramp had acted.
    pub(super) fn begin_closing(&mut self) {
        self.closed = [0.0; 2];
        if self.follows_speed() {
            let clearance = |steps: f64| {
                let t = self.drive.time_of(self.n) - steps * self.drive.step;
                self.machine.at(self.drive.rotor.speed(t)).clearance()
            };
            let [now, before, first] = [0.0, 1.0, 2.0].map(clearance);
            self.closed = [before - now, first - before];
        }
    }

    /// Returns the loss of clearance over the last two steps \[m\].
    #[inline]
    pub(super) fn lost_clearance(&self) -> f64 {
        self.closed[0] + self.closed[1]
    }

    /// Returns the deepest penetration of rigid tips now, zero where all gaps are open \[m\].
    fn deepest(&mut self) -> f64 {
        if self.lining.is_some() {
            return 0.0;
        }
        let turn = self.turn_now();
        let z = self.place(turn);
        let gap = |row: usize| self.row(row, z).gap;
        (0..self.tips_of_rows.rows.len()).map(gap).fold(0.0, |deepest, gap| f64::max(deepest, -gap))
    }

    /// Opens the gaps that other tips or another clearance have closed by more than the penetration
    /// before. All displacements shrink by one part, as those of a lock do, and rates stay; where tips
    /// leave the centre outside, the casing moves to the nearest open place.
    fn give_way(&mut self, before: f64) {
        let changes = self.machine.changes_with_speed() || self.machine.is_uneven();
        if !changes || self.tips.clearance <= 0.0 {
            return;
        }
        // The phases of the gaps are not quite in proportion.
        for _ in 0..GIVE_WAY {
            let deepest = self.deepest();
            if deepest <= before {
                return;
            }
            if self.tips.least <= 0.0 {
                self.move_from_tips();
            } else {
                let part = self.tips.least / (self.tips.least + deepest);
                self.u.iter_mut().for_each(|at| at.x *= part);
                self.disk.shrink(part);
            }
        }
    }

    /// Moves the casing to the nearest place that is open.
    fn move_from_tips(&mut self) {
        let theta = self.drive.rotor.angle(self.drive.time_of(self.n));
        let turn = self.turn_now();
        let z = self.place(turn);
        let angles = self.disk.every_angle();
        let risen =
            |blade: u32| self.tips.rise * angles.get(blade as usize).copied().unwrap_or(0.0);
        let Some((x, y)) = self.machine.nearest_open((z.re, z.im), theta, risen) else { return };
        let moved = (Plane::new(x, y) - z) * turn;
        self.u[0].x += moved.re;
        self.u[1].x += moved.im;
    }
}
