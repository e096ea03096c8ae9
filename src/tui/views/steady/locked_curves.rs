//! The curves of view 3 over a rounded speed range: the locked motion from the harmonic balance,
//! with and without damping, and, with radial coupling, the multiplier of the stable whirl.

use super::speeds::Speeds;
use crate::sheet::hbm::locked::add_points;
use crate::sheet::line::blades;
use crate::tui::axis::nice_step;
use crate::tui::views::id::ViewId;
use rubscope_solver::harmonic::{Form, LockedPoint, RoundWhirl, SpeedRanges, Sweep, locked_motion};
use rubscope_solver::model::Machine;
use rubscope_solver::scene::{ContactLaw, Scene};
use rubscope_solver::study::figures::{Series, Style};

/// Number of speeds per curve.
const POINTS: u32 = 161;

/// Style of the multipliers without damping.
pub const UNDAMPED: Style = Style::Dotted(0);

/// Multipliers over speed of one machine.
#[derive(Clone, Debug)]
pub struct LockedCurves {
    /// The speeds from 0 on, and the panels of the damped motion. The first one has the
    /// multipliers, also those of the stable whirl, and dotted those without damping, as in the
    /// paper, if there is casing damping, friction or an inclined tip.
    pub speeds: Speeds,
    /// The locked motion with the damping of the scene; `None` if the machine has no locked motion.
    pub damped: Option<Sweep>,
    /// Magnitude of the speed up to which the scales include the values \[rad/s\]. Beyond it the
    /// locked motion can have a resonance of casing and blades, which would flatten the rest.
    pub scaled_to: f64,
}

impl LockedCurves {
    /// Computes the curves of a scene.
    pub fn of(scene: &Scene) -> Self {
        let machine = scene.machine();
        let fastest = speed_range(scene, scene.operation.speed_rad_s);
        let step = fastest / f64::from(POINTS - 1);
        // A rotor that turns backward has its own locked motion, drawn over |Ω|.
        let sense = scene.operation.speed_rad_s.signum();
        let at: Vec<f64> = (0..POINTS).map(|k| sense * f64::from(k) * step).collect();
        let open = machine.clearance_at_rest() > 0.0;
        let curve = |damped| {
            open.then(|| locked_motion(&machine, Form::Modal, damped, None, &at).ok()).flatten()
        };
        let has_damping = machine.casing_damping > 0.0 || machine.tips_incline_or_rub();
        let damped = curve(true);
        let undamped = has_damping.then(|| curve(false)).flatten();
        let (range, marks) = ([0.0, fastest], marks(scene, &machine));
        let speeds = Speeds { view: ViewId::Locked, range, marks, panels: Vec::new() };
        let mut speeds = speeds.with_panels(scene, |sheet| {
            damped.iter().for_each(|damped| add_points(&damped.points, sheet));
        });
        if let Some((damped, panel)) = damped.as_ref().zip(speeds.panels.first_mut()) {
            let series = &mut panel.series;
            if machine.has_unequal_tips() {
                for (series, side) in series.iter_mut().zip(damped.corner.sides()) {
                    series.label += &format!(" {}", blades(&machine.first_of_side(side)));
                }
            } else if undamped.is_none() {
                // Without damping, equal tips have equal multipliers: one curve is enough.
                series.truncate(1);
                series.iter_mut().for_each(|series| series.label = "λ".into());
            }
            let whirl = Series::new("whirl", Style::Dashed(2), whirl(scene, &machine, &at));
            series.extend(Some(whirl).filter(|whirl| !whirl.points.is_empty()));
            let of = |point: &LockedPoint| (point.speed_rad_s, point.multipliers_n[0]);
            let undamped = undamped.iter().map(|sweep| sweep.points.iter().map(of));
            series.extend(undamped.map(|points| Series::new("undamped", UNDAMPED, points)));
        }
        Self { speeds, damped, scaled_to: scaled_to(scene, &machine).unwrap_or(fastest) }
    }

    /// Returns whether the scales include the values at a speed \[rad/s\].
    pub fn scales(&self, speed: f64) -> bool {
        speed.abs() <= self.scaled_to
    }
}

