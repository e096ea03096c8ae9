//! Every blade its own coordinate, Eqs. (2)-(3), with stiffnesses of its own where the
//! disk is mistuned (docs/theory.md, sections 1 and 10).
//!
//! Coordinates are the Fourier modes of the tuned ring, in which its circulant matrices
//! are diagonal. A blade that is stiffer than the others gets the torque of its extra
//! spring; the damping is that of the tuned disk.

use std::sync::Arc;

use super::full_at_once::Seen;
use super::ring::{Ring, springs};
use super::shapes::Room;
use super::{Columns, Disk, RowTable};
use crate::model::{Machine, gcd};
use crate::motion::Plane;
use crate::motion::explicit::{Coordinate, Driven, Oscillator};
use crate::scene::Scene;
use crate::tolerances::{ANGLE_LOOK, SHORTEST_BLOCK, SHORTEST_BLOCK_OF_BLADES, TIP_SLACK};

/// A ring of blades. A row is a blade, or all the blades that nothing tells apart, see
/// `Ring`; beyond the paper and without a slope of the tips it is a side, whose blades
/// share a push evenly.
#[derive(Clone, Debug)]
pub struct FullBlades {
    pub(super) ring: Arc<Ring>,
    pub(super) rows: Arc<Rows>,
    /// Mode coordinates, and their last increments.
    pub(super) x: Vec<f64>,
    pub(super) increments: Vec<f64>,
    /// Increments of the step before, which only motions beyond the paper ask for.
    before: Vec<f64>,
    /// The diameters that the excitation drove in the last step, and its torques \[N m\].
    torque: Option<(usize, [f64; 2])>,
    pub(super) room: Room,
    pub(super) seen: Seen,
}

/// What does not move.
#[derive(Debug)]
pub(super) struct Rows {
    pub table: RowTable,
    /// Members of the ring in a row.
    pub members: u32,
    /// Angle of a row per unit torque `distance` rows away.
    influence: Vec<f64>,
    /// Largest angle of a blade by unit torques on all of them, of either sign.
    pub most_turned: f64,
    /// `Oscillator::lost` of each coordinate.
    losses: Vec<f64>,
    /// Stiffness of each blade beyond that of the others \[N m/rad\]; none if tuned.
    pub springs: Vec<f64>,
    /// Steps between two looks at all blades, at most.
    pub steps_unseen: u32,
    /// Turn of a blade after which all are looked at \[rad\].
    pub most_slack: f64,
}

impl Rows {
    fn new(scene: &Scene, machine: &Machine, ring: &Ring) -> Self {
        let alone = machine.radial_coupling != 0.0 || machine.is_uneven();
        let by_side = scene.goes_beyond() && !alone;
        let alike = if by_side { machine.polygon.blades_per_side } else { ring.alike };
        let table = RowTable::new(machine, alike);
        let members = alike / ring.alike;
        // The members of a row are `rows` apart, and share its torque.
        let mean = |distance: usize| {
            let each = (0..members as usize)
                .map(|k| ring.influence[(distance + k * table.count()) % ring.influence.len()]);
            each.sum::<f64>() / f64::from(members)
        };
        let influence = (0..table.count()).map(mean).collect();
        let mut losses: Vec<f64> = ring.oscillators.iter().map(Oscillator::lost).collect();
        losses.resize(ring.shapes.width(), 0.0);
        let rise = (machine.radial_coupling * machine.blade_length).abs();
        let turn = ring.fastest.max(f64::MIN_POSITIVE);
        Self {
            table,
            members,
            influence,
            most_turned: ring.influence.iter().map(|angle| angle.abs()).sum(),
            losses: losses.repeat(2),
            springs: springs(scene),
            steps_unseen: (ANGLE_LOOK / turn).clamp(1.0, 1e9) as u32,
            most_slack: TIP_SLACK * machine.clearance().abs() / rise,
        }
    }
}

