//! The time solver of Eqs. (8)-(16): explicit central differences with Lagrange-multiplier
//! contact (docs/theory.md, sections 6 and 10). First order in the step once rigid contact
//! happens, second order on a lining.
//!
//! One step serves every scene; the paper's is that without slope, friction and restitution
//! (`kappa = mu = e = 0`). Read `oscillator` (one coordinate), `disk` with `fixed`, `shapes` and
//! `angles` (the blades as oscillators, their shapes, and how far they turn), `row` (gap and
//! directions of a tip), `step` (section 4.2 of the paper line by line), `lining` (a push by the gap
//! in place of the multiplier), `stride_map` and `strides` (many steps at once); then `drive`,
//! `record` (the drive of a motion, and its record), `changes` (a machine that
//! changes during the run) and `proofs` (verdicts before the end). `solver` combines them.

mod angles;
mod changes;
mod disk;
mod drive;
mod fixed;
mod lining;
mod oscillator;
mod proofs;
mod record;
mod row;
mod shapes;
mod solver;
mod step;
mod stride_map;
mod strides;

use std::sync::Arc;

use super::lasting::Lasting;
use super::{Failure, Ledger, Plane, across};
use crate::model::Machine;
use crate::numeric::lcp::Lcp;
use crate::scene::{CheckedScene, ContactLaw};
use disk::Disk;
use drive::Drive;
use lining::Lining;
use oscillator::{Coordinate, Oscillator};
use record::Record;
use row::{Row, TipLaw, Tips};
use step::LONG_STEP;
use strides::{Stride, Strides};

/// The explicit solver of one scene, at some step.
#[derive(Clone, Debug)]
pub(super) struct Explicit {
    scene: Arc<CheckedScene>,
    machine: Machine,
    law: ContactLaw,
    /// `e`.
    restitution: f64,
    drive: Drive,
    /// Index of the latest step, `t = n h`.
    n: u64,
    casing: Oscillator,
    u: [Coordinate; 2],
    /// Increments of the casing in the step before the last \[m\].
    before: [f64; 2],
    disk: Disk,
    /// Tip law at the present rotor speed.
    tips: TipLaw,
    tips_of_rows: Arc<Tips>,
    /// Rotation of the casing's lobes at the latest contact.
    lobe_turn: Plane,
    /// Side at which the search for the smallest gap begins.
    near: usize,
    /// Rows of the latest contact.
    rows: Vec<Row>,
    several: Lcp,
    lining: Option<Lining>,
    /// Penetration left at the latest step and at the one before \[m\].
    dips: [f64; 2],
    /// Loss of clearance in the latest step and in the one before \[m\].
    closed: [f64; 2],
    /// Casing displacement per step above which the step is too long \[m\], and the number of
    /// consecutive such steps.
    long_step: f64,
    long_steps: u32,
    /// Next step at which the tip swing is recorded.
    next_look: u64,
    record: Record,
    pub(super) lasting: Lasting,
    ledger: Ledger,
    strides: Strides,
    /// The stride that contains the latest step, and the motion at its start; or the stride that
    /// begins at the latest step, alone.
    stride: Option<(Stride, Option<Box<Explicit>>)>,
    /// Step of the latest change during the run.
    changed: u64,
    /// Number of steps that were not computed one by one, but many at once by strides.
    skipped: u64,
    failure: Option<Failure>,
}

impl Explicit {
    /// Creates the motion of a scene at t = 0. The step before the first knows every force that
    /// acts at the start: otherwise the second order is lost.
    pub(super) fn new(scene: &CheckedScene) -> Self {
        let machine = scene.machine();
        let mut disk = Disk::new(scene, &machine);
        let tips_of_rows = Tips::new(&machine, &disk);
        let drive = Drive::of(scene, tips_of_rows.lobes);
        disk.drive(drive.driven(0));
        disk.begin();
        disk.forget_felt();
        let casing = Oscillator::of_casing(&machine, drive.step);
        let (initial, speed, start) = (&scene.initial, drive.speed(0), scene.start());
        let u = [
            casing.start(start.0, initial.v_c_m_s, drive.force(0)),
            casing.start(start.1, initial.v_s_m_s, 0.0),
        ];
        let mut motion = Self {
            scene: Arc::new(scene.clone()),
            law: scene.solver.contact,
            restitution: scene.contact.restitution,
            lining: scene.lining().map(|law| Lining::new(law, &tips_of_rows, &disk)),
            tips: TipLaw::at(&machine, speed),
            tips_of_rows: Arc::new(tips_of_rows),
            lobe_turn: Plane::new(1.0, 0.0),
            record: Record::of(machine.polygon.sides, drive.step),
            lasting: Lasting::new(scene.solver.end_s),
            ledger: Ledger { counts: scene.goes_beyond(), ..Ledger::default() },
            drive,
            n: 0,
            casing,
            u,
            before: [0.0; 2],
            disk,
            near: 0,
            rows: Vec::with_capacity(8),
            several: Lcp::default(),
            dips: [0.0; 2],
            closed: [0.0; 2],
            long_step: long_step(scene, &machine),
            long_steps: 0,
            next_look: 0,
            strides: Strides::default(),
            stride: None,
            changed: 0,
            skipped: 0,
            failure: None,
            machine,
        };
        motion.begin_closing();
        motion.press_start();
        motion.ledger.start = motion.stored();
        motion
    }

