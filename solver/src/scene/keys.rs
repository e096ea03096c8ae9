//! The table of scene keys: path, unit, meaning, bounds, and how to read and write each. The file
//! reader, `--set` and the knobs of the explorer all use it.

use strum::VariantNames;

pub use super::differences::{differences, differing, view_differences};
pub use super::handle::{Handle, Turn};
use super::modes::{self, MOST_HZ, Structure};
use super::units::{Quantity, UnitError};
use super::{ContactLaw, ModelSize, Scene, SceneError, SolverKind};
use serde::Serialize;

use crate::model::ModePart;

/// Value of a key.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Value {
    /// Real number.
    Real(f64),
    /// Whole number, zero or more.
    Whole(u64),
    /// Line of text, or a word from a fixed set.
    Text(String),
    /// List of words.
    Words(Vec<String>),
    /// List of numbers.
    Numbers(Vec<f64>),
}

impl std::fmt::Display for Value {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Real(x) if *x != 0.0 && !(1e-3..1e6).contains(&x.abs()) => write!(out, "{x:e}"),
            Self::Real(x) => write!(out, "{x}"),
            Self::Whole(n) => write!(out, "{n}"),
            Self::Text(text) => write!(out, "{text:?}"),
            Self::Words(words) => write!(out, "{words:?}"),
            Self::Numbers(numbers) => write!(out, "{numbers:?}"),
        }
    }
}

/// Allowed values of a key.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Allowed {
    /// A finite number from `min` to `max`; `min` itself is excluded if `above` is set.
    Real {
        /// Lower bound.
        min: f64,
        /// Upper bound, included.
        max: f64,
        /// Whether the lower bound is excluded.
        above: bool,
    },
    /// A whole number from `min` to `max`.
    Whole {
        /// Lower bound, included.
        min: u64,
        /// Upper bound, included.
        max: u64,
    },
    /// One of these words.
    OneOf(&'static [&'static str]),
    /// One or more of these words, without repetition.
    SomeOf(&'static [&'static str]),
    /// A line of text of limited length.
    Text {
        /// Largest number of characters.
        most: usize,
    },
    /// A list of the modes of a structure, as TOML text.
    Modes(&'static Structure),
    /// A list of numbers of limited count and magnitude.
    Numbers {
        /// Largest magnitude.
        size: f64,
        /// Largest count.
        most: usize,
    },
}

impl std::fmt::Display for Allowed {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Real { min, max, above: true } => {
                write!(out, "a number above {} and up to {}", Value::Real(*min), Value::Real(*max))
            }
            Self::Real { min, max, above: false } => {
                write!(out, "a number from {} to {}", Value::Real(*min), Value::Real(*max))
            }
            Self::Whole { min, max } => write!(out, "a whole number from {min} to {max}"),
            Self::OneOf(words) => write!(out, "one of {}", words.join(", ")),
            Self::SomeOf(words) => write!(out, "a list of {}, each once", words.join(", ")),
            Self::Text { most } => write!(out, "a line of text of up to {most} characters"),
            Self::Modes(structure) => write!(out, "a list of modes, each {}", structure.form()),
            Self::Numbers { size, most } => {
                write!(out, "a list of up to {most} numbers from -{size} to {size}")
            }
        }
    }
}

/// Whether a running motion accepts a new value of a key.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Live {
    /// Both solvers accept a new value.
    Always,
    /// Only the explicit solver accepts a new value.
    Steps,
    /// A new value needs a new motion.
    Never,
    /// A new value has no effect, because the key describes the initial state.
    Start,
    /// The key does not affect the motion.
    Aside,
}

