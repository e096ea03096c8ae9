//! The command line: one file per command, options that change the scene in
//! `options`, exit status and one-line messages in `status`.
//!
//! Data goes to standard output, everything else to standard error.

mod check;
mod explore;
mod figures;
mod hbm;
mod man;
mod map;
mod margins;
mod new;
pub mod options;
mod output;
mod precision;
pub mod range;
mod run;
mod scenes;
pub mod script;
mod sign;
pub mod status;
mod survey;
mod words;

use std::ffi::OsString;
use std::io::{BufWriter, Write};

use clap::{CommandFactory, Parser, Subcommand};

use status::Done;
use words::misspelt;

/// Version and commit of the program (`build.rs`), for `--version`.
const VERSION: &str = env!("RUBSCOPE_VERSION");

/// See a flexible bladed disk rub against its flexible casing.
///
/// Without a command, opens the explorer on SCENE. Every command takes a
/// SCENE, which is the name of a built-in scene (see `rubscope scenes`) or the
/// path of a .toml file, and options that change it.
#[derive(Debug, Parser)]
#[command(name = "rubscope", version = VERSION, args_conflicts_with_subcommands = true)]
pub struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
    #[command(flatten)]
    explore: explore::ExploreCommand,
}

#[derive(Debug, Subcommand)]
enum Command {
    Run(Box<run::RunCommand>),
    Hbm(Box<hbm::HbmCommand>),
    Map(Box<map::MapCommand>),
    Margins(Box<margins::MarginsCommand>),
    Survey(Box<survey::SurveyCommand>),
    New(Box<new::NewCommand>),
    Check(Box<check::CheckCommand>),
    Precision(Box<precision::PrecisionCommand>),
    Figures(Box<figures::FiguresCommand>),
    Scenes(scenes::ScenesCommand),
    Completions(man::CompletionsCommand),
    Man(man::ManCommand),
}

/// Runs the program on these arguments and returns its exit status.
pub fn main(args: impl IntoIterator<Item = OsString>) -> u8 {
    output::outlive_size_limit();
    let arguments: Vec<OsString> = args.into_iter().collect();
    let cli = match Cli::try_parse_from(&arguments) {
        Ok(cli) => cli,
        Err(error) => {
            // An unknown first word is read as a scene, so that the rest of the line is refused.
            let first = arguments.get(1).and_then(|word| word.to_str()).unwrap_or_default();
            let refusal = misspelt(first, &Cli::command()).filter(|_| error.use_stderr());
            return match refusal {
                Some(refusal) => status::exit(Err(refusal.into())),
                None => status::usage(&error, &arguments),
            };
        }
    };
    // Standard output is not locked for the whole run: other threads that write would have to
    // wait while the output is blocked.
    let mut out = BufWriter::new(sign::Out);
    let done = dispatch(cli, &mut out).and_then(|status| {
        out.flush()?;
        Ok(status)
    });
    sign::end();
    status::exit(done)
}

fn dispatch(cli: Cli, out: &mut dyn Write) -> Done {
    // The spinner would wipe the screen of the explorer and the questions of `new`.
    if !matches!(cli.command, None | Some(Command::New(_))) {
        sign::begin();
    }
    match cli.command {
        None => cli.explore.run(&Cli::command(), out),
        Some(Command::Run(command)) => command.run(out),
        Some(Command::Hbm(command)) => command.run(out),
        Some(Command::Map(command)) => command.run(out),
        Some(Command::Margins(command)) => command.run(out),
        Some(Command::Survey(command)) => command.run(out),
        Some(Command::New(command)) => command.run(out),
        Some(Command::Check(command)) => command.run(out),
        Some(Command::Precision(command)) => command.run(out),
        Some(Command::Figures(command)) => command.run(out),
        Some(Command::Scenes(command)) => command.run(out),
        Some(Command::Completions(command)) => command.run(Cli::command(), out),
        Some(Command::Man(command)) => command.run(Cli::command(), out),
    }
}
