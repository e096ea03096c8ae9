//! What the tests of the solvers beyond the paper share: scenes in few words, a start
//! in a corner, and limits as the step goes to zero.

pub use crate::keys::{END, KAPPA, MU, PULSE, SPEED, STEP, TAU, ZETA as ZETA_C, ZETA_BD};
use rubscope_solver::motion::{Motion, State};
use rubscope_solver::scene::Scene;

/// The paper's machine, 22 blades and 3 diameters, unilateral, with some keys set.
pub fn scene(changes: &[(&str, f64)]) -> Scene {
    let mut scene = Scene::base();
    for (key, value) in changes {
        scene.set(key, &format!("{value:?}")).unwrap();
    }
    scene
}

/// All blades press on a soft lining by 20 micrometres.
pub fn pressed(changes: &[(&str, f64)]) -> Scene {
    let lining = [
        ("casing.radius_m", 0.49988),
        ("contact.stiffness_n_per_m", 27e3),
        ("contact.smoothing_m", 1e-6),
        (PULSE, 100.0),
        (KAPPA, 0.5),
        (STEP, 5e-6),
    ];
    let mut scene = scene(&[&lining, changes].concat());
    scene.set("solver.contact", "smooth").unwrap();
    scene
}

/// A start in the corner of blades 6 and 21, turning with the rotor, where blades soon
/// come to rest.
pub fn in_corner(mut scene: Scene) -> Scene {
    let resting = scene.machine();
    let machine = resting.at(scene.operation.speed_rad_s);
    let angle = machine.polygon.phase(15) + machine.polygon.delta;
    let amplitude = machine.clearance() / machine.polygon.delta.cos() * (1.0 - 1e-12);
    carried(&mut scene, [angle.cos(), angle.sin()].map(|part| -amplitude * part));
    scene.bladed_disk.damping_ratio = 1.0;
    scene
}

/// A start at a place of the casing that the rotor carries, without a pulse.
pub fn carried(scene: &mut Scene, [x, y]: [f64; 2]) {
    let nu = scene.machine().nu(scene.operation.speed_rad_s);
    (scene.initial.u_c_m, scene.initial.u_s_m) = (x, y);
    (scene.initial.v_c_m_s, scene.initial.v_s_m_s) = (-nu * y, nu * x);
    scene.operation.pulse_n = 0.0;
}

/// A start on side 0, or in its corner with the next, carried by the rotor.
pub fn on_side_0(scene: &mut Scene, corner: bool, pace: f64) {
    let machine = scene.machine();
    let y = if corner { -machine.polygon.half_side() } else { 0.0 };
    carried(scene, [-machine.clearance(), y]);
    scene.initial.v_s_m_s += pace;
}

/// The state at the end.
pub fn state(scene: &Scene) -> State {
    let mut motion = Motion::new(&scene.checked().unwrap());
    motion.advance(scene.solver.end_s).unwrap();
    motion.state()
}

/// The four coordinates at the end.
pub fn coordinates(scene: &Scene) -> [f64; 4] {
    let State { u, alpha, .. } = state(scene);
    [u[0], u[1], alpha[0], alpha[1]]
}

/// The limit of values at the steps `h`, `h/2` and `h/4` whose error is a series in `h`
/// that begins with this order.
pub fn limit(order: i32, values: [f64; 3]) -> f64 {
    let once = |k: usize| {
        let factor = 2_f64.powi(order);
        (factor * values[k + 1] - values[k]) / (factor - 1.0)
    };
    // A scheme of even order has no odd terms.
    let factor = 2_f64.powi(if order == 1 { 2 } else { order + 2 });
    (factor * once(1) - once(0)) / (factor - 1.0)
}
