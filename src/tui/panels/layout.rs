//! The areas of all panels for each screen size.

use ratatui::layout::{Constraint, Layout, Rect};

use crate::tui::app::App;
use crate::tui::views::{LEAST_ROWS, ViewId};

/// Smallest width of a screen that is drawn \[columns\].
pub const LEAST_WIDTH: u16 = 40;
/// Smallest height of a screen that is drawn \[rows\].
pub const LEAST_HEIGHT: u16 = 12;

/// Width from which the knobs have a column of their own.
const KNOBS_FROM: u16 = 66;
/// Width of the column of knobs.
const KNOBS_WIDTH: u16 = 27;
/// Width from which the column of knobs stays when two contact laws are compared.
const KNOBS_BESIDE_LAWS: u16 = 110;
/// Width from which two charts are side by side.
const PAIR_FROM: u16 = 76;

/// The areas of one frame.
pub struct Places {
    /// Verdict, title and speeds.
    pub header: Rect,
    /// Everything between header and footer.
    pub body: Rect,
    /// The knobs: a column, or a line with the selected one.
    pub knobs: Rect,
    /// Whether the knobs are a column; otherwise only the selected one is shown.
    pub column: bool,
    /// The views on the screen with their areas.
    pub charts: Vec<(ViewId, Rect)>,
    /// The current lesson; `None` if none is open, or the screen is too low for it.
    pub lesson: Option<Rect>,
    /// Status message or keys.
    pub footer: Rect,
}

/// Computes the areas for a screen of this size.
pub fn places(area: Rect, app: &App) -> Places {
    let [header, body, footer] =
        Layout::vertical([Constraint::Length(2), Constraint::Min(1), Constraint::Length(1)])
            .areas(area);
    let (lesson, rest) = lesson(body, app);
    let from = if app.compares() { KNOBS_BESIDE_LAWS } else { KNOBS_FROM };
    let column = area.width >= from && !app.layout.full_screen;
    let [knobs, charts] = if column {
        Layout::horizontal([Constraint::Length(KNOBS_WIDTH), Constraint::Min(1)]).areas(rest)
    } else {
        below(rest, 1)
    };
    let charts = if app.is_alone() { vec![(app.view(), charts)] } else { split(charts, app) };
    Places { header, body, knobs, column, charts, lesson, footer }
}

/// Splits off the first `rows` rows of an area.
fn below(area: Rect, rows: u16) -> [Rect; 2] {
    Layout::vertical([Constraint::Length(rows), Constraint::Min(1)]).areas(area)
}

/// Returns the area of the current lesson, and the rest below it.
fn lesson(body: Rect, app: &App) -> (Option<Rect>, Rect) {
    if app.lessons.progress.is_none() || body.height < 9 {
        return (None, body);
    }
    // An open question comes before the charts.
    let most = if app.is_asked() { body.height - 1 } else { body.height / 2 };
    let rows = super::lesson::rows(app, usize::from(body.width)).min(most);
    let [lesson, body] = below(body, rows);
    (Some(lesson), body)
}

/// Smallest height of the wheel above another chart \[rows\]; it needs no axis.
const WHEEL_ROWS: u16 = 10;

/// Splits the area into the large chart and as many smaller ones as remain legible. The wheel is
/// about square and shares its rows with another chart; any other large chart has the full width.
fn split(area: Rect, app: &App) -> Vec<(ViewId, Rect)> {
    let views = app.layout.views().iter().copied();
    let beside = u16::try_from(app.layout.beside).unwrap_or(0);
    let wheel = app.is_large(ViewId::Frame);
    let large = if wheel { WHEEL_ROWS } else { LEAST_ROWS };
    let below = area.height.saturating_sub(large) / LEAST_ROWS;
    // The margins table can use every row.
    let part = if app.is_large(ViewId::Margins) { 0 } else { LOWER };
    let lower = (area.height * part).div_ceil(100).max(LEAST_ROWS);
    let two = [Constraint::Min(1), Constraint::Length(lower)];
    let vertical = |parts: &[Constraint]| Layout::vertical(parts.iter()).split(area).to_vec();
    let pair = |area: Rect, left: u16| {
        let parts = [Constraint::Percentage(left), Constraint::Percentage(100 - left)];
        Layout::horizontal(parts).spacing(1).split(area).to_vec()
    };
    let areas = match (area.width >= PAIR_FROM, beside) {
        (_, 0) => vec![area],
        (true, 1) if wheel => pair(area, WHEEL_PART),
        (true, _) if below == 0 => {
            if wheel {
                pair(area, WHEEL_PART)
            } else {
                vec![area]
            }
        }
        (true, 1) => vertical(&two),
        (true, most) => match vertical(&two).as_slice() {
            [top, bottom] if wheel && most == 2 => [pair(*top, WHEEL_PART), vec![*bottom]].concat(),
            [top, bottom] if wheel => [pair(*top, WHEEL_PART), pair(*bottom, WHEEL_PART)].concat(),
            [top, bottom] => [vec![*top], pair(*bottom, 50)].concat(),
            _ => vec![area],
        },
        (false, most) => {
            let count = most.min(below);
            let low = area.height * 3 / (4 + 3 * count);
            let mut rows = vec![Constraint::Min(1)];
            rows.extend((0..count).map(|_| Constraint::Length(low.max(LEAST_ROWS))));
            vertical(&rows)
        }
    };
    views.zip(areas).collect()
}

/// Height of the charts below the large one on a wide screen \[% of the height of all charts\].
const LOWER: u16 = 45;
/// Width of the wheel beside another chart \[% of the width of both\].
const WHEEL_PART: u16 = 44;

/// Returns the room between header and footer on this screen.
pub fn body(app: &App) -> Rect {
    let area = Rect::new(0, 0, app.layout.size.0, app.layout.size.1);
    places(area, app).body
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::command::Command;
    use crate::tui::{Marker, Theme};
    use rubscope_solver::scene::Scene;

    fn app() -> App {
        App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Braille)
    }

    #[test]
    fn every_chart_beside_the_knobs_has_eight_rows_of_data() {
        for (width, height) in [(80, 24), (100, 30), (120, 40), (200, 50)] {
            for view in ViewId::all() {
                let mut app = app();
                app.act(Command::View(view));
                let charts = places(Rect::new(0, 0, width, height), &app).charts;
                for (shown, area) in charts {
                    // The wheel has no axis.
                    let axis = if shown == ViewId::Frame { 2 } else { 0 };
                    assert!(area.height + axis >= LEAST_ROWS, "{shown:?} {area:?}");
                }
            }
        }
        let first = places(Rect::new(0, 0, 80, 24), &app()).charts;
        assert_eq!(first.len(), 2, "the wheel and the response");
    }

    #[test]
    fn a_screen_that_is_too_small_says_so_whole() {
        let area = Rect::new(0, 0, 30, 8);
        let mut buffer = ratatui::buffer::Buffer::empty(area);
        crate::tui::panels::paint(&app(), &mut buffer, area);
        let text: String = buffer.content.iter().map(|cell| cell.symbol()).collect();
        assert!(text.contains("needs 40x12") && text.contains("30x8"), "{text}");
    }
}
