//! What is known of the angle of every blade, so that few of them are looked at
//! in a step in which the largest angle grows.
//!
//! A step turns no blade by more than a bound that is summed up. A blade whose
//! latest angle and this sum are below the largest angle so far is left alone.
//! While a push makes a few blades swing up, those are the ones looked at, and
//! one bound on all others spares even going through them.

use super::ring::Ring;
use super::shapes::{NearRows, product};
use crate::motion::explicit::Coordinate;
use crate::tolerances::BLADES_FIRST;

/// Bounds on the angle of every member of a ring.
#[derive(Clone, Debug)]
pub(super) struct AngleBounds {
    /// The diameters that an excitation drives. What they make of an angle is
    /// known of every member; the rest of it is what was seen.
    driven: Option<usize>,
    seen: Vec<Seen>,
    /// Sum of the bounds on what the steps so far have turned a member \[rad\].
    turned: f64,
    /// Members that are looked at first.
    first: Vec<usize>,
    /// A bound on the angle of all others, less `turned`.
    others: f64,
}

/// An angle that was looked at, and `turned` at that time \[rad\].
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    angle: f64,
    turned: f64,
}

impl AngleBounds {
    /// Of members at rest.
    pub fn at_rest(members: usize) -> Self {
        Self {
            driven: None,
            seen: vec![Seen::default(); members],
            turned: 0.0,
            first: Vec::new(),
            others: 0.0,
        }
    }

    /// Nothing is known but a bound on all angles.
    pub fn reset(&mut self, bound: f64) {
        self.seen.fill(Seen { angle: 0.0, turned: -bound });
        (self.turned, self.others) = (0.0, bound);
        self.first.clear();
    }

    /// All angles are known.
    pub fn set(&mut self, members: &[Coordinate]) {
        self.reset(0.0);
        for (seen, at) in self.seen.iter_mut().zip(members) {
            seen.angle = at.x;
            self.others = self.others.max(at.x.abs());
        }
    }

    /// From now on, an excitation drives the modes of these diameters, or none.
    pub fn drive(&mut self, driven: Option<usize>) {
        if driven != self.driven {
            self.driven = driven;
            self.reset(f64::INFINITY);
        }
    }

    /// No member has turned by more than `change`, but for what is driven.
    pub fn turn(&mut self, change: f64) {
        self.turned += change;
    }

    /// A bound on every angle, where nothing is driven.
    pub fn largest(&self) -> f64 {
        let bound = |&member: &usize| self.bound(member, 0.0);
        self.first.iter().map(bound).fold(self.others + self.turned, f64::max)
    }

    /// A bound on the angle of a member, of which the driven modes make a part.
    fn bound(&self, member: usize, driven: f64) -> f64 {
        let seen = self.seen[member];
        (driven + seen.angle).abs() + (self.turned - seen.turned)
    }

    /// The largest angle now of the members that may be beyond `largest`, and a
    /// bound on every angle.
    pub fn look(
        &mut self,
        ring: &Ring,
        near: &mut NearRows,
        x: &[f64],
        largest: f64,
    ) -> (f64, f64) {
        let mut now = 0.0_f64;
        if self.driven.is_none() {
            for place in 0..self.first.len() {
                let member = self.first[place];
                if self.bound(member, 0.0) > largest.max(now) {
                    let angle = product(near.row(&ring.shapes, member as u32), x);
                    self.seen[member] = Seen { angle, turned: self.turned };
                    now = now.max(size(angle));
                }
            }
            if self.others + self.turned <= largest.max(now) {
                return (now, self.largest());
            }
        }
        self.look_at_all(ring, x, (largest, now))
    }

    /// As `look`, where all members are gone through.
    fn look_at_all(
        &mut self,
        ring: &Ring,
        x: &[f64],
        (largest, mut now): (f64, f64),
    ) -> (f64, f64) {
        let mut top = (0, 0.0);
        ring.each_of_pair(self.driven, x, |member, driven| {
            // The sum starts from zero again, before it has many digits more than an angle.
            self.seen[member].turned -= self.turned;
            let bound = (driven + self.seen[member].angle).abs() - self.seen[member].turned;
            if bound > top.1 {
                top = (member, bound);
            }
        });
        self.turned = 0.0;
        // Where bounds are close, no member is beyond the one of the largest.
        if top.1 > largest.max(now) {
            now = now.max(size(ring.shapes.at(top.0, x)));
        }
        let (mut all, mut few) = (Vec::new(), ring.few);
        self.first.clear();
        self.others = 0.0;
        ring.each_of_pair(self.driven, x, |member, driven| {
            let mut bound = self.bound(member, driven);
            if member == top.0 || bound > largest.max(now) {
                if few == 0 && all.is_empty() {
                    all = ring.shapes.all(x);
                }
                few = few.saturating_sub(1);
                let known = all.get(member).copied();
                let angle = known.unwrap_or_else(|| ring.shapes.at(member, x));
                self.seen[member] = Seen { angle: angle - driven, turned: 0.0 };
                now = now.max(size(angle));
                // `driven + (angle - driven)` may be rounded.
                bound = size(angle);
                if self.first.len() < BLADES_FIRST {
                    self.first.push(member);
                    return;
                }
            }
            self.others = self.others.max(bound);
        });
        (now, self.others.max(now))
    }
}

/// The size of an angle; no angle is beyond any bound.
fn size(angle: f64) -> f64 {
    if angle.is_nan() { f64::INFINITY } else { angle.abs() }
}

#[cfg(test)]
mod tests {
    use crate::motion::explicit::disk::full::tests::pressed;
    use crate::motion::explicit::disk::{Disk, FullBlades};

    #[test]
    fn angles_are_never_beyond_their_estimates() {
        let scene = pressed(1e-5);
        let mut blades = FullBlades::at_rest(&scene, &scene.machine(), None);
        for step in 0..3000_u32 {
            blades.predict(None);
            if step % 50 < 5 {
                blades.correct(step % 22, -0.3);
            }
            let angles = blades.every_angle();
            let (_, estimates, slack) = blades.estimates();
            for (angle, estimate) in angles.iter().zip(estimates) {
                assert!((angle - estimate).abs() <= slack * (1.0 + 1e-9) + 1e-18, "{step}");
            }
            let most = angles.iter().fold(0.0_f64, |most, angle| most.max(angle.abs()));
            assert!(most <= blades.bound() * (1.0 + 1e-9));
        }
    }

    #[test]
    fn bent_blades_that_get_other_parameters_are_looked_at() {
        let scene = pressed(1e-5);
        let mut blades = FullBlades::at_rest(&scene, &scene.machine(), None);
        for step in 0..100_u32 {
            blades.predict(None);
            blades.correct(step % 22, -0.3);
        }
        for steps in 0..2 {
            let mut changed = blades.with_parameters(&scene, &scene.machine());
            (0..steps).for_each(|_| _ = changed.predict(None));
            let most = changed.every_angle().iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            assert!(most > 0.0 && most <= changed.bound() * (1.0 + 1e-9), "{steps}: {most}");
        }
    }
}
