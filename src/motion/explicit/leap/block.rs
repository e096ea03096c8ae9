//! Steps decided on ahead: a *block* of flight, of a held lock or of a side that is
//! slid along. It is looked at wherever asked, and taken at its end; looking never
//! changes the trajectory.

use super::held::Held;
use crate::motion::explicit::disk::Disk;
use crate::motion::explicit::{Coordinate, Explicit};

/// A block without end: no contact can ever come again.
pub(in crate::motion::explicit) const ENDLESS: u64 = u64::MAX;

/// Steps decided on, from the step the coordinates belong to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::motion::explicit) struct Block {
    length: u64,
    used: u64,
}

impl Block {
    /// Of so many steps.
    pub(in crate::motion::explicit) fn new(length: u64) -> Self {
        Self { length, used: 0 }
    }
    pub(in crate::motion::explicit) fn is_open(self) -> bool {
        self.length > 0
    }
    pub(in crate::motion::explicit) fn is_endless(self) -> bool {
        self.length == ENDLESS
    }
    pub(in crate::motion::explicit) fn used(self) -> u64 {
        self.used
    }
}

impl<B: Disk> Explicit<B> {
    /// Whether a block is open, deciding on one if it can be long enough to be worth it.
    pub(in crate::motion::explicit) fn open_block(&mut self) -> bool {
        let held = self.leaps.block.is_open() || (self.record.last_touch == self.n && self.hold());
        if !held {
            self.leaps.block = Block::new(self.flight());
        }
        self.leaps.block.is_open()
    }

    /// Goes on inside the open block, up to `target`; takes it at its end.
    pub(in crate::motion::explicit) fn use_block(&mut self, target: u64) {
        let before = self.leaps.block.used;
        let wanted = target - self.n;
        self.leaps.block.used = wanted.min(self.leaps.block.length);
        if let Some(held) = self.leaps.held.take() {
            self.log_held(&held, before);
            self.leaps.held = Some(held);
        }
        if self.leaps.block.used == self.leaps.block.length {
            self.close_block();
        }
    }

    /// Takes the steps used so far and closes the block.
    pub(in crate::motion::explicit) fn close_block(&mut self) {
        self.end_sliding();
        let used = self.leaps.block.used;
        if used > 0 && self.leaps.held.is_none() {
            let (largest, bound) = self.blades.fly(used, self.watch.largest());
            self.watch.skipped(largest, bound);
            self.u = self.u.map(|coordinate| self.casing.skip(coordinate, used));
        } else if used > 0 {
            let largest = self.largest_angle();
            (self.u, self.blades) = self.materialized();
            self.watch.skipped(largest, self.blades.look(largest).1);
        }
        self.n += used;
        self.leaps.skipped += used;
        if let Some(held) = self.leaps.held.take()
            && self.leaps.block.used > 0
        {
            self.record.last_touch = self.n;
            for (side, lambda) in held.multipliers(self.leaps.block.used) {
                self.record.keep_touching(self.n, side);
                for row in self.rows.iter_mut().filter(|row| row.side == side) {
                    row.lambda = lambda;
                }
            }
            self.leaps.hold_tried = self.n;
        }
        self.leaps.block = Block::default();
    }

    /// The largest angle of any blade so far, the open block included \[rad\].
    pub(in crate::motion::explicit) fn largest_angle(&self) -> f64 {
        let (used, least) = (self.leaps.block.used, self.watch.largest());
        match &self.leaps.held {
            _ if used == 0 => least,
            Some(Held::Corner(held)) => held.largest_angle(used, least),
            _ => self.blades.peak(used, least),
        }
    }

    /// Coordinates at the latest step, inside a block or not.
    pub(in crate::motion::explicit) fn materialized(&self) -> ([Coordinate; 2], B) {
        if let Some(sliding) = &self.leaps.sliding {
            return self.slid(sliding);
        }
        let mut blades = self.blades.clone();
        let used = self.leaps.block.used;
        match &self.leaps.held {
            _ if used == 0 => (self.u, blades),
            Some(Held::Corner(corner)) => self.held_at(corner, used),
            Some(Held::Side(side)) => (self.along_side(side, used), blades),
            None => {
                blades.skip(used);
                (self.u.map(|coordinate| self.casing.skip(coordinate, used)), blades)
            }
        }
    }
}
