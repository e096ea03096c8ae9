//! Changes of a running motion: another pulse, another speed, other parameters,
//! at any step. The program, which skips flights and holds corners in closed
//! form, against the plain stepper, which does neither.

use crate::keys::{LAW, MODEL, PULSE, SPEED};
use crate::plain::compare::Pair;
use crate::plain::scenes::{LAWS, MODELS, in_corner, scene};
use rubscope_solver::scene::Scene;

/// The same changes in every model under every law.
fn each(changes: &[(&str, &str)], mut run: impl FnMut(Scene)) {
    for model in MODELS {
        for law in LAWS {
            run(scene(&[changes, &[(MODEL, model), (LAW, law)]].concat()));
        }
    }
}

/// A motion of a scene to an instant.
fn moved(scene: &Scene, until: f64) -> Pair {
    let mut pair = Pair::new(scene);
    assert!(pair.advance(until).is_ok());
    pair
}

/// Continues until `end`, with a check every 0.3 ms and at the end.
fn go_on(pair: &mut Pair, what: &str, end: f64) {
    let begin = pair.plain.time();
    let solver = &pair.scene().solver;
    let what = format!("{what}, {:?} {:?}, changed at {begin}", solver.model, solver.contact);
    pair.check(&what);
    let looks = ((end - begin) / 3e-4).ceil().max(1.0);
    for look in 1..=looks as u32 {
        let until = begin + (end - begin) * f64::from(look) / looks;
        if pair.advance(until).is_err() || pair.is_chaotic() {
            return;
        }
        pair.check(&what);
    }
}

/// Steps to the impact with this number, counted from 1.
fn until_impact(pair: &mut Pair, number: usize) {
    while pair.plain.impacts.len() < number {
        assert!(pair.plain.time() < 0.01, "{} impacts only", pair.plain.impacts.len());
        let next = pair.plain.time() + pair.scene().solver.step_s;
        assert!(pair.advance(next).is_ok());
    }
}

#[test]
fn fired_again_in_flight() {
    // On a step, between steps, and when no contact is possible any more.
    for at in [0.0005, 0.001_037_5, 0.012] {
        each(&[], |scene| {
            let mut pair = moved(&scene, at);
            pair.fire();
            let before = pair.plain.impacts.len();
            go_on(&mut pair, "fired in flight", at + 0.002);
            assert!(pair.plain.impacts.len() > before);
        });
    }
}

#[test]
fn fired_again_with_pulses_of_any_length() {
    // Shorter than a step, no multiple of it, and nothing at all.
    for (force, duration) in
        [("3e6", "3e-7"), ("2e4", "5.03e-5"), ("-900", "1.01e-3"), ("1e6", "0")]
    {
        each(&[(PULSE, force), ("operation.pulse_s", duration)], |scene| {
            let mut pair = Pair::new(&scene);
            for at in [0.0021, 0.004] {
                go_on(&mut pair, "fired again", at);
                pair.fire();
            }
            go_on(&mut pair, "fired again", 0.006);
        });
    }
}

#[test]
fn fired_again_in_contact() {
    for impact in [1, 2] {
        each(&[(PULSE, "1e5")], |scene| {
            let mut pair = Pair::new(&scene);
            until_impact(&mut pair, impact);
            pair.fire();
            let end = pair.plain.time() + 0.001;
            go_on(&mut pair, "fired in contact", end);
        });
    }
}

#[test]
fn fired_again_while_locked() {
    // Weak and strong, with the lock and against it.
    for force in ["300", "4e4", "-1e5"] {
        for speed in ["500", "-430"] {
            each(&[(SPEED, speed)], |scene| {
                let mut scene = in_corner(scene);
                // The pulse waits for its first fire.
                let mut pair = moved(&scene, 0.001);
                assert_eq!(scene.set(PULSE, force), Ok(()));
                pair.adopt(&scene);
                assert!(pair.advance(0.0015).is_ok());
                pair.check("locked");
                pair.fire();
                go_on(&mut pair, "fired while locked", 0.0025);
                pair.fire();
                go_on(&mut pair, "fired once more", 0.0035);
            });
        }
    }
}

#[test]
fn fired_again_before_the_first_step_and_during_the_pulse() {
    for at in [0.0, 1e-5, 2.5e-5, 4.95e-5] {
        each(&[], |scene| {
            let mut pair = moved(&scene, at);
            pair.fire();
            go_on(&mut pair, &format!("fired at {at}"), 0.002);
            // Another pulse, too.
            let mut stronger = scene.clone();
            stronger.operation.pulse_n *= 2.0;
            let mut pair = moved(&scene, at);
            pair.adopt(&stronger);
            pair.fire();
            go_on(&mut pair, &format!("another fired at {at}"), 0.001);
        });
    }
}

#[test]
fn speed_changes_in_flight() {
    for (speed, ramp) in
        [(650.0, 0.0), (310.0, 0.0), (0.0, 0.0), (-480.0, 0.0), (500.0, -2e5), (3.0, -900.0)]
    {
        for at in [0.0005, 0.001_000_4] {
            each(&[(PULSE, "5e4")], |scene| {
                let mut pair = moved(&scene, at);
                pair.set_speed(speed, ramp);
                go_on(&mut pair, "speed in flight", 0.004);
            });
        }
    }
}

