//! Free steps of the full disk, many at once: how far they may turn a blade, and
//! how far they do.

use super::full::FullBlades;
use crate::motion::explicit::Coordinate;
use crate::tolerances::ANGLE_LOOK;

impl FullBlades {
    /// Free steps of the modes alone.
    pub(super) fn leap(&mut self, steps: u64) {
        for (k, oscillator) in self.ring.oscillators.iter().enumerate() {
            for place in self.ring.pair(k) {
                let ahead = oscillator.skip(self.coordinate_at(place), steps);
                (self.x[place], self.increments[place]) = (ahead.x, ahead.increment);
            }
        }
    }

    /// Bounds on every angle and its increment over all free steps to come
    /// \[rad\]: of modes that all add up, or of the norm, which a blade's angle
    /// does not exceed as shapes are orthonormal.
    pub(super) fn reaches(&self) -> (f64, f64) {
        let (mut sums, mut squares) = ((0.0, 0.0), (0.0, 0.0));
        for (k, oscillator) in self.ring.oscillators.iter().enumerate() {
            let pair = self.ring.pair(k).map(|place| self.coordinate_at(place));
            let (x, increment) = oscillator.reach_of(pair);
            let scale = self.ring.shapes.scale(k);
            sums = (sums.0 + scale * x, sums.1 + scale * increment);
            squares = (squares.0 + x * x, squares.1 + increment * increment);
        }
        (sums.0.min(squares.0.sqrt()), sums.1.min(squares.1.sqrt()))
    }

    /// Takes free steps and looks at every blade on the way; the largest angle,
    /// or `least`.
    pub(super) fn fly_looking(&mut self, steps: u64, least: f64) -> f64 {
        let stride = (ANGLE_LOOK / self.ring.fastest).clamp(1.0, 1e12) as u64;
        let mut here = self.members();
        let mut most = largest(&here).max(least);
        let mut taken = 0;
        while taken < steps && self.reaches().0 > most {
            let part = stride.min(steps - taken);
            let before = self.clone();
            self.leap(part);
            let next = self.members();
            most = most.max(largest(&next));
            for (member, (a, b)) in here.iter().zip(&next).enumerate() {
                // Beyond both ends by at most what the steeper end reaches half-way.
                let rise = a.increment.abs().max(b.increment.abs()) * part as f64;
                let turns = a.increment * b.increment < 0.0;
                if turns && a.x.abs().max(b.x.abs()) + 0.5 * rise > most {
                    most = most.max(before.turning_point(member, part));
                }
            }
            (here, taken) = (next, taken + part);
        }
        if taken < steps {
            self.bounds.reset(self.reaches().0);
            self.leap(steps - taken);
        } else {
            self.bounds.set(&here);
        }
        most
    }

    /// Angle and increment of every member.
    fn members(&self) -> Vec<Coordinate> {
        self.ring.shapes.all_moving(&self.x, &self.increments)
    }

    /// Largest angle of a member around the one turning point that it passes
    /// within `steps` free steps \[rad\].
    fn turning_point(&self, member: usize, steps: u64) -> f64 {
        let at = |steps| {
            let mut blades = self.clone();
            blades.leap(steps);
            [&blades.x, &blades.increments].map(|values| self.ring.shapes.at(member, values))
        };
        let start = self.ring.shapes.at(member, &self.increments);
        let (mut before, mut after) = (0, steps);
        while after - before > 1 {
            let middle = before + (after - before) / 2;
            if at(middle)[1] * start > 0.0 { before = middle } else { after = middle }
        }
        at(before)[0].abs().max(at(after)[0].abs())
    }
}

/// The largest angle.
fn largest(members: &[Coordinate]) -> f64 {
    members.iter().fold(0.0, |most, at| f64::max(most, at.x.abs()))
}

#[cfg(test)]
mod tests {
    use super::super::full::tests::{angles, at_rest, scene, widest};
    use crate::motion::explicit::EngineOrderTorque;
    use crate::motion::explicit::disk::Disk;
    use crate::motion::explicit::record::Watch;

    #[test]
    fn the_largest_angle_of_all_steps_is_found_by_looks_and_flights() {
        for (count, order) in
            [(5, None), (22, None), (22, Some(5)), (131, None), (140, None), (140, Some(7))]
        {
            let scene = scene(count, order);
            let torque = EngineOrderTorque::of(&scene);
            let (mut blades, mut watch, mut most) = (at_rest(&scene), Watch::default(), 0.0_f64);
            let mut looks = 0;
            for step in 0..600_u32 {
                let phase = 0.05 * f64::from(step);
                let mut unknown =
                    watch.moved(blades.predict(torque.as_ref().map(|torque| (torque, phase))));
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
                assert!(error < 1e-13 * most, "{count} {order:?} {step}: {error:e} of {most:e}");
                assert!(watch.bound() >= widest(&blades) * (1.0 - 1e-12), "{count} {step}");
                if order.is_none() && step % 97 == 60 {
                    let steps = u64::from(step % 30) + 1;
                    let mut stepped = blades.clone();
                    for _ in 0..steps {
                        stepped.predict(None);
                        most = most.max(widest(&stepped));
                    }
                    let (found, bound) = blades.fly(steps, watch.largest());
                    watch.skipped(found, bound);
                    assert!((found / most - 1.0).abs() < 1e-12, "{count} {step}: {found} {most}");
                    for (a, b) in angles(&blades).iter().zip(angles(&stepped)) {
                        assert!((a - b).abs() < 1e-13 * most, "{count} {step}: {a} {b}");
                    }
                }
            }
            assert!((10..550).contains(&looks), "{count} {order:?}: {looks} looks");
        }
    }

    #[test]
    fn no_number_is_beyond_every_bound() {
        for order in [None, Some(3)] {
            let scene = scene(22, order);
            let torque = EngineOrderTorque::of(&scene);
            let mut blades = at_rest(&scene);
            let mut watch = Watch::default();
            blades.correct(3, f64::NAN);
            assert!(watch.moved(blades.predict(torque.as_ref().map(|torque| (torque, 0.0)))));
            assert!(watch.look(blades.look(watch.largest())).is_err());
        }
    }
}
