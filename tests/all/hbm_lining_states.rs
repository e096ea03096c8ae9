//! Steady states of blades on a lining over a clearance: which linings hold a lock and
//! at which speeds, and branches followed over a parameter.

use rubscope_solver::harmonic::{BranchEnd, Lining, Special, follow, least_lock_stiffness};
use rubscope_solver::scene::Scene;

use crate::hbm_lining::{close, preloaded, with};

/// The paper's machine with a lining over its clearance.
fn lined(stiffness: &str, more: &[(&str, &str)]) -> Scene {
    let mut scene = Scene::base();
    let set = [
        ("solver.contact", "smooth"),
        ("contact.stiffness_n_per_m", stiffness),
        ("contact.smoothing_m", "0"),
    ];
    set.iter().chain(more).for_each(|(path, value)| scene.set(path, value).unwrap());
    scene
}

#[test]
fn a_soft_lining_cannot_hold_a_lock() {
    let light = [("casing.damping_ratio", "0.01")];
    for (more, stiffness, speed) in [(&[][..], 1.9312e8, 509.1), (&light[..], 2.440e7, 334.0)] {
        let least = least_lock_stiffness(&lined("1e9", more).machine()).unwrap();
        close(least.stiffness_n_per_m, stiffness, 3e-4);
        assert!((least.speed_rad_s - speed).abs() < 0.06, "{least:?}");
    }
    for (stiffness, more, window) in [
        ("3e8", &[][..], [438.1581, 732.355]),
        ("2e8", &[][..], [480.472, 548.470]),
        ("1e8", &light[..], [315.398, 535.074]),
    ] {
        let found = lined(stiffness, more).machine().lock_window(1.0).unwrap();
        assert!((found.from - window[0]).abs() < 6e-4, "{found:?}");
        assert!((found.to.unwrap() - window[1]).abs() < 6e-4, "{found:?}");
    }
    let stiff = lined("1e9", &[]).machine().lock_window(1.0).unwrap();
    assert!((stiff.from - 417.6167).abs() < 6e-5, "{stiff:?}");
    let soft = lined("1.93e8", &[]).machine().lock_window(1.0);
    assert_eq!(soft, None);
    // Next to rigid contact the window is that of the paper's lock.
    let machine = lined("1e15", &[]).machine();
    let window = machine.lock_window(1.0).unwrap();
    close(window.from, machine.with_lining(None).lock_speed().unwrap(), 2e-6);
    assert!(window.to.unwrap() > 1e6);
}

/// The pushes of the lock just inside its window, and its end at the window's end.
#[test]
fn pushes_of_a_soft_lock_to_its_last_speed() {
    with(&lined("1e9", &[]), |lining| {
        let states = lining.states(418.6166508).unwrap();
        let lock = states.iter().find(|state| state.stable && state.pushing == 2).unwrap();
        close(lock.pushes[0].push_n, 163.825941, 1e-8);
        close(lock.pushes[1].push_n, 0.541935, 2e-6);
        assert!(lining.states(416.6166508).unwrap().iter().all(|state| state.pushing == 0));
        let from = lining.machine.lock_window(1.0).unwrap().from;
        let held = |speed: f64| lining.states(speed).unwrap().len() > 1;
        assert!(held(from + 1e-6) && !held(from - 1e-6));
        // The saddle of one group is beside the lock.
        let saddle = states.iter().find(|state| state.pushing == 1).unwrap();
        assert!(!saddle.stable && saddle.growth_1_s > 0.0 && saddle.frequency_rad_s == 0.0);
    });
}

