//! When a knob has no effect because of the values of others.

use rubscope_solver::scene::{ContactLaw, ModelSize, Scene, SolverKind};

/// Function that returns why a knob has no effect in a scene; `None` if it has an effect.
pub type Inert = fn(&Scene) -> Option<&'static str>;

const STILL: &str = "the blades of the rigid model do not move";

/// Defines functions of type [`Inert`], each by a condition on the scene and a reason.
macro_rules! inert {
    ($($name:ident: |$scene:ident| $when:expr => $why:expr;)+) => {
        $(pub fn $name($scene: &Scene) -> Option<&'static str> { ($when).then_some($why) })+
    };
}

inert! {
    rigid: |scene| scene.solver.model == ModelSize::Rigid => STILL;
    without_time: |scene| scene.operation.pulse_s == 0.0 => "the pulse time is 0";
    without_pulse: |scene| scene.operation.pulse_n == 0.0 => "the pulse is 0";
    step: |scene| scene.solver.kind == SolverKind::Event => "the event solver has no steps";
    lining: |scene| scene.solver.contact != ContactLaw::Smooth => "only the smooth law has a lining";
    restitution: |scene| scene.solver.contact == ContactLaw::Smooth => "only rigid contact rebounds";
    not_modal: |scene| scene.solver.model != ModelSize::Modal => "only the modal model uses n_b";
    not_full: |scene| scene.solver.model != ModelSize::Full => "only the full model has individual blades";
    friction: |scene| scene.solver.model == ModelSize::Rigid && scene.casing.tangential_ratio == 0.0 => "rigid blades and a radial casing do not feel friction";
    tangential: |scene| scene.contact.friction == 0.0 => "without friction nothing pulls the casing along";
    equal_tips: |scene| scene.bladed_disk.tip_scatter_m == 0.0 => "the tip scatter is 0";
    centred: |scene| scene.bladed_disk.orbit_m == 0.0 => "the orbit is 0";
    without_lobes: |scene| scene.casing.lobes == 0 => "there are no lobes";
    round: |scene| scene.casing.out_of_round_m == 0.0 => "the casing is round";
}

pub fn draw(scene: &Scene) -> Option<&'static str> {
    let none = (scene.bladed_disk.mistuning == 0.0).then_some("the mistuning is 0");
    not_full(scene).or(none)
}

pub fn coupling(scene: &Scene) -> Option<&'static str> {
    let beside = scene.bladed_disk.diameters_beside(scene.operation.nodal_diameters);
    let alike = scene.solver.model == ModelSize::Modal && beside == 0;
    rigid(scene).or(alike.then_some("with n_d = 0 all blades move alike"))
}

pub fn order(scene: &Scene) -> Option<&'static str> {
    let none = (scene.excitation.amplitude_nm == 0.0).then_some("the EO torque is 0");
    rigid(scene).or(none)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::knobs::{Group, KNOBS, Knob};
    use rubscope_solver::motion::simulate;

    /// Changes of the scene; each makes other knobs inert.
    const CASES: [&[(&str, &str)]; 8] = [
        &[],
        &[("solver.kind", "event"), ("solver.contact", "unilateral")],
        &[("solver.kind", "event"), ("solver.contact", "unilateral"), ("solver.model", "rigid")],
        &[("solver.model", "rigid")],
        &[("operation.pulse_n", "0"), ("initial.v_c_m_s", "0.2")],
        &[("operation.pulse_s", "0"), ("initial.v_c_m_s", "0.2"), ("solver.model", "full")],
        &[("operation.nodal_diameters", "0")],
        &[("solver.contact", "smooth"), ("contact.stiffness_n_per_m", "1e8")],
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
                    // A refused value has no effect either.
                    let Ok((turned, _)) = knob.set(&scene, value) else { continue };
                    let after = simulate(&turned);
                    assert_eq!(after.outcome, before.outcome, "{} {case:?}", knob.label);
                    assert_eq!(after.r#final, before.r#final, "{} {case:?}", knob.label);
                    assert_eq!(after.impact_count, before.impact_count, "{}", knob.label);
                }
                seen.insert(knob.path);
            }
        }
        assert_eq!(seen.len(), 24, "{seen:?}");
    }

    #[test]
    fn a_knob_that_is_not_inert_changes_some_run() {
        // With a weak and a strong pulse, because a lock does not depend on how it began.
        let scenes = ["2e4", "1e6"].map(|pulse| {
            let changes =
                [("solver.step_s", "1e-6"), ("solver.end_s", "5e-3"), ("operation.pulse_n", pulse)];
            Scene::builtin("paper-nd3").unwrap().with(&changes).unwrap()
        });
        let runs = scenes.each_ref().map(simulate);
        let papers = |knob: &&Knob| knob.group != Group::Beyond;
        for knob in KNOBS.iter().filter(papers).filter(|knob| knob.inert(&scenes[0]).is_none()) {
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

    #[test]
    fn what_is_beyond_the_paper_changes_a_run_unless_it_is_inert() {
        let common = [
            ("solver.step_s", "1e-6"),
            ("solver.end_s", "3e-3"),
            ("solver.contact", "unilateral"),
            ("operation.pulse_n", "1e5"),
            ("operation.speed_rad_s", "450"),
            ("bladed_disk.radial_coupling", "0.3"),
            ("contact.friction", "0.15"),
            ("casing.tangential_ratio", "0.3"),
        ];
        let cases: [&[(&str, &str)]; 3] = [
            &[],
            &[("solver.contact", "smooth")],
            &[("solver.model", "full"), ("bladed_disk.mistuning", "0.02")],
        ];
        let mut seen = std::collections::BTreeSet::new();
        for case in cases {
            let changes: Vec<_> = common.iter().chain(case).copied().collect();
            let scene = Scene::base().with(&changes).unwrap();
            let before = simulate(&scene);
            let beyond = |knob: &&Knob| knob.group == Group::Beyond && knob.inert(&scene).is_none();
            for knob in KNOBS.iter().filter(beyond) {
                let value = knob.turned(&knob.get(&scene), true, true, &scene);
                // Rigid contact requires the casing's nodal diameters; the smooth law does not.
                let Ok((turned, _)) = knob.set(&scene, value) else {
                    assert_eq!(knob.path, "bladed_disk.nodal_diameters");
                    assert!(!case.contains(&("solver.contact", "smooth")));
                    continue;
                };
                let after = simulate(&turned);
                assert_ne!(after.r#final, before.r#final, "{} {case:?}", knob.label);
                seen.insert(knob.path);
            }
        }
        assert_eq!(seen.len(), Group::Beyond.knobs().count(), "{seen:?}");
    }

    #[test]
    fn those_that_are_turned_and_those_of_a_lining_leave_the_paper() {
        let of = |scene: &Scene| -> Vec<&str> {
            let knobs = KNOBS.iter().filter(|knob| knob.leaves_the_paper(scene));
            knobs.map(|knob| knob.label).collect()
        };
        let mut scene = Scene::base();
        scene.operation.speed_rad_s = 430.0;
        assert_eq!(of(&scene), [""; 0]);
        scene.bladed_disk.radial_coupling = 0.5;
        scene.solver.contact = ContactLaw::Smooth;
        assert_eq!(of(&scene), ["tip slope κ", "lining k_p", "lining eps"]);
    }
}
