//! `rubscope man` and `rubscope completions`: manual pages and shell completions generated from
//! the clap definition. The sections that do not follow from it are in `assets/manual.man`.

use std::io::Write;

use clap::Args;
use clap_complete::Shell;
use clap_mangen::roff::{Roff, bold, roman};

use super::status::{Done, Refusal, Status};
use crate::tui::command::table::{self, keys_text};
use rubscope_solver::scene::BUILTIN;

/// The change log. The date of its newest version is the date of the manual pages.
const CHANGES: &str = include_str!("../../CHANGELOG.md");

/// Exit status, environment, files and examples, in roff.
const MANUAL: &str = include_str!("../../assets/manual.man");

/// Print the manual page, or that of one command.
#[derive(Args, Debug)]
pub struct ManCommand {
    /// A command, for its page; for a subcommand both names, such as map merge
    command: Vec<String>,
}

impl ManCommand {
    pub(super) fn run(&self, cli: clap::Command, out: &mut dyn Write) -> Done {
        let mut whole = cli.version(env!("CARGO_PKG_VERSION"));
        whole.build();
        let command = self.command.iter().try_fold(whole, |of, name| page_of(&of, name))?;
        let page = clap_mangen::Man::new(command)
            .date(newest_date())
            .source(concat!("rubscope ", env!("CARGO_PKG_VERSION")))
            .manual("rubscope manual");
        if !self.command.is_empty() {
            page.render(out)?;
        } else {
            page.render_title(out)?;
            page.render_name_section(out)?;
            page.render_synopsis_section(out)?;
            page.render_description_section(out)?;
            page.render_options_section(out)?;
            page.render_subcommands_section(out)?;
            scenes_and_keys().to_writer(out)?;
            out.write_all(MANUAL.as_bytes())?;
            page.render_version_section(out)?;
        }
        Ok(Status::Done)
    }
}

/// Returns the date of the newest version in the change log, `## [0.1.0] - 2026-11-23`.
fn newest_date() -> &'static str {
    let mut headings =
        CHANGES.lines().filter_map(|line| line.strip_prefix("## [")?.split_once("] - "));
    headings.next().map_or("", |(_, date)| date)
}

fn page_of(whole: &clap::Command, name: &str) -> Result<clap::Command, Refusal> {
    let found = whole.get_subcommands().find(|command| command.get_name() == name);
    found.cloned().ok_or_else(|| {
        let names: Vec<&str> =
            whole.get_subcommands().map(clap::Command::get_name).filter(|&n| n != "help").collect();
        let allowed = match &names[..] {
            [] => format!("nothing after {}", whole.get_name()),
            names => format!("one of {}", names.join(", ")),
        };
        Refusal::of("COMMAND", name, allowed)
    })
}

/// Returns the scenes and the keys of the explorer.
fn scenes_and_keys() -> Roff {
    let mut page = Roff::new();
    page.control("SH", ["SCENES"]);
    let names: Vec<&str> = BUILTIN.iter().map(|scene| scene.name).collect();
    page.text([roman(format!(
        "Built-in scenes: {}. The first one is the default. A scene file is TOML; \
         `rubscope scenes NAME` prints one to start from. An option wins over the file, \
         and the file over the default.",
        names.join(", ")
    ))]);
    page.control("SH", ["KEYS"]);
    for binding in table::main() {
        page.control("TP", []);
        page.text([bold(keys_text(binding))]);
        page.text([roman(binding.what)]);
    }
    page
}

/// Print completions for a shell.
#[derive(Args, Debug)]
pub struct CompletionsCommand {
    /// Shell that the completions are for
    shell: Shell,
}

impl CompletionsCommand {
    pub(super) fn run(&self, mut cli: clap::Command, out: &mut dyn Write) -> Done {
        // Into memory first, because clap_complete panics when it cannot write.
        let mut text = Vec::new();
        clap_complete::generate(self.shell, &mut cli, "rubscope", &mut text);
        out.write_all(&text)?;
        Ok(Status::Done)
    }
}