/// Without damping, node and saddle swap as the wave is pushed out harder.
#[test]
fn undamped_the_push_spreads_over_more_blades() {
    let undamped = [("casing.damping_ratio", "0"), ("bladed_disk.damping_ratio", "0")];
    with(&lined("1e7", &undamped), |lining| {
        for (speed, pushing) in [(300.0, 2), (400.0, 3), (420.0, 4)] {
            let states = lining.states(speed).unwrap();
            let held: Vec<usize> =
                states.iter().filter(|s| s.stable && s.pushing > 0).map(|s| s.pushing).collect();
            assert_eq!(held, [pushing], "{speed}: {states:?}");
        }
        // The first swap, at |K| = 2 k_p sin^2 delta.
        let m = &lining.machine;
        let outward = 2.0 * 1e7 * m.polygon.delta.sin().powi(2);
        let swap = ((m.casing_stiffness + outward) / m.casing_mass).sqrt() / 3.0;
        for (speed, pushing) in [(swap - 0.01, 2), (swap + 0.01, 3)] {
            let states = lining.states(speed).unwrap();
            assert!(states.iter().any(|s| s.stable && s.pushing == pushing), "{states:?}");
        }
    });
}

#[test]
fn a_very_stiff_lining_is_the_rigid_lock() {
    for (kappa, pushes) in [("0", [244.415923, 57.294779]), ("0.1", [258.358348020, 55.600932525])]
    {
        let scene = lined("1e15", &[("bladed_disk.radial_coupling", kappa)]);
        with(&scene, |lining| {
            let states = lining.states(500.0).unwrap();
            let lock = states.iter().find(|state| state.stable && state.pushing == 2).unwrap();
            for (push, expected) in lock.pushes.iter().zip(pushes) {
                close(push.push_n, expected, 1e-6);
            }
        });
    }
}

/// Friction on the casing and tips that move outward ask for a stiffer lining; a preload,
/// and what no rigid contact holds either, have none.
#[test]
fn the_least_stiffness_is_where_a_window_opens() {
    let ring = ("casing.tangential_ratio", "0.3");
    for more in [
        &[("bladed_disk.radial_coupling", "0.1")][..],
        &[ring, ("contact.friction", "0.1")],
        &[ring, ("contact.friction", "0.05"), ("bladed_disk.radial_coupling", "0.05")],
    ] {
        let least = least_lock_stiffness(&lined("1e9", more).machine()).unwrap();
        // Of the machine, whatever its own lining is.
        assert_eq!(least_lock_stiffness(&lined("1e6", more).machine()), Some(least));
        let window = |part: f64| {
            let stiffness = (least.stiffness_n_per_m * part).to_string();
            lined(&stiffness, more).machine().lock_window(1.0)
        };
        assert_eq!(window(1.0 - 1e-9), None);
        let opens = window(1.0 + 1e-9).unwrap();
        let inside = opens.from < least.speed_rad_s && least.speed_rad_s < opens.to.unwrap();
        assert!(inside && least.stiffness_n_per_m > 1.9312e8, "{least:?} {opens:?}");
    }
    for (path, value) in [("casing.radius_m", "0.49988"), ("bladed_disk.radial_coupling", "0.35")] {
        assert_eq!(least_lock_stiffness(&lined("1e9", &[(path, value)]).machine()), None);
    }
}

fn marked(scene: &Scene, path: &str, over: [f64; 2]) -> (Vec<(Special, f64)>, BranchEnd) {
    let branch = follow(scene, path, over).unwrap();
    let marks = branch.points.iter().filter_map(|at| Some((at.special?, at.parameter))).collect();
    (marks, branch.end)
}

