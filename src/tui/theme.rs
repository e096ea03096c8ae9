//! Colours by role. Every theme has the same eight roles. No information depends on colour alone: a
//! sign, a word or a line style always repeats it.

use ratatui::style::{Color, Modifier, Style};
use serde::{Deserialize, Serialize};
use strum::{EnumString, VariantNames};

use super::ground::Ground;

/// Purpose of a text or a sign, which determines its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Ordinary text.
    Text,
    /// Axes, frames, units, and other text in the background.
    Quiet,
    /// The selected knob, the cursor, the open prompt.
    Focus,
    /// The first series of a chart.
    First,
    /// The second series of a chart.
    Second,
    /// Blades in contact, and their forces.
    Contact,
    /// Successes, such as a completed step of a lesson.
    Good,
    /// Danger, errors and doubts: a wave that whirls, tension, failures, refused values.
    Trouble,
}

/// Choice of a theme, as given on the command line and in the config file.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, EnumString, VariantNames, Serialize, Deserialize,
)]
#[strum(serialize_all = "lowercase")]
#[serde(rename_all = "lowercase")]
pub enum ThemeChoice {
    /// Light or dark, depending on the background of the terminal.
    #[default]
    Auto,
    /// For a dark background.
    Dark,
    /// For a light background.
    Light,
    /// No colours.
    Mono,
    /// Safe for common forms of colour blindness; light or dark as the background.
    ColorBlind,
}

impl ThemeChoice {
    /// Returns whether the theme follows the background of the terminal.
    pub fn follows_ground(self) -> bool {
        matches!(self, Self::Auto | Self::ColorBlind)
    }

    /// Returns the theme of this choice for a background.
    pub fn theme(self, ground: Ground) -> Theme {
        match self {
            Self::Dark => Theme::Dark,
            Self::Light => Theme::Light,
            Self::Mono => Theme::Mono,
            Self::Auto => Theme::Dark.on(ground),
            Self::ColorBlind => Theme::ColourBlind.on(ground),
        }
    }

    /// Returns the choice that gives this theme on its background.
    pub fn of(theme: Theme) -> Self {
        match theme {
            Theme::Dark => Self::Dark,
            Theme::Light => Self::Light,
            Theme::Mono => Self::Mono,
            Theme::ColourBlind | Theme::ColourBlindLight => Self::ColorBlind,
        }
    }
}

/// A set of colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Theme {
    /// Light text on a dark background.
    Dark,
    /// Dark text on a light background.
    Light,
    /// Blue and yellow on a dark background, safe for common forms of colour blindness.
    ColourBlind,
    /// Blue and magenta on a light background, where yellow is illegible. Readers who do not see
    /// red see both as blue; signs distinguish them.
    ColourBlindLight,
    /// No colours: bold, dim, reverse and underline only.
    Mono,
}

impl Theme {
    /// All themes, in the order `t` steps through them.
    pub const ALL: [Self; 5] =
        [Self::Dark, Self::Light, Self::ColourBlind, Self::ColourBlindLight, Self::Mono];

