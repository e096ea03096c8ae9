//! The lists `[[casing.modes]]` and `[[bladed_disk.modes]]`: reading, writing, and which mode is in
//! use for the nodal diameters of the scene.
//!
//! A value that a mode does not set is that of the structure. A frequency replaces the stiffness
//! that yields it, whatever the mass is: `k_c = m_c (2 pi f)^2` for the casing, and for the disk,
//! with the given `k_bb`, `k_b = m_b (2 pi f)^2 - 4 k_bb sin^2(pi n/N)`. Frequencies of a rotating
//! disk are converted to rest by `f^2 = f_0^2 + B (Omega/2 pi)^2`.

use std::f64::consts::TAU;

use toml::{Table, Value as Toml};

use super::units::Quantity;
use super::{Scene, SceneError, Value, file, keys};
use crate::model::{BladedDisk, Casing, Mode, ModePart, given_frequency, neighbour_stiffness};
use crate::numeric::rounding::rounded;

/// Names of a mode's values in the file.
const DIAMETERS: &str = "nodal_diameters";
const FREQUENCY: &str = "frequency_hz";
/// Name of the rotor speed at which the frequency was determined.
const AT_SPEED: &str = "at_speed_rad_s";
/// Largest accepted frequency, beyond that of any machine \[Hz\].
pub(crate) const MOST_HZ: f64 = 1e9;

/// A structure with modes: the key of its list, and the keys of the values that a mode can set.
#[derive(Debug, PartialEq)]
pub struct Structure {
    path: &'static str,
    keys: &'static [(&'static str, ModePart)],
}

pub(super) const CASING: Structure = Structure {
    path: keys::CASING_MODES,
    keys: &[
        (keys::CASING_MASS, ModePart::Mass),
        (keys::CASING_STIFFNESS, ModePart::Stiffness),
        (keys::CASING_DAMPING, ModePart::Damping),
    ],
};
pub(super) const DISK: Structure = Structure {
    path: keys::DISK_MODES,
    keys: &[
        (keys::BLADE_INERTIA, ModePart::Mass),
        (keys::BLADE_STIFFNESS, ModePart::Stiffness),
        (keys::BLADE_DAMPING, ModePart::Damping),
        (keys::STIFFENING, ModePart::Stiffening),
    ],
};

/// Returns the name of a key within its table.
fn leaf(path: &str) -> &str {
    path.split_once('.').map_or(path, |(_, leaf)| leaf)
}

impl Structure {
    /// Reads the list of modes from a scene file.
    ///
    /// # Errors
    /// A mode has an unknown key, a value that is not allowed, or the nodal diameters of another
    /// one.
    fn read(&self, items: &[Toml]) -> Result<Vec<Mode>, SceneError> {
        let mut found = Vec::with_capacity(items.len());
        for (place, item) in items.iter().enumerate() {
            let name = format!("{}[{}]", self.path, place + 1);
            let Toml::Table(table) = item else {
                return Err(SceneError::refused(
                    name,
                    file::one_line(item),
                    format!("a mode {}", self.form()),
                ));
            };
            found.push(self.mode(&name, table)?);
        }
        found.sort_by_key(|(mode, _)| mode.nodal_diameters);
        let of_one = found.chunk_by(|(a, _), (b, _)| a.nodal_diameters == b.nodal_diameters);
        of_one.map(|modes| self.at_rest(modes)).collect()
    }

    /// Combines the entries for one number of nodal diameters, given at one speed or at two, into
    /// one mode at rest.
    fn at_rest(&self, modes: &[(Mode, Option<f64>)]) -> Result<Mode, SceneError> {
        let of = |(mode, speed): &(Mode, Option<f64>)| {
            speed.map(|speed| (mode.frequency_hz.unwrap_or(0.0), speed))
        };
        let speeds: Vec<(f64, f64)> = modes.iter().filter_map(of).collect();
        let mut mode = modes.first().map(|(mode, _)| mode.clone()).unwrap_or_default();
        if modes.len() > speeds.len().max(1) {
            return Err(SceneError::refused(
                format!("{}.{DIAMETERS}", self.path),
                format!("{} twice", mode.nodal_diameters),
                "one mode for each number of nodal diameters",
            ));
        }
        if !speeds.is_empty() {
            let name = format!("{}.{FREQUENCY}", self.path);
            let known = modes.iter().find_map(|(mode, _)| mode.stiffening);
            let (rest, stiffening) = frequency_at_rest(&name, &speeds, known)?;
            (mode.frequency_hz, mode.stiffening) = (Some(rest), stiffening);
        }
        Ok(mode)
    }

