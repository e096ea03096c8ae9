//! The curves of view 9: growth rate of a small wave and amplitude of the limit cycle, over a speed
//! range around both coincidences (docs/theory.md, section 10). They are closed forms, except on a
//! lining, where each point is a search.

use super::speeds::Speeds;
use crate::sheet::hbm::coincidence::add_points;
use crate::sheet::ticks::linspace;
use crate::tui::axis::nice_step;
use crate::tui::views::id::ViewId;
use rubscope_solver::harmonic::{CoincidencePoint, coincidence, shifted_coincidence};
use rubscope_solver::model::Machine;
use rubscope_solver::scene::{ModelSize, Scene};

/// Number of equally spaced speeds over the whole range.
const POINTS: usize = 121;
/// Number of further speeds around each coincidence.
const POINTS_NEAR: usize = 81;
/// Half width of the finely sampled range around a coincidence, relative to it.
const NEAR: f64 = 0.15;
/// Margin of the speed range beyond the outermost marked speeds, relative to them.
const BEYOND: f64 = 0.25;

/// Growth and amplitude of the wave over speed, for one scene.
#[derive(Clone, Debug)]
pub struct CoincidenceCurves {
    /// The speeds around the coincidences, and the panels of the points.
    pub speeds: Speeds,
    /// Points in order of |speed|; speeds are negative if the rotor turns backward.
    pub points: Vec<CoincidencePoint>,
}

impl CoincidenceCurves {
    /// Computes the curves of a scene; `None` if the wave has no coincidence.
    pub fn of(scene: &Scene) -> Option<Self> {
        let machine = scene.machine();
        let markers = markers(scene, &machine);
        let (from, to) = range(scene.operation.speed_rad_s, &markers)?;
        let mut speeds = linspace(from, to, POINTS);
        for (speed, _) in &markers {
            speeds.extend(linspace((1.0 - NEAR) * speed, (1.0 + NEAR) * speed, POINTS_NEAR));
        }
        speeds.retain(|speed| (from..=to).contains(speed));
        speeds.sort_by(f64::total_cmp);
        speeds.dedup();
        let sense = if scene.operation.speed_rad_s < 0.0 { -1.0 } else { 1.0 };
        let speeds: Vec<f64> = speeds.into_iter().map(|speed| sense * speed).collect();
        let points = points(scene, &speeds);
        let (view, range, marks) = (ViewId::Coincidence, [from, to], markers);
        let speeds = Speeds { view, range, marks, panels: Vec::new() };
        let speeds = speeds.with_panels(scene, |sheet| add_points(&points, "", sheet));
        Some(Self { speeds, points })
    }

    /// Returns what the curves of a scene follow from: equal keys have equal curves. A speed inside
    /// the usual range counts by its sign.
    pub fn key(scene: &Scene) -> (Machine, ModelSize, f64) {
        let (machine, speed) = (scene.machine(), scene.operation.speed_rad_s);
        let usual = range(0.0, &markers(scene, &machine));
        let is_usual = usual.is_some_and(|(from, to)| (from..=to).contains(&speed.abs()));
        (machine, scene.solver.model, if is_usual { speed.signum() } else { speed })
    }
}

/// Returns both coincidences, and that of the machine on its lining if the blades rub at rest.
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

/// Returns a rounded speed range around the marked speeds and the speed `now`, as magnitudes
/// \[rad/s\]; `None` without a marked speed.
fn range(now: f64, markers: &[(f64, &'static str)]) -> Option<(f64, f64)> {
    let present = Some(now.abs()).filter(|speed| *speed > 0.0);
    let of_interest = || markers.iter().map(|(speed, _)| *speed).chain(present);
    let first = markers.first()?.0;
    let low = of_interest().fold(first, f64::min);
    let high = of_interest().fold(first, f64::max);
    let step = nice_step(high - low, 6).or_else(|| nice_step(high, 6))?;
    let low = (((1.0 - BEYOND) * low) / step).floor() * step;
    Some((low.max(0.0), ((1.0 + BEYOND) * high / step).ceil() * step))
}

/// Computes the point at every speed for the blade model of the scene. Speeds without a solution
/// are left out; the result is empty if the disk has other nodal diameters than the casing.
pub fn points(scene: &Scene, speeds: &[f64]) -> Vec<CoincidencePoint> {
    let mut scene = scene.clone();
    match scene.solver.model {
        ModelSize::Rigid => scene.bladed_disk.radial_coupling = 0.0,
        ModelSize::Full => scene.bladed_disk.nodal_diameters = 0,
        ModelSize::Modal => {}
    }
    // A speed without a solution leaves a gap in the curve.
    let at = |speed: &f64| coincidence(&scene, &[*speed]).ok()?.first().copied();
    speeds.iter().filter_map(at).collect()
}
