//! Laws of the event solver that need no reference, over random scenes of the paper and beyond:
//! nothing penetrates, nothing pulls, energy balances, a mirrored or turned start gives a
//! mirrored or turned motion, and the motion does not depend on when it is sampled. A new law is
//! a function of a scene; a new kind of scene is a part of `any_scene`.

use std::f64::consts::TAU;

use crate::plain::scenes::{in_corner, scene, taken_scene};
use crate::random::{each_case, scale, within};
use fastrand::Rng;
use rubscope_solver::motion::{ActiveSet, Events, Motion, Solver, State};
use rubscope_solver::scene::{ModelSize, Scene, SolverKind};

/// A scene of every kind the event solver takes; one in three with moving blades.
fn any_scene(rng: &mut Rng) -> Scene {
    let mut scene = Scene::base();
    scene.bladed_disk.blades = rng.u32(1..=30);
    scene.operation.nodal_diameters = rng.u32(0..=35);
    let clearance = if rng.bool() { 1e-4 } else { within(rng, 1e-6..1e-2) };
    scene.bladed_disk.blade_length_m = scene.casing.radius_m - clearance;
    scene.casing.damping_ratio = match rng.u8(0..5) {
        0 => 0.0,
        1 => 0.05,
        2 => 1.0,
        3 => within(rng, 0.0..0.2),
        _ => within(rng, 0.2..3.0),
    };
    scene.operation.speed_ramp_rad_s2 = match rng.u8(0..5) {
        0..3 => 0.0,
        3 => within(rng, -2e4..2e4),
        _ => within(rng, -1e6..1e6),
    };
    let speeds = if rng.bool() { -900.0..900.0 } else { 280.0..310.0 };
    scene.operation.speed_rad_s = within(rng, speeds);
    let force = if rng.bool() { 0.0 } else { scale(rng, 10.0..3.2e6) };
    scene.operation.pulse_n = if rng.bool() { -force } else { force };
    scene.operation.pulse_s = if rng.bool() { 50e-6 } else { within(rng, 1e-6..3e-3) };
    let clearance = scene.machine().clearance();
    let speed = clearance * 878.0;
    scene.initial.u_c_m = 0.7 * clearance * within(rng, -0.9..0.9);
    scene.initial.u_s_m = 0.7 * clearance * within(rng, -0.9..0.9);
    scene.initial.v_c_m_s = speed * within(rng, -3.0..3.0);
    scene.initial.v_s_m_s = speed * within(rng, -3.0..3.0);
    scene.solver.model = if rng.u8(0..3) < 2 { ModelSize::Rigid } else { ModelSize::Modal };
    if rng.u8(0..3) == 2 {
        scene.bladed_disk.radial_coupling = within(rng, -0.5..0.8);
        scene.contact.friction = within(rng, 0.0..0.5);
        scene.contact.restitution = within(rng, 0.0..0.9);
        scene.casing.tangential_ratio = within(rng, 0.0..0.4);
        scene.operation.speed_ramp_rad_s2 = 0.0;
    }
    scene.solver.kind = SolverKind::Event;
    scene
}

fn events(scene: &Scene) -> Events {
    Events::new(&scene.checked().unwrap()).unwrap()
}

/// Checks the state now.
fn assert_lawful(motion: &Events) {
    let (state, machine) = (motion.state(), motion.machine());
    let numbers = [state.u, state.v, state.alpha, state.alpha_rate].concat();
    assert!(numbers.iter().all(|x| x.is_finite()), "{state:?}");
    // Round-off of a phase of up to 1e4 rad, twice, and of the motion.
    let size = machine.clearance() + state.amplitude();
    let gaps = motion.blade_gaps();
    let least = gaps.iter().fold(f64::INFINITY, |least, gap| least.min(*gap));
    assert!(least > -1e-10 * size, "gap {least:e} at {}", state.t_s);
    let nu = machine.nu(motion.rotor().speed(state.t_s));
    let scale = size * machine.casing_mass * (nu * nu + machine.omega_c.powi(2));
    for (side, multiplier) in motion.multipliers() {
        assert!(multiplier <= 1e-9 * scale, "{multiplier} N pulls at {}", state.t_s);
        let gap = gaps[machine.polygon.blades_of_side(side)[0] as usize - 1];
        assert!(gap < 1e-10 * size, "push {multiplier} over a gap {gap:e}");
    }
}

