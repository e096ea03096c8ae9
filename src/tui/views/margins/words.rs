//! The words around the margins: what its signs mean, and what the cell under the
//! cursor says.

use ratatui::style::Style;

use super::bar::signs;
use super::rows::{change_text, opening, percent_text, reason, with_unit};
use crate::report::margins::LimitRow;
use crate::study::margins::Side;
use crate::tui::app::App;
use crate::tui::appearance::Appearance;
use crate::tui::knobs::knob_of;
use crate::tui::theme::Role;
use crate::tui::views::Opening;

/// The colour of a side: to be beyond a limit is no trouble.
pub fn role(side: Side) -> Role {
    match side {
        Side::Below => Role::Quiet,
        Side::At | Side::Beyond | Side::Inside => Role::Text,
    }
}

/// The sign of the nearest limit.
pub fn nearest_sign(look: &Appearance) -> &'static str {
    look.either("●", "*")
}

/// The title: whether the margins are old, and what the signs of the bars mean.
pub fn title(app: &App, width: u16) -> Vec<(String, Style)> {
    let look = &app.appearance;
    let mut line = Vec::new();
    if app.margins().is_some_and(|(_, old)| old) {
        let text = if width < 50 { "old" } else { "of the knobs before" };
        line.push((text.to_string(), look.style(Role::Focus)));
    }
    let [_, now, _, limit, _, lasting] = signs(look);
    // Not by `spell`: these signs are ASCII already where they must be.
    line.push((format!("{now} now"), look.style(Role::Focus)));
    line.push((format!("{limit} limit"), look.style(Role::Text)));
    line.push((format!("{lasting} lasts"), look.style(Role::Contact)));
    line.push((format!("{} nearest", nearest_sign(look)), look.style(Role::Focus)));
    line.extend(app.tuned_note().map(|note| (note.to_string(), look.style(Role::Quiet))));
    line
}

/// The cell under the cursor in words, or the key that leads to it.
pub fn told(app: &App, rows: &[LimitRow], cell: Option<[usize; 2]>) -> (String, Role) {
    let found = cell.and_then(|[column, row]| Some((column, rows.get(row)?)));
    let Some((column, row)) = found else {
        return ("i reads a row: Enter jumps to its limit, or selects a knob".into(), Role::Quiet);
    };
    let text = match column.checked_sub(1) {
        None => limit(app, row),
        Some(place) => match row.strongest().get(place) {
            Some((path, by)) => knob(row, path, *by),
            None => format!("{}: no more knobs move it", row.title(false)),
        },
    };
    (text, Role::Focus)
}

/// A limit: its value, what it is, and where the scene is.
fn limit(app: &App, row: &LimitRow) -> String {
    let mut parts = vec![match row.value() {
        Some(value) => format!("{} {}", row.title(false), with_unit(value, row.quantity())),
        None => row.title(false),
    }];
    parts.push(format!(": {}", row.name.what()));
    if let Some(side) = row.side() {
        parts.push(format!("; now {} {side}", percent_text(row).trim_start_matches(['+', '-'])));
    }
    if let Some(note) = reason(row).as_deref().or(row.note()) {
        parts.push(format!("; {note}"));
    }
    // The last line says what Enter does, but not with which knob.
    if let Opening::Select(path) = opening(row, 0, app) {
        let knob = knob_of(path).map_or(path, |knob| knob.label);
        parts.push(format!(". Enter selects {knob}"));
    }
    parts.concat()
}

/// A knob: its present value, and what one per cent more of it does.
fn knob(row: &LimitRow, path: &'static str, by: f64) -> String {
    let label = knob_of(path).map_or(path, |knob| knob.label);
    let part = row.value().map(|value| with_unit(value * by / 100.0, row.quantity()));
    let part = part.map_or(String::new(), |part| format!(" ({part})"));
    let symbol = row.title(false);
    format!("1 % more of {label}: {symbol} {} %{part}", change_text(by))
}
