//! What charts have in common: the title row with its legend.

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::{Modifier, Style},
};

use super::{frame, gaps, heat, locked, map, precision, print, response, spectrum};
use crate::tui::app::{App, View};
use crate::tui::raster::Pen;
use crate::tui::skin::Skin;
use crate::tui::theme::Role;

/// Draws one view.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect, view: View) {
    match view {
        View::Response => response::draw(app, buffer, area),
        View::Gaps if app.heat => heat::draw(app, buffer, area),
        View::Gaps => gaps::draw(app, buffer, area),
        View::Locked => locked::draw(app, buffer, area),
        View::Frame => frame::draw(app, buffer, area),
        View::Map => map::draw(app, buffer, area),
        View::Spectrum => spectrum::draw(app, buffer, area),
        View::Precision => precision::draw(app, buffer, area),
    }
}

/// The title row: a rule with the digit and name of the view and its legend,
/// as much of it as fits whole. Returns the rest of the area.
pub fn title(
    app: &App,
    buffer: &mut Buffer,
    area: Rect,
    view: View,
    name: &str,
    legend: &[(String, Style)],
) -> Rect {
    let skin = &app.skin;
    let rule = skin.either("─", "-").repeat(usize::from(area.width));
    print(buffer, area, 0, &rule, skin.style(Role::Quiet));
    let style = if view == app.view {
        skin.style(Role::Focus).add_modifier(Modifier::BOLD)
    } else {
        skin.style(Role::Text)
    };
    let name = skin.spell(&format!(" {} {name} ", view.digit()));
    let mut column = 1;
    let put = |text: &str, style: Style, column: &mut u16, buffer: &mut Buffer| {
        let wide = u16::try_from(text.chars().count()).unwrap_or(u16::MAX);
        if column.saturating_add(wide) > area.width {
            return false;
        }
        buffer.set_string(area.x + *column, area.y, text, style);
        *column += wide;
        true
    };
    put(&name, style, &mut column, buffer);
    for (text, style) in legend {
        if !put(&format!(" {} ", skin.spell(text)), *style, &mut column, buffer) {
            break;
        }
    }
    Rect { y: area.y + 1, height: area.height.saturating_sub(1), ..area }
}

/// A legend entry: a stretch of the line and the name of what it shows.
pub fn entry(skin: &Skin, pen: &Pen, name: &str) -> (String, Style) {
    let stroke = match (skin.ascii(), pen.dashed) {
        (true, _) => pen.sign.to_string().repeat(2),
        (false, true) => "╌╌".to_string(),
        (false, false) => "──".to_string(),
    };
    (format!("{stroke} {name}"), pen.style)
}
