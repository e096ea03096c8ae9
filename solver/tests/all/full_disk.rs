//! The full model with several blades on each side of the polygon, alike and
//! slightly different, under both laws: against the plain stepper, against each
//! blade solved on its own, and against the modal model.

use crate::plain::compare::Pair;
use crate::plain::scenes::{LAWS, scene};
use rubscope_solver::motion::Motion;
use rubscope_solver::scene::Scene;

/// Blades, diameters and the blades of a side.
const RINGS: [(&str, &str, usize); 4] =
    [("66", "3", 3), ("88", "4", 4), ("40", "8", 8), ("150", "50", 50)];

fn ring(blades: &str, diameters: &str, law: &str, changes: &[(&str, &str)]) -> Scene {
    let speed = if diameters == "50" { "30" } else { "300" };
    let base = [
        ("bladed_disk.blades", blades),
        ("operation.nodal_diameters", diameters),
        ("operation.speed_rad_s", speed),
        ("solver.contact", law),
        ("solver.model", "full"),
    ];
    scene(&[&base, changes].concat())
}

/// An excitation that tells the blades of a side apart, by so much.
fn apart(amplitude: &'static str) -> [(&'static str, &'static str); 2] {
    [("excitation.amplitude_nm", amplitude), ("excitation.order", "1")]
}

fn compare(what: &str, scene: &Scene, end: f64) -> Pair {
    let mut pair = Pair::new(scene);
    for look in 1..=4 {
        if pair.advance(end * f64::from(look) / 4.0).is_err() {
            break;
        }
        pair.check(what);
    }
    pair
}

#[test]
fn blades_of_a_side_move_as_the_plain_stepper_says() {
    for (blades, diameters, _) in RINGS {
        for law in LAWS {
            for changes in [&[][..], &apart("1e-9"), &apart("1e-3"), &apart("1")] {
                let many = diameters == "50";
                if many && changes.first().is_none_or(|change| change.1 != "1e-3") {
                    // The next tests have these; the stepper takes seconds for each.
                    continue;
                }
                let scene = ring(blades, diameters, law, changes);
                let what = format!("{blades} {diameters} {law} {changes:?}");
                let pair = compare(&what, &scene, if many { 3e-4 } else { 3e-3 });
                assert!(pair.plain.failure().is_none(), "{what}: {:?}", pair.plain.failure());
                assert!(!pair.plain.impacts.is_empty(), "{what}");
                assert!(!pair.is_chaotic(), "{what}: amplified {:e}", pair.amplified);
            }
        }
    }
}

#[test]
fn blades_that_are_alike_push_as_one_however_they_are_solved() {
    for (blades, diameters, each) in RINGS {
        for law in LAWS {
            // A torque of no size leaves them alike, but each with its own row.
            let [one, own] = [&[][..], &apart("1e-300")].map(|changes| {
                let mut motion =
                    Motion::new(&ring(blades, diameters, law, changes).checked().unwrap());
                motion.advance(3e-3).unwrap();
                motion
            });
            let what = format!("{blades} {diameters} {law}");
            let (a, b) = (one.state(), own.state());
            assert!((a.u[0] - b.u[0]).hypot(a.u[1] - b.u[1]) < 1e-13, "{what}: {a:?} {b:?}");
            let log = [&one, &own].map(|motion| motion.contacts().clone());
            assert_eq!(log[0].impacts, log[1].impacts, "{what}");
            assert_eq!(log[0].tensile_steps, log[1].tensile_steps, "{what}");
            assert!(log[0].impact_count > 0, "{what}");
            let angles = [&one, &own].map(|motion| motion.blade_angles());
            let size = angles[0].iter().fold(0.0_f64, |most, angle| most.max(angle.abs()));
            assert!(size > 0.0, "{what}");
            for (blade, (a, b)) in angles[0].iter().zip(&angles[1]).enumerate() {
                assert!((a - b).abs() < 1e-8 * size, "{what}: blade {blade} {a:e} {b:e}");
            }
            let sides = angles[0].len() / each;
            for (a, b) in angles[0].iter().zip(&angles[0][sides..]) {
                assert_eq!(a, b, "{what}");
            }
        }
    }
}

#[test]
fn blades_of_a_side_move_as_their_modes() {
    for (blades, diameters, _) in RINGS {
        for law in LAWS {
            for changes in [&[][..], &apart("1e-6")] {
                let [full, modal] = ["full", "modal"].map(|model| {
                    let changes = [changes, &[("solver.model", model)]].concat();
                    let scene = ring(blades, diameters, law, &changes);
                    let mut motion = Motion::new(&scene.checked().unwrap());
                    motion.advance(2e-3).unwrap();
                    motion
                });
                let what = format!("{blades} {diameters} {law} {changes:?}");
                let (a, b) = (full.state(), modal.state());
                // Blades that answer an impact by more modes are lighter.
                let apart = (a.u[0] - b.u[0]).hypot(a.u[1] - b.u[1]);
                assert!(apart < 1e-4 * 1e-4, "{what}: {apart:e}");
                let impacts = [&full, &modal].map(|motion| motion.contacts().impacts.clone());
                assert_eq!(impacts[0], impacts[1], "{what}");
            }
        }
    }
}

#[test]
fn blades_that_an_excitation_tells_apart_under_way() {
    for law in LAWS {
        let quiet = ring("66", "3", law, &[]);
        let mut pair = Pair::new(&quiet);
        let excited = |order: &'static str| {
            let changes = [("excitation.amplitude_nm", "0.5"), ("excitation.order", order)];
            ring("66", "3", law, &changes)
        };
        // Alike, alike under a torque, apart, and apart without one.
        for (scene, until) in
            [(&quiet, 3e-4), (&excited("6"), 5e-4), (&excited("5"), 7e-4), (&quiet, 1e-3)]
        {
            pair.adopt(scene);
            pair.advance(until).unwrap();
            pair.check(&format!("{law} {until}"));
        }
        assert!(!pair.is_chaotic());
    }
}
