//! Scenes: machine, operation and solver settings in one value.
//!
//! A scene comes from a built-in preset or a TOML file, and each of its keys can be changed with
//! [`Scene::set`]. An invalid value is rejected with one line that names the key, the value and
//! what is allowed. The file format, the command line and the knobs of the explorer all use the
//! table in [`keys`]. Combinations of values are checked by [`Scene::checked`], which returns the
//! type that the solvers take.

mod beyond;
mod builtin;
mod check;
mod checked;
mod differences;
mod error;
mod file;
mod handle;
pub mod keys;
mod law;
mod modes;
mod nearest;
pub mod units;

use serde::Serialize;
use strum::{AsRefStr, Display, EnumString, VariantNames};

pub use builtin::{BUILTIN, Builtin, DEFAULT};
pub(crate) use check::{SPEED_RANGE, STEP_ROUND_OFF, is_speed_range};
pub use check::{read_ends, speed_range};
pub use checked::{Adjustment, CheckedScene};
pub use error::SceneError;
pub(crate) use error::refuse_if;
pub use file::{read_bytes, read_text};
pub use keys::{Allowed, KEYS, Key, Value};
pub use law::ContactLaw;
pub use modes::{frequency_at_rest, hertz_of};
pub use nearest::nearest;
pub use units::Quantity;

use crate::model::{
    BladedDisk, Casing, ContactSurface, Excitation, Initial, LiningLaw, Machine, Operation,
};

/// Solver that computes the motion.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Serialize, Display, EnumString, AsRefStr, VariantNames,
)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum SolverKind {
    /// Explicit central differences, Eqs. (8)-(16); contact is of first order in the time step.
    Explicit,
    /// Event-driven closed-form solutions; serves as the reference.
    Event,
}

/// Model size: which parts of the machine have coordinates.
#[derive(
    Clone, Copy, Debug, PartialEq, Eq, Serialize, Display, EnumString, AsRefStr, VariantNames,
)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum ModelSize {
    /// Casing only; the blades are rigid.
    Rigid,
    /// The paper's four coordinates: two of the casing, two of the disk.
    Modal,
    /// One angle a blade, Eqs. (2)-(3), besides the casing.
    Full,
}

/// Settings of a time simulation.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SolverChoice {
    /// Solver.
    pub kind: SolverKind,
    /// Contact law.
    pub contact: ContactLaw,
    /// Model size.
    pub model: ModelSize,
    /// Time step of the explicit solver \[s\].
    pub step_s: f64,
    /// End of the simulation \[s\].
    pub end_s: f64,
    /// Whether the explicit solver computes every step one by one, and the verdict is not proved
    /// early. Not a key of a scene file.
    #[serde(skip)]
    pub plain: bool,
}

impl Default for SolverChoice {
    fn default() -> Self {
        Self {
            kind: SolverKind::Explicit,
            contact: ContactLaw::Unilateral,
            model: ModelSize::Modal,
            step_s: 1e-7,
            end_s: 0.1,
            plain: false,
        }
    }
}

/// Initial view of the explorer.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct View {
    /// Names of the charts; the first is shown largest.
    pub charts: Vec<String>,
    /// Time at which playback begins, at most the end of the run \[s\].
    pub begin_s: f64,
    /// Speeds of the machine, `FROM:TO` with units; empty for all speeds.
    #[serde(skip_serializing_if = "String::is_empty")]
    pub speeds: String,
}

impl Default for View {
    fn default() -> Self {
        let charts = ["wheel", "response", "gaps", "locked"].map(String::from).to_vec();
        Self { charts, begin_s: 0.0, speeds: String::new() }
    }
}

