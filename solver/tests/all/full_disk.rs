//! The full model with several blades on each side of the polygon, under both laws: against
//! the plain stepper and against the modal model.

use crate::plain::compare::Pair;
use crate::plain::scenes::{LAWS, scene};
use rubscope_solver::motion::Motion;
use rubscope_solver::scene::Scene;

/// Blades and diameters.
const RINGS: [(&str, &str); 4] = [("66", "3"), ("88", "4"), ("40", "8"), ("150", "50")];

fn ring(blades: &str, diameters: &str, law: &str, model: &str) -> Scene {
    let speed = if diameters == "50" { "30" } else { "300" };
    scene(&[
        ("bladed_disk.blades", blades),
        ("operation.nodal_diameters", diameters),
        ("operation.speed_rad_s", speed),
        ("solver.contact", law),
        ("solver.model", model),
    ])
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
    for (blades, diameters) in RINGS {
        for law in LAWS {
            let end = if diameters == "50" { 3e-4 } else { 3e-3 };
            let what = format!("{blades} {diameters} {law}");
            let pair = compare(&what, &ring(blades, diameters, law, "full"), end);
            assert!(pair.plain.failure().is_none(), "{what}: {:?}", pair.plain.failure());
            assert!(!pair.plain.impacts.is_empty(), "{what}");
            assert!(!pair.is_chaotic(), "{what}: amplified {:e}", pair.amplified);
        }
    }
}

#[test]
fn blades_of_a_side_move_as_their_modes() {
    for (blades, diameters) in RINGS {
        for law in LAWS {
            let [full, modal] = ["full", "modal"].map(|model| {
                let scene = ring(blades, diameters, law, model);
                let mut motion = Motion::new(&scene.checked().unwrap());
                motion.advance(2e-3).unwrap();
                motion
            });
            let what = format!("{blades} {diameters} {law}");
            let (a, b) = (full.state(), modal.state());
            // Blades that answer an impact by more modes are lighter.
            let apart = (a.u[0] - b.u[0]).hypot(a.u[1] - b.u[1]);
            assert!(apart < 1e-4 * 1e-4, "{what}: {apart:e}");
            let impacts = [&full, &modal].map(|motion| motion.contacts().impacts.clone());
            assert_eq!(impacts[0], impacts[1], "{what}");
        }
    }
}
