//! Runs the numbers in the notes of the scenes that go beyond the paper.

use crate::scene_notes::says;
use crate::{near, scene};
use rubscope_solver::harmonic::{Lining, least_lock_stiffness};
use rubscope_solver::motion::{Motion, RunReport, Verdict, simulate};
use rubscope_solver::scene::Scene;

fn run(name: &str, changes: &[(&str, &str)]) -> RunReport {
    crate::run_once(&scene(name, changes))
}

fn verdict(name: &str, changes: &[(&str, &str)]) -> Verdict {
    run(name, changes).outcome.verdict
}

fn speed(value: &str) -> (&'static str, &str) {
    ("operation.speed_rad_s", value)
}

/// Largest `|a|` of the last `window` seconds of a run \[rad\].
fn swing(name: &str, changes: &[(&str, &str)], window: f64) -> f64 {
    let scene = scene(name, changes).checked().unwrap();
    let mut motion = Motion::new(&scene);
    let end = scene.solver.end_s;
    (0..=2000).fold(0.0_f64, |most, look| {
        motion.advance(end - window * (1.0 - f64::from(look) / 2000.0)).unwrap();
        let [c, s] = motion.state().alpha;
        most.max(c.hypot(s))
    })
}

#[test]
fn the_coincidence_is_seen() {
    let name = "coincidence";
    says(name, "At 390 rad/s the pulse dies away. At 406 rad/s");
    says(name, "the blades swing by 0.182 mrad for good. At 445 rad/s the pulse dies away again");
    assert_eq!(verdict(name, &[speed("390")]), Verdict::Decay);
    assert_eq!(verdict(name, &[]), Verdict::Whirl);
    assert_eq!(verdict(name, &[speed("445")]), Verdict::Decay);
    near(swing(name, &[], 0.05), 1.82e-4, 0.005e-4);
    says(name, "Between 399.5 and 437.9 rad/s it cannot");
    says(name, "the coincidence (31), 388.3 rad/s, raised by the lining");
    let scene = Scene::builtin(name).unwrap();
    let machine = scene.machine();
    near(machine.dangerous_speed().unwrap(), 388.3, 0.05);
    let lining = Lining::of(&machine, &scene.contact).unwrap();
    let found: Vec<f64> =
        lining.hopf_points([300.0, 500.0]).unwrap().iter().map(|point| point.speed_rad_s).collect();
    assert_eq!(found.len(), 2);
    near(found[0], 399.5, 0.05);
    near(found[1], 437.9, 0.05);
}

#[test]
fn with_little_damping_the_peak_is_nearer_to_the_coincidence() {
    says(
        "coincidence",
        "With damping ratios of 0.01 and a lining of 5455 N/m the peak moves to 392.5",
    );
    let changes = [
        ("casing.damping_ratio", "0.01"),
        ("bladed_disk.damping_ratio", "0.01"),
        ("contact.stiffness_n_per_m", "5455"),
    ];
    let scene = scene("coincidence", &changes);
    let machine = scene.machine();
    let lining = Lining::of(&machine, &scene.contact).unwrap();
    let amplitude = |tenths: u32| {
        let cycles = lining.cycles(f64::from(tenths) / 10.0).unwrap();
        cycles.iter().filter(|one| one.stable).map(|one| one.blade_rad).fold(0.0, f64::max)
    };
    let peak = (3880..4000).max_by(|a, b| amplitude(*a).total_cmp(&amplitude(*b))).unwrap();
    assert!((3923..=3927).contains(&peak), "{peak}");
}

#[test]
fn a_rub_does_not_end() {
    let name = "rub";
    says(name, "the wave turns at 363 rad/s, and the blades swing by 0.79 mrad at 261 rad/s");
    let run = run(name, &[]);
    assert_eq!(run.outcome.verdict, Verdict::Whirl);
    let wave = run.outcome.wave_speed_rad_s.unwrap();
    near(wave, 363.0, 0.5);
    // The blades feel the wave that turns by them: s = n_d (Omega_wave - Omega).
    near(3.0 * (450.0 - wave), 261.0, 0.5);
    near(swing(name, &[], 0.05), 7.9e-4, 0.05e-4);
    says(name, "At 400 rad/s it decays, and so it does with radial tips (kappa = 0)");
    assert_eq!(verdict(name, &[speed("400")]), Verdict::Decay);
    assert_eq!(verdict(name, &[("bladed_disk.radial_coupling", "0")]), Verdict::Decay);
    says(name, "as speckled as which pulses lock; the whirl itself is always the same");
    let by = |pulse: &str| self::run(name, &[("operation.pulse_n", pulse)]);
    let verdicts = ["30e3", "50e3", "80e3"].map(|pulse| by(pulse).outcome.verdict);
    assert_eq!(verdicts, [Verdict::Whirl, Verdict::Decay, Verdict::Whirl]);
    for pulse in ["30e3", "80e3"] {
        near(by(pulse).outcome.wave_speed_rad_s.unwrap(), wave, 0.05);
    }
}

