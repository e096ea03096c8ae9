//! Every blade its own coordinate (docs/theory.md, section 1).

use std::f64::consts::TAU;
use std::sync::Arc;

use super::BladeModel;
use crate::model::{Machine, blade_frequency};
use crate::motion::explicit::{Coordinate, EngineOrderTorque, Oscillator};
use crate::scene::Scene;
use crate::tolerances::ANGLE_LOOK;

/// Every blade its own coordinate, Eqs. (2)-(3), carried in the Fourier modes
/// of the circulant matrices, where they are uncoupled. A row is a blade.
#[derive(Clone, Debug)]
pub struct FullBlades {
    tables: Arc<Tables>,
    /// Coordinates in the order of the basis.
    modes: Vec<Coordinate>,
}

/// What does not move.
#[derive(Debug)]
struct Tables {
    /// One oscillator for each number of diameters `0 ..= N/2`.
    oscillators: Vec<Oscillator>,
    /// Number of diameters of each mode.
    diameters: Vec<usize>,
    /// Factor that makes the modes of each number of diameters orthonormal.
    scales: Vec<f64>,
    /// Largest entry of `basis`.
    largest_shape: f64,
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

impl BladeModel for FullBlades {
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
        let alias = machine.polygon.nodal_diameters as usize % count;
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
        let tables = Tables {
            sides: (0..machine.polygon.sides)
                .map(|side| machine.polygon.blades_of_side(side).iter().map(|b| b - 1).collect())
                .collect(),
            largest_shape: scales.iter().fold(0.0, |most: f64, &scale| most.max(scale)),
            oscillators,
            diameters,
            scales,
            basis,
            influence,
            shown: [(cosine, scale), sine],
        };
        Self { tables: Arc::new(tables), modes: vec![Coordinate::default(); count] }
    }
    fn moving_as(self, other: &Self) -> Self {
        Self { modes: other.modes.clone(), ..self }
    }
    fn coordinates(&self) -> usize {
        2 + self.modes.len()
    }
    fn rows_of_side(&self, side: u32) -> usize {
        self.tables.sides[side as usize].len()
    }
    fn row(&self, side: u32, place: usize) -> u32 {
        self.tables.sides[side as usize][place]
    }
    fn predict(&mut self, excitation: Option<(&EngineOrderTorque, f64)>) -> f64 {
        let tables = &*self.tables;
        let mut change = 0.0;
        for (m, (mode, &k)) in self.modes.iter_mut().zip(&tables.diameters).enumerate() {
            let torque = excitation.map_or(0.0, |(excitation, phase)| {
                // Cosine modes stand before their sine partners.
                let is_sine = m > 0 && self.tables.diameters[m - 1] == k;
                let torque = excitation.torque_on(k as u32, phase);
                self.tables.scales[k] * torque[usize::from(is_sine)]
            });
            *mode = self.tables.oscillators[k].step(*mode, torque);
            change += mode.increment.abs();
        }
        self.tables.largest_shape * change
    }
    fn angle(&self, row: u32) -> f64 {
        self.tables.basis[row as usize]
            .iter()
            .zip(&self.modes)
            .map(|(shape, mode)| shape * mode.x)
            .sum()
    }
    fn compliance(&self, a: u32, b: u32) -> f64 {
        self.tables.influence[a.abs_diff(b) as usize]
    }
    fn correct(&mut self, row: u32, torque: f64) {
        let shapes = &self.tables.basis[row as usize];
        for ((mode, &k), shape) in self.modes.iter_mut().zip(&self.tables.diameters).zip(shapes) {
            let change = self.tables.oscillators[k].compliance * torque * shape;
            mode.x += change;
            mode.increment += change;
        }
    }
    fn skip(&mut self, steps: u64) {
        for (mode, &k) in self.modes.iter_mut().zip(&self.tables.diameters) {
            *mode = self.tables.oscillators[k].skip(*mode, steps);
        }
    }
    fn bound_now(&self) -> f64 {
        // Any blade's angle is at most the norm of the orthonormal coordinates.
        self.modes.iter().map(|mode| mode.x * mode.x).sum::<f64>().sqrt()
    }
    fn largest_now(&self) -> f64 {
        let angle = |blade| self.angle(blade).abs();
        (0..self.tables.basis.len() as u32).map(angle).fold(0.0, f64::max)
    }
    fn reach(&self) -> f64 {
        let modes = self.modes.iter().zip(&self.tables.diameters);
        let most = modes.map(|(&mode, &k)| {
            let oscillator = &self.tables.oscillators[k];
            oscillator.reach(oscillator.twice_energy(mode)).0
        });
        most.map(|x| x * x).sum::<f64>().sqrt()
    }
    fn peak(&self, steps: u64, least: f64) -> f64 {
        let tables = &*self.tables;
        let fastest = tables.oscillators.iter().map(Oscillator::turn).fold(0.0, f64::max);
        let stride = (ANGLE_LOOK / fastest).clamp(1.0, 1e12) as u64;
        let mut most = least.max(self.largest_now());
        let (mut here, mut taken) = (self.clone(), 0);
        while taken < steps && here.reach() > most {
            let part = stride.min(steps - taken);
            let mut next = here.clone();
            next.skip(part);
            most = most.max(next.largest_now());
            for blade in 0..tables.basis.len() as u32 {
                let [before, after] = [here.coordinate(blade), next.coordinate(blade)];
                // Beyond both ends by at most what the steeper end reaches half-way.
                let rise = before.increment.abs().max(after.increment.abs()) * part as f64;
                let turns = before.increment * after.increment < 0.0;
                if turns && before.x.abs().max(after.x.abs()) + 0.5 * rise > most {
                    most = most.max(here.turning_point(blade, part));
                }
            }
            (here, taken) = (next, taken + part);
        }
        most
    }
    fn modal(&self) -> ([f64; 2], [f64; 2]) {
        let value = |(m, scale): (usize, f64)| scale * self.modes[m].x;
        let rate = |(m, scale): (usize, f64)| {
            scale * self.tables.oscillators[self.tables.diameters[m]].rate(self.modes[m], 0.0)
        };
        (self.tables.shown.map(value), self.tables.shown.map(rate))
    }
    fn every_angle(&self, _: &Machine) -> Vec<f64> {
        (0..self.tables.basis.len() as u32).map(|blade| self.angle(blade)).collect()
    }
}

impl FullBlades {
    /// Angle and increment of a blade (from 0).
    fn coordinate(&self, blade: u32) -> Coordinate {
        let shapes = self.tables.basis[blade as usize].iter();
        shapes.zip(&self.modes).fold(Coordinate::default(), |sum, (shape, mode)| Coordinate {
            x: sum.x + shape * mode.x,
            increment: sum.increment + shape * mode.increment,
        })
    }

    /// Largest angle of a blade around the one turning point that it passes
    /// within `steps` free steps \[rad\].
    fn turning_point(&self, blade: u32, steps: u64) -> f64 {
        let start = self.coordinate(blade).increment;
        let (mut before, mut after) = (0, steps);
        let at = |steps| {
            let mut blades = self.clone();
            blades.skip(steps);
            blades.coordinate(blade)
        };
        while after - before > 1 {
            let middle = before + (after - before) / 2;
            if at(middle).increment * start > 0.0 { before = middle } else { after = middle }
        }
        at(before).x.abs().max(at(after).x.abs())
    }
}
