//! The screen for a projector: one chart, the verdict in large letters, why in one
//! sentence, and the knob being turned as a wide bar. Nothing else.

use font8x8::{BASIC_FONTS, UnicodeFonts};
use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Modifier, Style};

use super::{header, knobs};
use crate::tui::app::{App, InputMode, Target};
use crate::tui::text::{columns, print, shorten};
use crate::tui::theme::Role;

/// Smaller screens have the usual panels.
const LEAST: (u16, u16) = (60, 18);
/// Least height at which letters and bar are twice as high.
const TALL: u16 = 32;

/// Returns whether the screen is drawn so.
pub fn is_shown(app: &App, area: Rect) -> bool {
    let open = matches!(
        app.dialogue.mode,
        InputMode::Main | InputMode::Typing(_) | InputMode::Naming(..) | InputMode::Replacing(..)
    );
    app.appearance.wide && open && area.width >= LEAST.0 && area.height >= LEAST.1
}

/// Letters with the sentence below them, the chart, the knob, and the line for
/// questions and messages.
pub fn split(app: &App, area: Rect) -> [Rect; 4] {
    let tall = area.height >= TALL;
    // Half blocks are no ASCII: there, each dot of a letter is a whole cell.
    let letters = if tall || app.appearance.ascii() { 8 } else { 4 };
    Layout::vertical([
        Constraint::Length(letters + 1),
        Constraint::Min(1),
        Constraint::Length(if tall { 3 } else { 2 }),
        Constraint::Length(1),
    ])
    .areas(area)
}

/// Draws the verdict and its reason.
pub fn letters(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    let (headline, style) = header::headline(app, usize::from(area.width));
    let rows = area.height.saturating_sub(1);
    let wide = u16::try_from(columns(&headline.word)).unwrap_or(u16::MAX);
    // Cells of a letter, across and down.
    let sizes = [(DOTS, DOTS), (DOTS, DOTS / 2), (DOTS / 2, DOTS / 2)];
    let size = sizes.into_iter().find(|(width, height)| {
        wide.saturating_mul(*width) <= area.width
            && *height <= rows
            && (*height == DOTS || !look.ascii())
    });
    match size {
        Some((width, height)) => {
            let left = (area.width - wide * width) / 2;
            let mut at = Rect { x: area.x + left, y: area.y + (rows - height) / 2, width, height };
            for letter in headline.word.chars() {
                large_letter(buffer, at, letter, style, look.ascii());
                at.x += width;
            }
        }
        None => centred(app, buffer, area, rows / 2, &headline.word, style),
    }
    let parts =
        headline.history.map_or(headline.what.clone(), |told| format!("{} {told}", headline.what));
    centred(app, buffer, area, rows, &parts, look.style(Role::Text));
}

/// Dots across and down of a large letter.
const DOTS: u16 = 8;
/// The signs of a cell of two by two dots: those above count 1 and 2, those below 4 and 8.
const QUADRANTS: [char; 16] =
    [' ', '▘', '▝', '▀', '▖', '▌', '▞', '▛', '▗', '▚', '▐', '▜', '▄', '▙', '▟', '█'];

/// Draws a letter that fills this area.
fn large_letter(buffer: &mut Buffer, area: Rect, letter: char, style: Style, ascii: bool) {
    let glyph = BASIC_FONTS.get(letter).unwrap_or_default();
    let dot = |x: u16, y: u16| usize::from(glyph.get(usize::from(y)).map_or(0, |row| row >> x & 1));
    let (across, down) = (DOTS / area.width, DOTS / area.height);
    for at in area.positions() {
        let (x, y) = ((at.x - area.x) * across, (at.y - area.y) * down);
        // One dot fills a cell of its own.
        let (right, below) = (x + across - 1, y + down - 1);
        let dots = dot(x, y) + 2 * dot(right, y) + 4 * dot(x, below) + 8 * dot(right, below);
        let sign = if ascii && dots > 0 { '#' } else { *QUADRANTS.get(dots).unwrap_or(&' ') };
        if let Some(cell) = buffer.cell_mut(at) {
            cell.set_char(sign).set_style(style);
        }
    }
}

fn centred(app: &App, buffer: &mut Buffer, area: Rect, row: u16, text: &str, style: Style) {
    let look = &app.appearance;
    let text = shorten(&look.spell(text), usize::from(area.width), look.ellipsis());
    let left = area.width.saturating_sub(u16::try_from(columns(&text)).unwrap_or(0)) / 2;
    print(buffer, Rect { x: area.x + left, width: area.width - left, ..area }, row, &text, style);
}

/// Draws the selected knob: its value, and a bar over the whole width.
pub fn knob(app: &App, buffer: &mut Buffer, area: Rect) {
    let Some(knob) = app.selected() else { return };
    app.note(area, Target::Knob(app.knobs.selected));
    let focus = app.appearance.style(Role::Focus).add_modifier(Modifier::BOLD);
    match (&app.knobs.refusal, &app.dialogue.mode) {
        (Some(refusal), _) => {
            centred(app, buffer, area, 0, refusal, app.appearance.style(Role::Trouble));
        }
        (None, InputMode::Typing(text)) => {
            let typed = knob.typed(text, usize::from(area.width / 2));
            centred(app, buffer, area, 0, &format!("{} = {typed}", knob.label), focus);
        }
        _ => {
            let shown = knob.text(&app.scene);
            centred(app, buffer, area, 0, &format!("{} = {shown}", knob.label), focus);
        }
    }
    knobs::draw(app, buffer, bar_cells(area), knob);
}

/// Returns the cells of the bar of the selected knob.
fn bar_cells(area: Rect) -> Rect {
    let height = area.height.saturating_sub(1);
    Rect { x: area.x + 2, y: area.y + 1, width: area.width.saturating_sub(4), height }
}
