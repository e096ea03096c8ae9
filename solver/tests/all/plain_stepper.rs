//! The explicit solver against the plain stepper, without live changes.

use crate::keys::{BLADES, DIAMETERS, LAW, MODEL, PULSE, SPEED, STEP, ZETA};
use crate::plain::Plain;
use crate::plain::compare::Pair;
use crate::plain::scenes::{LAWS, MODELS, in_corner, scene};
use rubscope_solver::scene::{ContactLaw, Scene};

/// Compares states every half millisecond until `end` or the motion's failure.
fn compare(name: &str, scene: &Scene, end: f64) -> Pair {
    let mut pair = Pair::new(scene);
    let solver = &scene.solver;
    let what = format!("{name}, {:?} {:?}", solver.model, solver.contact);
    let looks = (end / 5e-4).ceil();
    for look in 1..=looks as u32 {
        if pair.advance(end * f64::from(look) / looks).is_err() || pair.is_chaotic() {
            break;
        }
        pair.check(&what);
    }
    pair
}

/// The same changes in these models under these laws.
fn each(models: &[&str], laws: &[&str], changes: &[(&str, &str)], mut run: impl FnMut(Scene)) {
    for model in models {
        for law in laws {
            run(scene(&[changes, &[(MODEL, *model), (LAW, *law)]].concat()));
        }
    }
}

#[test]
fn flights_and_impacts() {
    for (name, changes, end) in [
        ("no contact", &[(PULSE, "3000")][..], 0.01),
        ("case A", &[], 0.01),
        ("many impacts", &[(PULSE, "1e5")], 0.01),
        ("a pulse backward", &[(PULSE, "-4e4"), (SPEED, "-450")], 0.01),
        ("a disk that stands", &[(SPEED, "0")], 0.005),
        ("a pulse that lasts", &[("operation.pulse_s", "3.00005e-4"), (PULSE, "5e3")], 0.005),
        ("a longer step", &[(STEP, "1e-5"), (PULSE, "5e4")], 0.02),
        ("a shorter step", &[(STEP, "2e-7"), (PULSE, "1e5")], 0.003),
    ] {
        each(&MODELS, &LAWS, changes, |scene| {
            let pair = compare(name, &scene, end);
            assert!(!pair.is_chaotic(), "{name}: amplified {:e}", pair.amplified);
        });
    }
}

#[test]
fn slip_and_rocking() {
    for zeta in ["0.01", "0"] {
        let changes = [(ZETA, zeta), (PULSE, "51742")];
        each(&MODELS, &["unilateral"], &changes, |scene| {
            let pair = compare("slip", &scene, 0.03);
            let last = pair.plain.window(0.001);
            assert!(pair.plain.impacts.len() >= 5 && last.unbroken, "{last:?}");
        });
    }
}

#[test]
fn locks_that_hold_pull_and_break() {
    for (speed, breaks) in [("500", false), ("-500", false), ("420", false), ("330", true)] {
        each(&MODELS, &LAWS, &[(SPEED, speed)], |scene| {
            let pair = compare("corner", &in_corner(scene.clone()), 0.008);
            let kept = pair.plain.window(0.004).kept;
            let unilateral = scene.solver.contact == ContactLaw::Unilateral;
            assert_eq!(kept.is_some(), !(breaks && unilateral), "{speed} {kept:?}");
        });
    }
    // Pressed into a corner by a pulse, pulling from then on.
    let adhesive = [(PULSE, "1e6"), (SPEED, "360"), (STEP, "2e-7")];
    each(&MODELS, &["bilateral"], &adhesive, |scene| {
        let pair = compare("adhesive", &scene, 0.004);
        assert!(pair.plain.window(0.003).pulled);
    });
}

#[test]
fn blades_of_a_held_lock() {
    for speed in ["500", "-500", "420"] {
        each(&["modal"], &LAWS, &[(SPEED, speed)], |scene| {
            compare("corner", &in_corner(scene), 0.008);
        });
    }
    let five = [(BLADES, "5"), (DIAMETERS, "2"), (MODEL, "modal"), (LAW, "bilateral")];
    compare("five blades", &scene(&five), 0.006);
}

