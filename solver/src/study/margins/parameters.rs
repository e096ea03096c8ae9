//! The parameters of a scene as numbers that may carry a derivative, and how each is
//! read and changed.

use num_dual::Dual64;

use crate::model::{BladedDisk, Casing, LiningLaw, Machine, Number, Operation};
use crate::motion::FreeFlight;
use crate::scene::{Allowed, ContactLaw, Key, ModelSize, Scene, SceneError, Value, keys};

pub use crate::scene::keys::CLEARANCE;

const RADIUS: &str = keys::CASING_RADIUS;
const LENGTH: &str = keys::BLADE_LENGTH;
const STIFFNESS: &str = keys::LINING_STIFFNESS;
const SMOOTHING: &str = keys::LINING_SMOOTHING;
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
    pub operation: Operation<T>,
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
/// that stays the same at every speed none that would change it.
pub fn acting(scene: &Scene) -> impl Iterator<Item = &'static Parameter> {
    let lined = scene.solver.contact == ContactLaw::Smooth;
    let changes =
        |parameter: &Parameter| !SELDOM.contains(&parameter.path) || parameter.of(scene) != 0.0;
    PARAMETERS
        .iter()
        .filter(move |parameter| (lined || !parameter.is_of_lining()) && changes(parameter))
}

/// The parameter of this path; none for a key that holds no real number of the
/// machine or its operation.
#[must_use]
pub fn parameter(path: &str) -> Option<&'static Parameter> {
    PARAMETERS.iter().find(|parameter| parameter.path == path)
}

impl Parameter {
    /// The key that it changes.
    fn key(&self) -> Result<&'static Key, SceneError> {
        keys::find(if self.path == CLEARANCE { RADIUS } else { self.path })
    }

    /// Its value in a scene.
    #[must_use]
    pub fn of(&self, scene: &Scene) -> f64 {
        if self.path == CLEARANCE {
            return scene.clearance();
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
            _ => f64::MAX,
        }
    }

    /// Whether it is one of the lining, which rigid contact has not.
    pub(super) fn is_of_lining(&self) -> bool {
        [STIFFNESS, SMOOTHING].contains(&self.path)
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
        self.key().map_or("", |key| key.unit)
    }

    /// The parameters of a scene, with the derivative of this one.
    pub(super) fn seeded(&self, scene: &Scene) -> Parameters<Dual64> {
        let mut all = Parameters::of(scene);
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
        let mut machine = Machine::new(&self.disk, &self.casing, self.operation.nodal_diameters)
            .with_friction(self.friction)
            .with_lining((self.law == ContactLaw::Smooth).then_some(LiningLaw {
                stiffness_n_per_m: self.stiffness,
                smoothing_m: self.smoothing,
            }));
        machine.turn_at(self.operation.speed_rad_s);
        machine
    }
}

/// The sensitivity of a value by a parameter of this value, from its derivative; none
/// where there is none.
pub(super) fn sensitivity(value: f64, derivative: f64, parameter: f64) -> Option<f64> {
    // A change in per cent of nothing is nothing, whatever the derivative.
    let by = if parameter == 0.0 { 0.0 } else { derivative * parameter / value };
    // There is no minus zero.
    by.is_finite().then_some(by + 0.0)
}
