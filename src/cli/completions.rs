//! `rubscope completions`: shell completions, made from the same definition
//! as the command line itself.

use std::io::Write;

use clap::{Args, CommandFactory};
use clap_complete::Shell;

use super::status::Status;
use super::{Cli, Done};

/// Print completions for a shell.
#[derive(Args, Debug)]
pub struct CompletionsCommand {
    /// The shell
    shell: Shell,
}

impl CompletionsCommand {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        // Into memory first: clap_complete panics when it cannot write.
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut Cli::command(), "rubscope", &mut text);
        out.write_all(&text)?;
        Ok(Status::Done)
    }
}