#[test]
fn speed_changes_in_contact() {
    for (speed, ramp) in [(650.0, 0.0), (0.0, 0.0), (-480.0, 0.0), (500.0, -2e5)] {
        each(&[(PULSE, "3e4")], |scene| {
            let mut pair = Pair::new(&scene);
            until_impact(&mut pair, 1);
            pair.set_speed(speed, ramp);
            let end = pair.plain.time() + 0.002;
            go_on(&mut pair, "speed in contact", end);
        });
    }
}

#[test]
fn speed_changes_while_locked() {
    // Kept, kept by pulling only, broken, reversed, and ramped until it breaks.
    for (speed, ramp) in [
        (520.0, 0.0),
        (499.999, 0.0),
        (350.0, 0.0),
        (200.0, 0.0),
        (-450.0, 0.0),
        (500.0, -4e4),
        (500.0, 1e4),
    ] {
        each(&[], |scene| {
            let mut pair = moved(&in_corner(scene), 0.001);
            pair.set_speed(speed, ramp);
            go_on(&mut pair, "speed while locked", 0.0025);
            // After the end of a ramp the lock is held again.
            pair.set_speed(460.0, 0.0);
            go_on(&mut pair, "speed set again", 0.0035);
        });
    }
}

#[test]
fn multipliers_right_after_a_change_of_a_held_lock() {
    // Soft blades still settle when the lock is held: N' = 4 has long moment arms.
    let machine = [("bladed_disk.blades", "12"), (MODEL, "modal"), (LAW, "bilateral")];
    let changes: [fn(&mut Pair); 2] = [Pair::fire, |pair| pair.set_speed(500.0, 0.0)];
    for change in changes {
        let mut pair = moved(&in_corner(scene(&machine)), 0.004);
        change(&mut pair);
        pair.check_multipliers_now("held");
    }
    // A pulse that presses a lock: the step before it is held still has some
    // of it.
    let mut pressed = in_corner(scene(&[(MODEL, "rigid"), (LAW, "bilateral")]));
    let mut pair = Pair::new(&pressed);
    (pressed.operation.pulse_n, pressed.operation.pulse_s) = (-100.0, 8.09e-5);
    pair.adopt(&pressed);
    assert!(pair.advance(0.001).is_ok());
    pair.fire();
    assert!(pair.advance(0.002).is_ok());
    pair.set_speed(500.0, 0.0);
    pair.check_multipliers_now("pressed");
}

#[test]
fn mean_forces_of_a_held_lock() {
    // Blades swing once in some 20 ms, and the push on a side with them.
    let machine = [("bladed_disk.blades", "12"), (MODEL, "modal"), (LAW, "bilateral")];
    let mut pair = Pair::new(&in_corner(scene(&machine)));
    for look in 1..=5 {
        // Each advance compares the mean forces since the one before.
        assert!(pair.advance(0.004 * f64::from(look)).is_ok());
    }
}

/// What a running motion takes over, each turned on its own.
const TURNS: &[&[(&str, &str)]] = &[
    &[("casing.damping_ratio", "0.3")],
    &[("casing.damping_ratio", "0")],
    &[("casing.modal_mass_kg", "2.7")],
    &[("casing.modal_mass_kg", "0.9")],
    &[("casing.modal_stiffness_n_per_m", "2.4e6")],
    &[("casing.modal_stiffness_n_per_m", "9e5")],
    &[("bladed_disk.damping_ratio", "0.5")],
    &[("bladed_disk.damping_ratio", "0")],
    &[("bladed_disk.inertia_kg_m2", "0.02")],
    &[("bladed_disk.stiffness_nm_per_rad", "90000")],
    &[("bladed_disk.coupling_nm_per_rad", "0")],
    &[("bladed_disk.coupling_nm_per_rad", "40000")],
    &[("solver.contact", "bilateral")],
    &[("solver.contact", "unilateral")],
    &[("operation.pulse_n", "-7e4"), ("operation.pulse_s", "2e-5")],
    &[("operation.speed_rad_s", "100")],
    &[("excitation.amplitude_nm", "3")],
    &[("excitation.amplitude_nm", "3"), ("excitation.order", "8")],
];

fn turned(scene: &Scene, turn: &[(&str, &str)]) -> Option<Scene> {
    Some(scene.clone().with(turn).ok()?.into_scene())
}

#[test]
fn parameters_turned_in_flight_in_contact_and_locked() {
    for turn in TURNS {
        each(&[(PULSE, "3e4")], |scene| {
            // Only the two modes can be driven.
            let Some(other) = turned(&scene, turn) else { return };
            let mut flying = moved(&scene, 0.0006);
            flying.adopt(&other);
            go_on(&mut flying, &format!("{turn:?} in flight"), 0.0011);
            flying.fire();
            go_on(&mut flying, &format!("{turn:?}, fired"), 0.0017);
            let mut active_set = Pair::new(&scene);
            until_impact(&mut active_set, 1);
            active_set.adopt(&other);
            let end = active_set.plain.time() + 0.0005;
            go_on(&mut active_set, &format!("{turn:?} in contact"), end);
            let mut locked = moved(&in_corner(scene), 0.0006);
            let other = turned(locked.scene(), turn);
            locked.adopt(&other.unwrap());
            go_on(&mut locked, &format!("{turn:?} while locked"), 0.0016);
        });
    }
}

#[test]
fn parameters_turned_during_the_pulse() {
    for turn in TURNS {
        each(&[], |scene| {
            let Some(other) = turned(&scene, turn) else { return };
            let mut pair = moved(&scene, 3e-5);
            pair.adopt(&other);
            go_on(&mut pair, &format!("{turn:?} during the pulse"), 0.001);
        });
    }
}
