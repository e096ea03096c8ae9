//! Three sizes of the bladed disk for the explicit solver: rigid blades, the
//! two modes of the paper, or every blade its own coordinate.
//!
//! To contact they all look alike: *rows*, each a constraint with a blade
//! angle, a side of the polygon, and the angle that torques on rows make in
//! one step.

use std::f64::consts::TAU;

use super::excitation::Excitation;
use super::oscillator::{Coordinate, Oscillator};
use crate::model::{Machine, blade_frequency};
use crate::scene::Scene;

/// What the explicit solver asks of the bladed disk.
pub trait Blades: Clone + std::fmt::Debug {
    /// The disk at rest, for this scene.
    fn at_rest(scene: &Scene, machine: &Machine) -> Self;
    /// These blades with the displacements and rates of others of their kind.
    fn moving_as(self, other: &Self) -> Self;
    /// How many constraint rows a side of the polygon has.
    fn rows_of_side(&self, side: u32) -> usize;
    /// One of the rows of a side.
    fn row(&self, side: u32, place: usize) -> u32;
    /// One step without contact, which corrects it afterwards, under an
    /// excitation at its phase.
    fn predict(&mut self, excitation: Option<(&Excitation, f64)>);
    /// Blade angle of a row \[rad\].
    fn angle(&self, row: u32) -> f64;
    /// Angle of row `a` per unit torque on row `b` over one step \[rad/(N m)\].
    fn compliance(&self, a: u32, b: u32) -> f64;
    /// Correction of the predicted step by a torque on a row \[N m\].
    fn correct(&mut self, row: u32, torque: f64);
    /// `steps` free steps at once.
    fn skip(&mut self, steps: u64);
    /// A bound on every blade angle now \[rad\].
    fn largest_angle(&self) -> f64;
    /// Largest blade angle that free motion can still reach \[rad\].
    fn reach(&self) -> f64;
    /// `[alpha_c, alpha_s]` and their rates.
    fn modal(&self) -> ([f64; 2], [f64; 2]);
    /// The angle of every blade \[rad\].
    fn every_angle(&self, machine: &Machine) -> Vec<f64>;
    /// The two modes that a held corner follows; none where there are more.
    fn held_modes(&self) -> Option<[Coordinate; 2]> {
        None
    }
    /// Puts the modes of a held corner back.
    fn set_held_modes(&mut self, _: [Coordinate; 2]) {}
    /// Blade angle of a side for these mode displacements \[rad\].
    fn held_angle(&self, _: u32, _: [f64; 2]) -> f64 {
        0.0
    }
    /// Whether blades never move.
    fn is_rigid(&self) -> bool {
        false
    }
    /// Bounds on the displacement and the increment of these modes in free
    /// motion.
    fn swing(&self, _: [Coordinate; 2]) -> (f64, f64) {
        (0.0, 0.0)
    }
}

/// Blades that do not move.
#[derive(Clone, Debug)]
pub struct RigidBlades {
    blades: usize,
}

impl Blades for RigidBlades {
    fn at_rest(scene: &Scene, _: &Machine) -> Self {
        Self { blades: scene.bladed_disk.blades as usize }
    }
    fn moving_as(self, _: &Self) -> Self {
        self
    }
    fn rows_of_side(&self, _: u32) -> usize {
        1
    }
    fn row(&self, side: u32, _: usize) -> u32 {
        side
    }
    fn predict(&mut self, _: Option<(&Excitation, f64)>) {}
    fn angle(&self, _: u32) -> f64 {
        0.0
    }
    fn compliance(&self, _: u32, _: u32) -> f64 {
        0.0
    }
    fn correct(&mut self, _: u32, _: f64) {}
    fn skip(&mut self, _: u64) {}
    fn largest_angle(&self) -> f64 {
        0.0
    }
    fn reach(&self) -> f64 {
        0.0
    }
    fn modal(&self) -> ([f64; 2], [f64; 2]) {
        ([0.0; 2], [0.0; 2])
    }
    fn every_angle(&self, _: &Machine) -> Vec<f64> {
        vec![0.0; self.blades]
    }
    fn held_modes(&self) -> Option<[Coordinate; 2]> {
        Some([Coordinate::default(); 2])
    }
    fn is_rigid(&self) -> bool {
        true
    }
}

/// The two `n_d`-diameter modes, Eq. (4). Blades of one phase group move
/// alike, so a row is a side.
#[derive(Clone, Debug)]
pub struct ModalBlades {
    oscillator: Oscillator,
    modes: [Coordinate; 2],
    diameters: u32,
    has_sine_mode: bool,
    /// `(p_c, p_s)` of every side.
    shapes: Vec<(f64, f64)>,
}

