//! `rubscope scenes`: lists the built-in scenes, or prints the file of one.

use std::io::Write;

use clap::Args;

use super::status::{Done, Status};
use super::words::Words;
use rubscope_solver::scene::{BUILTIN, Scene};

/// List the built-in scenes; with a name, print its file.
#[derive(Args, Debug)]
pub struct ScenesCommand {
    /// Name of a built-in scene
    #[arg(value_parser = Words::scenes(), hide_possible_values = true)]
    name: Option<String>,
}

impl ScenesCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        if let Some(name) = &self.name {
            // Refuses an unknown name with the same message as every other command.
            Scene::builtin(name)?;
            let file = BUILTIN.iter().find(|scene| scene.name == name).map(|scene| scene.toml);
            writeln!(out, "{}", file.unwrap_or_default().trim_end())?;
            return Ok(Status::Done);
        }
        let widest = BUILTIN.iter().map(|scene| scene.name.len()).max().unwrap_or(0);
        for (index, builtin) in BUILTIN.iter().enumerate() {
            let scene = Scene::builtin(builtin.name)?;
            let default = if index == 0 { " (the default)" } else { "" };
            writeln!(out, "{:widest$}  {}{default}", builtin.name, scene.title)?;
            writeln!(out, "{:widest$}  {}", "", scene.note)?;
        }
        Ok(Status::Done)
    }
}
