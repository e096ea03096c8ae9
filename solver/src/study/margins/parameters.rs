//! The parameters of a scene as numbers that may carry a derivative, and how each is
//! read and changed.

use std::f64::consts::TAU;

use num_dual::Dual64;

use crate::model::{BladedDisk, Casing, LiningLaw, Machine, Number, Operation, of_neighbours};
use crate::motion::FreeFlight;
use crate::scene::{Allowed, ContactLaw, Key, MOST_HZ, ModelSize, Scene, SceneError, Value, keys};

pub use crate::scene::keys::CLEARANCE;

const RADIUS: &str = keys::CASING_RADIUS;
const LENGTH: &str = keys::BLADE_LENGTH;
const STIFFNESS: &str = keys::LINING_STIFFNESS;
const SMOOTHING: &str = keys::LINING_SMOOTHING;
/// Frequencies of the modes in use, which stand for a stiffness where a mode has one.
const CASING_FREQUENCY: &str = "casing.frequency_hz";
const BLADE_FREQUENCY: &str = "bladed_disk.frequency_hz";
/// Each frequency, and the stiffness that it stands for.
const FREQUENCIES: [(&str, &str); 2] =
    [(CASING_FREQUENCY, keys::CASING_STIFFNESS), (BLADE_FREQUENCY, keys::BLADE_STIFFNESS)];
/// The two lengths whose difference is the clearance.
pub(super) const LENGTHS: [&str; 2] = [LENGTH, RADIUS];

/// Whether this is the path of one of them.
pub(super) fn is_length(path: &str) -> bool {
    LENGTHS.contains(&path)
}

/// Everything in a scene that is a real number and that a limit may depend on. The
/// state at t = 0 is not among them: limits of the pulse are those of a start at rest.
#[derive(Clone, Debug)]
pub(super) struct Parameters<T> {
    pub disk: BladedDisk<T>,
    pub casing: Casing<T>,
    pub friction: T,
    /// Of the lining, where the contact has one.
    pub stiffness: T,
    pub smoothing: T,
    pub law: ContactLaw,
    pub model: ModelSize,
    pub operation: Operation<T>,
    /// Frequencies of casing and disk \[Hz\], where they stand for a stiffness.
    pub frequencies: [Option<T>; 2],
}

/// A parameter of a scene that is a real number.
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

/// Every parameter, in the order of the scene file.
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

/// Those that act only where they are not zero: most machines do not have them.
const SELDOM: [&str; 6] = [
    keys::STIFFENING,
    keys::CLEARANCE_LOSS,
    keys::TIP_SCATTER,
    keys::LONGEST_TIP,
    keys::ORBIT,
    keys::OUT_OF_ROUND,
];

/// Those that act in a scene: one without a lining has none of its numbers, and a machine
/// that stays the same at every speed none that would change it. A mode has its frequency or
/// its stiffness, whichever the scene gives.
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
    // Rigid contact has no parameters of a lining.
    let acts = move |one: &Parameter| lined || ![STIFFNESS, SMOOTHING].contains(&one.path);
    PARAMETERS.iter().filter(move |one| acts(one) && changes(one) && is_given(one))
}

/// The parameter of this path; none for a key that holds no real number of the
/// machine or its operation.
#[must_use]
pub fn parameter(path: &str) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|parameter| parameter.path == path)
}

impl Parameter {
    /// Which frequency it is, if it is one: that of the casing or of the disk.
    fn frequency(&self) -> Option<usize> {
        FREQUENCIES.iter().position(|(path, _)| *path == self.path)
    }

    /// The key that it changes.
    fn key(&self) -> Result<&'static Key, SceneError> {
        keys::find(if self.path == CLEARANCE { RADIUS } else { self.path })
    }

    /// The line of a scene file that sets it, and the part of the file where it stands.
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

    /// Its value in a scene.
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

    /// A scene with another value of it, not yet checked as a whole.
    ///
    /// # Errors
    /// A value that its key does not allow.
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

    /// What is walked over for a target, and its value in a scene: the parameter
    /// itself, or for a length the clearance that it leaves, as one step of a length is
    /// many clearances.
    pub(super) fn walked(&self, scene: &Scene) -> (&'static str, f64) {
        let path = if is_length(self.path) { CLEARANCE } else { self.path };
        (path, parameter(path).map_or(f64::NAN, |walked| walked.of(scene)))
    }

    /// The largest value that its key allows, in size.
    pub(super) fn largest(&self) -> f64 {
        match self.key().map(|key| key.allowed) {
            Ok(Allowed::Real { max, .. }) => max,
            _ => MOST_HZ,
        }
    }

    /// Its value where what is walked over has this one.
    pub(super) fn value_at(&self, scene: &Scene, walked: f64) -> f64 {
        match self.path {
            RADIUS => scene.bladed_disk.blade_length_m + walked,
            LENGTH => scene.casing.radius_m - walked,
            _ => walked,
        }
    }

    /// Its unit.
    #[must_use]
    pub fn unit(&self) -> &'static str {
        if self.frequency().is_some() {
            return "Hz";
        }
        self.key().map_or("", |key| key.unit)
    }

    /// The parameters of a scene, with the derivative of this one.
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
    /// Of a scene, without derivatives.
    pub(super) fn of(scene: &Scene) -> Self {
        let (disk, casing) = (scene.disk_in_use(), scene.casing_in_use());
        let operation = &scene.operation;
        Self {
            disk: BladedDisk {
                // Rigid blades do not move their tips outward, as in `Scene::machine`.
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

    /// The casing before any contact.
    pub(super) fn flight<'a>(&'a self, machine: &'a Machine<T>) -> FreeFlight<'a, T> {
        FreeFlight { machine, operation: &self.operation }
    }

    /// The machine of these parameters at their speed.
    pub(super) fn machine(&self) -> Machine<T> {
        let (mut disk, mut casing) = (self.disk.clone(), self.casing.clone());
        let square = |hertz: T| (hertz * TAU) * (hertz * TAU);
        let [of_casing, of_disk] = self.frequencies.map(|hertz| hertz.map(square));
        if let Some(square) = of_casing {
            casing.modal_stiffness_n_per_m = casing.modal_mass_kg * square;
        }
        if let Some(square) = of_disk {
            let diameters = disk.diameters_beside(self.operation.nodal_diameters);
            let share = of_neighbours(1.0, diameters, disk.blades);
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

/// Largest sensitivity: one per cent of the parameter moves the limit by as much as itself, and
/// the slope says nothing of such a change.
const MOST_SENSITIVE: f64 = 100.0;

/// The sensitivity of a value by a parameter of this value, from its derivative; none
/// where there is none, and above `MOST_SENSITIVE`.
pub(super) fn sensitivity(value: f64, derivative: f64, parameter: f64) -> Option<f64> {
    // A change in per cent of nothing is nothing, whatever the derivative.
    let by = if parameter == 0.0 { 0.0 } else { derivative * parameter / value };
    // There is no minus zero.
    (by.abs() <= MOST_SENSITIVE).then_some(by + 0.0)
}
