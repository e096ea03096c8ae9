//! The two blade modes of Eq. (4) (docs/theory.md, sections 1 and 10), which may have
//! other diameters than the casing wave.

use std::sync::Arc;

use super::{Columns, Disk, HeldModes, RowTable, total};
use crate::model::{ContactPolygon, Machine, gcd};
use crate::motion::Plane;
use crate::motion::explicit::{Coordinate, Driven, Oscillator};
use crate::scene::Scene;

/// Two modes. Without a slope of the tips a row is a side, whose blades share a push
/// evenly; with one, it is the blades of a side that move alike.
#[derive(Clone, Debug)]
pub struct ModalBlades {
    oscillator: Oscillator,
    /// Modal mass \[kg m^2\] and stiffness at rest \[N m/rad\].
    still: [f64; 2],
    modes: [Coordinate; 2],
    /// Their increments of the step before the last.
    before: [f64; 2],
    /// Torque of the excitation in the last step \[N m\].
    torque: [f64; 2],
    has_sine_mode: bool,
    rows: Arc<Rows>,
    /// Phase of the blades that had the largest angle when it was looked at last.
    widest: u32,
    /// Angle of each row, where they are not those of a wave of the casing's diameters.
    angles: Vec<f64>,
}

/// What does not move.
#[derive(Debug)]
struct Rows {
    diameters: u32,
    /// Whether the disk has the diameters of the casing wave.
    follows: bool,
    table: RowTable,
    /// `(p_c, p_s)` of each row, the mean of its blades. Where there is no sine mode, all
    /// of them are `(+-1, 0)`.
    shapes: Vec<(f64, f64)>,
    /// The phases of the blades in the modes of the disk.
    phases: ContactPolygon,
}

impl Rows {
    fn new(scene: &Scene, machine: &Machine) -> Self {
        let polygon = &machine.polygon;
        let diameters = scene.bladed_disk.diameters_beside(polygon.nodal_diameters);
        let follows = diameters == polygon.nodal_diameters;
        let group = polygon.blades_per_side;
        let alike = if machine.radial_coupling == 0.0 { group } else { gcd(group, diameters) };
        let alike = if machine.is_uneven() { 1 } else { alike };
        let table = RowTable::new(machine, alike);
        let phases = ContactPolygon::new(polygon.blades, diameters, 1.0);
        let shape = |row: usize| {
            if follows {
                return phases.direction(table.side[row]);
            }
            let blades = (0..alike).map(|member| (row + member as usize * table.count()) as u32);
            let (c, s) = blades.fold((0.0, 0.0), |(c, s), blade| {
                let (pc, ps) = phases.direction(phases.side_of_blade(blade + 1));
                (c + pc, s + ps)
            });
            (c / f64::from(alike), s / f64::from(alike))
        };
        let shapes = (0..table.count()).map(shape).collect();
        Self { diameters, follows, shapes, table, phases }
    }
}

