//! A machine that changes with the speed: blades that stiffen, `omega_bd^2 + B Omega^2`, and
//! that grow, `g0 - c Omega^2`. Closed forms against numbers that were made apart, and every
//! view of the frequency domain against the machine at one speed that stays the same (`frozen`).
//! A new view is compared so, too.

use crate::keys::{KAPPA, LOSS, SPEED, STIFFENING};
use crate::lock_ends::times;
use crate::tips_support::scene;
use rubscope_solver::harmonic::{
    Campbell, Form, Lining, coincidence, equilibria, flutters, joined_grow, lock_loads,
    locked_motion, slip_over, undamped_flutter_speed, whirl_spans,
};
use rubscope_solver::model::Machine;
use rubscope_solver::scene::Scene;
use rubscope_solver::study::margins::{LimitName, Margins};

const STIFFNESS: &str = "bladed_disk.stiffness_nm_per_rad";

fn changed(mut scene: Scene, changes: &[(&str, f64)]) -> Scene {
    changes.iter().for_each(|(path, value)| scene.set(path, &format!("{value:e}")).unwrap());
    scene
}

fn machine(changes: &[(&str, f64)]) -> Machine {
    scene(changes).machine()
}

pub fn close(value: f64, expected: f64, part: f64) {
    assert!((value - expected).abs() <= part * expected.abs(), "{value} is not {expected}");
}

/// The scene that stays the same and is at one speed what another is there.
pub fn frozen(of: &Scene, speed: f64) -> Scene {
    let mut still = of.clone();
    let stiffening = std::mem::take(&mut still.bladed_disk.centrifugal_stiffening);
    let loss = std::mem::take(&mut still.casing.clearance_loss_m_s2);
    let (before, disk) = (still.machine(), &mut still.bladed_disk);
    disk.stiffness_nm_per_rad += stiffening * disk.inertia_kg_m2 * speed * speed;
    let ratio = disk.damping_ratio;
    still.casing.radius_m -= loss * speed * speed;
    // The damping coefficient stays.
    still.bladed_disk.damping_ratio = ratio * before.omega_bd / still.machine().omega_bd;
    still.operation.speed_rad_s = speed;
    still
}

#[test]
fn coincidences_are_the_roots_of_their_quadratic() {
    for (stiffening, sum, difference) in [
        (0.0, Some(388.314_743_165), 197.442_127_141),
        (1.5, Some(528.982_636_319), 173.925_608_048),
        (10.0, None, 127.792_185_806),
    ] {
        for speed in [0.0, 500.0, -300.0] {
            let machine = machine(&[(STIFFENING, stiffening), (SPEED, speed)]);
            assert_eq!(machine.dangerous_speed().is_some(), sum.is_some(), "{stiffening}");
            if let (Some(found), Some(sum)) = (machine.dangerous_speed(), sum) {
                close(found, sum, 1e-11);
            }
            let differences = machine.coincidence_differences();
            close(differences[0], difference, 1e-11);
            // Each is where frequencies meet, in the machine of that speed.
            for found in machine.coincidence_speeds() {
                let (turn, here) = (machine.nu(found), machine.at(found));
                let casing = [here.omega_c, -here.omega_c];
                let apart = casing.map(|casing| ((turn - casing).abs() - here.omega_bd).abs());
                let least = apart[0].min(apart[1]);
                assert!(least < 1e-12 * turn, "{stiffening} {found}: {least}");
            }
        }
    }
    // Beyond n_d^2 blades overtake the casing at last: a second difference.
    assert_eq!(machine(&[(STIFFENING, 10.0)]).coincidence_differences().len(), 2);
    assert_eq!(machine(&[(STIFFENING, 8.9)]).coincidence_differences().len(), 1);
    // Blades that are faster at rest and stay so meet it nowhere.
    let fast = machine(&[(STIFFNESS, 1e6), (STIFFENING, 100.0)]);
    assert!(fast.coincidence_speeds().is_empty());
}

#[test]
fn campbell_lines_bend_and_cross_at_the_coincidences() {
    for stiffening in [0.0, 0.5, 3.0, 10.0] {
        let machine = machine(&[(STIFFENING, stiffening)]);
        let campbell = Campbell::of(&machine, &[1], 500.0).unwrap();
        for speed in [0.0, 300.0, -700.0] {
            let own = machine.at(speed).omega_bd;
            close(campbell.lines[2].at(speed) - machine.nu(speed), own, 1e-12);
            close(campbell.lines[3].at(speed) - machine.nu(speed), -own, 1e-12);
        }
        let differences = machine.coincidence_differences().len();
        let sums = usize::from(machine.dangerous_speed().is_some());
        assert_eq!(campbell.coincidences.len(), 2 * (differences + sums), "{stiffening}");
        for found in &campbell.coincidences {
            let casing = if found.casing_rad_s > 0.0 { 0 } else { 1 };
            let blades = if found.blades_rad_s > 0.0 { 2 } else { 3 };
            let [casing, blades] =
                [casing, blades].map(|line| campbell.lines[line].at(found.speed_rad_s));
            assert!((casing - blades).abs() < 1e-11 * machine.nu(found.speed_rad_s).abs());
        }
    }
}

