//! Work has bounds, and what passes them is told by name: scenes that once ran
//! for minutes or for ever, and those next to a bound that must still run. A case is a scene and
//! the words of its outcome.

use rubscope_solver::motion::{Motion, Verdict, simulate};
use rubscope_solver::scene::Scene;

use crate::plain::scenes::scene;

fn outcome(scene: &Scene) -> (Verdict, String) {
    let outcome = simulate(&scene.checked().unwrap()).outcome;
    (outcome.verdict, outcome.message.unwrap_or_default())
}

/// A rim of thousands of blades, nearly a circle: a step reaches many of them.
fn many_blades(contact: &str, nd: &str, step: &str) -> Scene {
    let mut scene = scene(&[
        ("bladed_disk.blades", "4090"),
        ("operation.nodal_diameters", nd),
        ("operation.pulse_n", "2e5"),
        ("solver.model", "rigid"),
        ("solver.contact", contact),
        ("solver.step_s", step),
    ]);
    scene.solver.end_s = 1e-3;
    scene
}

#[test]
fn as_many_rows_as_there_are_sides_are_solved_where_they_only_push() {
    let (verdict, message) = outcome(&many_blades("unilateral", "1", "4e-6"));
    assert_eq!(verdict, Verdict::Decay, "{message}");
}

#[test]
fn too_many_rows_to_be_closed_together_are_told() {
    let (verdict, message) = outcome(&many_blades("bilateral", "1", "1e-5"));
    assert_eq!(verdict, Verdict::Failed);
    assert!(message.contains("rows penetrate in one step, and at most 512"), "{message}");
}

#[test]
fn a_side_that_lets_go_and_closes_by_round_off_does_not_hang() {
    // Exactly at the critical speed, slowly speeding up, on a side without a push:
    // one of the runs for sensitivity went on in steps of 5e-324 s.
    let scene = scene(&[
        ("solver.kind", "event"),
        ("solver.contact", "unilateral"),
        ("solver.model", "rigid"),
        ("bladed_disk.blades", "24"),
        ("operation.nodal_diameters", "32"),
        ("bladed_disk.blade_length_m", "0.49999988539389134"),
        ("casing.damping_ratio", "0"),
        ("operation.speed_rad_s", "27.457353295610996"),
        ("operation.speed_ramp_rad_s2", "0.23702106901768974"),
        ("operation.pulse_n", "0"),
        ("initial.u_c_m", "5.730305432938227e-08"),
        ("initial.u_s_m", "-9.925180152736987e-08"),
        ("initial.v_c_m_s", "8.720613695241145e-05"),
        ("initial.v_s_m_s", "5.034848664446209e-05"),
        ("solver.end_s", "0.05"),
    ]);
    let outcome = simulate(&scene.checked().unwrap()).outcome;
    assert_eq!(outcome.verdict, Verdict::Decay, "{outcome:?}");
    // None of those runs fails.
    assert_eq!(outcome.ends_otherwise, Some(false), "{outcome:?}");
}

/// Full angles may leave a step without an answer where the linearised model has one.
#[test]
fn a_step_without_an_answer_says_why_where_friction_digs_in() {
    let mut scene = Scene::builtin("digs-in").unwrap();
    scene.set("contact.friction", "4.2").unwrap();
    scene.set("bladed_disk.radial_coupling", "-2.1").unwrap();
    scene.set("solver.end_s", "1e-3").unwrap();
    let mut motion = Motion::new(&scene.checked().unwrap());
    assert!(motion.advance(1e-3).is_err());
    let told = motion.stopped().unwrap();
    let why = "(singular equations); where kappa (kappa + mu) < 0, a push may close the gap";
    assert!(told.contains(why), "{told}");
}