impl Disk for FullBlades {
    fn at_rest(scene: &Scene, machine: &Machine, driven: Driven<'_>) -> Self {
        let alike = Ring::most_alike(scene, machine);
        let mut blades = Self::resting(scene, machine, alike);
        if let Some((k, torques)) = blades.driving(driven) {
            let scale = blades.ring.shapes.scale(k);
            for (place, torque) in blades.ring.pair(k).into_iter().zip(torques) {
                let begun =
                    blades.ring.oscillators[k].begin(blades.coordinate_at(place), scale * torque);
                blades.increments[place] = begun.increment;
            }
        }
        blades
    }
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self {
        let old = &*self.ring;
        // What was excited apart stays so.
        let alike = gcd(old.alike, Ring::most_alike(scene, machine));
        let mut new = Self::resting(scene, machine, alike);
        let finer = (old.alike / alike) as usize;
        for k in 0..old.oscillators.len() {
            let factor = old.shapes.scale(k) / new.ring.shapes.scale(k * finer);
            for (from, to) in old.pair(k).into_iter().zip(new.ring.pair(k * finer)) {
                new.x[to] = factor * self.x[from];
                new.increments[to] = factor * self.increments[from];
                if let Some(before) = new.before.get_mut(to) {
                    *before = factor * self.before[from];
                }
            }
        }
        new
    }
    fn coordinates(&self) -> usize {
        let members = self.ring.shapes.count();
        2 + if self.rows.springs.is_empty() { members } else { 8 * members }
    }
    fn table(&self) -> &RowTable {
        &self.rows.table
    }
    fn predict(&mut self, driven: Driven<'_>) -> f64 {
        self.torque = self.driving(driven);
        let pulled = self.pull();
        self.seen.steps = self.seen.steps.saturating_add(1);
        if !self.before.is_empty() {
            self.before.copy_from_slice(&self.increments);
        }
        let driven = self.torque.map(|(k, torques)| {
            let before = self.ring.pair(k).map(|place| self.coordinate_at(place));
            (k, torques, before)
        });
        let Self { ring, x, increments, .. } = self;
        let mut change = ring.step(x, increments);
        if let Some((k, torques, before)) = driven {
            change += ring.drive(k, torques, before, x, increments);
        }
        self.seen.slack += change;
        if pulled {
            change += self.turn_all();
        }
        change
    }
    fn angle(&mut self, row: u32) -> f64 {
        self.mean(row, |member| self.ring.shapes.at(member, &self.x))
    }
    fn angle_before(&mut self, row: u32) -> f64 {
        self.mean(row, |member| {
            let at = |values: &[f64]| self.ring.shapes.at(member, values);
            at(&self.x) - at(&self.increments) - at(&self.before)
        })
    }
    fn compliance(&self, a: u32, b: u32) -> f64 {
        self.rows.influence[a.abs_diff(b) as usize]
    }
    #[inline]
    fn correct(&mut self, row: u32, torque: f64) {
        let (members, rows) = (self.rows.members, self.rows.table.count() as u32);
        for member in 0..members {
            self.turn(row + member * rows, torque / f64::from(members));
        }
    }
    fn stiffen(&mut self, added: f64) -> f64 {
        let before = self.energy();
        Arc::make_mut(&mut self.ring).stiffen(added);
        self.energy() - before
    }
    fn shrink(&mut self, part: f64) {
        self.x.iter_mut().for_each(|x| *x *= part);
        self.seen.forget();
    }
    fn angles(&mut self, rows: &mut Columns) {
        if self.are_many(rows) {
            self.see_all();
        }
        let Self { ring, seen, x, .. } = &*self;
        for (angle, row) in rows.angle.iter_mut().zip(&rows.index) {
            *angle = self.mean(*row, |member| match seen.are_of_now() {
                true => seen.angles[member],
                false => ring.shapes.at(member, x),
            });
        }
    }
    fn push(&mut self, rows: &Columns, _: [f64; 2]) -> f64 {
        if self.are_many(rows) {
            self.put(rows.each(&rows.torque));
            return self.turn_all();
        }
        let mut change = 0.0;
        for (row, _, torque) in rows.each(&rows.torque) {
            if torque != 0.0 {
                self.correct(row, torque);
                change += self.compliance(row, row) * torque.abs();
            }
        }
        change
    }
    fn swept(&mut self, rows: &Columns) -> f64 {
        self.put(rows.each(&rows.push));
        let Self { ring, increments, before, room, .. } = self;
        let (mut swept, moved) = (0.0, |place: usize| 0.5 * (increments[place] + before[place]));
        ring.shapes.feel(room, |k, felt| {
            let pair = ring.pair(k).into_iter().zip(felt);
            swept += pair.map(|(place, felt)| felt * moved(place)).sum::<f64>();
        });
        swept
    }
    fn begin(&mut self, rows: &Columns, _: [f64; 2]) {
        self.put(rows.each(&rows.torque));
        let Self { ring, x, increments, room, .. } = self;
        ring.shapes.feel(room, |k, felt| {
            for (place, felt) in ring.pair(k).into_iter().zip(felt) {
                let at = Coordinate { x: x[place], increment: increments[place] };
                increments[place] = ring.oscillators[k].begin(at, felt).increment;
            }
        });
    }
    fn modal(&self) -> [f64; 2] {
        self.ring.shown().map(|(_, place, factor)| factor * self.x[place])
    }
    fn modal_rates(&self, ahead: &Self, step: f64) -> [f64; 2] {
        self.ring.shown().map(|(_, place, factor)| {
            factor * ((self.increments[place] + ahead.increments[place]) / (2.0 * step))
        })
    }
    fn every_angle(&self) -> Vec<f64> {
        self.ring.shapes.all(&self.x).repeat(self.ring.alike as usize)
    }
    fn look(&mut self, largest: f64) -> (f64, f64) {
        if self.seen.are_of_now() {
            let now = self.seen.largest[0];
            return (now, now);
        }
        self.look_at_largest(largest)
    }
    fn reach(&self) -> f64 {
        if !self.rows.springs.is_empty() {
            // With springs of their own the modes of the tuned ring exchange energy.
            return f64::INFINITY;
        }
        // Of modes that all add up, or of the norm, which a blade's angle does not exceed as
        // shapes are orthonormal.
        let (mut sum, mut square) = (0.0, 0.0);
        for (k, oscillator) in self.ring.oscillators.iter().enumerate() {
            let x = oscillator.reach_of(self.ring.pair(k).map(|place| self.coordinate_at(place))).0;
            sum += self.ring.shapes.scale(k) * x;
            square += x * x;
        }
        f64::min(sum, square.sqrt())
    }
    fn can_fly(&self, steps: u64, largest: f64) -> bool {
        // No angle on the way needs a look.
        let least =
            (self.ring.shapes.count() as u64).clamp(SHORTEST_BLOCK, SHORTEST_BLOCK_OF_BLADES);
        steps >= least && self.reach() <= largest
    }
    fn peak(&self, _: u64, least: f64) -> f64 {
        least
    }
    fn skip(&mut self, steps: u64) {
        for (k, oscillator) in self.ring.oscillators.iter().enumerate() {
            for place in self.ring.pair(k) {
                let ahead = oscillator.skip(self.coordinate_at(place), steps);
                (self.x[place], self.increments[place]) = (ahead.x, ahead.increment);
            }
        }
        self.seen.forget();
    }
    fn bound(&mut self) -> f64 {
        self.see();
        self.seen.largest[0] + self.seen.slack
    }
    fn wave(&self) -> Option<Plane> {
        None
    }
    fn estimates(&mut self) -> (&RowTable, &[f64], f64) {
        self.see();
        (&self.rows.table, &self.seen.angles, self.seen.slack)
    }
    fn swing(&mut self) -> f64 {
        self.see();
        self.seen.largest[1]
    }
    fn energy(&self) -> f64 {
        let modes = self.ring.oscillators.iter().enumerate();
        let twice: f64 = modes
            .flat_map(|(k, oscillator)| self.ring.pair(k).map(|place| (place, oscillator)))
            .map(|(place, oscillator)| oscillator.twice_energy(self.coordinate_at(place)))
            .sum();
        0.5 * (twice + self.twice_in_springs())
    }
    fn flows(&self) -> [f64; 2] {
        let moved = self.increments.iter().zip(&self.before).map(|(now, before)| now + before);
        let loss = moved.zip(&self.rows.losses).map(|(moved, loss)| loss * moved * moved).sum();
        let work = self.torque.map_or(0.0, |(k, torques)| {
            let scale = 0.5 * self.ring.shapes.scale(k);
            let pair = self.ring.pair(k).into_iter().zip(torques);
            pair.map(|(at, torque)| scale * torque * (self.increments[at] + self.before[at])).sum()
        });
        [loss, work]
    }
}