/// A key of the scene file.
#[derive(Debug)]
pub struct Key {
    /// Dotted path in the file, such as `operation.speed_rad_s`.
    pub path: &'static str,
    /// Unit, as displayed; `-` for none.
    pub unit: &'static str,
    /// Short description.
    pub what: &'static str,
    /// Whether a running motion accepts a new value.
    pub live: Live,
    /// Allowed values.
    pub allowed: Allowed,
    /// How the explorer turns it; `None` if it has no knob.
    pub handle: Option<Handle>,
    /// Reads the value from a scene.
    pub get: fn(&Scene) -> Value,
    /// Writes a value of the right type to a scene.
    pub(crate) set: fn(&mut Scene, Value),
}

impl Key {
    /// Returns description and unit, for use as an axis title.
    #[must_use]
    pub fn title(&self) -> String {
        if self.unit == "-" {
            self.what.to_string()
        } else {
            format!("{} [{}]", self.what, self.unit)
        }
    }

    /// Rejects a value of the wrong type or out of bounds.
    ///
    /// # Errors
    /// One line with the key, the value and what is allowed.
    pub fn check(&self, value: &Value) -> Result<(), SceneError> {
        let fits = match (value, self.allowed) {
            (Value::Real(x), Allowed::Real { min, max, above }) => {
                x.is_finite() && *x >= min && *x <= max && !(above && *x <= min)
            }
            (Value::Whole(n), Allowed::Whole { min, max }) => (min..=max).contains(n),
            (Value::Text(text), Allowed::OneOf(words)) => words.contains(&text.as_str()),
            (Value::Words(list), Allowed::SomeOf(words)) => {
                // Lists that are too long are rejected first, which bounds the quadratic search for
                // repetitions.
                let distinct = |(place, word): (usize, &String)| !list[..place].contains(word);
                (1..=words.len()).contains(&list.len())
                    && list.iter().all(|word| words.contains(&word.as_str()))
                    && list.iter().enumerate().all(distinct)
            }
            (Value::Numbers(list), Allowed::Numbers { size, most }) => {
                list.len() <= most && list.iter().all(|x| x.abs() <= size)
            }
            (Value::Text(text), Allowed::Modes(list)) => return list.parsed(text).map(drop),
            (Value::Text(text), Allowed::Text { most }) => {
                let length = text.chars().count();
                if length > most {
                    let given = format!("{length} characters");
                    return Err(SceneError::refused(self.path, given, self.allowed.to_string()));
                }
                text.chars().all(is_plain)
            }
            _ => false,
        };
        if fits {
            Ok(())
        } else {
            Err(SceneError::refused(self.path, value, self.allowed.to_string()))
        }
    }

    /// Returns the physical quantity of the key.
    #[must_use]
    pub fn quantity(&self) -> Quantity {
        Quantity::of(self.unit)
    }

    /// Returns its value in a scene, in its unit; NaN if it is no real number.
    #[must_use]
    pub fn real(&self, scene: &Scene) -> f64 {
        match (self.get)(scene) {
            Value::Real(number) => number,
            _ => f64::NAN,
        }
    }

    /// Reads a number within the bounds of this key, real or whole. Errors refer to it as `name`.
    ///
    /// # Errors
    /// The text is not such a number.
    pub fn number(&self, name: &str, text: &str) -> Result<f64, SceneError> {
        match self.parse(text).and_then(|value| self.check(&value).map(|()| value)) {
            Ok(Value::Real(x)) => Ok(x),
            Ok(Value::Whole(n)) => Ok(n as f64),
            Err(SceneError::Unit { why, .. }) => {
                Err(SceneError::Unit { key: name.into(), value: text.into(), why })
            }
            _ => Err(SceneError::refused(name, text, self.allowed.to_string())),
        }
    }

