//! The bladed disk as a ring of equal blades in its Fourier modes, where the
//! circulant matrices of Eqs. (2)-(3) are diagonal: what does not move.
//!
//! Blades `N/d` apart do the same for ever if `d` divides the number of blades and
//! the nodal diameters: nothing tells them apart. So `d` such blades are one member of a ring of `N/d`, with the inertia
//! of all of them, and a push on it is shared evenly.
//! A mistuned disk has springs of its own beside (section 10).

use super::shapes::{LANES, Shapes};
use crate::model::{Machine, blade_frequency};
use crate::motion::explicit::Oscillator;
use crate::numeric::normal::normals;
use crate::scene::Scene;

/// Members, modes and rows of a ring. A list of coefficients is laid out as the
/// coordinates are; see `Shapes`.
#[derive(Clone, Debug)]
pub(super) struct Ring {
    /// Blades that are one member.
    pub alike: u32,
    /// Mode shapes of the members.
    pub shapes: Shapes,
    /// One oscillator for each number of diameters: `d` times the place.
    pub oscillators: Vec<Oscillator>,
    /// Angle of a member per unit torque `distance` members away.
    pub influence: Vec<f64>,
    /// Largest turn of a mode in a step \[rad\].
    pub fastest: f64,
    /// Inertia of a member \[kg m^2\], and the stiffness of each mode at rest \[N m/rad\].
    inertia: f64,
    still: Vec<f64>,
    /// Coefficients of `Oscillator`, of every coordinate.
    ratio: Vec<f64>,
    pull: Vec<f64>,
    compliance: Vec<f64>,
    /// Largest entry of any shape.
    largest_shape: f64,
    /// Places of the cosine and sine coordinates of `n_d` diameters, and the
    /// factors that turn them into `alpha_c`, `alpha_s`.
    shown: [(usize, f64); 2],
}

impl Ring {
    /// Returns how many blades of a scene are one member.
    pub fn alike(scene: &Scene, machine: &Machine) -> u32 {
        let alone = scene.bladed_disk.mistuning != 0.0 || machine.is_uneven();
        if alone { 1 } else { machine.polygon.blades_per_side }
    }

    /// Creates the ring of a scene with `alike` blades as one member.
    pub fn new(scene: &Scene, machine: &Machine, alike: u32) -> Self {
        let disk = &scene.disk_in_use();
        let count = disk.blades / alike;
        let inertia = disk.inertia_kg_m2 * f64::from(alike);
        let shapes = Shapes::new(count);
        let frequencies: Vec<f64> =
            (0..=count / 2).map(|k| blade_frequency(disk, alike * k)).collect();
        let oscillators: Vec<Oscillator> = frequencies
            .iter()
            .map(|omega| {
                let damping = 2.0 * disk.damping_ratio * omega * inertia;
                let stiffness = (omega * omega + machine.stiffened_by()) * inertia;
                Oscillator::new(inertia, damping, stiffness, scene.solver.step_s)
            })
            .collect();
        let coefficients = |coefficient: fn(&Oscillator) -> f64| {
            let mut half: Vec<f64> = oscillators.iter().map(coefficient).collect();
            half.resize(shapes.width(), 0.0);
            half.repeat(2)
        };
        let compliance = coefficients(|oscillator| oscillator.compliance);
        // The shapes of member 0 are the scales of the cosine modes.
        let mut torque = vec![0.0; compliance.len()];
        for ((torque, compliance), scale) in torque.iter_mut().zip(&compliance).zip(shapes.scales())
        {
            *torque = compliance * scale;
        }
        Self {
            alike,
            influence: shapes.all(&torque),
            fastest: oscillators.iter().map(Oscillator::turn).fold(0.0, f64::max),
            ratio: coefficients(|oscillator| oscillator.ratio),
            pull: coefficients(|oscillator| oscillator.pull),
            compliance,
            largest_shape: shapes.scales().iter().fold(0.0, |most, &scale| f64::max(most, scale)),
            shown: shown(machine, &shapes, alike),
            inertia,
            still: frequencies.iter().map(|omega| omega * omega * inertia).collect(),
            shapes,
            oscillators,
        }
    }

    /// Sets the increase of the squared blade frequencies above those at rest \[rad^2/s^2\].
    pub fn stiffen(&mut self, added: f64) {
        let width = self.shapes.width();
        for (k, (oscillator, still)) in self.oscillators.iter_mut().zip(&self.still).enumerate() {
            oscillator.stiffen(still + added * self.inertia);
            (self.pull[k], self.pull[width + k]) = (oscillator.pull, oscillator.pull);
        }
    }

    /// Returns the length of a list of coordinates.
    pub fn len(&self) -> usize {
        self.ratio.len()
    }

