//! Rebounds of the explicit solver beside exact ones, over random scenes, steps and
//! coefficients of restitution: none is lost, and each comes at its time to first order
//! in the step. A new kind of scene is a part of `scenes`.

use crate::random::{each_case, one_of, taken, within};
use fastrand::Rng;
use rubscope_solver::motion::Motion;
use rubscope_solver::scene::{ModelSize, Scene, SolverKind};

/// Steps of one scene, as parts of the shortest.
const STEPS: [f64; 5] = [1.0, 1.11, 1.23, 1.37, 1.58];
/// Relative change of pulse and speed, as a part of a radian of the casing in a step:
/// far more than the scheme makes of one impact.
const CHANGE: f64 = 200.0;

/// Steps in which another side that is as near as the casing moves in them may be met, too.
const NEAR: f64 = 12.0;

/// Instants and sides of the first impacts.
fn impacts(scene: &Scene) -> Vec<(f64, u32)> {
    let mut motion = Motion::new(&scene.checked().unwrap());
    // A run that fails has its impacts until then.
    let _ = motion.advance(scene.solver.end_s);
    motion.contacts().impacts.iter().map(|impact| (impact.t_s, impact.side)).collect()
}

/// The same scene by events; where blades have a slope, which events make linear, by steps
/// of a fiftieth.
fn exactly(mut scene: Scene) -> Scene {
    if scene.bladed_disk.radial_coupling == 0.0 {
        scene.solver.kind = SolverKind::Event;
        if scene.solver.model == ModelSize::Full {
            scene.solver.model = ModelSize::Modal;
        }
    } else {
        scene.solver.step_s *= 0.02;
    }
    scene
}

fn exact(scene: Scene) -> Vec<(f64, u32)> {
    impacts(&exactly(scene))
}

/// Whether only this side is near the casing at an impact: at a corner, steps close what
/// they predict to penetrate, which may be both sides.
fn is_alone(scene: &Scene, t: f64, side: u32) -> bool {
    let mut motion = Motion::new(&exactly(scene.clone()).checked().unwrap());
    let _ = motion.advance(t);
    let (machine, state) = (motion.machine(), motion.state());
    let moved = state.v[0].hypot(state.v[1])
        + machine.nu(scene.operation.speed_rad_s).abs() * machine.clearance();
    let others = (1..).zip(motion.blade_gaps());
    others
        .filter(|(blade, _)| machine.polygon.side_of_blade(*blade) != side)
        .all(|(_, gap)| gap > NEAR * scene.solver.step_s * moved)
}

/// The impacts that slightly other pulses and speeds make too, each well before the next,
/// with how far these move them.
fn certain(scene: &Scene) -> Vec<(f64, u32, f64)> {
    let (step, end) = (scene.solver.step_s, scene.solver.end_s);
    let change = CHANGE * step * scene.machine().omega_c;
    let others = [(change, 0.0), (-change, 0.0), (0.0, change), (0.0, -change)];
    let others = others.map(|(pulse, speed)| {
        let mut other = scene.clone();
        other.operation.pulse_n *= 1.0 + pulse;
        other.operation.speed_rad_s *= 1.0 + speed;
        exact(other)
    });
    let mut found = Vec::new();
    for (k, &(t, side)) in exact(scene.clone()).iter().enumerate().take(4) {
        if !others.iter().all(|hits| hits.get(k).is_some_and(|hit| hit.1 == side)) {
            break;
        }
        let spread = others.iter().map(|hits| (hits[k].0 - t).abs()).fold(0.0, f64::max);
        let alone = |hits: &Vec<(f64, u32)>| {
            let next = hits.get(k + 1).map_or(end, |next| next.0);
            next - hits[k].0 > 60.0 * step + 5.0 * spread
        };
        if !others.iter().all(alone) || !is_alone(scene, t, side) {
            break;
        }
        found.push((t, side, spread));
    }
    found
}

/// How many impacts at all steps have been compared.
fn compare(scene: &Scene) -> usize {
    let expected = certain(scene);
    for part in STEPS {
        let mut stepped = scene.clone();
        stepped.solver.step_s *= part;
        let found = impacts(&stepped);
        for (k, &(t, side, spread)) in expected.iter().enumerate() {
            let allowed = 10.0 * stepped.solver.step_s + 4.0 * spread;
            let hit = found.iter().any(|hit| hit.1 == side && (hit.0 - t).abs() < allowed);
            assert!(
                hit,
                "impact {k} on side {side} at {t} +- {allowed:e}: {found:?} {:?} {:?} {:?}",
                stepped.solver, stepped.contact, stepped.operation
            );
        }
    }
    STEPS.len() * expected.len()
}

fn scenes(rng: &mut Rng, inclined: bool) -> Scene {
    let mut scene = Scene::base();
    let shapes = [(22, 3), (22, 4), (7, 2), (40, 3)];
    (scene.bladed_disk.blades, scene.operation.nodal_diameters) = one_of(rng, &shapes);
    scene.solver.model = one_of(rng, &[ModelSize::Rigid, ModelSize::Modal, ModelSize::Full]);
    scene.bladed_disk.radial_coupling = if inclined { within(rng, 0.05..0.5) } else { 0.0 };
    scene.operation.speed_rad_s = within(rng, 100.0..600.0);
    scene.operation.pulse_n = within(rng, 5e3..2e5);
    scene.casing.damping_ratio = within(rng, 0.0..0.06);
    // Blades that friction bends are not quite where events have them.
    let rubs = scene.solver.model == ModelSize::Rigid || inclined;
    scene.contact.friction = if rubs { within(rng, 0.0..0.3) } else { 0.0 };
    scene.casing.tangential_ratio = 0.3;
    scene.contact.restitution = within(rng, 0.05..0.95);
    scene.solver.step_s = within(rng, 1e-7..3.5e-7);
    scene.solver.end_s = if inclined { 6e-4 } else { 2.5e-3 };
    scene
}

/// Compares scenes until so many have had an impact that is certain.
fn compare_all(cases: u64, inclined: bool) {
    each_case(cases, |rng| {
        taken(|| compare(&scenes(rng, inclined)), |compared| *compared > 0);
    });
}

#[test]
fn no_rebound_is_lost_or_late() {
    compare_all(40, false);
}

#[test]
fn no_rebound_of_bending_tips_is_lost_or_late() {
    compare_all(4, true);
}

#[test]
fn a_target_that_binds_at_an_open_gap_is_met() {
    // Steps at which the dip of the step before the last asks for more than the gap has.
    for (e, step, t) in [(0.7, 1e-6, 845e-6), (0.8, 1e-6, 766e-6), (0.9, 1.14e-6, 706e-6)] {
        let mut scene = Scene::base();
        scene.solver.model = ModelSize::Rigid;
        (scene.contact.restitution, scene.solver.step_s) = (e, step);
        scene.solver.end_s = 3e-3;
        let second = impacts(&scene)[1];
        let blade = scene.machine().polygon.blades_of_side(second.1);
        assert!((second.0 - t).abs() < 6.0 * step && blade == [22], "{e}: {second:?}");
    }
}
