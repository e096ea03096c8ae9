//! Words for shell completion, for options and arguments whose values are checked later, by the
//! scene or the command.

use std::ffi::OsStr;

use clap::builder::{PossibleValue, StringValueParser, TypedValueParser};
use clap::{Arg, Command, Error};
use strum::VariantNames;

use rubscope_solver::scene::BUILTIN;

/// Parser that accepts any text; shell completion offers these words.
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
