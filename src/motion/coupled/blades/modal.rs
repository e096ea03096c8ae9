//! The two blade modes of `n_b` diameters, Eq. (4), which may be others than those of
//! the casing wave (docs/theory.md, section 10).

use std::sync::Arc;

use super::{TipModel, half_step, loss_of};
use crate::model::{ContactPolygon, Machine, gcd};
use crate::motion::Plane;
use crate::motion::coupled::rows::RowTable;
use crate::motion::explicit::{Coordinate, Driven, Oscillator};
use crate::scene::Scene;

/// Two modes. Without a slope of the tips a row is a side, whose blades share a push
/// evenly; with one, it is the blades of a side that move alike.
#[derive(Clone, Debug)]
pub(in crate::motion) struct ModalTips {
    oscillator: Oscillator,
    modes: [Coordinate; 2],
    /// Their increments of the step before the last.
    before: [f64; 2],
    /// Torque of the excitation in the last step \[N m\].
    torque: [f64; 2],
    diameters: u32,
    has_sine_mode: bool,
    /// Whether the disk has the diameters of the casing wave.
    follows: bool,
    table: Arc<RowTable>,
    /// `(p_c, p_s)` of each row, the mean of its blades.
    shapes: Arc<[(f64, f64)]>,
    /// The phases of the blades in the modes of the disk.
    phases: Arc<ContactPolygon>,
    angles: Vec<f64>,
}

impl TipModel for ModalTips {
    fn at_rest(scene: &Scene, machine: &Machine, driven: Driven<'_>) -> Self {
        let polygon = &machine.polygon;
        let diameters = scene.bladed_disk.diameters_beside(polygon.nodal_diameters);
        let group = polygon.blades_per_side;
        let alike = if machine.radial_coupling == 0.0 { group } else { gcd(group, diameters) };
        let table = RowTable::new(machine, alike);
        let phases = ContactPolygon::new(polygon.blades, diameters, 1.0);
        let shape = |row: usize| {
            let blades = (0..alike).map(|member| (row + member as usize * table.count()) as u32);
            let (c, s) = blades.fold((0.0, 0.0), |(c, s), blade| {
                let (pc, ps) = phases.direction(phases.side_of_blade(blade + 1));
                (c + pc, s + ps)
            });
            (c / f64::from(alike), s / f64::from(alike))
        };
        let shapes: Arc<[_]> = (0..table.count()).map(shape).collect();
        let mut tips = Self {
            oscillator: Oscillator::new(
                machine.blade_modal_mass,
                machine.blade_modal_damping,
                machine.blade_modal_stiffness,
                scene.solver.step_s,
            ),
            modes: [Coordinate::default(); 2],
            before: [0.0; 2],
            torque: [0.0; 2],
            diameters,
            has_sine_mode: machine.has_sine_mode,
            follows: diameters == polygon.nodal_diameters,
            angles: vec![0.0; table.count()],
            table: Arc::new(table),
            shapes,
            phases: Arc::new(phases),
        };
        let half = half_step(&tips.oscillator);
        let torques = tips.driving(driven);
        for (mode, torque) in tips.modes.iter_mut().zip(torques) {
            mode.increment -= half * torque;
        }
        tips
    }
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self {
        Self { modes: self.modes, before: self.before, ..Self::at_rest(scene, machine, None) }
    }
    fn coordinates(&self) -> usize {
        if self.follows { 4 } else { 4 + self.table.count() }
    }
    fn table(&self) -> &RowTable {
        &self.table
    }
    fn wave(&self) -> Option<Plane> {
        self.follows.then(|| Plane::new(self.modes[0].x, self.modes[1].x))
    }
    fn predict(&mut self, driven: Driven<'_>) {
        self.torque = self.driving(driven);
        let [c, s] = self.modes;
        self.before = [c.increment, s.increment];
        let step = |mode, torque| self.oscillator.step(mode, torque);
        self.modes = [step(c, self.torque[0]), step(s, self.torque[1])];
        if !self.has_sine_mode {
            self.modes[1] = Coordinate::default();
        }
    }
    fn angle(&mut self, row: u32) -> f64 {
        let (c, s) = self.shapes[row as usize];
        c * self.modes[0].x + s * self.modes[1].x
    }
    fn angle_before(&mut self, row: u32) -> f64 {
        let (c, s) = self.shapes[row as usize];
        let place = |k: usize| self.modes[k].x - (self.modes[k].increment + self.before[k]);
        c * place(0) + s * place(1)
    }
    fn compliance(&self, a: u32, b: u32) -> f64 {
        let ((ca, sa), (cb, sb)) = (self.shapes[a as usize], self.shapes[b as usize]);
        self.oscillator.compliance * (ca * cb + sa * sb)
    }
    fn correct(&mut self, row: u32, torque: f64) {
        let (c, s) = self.shapes[row as usize];
        for (mode, shape) in self.modes.iter_mut().zip([c, s]) {
            let change = self.oscillator.compliance * torque * shape;
            mode.x += change;
            mode.increment += change;
        }
    }
    fn begin(&mut self, row: u32, torque: f64) {
        let (c, s) = self.shapes[row as usize];
        let half = half_step(&self.oscillator);
        for (mode, shape) in self.modes.iter_mut().zip([c, s]) {
            mode.increment -= half * torque * shape;
        }
    }
    fn bound(&mut self) -> f64 {
        let [c, s] = self.modes;
        (c.x * c.x + s.x * s.x).sqrt()
    }
    fn estimates(&mut self) -> (&RowTable, &[f64], f64) {
        let [x, y] = self.modes.map(|mode| mode.x);
        for (angle, (c, s)) in self.angles.iter_mut().zip(&*self.shapes) {
            *angle = c * x + s * y;
        }
        (&self.table, &self.angles, 0.0)
    }
    fn largest(&mut self) -> f64 {
        let [c, s] = self.modes.map(|mode| mode.x);
        if c.is_finite() && s.is_finite() {
            self.phases.largest_component(c, s)
        } else {
            f64::INFINITY
        }
    }
    fn swing(&mut self) -> f64 {
        self.bound()
    }
    fn energy(&self) -> f64 {
        let twice: f64 = self.modes.iter().map(|mode| self.oscillator.twice_energy(*mode)).sum();
        0.5 * twice
    }
    fn flows(&self) -> [f64; 2] {
        let loss = loss_of(&self.oscillator);
        let ([c, s], [c_before, s_before]) = (self.modes, self.before);
        let (c, s) = (c.increment + c_before, s.increment + s_before);
        let work = 0.5 * (self.torque[0] * c + self.torque[1] * s);
        [loss * (c * c + s * s), work]
    }
    fn reach(&self) -> f64 {
        self.oscillator.reach_of(self.modes).0
    }
    fn modal(&self) -> ([f64; 2], [f64; 2]) {
        let mean = |k: usize| 0.5 * (self.modes[k].increment + self.before[k]);
        (self.modes.map(|mode| mode.x), [mean(0), mean(1)])
    }
    fn every_angle(&self) -> Vec<f64> {
        let [x, y] = self.modes.map(|mode| mode.x);
        let angle = |blade| {
            let (c, s) = self.phases.direction(self.phases.side_of_blade(blade));
            c * x + s * y
        };
        (1..=self.phases.blades).map(angle).collect()
    }
}

impl ModalTips {
    fn driving(&self, driven: Driven<'_>) -> [f64; 2] {
        let Some((excitation, phase)) = driven else { return [0.0; 2] };
        let [c, s] = excitation.torque_on(self.diameters, phase);
        [c, if self.has_sine_mode { s } else { 0.0 }]
    }
}
