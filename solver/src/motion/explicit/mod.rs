//! The time solver of Eqs. (8)-(16): explicit central differences with
//! Lagrange-multiplier contact (docs/theory.md, sections 6 and 10). First order in the
//! step once rigid contact happens, second order on a lining.
//!
//! Each step predicts free motion, looks for penetrations and corrects them by the
//! contact law. Beyond the paper, tips may move outward as blades bend, rub, rebound and
//! press on a lining, whose push is a force at the beginning of a step (`lining`).
//!
//! In the paper's model many steps are taken at once, as plain stepping would take them
//! (`leap`).
//!
//! Read `oscillator` (one coordinate) and `drive`, then `rows`, `pushes` and `correct` (rigid
//! contact of a step) and `lining`, `disk` (what it asks of the blades), `beyond`, `spin` (a
//! machine that changes with the speed), `lasting` and `dies`; `record`, `parameters` and
//! `solver` put them together.

mod beyond;
mod correct;
mod dies;
mod disk;
mod drive;
mod lasting;
mod leap;
mod lining;
mod oscillator;
mod parameters;
mod pushes;
mod record;
mod rows;
mod solver;
mod spin;
mod uneven;

pub(super) use disk::{FullBlades, ModalBlades, RigidBlades};
pub(super) use oscillator::{Coordinate, Oscillator};

use std::sync::Arc;

use super::{Failure, FailureReason, Plane};
use crate::contact::{ContactLaw, Several};
use crate::model::Machine;
use crate::scene::CheckedScene;
use beyond::Beyond;
use disk::Disk;
use drive::{Drive, Driven};
use leap::Leaps;
use lining::Lining;
use record::{Record, Watch};
use rows::{Row, TipLaw};

/// The explicit solver on one size of bladed disk.
#[derive(Clone, Debug)]
pub(super) struct Explicit<B: Disk> {
    scene: Arc<CheckedScene>,
    machine: Machine,
    law: ContactLaw,
    /// The lining of the smooth law.
    lining: Option<Lining>,
    /// Law of the tips at the current rotor speed.
    tips: TipLaw,
    drive: Drive,
    casing: Oscillator,
    /// Index of the step the coordinates belong to, `t = n h`.
    n: u64,
    u: [Coordinate; 2],
    blades: B,
    /// Side at which the search for the smallest gap begins.
    near: u32,
    /// Rows of the latest contact.
    rows: Vec<Row>,
    /// Distance of each row to its target \[m\].
    gaps: Vec<f64>,
    record: Record,
    watch: Watch,
    failure: Option<Failure>,
    /// Whether the scene goes beyond the paper's model, and the state that this needs.
    goes_beyond: bool,
    beyond: Beyond,

    /// Steps that are taken many at once.
    leaps: Leaps,
    /// Rows of three sides or more.
    several: Several,
    /// Whether the neighbours of a penetrating side always count; see `correct`.
    neighbours_matter: bool,
}

impl<B: Disk> Explicit<B> {
    /// Takes one step: predicts free motion, looks for penetrations, corrects them.
    fn take_step(&mut self) -> Result<(), FailureReason> {
        if self.goes_beyond {
            return self.take_step_beyond();
        }
        let mut unknown = self.predict(self.drive.force(self.n));
        let distance2 = self.distance2();
        let clearance = self.machine.polygon.clearance;
        if distance2 < clearance * clearance {
            self.open_gap();
        } else {
            let change = self.meet(distance2)?;
            unknown = self.watch.moved(change);
        }
        self.look_at_blades(unknown)
    }

    /// Predicts a step without contact, which is corrected afterwards. Returns whether to look at
    /// the blades.
    #[inline]
    fn predict(&mut self, force: f64) -> bool {
        self.u = [self.casing.step(self.u[0], force), self.casing.step(self.u[1], 0.0)];
        let change = self.blades.predict(self.drive.driven(self.n));
        self.n += 1;
        self.watch.moved(change)
    }

    /// Returns `|u|^2` \[m^2\].
    fn distance2(&self) -> f64 {
        self.u[0].x * self.u[0].x + self.u[1].x * self.u[1].x
    }

    /// Updates the largest blade angle, where it may have grown.
    ///
    /// # Errors
    /// The angle is beyond the limit of small angles.
    fn look_at_blades(&mut self, unknown: bool) -> Result<(), FailureReason> {
        if unknown {
            self.watch.look(self.blades.look(self.watch.largest()))?;
        }
        Ok(())
    }

    /// Returns the casing displacement in the frame of the blades at the latest step, and the turn
    /// of that frame.
    fn in_blade_frame(&mut self) -> (Plane, Plane) {
        let (c, s) = self.drive.turn(self.n);
        if let Some(uneven) = &mut self.beyond.uneven {
            uneven.turn_to(self.n, &self.drive.rotor, self.drive.step);
        }
        let turn = Plane::new(c, s);
        (Plane::new(self.u[0].x, self.u[1].x) * turn.conj(), turn)
    }

    /// Moves the casing by a shift in the frame of the blades.
    fn shift_casing(&mut self, shift: Plane, turn: Plane) {
        let moved = shift * turn;
        for (coordinate, part) in self.u.iter_mut().zip([moved.re, moved.im]) {
            coordinate.x += part;
            coordinate.increment += part;
        }
    }

    /// Checks that the casing has moved by less than its radius.
    ///
    /// # Errors
    /// It has moved farther.
    fn stays_in_range(&self, distance2: f64) -> Result<(), FailureReason> {
        let radius_m = self.scene.casing.radius_m;
        if distance2.is_nan() || distance2 > radius_m * radius_m {
            let distance_m = distance2.sqrt();
            return Err(FailureReason::Displacement { distance_m, radius_m });
        }
        Ok(())
    }

    /// Records the deepest predicted penetration.
    ///
    /// # Errors
    /// It is deeper than the clearance.
    fn is_shallow(&mut self, depth_m: f64) -> Result<(), FailureReason> {
        self.record.deepest_predicted = self.record.deepest_predicted.max(depth_m);
        let clearance_m = self.machine.polygon.clearance;
        if depth_m > clearance_m {
            return Err(FailureReason::Penetration { depth_m, clearance_m });
        }
        Ok(())
    }

    /// Records a step without contact.
    fn open_gap(&mut self) {
        if self.record.is_over(self.n) {
            self.end_contact(self.n);
        }
    }

    /// Records that the contact ends at step `n`.
    fn end_contact(&mut self, n: u64) {
        self.record.end_contact(n);
        self.beyond.lasting.touch(self.time_of(n), 0, false);
        self.rows.clear();
    }

    fn time_of(&self, n: u64) -> f64 {
        self.drive.time_of(n)
    }
}