impl FullBlades {
    /// Blades at rest, `alike` of them one member.
    fn resting(scene: &Scene, machine: &Machine, alike: u32) -> Self {
        let ring = Ring::new(scene, machine, alike);
        let rows = Rows::new(scene, machine, &ring);
        let (coordinates, members) = (ring.len(), ring.shapes.count());
        Self {
            x: vec![0.0; coordinates],
            increments: vec![0.0; coordinates],
            before: vec![0.0; if scene.goes_beyond() { coordinates } else { 0 }],
            torque: None,
            room: ring.shapes.room(),
            seen: Seen::nothing(members),
            ring: Arc::new(ring),
            rows: Arc::new(rows),
        }
    }

    pub(super) fn coordinate_at(&self, place: usize) -> Coordinate {
        Coordinate { x: self.x[place], increment: self.increments[place] }
    }

    /// Returns the mean over the members of a row.
    fn mean(&self, row: u32, value: impl Fn(usize) -> f64) -> f64 {
        let rows = self.rows.table.count();
        let members = self.rows.members as usize;
        (0..members).map(|member| value(row as usize + member * rows)).sum::<f64>() / members as f64
    }

    /// The diameters that an excitation drives, in those of the ring, and its torques.
    fn driving(&self, driven: Driven<'_>) -> Option<(usize, [f64; 2])> {
        let (excitation, phase) = driven?;
        let k = self.ring.driven(excitation);
        Some((k, excitation.torque_on(k as u32 * self.ring.alike, phase)))
    }

