//! The scene a command works on: a built-in scene or a file, and options that
//! change it. Precedence: option, then file, then documented default.

use std::os::unix::fs::FileTypeExt;

use clap::Args;
use rubscope_solver::scene::keys::{self, BLADE_DAMPING, CASING_DAMPING};

use super::range::Range;
use super::status::{Refusal, note, say};
use super::words::Words;
use crate::machine::range_doubt;
use crate::sheet::number::{tell_in_rpm, with_typed_unit};
use rubscope_solver::scene::{
    Adjustment, CheckedScene, ContactLaw, DEFAULT, ModelSize, Quantity, Scene, SceneError,
    SolverKind,
};

/// The scene and the options that change it, on every command.
#[derive(Args, Clone, Debug, Default)]
pub struct SceneOptions {
    /// Built-in scene or path of a .toml file [default: paper-nd3]
    #[arg(value_name = "SCENE", value_parser = Words::scenes(), hide_possible_values = true)]
    scene: Option<String>,
    /// Rotor speed; negative turns the other way [rad/s]
    #[arg(long, value_name = "SPEED", allow_hyphen_values = true, help_heading = HEADING)]
    speed: Option<String>,
    #[arg(help = "Force of the pulse on the casing [N]")]
    #[arg(long, value_name = "FORCE", allow_hyphen_values = true, help_heading = HEADING)]
    pulse: Option<String>,
    /// Nodal diameters
    #[arg(long, value_name = "COUNT", allow_hyphen_values = true, help_heading = HEADING)]
    nd: Option<String>,
    /// Damping ratio of the casing
    #[arg(long, value_name = "RATIO", allow_hyphen_values = true, help_heading = HEADING)]
    zeta_casing: Option<String>,
    /// Damping ratio of the bladed disk
    #[arg(long, value_name = "RATIO", allow_hyphen_values = true, help_heading = HEADING)]
    zeta_disk: Option<String>,
    /// explicit: the paper's time steps; event: closed forms between contacts
    #[arg(long, value_name = "KIND", help_heading = HEADING,
          value_parser = Words::of::<SolverKind>(), hide_possible_values = true)]
    solver: Option<String>,
    /// unilateral: contact only pushes; bilateral: the paper's equality, which may pull;
    /// smooth: an elastic lining
    #[arg(long, value_name = "LAW", help_heading = HEADING,
          value_parser = Words::of::<ContactLaw>(), hide_possible_values = true)]
    contact: Option<String>,
    /// rigid: casing only; modal: the paper's four coordinates; full: every blade
    #[arg(long, value_name = "SIZE", help_heading = HEADING,
          value_parser = Words::of::<ModelSize>(), hide_possible_values = true)]
    model: Option<String>,
    #[arg(help = "Time step of the explicit solver [s]")]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, help_heading = HEADING)]
    step: Option<String>,
    #[arg(help = "End of the simulation [s]")]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true, help_heading = HEADING)]
    end: Option<String>,
    /// Any key of the scene file, such as bladed_disk.blades=24; repeatable, applied last
    #[arg(long, value_name = "PATH=VALUE", allow_hyphen_values = true, help_heading = HEADING)]
    set: Vec<String>,
    /// Speeds in rpm, shown and given without a unit; files, JSON and --set keep rad/s
    #[arg(long, help_heading = HEADING)]
    rpm: bool,
}

/// Notes that a range of speeds without a unit looks like one in rpm. `text` is the range as given
/// with `option`; `range` has its ends \[rad/s\].
pub(super) fn ask_unit(option: &str, text: &str, range: [f64; 2], scene: &Scene) {
    let is_bare = text.split(':').take(2).all(|end| Quantity::bare(end).is_some());
    let doubt = is_bare.then(|| range_doubt(scene, range)).flatten();
    doubt.into_iter().for_each(|doubt| note(format!("rubscope: {option}: {doubt}")));
}

const HEADING: &str = "Options that change the scene";

/// A checked scene, and the ranges that its options give to the keys that the command sweeps.
#[derive(Clone, Debug, PartialEq)]
pub struct Resolved {
    /// The scene; a swept key has the first value of its range.
    pub scene: CheckedScene,
    ranges: Vec<(&'static str, Range)>,
}

impl Resolved {
    /// Returns the values of a swept key, in its SI unit; a single value is a range of one. `None`
    /// if its option is missing.
    pub fn range(&self, key: &str) -> Option<Range> {
        self.ranges.iter().find(|(swept, _)| *swept == key).map(|(_, range)| *range)
    }
}

impl SceneOptions {
    /// Returns the name or the path of the scene as typed; `None` if the user gave none.
    pub fn name(&self) -> Option<&str> {
        self.scene.as_deref()
    }

