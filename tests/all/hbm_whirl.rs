//! Whirl of blades and casing in the frequency domain: on a rim of many blades, and on
//! the polygon of the blades there are.

use proptest::prelude::*;
use rubscope_solver::harmonic::{
    Joint, NoWhirl, RoundWhirl, round_whirls, whirl_onset, whirl_onsets, whirl_over,
};
use rubscope_solver::model::Machine;
use rubscope_solver::scene::Scene;

/// Table 1 with these tips: `kappa`, `mu`, `mu_c`, and one damping ratio for both
/// structures, if given.
fn machine([kappa, mu, mu_c]: [f64; 3], zeta: Option<f64>) -> Machine {
    let mut scene = Scene::base();
    scene.bladed_disk.radial_coupling = kappa;
    scene.contact.friction = mu;
    scene.casing.tangential_ratio = if mu == 0.0 { 0.0 } else { mu_c / mu };
    if let Some(zeta) = zeta {
        scene.casing.damping_ratio = zeta;
        scene.bladed_disk.damping_ratio = zeta;
    }
    scene.machine()
}

fn waves(machine: &Machine, speed: f64) -> Vec<RoundWhirl> {
    round_whirls(&Joint::at(machine, speed))
}

fn close(value: f64, expected: f64, part: f64) {
    assert!((value - expected).abs() <= part * expected.abs(), "{value} is not {expected}");
}

#[test]
fn the_waves_of_the_theory() {
    for (tips, speed, omega, casing, blades) in [
        ([0.3, 0.0, 0.0], 420.0, 982.439, 1.6765e-4, 5.7724e-4),
        ([0.3, 0.0, 0.0], 450.0, 1088.520, 2.1659e-4, 8.0872e-4),
        ([0.3, 0.0, 0.0], 500.0, 1261.599, 2.6738e-4, 1.12563e-3),
        ([0.3, 0.15, 0.0], 450.0, 1096.362, 3.2049e-4, 1.49346e-3),
        ([-0.15, 0.3, 0.0], 300.0, 1203.512, 1.3114e-4, 4.7789e-4),
    ] {
        let machine = machine(tips, None);
        let found = waves(&machine, speed);
        let [threshold, lasting] = found[..] else { panic!("{found:?}") };
        assert!(lasting.attracts && lasting.growth_per_s < 0.0 && !threshold.attracts);
        assert_eq!(RoundWhirl::lasting(&found), Some(lasting));
        close(lasting.omega_rad_s, omega, 6e-7);
        close(lasting.casing_per_w * machine.clearance(), casing, 4e-5);
        close(lasting.blades_per_w * machine.clearance(), blades, 2e-5);
        assert_eq!(lasting.s_rad_s < 0.0, tips[0] > 0.0);
    }
}

#[test]
fn nothing_whirls_in_the_paper_and_below_the_fold() {
    for speed in [100.0, 388.3, 500.0, 2000.0] {
        assert_eq!(waves(&machine([0.0; 3], None), speed), vec![]);
    }
    assert_eq!(waves(&machine([0.3, 0.0, 0.0], None), 410.0), vec![]);
    // Between the two senses of the product.
    assert_eq!(waves(&machine([0.15, 0.3, 0.0], None), 300.0), vec![]);
    assert_eq!(waves(&machine([-0.15, 0.3, 0.0], None), 250.0), vec![]);
    let mut scene = Scene::base();
    scene.bladed_disk.radial_coupling = 0.3;
    scene.bladed_disk.nodal_diameters = 4;
    assert_eq!(waves(&scene.machine(), 500.0), vec![]);
    assert_eq!(whirl_onset(&scene.machine(), 1.0), None);
}

