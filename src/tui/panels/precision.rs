//! View 7: speed against error of every solver on this scene, one letter a
//! series as on the command line.

use ratatui::{buffer::Buffer, layout::Rect};

use super::charts::title;
use super::print;
use crate::report::precision::{decades, letter, place};
use crate::scene::SolverKind;
use crate::study::precision::{Measure, Way};
use crate::tui::app::{App, View};
use crate::tui::plot::{Axis, Plot};
use crate::tui::theme::Role;

/// Draws the view.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    let skin = &app.skin;
    let quiet = skin.style(Role::Quiet);
    let role = |way: &Way| match way.solver {
        SolverKind::Event => Role::First,
        SolverKind::Explicit => Role::Second,
    };
    let legend = [
        ("e event".to_string(), skin.style(Role::First)),
        (
            "u explicit, b other law (capital: modal, 1 2: full)".to_string(),
            skin.style(Role::Second),
        ),
        ("error |u-u_ref|/g0 by wall time [s]".to_string(), quiet),
    ];
    let inside = title(app, buffer, area, View::Precision, "precision", &legend);
    if let Err(error) = Measure::check(&app.scene) {
        print(buffer, inside, 1, "no reference for this scene:", skin.style(Role::Trouble));
        print(buffer, inside, 2, &error.to_string(), quiet);
        return;
    }
    let Some(report) = &app.precision else {
        print(buffer, inside, 1, "computed while this view is open", quiet);
        return;
    };
    if report.reference.sensitive {
        print(
            buffer,
            inside,
            0,
            "sensitive scene: end states mean nothing, compare verdicts",
            skin.style(Role::Trouble),
        );
    }
    let inside = Rect { y: inside.y + 1, height: inside.height.saturating_sub(1), ..inside };
    let points: Vec<_> = report.rows.iter().filter_map(|row| Some((place(row)?, row))).collect();
    if !report.reference.sensitive {
        let same_law = report.rows.iter().filter(|row| !row.other_law).count();
        let wrong = report.rows.iter().filter(|row| row.is_wrong()).count();
        let note = format!(
            "reference {}; {wrong} of {same_law} runs under its contact law have another verdict (!)",
            report.reference.verdict,
        );
        print(buffer, Rect { y: inside.y - 1, ..inside }, 0, &note, quiet);
    }
    let Some((left, right)) = decades(points.iter().map(|(at, _)| at.time)) else { return };
    // Only zeros: any range will do, they stand below it.
    let errors = decades(points.iter().filter_map(|(at, _)| at.error));
    let (bottom, top) = errors.unwrap_or((-16.0, 0.0));
    let (x, y) = (Axis::plain(left, right), Axis::plain(bottom, top));
    let Some(mut plot) = Plot::powers_both(buffer, inside, x, y, skin) else { return };
    for (at, row) in points {
        let style = skin.style(role(&row.way));
        plot.point(at.time, at.error.unwrap_or(bottom), letter(&row.way), style);
        let beside = match (row.is_wrong(), at.error) {
            (true, _) => ("!", skin.style(Role::Trouble)),
            // Off the logarithmic axis, below its lower end.
            (false, None) => ("=0", quiet),
            (false, Some(_)) => continue,
        };
        if let (Some(column), Some(line)) =
            (plot.column(at.time), plot.row(at.error.unwrap_or(bottom)))
        {
            plot.text(column + 1, line, beside.0, beside.1);
        }
    }
}
