//! Data of the bladed disk that is constant during a run: its modes, their shapes at the blades, the
//! rows, and the extra springs of a mistuned disk.

use std::sync::Arc;

use super::oscillator::Oscillator;
use super::shapes::{Label, Shapes};
use crate::model::{ContactPolygon, Machine, blade_frequency, gcd};
use crate::numeric::normal::normals;
use crate::scene::{ModelSize, Scene};

/// Data that is constant during a run.
#[derive(Debug)]
pub(super) struct Fixed {
    pub labels: Vec<Label>,
    /// Squared frequency of each mode at standstill \[rad^2/s^2\].
    pub still: Vec<f64>,
    /// Shapes at the blades, and at the rows.
    pub blades: Arc<Shapes>,
    pub rows: Arc<Shapes>,
    pub per_row: u32,
    /// Phases of the blades in the modes of a pair.
    pub phases: ContactPolygon,
    /// Whether there are only the modes of one number of diameters, or none.
    pub is_pair: bool,
    /// Angle of a row per unit torque `distance` rows away; none of a pair \[rad/(N m)\].
    pub influence: Vec<f64>,
    /// Largest angle of a blade per unit torque on another or itself \[rad/(N m)\].
    pub most_turned: f64,
    /// Stiffness of each blade beyond that of the tuned disk; none if tuned \[N m/rad\].
    pub springs: Vec<f64>,
    /// Modes and signs of `alpha_c` and `alpha_s`.
    pub shown: [Option<(usize, f64)>; 2],
}

impl Fixed {
    /// Creates the data and the oscillators of the modes.
    pub fn new(scene: &Scene, machine: &Machine) -> (Self, Vec<Oscillator>) {
        let (disk, polygon) = (&scene.disk_in_use(), &machine.polygon);
        let (blades, group) = (polygon.blades, polygon.blades_per_side);
        let diameters = disk.diameters_beside(polygon.nodal_diameters);
        let springs = springs(scene);
        let per_row = match scene.solver.model {
            _ if machine.is_uneven() => 1,
            // Tips without a slope share a push evenly, as only their sum is determined.
            _ if machine.radial_coupling == 0.0 => group,
            ModelSize::Rigid => group,
            ModelSize::Modal => gcd(group, diameters),
            ModelSize::Full => 1,
        };
        let label = |diameters: u32, is_sine: bool| {
            let is_alone = (2 * u64::from(diameters)).is_multiple_of(u64::from(blades));
            Label { diameters, is_sine, is_alone }
        };
        let both = |diameters: u32| {
            let [cosine, sine] = [false, true].map(|is_sine| label(diameters, is_sine));
            if sine.is_alone { vec![cosine] } else { vec![cosine, sine] }
        };
        let labels: Vec<Label> = match scene.solver.model {
            ModelSize::Rigid => Vec::new(),
            ModelSize::Modal => both(diameters),
            ModelSize::Full => (0..=blades / 2).flat_map(both).collect(),
        };
        let is_pair = scene.solver.model != ModelSize::Full;
        let every = Arc::new(Shapes::new(&labels, blades, 1, blades, !is_pair));
        let rows = if per_row == 1 {
            every.clone()
        } else {
            Arc::new(Shapes::new(&labels, blades, per_row, blades / per_row, false))
        };
        let oscillators = oscillators(scene, machine, &labels);
        // A torque on row 0 or on blade 0, felt by the modes; the disk is the same from any row.
        let turned = |shapes: &Shapes| {
            let first = shapes.row(0);
            every.all(|m| oscillators[m].compliance * first[m / 4][m % 4])
        };
        let mut influence = Vec::new();
        let mut most_turned = oscillators.first().map_or(0.0, |mode| mode.compliance);
        if !is_pair {
            most_turned = turned(&every).iter().fold(0.0, |most, x| f64::max(most, x.abs()));
            let (turned, count) = (turned(&rows), rows.count());
            let mean = |row: usize| {
                let each = (0..per_row as usize).map(|k| turned[row + k * count]);
                each.sum::<f64>() / f64::from(per_row)
            };
            influence = (0..count).map(mean).collect();
        }
        let fixed = Self {
            still: labels
                .iter()
                .map(|mode| blade_frequency(disk, mode.diameters).powi(2))
                .collect(),
            shown: match is_pair {
                true => [0, 1].map(|m| (m < labels.len()).then_some((m, 1.0))),
                false => shown(&labels, blades, polygon.nodal_diameters),
            },
            labels,
            blades: every,
            rows,
            per_row,
            phases: ContactPolygon::new(blades, diameters, 1.0),
            is_pair,
            influence,
            most_turned,
            springs,
        };
        (fixed, oscillators)
    }
}

/// Returns the oscillators of modes.
fn oscillators(scene: &Scene, machine: &Machine, labels: &[Label]) -> Vec<Oscillator> {
    let (disk, step) = (&scene.disk_in_use(), scene.solver.step_s);
    let oscillator = |label: &Label| {
        let blades = if label.is_alone { 1.0 } else { 0.5 } * f64::from(disk.blades);
        let (mass, omega) = (blades * disk.inertia_kg_m2, blade_frequency(disk, label.diameters));
        let stiffness = (omega.powi(2) + machine.stiffened_by()) * mass;
        Oscillator::new(mass, 2.0 * disk.damping_ratio * omega * mass, stiffness, step)
    };
    labels.iter().map(oscillator).collect()
}

/// Returns the modes of `alpha_c` and `alpha_s` with their signs: more diameters than half of the
/// blades are those of fewer, seen from blade to blade.
fn shown(labels: &[Label], blades: u32, diameters: u32) -> [Option<(usize, f64)>; 2] {
    let alias = diameters % blades;
    let folded = alias.min(blades - alias);
    let find = |is_sine: bool| {
        labels.iter().position(|label| label.diameters == folded && label.is_sine == is_sine)
    };
    let sign = if alias == folded { 1.0 } else { -1.0 };
    [find(false).map(|m| (m, 1.0)), find(true).map(|m| (m, sign))]
}

/// Returns the stiffness of each blade beyond `k_b`, `sd x_i k_b` with `x_i` standard normal less
/// their mean, so that `k_b` is the mean stiffness \[N m/rad\]; none for a tuned disk.
fn springs(scene: &Scene) -> Vec<f64> {
    let disk = &scene.disk_in_use();
    if disk.mistuning == 0.0 || scene.solver.model != ModelSize::Full {
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
        scene.solver.model = ModelSize::Full;
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
        scene.solver.model = ModelSize::Full;
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
