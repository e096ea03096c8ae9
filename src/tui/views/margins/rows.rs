//! The text around the margins: the title, the description of the cell under the cursor, and what
//! Enter does there.

use ratatui::style::Style;

use crate::sheet::margins::{STRONGEST, words};
use crate::sheet::number::with_unit;
use crate::tui::app::App;
use crate::tui::command::Command;
use crate::tui::knobs::{KNOBS, knob_of, place_of};
use crate::tui::theme::Role;
use rubscope_solver::study::margins::{Limit, Quantity};

/// Columns of the table before the first knob: limit, value and margin.
pub const LEADING: usize = 3;

/// Significant digits of a limit.
pub const DIGITS: usize = 5;

/// Formats the value of a limit with its unit.
fn value_text(value: f64, quantity: Quantity) -> String {
    with_unit(value, DIGITS, quantity.unit())
}

/// Returns why a limit has no value; `None` if it has one.
pub fn reason(row: &Limit) -> Option<String> {
    let none = || row.note.as_ref().map_or("none".into(), |note| format!("none: {note}"));
    row.value.is_none().then(none)
}

/// Returns what Enter does in a cell.
pub fn opening(row: &Limit, column: usize, app: &App) -> Command {
    let nothing = || {
        let why = reason(row).unwrap_or_else(|| "no such knob moves it".into());
        Command::Nothing(format!("{}: {why}", row.name.titles()[0]))
    };
    let select = |place: usize| {
        let path = row.sensitivities.strongest(STRONGEST).get(place).map(|knob| knob.0);
        path.and_then(place_of).map_or_else(nothing, Command::Select)
    };
    match (column.checked_sub(1), row.quantity.path(), row.value) {
        (Some(place), ..) => select(place),
        (None, None, _) => select(0),
        (None, Some(_), None) => nothing(),
        (None, Some(path), Some(value)) => {
            // Limits of speed are magnitudes; keep the rotor's direction.
            let backward = app.scene.operation.speed_rad_s < 0.0;
            let speed = row.quantity == Quantity::Speed;
            let value = if speed && backward { -value } else { value };
            Command::JumpTo { path, value, to: row.name.titles()[0].to_string() }
        }
    }
}

/// Returns the index of the row with the smallest margin, as a magnitude; `None` if no limit has a
/// margin.
pub fn nearest(rows: &[Limit]) -> Option<usize> {
    let margins = rows.iter().enumerate();
    let margins = margins.filter_map(|(place, row)| Some((place, row.margin?.abs())));
    margins.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// Returns the row that the current lesson step names (the last one of that name), or the first
/// row.
pub fn home(app: &App, rows: &[Limit]) -> usize {
    let named = app.lesson_step().and_then(|(step, _)| step.limit);
    rows.iter().rposition(|row| named == Some(row.name)).unwrap_or(0)
}

/// Returns the role of a cell. Being beyond a limit is not trouble by itself: a lock, for
/// example, needs a speed above `Omega_lock`.
pub fn role(limit: &Limit, column: usize) -> Role {
    let strongest = limit.sensitivities.strongest(STRONGEST);
    match column.checked_sub(LEADING).and_then(|place| strongest.get(place)) {
        Some((_, by)) if *by < 0.0 => Role::Second,
        Some(_) => Role::First,
        None if limit.value.is_none() => Role::Quiet,
        None if column + 1 == LEADING && limit.margin.is_some_and(|by| by < 0.0) => Role::Quiet,
        None => Role::Text,
    }
}

/// Returns the entries of the title: a note if the margins are outdated, and the sign of the
/// nearest limit.
pub fn title(app: &App) -> Vec<(String, Style)> {
    let look = &app.appearance;
    let mut line = Vec::new();
    if app.margins().is_some_and(|(_, old)| old) {
        line.push(("outdated".to_string(), look.style(Role::Focus)));
    }
    line.push((format!("{} nearest", look.either("●", "*")), look.style(Role::Focus)));
    line.extend(app.tuned_note().map(|note| (note.to_string(), look.style(Role::Quiet))));
    line
}

/// Describes the cell under the cursor, or names the key that starts reading.
pub fn told(app: &App, rows: &[Limit], cell: Option<[usize; 2]>) -> (String, Role) {
    let found = cell.and_then(|[column, row]| Some((column, rows.get(row)?)));
    let Some((column, row)) = found else {
        return ("i reads a row: Enter jumps to it, or selects a knob".into(), Role::Quiet);
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

/// Describes a limit: value, meaning, and the margin of the scene.
fn limit(app: &App, row: &Limit) -> String {
    let mut parts = vec![match row.value {
        Some(value) => format!("{} {}", row.name.titles()[0], value_text(value, row.quantity)),
        None => row.name.titles()[0].to_string(),
    }];
    parts.push(format!(": {}", row.name.what()));
    let changed = row.margin.filter(|margin| *margin != -1.0).map(words::to_limit);
    parts.extend(changed.map(|change| format!("; {change} from here")));
    if let Some(note) = reason(row).as_deref().or(row.note.as_deref()) {
        parts.push(format!("; {note}"));
    }
    // The footer names the action of Enter, but not the knob.
    if let Command::Select(place) = opening(row, 0, app)
        && let Some(knob) = KNOBS.get(place)
    {
        parts.push(format!(". Enter selects {}", knob.label));
    }
    parts.concat()
}

/// Describes the sensitivity to a knob: the change of the limit per 1 % of the knob.
fn knob(row: &Limit, path: &'static str, by: f64) -> String {
    let label = knob_of(path).map_or(path, |knob| knob.label);
    let part = row.value.map(|value| value_text(value * by / 100.0, row.quantity));
    let part = part.map_or(String::new(), |part| format!(" ({part})"));
    let symbol = row.name.titles()[0];
    format!("1 % more of {label}: {symbol} {}{part}", words::change(by))
}
