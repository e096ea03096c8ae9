//! Every blade its own coordinate, Eqs. (2)-(3), with stiffnesses of its own where the
//! disk is mistuned (docs/theory.md, section 10).
//!
//! Coordinates are the Fourier modes of the tuned ring. A blade that is stiffer than the
//! others gets the torque of its extra spring; the damping is that of the tuned disk.

use std::sync::Arc;

use super::mistuning::springs;
use super::{TipModel, loss_of};
use crate::model::Machine;
use crate::motion::Plane;
use crate::motion::coupled::rows::RowTable;
use crate::motion::explicit::{Coordinate, Driven, NearRows, Oscillator, Ring, product};
use crate::scene::Scene;
use crate::tolerances::{ANGLE_LOOK, TIP_SLACK};

/// A ring of single blades. Without a slope of the tips a row is a side, whose blades
/// share a push evenly; with one, it is a blade.
#[derive(Clone, Debug)]
pub(in crate::motion) struct FullTips {
    fixed: Arc<Fixed>,
    /// Mode coordinates, their last increments, and those of the step before.
    x: Vec<f64>,
    increments: Vec<f64>,
    before: Vec<f64>,
    /// Torque of the excitation in the last step on the modes that feel it.
    torque: Option<(usize, [f64; 2])>,
    near: NearRows,
    /// Angles of all rows at the last look, and how far they may have turned since.
    angles: Vec<f64>,
    slack: f64,
    steps_seen: u32,
    /// Largest angle at the last look, and the largest about the mean.
    largest: [f64; 2],
}

/// What does not move.
#[derive(Debug)]
struct Fixed {
    ring: Ring,
    table: RowTable,
    /// Angle of a row per unit torque `distance` rows away.
    influence: Vec<f64>,
    /// Loss of each mode, as `loss_of`, in the order of coordinates.
    losses: Vec<f64>,
    /// Half a step of acceleration of each mode by a unit force.
    halves: Vec<f64>,
    /// Stiffness of each blade beyond that of the others \[N m/rad\]; none if tuned.
    springs: Vec<f64>,
    /// Steps between two looks at all blades, at most.
    steps_unseen: u32,
    /// Turn of a blade after which all are looked at \[rad\].
    most_slack: f64,
}

impl Fixed {
    fn new(scene: &Scene, machine: &Machine) -> Self {
        let ring = Ring::new(scene, machine, 1);
        let group = machine.polygon.blades_per_side;
        let alike = if machine.radial_coupling == 0.0 { group } else { 1 };
        let table = RowTable::new(machine, alike);
        let blades = machine.polygon.blades as usize;
        // The blades of a row are `rows` apart, and share its torque.
        let mean = |distance: usize| {
            let each = (0..alike as usize)
                .map(|k| ring.influence[(distance + k * table.count()) % blades]);
            each.sum::<f64>() / f64::from(alike)
        };
        let influence = (0..table.count()).map(mean).collect();
        let of_modes = |value: &dyn Fn(&Oscillator) -> f64| {
            let mut half: Vec<f64> = ring.oscillators.iter().map(value).collect();
            half.resize(ring.shapes.width(), 0.0);
            half.repeat(2)
        };
        let rise = (machine.radial_coupling * machine.blade_length).abs();
        let turn = ring.fastest.max(f64::MIN_POSITIVE);
        Self {
            influence,
            losses: of_modes(&loss_of),
            halves: of_modes(&super::half_step),
            springs: springs(scene),
            steps_unseen: (ANGLE_LOOK / turn).clamp(1.0, 1e9) as u32,
            most_slack: TIP_SLACK * machine.clearance().abs() / rise,
            ring,
            table,
        }
    }
}

