//! Sides that close in every step to come: a lock, or a wave that slides along one
//! side. Such steps are taken many at once.

use super::block::{Block, ENDLESS};
use super::held_corner::HeldCorner;
use super::held_side::HeldSide;
use crate::motion::explicit::Explicit;
use crate::motion::explicit::disk::Disk;
use crate::tolerances::SHORTEST_BLOCK;

/// Sides that close in every step of the open block.
#[derive(Clone, Debug)]
pub(in crate::motion::explicit) enum Held {
    /// A lock.
    Corner(Box<HeldCorner>),
    /// A wave that slides along one side of rigid blades.
    Side(HeldSide),
}

impl Held {
    /// Multipliers of the step that led to `steps` steps from the start \[N\].
    pub fn multipliers(&self, steps: u64) -> impl Iterator<Item = (u32, f64)> {
        let pair = match self {
            Self::Corner(corner) => corner.by_side(corner.multipliers(steps)),
            Self::Side(side) => [Some((side.side, side.multiplier(steps))), None],
        };
        pair.into_iter().flatten()
    }

    /// Sums of the multipliers of the steps after `before`, up to `steps` \[N\].
    fn sums(&self, before: u64, steps: u64) -> impl Iterator<Item = (u32, f64)> {
        let pair = match self {
            Self::Corner(corner) => corner.by_side(corner.sums(before, steps)),
            Self::Side(side) => [Some((side.side, side.sum(before, steps))), None],
        };
        pair.into_iter().flatten()
    }
}

impl<B: Disk> Explicit<B> {
    /// Begins a block of steps in which the same sides close, if there are enough.
    pub(in crate::motion::explicit) fn hold(&mut self) -> bool {
        if let Some(corner) = self.hold_corner() {
            self.leaps.held = Some(Held::Corner(Box::new(corner)));
            self.leaps.block = Block::new(ENDLESS);
        } else if let Some(side) = self.hold_side() {
            let length = side.length;
            if length < SHORTEST_BLOCK {
                self.leaps.slide_tried = self.n + length;
                return false;
            }
            self.leaps.held = Some(Held::Side(side));
            self.leaps.block = Block::new(length);
        }
        self.leaps.held.is_some()
    }

    /// Keeps what the steps of held sides did since `before`.
    pub(in crate::motion::explicit) fn log_held(&mut self, held: &Held, before: u64) {
        let (used, t) = (self.leaps.block.used(), self.time_of(self.latest_step()));
        for (side, sum) in held.sums(before, used) {
            self.record.impulse(side, sum);
        }
        self.record.log.touch(t, self.record.log.active_set);
        match held {
            Held::Corner(corner) if corner.pulls => {
                self.record.log.tensile_steps += used - before;
                self.record.log.last_tensile = Some(t);
            }
            Held::Corner(_) => {}
            Held::Side(side) => {
                let deepest = side.deepest(before, used);
                self.record.deepest_predicted = self.record.deepest_predicted.max(deepest);
            }
        }
    }
}
