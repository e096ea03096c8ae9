//! Both ends of the speeds at which a lock only pushes, of rigid contact and on a lining:
//! against the formula of docs/theory.md, section 10, written once more from bare numbers,
//! with its derivatives, and against runs in time on both sides of each. A new case is a row of
//! `windows`: a scene, and speeds below, inside and beyond.

use nalgebra::Complex;
use rubscope_solver::harmonic::{Lining, coincidence, lock_loads};
use rubscope_solver::motion::{Change, Motion, Verdict};
use rubscope_solver::scene::{ContactLaw, Scene, Value};
use rubscope_solver::study::margins::{LimitName, Margins, Target};

use crate::tips_support::{KAPPA, MU, SPEED, STEP, TAU, ZETA_C, carried, in_corner, scene};

const STIFFNESS: &str = "contact.stiffness_n_per_m";
const SMOOTHING: &str = "contact.smoothing_m";

/// A scene whose casing has a lining without smoothing.
fn lined(stiffness: f64, changes: &[(&str, f64)]) -> Scene {
    let mut scene = scene(changes);
    scene.solver.contact = ContactLaw::Smooth;
    scene.contact.stiffness_n_per_m = stiffness;
    scene.contact.smoothing_m = 0.0;
    scene
}

/// How far two groups of a lock push, as a compliance: `-tan(delta) Re H - |Im H| -
/// 1/(k sin 2 delta)`, `H = (1 + i mu_c)/(k_c - nu^2 m_c + i nu d_c) + c2/k_a`.
fn pushed(scene: &Scene, speed: f64) -> f64 {
    let (disk, casing, surface) = (&scene.bladed_disk, &scene.casing, &scene.contact);
    let (blades, n) = (f64::from(disk.blades), f64::from(scene.operation.nodal_diameters));
    let delta = std::f64::consts::PI / blades;
    let turn = 2.0 * std::f64::consts::PI * n / blades;
    let joined = disk.stiffness_nm_per_rad + 2.0 * disk.coupling_nm_per_rad * (1.0 - turn.cos());
    let blade = 0.5 * blades * joined;
    let (mass, stiffness) = (casing.modal_mass_kg, casing.modal_stiffness_n_per_m);
    let damping = 2.0 * casing.damping_ratio * (mass * stiffness).sqrt();
    let (nu, mu) = (n * speed, surface.friction);
    let slope = disk.radial_coupling;
    let product = slope * (slope + mu) * disk.blade_length_m.powi(2);
    let impedance = Complex::new(stiffness - nu * nu * mass, nu * damping);
    let turned = Complex::new(1.0, mu * casing.tangential_ratio);
    let h = turned / impedance + product / blade;
    let lining = match scene.solver.contact {
        ContactLaw::Smooth => 1.0 / (surface.stiffness_n_per_m * (2.0 * delta).sin()),
        _ => 0.0,
    };
    -delta.tan() * h.re - h.im.abs() - lining
}

/// The speed between two where that changes its sign.
fn between(scene: &Scene, [low, high]: [f64; 2]) -> f64 {
    let (mut low, mut high) = (low, high);
    let below = pushed(scene, low) > 0.0;
    assert_ne!(below, pushed(scene, high) > 0.0, "{low} {high}");
    for _ in 0..100 {
        let middle = 0.5 * (low + high);
        if (pushed(scene, middle) > 0.0) == below { low = middle } else { high = middle }
    }
    0.5 * (low + high)
}

/// Scenes whose lock ends, a speed inside, and one beyond its end.
fn windows() -> Vec<(Scene, [f64; 3])> {
    vec![
        (scene(&[(KAPPA, 0.3)]), [400.0, 520.0, 700.0]),
        (scene(&[(KAPPA, 0.1), (MU, 0.15), (TAU, 1.0 / 3.0)]), [450.0, 600.0, 1500.0]),
        (lined(1e8, &[(ZETA_C, 0.01)]), [300.0, 400.0, 700.0]),
        (lined(1e9, &[(KAPPA, 0.1), (MU, 0.05), (TAU, 0.3)]), [400.0, 520.0, 1500.0]),
    ]
}

