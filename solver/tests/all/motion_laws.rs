//! Laws of motions beyond the paper, over random scenes: a refusal or a verdict and
//! never a number that is none, pushes that only push, energy that is never created. A new kind
//! of machine is a part of `machines`.

use crate::random::{each_case, one_of, within};
use fastrand::Rng;
use rubscope_solver::motion::{Change, Motion, Pulse, Script, Verdict, run_to_end, verdict_of};
use rubscope_solver::scene::{ContactLaw, ModelSize, Scene};

/// A random machine with something beyond the paper.
fn machines(rng: &mut Rng) -> Scene {
    let blades = [(22, 3), (22, 4), (12, 3), (7, 3), (5, 0), (3, 1), (1, 1), (96, 5)];
    let laws = [ContactLaw::Unilateral, ContactLaw::Smooth, ContactLaw::Bilateral];
    let mut scene = Scene::base();
    (scene.bladed_disk.blades, scene.operation.nodal_diameters) = one_of(rng, &blades);
    scene.solver.model = one_of(rng, &[ModelSize::Rigid, ModelSize::Modal, ModelSize::Full]);
    scene.solver.contact = one_of(rng, &laws);
    let some = |rng: &mut Rng, range| if rng.bool() { within(rng, range) } else { 0.0 };
    scene.bladed_disk.radial_coupling = some(rng, -0.5..1.0);
    scene.contact.friction = some(rng, 0.0..0.5);
    scene.casing.tangential_ratio = some(rng, 0.0..1.0);
    scene.contact.restitution = some(rng, 0.0..0.9);
    scene.contact.stiffness_n_per_m = within(rng, 1e3..1e8);
    scene.contact.smoothing_m = one_of(rng, &[0.0, 1e-6, 1e-5]);
    let lining = scene.solver.contact == ContactLaw::Smooth;
    if lining && rng.bool() {
        scene.casing.radius_m = 0.49988;
    }
    scene.operation.speed_rad_s = within(rng, -600.0..600.0);
    scene.operation.pulse_n = within(rng, -2e5..2e5);
    scene.operation.speed_ramp_rad_s2 = some(rng, -500.0..500.0);
    if rng.bool() {
        scene.bladed_disk.nodal_diameters = if lining { rng.u32(0..7) } else { 0 };
        let driven = scene.solver.model == ModelSize::Modal;
        scene.excitation.amplitude_nm = if driven { 0.3 } else { 0.0 };
    }
    if scene.solver.model == ModelSize::Full && scene.contact.restitution > 0.0 {
        scene.bladed_disk.mistuning = 0.02;
    }
    scene.solver.step_s = one_of(rng, &[2e-6, 5e-7]);
    scene.solver.end_s = 5e-3;
    println!("{scene:?}");
    scene
}

#[test]
fn a_scene_is_refused_or_has_a_verdict() {
    each_case(150, |rng| {
        let scene = machines(rng);
        let beyond = scene.checked().ok().filter(|scene| scene.goes_beyond());
        let Some(checked) = beyond else { return };
        let mut motion = Motion::new(&checked);
        let mut ran = Ok(());
        for look in 1..=50 {
            ran = motion.advance(1e-4 * f64::from(look));
            let state = motion.state();
            if ran.is_err() {
                break;
            }
            for value in [state.u, state.v, state.alpha, state.alpha_rate].concat() {
                assert!(value.is_finite(), "{state:?}");
            }
            for (side, force) in motion.multipliers() {
                assert!(side < motion.machine().polygon.sides && force.is_finite());
                let pushes = force <= 0.0 || checked.solver.contact == ContactLaw::Bilateral;
                assert!(pushes, "{force}");
            }
        }
        let verdict = verdict_of(&motion, 5e-4);
        match &ran {
            Ok(()) => assert!(!matches!(verdict, Verdict::Failed | Verdict::Divergent)),
            Err(failure) => {
                // What the pulse itself throws too far is not growth.
                let pulse = Pulse::of(&checked);
                let growth = failure.reason.is_growth() && failure.t_s > pulse.end;
                assert_eq!(verdict, if growth { Verdict::Divergent } else { Verdict::Failed });
                return;
            }
        }
        let ledger = motion.energy_account().unwrap();
        assert!(ledger.residual().is_finite());
        assert!(ledger.casing_loss_j >= 0.0 && ledger.blade_loss_j >= 0.0);
        if checked.solver.contact == ContactLaw::Unilateral {
            // An accepted gap is at most O(h) below zero.
            let deepest = motion.checks().max_penetration_m;
            let e = checked.contact.restitution;
            assert!(deepest < 1e-6 * (1.0 + 100.0 * e), "{deepest}");
        }
    });
}

