//! The event solver on the motions whose numbers are known: the reference cases,
//! the closed forms of locked motion, thresholds in speed and in pulse.

use rubscope_solver::motion::{ActiveSet, ExactEvents, Solver, Verdict};
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

fn run(changes: &[(&str, f64)], until: f64) -> ExactEvents {
    let mut motion = ExactEvents::new(&scene(changes).checked().unwrap()).unwrap();
    motion.advance(until).unwrap();
    motion
}

fn close(value: f64, expected: f64, tolerance: f64) {
    assert!((value - expected).abs() <= tolerance, "{value:e} is not {expected:e}");
}

const ZETA: &str = "casing.damping_ratio";
const PULSE: &str = "operation.pulse_n";
const SPEED: &str = "operation.speed_rad_s";
const RAMP: &str = "operation.speed_ramp_rad_s2";
const DIAMETERS: &str = "operation.nodal_diameters";

#[test]
fn case_a_has_its_two_impacts_and_decays() {
    let motion = run(&[], 0.1);
    let impacts = &motion.contacts().impacts;
    // The reference has six digits of the times and eight of the state.
    close(impacts[0].t_s, 0.228_219e-3, 5e-10);
    close(impacts[1].t_s, 0.292_811e-3, 5e-10);
    let blades: Vec<_> =
        impacts.iter().map(|impact| motion.machine().polygon.blades_of_side(impact.side)).collect();
    assert_eq!(blades, [[19], [4]]);
    let state = motion.state();
    close(state.u[0], 1.228_513_3e-6, 5e-14);
    close(state.u[1], 1.310_205_9e-7, 5e-15);
    assert_eq!(motion.final_verdict(), Some(Verdict::Decay));
}

/// Casing in the standing frame: `[u_c, u_s, v_c, v_s]`.
type Casing = [f64; 4];

/// One classical Runge-Kutta step of the free casing under a force on `u_c`.
fn runge_kutta(x: Casing, force: f64, h: f64) -> Casing {
    let (m, k): (f64, f64) = (2.0, 1.544e6);
    let d = 2.0 * 0.05 * (k * m).sqrt();
    let rate =
        |x: Casing| [x[2], x[3], (force - d * x[2] - k * x[0]) / m, (-d * x[3] - k * x[1]) / m];
    let along = |k: Casing, h: f64| std::array::from_fn(|i| x[i] + h * k[i]);
    let k1 = rate(x);
    let k2 = rate(along(k1, 0.5 * h));
    let k3 = rate(along(k2, 0.5 * h));
    let k4 = rate(along(k3, h));
    std::array::from_fn(|i| x[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i]))
}

/// Smallest gap of 22 blades at three diameters and 500 rad/s, and its blade.
fn smallest_gap(x: Casing, t: f64) -> (f64, u32) {
    (1..=22)
        .map(|blade| {
            let beta = 3.0 * (500.0 * t + f64::from(blade - 1) * std::f64::consts::TAU / 22.0);
            (0.5 - 0.4999 + x[0] * beta.cos() + x[1] * beta.sin(), blade)
        })
        .fold((f64::INFINITY, 0), |a, b| if b.0 < a.0 { b } else { a })
}

#[test]
fn case_a_agrees_with_small_runge_kutta_steps_and_bisection() {
    let h = 1e-6;
    let (mut x, mut t, mut impacts) = ([0.0; 4], 0.0_f64, Vec::new());
    let mut left: f64 = 0.1;
    while left > 1e-14 {
        // The pulse ends after exactly fifty steps; an impact shortens a step.
        let pulse = t < 50e-6 - 1e-12;
        let whole = if pulse { (50e-6 - t).min(h) } else { left.min(h) };
        let force = if pulse { 20e3 } else { 0.0 };
        let mut next = runge_kutta(x, force, whole);
        let mut step = whole;
        if smallest_gap(next, t + whole).0 < 0.0 {
            let (mut low, mut high) = (0.0, whole);
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                let gap = smallest_gap(runge_kutta(x, force, middle), t + middle).0;
                if gap > 0.0 { low = middle } else { high = middle }
            }
            step = low;
            next = runge_kutta(x, force, step);
            let (_, blade) = smallest_gap(next, t + step);
            let beta =
                3.0 * (500.0 * (t + step) + f64::from(blade - 1) * std::f64::consts::TAU / 22.0);
            let (sin, cos) = beta.sin_cos();
            let closing = next[2] * cos + next[3] * sin + 1500.0 * (next[1] * cos - next[0] * sin);
            next[2] -= closing * cos;
            next[3] -= closing * sin;
            impacts.push((t + step, blade));
            // After the time of touch, so that it is not found again.
            t += step;
            left -= step;
            x = runge_kutta(next, 0.0, 1e-9);
            t += 1e-9;
            left -= 1e-9;
            continue;
        }
        x = next;
        t += step;
        left -= step;
    }
    let motion = run(&[], t);
    let (state, found) = (motion.state(), &motion.contacts().impacts);
    assert_eq!(impacts.len(), found.len());
    for ((t, blade), impact) in impacts.iter().zip(found) {
        close(impact.t_s, *t, 1e-10);
        assert_eq!(motion.machine().polygon.side_of_blade(*blade), impact.side);
    }
    // The error of a step is (omega h)^5/120 = 4e-18: the rest is round-off of
    // 1e5 steps.
    close(state.u[0], x[0], 1e-8 * x[0].abs());
    close(state.u[1], x[1], 1e-8 * x[1].abs());
}

#[test]
fn case_c_rocks_into_a_corner() {
    let motion = run(&[(ZETA, 0.0), (PULSE, 51742.0)], 0.1);
    close(motion.contacts().since, 0.0580, 5e-5);
    assert!(matches!(motion.contacts().active_set, ActiveSet::Corner(..)));
    assert_eq!(motion.final_verdict(), Some(Verdict::Locked));
}