    /// Returns the names of the values that a mode can have, as words for an error message.
    pub(super) fn form(&self) -> String {
        format!("with {DIAMETERS} and any of {}", self.names().join(", "))
    }

    fn names(&self) -> Vec<&'static str> {
        let mut names: Vec<_> = self.keys.iter().map(|(path, _)| leaf(path)).collect();
        names.insert(2, FREQUENCY);
        names.extend((*self == DISK).then_some(AT_SPEED));
        names
    }

    /// Reads a mode, and the speed at which its frequency was determined.
    fn mode(&self, name: &str, table: &Table) -> Result<(Mode, Option<f64>), SceneError> {
        let (mut mode, mut diameters, mut speed) = (Mode::default(), None, None);
        for (entry, value) in table {
            let path = format!("{name}.{entry}");
            let own = self.keys.iter().find(|(path, _)| leaf(path) == entry);
            if let Some((key, part)) = own {
                *mode.part_mut(*part) = Some(number(&path, value, keys::find(key)?)?);
            } else if entry == DIAMETERS {
                let key = keys::find(keys::DIAMETERS)?;
                let whole = value.as_integer().and_then(|n| u32::try_from(n).ok());
                let allowed = whole.filter(|n| key.check(&Value::Whole(u64::from(*n))).is_ok());
                diameters = Some(allowed.ok_or_else(|| {
                    SceneError::refused(&path, file::one_line(value), key.allowed.to_string())
                })?);
            } else if entry == FREQUENCY {
                mode.frequency_hz = Some(hertz(&path, value)?);
            } else if entry == AT_SPEED && *self == DISK {
                speed = Some(number(&path, value, keys::find(keys::SPEED)?)?);
            } else {
                let allowed = format!("{DIAMETERS}, {}", self.names().join(", "));
                return Err(SceneError::UnknownKey { key: path, allowed });
            }
        }
        mode.nodal_diameters = diameters.ok_or_else(|| {
            SceneError::refused(
                name,
                format!("{{ {} }}", short(table)),
                format!("a mode {}", self.form()),
            )
        })?;
        if let (Some(frequency), Some(_)) = (mode.frequency_hz, mode.stiffness) {
            let stiffness = leaf(self.keys[1].0);
            let allowed = format!("{FREQUENCY} or {stiffness}, not both");
            return Err(SceneError::refused(format!("{name}.{FREQUENCY}"), frequency, allowed));
        }
        Ok((mode, speed))
    }

    /// Formats the list in one line, as `--set` accepts it.
    pub(super) fn text(&self, modes: &[Mode]) -> String {
        let each = modes.iter().map(|mode| {
            let values: Vec<String> =
                self.values(mode).map(|(name, value)| format!("{name} = {value}")).collect();
            format!("{{ {} }}", values.join(", "))
        });
        format!("[{}]", each.collect::<Vec<_>>().join(", "))
    }

    /// Formats the list as part of a scene file.
    pub(super) fn blocks(&self, modes: &[Mode]) -> String {
        let block = |mode: &Mode| {
            let values: String =
                self.values(mode).map(|(name, value)| format!("{name} = {value}\n")).collect();
            format!("\n[[{}]]\n{values}", self.path)
        };
        modes.iter().map(block).collect()
    }

    fn values(&self, mode: &Mode) -> impl Iterator<Item = (&'static str, String)> {
        let of = |(path, part): &(&'static str, ModePart)| (leaf(path), mode.part(*part));
        let mut parts: Vec<_> = self.keys.iter().map(of).collect();
        parts.insert(2, (FREQUENCY, mode.frequency_hz));
        let numbers =
            parts.into_iter().filter_map(|(name, value)| Some((name, format!("{:?}", value?))));
        [(DIAMETERS, mode.nodal_diameters.to_string())].into_iter().chain(numbers)
    }

    /// Reads such a list from its text.
    ///
    /// # Errors
    /// States the reason why it is none.
    pub(super) fn parsed(&self, text: &str) -> Result<Vec<Mode>, SceneError> {
        // Most scenes have no modes, and each of their checks comes here.
        if text == "[]" {
            return Ok(Vec::new());
        }
        let read = format!("modes = {text}").parse::<Table>().ok();
        match read.as_ref().and_then(|table| table.get("modes")) {
            Some(Toml::Array(items)) if read.as_ref().is_some_and(|table| table.len() == 1) => {
                self.read(items)
            }
            _ => Err(SceneError::refused(
                self.path,
                text,
                format!("a list of modes, each {}", self.form()),
            )),
        }
    }

    /// Returns the modes of a text that [`parsed`](Self::parsed) accepts.
    pub(super) fn modes(&self, text: &str) -> Vec<Mode> {
        self.parsed(text).unwrap_or_default()
    }
}

