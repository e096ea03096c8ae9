//! The rows of the margins: names, numbers, and what Enter does on them.

use super::LiveMargins;
use crate::report::margins::LimitRow;
use crate::report::number::{rounded, short};
use crate::study::margins::{Margins, Quantity};
use crate::tui::app::App;
use crate::tui::axis::readable;
use crate::tui::knobs::{Knob, knob_of, number};
use crate::tui::views::Opening;

/// Digits of a limit.
pub const DIGITS: usize = 5;

/// From this factor on, a margin is told as one.
const FACTORS: f64 = 10.0;

impl LiveMargins {
    /// Margins in which nothing was searched yet.
    pub fn of(margins: Margins) -> Self {
        let awaited = margins.laws().to_vec();
        Self { margins, awaited }
    }

    /// The rows, in the order of the limits; what is searched is among the pulses.
    pub fn rows(&self) -> Vec<LimitRow<'_>> {
        LimitRow::all(&self.margins, &self.awaited)
    }
}

/// The value of a limit, in a column whose speeds are in rad/s.
pub fn value_text(row: &LimitRow) -> String {
    match (row.value(), row.quantity()) {
        (None, _) => String::new(),
        (Some(value), Quantity::Speed) => number(rounded(value, DIGITS), ""),
        (Some(value), quantity) => with_unit(value, quantity),
    }
}

/// A value of a limit, with its unit.
pub fn with_unit(value: f64, quantity: Quantity) -> String {
    match quantity {
        Quantity::Speed | Quantity::Pulse => number(rounded(value, DIGITS), quantity.unit()),
        _ => readable(value, quantity.unit()),
    }
}

/// How far beyond a limit the scene is, in per cent, or as a factor where it is far.
pub fn percent_text(row: &LimitRow) -> String {
    row.margin().map_or(String::new(), |margin| match 1.0 + margin {
        factor if factor >= FACTORS => format!("{} x", short(rounded(factor, 3))),
        _ => format!("{:+.1} %", 100.0 * margin),
    })
}

/// Why there is no value.
pub fn reason(row: &LimitRow) -> Option<String> {
    match (row.limit(), row.value(), row.note()) {
        (None, ..) => Some("searching ...".into()),
        (Some(_), None, note) => Some(note.map_or("none".into(), |note| format!("none: {note}"))),
        _ => None,
    }
}

/// What Enter does on a column of a row.
pub fn opening(row: &LimitRow, column: usize, app: &App) -> Opening {
    let nothing = || {
        let why = reason(row).unwrap_or_else(|| "no such knob moves it".into());
        Opening::Nothing(format!("{}: {why}", row.title(false)))
    };
    let select = |place: usize| {
        let knob = row.strongest().get(place).map(|knob| knob.0);
        knob.map_or_else(nothing, Opening::Select)
    };
    match (column.checked_sub(1), row.quantity().path(), row.value()) {
        (Some(place), ..) => select(place),
        (None, None, _) => select(0),
        (None, Some(_), None) => nothing(),
        (None, Some(path), Some(value)) => {
            // Limits of speed are magnitudes; the rotor keeps its sense.
            let backward = app.scene.operation.speed_rad_s < 0.0;
            let speed = row.quantity() == Quantity::Speed;
            let value = if speed && backward { -value } else { value };
            Opening::Jump { path, value, to: row.title(false) }
        }
    }
}

/// The symbol of a parameter: the last word of the name of its knob.
pub fn knob_symbol(path: &'static str) -> &'static str {
    knob_of(path).map_or(path, Knob::symbol)
}

/// The limit that is nearest to the scene.
pub fn nearest(rows: &[LimitRow]) -> Option<usize> {
    let margins = rows.iter().enumerate();
    let margins = margins.filter_map(|(place, row)| Some((place, row.margin()?.abs())));
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
