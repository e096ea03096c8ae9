//! The flag of a cell is that of the changed runs that define it (docs/theory.md,
//! section 9), made here one by one and to the end.

use std::f64::consts::TAU;

use rubscope_solver::motion::{Motion, VerdictReached, run_to_verdict, to_the_end, verdict_of};
use rubscope_solver::scene::{CheckedScene, ModelSize, Scene};
use rubscope_solver::study::{Axis, Doubt, MapPlan};

/// Scene and casing damping of the four maps: 0 to 500 rad/s, 0 to 1 MN.
const MAPS: [(&str, f64); 4] =
    [("paper-nd3", 0.05), ("paper-nd3", 0.01), ("paper-nd4", 0.05), ("paper-nd3", 0.0)];

/// Without a pattern (SplitMix64).
fn mixed(n: u64) -> u64 {
    let mut x = n.wrapping_add(1).wrapping_mul(0x9e37_79b9_7f4a_7c15);
    x = (x ^ (x >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    x = (x ^ (x >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    x ^ (x >> 31)
}

fn cell(map: usize, model: ModelSize, n: u64) -> CheckedScene {
    let (name, zeta) = MAPS[map];
    let mut scene = Scene::builtin(name).unwrap().as_reference();
    let part = |n| (mixed(n) >> 11) as f64 / (1_u64 << 53) as f64;
    scene.solver.model = model;
    scene.casing.damping_ratio = zeta;
    scene.operation.speed_rad_s = 500.0 * part(2 * n);
    scene.operation.pulse_n = 1e6 * part(2 * n + 1);
    scene.checked().unwrap()
}

fn with(scene: &CheckedScene, change: impl FnOnce(&mut Scene)) -> CheckedScene {
    let mut scene = scene.clone().into_scene();
    change(&mut scene);
    scene.checked().unwrap()
}

/// With the rate changed once a casing period, and finer gaps.
fn noisy(scene: &CheckedScene) -> VerdictReached {
    let mut motion = Motion::new(scene);
    motion.scale_tolerance(0.1);
    let (period, end) = (TAU / motion.machine().omega_c, scene.solver.end_s);
    for look in 1.. {
        let until = (look as f64 * period).min(end);
        motion.advance(until).unwrap();
        if until >= end {
            break;
        }
        // A verdict that is final has no noise after it.
        if motion.final_verdict().is_none() {
            motion.scale_rate(if mixed(look) & 1 == 0 { 1.0 + 1e-9 } else { 1.0 - 1e-9 });
        }
    }
    VerdictReached::of(&motion, verdict_of(&motion, 0.1 * end))
}

/// Whether one of the changed runs differs, by the words of the documents.
fn sensitive(scene: &CheckedScene) -> [bool; 4] {
    let plain = run_to_verdict(scene, &to_the_end).unwrap();
    let run = |scene: CheckedScene| run_to_verdict(&scene, &to_the_end).unwrap();
    let pulse = |part: f64| {
        run(with(scene, |scene| {
            let operation = &mut scene.operation;
            // As small a part of the velocity that the pulse gives, across it.
            let given = (operation.pulse_n * operation.pulse_s).abs();
            scene.initial.v_s_m_s += part * given / scene.casing.modal_mass_kg;
            operation.pulse_n *= 1.0 + part;
        }))
    };
    let faster = run(with(scene, |scene| scene.operation.speed_rad_s *= 1.0 + 1e-9));
    [pulse(-1e-9), faster, pulse(1e-9), noisy(scene)].map(|other| {
        let counted = !plain.rested && !other.rested;
        let moved = plain.locked_s.zip(other.locked_s).map_or(0.0, |(one, two)| one - two);
        (plain.verdict, plain.held) != (other.verdict, other.held)
            || (counted && plain.impact_count != other.impact_count)
            || moved.abs() > 0.1 * TAU / scene.machine().omega_c
    })
}

/// The flag of a map of this one cell, with so many threads.
fn flag(scene: &CheckedScene, threads: usize) -> bool {
    let at = |path, value| Axis::new(path, value, value, 1, false).unwrap();
    let plan = MapPlan {
        x: at("operation.speed_rad_s", scene.operation.speed_rad_s),
        y: at("operation.pulse_n", scene.operation.pulse_n),
        scene: scene.clone().into_scene(),
        sensitivity: true,
    };
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| plan.compute(0, &to_the_end)).unwrap().doubt == Doubt::Sensitive
}

#[test]
fn cells_have_the_flags_of_the_plain_runs_with_any_number_of_threads() {
    let (mut found, mut first) = ([0; 4], [0; 4]);
    let (mut cells, mut all) = (0, 0);
    for model in [ModelSize::Rigid, ModelSize::Modal] {
        for map in 0..MAPS.len() {
            for n in 0..25 {
                let scene = cell(map, model, n + 100 * map as u64);
                let each = sensitive(&scene);
                let plain = each.contains(&true);
                let flags = [1, 2, 4].map(|threads| flag(&scene, threads));
                assert_eq!(flags, [plain; 3], "{model} {map} {:?}", scene.operation);
                for (sum, one) in found.iter_mut().zip(each) {
                    *sum += u32::from(one);
                }
                if let Some(place) = each.iter().position(|&one| one) {
                    first[place] += 1;
                }
                (cells, all) = (cells + 1, all + u32::from(plain));
            }
        }
    }
    // Each of the runs finds some, none of them all, and the first most of them.
    assert!(found.iter().all(|&one| 10 < one && one < all), "{found:?} of {all}");
    assert!(2 * first[0] > all, "{first:?} of {all}");
}
