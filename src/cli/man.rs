//! `rubscope man` and `rubscope completions`: manual pages and shell completions generated from
//! the clap definition. Some sections of the pages are written here.

use std::io::Write;

use clap::Args;
use clap_complete::Shell;
use clap_mangen::roff::{Roff, bold, roman};

use super::status::{Done, Refusal, Status};
use crate::tui::command::table::{self, keys_text};
use rubscope_solver::scene::BUILTIN;

/// The change log. The date of its newest version is the date of the manual pages.
const CHANGES: &str = include_str!("../../CHANGELOG.md");

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
            added().to_writer(out)?;
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

/// Each exit status and its meaning.
const EXIT_STATUS: &[(&str, &str)] = &[
    ("0", "Done."),
    ("1", "Failed: a file could not be written, or the computation broke down."),
    ("2", "Wrong usage or refused input; one line names the key, the value and what is allowed."),
    ("128+n", "Ended by signal n."),
];

/// Environment variables that the explorer reads, and what they do.
const ENVIRONMENT: &[(&str, &str)] = &[
    (
        "NO_COLOR",
        "Not empty: no colours, unless --color or --theme is given; bold and reverse are kept.",
    ),
    (
        "COLORFGBG",
        "Such as 0;15: the last number is the background, by which the explorer chooses its \
         theme. Without it, the explorer asks the terminal, and draws on a dark background until \
         it answers.",
    ),
    (
        "XDG_CONFIG_HOME, HOME",
        "The folder of rubscope/config.toml, or of .config/rubscope/config.toml.",
    ),
    (
        "TERM",
        "dumb: the explorer runs without a screen, as with --lines. linux, vt100 and \
         similar: the explorer draws with ASCII characters only, unless --marker is given.",
    ),
    (
        "LC_ALL, LC_CTYPE, LANG",
        "The first that is not empty is the locale. If it is not one of UTF-8, or none is set, \
         the explorer draws with ASCII characters only, unless --marker is given.",
    ),
    (
        "SSH_CONNECTION, SSH_TTY",
        "Set: the explorer assumes a slow connection, unless --line is given.",
    ),
];

/// Files that the program reads or writes without being asked, and what they contain.
const FILES: &[(&str, &str)] = &[(
    "~/.config/rubscope/config.toml",
    "Settings that the explorer remembers: theme, marker, number of charts, mouse. Options \
     override them; --no-config ignores the file. It may be deleted at any time.",
)];

const EXAMPLES: &[(&str, &str)] = &[
    ("rubscope", "Open the explorer on the default scene."),
    ("rubscope run adhesive", "Simulate a built-in scene and report how it ends."),
    (
        "rubscope run --contact unilateral --speed -430 --json",
        "The default scene with contact that only pushes, the rotor turning the other way, as JSON.",
    ),
    ("rubscope hbm --speed 0:500:501", "The locked motion against rotor speed."),
    ("rubscope map --speed 250:500:51 --pulse 1e4:1e6:25", "Which pulses lock at which speeds."),
    ("rubscope figures --out figures", "The figures of the paper."),
    (
        "rubscope run my.toml --set bladed_disk.blades=24 --out history.csv",
        "A scene file with one key changed; the history goes to a CSV file.",
    ),
];

/// Returns the sections that clap does not generate.
fn added() -> Roff {
    let mut page = Roff::new();
    page.control("SH", ["SCENES"]);
    let names: Vec<&str> = BUILTIN.iter().map(|scene| scene.name).collect();
    page.text([roman(format!(
        "Built-in scenes: {}. The first one is the default. A scene file is TOML; \
         `rubscope scenes NAME` prints one to start from. An option wins over the file, \
         and the file over the default.",
        names.join(", ")
    ))]);
    list(&mut page, "KEYS", table::main().map(|b| (keys_text(b), b.what)));
    let owned = |entries: &'static [(&str, &'static str)]| {
        entries.iter().map(|(term, text)| (term.to_string(), *text))
    };
    list(&mut page, "EXIT STATUS", owned(EXIT_STATUS));
    list(&mut page, "ENVIRONMENT", owned(ENVIRONMENT));
    list(&mut page, "FILES", owned(FILES));
    list(&mut page, "EXAMPLES", owned(EXAMPLES));
    page
}

fn list(page: &mut Roff, heading: &str, entries: impl Iterator<Item = (String, &'static str)>) {
    page.control("SH", [heading]);
    for (term, text) in entries {
        page.control("TP", []);
        page.text([bold(term)]);
        page.text([roman(text)]);
    }
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
