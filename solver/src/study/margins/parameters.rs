//! The parameters of a scene: how each is read and changed.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use crate::scene::{Allowed, ContactLaw, Key, MOST_HZ, Scene, SceneError, Value, keys};

pub use crate::scene::keys::CLEARANCE;

const RADIUS: &str = keys::CASING_RADIUS;
const LENGTH: &str = keys::BLADE_LENGTH;
const STIFFNESS: &str = keys::LINING_STIFFNESS;
const SMOOTHING: &str = keys::LINING_SMOOTHING;
/// Frequencies of the modes in use; they replace a stiffness if the mode gives a frequency.
const CASING_FREQUENCY: &str = "casing.frequency_hz";
const BLADE_FREQUENCY: &str = "bladed_disk.frequency_hz";
/// Each frequency and the stiffness that it replaces.
const FREQUENCIES: [(&str, &str); 2] =
    [(CASING_FREQUENCY, keys::CASING_STIFFNESS), (BLADE_FREQUENCY, keys::BLADE_STIFFNESS)];
/// The two lengths whose difference is the clearance.
pub(super) const LENGTHS: [&str; 2] = [LENGTH, RADIUS];

/// Returns whether a path is that of one of these lengths.
pub(super) fn is_length(path: &str) -> bool {
    LENGTHS.contains(&path)
}

/// A parameter of a scene with a real value.
#[derive(Clone, Copy, Debug)]
pub struct Parameter {
    /// Path of its key, or `clearance`.
    pub path: &'static str,
    /// Whether most machines do not have it; it is shown only if it is not zero.
    is_seldom: bool,
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
pub static PARAMETERS: LazyLock<Vec<Parameter>> = LazyLock::new(|| {
    let paper = Scene::base();
    let is_known = |key: &&Key| {
        let table = key.path.split('.').next().unwrap_or_default();
        let is_real = matches!(key.allowed, Allowed::Real { .. }) && key.unit != "rad";
        is_real && TABLES.contains(&table) && !UNKNOWN.contains(&key.path)
    };
    let seldom = |key: &Key| (key.get)(&paper) == Value::Real(0.0) && !SHOWN.contains(&key.path);
    let mut all = vec![Parameter { path: CLEARANCE, is_seldom: false }];
    for key in keys::KEYS.iter().filter(is_known) {
        all.push(Parameter { path: key.path, is_seldom: seldom(key) });
        let frequency = FREQUENCIES.iter().find(|(_, stiffness)| *stiffness == key.path);
        all.extend(frequency.map(|(path, _)| Parameter { path, is_seldom: false }));
    }
    all
});

/// Iterates over the parameters that affect a scene: those of a lining only if there is one, rarely
/// used ones only if they are not zero, and of each mode its frequency or its stiffness, whichever
/// the scene gives.
pub fn acting(scene: &Scene) -> impl Iterator<Item = &'static Parameter> {
    let lined = scene.solver.contact == ContactLaw::Smooth;
    let changes = |parameter: &Parameter| !parameter.is_seldom || parameter.of(scene) != 0.0;
    let given = scene.frequencies_in_use();
    let is_given = move |parameter: &Parameter| {
        let mut pairs = FREQUENCIES.iter().zip(given);
        pairs.all(|(&(frequency, stiffness), given)| {
            parameter.path != if given.is_some() { stiffness } else { frequency }
        })
    };
    // Rigid contact has no lining parameters.
    let acts = move |one: &Parameter| lined || ![STIFFNESS, SMOOTHING].contains(&one.path);
    PARAMETERS.iter().filter(move |one| acts(one) && changes(one) && is_given(one))
}

/// Returns the parameter with this path; `None` for a key that is not a real number of the machine
/// or its operation.
#[must_use]
pub fn parameter(path: &str) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|parameter| parameter.path == path)
}

impl Parameter {
    /// Returns 0 for the casing frequency, 1 for the disk frequency, and `None` for any other
    /// parameter.
    fn frequency(&self) -> Option<usize> {
        FREQUENCIES.iter().position(|(path, _)| *path == self.path)
    }

