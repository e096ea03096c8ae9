//! `rubscope man`: the manual pages, made from the same definition as the
//! command line itself.

use std::io::Write;

use clap::{Args, CommandFactory};

use super::status::{Refusal, Status};
use super::{Cli, Done};

/// Print the manual page, or that of one command.
#[derive(Args, Debug)]
pub struct Man {
    /// A command, for its own page
    command: Option<String>,
}

impl Man {
    pub(super) fn run(&self, out: &mut dyn Write) -> Done {
        let mut whole = Cli::command();
        whole.build();
        let command = match &self.command {
            None => whole,
            Some(name) => page_of(&whole, name)?,
        };
        clap_mangen::Man::new(command).manual("rubscope manual").render(out)?;
        Ok(Status::Done)
    }
}

fn page_of(whole: &clap::Command, name: &str) -> Result<clap::Command, Refusal> {
    let found = whole.get_subcommands().find(|command| command.get_name() == name);
    found.cloned().ok_or_else(|| {
        let names: Vec<&str> =
            whole.get_subcommands().map(clap::Command::get_name).filter(|&n| n != "help").collect();
        Refusal::of("COMMAND", name, format!("one of {}", names.join(", ")))
    })
}
