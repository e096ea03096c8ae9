//! The largest blade angle so far, at the price of a bound a step.
//!
//! A step moves no blade by more than a bound that comes with it. As long as
//! these bounds sum to less than what is missing to the largest angle so far,
//! there is nothing to look at.

use crate::motion::FailureReason;
use crate::tolerances::LARGEST_BLADE_ANGLE;

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

    /// A bound on every blade angle now \[rad\].
    pub fn bound(self) -> f64 {
        self.largest - self.room
    }

    /// Blades have moved by no more than `change`; whether to look at them.
    pub fn moved(&mut self, change: f64) -> bool {
        self.room -= change;
        self.room < 0.0 || self.room.is_nan()
    }

    /// The largest angle now of any blade that may be beyond `largest`, and a
    /// bound on every angle.
    ///
    /// # Errors
    /// It is beyond what small angles allow, or not a number.
    pub fn look(&mut self, (now, bound): (f64, f64)) -> Result<(), FailureReason> {
        self.largest = self.largest.max(now);
        self.room = self.largest - bound;
        let fits = now <= LARGEST_BLADE_ANGLE;
        if fits { Ok(()) } else { Err(FailureReason::BladeAngle { angle_rad: now }) }
    }

    /// Steps without a look, over which the largest angle was `largest`; blades
    /// are below `bound` now.
    pub fn skipped(&mut self, largest: f64, bound: f64) {
        self.largest = self.largest.max(largest);
        self.room = self.largest - bound;
    }
}
