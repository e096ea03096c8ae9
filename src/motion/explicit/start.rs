//! The motion of a scene at t = 0.
//!
//! Beyond the paper the step before the first knows every force that acts at the start,
//! those of a pressed lining too: otherwise the second order is lost.

use std::sync::Arc;

use super::beyond::Beyond;
use super::disk::Disk;
use super::drive::{Drive, Driven};
use super::leap::Leaps;
use super::record::Record;
use super::rows::TipLaw;
use super::watch::Watch;
use super::{Explicit, Oscillator};
use crate::contact::{self, Several, repeated::Repeated};
use crate::model::Machine;
use crate::motion::Plane;
use crate::scene::CheckedScene;

impl<B: Disk> Explicit<B> {
    /// The motion of a scene at t = 0.
    pub(in crate::motion) fn new(scene: &CheckedScene) -> Self {
        Self::with_blades(scene, |machine, driven| B::at_rest(scene, machine, driven))
    }

    /// The same with the blades that these make, of the machine and what drives it.
    pub(super) fn with_blades(
        scene: &CheckedScene,
        blades: impl FnOnce(&Machine, Driven<'_>) -> B,
    ) -> Self {
        let machine = scene.machine();
        let drive = Drive::of(scene);
        let blades = blades(&machine, drive.driven(0).filter(|_| scene.goes_beyond()));
        let casing = Oscillator::of_casing(&machine, drive.step);
        let (initial, speed) = (&scene.initial, drive.speed(0));
        let u = [
            casing.start(initial.u_c_m, initial.v_c_m_s, drive.force(0)),
            casing.start(initial.u_s_m, initial.v_s_m_s, 0.0),
        ];
        let mut motion = Self {
            scene: Arc::new(scene.clone()),
            law: contact::law(scene.solver.contact),
            lining: scene.lining(),
            tips: TipLaw::at(&machine, speed),
            record: Record::of(machine.polygon.sides, drive.step),
            drive,
            casing,
            n: 0,
            u,
            blades,
            near: 0,
            rows: Vec::with_capacity(8),
            gaps: Vec::new(),
            watch: Watch::default(),
            failure: None,
            goes_beyond: scene.goes_beyond(),
            beyond: Beyond::of(scene, speed),
            leaps: Leaps::default(),
            several: Several::default(),
            repeated: Repeated::default(),
            neighbours_matter: false,
            look: 0.0,
            machine,
        };
        motion.neighbours_matter = motion.neighbours_matter();
        if motion.goes_beyond {
            motion.press_start();
            motion.beyond.account.start = motion.stored();
        }
        motion
    }

    /// The lining at the start, and in the step before it.
    fn press_start(&mut self) {
        let Some(lining) = self.lining else { return };
        let tips = self.tips;
        let bound = self.blades.bound();
        let (z, turn) = self.in_blade_frame();
        self.find_pressed(z, &tips, bound);
        let mut force = Plane::default();
        for row in &self.rows {
            force -= tips.push_on_casing(row.place.normal) * row.lambda;
            self.blades.begin(row.index, tips.torque(row));
        }
        let force = force * turn;
        self.u =
            [(0, force.re), (1, force.im)].map(|(k, force)| self.casing.begin(self.u[k], force));
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
        self.beyond.account.lining_before = energy;
        if !self.rows.is_empty() {
            self.keep_rows();
        }
    }
}