    /// Corrects the step by a torque on one member (from 0); a bound on what it turns.
    fn turn(&mut self, member: u32, torque: f64) -> f64 {
        let Self { ring, x, increments, .. } = self;
        ring.shapes.with_row(member as usize, |row| ring.correct(row, torque, x, increments));
        let change = ring.influence[0] * torque.abs();
        self.seen.slack += change;
        change
    }

    /// Twice the energy in the extra springs between the last two steps \[J\].
    fn twice_in_springs(&self) -> f64 {
        if self.rows.springs.is_empty() {
            return 0.0;
        }
        let shapes = &self.ring.shapes;
        let (now, moved) = (shapes.all(&self.x), shapes.all(&self.increments));
        let each = self.rows.springs.iter().zip(now.iter().zip(&moved));
        each.map(|(spring, (x, increment))| spring * x * (x - increment)).sum()
    }
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;
    use crate::motion::Solver;
    use crate::motion::explicit::{EngineOrderTorque, Explicit};

    /// Blades of the paper, `count` of them, excited by an order or not.
    pub(in crate::motion) fn scene(count: u32, order: Option<u32>) -> Scene {
        let mut scene = Scene::base();
        scene.bladed_disk.blades = count;
        scene.solver.step_s = 1e-4;
        if let Some(order) = order {
            (scene.excitation.amplitude_nm, scene.excitation.order) = (0.3, order);
        }
        scene
    }

    pub(in crate::motion) fn at_rest(scene: &Scene) -> FullBlades {
        FullBlades::at_rest(scene, &scene.machine(), None)
    }

    pub(in crate::motion) fn angles(blades: &FullBlades) -> Vec<f64> {
        let shapes = &blades.ring.shapes;
        (0..shapes.count()).map(|member| shapes.at(member, &blades.x)).collect()
    }

