//! The motion of a scene at t = 0, and with other parameters from a later step on:
//! dampings, masses, stiffnesses, contact law and the pulse to fire next.
//!
//! Beyond the paper the step before the first knows every force that acts at the start,
//! those of a pressed lining too: otherwise the second order is lost. On the way,
//! displacements and increments go on as they are, so that positions and the mean rates
//! of the last step have no jump.

use std::sync::Arc;

use super::beyond::Beyond;
use super::disk::Disk;
use super::drive::Drive;
use super::leap::Leaps;
use super::lining::Lining;
use super::record::{Record, Watch};
use super::rows::TipLaw;
use super::{Explicit, Oscillator};
use crate::contact::Several;
use crate::motion::Change;
use crate::scene::CheckedScene;

impl<B: Disk> Explicit<B> {
    /// Creates the motion of a scene at t = 0.
    pub(in crate::motion) fn new(scene: &CheckedScene) -> Self {
        let machine = scene.machine();
        let drive = Drive::of(scene);
        let driven = drive.driven(0).filter(|_| scene.goes_beyond());
        let blades = B::at_rest(scene, &machine, driven);
        let casing = Oscillator::of_casing(&machine, drive.step);
        let (initial, speed, start) = (&scene.initial, drive.speed(0), scene.start());
        let u = [
            casing.start(start.0, initial.v_c_m_s, drive.force(0)),
            casing.start(start.1, initial.v_s_m_s, 0.0),
        ];
        let mut motion = Self {
            scene: Arc::new(scene.clone()),
            law: scene.solver.contact,
            lining: scene.lining().map(Lining::new),
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
            neighbours_matter: false,
            machine,
        };
        motion.neighbours_matter = motion.neighbours_matter();
        if motion.goes_beyond {
            motion.take_shape();
            motion.begin_closing();
            motion.press_start();
            motion.beyond.account.start = motion.stored();
        }
        motion
    }
}

impl<B: Disk> Explicit<B> {
    /// From the latest step on, moves with the parameters of a scene, if that is
    /// live. Time, coordinates, rates, rotor, the pulse under way and the record
    /// of contacts stay.
    pub(super) fn take_parameters(&mut self, scene: &CheckedScene) {
        if !Change::is_live(&self.scene, scene) {
            return;
        }
        self.interrupt();
        let before = self.stored_beyond();
        self.scene = Arc::new(scene.clone());
        let speed = self.drive.speed(self.n);
        self.machine = scene.machine().at(speed).into_owned();
        self.blades = self.blades.with_parameters(scene, &self.machine);
        self.casing = Oscillator::of_casing(&self.machine, self.drive.step);
        self.law = scene.solver.contact;
        self.drive.set_parameters(scene);
        self.neighbours_matter = self.neighbours_matter();
        self.tips = TipLaw::at(&self.machine, speed);
        if self.goes_beyond {
            self.beyond.set_parameters(scene, &self.machine, speed);
            self.take_shape();
            self.begin_closing();
            self.shrink_into_clearance();
            self.press_again();
            self.beyond.account.start += self.stored() - before;
        }
    }
}

#[cfg(test)]
mod tests {
    use crate::motion::{Change, Motion};
    use crate::scene::{ModelSize, Scene, SolverKind};

    fn scene(model: ModelSize) -> Scene {
        let mut scene = Scene::base();
        scene.solver.model = model;
        scene.solver.step_s = 1e-6;
        scene
    }

