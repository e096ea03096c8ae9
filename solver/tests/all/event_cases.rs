//! The event solver on motions whose thresholds are known in closed form. A case is some keys and
//! the formula; numbers of the reference cases stand in docs/numbers.csv.

use crate::close;
use crate::keys::{DIAMETERS, RAMP, SPEED, ZETA};
use crate::tips_support::on_side_0;
use rubscope_solver::motion::{ActiveSet, Events, Solver, Verdict};
use rubscope_solver::scene::Scene;

pub fn scene(changes: &[(&str, f64)]) -> Scene {
    scene_of("rigid", changes)
}

/// The paper's machine with some keys changed, for the event solver.
pub fn scene_of(model: &str, changes: &[(&str, f64)]) -> Scene {
    let mut scene = Scene::base();
    scene.set("solver.kind", "event").unwrap();
    scene.set("solver.model", model).unwrap();
    for (key, value) in changes {
        scene.set(key, &value.to_string()).unwrap();
    }
    scene.checked().unwrap();
    scene
}

/// Starts at rest against the blades in the corner of side 0 and the next.
fn in_a_corner(changes: &[(&str, f64)]) -> Events {
    let mut scene = scene(changes);
    on_side_0(&mut scene, true, 0.0);
    Events::new(&scene.checked().unwrap()).unwrap()
}

#[test]
fn a_corner_lets_go_below_the_lock_speed() {
    for (zeta, diameters) in [(0.0, 3.0), (0.05, 4.0)] {
        let holds = |speed: f64| {
            let mut motion = in_a_corner(&[(ZETA, zeta), (DIAMETERS, diameters), (SPEED, speed)]);
            motion.advance(1e-3).unwrap();
            motion.multipliers().len() == 2
        };
        let (mut low, mut high) = (100.0, 900.0);
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if holds(middle) { high = middle } else { low = middle }
        }
        let machine = scene(&[(ZETA, zeta), (DIAMETERS, diameters)]).machine();
        // The event solver takes a push of 1e-15 of the motion as zero.
        close(high, machine.lock_speed().unwrap(), 1e-10 * high);
    }
}

#[test]
fn a_falling_speed_breaks_the_lock_where_a_push_vanishes() {
    // With the Euler force: 2 c nu + nu' against the drag, as in the corner's
    // equations; the second push vanishes.
    let ramp = -200.0;
    let mut motion = in_a_corner(&[(RAMP, ramp)]);
    let t = motion.next_event(1.0).unwrap();
    let machine = motion.machine();
    let speed = 500.0 + ramp * t;
    let nu = machine.nu(speed);
    let drag = 2.0 * machine.casing_damping_ratio * machine.omega_c * nu + machine.nu(ramp);
    let (sin, cos) = machine.polygon.delta.sin_cos();
    let stiff = machine.omega_c.powi(2) - nu * nu;
    close(stiff / cos + drag / sin, 0.0, 1e-6 * stiff.abs().max(drag / sin));
    close(speed, machine.lock_speed().unwrap(), 3.0);
    assert!(matches!(motion.contacts().active_set, ActiveSet::Side(_)));
    motion.advance(1.0).unwrap();
    assert_eq!(motion.final_verdict(), Some(Verdict::Decay));
}
