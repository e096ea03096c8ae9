//! The bladed disk: uncoupled oscillators, its modes, and a table of their shapes at the blades.
//!
//! `alpha_i = sum_m S_im a_m`, and a torque `Q_i` on each blade is the force `sum_i S_im Q_i` on
//! mode `m`. With shapes `cos d Phi_i` and `sin d Phi_i`, not normalised, the modal mass is
//! `N m_b/2`, and `N m_b` where the sine vanishes.
//!
//! | size | modes |
//! |---|---|
//! | rigid | none |
//! | modal | the two of `n_b` nodal diameters, Eq. (4) |
//! | full | all, in which the circulant matrices of Eqs. (2)-(3) are diagonal |
//!
//! Contact asks for *rows*: blades `row`, `row + rows`, `row + 2 rows`, ... that share a push
//! evenly, and whose gap is that of their mean angle. A blade of a mistuned disk has an extra
//! spring, whose torque acts on the modes of the tuned disk; the damping is that of the tuned disk.

use std::borrow::Cow;
use std::sync::Arc;

use super::angles::Seen;
use super::drive::EngineOrderTorque;
use super::fixed::Fixed;
use super::oscillator::{Coordinate, Oscillator};
use super::row::Row;
use super::shapes::{Four, Label, dot, total};
use crate::model::Machine;
use crate::scene::Scene;

/// Coordinates of four modes and the coefficients of their recurrence, see [`Oscillator`].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Modes {
    pub(super) x: Four,
    increment: Four,
    /// Increments of the step before the last.
    before: Four,
    ratio: Four,
    pull: Four,
    compliance: Four,
    lost: Four,
    /// Torques that act on the next step, beside those of rigid contact \[N m\].
    felt: Four,
}

/// The bladed disk in motion.
#[derive(Clone, Debug)]
pub(super) struct Disk {
    pub(super) modes: Vec<Modes>,
    pub(super) oscillators: Arc<Vec<Oscillator>>,
    pub(super) fixed: Arc<Fixed>,
    /// Torques of the excitation in the last step, each with its mode \[N m\].
    driven: Vec<(usize, f64)>,
    pub(super) seen: Seen,
    /// Phase of the blades of a pair that had the largest angle at the latest evaluation.
    pub(super) widest: u32,
    /// Largest angle of any blade in any step \[rad\].
    pub(super) largest: f64,
}

impl Disk {
    /// Creates the disk of a scene at rest.
    pub fn new(scene: &Scene, machine: &Machine) -> Self {
        let (fixed, oscillators) = Fixed::new(scene, machine);
        let mut modes = vec![Modes::default(); fixed.blades.width()];
        for (m, oscillator) in oscillators.iter().enumerate() {
            let (four, lane) = (&mut modes[m / 4], m % 4);
            four.ratio[lane] = oscillator.ratio;
            four.pull[lane] = oscillator.pull;
            four.compliance[lane] = oscillator.compliance;
            four.lost[lane] = oscillator.lost();
        }
        let excitation = EngineOrderTorque::of(scene);
        let is_driven =
            |label: &Label| excitation.is_some_and(|torque| torque.drives(label.diameters));
        let driven = fixed.labels.iter().enumerate().filter(|(_, label)| is_driven(label));
        let driven = driven.map(|(m, _)| (m, 0.0)).collect();
        let (fixed, oscillators) = (Arc::new(fixed), Arc::new(oscillators));
        Self { modes, oscillators, fixed, driven, seen: Seen::NOTHING, widest: 0, largest: 0.0 }
    }

    /// Returns the disk with these coordinates and the parameters of another scene.
    pub fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self {
        let mut disk = Self::new(scene, machine);
        for m in 0..disk.fixed.labels.len() {
            if self.fixed.labels.get(m) == disk.fixed.labels.get(m) {
                disk.put(m, self.at(m));
            }
        }
        disk.largest = self.largest;
        disk
    }

    /// Returns the number of coordinates that a step updates.
    pub fn coordinates(&self) -> usize {
        let modes = self.fixed.labels.len();
        if self.is_tuned() { modes } else { 8 * modes }
    }

    /// Returns the number of rows, and the blades of each.
    pub fn rows(&self) -> (usize, u32) {
        (self.fixed.rows.count(), self.fixed.per_row)
    }

    /// Returns whether it has the modes of one number of nodal diameters, or none.
    pub fn is_pair(&self) -> bool {
        self.fixed.is_pair
    }

    /// Takes one step, Eq. (10), under an excitation and the torques of lining and springs at its
    /// beginning.
    #[inline]
    pub fn predict(&mut self, excitation: Option<(&EngineOrderTorque, f64)>) {
        self.drive(excitation);
        if !self.is_tuned() {
            self.pull_springs();
        }
        let mut moved = [0.0; 4];
        for four in &mut self.modes {
            four.before = four.increment;
            (0..4).for_each(|k| {
                four.increment[k] = four.ratio[k] * four.increment[k] - four.pull[k] * four.x[k]
                    + four.compliance[k] * four.felt[k];
                four.x[k] += four.increment[k];
                moved[k] += four.increment[k].abs();
            });
            four.felt = [0.0; 4];
        }
        self.seen.slack += total(moved);
    }