#[test]
fn a_blade_digs_in_below_the_critical_speed() {
    let name = "digs-in";
    says(name, "They whirl at 280 rad/s, below the critical speed 292.9 rad/s");
    says(name, "faster than the rotor, at 379 rad/s");
    let run = run(name, &[]);
    assert_eq!(run.outcome.verdict, Verdict::Whirl);
    near(run.outcome.wave_speed_rad_s.unwrap(), 379.0, 0.5);
    near(Scene::builtin(name).unwrap().machine().critical_speed().unwrap(), 292.9, 0.05);
    says(name, "At 240 rad/s it decays; with trailing blades (kappa = 0.15) it decays");
    assert_eq!(verdict(name, &[speed("240")]), Verdict::Decay);
    says(name, "(with 300 kN this run is sensitive; with 250 kN it is not)");
    let trailing = ("bladed_disk.radial_coupling", "0.15");
    for (pulse, sensitive) in [("300e3", true), ("250e3", false)] {
        let pulse = ("operation.pulse_n", pulse);
        assert_eq!(verdict(name, &[pulse]), Verdict::Whirl);
        let outcome = simulate(&scene(name, &[pulse, trailing]).checked().unwrap()).outcome;
        assert_eq!((outcome.verdict, outcome.sensitive), (Verdict::Decay, Some(sensitive)));
    }
}

#[test]
fn friction_works_against_the_lock() {
    let name = "friction-lock";
    says(name, "from 411.9 rad/s without it to 489.7 at mu = 0.15, 541.8 at 0.2 and 787.5 at 0.3");
    says(name, "from mu = 0.431 on there is no lock at any speed");
    says(name, "The wave starts locked at 500 rad/s; turn the friction up");
    let lock = |mu: &str| scene(name, &[("contact.friction", mu)]).machine().lock_speed();
    for (mu, value) in [("0", 411.9), ("0.15", 489.7), ("0.2", 541.8), ("0.3", 787.5)] {
        near(lock(mu).unwrap(), value, 0.05);
    }
    assert!(lock("0.4305").is_some() && lock("0.432").is_none());
    assert_eq!(verdict(name, &[]), Verdict::Locked);
    assert_eq!(verdict(name, &[("contact.friction", "0.2")]), Verdict::Decay);
    // Friction bends the blades, though no gap feels it: mu l_b |p|/k_a at last.
    let bent = run(name, &[("solver.end_s", "3")]).r#final;
    near(bent.alpha_c_rad.hypot(bent.alpha_s_rad), 1.195_782_347e-4, 1e-12);
}

#[test]
fn a_soft_lining_cannot_hold_a_lock() {
    let name = "soft-lining";
    says(name, "below 1.937e8 N/m there is no lock at this speed");
    says(name, "at no speed does a lining below 1.931e8 N/m hold it");
    says(name, "one of 3e8 N/m holds from 438.2 to 732.4 rad/s");
    let holds = |stiffness: f64| {
        let mut scene = Scene::builtin(name).unwrap();
        scene.contact.stiffness_n_per_m = stiffness;
        scene.machine().lock_windows(1.0).first().copied()
    };
    assert!(
        holds(1.9375e8).unwrap().from < 500.0 && holds(1.936e8).is_none_or(|at| at.from > 500.0)
    );
    let machine = Scene::builtin(name).unwrap().machine();
    near(least_lock_stiffness(&machine).unwrap().stiffness_n_per_m, 1.931e8, 0.0005e8);
    let window = holds(3e8).unwrap();
    near(window.from, 438.2, 0.05);
    near(window.to.unwrap(), 732.4, 0.05);
    assert_eq!(verdict(name, &[]), Verdict::Locked);
    // Softer from the same start.
    let softer = |stiffness| verdict(name, &[("contact.stiffness_n_per_m", stiffness)]);
    assert_eq!(softer("8e8"), Verdict::Locked);
    assert_eq!(softer("1.9e8"), Verdict::Decay);
    // Turned while it is held, at once and in parts.
    says(name, "Turned down at once from 1e9 N/m the lock is lost at 4.0e8 N/m already");
    says(
        name,
        "Turned to 6e8, 4e8, 3e8 and 2.5e8 N/m, with 0.2 s to come to rest at each, it holds",
    );
    let turned = |to: &[&str]| {
        let change = |(n, stiffness): (u32, &&str)| {
            let at = format!("{}:contact.stiffness_n_per_m={stiffness}", 0.1 + 0.2 * f64::from(n));
            ["--at".to_string(), at]
        };
        let end = ["--end".to_string(), (0.3 + 0.2 * to.len() as f64).to_string()];
        let words = ["run", name, "--json"].map(String::from).into_iter();
        let all: Vec<String> = words.chain((0..).zip(to).flat_map(change)).chain(end).collect();
        let words: Vec<&str> = all.iter().map(String::as_str).collect();
        let report = crate::cli_support::json(&words);
        report["outcome"]["verdict"].as_str().unwrap().to_string()
    };
    assert_eq!([turned(&["4.1e8"]), turned(&["4.0e8"])], ["locked", "decay"]);
    assert_eq!(turned(&["6e8", "4e8", "3e8", "2.5e8"]), "locked");
}
