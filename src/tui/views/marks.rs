//! Speeds that are marked on a chart over speeds, with their names.

use crate::tui::app::App;
use crate::tui::plot::Plot;
use crate::tui::theme::Role;

/// Names of marked speeds where the chart is empty, as high as possible, or on the axis; one
/// that covers data is left out, and has its line.
pub fn names(plot: &mut Plot, marks: &[(f64, &str)], app: &App) {
    let style = app.appearance.style(Role::Text);
    for (speed, name) in marks {
        let name = app.appearance.spell(name);
        let mut rows = plot.inner.y..plot.inner.bottom();
        if !rows.any(|row| plot.free_note(*speed, row, &name, style)) {
            plot.axis_note(*speed, &name, style, &app.appearance);
        }
    }
}

/// Upright lines at marked speeds, at the present one, and at that which is read.
pub fn uprights(plot: &mut Plot, app: &App, marks: &[(f64, &str)], read: Option<f64>) {
    let look = &app.appearance;
    for (speed, _) in marks {
        plot.upright(*speed, look.either('┊', ':'), look.style(Role::Quiet));
    }
    plot.upright(app.speed().abs(), look.either('│', '|'), look.style(Role::Focus));
    if let Some(speed) = read {
        plot.upright(speed, look.either('╎', '!'), look.style(Role::Focus));
    }
}
