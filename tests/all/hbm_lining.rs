//! Blades on a lining in the frequency domain: rest under preload, its Hopf points and
//! limit cycles, against numbers from time integration by other programs.

use crate::close;
use rubscope_solver::harmonic::{Cycle, Lining, growth_threshold};
use rubscope_solver::scene::Scene;

/// Pressed in by 20 micrometres, with the smooth law.
const PRELOADED: [(&str, &str); 3] = [
    ("solver.contact", "smooth"),
    ("casing.radius_m", "0.49988"),
    ("bladed_disk.radial_coupling", "0.5"),
];

pub fn preloaded(stiffness: &str, more: &[(&str, &str)]) -> Scene {
    let mut set = PRELOADED.to_vec();
    set.push(("contact.stiffness_n_per_m", stiffness));
    set.extend(more);
    let mut scene = Scene::base();
    set.iter().for_each(|(path, value)| scene.set(path, value).unwrap());
    scene
}

pub fn with<T>(scene: &Scene, of: impl FnOnce(&Lining) -> T) -> T {
    let machine = scene.machine();
    of(&Lining::of(&machine, &scene.contact).unwrap())
}

/// What a wave on a lining comes to.
#[derive(Debug, PartialEq)]
enum Whirl {
    /// Every wave decays.
    Decays,
    /// A wave of constant amplitude, the smallest stable one.
    Cycle(Cycle),
    /// No wave is large enough to stop its growth.
    Unbounded,
    /// Rest grows and waves far out decay, but none of constant amplitude is stable, as
    /// without damping.
    Unsteady,
}

fn whirl(lining: &Lining<'_>, speed: f64) -> Whirl {
    let stable = lining.cycles(speed).unwrap().into_iter().find(|cycle| cycle.stable);
    match stable {
        Some(cycle) => Whirl::Cycle(cycle),
        None if !lining.is_bounded(speed) => Whirl::Unbounded,
        None if lining.rest(speed).grows => Whirl::Unsteady,
        None => Whirl::Decays,
    }
}

/// The limit cycle at a speed.
fn cycle(lining: &Lining, speed: f64) -> Cycle {
    match whirl(lining, speed) {
        Whirl::Cycle(cycle) => cycle,
        other => panic!("{other:?} at {speed}"),
    }
}

/// Low damping, and the lining that then shows the coincidence.
const LIGHT: [(&str, &str); 2] =
    [("casing.damping_ratio", "0.01"), ("bladed_disk.damping_ratio", "0.01")];
/// 60/11 kN/m: all blades together 60 kN/m.
const SOFT: &str = "5454.545454545455";

#[test]
fn hopf_points_bound_the_growth() {
    let dug_in = [("bladed_disk.radial_coupling", "-0.15"), ("contact.friction", "0.3")];
    for (scene, expected, digits) in [
        (preloaded("27e3", &[]), [399.4641, 437.8875], 1e-4),
        (preloaded(SOFT, &LIGHT), [391.192, 398.495], 1e-3),
        (preloaded("80e3", &dug_in), [259.627, 286.212], 1e-3),
    ] {
        with(&scene, |lining| {
            let points = lining.hopf_points([0.0, 700.0]).unwrap();
            assert_eq!(points.len(), 2, "{points:?}");
            for (point, expected) in points.iter().zip(expected) {
                assert!((point.speed_rad_s - expected).abs() < 0.51 * digits, "{points:?}");
                assert!(lining.rest(point.speed_rad_s).worst().growth_1_s.abs() < 1e-9);
            }
            assert!(points[0].grows_above && !points[1].grows_above);
            // Mirrored, the tips lean the other way too.
            let kappa = -lining.machine.radial_coupling;
            let mut turned = scene.clone();
            turned.set("bladed_disk.radial_coupling", &kappa.to_string()).unwrap();
            let mirrored = with(&turned, |lining| lining.hopf_points([-700.0, 0.0]).unwrap());
            for (point, mirrored) in points.iter().zip(mirrored.iter().rev()) {
                assert!((mirrored.speed_rad_s + point.speed_rad_s).abs() < 1e-9, "{mirrored:?}");
                assert_eq!(mirrored.grows_above, !point.grows_above);
            }
            // The growth is fastest within 2 rad/s of the shifted coincidence.
            let shifted = lining.shifted_coincidence(1.0).unwrap();
            let growth = |speed: f64| lining.rest(speed).worst().growth_1_s;
            let fastest = (-800..=800)
                .map(|k| shifted + 0.05 * f64::from(k))
                .max_by(|a, b| growth(*a).total_cmp(&growth(*b)))
                .unwrap();
            assert!((fastest - shifted).abs() < 2.0, "{fastest} {shifted}");
        });
    }
}

