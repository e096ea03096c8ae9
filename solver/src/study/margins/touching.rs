//! The smallest pulse that makes a blade touch, to the last digit, and its derivatives. Until that
//! contact the casing motion has a closed form ([`FreeFlight`]).

use std::f64::consts::TAU;

use super::parameters::{largest, parameter};
use super::sensitivity::CHANGE;
use crate::model::{Excitation, Initial, Machine};
use crate::motion::FreeFlight;
use crate::numeric::search::bisected;
use crate::scene::keys::PULSE;
use crate::scene::{ModelSize, Scene};

/// Sampling step of the search for the instant at which the casing comes nearest: the part of half a
/// side that the wave passes, and the casing's phase angle \[rad\], in one step. With a larger one
/// several extrema could lie between two samples.
const TOUCHING_STEP: f64 = 0.25;

/// Number of casing periods after which the search for the first touch ends. It bounds the time for
/// an undamped casing to about 10 ms, but a blade that comes nearer later is missed.
const TOUCHING_PERIODS: f64 = 1000.0;

/// The smallest pulse that makes a blade touch, with the time and the side of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstTouch {
    /// Force of the pulse \[N\].
    pub pulse_n: f64,
    /// Time of the contact \[s\].
    pub t_s: f64,
    /// Side that is touched.
    pub side: u32,
}

/// Change of the angles of blades and casing at the touch up to which the force is a smooth function
/// of a parameter \[rad\].
const MOST_TURN: f64 = 0.02;

impl FirstTouch {
    /// Returns the force that closes the gap of the same side at the same instant in another scene
    /// \[N\].
    pub(super) fn force_in(&self, scene: &Scene) -> f64 {
        let flight = FreeFlight { machine: &scene.machine(), operation: &scene.operation };
        force(&flight, self.side, self.t_s)
    }

    /// Returns the relative change of a parameter from which a sensitivity is computed. It is smaller
    /// for a late touch, because it may alter the angles of blades and casing there by at most
    /// `MOST_TURN`.
    pub(super) fn change(&self, scene: &Scene) -> f64 {
        let (machine, operation) = (scene.machine(), &scene.operation);
        let gained = operation.speed_ramp_rad_s2.abs() * self.t_s;
        let fastest = machine.nu(operation.speed_rad_s.abs() + gained) + machine.omega_c;
        CHANGE.min(MOST_TURN / (fastest * self.t_s))
    }
}

/// Returns the smallest pulse force that makes a blade touch, for the scene's pulse duration and
/// rigid blades, with the sign of `most` \[N\]. `None` if no pulse up to `most` touches within the
/// run, without a clearance, for unequal tips or an out-of-round casing, and if the casing does not
/// start from rest.
#[must_use]
pub fn grazing_pulse(scene: &Scene, most: f64) -> Option<f64> {
    first_touch(scene, most).map(|touch| touch.pulse_n)
}

/// As [`grazing_pulse`], with time and place of the contact.
#[must_use]
pub fn first_touch(scene: &Scene, most: f64) -> Option<FirstTouch> {
    let sense = 1_f64.copysign(most);
    least(scene, sense).filter(|touch| touch.pulse_n.abs() <= most.abs())
}

/// Returns the smallest pulse that makes a blade touch, with the sign of the scene's pulse; `None` as
/// in [`grazing_pulse`], with the largest pulse that the key allows.
pub(super) fn smallest(scene: &Scene) -> Option<FirstTouch> {
    let most = parameter(PULSE).map_or(f64::MAX, largest);
    first_touch(scene, if scene.operation.pulse_n < 0.0 { -most } else { most })
}

/// Returns whether there is a clearance, tips are equal, the casing is round and starts at rest at
/// the centre, and the event solver supports the scene with rigid blades.
fn starts_at_rest(scene: &Scene) -> bool {
    let mut scene = scene.as_reference();
    scene.solver.model = ModelSize::Rigid;
    scene.excitation = Excitation::default();
    let machine = scene.machine();
    machine.clearance() > 0.0
        && !machine.is_uneven()
        && scene.initial == Initial::default()
        && scene.checked().is_ok()
}

/// Returns the time after which no swing can come closer to a blade than an earlier one \[s\]: the
/// decay then exceeds the factor `1/cos delta` by which the distance depends on the direction.
fn longest(scene: &Scene, machine: &Machine) -> f64 {
    let period = TAU / machine.omega_c;
    let hidden = -machine.polygon.delta.cos().max(0.0).ln();
    let fades = hidden / (machine.casing_damping_ratio * machine.omega_c);
    let most = TOUCHING_PERIODS * period;
    // Without damping there is no decay, and with fewer than three sides the factor is infinite.
    let wait = if fades.is_finite() { fades.min(most) } else { most };
    (scene.operation.pulse_s + period + wait).min(scene.solver.end_s)
}

/// Component of the casing position toward the nearest side at an instant, per unit of pulse force
/// \[m/N\].
#[derive(Clone, Copy)]
struct Sample {
    t: f64,
    near: f64,
    side: u32,
}

