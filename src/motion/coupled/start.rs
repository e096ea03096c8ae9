//! The motion of a scene at t = 0, and with other parameters from some step on.
//!
//! The step before the first knows every force that acts at the start, those of a
//! pressed lining too: otherwise the second order is lost.

use std::sync::Arc;

use super::blades::{TipModel, half_step, loss_of};
use super::energy::Account;
use super::lasting::Lasting;
use super::rows::TipLaw;
use super::{Coupled, laws};
use crate::motion::explicit::{Drive, Oscillator, Record};
use crate::motion::{Change, Plane};
use crate::scene::{CheckedScene, ModelSize};
use crate::tolerances::ANGLE_LOOK;

impl<B: TipModel> Coupled<B> {
    /// The motion of a scene at t = 0.
    pub(in crate::motion) fn new(scene: &CheckedScene) -> Self {
        let machine = scene.machine();
        let blades = B::at_rest(scene, &machine, Drive::of(scene).driven(0));
        Self::with_blades(scene, blades)
    }

    /// The motion of a scene with these blades at t = 0.
    pub(super) fn with_blades(scene: &CheckedScene, blades: B) -> Self {
        let machine = scene.machine();
        let drive = Drive::of(scene);
        let casing = Oscillator::of_casing(&machine, drive.step);
        let speed = drive.speed(0);
        let initial = &scene.initial;
        let first_force = drive.force(0);
        let u = [
            casing.start(initial.u_c_m, initial.v_c_m_s, first_force),
            casing.start(initial.u_s_m, initial.v_s_m_s, 0.0),
        ];
        let (law, lining) = laws(scene);
        let mut motion = Self {
            scene: Arc::new(scene.clone()),
            law,
            lining,
            record: Record::of(machine.polygon.sides, drive.step),
            drive,
            casing_loss: loss_of(&casing),
            casing,
            tips: TipLaw::at(&machine, speed),
            backward: speed < 0.0,
            n: 0,
            u,
            before: u.map(|coordinate| coordinate.increment),
            blades,
            near: 0,
            candidates: Vec::new(),
            rows: Vec::new(),
            gaps: Vec::new(),
            dips: [0.0; 2],
            long_steps: 0,
            lasting: Lasting::new(scene.solver.end_s),
            next_look: 0,
            steps_unseen: steps_unseen(scene),
            account: Account::default(),
            largest_angle: 0.0,
            failure: None,
            machine,
        };
        motion.press_start();
        motion.account.start = motion.stored();
        motion
    }

    /// The lining at the start, and in the step before it.
    fn press_start(&mut self) {
        if self.lining.is_none() {
            return;
        }
        let tips = self.tips;
        let bound = self.blades.bound();
        let (z, turn) = self.in_blade_frame();
        self.find_pressed(z, &tips, bound);
        let mut shift = Plane::default();
        for row in &self.rows {
            shift -= tips.push_on_casing(row.place.normal) * (half_step(&self.casing) * row.lambda);
            self.blades.begin(row.index, -row.lambda * (row.place.moment_arm - tips.pushed));
        }
        let moved = shift * turn;
        for (coordinate, part) in self.u.iter_mut().zip([moved.re, moved.im]) {
            coordinate.increment -= part;
        }
        let Some(lining) = self.lining else { return };
        // What the lining held in the step before, from the same rows.
        let back = Plane::cis(tips.diameters * self.drive.speed(0) * self.drive.step);
        let z = Plane::new(self.u[0].x - self.u[0].increment, self.u[1].x - self.u[1].increment);
        let each = f64::from(self.blades.table().blades_per_row);
        let mut energy = 0.0;
        for row in &self.rows {
            let direction = self.machine.polygon.direction(row.side);
            let angle = self.blades.angle_before(row.index);
            energy += each * lining.energy(tips.place(direction, z * back, angle).gap);
        }
        self.account.lining_before = energy;
        if !self.rows.is_empty() {
            self.keep();
        }
    }

    /// From the latest step on, moves with the parameters of a scene, if that is live.
    /// Time, coordinates, rates, rotor, the pulse under way and the record of contacts
    /// stay.
    pub(super) fn take_parameters(&mut self, scene: &CheckedScene) {
        if !Change::is_live(&self.scene, scene) {
            return;
        }
        let (before, held) = (self.stored(), self.account);
        self.scene = Arc::new(scene.clone());
        self.machine = scene.machine();
        self.blades = self.blades.with_parameters(scene, &self.machine);
        self.casing = Oscillator::of_casing(&self.machine, self.drive.step);
        self.casing_loss = loss_of(&self.casing);
        let speed = self.drive.speed(self.n);
        (self.tips, self.backward) = (TipLaw::at(&self.machine, speed), speed < 0.0);
        self.steps_unseen = steps_unseen(scene);
        (self.law, self.lining) = laws(scene);
        self.drive.set_parameters(scene);
        // Gaps of the steps before may be others now.
        self.dips = [self.machine.clearance().abs(); 2];
        self.rows.clear();
        if self.lining.is_some() {
            let tips = self.tips;
            let bound = self.blades.bound();
            let (z, _) = self.in_blade_frame();
            self.find_pressed(z, &tips, bound);
            // As if the lining had been another one for the half step before, too.
            let Account { lining, lining_before, .. } = held;
            let part = if lining > 0.0 { lining_before / lining } else { 1.0 };
            self.account.lining_before = part * self.account.lining;
        }
        self.account.start += self.stored() - before;
    }
}

/// Steps between two looks at the swing of rigid tips.
fn steps_unseen(scene: &CheckedScene) -> u64 {
    let machine = scene.machine();
    let fastest = match scene.solver.model {
        ModelSize::Full => machine.omega_bd_max,
        ModelSize::Rigid | ModelSize::Modal => machine.omega_bd,
    };
    ((ANGLE_LOOK / (fastest * scene.solver.step_s)) as u64).max(1)
}