impl TipModel for FullTips {
    fn at_rest(scene: &Scene, machine: &Machine, driven: Driven<'_>) -> Self {
        let fixed = Fixed::new(scene, machine);
        let coordinates = fixed.ring.len();
        let mut tips = Self {
            x: vec![0.0; coordinates],
            increments: vec![0.0; coordinates],
            before: vec![0.0; coordinates],
            torque: None,
            near: NearRows::default(),
            angles: vec![0.0; fixed.table.count()],
            slack: 0.0,
            // Not looked at yet.
            steps_seen: u32::MAX,
            largest: [0.0; 2],
            fixed: Arc::new(fixed),
        };
        if let Some((k, torques)) = tips.driving(driven) {
            let scale = tips.fixed.ring.shapes.scale(k);
            for (place, torque) in tips.fixed.ring.pair(k).into_iter().zip(torques) {
                tips.increments[place] -= tips.fixed.halves[place] * scale * torque;
            }
        }
        tips
    }
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self {
        let [x, increments, before] = [&self.x, &self.increments, &self.before].map(Clone::clone);
        Self { x, increments, before, ..Self::at_rest(scene, machine, None) }
    }
    fn coordinates(&self) -> usize {
        let blades = self.fixed.ring.shapes.count();
        if self.fixed.springs.is_empty() { 2 + 2 * blades } else { 2 + blades * blades }
    }
    fn table(&self) -> &RowTable {
        &self.fixed.table
    }
    fn wave(&self) -> Option<Plane> {
        None
    }
    fn predict(&mut self, driven: Driven<'_>) {
        self.torque = self.driving(driven);
        self.steps_seen = self.steps_seen.saturating_add(1);
        self.before.copy_from_slice(&self.increments);
        let Self { fixed, x, increments, .. } = self;
        let ring = &fixed.ring;
        let pulls: Vec<f64> = if fixed.springs.is_empty() {
            Vec::new()
        } else {
            let angles = ring.shapes.all(x);
            angles.iter().zip(&fixed.springs).map(|(angle, spring)| -spring * angle).collect()
        };
        let change = match self.torque {
            None => ring.step(x, increments),
            Some((k, torques)) => {
                let pair = ring.take_pair(k, x, increments);
                let rest = ring.step(x, increments);
                rest + ring.drive(k, torques, pair, x, increments)
            }
        };
        self.slack += change;
        for (blade, torque) in pulls.into_iter().enumerate() {
            self.turn(blade as u32, torque);
        }
    }
    fn angle(&mut self, row: u32) -> f64 {
        let Self { fixed, x, near, .. } = self;
        mean_of(fixed, near, row, |shapes| product(shapes, x))
    }
    fn angle_before(&mut self, row: u32) -> f64 {
        let Self { fixed, x, increments, before, near, .. } = self;
        mean_of(fixed, near, row, |shapes| {
            product(shapes, x) - product(shapes, increments) - product(shapes, before)
        })
    }
    fn compliance(&self, a: u32, b: u32) -> f64 {
        self.fixed.influence[a.abs_diff(b) as usize]
    }
    fn correct(&mut self, row: u32, torque: f64) {
        let (each, rows) = (self.fixed.table.blades_per_row, self.fixed.table.count() as u32);
        for member in 0..each {
            self.turn(row + member * rows, torque / f64::from(each));
        }
    }
    fn begin(&mut self, row: u32, torque: f64) {
        let Self { fixed, increments, near, .. } = self;
        let (each, rows) = (fixed.table.blades_per_row, fixed.table.count() as u32);
        for member in 0..each {
            let shapes = near.row(&fixed.ring.shapes, row + member * rows);
            let part = torque / f64::from(each);
            for ((increment, half), shape) in increments.iter_mut().zip(&fixed.halves).zip(shapes) {
                *increment -= half * shape * part;
            }
        }
    }
    fn bound(&mut self) -> f64 {
        self.see();
        self.largest[0] + self.slack
    }
    fn estimates(&mut self) -> (&RowTable, &[f64], f64) {
        self.see();
        (&self.fixed.table, &self.angles, self.slack)
    }
    fn largest(&mut self) -> f64 {
        self.see();
        self.largest[0]
    }
    fn swing(&mut self) -> f64 {
        self.see();
        self.largest[1]
    }
    fn energy(&self) -> f64 {
        let ring = &self.fixed.ring;
        let modes = ring.oscillators.iter().enumerate();
        let twice: f64 = modes
            .flat_map(|(k, oscillator)| ring.pair(k).map(|place| (place, oscillator)))
            .map(|(place, oscillator)| {
                let (x, increment) = (self.x[place], self.increments[place]);
                oscillator.twice_energy(Coordinate { x, increment })
            })
            .sum();
        0.5 * (twice + self.twice_in_springs())
    }
    fn flows(&self) -> [f64; 2] {
        let moved = self.increments.iter().zip(&self.before).map(|(now, before)| now + before);
        let loss = moved.zip(&self.fixed.losses).map(|(moved, loss)| loss * moved * moved).sum();
        let work = self.torque.map_or(0.0, |(k, torques)| {
            let scale = 0.5 * self.fixed.ring.shapes.scale(k);
            let pair = self.fixed.ring.pair(k).into_iter().zip(torques);
            pair.map(|(at, torque)| scale * torque * (self.increments[at] + self.before[at])).sum()
        });
        [loss, work]
    }
    fn reach(&self) -> f64 {
        if !self.fixed.springs.is_empty() {
            // The modes of the tuned ring exchange energy.
            return f64::INFINITY;
        }
        let ring = &self.fixed.ring;
        let of = |k: usize| {
            let at = |place| Coordinate { x: self.x[place], increment: self.increments[place] };
            ring.shapes.scale(k) * ring.oscillators[k].reach_of(ring.pair(k).map(at)).0
        };
        (0..ring.oscillators.len()).map(of).sum()
    }
    fn modal(&self) -> ([f64; 2], [f64; 2]) {
        let shown = self.fixed.ring.shown();
        let mean = |place: usize| 0.5 * (self.increments[place] + self.before[place]);
        (
            shown.map(|(_, place, factor)| factor * self.x[place]),
            shown.map(|(_, place, factor)| factor * mean(place)),
        )
    }
    fn every_angle(&self) -> Vec<f64> {
        self.fixed.ring.shapes.all(&self.x)
    }
}