/// Finds the smallest pulse of one sign that makes a blade touch, which corresponds to the largest
/// component toward a side per unit force: samples at steps of [`TOUCHING_STEP`], and refines each
/// maximum.
fn least(scene: &Scene, sense: f64) -> Option<FirstTouch> {
    if !starts_at_rest(scene) {
        return None;
    }
    let machine = scene.machine();
    let (polygon, operation) = (&machine.polygon, &scene.operation);
    let flight = FreeFlight { machine: &machine, operation };
    let sample = |t: f64| {
        let [(moved, turn), _] = flight.moved_by_pulse(t);
        let (sin, cos) = turn.sin_cos();
        let [x, y] = [cos, -sin].map(|part| sense * moved * part);
        let side = polygon.nearest_side(x, y);
        let (c, s) = polygon.direction(side);
        Sample { t, near: -(x * c + y * s), side }
    };
    let end = longest(scene, &machine);
    let speeds = [0.0, end].map(|t| operation.speed_rad_s + operation.speed_ramp_rad_s2 * t);
    let turning = machine.nu(speeds[0].abs().max(speeds[1].abs())) / polygon.delta;
    let step = TOUCHING_STEP / turning.max(machine.omega_c);
    let mut found: Option<FirstTouch> = None;
    let (mut before, mut now) = (0.0, sample(0.0));
    let mut place = 0.0;
    while before < now.near || now.t < end {
        place += 1.0;
        let ahead = sample((place * step).min(end));
        // A sampled instant underestimates the maximum by less than the square of a step.
        let most = now.near * (1.0 + TOUCHING_STEP * TOUCHING_STEP);
        let best = found.map_or(0.0, |touch| machine.clearance() / touch.pulse_n.abs());
        if now.near > before && now.near >= ahead.near && most > best {
            let touch = polished(&flight, now, sense, [step, end]);
            let nearer = |known: &FirstTouch| known.pulse_n.abs() <= touch.pulse_n.abs();
            found = found.filter(nearer).or(Some(touch));
        }
        (before, now) = (now.near, ahead);
    }
    found
}

/// Returns the force that exactly closes the gap of a side at one instant.
fn force(flight: &FreeFlight<'_>, side: u32, t: f64) -> f64 {
    -flight.machine.clearance() / flight.gap_by_pulse(side, t)[0]
}

/// Refines the instant, up to the `end`, at which the casing comes nearest to the side, which is the
/// zero of its rate within a `step` of the sample. If there is no zero, the sample is returned.
fn polished(flight: &FreeFlight<'_>, at: Sample, sense: f64, [step, end]: [f64; 2]) -> FirstTouch {
    let side = at.side;
    let opens = |t: f64| sense * flight.gap_by_pulse(side, t)[1] >= 0.0;
    let (early, late) = ((at.t - step).max(0.5 * at.t), (at.t + step).min(end));
    let is_nearest = !opens(early) && opens(late);
    let t_s = if is_nearest { bisected([early, late], opens)[1] } else { at.t };
    FirstTouch { pulse_n: force(flight, side, t_s), t_s, side }
}

/// Explains why no pulse touches.
pub(super) fn why_none(scene: &Scene) -> &'static str {
    let machine = scene.machine();
    let touches = |side| machine.apothem(side) < machine.out_of_round();
    if machine.clearance() <= 0.0 {
        "all blades touch without a pulse"
    } else if (0..machine.polygon.sides).any(touches) {
        "a tip touches without a pulse"
    } else if machine.is_uneven() {
        "it is computed for equal tips in a round casing only"
    } else if scene.casing.clearance_loss_m_s2 != 0.0 && scene.operation.speed_ramp_rad_s2 != 0.0 {
        "it is computed for a constant speed only if the clearance changes with speed"
    } else if scene.initial == Initial::default() {
        "no pulse of this length touches within the run"
    } else {
        "it is computed for a casing that starts at rest only"
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Of four sides the wave meets corners first and drifts into a side in a hundred half swings, or
    /// in many more without damping. A ramp passes sides faster and faster.
    #[test]
    fn no_instant_of_the_run_needs_a_smaller_pulse() {
        let mut scenes = Vec::new();
        for (damping, drift) in [(0.0, 5e-4), (3e-4, 3e-3)] {
            let mut few = Scene::base();
            (few.bladed_disk.blades, few.operation.nodal_diameters) = (4, 1);
            (few.casing.damping_ratio, few.solver.end_s) = (damping, 8.0);
            few.operation.speed_rad_s = few.machine().omega_c * (0.5 - drift / PI);
            scenes.push(few);
        }
        scenes.extend([3e5, 1e6, 1e7, 3e7].map(|ramp| {
            let mut scene = Scene::base();
            (scene.operation.speed_rad_s, scene.operation.speed_ramp_rad_s2) = (50.0, ramp);
            scene
        }));
        for scene in scenes {
            let found = least(&scene, 1.0).unwrap().pulse_n;
            let machine = scene.machine();
            let flight = FreeFlight { machine: &machine, operation: &scene.operation };
            let ends = [longest(&scene, &machine), scene.solver.end_s];
            let looks =
                ends.iter().flat_map(|end| (1..=20_000).map(move |k| end * f64::from(k) / 2e4));
            let sides = 0..machine.polygon.sides;
            let forces = looks.flat_map(|t| sides.clone().map(move |side| (side, t)));
            let forces = forces.map(|(side, t)| force(&flight, side, t)).filter(|f| *f > 0.0);
            let least = forces.fold(f64::INFINITY, f64::min);
            assert!(found <= least * (1.0 + 1e-9), "{:?}: {found} {least}", scene.operation);
        }
    }
}
