//! The largest blade angle so far, at the price of a bound a step.
//!
//! A step moves no blade by more than a bound that comes with it. As long as
//! these bounds sum to less than what is missing to the largest angle so far,
//! there is nothing to look at.

/// Blade angle beyond which small-angle blades have lost their meaning \[rad\].
pub(super) const LARGEST_ANGLE: f64 = 0.1;

/// The largest blade angle of the steps taken.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Watch {
    /// \[rad\]
    largest: f64,
    /// What every blade angle is below it, at least \[rad\].
    room: f64,
}

impl Watch {
    /// The largest angle so far \[rad\].
    pub fn largest(self) -> f64 {
        self.largest
    }

    /// Blades have moved by no more than `change`; whether to look at them.
    pub fn moved(&mut self, change: f64) -> bool {
        self.room -= change;
        self.room < 0.0 || self.room.is_nan()
    }

    /// The largest angle of any blade now.
    ///
    /// # Errors
    /// It is beyond what small angles allow, or not a number.
    pub fn look(&mut self, now: f64) -> Result<(), String> {
        self.largest = self.largest.max(now);
        self.room = self.largest - now;
        if now > LARGEST_ANGLE || now.is_nan() { Err(too_wide(now)) } else { Ok(()) }
    }

    /// Steps without a look, over which the largest angle was `largest`; blades
    /// are below `bound` now.
    pub fn skipped(&mut self, largest: f64, bound: f64) {
        self.largest = self.largest.max(largest);
        self.room = self.largest - bound;
    }
}

fn too_wide(angle: f64) -> String {
    format!(
        "a blade angle of {angle:.3e} rad is beyond the {LARGEST_ANGLE} rad that small angles allow"
    )
}