/// Returns the magnitude of the speed \[rad/s\] and the mean multiplier \[N\] of the stable whirl,
/// for every speed that has one; negative pushes. Computed in the limit of many blades. Empty
/// without radial coupling, with rigid blades or a lining, and for unequal tips or a casing out of
/// round, where no closed form is known.
fn whirl(scene: &Scene, machine: &Machine, speeds: &[f64]) -> Vec<(f64, f64)> {
    let open = machine.clearance_at_rest() > 0.0;
    let rigid = scene.solver.contact != ContactLaw::Smooth && open;
    if !rigid || !scene.is_coupled() || machine.is_uneven() {
        return Vec::new();
    }
    let push = |speed: &f64| {
        let wave = RoundWhirl::lasting(machine, *speed)?;
        Some((speed.abs(), -wave.stiffness_n_per_m * machine.at(*speed).clearance()))
    };
    speeds.iter().filter_map(push).collect()
}

/// Returns the threshold speeds of a scene \[rad/s\], with their labels. With radial coupling a
/// lock can also have an upper threshold, and rest a flutter speed.
fn marks(scene: &Scene, machine: &Machine) -> Vec<(f64, &'static str)> {
    let toward = scene.operation.speed_rad_s;
    let ranges = SpeedRanges::new(machine, toward);
    let window = ranges.locks().first().copied();
    let shown = machine.lining.is_none() && scene.is_coupled();
    let flutter = ranges.flutters().first().map(|range| range.from);
    let coincide = machine.locks_from_critical_speed();
    let mut marks: Vec<(f64, &'static str)> = [
        (machine.critical_speed(), if coincide { "Ω_c = Ω_lock" } else { "Ω_c" }),
        (window.map(|window| window.from).filter(|_| !coincide), "Ω_lock"),
        (window.and_then(|window| window.to), "lock ends"),
        (flutter.filter(|_| shown), "Ω_f"),
        (machine.dangerous_speed(), "coincidence"),
    ]
    .into_iter()
    .filter_map(|(speed, name)| Some((speed?, name)))
    .collect();
    marks.sort_by(|a, b| a.0.total_cmp(&b.0));
    marks
}

/// Returns a speed slightly above the marked speeds, except the flutter speed, and the current one
/// \[rad/s\]; `None` without radial coupling.
fn scaled_to(scene: &Scene, machine: &Machine) -> Option<f64> {
    if machine.radial_coupling == 0.0 {
        return None;
    }
    let ends = marks(scene, machine).into_iter().filter(|(_, name)| *name != "Ω_f");
    let present = scene.operation.speed_rad_s.abs();
    Some(BESIDE * ends.map(|(speed, _)| speed).fold(present, f64::max))
}

/// The scales include the values up to 5 % past the last marked speed.
const BESIDE: f64 = 1.05;
/// The range extends to a marked speed, such as a lock's upper threshold, if that is at most this
/// many times the highest speed without it.
const FURTHER: f64 = 1.6;

/// Returns a rounded speed above the thresholds and the speed `now` \[rad/s\].
pub fn speed_range(scene: &Scene, now: f64) -> f64 {
    let machine = scene.machine();
    let of_interest = [machine.lock_speed(), machine.dangerous_speed(), Some(now.abs())];
    let most = of_interest.into_iter().flatten().filter(|s| s.is_finite()).fold(1.0, f64::max);
    // The upper end of a lock can be far away.
    let ends = marks(scene, &machine).into_iter().map(|(speed, _)| speed);
    let most = ends.filter(|speed| *speed <= FURTHER * most).fold(most, f64::max);
    let step = nice_step(most * 1.1, 6).unwrap_or(most);
    (most * 1.05 / step).ceil() * step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curves_reach_beyond_every_threshold_and_meet_the_closed_form() {
        let scene = Scene::base();
        let curves = LockedCurves::of(&scene);
        let machine = scene.machine();
        assert!(
            curves.speeds.range[1] > 500.0
                && curves.speeds.range[1] > machine.lock_speed().unwrap()
        );
        let last = *curves.damped.unwrap().points.last().unwrap();
        let closed = machine.locked_multipliers(curves.speeds.range[1]).unwrap();
        for (lambda, exact) in last.multipliers_n.iter().zip(closed) {
            // Flexible blades change a multiplier by a few parts in a million.
            assert!((lambda - exact).abs() < 1e-4 * exact.abs(), "{lambda} {exact}");
        }
        let undamped = LockedCurves::of(&scene.with(&[("casing.damping_ratio", "0")]).unwrap());
        let names: Vec<&str> = undamped.speeds.marks.iter().map(|(_, name)| *name).collect();
        assert_eq!(names, ["Ω_c = Ω_lock", "coincidence"]);
    }

    #[test]
    fn a_wave_without_corners_has_no_curves() {
        let mut scene = Scene::base();
        scene.operation.nodal_diameters = 11;
        assert_eq!(LockedCurves::of(&scene).damped, None);
    }
}