    /// Adds the torques of an excitation at a phase, which act on the next step.
    #[inline]
    pub fn drive(&mut self, excitation: Option<(&EngineOrderTorque, f64)>) {
        let Some((excitation, phase)) = excitation else { return };
        for (m, torque) in &mut self.driven {
            let label = self.fixed.labels[*m];
            *torque = excitation.torque_on(label.diameters, phase)[usize::from(label.is_sine)];
            self.modes[*m / 4].felt[*m % 4] += *torque;
        }
    }

    /// Adds the torques of the extra springs.
    fn pull_springs(&mut self) {
        let mut torques = self.every_angle();
        torques.iter_mut().zip(&self.fixed.springs).for_each(|(angle, spring)| *angle *= -spring);
        self.feel_blades(&torques);
    }

    fn feel_blades(&mut self, torques: &[f64]) {
        let modes = &mut self.modes;
        self.fixed.blades.feel(torques, |m, felt| modes[m / 4].felt[m % 4] += felt);
    }

    /// Adds torques on all rows, which act on the next step \[N m\].
    pub fn feel(&mut self, torques: &[f64]) {
        let (rows, each) = self.rows();
        let blade = |blade: usize| torques[blade % rows] / f64::from(each);
        let shared: Vec<f64> = (0..self.fixed.blades.count()).map(blade).collect();
        self.feel_blades(&shared);
    }

    /// Adds torques on the two modes of a pair, which act on the next step \[N m\].
    #[inline(always)]
    pub fn feel_pair(&mut self, felt: [f64; 2]) {
        if let Some(four) = self.modes.first_mut() {
            (0..2).for_each(|k| four.felt[k] += felt[k]);
        }
    }

    /// Clears the torques that were added.
    pub fn forget_felt(&mut self) {
        self.modes.iter_mut().for_each(|four| four.felt = [0.0; 4]);
    }

    /// Includes the torques that were added in the fictitious step before the first, so that the start
    /// is of second order.
    pub fn begin(&mut self) {
        for (m, oscillator) in self.oscillators.iter().enumerate() {
            let four = &mut self.modes[m / 4];
            four.increment[m % 4] -= oscillator.start_shift(four.felt[m % 4]);
        }
    }

    /// Returns the angle of a row with these shapes of a pair of modes \[rad\].
    #[inline(always)]
    pub fn angle(&self, row: usize, shape: [f64; 2]) -> f64 {
        if self.fixed.is_pair {
            let x = self.pair_angles();
            return shape[0] * x[0] + shape[1] * x[1];
        }
        let shapes = self.fixed.rows.row(row);
        total(dot(&shapes, self.modes.iter().map(|four| four.x)))
    }

    /// Returns the angle of a row two steps before \[rad\].
    pub fn angle_before(&self, row: usize) -> f64 {
        let shapes = self.fixed.rows.row(row);
        let before = |four: &Modes| {
            let mut place = four.x;
            (0..4).for_each(|k| place[k] -= four.increment[k] + four.before[k]);
            place
        };
        total(dot(&shapes, self.modes.iter().map(before)))
    }

    /// Returns the angle of row `a` caused by a unit torque on row `b` in one step
    /// \[rad/(N m)\].
    #[inline]
    pub fn compliance(&self, a: &Row, b: &Row) -> f64 {
        if self.fixed.is_pair {
            let [[c, s], [p, q]] = [a.shape, b.shape];
            return self.modes.first().map_or(0.0, |four| four.compliance[0]) * (c * p + s * q);
        }
        if let Some(influence) = self.fixed.influence.get(a.index.abs_diff(b.index)) {
            return *influence;
        }
        0.0
    }

    /// Corrects the predicted step by a torque on a row, Eq. (13b).
    #[inline]
    pub fn turn(&mut self, row: &Row, torque: f64) {
        let Self { modes, fixed, .. } = self;
        self.seen.slack += fixed.most_turned * torque.abs();
        if fixed.is_pair {
            let Some(four) = modes.first_mut() else { return };
            for (k, shape) in row.shape.into_iter().enumerate() {
                let change = four.compliance[k] * shape * torque;
                four.x[k] += change;
                four.increment[k] += change;
            }
            return;
        }
        let shapes: Cow<'_, [Four]> = fixed.rows.row(row.index);
        for (four, shape) in modes.iter_mut().zip(shapes.iter()) {
            (0..4).for_each(|k| {
                let change = four.compliance[k] * shape[k] * torque;
                four.x[k] += change;
                four.increment[k] += change;
            });
        }
    }

    /// Sets the increase of the squared blade frequencies over those at standstill \[rad^2/s^2\].
    /// Returns the change of energy \[J\].
    pub fn stiffen(&mut self, added: f64) -> f64 {
        let before = self.energy();
        let oscillators = Arc::make_mut(&mut self.oscillators);
        for (m, (oscillator, still)) in oscillators.iter_mut().zip(&self.fixed.still).enumerate() {
            oscillator.stiffen((still + added) * oscillator.mass);
            self.modes[m / 4].pull[m % 4] = oscillator.pull;
        }
        self.energy() - before
    }

