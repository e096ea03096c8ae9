//! Bounds on the blade angles: now, in all free motion to come, and in all steps so far.
//!
//! The angles are evaluated only now and then; between two evaluations every step adds its largest
//! possible change to a slack.

use super::disk::Disk;
use super::oscillator::{Coordinate, Oscillator};
use crate::model::LARGEST_BLADE_ANGLE;

/// Phase that the blades turn between two evaluations of the largest angle \[rad\]. The relative
/// error is at most its square; within it the maximum is searched for.
pub(super) const ANGLE_LOOK: f64 = 0.125;

/// Largest blade angle at the latest evaluation, of a full disk all angles, and how far each may have
/// changed since \[rad\].
#[derive(Clone, Debug)]
pub(super) struct Seen {
    angles: Vec<f64>,
    largest: f64,
    pub slack: f64,
}

impl Seen {
    /// Nothing is known yet.
    pub const NOTHING: Self = Self { angles: Vec::new(), largest: 0.0, slack: f64::INFINITY };
}

impl Disk {
    /// Calls `put` with the angle of each row of a disk with more than a pair of modes \[rad\].
    pub fn all_angles(&mut self, mut put: impl FnMut(usize, f64)) {
        let (rows, per_row) = self.rows();
        let (angles, _) = self.angles_within(0.0);
        for row in 0..rows {
            let each = (0..per_row as usize).map(|k| angles[row + k * rows]);
            put(row, each.sum::<f64>() / f64::from(per_row));
        }
    }

    /// Returns the angles of the blades of such a disk, and how far each may have turned since, at most
    /// `slack` \[rad\].
    pub fn angles_within(&mut self, slack: f64) -> (&[f64], f64) {
        if self.seen.slack > slack {
            let angles = self.every_angle();
            let largest = angles.iter().copied().map(size).fold(0.0, f64::max);
            self.seen = Seen { angles, largest, slack: 0.0 };
        }
        (&self.seen.angles, self.seen.slack)
    }

    /// Returns a bound on every blade angle now \[rad\].
    #[inline]
    pub fn bound(&mut self) -> f64 {
        if self.fixed.is_pair {
            let [c, s] = self.pair_angles();
            return c.abs() + s.abs();
        }
        // Twice as large at most.
        self.angles_within(self.seen.largest);
        self.seen.largest + self.seen.slack
    }

    /// Returns the largest angle about the mean of all blades; for a pair, its amplitude \[rad\].
    pub fn swing(&mut self) -> f64 {
        if self.fixed.is_pair {
            let [c, s] = self.pair_angles();
            return (c * c + s * s).sqrt();
        }
        let (angles, _) = self.angles_within(0.0);
        let mean = angles.iter().sum::<f64>() / angles.len() as f64;
        angles.iter().map(|x| size(x - mean)).fold(0.0, f64::max)
    }

    /// Returns a bound on every blade angle in all free motion to come \[rad\].
    pub fn reach(&self) -> f64 {
        if !self.is_tuned() {
            return self.reach_of_mistuned();
        }
        let modes = self.oscillators.iter().enumerate();
        let reach = |(m, oscillator): (usize, &Oscillator)| oscillator.reach(&[self.at(m)]);
        match &self.oscillators[..] {
            [first, second] if self.fixed.is_pair && first == second => {
                first.reach(&[self.at(0), self.at(1)])
            }
            _ => modes.map(reach).sum(),
        }
    }

    /// Updates the largest angle. Returns the angle that is beyond the limit of the model, if one
    /// is \[rad\].
    #[inline]
    pub fn watch(&mut self) -> Option<f64> {
        let within = self.seen.largest + self.seen.slack <= self.largest;
        if within { None } else { self.look() }
    }

    #[inline(never)]
    fn look(&mut self) -> Option<f64> {
        if self.fixed.is_pair {
            let ([c, s], phases) = (self.pair_angles(), &self.fixed.phases);
            let is_finite = c.is_finite() && s.is_finite();
            let mut most = || phases.largest_component_near(c, s, &mut self.widest);
            let largest = if is_finite { most() } else { f64::INFINITY };
            self.seen = Seen { largest, slack: 0.0, ..Seen::NOTHING };
        } else {
            self.angles_within(0.0);
        }
        let now = self.seen.largest;
        self.largest = self.largest.max(now);
        (now > LARGEST_BLADE_ANGLE).then_some(now)
    }

    /// With springs of their own the modes of the tuned disk exchange energy: all of it in one blade,
    /// at the softest spring, is the most. As `Oscillator::reach`, in units of the inertia of a blade
    /// and of a step.
    fn reach_of_mistuned(&self) -> f64 {
        let Some(first) = self.oscillators.first() else { return 0.0 };
        let inertia = first.mass / self.fixed.springs.len() as f64;
        let of = |spring: f64| spring * first.step * first.step / inertia;
        let springs = self.fixed.springs.iter();
        let (least, most) = springs.fold((0.0, 0.0), |(least, most), &spring| {
            (f64::min(least, of(spring)), f64::max(most, of(spring)))
        });
        let least = least + first.turn() * first.turn();
        let most = most + self.fastest_turn() * self.fastest_turn();
        if least <= 0.0 || most >= 4.0 {
            return f64::INFINITY;
        }
        let energy = 2.0 * self.energy().max(0.0) * first.step * first.step / inertia;
        (energy * (1.0 / least + 0.25 / (1.0 - 0.25 * most))).sqrt()
    }

    /// Records the largest blade angle of a pair with these modes, and returns it \[rad\].
    pub fn see_pair(&mut self, [c, s]: [Coordinate; 2]) -> f64 {
        let angle = self.fixed.phases.largest_component_near(c.x, s.x, &mut self.widest);
        self.largest = self.largest.max(angle);
        angle
    }
}

/// Returns the magnitude of an angle; NaN counts as infinite.
fn size(angle: f64) -> f64 {
    if angle.is_nan() { f64::INFINITY } else { angle.abs() }
}
