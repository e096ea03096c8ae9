//! View 5: the verdict over speed and pulse, one sign for each run, with the
//! present knobs as a cross.

use ratatui::buffer::Buffer;

use super::panel::{ViewArea, ViewPanel, not_yet, title};
use crate::motion::Verdict;
use crate::report::map::{mark, write_csv};
use crate::study::Cell;
use crate::tui::app::App;
use crate::tui::axis::ChartAxis;
use crate::tui::plot::Plot;
use crate::tui::theme::Role;

/// The view.
pub struct MapView;

impl ViewPanel for MapView {
    fn what(&self) -> &'static str {
        "map over speed and pulse"
    }

    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let look = &app.appearance;
        let quiet = look.style(Role::Quiet);
        let legend_of = |verdict| {
            (
                format!("{} {verdict}", mark(Some(Cell { verdict, sensitive: false }))),
                look.style(role(verdict)),
            )
        };
        let mut legend = vec![
            legend_of(Verdict::Locked),
            legend_of(Verdict::Slip),
            legend_of(Verdict::Bounce),
            legend_of(Verdict::Decay),
            ("pulse [N] by speed [rad/s]; event solver, rigid, unilateral".to_string(), quiet),
        ];
        let map = app.latest.results.map.as_ref();
        if let Some(map) = map {
            let done = map.cells.iter().flatten().count();
            if done < map.cells.len() {
                legend.insert(
                    0,
                    (format!("{} %", 100 * done / map.cells.len().max(1)), look.style(Role::Focus)),
                );
            }
        }
        let inside = title(app, buffer, at, "map", &legend);
        let Some(map) = map else { return not_yet(app, buffer, inside) };
        let (x_axis, y_axis) = (&map.plan.x, &map.plan.y);
        let x = ChartAxis::plain(x_axis.from, x_axis.to);
        let y = ChartAxis::powers(y_axis.from.log10(), y_axis.to.log10());
        let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
        at.note(app, plot.inner);
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
                    plot.text(
                        inner.x + column,
                        inner.y + row,
                        &sign,
                        look.style(role(cell.verdict)),
                    );
                }
            }
        }
        for speed in [app.machine.critical_speed(), app.machine.lock_speed()].into_iter().flatten()
        {
            plot.upright(speed, look.either('┊', ':'), look.style(Role::Text));
        }
        let pulse = app.scene.operation.pulse_n.abs();
        if pulse > 0.0 {
            let cross = look.either('╋', '+');
            plot.point(app.speed().abs(), pulse.log10(), cross, look.style(Role::Focus));
        }
    }

    fn csv(&self, app: &App) -> Result<String, String> {
        let map = app.latest.results.map.as_ref().ok_or("there is no map yet")?;
        let mut bytes = Vec::new();
        write_csv(map, &mut bytes).map_err(|error| error.to_string())?;
        String::from_utf8(bytes).map_err(|error| error.to_string())
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
