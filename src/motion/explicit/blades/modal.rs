//! The paper's four-coordinate model: the two blade modes of `n_d` diameters
//! (docs/theory.md, section 1).

use std::sync::Arc;

use super::{BladeModel, HeldModes};
use crate::model::{ContactPolygon, Machine};
use crate::motion::explicit::{Coordinate, Driven, Oscillator};
use crate::scene::Scene;

/// The two `n_d`-diameter modes, Eq. (4). Blades of one phase group move
/// alike, so a row is a side.
#[derive(Clone, Debug)]
pub struct ModalBlades {
    oscillator: Oscillator,
    modes: [Coordinate; 2],
    has_sine_mode: bool,
    /// Mode shapes `(p_c, p_s)` of a side are its direction: where there is no
    /// sine mode, all of them are `(+-1, 0)`.
    polygon: Arc<ContactPolygon>,
}

impl BladeModel for ModalBlades {
    fn at_rest(scene: &Scene, machine: &Machine) -> Self {
        Self {
            oscillator: Oscillator::new(
                machine.blade_modal_mass,
                machine.blade_modal_damping,
                machine.blade_modal_stiffness,
                scene.solver.step_s,
            ),
            modes: [Coordinate::default(); 2],
            has_sine_mode: machine.has_sine_mode,
            polygon: Arc::new(machine.polygon.clone()),
        }
    }
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self {
        Self { modes: self.modes, ..Self::at_rest(scene, machine) }
    }
    fn coordinates(&self) -> usize {
        4
    }
    fn rows_of_side(&self, _: u32) -> usize {
        1
    }
    fn row(&self, side: u32, _: usize) -> u32 {
        side
    }
    fn predict(&mut self, excitation: Driven<'_>) -> f64 {
        let torque = match excitation {
            None => [0.0; 2],
            Some((excitation, phase)) => excitation.torque_on(self.polygon.nodal_diameters, phase),
        };
        for (mode, torque) in self.modes.iter_mut().zip(torque) {
            *mode = self.oscillator.step(*mode, torque);
        }
        if !self.has_sine_mode {
            self.modes[1] = Coordinate::default();
        }
        self.modes[0].increment.abs() + self.modes[1].increment.abs()
    }
    fn angle(&mut self, row: u32) -> f64 {
        self.angle_of(row)
    }
    fn compliance(&self, a: u32, b: u32) -> f64 {
        let ((ca, sa), (cb, sb)) = (self.polygon.direction(a), self.polygon.direction(b));
        self.oscillator.compliance * (ca * cb + sa * sb)
    }
    fn correct(&mut self, row: u32, torque: f64) {
        let (c, s) = self.polygon.direction(row);
        for (mode, shape) in self.modes.iter_mut().zip([c, s]) {
            mode.x += self.oscillator.compliance * torque * shape;
            mode.increment += self.oscillator.compliance * torque * shape;
        }
    }
    fn skip(&mut self, steps: u64) {
        self.modes = self.modes.map(|mode| self.oscillator.skip(mode, steps));
    }
    fn look(&mut self, _: f64) -> (f64, f64) {
        let now = self.largest(self.modes.map(|mode| mode.x));
        (now, now)
    }
    fn reach(&self) -> f64 {
        self.oscillator.reach_of(self.modes).0
    }
    fn peak(&self, steps: u64, least: f64) -> f64 {
        if self.reach() <= least {
            return least;
        }
        let mut last = self.clone();
        last.skip(steps);
        let [here, there] =
            [self, &last].map(|blades| self.largest(blades.modes.map(|mode| mode.x)));
        let mut most = least.max(here).max(there);
        // All blades swing alike but for their phases: a blade's first turning
        // point is its largest angle, as every later one is damped.
        for (c, s) in (0..self.polygon.sides).map(|side| self.polygon.direction(side)) {
            let blade = Coordinate {
                x: c * self.modes[0].x + s * self.modes[1].x,
                increment: c * self.modes[0].increment + s * self.modes[1].increment,
            };
            if self.oscillator.reach_of([blade, Coordinate::default()]).0 > most {
                most = most.max(self.oscillator.turning_point(blade, steps));
            }
        }
        most
    }
    fn modal(&self) -> ([f64; 2], [f64; 2]) {
        (self.modes.map(|mode| mode.x), self.modes.map(|mode| self.oscillator.rate(mode, 0.0)))
    }
    fn every_angle(&self, machine: &Machine) -> Vec<f64> {
        let polygon = &machine.polygon;
        (1..=polygon.blades).map(|blade| self.angle_of(polygon.side_of_blade(blade))).collect()
    }
    fn held_modes(&self) -> Option<HeldModes<'_>> {
        Some(HeldModes { modes: self.modes, moving: Some(self) })
    }
    fn set_held_modes(&mut self, modes: [Coordinate; 2]) {
        self.modes = modes;
    }
}

impl ModalBlades {
    /// Angle of the blades of a side \[rad\].
    fn angle_of(&self, side: u32) -> f64 {
        let (c, s) = self.polygon.direction(side);
        c * self.modes[0].x + s * self.modes[1].x
    }

    /// The oscillator that both modes are.
    pub fn oscillator(&self) -> &Oscillator {
        &self.oscillator
    }

    /// `(p_c, p_s)` of a side.
    pub fn shape(&self, side: u32) -> (f64, f64) {
        self.polygon.direction(side)
    }

    /// The largest angle of any blade at these mode displacements \[rad\].
    pub fn largest(&self, [cosine, sine]: [f64; 2]) -> f64 {
        self.polygon.largest_component(cosine, sine)
    }
}