/// Whether a motion may leave the range of the model: a wave that no corner
/// holds, blades that turn sides past each other, or growth by friction.
fn may_fail(scene: &Scene) -> bool {
    !scene.machine().polygon.has_corners()
        || scene.solver.model == ModelSize::Modal
        || scene.contact.friction > 0.0
}

fn same(a: &State, b: &State) -> bool {
    format!("{a:?}") == format!("{b:?}")
}

#[test]
fn no_penetration_no_pull_and_a_balance_of_energy() {
    each_case(60, |rng| {
        let scene = taken_scene(rng, any_scene);
        let mut motion = events(&scene);
        let end = 0.02;
        let mut largest: f64 = 0.0;
        for part in 1..=200 {
            let until = end * f64::from(part) / 200.0;
            loop {
                match motion.next_event(until) {
                    Err(_) => {
                        assert!(may_fail(&scene));
                        return;
                    }
                    Ok(_) => assert_lawful(&motion),
                }
                let state = motion.state();
                let energy = state.v[0].hypot(state.v[1]).powi(2)
                    + (motion.machine().omega_c * state.amplitude()).powi(2);
                largest = largest.max(motion.machine().casing_mass * energy);
                if state.t_s >= until {
                    break;
                }
            }
        }
        // The pulse does work of up to F^2 t^2/m, in several pieces, and the rotor what is lost.
        let impulse = scene.operation.pulse_n * scene.operation.pulse_s;
        let machine = motion.machine();
        let lost = 2.0 * machine.casing_damping_ratio * machine.omega_c * end;
        let scale = (1.0 + lost) * largest + impulse * impulse / machine.casing_mass;
        let checks = motion.checks();
        let residual = checks.energy_residual_j.unwrap();
        // The pushes of more sides than a corner has are those of a nearly singular matrix.
        let part =
            if matches!(motion.contacts().active_set, ActiveSet::Many) { 1e-8 } else { 1e-10 };
        assert!(residual.abs() <= part * scale, "{residual:e} of {scale:e} J");
        assert!(checks.max_penetration_m <= 1e-12 * motion.machine().clearance().max(1.0));
    });
}

#[test]
fn where_one_looks_does_not_change_a_bit() {
    each_case(60, |rng| {
        let scene = taken_scene(rng, any_scene);
        let mut cuts: Vec<f64> = (0..rng.usize(1..6)).map(|_| within(rng, 0.0..0.02)).collect();
        let mut whole = events(&scene);
        let mut again = events(&scene);
        let mut parts = events(&scene);
        cuts.sort_by(f64::total_cmp);
        let one = whole.advance(0.02);
        assert_eq!(&one, &again.advance(0.02));
        assert!(same(&whole.state(), &again.state()));
        for cut in cuts {
            if parts.advance(cut).is_err() {
                break;
            }
        }
        assert_eq!(one.is_ok(), parts.advance(0.02).is_ok());
        assert!(same(&whole.state(), &parts.state()), "{:?} {:?}", whole.state(), parts.state());
        assert_eq!(whole.contacts().impact_count, parts.contacts().impact_count);
        assert_eq!(whole.multipliers(), parts.multipliers());
    });
}

