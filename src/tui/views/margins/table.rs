//! The table of the margins: its heading, its rows as far as there is room, and where
//! they are for the mouse.
//!
//! Which columns a width has room for, the most important first, and where they are.
//!
//! The bar of a limit: from zero to the limit, or to the present value where that is
//! beyond, with both on it; and the small bar of a sensitivity.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::{Modifier, Style};

use crate::report::margins::STRONGEST;
use crate::report::number::speed_unit;
use crate::tui::app::App;
use crate::tui::appearance::Appearance;
use crate::tui::knobs::KnobRange;
use crate::tui::text::{columns as cells, print, shorten};
use crate::tui::theme::Role;
use crate::tui::views::ViewArea;
use crate::tui::views::margins::rows::{change_text, knob_symbol, percent_text, value_text};
use crate::tui::views::margins::{COLUMNS, rows};
use Column::{Bar, Knob, Percent, Symbol, Value, Word};
use rubscope_solver::study::margins::{Limit, Quantity};

/// From this height on, columns have headings.
const HEADING_FROM: u16 = 8;

/// The rows, and how they are drawn.
pub struct Table<'a> {
    app: &'a App,
    rows: &'a [Limit],
    old: bool,
    at: ViewArea,
    columns: Columns,
    /// The first knob that is shown of each row.
    first_knob: usize,
}

impl<'a> Table<'a> {
    /// The table for an area; `old` where it is of other knobs.
    pub fn new(
        app: &'a App,
        rows: &'a [Limit],
        old: bool,
        at: ViewArea,
        area: Rect,
        cell: Option<[usize; 2]>,
    ) -> Self {
        let columns = Columns::of(rows, area, at.large, &app.appearance);
        // Fewer knobs than have room: the one under the cursor is among them.
        let column = cell.map_or(0, |[column, _]| column);
        let first_knob = column.saturating_sub(columns.knobs());
        Self { app, rows, old, at, columns, first_knob }
    }

    /// Draws as many rows as have room, with that of the cursor; the area that is left.
    pub fn draw(&self, buffer: &mut Buffer, area: Rect, cell: Option<[usize; 2]>) -> Rect {
        let look = &self.app.appearance;
        let mut area = area;
        if area.height >= HEADING_FROM {
            self.heading(buffer, area);
            area = Rect { y: area.y + 1, height: area.height - 1, ..area };
        }
        let (room, count) = (usize::from(area.height), self.rows.len());
        // A rule before the loads, where everything fits; pages otherwise, on which
        // rows stay where they are while a pointer goes over them.
        let loads = self.rows.iter().position(Limit::is_load).filter(|_| count < room);
        let page = if count <= room { count } else { room.saturating_sub(1) }.max(1);
        let row = cell.map_or(0, |[_, row]| row);
        let first = row / page * page;
        let shown = first..(first + page).min(count);
        let nearest = rows::nearest(self.rows);
        let mut y = 0;
        for (place, row) in self.rows.iter().enumerate().filter(|(place, _)| shown.contains(place))
        {
            if loads == Some(place) {
                self.rule(buffer, area, y);
                y += 1;
            }
            let line = Rect { y: area.y.saturating_add(y), height: 1, ..area };
            if y < area.height {
                let column = cell.filter(|cell| cell[1] == place).map(|[column, _]| column);
                self.row(buffer, line, row, (column, nearest == Some(place)));
                self.note(line, place);
            }
            y += 1;
        }
        if count > room {
            let (before, after) = (shown.start, count - shown.end);
            let text = match (before, after) {
                (0, after) => format!(" +{after} more"),
                (before, 0) => format!(" {before} before"),
                (before, after) => format!(" {before} before, +{after} more"),
            };
            print(buffer, area, area.height.saturating_sub(1), &text, look.style(Role::Quiet));
            y = area.height;
        }
        let y = y.min(area.height);
        Rect { y: area.y + y, height: area.height - y, ..area }
    }

    /// The names of the columns.
    fn heading(&self, buffer: &mut Buffer, area: Rect) {
        let columns = &self.columns;
        let quiet = self.app.appearance.style(Role::Quiet);
        for (column, place) in columns.places(area) {
            let text = match column {
                Column::Symbol => "limit",
                Column::Bar if place.width >= 21 => "from 0 to it, and now",
                Column::Bar => "",
                Column::Value => speed_unit(),
                Column::Percent => "now",
                Column::Word => "",
                Column::Knob(0) if columns.knobs() > 1 => "1 % more of a knob gives, %",
                Column::Knob(0) => "+1 % gives",
                Column::Knob(_) => continue,
            };
            let place = match column {
                Column::Knob(_) => Rect { width: area.right() - place.x, ..place },
                _ => place,
            };
            let text = match column {
                Column::Value | Column::Percent => format!("{text:>0$}", usize::from(place.width)),
                _ => text.to_string(),
            };
            print(buffer, place, 0, &text, quiet);
        }
    }