fn value(margins: &Margins, name: LimitName) -> Option<f64> {
    margins.limit(name)?.value
}

#[test]
fn both_ends_are_those_of_the_plain_formula_and_move_as_it_does() {
    let mut compared = 0;
    for (scene, [below, inside, beyond]) in windows() {
        let margins = Margins::of(&scene.clone().checked().unwrap());
        let rigid = scene.machine().lock_windows(1.0)[0];
        for (name, closed, range) in [
            (LimitName::OmegaLock, Some(rigid.from), [below, inside]),
            (LimitName::LockEnds, rigid.to, [inside, beyond]),
        ] {
            let (closed, plain) = (closed.unwrap(), between(&scene, range));
            assert!((closed / plain - 1.0).abs() < 1e-12, "{name}: {closed} {plain}");
            // Heavy pushes bend the blades: the lock ends where it does with its own blades.
            let limit = margins.limit(name).unwrap();
            let told = limit.value.unwrap();
            assert!((told / plain - 1.0).abs() < 1e-2, "{name}: {told} {plain}");
            assert!(told == closed || scene.lining().is_none(), "{name}: {told} {closed}");
            // The formula is of rigid blades.
            if (told / plain - 1.0).abs() > 1e-12 {
                continue;
            }
            compared += 1;
            for path in [
                KAPPA,
                MU,
                TAU,
                ZETA_C,
                STIFFNESS,
                "casing.modal_mass_kg",
                "casing.modal_stiffness_n_per_m",
                "bladed_disk.stiffness_nm_per_rad",
            ] {
                let step = 1e-6;
                let at = |part: f64| between(&times(&scene, path, part), range);
                let measured = (at(1.0 + step) / at(1.0 - step)).ln() / (2.0 * step);
                // Rigid contact has no lining.
                let told = limit.sensitivities.by(path);
                let missing = path == STIFFNESS && scene.solver.contact != ContactLaw::Smooth;
                assert_eq!(told.is_none(), missing, "{name} {path}");
                let error = (told.unwrap_or(0.0) - measured).abs();
                assert!(error < 1e-7 + 1e-6 * measured.abs(), "{name} {path}: {told:?} {measured}");
            }
        }
    }
    assert!(compared > 5, "{compared}");
    for kappa in [0.35, 0.0] {
        let margins = Margins::of(&scene(&[(KAPPA, kappa)]).checked().unwrap());
        assert_eq!(value(&margins, LimitName::LockEnds), None, "{kappa}");
        assert_eq!(value(&margins, LimitName::OmegaLock).is_none(), kappa > 0.0);
    }
}

/// The scene with a number of it multiplied.
pub fn times(scene: &Scene, path: &str, part: f64) -> Scene {
    let key = rubscope_solver::scene::keys::find(path).unwrap();
    let Value::Real(x) = (key.get)(scene) else { panic!("{path}") };
    let mut beside = scene.clone();
    beside.set(path, &format!("{:?}", x * part)).unwrap();
    beside
}

/// A start in the lock of two groups on the lining of a scene; blades soon come to rest.
fn pressed_in_corner(mut scene: Scene) -> Scene {
    let (machine, speed) = (scene.machine(), scene.operation.speed_rad_s);
    let states = Lining::of(&machine, &scene.contact).unwrap().states(speed).unwrap();
    let pair = states.iter().find(|state| state.pushing == 2 && state.stable).unwrap();
    carried(&mut scene, pair.gap_m);
    scene.bladed_disk.damping_ratio = 1.0;
    scene
}

