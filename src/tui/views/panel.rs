//! The trait of a view, and what views share: the title row with its legend, the text above a
//! chart, and the files of a view.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::{Modifier, Style};

use crate::sheet::Sheet;
use crate::tui::app::layout::LEAST_ROWS;
use crate::tui::app::{App, Cursor, Parts};
use crate::tui::appearance::Appearance;
use crate::tui::command::Command;
use crate::tui::raster::Pen;
use crate::tui::text::{columns, pieces, print, wrap};
use crate::tui::theme::Role;
use crate::tui::views::ViewId;

/// A view of the explorer: drawing, export, and its cursor.
pub trait ViewPanel: Sync {
    /// Draws the view.
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea);

    /// Returns the view's data as a sheet; `None` before there are any.
    fn sheet<'a>(&self, app: &'a App) -> Option<Sheet<'a>>;

    /// Exports the view's data as a figure (`svg`) or a table (`csv`).
    ///
    /// # Errors
    /// Says why there is nothing to export.
    fn file(&self, app: &App, ending: &str) -> Result<String, String> {
        let has_rows = |sheet: &Sheet| sheet.file().is_some_and(|table| !table.is_empty());
        let sheet = self.sheet(app).filter(has_rows);
        let mut bytes = Vec::new();
        let written = sheet.ok_or("there is no data yet")?.write_file(ending, &mut bytes);
        written.map_err(|error| error.to_string())?;
        String::from_utf8(bytes).map_err(|error| error.to_string())
    }

    /// Returns the text for `--lines`: that of the sheet.
    fn text(&self, app: &App) -> String {
        let mut bytes = Vec::new();
        let written = self.sheet(app).map(|sheet| sheet.write_text(&mut bytes));
        written.map_or(String::new(), |_| String::from_utf8_lossy(&bytes).into_owned())
    }

    /// Returns how many cells the chart has across and up, if its cursor moves from cell to cell;
    /// 0 if the cursor moves freely.
    fn grid(&self, _: &App) -> [u32; 2] {
        [0, 0]
    }

    /// Returns where a new cursor appears.
    fn here(&self, _: &App) -> Cursor {
        Cursor { across: 0.5, up: 0.5 }
    }

    /// Returns the command of Enter at a position of the chart; `None` if the view has nothing to
    /// open.
    fn opening(&self, _: &App, _: Cursor) -> Option<Command> {
        None
    }
}

/// Smallest legible width of a chart beside another.
const LEAST_COLUMNS: u16 = 38;

/// Where and how a view is drawn.
#[derive(Clone, Copy, Debug)]
pub struct ViewArea {
    /// Area on the screen.
    pub area: Rect,
    /// Digit key of the view, shown in its title.
    pub digit: u8,
    /// Whether it is the large chart.
    pub large: bool,
}

impl ViewArea {
    /// Records the data area of the large chart for the mouse.
    pub fn note(self, app: &App, inner: Rect) {
        self.note_part(app, inner, [(0.0, 1.0); 2]);
    }

    /// As [`Self::note`], for an area that covers only the fractions `parts` (across, up) of the
    /// chart.
    pub fn note_part(self, app: &App, inner: Rect, parts: Parts) {
        if self.large && inner.area() > 0 {
            app.note_part(inner, Command::PutCursor([0.0; 2]), parts);
        }
    }

    /// Splits the area into two rows; the lower one has `percent` of the height.
    pub fn rows(self, percent: u16) -> [Self; 2] {
        let lower = (self.area.height * percent / 100).max(LEAST_ROWS.min(self.area.height / 2));
        let parts = [Constraint::Min(1), Constraint::Length(lower)];
        Layout::vertical(parts).areas(self.area).map(|area| Self { area, ..self })
    }

    /// Splits the area for two charts, above each other or side by side; returns a single one if
    /// two would not be legible.
    pub fn pair(self, percent: u16) -> (Self, Option<Self>) {
        let [first, second] = match self.area {
            area if area.height >= 2 * LEAST_ROWS => self.rows(percent),
            area if area.width >= 2 * LEAST_COLUMNS => self.columns(),
            _ => return (self, None),
        };
        (first, Some(second))
    }

    /// Returns the area below the title row and some lines of text.
    pub fn below(self, lines: usize) -> Rect {
        let rows = u16::try_from(1 + lines).unwrap_or(u16::MAX).min(self.area.height);
        Rect { y: self.area.y + rows, height: self.area.height - rows, ..self.area }
    }

    /// Extends a chart by a row if the area `lower`, with a chart over the same x values, is below it:
    /// the title of that chart covers the labels of this axis, so that both share those of the lower one.
    pub fn above(mut self, lower: Rect) -> Self {
        self.area.height += u16::from(self.area.bottom() == lower.y);
        self
    }

