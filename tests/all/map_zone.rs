//! What the map shows: no lock below the lock speed where contact can only
//! push, the paper's zone with its adhesive part where it can pull, and the same
//! map on any number of threads.

use std::f64::consts::TAU;

use rayon::prelude::*;
use rubscope_solver::motion::{Verdict, run_to_verdict, to_the_end};
use rubscope_solver::scene::{ContactLaw, ModelSize, Scene, SolverKind};
use rubscope_solver::study::margins::grazing_pulse;
use rubscope_solver::study::{Axis, Map, MapPlan};

/// The paper's machine with rigid blades, cell by cell, without sensitivity.
fn plan(speed: &str, pulse: &str) -> MapPlan {
    let mut scene = Scene::base();
    scene.casing.damping_ratio = 0.05;
    scene.solver.kind = SolverKind::Event;
    scene.solver.contact = ContactLaw::Unilateral;
    scene.solver.model = ModelSize::Rigid;
    let axis = |key: &str, range: &str| Axis::parse(&format!("operation.{key}={range}")).unwrap();
    let (x, y) = (axis("speed_rad_s", speed), axis("pulse_n", pulse));
    MapPlan { scene, x, y, sensitivity: false }
}

fn filled(plan: MapPlan) -> Map {
    let mut map = Map::empty(plan);
    map.fill((0..map.cells.len()).into_par_iter(), &|| true, &|_, _| {});
    assert!(map.is_complete());
    map
}

/// Speed, pulse and verdict of every cell.
fn cells(map: &Map) -> Vec<(f64, f64, Verdict)> {
    let columns = map.plan.x.count as usize;
    let value = |index: usize| {
        let (x, y) = ((index % columns) as u32, (index / columns) as u32);
        (map.plan.x.value(x), map.plan.y.value(y), map.cells[index].unwrap().verdict)
    };
    (0..map.cells.len()).map(value).collect()
}

fn is_held(verdict: Verdict) -> bool {
    matches!(verdict, Verdict::Locked | Verdict::Adhesive)
}

/// No cell holds at or below Omega_lock, 411.934 rad/s here, and none anywhere
/// needs a pull; returns how many hold above.
fn holds_only_above_lock_speed(speed: &str, pulse: &str) -> usize {
    let map = filled(plan(speed, pulse));
    let lock = map.plan.scene.machine().lock_speed().unwrap();
    assert!((lock - 411.934).abs() < 1e-3, "{lock}");
    let held: Vec<_> = cells(&map).into_iter().filter(|cell| is_held(cell.2)).collect();
    for &(speed, pulse, verdict) in &held {
        assert!(speed > lock, "{verdict} at {speed} rad/s with {pulse} N");
        assert_eq!(verdict, Verdict::Locked, "contact that only pushes cannot be adhesive");
    }
    held.len()
}

#[test]
fn no_lock_at_or_below_the_lock_speed_where_contact_only_pushes() {
    // Ends at Omega_lock to all digits given: "at" is in.
    assert_eq!(holds_only_above_lock_speed("0:411.934:60", "1e3:1e6:30"), 0);
    // The default scene locks here, between 45 and 60 kN for one.
    assert!(holds_only_above_lock_speed("430:800:20", "1e4:1e6:30") > 0);
}

#[test]
#[ignore = "40,000 cells, for release builds: cargo test --release -- --ignored"]
fn no_lock_at_or_below_the_lock_speed_in_a_full_map() {
    holds_only_above_lock_speed("0:500:200", "0:1.2e6:200");
}

#[test]
fn the_bilateral_map_shows_the_zone_of_the_paper() {
    let mut plan = plan("0:500:51", "0:4e5:9");
    plan.scene.solver.kind = SolverKind::Explicit;
    plan.scene.solver.contact = ContactLaw::Bilateral;
    plan.scene.solver.step_s = 1e-6;
    let machine = plan.scene.machine();
    let (critical, lock) = (machine.critical_speed().unwrap(), machine.lock_speed().unwrap());
    // Omega_c [zeta_c tan delta + sqrt(1 + zeta_c^2 tan^2 delta)], delta the
    // half corner, pi / 22 for these 22 sides.
    let tan = 0.05 * (std::f64::consts::PI / 22.0).tan();
    let adhesive_from = critical * (tan + (1.0 + tan * tan).sqrt());
    assert!((adhesive_from - 294.99).abs() < 0.01, "{adhesive_from}");
    let map = filled(plan);
    let mut seen = [0; 2];
    for (speed, pulse, verdict) in cells(&map) {
        if is_held(verdict) {
            assert!(speed > adhesive_from, "{verdict} at {speed} rad/s with {pulse} N");
            let expected = if speed > lock { Verdict::Locked } else { Verdict::Adhesive };
            assert_eq!(verdict, expected, "at {speed} rad/s with {pulse} N");
            seen[usize::from(expected == Verdict::Locked)] += 1;
        }
    }
    assert!(seen.iter().all(|&count| count > 20), "{seen:?} adhesive and locked cells");
    // A threshold pulse: without one nothing holds, with more of it something.
    for column in 0..map.plan.x.count {
        assert_eq!(map.at(column, 0).unwrap().verdict, Verdict::Decay);
    }
    let at_500 = |row| is_held(map.at(50, row).unwrap().verdict);
    assert!(at_500(4) && at_500(6), "200 and 300 kN hold at 500 rad/s");
}

#[test]
fn strong_pulses_at_a_coarse_step_fail_plainly() {
    let mut plan = plan("300:500:5", "1e6:1.2e6:3");
    plan.scene.solver.model = ModelSize::Modal;
    plan.scene.solver.kind = SolverKind::Explicit;
    plan.scene.solver.contact = ContactLaw::Bilateral;
    plan.scene.solver.step_s = 1e-6;
    for (speed, pulse, verdict) in cells(&filled(plan)) {
        assert_eq!(verdict, Verdict::Failed, "at {speed} rad/s with {pulse} N");
    }
}

#[test]
fn one_thread_and_two_give_the_same_map() {
    let mut plan = plan("300:500:11", "1e4:1e6:11");
    plan.sensitivity = true;
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| filled(plan.clone())).cells
    };
    assert_eq!(on(1), on(2));
}

#[test]
fn the_grazing_pulse_is_where_blades_begin_to_be_met() {
    for (speed, zeta, pulse_s) in [(500.0, 0.05, 50e-6), (50.0, 0.0, 1e-3), (-400.0, 0.3, 1e-2)] {
        let mut scene = plan("300:500:5", "1e4:1e6:3").scene;
        scene.operation.speed_rad_s = speed;
        scene.casing.damping_ratio = zeta;
        scene.operation.pulse_s = pulse_s;
        scene.solver.end_s = pulse_s + TAU / scene.machine().omega_c;
        let grazing = grazing_pulse(&scene, 1e5).unwrap();
        for (part, touches) in [(1.0 - 1e-6, false), (1.0 + 1e-6, true)] {
            scene.operation.pulse_n = part * grazing;
            assert_eq!(
                run_to_verdict(&scene.checked().unwrap(), &to_the_end).unwrap().impact_count > 0,
                touches,
                "{part} of {grazing} N"
            );
        }
    }
}