    /// Takes one free step of every coordinate. Returns a bound on the change of any angle \[rad\].
    pub fn step(&self, x: &mut [f64], increments: &mut [f64]) -> f64 {
        let mut sums = [0.0; LANES];
        let moving = x.as_chunks_mut::<LANES>().0.iter_mut();
        let moving = moving.zip(increments.as_chunks_mut::<LANES>().0);
        let coefficients = self.ratio.as_chunks::<LANES>().0.iter();
        let coefficients = coefficients.zip(self.pull.as_chunks::<LANES>().0);
        for ((x, increment), (ratio, pull)) in moving.zip(coefficients) {
            for lane in 0..LANES {
                increment[lane] = ratio[lane] * increment[lane] - pull[lane] * x[lane];
                x[lane] += increment[lane];
                sums[lane] += increment[lane].abs();
            }
        }
        self.largest_shape * sums.iter().sum::<f64>()
    }

    /// Returns the places of the cosine and sine coordinates of `k` diameters of the ring.
    pub fn pair(&self, k: usize) -> [usize; 2] {
        [k, self.shapes.width() + k]
    }

    /// Adds the effect of a torque on the member with this row of shapes to positions and
    /// increments of a step.
    pub fn correct(&self, row: &[f64], torque: f64, x: &mut [f64], increments: &mut [f64]) {
        let moving = x.as_chunks_mut::<LANES>().0.iter_mut();
        let moving = moving.zip(increments.as_chunks_mut::<LANES>().0);
        let changes = self.compliance.as_chunks::<LANES>().0.iter();
        let changes = changes.zip(row.as_chunks::<LANES>().0);
        for ((x, increment), (compliance, shape)) in moving.zip(changes) {
            for lane in 0..LANES {
                let change = compliance[lane] * torque * shape[lane];
                x[lane] += change;
                increment[lane] += change;
            }
        }
    }

    /// Returns the coordinates of `alpha_c` and `alpha_s`: diameters, place in the list and factor.
    pub fn shown(&self) -> [(usize, usize, f64); 2] {
        self.shown.map(|(place, factor)| (place % self.shapes.width(), place, factor))
    }
}

/// See `Ring::shown`: modes of `n_d` diameters are those of fewer, seen from
/// blade to blade.
fn shown(machine: &Machine, shapes: &Shapes, alike: u32) -> [(usize, f64); 2] {
    let count = shapes.count();
    let alias = (machine.polygon.nodal_diameters / alike) as usize % count;
    let folded = alias.min(count - alias);
    let scale = shapes.scale(folded);
    let sign = if !machine.has_sine_mode {
        0.0
    } else if alias == folded {
        1.0
    } else {
        -1.0
    };
    [(folded, scale), (shapes.width() + folded, sign * scale)]
}

/// Returns the stiffness of each blade beyond `k_b`, `sd x_i k_b` with `x_i` standard normal less
/// their mean, so that `k_b` is the mean stiffness \[N m/rad\]; none for a tuned disk.
pub(super) fn springs(scene: &Scene) -> Vec<f64> {
    let disk = &scene.disk_in_use();
    if disk.mistuning == 0.0 {
        return Vec::new();
    }
    let drawn = normals(disk.mistuning_seed, disk.blades);
    let mean = drawn.iter().sum::<f64>() / f64::from(disk.blades);
    // A spring may be soft, and none pushes away.
    let softest = drawn.iter().fold(0.0, |most: f64, x| most.max(mean - x));
    let spread = disk.stiffness_nm_per_rad * disk.mistuning.min(1.0 / softest);
    drawn.into_iter().map(|x| spread * (x - mean)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stiffnesses_are_drawn_alike_on_every_machine() {
        let mut scene = Scene::base();
        scene.bladed_disk.mistuning = 0.02;
        let drawn = springs(&scene);
        assert_eq!(drawn, springs(&scene));
        scene.bladed_disk.mistuning_seed = 2;
        assert_ne!(drawn, springs(&scene));
        scene.bladed_disk.blades = 4000;
        let part = |spring: &f64| spring / (0.02 * scene.bladed_disk.stiffness_nm_per_rad);
        let parts: Vec<f64> = springs(&scene).iter().map(part).collect();
        let square = parts.iter().map(|x| x * x).sum::<f64>() / 4000.0;
        // Four standard errors.
        assert!((square - 1.0).abs() < 0.09, "{square}");
    }

    #[test]
    fn the_mean_stiffness_of_a_draw_is_that_of_the_tuned_blade() {
        let mut scene = Scene::base();
        let stiffness = scene.bladed_disk.stiffness_nm_per_rad;
        // The last is more than some of its springs can lose.
        for (blades, seed, sd) in
            [(22, 1, 0.2), (22, 2, 0.05), (3, 5, 0.2), (1, 1, 0.2), (4000, 1, 0.4)]
        {
            let disk = &mut scene.bladed_disk;
            (disk.blades, disk.mistuning_seed, disk.mistuning) = (blades, seed, sd);
            let drawn = springs(&scene);
            let mean = drawn.iter().sum::<f64>() / f64::from(blades);
            assert!(mean.abs() < 1e-14 * stiffness, "{blades} {seed}: {mean}");
            assert!(blades == 1 || drawn.iter().any(|&x| x > 0.01 * stiffness));
            assert!(drawn.iter().all(|&x| x >= -stiffness * (1.0 + 1e-12)), "{blades} {seed}");
        }
    }
}
