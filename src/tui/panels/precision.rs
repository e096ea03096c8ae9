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
    if !report.reference.sensitive {
        let same_law = report.rows.iter().filter(|row| !row.other_law).count();
        let wrong = report.rows.iter().filter(|row| row.is_wrong()).count();
        let note = format!(
            "reference {}; {wrong} of {same_law} runs under its contact law have another verdict (!)",
            report.reference.verdict,
        );
        print(buffer, Rect { y: inside.y - 1, ..inside }, 0, &note, quiet);
    }
    let placed = || report.rows.iter().filter_map(|row| Some((place(row)?, row)));
    // An error of zero has no place on the axis: such rows have a line below.
    let mut zeros: Vec<char> =
        placed().filter(|(at, _)| at.error.is_none()).map(|(_, row)| letter(&row.way)).collect();
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
    let (x, y) = (Axis::plain(left, right), Axis::plain(bottom, top));
    let Some(mut plot) = Plot::powers_both(buffer, inside, x, y, skin) else { return };
    for ((x, y), row) in points {
        plot.point(x, y, letter(&row.way), skin.style(role(&row.way)));
        if row.is_wrong()
            && let (Some(column), Some(line)) = (plot.column(x), plot.row(y))
        {
            plot.text(column + 1, line, "!", skin.style(Role::Trouble));
        }
    }
}
