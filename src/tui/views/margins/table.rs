//! The table of the margins: its heading, its rows as far as there is room, and where
//! they are for the mouse.

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier, style::Style};

use super::bar::{self, LimitBar};
use super::columns::{Column, Columns};
use super::rows;
use super::{COLUMNS, words};
use crate::report::margins::LimitRow;
use crate::tui::app::App;
use crate::tui::text::{print, shorten};
use crate::tui::theme::Role;
use crate::tui::views::ViewArea;

/// From this height on, columns have headings.
const HEADING_FROM: u16 = 8;

/// The rows, and how they are drawn.
pub struct Table<'a> {
    app: &'a App,
    rows: &'a [LimitRow<'a>],
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
        rows: &'a [LimitRow<'a>],
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
        let loads = self.rows.iter().position(LimitRow::is_load).filter(|_| count < room);
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
                Column::Value => "rad/s",
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
        row: &LimitRow,
        (cursor, nearest): (Option<usize>, bool),
    ) {
        let columns = &self.columns;
        let look = &self.app.appearance;
        let style = |role: Role| look.style(if self.old { Role::Quiet } else { role });
        let here = look.style(Role::Focus).add_modifier(Modifier::REVERSED);
        if cursor.is_some() {
            print(buffer, line, 0, look.either("▸", ">"), look.style(Role::Focus));
        } else if nearest {
            print(buffer, line, 0, words::nearest_sign(look), style(Role::Focus));
        }
        let quiet = row.value().is_none();
        for (column, place) in columns.places(line) {
            let width = usize::from(place.width);
            let mut put = |text: &str, style: Style| print(buffer, place, 0, text, style);
            match column {
                Column::Symbol => {
                    let text =
                        shorten(&look.spell(&row.title(columns.short)), width, look.ellipsis());
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
                    let role = row.side().map_or(Role::Text, words::role);
                    let text = match row.is_load() && !columns.has(Column::Value) {
                        true => rows::value_text(row),
                        false => rows::percent_text(row),
                    };
                    put(&format!("{:>width$}", look.spell(&text)), style(role));
                }
                Column::Word => {
                    if let Some(side) = row.side() {
                        put(&side.to_string(), style(words::role(side)));
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
    fn knob(&self, buffer: &mut Buffer, line: Rect, place: usize, row: &LimitRow, under: bool) {
        let look = &self.app.appearance;
        let strongest = row.strongest();
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
        print(buffer, bar, 0, &bar::signed(by / most, bar.width, look), style(role));
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
