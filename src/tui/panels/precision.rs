//! View 7: speed against error of every solver on this scene, one letter a
//! series as on the command line.

use ratatui::{buffer::Buffer, layout::Rect};

use super::charts::title;
use super::print;
use crate::report::precision::{letter, place};
use crate::scene::SolverKind;
use crate::study::precision::Way;
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
        ("u, b explicit (capital: modal, 1 2: full)".to_string(), skin.style(Role::Second)),
        ("error |u-u_ref|/g0 by wall time [s]".to_string(), quiet),
    ];
    let inside = title(app, buffer, area, View::Precision, "precision", &legend);
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
    let wrong = report.rows.iter().filter(|row| !row.verdict_right).count();
    let inside = Rect { y: inside.y + 1, height: inside.height.saturating_sub(1), ..inside };
    let points: Vec<_> = report
        .rows
        .iter()
        .filter_map(|row| Some((place(row)?, &row.way, row.verdict_right)))
        .collect();
    if !report.reference.sensitive {
        let note = format!(
            "reference {}; {} of {} runs have another verdict (!)",
            report.reference.verdict,
            wrong,
            report.rows.len()
        );
        print(buffer, Rect { y: inside.y - 1, ..inside }, 0, &note, quiet);
    }
    let bound = |values: &mut dyn Iterator<Item = f64>| {
        let (low, high) = values
            .filter(|v| v.is_finite())
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(v), b.max(v)));
        (low.floor(), high.ceil().max(low.floor() + 1.0))
    };
    let (left, right) = bound(&mut points.iter().map(|((x, _), ..)| *x));
    let (bottom, top) = bound(&mut points.iter().map(|((_, y), ..)| *y));
    let (x, y) = (Axis::plain(left, right), Axis::plain(bottom, top));
    let Some(mut plot) = Plot::powers_both(buffer, inside, x, y, skin) else { return };
    for ((x, y), way, right) in points {
        plot.point(x, y, letter(way), skin.style(role(way)));
        if !right && let (Some(column), Some(row)) = (plot.column(x), plot.row(y)) {
            plot.text(column + 1, row, "!", skin.style(Role::Trouble));
        }
    }
}