#[test]
fn onsets_of_the_theory() {
    for (zeta, expected) in [
        (None, [565.0, 477.2, 430.9, 414.3, 398.6]),
        (Some(0.01), [429.0, 408.5, 398.0, 394.4, 391.1]),
        (Some(0.002), [396.5, 392.4, 390.3, 389.5, 388.9]),
    ] {
        for (kappa, onset) in [0.05, 0.1, 0.2, 0.3, 0.5].into_iter().zip(expected) {
            let found = whirl_onset(&machine([kappa, 0.0, 0.0], zeta), 1.0).unwrap_or(f64::NAN);
            assert!((found - onset).abs() <= 0.0501, "{kappa} {zeta:?}: {found} is not {onset}");
        }
    }
    for (zeta, expected) in [(None, [316.3, 255.9, 230.4]), (Some(0.01), [224.5, 210.7, 205.0])] {
        for (mu, onset) in [0.15, 0.3, 0.5].into_iter().zip(expected) {
            let found = whirl_onset(&machine([-0.5 * mu, mu, 0.0], zeta), 1.0).unwrap_or(f64::NAN);
            assert!((found - onset).abs() <= 0.0501, "{mu} {zeta:?}: {found} is not {onset}");
        }
    }
}

#[test]
fn with_less_damping_the_onset_tends_to_the_coincidence() {
    for (tips, limit) in [([0.3, 0.0, 0.0], 1), ([-0.15, 0.3, 0.0], 0)] {
        let mut parts = Vec::new();
        for exponent in 2..=7 {
            let zeta = 10_f64.powi(-exponent);
            let machine = machine(tips, Some(zeta));
            let coincidence = machine.coincidence_speeds()[limit];
            let above = whirl_onset(&machine, 1.0).unwrap() / coincidence - 1.0;
            assert!(above > 0.0, "{above:e} at {zeta:e}");
            parts.push(above / zeta);
        }
        // In proportion to the damping, in the end.
        close(parts[5], parts[4], 1e-4);
        assert!(parts.iter().all(|part| *part < 20.0), "{parts:?}");
    }
}

#[test]
fn at_the_fold_the_two_waves_are_one() {
    for onset in whirl_onsets(&machine([0.3, 0.0, 0.0], None), 1.0) {
        let machine = machine([0.3, 0.0, 0.0], None);
        let step = if onset.appears { 1e-8 } else { -1e-8 };
        let found = waves(&machine, onset.speed_rad_s * (1.0 + step));
        let [low, high] = found[..] else { panic!("{found:?}") };
        assert!((high.omega_rad_s - low.omega_rad_s).abs() < 1e-2 * high.omega_rad_s);
        close(onset.wave.omega_rad_s, high.omega_rad_s, 1e-2);
        assert!(waves(&machine, onset.speed_rad_s * (1.0 - step)).is_empty());
    }
}

#[test]
fn whirl_on_the_polygon_of_the_theory() {
    for (tips, speed, figures) in [
        (
            [0.3, 0.0, 0.0],
            420.0,
            [
                1.031892446e-3,
                983.227616,
                72.8752784154,
                0.0170549600,
                1.7093178714e-4,
                5.7192438369e-4,
            ],
        ),
        (
            [0.3, 0.0, 0.0],
            450.0,
            [
                1.094461687e-3,
                1089.050407,
                183.1891563687,
                0.0170610436,
                2.1539662278e-4,
                7.9074746905e-4,
            ],
        ),
        (
            [0.3, 0.0, 0.0],
            500.0,
            [
                1.200812268e-3,
                1262.161547,
                440.2755891585,
                0.0180105761,
                2.6548510522e-4,
                1.1055102989e-3,
            ],
        ),
        (
            [0.3, 0.15, 0.0],
            450.0,
            [
                1.127385385e-3,
                1096.671071,
                281.5196985517,
                0.0172582322,
                3.1845570489e-4,
                1.4715828113e-3,
            ],
        ),
        (
            [-0.15, 0.3, 0.0],
            300.0,
            [
                9.440509250e-4,
                1202.525345,
                181.3063714088,
                0.0179329119,
                1.3302970557e-4,
                5.0105839794e-4,
            ],
        ),
    ] {
        let orbit = whirl_over(&machine(tips, None), &[speed]).unwrap()[0].outcome.unwrap();
        close(orbit.passing_time_s, figures[0], 6e-10);
        close(orbit.omega_rad_s, figures[1], 6e-10);
        close(orbit.mean_push_n, figures[2], 1e-10);
        close(orbit.corner_impulse_n_s, figures[3], 4e-9);
        // Extremes between samples, by a parabola.
        close(orbit.casing_m, figures[4], 1e-8);
        close(orbit.blade_rad, figures[5], 1e-8);
        assert!((0.986..0.994).contains(&orbit.multiplier), "{orbit:?}");
    }
}

