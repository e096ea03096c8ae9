//! Limits in closed form.

use super::limit::{Limit, LimitName, Quantity, Sensitivities};
use super::parameters::{Parameter, acting};
use super::sensitivity::{CHANGE, sensitivities};
use crate::harmonic::{
    LockLoads, flutters, lobes_of, lock_growth, lock_loads, lock_windows, roundness, whirl_spans,
};
use crate::model::{LockWindow, Machine};
use crate::numeric::rounding::rounded;
use crate::scene::{CheckedScene, ModelSize, Scene};

/// Number of the closed forms that are speeds; these come first in [`CLOSED`].
const SPEEDS: usize = 9;

/// The closed forms, in the order in which they are shown.
pub(super) const CLOSED: [LimitName; 14] = [
    LimitName::OmegaC,
    LimitName::OmegaAdhesive,
    LimitName::OmegaLock,
    LimitName::LockEnds,
    LimitName::Coincidence,
    LimitName::CoincidenceDifference,
    LimitName::WhirlOnset,
    LimitName::FlutterSpeed,
    LimitName::FirstTouch,
    LimitName::PushA,
    LimitName::PushB,
    LimitName::Torque,
    LimitName::Power,
    LimitName::Roundness,
];

/// Limits that few machines have; a limit of these is listed only if it exists.
const SELDOM: [LimitName; 5] = [
    LimitName::LockEnds,
    LimitName::WhirlOnset,
    LimitName::FlutterSpeed,
    LimitName::FirstTouch,
    LimitName::Roundness,
];

/// Returns the first value of every closed form, in the order of [`CLOSED`]; `None` if the machine
/// has no such limit.
pub(super) fn values(scene: &Scene) -> [Option<f64>; CLOSED.len()] {
    all_values(scene).map(|found| found.first().copied())
}

/// Returns all values of every closed form; a machine that changes with speed can have several.
fn all_values(scene: &Scene) -> [Vec<f64>; CLOSED.len()] {
    let machine = scene.machine();
    let speed = scene.operation.speed_rad_s;
    // In the rigid model the contact forces do not bend the blades.
    let loads = match scene.solver.model {
        ModelSize::Rigid => lock_loads(&machine.clone().with_stiff_blades(), speed),
        ModelSize::Modal | ModelSize::Full => lock_loads(&machine, speed),
    };
    let of = |get: fn(&LockLoads) -> f64| one(loads.as_ref().map(get));
    let of_lock = [
        of(|loads| loads.pushes_n[0]),
        of(|loads| loads.pushes_n[1]),
        of(|loads| loads.torque_nm),
        of(|loads| loads.power_w),
    ];
    let lobes = lobes_of(scene.operation.nodal_diameters);
    let round = lobes.map_while(|lobes| roundness(&machine, speed, lobes)).collect();
    let mut all = speed_values(&machine, speed).into_iter().chain(of_lock).chain([round]);
    std::array::from_fn(|_| all.next().unwrap_or_default())
}

/// Returns the values of the closed forms that are speeds.
fn speed_values(machine: &Machine, toward: f64) -> [Vec<f64>; SPEEDS] {
    let windows = lock_windows(machine, toward);
    // Flutter applies to rigid contact only.
    let fluttering = if machine.lining.is_none() { flutters(machine, toward) } else { Vec::new() };
    [
        one(machine.critical_speed()),
        one(machine.adhesive_speed()),
        windows.iter().map(|window| window.from).collect(),
        windows.iter().filter_map(|window| window.to).collect(),
        one(machine.dangerous_speed()),
        machine.coincidence_differences(),
        whirl_spans(machine, toward).iter().map(|span| span.from).collect(),
        fluttering.iter().map(|flutter| flutter.from).collect(),
        one(machine.touching_speed()),
    ]
}

fn one(value: Option<f64>) -> Vec<f64> {
    value.into_iter().collect()
}

