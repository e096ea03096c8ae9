//! The parameters of a scene: the real keys of its machine and operation, the clearance, and the
//! frequencies of its modes.

use std::sync::LazyLock;

pub use crate::scene::keys::CLEARANCE;
use crate::scene::keys::{
    BLADE_FREQUENCY, BLADE_LENGTH as LENGTH, BLADE_STIFFNESS, CASING_FREQUENCY,
    CASING_RADIUS as RADIUS, CASING_STIFFNESS, CLEARANCE_KEY, FREQUENCY_KEYS,
};
use crate::scene::{Allowed, ContactLaw, Key, Scene, SceneError, Value, keys};

/// Each frequency and the stiffness that it replaces.
const FREQUENCIES: [(&str, &str); 2] =
    [(CASING_FREQUENCY, CASING_STIFFNESS), (BLADE_FREQUENCY, BLADE_STIFFNESS)];

/// Returns whether a path is that of one of the two lengths whose difference is the clearance.
pub(super) fn is_length(path: &str) -> bool {
    [LENGTH, RADIUS].contains(&path)
}

/// Tables of a scene whose numbers are parameters. Limits of the pulse assume a start from rest, so
/// the initial state has none.
const TABLES: [&str; 4] = ["bladed_disk", "casing", "contact", "operation"];
/// Real keys of these tables that no limit knows; directions are none, too.
const UNKNOWN: [&str; 2] = [keys::MISTUNING, keys::RESTITUTION];
/// Parameters that are zero in the paper, but shown for every machine.
const SHOWN: [&str; 4] =
    [keys::RADIAL_COUPLING, keys::TANGENTIAL_RATIO, keys::FRICTION, keys::SPEED_RAMP];

/// All parameters, in the order of the scene file: the clearance, and the real keys of the machine
/// and its operation. The frequency of a mode follows the stiffness that it replaces.
pub static PARAMETERS: LazyLock<Vec<&'static Key>> = LazyLock::new(|| {
    let is_known = |key: &&Key| {
        let table = key.path.split('.').next().unwrap_or_default();
        let is_real = matches!(key.allowed, Allowed::Real { .. }) && key.unit != "rad";
        is_real && TABLES.contains(&table) && !UNKNOWN.contains(&key.path)
    };
    let mut all = vec![&CLEARANCE_KEY];
    for key in keys::KEYS.iter().filter(is_known) {
        let frequency = FREQUENCIES.iter().position(|(_, stiffness)| *stiffness == key.path);
        all.extend([key].into_iter().chain(frequency.map(|which| &FREQUENCY_KEYS[which])));
    }
    all
});

/// Iterates over the parameters that affect a scene: those of a lining only if there is one, those
/// that are zero in the paper only if they are not zero, and of each mode its frequency or its
/// stiffness, whichever the scene gives.
pub fn acting(scene: &Scene) -> impl Iterator<Item = &'static Key> {
    let paper = Scene::base();
    let lined = scene.solver.contact == ContactLaw::Smooth;
    let given = scene.frequencies_in_use();
    let acts = move |key: &Key| {
        let is_seldom = key.real(&paper) == 0.0 && !SHOWN.contains(&key.path);
        let replaced = FREQUENCIES.iter().zip(given).any(|(&(frequency, stiffness), given)| {
            key.path == if given.is_some() { stiffness } else { frequency }
        });
        let of_lining = [keys::LINING_STIFFNESS, keys::LINING_SMOOTHING].contains(&key.path);
        (lined || !of_lining) && !replaced && (!is_seldom || key.real(scene) != 0.0)
    };
    PARAMETERS.iter().copied().filter(move |key| acts(key))
}

/// Returns the parameter with this path.
///
/// # Errors
/// The path is not that of a real number of the machine or its operation; the message lists those.
pub fn parameter(path: &str) -> Result<&'static Key, SceneError> {
    PARAMETERS.iter().copied().find(|key| key.path == path).ok_or_else(|| {
        let paths: Vec<&str> = PARAMETERS.iter().map(|key| key.path).collect();
        SceneError::refused("parameter", path, format!("one of {}", paths.join(", ")))
    })
}

/// Returns a scene with another value of a parameter, checked only against the bounds of the key.
///
/// # Errors
/// The key does not allow the value.
pub fn changed(by: &Key, scene: &Scene, value: f64) -> Result<Scene, SceneError> {
    let mut changed = scene.clone();
    changed.set_value(by, Value::Real(value)).map(|()| changed)
}

/// Returns the line of a scene file that sets a parameter, and the table that contains it; `None` if
/// the key does not allow the value.
#[must_use]
pub fn line(by: &Key, scene: &Scene, value: f64) -> Option<String> {
    let changed = changed(by, scene, value).ok()?;
    let mut frequencies = FREQUENCIES.iter().zip(scene.frequencies_in_use());
    let path = match frequencies.find(|((frequency, _), _)| *frequency == by.path) {
        _ if by.path == CLEARANCE => RADIUS,
        Some(((_, stiffness), None)) => stiffness,
        _ => by.path,
    };
    let value = if path == by.path { value } else { keys::find(path).ok()?.real(&changed) };
    let (table, leaf) = path.split_once('.')?;
    let (before, now, diameters) = match table {
        "casing" => (&scene.casing.modes, &changed.casing.modes, scene.operation.nodal_diameters),
        _ => (&scene.bladed_disk.modes, &changed.bladed_disk.modes, scene.disk_diameters()),
    };
    Some(match before != now {
        true => format!("{leaf} = {value:?} in [[{table}.modes]], {diameters} nodal diameters"),
        false => format!("{leaf} = {value:?} in [{table}]"),
    })
}

/// Returns a scene with a parameter multiplied by `1 + part`, also beyond the bounds of its key. The
/// casing grows with the blade length, so that the clearance stays.
pub(super) fn scaled(by: &Key, scene: &Scene, part: f64) -> Scene {
    let (mut changed, value) = (scene.clone(), by.real(scene));
    (by.set)(&mut changed, Value::Real(value + part * value));
    if by.path == LENGTH {
        changed.casing.radius_m += part * value;
    }
    changed
}

/// Returns `d ln(clearance)/d ln(parameter)` if the parameter is a length, otherwise 0.
pub(super) fn clearance_share(by: &Key, scene: &Scene) -> f64 {
    let clearance = scene.clearance();
    match by.path {
        _ if clearance == 0.0 => 0.0,
        LENGTH => -scene.bladed_disk.blade_length_m / clearance,
        RADIUS => scene.casing.radius_m / clearance,
        _ => 0.0,
    }
}

/// Returns the quantity over which a target is searched: the parameter itself, or the clearance
/// instead of a length, because one search step of a length would be many clearances.
pub(super) fn walked(by: &'static Key) -> &'static Key {
    if is_length(by.path) { &CLEARANCE_KEY } else { by }
}

/// Converts a value of the searched quantity to a value of the parameter.
pub(super) fn value_at(by: &Key, scene: &Scene, walked: f64) -> f64 {
    match by.path {
        RADIUS => scene.bladed_disk.blade_length_m + walked,
        LENGTH => scene.casing.radius_m - walked,
        _ => walked,
    }
}

/// Returns the largest magnitude that the key of a parameter allows.
pub(super) fn largest(by: &Key) -> f64 {
    match by.allowed {
        Allowed::Real { max, .. } => max,
        _ => f64::MAX,
    }
}
