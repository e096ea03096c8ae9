//! A machine that changes with the rotor speed (docs/theory.md, section 10). Under a
//! ramp the force of a step is that of blades as stiff as at its beginning, and contact aims
//! at the gap at its end; a sudden change of speed leaves displacements and rates. What
//! either gives to the blades is work of the rotor or of their growth.

use super::Explicit;
use super::disk::Disk;
use super::rows::TipLaw;
use crate::motion::{Failure, FailureReason};
use crate::tolerances::{GIVE_WAY, TIP_MARGIN};

impl<B: Disk> Explicit<B> {
    /// Returns whether the machine changes from step to step.
    #[inline]
    pub(super) fn follows_speed(&self) -> bool {
        self.machine.changes_with_speed() && self.drive.rotor.ramp() != 0.0
    }

    /// Goes from the machine at the beginning of a step to the one at its end.
    ///
    /// # Errors
    /// Rigid blades have grown into the casing.
    #[inline]
    pub(super) fn follow_speed(&mut self) -> Result<(), FailureReason> {
        if self.follows_speed() { self.turn_on() } else { Ok(()) }
    }

    fn turn_on(&mut self) -> Result<(), FailureReason> {
        let work = self.blades.stiffen(self.machine.stiffened_by());
        self.beyond.account.sums.rotor_work_j += work;
        let (before, speed) = (self.tips.clearance, self.drive.speed(self.n + 1));
        let short = before - self.tips.least;
        self.machine.turn_at(speed);
        self.tips.clearance = self.machine.clearance();
        self.tips.least = self.tips.clearance - short;
        let closed = &mut self.beyond.closed;
        *closed = [before - self.tips.clearance, closed[0]];
        self.has_room(speed)
    }

    fn has_room(&self, speed_rad_s: f64) -> Result<(), FailureReason> {
        let has = self.lining.is_some() || self.tips.least > 0.0 || self.machine.has_room();
        if has { Ok(()) } else { Err(FailureReason::Closed { speed_rad_s }) }
    }

    /// What the clearance lost in the two steps before now, as it does so.
    pub(super) fn begin_closing(&mut self) {
        if !self.follows_speed() {
            self.beyond.closed = [0.0; 2];
            return;
        }
        let clearance = |steps: f64| {
            let t = self.time_of(self.n) - steps * self.drive.step;
            self.machine.at(self.drive.rotor.speed(t)).clearance()
        };
        let [now, before, first] = [0.0, 1.0, 2.0].map(clearance);
        self.beyond.closed = [before - now, first - before];
    }

    /// Returns the loss of clearance over the last two steps \[m\].
    #[inline]
    pub(super) fn lost_clearance(&self) -> f64 {
        self.beyond.closed[0] + self.beyond.closed[1]
    }

    /// The machine at another speed from the latest step on.
    pub(super) fn take_speed(&mut self) {
        if !self.machine.changes_with_speed() {
            return;
        }
        let speed = self.drive.speed(self.n);
        self.machine.turn_at(speed);
        let before = self.blades.energy();
        self.blades = self.blades.with_parameters(&self.scene, &self.machine);
        self.beyond.account.sums.rotor_work_j += self.blades.energy() - before;
        self.begin_closing();
        if self.tips.clearance == self.machine.clearance() || !self.goes_beyond {
            return;
        }
        let before = self.stored();
        self.tips = TipLaw::at(&self.machine, speed);
        self.beyond.dips = [self.machine.clearance().abs(); 2];
        self.shrink_into_clearance();
        self.press_again();
        self.beyond.account.sums.growth_work_j += self.stored() - before;
        if let Err(reason) = self.has_room(speed) {
            self.record.end_contact(self.n);
            self.failure.get_or_insert(Failure { t_s: self.time_of(self.n), reason });
        }
    }

    /// Where a clearance that is smaller all at once leaves rigid tips in the casing, all
    /// displacements shrink by one part, as those of a lock do; rates stay.
    pub(super) fn shrink_into_clearance(&mut self) {
        let rigid = self.lining.is_none() && self.tips.clearance > 0.0;
        if !(rigid && (self.machine.changes_with_speed() || self.machine.is_uneven())) {
            return;
        }
        if self.tips.least <= 0.0 {
            return self.move_from_tips();
        }
        // The phases of the gaps are not quite in proportion.
        for _ in 0..GIVE_WAY {
            let (tips, bound) = (self.tips, self.blades.bound());
            let (z, _) = self.in_blade_frame();
            self.find_candidates(z, &tips, bound, 0.0, TIP_MARGIN);
            let deepest = self.gather_targets(z, &tips, 0.0, 0.0);
            self.rows.clear();
            if deepest <= 0.0 {
                return;
            }
            let part = self.tips.least / (self.tips.least + deepest);
            self.u.iter_mut().for_each(|at| at.x *= part);
            self.blades.shrink(part);
        }
    }
}
