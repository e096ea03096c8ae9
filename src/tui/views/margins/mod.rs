//! View 8: the distance of the run from another verdict, the distance of the scene from every
//! limit, and the parameters that move each limit most.

pub mod ends;
pub mod live;
mod rows;
mod survey;

use ratatui::{buffer::Buffer, layout::Rect};

use super::panel::{
    Lines, ViewArea, ViewPanel, cursor_at, lines_above, message, not_yet, paragraph, title,
};
use crate::sheet::number::{rounded, speed_unit};
use crate::sheet::{Sheet, margins};
use crate::tui::app::{App, Cursor};
use crate::tui::axis::number;
use crate::tui::command::Command;
use crate::tui::knobs::{knob_of, place_of};
use crate::tui::text::{columns, first_lines, wrap};
use crate::tui::theme::Role;
use crate::tui::views::id::ViewId;
use crate::tui::views::table::Rows;
use live::LiveMargins;
use rows::{DIGITS, LEADING};
use rubscope_solver::scene::{Allowed, Value};
use rubscope_solver::study::margins::Margins;
pub use survey::SurveyView;

/// Columns of the cursor: the limit, and its most influential knobs.
pub const COLUMNS: u32 = margins::STRONGEST as u32 + 1;
/// Height from which a line describes the row under the cursor.
const TOLD_FROM: u16 = 6;
/// Height from which the description has two lines.
const TOLD_TWICE_FROM: u16 = 16;

/// Index of the column with the current value.
const NOW: usize = 2;
/// Width from which the sentence names the lobes that end a lock \[columns\].
const WIDE: usize = 70;
/// Rows of limits that stay visible below on a small screen.
const LEFT: usize = 6;

/// The view of the margins.
pub struct MarginsView;

impl ViewPanel for MarginsView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let (look, legend) = (&app.appearance, rows::title(app));
        let Some((live, old)) = app.margins() else {
            return message(app, buffer, at, ("margins", &legend), not_yet(app));
        };
        let inside = title(app, buffer, at, "margins", &legend);
        let cell = app.margins_cell().filter(|_| at.large);
        let told = match (at.large, inside.height) {
            (true, TOLD_TWICE_FROM..) => 2,
            (true, TOLD_FROM..) => 1,
            _ => 0,
        };
        let limits = &live.margins.limits;
        let mut above = Rect { height: inside.height - told, ..inside };
        if at.large && !old {
            above = lines_above(app, buffer, above, &head(app, &live.margins, above, limits.len()));
        }
        let table = margins::table(&live.margins, |name| name.titles()[1].to_string());
        let drawn = Rows {
            table,
            cursor: [LEADING, COLUMNS as usize],
            cell,
            home: rows::home(app, limits),
            marked: rows::nearest(limits),
        };
        let style = |row: usize, column: usize| {
            let role = limits.get(row).map_or(Role::Text, |limit| rows::role(limit, column));
            look.style(if old { Role::Quiet } else { role })
        };
        let height = drawn.draw(app, buffer, (at, above), style);
        // Leave an empty row below the table if there is room.
        let y = above.y + (height + 1).min(above.height);
        let below = Rect { y, height: told, ..inside };
        let (text, role) = rows::told(app, limits, cell);
        let width = usize::from(below.width.saturating_sub(1));
        let lines = wrap(&look.spell(&text), width);
        let lines = first_lines(lines, width, usize::from(told), look.ellipsis());
        lines_above(app, buffer, below, &lines.into_iter().map(|line| (line, role)).collect());
    }

    fn grid(&self, app: &App) -> [u32; 2] {
        let rows = app.margins().map_or(0, |(live, _)| live.margins.limits.len());
        u32::try_from(rows).ok().filter(|rows| *rows > 0).map_or([0, 0], |rows| [COLUMNS, rows])
    }

    fn here(&self, app: &App) -> Cursor {
        let [_, rows] = self.grid(app);
        cursor_at([0, u32::MAX], [COLUMNS, rows])
    }

    fn opening(&self, app: &App, _: Cursor) -> Option<Command> {
        let ((live, old), [column, row]) = (app.margins()?, app.margins_cell()?);
        if old {
            let reason = "these margins are outdated; new ones are being computed";
            return Some(Command::Nothing(reason.into()));
        }
        Some(rows::opening(live.margins.limits.get(row)?, column, app))
    }

    fn sheet<'a>(&self, app: &'a App) -> Option<Sheet<'a>> {
        Some(margins::sheet(&app.margins()?.0.margins, app.view_command()))
    }
}

impl App {
    /// Returns the latest margins, and whether they are outdated (another scene or speed range);
    /// `None` if none were computed yet.
    pub fn margins(&self) -> Option<(&LiveMargins, bool)> {
        let live = self.results().found.margins.as_deref()?;
        let range = live.survey.as_ref().map(|survey| survey.range_rad_s);
        let other = range.is_some_and(|range| range != self.layout.range);
        Some((live, other || live.margins.scene != self.scene))
    }

    /// Returns column and row of the margins under the cursor; row 0 is at the top. `None` without
    /// a cursor in the margins, and until there are margins.
    pub fn margins_cell(&self) -> Option<[usize; 2]> {
        let [column, from_below] = self.cell_in(ViewId::Margins)?;
        let rows = self.margins()?.0.margins.limits.len();
        Some([column as usize, rows.checked_sub(1 + from_below as usize)?])
    }