#[test]
fn a_followed_lock_turns_back_where_its_window_ends() {
    let scene = lined("1e9", &[]);
    let from = scene.machine().lock_window(1.0).unwrap().from;
    let (marks, end) = marked(&scene, "operation.speed_rad_s", [500.0, 400.0]);
    assert_eq!((marks.len(), marks[0].0, end), (1, Special::Border, BranchEnd::Returned));
    assert!((marks[0].1 - from).abs() < 1e-6, "{marks:?} {from}");
    // Over the stiffness at one speed.
    let (marks, _) = marked(&scene, "contact.stiffness_n_per_m", [1e9, 1e8]);
    let machine = scene.machine();
    let nu = machine.nu(500.0);
    let (k, d) =
        (machine.casing_mass * nu * nu - machine.casing_stiffness, machine.casing_damping * nu);
    let delta = machine.polygon.delta;
    let needed = (k * k + d * d) / ((2.0 * delta).sin() * (k * delta.tan() - d));
    close(marks[0].1, needed, 1e-6);
    // Smoothed, the corner is a fold.
    let mut smooth = scene.clone();
    smooth.set("contact.smoothing_m", "1e-7").unwrap();
    let (marks, end) = marked(&smooth, "operation.speed_rad_s", [500.0, 400.0]);
    assert_eq!(
        (marks.len(), marks[0].0, end),
        (1, Special::Fold, BranchEnd::Returned),
        "{marks:?}"
    );
    // On one side of it there are the lock and the saddle, on the other neither.
    with(&smooth, |lining| {
        for (aside, count) in [(1e-4, 3), (-1e-4, 1)] {
            let states = lining.states(marks[0].1 + aside).unwrap();
            assert_eq!(states.len(), count, "{aside}: {states:?}");
        }
    });
}

#[test]
fn every_followed_point_is_a_steady_state_and_work_is_bounded() {
    let scene = lined("3e8", &[("contact.smoothing_m", "1e-8")]);
    for (path, over) in [
        ("operation.speed_rad_s", [500.0, 900.0]),
        ("casing.damping_ratio", [0.05, 0.2]),
        ("bladed_disk.radial_coupling", [0.0, 0.3]),
    ] {
        let branch = follow(&scene, path, over).unwrap();
        assert!(branch.points.len() > 10 && branch.points.len() < 4000, "{path}");
        assert!(
            branch.end != BranchEnd::Lost && branch.end != BranchEnd::Most,
            "{path} {:?}",
            branch.end
        );
        for point in branch.points.iter().step_by(7) {
            let mut here = scene.clone();
            here.set(path, &format!("{:?}", point.parameter)).unwrap();
            let machine = here.machine();
            let lining = Lining::of(&machine, &here.contact).unwrap();
            let states = lining.states(here.operation.speed_rad_s).unwrap();
            let size = point.state.gap_m[0].hypot(point.state.gap_m[1]);
            let same = states.iter().any(|state| {
                let other = state.gap_m[0].hypot(state.gap_m[1]);
                (other - size).abs() < 1e-7 * size && state.pushing == point.state.pushing
            });
            assert!(same, "{path} {}: {:?} is none of {states:?}", point.parameter, point.state);
        }
    }
}

#[test]
fn rest_under_preload_is_followed_through_its_hopf_points() {
    let scene = preloaded("27e3", &[]);
    let (marks, end) = marked(&scene, "operation.speed_rad_s", [380.0, 450.0]);
    assert_eq!(end, BranchEnd::Reached);
    assert_eq!(marks.iter().map(|mark| mark.0).collect::<Vec<_>>(), [Special::Hopf; 2]);
    assert!((marks[0].1 - 399.4641).abs() < 1e-4 && (marks[1].1 - 437.8875).abs() < 1e-4);
    let (marks, _) = marked(&scene, "casing.damping_ratio", [0.05, 0.3]);
    assert_eq!(marks.len(), usize::from(with(&scene, |l| l.rest(500.0).grows)));
}

#[test]
fn what_cannot_be_followed_is_refused() {
    let scene = lined("1e9", &[]);
    for (path, over, said) in [
        ("solver.model", [0.0, 1.0], "solver.model"),
        ("nothing.here", [0.0, 1.0], "nothing.here"),
        ("operation.speed_rad_s", [300.0, 400.0], "a steady state whose blades push"),
        ("operation.speed_rad_s", [500.0, f64::NAN], "operation.speed_rad_s"),
        ("operation.speed_rad_s", [500.0, 500.0], "two different values"),
        ("casing.radius_m", [0.5, 0.4999], "casing.radius_m"),
    ] {
        let error = follow(&scene, path, over).unwrap_err().to_string();
        assert!(error.contains(said), "{path}: {error}");
    }
}