    /// Reads a value of this key's type from text, as given on a command line; a number may have a
    /// unit. Bounds are not checked.
    ///
    /// # Errors
    /// The text is not a value of this type.
    pub fn parse(&self, text: &str) -> Result<Value, SceneError> {
        let refused =
            |text: &str, why| SceneError::not_read(self.path, text, why, self.allowed.to_string());
        let trimmed = text.trim();
        let number = |item: &str| {
            self.quantity().read(item).map_err(|why| match why {
                UnitError::NoNumber => refused(text, why),
                why => refused(item, why),
            })
        };
        Ok(match self.allowed {
            Allowed::Real { .. } => Value::Real(number(trimmed)?),
            Allowed::Numbers { .. } => {
                let list = trimmed.trim_start_matches('[').trim_end_matches(']').trim();
                let items = list.split(',').filter(|_| !list.is_empty());
                let item = |item: &str| number(item.trim().trim_matches('"'));
                Value::Numbers(items.map(item).collect::<Result<_, _>>()?)
            }
            Allowed::Whole { .. } => {
                Value::Whole(trimmed.parse().map_err(|_| refused(text, UnitError::NoNumber))?)
            }
            Allowed::OneOf(_) | Allowed::Modes(_) => Value::Text(trimmed.to_string()),
            Allowed::Text { .. } => Value::Text(text.to_string()),
            Allowed::SomeOf(_) => {
                Value::Words(trimmed.split(',').map(|word| word.trim().to_string()).collect())
            }
        })
    }
}

/// Returns whether a character is visible text and nothing else: not a control character, not a
/// direction mark, not invisible, and allowed in XML. Joiners and variation selectors are excluded
/// too, because terminals disagree on the width of the result.
#[must_use]
pub fn is_plain(c: char) -> bool {
    let acts = matches!(
        c,
        '\u{ad}' | '\u{34f}' | '\u{61c}' | '\u{115f}' | '\u{1160}' | '\u{17b4}' | '\u{17b5}'
            | '\u{180b}'..='\u{180f}' | '\u{200b}'..='\u{200f}' | '\u{2028}'..='\u{202e}'
            | '\u{2060}'..='\u{206f}' | '\u{3164}' | '\u{fe00}'..='\u{fe0f}' | '\u{feff}'
            | '\u{ffa0}' | '\u{fff9}'..='\u{fffb}' | '\u{fffe}' | '\u{ffff}'
            | '\u{1d173}'..='\u{1d17a}' | '\u{e0000}'..='\u{e0fff}'
    );
    !c.is_control() && !acts
}

/// Returns the key with this dotted path.
///
/// # Errors
/// The path is unknown; the message lists the keys of its table.
pub fn find(path: &str) -> Result<&'static Key, SceneError> {
    KEYS.iter().find(|key| key.path == path).ok_or_else(|| unknown(path))
}

/// As [`find`], for a key or the clearance, which can be changed and swept like a key.
///
/// # Errors
/// As [`find`].
pub fn find_varied(path: &str) -> Result<&'static Key, SceneError> {
    if path == CLEARANCE { Ok(&CLEARANCE_KEY) } else { find(path) }
}

/// Returns the error for an unknown key; it lists the keys of the same table, or all tables.
pub(super) fn unknown(path: &str) -> SceneError {
    if path.is_empty() {
        return SceneError::NoKey;
    }
    let table_of = |key: &Key| key.path.split_once('.').map(|(table, _)| table);
    let table = path.split_once('.').map_or(path, |(table, _)| table);
    let of_table = KEYS.iter().filter(|key| table_of(key) == Some(table));
    let mut names: Vec<String> = of_table.map(|key| key.path.into()).collect();
    if names.is_empty() {
        let all = |key| table_of(key).map_or(key.path.into(), |table| format!("{table}.*"));
        names = std::iter::once("schema".into()).chain(KEYS.iter().map(all)).collect();
        names.dedup();
    }
    SceneError::UnknownKey { key: path.to_string(), allowed: names.join(", ") }
}

/// Charts of the explorer, in the order of their digit keys.
pub const CHARTS: &[&str] = &[
    "response",
    "gaps",
    "locked",
    "wheel",
    "map",
    "spectrum",
    "precision",
    "margins",
    "coincidence",
];

