//! The parameters of a scene as numbers that can carry a derivative, and how each is read and
//! changed.

use std::f64::consts::TAU;

use num_dual::Dual64;

use crate::model::{
    BladedDisk, Casing, LiningLaw, Machine, Number, Operation, neighbour_stiffness,
};
use crate::motion::FreeFlight;
use crate::scene::{Allowed, ContactLaw, Key, MOST_HZ, ModelSize, Scene, SceneError, Value, keys};

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

/// All real numbers of a scene that a limit can depend on. The initial state is not included,
/// because limits of the pulse assume a start from rest.
#[derive(Clone, Debug)]
pub(super) struct Parameters<T> {
    pub disk: BladedDisk<T>,
    pub casing: Casing<T>,
    pub friction: T,
    /// Stiffness and smoothing depth of the lining.
    pub stiffness: T,
    pub smoothing: T,
    pub law: ContactLaw,
    pub model: ModelSize,
    pub operation: Operation<T>,
    /// Frequencies of casing and disk, if they replace a stiffness \[Hz\].
    pub frequencies: [Option<T>; 2],
}

/// A parameter of a scene with a real value.
#[derive(Clone, Copy)]
pub struct Parameter {
    /// Path of its key, or `clearance`.
    pub path: &'static str,
    place: fn(&mut Parameters<Dual64>) -> &mut Dual64,
}

impl std::fmt::Debug for Parameter {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(out, "Parameter({})", self.path)
    }
}

macro_rules! at {
    ($path:expr, $($field:ident).+) => {
        Parameter { path: $path, place: |all| &mut all.$($field).+ }
    };
}

/// All parameters, in the order of the scene file.
pub const PARAMETERS: &[Parameter] = &[
    at!(CLEARANCE, casing.radius_m),
    at!(LENGTH, disk.blade_length_m),
    at!(keys::BLADE_INERTIA, disk.inertia_kg_m2),
    at!(keys::BLADE_STIFFNESS, disk.stiffness_nm_per_rad),
    Parameter {
        path: BLADE_FREQUENCY,
        place: |all| all.frequencies[1].get_or_insert(Dual64::new(0.0, 0.0)),
    },
    at!(keys::BLADE_COUPLING, disk.coupling_nm_per_rad),
    at!(keys::BLADE_DAMPING, disk.damping_ratio),
    at!(keys::STIFFENING, disk.centrifugal_stiffening),
    at!(keys::RADIAL_COUPLING, disk.radial_coupling),
    at!(keys::TIP_SCATTER, disk.tip_scatter_m),
    at!(keys::LONGEST_TIP, disk.longest_tip_m),
    at!(keys::ORBIT, disk.orbit_m),
    at!(RADIUS, casing.radius_m),
    at!(keys::CASING_MASS, casing.modal_mass_kg),
    at!(keys::CASING_STIFFNESS, casing.modal_stiffness_n_per_m),
    Parameter {
        path: CASING_FREQUENCY,
        place: |all| all.frequencies[0].get_or_insert(Dual64::new(0.0, 0.0)),
    },
    at!(keys::CASING_DAMPING, casing.damping_ratio),
    at!(keys::TANGENTIAL_RATIO, casing.tangential_ratio),
    at!(keys::CLEARANCE_LOSS, casing.clearance_loss_m_s2),
    at!(keys::OUT_OF_ROUND, casing.out_of_round_m),
    at!(keys::FRICTION, friction),
    at!(STIFFNESS, stiffness),
    at!(SMOOTHING, smoothing),
    at!(keys::SPEED, operation.speed_rad_s),
    at!(keys::SPEED_RAMP, operation.speed_ramp_rad_s2),
    at!(keys::PULSE, operation.pulse_n),
    at!(keys::PULSE_TIME, operation.pulse_s),
];

/// Parameters that most machines do not have; they are shown only if they are not zero.
const SELDOM: [&str; 6] = [
    keys::STIFFENING,
    keys::CLEARANCE_LOSS,
    keys::TIP_SCATTER,
    keys::LONGEST_TIP,
    keys::ORBIT,
    keys::OUT_OF_ROUND,
];

