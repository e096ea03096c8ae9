//! Options of the explorer, and how they combine with the environment and the config file.

use std::time::Duration;

use strum::{EnumString, VariantNames};

use super::ability::is_remote;
use super::app::Source;
use super::config::Config;
use super::line::Line;
use super::raster::Marker;
use super::theme::ThemeChoice;

/// When the explorer uses colours.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, EnumString, VariantNames)]
#[strum(serialize_all = "lowercase")]
pub enum Color {
    /// Unless the environment variable `NO_COLOR` is not empty or `TERM` is `dumb`.
    #[default]
    Auto,
    /// Always, whatever the environment says.
    Always,
    /// Never; bold, reverse and dim remain.
    Never,
}

/// Options of the explorer.
#[derive(Clone, Debug, PartialEq)]
pub struct ExploreOptions {
    /// Largest number of frames per second while the motion plays.
    pub fps: f64,
    /// When colours are used.
    pub color: Color,
    /// The theme; `None` leaves it to the config file and the terminal.
    pub theme: Option<ThemeChoice>,
    /// The marker; `None` leaves it to the config file, the terminal and the locale.
    pub marker: Option<Marker>,
    /// Whether the explorer uses the mouse; false leaves it to the terminal.
    pub mouse: bool,
    /// How much the connection to the terminal carries.
    pub line: Line,
    /// Whether the config file is read and written.
    pub config: bool,
    /// Whether speeds are shown in rpm; otherwise in the unit of the config file.
    pub rpm: bool,
    /// Name of the opened scene and the scene as it was read, for the command line that repeats the
    /// run.
    pub source: Option<Source>,
}

impl ExploreOptions {
    /// Returns the theme to use. Options take precedence over environment variables, whose values
    /// `variable` returns, and these over the config file.
    pub(super) fn theme(&self, config: &Config, variable: &dyn Fn(&str) -> String) -> ThemeChoice {
        let plain = match self.color {
            Color::Always => false,
            Color::Never => true,
            Color::Auto => !variable("NO_COLOR").is_empty() || variable("TERM") == "dumb",
        };
        let given = self.theme.filter(|choice| *choice != ThemeChoice::Auto);
        match given {
            Some(choice) => choice,
            None if plain => ThemeChoice::Mono,
            // An explicit `auto` also takes precedence over the config file.
            None if self.theme.is_some() => ThemeChoice::Auto,
            None => config.theme.unwrap_or_default(),
        }
    }

    /// Returns the marker to use. An option takes precedence over the abilities of the terminal,
    /// and these over the config file.
    pub(super) fn marker(&self, config: &Config, only_ascii: bool) -> Marker {
        let usual = if only_ascii { Marker::Ascii } else { Marker::Braille };
        // The marker may have been saved on another terminal, which showed more than ASCII.
        let is_shown = |marker: &Marker| *marker == Marker::Ascii || !only_ascii;
        self.marker.or(config.marker.filter(is_shown)).unwrap_or(usual)
    }

    /// Returns how much the connection to the terminal carries: thin over SSH, unless an option
    /// says otherwise.
    pub(super) fn line(&self, variable: &dyn Fn(&str) -> String) -> Line {
        if self.line == Line::Auto && is_remote(variable) { Line::Thin } else { self.line }
    }

    pub(super) fn frame(&self) -> Duration {
        let fps = if self.fps.is_finite() { self.fps.clamp(0.1, 60.0) } else { 10.0 };
        Duration::from_secs_f64(1.0 / fps)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::Theme;
    use crate::tui::ground::Ground;

    impl Default for ExploreOptions {
        fn default() -> Self {
            Self {
                fps: 10.0,
                color: Color::Auto,
                theme: None,
                marker: None,
                mouse: true,
                line: Line::Auto,
                config: true,
                rpm: false,
                source: None,
            }
        }
    }

    fn theme(options: ExploreOptions, config: Option<ThemeChoice>, no_color: &str) -> Theme {
        let config = Config { theme: config, ..Config::default() };
        let variable =
            |name: &str| if name == "NO_COLOR" { no_color.to_string() } else { String::new() };
        options.theme(&config, &variable).theme(Ground::Light)
    }

    #[test]
    fn an_option_wins_over_the_environment_and_that_over_the_file() {
        let with = |theme| ExploreOptions { theme, ..ExploreOptions::default() };
        let never = || ExploreOptions { color: Color::Never, ..with(None) };
        let always = || ExploreOptions { color: Color::Always, ..with(None) };
        let (dark, auto) = (Some(ThemeChoice::Dark), Some(ThemeChoice::Auto));
        let blind = Some(ThemeChoice::ColorBlind);
        assert_eq!(theme(with(None), None, ""), Theme::Light);
        assert_eq!(theme(with(None), dark, ""), Theme::Dark);
        assert_eq!(theme(with(None), blind, ""), Theme::ColourBlindLight);
        assert_eq!(theme(with(auto), dark, ""), Theme::Light);
        assert_eq!(theme(with(dark), None, ""), Theme::Dark);
        assert_eq!(theme(with(None), dark, "1"), Theme::Mono);
        assert_eq!(theme(with(auto), dark, "1"), Theme::Mono);
        assert_eq!(theme(with(dark), None, "1"), Theme::Dark);
        assert_eq!(theme(never(), dark, ""), Theme::Mono);
        assert_eq!(theme(always(), dark, "1"), Theme::Dark);
    }

    #[test]
    fn the_line_is_thin_over_ssh_unless_an_option_says_otherwise() {
        let remote = |name: &str| if name == "SSH_TTY" { "/dev/pts/1" } else { "" }.to_string();
        let options = |line| ExploreOptions { line, ..ExploreOptions::default() };
        assert_eq!(options(Line::Auto).line(&remote), Line::Thin);
        assert_eq!(options(Line::Full).line(&remote), Line::Full);
        assert_eq!(options(Line::Auto).line(&|_| String::new()), Line::Auto);
    }

    #[test]
    fn a_remembered_marker_is_used_where_the_terminal_shows_it() {
        let config = |marker| Config { marker: Some(marker), ..Config::default() };
        let options = ExploreOptions::default();
        let given = ExploreOptions { marker: Some(Marker::HalfBlock), ..ExploreOptions::default() };
        assert_eq!(options.marker(&config(Marker::Dot), false), Marker::Dot);
        assert_eq!(options.marker(&config(Marker::Dot), true), Marker::Ascii);
        assert_eq!(given.marker(&config(Marker::Dot), true), Marker::HalfBlock);
    }
}
