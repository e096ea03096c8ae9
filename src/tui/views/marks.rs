//! Speeds that are marked on a chart over speeds, with their names.

use crate::tui::app::App;
use crate::tui::plot::Plot;
use crate::tui::theme::Role;

/// Names of marked speeds in the upper rows, one below the other if close.
pub fn names(plot: &mut Plot, marks: &[(f64, &str)], app: &App) {
    let mut free = [0_u16; 3];
    for (speed, name) in marks {
        let name = app.appearance.spell(name);
        let Some(column) = plot.column(*speed) else { continue };
        let wide = u16::try_from(name.chars().count()).unwrap_or(u16::MAX);
        let column = column.min(plot.inner.right().saturating_sub(wide));
        for (row, free) in (plot.inner.y..plot.inner.bottom()).zip(&mut free) {
            if column >= *free {
                plot.note(*speed, row, &name, app.appearance.style(Role::Text));
                *free = column.saturating_add(wide + 1);
                break;
            }
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