    /// Multiplies every angle by `part`; rates do not change.
    pub fn shrink(&mut self, part: f64) {
        self.modes.iter_mut().for_each(|four| four.x.iter_mut().for_each(|x| *x *= part));
        self.seen = Seen::NOTHING;
    }

    /// Returns `[alpha_c, alpha_s]` \[rad\].
    pub fn modal(&self) -> [f64; 2] {
        self.shown(|four| four.x)
    }

    /// Returns their increments in the last step.
    pub fn modal_increments(&self) -> [f64; 2] {
        self.shown(|four| four.increment)
    }

    fn shown(&self, of: impl Fn(&Modes) -> Four) -> [f64; 2] {
        self.fixed
            .shown
            .map(|mode| mode.map_or(0.0, |(m, sign)| sign * of(&self.modes[m / 4])[m % 4]))
    }

    /// Returns the angle of every blade \[rad\].
    pub fn every_angle(&self) -> Vec<f64> {
        self.fixed.blades.all(|m| self.modes[m / 4].x[m % 4])
    }

    /// Returns the displacements of the modes of a pair.
    #[inline(always)]
    pub fn pair_angles(&self) -> [f64; 2] {
        self.modes.first().map_or([0.0; 2], |four| [four.x[0], four.x[1]])
    }

    pub(super) fn at(&self, m: usize) -> Coordinate {
        let four = &self.modes[m / 4];
        Coordinate { x: four.x[m % 4], increment: four.increment[m % 4] }
    }

    /// Returns the modes of a moving pair; `None` for other disks.
    pub fn modes_of_pair(&self) -> &[Oscillator] {
        if self.fixed.is_pair { &self.oscillators } else { &[] }
    }

    /// Returns the coordinates of a pair after so many free steps; missing ones are zero.
    pub fn flown_pair(&self, steps: u64) -> [Coordinate; 2] {
        let modes = self.modes_of_pair();
        [0, 1].map(|m| {
            modes.get(m).map_or_else(Coordinate::default, |mode| mode.fly(self.at(m), steps))
        })
    }

    /// Sets the coordinates of a pair.
    pub fn set_pair(&mut self, coordinates: [Coordinate; 2]) {
        for (m, at) in coordinates.into_iter().enumerate().take(self.oscillators.len()) {
            self.put(m, at);
        }
        self.seen = Seen::NOTHING;
    }

    /// Returns whether its modes are independent of each other.
    pub fn is_tuned(&self) -> bool {
        self.fixed.springs.is_empty()
    }

    /// Returns the largest phase that a mode turns in a step \[rad\].
    pub fn fastest_turn(&self) -> f64 {
        self.oscillators.iter().map(Oscillator::turn).fold(0.0, f64::max)
    }

    /// Takes many free steps at once.
    pub fn fly(&mut self, steps: u64) {
        for m in 0..self.oscillators.len() {
            self.put(m, self.oscillators[m].fly(self.at(m), steps));
        }
        self.seen = Seen::NOTHING;
    }

    /// Sets the coordinate of a mode.
    fn put(&mut self, m: usize, at: Coordinate) {
        let (four, k) = (&mut self.modes[m / 4], m % 4);
        (four.x[k], four.increment[k]) = (at.x, at.increment);
    }

    /// Returns the shapes of the two modes at a row, for a pair; else zero.
    pub fn shape_of(&self, row: usize) -> [f64; 2] {
        let shapes = self.fixed.rows.table().get(row).filter(|_| self.fixed.is_pair);
        shapes.map_or([0.0; 2], |shape| [shape[0], shape[1]])
    }

    /// Returns the energy between the last two steps \[J\].
    pub fn energy(&self) -> f64 {
        let modes = self.oscillators.iter().enumerate();
        let twice: f64 = modes.map(|(m, oscillator)| oscillator.twice_energy(self.at(m))).sum();
        if self.is_tuned() {
            return 0.5 * twice;
        }
        let moved = self.fixed.blades.all(|m| self.modes[m / 4].increment[m % 4]);
        let each = self.fixed.springs.iter().zip(self.every_angle().into_iter().zip(moved));
        let springs: f64 = each.map(|(spring, (x, moved))| spring * x * (x - moved)).sum();
        0.5 * (twice + springs)
    }

    /// Returns the energy dissipated in the last step, and the work of the excitation
    /// \[J\].
    pub fn flows(&self) -> [f64; 2] {
        let mut loss = [0.0; 4];
        for four in &self.modes {
            (0..4).for_each(|k| {
                let moved = four.increment[k] + four.before[k];
                loss[k] += four.lost[k] * moved * moved;
            });
        }
        let moved = |m: usize| self.modes[m / 4].increment[m % 4] + self.modes[m / 4].before[m % 4];
        let work: f64 = self.driven.iter().map(|&(m, torque)| 0.5 * torque * moved(m)).sum();
        [total(loss), work]
    }
}
