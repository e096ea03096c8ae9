//! The places of all panels at each screen size.

use ratatui::layout::{Constraint, Layout, Rect};

use super::presentation;
use crate::tui::app::App;
use crate::tui::views::ViewId;

/// Narrowest screen.
pub const LEAST_WIDTH: u16 = 40;
/// Lowest screen.
pub const LEAST_HEIGHT: u16 = 12;

/// From this width on, the knobs have a separate column.
const KNOBS_FROM: u16 = 66;
/// Width of that column.
const KNOBS_WIDTH: u16 = 27;
/// From this width on, they stay beside two contact laws that are compared.
const KNOBS_BESIDE_LAWS: u16 = 110;
/// From this width on, two charts are side by side.
const PAIR_FROM: u16 = 76;

/// The places of one frame.
pub struct Places {
    /// Scene, verdict, speeds.
    pub header: Rect,
    /// Everything between header and footer.
    pub body: Rect,
    /// The knobs.
    pub knobs: Rect,
    /// Whether they are a column, not the selected one alone.
    pub column: bool,
    /// The charts.
    pub charts: Vec<(ViewId, Rect)>,
    /// The verdict in large letters, which only a screen for a projector has.
    pub letters: Option<Rect>,
    /// The current lesson.
    pub lesson: Option<Rect>,
    /// Keys.
    pub footer: Rect,
}

/// Places for a screen of this size.
pub fn places(area: Rect, app: &App) -> Places {
    if presentation::is_shown(app, area) {
        let [letters, chart, knobs, footer] = presentation::split(app, area);
        return Places {
            header: Rect::default(),
            body: area,
            knobs,
            column: false,
            charts: vec![(app.view(), chart)],
            letters: Some(letters),
            lesson: None,
            footer,
        };
    }
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
    Places { header, body, knobs, column, charts, letters: None, lesson, footer }
}

/// The first rows of an area, and the rest below.
fn below(area: Rect, rows: u16) -> [Rect; 2] {
    Layout::vertical([Constraint::Length(rows), Constraint::Min(1)]).areas(area)
}

/// Rows of the current lesson, above the knobs and charts.
fn lesson(body: Rect, app: &App) -> (Option<Rect>, Rect) {
    if app.lessons.progress.is_none() || body.height < 9 {
        return (None, body);
    }
    let wanted = super::lesson::rows(app, usize::from(body.width));
    let read = app.lessons.progress.as_ref().is_some_and(|progress| progress.read);
    let rows = match wanted <= most_rows(body.height) {
        true => wanted,
        // If it is too long to leave room for the charts: first the text, page by
        // page, then its end.
        false if !read => page_rows(body.height),
        false => {
            super::lesson::end_rows(app, usize::from(body.width)).min(most_rows(body.height)).max(3)
        }
    };
    let [lesson, body] = below(body, rows);
    (Some(lesson), body)
}

/// One large chart, and as many of the requested smaller ones as can be read.
fn split(area: Rect, app: &App) -> Vec<(ViewId, Rect)> {
    let views = app.layout.views().iter().copied();
    let halves = || [Constraint::Percentage(50), Constraint::Percentage(50)];
    let readable = match area.height {
        0..14 => 0,
        14..20 if area.width < PAIR_FROM => 1,
        _ => 3,
    };
    let companions = app.layout.beside.min(readable);
    let areas: Vec<Rect> = match (companions, area.width >= PAIR_FROM) {
        (0, _) => vec![area],
        (1, _) => Layout::vertical(LARGE).split(area).to_vec(),
        (2, true) => {
            let [top, bottom] = Layout::vertical(LARGE).areas(area);
            let [left, right] = Layout::horizontal(halves()).spacing(1).areas(bottom);
            vec![top, left, right]
        }
        (_, true) => {
            let [top, bottom] = Layout::vertical(halves()).areas(area);
            let [a, b] = Layout::horizontal(halves()).spacing(1).areas(top);
            let [c, d] = Layout::horizontal(halves()).spacing(1).areas(bottom);
            vec![a, b, c, d]
        }
        (count, false) => {
            let low = area.height * 3 / (4 + 3 * u16::try_from(count).unwrap_or(2));
            let mut rows = vec![Constraint::Min(1)];
            rows.extend((0..count).map(|_| Constraint::Length(low)));
            Layout::vertical(rows).split(area).to_vec()
        }
    };
    views.zip(areas).collect()
}

/// The large chart above, a smaller one below.
const LARGE: [Constraint; 2] = [Constraint::Percentage(55), Constraint::Percentage(45)];

/// Rows between header and footer, which take three.
fn body_rows(app: &App) -> u16 {
    app.layout.size.1.saturating_sub(3)
}

/// Most rows of a lesson beside the charts.
fn most_rows(body: u16) -> u16 {
    body / 2
}

/// Rows of a page of a lesson in front of the charts.
fn page_rows(body: u16) -> u16 {
    body.saturating_sub(1)
}

/// Whether the text of the lesson hides the charts on this screen.
pub fn lesson_fills(app: &App) -> bool {
    let rows = super::lesson::rows(app, usize::from(app.layout.size.0));
    app.lessons.progress.is_some() && rows > most_rows(body_rows(app))
}

/// Pages of the text of the lesson where it hides the charts.
pub fn lesson_pages(app: &App) -> usize {
    super::lesson::pages(app, usize::from(app.layout.size.0), page_rows(body_rows(app)))
}

/// The room between header and footer on this screen.
pub fn body(app: &App) -> Rect {
    let area = Rect::new(0, 0, app.layout.size.0, app.layout.size.1);
    places(area, app).body
}
