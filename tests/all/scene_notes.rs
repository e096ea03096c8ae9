//! Runs the numbers in the scene notes and in docs/accuracy.md that no other test checks.

use crate::scene_support::{half_n, near_critical};
use crate::{near, scene};
use rubscope_solver::harmonic::Lining;
use rubscope_solver::motion::{ActiveSet, Motion, RunReport, Verdict, simulate};
use rubscope_solver::scene::Scene;

pub fn run(name: &str, changes: &[(&str, &str)]) -> RunReport {
    simulate(&scene(name, changes))
}

fn of(scene: Scene) -> RunReport {
    simulate(&scene.checked().unwrap())
}

pub fn says(name: &str, words: &str) {
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
    let slower = ("operation.speed_rad_s", "292.8");
    for (end, verdict) in [("0.1", Verdict::Slip), ("3", Verdict::Slip), ("5", Verdict::Bounce)] {
        for model in ["rigid", "modal"] {
            let changes = [slower, ("solver.end_s", end), ("solver.model", model)];
            let outcome = of(near_critical().with(&changes).unwrap().into_scene()).outcome;
            assert_eq!(outcome.verdict, verdict, "{model} to {end} s");
            let wave = outcome.wave_speed_rad_s.unwrap();
            assert!((293.3..293.7).contains(&wave), "{wave} rad/s to {end} s");
        }
    }
    let started = Motion::new(&near_critical().with(&[slower]).unwrap());
    let broken = first_break(started, 0.0, 5.0).unwrap();
    assert!((broken - 3.25).abs() < 5e-3, "{broken}");
    // The same when it is slowed down while locked.
    let mut locked = Motion::new(&near_critical().checked().unwrap());
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
fn every_number_of_the_other_notes_is_what_the_program_finds() {
    let blades = |report: &RunReport| -> Vec<Vec<u32>> {
        report.impacts.iter().map(|impact| impact.blades.clone()).collect()
    };
    says("run-down", "touches blades 13 and 20 once each, and decays");
    let down = run("run-down", &[]);
    assert_eq!((blades(&down), down.outcome.verdict), (vec![vec![13], vec![20]], Verdict::Decay));

    says("rocking", "at 58.0 ms the wave is locked, and two blades push it with 150.9 N each");
    says("rocking", "Each crossing reduces its speed by the factor cos(2 delta)");
    let rocking = run("rocking", &[]).outcome;
    near(rocking.lock_time_s.unwrap(), 58.0e-3, 5e-5);
    rocking.contacts.iter().for_each(|contact| near(contact.multiplier_n, -150.9, 0.05));

    says("slip", "turns at about 385 rad/s while the blades turn at 500 rad/s");
    near(run("slip", &[]).outcome.wave_speed_rad_s.unwrap(), 385.0, 0.5);

    says("paper-nd3", "against blade 12, then 19");
    says(
        "paper-nd3",
        "two steps that pull (one, at some time steps). With the unilateral law the motion decays",
    );
    let pulled = |n: u32| {
        let step = (1e-8 * 50_f64.powf(f64::from(n) / 49.0)).to_string();
        let paper = run("paper-nd3", &[("solver.end_s", "0.001"), ("solver.step_s", &step)]);
        assert_eq!(paper.outcome.verdict, Verdict::Locked, "{step}");
        paper.checks.tensile_steps
    };
    let pulls: Vec<u64> = (0..50).map(pulled).collect();
    let one = pulls.iter().filter(|count| **count == 1).count();
    assert!((1..5).contains(&one) && pulls.iter().all(|count| *count <= 2), "{pulls:?}");
    let paper = run("paper-nd3", &[("solver.end_s", "0.001")]);
    assert_eq!((blades(&paper), paper.checks.tensile_steps), (vec![vec![12], vec![19]], 2));

    says("paper-nd4", "Eleven sides with two blades each");
    says(
        "paper-nd4",
        "Omega_c = 256.12 rad/s implies omega_c = 1024.48 rad/s, not the printed 878.63 rad/s",
    );
    let four = scene("paper-nd4", &[]).machine();
    assert_eq!((four.polygon.sides, four.polygon.blades_per_side), (11, 2));
    near(four.omega_c, 1024.48, 5e-3);
    near(four.critical_speed().unwrap(), 256.12, 5e-3);
    // The paper cuts its digits: 878.635.
    near(scene("paper-nd3", &[]).machine().omega_c, 878.63, 1e-2);

    says("adhesive", "with one tensile multiplier");
    let held = run("adhesive", &[("solver.end_s", "0.02")]).outcome;
    assert_eq!(held.contacts.iter().filter(|contact| contact.multiplier_n > 0.0).count(), 1);
}

#[test]
fn imperfect_machines_do_what_their_notes_say() {
    says("long-tip", "drags the wave along with 2.3 N: forced, not locked");
    says("long-tip", "From 292.1 rad/s on");
    says("long-tip", "that blades 1 and 3 form, and both hold the wave for good");
    says("long-tip", "equal tips would need 411.9 rad/s");
    let dragged = run("long-tip", &[("operation.speed_ramp_rad_s2", "0")]).outcome;
    assert_eq!(dragged.verdict, Verdict::Forced);
    assert!((dragged.contacts[0].multiplier_n + 2.3).abs() < 5e-3, "{dragged:?}");
    let locked = run("long-tip", &[]).outcome;
    assert_eq!(locked.verdict, Verdict::Locked);
    let blades: Vec<u32> = locked.contacts.iter().flat_map(|x| x.blades.clone()).collect();
    assert_eq!(blades, [1, 3]);
    let lock = |longest: &str| {
        let machine = scene("long-tip", &[("bladed_disk.longest_tip_m", longest)]).machine();
        machine.lock_speed().unwrap()
    };
    assert!((lock("105e-6") - 292.1).abs() < 0.06 && (lock("0") - 411.9).abs() < 0.06);

    says("oval", "at 8.91 per second, as if all blades pressed a lining of 0.39 of the stiffness");
    says("oval", "With a lining of 40 kN/m it decays, at 6.3 per second");
    says("oval", "With two lobes it grows, too");
    let growth = |changes: &[(&str, &str)]| {
        let scene = scene("oval", changes);
        let machine = scene.machine();
        let lining = Lining::of(&machine, &scene.contact).unwrap();
        let all = 11.0 * scene.contact.stiffness_n_per_m;
        assert!((lining.stiffness_at_rest() / all - 0.39).abs() < 5e-3);
        lining.rest(420.0).worst().growth_1_s
    };
    assert!((growth(&[]) - 8.91).abs() < 5e-3);
    assert!((growth(&[("contact.stiffness_n_per_m", "40e3")]) + 6.3).abs() < 0.05);
    for lobes in ["4", "2"] {
        let mut motion = Motion::new(&scene("oval", &[("casing.lobes", lobes)]));
        motion.advance(0.5).unwrap();
        let before = motion.state().amplitude();
        motion.advance(1.0).unwrap();
        assert!(motion.state().amplitude() > 20.0 * before, "{lobes}");
    }
}

#[test]
fn slip_along_a_side_that_no_corner_ends_turns_faster_than_the_rotor() {
    let report = of(half_n());
    assert_eq!(report.outcome.verdict, Verdict::Slip);
    assert!(report.outcome.wave_speed_rad_s.unwrap() > 100.0, "{:?}", report.outcome);
    assert_eq!(report.outcome.contacts.len(), 1);
}

#[test]
fn round_off_of_a_multiplier_at_the_smallest_step() {
    // A lock whose two pushes are 0.0654 N each. At h = 1e-8 s each may be
    // 1e-20 m / (h^2/m_c) = 2e-4 N off; the step's own error is 3e-6 N.
    let exact = of(near_critical()).outcome.contacts[0].multiplier_n;
    let small = [("solver.kind", "explicit"), ("solver.step_s", "1e-8"), ("solver.end_s", "0.01")];
    let outcome = of(near_critical().with(&small).unwrap().into_scene()).outcome;
    assert_eq!(outcome.verdict, Verdict::Locked);
    for contact in outcome.contacts {
        assert!((contact.multiplier_n - exact).abs() < 4e-4, "{contact:?} {exact}");
    }
}

#[test]
fn without_damping_the_impacts_of_a_second_are_sensitive() {
    says("undamped", "A run of one second is sensitive");
    let changes = [("solver.kind", "event")];
    assert!(run("undamped", &changes).outcome.sensitive == Some(false));
    let changes = [("solver.kind", "event"), ("solver.end_s", "1")];
    assert!(run("undamped", &changes).outcome.sensitive == Some(true));
}

/// The tests of the figures check the numbers of these notes; here their words.
#[test]
fn the_scenes_of_the_figures_say_what_the_figures_find() {
    says("paper-figs-4-6", "Locked at 76.9 ms on #6 and #21");
    says("paper-figs-4-6", "43,400 N");
    says(
        "paper-figs-4-6",
        "at each of 50 time steps from 0.01 to 1 us it locks from 75 to 81 ms, at some 30",
    );
    says("paper-figs-4-6", "The disk still swings by 19 nrad at the end");
    says("paper-fig-7", "at nine of ten after 20 to 50 ms and at single ones as late as 0.15 s");
    says("paper-fig-7", "42 kN locks at some two steps of three, mostly after 30 ms to 0.1 s");
    for (name, printed) in [("paper-fig-7", 256.12), ("paper-fig-8", 292.88)] {
        let critical = scene(name, &[]).machine().critical_speed().unwrap();
        assert!((critical - printed).abs() < 5e-3, "{name} {critical}");
    }
    says("paper-fig-7", "256.12 rad/s");
    says("paper-fig-8", "0.85 MN at 300 rad/s, 0.54 MN at 400, 0.38 MN at 500");
    for (speed, threshold) in [("300", 0.85e6), ("400", 0.54e6), ("500", 0.38e6)] {
        let lasts = |pulse: f64| {
            let pulse = pulse.to_string();
            let changes = [("operation.speed_rad_s", speed), ("operation.pulse_n", &pulse)];
            matches!(
                run("paper-fig-8", &changes).outcome.verdict,
                Verdict::Locked | Verdict::Adhesive
            )
        };
        assert!(!lasts(threshold - 1e4) && lasts(threshold + 1e4), "{speed}");
    }
    let push_only = [("solver.contact", "unilateral")];
    says("paper-fig-8", "the zone is gone");
    assert_eq!(run("paper-fig-8", &push_only).outcome.verdict, Verdict::Decay);
}