impl Disk for ModalBlades {
    fn at_rest(scene: &Scene, machine: &Machine, driven: Driven<'_>) -> Self {
        let rows = Rows::new(scene, machine);
        let mut blades = Self {
            oscillator: Oscillator::new(
                machine.blade_modal_mass,
                machine.blade_modal_damping,
                machine.blade_modal_stiffness,
                scene.solver.step_s,
            ),
            still: [machine.blade_modal_mass, machine.blade_stiffness_at_rest()],
            modes: [Coordinate::default(); 2],
            before: [0.0; 2],
            torque: [0.0; 2],
            angles: vec![0.0; if rows.follows { 0 } else { rows.table.count() }],
            has_sine_mode: machine.has_sine_mode,
            widest: 0,
            rows: Arc::new(rows),
        };
        let torques = blades.torques(driven);
        for (mode, torque) in blades.modes.iter_mut().zip(torques) {
            *mode = blades.oscillator.begin(*mode, torque);
        }
        blades
    }
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self {
        Self { modes: self.modes, before: self.before, ..Self::at_rest(scene, machine, None) }
    }
    fn coordinates(&self) -> usize {
        4 + self.angles.len()
    }
    fn table(&self) -> &RowTable {
        &self.rows.table
    }
    fn predict(&mut self, driven: Driven<'_>) -> f64 {
        self.torque = self.torques(driven);
        self.before = self.modes.map(|mode| mode.increment);
        for (mode, torque) in self.modes.iter_mut().zip(self.torque) {
            *mode = self.oscillator.step(*mode, torque);
        }
        if !self.has_sine_mode {
            self.modes[1] = Coordinate::default();
        }
        self.modes[0].increment.abs() + self.modes[1].increment.abs()
    }
    fn angle(&mut self, row: u32) -> f64 {
        self.at(self.rows.shapes[row as usize])
    }
    fn angle_before(&mut self, row: u32) -> f64 {
        let (c, s) = self.rows.shapes[row as usize];
        let place = |k: usize| self.modes[k].x - (self.modes[k].increment + self.before[k]);
        c * place(0) + s * place(1)
    }
    fn compliance(&self, a: u32, b: u32) -> f64 {
        let shapes = &self.rows.shapes;
        let ((ca, sa), (cb, sb)) = (shapes[a as usize], shapes[b as usize]);
        self.oscillator.compliance * (ca * cb + sa * sb)
    }
    fn correct(&mut self, row: u32, torque: f64) {
        let (c, s) = self.rows.shapes[row as usize];
        for (mode, shape) in self.modes.iter_mut().zip([c, s]) {
            let change = self.oscillator.compliance * torque * shape;
            mode.x += change;
            mode.increment += change;
        }
    }
    fn shape_of(&self, row: u32) -> (f64, f64) {
        self.rows.shapes[row as usize]
    }
    fn push(&mut self, _: &Columns, felt: [f64; 2]) -> f64 {
        let mut change = 0.0;
        for (mode, felt) in self.modes.iter_mut().zip(felt) {
            let moved = self.oscillator.compliance * felt;
            mode.x += moved;
            mode.increment += moved;
            change += moved.abs();
        }
        change
    }
    fn stiffen(&mut self, added: f64) -> f64 {
        let (before, [mass, stiffness]) = (self.energy(), self.still);
        self.oscillator.stiffen(stiffness + added * mass);
        self.energy() - before
    }
    fn shrink(&mut self, part: f64) {
        self.modes.iter_mut().for_each(|mode| mode.x *= part);
    }
    fn swept(&mut self, rows: &Columns) -> f64 {
        let mut felt = [[0.0; 4]; 2];
        for four in &rows.fours {
            for (felt, shape) in felt.iter_mut().zip(&four.shape) {
                (0..4).for_each(|lane| felt[lane] += shape[lane] * four.push[lane]);
            }
        }
        let [c, s] = felt.map(total);
        let moved = |k: usize| 0.5 * (self.modes[k].increment + self.before[k]);
        c * moved(0) + s * moved(1)
    }
    fn begin(&mut self, _: &Columns, felt: [f64; 2]) {
        for (mode, felt) in self.modes.iter_mut().zip(felt) {
            *mode = self.oscillator.begin(*mode, felt);
        }
    }
    fn modal(&self) -> [f64; 2] {
        self.modes.map(|mode| mode.x)
    }
    fn modal_rates(&self, ahead: &Self, step: f64) -> [f64; 2] {
        let rate = |k: usize| (self.modes[k].increment + ahead.modes[k].increment) / (2.0 * step);
        [rate(0), rate(1)]
    }
    fn every_angle(&self) -> Vec<f64> {
        let phases = &self.rows.phases;
        let angle = |blade| self.at(phases.direction(phases.side_of_blade(blade)));
        (1..=phases.blades).map(angle).collect()
    }
    fn look(&mut self, largest: f64) -> (f64, f64) {
        let amplitude = self.swing();
        if amplitude <= largest {
            return (0.0, amplitude);
        }
        let (now, widest) = self.largest_and_where(self.modal());
        self.widest = widest;
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
        let [here, there] = [self, &last].map(|blades| self.largest(blades.modal()));
        let mut most = least.max(here).max(there);
        // All blades swing alike but for their phases: a blade's first turning
        // point is its largest angle, as every later one is damped.
        let phases = &self.rows.phases;
        for (c, s) in (0..phases.sides).map(|side| phases.direction(side)) {
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
    fn skip(&mut self, steps: u64) {
        self.modes = self.modes.map(|mode| self.oscillator.skip(mode, steps));
    }
    fn held_modes(&self) -> Option<HeldModes<'_>> {
        Some(HeldModes { modes: self.modes, moving: Some(self) })
    }
    fn set_held_modes(&mut self, modes: [Coordinate; 2], before: [f64; 2]) {
        (self.modes, self.before) = (modes, before);
    }
    fn bound(&mut self) -> f64 {
        self.swing()
    }
    fn wave(&self) -> Option<Plane> {
        self.rows.follows.then(|| Plane::new(self.modes[0].x, self.modes[1].x))
    }
    fn estimates(&mut self) -> (&RowTable, &[f64], f64) {
        let [x, y] = self.modal();
        for (angle, (c, s)) in self.angles.iter_mut().zip(&self.rows.shapes) {
            *angle = c * x + s * y;
        }
        (&self.rows.table, &self.angles, 0.0)
    }
    fn swing(&mut self) -> f64 {
        let [c, s] = self.modes;
        (c.x * c.x + s.x * s.x).sqrt()
    }
    fn energy(&self) -> f64 {
        let twice: f64 = self.modes.iter().map(|mode| self.oscillator.twice_energy(*mode)).sum();
        0.5 * twice
    }
    fn flows(&self) -> [f64; 2] {
        let [c, s] = [0, 1].map(|k| self.modes[k].increment + self.before[k]);
        let work = 0.5 * (self.torque[0] * c + self.torque[1] * s);
        [self.oscillator.lost() * (c * c + s * s), work]
    }
}

impl ModalBlades {
    /// Returns the angle of blades of these shapes \[rad\].
    fn at(&self, (c, s): (f64, f64)) -> f64 {
        c * self.modes[0].x + s * self.modes[1].x
    }

