//! Free flight: how many steps no contact can come in.
//!
//! The discrete energy bounds how far `|u|` can travel in one step
//! (docs/theory.md, section 6). So many steps as cannot reach the clearance are one block.

use super::block::ENDLESS;
use crate::motion::ActiveSet;
use crate::motion::explicit::Explicit;
use crate::motion::explicit::disk::Disk;
use crate::tolerances::{BREAK_STEPS, LARGEST_BLADE_ANGLE};

impl<B: Disk> Explicit<B> {
    /// Steps that cannot touch; none where they are too few to be worth a block.
    pub(in crate::motion::explicit) fn flight(&mut self) -> u64 {
        let clearance = self.machine.polygon.clearance;
        let distance2 = self.u[0].x * self.u[0].x + self.u[1].x * self.u[1].x;
        // Blades that are driven do not follow the free recurrence.
        let outside = distance2 >= clearance * clearance;
        if outside || self.drive.pulse_to_come(self.n) || self.drive.excitation.is_some() {
            return 0;
        }
        let distance = distance2.sqrt();
        let (farthest, longest) = self.casing.reach_of(self.u);
        let length =
            if farthest < clearance { ENDLESS } else { ((clearance - distance) / longest) as u64 };
        // Blades that may swing too far are followed step by step.
        if length < self.blades.shortest_block() || self.blades.reach() > LARGEST_BLADE_ANGLE {
            return 0;
        }
        // Such a block is longer than the pause that ends a contact.
        if self.record.log.active_set != ActiveSet::Nothing {
            self.end_contact(self.n.max(self.record.last_touch + BREAK_STEPS + 1));
        }
        length
    }

    /// Whether no contact can ever come again: the casing, whatever the blades
    /// do, never reaches one.
    pub(in crate::motion::explicit) fn no_contact_to_come(&self) -> bool {
        if self.leaps.held.is_some()
            || self.leaps.sliding.is_some()
            || self.drive.pulse_to_come(self.n)
        {
            return false;
        }
        if self.goes_beyond {
            return self.rests();
        }
        let skipped = |coordinate| self.casing.skip(coordinate, self.leaps.block.used());
        self.leaps.block.is_endless()
            || self.casing.reach_of(self.u.map(skipped)).0 < self.machine.polygon.clearance
    }
}
