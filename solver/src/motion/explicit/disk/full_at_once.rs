//! All blades of the full disk at once, by transforms: looks at their angles, and torques on
//! many of them.

use super::full::FullBlades;
use super::{Columns, Disk};
use crate::tolerances::{FEW_BLADES, FEW_PRESSED};

/// Angles of all members at the latest look at them.
#[derive(Clone, Debug)]
pub(super) struct Seen {
    pub angles: Vec<f64>,
    /// How far they may have turned since \[rad\], and the steps since.
    pub slack: f64,
    pub steps: u32,
    /// Largest of a blade, and the largest about the mean \[rad\].
    pub largest: [f64; 2],
}

impl Seen {
    /// Creates the state of members that have not been looked at yet.
    pub fn nothing(members: usize) -> Self {
        let angles = vec![0.0; members];
        Self { angles, slack: f64::INFINITY, steps: u32::MAX, largest: [0.0; 2] }
    }

    /// Forgets what was seen.
    pub fn forget(&mut self) {
        (self.slack, self.steps) = (f64::INFINITY, u32::MAX);
    }

    /// Returns whether nothing has moved since.
    pub fn are_of_now(&self) -> bool {
        self.steps == 0 && self.slack == 0.0
    }
}

impl FullBlades {
    /// Puts the torques of the extra springs into the room. Returns whether there are any.
    pub(super) fn pull(&mut self) -> bool {
        let Self { ring, rows, x, room, .. } = self;
        if !rows.springs.is_empty() {
            ring.shapes.all_into(x, room);
            room.blades.iter_mut().zip(&rows.springs).for_each(|(angle, spring)| *angle *= -spring);
        }
        !rows.springs.is_empty()
    }

    /// Returns whether these rows cost more one by one than all at once.
    pub(super) fn are_many(&self, rows: &Columns) -> bool {
        rows.index.len() * self.rows.members as usize
            > self.ring.shapes.few() / FEW_BLADES * FEW_PRESSED
    }

    /// Puts values of rows, shared evenly by their members, into the room.
    pub(super) fn put(&mut self, values: impl Iterator<Item = (u32, u32, f64)>) {
        let (members, count) = (self.rows.members as usize, self.rows.table.count());
        self.room.blades.fill(0.0);
        for (row, _, value) in values {
            for member in 0..members {
                self.room.blades[row as usize + member * count] = value / members as f64;
            }
        }
    }

    /// Corrects the step by the torques in the room. Returns a bound on the change of any angle
    /// \[rad\].
    pub(super) fn turn_all(&mut self) -> f64 {
        let Self { ring, rows, x, increments, room, .. } = self;
        let most = room.blades.iter().fold(0.0_f64, |most, torque| most.max(torque.abs()));
        ring.shapes.feel(room, |k, felt| {
            let compliance = ring.oscillators[k].compliance;
            for (place, felt) in ring.pair(k).into_iter().zip(felt) {
                x[place] += compliance * felt;
                increments[place] += compliance * felt;
            }
        });
        let change = rows.most_turned * most;
        self.seen.slack += change;
        change
    }

    /// Looks at all blades, if they may have turned too far since the last look.
    pub(super) fn see(&mut self) {
        let rows = &self.rows;
        if self.seen.slack > rows.most_slack || self.seen.steps >= rows.steps_unseen {
            self.see_all();
        }
    }

    /// Looks at all blades.
    pub(super) fn see_all(&mut self) {
        if self.seen.are_of_now() {
            return;
        }
        let Self { ring, x, room, seen, .. } = self;
        ring.shapes.all_into(x, room);
        seen.angles.copy_from_slice(&room.blades);
        let mean = seen.angles.iter().sum::<f64>() / seen.angles.len() as f64;
        let most = |about: f64| seen.angles.iter().map(|x| size(x - about)).fold(0.0, f64::max);
        seen.largest = [most(0.0), most(mean)];
        (seen.slack, seen.steps) = (0.0, 0);
    }

    /// Looks at those members whose angles may be beyond `largest`. Returns the largest of these
    /// angles, and a bound on all angles.
    pub(super) fn look_at_largest(&mut self, largest: f64) -> (f64, f64) {
        let Self { ring, seen, x, .. } = self;
        let mut left = ring.shapes.few().min(seen.angles.len() / 2);
        let (mut now, mut bound) = (0.0_f64, 0.0_f64);
        for (member, angle) in seen.angles.iter().enumerate() {
            let most = angle.abs() + seen.slack;
            if most <= largest {
                bound = bound.max(most);
            } else if left > 0 {
                left -= 1;
                now = now.max(size(ring.shapes.at(member, x)));
            } else {
                self.see_all();
                return (self.seen.largest[0], self.seen.largest[0]);
            }
        }
        (now, bound.max(now))
    }
}

