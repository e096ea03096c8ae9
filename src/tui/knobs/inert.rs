//! Knobs that cannot change the run as the others stand, and why.

use super::Knob;
use crate::scene::{ModelSize, Scene, SolverKind};

impl Knob {
    /// The reason why this knob does not change the run of a scene, if it does not.
    pub fn inert(&self, scene: &Scene) -> Option<&'static str> {
        let rigid = scene.solver.model == ModelSize::Rigid;
        let event = scene.solver.kind == SolverKind::Event;
        let uncoupled = scene.operation.nodal_diameters == 0;
        let modal = scene.solver.model == ModelSize::Modal;
        match self.path {
            "solver.step_s" if event => Some("the event solver has no steps"),
            "operation.pulse_n" if scene.operation.pulse_s == 0.0 => Some("the pulse time is 0"),
            "operation.pulse_s" if scene.operation.pulse_n == 0.0 => Some("the pulse is 0"),
            "bladed_disk.damping_ratio"
            | "bladed_disk.stiffness_nm_per_rad"
            | "bladed_disk.coupling_nm_per_rad"
            | "bladed_disk.inertia_kg_m2"
                if rigid =>
            {
                Some("the blades of the rigid model do not move")
            }
            "bladed_disk.coupling_nm_per_rad" if modal && uncoupled => {
                Some("with n_d = 0 all blades move alike")
            }
            "excitation.amplitude_nm" | "excitation.order" if rigid => {
                Some("the blades of the rigid model do not move")
            }
            "excitation.amplitude_nm" | "excitation.order" if event => {
                Some("the event solver takes no torque")
            }
            "excitation.order" if scene.excitation.amplitude_nm == 0.0 => {
                Some("the EO torque is 0")
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::KNOBS;
    use super::*;
    use crate::motion::simulate;

    /// Scenes of which each has other inert knobs.
    const CASES: [&[(&str, &str)]; 7] = [
        &[],
        &[("solver.kind", "event"), ("solver.contact", "unilateral")],
        &[("solver.kind", "event"), ("solver.contact", "unilateral"), ("solver.model", "rigid")],
        &[("solver.model", "rigid")],
        &[("operation.pulse_n", "0"), ("initial.v_c_m_s", "0.2")],
        &[("operation.pulse_s", "0"), ("initial.v_c_m_s", "0.2"), ("solver.model", "full")],
        &[("operation.nodal_diameters", "0")],
    ];

    #[test]
    fn turning_an_inert_knob_does_not_change_the_run() {
        let mut seen = std::collections::BTreeSet::new();
        for case in CASES {
            let mut changes = vec![
                ("solver.step_s", "1e-6"),
                ("solver.end_s", "5e-3"),
                ("operation.pulse_n", "2e4"),
            ];
            changes.extend(case);
            let scene = Scene::builtin("paper-nd3").unwrap().with(&changes).unwrap();
            let before = simulate(&scene);
            for knob in KNOBS.iter().filter(|knob| knob.inert(&scene).is_some()) {
                for (up, coarse) in [(true, false), (true, true), (false, true)] {
                    let value = knob.turned(&knob.get(&scene), up, coarse, &scene);
                    // What is refused changes nothing either.
                    let Ok((turned, _)) = knob.set(&scene, value) else { continue };
                    let after = simulate(&turned);
                    assert_eq!(after.outcome, before.outcome, "{} {case:?}", knob.label);
                    assert_eq!(after.r#final, before.r#final, "{} {case:?}", knob.label);
                    assert_eq!(after.impact_count, before.impact_count, "{}", knob.label);
                }
                seen.insert(knob.path);
            }
        }
        assert_eq!(seen.len(), 9, "{seen:?}");
    }

    #[test]
    fn a_knob_that_is_not_inert_changes_some_run() {
        // A weak and a strong pulse: a lock forgets how it began.
        let scenes = ["2e4", "1e6"].map(|pulse| {
            let changes =
                [("solver.step_s", "1e-6"), ("solver.end_s", "5e-3"), ("operation.pulse_n", pulse)];
            Scene::builtin("paper-nd3").unwrap().with(&changes).unwrap()
        });
        let runs = scenes.each_ref().map(simulate);
        for knob in KNOBS.iter().filter(|knob| knob.inert(&scenes[0]).is_none()) {
            let changes = scenes.iter().zip(&runs).any(|(scene, before)| {
                let turned = |up| {
                    let value = knob.turned(&knob.get(scene), up, true, scene);
                    knob.set(scene, value).ok()
                };
                let (after, _) = turned(true).or_else(|| turned(false)).unwrap();
                let after = simulate(&after);
                after.r#final != before.r#final || after.outcome != before.outcome
            });
            assert!(changes || knob.path == "solver.kind", "{}", knob.label);
        }
    }
}