#[test]
fn a_mirrored_machine_mirrors_its_motion() {
    each_case(150, |rng| {
        let mut scene = machines(rng);
        scene.excitation.amplitude_nm = 0.0;
        scene.bladed_disk.mistuning = 0.0;
        scene.solver.end_s = 4e-4;
        // A rim pressed on a stiff lining may buckle either way.
        scene.casing.radius_m = 0.5;
        let beyond = scene.checked().ok().filter(|scene| scene.goes_beyond());
        let Some(checked) = beyond else { return };
        // Seen from behind: the rotor turns the other way, and trailing tips lead.
        let mut mirror = scene.clone();
        mirror.operation.speed_rad_s *= -1.0;
        mirror.operation.speed_ramp_rad_s2 *= -1.0;
        mirror.bladed_disk.radial_coupling *= -1.0;
        let Ok(mirrored) = mirror.checked() else { return };
        let state = |scene| {
            let mut motion = Motion::new(scene);
            motion.advance(4e-4).ok().map(|()| motion.state())
        };
        if let (Some(a), Some(b)) = (state(&checked), state(&mirrored)) {
            let size = a.amplitude() + scene.clearance().abs();
            let off = (a.u[0] - b.u[0]).hypot(a.u[1] + b.u[1]);
            // A blade that is hit on an edge by round-off would be another motion.
            assert!(off < 1e-6 * size, "{off} {size}");
        }
    });
}

#[test]
fn parameters_turned_and_turned_back_leave_no_trace() {
    for contact in ["unilateral", "smooth"] {
        let mut scene = Scene::base();
        scene.set("solver.contact", contact).unwrap();
        scene.bladed_disk.radial_coupling = 0.3;
        scene.solver.step_s = 1e-6;
        let checked = scene.checked().unwrap();
        let mut other = scene.clone();
        other.bladed_disk.radial_coupling = 0.1;
        other.contact.friction = 0.2;
        let other = other.checked().unwrap();
        assert!(Change::is_live(&checked, &other));
        let (mut plain, mut turned) = (Motion::new(&checked), Motion::new(&checked));
        for t in [1e-4, 2.29e-4, 1e-3] {
            plain.advance(t).unwrap();
            turned.advance(t).unwrap();
            turned.set_parameters(&other);
            turned.set_parameters(&checked);
        }
        plain.advance(3e-3).unwrap();
        turned.advance(3e-3).unwrap();
        let (a, b) = (plain.state(), turned.state());
        assert!((a.u[0] - b.u[0]).hypot(a.u[1] - b.u[1]) < 1e-12, "{a:?} {b:?}");
        let residual = |motion: &Motion| motion.checks().energy_residual_j.unwrap();
        assert!((residual(&plain) - residual(&turned)).abs() < 1e-9);
    }
}

#[test]
fn what_is_drawn_or_fixed_is_not_live() {
    let mut scene = Scene::base();
    scene.bladed_disk.radial_coupling = 0.3;
    let turns: [fn(&mut Scene); 4] = [
        |scene| scene.bladed_disk.nodal_diameters = 4,
        |scene| scene.bladed_disk.mistuning_seed = 7,
        |scene| scene.bladed_disk.radial_coupling = 0.0,
        |scene| scene.solver.contact = ContactLaw::Smooth,
    ];
    for turn in turns {
        let mut other = scene.clone();
        turn(&mut other);
        assert!(!Change::is_live(&scene, &other));
    }
    for live in [
        |scene: &mut Scene| scene.contact.friction = 0.2,
        |scene: &mut Scene| scene.contact.restitution = 0.3,
        |scene: &mut Scene| scene.casing.tangential_ratio = 0.3,
    ] {
        let mut other = scene.clone();
        live(&mut other);
        assert!(Change::is_live(&scene, &other));
    }
}

#[test]
fn a_run_with_changes_is_that_of_one_motion() {
    let mut scene = Scene::base();
    scene.bladed_disk.radial_coupling = 0.3;
    (scene.solver.step_s, scene.solver.end_s) = (1e-6, 2e-3);
    let script =
        Script::new(vec![(4e-4, Change::Pulse), (1e-3, Change::Rotor { speed: None, ramp: -2e3 })]);
    let checked = scene.checked().unwrap();
    let report = run_to_end(&checked, &script, Default::default(), &mut |_| {});
    let mut motion = Motion::new(&checked);
    motion.advance(4e-4).unwrap();
    motion.fire();
    motion.advance(1e-3).unwrap();
    let speed = motion.rotor().speed(motion.t_s());
    motion.set_speed(speed, -2e3);
    motion.advance(2e-3).unwrap();
    assert_eq!(report.r#final.u_c_m, motion.state().u[0]);
    // Both pulses gave their impulse: the work is that of both.
    assert!(report.energy.unwrap().pulse_work_j > 0.2);
}