#[test]
fn the_power_is_shared_as_the_frequencies() {
    let machine = machine([0.3, 0.0, 0.0], None);
    let joint = Joint::at(&machine, 450.0);
    let wave = RoundWhirl::lasting(&round_whirls(&joint)).unwrap();
    let loads = wave.loads(&joint);
    let power = loads.casing_w + loads.blades_w;
    let torque = 3.0 * machine.casing_damping * wave.omega_rad_s * loads.casing_m.powi(2);
    close(torque, 0.026919, 2e-5);
    close(power, 12.1135, 5e-6);
    close(loads.casing_w, 9.7672, 6e-6);
    close(loads.blades_w, 2.3462, 2.5e-5);
    close(torque * 450.0, power, 1e-12);
    close(loads.casing_w, power * wave.omega_rad_s / joint.nu, 1e-12);
    close(loads.blades_w, power * wave.s_rad_s.abs() / joint.nu, 1e-12);
    assert_eq!(loads.friction_w, 0.0);
    // Friction heat is far larger.
    let machine = self::machine([0.3, 0.15, 0.0], None);
    let joint = Joint::at(&machine, 450.0);
    let heat = RoundWhirl::lasting(&round_whirls(&joint)).unwrap().loads(&joint).friction_w;
    assert!((heat - 9.5e3).abs() < 60.0, "{heat}");
}

#[test]
fn where_nothing_whirls_it_is_said_why() {
    let why = |tips, speed| whirl_over(&machine(tips, None), &[speed]).unwrap()[0].outcome.err();
    assert_eq!(why([0.0; 3], 500.0), Some(NoWhirl::NotInclined));
    assert_eq!(why([0.0, 0.3, 0.1], 500.0), Some(NoWhirl::NotInclined));
    assert_eq!(why([0.3, 0.0, 0.0], 405.0), Some(NoWhirl::NoBalance));
    // The fold of the 22 blades is near 412.5, a little below that of the rim.
    assert_eq!(why([0.3, 0.0, 0.0], 412.0), Some(NoWhirl::NoBalance));
    assert_eq!(why([0.3, 0.0, 0.0], 413.0), None);
    let mut four = machine([0.3, 0.0, 0.0], None);
    four.polygon = rubscope_solver::model::ContactPolygon::new(4, 3, 1e-4);
    let outcome = whirl_over(&four, &[500.0]).unwrap()[0].outcome;
    assert_eq!(outcome, Err(NoWhirl::StopsAtCorner));
    let mut flat = Scene::base();
    flat.operation.nodal_diameters = 11;
    assert!(whirl_over(&flat.machine(), &[500.0]).is_err());
}