    #[test]
    fn adopting_the_same_scene_changes_nothing() {
        for model in [ModelSize::Rigid, ModelSize::Modal, ModelSize::Full] {
            let scene = scene(model);
            let mut plain = Motion::new(&scene.checked().unwrap());
            let mut adopting = plain.clone();
            // Under the pulse, in flight, between impacts, and locked.
            for t in [2e-5, 1.5e-4, 1e-3, 8e-3] {
                plain.advance(t).unwrap();
                adopting.advance(t).unwrap();
                adopting.set_parameters(&scene.checked().unwrap());
            }
            plain.advance(0.02).unwrap();
            adopting.advance(0.02).unwrap();
            let (a, b) = (plain.state(), adopting.state());
            // Round-off of blocks cut elsewhere, against a clearance of 1e-4.
            assert!((a.u[0] - b.u[0]).hypot(a.u[1] - b.u[1]) < 1e-12, "{a:?} {b:?}");
            assert_eq!(plain.contacts().impact_count, adopting.contacts().impact_count);
            assert_eq!(plain.contacts().active_set, adopting.contacts().active_set);
        }
    }

    #[test]
    fn a_new_damping_decays_at_its_own_rate_from_there_on() {
        let mut scene = scene(ModelSize::Modal);
        scene.operation.pulse_n = 0.0;
        scene.initial.u_c_m = 5e-5;
        let mut motion = Motion::new(&scene.checked().unwrap());
        motion.advance(2e-3).unwrap();
        let before = motion.state();
        scene.casing.damping_ratio *= 3.0;
        motion.set_parameters(&scene.checked().unwrap());
        let after = motion.state();
        assert_eq!(before.u, after.u);
        // The other run starts with the new damping from where the change was made.
        let mut changed = scene.clone();
        [changed.initial.u_c_m, changed.initial.u_s_m] = after.u;
        [changed.initial.v_c_m_s, changed.initial.v_s_m_s] = after.v;
        let mut other = Motion::new(&changed.checked().unwrap());
        motion.advance(7e-3).unwrap();
        other.advance(5e-3).unwrap();
        let (here, there) = (motion.state().u[0], other.state().u[0]);
        // The mean rate of the step before is kept: h/2 times the change of
        // acceleration, 2 zeta omega v, is 1e-9 of an amplitude of 5e-5.
        assert!((here - there).abs() < 5e-9, "{here} {there}");
        assert!((here - there).abs() < 1e-3 * here.abs(), "{here} {there}");
    }

    #[test]
    fn another_pulse_waits_for_the_next_fire() {
        let mut scene = scene(ModelSize::Modal);
        let mut motion = Motion::new(&scene.checked().unwrap());
        motion.advance(1e-5).unwrap();
        scene.operation.pulse_n = 5.0;
        scene.operation.pulse_s = 1e-4;
        motion.set_parameters(&scene.checked().unwrap());
        assert_eq!(motion.pulse().force, Scene::base().operation.pulse_n);
        motion.advance(3e-3).unwrap();
        motion.fire();
        let pulse = motion.pulse();
        assert_eq!(pulse.force, 5.0);
        assert!((pulse.end - pulse.start - 1e-4).abs() < 1e-15);
    }

    #[test]
    fn what_needs_another_motion_changes_nothing() {
        let base = scene(ModelSize::Modal);
        let turns: [fn(&mut Scene); 6] = [
            |scene| scene.bladed_disk.blades = 21,
            |scene| scene.operation.nodal_diameters = 4,
            |scene| scene.casing.radius_m += 1e-5,
            |scene| scene.solver.step_s = 2e-6,
            |scene| scene.solver.model = ModelSize::Full,
            |scene| scene.solver.kind = SolverKind::Event,
        ];
        for turn in turns {
            let mut other = base.clone();
            turn(&mut other);
            for (from, to) in [(&base, &other), (&other, &base)] {
                assert!(!Change::is_live(from, to), "{other:?}");
                let mut motion = Motion::new(&from.checked().unwrap());
                let before = format!("{motion:?}");
                motion.set_parameters(&to.checked().unwrap());
                assert_eq!(format!("{motion:?}"), before);
            }
        }
        let mut softer = base.clone();
        softer.casing.modal_stiffness_n_per_m *= 0.5;
        assert!(Change::is_live(&base, &softer));
    }
}