/// Returns the frequency at rest and `B`, from frequencies at rotor speeds \[Hz, rad/s\]: two or
/// more frequencies, one with a known `B`, or one at standstill. More than two are fitted by least
/// squares of `f^2` over `(Omega/2 pi)^2`.
///
/// # Errors
/// No `B` within its bounds yields these frequencies, or there are too few. The message refers to
/// them as `name`.
pub fn frequency_at_rest(
    name: &str,
    speeds: &[(f64, f64)],
    known: Option<f64>,
) -> Result<(f64, Option<f64>), SceneError> {
    let squares: Vec<_> = speeds.iter().map(|(f, speed)| (f * f, (speed / TAU).powi(2))).collect();
    let mean = |of: &dyn Fn(&(f64, f64)) -> f64| {
        squares.iter().map(of).sum::<f64>() / squares.len() as f64
    };
    let (f_mean, speed_mean) = (mean(&|(f, _)| *f), mean(&|(_, speed)| *speed));
    let stiffening = match (speeds, known) {
        ([one], known) if known.is_some() || one.1 == 0.0 => known,
        ([_, _, ..], None) => Some(
            mean(&|(f, speed)| (f - f_mean) * (speed - speed_mean))
                / mean(&|(_, speed)| (speed - speed_mean).powi(2)),
        ),
        _ => Some(f64::NAN),
    };
    let rest = (f_mean - stiffening.unwrap_or(0.0) * speed_mean).sqrt();
    let key = keys::find(keys::STIFFENING)?;
    let is_known = stiffening.is_none_or(|b| key.check(&Value::Real(b)).is_ok());
    if is_known && rest > 0.0 {
        return Ok((rest, stiffening));
    }
    if let Some(b) = stiffening.filter(|b| *b > 0.0 && !is_known && rest > 0.0) {
        let why = "for these frequencies and speeds; one of the two may have another unit";
        let allowed = format!("{} {why}", key.allowed);
        return Err(SceneError::refused(format!("{name}: B"), rounded(b, 4), allowed));
    }
    let given =
        speeds.iter().map(|(hertz, speed)| format!("{hertz} Hz at {} rad/s", rounded(*speed, 9)));
    let allowed = "two of them or more, the higher ones at the higher speeds, or one with its \
                   centrifugal_stiffening B and above what that alone gives";
    Err(SceneError::refused(name, given.collect::<Vec<_>>().join(" and "), allowed))
}

/// Formats a table in one line.
fn short(table: &Table) -> String {
    let values = table.iter().map(|(name, value)| format!("{name} = {}", file::one_line(value)));
    values.collect::<Vec<_>>().join(", ")
}

