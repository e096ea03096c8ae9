//! Which columns a width has room for, the most important first, and where they are.

use ratatui::layout::Rect;

use super::rows::{change_text, knob_symbol, percent_text, value_text};
use crate::report::margins::{LimitRow, TOLD};
use crate::tui::appearance::Appearance;
use crate::tui::text::columns as cells;

/// A column of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Column {
    /// The name of the limit.
    Symbol,
    /// From 0 to the limit, with the present value.
    Bar,
    /// The limit.
    Value,
    /// The margin.
    Percent,
    /// The side.
    Word,
    /// One of the knobs that matter most.
    Knob(usize),
}

use Column::{Bar, Knob, Percent, Symbol, Value, Word};

/// What there is room for, in the order of its importance: in the large chart,
const LARGE: [Column; 7] = [Percent, Value, Knob(0), Bar, Word, Knob(1), Knob(2)];
/// and in another one.
const BESIDE: [Column; 4] = [Percent, Word, Value, Bar];
/// From left to right.
const ORDER: [Column; 8] = [Symbol, Bar, Value, Percent, Word, Knob(0), Knob(1), Knob(2)];

/// The narrowest bar of a limit,
const LEAST_BAR: u16 = 4;
/// the one from which on other columns may grow,
const GOOD_BAR: u16 = 24;
/// and the widest.
const MOST_BAR: u16 = 60;
/// The narrowest bar of a knob, and the widest: an odd number of cells.
const KNOB_BAR: [u16; 2] = [3, 9];
/// Below this width, the symbol of a knob has this many cells: Greek letters are long
/// in ASCII.
const WHOLE_FROM: u16 = 60;
const LABEL: u16 = 4;
/// From this width on, limits have their long names.
const LONG_FROM: u16 = 100;

/// The columns of a table.
#[derive(Debug)]
pub struct Columns {
    shown: Vec<(Column, u16)>,
    label: u16,
    knob_bar: u16,
    /// Whether limits have their short titles.
    pub short: bool,
}

impl Columns {
    /// The columns for these rows.
    pub fn of(rows: &[LimitRow], area: Rect, large: bool, look: &Appearance) -> Self {
        let widest = |of: &dyn Fn(&LimitRow) -> String| {
            let most = rows.iter().map(|row| cells(&look.spell(&of(row)))).max();
            most.and_then(|most| u16::try_from(most).ok()).unwrap_or(0)
        };
        let widest_knob = |of: &dyn Fn(&(&'static str, f64)) -> String| {
            let strongest = rows.iter().flat_map(LimitRow::strongest);
            let most = strongest.map(|knob| cells(&look.spell(&of(&knob)))).max();
            most.and_then(|most| u16::try_from(most).ok()).unwrap_or(1)
        };
        let short = area.width < LONG_FROM;
        let label = widest_knob(&|(path, _)| knob_symbol(path).to_string());
        let label = if area.width < WHOLE_FROM { label.min(LABEL) } else { label };
        let number = widest_knob(&|(_, by)| change_text(*by));
        let mut knob_bar = KNOB_BAR[0];
        let width = |column: Column, knob_bar: u16| match column {
            Symbol => widest(&|row| row.title(short)),
            Bar => LEAST_BAR,
            Value => widest(&value_text),
            Percent => widest(&percent_text),
            Word => 6,
            Knob(_) => label + 1 + knob_bar + 1 + number,
        };
        // The first cell is for the cursor.
        let mut left = area.width.saturating_sub(1 + width(Symbol, knob_bar));
        let mut chosen = vec![Symbol];
        for &column in if large { &LARGE[..] } else { &BESIDE } {
            let wide = 1 + width(column, knob_bar);
            if wide <= left {
                left -= wide;
                chosen.push(column);
            }
        }
        let knobs = chosen.iter().filter(|column| matches!(column, Knob(_))).count();
        let knobs = u16::try_from(knobs).unwrap_or(0);
        let has_bar = chosen.contains(&Bar);
        while knobs > 0
            && knob_bar + 2 <= KNOB_BAR[1]
            && left >= 2 * knobs + if has_bar { GOOD_BAR } else { 0 }
        {
            (knob_bar, left) = (knob_bar + 2, left - 2 * knobs);
        }
        let bar = (LEAST_BAR + left).min(MOST_BAR);
        let wide = |column| if column == Bar { bar } else { width(column, knob_bar) };
        let shown = ORDER.into_iter().filter(|column| chosen.contains(column));
        Self { shown: shown.map(|column| (column, wide(column))).collect(), label, knob_bar, short }
    }

    /// Whether a column is shown.
    pub fn has(&self, column: Column) -> bool {
        self.shown.iter().any(|(shown, _)| *shown == column)
    }

    /// How many knobs are shown.
    pub fn knobs(&self) -> usize {
        (0..TOLD).filter(|place| self.has(Knob(*place))).count()
    }

    /// The columns in a line, from left to right; none beyond its end.
    pub fn places(&self, line: Rect) -> Vec<(Column, Rect)> {
        let mut x = line.x.saturating_add(1);
        let mut places = Vec::new();
        for &(column, width) in &self.shown {
            let width = width.min(line.right().saturating_sub(x));
            places.push((column, Rect { x, width, height: 1, ..line }));
            x = x.saturating_add(width + 1).min(line.right());
        }
        places
    }

    /// What is left of a line behind the name.
    pub fn after_symbol(&self, line: Rect) -> Rect {
        let symbol = self.shown.first().map_or(0, |(_, width)| *width);
        let x = line.x.saturating_add(symbol + 2).min(line.right());
        Rect { x, width: line.right() - x, height: 1, ..line }
    }

    /// The cells of a knob: symbol, number and bar.
    pub fn knob_cells(&self, line: Rect, place: usize) -> [Rect; 3] {
        let places = self.places(line);
        let found = places.into_iter().find(|(column, _)| *column == Knob(place));
        let whole = found.map_or(Rect { width: 0, ..line }, |(_, whole)| whole);
        let part = |from: u16, width: u16| {
            let x = whole.x.saturating_add(from).min(whole.right());
            Rect { x, width: width.min(whole.right() - x), ..whole }
        };
        // The number stands beside its own knob; the bar is at the end.
        let number = self.label + 1;
        let bar = whole.width.saturating_sub(self.knob_bar);
        [part(0, self.label), part(number, bar.saturating_sub(number + 1)), part(bar, u16::MAX)]
    }
}
