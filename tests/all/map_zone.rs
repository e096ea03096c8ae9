//! What the map shows: no lock below the lock speed where contact can only push.

use rayon::prelude::*;
use rubscope_solver::motion::Verdict;
use rubscope_solver::study::{Axis, Map, MapPlan};

/// The paper's machine with rigid blades, cell by cell, without sensitivity: no cell holds at
/// or below Omega_lock, 411.934 rad/s here, and none anywhere needs a pull; returns how many
/// hold above.
fn holds_only_above_lock_speed(speed: &str, pulse: &str) -> usize {
    let changes =
        [("solver.kind", "event"), ("solver.contact", "unilateral"), ("solver.model", "rigid")];
    let scene = crate::scene("paper-nd3", &changes).into_scene();
    let lock = scene.machine().lock_speed().unwrap();
    let axis = |key: &str, range: &str| Axis::parse(&format!("operation.{key}={range}")).unwrap();
    let (x, y) = (axis("speed_rad_s", speed), axis("pulse_n", pulse));
    let mut map = Map::empty(MapPlan { scene, x, y, sensitivity: false });
    map.fill((0..map.cells.len()).into_par_iter(), &|| true, &|_, _| {});
    assert!(map.is_complete());
    let mut held = 0;
    for (place, cell) in map.cells.iter().enumerate() {
        let verdict = cell.unwrap().verdict;
        if matches!(verdict, Verdict::Locked | Verdict::Adhesive) {
            let speed = map.plan.x.value(place as u32 % map.plan.x.count);
            assert!(speed > lock, "{verdict} at {speed} rad/s");
            assert_eq!(verdict, Verdict::Locked, "contact that only pushes cannot be adhesive");
            held += 1;
        }
    }
    held
}

#[test]
fn no_lock_at_or_below_the_lock_speed_where_contact_only_pushes() {
    // Ends at Omega_lock to all digits given: "at" is in.
    assert_eq!(holds_only_above_lock_speed("0:411.934:60", "1e3:1e6:30"), 0);
    // The default scene locks here, between 45 and 60 kN for one.
    assert!(holds_only_above_lock_speed("430:800:20", "1e4:1e6:30") > 0);
}