impl Blades for ModalBlades {
    fn at_rest(scene: &Scene, machine: &Machine) -> Self {
        let shape = |side| {
            let (c, s) = machine.rim.direction(side);
            (c, if machine.has_sine_mode { s } else { 0.0 })
        };
        Self {
            oscillator: Oscillator::new(
                machine.blade_modal_mass,
                machine.blade_modal_damping,
                machine.blade_modal_stiffness,
                scene.solver.step_s,
            ),
            modes: [Coordinate::default(); 2],
            diameters: machine.rim.nodal_diameters,
            has_sine_mode: machine.has_sine_mode,
            shapes: (0..machine.rim.sides).map(shape).collect(),
        }
    }
    fn moving_as(self, other: &Self) -> Self {
        Self { modes: other.modes, ..self }
    }
    fn rows_of_side(&self, _: u32) -> usize {
        1
    }
    fn row(&self, side: u32, _: usize) -> u32 {
        side
    }
    fn predict(&mut self, excitation: Option<(&Excitation, f64)>) {
        let torque = match excitation {
            None => [0.0; 2],
            Some((excitation, phase)) => excitation.torque_on(self.diameters, phase),
        };
        for (mode, torque) in self.modes.iter_mut().zip(torque) {
            *mode = self.oscillator.step(*mode, torque);
        }
        if !self.has_sine_mode {
            self.modes[1] = Coordinate::default();
        }
    }
    fn angle(&self, row: u32) -> f64 {
        let (c, s) = self.shapes[row as usize];
        c * self.modes[0].x + s * self.modes[1].x
    }
    fn compliance(&self, a: u32, b: u32) -> f64 {
        let ((ca, sa), (cb, sb)) = (self.shapes[a as usize], self.shapes[b as usize]);
        self.oscillator.compliance * (ca * cb + sa * sb)
    }
    fn correct(&mut self, row: u32, torque: f64) {
        let (c, s) = self.shapes[row as usize];
        for (mode, shape) in self.modes.iter_mut().zip([c, s]) {
            mode.x += self.oscillator.compliance * torque * shape;
            mode.increment += self.oscillator.compliance * torque * shape;
        }
    }
    fn skip(&mut self, steps: u64) {
        self.modes = self.modes.map(|mode| self.oscillator.skip(mode, steps));
    }
    fn largest_angle(&self) -> f64 {
        self.modes[0].x.abs() + self.modes[1].x.abs()
    }
    fn reach(&self) -> f64 {
        let energy: f64 = self.modes.iter().map(|&mode| self.oscillator.twice_energy(mode)).sum();
        self.oscillator.reach(energy).0
    }
    fn modal(&self) -> ([f64; 2], [f64; 2]) {
        (self.modes.map(|mode| mode.x), self.modes.map(|mode| self.oscillator.rate(mode, 0.0)))
    }
    fn every_angle(&self, machine: &Machine) -> Vec<f64> {
        let rim = &machine.rim;
        (1..=rim.blades).map(|blade| self.angle(rim.side_of_blade(blade))).collect()
    }
    fn held_modes(&self) -> Option<[Coordinate; 2]> {
        Some(self.modes)
    }
    fn set_held_modes(&mut self, modes: [Coordinate; 2]) {
        self.modes = modes;
    }
    fn held_angle(&self, side: u32, [cosine, sine]: [f64; 2]) -> f64 {
        let (c, s) = self.shapes[side as usize];
        c * cosine + s * sine
    }
    fn swing(&self, modes: [Coordinate; 2]) -> (f64, f64) {
        let energy: f64 = modes.iter().map(|&mode| self.oscillator.twice_energy(mode)).sum();
        self.oscillator.reach(energy)
    }
}

/// Every blade its own coordinate, Eqs. (2)-(3), carried in the Fourier modes
/// of the circulant matrices, where they are uncoupled. A row is a blade.
#[derive(Clone, Debug)]
pub struct FullBlades {
    /// One oscillator for each number of diameters `0 ..= N/2`.
    oscillators: Vec<Oscillator>,
    /// Coordinates in the order of `basis`.
    modes: Vec<Coordinate>,
    /// Number of diameters of each mode.
    diameters: Vec<usize>,
    /// Factor that makes the modes of each number of diameters orthonormal.
    scales: Vec<f64>,
    /// `basis[blade][mode]`, orthonormal.
    basis: Vec<Vec<f64>>,
    /// Angle of a blade per unit torque `distance` blades away.
    influence: Vec<f64>,
    /// Blades (from 0) of each side.
    sides: Vec<Vec<u32>>,
    /// Positions of the cosine and sine modes of `n_d` diameters, and the
    /// factors that turn their coordinates into `alpha_c`, `alpha_s`.
    shown: [(usize, f64); 2],
}