/// Limits that need no contact.
const OF_NO_CONTACT: [LimitName; 3] =
    [LimitName::OmegaC, LimitName::Coincidence, LimitName::CoincidenceDifference];

/// Removes the limits of rigid contact if a lining is compressed at rest; that case has other
/// limits (`LiningState`).
fn keep_known(scene: &Scene, found: &mut [Vec<f64>]) {
    if scene.clearance() <= 0.0 {
        for (values, name) in found.iter_mut().zip(CLOSED) {
            if !OF_NO_CONTACT.contains(&name) {
                values.clear();
            }
        }
    }
}

/// Returns all limits of a scene that are speeds.
pub(in crate::study) fn speeds(scene: &Scene) -> Vec<(LimitName, f64)> {
    let mut found = speed_values(&scene.machine(), scene.operation.speed_rad_s);
    keep_known(scene, &mut found);
    let each = CLOSED.into_iter().zip(found);
    let each = each.flat_map(|(name, values)| values.into_iter().map(move |value| (name, value)));
    each.filter(|(_, value)| value.is_finite()).collect()
}

/// Returns the sensitivities of the limits of [`speeds`] to one parameter, in the same order;
/// `None` as in [`sensitivities`].
pub(in crate::study) fn speed_sensitivities(
    scene: &Scene,
    parameter: &Parameter,
) -> Vec<Option<f64>> {
    let known = speeds(scene);
    sensitivities(scene, parameter, CHANGE, |changed| {
        let found = speeds(changed);
        let same = |place: usize| found.get(place).filter(|(name, _)| *name == known[place].0);
        (0..known.len()).map(|place| same(place).map_or(f64::NAN, |(_, value)| *value)).collect()
    })
}

/// Returns the limits of a scene in closed form, with their sensitivities.
pub(super) fn limits(scene: &CheckedScene) -> Vec<Limit> {
    let mut found = all_values(scene);
    keep_known(scene, &mut found);
    let places: Vec<(usize, usize)> = found
        .iter()
        .enumerate()
        .flat_map(|(place, values)| (0..values.len()).map(move |which| (place, which)))
        .collect();
    let by_parameter: Vec<(&str, Vec<Option<f64>>)> = acting(scene)
        .map(|parameter| {
            let changed = |scene: &Scene| {
                let found = all_values(scene);
                let value = |values: &[f64], which| values.get(which).copied().unwrap_or(f64::NAN);
                places.iter().map(|&(place, which)| value(&found[place], which)).collect()
            };
            (parameter.path, sensitivities(scene, parameter, CHANGE, changed))
        })
        .collect();
    let present = |name: LimitName| match name.quantity() {
        Quantity::Height => Some(scene.casing.out_of_round_m),
        quantity => quantity.path().map(|_| scene.operation.speed_rad_s.abs()),
    };
    let lobes: Vec<u32> = lobes_of(scene.operation.nodal_diameters).collect();
    let limits = CLOSED.into_iter().enumerate().flat_map(|(place, name)| {
        let mut limits = Vec::new();
        for (which, &value) in found[place].iter().enumerate() {
            let mut limit = Limit::new(name, Some(value), present(name));
            let at = places.iter().position(|found| *found == (place, which)).unwrap_or_default();
            let by = by_parameter.iter().map(|(path, by)| (*path, by[at]));
            limit.sensitivities = Sensitivities(by.collect());
            limit.note = note(scene, name, value);
            if name == LimitName::Roundness {
                limit.lobes = lobes.get(which).copied();
            }
            limits.push(limit);
        }
        if limits.is_empty() {
            let mut limit = Limit::new(name, None, present(name));
            limit.note = Some(why_none(scene, name));
            limits.push(limit);
        }
        limits
    });
    limits.filter(|limit| !SELDOM.contains(&limit.name) || limit.value.is_some()).collect()
}

