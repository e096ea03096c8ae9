//! View 7: speed against error of every solver on this scene, one letter per
//! series, as on the command line.

use ratatui::{buffer::Buffer, layout::Rect};

use super::panel::{ViewArea, ViewPanel, not_yet, title};
use crate::report::precision::{decades, letter, place, reference_words, series};
use crate::tui::app::App;
use crate::tui::axis::{ChartAxis, readable};
use crate::tui::plot::Plot;
use crate::tui::text::{columns, print, wrap};
use crate::tui::theme::Role;
use rubscope_solver::scene::{ContactLaw, SolverKind};
use rubscope_solver::study::precision::{Effort, Measure, Row, Way};

/// Columns of the title before its legend.
const TITLE: usize = 14;
/// From this height on there is room for a legend below the title.
const LEGEND_FROM: u16 = 8;

/// The view.
pub struct PrecisionView;

impl ViewPanel for PrecisionView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let look = &app.appearance;
        let quiet = look.style(Role::Quiet);
        let hue = |way: &Way| match way.solver {
            SolverKind::Event => Role::First,
            SolverKind::Explicit => Role::Second,
        };
        let explicit = match app.scene.solver.contact {
            ContactLaw::Smooth => "s explicit (capital: modal, 1: full)",
            _ => "u explicit, b other law (capital: modal, 1 2: full)",
        };
        let entries = [("e event", Role::First), (explicit, Role::Second)];
        let axes = [("error |u-u_ref|/g0 by wall time [s]".to_string(), quiet)];
        let mut legend: Vec<_> =
            entries.iter().map(|(text, role)| (text.to_string(), look.style(*role))).collect();
        legend.extend(axes.clone());
        // What does not fit into the title has lines of its own.
        let taken: usize = legend.iter().map(|(text, _)| columns(text) + 2).sum();
        let fits = taken + TITLE <= usize::from(at.area.width);
        let mut inside = title(app, buffer, at, "precision", if fits { &legend } else { &axes });
        if !fits && inside.height >= LEGEND_FROM {
            for (text, role) in entries {
                for line in wrap(text, usize::from(inside.width)) {
                    print(buffer, inside, 0, &line, look.style(role));
                    inside = below(inside);
                }
            }
        }
        if let Err(error) = Measure::check(&app.scene, Effort::QUICK) {
            print(buffer, inside, 1, "no reference for this scene:", look.style(Role::Trouble));
            print(buffer, inside, 2, &error.to_string(), quiet);
            return;
        }
        let Some(report) = &app.results().found.precision else {
            return not_yet(app, buffer, inside);
        };
        let words = inside;
        let (note, role) = if report.reference.sensitive == Some(true) {
            let text = "sensitive scene: end states mean nothing, compare verdicts";
            (text.to_string(), Role::Trouble)
        } else {
            let same_law = report.rows.iter().filter(|row| !row.other_law).count();
            let wrong = report.rows.iter().filter(|row| row.is_wrong()).count();
            let words = reference_words(&report.reference);
            let law = report.reference.way.contact;
            let note = format!("reference ({law} law) {words}; {wrong} of its {same_law} differ");
            (if wrong > 0 { note + "; ! has another verdict" } else { note }, Role::Quiet)
        };
        for line in wrap(&note, usize::from(inside.width)) {
            print(buffer, inside, 0, &line, look.style(role));
            inside = below(inside);
        }
        let placed = || report.rows.iter().filter_map(|row| Some((place(row)?, row)));
        // A logarithmic axis has no zero: rows without error are listed below.
        let mut zeros: Vec<char> = placed()
            .filter(|(at, _)| at.error.is_none())
            .map(|(_, row)| letter(&row.way))
            .collect();
        zeros.dedup();
        // Nor has it a place for a run that gives no number to compare.
        let lost = report.rows.iter().filter(|row| row.is_wrong() && place(row).is_none());
        let mut lost: Vec<char> = lost.map(|row| letter(&row.way)).collect();
        lost.dedup();
        let listed = |letters: Vec<char>, what: &str, sign: &str| {
            let named: String = letters.iter().map(|letter| format!(" {letter}{sign}")).collect();
            (!letters.is_empty()).then(|| format!("{what}:{named}"))
        };
        let off = [listed(zeros, "error 0, off this axis", ""), listed(lost, "no error", "!")];
        let off = off.into_iter().flatten().collect::<Vec<_>>().join("; ");
        let height = inside.height.saturating_sub(u16::from(!off.is_empty()));
        if !off.is_empty() {
            print(buffer, inside, height, &off, quiet);
        }
        let inside = Rect { height, ..inside };
        let points: Vec<_> =
            placed().filter_map(|(at, row)| Some(((at.time, at.error?), row))).collect();
        let times = decades(points.iter().map(|((x, _), _)| *x));
        let errors = decades(points.iter().map(|((_, y), _)| *y));
        let (Some((left, right)), Some((bottom, top))) = (times, errors) else { return };
        let (x, y) = (ChartAxis::powers(left, right), ChartAxis::powers(bottom, top));
        let mut reading = None;
        let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
        at.note(app, plot.inner);
        let cursor =
            app.reading.cursor.filter(|_| at.large).map(|at| (x.at(at.across), y.at(at.up)));
        if let Some(cursor) = cursor {
            plot.point(cursor.0, cursor.1, '+', look.style(Role::Focus));
            // Both axes are as long.
            let [wide, high] = [right - left, top - bottom];
            let far = |(x, y): (f64, f64)| ((x - cursor.0) / wide).hypot((y - cursor.1) / high);
            let nearest = points.iter().min_by(|a, b| far(a.0).total_cmp(&far(b.0)));
            if let Some((_, row)) = nearest {
                reading = Some(told(row));
            }
        }
        for ((x, y), row) in &points {
            plot.point(*x, *y, letter(&row.way), look.style(hue(&row.way)));
        }
        for ((x, y), _) in points.iter().filter(|(_, row)| row.is_wrong()) {
            if let (Some(column), Some(line)) = (plot.column(*x), plot.row(*y)) {
                // Beside its letter, on the side where there is room.
                let last = plot.inner.right() - 1;
                let beside = if column < last { column + 1 } else { column - 1 };
                plot.text(beside, line, "!", look.style(Role::Trouble));
            }
        }
        if let Some(reading) = reading {
            let blank = " ".repeat(usize::from(words.width));
            print(buffer, words, 0, &blank, quiet);
            print(buffer, words, 0, &look.spell(&reading), look.style(Role::Focus));
        }
    }

    fn csv(&self, _: &App) -> Result<String, String> {
        Err("`rubscope precision` writes these rows".into())
    }
}

/// A row in words: the nearest to the reading cursor.
fn told(row: &Row) -> String {
    let step = row.way.step_s.map_or(String::new(), |step| format!(", h {}", readable(step, "s")));
    let error = row.error_final.map_or("-".to_string(), |error| format!("{error:.2e}"));
    let (letter, series) = (letter(&row.way), series(&row.way));
    format!("{letter} {series}{step}: error {error} in {}", readable(row.wall_s, "s"))
}

/// An area without its first row.
fn below(area: Rect) -> Rect {
    Rect { y: area.y + 1, height: area.height.saturating_sub(1), ..area }
}
