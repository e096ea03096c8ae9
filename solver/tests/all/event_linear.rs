//! The event solver beyond the paper's model: the end of a divergent run. Numbers of two other codes
//! are in docs/numbers.csv.

use crate::keys::{KAPPA, MU, PULSE, SPEED};
use rubscope_solver::motion::{Sample, Sampling, Script, Verdict, run_to_end};
use rubscope_solver::scene::CheckedScene;

pub fn scene(model: &str, changes: &[(&str, f64)]) -> CheckedScene {
    crate::event_cases::scene_of(model, changes).checked().unwrap()
}

#[test]
fn a_divergent_run_ends_in_one_state_with_its_energy() {
    let keys = [(KAPPA, 0.58), (MU, 0.27), (SPEED, 517.0), (PULSE, 15699.0)];
    let mut scene = scene("modal", &keys).into_scene();
    scene.solver.end_s = 0.05;
    let scene = scene.checked().unwrap();
    let mut last = None;
    let sampling = Sampling { intervals: 200_000, gaps: false };
    let mut keep = |sample: &Sample| last = Some(sample.state);
    let report = run_to_end(&scene, &Script::default(), sampling, &mut keep);
    assert_eq!(report.outcome.verdict, Verdict::Divergent);
    let (last, end) = (last.unwrap(), &report.r#final);
    // A quarter of a microsecond between samples: nothing moves far.
    let later = end.t_s - last.t_s;
    assert!((0.0..=2.5e-7).contains(&later), "{later}");
    let moved = (end.alpha_c_rad - last.alpha[0]).hypot(end.alpha_s_rad - last.alpha[1]);
    let rate = last.alpha_rate[0].hypot(last.alpha_rate[1]);
    assert!(moved <= 1.1 * rate * later + 1e-12, "{moved} in {later}");
    assert!(end.alpha_c_rad.hypot(end.alpha_s_rad) > 0.1, "the state is that which was told");
    let ledger = report.energy.unwrap();
    let residual = report.checks.energy_residual_j.unwrap();
    assert!((ledger.residual() - residual).abs() <= 1e-9 * ledger.stored_j);
    assert!(residual.abs() <= 1e-9 * ledger.stored_j, "{residual} of {ledger:?}");
    assert!(ledger.friction_heat_j > 0.0 && ledger.rotor_work_j > ledger.stored_j, "{ledger:?}");
    let message = report.outcome.message.unwrap();
    assert!(message.starts_with("left the range of the model at t = 2.6"), "{message}");
}
