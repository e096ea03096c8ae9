//! Scenes for comparisons: changes to the default, and starts in a corner.

use rubscope_solver::scene::Scene;

pub const LAWS: [&str; 2] = ["unilateral", "bilateral"];
pub const MODELS: [&str; 3] = ["rigid", "modal", "full"];

/// A millisecond of the paper's machine takes 1000 steps, unless changed.
pub fn scene(changes: &[(&str, &str)]) -> Scene {
    let all = [&[("solver.step_s", "1e-6"), ("solver.end_s", "0.1")], changes].concat();
    Scene::base().with(&all).unwrap_or_else(|error| panic!("{changes:?}: {error}")).into_scene()
}

/// Puts the casing into the corner of sides 0 and 1, turning with the blades,
/// without a pulse.
pub fn in_corner(mut scene: Scene) -> Scene {
    let machine = scene.machine();
    let angle = machine.polygon.delta;
    let amplitude = machine.clearance() / machine.polygon.delta.cos();
    let (x, y) = (-amplitude * angle.cos(), -amplitude * angle.sin());
    let nu = machine.nu(scene.operation.speed_rad_s);
    scene.operation.pulse_n = 0.0;
    (scene.initial.u_c_m, scene.initial.u_s_m) = (x, y);
    (scene.initial.v_c_m_s, scene.initial.v_s_m_s) = (-nu * y, nu * x);
    assert!(scene.checked().is_ok(), "{:?}", scene.checked());
    scene
}
