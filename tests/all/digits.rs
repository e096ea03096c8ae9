//! Which digits of a run hold: its spread, and the text that leaves the others out.

use rubscope_solver::motion::{Contact, RunReport, Spread, simulate};
use rubscope_solver::scene::{CheckedScene, Scene};

fn plain(scene: &CheckedScene) -> RunReport {
    crate::run_once(scene)
}

fn with_pulse(scene: &CheckedScene, factor: f64) -> CheckedScene {
    let mut scene = scene.clone().into_scene();
    scene.operation.pulse_n *= factor;
    scene.checked().unwrap()
}

#[test]
fn the_spread_is_how_far_changed_runs_end_from_the_run() {
    let scene = Scene::builtin("paper-nd3").unwrap().as_reference();
    for (speed, pulse) in [(500.0, 20e3), (300.0, 150e3), (470.0, 700e3), (355.0, 440e3)] {
        let mut scene = scene.clone();
        (scene.operation.speed_rad_s, scene.operation.pulse_n) = (speed, pulse);
        let scene = scene.checked().unwrap();
        let report = simulate(&scene);
        let spread = report.outcome.spread.clone().unwrap();
        for factor in [1.0 + 1e-9, 1.0 - 1e-9] {
            let other = plain(&with_pulse(&scene, factor));
            let moved = |number: fn(&RunReport) -> f64| (number(&other) - number(&report)).abs();
            for (moved, most) in [
                (moved(|run| run.outcome.amplitude_m), spread.amplitude_m),
                (moved(|run| run.r#final.u_c_m), spread.u_c_m),
                (moved(|run| run.r#final.u_s_m), spread.u_s_m),
                (moved(|run| run.r#final.alpha_c_rad), spread.alpha_c_rad),
                (moved(|run| run.r#final.alpha_s_rad), spread.alpha_s_rad),
                (moved(|run| run.r#final.t_s), spread.t_s),
            ] {
                assert!(moved <= most.unwrap(), "{pulse}: {moved:e} {most:?}");
            }
        }
    }
}

#[test]
fn a_number_that_a_changed_run_does_not_have_has_no_spread() {
    // Locked in another corner by each of the tiny changes.
    let changes = [("solver.model", "rigid"), ("casing.damping_ratio", "0")];
    let mut scene = Scene::builtin("paper-nd3").unwrap().as_reference();
    changes.iter().for_each(|(key, value)| scene.set(key, value).unwrap());
    (scene.operation.pulse_n, scene.solver.end_s) = (2_512_435.6, 0.2);
    let scene = scene.checked().unwrap();
    let report = simulate(&scene);
    let groups = |run: &RunReport| -> Vec<_> {
        run.outcome.contacts.iter().map(|group| group.blades.clone()).collect()
    };
    assert_ne!(groups(&report), groups(&plain(&with_pulse(&scene, 1.0 + 1e-9))));
    let spread = report.outcome.spread.clone().unwrap();
    assert_eq!(spread.multipliers_n, [None, None]);
    assert!(spread.amplitude_m.is_some());
    let text = crate::told(&report);
    assert!(
        text.contains(" pushes with about 200 N") && text.contains("has no reliable digit"),
        "{text}"
    );
}

/// Numbers that move by amounts of their own are each told in the digits that hold.
#[test]
fn each_number_is_told_in_its_own_digits() {
    let mut scene = Scene::builtin("paper-nd3").unwrap();
    (scene.solver.step_s, scene.solver.end_s) = (1e-6, 1e-3);
    let mut report = simulate(&scene.checked().unwrap());
    let touch = |multiplier_n: f64, blades: &[u32]| {
        let mut contact = Contact { blades: Vec::new(), multiplier_n };
        contact.blades.extend(blades);
        contact
    };
    let spread = report.outcome.spread.clone().unwrap();
    let outcome = &mut report.outcome;
    outcome.lock_time_s = Some(0.012_345_6);
    outcome.amplitude_m = 2.686_35e-6;
    outcome.wave_speed_rad_s = Some(413.257);
    outcome.contacts = vec![touch(-244.416, &[6]), touch(-57.2951, &[17])];
    outcome.spread = Some(Spread {
        lock_time_s: Some(1e-5),
        amplitude_m: Some(5.33e-9),
        wave_speed_rad_s: Some(0.3),
        multipliers_n: vec![Some(0.004), Some(0.4)],
        ..spread.clone()
    });
    let text = crate::told(&report);
    for words in [
        "same blades since 12.3 ms.",
        "Blade 6 pushes with 244.42 N",
        "Blade 17 pushes with 57 N",
        "at the end: 2.7e-6 m, 0.027 of the clearance.",
        "The wave turns at 413 rad/s.",
    ] {
        assert!(text.contains(words), "no {words} in {text}");
    }
    // Of many, the sum moves by what all move by.
    report.outcome.contacts = (1..=5).map(|blade| touch(-10.1234, &[blade])).collect();
    report.outcome.spread = Some(Spread { multipliers_n: vec![Some(0.04); 5], ..spread });
    let text = crate::told(&report);
    assert!(text.contains("2 more together push with 51 N at the end."), "{text}");
}

#[test]
fn every_penetration_above_round_off_is_told() {
    let mut scene = Scene::base();
    scene.solver.end_s = 1e-4;
    let mut report = simulate(&scene.checked().unwrap());
    for (part, is_told) in [(0.0, false), (1e-14, false), (1e-12, true), (5e-3, true)] {
        report.checks.max_penetration_m = part * scene.machine().clearance();
        let text = crate::told(&report);
        let line = text.lines().find(|line| line.starts_with("Deepest penetration:")).unwrap();
        assert_eq!(line.ends_with(" of the clearance."), is_told, "{part}: {line}");
    }
}
