//! Where a lock holds: both blades push, and no motion that keeps it grows. One answer for every
//! question about it. A case is a machine and the speeds at which its lock lasts.

use crate::explicit::scene;
use rubscope_solver::harmonic::{
    Form, flutters, lock_growth, lock_window, lock_windows, locked_motion,
};
use rubscope_solver::scene::Scene;
use rubscope_solver::study::margins::{LimitName, Margins};

/// A lock that grows at every speed.
const GROWS: [(&str, &str); 6] = [
    ("solver.contact", "unilateral"),
    ("bladed_disk.radial_coupling", "-0.15"),
    ("contact.friction", "0.4"),
    ("casing.tangential_ratio", "0.2"),
    ("bladed_disk.damping_ratio", "0.001"),
    ("operation.speed_rad_s", "800"),
];

#[test]
fn flutter_from_rest_on_is_found_and_no_lock_holds_there() {
    for stiffening in ["0", "0.01"] {
        let mut scene = scene(&GROWS);
        scene.set("bladed_disk.centrifugal_stiffening", stiffening).unwrap();
        let machine = scene.machine();
        let found = flutters(&machine, 1.0);
        assert_eq!(found.len(), 1, "{found:?}");
        assert_eq!((found[0].from, found[0].to), (0.0, None));
        // Both blades push from 510 rad/s on.
        assert!((machine.lock_windows(1.0)[0].from - 511.0).abs() < 2.0);
        assert_eq!(lock_windows(&machine, 1.0), []);
        let margins = Margins::of(&scene.checked().unwrap());
        let lock = margins.limit(LimitName::OmegaLock).unwrap();
        assert_eq!(lock.value, None);
        assert!(lock.note.as_ref().unwrap().contains("flutters"), "{lock:?}");
        let flutter = margins.limit(LimitName::FlutterSpeed).unwrap();
        assert_eq!((flutter.value, flutter.margin), (Some(0.0), None));
        assert_eq!(flutter.note.as_deref(), Some("at every speed"));
        let push = margins.limit(LimitName::PushA).unwrap();
        assert!(push.note.as_ref().unwrap().contains("this lock is unstable"), "{push:?}");
    }
}

/// Rates of an independent code: 9.0 1/s at 800 rad/s, 19.7 at 1500.
#[test]
fn growth_of_a_lock_that_pushes_hold() {
    let machine = scene(&GROWS).machine();
    for (speed, expected) in [(800.0, 9.0), (1500.0, 19.7)] {
        let growth = lock_growth(&machine, speed).unwrap();
        assert!((growth - expected).abs() < 0.1, "{growth}");
    }
    // No lock is held by pushes here, and this one lasts.
    assert_eq!(lock_growth(&machine, 150.0), None);
    assert_eq!(lock_growth(&Scene::base().machine(), 500.0), None);
}

#[test]
fn a_window_of_a_lock_is_where_its_motion_is_stable() {
    let (mut held, mut lost) = (0, 0);
    for (kappa, friction, blades, stiffening) in [
        ("-0.15", "0.4", "0.0005", "0"),
        ("-0.15", "0.1", "0.02", "0.2"),
        ("0.1", "0", "0.02", "0.2"),
        ("0.1", "0.1", "0.0005", "0"),
        ("0.3", "0.1", "0.02", "0"),
        ("0.3", "0.4", "0.0005", "0.2"),
        ("0.5", "0", "0.0005", "0.2"),
        ("0.5", "0.1", "0.02", "0"),
    ] {
        let machine = scene(&[
            ("bladed_disk.radial_coupling", kappa),
            ("contact.friction", friction),
            ("casing.tangential_ratio", "0.3"),
            ("bladed_disk.damping_ratio", blades),
            ("bladed_disk.centrifugal_stiffening", stiffening),
        ])
        .machine();
        let speeds: Vec<f64> = (1..40).map(|n| 31.7 * f64::from(n)).collect();
        let windows = lock_windows(&machine, 1.0);
        assert_eq!(windows.first().copied(), lock_window(&machine, 1.0));
        let sweep = locked_motion(&machine, Form::Modal, true, None, &speeds).unwrap();
        for point in sweep.points {
            let has = |part: f64| windows.iter().any(|window| window.has(point.speed_rad_s * part));
            // Both forms differ by the small slope of the gap beside a limit.
            if has(0.998) != has(1.002) {
                continue;
            }
            assert_eq!(has(1.0), point.stable, "{point:?} {windows:?}");
            *(if point.stable { &mut held } else { &mut lost }) += 1;
        }
    }
    assert!(held > 50 && lost > 50, "{held} {lost}");
}

/// Blades of the rigid model do not bend under the loads of a lock: they are those of the closed
/// form.
#[test]
fn loads_of_a_lock_of_rigid_blades_are_those_of_blades_that_do_not_bend() {
    let loads = |model: &str| {
        let scene = scene(&[
            ("solver.model", model),
            ("casing.damping_ratio", "0.3"),
            ("operation.speed_rad_s", "2000"),
        ]);
        let margins = Margins::of(&scene.checked().unwrap());
        let value = |name| margins.limit(name).unwrap().value.unwrap();
        let by = |path| margins.limit(LimitName::PushA).unwrap().sensitivities.by(path);
        let closed = scene.machine().locked_multipliers(2000.0).unwrap();
        let stiffness = by("bladed_disk.stiffness_nm_per_rad").unwrap();
        ([value(LimitName::PushA), value(LimitName::PushB)], closed.map(|force| -force), stiffness)
    };
    let ([a, b], closed, by) = loads("rigid");
    assert!((a - closed[0]).abs() < 1e-12 * a && (b - closed[1]).abs() < 1e-12 * b, "{a} {b}");
    assert_eq!(by, 0.0);
    let ([bent, _], ..) = loads("modal");
    assert!((bent - a).abs() > 1e-9 * a, "{bent} {a}");
}
