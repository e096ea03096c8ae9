//! A list of lines with a selected one.

use ratatui::text::Line;
use ratatui::widgets::{HighlightSpacing, List, ListState, StatefulWidget};
use ratatui::{buffer::Buffer, layout::Rect, style::Modifier};

use super::appearance::Appearance;
use super::theme::Role;

/// Draws the lines of a list, each with a role, in the rows of an area. The line at `chosen` is
/// marked and in sight. Returns the index of the first line that is shown.
pub fn draw_list(
    look: &Appearance,
    buffer: &mut Buffer,
    area: Rect,
    lines: impl IntoIterator<Item = (String, Role)>,
    chosen: usize,
) -> usize {
    let lines = lines.into_iter().map(|(text, role)| Line::styled(text, look.style(role)));
    let list = List::new(lines)
        .highlight_symbol(look.either("▸", ">"))
        .highlight_spacing(HighlightSpacing::Always)
        .highlight_style(look.style(Role::Focus).add_modifier(Modifier::REVERSED));
    let mut state = ListState::default().with_selected(Some(chosen));
    StatefulWidget::render(list, area, buffer, &mut state);
    state.offset()
}
