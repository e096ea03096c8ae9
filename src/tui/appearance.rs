//! The appearance of the screen: theme, marker and characters, which are ASCII if the marker is.

use ratatui::style::Style;

use super::field::CURSOR;
use super::ground::Ground;
use super::raster::{Marker, Pen};
use super::theme::{Role, Theme};
use crate::sheet::number::{spell_micro, tell_in_rpm};

/// Letters and signs of the screen, each with its spelling in ASCII.
const SPELLED: &[&str] = &[
    "ΩOm", "ωom", "λlambda", "ζzeta", "αalpha", "βbeta", "γgamma", "δdelta", "θtheta", "νnu",
    "ΦPhi", "ψpsi", "κkappa", "μmu", "τtau", "πpi", "µu", "±+-", "²^2", "·.", "×x", "–-", "—-",
    "─-", "…...", "●o", "◆@", "▲^", "╋+", "○o", "◄<", "←<", "►>", "→>", "▸>", "↑^", "↓v", "┄~",
];

/// Theme, marker and unit of speeds that the screen uses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Appearance {
    /// Theme: the colour of each role.
    pub theme: Theme,
    /// Whether the theme follows the background of the terminal, until a key chooses one.
    pub follows_ground: bool,
    /// Characters with which curves are drawn.
    pub marker: Marker,
    /// Whether speeds are shown in rpm; otherwise in rad/s.
    pub rpm: bool,
}

impl Appearance {
    /// Creates an appearance with a fixed theme and speeds in rad/s.
    pub fn new(theme: Theme, marker: Marker) -> Self {
        Self { theme, follows_ground: false, marker, rpm: false }
    }

    /// Switches to a theme, which no longer follows the background; returns the message for the
    /// status line.
    pub fn use_theme(&mut self, theme: Theme) -> String {
        (self.theme, self.follows_ground) = (theme, false);
        format!("theme {}", self.theme.name())
    }

    /// Adapts the theme to the background that the terminal reported, unless the user chose one.
    pub fn use_ground(&mut self, ground: Ground) {
        if self.follows_ground {
            self.theme = self.theme.on(ground);
        }
    }

    /// Makes this thread format speeds in the chosen unit, and the prefix micro as the marker has
    /// it.
    pub fn use_units(&self) {
        tell_in_rpm(self.rpm);
        spell_micro(self.either("µ", "u"));
    }

    /// Returns the style of a role.
    pub fn style(&self, role: Role) -> Style {
        self.theme.style(role)
    }

    /// Returns whether only ASCII may be written.
    pub fn ascii(&self) -> bool {
        self.marker == Marker::Ascii
    }

    /// Returns the first value, or the second if only ASCII may be written.
    pub fn either<T>(&self, unicode: T, ascii: T) -> T {
        if self.ascii() { ascii } else { unicode }
    }

    /// Returns the mark of a text that is cut off.
    pub fn ellipsis(&self) -> &'static str {
        self.either("…", "..")
    }

    /// Replaces Greek letters and signs in a text by ASCII, if only ASCII may be written.
    pub fn spell(&self, text: &str) -> String {
        if !self.ascii() {
            return text.to_string();
        }
        let mut out = String::with_capacity(text.len());
        for letter in text.chars() {
            if letter.is_ascii() || letter == CURSOR {
                out.push(letter);
                continue;
            }
            let spelled = SPELLED.iter().find_map(|of| of.strip_prefix(letter));
            out.push_str(spelled.unwrap_or("?"));
        }
        out
    }

    /// Returns the signs of the axes: vertical line and tick, corner, horizontal line and tick.
    pub fn axis_signs(&self) -> [char; 5] {
        self.either(['│', '┤', '└', '─', '┬'], ['|', '+', '+', '-', '+'])
    }

    /// Returns the solid pen of the first series.
    pub fn first(&self) -> Pen {
        Pen { style: self.style(Role::First), sign: '*', dashed: false }
    }

    /// Returns the dashed pen of the second series.
    pub fn second(&self) -> Pen {
        Pen { style: self.style(Role::Second), sign: 'o', dashed: true }
    }

    /// Returns the pen for data shown for comparison.
    pub fn quiet(&self) -> Pen {
        Pen { style: self.style(Role::Quiet), sign: '.', dashed: true }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ascii_means_ascii() {
        let look = Appearance::new(Theme::Dark, Marker::Ascii);
        let text = look.spell("Ω/Ωc λ ζ α 228 µs ±3 kg m² × – … ● ▲ ◄ ► ┄ é");
        assert!(text.is_ascii(), "{text}");
        assert!(text.starts_with("Om/Omc lambda zeta alpha 228 us +-3 kg m^2"));
    }
}
