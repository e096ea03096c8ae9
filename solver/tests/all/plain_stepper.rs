//! The explicit solver against the plain stepper, without live changes (`live_random` has those).
//! A case is some changes to the paper's machine, run in every model under both laws and
//! compared every half millisecond; a new one is a row of the table of its kind.

use crate::keys::{BLADES, DIAMETERS, LAW, MODEL, PULSE, RAMP, SPEED, STEP, ZETA};
use crate::plain::compare::Pair;
use crate::plain::scenes::{LAWS, MODELS, in_corner, scene};
use rubscope_solver::motion::ActiveSet;
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
fn flights_impacts_and_slip() {
    for (name, changes, end) in [
        ("no contact", &[(PULSE, "3000")][..], 0.005),
        ("many impacts", &[(PULSE, "1e5")], 0.006),
        ("a pulse backward", &[(PULSE, "-4e4"), (SPEED, "-450")], 0.006),
        ("a disk that stands", &[(SPEED, "0")], 0.004),
        ("a pulse that lasts", &[("operation.pulse_s", "3.00005e-4"), (PULSE, "5e3")], 0.004),
        ("a longer step", &[(STEP, "1e-5"), (PULSE, "5e4")], 0.02),
        ("a shorter step", &[(STEP, "2e-7"), (PULSE, "1e5")], 0.001),
        // Through rest and on backward.
        ("reversal", &[(SPEED, "100"), (PULSE, "1e5"), (RAMP, "-3e4")], 0.006),
    ] {
        each(&MODELS, &LAWS, changes, |scene| {
            let pair = compare(name, &scene, end);
            assert!(!pair.is_chaotic(), "{name}: amplified {:e}", pair.amplified);
        });
    }
    each(&MODELS, &["unilateral"], &[(ZETA, "0.01"), (PULSE, "51742")], |scene| {
        let pair = compare("slip", &scene, 0.02);
        let since = pair.motion.contacts().unbroken_since;
        assert!(pair.plain.impacts.len() >= 5 && since < Some(0.019), "{since:?}");
    });
}

#[test]
fn locks_that_hold_pull_and_break() {
    for (speed, breaks) in [("-500", false), ("420", false), ("330", true)] {
        each(&MODELS, &LAWS, &[(SPEED, speed)], |scene| {
            let pair = compare("corner", &in_corner(scene.clone()), 0.006);
            let log = pair.motion.contacts();
            let unilateral = scene.solver.contact == ContactLaw::Unilateral;
            let kept = matches!(log.active_set, ActiveSet::Corner(..)) && log.since < 0.003;
            assert_eq!(kept, !(breaks && unilateral), "{speed} {log:?}");
        });
    }
    each(&MODELS, &LAWS, &[(SPEED, "430"), (RAMP, "-3000")], |scene| {
        compare("run-down", &in_corner(scene), 0.008);
    });
    // Pressed into a corner by a pulse, pulling from then on.
    let adhesive = [(PULSE, "1e6"), (SPEED, "360"), (STEP, "2e-7")];
    each(&["modal"], &["bilateral"], &adhesive, |scene| {
        assert!(compare("adhesive", &scene, 0.004).plain.tensile_steps > 1000);
    });
}

#[test]
fn excited_blades() {
    for (order, corner) in [("3", false), ("19", true), ("25", false), ("5", true)] {
        let changes = [("excitation.amplitude_nm", "2"), ("excitation.order", order)];
        each(&["modal"], &LAWS, &changes, |scene| {
            let scene = if corner { in_corner(scene) } else { scene };
            compare("excited", &scene, 0.006);
        });
    }
}

/// Few blades, aliased diameters, two sides, and blades that share a phase.
#[test]
fn disks_of_every_size() {
    let both = &["rigid", "modal"][..];
    for (blades, diameters, speed, models, end) in [
        ("1", "1", "500", &MODELS[..], 0.006),
        ("3", "1", "1500", &MODELS, 0.006),
        ("4", "1", "900", &MODELS, 0.006),
        ("7", "9", "200", &MODELS, 0.006),
        ("22", "25", "60", &MODELS, 0.006),
        ("40", "3", "500", &MODELS, 0.003),
        ("22", "11", "100", both, 0.006),
        ("2", "1", "100", both, 0.006),
        ("12", "8", "500", both, 0.006),
        ("66", "3", "500", both, 0.006),
        ("22", "0", "500", &MODELS, 0.003),
        ("12", "2", "0.1", &["full"], 0.003),
        ("88", "4", "300", &["full"], 0.001),
        ("150", "50", "30", &["full"], 3e-4),
    ] {
        let changes = [(BLADES, blades), (DIAMETERS, diameters), (SPEED, speed)];
        each(models, &LAWS, &changes, |scene| {
            compare(&format!("{blades} {diameters}"), &scene, end);
        });
    }
}

#[test]
fn three_sides_at_once() {
    // They are no answer for rigid blades.
    for (pulse, step) in [("1e6", "1e-6"), ("4e5", "2e-6")] {
        each(&["rigid"], &["bilateral"], &[(PULSE, pulse), (STEP, step)], |scene| {
            assert!(compare("three sides", &scene, 0.001).plain.failure().is_some());
        });
    }
    // A push on one of three closes the next.
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

/// Blades that swing by 0.03 to 0.06 rad, and blades light enough to share impacts.
#[test]
fn soft_and_light_blades() {
    let soft = [
        ("bladed_disk.stiffness_nm_per_rad", "100"),
        ("bladed_disk.coupling_nm_per_rad", "10"),
        ("bladed_disk.blade_length_m", "0.495"),
        ("bladed_disk.damping_ratio", "1"),
        (PULSE, "1e6"),
    ];
    for (model, inertia) in [("modal", "1e-5"), ("full", "1e-3")] {
        let changes = [&soft[..], &[("bladed_disk.inertia_kg_m2", inertia)]].concat();
        each(&[model], &LAWS, &changes, |scene| {
            let pair = compare("soft", &scene, 0.01);
            assert!(pair.plain.failure().is_none(), "{:?}", pair.plain.failure());
            // To the square of the step times the fastest blade frequency.
            let widest = pair.motion.checks().max_blade_angle_rad;
            assert!((widest / pair.plain.widest - 1.0).abs() < 1e-5, "{widest} {changes:?}");
        });
    }
    let light = [
        ("bladed_disk.inertia_kg_m2", "1e-6"),
        ("bladed_disk.stiffness_nm_per_rad", "1"),
        ("bladed_disk.coupling_nm_per_rad", "0.5"),
        (PULSE, "1e4"),
    ];
    each(&MODELS, &LAWS, &light, |scene| {
        compare("light", &scene, 0.004);
    });
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
        ("excitation.amplitude_nm", "900"),
    ];
    each(&["modal"], &LAWS, &driven, |scene| {
        let pair = compare("turned", &scene, 0.02);
        assert!(pair.plain.impacts.len() > 5, "{:?}", pair.plain.impacts);
        assert!(9.0 * pair.plain.widest > 0.5, "{}", pair.plain.widest);
    });
}
