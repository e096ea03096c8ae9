//! The explicit solver against closed forms. A new case is some keys and the formula.

use crate::keys::{LAW, MODEL, PULSE, SPEED, STEP};
use rubscope_solver::motion::{Motion, RunReport, Verdict};
use rubscope_solver::scene::Scene;

/// Case A of the paper's machine: three diameters, 500 rad/s, 20 kN.
pub fn scene(changes: &[(&str, &str)]) -> Scene {
    Scene::base().with(changes).unwrap().into_scene()
}

fn run(changes: &[(&str, &str)]) -> RunReport {
    crate::run_once(&scene(changes).checked().unwrap())
}

/// Nine blades with three diameters have three sides: `Omega_lock` = 301.455, adhesive from 319.339.
#[test]
fn with_three_sides_the_bilateral_law_chatters_up_to_the_adhesive_limit() {
    for (speed, bilateral) in [("310", Verdict::Slip), ("322", Verdict::Locked)] {
        for (contact, verdict) in [("bilateral", bilateral), ("unilateral", Verdict::Locked)] {
            let asked = [(SPEED, speed), (LAW, contact), (PULSE, "20000"), (STEP, "1e-6")];
            let found = run(&[&asked[..], &[("bladed_disk.blades", "9")]].concat());
            assert_eq!(found.outcome.verdict, verdict, "{speed} {contact}");
        }
    }
}

#[test]
fn gaps_of_all_blades_are_those_of_equation_14() {
    for (model, diameters) in [("rigid", 3), ("modal", 3), ("full", 4)] {
        let set = [(MODEL, model), ("operation.nodal_diameters", &*diameters.to_string())];
        let scene = scene(&set).checked().unwrap();
        let mut motion = Motion::new(&scene);
        for t in [1.1e-4, 2.4e-4, 7.7e-3] {
            motion.advance(t).unwrap();
            let (state, angles) = (motion.state(), motion.blade_angles());
            let theta = scene.operation.speed_rad_s * state.t_s;
            let gaps = motion.blade_gaps();
            assert_eq!((gaps.len(), state.t_s), (22, motion.t_s()));
            for (i, (gap, alpha)) in gaps.into_iter().zip(angles).enumerate() {
                let turned = theta + std::f64::consts::TAU * i as f64 / 22.0 + alpha;
                let (sin, cos) = (f64::from(diameters) * turned).sin_cos();
                let expected = motion.machine().clearance() + state.u[0] * cos + state.u[1] * sin;
                // Round-off of an angle of some tens of radians, at 1e-4 m.
                assert!(
                    (gap - expected).abs() < 2e-18,
                    "{model} {diameters} {i}: {gap} {expected}"
                );
            }
        }
    }
}

#[test]
fn an_engine_order_moves_the_blades_and_hardly_the_lock() {
    let drive = [("excitation.amplitude_nm", "1.0"), ("excitation.order", "3")];
    // Heavy blade damping, so that the transient is gone by exp(-17).
    let heavy = ("bladed_disk.damping_ratio", "0.3");
    let still = [(PULSE, "0"), (SPEED, "100"), (STEP, "1e-6"), heavy, drive[0], drive[1]];
    // Blades alone settle to the linear response at 3 Omega, since E = n_d.
    let scene = scene(&still);
    let machine = scene.machine();
    let mut motion = Motion::new(&scene.checked().unwrap());
    motion.advance(0.2).unwrap();
    let omega = 3.0 * 100.0;
    let stiff = machine.omega_bd * machine.omega_bd - omega * omega;
    let drag = 2.0 * machine.blade_damping_ratio * machine.omega_bd * omega;
    let expected = 1.0 / (machine.blade_inertia * stiff.hypot(drag));
    let found = motion.state().alpha[0].hypot(motion.state().alpha[1]);
    // Second order in the step: (omega h)^2/12 of the response near resonance.
    assert!((found / expected - 1.0).abs() < 1e-6, "{found} {expected}");
}