#[test]
fn limits_of_radial_tips_do_not_notice_stiffer_blades() {
    let (still, stiff) = (machine(&[]), machine(&[(STIFFENING, 2.0)]));
    assert_eq!(stiff.critical_speed(), still.critical_speed());
    assert_eq!(stiff.adhesive_speed(), still.adhesive_speed());
    assert_eq!(stiff.lock_windows(1.0), still.lock_windows(1.0));
}

#[test]
fn a_lost_clearance_ends_every_lock() {
    let closing = machine(&[(LOSS, 4e-10)]);
    close(closing.closing_speed().unwrap(), 500.0, 1e-12);
    let windows = closing.lock_windows(1.0);
    close(windows[0].from, 411.93, 1e-4);
    assert_eq!((windows.len(), windows[0].to), (1, closing.closing_speed()));
    // Lost before any lock, and before the adhesive limit.
    let early = machine(&[(LOSS, 2e-9), (SPEED, 100.0)]);
    assert!(early.lock_windows(1.0).is_empty() && early.adhesive_speed().is_none());
}

#[test]
fn lock_windows_of_stiffer_inclined_tips_end_where_a_push_of_that_machine_vanishes() {
    for stiffening in [0.1, 2.0] {
        for kappa in [0.2, 0.35] {
            let of = scene(&[(KAPPA, kappa), (STIFFENING, stiffening)]);
            let windows = of.machine().lock_windows(1.0);
            assert!(!windows.is_empty(), "{stiffening} {kappa}");
            for end in windows.iter().flat_map(|window| [Some(window.from), window.to]).flatten() {
                let here = frozen(&of, end).machine().locked_multipliers(end).unwrap();
                let [a, b] = here.map(f64::abs);
                assert!(a.min(b) < 1e-9 * (a + b), "{stiffening} {kappa} {end}: {here:?}");
            }
        }
    }
    // Where none was, stiffening makes one: its blades give less.
    assert!(machine(&[(KAPPA, 0.35)]).lock_windows(1.0).is_empty());
}

#[test]
fn flutter_of_an_undamped_lock() {
    let flutter = |stiffening: f64| {
        let machine = machine(&[(KAPPA, 0.5), (STIFFENING, stiffening)]);
        undamped_flutter_speed(&machine, 1.0)
    };
    close(flutter(0.0).unwrap(), 516.281_200_164, 1e-12);
    close(flutter(0.1).unwrap(), 582.639_950_863, 1e-12);
    // From B = n_d^2 c2/(m_a T) on, T = 1/m_c + c2/m_a.
    let (c2, mass) = (0.25 * 0.4999 * 0.4999, 11.0 * 0.20825);
    let last = 9.0 * c2 / (mass * (0.5 + c2 / mass));
    assert!(flutter(last * 0.9999).is_some() && flutter(last * 1.0001).is_none());
}

#[test]
fn damped_flutter_begins_and_ends_where_growth_of_that_machine_does() {
    let mut ended = 0;
    for (stiffening, friction) in [(0.05, 0.0), (0.2, 0.0), (0.35, 0.0), (0.2, 0.1)] {
        let changes = [
            (KAPPA, 0.5),
            (STIFFENING, stiffening),
            ("contact.friction", friction),
            ("casing.tangential_ratio", 0.3),
        ];
        let of = scene(&changes);
        let found = flutters(&of.machine(), 1.0);
        for range in &found {
            let grows = |speed: f64| joined_grow(&frozen(&of, speed).machine(), speed);
            assert!(!grows(range.from * (1.0 - 1e-8)) && grows(range.from * (1.0 + 1e-8)));
            if let Some(to) = range.to {
                assert!(grows(to * (1.0 - 1e-8)) && !grows(to * (1.0 + 1e-8)));
                ended += 1;
            }
        }
        assert!(!found.is_empty(), "{stiffening} {friction}");
    }
    assert!(ended < 9);
    assert!(flutters(&machine(&[(KAPPA, 0.5), (STIFFENING, 2.0)]), 1.0).is_empty());
}