/// Reads a number of a mode, within the bounds of the structure's key.
fn number(path: &str, value: &Toml, key: &keys::Key) -> Result<f64, SceneError> {
    if let Toml::String(text) = value {
        return key.number(path, text);
    }
    let allowed = plain(value).filter(|x| key.check(&Value::Real(*x)).is_ok());
    allowed.ok_or_else(|| SceneError::refused(path, value, key.allowed.to_string()))
}

/// Returns the value of a TOML float or integer; `None` for any other type.
fn plain(value: &Toml) -> Option<f64> {
    value.as_float().or_else(|| value.as_integer().map(|n| n as f64))
}

/// Reads a frequency; a number without a unit is in hertz, as the name of the key says.
fn hertz(path: &str, value: &Toml) -> Result<f64, SceneError> {
    match value {
        Toml::String(text) => hertz_of(path, text),
        value => frequency(path, file::one_line(value), plain(value)),
    }
}

/// Reads a frequency from text; a number without a unit is in hertz. Errors refer to it as `path`.
///
/// # Errors
/// The text is not a frequency of a machine.
pub fn hertz_of(path: &str, text: &str) -> Result<f64, SceneError> {
    // Rounded to 14 digits, so that the conversion through 2 pi turns 310.7 Hz into 310.7.
    let with_unit = || Quantity::Speed.read(text).map(|omega| rounded(omega / TAU, 14));
    let given = Quantity::bare(text).map_or_else(with_unit, Ok);
    let given = given.map_err(|why| SceneError::not_read(path, text, why, hertz_allowed()))?;
    frequency(path, text.to_string(), Some(given))
}

fn hertz_allowed() -> String {
    format!("a frequency above 0 and up to {MOST_HZ:e} Hz")
}

fn frequency(path: &str, given: String, hertz: Option<f64>) -> Result<f64, SceneError> {
    let allowed = hertz.filter(|hertz| *hertz > 0.0 && *hertz <= MOST_HZ);
    allowed.ok_or_else(|| SceneError::refused(path, given, hertz_allowed()))
}

/// Rejects disk modes that would need a negative blade stiffness.
///
/// # Errors
/// The frequency of a mode is below that of the blade-to-blade coupling alone.
pub(super) fn check(scene: &Scene) -> Result<(), SceneError> {
    let disk = &scene.bladed_disk;
    let stiffness = |mode: &Mode| disk.at(mode.nodal_diameters).stiffness_nm_per_rad;
    let Some(mode) = disk.modes.iter().find(|mode| stiffness(mode) <= 0.0) else { return Ok(()) };
    let inertia = mode.mass.unwrap_or(disk.inertia_kg_m2);
    let (diameters, coupling) = (mode.nodal_diameters, disk.coupling_nm_per_rad);
    let neighbours = neighbour_stiffness(coupling, diameters, disk.blades);
    let hertz = |stiffness: f64| (stiffness / inertia).sqrt() / TAU;
    let given = hertz(neighbours + stiffness(mode));
    let least = hertz(neighbours);
    let allowed = format!(
        "above {least:.4} at {diameters} nodal diameters, which {} = {coupling} alone gives",
        keys::BLADE_COUPLING
    );
    let name = format!("{}.{FREQUENCY}", keys::DISK_MODES);
    Err(SceneError::refused(name, format!("{given:.4}"), allowed))
}

impl Scene {
    /// Returns the casing with the values of the mode that has the scene's nodal diameters.
    #[must_use]
    pub fn casing_in_use(&self) -> Casing {
        self.casing.at(self.operation.nodal_diameters)
    }

    /// Returns the disk with the values of the mode in use.
    #[must_use]
    pub fn disk_in_use(&self) -> BladedDisk {
        self.bladed_disk.at(self.disk_diameters())
    }

    /// Returns the nodal diameters of the disk modes in use.
    pub(crate) fn disk_diameters(&self) -> u32 {
        self.bladed_disk.diameters_beside(self.operation.nodal_diameters)
    }

