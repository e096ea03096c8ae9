//! Where everything goes at each size.

use ratatui::layout::{Constraint, Layout, Rect};

use crate::tui::app::{App, View};

/// Narrowest screen.
pub const LEAST_WIDTH: u16 = 40;
/// Lowest screen.
pub const LEAST_HEIGHT: u16 = 12;

/// From this width on the knobs have a column of their own.
const KNOBS_FROM: u16 = 66;
/// Width of that column.
const KNOBS_WIDTH: u16 = 27;
/// Two charts go side by side from this width on.
const PAIR_FROM: u16 = 76;

/// The places of one frame.
pub struct Places {
    /// Scene, verdict, speeds.
    pub header: Rect,
    /// Everything between header and footer.
    pub body: Rect,
    /// The column of knobs.
    pub knobs: Option<Rect>,
    /// The selected knob alone, where there is no column.
    pub strip: Option<Rect>,
    /// The charts.
    pub charts: Vec<(View, Rect)>,
    /// Keys.
    pub footer: Rect,
}

/// Places for a screen of this size.
pub fn places(area: Rect, app: &App) -> Places {
    let [header, body, footer] =
        Layout::vertical([Constraint::Length(2), Constraint::Min(1), Constraint::Length(1)])
            .areas(area);
    if app.full_screen {
        let [strip, charts] =
            Layout::vertical([Constraint::Length(1), Constraint::Min(1)]).areas(body);
        let charts = vec![(app.view, charts)];
        return Places { header, body, knobs: None, strip: Some(strip), charts, footer };
    }
    let (knobs, strip, charts) = if area.width >= KNOBS_FROM {
        let columns = [Constraint::Length(KNOBS_WIDTH), Constraint::Min(1)];
        let [knobs, charts] = Layout::horizontal(columns).areas(body);
        (Some(knobs), None, charts)
    } else {
        let [strip, charts] =
            Layout::vertical([Constraint::Length(1), Constraint::Min(1)]).areas(body);
        (None, Some(strip), charts)
    };
    Places { header, body, knobs, strip, charts: split(charts, app), footer }
}

/// One large chart and as many beside it as can still be read.
fn split(area: Rect, app: &App) -> Vec<(View, Rect)> {
    let mut others = app.companions.iter().copied();
    let mut charts = Vec::new();
    if area.height < 14 {
        charts.push((app.view, area));
    } else if area.width >= PAIR_FROM {
        let rows = [Constraint::Percentage(55), Constraint::Percentage(45)];
        let [top, bottom] = Layout::vertical(rows).areas(area);
        let halves = [Constraint::Percentage(50), Constraint::Percentage(50)];
        let [left, right] = Layout::horizontal(halves).spacing(1).areas(bottom);
        charts.push((app.view, top));
        charts.extend(others.by_ref().zip([left, right]));
    } else {
        let small = if area.height >= 20 { 2 } else { 1 };
        let low = if small == 2 { area.height * 3 / 10 } else { area.height * 4 / 10 };
        let mut rows = vec![Constraint::Min(1)];
        rows.extend((0..small).map(|_| Constraint::Length(low)));
        let areas = Layout::vertical(rows).split(area);
        let views = std::iter::once(app.view).chain(others);
        charts.extend(views.zip(areas.iter().copied()));
    }
    charts
}