/// Builds a [`Key`] from its allowed values, the type of its value, and the expressions that read
/// and write it.
macro_rules! key {
    ($path:expr, $live:ident, $unit:expr, $what:expr, $allowed:expr,
     $kind:ident, |$from:ident| $get:expr, |$to:ident, $value:ident| $set:expr) => {
        Key {
            path: $path,
            unit: $unit,
            what: $what,
            live: Live::$live,
            allowed: $allowed,
            handle: None,
            get: |$from| Value::$kind($get),
            set: |$to, value| {
                if let Value::$kind($value) = value {
                    $set
                }
            },
        }
    };
}
macro_rules! real {
    ($path:expr, $live:ident, $unit:literal, $what:literal, $above:literal $min:literal .. $max:literal, $($field:ident).+) => {
        key!($path, $live, $unit, $what, Allowed::Real { min: $min, max: $max, above: $above },
            Real, |scene| scene.$($field).+, |scene, x| scene.$($field).+ = x)
    };
}
/// As `real`, for a value that modes can set themselves: reads and writes that of the mode in use.
macro_rules! moded {
    ($path:expr, $live:ident, $unit:literal, $what:literal, $above:literal $min:literal .. $max:literal, $in_use:ident.$field:ident, $place:ident $part:ident) => {
        key!(
            $path,
            $live,
            $unit,
            $what,
            Allowed::Real { min: $min, max: $max, above: $above },
            Real,
            |scene| scene.$in_use().$field,
            |scene, x| *scene.$place(ModePart::$part) = x
        )
    };
}
macro_rules! modes {
    ($path:expr, $live:ident, $what:literal, $structure:ident, $table:ident) => {
        key!(
            $path,
            $live,
            "-",
            $what,
            Allowed::Modes(&modes::$structure),
            Text,
            |scene| modes::$structure.text(&scene.$table.modes),
            |scene, text| scene.$table.modes = modes::$structure.modes(&text)
        )
    };
}
macro_rules! whole {
    ($path:expr, $live:ident, $what:literal, $min:literal .. $max:literal, $($field:ident).+) => {
        key!($path, $live, "-", $what, Allowed::Whole { min: $min, max: $max },
            Whole, |scene| u64::from(scene.$($field).+),
            |scene, n| if let Ok(n) = u32::try_from(n) { scene.$($field).+ = n })
    };
}
macro_rules! word {
    ($path:expr, $live:ident, $what:literal, $type:ident, $($field:ident).+) => {
        key!($path, $live, "-", $what, Allowed::OneOf($type::VARIANTS),
            Text, |scene| scene.$($field).+.to_string(),
            |scene, text| if let Ok(choice) = text.parse::<$type>() { scene.$($field).+ = choice })
    };
}
macro_rules! text {
    ($path:expr, $live:ident, $what:literal, $most:literal, $($field:ident).+) => {
        key!($path, $live, "-", $what, Allowed::Text { most: $most },
            Text, |scene| scene.$($field).+.clone(), |scene, text| scene.$($field).+ = text)
    };
}

/// Path of the clearance.
pub const CLEARANCE: &str = "clearance";

/// The clearance `g0 = R_c - l_b` \[m\], negative if the blades rub at rest. No file has it: the
/// casing radius sets it.
pub static CLEARANCE_KEY: Key = Key {
    handle: Some(Handle {
        label: "clearance g0",
        turn: Turn::Decades(1e-9),
        does: "clearance at rest g0 = R_c - l_b; below 0, with the smooth law, all blades rub",
    }),
    ..key!(
        CLEARANCE,
        Never,
        "m",
        "clearance g0",
        Allowed::Real { min: -1e3, max: 1e3, above: false },
        Real,
        |scene| scene.clearance(),
        |scene, g0| scene.casing.radius_m = scene.bladed_disk.blade_length_m + g0
    )
};

/// Path of the frequency of the casing.
pub const CASING_FREQUENCY: &str = "casing.frequency_hz";
/// Path of the frequency of the disk.
pub const BLADE_FREQUENCY: &str = "bladed_disk.frequency_hz";

