//! What the lists of the screen share: which entries are in sight, and how the
//! chosen one looks.

use ratatui::style::{Modifier, Style};

use crate::tui::appearance::Appearance;
use crate::tui::theme::Role;

/// The first entry in sight of a list with so many rows, so that the chosen one is
/// in sight.
pub fn first_in_sight(chosen: usize, rows: usize) -> usize {
    (chosen + 1).saturating_sub(rows)
}

/// The sign before an entry and its style; one that is not chosen has the colour
/// of its role.
pub fn look_of(look: &Appearance, is_chosen: bool, role: Role) -> (&'static str, Style) {
    match is_chosen {
        true => (look.either("▸", ">"), look.style(Role::Focus).add_modifier(Modifier::REVERSED)),
        false => (" ", look.style(role)),
    }
}