impl Blades for FullBlades {
    fn at_rest(scene: &Scene, machine: &Machine) -> Self {
        let disk = &scene.bladed_disk;
        let count = disk.blades as usize;
        let blades = f64::from(disk.blades);
        let oscillators = (0..=disk.blades / 2)
            .map(|diameters| {
                let omega = blade_frequency(disk, diameters);
                Oscillator::new(
                    disk.inertia_kg_m2,
                    2.0 * disk.damping_ratio * omega * disk.inertia_kg_m2,
                    omega * omega * disk.inertia_kg_m2,
                    scene.solver.step_s,
                )
            })
            .collect::<Vec<_>>();
        let mut diameters = Vec::with_capacity(count);
        let mut basis = vec![Vec::with_capacity(count); count];
        let mut scales = Vec::with_capacity(count / 2 + 1);
        for k in 0..=count / 2 {
            let alone = k == 0 || 2 * k == count;
            let scale = if alone { 1.0 / blades } else { 2.0 / blades }.sqrt();
            scales.push(scale);
            for sine in [false, true].into_iter().take(if alone { 1 } else { 2 }) {
                diameters.push(k);
                for (blade, row) in basis.iter_mut().enumerate() {
                    let angle = TAU * ((k * blade) % count) as f64 / blades;
                    row.push(scale * if sine { angle.sin() } else { angle.cos() });
                }
            }
        }
        let influence = (0..count)
            .map(|distance| {
                let mode = |m: usize| {
                    oscillators[diameters[m]].compliance * basis[0][m] * basis[distance][m]
                };
                (0..count).map(mode).sum()
            })
            .collect();
        let alias = machine.rim.nodal_diameters as usize % count;
        let folded = alias.min(count - alias);
        let cosine = diameters.iter().position(|&k| k == folded).unwrap_or(0);
        let scale = if machine.has_sine_mode { 2.0 / blades } else { 1.0 / blades }.sqrt();
        let sine = if !machine.has_sine_mode {
            (cosine, 0.0)
        } else if alias == folded {
            (cosine + 1, scale)
        } else {
            (cosine + 1, -scale)
        };
        Self {
            modes: vec![Coordinate::default(); count],
            sides: (0..machine.rim.sides)
                .map(|side| machine.rim.blades_of_side(side).iter().map(|b| b - 1).collect())
                .collect(),
            oscillators,
            diameters,
            scales,
            basis,
            influence,
            shown: [(cosine, scale), sine],
        }
    }
    fn moving_as(self, other: &Self) -> Self {
        Self { modes: other.modes.clone(), ..self }
    }
    fn rows_of_side(&self, side: u32) -> usize {
        self.sides[side as usize].len()
    }
    fn row(&self, side: u32, place: usize) -> u32 {
        self.sides[side as usize][place]
    }
    fn predict(&mut self, excitation: Option<(&Excitation, f64)>) {
        for (m, (mode, &k)) in self.modes.iter_mut().zip(&self.diameters).enumerate() {
            let torque = excitation.map_or(0.0, |(excitation, phase)| {
                // Cosine modes stand before their sine partners.
                let is_sine = m > 0 && self.diameters[m - 1] == k;
                let torque = excitation.torque_on(k as u32, phase);
                self.scales[k] * torque[usize::from(is_sine)]
            });
            *mode = self.oscillators[k].step(*mode, torque);
        }
    }
    fn angle(&self, row: u32) -> f64 {
        self.basis[row as usize].iter().zip(&self.modes).map(|(shape, mode)| shape * mode.x).sum()
    }
    fn compliance(&self, a: u32, b: u32) -> f64 {
        self.influence[a.abs_diff(b) as usize]
    }
    fn correct(&mut self, row: u32, torque: f64) {
        let shapes = &self.basis[row as usize];
        for ((mode, &k), shape) in self.modes.iter_mut().zip(&self.diameters).zip(shapes) {
            let change = self.oscillators[k].compliance * torque * shape;
            mode.x += change;
            mode.increment += change;
        }
    }
    fn skip(&mut self, steps: u64) {
        for (mode, &k) in self.modes.iter_mut().zip(&self.diameters) {
            *mode = self.oscillators[k].skip(*mode, steps);
        }
    }
    fn largest_angle(&self) -> f64 {
        // Any blade's angle is at most the norm of the orthonormal coordinates.
        self.modes.iter().map(|mode| mode.x * mode.x).sum::<f64>().sqrt()
    }
    fn reach(&self) -> f64 {
        let modes = self.modes.iter().zip(&self.diameters);
        let most = modes.map(|(&mode, &k)| {
            let oscillator = &self.oscillators[k];
            oscillator.reach(oscillator.twice_energy(mode)).0
        });
        most.map(|x| x * x).sum::<f64>().sqrt()
    }
    fn modal(&self) -> ([f64; 2], [f64; 2]) {
        let value = |(m, scale): (usize, f64)| scale * self.modes[m].x;
        let rate = |(m, scale): (usize, f64)| {
            scale * self.oscillators[self.diameters[m]].rate(self.modes[m], 0.0)
        };
        (self.shown.map(value), self.shown.map(rate))
    }
    fn every_angle(&self, _: &Machine) -> Vec<f64> {
        (0..self.basis.len() as u32).map(|blade| self.angle(blade)).collect()
    }
}
