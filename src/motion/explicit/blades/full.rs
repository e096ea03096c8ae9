//! Every blade its own coordinate (docs/theory.md, section 1).

use std::sync::Arc;

use super::BladeModel;
use super::angle_bounds::AngleBounds;
use super::near::NearRows;
use super::ring::Ring;
use super::shapes::product;
use crate::model::{Machine, gcd};
use crate::motion::explicit::{Coordinate, Driven};
use crate::scene::Scene;
use crate::tolerances::{SHORTEST_BLOCK, SHORTEST_BLOCK_OF_BLADES};

/// Every blade its own coordinate, Eqs. (2)-(3), carried in the Fourier modes
/// of the circulant matrices, where they are uncoupled. A row is a blade, or
/// all the blades that nothing tells apart; see `Ring`.
#[derive(Clone, Debug)]
pub struct FullBlades {
    pub(super) ring: Arc<Ring>,
    /// Mode coordinates, and their last increments.
    pub(super) x: Vec<f64>,
    pub(super) increments: Vec<f64>,
    near: NearRows,
    pub(super) bounds: AngleBounds,
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
        new.bounds.reset(f64::INFINITY);
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
    fn predict(&mut self, excitation: Driven<'_>) -> f64 {
        let Self { ring, x, increments, .. } = self;
        let driven = excitation.map(|(torque, _)| ring.driven(torque));
        self.bounds.drive(driven);
        let Some(((torque, phase), k)) = excitation.zip(driven) else {
            let change = ring.step(x, increments);
            self.bounds.turn(change);
            return change;
        };
        let before = ring.take_pair(k, x, increments);
        let rest = ring.step(x, increments);
        self.bounds.turn(rest);
        rest + ring.drive(k, torque.torque_on(k as u32 * ring.alike, phase), before, x, increments)
    }
    fn angle(&mut self, row: u32) -> f64 {
        product(self.near.row(&self.ring.shapes, row), &self.x)
    }
    fn compliance(&self, a: u32, b: u32) -> f64 {
        self.ring.influence[a.abs_diff(b) as usize]
    }
    fn correct(&mut self, row: u32, torque: f64) {
        let Self { ring, x, increments, near, .. } = self;
        ring.correct(near.row(&ring.shapes, row), torque, x, increments);
        self.bounds.turn(ring.influence[0] * torque.abs());
    }
    fn skip(&mut self, steps: u64) {
        self.leap(steps);
        self.bounds.reset(f64::INFINITY);
    }
    fn shortest_block(&self) -> u64 {
        (self.ring.shapes.count() as u64).clamp(SHORTEST_BLOCK, SHORTEST_BLOCK_OF_BLADES)
    }
    fn look(&mut self, largest: f64) -> (f64, f64) {
        self.bounds.look(&self.ring, &mut self.near, &self.x, largest)
    }
    fn reach(&self) -> f64 {
        self.reaches().0
    }
    fn peak(&self, steps: u64, least: f64) -> f64 {
        self.clone().fly(steps, least).0
    }
    fn fly(&mut self, steps: u64, least: f64) -> (f64, f64) {
        self.bounds.drive(None);
        let (farthest, longest) = self.reaches();
        let turned = longest * steps as f64;
        let bound = farthest.min(self.bounds.largest() + turned);
        if bound <= least {
            self.leap(steps);
            self.bounds.turn(turned);
            return (least, bound);
        }
        let most = self.fly_looking(steps, least);
        (most, self.bounds.largest())
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
            near: NearRows::default(),
            bounds: AngleBounds::at_rest(members),
        }
    }

    pub(super) fn coordinate_at(&self, place: usize) -> Coordinate {
        Coordinate { x: self.x[place], increment: self.increments[place] }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::explicit::EngineOrderTorque;
    use crate::motion::explicit::watch::Watch;

    /// Blades of the paper, `count` of them, excited by an order or not.
    fn scene(count: u32, order: Option<u32>) -> Scene {
        let mut scene = Scene::base();
        scene.bladed_disk.blades = count;
        scene.solver.step_s = 1e-4;
        if let Some(order) = order {
            (scene.excitation.amplitude_nm, scene.excitation.order) = (0.3, order);
        }
        scene
    }

    fn at_rest(scene: &Scene) -> FullBlades {
        FullBlades::at_rest(scene, &scene.machine())
    }

    fn angles(blades: &FullBlades) -> Vec<f64> {
        let shapes = &blades.ring.shapes;
        (0..shapes.count()).map(|member| shapes.at(member, &blades.x)).collect()
    }

    fn widest(blades: &FullBlades) -> f64 {
        angles(blades).iter().fold(0.0, |most, angle| f64::max(most, angle.abs()))
    }

    #[test]
    fn a_step_is_that_of_one_oscillator_for_each_mode() {
        for (count, order) in [(22, None), (22, Some(5)), (131, Some(19)), (5, Some(0))] {
            let scene = scene(count, order);
            let torque = EngineOrderTorque::of(&scene);
            let mut blades = at_rest(&scene);
            blades.correct(1, 3.0);
            blades.correct(3, -2.0);
            let ring = blades.ring.clone();
            for step in 0..100 {
                let (phase, before) = (0.05 * f64::from(step), blades.clone());
                let change = blades.predict(torque.as_ref().map(|torque| (torque, phase)));
                for (k, oscillator) in ring.oscillators.iter().enumerate() {
                    let force = torque.map_or([0.0; 2], |torque| torque.torque_on(k as u32, phase));
                    for (place, force) in ring.pair(k).into_iter().zip(force) {
                        let force = ring.shapes.scale(k) * force;
                        let next = oscillator.step(before.coordinate_at(place), force);
                        assert_eq!(blades.coordinate_at(place), next, "{count} {k}");
                    }
                }
                for (a, b) in angles(&blades).iter().zip(angles(&before)) {
                    assert!((a - b).abs() <= change * (1.0 + 1e-12), "{count}: {change}");
                }
            }
        }
    }

    #[test]
    fn a_push_turns_every_blade_by_its_compliance() {
        for count in [1, 2, 4, 22, 140] {
            let scene = scene(count, None);
            let mut blades = at_rest(&scene);
            let pushed = count / 2;
            blades.correct(pushed, 2.0);
            let own = blades.compliance(pushed, pushed);
            for blade in 0..count {
                let expected = 2.0 * blades.compliance(blade, pushed);
                assert!((blades.angle(blade) - expected).abs() < 1e-14 * own, "{count} {blade}");
                assert!(expected <= 2.0 * own);
            }
        }
    }

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
    fn blades_that_nothing_tells_apart_are_one() {
        for (blades, diameters, order, alike) in [
            (66, 3, None, 3),
            (66, 3, Some(5), 1),
            (66, 3, Some(63), 3),
            (88, 4, Some(6), 2),
            (22, 0, None, 22),
            (22, 11, Some(0), 11),
        ] {
            let mut scene = scene(blades, order);
            scene.operation.nodal_diameters = diameters;
            let machine = scene.machine();
            let one = at_rest(&scene);
            assert_eq!(one.ring.alike, alike, "{blades} {diameters} {order:?}");
            // Each on its own, and the same torque on all of a member.
            let mut each = FullBlades::resting(Ring::new(&scene, &machine, 1));
            let mut one = one;
            let torque = EngineOrderTorque::of(&scene);
            for step in 0..200 {
                let excitation = torque.as_ref().map(|torque| (torque, 0.05 * f64::from(step)));
                one.predict(excitation);
                each.predict(excitation);
                let side = step as u32 % machine.polygon.sides;
                for place in 0..one.rows_of_side(side) {
                    one.correct(one.row(side, place), 1.0);
                }
                for place in 0..each.rows_of_side(side) {
                    each.correct(each.row(side, place), 1.0 / f64::from(alike));
                }
            }
            let (a, b) = (one.every_angle(&machine), each.every_angle(&machine));
            let size = widest(&each);
            for (a, b) in a.iter().zip(&b) {
                assert!((a - b).abs() < 1e-12 * size, "{blades} {diameters}: {a} {b}");
            }
            let ((a, b), (c, d)) = (one.modal(), each.modal());
            for (found, expected) in a.into_iter().chain(b).zip(c.into_iter().chain(d)) {
                assert!((found - expected).abs() < 1e-12 * size * 1e3, "{found} {expected}");
            }
            // Told apart from now on, they go on from where they are.
            scene.excitation.amplitude_nm = 0.3;
            scene.excitation.order = 1;
            let apart = one.with_parameters(&scene, &machine);
            assert_eq!(apart.ring.alike, 1);
            for (a, b) in apart.every_angle(&machine).iter().zip(one.every_angle(&machine)) {
                assert!((a - b).abs() < 1e-13 * size, "{blades} {diameters}: {a} {b}");
            }
            scene.excitation.amplitude_nm = 0.0;
            assert_eq!(apart.with_parameters(&scene, &machine).ring.alike, 1);
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
