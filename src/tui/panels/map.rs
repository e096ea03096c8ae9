//! View 5: how the motion lasts over speed and pulse, a sign a run, with the
//! present knobs as a cross.

use ratatui::{buffer::Buffer, layout::Rect};

use super::charts::title;
use super::print;
use crate::motion::Verdict;
use crate::report::map::mark;
use crate::study::Cell;
use crate::tui::app::{App, View};
use crate::tui::axis::Scale;
use crate::tui::plot::{Axis, Plot};
use crate::tui::theme::Role;

/// Draws the view.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    let skin = &app.skin;
    let quiet = skin.style(Role::Quiet);
    let legend_of = |verdict| {
        (
            format!("{} {verdict}", mark(Some(Cell { verdict, sensitive: false }))),
            skin.style(role(verdict)),
        )
    };
    let mut legend = vec![
        legend_of(Verdict::Locked),
        legend_of(Verdict::Slip),
        legend_of(Verdict::Bounce),
        legend_of(Verdict::Decay),
        ("pulse [N] by speed [rad/s]; event solver, rigid, unilateral".to_string(), quiet),
    ];
    if let Some(map) = &app.map {
        let done = map.cells.iter().flatten().count();
        if done < map.cells.len() {
            legend.insert(
                0,
                (format!("{} %", 100 * done / map.cells.len().max(1)), skin.style(Role::Focus)),
            );
        }
    }
    let inside = title(app, buffer, area, View::Map, "map", &legend);
    let Some(map) = &app.map else {
        print(buffer, inside, 1, "computed while this view is open", quiet);
        return;
    };
    let (x_axis, y_axis) = (&map.plan.x, &map.plan.y);
    let x = Axis { low: x_axis.from, high: x_axis.to, scale: Scale::plain() };
    let y = Axis { low: y_axis.from.log10(), high: y_axis.to.log10(), scale: Scale::plain() };
    let Some(mut plot) = Plot::powers(buffer, inside, x, y, skin) else { return };
    let inner = plot.inner;
    let nearest = |place: u16, cells: u16, count: u32| {
        let part = (f64::from(place) + 0.5) / f64::from(cells.max(1));
        ((part * f64::from(count)) as u32).min(count.saturating_sub(1))
    };
    for row in 0..inner.height {
        let up = nearest(inner.height - 1 - row, inner.height, y_axis.count);
        for column in 0..inner.width {
            let across = nearest(column, inner.width, x_axis.count);
            if let Some(cell) = map.at(across, up) {
                let sign = mark(Some(cell)).to_string();
                plot.text(inner.x + column, inner.y + row, &sign, skin.style(role(cell.verdict)));
            }
        }
    }
    for speed in [app.machine.critical_speed(), app.machine.lock_speed()].into_iter().flatten() {
        plot.upright(speed, skin.either('┊', ':'), skin.style(Role::Text));
    }
    let pulse = app.scene.operation.pulse_n.abs();
    if pulse > 0.0 {
        plot.point(
            app.speed().abs(),
            pulse.log10(),
            skin.either('╋', '+'),
            skin.style(Role::Focus),
        );
    }
}

fn role(verdict: Verdict) -> Role {
    match verdict {
        Verdict::Locked => Role::Contact,
        Verdict::Adhesive | Verdict::Failed => Role::Trouble,
        Verdict::Slip => Role::Second,
        Verdict::Bounce => Role::First,
        Verdict::Decay => Role::Quiet,
    }
}