/// A complete scene: every key has a value, but combinations are not checked yet.
///
/// ```
/// use rubscope_solver::scene::Scene;
/// let mut scene = Scene::builtin("paper-nd3")?;
/// scene.set("operation.speed_rad_s", "450")?;
/// assert_eq!(scene.operation.speed_rad_s, 450.0);
/// let refused = scene.set("bladed_disk.blades", "0").unwrap_err();
/// assert!(refused.to_string().starts_with("bladed_disk.blades = 0"));
/// # Ok::<(), rubscope_solver::scene::SceneError>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Scene {
    /// Version of the file format, 1.
    pub schema: u32,
    /// Title, one line.
    pub title: String,
    /// What the scene shows, for its reader.
    pub note: String,
    /// The bladed disk.
    pub bladed_disk: BladedDisk,
    /// The casing.
    pub casing: Casing,
    /// Friction, restitution and lining.
    pub contact: ContactSurface,
    /// Speed, pulse and nodal diameters.
    pub operation: Operation,
    /// Casing state at t = 0.
    pub initial: Initial,
    /// Engine-order excitation of the blades; off by default.
    pub excitation: Excitation,
    /// Settings of the simulation.
    pub solver: SolverChoice,
    /// Initial view of the explorer.
    pub view: View,
}

impl Scene {
    /// Returns the scene of an empty file, which contains the default value of every key: the
    /// paper's machine, without a title or note.
    #[must_use]
    pub fn base() -> Self {
        Self {
            schema: 1,
            title: String::new(),
            note: String::new(),
            bladed_disk: BladedDisk::default(),
            casing: Casing::default(),
            contact: ContactSurface::default(),
            operation: Operation::default(),
            initial: Initial::default(),
            excitation: Excitation::default(),
            solver: SolverChoice::default(),
            view: View::default(),
        }
    }

    /// Returns the machine at the scene's rotor speed, with all derived quantities.
    #[must_use]
    pub fn machine(&self) -> Machine {
        let (disk, casing) = (self.disk_in_use(), self.casing_in_use());
        let mut machine = Machine::new(&disk, &casing, self.operation.nodal_diameters)
            .with_friction(self.contact.friction)
            .with_lining(self.lining());
        if self.solver.model == ModelSize::Rigid {
            // Rigid blades do not bend, so an inclined tip path has no effect.
            machine.radial_coupling = 0.0;
            machine.rigid_blades = true;
        }
        machine.turn_at(self.operation.speed_rad_s);
        machine
    }

    /// Returns whether contact couples blade and casing vibration, which makes a coincidence
    /// speed dangerous: on a lining, or by blades that bend along an inclined path.
    #[must_use]
    pub fn is_coupled(&self) -> bool {
        let bends = self.solver.model != ModelSize::Rigid;
        let lined = self.solver.contact == ContactLaw::Smooth;
        lined || (bends && self.bladed_disk.radial_coupling != 0.0)
    }

    /// Returns the initial casing position \[m\]: the given one, or, if none is given and the tips
    /// exclude the centre in rigid contact, the nearest position with every gap open.
    #[must_use]
    pub fn start(&self) -> (f64, f64) {
        let Initial { u_c_m, u_s_m, v_c_m_s, v_s_m_s } = self.initial;
        let machine = self.machine();
        let given = [u_c_m, u_s_m, v_c_m_s, v_s_m_s].iter().any(|value| *value != 0.0);
        let lined = self.solver.contact == ContactLaw::Smooth;
        if given || lined {
            return (u_c_m, u_s_m);
        }
        machine.nearest_open((0.0, 0.0), 0.0, |_| 0.0).unwrap_or_default()
    }

    /// Returns a note that the initial casing position is not the given one; `None` if it is.
    #[must_use]
    pub fn start_note(&self) -> Option<String> {
        let (x, y) = self.start();
        ((x, y) != (self.initial.u_c_m, self.initial.u_s_m)).then(|| {
            format!(
                "tips leave the centre outside, so the casing begins at rest at the nearest open \
                 place, u_c = {:.4} um and u_s = {:.4} um",
                1e6 * x,
                1e6 * y
            )
        })
    }

    /// Returns the lining under a blade; `None` with rigid contact.
    #[must_use]
    pub fn lining(&self) -> Option<LiningLaw> {
        (self.solver.contact == ContactLaw::Smooth).then(|| LiningLaw::of(&self.contact))
    }

