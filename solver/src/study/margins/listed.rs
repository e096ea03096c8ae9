//! The limits of a scene with its margins to them, the sensitivities, and a note on what a closed
//! form neglects or why there is no value.

use super::evaluated::Evaluated;
use super::limit::{Limit, LimitName, Quantity, Sensitivities};
use super::parameters::acting;
use super::touching;
use crate::harmonic::{lobes_of, lock_growth};
use crate::model::LockWindow;
use crate::numeric::rounding::rounded;
use crate::scene::Scene;

/// Limits that few machines have; such a limit is listed only if it exists.
const SELDOM: [LimitName; 5] = [
    LimitName::LockEnds,
    LimitName::WhirlOnset,
    LimitName::FlutterSpeed,
    LimitName::FirstTouch,
    LimitName::Roundness,
];

/// Returns the limits of a scene in the order in which they are shown, with their sensitivities.
pub(super) fn limits(scene: &Scene) -> Vec<Limit> {
    let here = Evaluated::of(scene);
    let all = here.all(false);
    let by: Vec<_> = acting(scene).map(|by| (by.path, here.sensitivities(&all, by))).collect();
    let operation = &scene.operation;
    let mut limits = Vec::new();
    let mut place = 0;
    for (name, values) in all {
        let present = match name.quantity() {
            Quantity::Speed => Some(operation.speed_rad_s.abs()),
            Quantity::Pulse => Some(operation.pulse_n),
            Quantity::Height => Some(scene.casing.out_of_round_m),
            Quantity::Push | Quantity::Torque | Quantity::Power => None,
        };
        if values.is_empty() && !SELDOM.contains(&name) {
            let note = Some(why_none(&here, name));
            limits.push(Limit { note, ..Limit::new(name, None, present) });
        }
        let lobes = lobes_of(operation.nodal_diameters).filter(|_| name == LimitName::Roundness);
        let mut lobes = lobes.map(Some).chain(std::iter::repeat(None));
        for value in values {
            let of_value = by.iter().map(|(path, by)| (*path, by.get(place).copied().flatten()));
            let lobes = lobes.next().flatten();
            // The casing has lobes of one count only; other counts have no height to compare.
            let same = lobes.is_none_or(|lobes| lobes == scene.casing.lobes);
            let present = if same { present } else { Some(0.0) };
            limits.push(Limit {
                lobes,
                sensitivities: Sensitivities(of_value.collect()),
                note: note(&here, name, value),
                ..Limit::new(name, Some(value), present)
            });
            place += 1;
        }
    }
    limits
}