#[test]
fn speed_ramps() {
    let ramp = |ramp: &'static str| ("operation.speed_ramp_rad_s2", ramp);
    let run_down = [(SPEED, "430"), ramp("-3000")];
    each(&MODELS, &LAWS, &run_down, |scene| {
        compare("run-down", &in_corner(scene), 0.01);
    });
    // Through rest and on backward.
    each(&MODELS, &LAWS, &[(SPEED, "100"), (PULSE, "1e5"), ramp("-3e4")], |scene| {
        compare("reversal", &scene, 0.01);
    });
}

#[test]
fn excited_blades() {
    for (order, corner) in [("3", false), ("19", true), ("25", false), ("5", true), ("22", false)] {
        let changes = [("excitation.amplitude_nm", "2"), ("excitation.order", order)];
        each(&["modal"], &LAWS, &changes, |scene| {
            let scene = if corner { in_corner(scene) } else { scene };
            compare("excited", &scene, 0.006);
        });
    }
}

#[test]
fn few_blades_and_aliased_diameters() {
    for (blades, diameters, speed) in [
        ("1", "1", "500"),
        ("3", "1", "500"),
        ("3", "1", "1500"),
        ("4", "1", "900"),
        ("5", "2", "500"),
        ("7", "9", "200"),
        ("22", "25", "60"),
        ("40", "3", "500"),
    ] {
        let changes = [(BLADES, blades), (DIAMETERS, diameters), (SPEED, speed)];
        each(&MODELS, &LAWS, &changes, |scene| {
            compare(&format!("{blades} {diameters}"), &scene, 0.006);
        });
    }
}

#[test]
fn blades_light_enough_to_share_impacts() {
    let light = [
        ("bladed_disk.inertia_kg_m2", "1e-6"),
        ("bladed_disk.stiffness_nm_per_rad", "1"),
        ("bladed_disk.coupling_nm_per_rad", "0.5"),
        (PULSE, "1e4"),
    ];
    each(&MODELS, &LAWS, &light, |scene| {
        compare("light", &scene, 0.006);
    });
}

#[test]
fn blades_that_share_a_phase_rigid_and_modal() {
    for (blades, diameters) in [("22", "4"), ("12", "2"), ("12", "8"), ("66", "3"), ("22", "0")] {
        let changes = [(BLADES, blades), (DIAMETERS, diameters)];
        each(&["rigid", "modal"], &LAWS, &changes, |scene| {
            compare(&format!("{blades} {diameters}"), &scene, 0.006);
        });
    }
}

#[test]
fn two_sides() {
    for (blades, diameters) in [("22", "11"), ("4", "2"), ("2", "1")] {
        let changes = [(BLADES, blades), (DIAMETERS, diameters), (SPEED, "100")];
        each(&["rigid", "modal"], &LAWS, &changes, |scene| {
            compare(&format!("{blades} {diameters}"), &scene, 0.006);
        });
    }
}

#[test]
fn three_sides_at_once_are_no_answer_for_rigid_blades() {
    for (pulse, step) in [("1e6", "1e-6"), ("4e5", "2e-6"), ("5e6", "1e-6")] {
        let changes = [(PULSE, pulse), (STEP, step)];
        each(&["rigid"], &["bilateral"], &changes, |scene| {
            let pair = compare("three sides", &scene, 0.001);
            assert!(pair.plain.failure().is_some());
        });
    }
}

#[test]
fn a_push_on_one_of_three_sides_closes_the_next() {
    let three = [(BLADES, "3"), (DIAMETERS, "1"), (SPEED, "0")];
    each(&["rigid", "modal"], &["unilateral"], &three, |scene| {
        let mut scene = in_corner(scene);
        let (step, polygon) = (scene.solver.step_s, scene.machine().polygon);
        let [a, b] = [0, 1].map(|side| polygon.direction(side));
        let sine = a.0 * b.1 - a.1 * b.0;
        let with_gaps = |p: f64, q: f64| ((p * b.1 - q * a.1) / sine, (q * a.0 - p * b.0) / sine);
        // Half a step before side 0 at 1 m/s, along side 1 and close to it.
        let place = with_gaps(0.5 * step, 0.1 * step);
        scene.initial.u_c_m += place.0;
        scene.initial.u_s_m += place.1;
        (scene.initial.v_c_m_s, scene.initial.v_s_m_s) = with_gaps(-1.0, 0.0);
        compare("three sides", &scene, 0.002);
    });
}