#[test]
fn rest_on_a_lining_grows_between_other_speeds() {
    for (stiffening, ends) in [
        (0.0, vec![399.464_051_53, 437.887_541_647]),
        (0.5, vec![453.445_007_988, 481.666_401_907]),
        (1.5, vec![]),
    ] {
        let scene = changed(Scene::builtin("coincidence").unwrap(), &[(STIFFENING, stiffening)]);
        let machine = scene.machine();
        let lining = Lining::of(&machine, &scene.contact).unwrap();
        let found = lining.hopf_points([1.0, 900.0]).unwrap();
        assert_eq!(found.len(), ends.len(), "{stiffening}: {found:?}");
        for (point, end) in found.iter().zip(ends) {
            close(point.speed_rad_s, end, 1e-11);
        }
        if stiffening == 0.5 {
            close(lining.rest(468.0).worst().growth_1_s, 3.392_09, 2e-6);
        }
    }
}

#[test]
fn rest_grows_from_where_a_closing_gap_presses_the_lining() {
    let changes = [("casing.radius_m", 0.49995), (LOSS, 3e-10)];
    let scene = changed(Scene::builtin("coincidence").unwrap(), &changes);
    let machine = scene.machine();
    let closed = machine.closing_speed().unwrap();
    close(closed, (5e-5_f64 / 3e-10).sqrt(), 1e-12);
    let lining = Lining::of(&machine, &scene.contact).unwrap();
    assert_eq!(lining.at(0.999 * closed).stiffness_at_rest(), 0.0);
    assert!(lining.at(1.01 * closed).stiffness_at_rest() > 0.0);
    let found = lining.hopf_points([300.0, 600.0]).unwrap();
    // It grows as soon as enough is pressed, and until the speed that the clearance has no
    // part in.
    assert!((found[0].speed_rad_s / closed - 1.0).abs() < 0.02 && found[0].grows_above);
    close(found[1].speed_rad_s, 437.887_541_647, 1e-9);
}

#[test]
fn all_lengths_of_a_lock_scale_with_the_clearance() {
    let (still, grown) = (machine(&[]), machine(&[(LOSS, 1e-10)]));
    let [a, b] = grown.locked_multipliers(500.0).unwrap();
    close(-a, 0.75 * 244.415_923, 1e-8);
    close(-b, 0.75 * 57.294_779, 1e-8);
    let [one, other] = [&still, &grown].map(|machine| lock_loads(machine, 500.0).unwrap());
    close(other.amplitude_m, 0.75 * one.amplitude_m, 1e-6);
    for (push, of) in other.pushes_n.iter().zip(one.pushes_n) {
        close(*push, 0.75 * of, 1e-6);
    }
    let touching = |changes: &[(&str, f64)]| {
        let margins = Margins::of(&scene(changes).checked().unwrap());
        margins.limit(LimitName::TouchingPulse).unwrap().value.unwrap()
    };
    close(touching(&[]), 3795.0247, 1e-8);
    close(touching(&[(LOSS, 1e-10)]), 0.75 * 3795.0247, 1e-8);
}

#[test]
fn a_sweep_asks_the_machine_of_each_speed() {
    let speeds = [420.0, 455.0, 480.0];
    for kappa in [0.0, 0.25] {
        let mut of = scene(&[(KAPPA, kappa), (STIFFENING, 1.2), (LOSS, 1e-10)]);
        if kappa == 0.0 {
            of.casing.damping_ratio = 0.01;
        }
        let machine = of.machine();
        let lock = locked_motion(&machine, Form::Modal, true, None, &speeds).unwrap();
        let waves = coincidence(&of, &speeds).unwrap();
        for (place, &speed) in speeds.iter().enumerate() {
            let still = frozen(&of, speed).machine();
            let expected = locked_motion(&still, Form::Modal, true, None, &[speed]).unwrap();
            let (found, expected) = (lock.points[place], expected.points[0]);
            for (a, b) in found.multipliers_n.iter().zip(expected.multipliers_n) {
                close(*a, b, 1e-9);
            }
            close(found.amplitude_m, expected.amplitude_m, 1e-10);
            let expected = coincidence(&frozen(&of, speed), &[speed]).unwrap()[0];
            match (waves[place].blade_amplitude_rad, expected.blade_amplitude_rad) {
                (Some(a), Some(b)) => close(a, b, 1e-8),
                (a, b) => assert_eq!(a, b),
            }
            if kappa == 0.0 {
                let slip = |machine: &Machine| slip_over(machine, &[speed]).unwrap()[0].outcome;
                match (slip(&machine), slip(&still)) {
                    (Ok(a), Ok(b)) => close(a.torque_nm, b.torque_nm, 1e-9),
                    (a, b) => assert_eq!(a, b),
                }
                let states = |machine: &Machine| equilibria(machine, speed, true).unwrap();
                for (a, b) in states(&machine).iter().zip(states(&still)) {
                    assert_eq!((a.kind, a.character), (b.kind, b.character));
                    close(a.growth_per_s, b.growth_per_s, 1e-9);
                }
            }
        }
    }
}

