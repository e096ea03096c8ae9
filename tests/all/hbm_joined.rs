//! The lock of tips that are inclined or rub, in the frequency domain: the flutter speeds of
//! docs/theory.md, section 10, and laws.

use crate::close;
use crate::random::{each_case, one_of, within};
use rubscope_solver::harmonic::{
    Form, flutters, lock_loads, locked_motion, undamped_flutter_speed,
};
use rubscope_solver::model::{Frame, Machine};
use rubscope_solver::scene::Scene;

/// Table 1 with these tips: `kappa`, `mu`, `mu_c`.
pub fn scene([kappa, mu, mu_c]: [f64; 3]) -> Scene {
    let mut scene = Scene::base();
    scene.bladed_disk.radial_coupling = kappa;
    scene.contact.friction = mu;
    scene.casing.tangential_ratio = if mu == 0.0 { 0.0 } else { mu_c / mu };
    scene
}

fn machine(tips: [f64; 3]) -> Machine {
    scene(tips).machine()
}

/// Returns the speed from which blades and casing as one grow.
fn flutter_speed(machine: &Machine, toward: f64) -> Option<f64> {
    flutters(machine, toward).first().map(|range| range.from)
}

#[test]
fn flutter_of_the_theory() {
    let found = undamped_flutter_speed(&machine([1.0, 0.0, 0.0]), 1.0).unwrap();
    assert!((found - 394.1).abs() < 0.0501, "{found}");
    // The least of all is the dangerous coincidence.
    let least = machine([1.222, 0.0, 0.0]);
    close(undamped_flutter_speed(&least, 1.0).unwrap(), least.dangerous_speed().unwrap(), 1e-6);
    // With damping, however small: Ziegler's paradox.
    for zeta in [1e-2, 1e-4, 1e-6] {
        let mut scene = scene([1.0, 0.0, 0.0]);
        scene.casing.damping_ratio = zeta;
        scene.bladed_disk.damping_ratio = zeta;
        let found = flutter_speed(&scene.machine(), 1.0).unwrap();
        assert!((found - 341.1).abs() < 0.0501, "{found}");
    }
    let found = flutter_speed(&machine([0.5, 0.0, 0.0]), 1.0).unwrap();
    assert!((found - 452.80).abs() < 5.01e-3, "{found}");
    assert_eq!(flutter_speed(&machine([0.0, 0.3, 0.1]), 1.0), None);
}

#[test]
fn at_the_flutter_speed_a_whirl_has_no_bound() {
    for tips in [[0.5, 0.0, 0.0], [0.3, 0.15, 0.0], [0.3, 0.15, 0.05]] {
        let machine = machine(tips);
        let limit = flutter_speed(&machine, 1.0).unwrap();
        let grows = |machine: &Machine, speed: f64| {
            let roots = Frame::at(machine, speed).joined();
            roots.iter().any(|root| root.re > 0.0)
        };
        assert!(!grows(&machine, limit * (1.0 - 1e-9)) && grows(&machine, limit * (1.0 + 1e-9)));
        let frame = Frame::at(&machine, limit);
        let root = frame.joined().into_iter().max_by(|a, b| a.re.total_cmp(&b.re)).unwrap();
        // There the compliance vanishes: a whirl there has no bound.
        let away = frame.turning(root.im).compliance().norm();
        assert!(away < 1e-9 * frame.compliance().norm(), "{away:e}");
    }
}

/// Both push inside the windows and nowhere else.
#[test]
fn windows_end_where_a_push_changes_its_sign() {
    each_case(1000, |rng| {
        let [kappa, mu, tau, zeta] =
            [-0.6..0.6, 0.0..0.6, 0.0..0.4, 0.0..0.2].map(|range| within(rng, range));
        let parts = [(); 8].map(|()| within(rng, 0.0..1.0));
        let mut scene = scene([kappa, mu, mu * tau]);
        scene.casing.damping_ratio = zeta;
        let machine = scene.machine();
        let sense = one_of(rng, &[1.0, -1.0]);
        let windows = machine.lock_windows(sense);
        let push = |speed: f64| {
            machine.locked_multipliers(sense * speed).unwrap().iter().all(|&lambda| lambda < 0.0)
        };
        for window in &windows {
            if window.from > 0.0 {
                assert!(push(window.from * (1.0 + 1e-9)), "{window:?}");
                assert!(!push(window.from * (1.0 - 1e-9)), "{window:?}");
            }
            if let Some(to) = window.to {
                assert!(push(to * (1.0 - 1e-9)), "{window:?}");
                assert!(!push(to * (1.0 + 1e-9)), "{window:?}");
            }
        }
        for part in parts {
            let speed = 50.0 * (400.0_f64).powf(part);
            let inside = windows
                .iter()
                .any(|window| speed > window.from && window.to.is_none_or(|to| speed < to));
            assert_eq!(push(speed), inside, "{} {:?}", speed, windows);
        }
    });
}

/// The exact pair of nearly still blades is the closed form, and its motion that of
/// blades and casing as one.
#[test]
fn the_exact_pair_of_a_small_clearance_is_the_closed_form() {
    each_case(1000, |rng| {
        let [kappa, mu, mu_c] = [0.05..0.4, 0.0..0.3, 0.0..0.1].map(|range| within(rng, range));
        let (speed, backward) = (within(rng, 350.0..900.0), rng.bool());
        let mut scene = scene([kappa, mu, mu_c]);
        scene.casing.radius_m = scene.bladed_disk.blade_length_m + 1e-9;
        let machine = scene.machine();
        let speed = if backward { -speed } else { speed };
        let closed = machine.locked_multipliers(speed).unwrap();
        let size = closed[0].abs().max(closed[1].abs());
        let sweep = locked_motion(&machine, Form::Modal, true, None, &[speed]).unwrap();
        if let Some(point) = sweep.points.first() {
            for (exact, closed) in point.multipliers_n.iter().zip(closed) {
                assert!((exact - closed).abs() <= 1e-2 * size, "{exact} {closed}");
            }
            let grows = Frame::at(&machine, speed).joined().iter().any(|root| root.re > 1e-2);
            let pushes = point.multipliers_n.iter().all(|&lambda| lambda <= 0.0);
            assert!(!pushes || point.stable != grows, "{point:?}");
        }
    });
}

/// The mirror image of a machine turns the other way.
#[test]
fn a_mirrored_rotor_locks_as_the_mirror_image() {
    each_case(1000, |rng| {
        let [kappa, mu, mu_c] = [-0.4..0.4, 0.0..0.4, 0.0..0.1].map(|range| within(rng, range));
        let speed = within(rng, 300.0..900.0);
        let (forward, backward) = (machine([kappa, mu, mu_c]), machine([-kappa, mu, mu_c]));
        assert_eq!(forward.lock_windows(1.0), backward.lock_windows(-1.0));
        assert_eq!(flutter_speed(&forward, 1.0), flutter_speed(&backward, -1.0));
        let one = lock_loads(&forward, speed);
        let other = lock_loads(&backward, -speed);
        assert_eq!(one.is_some(), other.is_some());
        if let Some((one, other)) = one.zip(other) {
            let size = one.pushes_n[0].abs().max(one.pushes_n[1].abs());
            for i in [0, 1] {
                assert!((one.pushes_n[i] - other.pushes_n[1 - i]).abs() <= 1e-9 * size);
            }
            close(other.amplitude_m, one.amplitude_m, 1e-9);
        }
    });
}