    /// Returns the frequencies that the modes in use of casing and disk give in place of a
    /// stiffness; `None` where no mode gives one \[Hz\].
    pub(crate) fn frequencies_in_use(&self) -> [Option<f64>; 2] {
        [
            given_frequency(&self.casing.modes, self.operation.nodal_diameters),
            given_frequency(&self.bladed_disk.modes, self.disk_diameters()),
        ]
    }

    /// Returns the frequency of the mode in use of the casing (0) or the disk (1), at rest if it is
    /// given \[Hz\].
    pub(super) fn frequency(&self, which: usize) -> f64 {
        let of_stiffness = || {
            let machine = self.machine();
            [machine.omega_c, machine.omega_bd][which] / TAU
        };
        self.frequencies_in_use()[which].unwrap_or_else(of_stiffness)
    }

    /// Sets the frequency of the mode in use of the casing (0) or the disk (1) \[Hz\]. If the mode
    /// gives no frequency, its stiffness is set instead.
    pub(super) fn set_frequency(&mut self, which: usize, hertz: f64) {
        let diameters = [self.operation.nodal_diameters, self.disk_diameters()][which];
        let modes = if which == 0 { &mut self.casing.modes } else { &mut self.bladed_disk.modes };
        let mode = modes.iter_mut().find(|mode| mode.nodal_diameters == diameters);
        if let Some(given) = mode.and_then(|mode| mode.frequency_hz.as_mut()) {
            *given = hertz;
            return;
        }
        let square = (TAU * hertz).powi(2);
        if which == 0 {
            let mass = self.casing_in_use().modal_mass_kg;
            *self.casing_part(ModePart::Stiffness) = mass * square;
        } else {
            let BladedDisk { inertia_kg_m2, coupling_nm_per_rad, blades, .. } = self.disk_in_use();
            let neighbours = neighbour_stiffness(coupling_nm_per_rad, diameters, blades);
            *self.disk_part(ModePart::Stiffness) = inertia_kg_m2 * square - neighbours;
        }
    }

    /// Returns a value of the casing's mode in use.
    pub(super) fn casing_part(&mut self, part: ModePart) -> &mut f64 {
        self.casing.part_at(self.operation.nodal_diameters, part)
    }

    /// Returns a value of the disk's mode in use.
    pub(super) fn disk_part(&mut self, part: ModePart) -> &mut f64 {
        self.bladed_disk.part_at(self.disk_diameters(), part)
    }

    /// Returns the scene without the lists of modes.
    pub(super) fn without_modes(&self) -> Self {
        let mut scene = self.clone();
        scene.casing.modes.clear();
        scene.bladed_disk.modes.clear();
        scene
    }

    /// Returns a sentence (without full stop) if a list of modes exists but lacks the nodal
    /// diameters in use, so that the structure's own values apply.
    #[must_use]
    pub fn modes_note(&self) -> Option<String> {
        let missing = |modes: &[Mode], diameters: u32| {
            !modes.is_empty() && modes.iter().all(|mode| mode.nodal_diameters != diameters)
        };
        let note = |modes: &[Mode], diameters: u32, name: &str| {
            missing(modes, diameters).then(|| {
                let known: Vec<String> =
                    modes.iter().map(|mode| mode.nodal_diameters.to_string()).collect();
                let plural = if diameters == 1 { "" } else { "s" };
                format!(
                    "no mode of the {name} with {diameters} nodal diameter{plural} is known \
                     (known: {}): the {name}'s common values are used",
                    listed(&known)
                )
            })
        };
        let casing = note(&self.casing.modes, self.operation.nodal_diameters, "casing");
        let disk = note(&self.bladed_disk.modes, self.disk_diameters(), "disk");
        let notes: Vec<String> = casing.into_iter().chain(disk).collect();
        (!notes.is_empty()).then(|| notes.join("; "))
    }
}

/// Largest count of numbers that a note lists in full.
const LISTED: usize = 8;

fn listed(known: &[String]) -> String {
    match known {
        [first @ .., last] if known.len() > LISTED => {
            let some: Vec<&str> = first.iter().take(LISTED - 2).map(String::as_str).collect();
            format!("{} ... {last}", some.join(", "))
        }
        all => all.join(", "),
    }
}