    /// The rule before the loads.
    fn rule(&self, buffer: &mut Buffer, area: Rect, y: u16) {
        let look = &self.app.appearance;
        let rule = look.either("─", "-");
        let text = format!("{rule} loads of a lock at this speed ");
        let width = usize::from(area.width);
        let text = format!("{text}{}", rule.repeat(width.saturating_sub(text.chars().count())));
        print(buffer, area, y, &shorten(&text, width, rule), look.style(Role::Quiet));
    }

    /// One row; `cursor` is the column that is read in it, and whether it is the nearest.
    fn row(
        &self,
        buffer: &mut Buffer,
        line: Rect,
        row: &Limit,
        (cursor, nearest): (Option<usize>, bool),
    ) {
        let columns = &self.columns;
        let look = &self.app.appearance;
        let style = |role: Role| look.style(if self.old { Role::Quiet } else { role });
        let here = look.style(Role::Focus).add_modifier(Modifier::REVERSED);
        if cursor.is_some() {
            print(buffer, line, 0, look.either("▸", ">"), look.style(Role::Focus));
        } else if nearest {
            print(buffer, line, 0, rows::nearest_sign(look), style(Role::Focus));
        }
        let quiet = row.value.is_none();
        for (column, place) in columns.places(line) {
            let width = usize::from(place.width);
            let mut put = |text: &str, style: Style| print(buffer, place, 0, text, style);
            match column {
                Column::Symbol => {
                    let text = shorten(
                        &look.spell(row.name.titles()[usize::from(columns.short)]),
                        width,
                        look.ellipsis(),
                    );
                    put(&text, if cursor == Some(0) { here } else { style(Role::Text) });
                }
                Column::Bar if !quiet => {
                    if let Some(bar) = LimitBar::of(row) {
                        bar.draw(look, buffer, place, self.old);
                    }
                }
                Column::Value => put(
                    &format!("{:>width$}", look.spell(&rows::value_text(row))),
                    style(Role::Text),
                ),
                Column::Percent => {
                    let role = row.side().map_or(Role::Text, rows::role);
                    let text = match row.is_load() && !columns.has(Column::Value) {
                        true => rows::value_text(row),
                        false => rows::percent_text(row),
                    };
                    put(&format!("{:>width$}", look.spell(&text)), style(role));
                }
                Column::Word => {
                    if let Some(side) = row.side() {
                        put(&side.to_string(), style(rows::role(side)));
                    }
                }
                Column::Knob(place) => {
                    let under = cursor == Some(place + self.first_knob + 1);
                    self.knob(buffer, line, place, row, under);
                }
                Column::Bar => {}
            }
        }
        if let Some(reason) = rows::reason(row) {
            // In the place of all that is not there.
            let symbol = columns.after_symbol(line);
            print(buffer, symbol, 0, &look.spell(&reason), look.style(Role::Quiet));
        }
    }

    /// One knob: its symbol, the change by one per cent, and a signed bar.
    fn knob(&self, buffer: &mut Buffer, line: Rect, place: usize, row: &Limit, under: bool) {
        let look = &self.app.appearance;
        let strongest = row.sensitivities.strongest(STRONGEST);
        let Some((path, by)) = strongest.get(place + self.first_knob) else { return };
        let most = strongest.first().map_or(1.0, |first| first.1.abs());
        let style = |role: Role| look.style(if self.old { Role::Quiet } else { role });
        let [label, number, bar] = self.columns.knob_cells(line, place);
        let name = style(Role::Text);
        let name =
            if under { look.style(Role::Focus).add_modifier(Modifier::REVERSED) } else { name };
        let symbol = shorten(&look.spell(rows::knob_symbol(path)), usize::from(label.width), "");
        print(buffer, label, 0, &symbol, name);
        let role = if *by < 0.0 { Role::Second } else { Role::First };
        print(buffer, bar, 0, &signed(by / most, bar.width, look), style(role));
        let text = format!("{:>1$}", rows::change_text(*by), usize::from(number.width));
        print(buffer, number, 0, &text, style(Role::Text));
    }

