//! Draws a page of a table on the screen, with the row under the cursor.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use crate::sheet::symbols::greek;
use crate::sheet::table::Table;
use crate::tui::app::App;
use crate::tui::text::print;
use crate::tui::theme::Role;
use crate::tui::views::ViewArea;

/// Height from which columns have headings.
const HEADING_FROM: u16 = 5;

/// A table, with its cursor.
pub struct Rows<'a> {
    pub table: Table<'a>,
    /// Number of table columns in the first cursor column, and number of cursor columns; each
    /// further cursor column is one table column.
    pub cursor: [usize; 2],
    /// Cursor column and row under the cursor; `None` without a cursor.
    pub cell: Option<[usize; 2]>,
    /// Index of the row that is centred without a cursor.
    pub home: usize,
    /// Index of the row marked with a dot; `None` marks no row.
    pub marked: Option<usize>,
}

impl Rows<'_> {
    /// Draws the rows that fit, with `style(row, column)`; returns the height used.
    pub fn draw(
        &self,
        app: &App,
        buffer: &mut Buffer,
        (at, area): (ViewArea, Rect),
        style: impl Fn(usize, usize) -> Style,
    ) -> u16 {
        let look = &app.appearance;
        // The first column of the screen is for the cursor sign.
        let room = usize::from(area.width.saturating_sub(1));
        let spell = |text: &str| look.spell(&greek(text).replace("g_0", "g0"));
        let lines = self.table.lines(room, 1, spell);
        let parts = lines.split_first().filter(|_| area.height > 0);
        let Some((headings, rows)) = parts else { return 0 };
        let head = u16::from(area.height >= HEADING_FROM);
        let room = usize::from(area.height - head).max(1);
        // Scroll by pages, so that rows do not move under the pointer.
        let first =
            self.cell.map_or(self.home.saturating_sub(room / 2), |[_, row]| row / room * room);
        let first = first.min(rows.len().saturating_sub(room));
        let last = (first + room).min(rows.len());
        if head > 0 {
            let quiet = look.style(Role::Quiet);
            let line = Rect { height: 1, ..area };
            for (cell, place) in headings.iter().zip(places(line, headings)) {
                print(buffer, place, 0, cell, quiet);
            }
        }
        for (y, (place, cells)) in (head..).zip(rows.iter().enumerate().take(last).skip(first)) {
            let line = Rect { y: area.y + y, height: 1, ..area };
            let here = self.cell.filter(|cell| cell[1] == place).map(|[column, _]| column);
            let sign = match () {
                () if here.is_some() => look.either("▸", ">"),
                () if self.marked == Some(place) => look.either("●", "*"),
                () if place + 1 == last && last < rows.len() => look.either("↓", "v"),
                () if place == first && first > 0 => look.either("↑", "^"),
                () => " ",
            };
            print(buffer, line, 0, sign, look.style(Role::Focus));
            for (column, (text, spot)) in cells.iter().zip(places(line, cells)).enumerate() {
                let under = here.is_some_and(|here| self.leads(here) == column);
                let style = match under {
                    true => look.style(Role::Focus).add_modifier(Modifier::REVERSED),
                    false => style(place, column),
                };
                print(buffer, spot, 0, text, style);
            }
            self.note(app, at, line, (place, rows.len(), cells));
        }
        head + u16::try_from(last - first).unwrap_or(0)
    }

    /// Returns the first table column of a cursor column.
    fn leads(&self, column: usize) -> usize {
        if column == 0 { 0 } else { self.cursor[0] + column - 1 }
    }

    /// Records where a row is, for the mouse.
    fn note(&self, app: &App, at: ViewArea, line: Rect, row: (usize, usize, &[String])) {
        let (place, count, cells) = row;
        let up = [place + 1, place].map(|from_top| 1.0 - from_top as f64 / count as f64);
        let spots = places(line, cells);
        for column in 0..self.cursor[1] {
            let from = spots.get(self.leads(column)).map(|spot| spot.x);
            let to = spots.get(self.leads(column + 1)).map_or(line.right(), |spot| spot.x);
            if let Some(from) = from {
                let from = if column == 0 { line.x } else { from };
                let across = [column, column + 1].map(|end| end as f64 / self.cursor[1] as f64);
                let area = Rect { x: from, width: to.saturating_sub(from), ..line };
                at.note_part(app, area, [(across[0], across[1]), (up[0], up[1])]);
            }
        }
    }
}

/// Returns the areas of the cells of a line.
fn places(line: Rect, cells: &[String]) -> Vec<Rect> {
    let mut x = line.x.saturating_add(1);
    let place = |cell: &String| {
        let width = u16::try_from(cell.chars().count()).unwrap_or(u16::MAX);
        let width = width.min(line.right().saturating_sub(x));
        let place = Rect { x, width, ..line };
        x = x.saturating_add(width + 1).min(line.right());
        place
    };
    cells.iter().map(place).collect()
}