#[test]
fn where_blades_have_grown_into_the_casing_nothing_is_locked() {
    let machine = machine(&[(LOSS, 5e-10), (SPEED, 300.0)]);
    let sweep = locked_motion(&machine, Form::Modal, true, None, &[430.0, 460.0]).unwrap();
    assert_eq!((sweep.points.len(), sweep.missing), (1, vec![460.0]));
    assert!(lock_loads(&machine, 460.0).is_none());
    assert!(slip_over(&machine, &[460.0]).unwrap()[0].outcome.is_err());
    assert!(equilibria(&machine, 460.0, true).unwrap().is_empty());
}

#[test]
fn whirl_begins_where_it_does_in_the_machine_of_that_speed() {
    for stiffening in [0.3, 1.0] {
        let of = scene(&[(KAPPA, 0.3), (STIFFENING, stiffening)]);
        let onset = whirl_spans(&of.machine(), 1.0)[0].from;
        let has = |speed: f64| {
            coincidence(&frozen(&of, speed), &[speed]).unwrap()[0].blade_amplitude_rad.is_some()
        };
        assert!(!has(onset * (1.0 - 1e-6)) && has(onset * (1.0 + 1e-6)), "{stiffening} {onset}");
    }
}

#[test]
fn limits_change_with_every_parameter_as_their_derivatives_say() {
    let of = scene(&[
        (KAPPA, 0.28),
        (STIFFENING, 0.05),
        (LOSS, 5e-11),
        (SPEED, 520.0),
        ("casing.damping_ratio", 0.02),
        ("bladed_disk.damping_ratio", 0.02),
        ("contact.friction", 0.05),
        ("casing.tangential_ratio", 0.3),
    ]);
    // What a limit of a machine that has all of them is made of.
    let values = |of: &Scene| {
        let machine = of.machine();
        let loads = lock_loads(&machine, 520.0).unwrap();
        [
            (LimitName::Coincidence, machine.dangerous_speed()),
            (LimitName::OmegaLock, machine.lock_windows(1.0).first().map(|window| window.from)),
            (LimitName::FlutterSpeed, flutters(&machine, 1.0).first().map(|range| range.from)),
            (LimitName::WhirlOnset, whirl_spans(&machine, 1.0).first().map(|span| span.from)),
            (LimitName::PushA, Some(loads.pushes_n[0].max(loads.pushes_n[1]))),
            (LimitName::Power, Some(loads.power_w)),
        ]
        .map(|(name, value)| (name, value.unwrap()))
    };
    let here = Margins::of(&of.checked().unwrap());
    for (path, part) in [
        (STIFFENING, 1e-5),
        (LOSS, 1e-5),
        (KAPPA, 1e-6),
        (STIFFNESS, 1e-6),
        ("casing.damping_ratio", 1e-5),
        ("bladed_disk.damping_ratio", 1e-5),
        ("casing.modal_stiffness_n_per_m", 1e-6),
        ("casing.modal_mass_kg", 1e-6),
        ("bladed_disk.inertia_kg_m2", 1e-6),
        ("contact.friction", 1e-5),
    ] {
        let [more, less] = [1.0 + part, 1.0 - part].map(|part| values(&times(&of, path, part)));
        for (place, (name, value)) in values(&of).into_iter().enumerate() {
            let limit = here.limit(name).unwrap();
            close(limit.value.unwrap(), value, 1e-9);
            let Some(exact) = limit.sensitivities.by(path) else { continue };
            let slope = (more[place].1 - less[place].1) / (2.0 * part * value);
            // A fold is known to half the digits only.
            let known = if name == LimitName::WhirlOnset { 1e-3 } else { 1e-5 };
            let apart = (slope - exact).abs();
            assert!(apart < known * (1.0 + exact.abs()), "{name} {path}: {slope} {exact}");
        }
    }
    // The limits that only such a machine has feel what makes it change.
    let by = |name, path| here.limit(name).unwrap().sensitivities.by(path).unwrap();
    assert!(by(LimitName::Coincidence, STIFFENING) > 0.01);
    assert!(by(LimitName::FlutterSpeed, STIFFENING) > 0.01);
    assert!(by(LimitName::PushA, LOSS) < -0.1);
    assert!(by(LimitName::OmegaC, STIFFENING) == 0.0);
}