    /// Returns the key that the parameter changes.
    fn key(&self) -> Result<&'static Key, SceneError> {
        keys::find_varied(self.path)
    }

    /// Returns the line of a scene file that sets the parameter, and the table that contains it;
    /// `None` if the key does not allow the value.
    #[must_use]
    pub fn line(&self, scene: &Scene, value: f64) -> Option<String> {
        let changed = self.set(scene, value).ok()?;
        let (path, value) = match self.frequency() {
            _ if self.path == CLEARANCE => (RADIUS, changed.casing.radius_m),
            Some(which) if scene.frequencies_in_use()[which].is_none() => {
                let path = FREQUENCIES[which].1;
                (path, parameter(path)?.of(&changed))
            }
            _ => (self.path, value),
        };
        let (table, leaf) = path.split_once('.')?;
        let (before, now, diameters) = match table {
            "casing" => {
                (&scene.casing.modes, &changed.casing.modes, scene.operation.nodal_diameters)
            }
            _ => (&scene.bladed_disk.modes, &changed.bladed_disk.modes, scene.disk_diameters()),
        };
        Some(match before != now {
            true => format!("{leaf} = {value:?} in [[{table}.modes]], {diameters} nodal diameters"),
            false => format!("{leaf} = {value:?} in [{table}]"),
        })
    }

    /// Returns its value in a scene.
    #[must_use]
    pub fn of(&self, scene: &Scene) -> f64 {
        if let Some(which) = self.frequency() {
            let given = scene.frequencies_in_use()[which];
            let machine = scene.machine();
            return given.unwrap_or([machine.omega_c, machine.omega_bd][which] / TAU);
        }
        match self.key().map(|key| (key.get)(scene)) {
            Ok(Value::Real(value)) => value,
            _ => f64::NAN,
        }
    }

    /// Returns a scene with another value, checked only against the bounds of the key.
    ///
    /// # Errors
    /// The key does not allow the value.
    pub fn set(&self, scene: &Scene, value: f64) -> Result<Scene, SceneError> {
        self.changed(scene, value, Scene::set_value)
    }

    /// Returns a scene with the parameter multiplied by `1 + part`, also beyond the bounds of its
    /// key; the scene itself if a frequency cannot be set. The casing grows with the blade length, so
    /// that the clearance stays.
    pub(super) fn scaled(&self, scene: &Scene, part: f64) -> Scene {
        let more = part * self.of(scene);
        let changed = self.changed(scene, self.of(scene) + more, |scene, key, value| {
            (key.set)(scene, value);
            Ok(())
        });
        let mut changed = changed.unwrap_or_else(|_| scene.clone());
        if self.path == LENGTH {
            changed.casing.radius_m += more;
        }
        changed
    }

    /// Returns whether the parameter acts through the clearance only.
    pub(super) fn is_radius(&self) -> bool {
        self.path == RADIUS
    }

    /// Returns `d ln(clearance)/d ln(parameter)` if the parameter is a length, otherwise 0.
    pub(super) fn clearance_share(&self, scene: &Scene) -> f64 {
        let clearance = scene.clearance();
        match self.path {
            _ if clearance == 0.0 => 0.0,
            LENGTH => -scene.bladed_disk.blade_length_m / clearance,
            RADIUS => scene.casing.radius_m / clearance,
            _ => 0.0,
        }
    }

    /// Returns a scene with another value, which `set` writes.
    fn changed(
        &self,
        scene: &Scene,
        value: f64,
        set: impl Fn(&mut Scene, &Key, Value) -> Result<(), SceneError>,
    ) -> Result<Scene, SceneError> {
        let mut changed = scene.clone();
        if let Some(which) = self.frequency() {
            changed.set_frequency(which, value)?;
            return Ok(changed);
        }
        set(&mut changed, self.key()?, Value::Real(value))?;
        Ok(changed)
    }

    /// Returns the quantity over which a target is searched, and its value in a scene: the
    /// parameter itself, or the clearance instead of a length, because one search step of a length
    /// would be many clearances.
    pub(super) fn walked(&self, scene: &Scene) -> (&'static str, f64) {
        let path = if is_length(self.path) { CLEARANCE } else { self.path };
        (path, parameter(path).map_or(f64::NAN, |walked| walked.of(scene)))
    }

    /// Returns the largest magnitude that the key allows.
    pub(super) fn largest(&self) -> f64 {
        match self.key().map(|key| key.allowed) {
            Ok(Allowed::Real { max, .. }) => max,
            _ => MOST_HZ,
        }
    }

    /// Converts a value of the searched quantity to a value of the parameter.
    pub(super) fn value_at(&self, scene: &Scene, walked: f64) -> f64 {
        match self.path {
            RADIUS => scene.bladed_disk.blade_length_m + walked,
            LENGTH => scene.casing.radius_m - walked,
            _ => walked,
        }
    }

    /// Returns its unit.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        if self.frequency().is_some() {
            return "Hz";
        }
        self.key().map_or("", |key| key.unit)
    }
}