#[test]
fn the_mirror_image_is_a_motion() {
    each_case(60, |rng| {
        let scene = taken_scene(rng, any_scene);
        let mut mirrored = scene.clone();
        mirrored.operation.speed_rad_s *= -1.0;
        mirrored.operation.speed_ramp_rad_s2 *= -1.0;
        mirrored.bladed_disk.radial_coupling *= -1.0;
        mirrored.initial.u_s_m *= -1.0;
        mirrored.initial.v_s_m_s *= -1.0;
        let (mut left, mut right) = (events(&scene), events(&mirrored));
        // Grazing contacts amplify round-off: compare the first twenty changes of contact.
        for _ in 0..20 {
            let both = (left.next_event(0.01), right.next_event(0.01));
            assert_eq!(both.0.is_ok(), both.1.is_ok());
            let Ok(now) = both.0 else { return };
            if now >= 0.01 {
                break;
            }
        }
        let (left, right) = (left.state(), right.state());
        let size = scene.machine().clearance() + left.amplitude();
        assert!((left.u[0] - right.u[0]).abs() < 1e-9 * size);
        assert!((left.u[1] + right.u[1]).abs() < 1e-9 * size);
    });
}

#[test]
fn turning_the_start_by_one_group_turns_the_motion() {
    each_case(60, |rng| {
        let mut scene = taken_scene(rng, any_scene);
        scene.operation.pulse_n = 0.0;
        let machine = scene.machine();
        let angle = TAU / f64::from(machine.polygon.sides);
        let (sin, cos) = angle.sin_cos();
        let mut turned = scene.clone();
        let start = &scene.initial;
        turned.initial.u_c_m = start.u_c_m * cos - start.u_s_m * sin;
        turned.initial.u_s_m = start.u_c_m * sin + start.u_s_m * cos;
        turned.initial.v_c_m_s = start.v_c_m_s * cos - start.v_s_m_s * sin;
        turned.initial.v_s_m_s = start.v_c_m_s * sin + start.v_s_m_s * cos;
        let (mut one, mut other) = (events(&scene), events(&turned));
        // Impacts near corners and grazing contacts amplify round-off: compare the first few.
        let mut until: f64 = 0.005;
        for _ in 0..4 {
            let next = one.next_event(0.005);
            if next.is_err() {
                return;
            }
            until = next.unwrap();
        }
        let mut one = events(&scene);
        one.advance(0.999 * until).unwrap();
        other.advance(0.999 * until).unwrap();
        let (one, other) = (one.state(), other.state());
        let back = [other.u[0] * cos + other.u[1] * sin, other.u[1] * cos - other.u[0] * sin];
        let size = machine.clearance() + one.amplitude();
        assert!((one.u[0] - back[0]).abs() < 1e-6 * size, "{one:?} {back:?}");
        assert!((one.u[1] - back[1]).abs() < 1e-6 * size, "{one:?} {back:?}");
    });
}

#[test]
fn changes_on_the_way_are_followed() {
    each_case(60, |rng| {
        let scene = taken_scene(rng, any_scene);
        let turn = within(rng, -600.0..600.0);
        let mut motion = Motion::new(&scene.checked().unwrap());
        for k in 1..=20 {
            if motion.advance(1e-3 * f64::from(k)).is_err() {
                break;
            }
            match k % 4 {
                0 => motion.fire(),
                1 => motion.set_speed(turn, 0.0),
                2 => motion.scale_rate(1.0 + 1e-9),
                _ => motion.scale_tolerance(0.1),
            }
        }
        let state = motion.state();
        assert!(state.u.iter().chain(&state.alpha).all(|x| x.is_finite()));
    });
}

#[test]
fn a_corner_under_a_pulse_lets_go_before_it_pulls() {
    for speed in ["413", "430"] {
        let rigid = [("solver.model", "rigid"), ("operation.speed_rad_s", speed)];
        let mut scene = in_corner(scene(&rigid));
        (scene.solver.kind, scene.operation.pulse_s) = (SolverKind::Event, 4e-3);
        for force in [-300.0, -10.0, -3.0, 3.0, 10.0, 300.0] {
            scene.operation.pulse_n = force;
            for k in 1..=40 {
                // A separate run for each time: sampling must not change the result.
                let mut motion = Motion::new(&scene.checked().unwrap());
                assert!(motion.advance(1e-4 * f64::from(k)).is_ok());
                for (side, multiplier) in motion.multipliers() {
                    assert!(multiplier <= 1e-6, "{force} N: {side} {multiplier} N, {k}");
                }
            }
        }
    }
}