/// Returns what a closed form neglects, if that matters for this scene.
fn note(here: &Evaluated<'_>, name: LimitName, value: f64) -> Option<String> {
    let (scene, machine) = (here.scene, here.machine());
    let of_speeds =
        [LimitName::OmegaLock, LimitName::LockEnds, LimitName::OmegaAdhesive].contains(&name);
    let of_lock = of_speeds || name.quantity().path().is_none();
    if of_lock && scene.operation.speed_ramp_rad_s2 != 0.0 {
        return Some("for a constant speed; a ramp adds a force along the blades".to_string());
    }
    if of_speeds && scene.lining().is_some() {
        let smoothed = scene.contact.smoothing_m > 0.0;
        let without = if smoothed { ", without its smoothing" } else { "" };
        return Some(format!("for two groups on the lining{without}"));
    }
    if name == LimitName::LockEnds && machine.closing_speed() == Some(value) {
        return Some("the clearance closes at this speed".to_string());
    }
    let speed = scene.operation.speed_rad_s;
    if name.quantity().path().is_none() {
        let growth = lock_growth(machine, speed)?;
        return Some(format!(
            "this lock is unstable: deviations grow at {} 1/s",
            rounded(growth, 3)
        ));
    }
    let fluttering = here.flutters();
    let begins = fluttering.iter().find(|flutter| flutter.from == value);
    if name == LimitName::FlutterSpeed {
        let flutter = begins?;
        let ends = flutter.to.map(|to| format!("up to {} rad/s", rounded(to, 6)));
        let speeds = match ends {
            Some(ends) if value == 0.0 => Some(format!("from standstill {ends}")),
            None if value == 0.0 => Some("at every speed".to_string()),
            ends => ends,
        };
        let outlasts = |lock: &LockWindow| !lock.without(flutter).eq([*lock]);
        let held = here.ranges.locks().iter().any(outlasts);
        let held = held.then(|| "the curvature of its pushes can keep a lock stable".to_string());
        let words: Vec<String> = speeds.into_iter().chain(held).collect();
        return (!words.is_empty()).then(|| words.join("; "));
    }
    if name == LimitName::LockEnds && begins.is_some() {
        return Some("above it the lock flutters".to_string());
    }
    if name == LimitName::OmegaLock && fluttering.iter().any(|flutter| flutter.to == Some(value)) {
        return Some("below it the lock flutters".to_string());
    }
    // The adhesive limit is computed for rigid blades. If their lock speed differs from that of the
    // flexible blades, so does the adhesive limit.
    let rigid = name == LimitName::OmegaAdhesive && !machine.is_uneven() && fluttering.is_empty();
    let locks = |windows: &[LockWindow]| windows.first().map(|window| window.from);
    (rigid && locks(&machine.lock_windows(speed)) != locks(here.ranges.locks()))
        .then(|| "for rigid blades; these bend so much that theirs differs".to_string())
}

/// Explains why a machine does not have a limit.
fn why_none(here: &Evaluated<'_>, name: LimitName) -> String {
    let (scene, machine) = (here.scene, here.machine());
    let of_speeds = name.quantity().path().is_some();
    let (polygon, diameters) = (&machine.polygon, scene.operation.nodal_diameters);
    if name == LimitName::TouchingPulse {
        touching::why_none(scene).to_string()
    } else if diameters == 0 {
        "without nodal diameters no wave travels".to_string()
    } else if name == LimitName::Coincidence {
        format!("B = {} >= n_d^2: blades stiffen faster than n_d Omega rises", machine.stiffening())
    } else if name == LimitName::CoincidenceDifference {
        "the blade wave is faster than the casing wave at every speed".to_string()
    } else if !polygon.has_corners() {
        format!("with {diameters} nodal diameters the contact polygon has no corners")
    } else {
        let toward = scene.operation.speed_rad_s;
        let pushed = machine.clone().with_lining(None).lock_windows(toward);
        let hard = pushed.first();
        match (machine.lining, name) {
            _ if scene.clearance() <= 0.0 => "all blades rub at rest: nothing locks",
            _ if !of_speeds && machine.clearance() <= 0.0 => {
                "all blades rub at this speed: nothing locks"
            }
            (Some(_), LimitName::OmegaAdhesive) => "a lining cannot pull",
            _ if machine.is_uneven() => {
                "no formula is known for these tips and this casing; a run computes it"
            }
            _ if machine.closing_speed().is_some() && hard.is_none() => {
                "the clearance closes below every lock speed"
            }
            (Some(_), _) if of_speeds && hard.is_some() => {
                "the lining is too soft for two groups to hold a lock at any speed"
            }
            (Some(_), _) if hard.is_some() => "on this lining no two groups hold a lock; more may",
            (None, LimitName::OmegaAdhesive) if machine.friction != 0.0 => {
                "contact with friction cannot pull"
            }
            (None, LimitName::OmegaAdhesive) if !machine.contact_can_pull() => {
                "the bilateral law, which can pull, does not allow inclined tips"
            }
            (None, LimitName::OmegaLock)
                if hard.is_some() && machine.coupling_product_at(toward) != 0.0 =>
            {
                "a lock flutters at every speed at which both blades push"
            }
            _ if machine.tips_incline_or_rub() => {
                "with this friction or tip slope there is no lock here"
            }
            _ => "blades this soft cannot hold a lock at this speed",
        }
        .to_string()
    }
}
