//! The smallest pulse that makes a blade touch: by bisection on the event solver, and
//! to the last digit, with its derivative, where the gap of the side just closes.

use std::f64::consts::TAU;

use num_dual::Dual64;

use super::limit::{Limit, LimitName, Sensitivities};
use super::parameters::{Parameter, Parameters, acting, parameter, sensitivity};
use crate::model::{Excitation, Initial, Number};
use crate::motion::{FreeFlight, Motion};
use crate::numeric::bisection::{bisected, bisected_to};
use crate::scene::keys::PULSE;
use crate::scene::{CheckedScene, ModelSize, Scene};
use crate::tolerances::{TOUCHING_PART, TOUCHING_PERIODS};

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
    let reference = reference(scene)?;
    let mut found = touch_of(&reference, most)?;
    bisected_to([0.0, most.abs()], TOUCHING_PART, |size| {
        match touch_of(&reference, size.copysign(most)) {
            Some(touch) => {
                found = touch;
                true
            }
            None => false,
        }
    });
    Some(polished(scene, found))
}

/// As `first_touch` near a guess, to `part` of itself.
pub(super) fn near(scene: &CheckedScene, guess: f64, part: f64) -> Option<f64> {
    let reference = reference(scene)?;
    let touches = |size: f64| touch_of(&reference, size.copysign(guess)).is_some();
    let (mut less, mut enough) = (guess.abs(), guess.abs());
    for _ in 0..40 {
        if !touches(less) {
            break;
        }
        less *= 1.0 - NEAR;
    }
    for _ in 0..400 {
        if touches(enough) {
            return Some(bisected_to([less, enough], part, touches)[1].copysign(guess));
        }
        (less, enough) = (enough, enough * (1.0 + NEAR));
    }
    None
}

/// Step of that search.
const NEAR: f64 = 0.01;

/// The scene as the event solver takes it with rigid blades, and no motion but that
/// of the casing; none where it does not start at rest.
fn reference(scene: &Scene) -> Option<CheckedScene> {
    if scene.machine().clearance() <= 0.0 {
        return None;
    }
    if scene.initial != Initial::default() {
        return None;
    }
    let mut scene = scene.as_reference();
    scene.solver.model = ModelSize::Rigid;
    scene.excitation = Excitation::default();
    scene.checked().ok()
}

/// The first contact under this pulse, if there is one.
fn touch_of(reference: &CheckedScene, pulse: f64) -> Option<FirstTouch> {
    let scene = reference.perturbed(|scene| scene.operation.pulse_n = pulse);
    let mut motion = Motion::new(&scene);
    let (end, mut until) = (longest(&scene), TAU / scene.machine().omega_c);
    // What follows the first contact is of no interest, and may be a rub without end. A
    // motion that fails may have touched before; one that leaves the model has not.
    while motion.advance(until.min(end)).is_ok()
        && motion.contacts().impacts.is_empty()
        && until < end
    {
        until *= 2.0;
    }
    let first = motion.contacts().impacts.first()?;
    Some(FirstTouch { pulse_n: pulse, t_s: first.t_s, side: first.side })
}

/// How long a blade may still pass nearer to the casing than before \[s\]: later its
/// swing has decayed by more than the angle between two blades can hide.
fn longest(scene: &Scene) -> f64 {
    let machine = scene.machine();
    let period = TAU / machine.omega_c;
    let hidden = -machine.polygon.delta.cos().max(0.0).ln();
    let fades = hidden / (machine.casing_damping_ratio * machine.omega_c);
    let most = TOUCHING_PERIODS * period;
    // Without damping nothing fades, and fewer than three sides hide everything.
    let wait = if fades.is_finite() { fades.min(most) } else { most };
    (scene.operation.pulse_s + period + wait).min(scene.solver.end_s)
}

/// The force that closes the gap of a side at one instant exactly.
fn force<T: Number>(flight: &FreeFlight<'_, T>, side: u32, t: T) -> T {
    -flight.machine.clearance() / flight.gap_by_pulse(side, t)
}

/// The same touch at the instant at which the side needs least.
fn polished(scene: &Scene, touch: FirstTouch) -> FirstTouch {
    let all = Parameters::<Dual64>::of(scene);
    let machine = all.machine();
    let flight = all.flight(&machine);
    // The derivative of the force by the instant has one zero near the touch.
    let slope =
        |t: f64| force(&flight, touch.side, Dual64::new(t, 1.0)).eps * touch.pulse_n.signum();
    let reach = 1e-4 / machine.omega_c.re;
    let (early, late) = ((touch.t_s - reach).max(0.0), touch.t_s + reach);
    let t_s = if slope(early) < 0.0 && slope(late) > 0.0 {
        bisected([early, late], |t| slope(t) >= 0.0)[1]
    } else {
        // At the end of what is looked at, not where the gap is least.
        touch.t_s
    };
    let pulse_n = force(&flight, touch.side, Dual64::from(t_s)).re;
    let agrees = (pulse_n / touch.pulse_n - 1.0).abs() < 10.0 * TOUCHING_PART;
    if agrees { FirstTouch { pulse_n, t_s, ..touch } } else { touch }
}

/// The smallest pulse of the sense of the scene's that touches, if one does.
pub(super) fn smallest(scene: &CheckedScene) -> Option<FirstTouch> {
    first_touch(scene, enough(scene)?)
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
    if scene.machine().clearance() <= 0.0 {
        "all blades touch without a pulse"
    } else if scene.casing.clearance_loss_m_s2 != 0.0 && scene.operation.speed_ramp_rad_s2 != 0.0 {
        "at a constant speed only, as the clearance changes with it"
    } else if scene.initial == Initial::default() {
        "no pulse of this length touches within the run"
    } else {
        "only for a casing that starts at rest"
    }
}

/// A pulse that touches, if any of its length does \[N\]: by doubling, from one that
/// moves the free casing by about the clearance.
fn enough(scene: &CheckedScene) -> Option<f64> {
    let reference = reference(scene)?;
    let machine = scene.machine();
    let impulse = machine.clearance() * machine.omega_c * machine.casing_mass;
    let force = impulse / scene.operation.pulse_s + machine.clearance() * machine.casing_stiffness;
    let sense = if scene.operation.pulse_n < 0.0 { -1.0 } else { 1.0 };
    let most = parameter(PULSE).map_or(f64::MAX, Parameter::largest);
    let doubled = (0..=DOUBLINGS).map(|k| sense * (force * 2_f64.powi(k)).min(most));
    doubled.into_iter().find(|pulse| pulse.is_finite() && touch_of(&reference, *pulse).is_some())
}

/// Most doublings: beyond, the casing has left the model long before it touches.
const DOUBLINGS: i32 = 40;
