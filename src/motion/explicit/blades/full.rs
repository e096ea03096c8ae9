//! Every blade its own coordinate (docs/theory.md, section 1).

use std::sync::Arc;

use super::BladeModel;
use super::ring::Ring;
use crate::model::{Machine, gcd};
use crate::motion::explicit::{Coordinate, EngineOrderTorque};
use crate::scene::Scene;
use crate::tolerances::{ANGLE_LOOK, FEW_BLADES, SHORTEST_BLOCK_OF_BLADES};

/// Every blade its own coordinate, Eqs. (2)-(3), carried in the Fourier modes
/// of the circulant matrices, where they are uncoupled. A row is a blade, or
/// all the blades that nothing tells apart; see `Ring`.
#[derive(Clone, Debug)]
pub struct FullBlades {
    ring: Arc<Ring>,
    /// Mode coordinates, and their last increments.
    x: Vec<f64>,
    increments: Vec<f64>,
    /// Bounds on the angle of every member, `moved` ago \[rad\].
    seen: Vec<f64>,
    /// Bound on what every member has turned since \[rad\].
    moved: f64,
}

impl BladeModel for FullBlades {
    fn at_rest(scene: &Scene, machine: &Machine) -> Self {
        Self::resting(Ring::new(scene, machine, Ring::most_alike(scene, machine)))
    }
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self {
        let old = &*self.ring;
        // What was excited apart stays so.
        let alike = gcd(old.alike, Ring::most_alike(scene, machine));
        let mut new = Self::resting(Ring::new(scene, machine, alike));
        let finer = (old.alike / alike) as usize;
        for k in 0..old.oscillators.len() {
            let factor = old.shapes.scale(k) / new.ring.shapes.scale(k * finer);
            for (from, to) in old.pair(k).into_iter().zip(new.ring.pair(k * finer)) {
                new.x[to] = factor * self.x[from];
                new.increments[to] = factor * self.increments[from];
            }
        }
        new.seen = self.seen.repeat(finer);
        new.moved = self.moved;
        new
    }
    fn coordinates(&self) -> usize {
        2 + self.ring.shapes.count()
    }
    fn rows_of_side(&self, side: u32) -> usize {
        self.ring.rows(side).len()
    }
    fn row(&self, side: u32, place: usize) -> u32 {
        self.ring.rows(side)[place]
    }
    fn predict(&mut self, excitation: Option<(&EngineOrderTorque, f64)>) -> f64 {
        let ring = &*self.ring;
        let before = excitation.map(|(torque, _)| {
            let place = |place: usize| self.coordinate_at(place);
            ring.pair(ring.driven(torque)).map(place)
        });
        let mut change = ring.step(&mut self.x, &mut self.increments);
        if let (Some(excitation), Some(before)) = (excitation, before) {
            change += ring.drive(excitation, before, &mut self.x, &mut self.increments);
        }
        self.moved += change;
        change
    }
    fn angle(&self, row: u32) -> f64 {
        self.ring.shapes.at(row as usize, &self.x)
    }
    fn compliance(&self, a: u32, b: u32) -> f64 {
        self.ring.influence[a.abs_diff(b) as usize]
    }
    fn correct(&mut self, row: u32, torque: f64) {
        self.ring.correct(row, torque, &mut self.x, &mut self.increments);
        self.moved += self.ring.influence[0] * torque.abs();
    }
    fn skip(&mut self, steps: u64) {
        self.leap(steps);
        self.seen.fill(f64::INFINITY);
    }
    fn shortest_block(&self) -> u64 {
        SHORTEST_BLOCK_OF_BLADES
    }
    fn look(&mut self, largest: f64) -> (f64, f64) {
        if !self.moved.is_finite() {
            return (f64::INFINITY, f64::INFINITY);
        }
        for seen in &mut self.seen {
            *seen += self.moved;
        }
        self.moved = 0.0;
        let far = self.seen.iter().filter(|&&seen| seen > largest).count();
        let mut now = 0.0_f64;
        if far > FEW_BLADES {
            self.seen = self.ring.shapes.all(&self.x);
            for seen in &mut self.seen {
                *seen = seen.abs();
            }
            now = top(&self.seen);
        } else {
            for (member, seen) in self.seen.iter_mut().enumerate() {
                if *seen > largest {
                    *seen = self.ring.shapes.at(member, &self.x).abs();
                    now = now.max(*seen);
                }
            }
        }
        (now, top(&self.seen))
    }
    fn reach(&self) -> f64 {
        self.reaches().0
    }
    fn peak(&self, steps: u64, least: f64) -> f64 {
        self.clone().fly(steps, least).0
    }
    fn fly(&mut self, steps: u64, least: f64) -> (f64, f64) {
        let (farthest, longest) = self.reaches();
        let risen = longest * steps as f64;
        let bound = farthest.min(top(&self.seen) + self.moved + risen);
        if bound <= least {
            self.leap(steps);
            self.moved += risen;
            return (least, bound);
        }
        let most = self.fly_looking(steps, least);
        (most, top(&self.seen))
    }
    fn modal(&self) -> ([f64; 2], [f64; 2]) {
        let shown = self.ring.shown();
        let rate = |(k, place, factor): (usize, usize, f64)| {
            factor * self.ring.oscillators[k].rate(self.coordinate_at(place), 0.0)
        };
        (shown.map(|(_, place, factor)| factor * self.x[place]), shown.map(rate))
    }
    fn every_angle(&self, _: &Machine) -> Vec<f64> {
        self.ring.shapes.all(&self.x).repeat(self.ring.alike as usize)
    }
}

impl FullBlades {
    fn resting(ring: Ring) -> Self {
        let (coordinates, members) = (ring.len(), ring.shapes.count());
        Self {
            ring: Arc::new(ring),
            x: vec![0.0; coordinates],
            increments: vec![0.0; coordinates],
            seen: vec![0.0; members],
            moved: 0.0,
        }
    }

    fn coordinate_at(&self, place: usize) -> Coordinate {
        Coordinate { x: self.x[place], increment: self.increments[place] }
    }

    /// Free steps of the modes alone.
    fn leap(&mut self, steps: u64) {
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
    fn reaches(&self) -> (f64, f64) {
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
    fn fly_looking(&mut self, steps: u64, least: f64) -> f64 {
        let stride = (ANGLE_LOOK / self.ring.fastest).clamp(1.0, 1e12) as u64;
        let mut here = self.members();
        let mut most = largest(&here).max(least);
        let mut taken = 0;
        while taken < steps && self.reach() > most {
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
        self.moved = 0.0;
        if taken < steps {
            let bound = self.reach();
            self.seen.fill(bound);
            self.leap(steps - taken);
        } else {
            self.seen = here.iter().map(|at| at.x.abs()).collect();
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

/// The largest of some bounds.
fn top(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, &value| f64::max(most, value))
}

/// The largest angle.
fn largest(members: &[Coordinate]) -> f64 {
    members.iter().fold(0.0, |most, at| f64::max(most, at.x.abs()))
}
