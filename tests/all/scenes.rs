//! Every built-in scene does what its note says, also in longer runs.

use crate::scene_support::{half_n, near_critical};
use rubscope_solver::motion::{Motion, RunReport, Verdict, simulate};
use rubscope_solver::scene::Scene;

fn run(name: &str, changes: &[(&str, &str)]) -> RunReport {
    let scene = Scene::builtin(name).unwrap().with(changes).unwrap();
    simulate(&scene.checked().unwrap())
}

fn verdict(name: &str, changes: &[(&str, &str)]) -> Verdict {
    run(name, changes).outcome.verdict
}

const UNILATERAL: (&str, &str) = ("solver.contact", "unilateral");

#[test]
fn the_papers_scenes_lock_under_the_equality_law_only() {
    for name in ["paper-nd3", "paper-nd4"] {
        let scene = Scene::builtin(name).unwrap();
        let report = run(name, &[("solver.step_s", "2e-7"), ("solver.end_s", "0.05")]);
        assert_eq!(report.outcome.verdict, Verdict::Locked, "{name}");
        let exact = scene.machine().locked_multipliers(500.0).unwrap();
        for (contact, exact) in report.outcome.contacts.iter().zip(exact) {
            assert!((contact.multiplier_n / exact - 1.0).abs() < 0.01, "{contact:?} {exact}");
        }
        assert_ne!(verdict(name, &[UNILATERAL, ("solver.end_s", "0.05")]), Verdict::Locked);
    }
    let blades = |report: RunReport| {
        report.outcome.contacts.iter().map(|contact| contact.blades.len()).collect::<Vec<_>>()
    };
    assert_eq!(blades(run("paper-nd4", &[("solver.end_s", "0.01")])), [2, 2]);
}

#[test]
fn adhesive_glues_and_lets_go() {
    let short = ("solver.end_s", "0.02");
    assert_eq!(verdict("adhesive", &[short]), Verdict::Adhesive);
    assert_eq!(verdict("adhesive", &[short, UNILATERAL]), Verdict::Decay);
}

#[test]
fn undamped_bounces_for_seconds_and_is_sensitive() {
    assert_eq!(verdict("undamped", &[("solver.step_s", "1e-6")]), Verdict::Bounce);
    let event = [("solver.kind", "event"), ("solver.model", "rigid")];
    let after = |end: &str| run("undamped", &[event[0], event[1], ("solver.end_s", end)]);
    let (soon, later) = (after("0.1"), after("10"));
    assert!(later.impact_count > 10 * soon.impact_count);
    assert!(later.outcome.sensitive == Some(true));
    // With damping it would be down by exp(-440).
    assert!(later.outcome.amplitude_m > 1e-5);
}

#[test]
fn rocking_locks_at_the_end_of_its_series() {
    let report = run("rocking", &[]);
    assert_eq!(report.outcome.verdict, Verdict::Locked);
    assert!((report.outcome.lock_time_s.unwrap() - 0.0580).abs() < 5e-5);
    let exact = Scene::builtin("rocking").unwrap().machine().locked_multipliers(500.0).unwrap();
    for (contact, exact) in report.outcome.contacts.iter().zip(exact) {
        assert!((contact.multiplier_n / exact - 1.0).abs() < 1e-12, "{contact:?}");
    }
}

#[test]
fn slip_turns_slower_and_locks_only_by_the_equality_law() {
    let report = run("slip", &[]);
    assert_eq!(report.outcome.verdict, Verdict::Slip);
    let wave = report.outcome.wave_speed_rad_s.unwrap();
    assert!((wave - 385.0).abs() < 1.0, "{wave}");
    let changes = [
        ("solver.kind", "explicit"),
        ("solver.contact", "bilateral"),
        ("solver.end_s", "0.02"),
        ("solver.step_s", "2e-7"),
    ];
    assert_eq!(verdict("slip", &changes), Verdict::Locked);
}

#[test]
fn grazing_touches_once_and_a_little_less_does_not() {
    let touches = |pulse: &str| run("grazing", &[("operation.pulse_n", pulse)]).impact_count;
    assert_eq!(run("grazing", &[]).impact_count, 1);
    assert_eq!(touches("3794"), 0);
    // One part in a million on either side of the smallest pulse that touches.
    let least: f64 = 3_795.024_727_266_787;
    assert_eq!(touches(&(least * (1.0 + 1e-6)).to_string()), 1);
    assert_eq!(touches(&(least * (1.0 - 1e-6)).to_string()), 0);
}

#[test]
fn a_wave_near_the_critical_speed_is_held_by_a_breath() {
    let scene = near_critical();
    let critical = scene.machine().critical_speed().unwrap();
    assert!((critical - 292.878).abs() < 5e-4, "{critical}");
    let report = simulate(&scene.checked().unwrap());
    assert_eq!(report.outcome.verdict, Verdict::Locked);
    for contact in &report.outcome.contacts {
        assert!((contact.multiplier_n + 0.065).abs() < 5e-4, "{contact:?}");
    }
    let slower = scene.with(&[("operation.speed_rad_s", "292.8")]).unwrap();
    assert_ne!(simulate(&slower).outcome.verdict, Verdict::Locked);
}

#[test]
fn run_down_breaks_its_lock_at_the_lock_speed() {
    let scene = Scene::builtin("run-down").unwrap();
    let mut motion = Motion::new(&scene.checked().unwrap());
    motion.advance(0.048_9).unwrap();
    assert_eq!(motion.multipliers().len(), 2);
    motion.advance(0.049).unwrap();
    assert_eq!(motion.multipliers().len(), 1);
    // The Euler force m nu' acts against the drag d_c nu: D(Omega_lock) is
    // reached at a speed lower by about nu' / (d_c/m_c n_d).
    let machine = scene.machine();
    let speed = motion.rotor().speed(0.048_95);
    assert!(speed < machine.lock_speed().unwrap() && (speed - 410.4).abs() < 0.1, "{speed}");
    assert_eq!(verdict("run-down", &[]), Verdict::Decay);
}

#[test]
fn along_two_parallel_sides_a_wave_slides_and_grows() {
    let report = simulate(&half_n().checked().unwrap());
    assert_eq!(report.outcome.verdict, Verdict::Slip);
    assert!((report.outcome.amplitude_m / 1e-4 - 38.8).abs() < 0.05);
    let longer = simulate(&half_n().with(&[("solver.end_s", "0.02")]).unwrap());
    assert_eq!(longer.outcome.verdict, Verdict::Failed);
    assert!(longer.outcome.message.unwrap().contains("beyond the casing radius"));
}

#[test]
fn slip_goes_on_for_a_million_impacts() {
    let mut motion = Motion::new(&Scene::builtin("slip").unwrap().checked().unwrap());
    motion.advance(900.0).unwrap();
    assert!(motion.contacts().impact_count > 1_000_000);
    let checks = motion.checks();
    let clearance = motion.machine().clearance();
    assert!(checks.max_penetration_m < 1e-14 * clearance, "{checks:?}");
    // 4 W over 900 s are 4 kJ: round-off of a million terms.
    assert!(checks.energy_residual_j.unwrap().abs() < 1e-7, "{checks:?}");
}
