//! Scenes for comparisons: changes to the default, and starts in a corner.

use crate::random::taken;
use crate::tips_support::carried;
use fastrand::Rng;
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
    let amplitude = machine.clearance() / angle.cos();
    carried(&mut scene, [angle.cos(), angle.sin()].map(|part| -amplitude * part));
    scene
}

/// A scene of a kind that the solver takes.
pub fn taken_scene(rng: &mut Rng, any: fn(&mut Rng) -> Scene) -> Scene {
    let scene = taken(|| any(rng), |scene| scene.checked().is_ok());
    println!("{scene:?}");
    scene
}
