//! The explicit solver of what goes beyond the paper (docs/theory.md, section 10): tips
//! that move outward as blades bend, friction, restitution, a lining that gives way,
//! disks of other diameters and mistuned ones.
//!
//! Central differences as in `explicit`, Eqs. (8)-(16). Rigid contact corrects a
//! predicted step by pushes whose force direction is not that of the constraint: first
//! order in the step. A lining pushes by where the step begins: second order.

mod blades;
mod candidates;
mod energy;
mod keep;
mod lasting;
mod lining_step;
mod pushes;
mod rigid_step;
mod rows;
mod solver;
mod start;

pub(super) use blades::{FullTips, ModalTips, RigidTips};
pub use energy::EnergyLedger;

use std::sync::Arc;

use super::explicit::{Coordinate, Drive, Oscillator, Record};
use super::{Failure, FailureReason};
use crate::contact::{self, StepLaw};
use crate::model::{LiningLaw, Machine};
use crate::scene::CheckedScene;
use crate::tolerances::LARGEST_BLADE_ANGLE;
use blades::TipModel;
use energy::Account;
use lasting::Lasting;
use rows::{Row, TipLaw};

/// The explicit solver beyond the paper, on one size of bladed disk.
#[derive(Clone, Debug)]
pub(super) struct Coupled<B: TipModel> {
    scene: Arc<CheckedScene>,
    machine: Machine,
    law: &'static dyn StepLaw,
    /// The lining of the smooth law.
    lining: Option<LiningLaw>,
    drive: Drive,
    casing: Oscillator,
    /// `loss_of` the casing.
    casing_loss: f64,
    /// What tips do where the rotor turns backward, or else forward.
    tips: TipLaw,
    backward: bool,
    /// Index of the step the coordinates belong to, `t = n h`.
    n: u64,
    u: [Coordinate; 2],
    /// Increments of the casing in the step before the last \[m\].
    before: [f64; 2],
    blades: B,
    /// Side to begin the search for the smallest gap at.
    near: u32,
    /// Rows that may touch now.
    candidates: Vec<u32>,
    /// Rows of the latest contact: of a lining, those that push now.
    rows: Vec<Row>,
    /// Distance of each row to its target \[m\].
    gaps: Vec<f64>,
    /// Bounds on the penetration left at the latest step and at the one before \[m\].
    dips: [f64; 2],
    /// Steps in a row in which the casing passed much of a side.
    long_steps: u32,
    record: Record,
    lasting: Lasting,
    /// Step of the next look at the swing of rigid tips, and the steps between two.
    next_look: u64,
    steps_unseen: u64,
    account: Account,
    largest_angle: f64,
    failure: Option<Failure>,
}

impl<B: TipModel> Coupled<B> {
    /// One step.
    fn take_step(&mut self) -> Result<(), FailureReason> {
        let n = self.n;
        let force = self.drive.force(n);
        self.before = [self.u[0].increment, self.u[1].increment];
        self.u = [self.casing.step(self.u[0], force), self.casing.step(self.u[1], 0.0)];
        self.blades.predict(self.drive.driven(n));
        if self.lining.is_some() {
            self.push_lining();
        }
        self.n = n + 1;
        let distance2 = self.u[0].x * self.u[0].x + self.u[1].x * self.u[1].x;
        let bound = self.blades.bound();
        self.look_at_blades(bound)?;
        let tips = self.tips_at(n);
        // Beyond it, even the nearest side is open, and above its target.
        let room = tips.clearance - tips.rise.abs() * bound - self.highest_target();
        if room > 0.0 && distance2 < room * room {
            if self.lining.is_some() {
                self.rows.clear();
                self.account.press(0.0);
            }
            self.part();
        } else {
            self.stays_in_range(distance2, &tips)?;
            if self.lining.is_some() { self.press(&tips, bound) } else { self.meet(&tips, bound)? }
        }
        if !self.account.forgone {
            self.count_flows(force);
        }
        Ok(())
    }

    /// Keeps the largest angles.
    ///
    /// # Errors
    /// A blade angle is beyond what small angles allow.
    fn look_at_blades(&mut self, bound: f64) -> Result<(), FailureReason> {
        if bound > self.largest_angle || !bound.is_finite() {
            let angle_rad = self.blades.largest();
            self.largest_angle = self.largest_angle.max(angle_rad);
            if angle_rad > LARGEST_BLADE_ANGLE || !angle_rad.is_finite() {
                return Err(FailureReason::BladeAngle { angle_rad });
            }
        }
        Ok(())
    }

    /// # Errors
    /// The casing has left its own size behind, or outruns the blades.
    fn stays_in_range(&self, distance2: f64, tips: &TipLaw) -> Result<(), FailureReason> {
        let radius_m = self.scene.casing.radius_m;
        if distance2.is_nan() || distance2 > radius_m * radius_m {
            let distance_m = distance2.sqrt();
            return Err(FailureReason::Displacement { distance_m, radius_m });
        }
        if tips.casing_friction != 0.0 {
            let rate = self.u[0].increment.hypot(self.u[1].increment) / self.drive.step;
            let speed_m_s = self.machine.tangential_ratio * rate;
            let tip_m_s = self.drive.speed(self.n).abs() * radius_m;
            if speed_m_s > tip_m_s {
                return Err(FailureReason::CasingSpeed { speed_m_s, tip_m_s });
            }
        }
        Ok(())
    }

    /// Flows of energy of the step just taken, beside those of contact.
    fn count_flows(&mut self, force: f64) {
        let [c, s] = self.moved();
        let sums = &mut self.account.sums;
        sums.pulse_work_j += 0.5 * force * c;
        sums.casing_loss_j += self.casing_loss * (c * c + s * s);
        let [loss, work] = self.blades.flows();
        sums.blade_loss_j += loss;
        sums.pulse_work_j += work;
    }

    /// What the casing has moved in the last two steps \[m\].
    fn moved(&self) -> [f64; 2] {
        [self.u[0].increment + self.before[0], self.u[1].increment + self.before[1]]
    }

    /// What tips do at step `n`: friction turns round with the rotor.
    fn tips_at(&mut self, n: u64) -> TipLaw {
        let speed = self.drive.speed(n);
        if (speed < 0.0) != self.backward {
            self.backward = speed < 0.0;
            self.tips = TipLaw::at(&self.machine, speed);
        }
        self.tips
    }

    /// Energy in casing, blades and lining between the last two steps \[J\].
    fn stored(&self) -> f64 {
        let casing: f64 = self.u.iter().map(|&at| self.casing.twice_energy(at)).sum();
        0.5 * casing + self.blades.energy() + self.account.in_lining()
    }

    fn time_of(&self, n: u64) -> f64 {
        self.drive.time_of(n)
    }

    /// Whether no contact can ever come again: the energies of casing and blades do not
    /// reach one.
    fn no_contact_to_come(&self) -> bool {
        let clearance = self.machine.clearance();
        if clearance <= 0.0 || self.drive.pulse_to_come(self.n) || self.drive.excitation.is_some() {
            return false;
        }
        let rise = (self.machine.radial_coupling * self.machine.blade_length).abs();
        let tips = if rise == 0.0 { 0.0 } else { rise * self.blades.reach() };
        let resting = self.account.lining == 0.0;
        resting && tips < clearance && self.casing.reach_of(self.u).0 + tips < clearance
    }
}

/// The law of rigid contact of a scene, and its lining if it has one.
fn laws(scene: &CheckedScene) -> (&'static dyn StepLaw, Option<LiningLaw>) {
    (contact::law(scene.solver.contact), scene.lining())
}
