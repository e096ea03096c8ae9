//! Text on the screen: one row, pieces of one row, and wrapped lines.

use ratatui::{buffer::Buffer, layout::Rect, style::Style};

/// Text in one row of an area; what does not fit is cut.
pub fn print(buffer: &mut Buffer, area: Rect, row: u16, text: &str, style: Style) {
    if row < area.height && area.width > 0 {
        buffer.set_stringn(area.x, area.y + row, text, usize::from(area.width), style);
    }
}

/// Pieces of text in one row, as many of them from the left as fit whole.
pub fn pieces(buffer: &mut Buffer, area: Rect, row: u16, parts: &[(String, Style)]) {
    let mut x = area.x;
    for (text, style) in parts {
        let end = x.saturating_add(u16::try_from(text.chars().count()).unwrap_or(u16::MAX));
        if end > area.right() || row >= area.height {
            return;
        }
        buffer.set_string(x, area.y + row, text, *style);
        x = end;
    }
}

/// Words broken into lines no wider than `width`.
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split_whitespace() {
        let word: String = word.chars().take(width.max(1)).collect();
        let Some(last) = lines.last_mut() else { break };
        if last.is_empty() {
            *last = word;
        } else if last.chars().count() + 1 + word.chars().count() <= width {
            last.push(' ');
            last.push_str(&word);
        } else {
            lines.push(word);
        }
    }
    lines
}
