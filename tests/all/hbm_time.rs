//! The frequency domain against the time solvers: locked states in all four
//! coordinates, the speed of slip.

use crate::close;
use nalgebra::Complex;
use rubscope_solver::harmonic::{Corner, Form, Locked, SlipOrbit, slip_over};
use rubscope_solver::motion::{ActiveSet, Events, Solver};
use rubscope_solver::scene::{ModelSize, Scene};

/// Rigid blades unless a test changes it, as the closed forms have them.
fn scene(changes: &[(&str, &str)]) -> Scene {
    let mut scene = Scene::base();
    scene.solver.model = ModelSize::Rigid;
    scene.with(changes).unwrap().into_scene()
}

/// The same without a pulse.
fn quiet(diameters: u32, zeta: f64, speed: f64) -> Scene {
    let mut scene = scene(&[("operation.pulse_n", "0")]);
    scene.operation.nodal_diameters = diameters;
    scene.casing.damping_ratio = zeta;
    scene.operation.speed_rad_s = speed;
    scene
}

/// The wave put into the default corner, of blades 6 and 21 for three diameters, turning with the
/// rotor.
fn in_corner(diameters: u32, zeta: f64, speed: f64) -> Scene {
    let mut scene = quiet(diameters, zeta, speed);
    let machine = scene.machine();
    let corner = Corner::paper(&machine.polygon).unwrap();
    let middle = machine.polygon.phase(corner.a) + machine.polygon.delta;
    let amplitude = machine.locked_amplitude().unwrap();
    let nu = machine.nu(speed);
    scene.initial.u_c_m = -amplitude * middle.cos();
    scene.initial.u_s_m = -amplitude * middle.sin();
    scene.initial.v_c_m_s = -nu * scene.initial.u_s_m;
    scene.initial.v_s_m_s = nu * scene.initial.u_c_m;
    scene.checked().unwrap();
    scene
}

/// Rotor speed of the wave over 100 sides, after neighbouring orbits have
/// converged to 1e-12.
fn long_wave_speed(scene: &Scene, orbit: &SlipOrbit) -> f64 {
    let mut motion = Events::new(&scene.checked().unwrap()).unwrap();
    let steady = orbit.period_s * 1e-12_f64.ln() / orbit.slope.ln();
    motion.advance(0.1 + steady).unwrap();
    let mut sides = Vec::new();
    while sides.len() < 102 {
        let limit = 100.0 + steady;
        let time = motion.next_event(limit).unwrap();
        assert!(time < limit, "no slip: {:?}", motion.contacts().active_set);
        if let ActiveSet::Side(side) = motion.contacts().active_set
            && sides.last().is_none_or(|&(last, _)| last != side)
        {
            sides.push((side, time));
        }
    }
    let machine = motion.machine();
    let period = (sides[101].1 - sides[1].1) / 100.0;
    scene.operation.speed_rad_s - 2.0 * machine.polygon.delta / period / machine.nodal_diameters
}

#[test]
fn slip_of_the_map_is_the_long_motion_of_the_event_solver() {
    let scene = scene(&[("casing.damping_ratio", "0.01"), ("operation.pulse_n", "51742")]);
    let orbit = slip_over(&scene.machine(), &[500.0]).unwrap()[0].outcome.unwrap();
    close(long_wave_speed(&scene, &orbit), orbit.wave_speed_rad_s, 1e-10);
    // Flexible blades change the corner and its impulse by some 1e-8.
    let mut moving = scene;
    moving.solver.model = ModelSize::Modal;
    close(long_wave_speed(&moving, &orbit), orbit.wave_speed_rad_s, 1e-7);
}

/// The event solver has no step: with moving blades it comes to rest in the
/// exact form, in all four coordinates and both multipliers.
#[test]
fn event_locked_motion_is_the_modal_form() {
    // Four diameters put two blades on each side.
    for (diameters, speed) in [(3, 420.0), (3, 500.0), (3, 700.0), (4, 500.0), (7, 300.0)] {
        let mut scene = in_corner(diameters, 0.05, speed);
        scene.solver.model = ModelSize::Modal;
        // The blades' start at rest is forgotten after 0.3 s.
        scene.bladed_disk.damping_ratio = 0.5;
        let mut motion = Events::new(&scene.checked().unwrap()).unwrap();
        motion.advance(0.3).unwrap();
        let machine = scene.machine();
        let corner = Corner::paper(&machine.polygon).unwrap();
        assert_eq!(motion.contacts().active_set, ActiveSet::of(&corner.sides()));
        let point = Locked::new(&machine, corner, Form::Modal, true).unwrap().at(speed).unwrap();
        let state = motion.state();
        let turn =
            Complex::new(0.0, -machine.nodal_diameters * motion.rotor().angle(state.t_s)).exp();
        let z = Complex::new(state.u[0], state.u[1]) * turn;
        let expected = Complex::new(point.u_cc_m, point.u_sc_m);
        // An angle of 600 rad rounds off by 1e-13.
        assert!((z - expected).norm() < 1e-12 * expected.norm());
        for (i, (_, multiplier)) in motion.multipliers().into_iter().enumerate() {
            close(multiplier, point.multipliers_n[i], 1e-12);
        }
        for (i, side) in corner.sides().into_iter().enumerate() {
            let (cos, sin) = machine.polygon.direction(side);
            let alpha = cos * state.alpha[0] + sin * state.alpha[1];
            close(alpha, point.alpha_rad[i], 1e-12);
        }
    }
}
