//! Words for shell completion, for options and arguments whose values are checked later, by the
//! scene or the command; and the command that a misspelt word means.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Arg, Command, Error};
use strum::VariantNames;

use super::status::Refusal;
use rubscope_solver::scene::{BUILTIN, nearest};

/// Parser of an argument that accepts any text. The words are only what shell completion offers.
#[derive(Clone, Debug)]
pub struct Words(Vec<&'static str>);

impl Words {
    /// Offers the variants of an enum.
    pub fn of<T: VariantNames>() -> Self {
        Self(T::VARIANTS.to_vec())
    }

    /// Offers the names of the built-in scenes.
    pub fn scenes() -> Self {
        Self(BUILTIN.iter().map(|scene| scene.name).collect())
    }
}

impl TypedValueParser for Words {
    type Value = String;

    fn parse_ref(
        &self,
        command: &Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<String, Error> {
        StringValueParser::new().parse_ref(command, argument, value)
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(self.0.iter().copied().map(PossibleValue::new)))
    }
}

/// Returns the refusal of a word that is most like the name of a command of `cli`; `None` for a
/// command, a scene, a path, an option, and a word that is like no command.
pub fn misspelt(word: &str, cli: &Command) -> Option<Refusal> {
    let commands = || cli.get_subcommands().map(Command::get_name);
    let scenes = || BUILTIN.iter().map(|scene| scene.name);
    let is_other = word.starts_with('-') || word.contains(['.', '/']);
    if is_other || commands().chain(scenes()).any(|known| known == word) {
        return None;
    }
    let meant = nearest(word, commands().chain(scenes()))?;
    let is_command = commands().any(|command| command == meant);
    is_command.then(|| {
        Refusal::because(format!(
            "unknown command {word} (did you mean {meant}?); see rubscope --help, or rubscope \
             scenes for the names of scenes"
        ))
    })
}
