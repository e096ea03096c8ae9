//! The rows of the margins: names, numbers, and what Enter does on them.
//!
//! The words around the margins: what its signs mean, and what the cell under the
//! cursor says.

use ratatui::style::Style;

use crate::report::margins::STRONGEST;
use crate::report::number::{per_speed, rounded, short, speed_unit};
use crate::tui::app::App;
use crate::tui::appearance::Appearance;
use crate::tui::axis::readable;
use crate::tui::knobs::{Knob, knob_of, number};
use crate::tui::theme::Role;
use crate::tui::views::Opening;
use crate::tui::views::margins::table::signs;
use rubscope_solver::study::margins::{Limit, Quantity, Side};

/// Digits of a limit.
pub const DIGITS: usize = 5;

/// From this factor on, a margin is told as one.
const FACTORS: f64 = 10.0;

/// The value of a limit, in a column whose speeds have the unit of speeds.
pub fn value_text(row: &Limit) -> String {
    match (row.value, row.quantity) {
        (None, _) => String::new(),
        (Some(value), Quantity::Speed) => number(rounded(per_speed(value), DIGITS), ""),
        (Some(value), quantity) => with_unit(value, quantity),
    }
}

/// A value of a limit, with its unit.
pub fn with_unit(value: f64, quantity: Quantity) -> String {
    match quantity {
        Quantity::Speed => {
            format!("{} {}", number(rounded(per_speed(value), DIGITS), ""), speed_unit())
        }
        Quantity::Pulse => number(rounded(value, DIGITS), quantity.unit()),
        _ => readable(value, quantity.unit()),
    }
}

/// How far beyond a limit the scene is, in per cent, or as a factor where it is far.
pub fn percent_text(row: &Limit) -> String {
    row.margin.map_or(String::new(), |margin| match 1.0 + margin {
        factor if factor >= FACTORS => format!("{} x", short(rounded(factor, 3))),
        _ => format!("{:+.1} %", 100.0 * margin),
    })
}

/// Why there is no value.
pub fn reason(row: &Limit) -> Option<String> {
    let none = || row.note.as_ref().map_or("none".into(), |note| format!("none: {note}"));
    row.value.is_none().then(none)
}

/// What Enter does on a column of a row.
pub fn opening(row: &Limit, column: usize, app: &App) -> Opening {
    let nothing = || {
        let why = reason(row).unwrap_or_else(|| "no such knob moves it".into());
        Opening::Nothing(format!("{}: {why}", row.name.titles()[0]))
    };
    let select = |place: usize| {
        let knob = row.sensitivities.strongest(STRONGEST).get(place).map(|knob| knob.0);
        knob.map_or_else(nothing, Opening::Select)
    };
    match (column.checked_sub(1), row.quantity.path(), row.value) {
        (Some(place), ..) => select(place),
        (None, None, _) => select(0),
        (None, Some(_), None) => nothing(),
        (None, Some(path), Some(value)) => {
            // Limits of speed are magnitudes; the rotor keeps its sense.
            let backward = app.scene.operation.speed_rad_s < 0.0;
            let speed = row.quantity == Quantity::Speed;
            let value = if speed && backward { -value } else { value };
            Opening::Jump { path, value, to: row.name.titles()[0].to_string() }
        }
    }
}

/// The symbol of a parameter: the last word of the name of its knob.
pub fn knob_symbol(path: &'static str) -> &'static str {
    knob_of(path).map_or(path, Knob::symbol)
}

/// The limit that is nearest to the scene.
pub fn nearest(rows: &[Limit]) -> Option<usize> {
    let margins = rows.iter().enumerate();
    let margins = margins.filter_map(|(place, row)| Some((place, row.margin?.abs())));
    margins.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// A change in per cent by one per cent of a knob, in about three digits.
pub fn change_text(by: f64) -> String {
    match by.abs() {
        0.0..1e-3 => format!("{by:+.4}"),
        1e-3..10.0 => format!("{by:+.3}"),
        10.0..100.0 => format!("{by:+.2}"),
        100.0..1e3 => format!("{by:+.1}"),
        1e3..1e5 => format!("{by:+.0}"),
        _ => format!("{by:+.0e}"),
    }
}

/// The colour of a side: to be beyond a limit is no trouble.
pub fn role(side: Side) -> Role {
    match side {
        Side::Below => Role::Quiet,
        Side::At | Side::Beyond => Role::Text,
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
    let [_, now, _, limit, _] = signs(look);
    // Not by `spell`: these signs are ASCII already where they must be.
    line.push((format!("{now} now"), look.style(Role::Focus)));
    line.push((format!("{limit} limit"), look.style(Role::Text)));
    line.push((format!("{} nearest", nearest_sign(look)), look.style(Role::Focus)));
    line.extend(app.tuned_note().map(|note| (note.to_string(), look.style(Role::Quiet))));
    line
}

/// The cell under the cursor in words, or the key that leads to it.
pub fn told(app: &App, rows: &[Limit], cell: Option<[usize; 2]>) -> (String, Role) {
    let found = cell.and_then(|[column, row]| Some((column, rows.get(row)?)));
    let Some((column, row)) = found else {
        return ("i reads a row: Enter jumps to its limit, or selects a knob".into(), Role::Quiet);
    };
    let text = match column.checked_sub(1) {
        None => limit(app, row),
        Some(place) => match row.sensitivities.strongest(STRONGEST).get(place) {
            Some((path, by)) => knob(row, path, *by),
            None => format!("{}: no more knobs move it", row.name.titles()[0]),
        },
    };
    (text, Role::Focus)
}

/// A limit: its value, what it is, and where the scene is.
fn limit(app: &App, row: &Limit) -> String {
    let mut parts = vec![match row.value {
        Some(value) => format!("{} {}", row.name.titles()[0], with_unit(value, row.quantity)),
        None => row.name.titles()[0].to_string(),
    }];
    parts.push(format!(": {}", row.name.what()));
    if let Some(side) = row.side() {
        parts.push(format!("; now {} {side}", percent_text(row).trim_start_matches(['+', '-'])));
    }
    if let Some(note) = reason(row).as_deref().or(row.note.as_deref()) {
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
fn knob(row: &Limit, path: &'static str, by: f64) -> String {
    let label = knob_of(path).map_or(path, |knob| knob.label);
    let part = row.value.map(|value| with_unit(value * by / 100.0, row.quantity));
    let part = part.map_or(String::new(), |part| format!(" ({part})"));
    let symbol = row.name.titles()[0];
    format!("1 % more of {label}: {symbol} {} %{part}", change_text(by))
}