    /// Where a row is, for the mouse.
    fn note(&self, line: Rect, place: usize) {
        let (columns, first_knob) = (&self.columns, self.first_knob);
        let rows = self.rows.len().max(1) as f64;
        let up = (1.0 - (place as f64 + 1.0) / rows, 1.0 - place as f64 / rows);
        let across = |column: usize| {
            let column = column as f64;
            (column / f64::from(COLUMNS), (column + 1.0) / f64::from(COLUMNS))
        };
        let mut left = line;
        for shown in 0..columns.knobs() {
            let [label, _, bar] = columns.knob_cells(line, shown);
            let area = Rect { width: bar.right().saturating_sub(label.x), ..label };
            self.at.note_part(self.app, area, [across(shown + first_knob + 1), up]);
            if shown == 0 {
                left.width = label.x.saturating_sub(line.x);
            }
        }
        self.at.note_part(self.app, left, [across(0), up]);
    }
}

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
    pub fn of(rows: &[Limit], area: Rect, large: bool, look: &Appearance) -> Self {
        let widest = |of: &dyn Fn(&Limit) -> String| {
            let most = rows.iter().map(|row| cells(&look.spell(&of(row)))).max();
            most.and_then(|most| u16::try_from(most).ok()).unwrap_or(0)
        };
        let widest_knob = |of: &dyn Fn(&(&'static str, f64)) -> String| {
            let strongest = rows.iter().flat_map(|row| row.sensitivities.strongest(STRONGEST));
            let most = strongest.map(|knob| cells(&look.spell(&of(&knob)))).max();
            most.and_then(|most| u16::try_from(most).ok()).unwrap_or(1)
        };
        let short = area.width < LONG_FROM;
        let label = widest_knob(&|(path, _)| knob_symbol(path).to_string());
        let label = if area.width < WHOLE_FROM { label.min(LABEL) } else { label };
        let number = widest_knob(&|(_, by)| change_text(*by));
        let mut knob_bar = KNOB_BAR[0];
        let width = |column: Column, knob_bar: u16| match column {
            Symbol => widest(&|row| row.name.titles()[usize::from(short)].to_string()),
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
        (0..STRONGEST).filter(|place| self.has(Knob(*place))).count()
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

/// How far the scale of a pulse goes below and above what is on it, as a factor: it
/// is one of factors, and has no zero.
const AROUND: f64 = 2.0;

/// Signs of a bar: below the present value, that value, above it, the limit, both in
/// one cell.
pub fn signs(look: &Appearance) -> [&'static str; 5] {
    look.either(["▒", "█", "▁", "┃", "╋"], ["=", "#", ".", "|", "+"])
}

/// A limit on its scale.
#[derive(Debug)]
pub struct LimitBar {
    value: f64,
    present: f64,
    range: KnobRange,
}

impl LimitBar {
    /// The bar of a row; none of a load, and none where there is no such limit.
    pub fn of(limit: &Limit) -> Option<Self> {
        let (value, present) = limit.value.zip(limit.present)?;
        // Magnitudes: a negative pulse has negative limits.
        let sign = if value < 0.0 { -1.0 } else { 1.0 };
        let (value, present) = (sign * value, sign * present);
        let log = limit.quantity == Quantity::Pulse;
        let all = || [value, present].into_iter().filter(|x| *x > 0.0);
        let most = all().fold(0.0, f64::max);
        let range = match log {
            true => KnobRange::log(all().fold(most, f64::min) / AROUND, most * AROUND),
            false => KnobRange::linear(0.0, most),
        };
        (range.is_sound() && value > 0.0).then_some(Self { value, present, range })
    }

    /// Draws it over the cells of one row.
    pub fn draw(&self, look: &Appearance, buffer: &mut Buffer, cells: Rect, old: bool) {
        if cells.width == 0 {
            return;
        }
        let [full, now, empty, limit, both] = signs(look);
        let width = f64::from(cells.width);
        let cell = |x: f64| ((self.range.part(x) * width) as u16).min(cells.width - 1);
        let (here, there) = (cell(self.present), cell(self.value));
        for k in 0..cells.width {
            let (sign, role) = match () {
                () if k == here && k == there => (both, Role::Focus),
                () if k == here => (now, Role::Focus),
                () if k == there => (limit, Role::Text),
                () if k < here => (full, Role::Quiet),
                () => (empty, Role::Quiet),
            };
            let mut style = look.style(if old { Role::Quiet } else { role });
            if k == there && !old {
                style = style.add_modifier(Modifier::BOLD);
            }
            if let Some(cell) = buffer.cell_mut(Position::new(cells.x + k, cells.y)) {
                cell.reset();
                cell.set_symbol(sign).set_style(style);
            }
        }
    }
}

/// A part of the greatest change, -1 to 1, to the left or the right of the middle of
/// an odd number of cells.
pub fn signed(part: f64, width: u16, look: &Appearance) -> String {
    let side = usize::from(width / 2);
    // Half cells; the least is seen, too.
    let halves = (part.abs().min(1.0) * 2.0 * side as f64).round().max(1.0) as usize;
    let (whole, half) = (halves / 2, halves % 2);
    let [block, left, right, middle] = look.either(["█", "▐", "▌", "│"], ["=", "-", "-", "|"]);
    let blank = " ".repeat(side.saturating_sub(whole + half));
    let (blocks, empty) = (block.repeat(whole), " ".repeat(side));
    match part < 0.0 {
        true => format!("{blank}{}{blocks}{middle}{empty}", left.repeat(half)),
        false => format!("{empty}{middle}{blocks}{}{blank}", right.repeat(half)),
    }
}