    /// Returns whether speeds are shown in rpm.
    pub fn in_rpm(&self) -> bool {
        self.rpm
    }

    /// Returns the speed or range given with `--speed`, as typed, with `rpm` appended if `--rpm`
    /// applies to it; `None` without the option.
    pub fn speed(&self) -> Option<String> {
        self.speed.as_ref().map(|text| with_typed_unit(text, Quantity::Speed))
    }

    /// Returns the scene that these options describe. If a key had to be adjusted to fit them,
    /// a message on standard error says so.
    ///
    /// # Errors
    /// There is no such scene, or a key, value or combination is refused.
    pub fn scene(&self) -> anyhow::Result<CheckedScene> {
        Ok(self.resolve(&[])?.scene)
    }

    /// Notes that a single speed without a unit looks like one in rpm.
    pub(super) fn ask_speed(&self, scene: &Scene) {
        if let Some(text) = self.speed().filter(|text| !text.contains(':')) {
            ask_unit("--speed", &text, [scene.operation.speed_rad_s; 2], scene);
        }
    }

    /// Notes each damping ratio that is a default: neither the scene file nor an option sets it.
    pub(super) fn note_assumed(&self, scene: &Scene) {
        let file = self.name().filter(|name| name.contains(['.', '/']));
        let file = file.filter(|name| std::fs::metadata(name).is_ok_and(|found| found.is_file()));
        let text = file.and_then(|name| std::fs::read_to_string(name).ok());
        let Some(Ok(table)) = text.map(|text| text.parse::<toml::Table>()) else { return };
        for (key, option, value) in [
            (CASING_DAMPING, "--zeta-casing", scene.casing.damping_ratio),
            (BLADE_DAMPING, "--zeta-disk", scene.bladed_disk.damping_ratio),
        ] {
            let Some((part, name)) = key.split_once('.') else { continue };
            let has = |table: &toml::Value| table.get(name).is_some();
            let every =
                |modes: &toml::Value| modes.as_array().is_some_and(|all| all.iter().all(has));
            let part = table.get(part);
            let in_file = part.is_some_and(|of| has(of) || of.get("modes").is_some_and(every));
            if !(in_file || self.sets(key)) {
                note(format!("rubscope: {key}: {value} is assumed ({option})"));
            }
        }
    }

    /// As [`Self::scene`], where the options of the keys `swept` may be ranges `FROM:TO:COUNT`.
    ///
    /// # Errors
    /// As `scene`, which is checked at both ends of each range.
    pub fn resolve(&self, swept: &[&str]) -> anyhow::Result<Resolved> {
        self.apply(read_scene(self.scene.as_deref().unwrap_or(DEFAULT))?, swept)
    }

    /// Applies these options to `scene` instead of the scene they name.
    ///
    /// # Errors
    /// As `scene`.
    pub fn change(&self, scene: Scene) -> anyhow::Result<CheckedScene> {
        Ok(self.apply(scene, &[])?.scene)
    }

    fn apply(&self, mut scene: Scene, swept: &[&str]) -> anyhow::Result<Resolved> {
        // What the scene is refused for also without the options has the name of its file.
        let own = scene.clone();
        let refused = || own.checked().and_then(|own| own.slides()).err();
        let in_file = |error: SceneError| match self.name() {
            Some(file) if refused().as_ref() == Some(&error) => error.in_file(file),
            _ => error,
        };
        tell_in_rpm(self.rpm);
        let mut ranges = Vec::new();
        for (option, path, text) in self.named() {
            let Some(text) = text else { continue };
            let (key, is_swept) = (keys::find(path)?, swept.contains(&path));
            let text = with_typed_unit(text, key.quantity());
            if is_swept && text.contains(':') {
                let range = Range::parse(option, &text, key.quantity())?;
                if path == keys::SPEED {
                    ask_unit(option, &text, [range.from, range.to], &scene);
                }
                scene.set(path, &range.from.to_string())?;
                ranges.push((path, range));
                continue;
            }
            scene.set(path, &text)?;
            if is_swept {
                let value = key.real(&scene);
                ranges.push((path, Range { from: value, to: value, count: 1 }));
            }
        }
        for assignment in &self.set {
            let (key, text) = assignment.split_once('=').ok_or_else(|| {
                Refusal::of("--set", assignment, "PATH=VALUE, such as bladed_disk.blades=24")
            })?;
            scene.set(key.trim(), text)?;
        }
        let made = scene.make_compatible(|key| self.sets(key));
        for (key, range) in &ranges {
            let mut last = scene.clone();
            last.set(key, &range.to.to_string())?;
            last.checked().map_err(in_file)?;
        }
        let scene = scene.checked().map_err(in_file)?;
        if !swept.contains(&keys::SPEED) {
            scene.slides().map_err(in_file)?;
        }
        note_adjusted(&made);
        Ok(Resolved { scene, ranges })
    }