    /// Returns the rotation of the blade frame at the latest step, `exp(i n_d theta)`, and rotates the
    /// lobes to that step.
    #[inline]
    fn turn_now(&mut self) -> Plane {
        if self.tips_of_rows.lobes != 0.0 {
            self.lobe_turn = self.drive.lobe_turn(self.n);
        }
        self.drive.turn(self.n)
    }

    /// Returns the casing displacement in the blade frame with this rotation \[m\].
    #[inline(always)]
    fn place(&self, turn: Plane) -> Plane {
        Plane::new(self.u[0].x, self.u[1].x) * turn.conj()
    }

    /// Returns the row of a tip, for the casing at `z` and the blades as they are.
    #[inline(always)]
    fn row(&self, index: usize, z: Plane) -> Row {
        self.tips_of_rows.row(index, z, self.angle(index), self.lobe_turn, &self.tips)
    }

    /// Returns the angle of a row \[rad\].
    #[inline(always)]
    fn angle(&self, index: usize) -> f64 {
        self.disk.angle(index, self.tips_of_rows.rows[index].shape)
    }

    /// Turns the friction of the tips at the latest step with the rotor.
    #[inline]
    fn turn_friction(&mut self) {
        if self.machine.friction != 0.0 {
            let speed = self.drive.speed(self.n);
            if (speed < 0.0) != (self.tips.friction < 0.0) {
                self.tips = TipLaw::at(&self.machine, speed);
            }
        }
    }

    /// Returns the energy of casing, blades and lining between the last two steps \[J\].
    fn stored(&self) -> f64 {
        self.casing_energy() + self.disk.energy() + self.lining.as_ref().map_or(0.0, Lining::stored)
    }

    fn casing_energy(&self) -> f64 {
        0.5 * self.u.iter().map(|&at| self.casing.twice_energy(at)).sum::<f64>()
    }

    /// Adds the energy flows of the step just taken, except those of contact.
    fn count_flows(&mut self, force: f64) {
        let [c, s] = self.moved();
        let [loss, work] = self.disk.flows();
        let sums = &mut self.ledger.sums;
        sums.pulse_work_j += 0.5 * force * c + work;
        sums.casing_loss_j += self.casing.lost() * (c * c + s * s);
        sums.blade_loss_j += loss;
    }

    /// Adds the work of the rotor and the heat of one push over the last two half steps \[J\].
    fn count_push(&mut self, row: &Row, turn: Plane) {
        let (push, normal, tips) = (-row.lambda, row.normal, self.tips);
        let speed = self.drive.rotor.speed(self.drive.time_of(self.n) - self.drive.step);
        let rotor = speed * self.drive.step;
        self.ledger.sums.rotor_work_j -= push * row.arm * rotor;
        if tips.friction == 0.0 {
            return;
        }
        let [c, s] = self.moved();
        let moved = Plane::new(0.5 * c, 0.5 * s) * turn.conj();
        let along = across(normal, moved);
        let turned = 0.5 * (self.angle(row.index) - self.disk.angle_before(row.index));
        let (radius, bent) = (self.scene.casing.radius_m, self.machine.blade_length * turned);
        let sums = &mut self.ledger.sums;
        sums.rotor_work_j += push * tips.friction * radius * rotor;
        sums.friction_heat_j +=
            push * (tips.friction * (radius * rotor + bent) - tips.casing_friction * along);
    }
}

/// Returns the casing displacement per step above which the step is too long; infinite for the
/// paper's tips, which drive no wave so fast for long \[m\].
fn long_step(scene: &CheckedScene, machine: &Machine) -> f64 {
    let side = 2.0 * machine.clearance() * machine.polygon.delta.tan();
    let is_limited = machine.polygon.has_corners() && scene.goes_beyond();
    if is_limited { LONG_STEP * side } else { f64::INFINITY }
}
