//! Other parameters for a motion that is under way: dampings, masses,
//! stiffnesses, contact law and the pulse to fire next, from this step on.
//!
//! Displacements and increments go on as they are, so that positions and the
//! mean rates of the last step have no jump.

use super::{Blades, Excitation, Explicit, Oscillator};
use crate::model::Rim;
use crate::motion::Pulse;
use crate::scene::{Scene, SolverKind};

/// Whether a motion of one checked scene can take over the parameters of
/// another while it runs. The same answer as `Motion::adopt`, without a motion.
#[must_use]
pub fn can_adopt(before: &Scene, after: &Scene) -> bool {
    let (old, new) = (&before.solver, &after.solver);
    [old, new].iter().all(|solver| solver.kind == SolverKind::Explicit)
        && old.model == new.model
        && old.step_s == new.step_s
        && same_polygon(&before.machine().rim, &after.machine().rim)
}

fn same_polygon(a: &Rim, b: &Rim) -> bool {
    a.blades == b.blades && a.nodal_diameters == b.nodal_diameters && a.clearance == b.clearance
}

impl<B: Blades> Explicit<B> {
    /// From the latest step on, moves with the parameters of a checked scene.
    /// Time, coordinates, rates, rotor, the pulse under way and the record of
    /// contacts stay. False, and nothing changes, where the scene has another
    /// number of blades or nodal diameters, another clearance or another step.
    pub fn adopt(&mut self, scene: &Scene) -> bool {
        let machine = scene.machine();
        if !same_polygon(&machine.rim, &self.machine.rim) || scene.solver.step_s != self.step {
            return false;
        }
        self.interrupt();
        self.blades = B::at_rest(scene, &machine).moving_as(&self.blades);
        self.casing = Oscillator::new(
            machine.casing_mass,
            machine.casing_damping,
            machine.casing_stiffness,
            self.step,
        );
        self.machine = machine;
        self.law = scene.solver.contact;
        self.casing_radius = scene.casing.radius_m;
        self.excitation = Excitation::of(scene);
        self.next_pulse = Pulse::of(scene);
        self.neighbours_matter = self.neighbours_matter();
        true
    }
}

#[cfg(test)]
mod tests {
    use super::can_adopt;
    use crate::motion::Motion;
    use crate::scene::{ModelSize, Scene, SolverKind};

    fn scene(model: ModelSize) -> Scene {
        let mut scene = Scene::default();
        scene.solver.model = model;
        scene.solver.step_s = 1e-6;
        scene
    }

    #[test]
    fn adopting_the_same_scene_changes_nothing() {
        for model in [ModelSize::Rigid, ModelSize::Modal, ModelSize::Full] {
            let scene = scene(model);
            let mut plain = Motion::new(&scene);
            let mut adopting = plain.clone();
            // Under the pulse, in flight, between impacts, and locked.
            for t in [2e-5, 1.5e-4, 1e-3, 8e-3] {
                plain.advance(t).unwrap();
                adopting.advance(t).unwrap();
                assert!(adopting.adopt(&scene));
            }
            plain.advance(0.02).unwrap();
            adopting.advance(0.02).unwrap();
            let (a, b) = (plain.state(), adopting.state());
            // Round-off of blocks cut elsewhere, against a clearance of 1e-4.
            assert!((a.u[0] - b.u[0]).hypot(a.u[1] - b.u[1]) < 1e-12, "{a:?} {b:?}");
            assert_eq!(plain.contacts().impact_count, adopting.contacts().impact_count);
            assert_eq!(plain.contacts().touching, adopting.contacts().touching);
        }
    }

    #[test]
    fn a_new_damping_decays_at_its_own_rate_from_there_on() {
        let mut scene = scene(ModelSize::Modal);
        scene.operation.pulse_n = 0.0;
        scene.initial.u_c_m = 5e-5;
        let mut motion = Motion::new(&scene);
        motion.advance(2e-3).unwrap();
        let before = motion.state();
        scene.casing.damping_ratio *= 3.0;
        assert!(motion.adopt(&scene));
        let after = motion.state();
        assert_eq!(before.u, after.u);
        // The other run starts with the new damping from where the change was made.
        let mut changed = scene.clone();
        [changed.initial.u_c_m, changed.initial.u_s_m] = after.u;
        [changed.initial.v_c_m_s, changed.initial.v_s_m_s] = after.v;
        let mut other = Motion::new(&changed);
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
        let mut motion = Motion::new(&scene);
        motion.advance(1e-5).unwrap();
        scene.operation.pulse_n = 5.0;
        scene.operation.pulse_s = 1e-4;
        assert!(motion.adopt(&scene));
        assert_eq!(motion.pulse().force, Scene::default().operation.pulse_n);
        motion.advance(3e-3).unwrap();
        motion.fire();
        let pulse = motion.pulse();
        assert_eq!(pulse.force, 5.0);
        assert!((pulse.end - pulse.start - 1e-4).abs() < 1e-15);
    }

    #[test]
    fn what_needs_another_motion_is_refused() {
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
            for (before, after) in [(&base, &other), (&other, &base)] {
                assert!(!Motion::new(before).adopt(after) && !can_adopt(before, after));
            }
        }
        let mut softer = base.clone();
        softer.casing.modal_stiffness_n_per_m *= 0.5;
        assert!(Motion::new(&base).adopt(&softer) && can_adopt(&base, &softer));
    }
}