    /// Switches between the survey over all nodal diameters and the margins of one; from another
    /// view it opens the survey.
    pub fn turn_survey(&mut self) {
        self.show_survey(!(self.is_large(ViewId::Margins) && self.layout.survey));
    }

    /// Shows the survey over all nodal diameters, or the margins of one.
    pub fn show_survey(&mut self, on: bool) {
        self.layout.survey = on;
        let ends = if speed_unit() == "rpm" { "2000:6000" } else { "200:600" };
        self.stop_reading();
        self.walk(ViewId::Margins);
        self.status = Some(match on {
            true => {
                format!("survey of all nodal diameters; : range {ends} sets the speeds")
            }
            false => "margins of n_d alone".to_string(),
        });
    }

    /// Sets a knob exactly to a limit and selects it.
    pub fn jump_to_limit(&mut self, path: &str, value: f64, to: &str) {
        let Some((place, knob)) = place_of(path).zip(knob_of(path)) else { return };
        self.knobs.select(place);
        let value_of = match knob.allowed() {
            Allowed::Whole { .. } => Value::Whole(value as u64),
            _ => Value::Real(value),
        };
        if self.set(knob, value_of) {
            let name = knob.label.split(' ').next().unwrap_or(knob.label);
            let jumped = format!("{name} {}: {to}", number(rounded(value, DIGITS), knob.unit()));
            // Keep the message about other effects of the turn.
            let more = self.status.take().map_or(String::new(), |said| format!("; {said}"));
            self.status = Some(jumped + &more);
        }
    }
}

/// Returns the distance of this run from another verdict as a sentence and one row per quantity,
/// under each contact law examined, for the top of an area. The rows of the second law are shown
/// only if all `limits` fit below them.
fn head(app: &App, margins: &Margins, area: Rect, limits: usize) -> Lines {
    let mut lines = Lines::new();
    let (height, width) = (usize::from(area.height), usize::from(area.width.saturating_sub(1)));
    for (place, found) in margins::robust::asked(margins).enumerate() {
        let sentence = margins::robust::sentence(found, margins, width >= WIDE);
        let sentence = paragraph(app, &sentence, area, Role::Text);
        let spell = |text: &str| app.appearance.spell(text);
        let shown = |at| margins::robust::table(found, at).lines(usize::MAX, 1, spell);
        let wide = |row: &Vec<String>| columns(&row.join(" ")) > width;
        let ways = [" at ", " "].map(shown).into_iter().find(|rows| !rows.iter().any(wide));
        let rows = ways.unwrap_or_else(|| {
            let mut rows = shown(" ");
            // The current values are at the knobs too, so drop their column first.
            rows.iter_mut().for_each(|row| drop(row.remove(NOW)));
            rows
        });
        if lines.len() + sentence.len() + LEFT > height {
            break;
        }
        lines.extend(sentence);
        let below = if place == 0 { LEFT } else { limits + 2 };
        if lines.len() + rows.len() + below <= height {
            let role = |row| if row == 0 { Role::Quiet } else { Role::Text };
            lines.extend(rows.iter().enumerate().map(|(row, cells)| (cells.join(" "), role(row))));
        }
    }
    lines
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use super::*;
    use crate::tui::{Marker, Theme};
    use rubscope_solver::scene::Scene;

    fn app() -> App {
        let scene = Scene::base().checked().unwrap();
        let mut app = App::new(scene.clone(), Theme::Dark, Marker::Braille);
        app.act(Command::View(ViewId::Margins));
        app.run.latest.results.found.margins =
            Some(Arc::new(LiveMargins { margins: Margins::of(&scene), survey: None }));
        app
    }

    #[test]
    fn the_export_is_the_table_of_the_report() {
        let mut app = app();
        let (live, _) = app.margins().unwrap();
        let mut bytes = Vec::new();
        margins::table(&live.margins, |name| name.to_string()).write_csv(&mut bytes).unwrap();
        assert_eq!(MarginsView.file(&app, "csv").unwrap().into_bytes(), bytes);
        app.run.latest.results.found.margins = None;
        assert_eq!(MarginsView.file(&app, "csv"), Err("there is no data yet".into()));
    }

    fn text(app: &App) -> String {
        let area = Rect::new(0, 0, 100, 24);
        let mut buffer = Buffer::empty(area);
        MarginsView.draw(app, &mut buffer, ViewArea { area, digit: 8, large: true });
        let line = |row: &[ratatui::buffer::Cell]| {
            row.iter().map(|cell| cell.symbol()).collect::<String>() + "\n"
        };
        buffer.content.chunks(100).map(line).collect()
    }

    #[test]
    fn margins_of_other_knobs_are_marked_and_nothing_jumps_there() {
        let mut app = app();
        app.reading.cursor = Some(MarginsView.here(&app));
        assert!(!text(&app).contains("outdated"));
        assert!(matches!(app.opening(), Some(Command::JumpTo { .. })));
        let mut other = app.scene.clone().into_scene();
        other.casing.damping_ratio = 0.1;
        app.set_scene(other.checked().unwrap(), false);
        assert!(text(&app).contains("outdated"), "{}", text(&app));
        assert!(matches!(app.opening(), Some(Command::Nothing(_))));
    }
}