/// The mean over the blades of a row.
fn mean_of(fixed: &Fixed, near: &mut NearRows, row: u32, value: impl Fn(&[f64]) -> f64) -> f64 {
    let (each, rows) = (fixed.table.blades_per_row, fixed.table.count() as u32);
    if each == 1 {
        return value(near.row(&fixed.ring.shapes, row));
    }
    let sum: f64 =
        (0..each).map(|member| value(near.row(&fixed.ring.shapes, row + member * rows))).sum();
    sum / f64::from(each)
}

impl FullTips {
    fn driving(&self, driven: Driven<'_>) -> Option<(usize, [f64; 2])> {
        let (excitation, phase) = driven?;
        let k = self.fixed.ring.driven(excitation);
        Some((k, excitation.torque_on(k as u32, phase)))
    }

    /// Corrects the step by a torque on one blade (from 0).
    fn turn(&mut self, blade: u32, torque: f64) {
        let Self { fixed, x, increments, near, .. } = self;
        fixed.ring.correct(near.row(&fixed.ring.shapes, blade), torque, x, increments);
        self.slack += fixed.ring.influence[0] * torque.abs();
    }

    /// Looks at all blades, if they may have turned too far since the last look.
    fn see(&mut self) {
        let fixed = &self.fixed;
        if self.slack <= fixed.most_slack && self.steps_seen < fixed.steps_unseen {
            return;
        }
        let angles = fixed.ring.shapes.all(&self.x);
        let mean = angles.iter().sum::<f64>() / angles.len() as f64;
        let most = |about: f64| {
            let size = |angle: &f64| (angle - about).abs();
            angles.iter().map(size).fold(0.0, |most, at| if at <= most { most } else { at })
        };
        self.largest = [most(0.0), most(mean)];
        let rows = fixed.table.count();
        for (row, angle) in self.angles.iter_mut().enumerate() {
            let blades = angles.iter().skip(row).step_by(rows);
            *angle = blades.sum::<f64>() / f64::from(fixed.table.blades_per_row);
        }
        (self.slack, self.steps_seen) = (0.0, 0);
    }

    /// Twice the energy in the extra springs between the last two steps \[J\].
    fn twice_in_springs(&self) -> f64 {
        if self.fixed.springs.is_empty() {
            return 0.0;
        }
        let shapes = &self.fixed.ring.shapes;
        let (now, moved) = (shapes.all(&self.x), shapes.all(&self.increments));
        let each = self.fixed.springs.iter().zip(now.iter().zip(&moved));
        each.map(|(spring, (x, increment))| spring * x * (x - increment)).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Solver;
    use crate::motion::coupled::Coupled;

    /// Single blades on a lining that all press; MODEL: a pulse of 100 N at 410 rad/s.
    fn pressed(step: f64) -> Scene {
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
            let mut blades = FullTips::at_rest(&scene, &scene.machine(), None);
            let fixed = Arc::get_mut(&mut blades.fixed).unwrap();
            fixed.springs = vec![0.0; 22];
            fixed.springs[0] = 0.05 * scene.bladed_disk.stiffness_nm_per_rad;
            let mut motion = Coupled::with_blades(&scene.checked().unwrap(), blades);
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
            let pushed = |motion: &Coupled<FullTips>| motion.multipliers().len();
            let mut motion = Coupled::<FullTips>::new(&scene.checked().unwrap());
            assert_eq!(pushed(&motion), 22, "{kappa}");
            motion.advance(1e-6).unwrap();
            assert_eq!(pushed(&motion), 22, "{kappa}");
        }
    }

    #[test]
    fn angles_are_never_beyond_their_estimates() {
        let scene = pressed(1e-5);
        let mut blades = FullTips::at_rest(&scene, &scene.machine(), None);
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
        let mut blades = FullTips::at_rest(&scene, &scene.machine(), None);
        for step in 0..100_u32 {
            blades.predict(None);
            blades.correct(step % 22, -0.3);
        }
        for steps in 0..2 {
            let mut changed = blades.with_parameters(&scene, &scene.machine());
            (0..steps).for_each(|_| changed.predict(None));
            let most = changed.every_angle().iter().fold(0.0_f64, |most, x| most.max(x.abs()));
            assert!(most > 0.0 && most <= changed.bound() * (1.0 + 1e-9), "{steps}: {most}");
        }
    }
}
