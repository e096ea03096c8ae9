//! A running motion is fired again, in places that `live_random` does not reach. The
//! program, which skips flights and holds corners in closed form, against the plain stepper,
//! which does neither.

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