/// Turns a lock from a speed to others in turn, and keeps it there a while; whether it
/// still holds.
fn held_at(scene: Scene, speeds: [f64; 2]) -> [bool; 2] {
    let mut speed = scene.operation.speed_rad_s;
    let start = if scene.lining().is_some() { pressed_in_corner } else { in_corner };
    let mut motion = Motion::new(&start(scene).checked().unwrap());
    let mut t = 0.05;
    motion.advance(t).unwrap();
    speeds.map(|wanted| {
        let ramp = 100.0_f64.copysign(wanted - speed);
        motion.apply(&Change::Rotor { speed: None, ramp });
        t += (wanted - speed) / ramp;
        motion.advance(t).unwrap();
        motion.apply(&Change::Rotor { speed: None, ramp: 0.0 });
        speed = wanted;
        t += 0.08;
        motion.advance(t).is_ok() && motion.lasting(0.02) == Verdict::Locked
    })
}

#[test]
fn runs_in_time_keep_a_lock_to_its_ends_and_lose_it_beyond() {
    let stiff = |speed: f64| lined(3e8, &[(SPEED, speed), (STEP, 2e-6)]);
    let joined = |speed: f64| {
        lined(1e9, &[(KAPPA, 0.1), (MU, 0.05), (TAU, 0.3), (SPEED, speed), (STEP, 1e-6)])
    };
    for (scene, speeds) in [
        // The shift of mu_c by nu h, and full angles, move the end by a part of this.
        (scene(&[(KAPPA, 0.3), (SPEED, 540.0), (STEP, 1e-7)]), [563.5, 569.0]),
        (stiff(700.0), [729.0, 736.0]),
        (joined(520.0), {
            let from = joined(520.0).machine().lock_windows(1.0)[0].from;
            [from + 2.0, from - 2.0]
        }),
    ] {
        assert_eq!(held_at(scene, speeds), [true, false], "{speeds:?}");
    }
}

#[test]
fn margins_of_a_lining_that_holds_no_lock_say_why_there_are_none() {
    let scene = Scene::builtin("soft-lining").unwrap().with(&[(STIFFNESS, "1e8")]).unwrap();
    let soft = Margins::of(&scene);
    for name in [LimitName::OmegaLock, LimitName::OmegaAdhesive, LimitName::PushA] {
        let limit = soft.limit(name).unwrap();
        assert!(limit.value.is_none() && limit.note.as_ref().unwrap().contains("lining"));
    }
    assert!(soft.limit(LimitName::LockEnds).is_none());
}

/// Beyond the window two groups still balance each other, and the smallest motion leaves
/// that state for the lock of three.
#[test]
fn loads_beyond_the_end_of_two_groups_are_absent() {
    let mut scene = Scene::builtin("soft-lining").unwrap();
    scene.casing.damping_ratio = 0.01;
    scene.contact.stiffness_n_per_m = 1e8;
    for (speed, held) in [(500.0, true), (600.0, false), (700.0, false)] {
        scene.operation.speed_rad_s = speed;
        let machine = scene.machine();
        let states = Lining::of(&machine, &scene.contact).unwrap().states(speed).unwrap();
        let stable = |pushing| states.iter().any(|it| it.pushing == pushing && it.stable);
        assert_eq!([stable(2), stable(3)], [held, !held], "{speed}");
        let margins = Margins::of(&scene.checked().unwrap());
        for name in [LimitName::PushA, LimitName::Torque] {
            let limit = margins.limit(name).unwrap();
            assert_eq!(limit.value.is_some(), held, "{name} at {speed}");
            let why = "no two groups hold a lock";
            assert_eq!(limit.note.as_ref().is_some_and(|note| note.contains(why)), !held);
        }
    }
}

