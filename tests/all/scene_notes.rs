//! Runs the numbers in the scene notes and in docs/accuracy.md that no other test checks.

use rubscope::motion::{ActiveSet, Motion, RunReport, Verdict, simulate};
use rubscope::scene::Scene;

fn scene(name: &str, changes: &[(&str, &str)]) -> Scene {
    Scene::builtin(name).unwrap().with(changes).unwrap().into_scene()
}

fn run(name: &str, changes: &[(&str, &str)]) -> RunReport {
    simulate(&scene(name, changes).checked().unwrap())
}

fn says(name: &str, words: &str) {
    let note = Scene::builtin(name).unwrap().note;
    assert!(note.contains(words), "{name}: {note}");
}

/// The first time without contact, checked every 0.1 ms \[s\].
fn first_break(mut motion: Motion, from: f64, until: f64) -> Option<f64> {
    let looks = ((until - from) / 1e-4).round() as u32;
    (1..=looks).map(|look| from + 1e-4 * f64::from(look)).find(|&t| {
        motion.advance(t).unwrap();
        motion.contacts().active_set == ActiveSet::Nothing
    })
}

#[test]
fn a_little_below_the_critical_speed_the_wave_slips_for_seconds() {
    says(
        "near-critical",
        "slips from blade to blade, for 3.25 s without a break, and then bounces",
    );
    says("near-critical", "a little faster than the rotor");
    let slower = ("operation.speed_rad_s", "292.8");
    for (end, verdict) in [("0.1", Verdict::Slip), ("3", Verdict::Slip), ("5", Verdict::Bounce)] {
        for model in ["rigid", "modal"] {
            let changes = [slower, ("solver.end_s", end), ("solver.model", model)];
            let outcome = run("near-critical", &changes).outcome;
            assert_eq!(outcome.verdict, verdict, "{model} to {end} s");
            let wave = outcome.wave_speed_rad_s.unwrap();
            assert!((293.3..293.7).contains(&wave), "{wave} rad/s to {end} s");
        }
    }
    let started = Motion::new(&scene("near-critical", &[slower]).checked().unwrap());
    let broken = first_break(started, 0.0, 5.0).unwrap();
    assert!((broken - 3.25).abs() < 5e-3, "{broken}");
    // The same when it is slowed down while locked.
    let mut locked = Motion::new(&scene("near-critical", &[]).checked().unwrap());
    locked.advance(0.05).unwrap();
    assert!(matches!(locked.contacts().active_set, ActiveSet::Corner(..)));
    locked.set_speed(292.8, 0.0);
    let broken = first_break(locked, 0.05, 5.0).unwrap();
    assert!((broken - 0.05 - 3.25).abs() < 5e-3, "{broken}");
}

#[test]
fn the_smallest_pulse_that_touches_to_the_hundredth_of_a_newton() {
    says("grazing", "The smallest pulse that touches is 3795.03 N");
    says("grazing", "with 3795.02 N no blade is touched");
    says("grazing", "one soft touch after 1.7 ms");
    let touches = |pulse: &str| {
        // Long enough for it to decay.
        run("grazing", &[("operation.pulse_n", pulse), ("solver.end_s", "0.3")])
    };
    assert_eq!((touches("3795.03").impact_count, touches("3795.02").impact_count), (1, 0));
    let soft = touches("3796");
    assert_eq!((soft.impact_count, soft.outcome.verdict), (1, Verdict::Decay));
    assert!((soft.impacts[0].t_s - 1.7e-3).abs() < 5e-5, "{:?}", soft.impacts);
}

#[test]
fn slip_may_turn_slower_or_faster_and_along_one_side() {
    // Slower than the rotor, over the corners.
    let wave = run("slip", &[]).outcome.wave_speed_rad_s.unwrap();
    assert!(wave < 400.0, "{wave}");
    // Faster, along a side that no corner ends.
    let report = run("half-n", &[]);
    assert_eq!(report.outcome.verdict, Verdict::Slip);
    assert!(report.outcome.wave_speed_rad_s.unwrap() > 100.0, "{:?}", report.outcome);
    assert_eq!(report.outcome.contacts.len(), 1);
}

#[test]
fn round_off_of_a_multiplier_at_the_smallest_step() {
    // A lock whose two pushes are 0.0654 N each. At h = 1e-8 s each may be
    // 1e-20 m / (h^2/m_c) = 2e-4 N off; the step's own error is 3e-6 N.
    let exact = run("near-critical", &[]).outcome.contacts[0].multiplier_n;
    let small = [("solver.kind", "explicit"), ("solver.step_s", "1e-8"), ("solver.end_s", "0.01")];
    let outcome = run("near-critical", &small).outcome;
    assert_eq!(outcome.verdict, Verdict::Locked);
    for contact in outcome.contacts {
        assert!((contact.multiplier_n - exact).abs() < 4e-4, "{contact:?} {exact}");
    }
}

#[test]
fn without_damping_the_impacts_of_a_second_are_sensitive() {
    says("undamped", "A run of one second is sensitive");
    let changes = [("solver.kind", "event")];
    assert!(!run("undamped", &changes).outcome.sensitive);
    let changes = [("solver.kind", "event"), ("solver.end_s", "1")];
    assert!(run("undamped", &changes).outcome.sensitive);
}
