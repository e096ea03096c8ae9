//! The command line that reproduces a result, and the origin that output files record: program,
//! version, command and scene.

use std::fmt::{Display, Formatter};

use serde_json::{Value, json};

use rubscope_solver::scene::keys::{differences, is_plain, view_differences};
use rubscope_solver::scene::{BUILTIN, DEFAULT, Scene};

/// Name of the program, as it is typed and as files record it.
pub const PROGRAM: &str = "rubscope";
/// Version of the program.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
/// Commit of the program; a build from other sources than a commit adds a hash of them
/// (`build.rs`). Another commit may give other verdicts.
pub const COMMIT: &str = env!("RUBSCOPE_COMMIT");

/// A command line of this program that can be pasted into a shell: words are quoted where needed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CommandLine(String);

impl CommandLine {
    /// Creates `rubscope COMMAND NAME`, with `--set` for every key in which `scene` differs from
    /// `base`, the scene of that name. Keys that affect only what charts show are left out.
    pub fn from_base(command: &str, name: &str, base: &Scene, scene: &Scene) -> Self {
        // A file name that begins with - would be read as an option.
        let here = if name.starts_with('-') { "./" } else { "" };
        let start = Self(format!("{PROGRAM} {command} {}", quoted(&format!("{here}{name}"))));
        let set = |(path, text)| format!("{path}={text}");
        differences(base, scene).map(set).fold(start, |line, set| line.option("--set", set))
    }

    /// Creates the line of a command that takes no scene.
    pub fn without_scene(command: &str) -> Self {
        Self(format!("{PROGRAM} {command}"))
    }

    /// As [`Self::from_base`], based on the built-in scene of the same title, or else on the one
    /// that differs in the fewest keys, so that the command needs no scene file. Keys that affect
    /// only what charts show are set too, so that the scene is the same in every key.
    pub fn new(command: &str, scene: &Scene) -> Self {
        let known = |name| Scene::builtin(name).ok().map(|base| (name, base));
        let far = |base: &Scene| (base.title != scene.title, differences(base, scene).count());
        let nearest = BUILTIN.iter().filter_map(|builtin| known(builtin.name));
        let nearest = nearest.min_by_key(|(_, base)| far(base));
        let (name, base) = nearest.unwrap_or_else(|| (DEFAULT, Scene::base()));
        let line = Self::from_base(command, name, &base, scene);
        let set = |line: Self, (path, text)| line.option("--set", format!("{path}={text}"));
        view_differences(&base, scene).fold(line, set)
    }

    /// Adds an option and its value.
    pub fn option(mut self, name: &str, value: impl Display) -> Self {
        self.0.push_str(&format!(" {name} {}", quoted(&value.to_string())));
        self
    }

    /// Adds an option and its value, if there is one.
    pub fn optional(self, name: &str, value: Option<impl Display>) -> Self {
        match value {
            Some(value) => self.option(name, value),
            None => self,
        }
    }

    /// Adds an option that has no value, if `given`.
    pub fn flag(mut self, name: &str, given: bool) -> Self {
        if given {
            self.0.push_str(&format!(" {name}"));
        }
        self
    }

    /// Returns program, version, commit and command: the field `program` of JSON reports.
    pub fn program(&self) -> Value {
        json!({ "name": PROGRAM, "version": VERSION, "commit": COMMIT, "command": self.0 })
    }
}

impl Display for CommandLine {
    fn fmt(&self, out: &mut Formatter<'_>) -> std::fmt::Result {
        out.write_str(&self.0)
    }
}

/// Quotes a word for the shell, if it needs quotes. What a terminal would obey, or not show, is
/// written as its bytes: `$'a\x07.toml'`.
fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_ascii_alphanumeric() || "-_./=+:,".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_string();
    }
    if word.chars().all(is_plain) {
        return format!("'{}'", word.replace('\'', "'\\''"));
    }
    let escaped = |c: char| match c {
        '\'' | '\\' => format!("\\{c}"),
        c if is_plain(c) => c.to_string(),
        c => c.to_string().bytes().map(|byte| format!("\\x{byte:02x}")).collect(),
    };
    format!("$'{}'", word.chars().map(escaped).collect::<String>())
}

/// Origin of a result, which its files record.
#[derive(Clone, Debug, PartialEq)]
pub struct Provenance {
    /// The command that reproduces it.
    pub command: CommandLine,
    /// The scene, with every key.
    pub scene: Scene,
}

impl Provenance {
    /// Returns the origin as text: program, version and commit on the first line, then the command
    /// and the scene file.
    pub fn text(&self) -> String {
        format!("{PROGRAM} {VERSION} {COMMIT}\n{}\n\n{}", self.command, self.scene.to_toml())
    }

    /// Returns program, version and command in one line.
    pub fn line(&self) -> String {
        format!("{PROGRAM} {VERSION}: {}", self.command)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_names_what_differs_and_nothing_else() {
        let mut scene = Scene::builtin("slip").unwrap();
        assert_eq!(CommandLine::new("run", &scene).to_string(), "rubscope run slip");
        let dashed = CommandLine::from_base("run", "-a.toml", &scene, &scene);
        assert_eq!(dashed.to_string(), "rubscope run ./-a.toml");
        let odd = CommandLine::from_base("run", "a\u{7}'\u{202e}.toml", &scene, &scene);
        assert_eq!(odd.to_string(), "rubscope run $'a\\x07\\'\\xe2\\x80\\xae.toml'");
        scene.set("operation.speed_rad_s", "-430").unwrap();
        scene.set("title", "it's mine").unwrap();
        scene.set("note", "seen on Monday").unwrap();
        let line =
            CommandLine::new("run", &scene).option("--at", "0.05:pulse").flag("--gaps", true);
        assert_eq!(
            line.to_string(),
            "rubscope run slip --set 'title=it'\\''s mine' --set 'note=seen on Monday' \
             --set operation.speed_rad_s=-430.0 --at 0.05:pulse --gaps"
        );
    }
}
