//! Whirl of blades and casing in the frequency domain, in the limit of many blades.

use crate::close;
use crate::hbm_joined::scene;
use crate::random::{each_case, within};
use rubscope_solver::harmonic::{RoundWhirl, round_whirls, whirl_spans};
use rubscope_solver::model::{Frame, Machine};
use rubscope_solver::scene::Scene;

/// Table 1 with these tips: `kappa`, `mu`, `mu_c`, and one damping ratio for both
/// structures, if given.
fn machine(tips: [f64; 3], zeta: Option<f64>) -> Machine {
    let mut scene = scene(tips);
    if let Some(zeta) = zeta {
        scene.casing.damping_ratio = zeta;
        scene.bladed_disk.damping_ratio = zeta;
    }
    scene.machine()
}

fn waves(machine: &Machine, speed: f64) -> Vec<RoundWhirl> {
    round_whirls(machine, speed)
}

#[test]
fn at_the_fold_the_two_waves_are_one() {
    for (tips, zeta) in [
        ([0.3, 0.0, 0.0], None),
        ([0.05, 0.0, 0.0], None),
        ([0.5, 0.0, 0.0], Some(0.01)),
        ([-0.075, 0.15, 0.0], None),
        ([-0.25, 0.5, 0.0], Some(0.01)),
    ] {
        let machine = machine(tips, zeta);
        let spans = whirl_spans(&machine, 1.0);
        assert!(!spans.is_empty(), "{tips:?}");
        // A range that ends may do so where the force grows without bound, which is no fold.
        let onset = spans[0].from;
        let found = waves(&machine, onset * (1.0 + 1e-8));
        let [low, high] = found[..] else { panic!("{found:?}") };
        assert!((high.omega_rad_s - low.omega_rad_s).abs() < 1e-2 * high.omega_rad_s.abs());
        assert!(waves(&machine, onset * (1.0 - 1e-8)).is_empty());
    }
}

/// A wider clearance changes sizes alone.
#[test]
fn whirl_goes_with_the_clearance() {
    each_case(256, |rng| {
        let (speed, part) = (within(rng, 420.0..500.0), within(rng, 0.1..10.0));
        let mut scene = Scene::base();
        scene.bladed_disk.radial_coupling = 0.3;
        let lasting = |machine: &Machine| {
            let wave = RoundWhirl::lasting(machine, speed).unwrap();
            (wave, wave.loads(machine, speed))
        };
        let (one, loads) = lasting(&scene.machine());
        scene.casing.radius_m = scene.bladed_disk.blade_length_m + 1e-4 * part;
        let machine = scene.machine();
        let clearance = machine.clearance() / 1e-4;
        let (other, wider) = lasting(&machine);
        close(other.omega_rad_s, one.omega_rad_s, 1e-11);
        close(wider.push_n, loads.push_n * clearance, 1e-9);
        close(wider.casing_m, loads.casing_m * clearance, 1e-9);
    });
}

/// Roots are complete: as many waves as a dense scan sees, at the same places.
#[test]
fn every_wave_of_a_dense_scan_is_found() {
    each_case(256, |rng| {
        let [kappa, mu, mu_c] = [-0.6..0.6, 0.0..0.6, 0.0..0.2].map(|range| within(rng, range));
        let zetas = [(); 2].map(|()| within(rng, 0.003..0.2));
        let speed = within(rng, 20.0..1500.0);
        let mut machine = machine([kappa, mu, mu_c], None);
        machine.casing_damping_ratio = zetas[0];
        machine.casing_damping = 2.0 * zetas[0] * machine.omega_c * machine.casing_mass;
        machine.blade_damping_ratio = zetas[1];
        machine.blade_modal_damping = 2.0 * zetas[1] * machine.omega_bd * machine.blade_modal_mass;
        let frame = Frame::at(&machine, speed);
        let compliance = |omega: f64| frame.turning(omega - frame.casing.turn).compliance();
        let found = round_whirls(&machine, speed);
        let reach = 8.0 * (machine.omega_c + frame.casing.turn);
        let count = 50_000;
        let mut seen = Vec::new();
        let mut last = compliance(-reach);
        for step in 1..=count {
            let omega = reach * (2.0 * f64::from(step) / f64::from(count) - 1.0);
            let here = compliance(omega);
            if here.im * last.im < 0.0 && here.re < 0.0 && last.re < 0.0 {
                seen.push(omega);
            }
            last = here;
        }
        let width = 2.0 * reach / f64::from(count);
        for omega in &seen {
            let near = |wave: &RoundWhirl| (wave.omega_rad_s - omega).abs() <= width;
            assert!(found.iter().any(near), "{omega}: {found:?}");
        }
        for wave in &found {
            let at = compliance(wave.omega_rad_s);
            assert!(at.im.abs() <= 1e-11 * at.re.abs() && at.re < 0.0);
            // Two within one step of the scan are not seen by it.
            let alone = |other: &RoundWhirl| {
                other == wave || (other.omega_rad_s - wave.omega_rad_s).abs() > 2.0 * width
            };
            let inside = wave.omega_rad_s.abs() < reach - width && found.iter().all(alone);
            let near = |omega: &f64| (wave.omega_rad_s - omega).abs() <= 2.0 * width;
            let edge = compliance(wave.omega_rad_s + width).re >= 0.0
                || compliance(wave.omega_rad_s - width).re >= 0.0;
            assert!(!inside || edge || seen.iter().any(near), "{wave:?} not in {seen:?}");
        }
    });
}

/// The stiffest of a pair attracts, and never both.
#[test]
fn of_two_waves_the_stiffer_attracts() {
    each_case(256, |rng| {
        let [kappa, mu, zeta, speed] =
            [0.05..0.6, 0.0..0.4, 0.003..0.1, 380.0..700.0].map(|range| within(rng, range));
        if let [threshold, lasting] = waves(&machine([kappa, mu, 0.0], Some(zeta)), speed)[..] {
            assert!(lasting.attracts && !threshold.attracts, "{threshold:?} {lasting:?}");
        }
    });
}

/// The mirror image of a machine turns the other way: `kappa -> -kappa`.
#[test]
fn a_mirrored_rotor_whirls_as_the_mirror_image() {
    each_case(256, |rng| {
        let [kappa, mu, mu_c] = [-0.6..0.6, 0.0..0.6, 0.0..0.2].map(|range| within(rng, range));
        let speed = within(rng, 100.0..900.0);
        let forward = waves(&machine([kappa, mu, mu_c], None), speed);
        let backward = waves(&machine([-kappa, mu, mu_c], None), -speed);
        assert_eq!(forward.len(), backward.len());
        for (one, other) in forward.iter().zip(&backward) {
            close(-other.omega_rad_s, one.omega_rad_s, 1e-12);
            close(other.stiffness_n_per_m, one.stiffness_n_per_m, 1e-10);
            close(other.blades_per_w, one.blades_per_w, 1e-10);
            assert_eq!(other.attracts, one.attracts);
        }
    });
}
