//! How two scenes differ: the keys with their new values as text, in an order that turns one scene
//! into the other.

use super::Scene;
use super::keys::{CASING_MODES, DIAMETERS, DISK_DIAMETERS, DISK_MODES, KEYS, Key, Value, find};

/// Returns the keys in which `to` differs from `from`, with their new values as text. Applied in
/// this order they turn one scene into the other. Keys of the explorer's initial view are left out.
pub fn differences(from: &Scene, to: &Scene) -> impl Iterator<Item = (&'static str, String)> {
    changed(from, to, false)
}

/// As [`differences`], but only the keys of the explorer's initial view.
pub fn view_differences(from: &Scene, to: &Scene) -> impl Iterator<Item = (&'static str, String)> {
    changed(from, to, true)
}

/// Returns the keys whose values differ between two scenes.
pub fn differing(from: &Scene, to: &Scene) -> impl Iterator<Item = &'static Key> + Clone {
    KEYS.iter().filter(move |key| (key.get)(from) != (key.get)(to))
}

/// Returns the changes that turn one scene into the other if applied in order: first the keys that
/// select the modes in use, last the lists of modes.
fn changed(from: &Scene, to: &Scene, view: bool) -> impl Iterator<Item = (&'static str, String)> {
    let (mut made, scene) = walked(from, to, view);
    let alike = scene.casing == to.casing && scene.bladed_disk == to.bladed_disk;
    if !view && !alike {
        // A difference is hidden by the mode in use: clear the lists, set all values, and restore
        // the lists.
        let none = MODES.map(|path| (path, "[]".to_string()));
        made = walked(&from.without_modes(), &to.without_modes(), view).0;
        made.splice(0..0, none);
        let known = [&to.bladed_disk.modes, &to.casing.modes].map(|modes| !modes.is_empty());
        let modes = MODES.into_iter().zip(known).filter(|(_, known)| *known);
        made.extend(modes.filter_map(|(path, _)| Some((path, text_of(find(path).ok()?, to)))));
    }
    made.into_iter()
}

/// Keys of the lists of modes.
const MODES: [&str; 2] = [DISK_MODES, CASING_MODES];

/// Returns the changes from a scene to another, and the scene that results from applying them.
fn walked(from: &Scene, to: &Scene, view: bool) -> (Vec<(&'static str, String)>, Scene) {
    const FIRST: [&str; 2] = [DIAMETERS, DISK_DIAMETERS];
    let mut scene = from.clone();
    let place = |key: &&Key| match key.path {
        path if FIRST.contains(&path) => 0,
        path if MODES.contains(&path) => 2,
        _ => 1,
    };
    let mut keys: Vec<&Key> =
        KEYS.iter().filter(|key| key.path.starts_with("view.") == view).collect();
    // Without modes the order is that of the file.
    if !from.casing.modes.is_empty() || !from.bladed_disk.modes.is_empty() {
        keys.sort_by_key(place);
    }
    let mut made = Vec::new();
    for key in keys {
        let value = (key.get)(to);
        if (key.get)(&scene) != value {
            made.push((key.path, text_of(key, to)));
            (key.set)(&mut scene, value);
        }
    }
    (made, scene)
}

/// Returns the value of a key as text that is read back exactly.
fn text_of(key: &Key, scene: &Scene) -> String {
    match (key.get)(scene) {
        Value::Real(x) => format!("{x:?}"),
        Value::Text(text) => text,
        Value::Words(words) => words.join(","),
        other => other.to_string(),
    }
}