/// Returns what a closed form neglects, if that matters for this scene.
fn note(scene: &CheckedScene, name: LimitName, value: f64) -> Option<String> {
    let of_speeds =
        [LimitName::OmegaLock, LimitName::LockEnds, LimitName::OmegaAdhesive].contains(&name);
    let of_lock = of_speeds || name.quantity().path().is_none();
    if of_lock && scene.operation.speed_ramp_rad_s2 != 0.0 {
        return Some("at a constant speed; a ramp adds a force along the blades".to_string());
    }
    if of_speeds && scene.lining().is_some() {
        let smoothed = scene.contact.smoothing_m > 0.0;
        let without = if smoothed { ", without its smoothing" } else { "" };
        return Some(format!("of two groups on the lining{without}"));
    }
    let machine = scene.machine();
    if name == LimitName::LockEnds && machine.closing_speed() == Some(value) {
        return Some("there the clearance is lost".to_string());
    }
    let speed = scene.operation.speed_rad_s;
    if name.quantity().path().is_none() {
        let bends = scene.solver.model != ModelSize::Rigid;
        let growth = lock_growth(&machine, speed).filter(|_| bends)?;
        return Some(format!(
            "of a lock that does not last: it grows by {} 1/s",
            rounded(growth, 3)
        ));
    }
    let fluttering = if scene.lining().is_none() { flutters(&machine, speed) } else { Vec::new() };
    let begins = fluttering.iter().find(|flutter| flutter.from == value);
    if name == LimitName::FlutterSpeed {
        let ends = begins?.to.map(|to| format!("up to {} rad/s", rounded(to, 6)));
        return match ends {
            Some(ends) if value == 0.0 => Some(format!("from rest on, {ends}")),
            None if value == 0.0 => Some("at every speed".to_string()),
            ends => ends,
        };
    }
    if name == LimitName::LockEnds && begins.is_some() {
        return Some("there the lock begins to flutter".to_string());
    }
    if name == LimitName::OmegaLock && fluttering.iter().any(|flutter| flutter.to == Some(value)) {
        return Some("below it the lock flutters".to_string());
    }
    // The adhesive limit is that of rigid blades; flexible ones have another if their lock has.
    let rigid = name == LimitName::OmegaAdhesive && !machine.is_uneven();
    let locks = |windows: Vec<LockWindow>| windows.first().map(|window| window.from);
    let bend = rigid && locks(machine.lock_windows(speed)) != locks(lock_windows(&machine, speed));
    (bend && fluttering.is_empty())
        .then(|| "for rigid blades; these bend so much that it is another".to_string())
}