#[test]
fn decay_is_seen_as_soon_as_nothing_can_touch() {
    // The last contact removes nearly all the excess speed; drag removes the rest.
    for pulse in ["5e3", "1e4", "1.5e4", "2e4", "3e4"] {
        each(&["rigid", "modal"], &["unilateral"], &[(PULSE, pulse), (ZETA, "0.3")], |scene| {
            let mut pair = Pair::new(&scene);
            for look in 1..=60 {
                assert!(pair.advance(f64::from(look) * 5e-5).is_ok());
                pair.check_verdict("decay", 1e-3);
            }
        });
    }
}

#[test]
fn blades_that_share_a_phase_full() {
    for (blades, diameters, speed) in [
        ("22", "4", "300"),
        ("12", "2", "0.1"),
        ("66", "3", "500"),
        ("22", "0", "500"),
        ("22", "11", "100"),
        ("88", "4", "300"),
        ("40", "8", "300"),
        ("150", "50", "30"),
    ] {
        let changes = [(BLADES, blades), (DIAMETERS, diameters), (SPEED, speed)];
        let end = if blades == "150" { 3e-4 } else { 3e-3 };
        each(&["full"], &LAWS, &changes, |scene| {
            compare(&format!("{blades} {diameters}"), &scene, end);
        });
    }
}

/// Blades so soft and heavily damped that they swing by 0.03 to 0.06 rad.
const SOFT: [(&str, &str); 5] = [
    ("bladed_disk.stiffness_nm_per_rad", "100"),
    ("bladed_disk.coupling_nm_per_rad", "10"),
    ("bladed_disk.blade_length_m", "0.495"),
    ("bladed_disk.damping_ratio", "1"),
    (PULSE, "1e6"),
];

#[test]
fn soft_blades_fail_where_an_angle_passes_a_tenth() {
    for (model, inertia) in [("modal", "1e-5"), ("full", "1e-3")] {
        let changes = [&SOFT[..], &[("bladed_disk.inertia_kg_m2", inertia)]].concat();
        each(&[model], &LAWS, &changes, |scene| {
            let pair = compare("soft", &scene, 0.01);
            assert!(pair.plain.failure().is_none(), "{:?}", pair.plain.failure());
        });
    }
}

#[test]
fn the_largest_blade_angle_is_that_of_some_step() {
    let driven = [(PULSE, "0"), ("excitation.amplitude_nm", "3000")];
    let both = &["modal", "full"][..];
    for (models, changes) in
        [(both, &[][..]), (both, &[(PULSE, "1e5")]), (&["modal"], &driven), (both, &SOFT)]
    {
        each(models, &LAWS, changes, |scene| {
            let pair = compare("widest", &scene, 0.01);
            let widest = pair.motion.checks().max_blade_angle_rad;
            // Sampled every step, or at the peak of a closed form: the same to
            // the square of the step times the fastest blade frequency.
            assert!((widest / pair.plain.widest - 1.0).abs() < 1e-5, "{widest} {changes:?}");
        });
    }
}

/// Blades turned by more than the angle between two sides: the side that penetrates is
/// not the one nearest to the casing, and open ones lie between.
#[test]
fn blades_turned_past_their_neighbours() {
    let driven = [
        ("operation.pulse_s", "1"),
        (PULSE, "400"),
        (SPEED, "31"),
        (DIAMETERS, "9"),
        ("excitation.order", "9"),
    ];
    for torque in ["900", "850"] {
        let changes = [&driven[..], &[("excitation.amplitude_nm", torque)]].concat();
        each(&["modal"], &LAWS, &changes, |scene| {
            let pair = compare("turned", &scene, 0.02);
            assert!(pair.plain.impacts.len() > 5, "{:?}", pair.plain.impacts);
            assert!(9.0 * pair.plain.widest > 0.5, "{}", pair.plain.widest);
        });
    }
}

/// The scheme without round-off, at the longest step that figure 4 names.
#[test]
fn round_off_moves_the_lock_at_the_longest_step_of_figure_4() {
    let scene =
        Scene::builtin("paper-figs-4-6").unwrap().with(&[("solver.step_s", "1e-6")]).unwrap();
    let mut plain = Plain::new(&scene);
    plain.advance(0.082).unwrap();
    let since = plain.kept_since().unwrap();
    assert!((since - 0.0796).abs() < 5e-5, "{since}");
}
