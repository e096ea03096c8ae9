//! The screen as a function of the state: where each panel goes, and one file
//! per panel.

mod charts;
mod footer;
mod frame;
mod gaps;
mod guide;
mod header;
pub mod heat;
mod help;
mod knobs;
mod layout;
mod locked;
mod map;
mod precision;
mod response;
mod spectrum;
mod wheel;

use ratatui::{
    Frame,
    buffer::Buffer,
    layout::Rect,
    style::Style,
    text::{Line, Span},
    widgets::Widget,
};

use super::app::{App, Mode};
use super::theme::Role;
pub use layout::{LEAST_HEIGHT, LEAST_WIDTH, lesson_fills};

/// Draws the whole screen.
pub fn draw(frame: &mut Frame, app: &App) {
    let area = frame.area();
    paint(app, frame.buffer_mut(), area);
}

/// Paints the whole screen into a buffer.
pub fn paint(app: &App, buffer: &mut Buffer, area: Rect) {
    if area.width < LEAST_WIDTH || area.height < LEAST_HEIGHT {
        let needs = format!(
            "rubscope needs {LEAST_WIDTH}x{LEAST_HEIGHT}; this is {}x{}",
            area.width, area.height
        );
        print(buffer, area, 0, &needs, app.skin.style(Role::Text));
        return;
    }
    let places = layout::places(area, app);
    header::draw(app, buffer, places.header);
    if let Mode::Help(scroll) = app.mode {
        help::draw(app, buffer, places.body, scroll);
    } else if let Mode::Lessons(place) = app.mode {
        guide::list(app, buffer, places.body, place);
    } else {
        if let Some(area) = places.guide {
            guide::draw(app, buffer, area);
        }
        if let Some(area) = places.knobs {
            knobs::panel(app, buffer, area);
        }
        if let Some(area) = places.strip {
            knobs::strip(app, buffer, area);
        }
        for (view, area) in &places.charts {
            charts::draw(app, buffer, *area, *view);
        }
    }
    footer::draw(app, buffer, places.footer);
}

/// Text in one row of an area; what does not fit is cut.
fn print(buffer: &mut Buffer, area: Rect, row: u16, text: &str, style: Style) {
    if row < area.height && area.width > 0 {
        buffer.set_stringn(area.x, area.y + row, text, usize::from(area.width), style);
    }
}

/// Pieces of text in one row, as many of them from the left as fit whole.
fn pieces(buffer: &mut Buffer, area: Rect, row: u16, parts: &[(String, Style)]) {
    let mut line = Vec::new();
    let mut used = 0;
    for (text, style) in parts {
        used += text.chars().count();
        if used > usize::from(area.width) {
            break;
        }
        line.push(Span::styled(text.clone(), *style));
    }
    if row < area.height {
        let area = Rect { y: area.y + row, height: 1, ..area };
        Line::from(line).render(area, buffer);
    }
}

/// Words broken into lines no wider than `width`.
fn wrap(text: &str, width: usize) -> Vec<String> {
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
