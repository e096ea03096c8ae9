//! The event solver beyond the paper's model on anything: a verdict or a failure with
//! a reason, and on the way no number that is none, no pull, no closed gap passed, and
//! no energy from nowhere.

use proptest::prelude::*;
use rubscope_solver::motion::{Events, Motion, Solver, Verdict, to_the_end};
use rubscope_solver::scene::{CheckedScene, Scene};

use crate::{drawn, event_linear};

#[derive(Clone, Debug)]
struct Machine {
    blades: u32,
    casing: u32,
    rigid: bool,
    numbers: Vec<(&'static str, f64)>,
}

fn machine() -> impl Strategy<Value = Machine> {
    let slope = prop_oneof![Just(0.0), -0.5..0.8];
    let friction = prop_oneof![Just(0.0), 0.0..0.5];
    let rebound = prop_oneof![Just(0.0), 0.0..0.9];
    let speed = prop_oneof![50.0..600.0, -600.0..-50.0];
    let sizes = (1_u32..=40, 0_u32..=12, any::<bool>());
    let contact = (slope, friction, rebound, 0.0..0.4);
    let drive = (speed, 1e3..3e5, 0.0..0.1, 0.0..0.1);
    (sizes, contact, drive).prop_map(|(sizes, contact, drive)| Machine {
        blades: sizes.0,
        casing: sizes.1,
        rigid: sizes.2,
        numbers: vec![
            ("bladed_disk.radial_coupling", contact.0),
            ("contact.friction", contact.1),
            ("contact.restitution", contact.2),
            ("casing.tangential_ratio", contact.3),
            ("operation.speed_rad_s", drive.0),
            ("operation.pulse_n", drive.1),
            ("casing.damping_ratio", drive.2),
            ("bladed_disk.damping_ratio", drive.3),
        ],
    })
}

fn scene(machine: &Machine) -> CheckedScene {
    let mut scene: Scene = event_linear::scene("modal", &[]).into_scene();
    scene.bladed_disk.blades = machine.blades;
    scene.operation.nodal_diameters = machine.casing;
    scene.solver.end_s = 0.05;
    if machine.rigid {
        scene.set("solver.model", "rigid").unwrap();
    }
    for (key, value) in &machine.numbers {
        scene.set(key, &value.to_string()).unwrap();
    }
    scene.checked().unwrap()
}

proptest! {
    #![proptest_config(drawn(60))]

    #[test]
    fn nothing_pulls_passes_or_comes_from_nowhere(machine in machine()) {
        let scene = scene(&machine);
        let mut motion = Events::new(&scene).unwrap();
        let g0 = scene.clearance();
        let mut ended = false;
        for k in 1..=50 {
            ended = motion.advance(1e-3 * f64::from(k)).is_err();
            let state = motion.state();
            let numbers = [state.u, state.v, state.alpha, state.alpha_rate].concat();
            prop_assert!(numbers.iter().all(|x| x.is_finite()), "{state:?}");
            let checks = motion.checks();
            prop_assert!(checks.energy_residual_j.is_some_and(f64::is_finite));
            if ended {
                break;
            }
            // Of the size of the motion, the gap has fifteen digits.
            let size = g0 + state.amplitude();
            let least = motion.blade_gaps().into_iter().fold(f64::INFINITY, f64::min);
            prop_assert!(least >= -1e-12 * size, "{least:e} at {k} ms");
            prop_assert!(motion.multipliers().iter().all(|&(_, force)| force <= 0.0));
            let energy = 1.544e6 * state.amplitude().powi(2)
                + 2.0 * (state.v[0].powi(2) + state.v[1].powi(2));
            let pulse = machine.numbers[5].1;
            let scale = 1.0 + energy + pulse * 50e-6;
            let residual = checks.energy_residual_j.unwrap_or(f64::NAN);
            prop_assert!(residual.abs() < 1e-8 * scale, "{residual:e} J of {scale:e} at {k} ms");
        }
        let verdict = motion.final_verdict();
        let failed = matches!(verdict, Some(Verdict::Failed | Verdict::Divergent));
        prop_assert_eq!(ended, failed);
    }

    #[test]
    fn where_one_looks_changes_no_bit(machine in machine()) {
        let scene = scene(&machine);
        let (mut once, mut often) = (Events::new(&scene).unwrap(), Events::new(&scene).unwrap());
        let first = once.advance(0.02);
        let mut second = Ok(());
        for k in 1..=100 {
            second = often.advance(2e-4 * f64::from(k));
        }
        prop_assert_eq!(first.is_ok(), second.is_ok());
        if first.is_ok() {
            prop_assert_eq!(once.state(), often.state());
            prop_assert_eq!(once.contacts().impact_count, often.contacts().impact_count);
            prop_assert_eq!(once.contacts().active_set, often.contacts().active_set);
        }
    }

    #[test]
    fn changes_on_the_way_are_followed(machine in machine(), turn in -600.0..600.0_f64) {
        let scene = scene(&machine);
        let mut motion = Motion::new(&scene);
        for k in 1..=20 {
            if motion.advance_while(1e-3 * f64::from(k), &to_the_end).is_err() {
                break;
            }
            match k % 4 {
                0 => motion.fire(),
                1 => motion.set_speed(turn, 0.0),
                2 => motion.scale_rate(1.0 + 1e-9),
                _ => motion.scale_tolerance(0.1),
            }
        }
        let state = motion.state();
        prop_assert!(state.u.iter().chain(&state.alpha).all(|x| x.is_finite()));
    }
}

#[test]
fn a_whole_run_has_a_verdict() {
    let keys = [("bladed_disk.radial_coupling", 0.3), ("operation.speed_rad_s", 450.0)];
    let report = crate::run_once(&event_linear::scene("modal", &keys));
    assert_ne!(report.outcome.verdict, Verdict::Failed, "{:?}", report.outcome);
    assert!(report.checks.energy_residual_j.unwrap().abs() < 1e-10);
}
