//! A list of lines with a selected one.

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
    let lines: Vec<_> = lines.into_iter().collect();
    let chosen = chosen.min(lines.len().saturating_sub(1));
    let first = (chosen + 1).saturating_sub(area.height.into());
    let width = usize::from(area.width);
    for (row, (at, (text, role))) in area.rows().zip(lines.iter().enumerate().skip(first)) {
        let mark = if at == chosen { look.either("▸", ">") } else { " " };
        buffer.set_stringn(row.x, row.y, format!("{mark}{text}"), width, look.style(*role));
        if at == chosen {
            buffer.set_style(row, look.style(Role::Focus).add_modifier(Modifier::REVERSED));
        }
    }
    first
}
