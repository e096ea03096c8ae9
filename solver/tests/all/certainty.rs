//! What a verdict rests on, and what changes it: proofs, the rate of a linear rest, another
//! step, and a tiny change. A case is the words of a command, a verdict, and what it rests on;
//! a new one is a row of the test that asks for the same.

use rubscope_solver::motion::{
    Basis, Certainty, Proof, RunReport, Script, Verdict, certainty, run_to_verdict,
    run_with_certainty, simulate, to_the_end,
};
use rubscope_solver::scene::CheckedScene;

use crate::run_once;
use crate::tips_support::carried;

fn scene(base: &str, words: &str) -> CheckedScene {
    crate::cases::scene(base, words).checked().unwrap()
}

fn is_proved(report: &RunReport) -> bool {
    matches!(report.outcome.basis, Some(Basis::Proved { .. }))
}

/// A blade that an engine order drives too far makes the run fail, though nothing touches.
#[test]
fn an_excitation_forbids_an_early_decay() {
    let words = "excitation.amplitude_nm 2000 excitation.order 3 speed 95.43 pulse 100 \
                 step 1e-6 end 0.3";
    let early = run_to_verdict(&scene("paper-nd3", words), &to_the_end);
    assert_eq!(early.unwrap().verdict, Verdict::Failed);
}

#[test]
fn what_is_told_to_stop_does_not_know_whether_a_run_is_sensitive() {
    let scene = scene("paper-nd3", "contact unilateral solver event");
    let reached = run_to_verdict(&scene, &to_the_end).unwrap();
    assert_eq!(certainty(&scene, reached, false, &|| false), None);
    assert_eq!(run_with_certainty(&scene, &|| false), None);
}

#[test]
fn a_proved_lock_near_its_limit_holds_in_longer_runs() {
    let mut locked = 0;
    for (machine, speed) in [
        ("bladed_disk.blades 12 nd 1", 1_057.757_253_947_363),
        ("bladed_disk.blades 22 nd 5", 545.492_786_902_743_2),
    ] {
        for apart in [-1e-8, 1e-11, 1e-9, 1e-7, 1e-3] {
            for how in ["solver event", "solver event model rigid", "model modal"] {
                let run = |end: f64| {
                    let near = speed * (1.0 + apart);
                    let words =
                        format!("contact unilateral {how} {machine} speed {near} end {end}");
                    let mut scene = crate::cases::scene("paper-nd3", &words);
                    let machine = scene.machine();
                    let corner = [machine.clearance(), machine.polygon.half_side()];
                    carried(&mut scene, corner.map(|part| (1e-11 - 1.0) * part));
                    simulate(&scene.checked().unwrap())
                };
                let [short, long] = [0.0015, 0.024].map(run);
                if is_proved(&short) {
                    let told =
                        |report: &RunReport| (report.outcome.verdict, report.outcome.lock_time_s);
                    assert_eq!(told(&short), told(&long), "{machine} {apart} {how}");
                    locked += u32::from(short.outcome.verdict == Verdict::Locked);
                }
            }
        }
    }
    assert!(locked > 3, "{locked}");
}

/// Soft blades swing far enough to change a push: what holds now may not hold for good.
#[test]
fn a_corner_of_blades_one_by_one_is_proved_only_where_they_bend_little() {
    for (stiffness, proved) in [(100, true), (10, false)] {
        let words = "model full end 0.002 bladed_disk.coupling_nm_per_rad 0";
        let words = format!("{words} bladed_disk.stiffness_nm_per_rad {stiffness}");
        let report = run_once(&scene("paper-nd3", &words));
        assert_eq!(report.outcome.verdict, Verdict::Locked, "{stiffness}");
        assert_eq!(is_proved(&report), proved, "{stiffness}: {:?}", report.outcome.basis);
    }
}