#[test]
fn the_summed_rocking_is_where_stepping_would_be() {
    // A sample between the last computed crossing and the limit repeats the
    // crossings; the corner is approached without a jump.
    let changes = [(ZETA, 0.0), (PULSE, 51742.0)];
    let lock = run(&changes, 0.1).contacts().since;
    let mut motion = ExactEvents::new(&scene(&changes).checked().unwrap()).unwrap();
    let corner = motion.machine().locked_amplitude().unwrap();
    let mut last = f64::INFINITY;
    for part in 0..40 {
        motion.advance(lock * (1.0 - 0.5_f64.powi(part + 6))).unwrap();
        let distance = corner - motion.state().amplitude();
        assert!(distance > -1e-15 * corner);
        last = distance;
    }
    assert!(last < 1e-15 * corner, "{last:e}");
    motion.advance(lock + 1e-15).unwrap();
    assert!(matches!(motion.contacts().active_set, ActiveSet::Corner(..)));
}

#[test]
fn light_damping_slips_and_a_strong_pulse_decays() {
    let slip = run(&[(ZETA, 0.01), (PULSE, 51742.0)], 0.5);
    let log = slip.contacts();
    assert!(log.unbroken_since.unwrap() < 0.01);
    assert!(log.since > 0.49 && log.impact_count > 200);
    let decay = run(&[(PULSE, 1e6)], 0.1);
    assert_eq!(decay.final_verdict(), Some(Verdict::Decay));
}

/// Starts at rest against the blades in the corner of side 0 and the next.
fn in_a_corner(changes: &[(&str, f64)]) -> ExactEvents {
    let mut scene = scene(changes);
    scene.operation.pulse_n = 0.0;
    let machine = scene.machine();
    let (sin, cos) = machine.polygon.delta.sin_cos();
    let radius = machine.locked_amplitude().unwrap();
    let nu = machine.nu(scene.operation.speed_rad_s);
    scene.initial.u_c_m = -radius * cos;
    scene.initial.u_s_m = -radius * sin;
    scene.initial.v_c_m_s = nu * radius * sin;
    scene.initial.v_s_m_s = -nu * radius * cos;
    ExactEvents::new(&scene.checked().unwrap()).unwrap()
}

#[test]
fn locked_motion_has_the_closed_form() {
    for (diameters, zeta, speed) in [
        (3.0, 0.05, 500.0),
        (3.0, 0.0, 295.0),
        (4.0, 0.05, 480.0),
        (25.0, 0.01, 200.0),
        (5.0, 0.0, 190.0),
    ] {
        for speed in [speed, -speed] {
            let mut motion = in_a_corner(&[(DIAMETERS, diameters), (ZETA, zeta), (SPEED, speed)]);
            motion.advance(0.05).unwrap();
            assert_eq!(motion.final_verdict(), Some(Verdict::Locked), "{diameters} {zeta} {speed}");
            let machine = motion.machine();
            let expected = machine.locked_multipliers(speed).unwrap();
            let scale = expected[0].abs().max(expected[1].abs());
            let found = motion.multipliers();
            for ((_, multiplier), expected) in found.iter().zip(expected) {
                close(
                    *multiplier,
                    expected,
                    1e-12 * scale.max(machine.clearance() * machine.casing_stiffness),
                );
            }
            assert!(machine.polygon.next(found[0].0) == found[1].0);
            let radius = machine.locked_amplitude().unwrap();
            close(motion.state().amplitude(), radius, 1e-12 * radius);
            // Torque from the contact feeds the casing damping, T Omega = d nu^2 |z|^2.
            let power = machine.casing_damping * machine.nu(speed).powi(2) * radius * radius;
            let torque: f64 = motion
                .multipliers()
                .iter()
                .zip([-1.0, 1.0])
                .map(|((_, multiplier), sign)| multiplier * sign * machine.polygon.half_side())
                .sum();
            close(torque * machine.nu(speed), power, 1e-11 * scale);
        }
    }
    close(
        in_a_corner(&[]).machine().casing_damping * 1500.0_f64.powi(2) * 1.010_283e-4_f64.powi(2),
        4.036,
        5e-4,
    );
}

#[test]
fn a_corner_lets_go_below_the_lock_speed() {
    for (zeta, diameters) in [(0.05, 3.0), (0.01, 3.0), (0.0, 3.0), (0.05, 4.0), (0.2, 5.0)] {
        let holds = |speed: f64| {
            let motion = in_a_corner(&[(ZETA, zeta), (DIAMETERS, diameters), (SPEED, speed)]);
            motion.final_verdict() == Some(Verdict::Locked)
        };
        let (mut low, mut high) = (100.0, 900.0);
        while high - low > 1e-5 {
            let middle = 0.5 * (low + high);
            if holds(middle) { high = middle } else { low = middle }
        }
        let machine = scene(&[(ZETA, zeta), (DIAMETERS, diameters)]).machine();
        close(high, machine.lock_speed().unwrap(), 1e-4);
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

#[test]
fn the_grazing_pulse_touches_on_one_side_of_its_threshold_only() {
    let touches = |pulse: f64| run(&[(PULSE, pulse)], 0.05).contacts().impact_count > 0;
    let (mut low, mut high) = (3000.0, 5000.0);
    while high - low > 1e-9 * high {
        let middle = 0.5 * (low + high);
        if touches(middle) { high = middle } else { low = middle }
    }
    close(high, 3795.0, 1.0);
    assert!(!touches(high * (1.0 - 1e-6)) && touches(high * (1.0 + 1e-6)));
    assert!(!touches(high * (1.0 - 1e-8)) && touches(high * (1.0 + 1e-8)));
}