proptest! {
    /// Scales: a wider clearance, or everything stiffer, changes sizes alone.
    #[test]
    fn whirl_goes_with_the_clearance(speed in 415.0..500.0_f64, part in 0.1..10.0_f64) {
        let mut scene = Scene::base();
        scene.bladed_disk.radial_coupling = 0.3;
        let one = whirl_over(&scene.machine(), &[speed]).unwrap()[0].outcome.unwrap();
        scene.casing.radius_m = scene.bladed_disk.blade_length_m + 1e-4 * part;
        let clearance = scene.machine().clearance() / 1e-4;
        let other = whirl_over(&scene.machine(), &[speed]).unwrap()[0].outcome.unwrap();
        close(other.omega_rad_s, one.omega_rad_s, 1e-11);
        close(other.mean_push_n, one.mean_push_n * clearance, 1e-9);
        close(other.casing_m, one.casing_m * clearance, 1e-9);
    }

    /// The mirror image on the polygon.
    #[test]
    fn a_mirrored_polygon_whirls_as_the_mirror_image(
        kappa in 0.1..0.4_f64, mu in 0.0..0.3_f64, mu_c in 0.0..0.05_f64,
        speed in 380.0..600.0_f64,
    ) {
        let forward = machine([kappa, mu, mu_c], None);
        let backward = machine([-kappa, mu, mu_c], None);
        let one = whirl_over(&forward, &[speed]).unwrap()[0].outcome;
        let other = whirl_over(&backward, &[-speed]).unwrap()[0].outcome;
        prop_assert_eq!(one.err(), other.err());
        if let Some((one, other)) = one.ok().zip(other.ok()) {
            close(-other.omega_rad_s, one.omega_rad_s, 1e-10);
            close(other.mean_push_n, one.mean_push_n, 1e-8);
            close(other.multiplier, one.multiplier, 1e-6);
        }
    }

    /// Roots are complete: as many waves as a dense scan sees, at the same places.
    #[test]
    fn every_wave_of_a_dense_scan_is_found(
        kappa in -0.6..0.6_f64, mu in 0.0..0.6_f64, mu_c in 0.0..0.2_f64,
        zetas in [0.003..0.2_f64, 0.003..0.2_f64], speed in 20.0..1500.0_f64,
    ) {
        let mut machine = machine([kappa, mu, mu_c], None);
        machine.casing_damping_ratio = zetas[0];
        machine.casing_damping = 2.0 * zetas[0] * machine.omega_c * machine.casing_mass;
        machine.blade_damping_ratio = zetas[1];
        machine.blade_modal_damping = 2.0 * zetas[1] * machine.omega_bd * machine.blade_modal_mass;
        let joint = Joint::at(&machine, speed);
        let found = round_whirls(&joint);
        let reach = 8.0 * (machine.omega_c + joint.nu);
        let count = 100_000;
        let mut seen = Vec::new();
        let mut last = joint.compliance(-reach);
        for step in 1..=count {
            let omega = reach * (2.0 * f64::from(step) / f64::from(count) - 1.0);
            let here = joint.compliance(omega);
            if here.im * last.im < 0.0 && here.re < 0.0 && last.re < 0.0 {
                seen.push(omega);
            }
            last = here;
        }
        let width = 2.0 * reach / f64::from(count);
        for omega in &seen {
            let near = |wave: &RoundWhirl| (wave.omega_rad_s - omega).abs() <= width;
            prop_assert!(found.iter().any(near), "{omega}: {found:?}");
        }
        for wave in &found {
            let compliance = joint.compliance(wave.omega_rad_s);
            prop_assert!(compliance.im.abs() <= 1e-11 * compliance.re.abs() && compliance.re < 0.0);
            // Two within one step of the scan are not seen by it.
            let alone = |other: &RoundWhirl| {
                other == wave || (other.omega_rad_s - wave.omega_rad_s).abs() > 2.0 * width
            };
            let inside = wave.omega_rad_s.abs() < reach - width && found.iter().all(alone);
            let near = |omega: &f64| (wave.omega_rad_s - omega).abs() <= 2.0 * width;
            let edge = joint.compliance(wave.omega_rad_s + width).re >= 0.0
                || joint.compliance(wave.omega_rad_s - width).re >= 0.0;
            prop_assert!(!inside || edge || seen.iter().any(near), "{wave:?} not in {seen:?}");
        }
    }

    /// The stiffest of a pair attracts, and never both.
    #[test]
    fn of_two_waves_the_stiffer_attracts(
        kappa in 0.05..0.6_f64, mu in 0.0..0.4_f64, zeta in 0.003..0.1_f64,
        speed in 380.0..700.0_f64,
    ) {
        if let [threshold, lasting] = waves(&machine([kappa, mu, 0.0], Some(zeta)), speed)[..] {
            prop_assert!(lasting.attracts && !threshold.attracts, "{threshold:?} {lasting:?}");
        }
    }

    /// The mirror image of a machine turns the other way: `kappa -> -kappa`.
    #[test]
    fn a_mirrored_rotor_whirls_as_the_mirror_image(
        kappa in -0.6..0.6_f64, mu in 0.0..0.6_f64, mu_c in 0.0..0.2_f64,
        speed in 100.0..900.0_f64,
    ) {
        let forward = waves(&machine([kappa, mu, mu_c], None), speed);
        let backward = waves(&machine([-kappa, mu, mu_c], None), -speed);
        prop_assert_eq!(forward.len(), backward.len());
        for (one, other) in forward.iter().zip(&backward) {
            close(-other.omega_rad_s, one.omega_rad_s, 1e-12);
            close(other.stiffness_n_per_m, one.stiffness_n_per_m, 1e-10);
            close(other.blades_per_w, one.blades_per_w, 1e-10);
            prop_assert_eq!(other.attracts, one.attracts);
        }
    }
}