    /// Returns the largest speed during the run, as a magnitude \[rad/s\].
    #[must_use]
    pub fn fastest_rad_s(&self) -> f64 {
        let operation = &self.operation;
        let last = operation.speed_rad_s + operation.speed_ramp_rad_s2 * self.solver.end_s;
        operation.speed_rad_s.abs().max(last.abs())
    }

    /// Returns the stability limit of the explicit solver's time step, `2/omega_max`, Eq. (9)
    /// \[s\]. On a lining `omega_max^2` is increased by the stiffness of all blades in contact.
    #[must_use]
    pub fn stable_step(&self) -> f64 {
        let machine = self.machine();
        let machine = machine.at(self.fastest_rad_s());
        let fastest = match self.solver.model {
            ModelSize::Rigid => machine.omega_c,
            ModelSize::Modal => machine.omega_c.max(machine.omega_bd),
            ModelSize::Full => machine.omega_c.max(machine.omega_bd_max),
        };
        if self.solver.contact != ContactLaw::Smooth {
            return 2.0 / fastest;
        }
        // All blades in contact with the lining.
        let (lining, blades) = (self.contact.stiffness_n_per_m, f64::from(self.bladed_disk.blades));
        let speed = self.operation.speed_rad_s;
        let turn = machine.casing_friction_at(speed).hypot(1.0);
        let tips = match self.solver.model {
            ModelSize::Rigid => 0.0,
            ModelSize::Modal => machine.coupling_product_at(speed).abs() / machine.blade_modal_mass,
            ModelSize::Full => {
                2.0 * machine.coupling_product_at(speed).abs() / machine.blade_inertia / blades
            }
        };
        let joined = lining * blades * (turn / machine.casing_mass + tips)
            / if machine.polygon.sides > 2 { 2.0 } else { 1.0 };
        2.0 / fastest.hypot(joined.sqrt())
    }

    /// Sets a key from text, as `--set` and the knobs do, and checks the value against the bounds
    /// of that key. The scene is unchanged on error.
    ///
    /// # Errors
    /// The key is unknown, or the value has the wrong type or is out of bounds.
    pub fn set(&mut self, path: &str, text: &str) -> Result<(), SceneError> {
        let key = keys::find(path)?;
        let value = key.parse(text)?;
        self.set_value(key, value)
    }

    /// Sets several keys from text and checks the scene completely.
    ///
    /// # Errors
    /// Names the first key, value or combination that is not allowed.
    pub fn with(mut self, changes: &[(&str, &str)]) -> Result<CheckedScene, SceneError> {
        for (path, text) in changes {
            self.set(path, text)?;
        }
        self.checked()
    }

    /// Sets a key to a value, checked against the bounds of that key.
    ///
    /// # Errors
    /// The value has the wrong type or is out of bounds.
    pub fn set_value(&mut self, key: &Key, value: Value) -> Result<(), SceneError> {
        key.check(&value)?;
        (key.set)(self, value);
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_builtin_scene_loads_and_survives_a_round_trip() {
        for builtin in BUILTIN {
            let scene = Scene::builtin(builtin.name).unwrap();
            assert!(!scene.title.is_empty() && !scene.note.is_empty(), "{}", builtin.name);
            assert_eq!(Scene::from_toml(&scene.to_toml()).unwrap(), scene);
        }
    }

    #[test]
    fn every_key_is_in_the_struct_and_every_field_in_the_table() {
        let mut scene = Scene::base();
        let mode = crate::model::Mode { nodal_diameters: 3, ..Default::default() };
        scene.casing.modes = vec![mode.clone()];
        scene.bladed_disk.modes = vec![mode];
        // A field that is empty is left out.
        scene.view.speeds = "0:1".into();
        let table = toml::Table::try_from(&scene).unwrap();
        let mut paths = Vec::new();
        for (name, value) in &table {
            match value {
                toml::Value::Table(inner) => {
                    paths.extend(inner.keys().map(|leaf| format!("{name}.{leaf}")));
                }
                _ if name == "schema" => {}
                _ => paths.push(name.clone()),
            }
        }
        let mut keys: Vec<&str> = KEYS.iter().map(|key| key.path).collect();
        keys.sort_unstable();
        paths.sort_unstable();
        assert_eq!(paths, keys);
    }
}
