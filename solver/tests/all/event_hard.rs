//! The hard cases of the event solver, each with its right answer or a clear
//! error: no hang, no NaN, no silent wrong result. A new case is some keys and numbers for
//! `run` or `arrives`, and what must be true at the end.

use crate::keys::{BLADES, DIAMETERS, LENGTH, PULSE, RAMP, SPEED, ZETA};
use std::f64::consts::FRAC_PI_2;

use crate::event_cases::scene as event_scene;
use crate::tips_support::on_side_0;
use rubscope_solver::motion::{ActiveSet, Events, Failure, Solver, Verdict};
use rubscope_solver::scene::{ModelSize, Scene};

const BLADE: &str = "bladed_disk.blade_length_m";

fn run(changes: &[(&str, f64)], until: f64) -> (Events, Result<(), Failure>) {
    let scene = event_scene(changes).checked().unwrap();
    let mut motion = Events::new(&scene).unwrap();
    let result = motion.advance(until);
    let state = motion.state();
    let numbers = [state.u[0], state.u[1], state.v[0], state.v[1]];
    assert!(numbers.iter().all(|x| x.is_finite()), "{changes:?} {state:?}");
    assert!(motion.checks().energy_residual_j.unwrap().is_finite());
    (motion, result)
}

/// As `run`, for a motion that must reach its end; its largest allowed
/// penetration is round-off of the clearance.
fn arrives(changes: &[(&str, f64)], until: f64) -> Events {
    let (motion, result) = run(changes, until);
    result.unwrap();
    let clearance = motion.machine().clearance();
    assert!(motion.checks().max_penetration_m <= 1e-10 * clearance, "{changes:?}");
    motion
}

#[test]
fn a_giganewton_is_borne() {
    for more in [(ZETA, 0.0), (ZETA, 10.0), (LENGTH, 0.01)] {
        assert!(arrives(&[(PULSE, 1e9), more], 0.02).contacts().impact_count > 0);
    }
}

#[test]
fn a_hundred_seconds_without_damping_keep_the_energy_in_the_turning_frame() {
    let motion = arrives(&[(ZETA, 0.0)], 100.0);
    let checks = motion.checks();
    // The pulse does 0.25 J.
    assert!(checks.energy_residual_j.unwrap().abs() < 1e-11);
    // Between impacts, energy less nu times angular momentum is constant.
    let jacobi = |motion: &Events| {
        let s = motion.state();
        let machine = motion.machine();
        let energy = 0.5 * (s.v[0].powi(2) + s.v[1].powi(2))
            + 0.5 * machine.omega_c.powi(2) * (s.u[0].powi(2) + s.u[1].powi(2));
        energy - 1500.0 * (s.u[0] * s.v[1] - s.u[1] * s.v[0])
    };
    let mut later = motion.clone();
    later.advance(101.0).unwrap();
    if later.events() == motion.events() {
        assert!((jacobi(&later) / jacobi(&motion) - 1.0).abs() < 1e-11);
    }
}

#[test]
fn at_the_critical_speed_a_slide_keeps_its_pace() {
    // omega_c^2 - nu^2 = 0 and no damping: y'' = 0 and the push is -2 nu y'.
    let mut scene = Scene::base();
    scene.set("solver.model", "rigid").unwrap();
    scene.casing.damping_ratio = 0.0;
    let critical = scene.machine().critical_speed().unwrap();
    scene.operation.speed_rad_s = critical;
    let machine = scene.machine();
    let nu = machine.nu(critical);
    // Rate of z in the turning frame: backward along side 0 is -i.
    let pace = 1e-3;
    on_side_0(&mut scene, false, -pace);
    let mut motion = Events::new(&scene.checked().unwrap()).unwrap();
    assert_eq!(motion.contacts().active_set, ActiveSet::Side(0));
    let push = -motion.multipliers()[0].1 / machine.casing_mass;
    assert!((push - 2.0 * nu * pace).abs() < 1e-10 * push, "{push} {}", 2.0 * nu * pace);
    let t = motion.next_event(0.1).unwrap();
    assert!((t * pace / machine.polygon.half_side() - 1.0).abs() < 1e-9);
    assert_eq!(motion.contacts().active_set, ActiveSet::Side(1));
    motion.advance(10.0).unwrap();
    assert!(motion.state().u[0].is_finite());
}