    /// Splits the area into two columns of equal width.
    pub fn columns(self) -> [Self; 2] {
        let halves = [Constraint::Percentage(50), Constraint::Percentage(50)];
        Layout::horizontal(halves).spacing(1).areas(self.area).map(|area| Self { area, ..self })
    }
}

/// Draws the title row: a rule with digit, name, and the first legend entries that fit as a whole.
/// Returns the rest of the area.
pub fn title(
    app: &App,
    buffer: &mut Buffer,
    at: ViewArea,
    name: &str,
    legend: &[(String, Style)],
) -> Rect {
    let (look, area) = (&app.appearance, at.area);
    let rule = look.either("─", "-").repeat(usize::from(area.width));
    print(buffer, area, 0, &rule, look.style(Role::Quiet));
    let style = if at.large {
        look.style(Role::Focus).add_modifier(Modifier::BOLD)
    } else {
        look.style(Role::Text)
    };
    let head = (format!("{} {name}", at.digit).trim_end().to_string(), style);
    let working = working(app, at);
    let parts = std::iter::once(&head).chain(&working).chain(legend);
    let parts: Vec<_> =
        parts.map(|(text, style)| (format!(" {} ", look.spell(text)), *style)).collect();
    let inside = Rect { x: area.x + 1, width: area.width.saturating_sub(1), ..area };
    let mut left = usize::from(inside.width);
    let mut fits = |(text, _): &(String, Style)| {
        // A trailing space needs no room.
        let fits = columns(text.trim_end_matches(' ')) <= left;
        left -= if fits { columns(text).min(left) } else { 0 };
        fits
    };
    let parts: Vec<_> = parts.into_iter().filter(|part| fits(part)).collect();
    pieces(buffer, inside, 0, &parts);
    at.below(0)
}

/// Returns for how long the view's study has been running; `None` if it is not running for long, and
/// for the map, which shows its progress itself.
fn working(app: &App, at: ViewArea) -> Option<(String, Style)> {
    let known = app.results().working.iter().find(|working| working.view.digit() == at.digit)?;
    let text = format!("computing {} s", known.seconds);
    (known.view != ViewId::Map).then(|| (text, app.appearance.style(Role::Focus)))
}

/// Returns a cursor in the middle of a cell of a chart; of the last one if there are not so many.
pub fn cursor_at(cell: [u32; 2], grid: [u32; 2]) -> Cursor {
    let [across, up] = [0, 1].map(|axis| {
        let count = grid[axis].max(1);
        (f64::from(cell[axis].min(count - 1)) + 0.5) / f64::from(count)
    });
    Cursor { across, up }
}

/// Returns a legend entry: a stretch of the line and its label.
pub fn entry(look: &Appearance, pen: &Pen, name: &str) -> (String, Style) {
    let stroke = match (look.ascii(), pen.dashed) {
        (true, _) => pen.sign.to_string().repeat(2),
        (false, true) => "╌╌".to_string(),
        (false, false) => "──".to_string(),
    };
    (format!("{stroke} {name}"), pen.style)
}

/// Returns a legend entry for a dotted line.
pub fn dots(look: &Appearance, name: &str) -> (String, Style) {
    (format!("{} {name}", look.either("· ·", ". .")), look.style(Role::Quiet))
}

/// Lines of text, spelled as the screen can show them, with their roles.
pub type Lines = Vec<(String, Role)>;

/// Wraps a text to the width of an area.
pub fn paragraph(app: &App, text: &str, area: Rect, role: Role) -> Lines {
    let width = usize::from(area.width.saturating_sub(1));
    wrap(&app.appearance.spell(text), width).into_iter().map(|line| (line, role)).collect()
}

/// Prints lines above a chart; returns the rest of the area.
pub fn lines_above(app: &App, buffer: &mut Buffer, inside: Rect, lines: &Lines) -> Rect {
    let rows = u16::try_from(lines.len()).unwrap_or(u16::MAX).min(inside.height);
    let area = Rect { x: inside.x + 1, width: inside.width.saturating_sub(1), ..inside };
    for (row, (line, role)) in (0..rows).zip(lines) {
        print(buffer, area, row, line, app.appearance.style(*role));
    }
    Rect { y: inside.y + rows, height: inside.height - rows, ..inside }
}

/// Draws the title row of a view that has nothing to show, and why below an empty row.
pub fn message(
    app: &App,
    buffer: &mut Buffer,
    at: ViewArea,
    (name, legend): (&str, &[(String, Style)]),
    (text, role): (&str, Role),
) {
    let inside = title(app, buffer, at, name, legend);
    let mut lines = paragraph(app, text, inside, role);
    lines.insert(0, (String::new(), role));
    lines_above(app, buffer, inside, &lines);
}

/// Says why the study of a view has no result yet; studies follow the run.
pub fn not_yet(app: &App) -> (&'static str, Role) {
    let text = match app.full_run() {
        Some(_) => "computing ...",
        None => "waiting for the verdict of the run",
    };
    (text, Role::Quiet)
}
