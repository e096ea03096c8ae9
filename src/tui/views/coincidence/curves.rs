//! What view 9 draws: over a range of speeds around both coincidences, how fast a
//! small wave grows and how large it becomes, in closed form (docs/theory.md,
//! section 10).

use crate::tui::axis::nice_step;
use rubscope_solver::harmonic::{CoincidencePoint, coincidence, shifted_coincidence};
use rubscope_solver::model::{Initial, Machine};
use rubscope_solver::scene::{ModelSize, Scene, SolverChoice, View};

/// Speeds over the whole range, and around each coincidence.
const POINTS: u32 = 121;
const POINTS_NEAR: u32 = 81;
/// How far around, in parts of the coincidence.
const NEAR: f64 = 0.15;
/// How far the range reaches beyond both coincidences.
const BEYOND: f64 = 0.25;

/// The curves of one scene.
#[derive(Clone, Debug, PartialEq)]
pub struct CoincidenceCurves {
    /// The range of speeds \[rad/s\].
    pub from: f64,
    /// Its end.
    pub to: f64,
    /// Marked speeds and their names, the slowest first \[rad/s\].
    pub markers: Vec<(f64, &'static str)>,
    /// The points, in order of speed; speeds of a rotor that turns backward are below 0.
    pub points: Vec<CoincidencePoint>,
}

impl CoincidenceCurves {
    /// The curves of a scene; none where the wave has no coincidence.
    pub fn of(scene: &Scene) -> Option<Self> {
        let machine = scene.machine();
        let markers = markers(scene, &machine);
        let (from, to) = range(scene, &markers)?;
        let mut speeds = even(from, to, POINTS);
        for (speed, _) in &markers {
            speeds.extend(even((1.0 - NEAR) * speed, (1.0 + NEAR) * speed, POINTS_NEAR));
        }
        speeds.retain(|speed| (from..=to).contains(speed));
        speeds.sort_by(f64::total_cmp);
        speeds.dedup();
        let sense = if scene.operation.speed_rad_s < 0.0 { -1.0 } else { 1.0 };
        let speeds: Vec<f64> = speeds.into_iter().map(|speed| sense * speed).collect();
        Some(Self { from, to, markers, points: points(scene, &speeds) })
    }

    /// A scene without what these curves do not depend on, to know whether they are old.
    pub fn key(scene: &Scene) -> Scene {
        let mut key = scene.clone();
        let machine = scene.machine();
        let usual = range(&at_rest(scene), &markers(scene, &machine));
        let speed = &mut key.operation.speed_rad_s;
        if usual.is_some_and(|(from, to)| (from..=to).contains(&speed.abs())) {
            *speed = speed.signum();
        }
        (key.operation.pulse_n, key.operation.pulse_s) = (0.0, 0.0);
        key.operation.speed_ramp_rad_s2 = 0.0;
        key.initial = Initial::default();
        let SolverChoice { contact, model, .. } = key.solver;
        key.solver = SolverChoice { contact, model, ..SolverChoice::default() };
        (key.view, key.title, key.note) = (View::default(), String::new(), String::new());
        key
    }
}

fn at_rest(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.operation.speed_rad_s = 0.0;
    scene
}

/// Speeds from one to another, with the same steps.
fn even(from: f64, to: f64, count: u32) -> Vec<f64> {
    let step = (to - from) / f64::from(count - 1);
    (0..count).map(|k| from + f64::from(k) * step).collect()
}

/// Both coincidences, and where blades rub at rest that of the machine on its lining.
fn markers(scene: &Scene, machine: &Machine) -> Vec<(f64, &'static str)> {
    let differences = machine.coincidence_differences().into_iter();
    let mut markers: Vec<_> = differences.map(|speed| (speed, "coincidence (30)")).collect();
    markers.extend(machine.dangerous_speed().map(|speed| (speed, "coincidence (31)")));
    let shifted = shifted_coincidence(scene, scene.operation.speed_rad_s);
    markers.extend(shifted.map(|speed| (speed.abs(), "on the lining")));
    markers.retain(|(speed, _)| speed.is_finite() && *speed > 0.0);
    markers.sort_by(|a, b| a.0.total_cmp(&b.0));
    markers
}

/// A round range of speeds around the marked ones and the present one.
fn range(scene: &Scene, markers: &[(f64, &'static str)]) -> Option<(f64, f64)> {
    let present = Some(scene.operation.speed_rad_s.abs()).filter(|speed| *speed > 0.0);
    let of_interest = || markers.iter().map(|(speed, _)| *speed).chain(present);
    let first = markers.first()?.0;
    let low = of_interest().fold(first, f64::min);
    let high = of_interest().fold(first, f64::max);
    let step = nice_step(high - low, 6).or_else(|| nice_step(high, 6))?;
    let low = (((1.0 - BEYOND) * low) / step).floor() * step;
    Some((low.max(0.0), ((1.0 + BEYOND) * high / step).ceil() * step))
}

/// The point at every speed, of the blades that the model of the scene has; empty where
/// no one wave goes round.
pub fn points(scene: &Scene, speeds: &[f64]) -> Vec<CoincidencePoint> {
    let mut scene = scene.clone();
    match scene.solver.model {
        ModelSize::Rigid => scene.bladed_disk.radial_coupling = 0.0,
        ModelSize::Full => scene.bladed_disk.nodal_diameters = 0,
        ModelSize::Modal => {}
    }
    // A speed without an answer leaves a hole.
    let at = |speed: &f64| coincidence(&scene, &[*speed]).ok()?.first().copied();
    speeds.iter().filter_map(at).collect()
}