#[test]
fn speeds_of_zero_and_below_every_alias_and_any_number_of_blades() {
    let still = arrives(&[(SPEED, 0.0)], 0.1);
    assert_eq!(still.final_verdict(), Some(Verdict::Decay));
    let (forward, backward) = (arrives(&[], 0.1), arrives(&[(SPEED, -500.0)], 0.1));
    let (a, b) = (forward.state(), backward.state());
    assert!((a.u[0] - b.u[0]).abs() < 1e-16 && (a.u[1] + b.u[1]).abs() < 1e-16);
    // 25 diameters on 22 blades have the sides of 3 but turn faster.
    let alias = arrives(&[(DIAMETERS, 25.0), (SPEED, 60.0)], 0.1);
    let plain = arrives(&[(DIAMETERS, 3.0), (SPEED, 500.0)], 0.1);
    assert!((alias.state().u[0] - plain.state().u[0]).abs() < 1e-16);
    // Half the blades of an even number: a slab; the same again with every blade.
    for diameters in [0.0, 4.0, 11.0, 22.0, 33.0, 4000.0] {
        for speed in [20.0, 500.0] {
            let (motion, result) = run(&[(DIAMETERS, diameters), (SPEED, speed)], 0.1);
            let cornered = motion.machine().polygon.has_corners();
            assert!(result.is_ok() || !cornered, "{diameters} {result:?}");
        }
    }
    for blades in [1.0, 2.0, 3.0, 5.0, 500.0, 4096.0] {
        for speed in [100.0, 1000.0] {
            let changes = [(BLADES, blades), (DIAMETERS, 1.0), (SPEED, speed), (PULSE, 5e4)];
            let (motion, result) = run(&changes, 0.02);
            assert!(result.is_ok() || !motion.machine().polygon.has_corners());
        }
    }
}

#[test]
fn a_side_without_corners_lets_the_wave_run_away_with_a_reason() {
    let (motion, result) =
        run(&[(DIAMETERS, 11.0), (SPEED, 500.0), (PULSE, 1e6), (ZETA, 0.0)], 10.0);
    let failure = result.unwrap_err();
    assert!(failure.to_string().contains("casing radius"), "{failure}");
    assert!(failure.t_s > 0.0 && failure.t_s < 10.0);
    assert_eq!(motion.final_verdict(), Some(Verdict::Failed));
    assert_eq!(motion.clone().advance(11.0), Err(failure));
}

#[test]
fn clearances_from_a_picometre_to_a_metre() {
    for (blade, touches) in [(0.5 - 1e-12, true), (0.5 - 1e-9, true), (0.4, false)] {
        let motion = arrives(&[(BLADE, blade)], 0.01);
        assert_eq!(motion.events() > Some(0), touches);
    }
    let wide = [("casing.radius_m", 1.5), (BLADE, 0.5), (PULSE, 1e8)];
    let motion = arrives(&wide, 0.01);
    assert!(motion.contacts().impact_count > 0);
}

#[test]
fn every_casing_damping_and_ramp() {
    for zeta in [0.0, 1e-12, 0.999_999, 1.0, 1.000_001, 10.0] {
        for ramp in [0.0, 1.0, 1e6, -1e8] {
            let motion = arrives(&[(ZETA, zeta), (RAMP, ramp), (PULSE, 1e5)], 0.003);
            let residual = motion.checks().energy_residual_j.unwrap();
            // The pulse does (F t_p)^2/2m = 6 J; what turns at nu has nu^2 g0^2.
            let nu = motion.machine().nu(motion.rotor().speed(0.003));
            let scale = 6.0 + 2.0 * (nu * 1e-4).powi(2);
            assert!(residual.abs() < 1e-11 * scale, "{zeta} {ramp}: {residual:e} J");
        }
    }
}