/// A beat of blades that stay pressed has the verdict and the rate of its linear equations,
/// whatever part of it a run sees; one that lifts blades has none.
#[test]
fn the_rate_of_the_linear_rest_decides_on_a_beat() {
    let one = "contact.smoothing_m 1e-8 nd 1";
    let beat = "bladed_disk.blades 12 casing.radius_m 0.499898 bladed_disk.radial_coupling 0.398 \
                zeta-casing 0";
    let large = "bladed_disk.blades 28 casing.radius_m 0.49983974 zeta-casing 1.2825e-6 \
                 zeta-disk 1.5532e-6 bladed_disk.radial_coupling -0.5479 \
                 contact.stiffness_n_per_m 65252 speed 54.4787 pulse 2209";
    for (words, first, verdict) in [
        ("bladed_disk.radial_coupling 0 zeta-disk 0 pulse 3000".to_string(), 0.1, Verdict::Decay),
        (format!("{one} {beat} speed 20 pulse 1 zeta-disk 1e-7"), 0.02, Verdict::Decay),
        (format!("{one} {beat} speed 20 pulse 1 zeta-disk 0"), 0.02, Verdict::Slip),
        (format!("{one} {beat} speed 406 pulse 100 zeta-disk 1e-7"), 0.05, Verdict::Slip),
        (format!("{one} {large}"), 0.0872, Verdict::Decay),
    ] {
        let rates = [1.0, 2.5, 5.0].map(|times| {
            let scene = scene("coincidence", &format!("{words} end {}", times * first));
            let outcome = run_once(&scene).outcome;
            assert_eq!(outcome.verdict, verdict, "{words} {times}");
            outcome.decay_rate_per_s
        });
        assert!(rates[0] == rates[1] && rates[0] == rates[2], "{words}: {rates:?}");
        assert_eq!(rates[0] > Some(0.0), verdict == Verdict::Decay, "{words}: {rates:?}");
    }
}

#[test]
fn a_verdict_says_what_it_rests_on() {
    let basis = |base: &str, words: &str| {
        let report = run_once(&scene(base, words));
        (report.outcome.verdict, report.outcome.basis, report.outcome.lock_time_s)
    };
    let (verdict, locked, since) = basis("paper-nd3", "");
    let proof = |by, since_s| Some(Basis::Proved { by, since_s });
    assert_eq!((verdict, locked), (Verdict::Locked, proof(Proof::HeldCorner, since.unwrap())));
    let (verdict, decay, _) = basis("paper-nd3", "pulse 1000");
    assert_eq!((verdict, decay), (Verdict::Decay, proof(Proof::NoContact, 0.0)));
    let (verdict, slip, _) = basis("slip", "");
    let Some(Basis::Judged { from_s, to_s }) = slip else { panic!("{verdict} {slip:?}") };
    assert_eq!(verdict, Verdict::Slip);
    assert!((from_s / to_s - 0.9).abs() < 1e-6, "{from_s} {to_s}");
    let (verdict, failed, _) = basis("paper-nd3", "step 1e-6");
    assert_eq!((verdict, failed), (Verdict::Failed, None));
}

#[test]
fn a_verdict_that_another_step_changes_says_so() {
    for (words, depends) in [
        ("speed 320 pulse 30000 step 1e-6", Some(true)),
        ("speed 320 pulse 30000", Some(false)),
        ("zeta-casing 0 contact unilateral step 1e-6", Some(true)),
        ("solver event contact unilateral", None),
        // A run that its step makes fail.
        ("step 6.18e-7", Some(true)),
    ] {
        let scene = scene("paper-nd3", words);
        assert_eq!(simulate(&scene).outcome.depends_on_step, depends, "{words}");
        let (_, certainty) = run_with_certainty(&scene, &to_the_end).unwrap();
        let Certainty { sensitive, depends_on_step, .. } = certainty;
        // A cell of a map does not ask for it where it is sensitive.
        assert!(sensitive || depends_on_step == depends, "{words}");
    }
}

#[test]
fn other_impacts_are_no_other_end() {
    let words = "solver event model rigid contact unilateral pulse 200000";
    let outcome = simulate(&scene("paper-nd3", words)).outcome;
    assert_eq!((outcome.sensitive, outcome.ends_otherwise), (Some(true), Some(false)));
}

#[test]
fn a_run_by_steps_knows_where_events_say_otherwise() {
    for (step, verdict, by_events) in
        [("1e-7", Verdict::Decay, None), ("1e-6", Verdict::Locked, Some(Verdict::Decay))]
    {
        let words = format!("pulse 50000 contact unilateral step {step}");
        let mut report = run_once(&scene("paper-nd3", &words));
        report.ask_events(&Script::default(), &to_the_end);
        assert_eq!((report.outcome.verdict, report.outcome.by_events), (verdict, by_events));
    }
}
