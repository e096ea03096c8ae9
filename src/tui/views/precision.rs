//! View 7: speed against error of every solver on this scene, one letter per
//! series, as on the command line.

use ratatui::{buffer::Buffer, layout::Rect};

use super::panel::{ViewArea, ViewPanel, not_yet, title};
use crate::report::precision::{decades, letter, place};
use crate::scene::SolverKind;
use crate::study::precision::{Measure, Way};
use crate::tui::app::App;
use crate::tui::axis::ChartAxis;
use crate::tui::plot::Plot;
use crate::tui::text::print;
use crate::tui::theme::Role;

/// The view.
pub struct PrecisionView;

impl ViewPanel for PrecisionView {
    fn what(&self) -> &'static str {
        "speed against error"
    }

    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let look = &app.appearance;
        let quiet = look.style(Role::Quiet);
        let role = |way: &Way| match way.solver {
            SolverKind::Event => Role::First,
            SolverKind::Explicit => Role::Second,
        };
        let legend = [
            ("e event".to_string(), look.style(Role::First)),
            (
                "u explicit, b other law (capital: modal, 1 2: full)".to_string(),
                look.style(Role::Second),
            ),
            ("error |u-u_ref|/g0 by wall time [s]".to_string(), quiet),
        ];
        let inside = title(app, buffer, at, "precision", &legend);
        if let Err(error) = Measure::check(&app.scene) {
            print(buffer, inside, 1, "no reference for this scene:", look.style(Role::Trouble));
            print(buffer, inside, 2, &error.to_string(), quiet);
            return;
        }
        let Some(report) = &app.latest.results.precision else {
            return not_yet(app, buffer, inside);
        };
        if report.reference.sensitive {
            let text = "sensitive scene: end states mean nothing, compare verdicts";
            print(buffer, inside, 0, text, look.style(Role::Trouble));
        } else {
            let same_law = report.rows.iter().filter(|row| !row.other_law).count();
            let wrong = report.rows.iter().filter(|row| row.is_wrong()).count();
            let note = format!(
                "reference {}; {wrong} of {same_law} runs under its contact law have another verdict (!)",
                report.reference.verdict,
            );
            print(buffer, inside, 0, &note, quiet);
        }
        let inside = Rect { y: inside.y + 1, height: inside.height.saturating_sub(1), ..inside };
        let placed = || report.rows.iter().filter_map(|row| Some((place(row)?, row)));
        // A logarithmic axis has no zero: rows without error are listed below.
        let mut zeros: Vec<char> = placed()
            .filter(|(at, _)| at.error.is_none())
            .map(|(_, row)| letter(&row.way))
            .collect();
        zeros.dedup();
        let height = inside.height.saturating_sub(u16::from(!zeros.is_empty()));
        if !zeros.is_empty() {
            let letters: String = zeros.into_iter().flat_map(|letter| [' ', letter]).collect();
            print(buffer, inside, height, &format!("error 0, off this axis:{letters}"), quiet);
        }
        let inside = Rect { height, ..inside };
        let points: Vec<_> =
            placed().filter_map(|(at, row)| Some(((at.time, at.error?), row))).collect();
        let times = decades(points.iter().map(|((x, _), _)| *x));
        let errors = decades(points.iter().map(|((_, y), _)| *y));
        let (Some((left, right)), Some((bottom, top))) = (times, errors) else { return };
        let (x, y) = (ChartAxis::powers(left, right), ChartAxis::powers(bottom, top));
        let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
        at.note(app, plot.inner);
        for ((x, y), row) in points {
            plot.point(x, y, letter(&row.way), look.style(role(&row.way)));
            if row.is_wrong()
                && let (Some(column), Some(line)) = (plot.column(x), plot.row(y))
            {
                plot.text(column + 1, line, "!", look.style(Role::Trouble));
            }
        }
    }

    fn csv(&self, _: &App) -> Result<String, String> {
        Err("`rubscope precision` writes these rows".into())
    }
}
