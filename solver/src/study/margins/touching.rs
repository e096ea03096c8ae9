//! The smallest pulse that makes a blade touch, to the last digit, and its derivatives. Until that
//! contact the casing motion has a closed form ([`FreeFlight`]).

use std::f64::consts::TAU;

use super::limit::{Limit, LimitName, Sensitivities};
use super::parameters::{Parameter, acting, parameter};
use super::sensitivity::{CHANGE, sensitivities};
use crate::model::{Excitation, Initial, Machine};
use crate::motion::FreeFlight;
use crate::numeric::bisection::bisected;
use crate::scene::keys::PULSE;
use crate::scene::{CheckedScene, ModelSize, Scene};
use crate::tolerances::{SWING_LOOKS, TOUCHING_LOOK, TOUCHING_PERIODS};

/// The smallest pulse that makes a blade touch, with time and place of the contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstTouch {
    /// Force of the pulse \[N\].
    pub pulse_n: f64,
    /// Time of the contact \[s\].
    pub t_s: f64,
    /// Side that is touched.
    pub side: u32,
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

/// Returns the smallest pulse that touches, with the sign of the scene's pulse; `None` as in
/// [`grazing_pulse`], with the largest pulse that the key allows.
pub(super) fn smallest(scene: &Scene) -> Option<FirstTouch> {
    let most = parameter(PULSE).map_or(f64::MAX, Parameter::largest);
    first_touch(scene, if scene.operation.pulse_n < 0.0 { -most } else { most })
}

/// Returns whether there is a clearance, tips are equal, the casing is round and starts at rest at
/// the centre, and the event solver supports the scene with rigid blades.
fn starts_at_rest(scene: &Scene) -> bool {
    let mut scene = scene.as_reference();
    scene.solver.model = ModelSize::Rigid;
    scene.excitation = Excitation::default();
    scene.machine().clearance() > 0.0
        && !scene.is_uneven()
        && scene.initial == Initial::default()
        && scene.checked().is_ok()
}

/// Returns the time until which a later swing can come closer to a blade than an earlier one \[s\]:
/// after that the decay exceeds the factor `1/cos delta` by which the distance depends on the
/// direction.
fn longest(scene: &Scene, machine: &Machine) -> f64 {
    let period = TAU / machine.omega_c;
    let hidden = -machine.polygon.delta.cos().max(0.0).ln();
    let fades = hidden / (machine.casing_damping_ratio * machine.omega_c);
    let most = TOUCHING_PERIODS * period;
    // Without damping there is no decay, and with fewer than three sides the factor is infinite.
    let wait = if fades.is_finite() { fades.min(most) } else { most };
    (scene.operation.pulse_s + period + wait).min(scene.solver.end_s)
}

/// Casing position at an instant, per unit of pulse force \[m/N\].
#[derive(Clone, Copy)]
struct Look {
    t: f64,
    /// Distance from the centre, and its component toward the nearest side.
    moved: f64,
    near: f64,
    side: u32,
}

/// Finds the smallest pulse of one sign that touches, which corresponds to the largest component
/// toward a side per unit force.
///
/// That component is at most the distance from the centre, and at least the distance times
/// `cos delta`. So only instants matter at which the distance exceeds the best component so far;
/// the time until then is skipped, using the highest possible velocity.
fn least(scene: &Scene, sense: f64) -> Option<FirstTouch> {
    if !starts_at_rest(scene) {
        return None;
    }
    let machine = scene.machine();
    let (polygon, operation) = (&machine.polygon, &scene.operation);
    let flight = FreeFlight { machine: &machine, operation };
    let look = |t: f64| {
        let [(moved, turn), _] = flight.moved_by_pulse(t);
        let (sin, cos) = turn.sin_cos();
        let [x, y] = [cos, -sin].map(|part| sense * moved * part);
        let side = polygon.nearest_side(x, y);
        let (c, s) = polygon.direction(side);
        Look { t, moved: moved.abs(), near: -(x * c + y * s), side }
    };
    let end = longest(scene, &machine);
    let swing = end.min(operation.pulse_s + TAU / machine.omega_c);
    let looks = (1..=SWING_LOOKS).map(|k| look(swing * f64::from(k) / f64::from(SWING_LOOKS)));
    let furthest = looks.fold(0.0, |most: f64, look| most.max(look.moved));
    let mut best = furthest * polygon.delta.cos().max(0.0);
    let speeds = [0.0, end].map(|t| operation.speed_rad_s + operation.speed_ramp_rad_s2 * t);
    let turning = machine.nu(speeds[0].abs().max(speeds[1].abs())) / polygon.delta;
    let step = TOUCHING_LOOK / turning.max(machine.omega_c);
    let fastest = operation.pulse_s / machine.casing_mass;
    let mut found: Option<FirstTouch> = None;
    let (mut before, mut now) = (0.0, look(0.0));
    while now.t < end {
        let passed = (best - now.moved) / fastest - step;
        let ahead = look((now.t + passed.max(step)).min(end));
        let is_nearest = now.near > before && now.near >= ahead.near;
        let last = (ahead.t == end && ahead.near > now.near).then_some(ahead);
        for look in is_nearest.then_some(now).into_iter().chain(last) {
            // A sampled instant underestimates the maximum by less than the square of a step.
            if look.near > 0.0 && look.near * (1.0 + TOUCHING_LOOK * TOUCHING_LOOK) >= best {
                let touch = polished(&flight, look, sense, [step, end]);
                best = best.max(machine.clearance() / touch.pulse_n.abs());
                found = found
                    .filter(|found| found.pulse_n.abs() <= touch.pulse_n.abs())
                    .or(Some(touch));
            }
        }
        (before, now) = (now.near, ahead);
    }
    found
}

