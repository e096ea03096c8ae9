//! Laws of motions beyond the paper, over random scenes: a refusal or a verdict and
//! never a number that is none, pushes that only push, energy that is never created. A new kind
//! of machine is a part of `machines`.

use crate::drawn;
use proptest::prelude::*;
use rubscope_solver::motion::{Change, Motion, Pulse, Script, Verdict, run_to_end, verdict_of};
use rubscope_solver::scene::{ContactLaw, ModelSize, Scene};

/// A random machine with something beyond the paper.
fn machines() -> impl Strategy<Value = Scene> {
    let blades = prop_oneof![
        Just((22_u32, 3_u32)),
        Just((22, 4)),
        Just((12, 3)),
        Just((7, 3)),
        Just((5, 0)),
        Just((3, 1)),
        Just((1, 1)),
        Just((131, 5))
    ];
    let tips = (-0.5..1.0_f64, 0.0..0.5_f64, 0.0..1.0_f64, 0.0..0.9_f64);
    let kinds = (
        prop_oneof![Just(ModelSize::Rigid), Just(ModelSize::Modal), Just(ModelSize::Full)],
        prop_oneof![
            Just(ContactLaw::Unilateral),
            Just(ContactLaw::Smooth),
            Just(ContactLaw::Bilateral)
        ],
    );
    let lining = (1e3..1e8_f64, prop_oneof![Just(0.0), Just(1e-6), Just(1e-5)], any::<bool>());
    let drive = (-600.0..600.0_f64, -2e5..2e5_f64, -500.0..500.0_f64, 0_u32..7);
    let choices = (any::<[bool; 6]>(), prop_oneof![Just(2e-6), Just(5e-7)]);
    (blades, tips, kinds, lining, drive, choices).prop_map(
        |(blades, tips, kinds, lining, drive, (on, step))| {
            let mut scene = Scene::base();
            (scene.bladed_disk.blades, scene.operation.nodal_diameters) = blades;
            let when = |on: bool, value: f64| if on { value } else { 0.0 };
            scene.bladed_disk.radial_coupling = when(on[0], tips.0);
            scene.contact.friction = when(on[1], tips.1);
            scene.casing.tangential_ratio = when(on[2], tips.2);
            scene.contact.restitution = when(on[3], tips.3);
            (scene.solver.model, scene.solver.contact) = kinds;
            scene.contact.stiffness_n_per_m = lining.0;
            scene.contact.smoothing_m = lining.1;
            if kinds.1 == ContactLaw::Smooth && lining.2 {
                scene.casing.radius_m = 0.49988;
            }
            scene.operation.speed_rad_s = drive.0;
            scene.operation.pulse_n = drive.1;
            scene.operation.speed_ramp_rad_s2 = when(on[4], drive.2);
            if on[5] {
                let lining = kinds.1 == ContactLaw::Smooth;
                scene.bladed_disk.nodal_diameters = if lining { drive.3 } else { 0 };
                scene.excitation.amplitude_nm = when(kinds.0 == ModelSize::Modal, 0.3);
            }
            if kinds.0 == ModelSize::Full && on[3] {
                scene.bladed_disk.mistuning = 0.02;
            }
            scene.solver.step_s = step;
            scene.solver.end_s = 5e-3;
            scene
        },
    )
}

proptest! {
    #![proptest_config(drawn(150))]

    #[test]
    fn a_scene_is_refused_or_has_a_verdict(scene in machines()) {
        let Ok(checked) = scene.checked() else { return Ok(()) };
        if !checked.goes_beyond() {
            return Ok(());
        }
        let mut motion = Motion::new(&checked);
        let mut ran = Ok(());
        for look in 1..=50 {
            ran = motion.advance(1e-4 * f64::from(look));
            let state = motion.state();
            if ran.is_err() {
                break;
            }
            for value in [state.u, state.v, state.alpha, state.alpha_rate].concat() {
                prop_assert!(value.is_finite(), "{state:?}");
            }
            for (side, force) in motion.multipliers() {
                prop_assert!(side < motion.machine().polygon.sides && force.is_finite());
                let pushes = force <= 0.0 || checked.solver.contact == ContactLaw::Bilateral;
                prop_assert!(pushes, "{force}");
            }
        }
        let verdict = verdict_of(&motion, 5e-4);
        match &ran {
            Ok(()) => prop_assert!(!matches!(verdict, Verdict::Failed | Verdict::Divergent)),
            Err(failure) => {
                // What the pulse itself throws too far is not growth.
                let pulse = Pulse::of(&checked);
                let growth = failure.reason.is_growth() && failure.t_s > pulse.end;
                prop_assert_eq!(verdict, if growth { Verdict::Divergent } else { Verdict::Failed });
                return Ok(());
            }
        }
        let ledger = motion.energy_account().unwrap();
        prop_assert!(ledger.residual().is_finite());
        prop_assert!(ledger.casing_loss_j >= 0.0 && ledger.blade_loss_j >= 0.0);
        if checked.solver.contact == ContactLaw::Unilateral {
            // An accepted gap is at most O(h) below zero.
            let deepest = motion.checks().max_penetration_m;
            let e = checked.contact.restitution;
            prop_assert!(deepest < 1e-6 * (1.0 + 100.0 * e), "{deepest}");
        }
    }

    #[test]
    fn a_mirrored_machine_mirrors_its_motion(scene in machines()) {
        let mut scene = scene;
        scene.excitation.amplitude_nm = 0.0;
        scene.bladed_disk.mistuning = 0.0;
        scene.solver.end_s = 4e-4;
        // A rim pressed on a stiff lining may buckle either way.
        scene.casing.radius_m = 0.5;
        let Ok(checked) = scene.checked() else { return Ok(()) };
        // Seen from behind: the rotor turns the other way, and trailing tips lead.
        let mut mirror = scene.clone();
        mirror.operation.speed_rad_s *= -1.0;
        mirror.operation.speed_ramp_rad_s2 *= -1.0;
        mirror.bladed_disk.radial_coupling *= -1.0;
        let Ok(mirrored) = mirror.checked() else { return Ok(()) };
        if !checked.goes_beyond() {
            return Ok(());
        }
        let state = |scene| {
            let mut motion = Motion::new(scene);
            motion.advance(4e-4).ok().map(|()| motion.state())
        };
        if let (Some(a), Some(b)) = (state(&checked), state(&mirrored)) {
            let size = a.amplitude() + scene.clearance().abs();
            let off = (a.u[0] - b.u[0]).hypot(a.u[1] + b.u[1]);
            // A blade that is hit on an edge by round-off would be another motion.
            prop_assert!(off < 1e-6 * size, "{off} {size}");
        }
    }
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
