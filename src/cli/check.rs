//! `rubscope check`: derived values of a scene, missing data and likely unit errors, in sentences.

use std::io::Write;

use clap::Args;

use super::options::SceneOptions;
use super::status::{self, Done, Status};
use crate::sheet::{CommandLine, check as report};

/// Summarise a scene in words: derived values, missing data, likely unit errors.
#[derive(Args, Debug)]
pub struct CheckCommand {
    #[command(flatten)]
    options: SceneOptions,
}

impl CheckCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let scene = self.options.scene()?;
        self.options.note_assumed(&scene);
        status::say_noted();
        report::sheet(&scene, CommandLine::new("check", &scene)).write_text(out)?;
        Ok(Status::Done)
    }
}
