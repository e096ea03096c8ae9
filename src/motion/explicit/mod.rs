//! The paper's time solver, Eqs. (8)-(16): explicit central differences with
//! Lagrange-multiplier contact (docs/theory.md, section 6). First order in the step
//! once contact happens.
//!
//! Each step predicts free motion, looks for penetrations and corrects them
//! with one of the two contact laws. Free steps (`flight`), those of a held lock
//! (`held_corner`) and those along one side of rigid blades (`held_side`) are taken many
//! at once, as plain stepping would take them; along a side of blades that move a short
//! step is enough (`sliding`).

mod blades;
mod block;
mod corner_step;
mod correct;
mod decided;
mod drive;
mod excitation;
mod flight;
mod held;
mod held_corner;
mod held_side;
mod leap;
mod oscillator;
mod parameters;
mod phasor;
mod record;
mod side_map;
mod sliding;
mod solver;
mod watch;

pub use blades::{BladeModel, FullBlades, ModalBlades, RigidBlades};
pub(in crate::motion) use blades::{NearRows, Ring, product};
pub(in crate::motion) use drive::{Drive, Driven};
pub use excitation::EngineOrderTorque;
pub use oscillator::{Coordinate, Oscillator};
pub(in crate::motion) use record::Record;

use std::sync::Arc;

use super::{Failure, FailureReason};
use crate::contact::{self, StepLaw, repeated::Repeated};
use crate::model::Machine;
use crate::scene::CheckedScene;
use block::Block;
use correct::ConstraintRow;
use held::Held;
use side_map::SideMap;
use sliding::Sliding;
use watch::Watch;

/// The explicit solver on one size of bladed disk.
#[derive(Clone, Debug)]
pub struct Explicit<B: BladeModel> {
    scene: Arc<CheckedScene>,
    machine: Machine,
    law: &'static dyn StepLaw,
    drive: Drive,
    casing: Oscillator,
    /// Index of the step the coordinates belong to, `t = n h`.
    n: u64,
    u: [Coordinate; 2],
    blades: B,
    /// Steps already decided on, not yet taken.
    block: Block,
    /// Steps of the blocks closed so far.
    skipped: u64,
    /// The sides that the open block holds, if it is in contact.
    held: Option<Held>,
    /// Step before which a corner is not tried to be held.
    hold_tried: u64,
    /// The same for a side.
    slide_tried: u64,
    /// The map of a side at this speed, once asked for.
    side_map: Option<Arc<SideMap>>,
    /// The wave on a side of blades that move; `u` and `blades` are then those before.
    sliding: Option<Sliding>,
    /// Steps in a row until the latest contact with the same sides.
    same_sides: u64,
    /// Side to begin the search for the deepest penetration at.
    near: u32,
    /// Multipliers of the latest step in contact, by row.
    rows: Vec<ConstraintRow>,
    /// Rows of which several belong to one side; see `solve_repeated`.
    repeated: Repeated,
    /// Whether the neighbours of a penetrating side always count; see `correct`.
    neighbours_matter: bool,
    /// Rigid gap beyond which no blade of a side can touch now \[m\].
    look: f64,
    record: Record,
    watch: Watch,
    failure: Option<Failure>,
}

impl<B: BladeModel> Explicit<B> {
    /// The motion of a scene at t = 0.
    pub(super) fn new(scene: &CheckedScene) -> Self {
        let machine = scene.machine();
        let drive = Drive::of(scene);
        let casing = Oscillator::of_casing(&machine, drive.step);
        let first_force = drive.force(0);
        let initial = &scene.initial;
        let u = [
            casing.start(initial.u_c_m, initial.v_c_m_s, first_force),
            casing.start(initial.u_s_m, initial.v_s_m_s, 0.0),
        ];
        let mut motion = Self {
            scene: Arc::new(scene.clone()),
            blades: B::at_rest(scene, &machine),
            law: contact::law(scene.solver.contact),
            record: Record::of(machine.polygon.sides, drive.step),
            machine,
            drive,
            casing,
            n: 0,
            u,
            block: Block::default(),
            skipped: 0,
            held: None,
            hold_tried: 0,
            slide_tried: 0,
            side_map: None,
            sliding: None,
            same_sides: 0,
            near: 0,
            rows: Vec::with_capacity(8),
            repeated: Repeated::default(),
            neighbours_matter: false,
            look: 0.0,
            watch: Watch::default(),
            failure: None,
        };
        motion.neighbours_matter = motion.neighbours_matter();
        motion
    }

    /// One step: predict, look, correct.
    fn take_step(&mut self) -> Result<(), FailureReason> {
        let n = self.n;
        let force = self.drive.force(n);
        self.u = [self.casing.step(self.u[0], force), self.casing.step(self.u[1], 0.0)];
        let change = self.blades.predict(self.drive.driven(n));
        let mut unknown = self.watch.moved(change);
        self.n = n + 1;
        let distance2 = self.u[0].x * self.u[0].x + self.u[1].x * self.u[1].x;
        let clearance = self.machine.polygon.clearance;
        if distance2 < clearance * clearance {
            self.open_gap();
        } else {
            let change = self.meet(distance2)?;
            unknown = self.watch.moved(change);
        }
        if unknown {
            self.watch.look(self.blades.look(self.watch.largest()))?;
        }
        Ok(())
    }

    /// Bookkeeping of a step without contact.
    fn open_gap(&mut self) {
        if self.record.is_over(self.n) {
            self.end_contact(self.n);
        }
    }

    /// The contact is broken at step `n`.
    fn end_contact(&mut self, n: u64) {
        self.record.end_contact(n);
        self.rows.clear();
    }

    fn time_of(&self, n: u64) -> f64 {
        self.drive.time_of(n)
    }

    /// The latest step, that of an open block included.
    fn latest_step(&self) -> u64 {
        self.n + self.block.used()
    }

    /// Ends what was decided on ahead.
    fn interrupt(&mut self) {
        self.close_block();
        self.hold_tried = self.n;
        self.slide_tried = self.n;
        self.same_sides = 0;
    }
}