    /// Returns the torque of the excitation on the modes \[N m\].
    fn torques(&self, driven: Driven<'_>) -> [f64; 2] {
        let Some((excitation, phase)) = driven else { return [0.0; 2] };
        let [c, s] = excitation.torque_on(self.rows.diameters, phase);
        [c, if self.has_sine_mode { s } else { 0.0 }]
    }

    /// Returns the oscillator of both modes.
    pub fn oscillator(&self) -> &Oscillator {
        &self.oscillator
    }

    /// Returns the increments of the modes in the step before the last \[rad\].
    pub fn before(&self) -> [f64; 2] {
        self.before
    }

    /// Returns `(p_c, p_s)` of a side, where the disk has the diameters of the casing wave.
    pub fn shape(&self, side: u32) -> (f64, f64) {
        self.rows.phases.direction(side)
    }

    /// Returns the largest angle of any blade at these mode displacements \[rad\].
    pub fn largest(&self, modes: [f64; 2]) -> f64 {
        self.largest_and_where(modes).0
    }

    /// Returns the same, and the phase of the blades that have it.
    fn largest_and_where(&self, [cosine, sine]: [f64; 2]) -> (f64, u32) {
        let mut widest = self.widest;
        if cosine.is_finite() && sine.is_finite() {
            let phases = &self.rows.phases;
            (phases.largest_component_near(cosine, sine, &mut widest), widest)
        } else {
            (f64::INFINITY, widest)
        }
    }
}
