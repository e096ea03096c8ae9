//! Words for shell completion, for options and arguments that the scene or the
//! command checks itself.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Arg, Command, Error};
use strum::VariantNames;

use rubscope_solver::scene::BUILTIN;

/// Accepts any text; the shell offers these words.
#[derive(Clone, Debug)]
pub struct Words(Vec<&'static str>);

impl Words {
    /// Creates the words of a choice.
    pub fn of<T: VariantNames>() -> Self {
        Self(T::VARIANTS.to_vec())
    }

    /// Creates the names of the built-in scenes.
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
