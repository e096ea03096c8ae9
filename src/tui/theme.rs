//! Colours by role. Every theme has the same eight roles; a sign, a word or a
//! line style always gives the same information as a colour.

use ratatui::style::{Color, Modifier, Style};

/// What a colour is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// Ordinary text.
    Text,
    /// Axes, frames, units.
    Quiet,
    /// What the keyboard acts on.
    Focus,
    /// The first series of a chart.
    First,
    /// The second series of a chart.
    Second,
    /// Blades in contact, and their forces.
    Contact,
    /// Good news.
    Good,
    /// Problems: refused values, pulls, failures.
    Trouble,
}

/// A named set of colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Theme {
    /// Light text on a dark background.
    Dark,
    /// Dark text on a light background.
    Light,
    /// Blue and orange (yellow), safe for the common colour blindnesses.
    ColourBlind,
    /// No colours: bold, dim, reverse and underline only.
    Mono,
}

impl Theme {
    /// All themes, in the order `t` steps through them.
    pub const ALL: [Self; 4] = [Self::Dark, Self::Light, Self::ColourBlind, Self::Mono];

    /// The name on screen.
    pub fn name(self) -> &'static str {
        ["dark", "light", "colour-blind", "mono"][self as usize]
    }

    /// The next theme.
    pub fn next(self) -> Self {
        Self::ALL[(self as usize + 1) % Self::ALL.len()]
    }

    /// Style of a role. Only the sixteen named colours, which follow the user's
    /// palette.
    pub fn style(self, role: Role) -> Style {
        let colour = match (self, role) {
            (Self::Mono, _) | (_, Role::Text) => Color::Reset,
            (_, Role::Quiet) => Color::DarkGray,
            (Self::Dark, Role::Focus) => Color::LightYellow,
            (Self::Dark, Role::First) => Color::LightCyan,
            (Self::Dark, Role::Second) => Color::LightMagenta,
            (Self::Dark, Role::Contact | Role::Trouble) => Color::LightRed,
            (Self::Dark, Role::Good) => Color::LightGreen,
            (Self::Light, Role::Focus | Role::First) => Color::Blue,
            (Self::Light, Role::Second) => Color::Magenta,
            (Self::Light, Role::Contact | Role::Trouble) => Color::Red,
            (Self::Light, Role::Good) => Color::Green,
            (Self::ColourBlind, Role::First | Role::Good) => Color::LightBlue,
            (Self::ColourBlind, Role::Second) => Color::Yellow,
            (Self::ColourBlind, _) => Color::LightYellow,
        };
        let weight = match role {
            Role::Quiet if self == Self::Mono => Modifier::DIM,
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

    #[test]
    fn no_theme_uses_colours_the_user_did_not_choose() {
        for theme in Theme::ALL {
            for role in ROLES {
                let colour = theme.style(role).fg.unwrap();
                assert!(
                    !matches!(colour, Color::Rgb(..) | Color::Indexed(_)),
                    "{theme:?} {role:?}"
                );
            }
        }
    }

    #[test]
    fn mono_has_no_colour_at_all_and_the_cycle_visits_every_theme() {
        assert!(ROLES.iter().all(|role| Theme::Mono.style(*role).fg == Some(Color::Reset)));
        let mut theme = Theme::Dark;
        for _ in 0..Theme::ALL.len() {
            theme = theme.next();
        }
        assert_eq!(theme, Theme::Dark);
    }
}
