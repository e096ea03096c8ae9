//! Steady states of blades on a lining over a clearance: which linings hold a lock and
//! at which speeds, and branches followed over a parameter.

use rubscope_solver::harmonic::least_lock_stiffness;
use rubscope_solver::scene::Scene;

use crate::close;
use crate::hbm_lining::with;

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
            lined(&stiffness, more).machine().lock_windows(1.0).first().copied()
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
