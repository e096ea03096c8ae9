//! The screen as a function of the state: header, footer, and between them an open list or the
//! charts with the knobs and the lesson.

mod footer;
mod header;

use ratatui::widgets::{Clear, Widget};
use ratatui::{Frame, buffer::Buffer, layout::Rect, style::Modifier};

use super::app::knobs::{panel as knobs, strip};
use super::app::layout::{LEAST_HEIGHT, LEAST_WIDTH, Places};
use super::app::{App, InputMode, help, layout, lesson, palette};
use super::command::Command;
use super::field::CURSOR;
use super::text::{CUT, print, wrap};
use super::theme::Role;
use super::views::margins::ends;
use super::views::{ViewArea, ViewId};
pub use header::head_text;

/// Draws the whole screen into a frame of the terminal.
pub fn draw(frame: &mut Frame, app: &App) {
    let area = frame.area();
    paint(app, frame.buffer_mut(), area);
}

/// Paints the whole screen into a buffer.
pub fn paint(app: &App, buffer: &mut Buffer, area: Rect) {
    app.forget_drawn();
    app.appearance.use_units();
    if area.width < LEAST_WIDTH || area.height < LEAST_HEIGHT {
        let needs = format!(
            "rubscope needs {LEAST_WIDTH}x{LEAST_HEIGHT}; this is {}x{}",
            area.width, area.height
        );
        for (row, line) in (0..area.height).zip(wrap(&needs, usize::from(area.width))) {
            print(buffer, area, row, &line, app.appearance.style(Role::Text));
        }
        return;
    }
    let places = layout::places(area, app);
    header::draw(app, buffer, places.header);
    match &app.dialogue.mode {
        InputMode::Help(filter) | InputMode::Search(filter) => {
            help::draw(app, buffer, places.body, filter);
        }
        InputMode::Palette(word, typed) => {
            palette::draw(app, buffer, places.body, word, typed);
        }
        _ => main_screen(app, buffer, &places),
    }
    footer::draw(app, buffer, places.footer);
    for cell in &mut buffer.content {
        if let Some(letter) = cell.symbol().strip_suffix(CURSOR).map(String::from) {
            cell.set_symbol(&letter).modifier.toggle(Modifier::REVERSED);
        }
    }
    if app.appearance.ascii() {
        // Names and titles may contain any character.
        let others = buffer.content.iter_mut().filter(|cell| !cell.symbol().is_ascii());
        let plain = |sign: &str| if sign.starts_with(CUT) { '>' } else { '?' };
        others.for_each(|cell| _ = cell.set_char(plain(cell.symbol())));
    }
}

/// Draws the lesson, the knobs and the charts.
fn main_screen(app: &App, buffer: &mut Buffer, places: &Places) {
    if let Some(area) = places.lesson {
        lesson::draw_step(app, buffer, area);
    }
    if places.column {
        knobs::panel(app, buffer, places.knobs, 0);
    } else {
        strip::draw(app, buffer, places.knobs, places.list.is_some());
    }
    for (view, area) in &places.charts {
        let at = ViewArea { area: *area, digit: view.digit(), large: *view == app.view() };
        if !at.large {
            app.note(*area, Command::View(*view));
        }
        match view {
            ViewId::Margins if app.is_overview() => ends::draw(app, buffer, at),
            _ => app.panel_of(*view).draw(app, buffer, at),
        }
    }
    if let Some(area) = places.list {
        Clear.render(area, buffer);
        knobs::panel(app, buffer, area, strip::count(app, places.knobs.width));
    } else if !places.column {
        let below = places.body.bottom() - places.knobs.y;
        knobs::refusal(app, buffer, Rect { height: below, ..places.knobs }, 0);
    }
}