/// Explains why a machine does not have a limit.
fn why_none(scene: &CheckedScene, name: LimitName) -> String {
    let machine = scene.machine();
    let of_speeds = name.quantity().path().is_some();
    let (polygon, diameters) = (&machine.polygon, scene.operation.nodal_diameters);
    if diameters == 0 {
        "no wave turns without nodal diameters".to_string()
    } else if name == LimitName::Coincidence {
        format!("B = {} >= n_d^2: blades stiffen faster than the wave turns", machine.stiffening())
    } else if name == LimitName::CoincidenceDifference {
        "blades stay faster than the casing".to_string()
    } else if !polygon.has_corners() {
        format!("{diameters} nodal diameters make no corner of blades")
    } else {
        let toward = scene.operation.speed_rad_s;
        let pushed = machine.clone().with_lining(None).lock_windows(toward);
        let hard = pushed.first();
        match (machine.lining, name) {
            _ if scene.clearance() <= 0.0 => "all blades rub at rest: nothing locks",
            _ if !of_speeds && machine.clearance() <= 0.0 => {
                "all blades rub at this speed: nothing locks"
            }
            _ if machine.closing_speed().is_some() && hard.is_none() => {
                "the clearance is lost before blades lock"
            }
            (Some(_), LimitName::OmegaAdhesive) => "a lining does not pull",
            (Some(_), _) if of_speeds && hard.is_some() => {
                "the lining is too soft: two groups hold a lock on it at no speed"
            }
            (Some(_), _) if hard.is_some() => {
                "two groups alone hold no stable lock on the lining at this speed; others \
                 may: its steady states"
            }
            _ if machine.is_uneven() => {
                "not known of these tips and this shape of the casing: runs have it"
            }
            (None, LimitName::OmegaAdhesive) if machine.friction != 0.0 => {
                "tips that rub cannot pull"
            }
            (None, LimitName::OmegaLock)
                if hard.is_some() && machine.coupling_product_at(toward) != 0.0 =>
            {
                "a lock flutters at every speed at which both blades push"
            }
            _ if machine.tips_incline_or_rub() => {
                "friction or the slope of the tips leaves no lock here"
            }
            _ => "the blades are so soft that no lock is left at this speed",
        }
        .to_string()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn limits_of(stiffness: f64, smoothing: f64) -> Vec<Limit> {
        let mut scene = Scene::builtin("soft-lining").unwrap();
        scene.contact.stiffness_n_per_m = stiffness;
        scene.contact.smoothing_m = smoothing;
        limits(&scene.checked().unwrap())
    }

    #[test]
    fn only_the_speeds_of_a_lining_with_smoothing_say_that_they_leave_it_out() {
        for smoothing in [0.0, 1e-6] {
            let limits = limits_of(1e9, smoothing);
            let noted = limits.iter().filter(|limit| {
                limit.note.as_ref().is_some_and(|note| note.contains("without its smoothing"))
            });
            let noted: Vec<LimitName> = noted.map(|limit| limit.name).collect();
            let speeds = [LimitName::OmegaLock, LimitName::LockEnds];
            assert_eq!(noted, if smoothing > 0.0 { &speeds[..] } else { &[] }, "{smoothing}");
        }
    }

    #[test]
    fn the_lock_speed_of_blades_that_bend_much_is_their_own() {
        let speeds = |stiffness: f64| {
            let mut scene = Scene::base();
            scene.bladed_disk.stiffness_nm_per_rad = stiffness;
            scene.bladed_disk.coupling_nm_per_rad = 0.0;
            let limits = limits(&scene.clone().checked().unwrap());
            let limit = |name| limits.iter().find(|limit| limit.name == name).unwrap();
            let rigid = scene.machine().lock_speed().unwrap();
            let noted = limit(LimitName::OmegaAdhesive).note.is_some();
            (limit(LimitName::OmegaLock).value.unwrap() / rigid - 1.0, noted)
        };
        assert_eq!([speeds(15e3), speeds(500.0)], [(0.0, false); 2]);
        let (apart, noted) = speeds(0.02);
        assert!(apart.abs() > 1e-3 && noted, "{apart}");
    }

    #[test]
    fn tips_that_just_touch_at_rest_have_no_limit_of_a_contact() {
        let known = |clearance: f64| {
            let mut scene = Scene::builtin("soft-lining").unwrap();
            scene.bladed_disk.radial_coupling = 0.3;
            scene.bladed_disk.blade_length_m = scene.casing.radius_m - clearance;
            let found = speeds(&scene).into_iter().map(|(name, _)| name);
            found.filter(|name| !OF_NO_CONTACT.contains(name)).count()
        };
        assert!(known(1e-4) > 0);
        assert_eq!([known(0.0), known(-1e-5)], [0, 0]);
    }

    #[test]
    fn what_a_soft_lining_does_not_hold_has_its_own_reason() {
        let limits = limits_of(1e8, 1e-6);
        for (name, reason) in [
            (LimitName::OmegaLock, "at no speed"),
            (LimitName::OmegaAdhesive, "does not pull"),
            (LimitName::PushA, "at this speed"),
        ] {
            let limit = limits.iter().find(|limit| limit.name == name).unwrap();
            let note = limit.note.as_ref().unwrap();
            assert!(limit.value.is_none() && note.contains(reason), "{name}: {note}");
        }
    }
}
