//! The smallest pulse that makes a blade touch, to the last digit, and its derivative: until
//! then the casing moves in closed form.

use std::f64::consts::TAU;

use num_dual::Dual64;

use super::limit::{Limit, LimitName, Sensitivities};
use super::parameters::{Parameter, Parameters, acting, parameter, sensitivity};
use crate::model::{Excitation, Initial, Machine, Number};
use crate::motion::FreeFlight;
use crate::numeric::bisection::bisected;
use crate::scene::keys::PULSE;
use crate::scene::{CheckedScene, ModelSize, Scene};
use crate::tolerances::{SWING_LOOKS, TOUCHING_LOOK, TOUCHING_PERIODS};

/// The smallest pulse that touches, and where it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FirstTouch {
    /// The pulse \[N\].
    pub pulse_n: f64,
    /// When it touches \[s\].
    pub t_s: f64,
    /// The side that touches.
    pub side: u32,
}

/// The smallest pulse force of the scene's duration that makes a blade touch,
/// up to `most` \[N\], with rigid blades; negative where `most` is. None where that
/// does not touch, or the casing does not start at rest.
#[must_use]
pub fn grazing_pulse(scene: &Scene, most: f64) -> Option<f64> {
    first_touch(scene, most).map(|touch| touch.pulse_n)
}

/// As `grazing_pulse`, and where it touches.
#[must_use]
pub fn first_touch(scene: &Scene, most: f64) -> Option<FirstTouch> {
    let sense = 1_f64.copysign(most);
    least(scene, sense).filter(|touch| touch.pulse_n.abs() <= most.abs())
}

/// The smallest pulse of the sense of the scene's that touches, if its key allows it.
pub(super) fn smallest(scene: &Scene) -> Option<FirstTouch> {
    let most = parameter(PULSE).map_or(f64::MAX, Parameter::largest);
    first_touch(scene, if scene.operation.pulse_n < 0.0 { -most } else { most })
}

/// Whether there is a clearance, and the casing starts in the middle of it.
fn starts_at_rest(scene: &Scene) -> bool {
    let mut scene = scene.as_reference();
    scene.solver.model = ModelSize::Rigid;
    scene.excitation = Excitation::default();
    scene.machine().clearance() > 0.0
        && !scene.is_uneven()
        && scene.initial == Initial::default()
        && scene.checked().is_ok()
}

/// How long a blade may still pass nearer to the casing than before \[s\]: later its
/// swing has decayed by more than the angle between two blades can hide.
fn longest(scene: &Scene, machine: &Machine) -> f64 {
    let period = TAU / machine.omega_c;
    let hidden = -machine.polygon.delta.cos().max(0.0).ln();
    let fades = hidden / (machine.casing_damping_ratio * machine.omega_c);
    let most = TOUCHING_PERIODS * period;
    // Without damping nothing fades, and fewer than three sides hide everything.
    let wait = if fades.is_finite() { fades.min(most) } else { most };
    (scene.operation.pulse_s + period + wait).min(scene.solver.end_s)
}

/// Where the casing is at an instant, by one newton \[m/N\].
#[derive(Clone, Copy)]
struct Look {
    t: f64,
    /// How far it has moved, and how far of that toward the nearest side.
    moved: f64,
    near: f64,
    side: u32,
}

/// The smallest pulse of this sense that touches: the largest way to a side by one newton.
///
/// No side is nearer than the casing has moved, and one is as near as that times the cosine
/// of half a side's angle. So only instants matter at which the casing has moved further
/// than the best way so far, and what lies before is passed at its highest rate.
fn least(scene: &Scene, sense: f64) -> Option<FirstTouch> {
    if !starts_at_rest(scene) {
        return None;
    }
    let all = Parameters::<f64>::of(scene);
    let machine = all.machine();
    let (flight, polygon, operation) = (all.flight(&machine), &machine.polygon, &all.operation);
    let look = |t: f64| {
        let (moved, turn) = flight.moved_by_pulse(t);
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
            // A look misses the nearest instant by less than the square of a step.
            if look.near > 0.0 && look.near * (1.0 + TOUCHING_LOOK * TOUCHING_LOOK) >= best {
                let touch = polished(&Parameters::of(scene), look, sense, step);
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

/// The force that closes the gap of a side at one instant exactly.
fn force<T: Number>(flight: &FreeFlight<'_, T>, side: u32, t: T) -> T {
    -flight.machine.clearance() / flight.gap_by_pulse(side, t)
}

/// The same side at the instant near this look at which it needs least; at the end of what
/// is looked at, that end.
fn polished(all: &Parameters<Dual64>, look: Look, sense: f64, step: f64) -> FirstTouch {
    let machine = all.machine();
    let flight = all.flight(&machine);
    // The derivative of the force by the instant has one zero near the touch.
    let slope = |t: f64| force(&flight, look.side, Dual64::new(t, 1.0)).eps * sense;
    let (early, late) = ((look.t - step).max(0.5 * look.t), look.t + step);
    let t_s = if slope(early) < 0.0 && slope(late) > 0.0 {
        bisected([early, late], |t| slope(t) >= 0.0)[1]
    } else {
        look.t
    };
    FirstTouch { pulse_n: force(&flight, look.side, Dual64::from(t_s)).re, t_s, side: look.side }
}

/// The limit, with its derivatives by the implicit function theorem: the gap of the
/// side that touches is zero at an instant at which it does not change.
pub(super) fn limit(scene: &CheckedScene) -> Limit {
    let found = smallest(scene);
    let present = Some(scene.operation.pulse_n);
    let mut limit = Limit::new(LimitName::TouchingPulse, found.map(|touch| touch.pulse_n), present);
    let Some(touch) = found else {
        limit.note = Some(why_none(scene).to_string());
        return limit;
    };
    let by = acting(scene).map(|parameter| {
        let all = parameter.seeded(scene);
        let machine = all.machine();
        let dual = force(&all.flight(&machine), touch.side, Dual64::from(touch.t_s));
        (parameter.path, sensitivity(touch.pulse_n, dual.eps, parameter.of(scene)))
    });
    limit.sensitivities = Sensitivities(by.collect());
    limit
}

/// Why no pulse touches.
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
            let all = Parameters::<f64>::of(&scene);
            let machine = all.machine();
            let (flight, end) = (all.flight(&machine), longest(&scene, &machine));
            let looks = (1..=20_000).map(|k| end * f64::from(k) / 2e4);
            let sides = 0..machine.polygon.sides;
            let forces = looks.flat_map(|t| sides.clone().map(move |side| (side, t)));
            let forces = forces.map(|(side, t)| force(&flight, side, t)).filter(|f| *f > 0.0);
            let least = forces.fold(f64::INFINITY, f64::min);
            assert!(found <= least * (1.0 + 1e-9), "{ramp}: {found} {least}");
        }
    }
}