    /// Returns the name of the theme on the screen.
    pub fn name(self) -> &'static str {
        ["dark", "light", "colour-blind on dark", "colour-blind on light", "mono"][self as usize]
    }

    /// Returns the theme of the same kind for this background.
    pub fn on(self, ground: Ground) -> Self {
        match (self, ground) {
            (Self::Dark | Self::Light, Ground::Dark) => Self::Dark,
            (Self::Dark | Self::Light, Ground::Light) => Self::Light,
            (Self::ColourBlind | Self::ColourBlindLight, Ground::Dark) => Self::ColourBlind,
            (Self::ColourBlind | Self::ColourBlindLight, Ground::Light) => Self::ColourBlindLight,
            (Self::Mono, _) => Self::Mono,
        }
    }

    /// Returns the next theme.
    pub fn next(self) -> Self {
        Self::ALL[(self as usize + 1) % Self::ALL.len()]
    }

    /// Returns the style of a role. Only the sixteen named colours are used, because they follow
    /// the user's palette.
    pub fn style(self, role: Role) -> Style {
        let colour = match (self, role) {
            (Self::Mono, _) | (_, Role::Text) => Color::Reset,
            (_, Role::Quiet) => Color::DarkGray,
            (Self::Dark, Role::Focus) => Color::LightYellow,
            (Self::Dark, Role::First) => Color::LightCyan,
            (Self::Dark, Role::Second) => Color::LightMagenta,
            (Self::Dark, Role::Contact) => Color::LightGreen,
            (Self::Dark, Role::Good) => Color::LightBlue,
            (Self::Dark | Self::ColourBlind, Role::Trouble) => Color::LightRed,
            // On white, the green of most terminals is illegible, and magenta marks contact.
            (Self::Light | Self::ColourBlindLight, Role::Second) => Color::Reset,
            (Self::Light | Self::ColourBlindLight, Role::Contact) => Color::Magenta,
            (Self::Light | Self::ColourBlindLight, Role::Trouble) => Color::Red,
            (Self::Light | Self::ColourBlindLight, _) => Color::Blue,
            (Self::ColourBlind, Role::First | Role::Good) => Color::LightBlue,
            (Self::ColourBlind, Role::Second) => Color::Yellow,
            (Self::ColourBlind, Role::Contact) => Color::LightCyan,
            (Self::ColourBlind, Role::Focus) => Color::LightYellow,
        };
        let weight = match role {
            Role::Quiet if self == Self::Mono => Modifier::DIM,
            Role::Trouble if self == Self::Mono => Modifier::BOLD.union(Modifier::UNDERLINED),
            Role::Focus | Role::Contact | Role::Trouble => Modifier::BOLD,
            _ => Modifier::empty(),
        };
        Style::new().fg(colour).add_modifier(weight)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ROLES: [Role; 8] = [
        Role::Text,
        Role::Quiet,
        Role::Focus,
        Role::First,
        Role::Second,
        Role::Contact,
        Role::Good,
        Role::Trouble,
    ];

    /// The sixteen colours as common terminals draw them: xterm, Linux console and VGA, Windows
    /// (Campbell), GNOME.
    const PALETTES: [[u32; 16]; 4] = [
        [
            0x000000, 0xcd0000, 0x00cd00, 0xcdcd00, 0x0000ee, 0xcd00cd, 0x00cdcd, 0xe5e5e5,
            0x7f7f7f, 0xff0000, 0x00ff00, 0xffff00, 0x5c5cff, 0xff00ff, 0x00ffff, 0xffffff,
        ],
        [
            0x000000, 0xaa0000, 0x00aa00, 0xaa5500, 0x0000aa, 0xaa00aa, 0x00aaaa, 0xaaaaaa,
            0x555555, 0xff5555, 0x55ff55, 0xffff55, 0x5555ff, 0xff55ff, 0x55ffff, 0xffffff,
        ],
        [
            0x0c0c0c, 0xc50f1f, 0x13a10e, 0xc19c00, 0x0037da, 0x881798, 0x3a96dd, 0xcccccc,
            0x767676, 0xe74856, 0x16c60c, 0xf9f1a5, 0x3b78ff, 0xb4009e, 0x61d6d6, 0xf2f2f2,
        ],
        [
            0x171421, 0xc01c28, 0x26a269, 0xa2734c, 0x12488b, 0xa347ba, 0x2aa1b3, 0xd0cfcc,
            0x5e5c64, 0xf66151, 0x33d17a, 0xe9ad0c, 0x2a7bde, 0xc061cb, 0x33c7de, 0xffffff,
        ],
    ];

    /// Returns the relative luminance (WCAG).
    fn luminance(colour: u32) -> f64 {
        let part = |shift: u32| {
            let x = f64::from(colour >> shift & 0xff) / 255.0;
            if x <= 0.03928 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
        };
        0.2126 * part(16) + 0.7152 * part(8) + 0.0722 * part(0)
    }

    fn place(colour: Color) -> Option<usize> {
        Some(match colour {
            Color::Red => 1,
            Color::Green => 2,
            Color::Yellow => 3,
            Color::Blue => 4,
            Color::Magenta => 5,
            Color::Cyan => 6,
            Color::DarkGray => 8,
            Color::LightRed => 9,
            Color::LightGreen => 10,
            Color::LightYellow => 11,
            Color::LightBlue => 12,
            Color::LightMagenta => 13,
            Color::LightCyan => 14,
            Color::Reset => return None,
            other => panic!("{other:?}"),
        })
    }

    /// Returns the background that a theme needs; `None` if it is legible on both.
    fn made_for(theme: Theme) -> Option<Ground> {
        match theme {
            Theme::Dark | Theme::ColourBlind => Some(Ground::Dark),
            Theme::Light | Theme::ColourBlindLight => Some(Ground::Light),
            Theme::Mono => None,
        }
    }

    #[test]
    fn every_theme_can_be_read_on_its_ground_in_common_palettes() {
        for theme in Theme::ALL {
            let Some(ground) = made_for(theme) else { continue };
            for (palette, role) in PALETTES.iter().flat_map(|p| ROLES.map(|role| (p, role))) {
                let Some(place) = place(theme.style(role).fg.unwrap()) else { continue };
                let ground = if ground == Ground::Light { 0xffffff } else { palette[0] };
                let [a, b] = [luminance(ground), luminance(palette[place])];
                let contrast = (a.max(b) + 0.05) / (a.min(b) + 0.05);
                // Quiet text carries no message and may have less contrast.
                let least = if role == Role::Quiet { 2.5 } else { 3.0 };
                assert!(contrast >= least, "{theme:?} {role:?}: {contrast:.2} of {least}");
            }
        }
    }

    #[test]
    fn a_choice_stands_for_a_theme_and_asks_for_the_ground_only_if_it_matters() {
        for theme in Theme::ALL {
            let ground = made_for(theme).unwrap_or_default();
            assert_eq!(ThemeChoice::of(theme).theme(ground), theme);
        }
        assert_eq!(ThemeChoice::Auto.theme(Ground::Light), Theme::Light);
        assert_eq!(ThemeChoice::Auto.theme(Ground::Dark), Theme::Dark);
    }

    #[test]
    fn trouble_and_contact_look_like_nothing_else_in_every_theme() {
        for theme in Theme::ALL {
            for role in ROLES {
                let same = |other: Role| theme.style(role) == theme.style(other);
                assert_eq!(same(Role::Trouble), role == Role::Trouble, "{theme:?} {role:?}");
                // In the mono theme, contact is marked by its sign.
                let distinct = theme != Theme::Mono || role != Role::Focus;
                assert!(!distinct || same(Role::Contact) == (role == Role::Contact), "{theme:?}");
            }
        }
    }
}
