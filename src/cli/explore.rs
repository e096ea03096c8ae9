//! `rubscope [SCENE]`: the explorer, which needs a terminal.

use std::io::IsTerminal;

use clap::Args;

use super::Done;
use super::options::SceneOptions;
use super::status::Refusal;

/// What the explorer opens with.
#[derive(Args, Debug)]
pub struct Explore {
    #[command(flatten)]
    options: SceneOptions,
}

impl Explore {
    pub(super) fn run(&self) -> Done {
        let _scene = self.options.scene()?;
        if !std::io::stdout().is_terminal() {
            return Err(Refusal::because(
                "the explorer needs a terminal on standard output; without one, use `rubscope run`",
            )
            .into());
        }
        anyhow::bail!("the explorer is not part of this build")
    }
}
