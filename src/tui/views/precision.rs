//! View 7: computing time against error of every solver on this scene, one letter per series, as in
//! `rubscope precision`.

use ratatui::buffer::Buffer;

use super::ViewId;
use super::chart::Chart;
use super::panel::{ViewArea, ViewPanel, message, not_yet, paragraph};
use crate::sheet::Sheet;
use crate::sheet::number::count;
use crate::sheet::precision::{mark, place, reference_words, series, sheet};
use crate::tui::app::App;
use crate::tui::axis::{ChartAxis, readable};
use crate::tui::text::print;
use crate::tui::theme::Role;
use rubscope_solver::scene::SolverKind;
use rubscope_solver::study::precision::{Effort, Measure, Precision, Row, Way};

/// The view of computing time against error.
pub struct PrecisionView;

impl ViewPanel for PrecisionView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let look = &app.appearance;
        let quiet = look.style(Role::Quiet);
        let hue = |way: &Way| match way.solver {
            SolverKind::Event => Role::First,
            SolverKind::Explicit => Role::Second,
        };
        let axes = vec![("error |u-u_ref|/g0 by wall time [s]".to_string(), quiet)];
        if let Err(error) = Measure::check(&app.scene, Effort::QUICK) {
            let why = format!("no reference for this scene: {error}");
            return message(app, buffer, at, ("precision", &axes), (&why, Role::Trouble));
        }
        let Some(report) = &app.results().found.precision else {
            return message(app, buffer, at, ("precision", &axes), not_yet(app));
        };
        // A logarithmic axis has no zero, and no position for a run without an error.
        let placed = report.rows.iter().filter_map(|row| Some((place(row)?, row)));
        let points = placed.filter(|((_, error), _)| *error > 0.0);
        let points: Vec<_> =
            points.map(|((time, error), row)| ((time.log10(), error.log10()), row)).collect();
        let (x, y) =
            (decades(points.iter().map(|at| at.0.0)), decades(points.iter().map(|at| at.0.1)));
        let mut chart = Chart { legend: axes, ..Chart::new("precision", x, y) };
        let told = |text: &str, role| paragraph(app, text, at.area, role);
        let (note, role) = note(report);
        chart.lines = told(&note, role);
        if at.large {
            chart.lines.extend(told(&legend(points.iter().map(|(_, row)| *row)), Role::Quiet));
        }
        let cursor = app.cursor_in(ViewId::Precision).filter(|_| at.large);
        if let Some(cursor) = cursor.map(|at| (x.at(at.across), y.at(at.up))) {
            chart.points.push((cursor.0, cursor.1, '+', look.style(Role::Focus)));
            // Distances are relative to the lengths of the axes.
            let [wide, high] = [x, y].map(|axis| axis.high - axis.low);
            let far = |(x, y): (f64, f64)| ((x - cursor.0) / wide).hypot((y - cursor.1) / high);
            let nearest = points.iter().min_by(|a, b| far(a.0).total_cmp(&far(b.0)));
            if let Some((_, row)) = nearest {
                chart.lines.extend(told(&described(row), Role::Focus));
            }
        }
        chart.points.extend(points.iter().map(|((x, y), row)| {
            let (sign, role) = match row.is_wrong() {
                true => ('!', Role::Trouble),
                false => (mark(&row.way).0, hue(&row.way)),
            };
            (*x, *y, sign, look.style(role))
        }));
        let (off, mut above) = (report.rows.len() - points.len(), at);
        if off > 0 {
            above.area.height = at.area.height.saturating_sub(1);
            let text = format!("{} off this axis: error 0 or none", count(off as u64, "row"));
            print(buffer, at.area, above.area.height, &text, quiet);
        }
        chart.draw(app, buffer, above);
    }

    fn sheet<'a>(&self, app: &'a App) -> Option<Sheet<'a>> {
        Some(sheet(app.results().found.precision.as_ref()?, app.view_command()))
    }
}

/// Returns an axis from one whole power of ten to another, at least a decade, that encloses some
/// exponents; without any it is not sound, and nothing is drawn.
fn decades(exponents: impl Iterator<Item = f64>) -> ChartAxis {
    let (low, high) = exponents
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), x| (low.min(x), high.max(x)));
    ChartAxis::powers(low.floor(), high.ceil().max(low.floor() + 1.0), None)
}

/// Describes the reference and the number of runs with another verdict, with the role of the text.
fn note(report: &Precision) -> (String, Role) {
    if report.reference.sensitive {
        let text = "sensitive: a tiny change alters the verdict; compare verdicts, not ends";
        return (text.to_string(), Role::Trouble);
    }
    let same_law = report.rows.iter().filter(|row| !row.other_law).count();
    let wrong = report.rows.iter().filter(|row| row.is_wrong()).count();
    let words = reference_words(&report.reference);
    let law = report.reference.way.contact;
    let mut note = format!("reference ({law} law): {words}; {wrong} of {same_law} runs differ");
    if wrong > 0 {
        note += ", marked !";
    }
    let ends_otherwise = |row: &&Row| row.other_law && row.verdict_right == Some(false);
    if let Some(row) = report.rows.iter().find(ends_otherwise) {
        note += &format!("; the {} law gives another verdict: no error", row.way.contact);
    }
    (note, Role::Quiet)
}

/// Names the series of the letters on the chart.
fn legend<'a>(rows: impl Iterator<Item = &'a Row>) -> String {
    let name = |row: &Row| format!("{} {}", mark(&row.way).0, series(&row.way));
    let mut names: Vec<String> = rows.map(name).collect();
    names.dedup();
    names.join(", ")
}

/// Describes a row: solver, step, error and time.
fn described(row: &Row) -> String {
    let step = row.way.step_s.map_or(String::new(), |step| format!(", h {}", readable(step, "s")));
    let error = row.error_final.map_or("-".to_string(), |error| format!("{error:.2e}"));
    let ((letter, _), series) = (mark(&row.way), series(&row.way));
    format!("{letter} {series}{step}: error {error} in {}", readable(row.wall_s, "s"))
}
