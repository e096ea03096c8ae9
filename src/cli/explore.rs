//! `rubscope [SCENE]`: opens the explorer on a terminal; with `--lines` it reads commands from
//! standard input instead.

use std::io::{IsTerminal, Write};
use std::str::FromStr;

use clap::Args;
use clap::builder::TypedValueParser;
use strum::VariantNames;

use super::options::{SceneOptions, read_scene};
use super::status::{self, Done, Refusal, Status};
use super::words::{Words, misspelt};
use crate::tui;
use rubscope_solver::scene::{DEFAULT, SceneError};

/// Options of the explorer.
#[derive(Args, Debug)]
pub struct ExploreCommand {
    #[command(flatten)]
    options: SceneOptions,
    /// Largest number of frames per second while the motion plays
    #[arg(long, value_name = "COUNT", default_value_t = 10.0, value_parser = frames)]
    fps: f64,
    /// Colours: auto (if the terminal has them), always or never
    #[arg(long, value_name = "WHEN", default_value = "auto",
          value_parser = choice::<tui::Color>(), hide_possible_values = true)]
    color: tui::Color,
    /// Theme: auto (by the background of the terminal), dark, light, mono or
    /// colorblind [default: the last one chosen with `t`, otherwise auto]
    #[arg(long, value_name = "THEME",
          value_parser = choice::<tui::ThemeChoice>(), hide_possible_values = true)]
    theme: Option<tui::ThemeChoice>,
    /// How points are drawn: braille, halfblock, dot or ascii [default:
    /// ascii where TERM is linux, vt100 or similar, or the locale is not UTF-8,
    /// otherwise the last one chosen with `m`, or braille]
    #[arg(long, value_name = "MARKER",
          value_parser = choice::<tui::Marker>(), hide_possible_values = true)]
    marker: Option<tui::Marker>,
    /// Data rate to the terminal: thin (at most 5 kB/s while the motion plays, so a large window
    /// gets fewer frames, at least one in ten seconds), full, or auto (thin over SSH or if the
    /// terminal is slow)
    #[arg(long, value_name = "LINE", default_value = "auto",
          value_parser = choice::<tui::Line>(), hide_possible_values = true)]
    line: tui::Line,
    /// Run without a screen: read commands from standard input, one per line, and print
    /// answers as text (default if TERM=dumb)
    #[arg(long)]
    lines: bool,
    /// Do not use the mouse: leave it to the terminal
    #[arg(long)]
    no_mouse: bool,
    /// Neither read nor write the config file
    #[arg(long)]
    no_config: bool,
}

fn frames(text: &str) -> Result<f64, String> {
    let fps = text.parse().ok().filter(|fps| (0.1..=60.0).contains(fps));
    fps.ok_or_else(|| "allowed is a number from 0.1 to 60".to_string())
}

/// Creates a parser for the words of an option's enum; shell completion offers the same words.
fn choice<T>() -> impl TypedValueParser<Value = T>
where
    T: FromStr + VariantNames + Clone + Send + Sync + 'static,
{
    Words::of::<T>().try_map(|text| {
        text.parse().map_err(|_| format!("allowed is one of {}", T::VARIANTS.join(", ")))
    })
}

impl ExploreCommand {
    pub(super) fn run(&self, cli: &clap::Command, out: &mut dyn Write) -> Done {
        let name = self.options.name().unwrap_or(DEFAULT);
        // After an option, clap reads the name of a command as that of a scene.
        if cli.get_subcommands().any(|command| command.get_name() == name) {
            let right = format!("options come after the command: rubscope {name} [OPTIONS]");
            return Err(Refusal::because(right).into());
        }
        let read = read_scene(name).map_err(|error| match misspelt(name, cli) {
            Some(refusal) if matches!(error, SceneError::UnknownScene { .. }) => refusal.into(),
            _ => anyhow::Error::from(error),
        })?;
        let scene = self.options.change(read.clone())?;
        let is_in_lines = self.lines || tui::is_dumb_terminal();
        if !is_in_lines {
            tui::check_terminal().map_err(Refusal::because)?;
        }
        let look = tui::ExploreOptions {
            fps: self.fps,
            color: self.color,
            theme: self.theme,
            marker: self.marker,
            mouse: !self.no_mouse,
            line: self.line,
            config: !self.no_config,
            rpm: self.options.in_rpm(),
            source: Some(tui::Source { name: name.to_string(), scene: read }),
        };
        status::say_noted();
        if is_in_lines {
            let input = std::io::stdin();
            tui::lines(scene, &look, &mut input.lock(), out, input.is_terminal())?;
            return Ok(Status::Done);
        }
        match tui::explore(scene, look)? {
            0 => Ok(Status::Done),
            code => Ok(Status::Signal(code.saturating_sub(128))),
        }
    }
}