/// Change of the angle of blades and casing at the touch \[rad\], over which the force is a smooth
/// function of a parameter.
const LEAST_TURN: f64 = 0.02;

/// Returns the force that exactly closes the gap of a side at one instant.
fn force(flight: &FreeFlight<'_>, side: u32, t: f64) -> f64 {
    -flight.machine.clearance() / flight.gap_by_pulse(side, t)[0]
}

/// Refines the instant, up to the `end`, at which the side needs the smallest force: there it comes
/// nearest, once within a `step` of the look. If it does not, the given instant is kept.
fn polished(flight: &FreeFlight<'_>, look: Look, sense: f64, [step, end]: [f64; 2]) -> FirstTouch {
    let side = look.side;
    let opens = |t: f64| sense * flight.gap_by_pulse(side, t)[1] >= 0.0;
    let (early, late) = ((look.t - step).max(0.5 * look.t), (look.t + step).min(end));
    let is_nearest = !opens(early) && opens(late);
    let t_s = if is_nearest { bisected([early, late], opens)[1] } else { look.t };
    FirstTouch { pulse_n: force(flight, side, t_s), t_s, side }
}

/// Returns the limit with its sensitivities, those of the force that closes the gap of the touched
/// side at the same instant: there the gap has no rate, so a shift in time does not contribute.
pub(super) fn limit(scene: &CheckedScene) -> Limit {
    let found = smallest(scene);
    let present = Some(scene.operation.pulse_n);
    let mut limit = Limit::new(LimitName::TouchingPulse, found.map(|touch| touch.pulse_n), present);
    let Some(touch) = found else {
        limit.note = Some(why_none(scene).to_string());
        return limit;
    };
    let there = |scene: &Scene| {
        let flight = FreeFlight { machine: &scene.machine(), operation: &scene.operation };
        vec![force(&flight, touch.side, touch.t_s)]
    };
    // The casing and the blades have turned so far until then, and must not turn visibly further.
    let machine = scene.machine();
    let speeds = [0.0, touch.t_s].map(|t| scene.operation.speed_ramp_rad_s2 * t);
    let turned = speeds.map(|more| machine.nu(scene.operation.speed_rad_s + more).abs());
    let turned = (turned[0].max(turned[1]) + machine.omega_c) * touch.t_s;
    let change = CHANGE.min(LEAST_TURN / turned);
    let by = acting(scene).map(|parameter| {
        let by = sensitivities(scene, parameter, change, there);
        (parameter.path, by.first().copied().flatten())
    });
    limit.sensitivities = Sensitivities(by.collect());
    limit
}

/// Explains why no pulse touches.
pub(super) fn why_none(scene: &CheckedScene) -> &'static str {
    let machine = scene.machine();
    let touches = |side| machine.apothem(side) < machine.out_of_round();
    if machine.clearance() <= 0.0 {
        "all blades touch without a pulse"
    } else if (0..machine.polygon.sides).any(touches) {
        "a tip touches without a pulse"
    } else if machine.is_uneven() {
        "of equal tips in a round casing only"
    } else if scene.casing.clearance_loss_m_s2 != 0.0 && scene.operation.speed_ramp_rad_s2 != 0.0 {
        "at a constant speed only, as the clearance changes with it"
    } else if scene.initial == Initial::default() {
        "no pulse of this length touches within the run"
    } else {
        "only for a casing that starts at rest"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_instant_of_a_ramp_needs_a_smaller_pulse() {
        for ramp in [3e5, 1e6, 1e7, 3e7] {
            let mut scene = Scene::base();
            scene.operation.speed_rad_s = 50.0;
            scene.operation.speed_ramp_rad_s2 = ramp;
            let found = least(&scene, 1.0).unwrap().pulse_n;
            let machine = scene.machine();
            let flight = FreeFlight { machine: &machine, operation: &scene.operation };
            let end = longest(&scene, &machine);
            let looks = (1..=20_000).map(|k| end * f64::from(k) / 2e4);
            let sides = 0..machine.polygon.sides;
            let forces = looks.flat_map(|t| sides.clone().map(move |side| (side, t)));
            let forces = forces.map(|(side, t)| force(&flight, side, t)).filter(|f| *f > 0.0);
            let least = forces.fold(f64::INFINITY, f64::min);
            assert!(found <= least * (1.0 + 1e-9), "{ramp}: {found} {least}");
        }
    }
}