#[test]
fn straight_into_a_corner_or_onto_a_side_by_symmetry() {
    // Not turning, the pulse drives the casing along u_c: for an even number of sides onto the
    // middle of one, for an odd number exactly into a corner. With three sides an impact on one
    // closes the gap of the other, and both impacts are one. With more it opens that gap, and one
    // impact follows the other, as with the least rotation.
    for (blades, sides, symmetric) in
        [(22.0, 1, true), (4.0, 1, true), (3.0, 2, true), (5.0, 2, false), (7.0, 2, false)]
    {
        let changes = [(BLADES, blades), (DIAMETERS, 1.0), (SPEED, 0.0), (ZETA, 0.0)];
        let (mut motion, _) = run(&changes, 0.0);
        let t = motion.next_event(1.0).unwrap();
        motion.advance(t + 1e-9).unwrap();
        assert_eq!(motion.contacts().impact_count, sides, "{blades}");
        let still = motion.state().v[1].abs() < 1e-12;
        assert_eq!(still, symmetric, "{blades}");
        // With the least rotation the same, to within a mirror.
        let changes = [(BLADES, blades), (DIAMETERS, 1.0), (SPEED, 1e-6), (ZETA, 0.0)];
        let (mut turning, _) = run(&changes, 0.0);
        turning.advance(t + 1e-9).unwrap();
        if !symmetric {
            let (a, b) = (motion.state().v, turning.state().v);
            assert!((a[0] - b[0]).abs() + (a[1].abs() - b[1].abs()).abs() < 1e-5, "{a:?} {b:?}");
        }
    }
}

#[test]
fn a_slip_that_goes_on_for_ever_goes_through_side_after_side() {
    let motion = arrives(&[(ZETA, 0.01), (PULSE, 51742.0)], 10.0);
    let log = motion.contacts();
    assert!(log.unbroken_since.unwrap() < 0.01);
    // About 1100 crossings a second, and their record stays small.
    assert!(log.impact_count > 10_000 && log.impacts.len() == 1000);
    // The rotor does some 40 J in that time.
    assert!(motion.checks().energy_residual_j.unwrap().abs() < 1e-9);
}

/// Two sides a half turn apart meet where their blades turn them by a quarter
/// turn: a failure with a reason, not a motion through the other side.
#[test]
fn blades_that_turn_two_sides_onto_each_other_end_the_motion() {
    let mut scene = Scene::base();
    scene.bladed_disk.blades = 8;
    scene.bladed_disk.blade_length_m = scene.casing.radius_m - 0.008;
    scene.casing.damping_ratio = 1.0;
    scene.operation.nodal_diameters = 28;
    scene.operation.speed_rad_s = -97.5;
    scene.operation.pulse_n = -9e4;
    scene.operation.pulse_s = 1.4e-3;
    scene.initial.v_c_m_s = -10.0;
    scene.solver.model = ModelSize::Modal;
    let mut motion = Events::new(&scene.checked().unwrap()).unwrap();
    let failure = motion.advance(0.02).unwrap_err();
    assert!(failure.to_string().contains("turn the only two sides onto each other"), "{failure}");
    let turned = 28.0 * motion.state().alpha[0].abs();
    assert!((0.9..FRAC_PI_2).contains(&turned), "{turned} rad");
}