    /// Returns whether an option sets this key.
    pub(super) fn sets(&self, key: &str) -> bool {
        let is_named = self.named().into_iter().any(|(_, of, text)| of == key && text.is_some());
        let name = |set: &String| set.split('=').next().is_some_and(|name| name.trim() == key);
        is_named || self.set.iter().any(name)
    }

    /// Returns the name of every option that sets exactly one key, that key, and the text given
    /// with the option; `None` for an option that is missing.
    fn named(&self) -> [(&'static str, &'static str, Option<&String>); 10] {
        [
            ("--speed", keys::SPEED, self.speed.as_ref()),
            ("--pulse", keys::PULSE, self.pulse.as_ref()),
            ("--nd", keys::DIAMETERS, self.nd.as_ref()),
            ("--zeta-casing", keys::CASING_DAMPING, self.zeta_casing.as_ref()),
            ("--zeta-disk", keys::BLADE_DAMPING, self.zeta_disk.as_ref()),
            ("--solver", keys::SOLVER, self.solver.as_ref()),
            ("--contact", keys::LAW, self.contact.as_ref()),
            ("--model", keys::MODEL, self.model.as_ref()),
            ("--step", keys::STEP, self.step.as_ref()),
            ("--end", keys::END, self.end.as_ref()),
        ]
    }
}

/// Reads a built-in scene or a scene file. Reading a named pipe blocks until someone writes to it,
/// so a message says that the program is waiting.
///
/// # Errors
/// As `Scene::load_unchecked`.
pub(super) fn read_scene(name: &str) -> Result<Scene, SceneError> {
    let is_pipe = std::fs::metadata(name).is_ok_and(|found| found.file_type().is_fifo());
    // A shell's own pipe (`<(...)`) has a path in these directories, and a writer.
    if is_pipe && !["/dev/", "/proc/"].iter().any(|folder| name.starts_with(folder)) {
        say(&format!("rubscope: {name} is a pipe: waiting for its writer"));
    }
    Scene::load_unchecked(name)
}

/// Notes each key that was changed because another one requires it.
pub(super) fn note_adjusted(made: &[Adjustment]) {
    for Adjustment { key, from, to, why } in made {
        note(format!("rubscope: took {key} = {to:?} instead of the scene's {from:?}, which {why}"));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_not_asked_for_is_left_alone() {
        for given in [&[][..], &["solver.step_s"], &["solver.kind", "solver.contact"]] {
            let mut scene = Scene::base();
            scene.solver.kind = SolverKind::Event;
            scene.solver.contact = ContactLaw::Bilateral;
            let before = scene.clone();
            assert!(scene.make_compatible(|key| given.contains(&key)).is_empty());
            assert_eq!(scene, before);
        }
    }

    #[test]
    fn the_solver_follows_what_only_the_explicit_one_can_do() {
        let mut scene = Scene::base().as_reference();
        scene.solver.contact = ContactLaw::Bilateral;
        let mut oval = Scene::base().as_reference();
        (oval.casing.lobes, oval.casing.out_of_round_m) = (3, 1e-6);
        for (scene, asked) in [(scene, "solver.contact"), (oval, "casing.out_of_round_m")] {
            let (mut left, mut made) = (scene.clone(), scene);
            assert_eq!(left.make_compatible(|key| key == "solver.step_s"), []);
            assert_eq!(made.make_compatible(|key| key == asked).len(), 1);
            assert_eq!(made.solver.kind, SolverKind::Explicit);
        }
    }
}