impl FullBlades {
    /// Takes `left` free steps and returns the largest angle of a blade in them; `least` where
    /// none is larger \[rad\]. All blades are looked at again once one of them may have gone
    /// beyond the largest angle before and come back: until then, an angle that grows is
    /// largest at the next look.
    pub(super) fn fly_looking(&mut self, mut left: u64, least: f64) -> f64 {
        let mut most = least;
        loop {
            let (angles, increments) =
                (self.ring.shapes.all(&self.x), self.ring.shapes.all(&self.increments));
            most = angles.iter().fold(most, |most, angle| most.max(angle.abs()));
            if left == 0 {
                return most;
            }
            let bend = self.most_bent();
            let unseen = |(angle, increment): (&f64, &f64)| {
                let outward = increment * angle.signum();
                let within = until(most - angle.abs(), outward, bend);
                let beyond = until(most + angle.abs(), -outward, bend);
                within.min(beyond).max(outward / bend)
            };
            let free = angles.iter().zip(&increments).map(unseen).fold(left as f64, f64::min);
            let steps = (free as u64).clamp(1, left);
            self.skip(steps);
            left -= steps;
        }
    }

    /// Returns a bound on the change of the increment of any angle in one of the free steps to
    /// come \[rad\]; shapes are orthonormal.
    fn most_bent(&self) -> f64 {
        let each = self.ring.oscillators.iter().enumerate().map(|(k, oscillator)| {
            let pair = self.ring.pair(k).map(|place| self.coordinate_at(place));
            let (x, increment) = oscillator.reach_of(pair);
            oscillator.pull * x + oscillator.loss * increment
        });
        each.map(|bend| bend * bend).sum::<f64>().sqrt()
    }
}

/// Returns the steps in which an angle cannot grow by `room`, where its increment is `increment`
/// now and changes by no more than `bend` in a step.
fn until(room: f64, increment: f64, bend: f64) -> f64 {
    let rate = increment + 0.5 * bend;
    let root = (rate * rate + 2.0 * bend * room).sqrt();
    if rate > 0.0 { 2.0 * room / (rate + root) } else { (root - rate) / bend }
}

/// Returns the size of an angle; what is no number is beyond any bound.
fn size(angle: f64) -> f64 {
    if angle.is_nan() { f64::INFINITY } else { angle.abs() }
}

#[cfg(test)]
mod tests {
    use super::super::full::tests::{at_rest, pressed, scene, widest};
    use crate::motion::explicit::disk::{Disk, FullBlades};
    use crate::motion::explicit::record::Watch;

    #[test]
    fn the_largest_angle_of_all_steps_is_found() {
        for count in [5, 22, 131, 140] {
            let mut blades = at_rest(&scene(count));
            let (mut watch, mut most) = (Watch::default(), 0.0_f64);
            let mut looks = 0;
            for step in 0..600_u32 {
                let phase = 0.05 * f64::from(step);
                let mut unknown = watch.moved(blades.predict(None));
                // Pushes of one blade, of its neighbour, and one from far away.
                if step % 97 < 20 {
                    let (blade, push) = ((step / 97 * 7) % count, 1.0 + (0.1 * phase).sin());
                    blades.correct(blade, push);
                    unknown = watch.moved(blades.compliance(blade, blade) * push);
                }
                if unknown {
                    looks += 1;
                    watch.look(blades.look(watch.largest())).unwrap();
                }
                most = most.max(widest(&blades));
                // Round-off of the transform, and of the sum of the bounds.
                let error = (watch.largest() - most).abs();
                assert!(error < 1e-13 * most, "{count} {step}: {error:e} of {most:e}");
                assert!(watch.bound() >= widest(&blades) * (1.0 - 1e-12), "{count} {step}");
            }
            assert!((10..550).contains(&looks), "{count}: {looks} looks");
        }
    }

    #[test]
    fn no_number_is_beyond_every_bound() {
        let (mut blades, mut watch) = (at_rest(&scene(22)), Watch::default());
        blades.correct(3, f64::NAN);
        assert!(watch.moved(blades.predict(None)));
        assert!(watch.look(blades.look(watch.largest())).is_err());
    }

    #[test]
    fn the_largest_angle_of_a_flight_is_that_of_its_steps() {
        for count in [1, 5, 22, 131, 140] {
            for steps in [1_u64, 10, 300, 3000] {
                let mut blades = at_rest(&scene(count));
                for step in 0..40 {
                    blades.predict(None);
                    blades.correct(step % count.min(3), 1.0);
                }
                let least = 0.5 * widest(&blades);
                let mut plain = blades.clone();
                let most = (0..steps).fold(widest(&blades), |most, _| {
                    plain.predict(None);
                    most.max(widest(&plain))
                });
                let found = blades.peak(steps, least);
                assert!((found - most).abs() < 1e-12 * most, "{count} {steps}: {found} {most}");
                assert_eq!(blades.peak(steps, 2.0 * blades.reach()), 2.0 * blades.reach());
            }
        }
    }

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
