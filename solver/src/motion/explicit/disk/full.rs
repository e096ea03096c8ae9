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
use crate::model::Machine;
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
    fn at_rest(scene: &Scene, machine: &Machine, _: Driven<'_>) -> Self {
        Self::resting(scene, machine, Ring::alike(scene, machine))
    }
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self {
        Self {
            x: self.x.clone(),
            increments: self.increments.clone(),
            before: self.before.clone(),
            ..Self::at_rest(scene, machine, None)
        }
    }
    fn coordinates(&self) -> usize {
        let members = self.ring.shapes.count();
        2 + if self.rows.springs.is_empty() { members } else { 8 * members }
    }
    fn table(&self) -> &RowTable {
        &self.rows.table
    }
    fn predict(&mut self, _: Driven<'_>) -> f64 {
        let pulled = self.pull();
        self.seen.steps = self.seen.steps.saturating_add(1);
        if !self.before.is_empty() {
            self.before.copy_from_slice(&self.increments);
        }
        let mut change = self.ring.step(&mut self.x, &mut self.increments);
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
    fn amplitudes(&mut self, rows: &mut Columns) -> [f64; 2] {
        if self.are_many(rows) {
            self.see_all();
        }
        let Self { ring, seen, x, .. } = &*self;
        rows.put_angles(|row| {
            self.mean(row, |member| match seen.are_of_now() {
                true => seen.angles[member],
                false => ring.shapes.at(member, x),
            })
        });
        [1.0, 0.0]
    }
    fn push(&mut self, rows: &Columns, _: [f64; 2]) -> f64 {
        if self.are_many(rows) {
            self.put(rows.each(|four| four.torque));
            return self.turn_all();
        }
        let mut change = 0.0;
        for (row, _, torque) in rows.each(|four| four.torque).filter(|(.., torque)| *torque != 0.0)
        {
            self.correct(row, torque);
            change += self.compliance(row, row) * torque.abs();
        }
        change
    }
    fn swept(&mut self, rows: &Columns) -> f64 {
        self.put(rows.each(|four| four.push));
        let Self { ring, increments, before, room, .. } = self;
        let (mut swept, moved) = (0.0, |place: usize| 0.5 * (increments[place] + before[place]));
        ring.shapes.feel(room, |k, felt| {
            let pair = ring.pair(k).into_iter().zip(felt);
            swept += pair.map(|(place, felt)| felt * moved(place)).sum::<f64>();
        });
        swept
    }
    fn begin(&mut self, rows: &Columns, _: [f64; 2]) {
        self.put(rows.each(|four| four.torque));
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
    fn shortest_block(&self) -> u64 {
        (self.ring.shapes.count() as u64).clamp(SHORTEST_BLOCK, SHORTEST_BLOCK_OF_BLADES)
    }
    fn peak(&self, steps: u64, least: f64) -> f64 {
        if self.reach() <= least { least } else { self.clone().fly_looking(steps, least) }
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
        [loss, 0.0]
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

    /// Corrects the step by a torque on one member (from 0); a bound on what it turns.
    fn turn(&mut self, member: u32, torque: f64) -> f64 {
        let Self { ring, x, increments, .. } = self;
        ring.shapes.with_row(member as usize, |row| ring.correct(row, torque, x, increments));
        let change = ring.influence[0] * torque.abs();
        self.seen.slack += change;
        change
    }

    /// Returns twice the energy in the extra springs between the last two steps \[J\].
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
    use crate::motion::explicit::Explicit;

    /// Blades of the paper, `count` of them.
    pub(in crate::motion) fn scene(count: u32) -> Scene {
        let mut scene = Scene::base();
        scene.bladed_disk.blades = count;
        scene.solver.step_s = 1e-4;
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
        for count in [5, 22, 131] {
            let mut blades = at_rest(&scene(count));
            blades.correct(1, 3.0);
            blades.correct(3, -2.0);
            let ring = blades.ring.clone();
            for _ in 0..100 {
                let before = blades.clone();
                let change = blades.predict(None);
                for (k, oscillator) in ring.oscillators.iter().enumerate() {
                    for place in ring.pair(k) {
                        let next = oscillator.step(before.coordinate_at(place), 0.0);
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
            let mut blades = at_rest(&scene(count));
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
        for (blades, diameters, alike) in [(66, 3, 3), (88, 4, 4), (22, 0, 22), (22, 11, 11)] {
            let mut scene = scene(blades);
            scene.operation.nodal_diameters = diameters;
            let machine = scene.machine();
            let mut one = at_rest(&scene);
            assert_eq!(one.ring.alike, alike, "{blades} {diameters}");
            // Each on its own, and the same torque on all of a member.
            let mut each = FullBlades::resting(&scene, &machine, 1);
            for step in 0..200 {
                one.predict(None);
                each.predict(None);
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
            let mut motion = Explicit::<FullBlades>::new(&scene.checked().unwrap());
            motion.blades = blades;
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
