//! `rubscope [SCENE]`: the explorer, which needs a terminal.

use std::io::IsTerminal;

use clap::{Args, CommandFactory};

use super::options::SceneOptions;
use super::status::{Refusal, Status};
use super::{Cli, Done};
use crate::tui;

/// What the explorer opens with.
#[derive(Args, Debug)]
pub struct Explore {
    #[command(flatten)]
    options: SceneOptions,
}

impl Explore {
    pub(super) fn run(&self) -> Done {
        self.refuse_command()?;
        let scene = self.options.scene()?;
        if !std::io::stdout().is_terminal() {
            return Err(Refusal::because(
                "the explorer needs a terminal on standard output; without one, use `rubscope run`",
            )
            .into());
        }
        match tui::explore(scene, tui::ExploreOptions::default())? {
            0 => Ok(Status::Done),
            code => Ok(Status::Signal(code.saturating_sub(128))),
        }
    }

    /// A command after options is read as a scene: say what was meant.
    fn refuse_command(&self) -> Result<(), Refusal> {
        let name = self.options.name().unwrap_or_default();
        if Cli::command().get_subcommands().any(|command| command.get_name() == name) {
            let right = format!("options come after the command: rubscope {name} [OPTIONS]");
            return Err(Refusal::because(right));
        }
        Ok(())
    }
}