    pub(in crate::motion) fn widest(blades: &FullBlades) -> f64 {
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
            let mut each = FullBlades::resting(&scene, &machine, 1);
            let mut one = one;
            let torque = EngineOrderTorque::of(&scene);
            for step in 0..200 {
                let excitation = torque.as_ref().map(|torque| (torque, 0.05 * f64::from(step)));
                one.predict(excitation);
                each.predict(excitation);
                let side = step as u32 % machine.polygon.sides;
                for row in one.table().of_side(side).to_vec() {
                    one.correct(row, 1.0);
                }
                for row in each.table().of_side(side).to_vec() {
                    each.correct(row, 1.0 / f64::from(alike));
                }
            }
            let (a, b) = (one.every_angle(), each.every_angle());
            let size = widest(&each);
            for (a, b) in a.iter().zip(&b) {
                assert!((a - b).abs() < 1e-12 * size, "{blades} {diameters}: {a} {b}");
            }
            let (mut ahead, mut each_ahead) = (one.clone(), each.clone());
            ahead.predict(None);
            each_ahead.predict(None);
            let rates = [one.modal_rates(&ahead, 1e-4), each.modal_rates(&each_ahead, 1e-4)];
            let [a, b] = [(one.modal(), rates[0]), (each.modal(), rates[1])]
                .map(|(at, rates)| at.into_iter().chain(rates));
            for (found, expected) in a.zip(b) {
                assert!((found - expected).abs() < 1e-12 * size * 1e3, "{found} {expected}");
            }
            // Told apart from now on, they go on from where they are.
            scene.excitation.amplitude_nm = 0.3;
            scene.excitation.order = 1;
            let apart = one.with_parameters(&scene, &machine);
            assert_eq!(apart.ring.alike, 1);
            for (a, b) in apart.every_angle().iter().zip(one.every_angle()) {
                assert!((a - b).abs() < 1e-13 * size, "{blades} {diameters}: {a} {b}");
            }
            scene.excitation.amplitude_nm = 0.0;
            assert_eq!(apart.with_parameters(&scene, &machine).ring.alike, 1);
        }
    }

    /// Single blades on a lining that all press, after a pulse of 100 N at 410 rad/s.
    pub(in crate::motion) fn pressed(step: f64) -> Scene {
        let mut scene = Scene::base();
        for (key, value) in [("solver.contact", "smooth"), ("solver.model", "full")] {
            scene.set(key, value).unwrap();
        }
        scene.casing.radius_m = 0.49988;
        scene.contact.stiffness_n_per_m = 27e3;
        scene.bladed_disk.radial_coupling = 0.5;
        (scene.operation.pulse_n, scene.operation.speed_rad_s) = (100.0, 410.0);
        (scene.solver.step_s, scene.solver.end_s) = (step, 0.05);
        scene
    }

    #[test]
    fn one_stiffer_blade_changes_the_motion_as_another_program_says() {
        let at = [2e-6, 1e-6].map(|step| {
            let scene = pressed(step);
            let mut blades = FullBlades::at_rest(&scene, &scene.machine(), None);
            let rows = Arc::get_mut(&mut blades.rows).unwrap();
            rows.springs = vec![0.0; 22];
            rows.springs[0] = 0.05 * scene.bladed_disk.stiffness_nm_per_rad;
            let mut motion = Explicit::with_blades(&scene.checked().unwrap(), |_, _| blades);
            motion.advance(0.05).unwrap();
            motion.state().u
        });
        for (k, expected) in [(0, -2.448_242_835e-7), (1, 4.258_978_112e-7)] {
            let found = (4.0 * at[1][k] - at[0][k]) / 3.0;
            assert!((found - expected).abs() < 1e-14, "{found:e}");
        }
    }

    #[test]
    fn all_blades_press_from_the_first_step_on() {
        for kappa in [0.0, 0.5] {
            let mut scene = pressed(1e-6);
            scene.bladed_disk.radial_coupling = kappa;
            let pushed = |motion: &Explicit<FullBlades>| motion.multipliers().len();
            let mut motion = Explicit::<FullBlades>::new(&scene.checked().unwrap());
            assert_eq!(pushed(&motion), 22, "{kappa}");
            motion.advance(1e-6).unwrap();
            assert_eq!(pushed(&motion), 22, "{kappa}");
        }
    }
}