/// Builds the key of a frequency: 0 of the casing, 1 of the disk.
macro_rules! frequency {
    ($path:ident, $what:literal, $which:literal) => {
        key!(
            $path,
            Steps,
            "Hz",
            $what,
            Allowed::Real { min: 0.0, max: MOST_HZ, above: true },
            Real,
            |scene| scene.frequency($which),
            |scene, hertz| scene.set_frequency($which, hertz)
        )
    };
}

/// The frequencies at rest of the modes in use of casing and disk \[Hz\]. A file has them in its lists
/// of modes; where a mode gives none, the stiffness is set that yields it.
pub static FREQUENCY_KEYS: [Key; 2] = [
    frequency!(CASING_FREQUENCY, "frequency of the casing", 0),
    frequency!(BLADE_FREQUENCY, "frequency of the disk", 1),
];

/// Builds the [`Handle`] of a key, if it has one.
macro_rules! handle {
    () => {
        None
    };
    ($label:literal, $turn:expr, $does:literal) => {
        Some(Handle { label: $label, turn: $turn, does: $does })
    };
}

/// For each row, defines a constant with the path of the key, and adds the key to `KEYS`; behind a
/// key that has a knob stand its label, its steps and its sentence.
macro_rules! keys {
    ($($name:ident $path:literal = $kind:ident($($of:tt)+)
        $(, $label:literal $turn:ident $(($($step:literal),+))? $does:literal)?;)+) => {
        $(
            #[doc = concat!("Path of the key `", $path, "`.")]
            pub const $name: &str = $path;
        )+

        /// All keys except `schema`, in the order of the file.
        pub const KEYS: &[Key] = &[$(Key {
            handle: handle!($($label, Turn::$turn $(($($step),+))?, $does)?),
            ..$kind!($name, $($of)+)
        }),+];
    };
}