/// The loads of a pair on a lining, with smoothing or without: those of all steady states,
/// and their derivatives.
#[test]
fn loads_on_a_lining_are_those_of_its_steady_state() {
    for (smoothing, changes) in
        [(0.0, &[][..]), (1e-6, &[(KAPPA, 0.1), (MU, 0.05), (TAU, 0.3), (SPEED, -500.0)])]
    {
        let mut scene = lined(1e9, changes);
        scene.contact.smoothing_m = smoothing;
        let (machine, speed) = (scene.machine(), scene.operation.speed_rad_s);
        let lining = Lining::of(&machine, &scene.contact).unwrap();
        let states = lining.states(speed).unwrap();
        let pair = states.iter().find(|state| state.pushing == 2 && state.stable).unwrap();
        let base = Margins::of(&scene.checked().unwrap());
        let mut pushes =
            [LimitName::PushA, LimitName::PushB].map(|name| value(&base, name).unwrap());
        pushes.sort_by(|a, b| b.total_cmp(a));
        for (told, push) in pushes.iter().zip(&pair.pushes) {
            assert!((told / push.push_n - 1.0).abs() < 1e-9, "{told} {push:?}");
        }
        // Torque that friction does not take is what the damper does.
        let nu = machine.nu(speed);
        let square = pair.casing_m.powi(2);
        let loads = lock_loads(&machine, speed).unwrap();
        assert!((loads.amplitude_m / pair.casing_m - 1.0).abs() < 1e-9);
        if scene.contact.friction == 0.0 {
            let torque = machine.nodal_diameters * machine.casing_damping * nu * square;
            assert!((value(&base, LimitName::Torque).unwrap() / torque - 1.0).abs() < 1e-9);
        }
        for path in [STIFFNESS, SMOOTHING, ZETA_C, SPEED] {
            let step = 1e-5;
            let beside = [1.0 - step, 1.0 + step].map(|part| {
                let scene = times(&scene, path, part);
                let loads = lock_loads(&scene.machine(), scene.operation.speed_rad_s).unwrap();
                [loads.pushes_n[0], loads.pushes_n[1], loads.power_w].map(f64::abs)
            });
            for name in [LimitName::PushA, LimitName::PushB, LimitName::Power] {
                let limit = base.limit(name).unwrap();
                let near = |at: &usize| (beside[0][*at] / limit.value.unwrap() - 1.0).abs();
                let place = (0..3).min_by(|a, b| near(a).total_cmp(&near(b))).unwrap();
                assert!(near(&place) < 1e-3, "{name}: {limit:?} {beside:?}");
                let measured = (beside[1][place] / beside[0][place]).ln() / (2.0 * step);
                let told = limit.sensitivities.by(path).unwrap();
                let error = (told - measured).abs();
                assert!(error < 1e-5 + 1e-5 * measured.abs(), "{name} {path}: {told} {measured}");
            }
        }
    }
}

/// A target is sought in the limits of the scene's own law.
#[test]
fn a_lining_is_found_that_holds_a_lock_from_a_speed() {
    let scene = lined(1e9, &[]).checked().unwrap();
    let target = Target::parse("omega_lock=430", STIFFNESS).unwrap();
    let found = target.solve(&scene, &|| true).unwrap();
    let stiffness = found.to.unwrap();
    let plain = between(&lined(stiffness, &[]), [400.0, 500.0]);
    assert!((plain - 430.0).abs() < 1e-3, "{stiffness}: {plain}");
}

/// A whirl on a lining begins at the fold of rigid contact, if the lining is stiff enough
/// for its wave: as the waves that last say on both sides of it.
#[test]
fn a_whirl_begins_on_a_lining_that_is_stiff_enough_for_it() {
    for (stiffness, begins) in [(8e4, true), (7e4, false)] {
        let scene = lined(stiffness, &[(KAPPA, 0.3), (SPEED, 450.0)]);
        let margins = Margins::of(&scene.checked().unwrap());
        let onset = value(&margins, LimitName::WhirlOnset);
        assert_eq!(onset.is_some(), begins, "{stiffness}");
        let fold = onset.unwrap_or(414.339);
        assert!((fold - 414.339).abs() < 1e-3, "{fold}");
        let beside = coincidence(&scene, &[fold - 0.01, fold + 0.01]).unwrap();
        let lasts = beside.iter().map(|point| point.blade_amplitude_rad.is_some());
        assert_eq!(lasts.collect::<Vec<_>>(), [false, begins], "{stiffness}");
        // The corner that flutters is one that does not give.
        assert!(value(&margins, LimitName::FlutterSpeed).is_none());
    }
}