/// A slow motion that crosses a corner keeps what is round-off apart from what is
/// a rate, also where blades move: no endless crossings, and energy balances.
#[test]
fn crossings_of_moving_blades_are_clean_of_round_off() {
    let still = "contact unilateral bladed_disk.blades 4 bladed_disk.blade_length_m 0.4999898089726025 \
                 casing.modal_stiffness_n_per_m 1709405.6704526693 \
                 casing.modal_mass_kg 1.8930829502420177 zeta-casing 0 \
                 speed 1218.0002700696834 pulse 0 initial.u_c_m 1.0191027381492726e-5 \
                 initial.u_s_m 1.019102739752132e-5 initial.v_c_m_s -0.03723802236740554 \
                 initial.v_s_m_s 0.03723802230883704";
    let struck = "contact unilateral bladed_disk.blades 24 bladed_disk.blade_length_m 0.35 zeta-disk 1 \
                  casing.modal_mass_kg 30 zeta-casing 0 nd 11 speed 62.77 \
                  operation.pulse_s 0.00119 pulse 47616673";
    for (words, end, events, scale) in [(still, 1e-5, 3, 1e-3), (struck, 5.8e-4, 20, 1e3)] {
        let mut scene = crate::cases::scene("paper-nd3", words);
        scene.solver.model = ModelSize::Modal;
        let mut motion = Events::new(&scene.checked().unwrap()).unwrap();
        motion.advance(end).unwrap();
        assert!(motion.events() <= Some(events), "{:?}", motion.events());
        let residual = motion.checks().energy_residual_j.unwrap();
        assert!(residual.abs() < 1e-10 * scale, "{residual:e} J");
    }
}

/// The report is of the state at which a run that grows without bound was ended.
#[test]
fn a_divergent_run_ends_in_one_state_with_its_energy() {
    let words = "solver event model modal contact unilateral end 0.05 speed 517 pulse 15699 \
                 bladed_disk.radial_coupling 0.58 contact.friction 0.27";
    let report = crate::run_once(&crate::cases::scene("paper-nd3", words).checked().unwrap());
    assert_eq!(report.outcome.verdict, Verdict::Divergent);
    let end = &report.r#final;
    assert!(end.alpha_c_rad.hypot(end.alpha_s_rad) > 0.1, "the state is that which was told");
    let ledger = report.energy.unwrap();
    let residual = report.checks.energy_residual_j.unwrap();
    assert!((ledger.residual() - residual).abs() <= 1e-9 * ledger.stored_j);
    assert!(residual.abs() <= 1e-9 * ledger.stored_j, "{residual} of {ledger:?}");
    assert!(ledger.friction_heat_j > 0.0 && ledger.rotor_work_j > ledger.stored_j, "{ledger:?}");
    let message = report.outcome.message.unwrap();
    assert!(message.starts_with("left the range of the model at t = 2.6"), "{message}");
}

#[test]
fn the_event_solver_refuses_what_it_does_not_know() {
    for (key, value) in [
        ("solver.contact", "bilateral"),
        ("solver.model", "full"),
        ("excitation.amplitude_nm", "1"),
    ] {
        let scene = Scene::base().with(&[(key, value)]).unwrap();
        let refused = Events::new(&scene).unwrap_err().to_string();
        assert!(refused.starts_with(key), "{refused}");
    }
}

/// Two parallel sides of blades that move, and pulses so strong that the series along a
/// side is tried on shorter and shorter stretches.
#[test]
fn strong_pulses_between_two_sides() {
    for pulse in ["-1e6", "5e6"] {
        let run = |changes: &[(&str, &str)]| {
            let fixed = [
                ("operation.nodal_diameters", "11"),
                ("operation.speed_rad_s", "100"),
                ("operation.pulse_n", pulse),
                ("solver.contact", "unilateral"),
                ("solver.model", "modal"),
                ("solver.end_s", "3e-4"),
            ];
            let scene = Scene::base().with(&[&fixed[..], changes].concat()).unwrap();
            rubscope_solver::motion::simulate(&scene)
        };
        let event = run(&[("solver.kind", "event")]);
        let steps = run(&[("solver.kind", "explicit"), ("solver.step_s", "1e-8")]);
        assert_eq!(event.outcome.message, None, "{pulse}");
        assert_eq!(event.impact_count, steps.impact_count, "{pulse}");
        let (here, there) = (&event.r#final, &steps.r#final);
        // First order in the step, of motions of a tenth of a millimetre and more.
        let far = (here.u_c_m - there.u_c_m).hypot(here.u_s_m - there.u_s_m);
        assert!(far < 2e-3 * event.outcome.amplitude_m, "{pulse}: {far:e}");
    }
}