keys! {
    TITLE "title" = text(Aside, "one line that names the scene", 200, title);
    NOTE "note" = text(Aside, "what to look for", 4000, note);
    BLADES "bladed_disk.blades" = whole(Never, "number of blades N", 1..4096, bladed_disk.blades),
        "blades N" Whole(1, 10) "number of blades; with n_d it gives the sides that can touch";
    BLADE_LENGTH "bladed_disk.blade_length_m" = real(Never, "m", "blade length l_b", true 0.0..1e3, bladed_disk.blade_length_m),
        "blade l_b" Linear(1e-6, 1e-5) "blade length from the axis to the tip; longer closes the clearance";
    BLADE_INERTIA "bladed_disk.inertia_kg_m2" = moded(Steps, "kg m^2", "blade inertia m_b", true 0.0..1e9, disk_in_use.inertia_kg_m2, disk_part Mass),
        "blade m_b" Decades(1e-9) "moment of inertia of a blade about the axis";
    BLADE_STIFFNESS "bladed_disk.stiffness_nm_per_rad" = moded(Steps, "N m/rad", "blade-to-disk stiffness k_b", true 0.0..1e15, disk_in_use.stiffness_nm_per_rad, disk_part Stiffness),
        "blade k_b" Decades(1e-6) "stiffness of a blade on the disk";
    BLADE_COUPLING "bladed_disk.coupling_nm_per_rad" = real(Steps, "N m/rad", "blade-to-blade stiffness k_bb", false 0.0..1e15, bladed_disk.coupling_nm_per_rad),
        "blade k_bb" Decades(1e-3) "stiffness between neighbouring blades";
    BLADE_DAMPING "bladed_disk.damping_ratio" = moded(Steps, "-", "blade damping zeta_bd", false 0.0..10.0, disk_in_use.damping_ratio, disk_part Damping),
        "damping ζ_bd" Linear(0.005, 0.05) "damping ratio of the blades";
    STIFFENING "bladed_disk.centrifugal_stiffening" = moded(Steps, "-", "centrifugal stiffening, omega^2 + B Omega^2, B", false 0.0..1e3, disk_in_use.centrifugal_stiffening, disk_part Stiffening),
        "stiffening B" Linear(0.1, 0.5) "centrifugal stiffening: ω_bd² grows by B Ω²; 0 in the paper";
    RADIAL_COUPLING "bladed_disk.radial_coupling" = real(Steps, "-", "slope of the blade tip's path, kappa", false -10.0..10.0, bladed_disk.radial_coupling),
        "tip slope κ" Linear(0.05, 0.1) "radial coupling: a blade tip moves outward by κ l_b α; 0 in the paper";
    DISK_DIAMETERS "bladed_disk.nodal_diameters" = whole(Never, "nodal diameters of the disk, 0 for those of the casing, n_b", 0..4096, bladed_disk.nodal_diameters),
        "diameters n_b" Whole(1, 4) "nodal diameters of the disk; 0 for those of the casing";
    MISTUNING "bladed_disk.mistuning" = real(Never, "-", "relative standard deviation of k_b over the blades (full model), sd", false 0.0..0.2, bladed_disk.mistuning),
        "mistuning" Linear(0.005, 0.01) "scatter of the blade stiffness k_b (standard deviation, full model)";
    MISTUNING_SEED "bladed_disk.mistuning_seed" = whole(Never, "seed of the random blade stiffnesses, seed", 0..1_000_000, bladed_disk.mistuning_seed),
        "draw" Whole(1, 10) "seed of the random blade stiffnesses";
    TIPS "bladed_disk.tips_m" = key(Steps, "m", "extra length of each blade, one number per blade", Allowed::Numbers { size: 1.0, most: 4096 }, Numbers,
        |scene| scene.bladed_disk.tips_m.clone(), |scene, list| scene.bladed_disk.tips_m = list);
    TIP_SCATTER "bladed_disk.tip_scatter_m" = real(Steps, "m", "standard deviation of the blade lengths, sigma_b", false 0.0..1.0, bladed_disk.tip_scatter_m),
        "tip scatter" Decades(1e-9) "standard deviation of the blade lengths; 0 for equal tips";
    TIP_SEED "bladed_disk.tip_seed" = whole(Steps, "seed of the random blade lengths, seed_b", 0..1_000_000, bladed_disk.tip_seed),
        "tip seed" Whole(1, 10) "seed of the random blade lengths";
    LONGEST_TIP "bladed_disk.longest_tip_m" = real(Steps, "m", "extra length of blade 1, b_1", false -1.0..1.0, bladed_disk.longest_tip_m),
        "longest tip" Linear(1e-6, 1e-5) "extra length of blade 1; above the clearance it drags the wave";
    ORBIT "bladed_disk.orbit_m" = real(Steps, "m", "eccentricity of the rotor, r", false 0.0..1.0, bladed_disk.orbit_m),
        "orbit r" Decades(1e-9) "eccentricity of the rotor: its centre is off the axis of rotation";
    ORBIT_ANGLE "bladed_disk.orbit_angle_rad" = real(Steps, "rad", "direction of the eccentricity in the rotor, chi", false -100.0..100.0, bladed_disk.orbit_angle_rad),
        "orbit χ" Linear(0.1, 1.0) "direction of the eccentricity in the frame of the rotor";
    DISK_MODES "bladed_disk.modes" = modes(Aside, "modes of the disk, one per number of nodal diameters", DISK, bladed_disk);
    CASING_RADIUS "casing.radius_m" = real(Never, "m", "casing radius R_c", true 0.0..1e3, casing.radius_m),
        "casing R_c" Linear(1e-6, 1e-5) "inner radius of the casing; larger opens the clearance";
    CASING_MASS "casing.modal_mass_kg" = moded(Steps, "kg", "casing modal mass m_c", true 0.0..1e9, casing_in_use.modal_mass_kg, casing_part Mass),
        "casing m_c" Decades(1e-9) "modal mass of the casing; heavier lowers Ω_c";
    CASING_STIFFNESS "casing.modal_stiffness_n_per_m" = moded(Steps, "N/m", "casing modal stiffness k_c", true 0.0..1e15, casing_in_use.modal_stiffness_n_per_m, casing_part Stiffness),
        "casing k_c" Decades(1e-6) "modal stiffness of the casing; stiffer raises Ω_c";
    CASING_DAMPING "casing.damping_ratio" = moded(Steps, "-", "casing damping zeta_c", false 0.0..10.0, casing_in_use.damping_ratio, casing_part Damping),
        "damping ζ_c" Linear(0.005, 0.05) "damping ratio of the casing: damps waves and raises Ω_lock";
    TANGENTIAL_RATIO "casing.tangential_ratio" = real(Steps, "-", "ratio of tangential to radial casing amplitude, tau", false 0.0..10.0, casing.tangential_ratio),
        "tangential τ" Linear(0.05, 0.1) "ratio of tangential to radial casing amplitude: 1/n_d for a ring";
    CLEARANCE_LOSS "casing.clearance_loss_m_s2" = real(Steps, "m s^2", "clearance lost with speed, g0 - c Omega^2, c", false 0.0..1.0, casing.clearance_loss_m_s2),
        "growth c" Decades(1e-14) "clearance lost as blades grow with the speed, c Ω²; 0 in the paper";
    LOBES "casing.lobes" = whole(Steps, "number of lobes of an out-of-round casing, m", 0..4096, casing.lobes),
        "lobes" Whole(1, 5) "number of lobes of an out-of-round casing; 0 for none";
    OUT_OF_ROUND "casing.out_of_round_m" = real(Steps, "m", "height of the lobes, e_m", false 0.0..1.0, casing.out_of_round_m),
        "out of round" Decades(1e-9) "height of the casing's lobes; 0 for a round casing";
    OUT_OF_ROUND_ANGLE "casing.out_of_round_angle_rad" = real(Steps, "rad", "phase of the lobes, psi", false -100.0..100.0, casing.out_of_round_angle_rad),
        "shape ψ" Linear(0.1, 1.0) "phase of the casing's lobes";
    CASING_MODES "casing.modes" = modes(Aside, "modes of the casing, one per number of nodal diameters", CASING, casing);
    FRICTION "contact.friction" = real(Steps, "-", "friction coefficient mu", false 0.0..5.0, contact.friction),
        "friction μ" Linear(0.05, 0.1) "Coulomb friction of the blades, which slide forward; 0 in the paper";
    RESTITUTION "contact.restitution" = real(Steps, "-", "coefficient of restitution e", false 0.0..0.95, contact.restitution),
        "restitution e" Linear(0.05, 0.1) "ratio of rebound speed to impact speed; 0 in the paper";
    LINING_STIFFNESS "contact.stiffness_n_per_m" = real(Steps, "N/m", "stiffness of the lining under a blade (smooth only), k_p", true 0.0..1e15, contact.stiffness_n_per_m),
        "lining k_p" Decades(1e-3) "stiffness of the lining under one blade, for the smooth law";
    LINING_SMOOTHING "contact.smoothing_m" = real(Steps, "m", "depth over which the lining's stiffness sets in (smooth only), eps", false 0.0..1.0, contact.smoothing_m),
        "lining eps" Decades(1e-9) "depth over which the stiffness of the lining sets in, for the smooth law";
    DIAMETERS "operation.nodal_diameters" = whole(Never, "nodal diameters n_d", 0..4096, operation.nodal_diameters),
        "diameters n_d" Whole(1, 4) "nodal diameters of the wave in casing and blades";
    SPEED "operation.speed_rad_s" = real(Always, "rad/s", "rotor speed Omega", false -1e6..1e6, operation.speed_rad_s),
        "speed Ω" Linear(5.0, 50.0) "rotor speed: above Ω_c the wave presses against the blades, above Ω_lock a lock only pushes";
    SPEED_RAMP "operation.speed_ramp_rad_s2" = real(Always, "rad/s^2", "rotor acceleration", false -1e9..1e9, operation.speed_ramp_rad_s2),
        "speed ramp" Decades(1.0) "rotor acceleration; negative slows down";
    PULSE "operation.pulse_n" = real(Steps, "N", "pulse force on u_c", false -1e12..1e12, operation.pulse_n),
        "pulse F" Decades(1.0) "force of the push on u_c that starts the motion";
    PULSE_TIME "operation.pulse_s" = real(Steps, "s", "pulse duration t_p", false 0.0..1e6, operation.pulse_s),
        "pulse time t_p" Decades(1e-9) "duration of the pulse";
    INITIAL_U_C "initial.u_c_m" = real(Start, "m", "u_c at t = 0", false -1e3..1e3, initial.u_c_m),
        "start u_c" Linear(5e-6, 2e-5) "casing position u_c at t = 0; every gap must be open there";
    INITIAL_U_S "initial.u_s_m" = real(Start, "m", "u_s at t = 0", false -1e3..1e3, initial.u_s_m),
        "start u_s" Linear(5e-6, 2e-5) "casing position u_s at t = 0; every gap must be open there";
    INITIAL_V_C "initial.v_c_m_s" = real(Start, "m/s", "rate of u_c at t = 0", false -1e6..1e6, initial.v_c_m_s),
        "start u_c'" Linear(5e-3, 5e-2) "casing velocity along u_c at t = 0";
    INITIAL_V_S "initial.v_s_m_s" = real(Start, "m/s", "rate of u_s at t = 0", false -1e6..1e6, initial.v_s_m_s),
        "start u_s'" Linear(5e-3, 5e-2) "casing velocity along u_s at t = 0";
    EXCITATION "excitation.amplitude_nm" = real(Steps, "N m", "engine-order torque on each blade, 0 for none", false 0.0..1e9, excitation.amplitude_nm),
        "EO torque" Decades(1e-3) "engine-order torque on each blade, fixed in space; 0 for none";
    ENGINE_ORDER "excitation.order" = whole(Steps, "engine order of the torque", 1..4096, excitation.order),
        "EO order" Whole(1, 5) "engine order: cycles of the torque per turn";
    SOLVER "solver.kind" = word(Never, "solver", SolverKind, solver.kind),
        "solver" Words "solver: explicit takes time steps; event goes from impact to impact exactly";
    LAW "solver.contact" = word(Steps, "contact law", ContactLaw, solver.contact),
        "contact" Words "contact law: unilateral pushes; bilateral, the paper's, pulls too; smooth is elastic";
    MODEL "solver.model" = word(Never, "model size", ModelSize, solver.model),
        "model" Words "model size: rigid: casing only; modal: two blade modes too; full: every blade";
    STEP "solver.step_s" = real(Never, "s", "time step h (explicit only)", true 0.0..1e3, solver.step_s),
        "step h" Decades(1e-12) "time step of the explicit solver: shorter is more accurate and slower";
    END "solver.end_s" = real(Aside, "s", "end of the simulation", true 0.0..1e6, solver.end_s),
        "run end" Decades(1e-9) "end of the run; the verdict describes its last tenth";
    VIEW_CHARTS "view.charts" = key(Aside, "-", "charts the explorer opens with", Allowed::SomeOf(CHARTS), Words,
        |scene| scene.view.charts.clone(), |scene, words| scene.view.charts = words);
    VIEW_BEGIN "view.begin_s" = real(Aside, "s", "time at which the explorer starts to play, or solver.end_s if earlier", false 0.0..1e6, view.begin_s);
    VIEW_SPEEDS "view.speeds" = text(Aside, "speeds of the machine, such as 7000rpm:12000rpm, for the survey; empty for all", 60, view.speeds);
}
