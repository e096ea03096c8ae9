//! Steps taken many at once, with the result of taking each: free flight (`flight`), a held
//! lock (`corner_step`, `unfolded`, `held_corner`). Along a side of blades that move a short
//! step is enough (`sliding`, `along_side`). Each says itself where it applies
//! (docs/theory.md, section 6). Read them in this order.

mod along_side;
mod block;
mod corner_step;
mod flight;
mod held_corner;
mod sliding;
mod unfolded;

use super::Explicit;
use super::disk::Disk;
use block::Block;
use held_corner::HeldCorner;
use sliding::Sliding;

/// What was decided on ahead, and when to try again.
#[derive(Clone, Debug, Default)]
pub(super) struct Leaps {
    /// Steps already decided on, not yet taken.
    block: Block,
    /// Steps of the blocks closed so far.
    skipped: u64,
    /// The lock that the open block holds, if it is in contact.
    held: Option<Box<HeldCorner>>,
    /// Step before which a corner is not tried to be held.
    hold_tried: u64,
    /// The same for a side, and for a flight beyond the paper.
    slide_tried: u64,
    flight_tried: u64,
    /// The wave on a side of blades that move; `u` and `blades` are then those before.
    sliding: Option<Sliding>,
    /// Steps in a row until the latest contact with the same sides.
    pub same_sides: u64,
}

impl Leaps {
    /// Returns whether a lock is held.
    pub fn holds_corner(&self) -> bool {
        self.held.is_some()
    }

    /// Returns whether the coordinates are those of an earlier step.
    pub fn are_ahead(&self) -> bool {
        self.block.used() > 0 || self.sliding.is_some()
    }

    /// Returns the steps of all blocks.
    pub fn skipped(&self) -> u64 {
        self.skipped + self.block.used()
    }

    /// Returns the multipliers by side inside an open block or slide, if there is one.
    pub fn multipliers(&self) -> Option<Vec<(u32, f64)>> {
        let of_slide = |sliding: &Sliding| vec![(sliding.side, sliding.multiplier)];
        let of_block = || {
            let held = self.held.as_ref().filter(|_| self.block.used() > 0)?;
            Some(held.pushes_by_side(self.block.used()).to_vec())
        };
        self.sliding.as_ref().map(of_slide).or_else(of_block)
    }
}

impl<B: Disk> Explicit<B> {
    /// Takes steps at once, up to step `target` and about `most` of them, if there are
    /// any to take; how many are worth a look at the clock.
    pub(super) fn leap(&mut self, target: u64, most: usize) -> Option<usize> {
        if self.is_sliding() {
            let unseen = if self.goes_beyond { self.beyond.unseen(self.n) } else { u64::MAX };
            self.slide((target - self.n).min(most as u64).min(unseen));
            Some(most.min(unseen as usize))
        } else if self.open_block() {
            self.use_block(target);
            Some(0)
        } else {
            None
        }
    }

    /// Returns the latest step, that of an open block included.
    pub(super) fn latest_step(&self) -> u64 {
        self.n + self.leaps.block.used()
    }

    /// Ends what was decided on ahead.
    pub(super) fn interrupt(&mut self) {
        self.close_block();
        self.leaps.hold_tried = self.n;
        (self.leaps.slide_tried, self.leaps.flight_tried) = (self.n, self.n);
        self.leaps.same_sides = 0;
        if let Some(lining) = &mut self.lining {
            lining.rest = std::sync::OnceLock::new();
        }
    }
}