/// Iterates over the parameters that affect a scene: those of a lining only if there is one, rarely
/// used ones only if they are not zero, and of each mode its frequency or its stiffness, whichever
/// the scene gives.
pub fn acting(scene: &Scene) -> impl Iterator<Item = &'static Parameter> {
    let lined = scene.solver.contact == ContactLaw::Smooth;
    let changes =
        |parameter: &Parameter| !SELDOM.contains(&parameter.path) || parameter.of(scene) != 0.0;
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
        keys::find(if self.path == CLEARANCE { RADIUS } else { self.path })
    }

    /// Returns the line of a scene file that sets the parameter, and the table that contains it.
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
            true => format!("{leaf} = {value:?} in [[{table}.modes]] of {diameters} diameters"),
            false => format!("{leaf} = {value:?} in [{table}]"),
        })
    }

    /// Returns its value in a scene.
    #[must_use]
    pub fn of(&self, scene: &Scene) -> f64 {
        if self.path == CLEARANCE {
            return scene.clearance();
        }
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
        let mut changed = scene.clone();
        if let Some(which) = self.frequency() {
            changed.set_frequency(which, value)?;
            return Ok(changed);
        }
        let of_key =
            if self.path == CLEARANCE { scene.bladed_disk.blade_length_m + value } else { value };
        changed.set_value(self.key()?, Value::Real(of_key))?;
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

    /// Returns the parameters of a scene, with the derivative with respect to this one.
    pub(super) fn seeded(&self, scene: &Scene) -> Parameters<Dual64> {
        let mut all = Parameters::of(scene);
        if let Some(which) = self.frequency() {
            all.frequencies[which] = Some(self.of(scene).into());
        }
        (self.place)(&mut all).eps = 1.0;
        all
    }
}

impl<T: Number> Parameters<T> {
    /// Takes the parameters of a scene, without derivatives.
    pub(super) fn of(scene: &Scene) -> Self {
        let (disk, casing) = (scene.disk_in_use(), scene.casing_in_use());
        let operation = &scene.operation;
        Self {
            disk: BladedDisk {
                // As in `Scene::machine`: rigid blades do not bend, so an inclined tip path has no
                // effect.
                radial_coupling: match scene.solver.model {
                    ModelSize::Rigid => T::from(0.0),
                    _ => disk.radial_coupling.into(),
                },
                ..disk.to()
            },
            casing: casing.to(),
            friction: scene.contact.friction.into(),
            stiffness: scene.contact.stiffness_n_per_m.into(),
            smoothing: scene.contact.smoothing_m.into(),
            law: scene.solver.contact,
            model: scene.solver.model,
            frequencies: scene.frequencies_in_use().map(|hertz| hertz.map(Into::into)),
            operation: Operation {
                nodal_diameters: operation.nodal_diameters,
                speed_rad_s: operation.speed_rad_s.into(),
                speed_ramp_rad_s2: operation.speed_ramp_rad_s2.into(),
                pulse_n: operation.pulse_n.into(),
                pulse_s: operation.pulse_s.into(),
            },
        }
    }

    /// Returns the motion of the casing before any contact.
    pub(super) fn flight<'a>(&'a self, machine: &'a Machine<T>) -> FreeFlight<'a, T> {
        FreeFlight { machine, operation: &self.operation }
    }

    /// Creates the machine at the speed of these parameters.
    pub(super) fn machine(&self) -> Machine<T> {
        let (mut disk, mut casing) = (self.disk.clone(), self.casing.clone());
        let square = |hertz: T| (hertz * TAU) * (hertz * TAU);
        let [of_casing, of_disk] = self.frequencies.map(|hertz| hertz.map(square));
        if let Some(square) = of_casing {
            casing.modal_stiffness_n_per_m = casing.modal_mass_kg * square;
        }
        if let Some(square) = of_disk {
            let diameters = disk.diameters_beside(self.operation.nodal_diameters);
            let share = neighbour_stiffness(1.0, diameters, disk.blades);
            disk.stiffness_nm_per_rad =
                disk.inertia_kg_m2 * square - disk.coupling_nm_per_rad * share;
        }
        let mut machine = Machine::new(&disk, &casing, self.operation.nodal_diameters)
            .with_friction(self.friction)
            .with_lining((self.law == ContactLaw::Smooth).then_some(LiningLaw {
                stiffness_n_per_m: self.stiffness,
                smoothing_m: self.smoothing,
            }));
        machine.turn_at(self.operation.speed_rad_s);
        machine
    }
}

/// Largest meaningful sensitivity: here one per cent of the parameter changes the limit by 100 %,
/// which no linearisation describes.
const MOST_SENSITIVE: f64 = 100.0;

/// Returns the sensitivity from a value, its derivative and the parameter; `None` if it is not
/// finite or above `MOST_SENSITIVE`.
pub(super) fn sensitivity(value: f64, derivative: f64, parameter: f64) -> Option<f64> {
    // A relative change of zero is zero, whatever the derivative.
    let by = if parameter == 0.0 { 0.0 } else { derivative * parameter / value };
    // Adding zero turns minus zero into zero.
    (by.abs() <= MOST_SENSITIVE).then_some(by + 0.0)
}