/// Ring friction alone feeds a backward wave.
#[test]
fn dry_whip_runs_backward_at_any_speed() {
    let scene = preloaded(
        "3e5",
        &[
            ("bladed_disk.radial_coupling", "0"),
            ("contact.friction", "0.3"),
            ("casing.tangential_ratio", "0.3333333333333333"),
        ],
    );
    with(&scene, |lining| {
        for speed in [100.0, 500.0] {
            let worst = lining.rest(speed).worst();
            close(worst.growth_1_s, 9.0697, 1e-5);
            assert!(worst.omega_rad_s < 0.0);
            let found = cycle(lining, speed);
            close(found.omega_rad_s, -1421.66, 5e-6);
            close(found.gap_amplitude_m, 4.686e-5, 2e-4);
            let ratio = -found.omega_rad_s / lining.machine.omega_c;
            close(ratio - ratio.recip(), 2.0 * 0.05 / 0.1, 1e-9);
        }
    });
    // Not with less friction than mu_c S0 = d_c sqrt((k_c + S0)/m_c).
    let machine = scene.machine();
    let stiffness: f64 = 11.0 * 3e5;
    let edge = machine.casing_damping
        * ((machine.casing_stiffness + stiffness) / machine.casing_mass).sqrt()
        / stiffness;
    for (part, grows) in [(0.97, false), (1.03, true)] {
        let mut changed = scene.clone();
        changed.set("contact.friction", &(3.0 * part * edge).to_string()).unwrap();
        with(&changed, |lining| assert_eq!(lining.rest(500.0).grows, grows));
    }
}

#[test]
fn threshold_of_the_lining_is_that_of_its_formula() {
    for (kappa, zeta) in [("0.5", "0.05"), ("0.3", "0.01"), ("0.2", "0.002")] {
        let scene = preloaded(
            "27e3",
            &[
                ("bladed_disk.radial_coupling", kappa),
                ("casing.damping_ratio", zeta),
                ("bladed_disk.damping_ratio", zeta),
            ],
        );
        let m = scene.machine();
        let found = growth_threshold(&m, 1.0).unwrap();
        let inertia = m.casing_mass * m.omega_c * m.blade_modal_mass * m.omega_bd;
        let damping = m.casing_damping_ratio * m.omega_c * m.blade_damping_ratio * m.omega_bd;
        let formula = 2.0 * (inertia * damping / m.coupling_product_at(1.0)).sqrt();
        close(found.stiffness_n_per_m, formula, 0.15);
        // Below it no speed grows, above it some do.
        for (part, grows) in [(0.995, false), (1.005, true)] {
            let stiffness = (part * found.stiffness_n_per_m / 11.0).to_string();
            let mut scene = scene.clone();
            scene.set("contact.stiffness_n_per_m", &stiffness).unwrap();
            with(&scene, |lining| {
                let points = lining.hopf_points([0.0, 700.0]).unwrap();
                assert_eq!(!points.is_empty(), grows, "{kappa} {zeta} {part}");
            });
        }
    }
}
