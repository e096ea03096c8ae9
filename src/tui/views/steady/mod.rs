//! Curves over the magnitude of the speed, with marked speeds, the present one, and a cursor that
//! reads the state at a speed: the locked motion (view 3) and the coincidence (view 9).

pub mod coincidence;
pub mod coincidence_curves;
pub mod locked;
pub mod locked_curves;
pub mod speeds;

use ratatui::buffer::Buffer;
use ratatui::style::Style;

use crate::sheet::number::speed_unit;
use crate::tui::app::{App, Cursor};
use crate::tui::axis::ChartAxis;
use crate::tui::text::whole_parts;
use crate::tui::theme::Role;
use crate::tui::views::chart::{Chart, curves, legend};
use crate::tui::views::panel::{Lines, ViewArea};
use rubscope_solver::study::figures::Panel;
use speeds::Speeds;

/// Largest number of rows for the text above a chart.
const MOST_ROWS: usize = 3;
/// Width from which the title has room for the present values. A narrower chart prints them at
/// their points \[columns\].
const NAMED_FROM: u16 = 46;

/// A chart over the speeds of a view.
#[derive(Default)]
struct SpeedChart<'a> {
    name: &'a str,
    y: ChartAxis,
    unit: &'a str,
    /// Values of the running motion, none without contact; `None` if they are not shown.
    now: Option<&'a [(f64, String)]>,
    /// Magnitudes of the speeds at which the curve is beyond the chart \[rad/s\].
    beyond: Vec<f64>,
    /// Remarks in the legend.
    notes: Vec<&'a str>,
    /// Text above the chart.
    text: Option<(String, Role)>,
}

impl Speeds {
    /// Returns a cursor at the present speed.
    fn here(&self, app: &App) -> Cursor {
        let [from, to] = self.range;
        Cursor { across: ((app.speed().abs() - from) / (to - from)).clamp(0.0, 1.0), up: 0.5 }
    }

    /// Returns the magnitude of the speed under the cursor \[rad/s\]; `None` without a cursor in the
    /// view.
    fn read(&self, app: &App) -> Option<f64> {
        let [from, to] = self.range;
        app.cursor_in(self.view).map(|cursor| from + cursor.across * (to - from))
    }

    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea, panel: &Panel, what: SpeedChart) {
        let look = &app.appearance;
        let [quiet, contact] = [Role::Quiet, Role::Contact].map(|role| look.style(role));
        let unit = format!("{}{} over {}", what.y.scale.prefix, what.unit, speed_unit());
        let mut entries = vec![(unit, quiet)];
        let [lines, dotted] = legend(look, panel);
        entries.extend(lines);
        entries.extend(what.now.map(|now| present(app, now)));
        entries.extend(what.notes.iter().map(|note| (note.to_string(), quiet)));
        entries.extend(dotted);
        if app.speed() < 0.0 {
            entries.push(("over |Ω|, turning backwards".into(), quiet));
        }
        let mut lines = Lines::new();
        if let Some((text, role)) = what.text {
            let width = usize::from(at.area.width).saturating_sub(1);
            // The chart keeps at least three quarters of the rows.
            let most = MOST_ROWS.min(usize::from(at.below(0).height / 4)).max(1);
            let parts = whole_parts(&look.spell(&text), width, most);
            lines = parts.into_iter().map(|line| (line, role)).collect();
        }
        let y = what.y.evened(at.below(lines.len()), look);
        let x = ChartAxis::speeds(self.range[0], self.range[1]);
        let mut chart = Chart::new(what.name, x, y);
        (chart.legend, chart.lines) = (entries, lines);
        chart.levels.push((0.0, "", Role::Quiet));
        let speed = app.speed().abs();
        (chart.marks, chart.read, chart.now) = (&self.marks, self.read(app), Some(speed));
        chart.curves = curves(look, panel);
        let place = |value: f64| match value {
            below if below < y.low => (look.either('▼', 'v'), y.low),
            above if above > y.high => (look.either('▲', '^'), y.high),
            _ => (look.either('◆', '@'), value),
        };
        let now = what.now.unwrap_or_default();
        let places = now.iter().map(|(value, _)| place(*value));
        let up = (look.either('▲', '^'), look.style(Role::Trouble));
        chart.points = what.beyond.into_iter().map(|speed| (speed, y.high, up.0, up.1)).collect();
        chart.points.extend(places.map(|(sign, value)| (speed, value, sign, contact)));
        let Some(mut plot) = chart.draw(app, buffer, at) else { return };
        for (value, text) in now.iter().filter(|_| at.area.width < NAMED_FROM) {
            if let Some(row) = plot.row(place(*value).1) {
                plot.free_note(speed, row, text, contact);
            }
        }
    }
}

/// Returns the legend of the values of the running motion; of many contacts it has the first two.
fn present(app: &App, now: &[(f64, String)]) -> (String, Style) {
    let now: Vec<&str> = now.iter().take(2).map(|(_, text)| text.as_str()).collect();
    let now = if now.is_empty() { "no contact".to_string() } else { now.join(" ") };
    let look = &app.appearance;
    (format!("{} now {now}", look.either('◆', '@')), look.style(Role::Contact))
}
