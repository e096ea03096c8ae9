//! View 3: the multipliers of the locked motion against speed, the speeds
//! of the thresholds, the present speed, and the forces of the running motion.

pub mod curves;

use ratatui::buffer::Buffer;

use super::panel::{ViewArea, ViewPanel, csv, entry, title};
use crate::harmonic::{LockedPoint, Sweep};
use crate::motion::ActiveSet;
use crate::tui::app::App;
use crate::tui::axis::{ChartAxis, nice_step};
use crate::tui::plot::Plot;
use crate::tui::raster::Pen;
use crate::tui::text::print;
use crate::tui::theme::Role;

/// From this height on, the undamped curve of the paper is shown too.
const ROOMY: u16 = 14;

/// The view.
pub struct LockedView;

impl ViewPanel for LockedView {
    fn what(&self) -> &'static str {
        "locked motion"
    }

    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let look = &app.appearance;
        let quiet = look.style(Role::Quiet);
        let curves = app.latest.results.locked.as_deref();
        let roomy = at.area.height >= ROOMY;
        let pair = curves.is_some_and(|curves| curves.undamped.is_some());
        let point = look.either('◆', '@');
        let mut legend = vec![entry(look, &look.first(), if pair { "λ_a" } else { "λ" })];
        if pair {
            legend.push(entry(look, &look.second(), "λ_b"));
        }
        let points = running(app);
        let forces: Vec<String> = points.iter().take(2).map(|force| short(*force)).collect();
        let now = if points.is_empty() { "running".to_string() } else { forces.join(" ") };
        legend.push((format!("{point} {now}"), look.style(Role::Contact)));
        legend.push(("N over rad/s".into(), quiet));
        legend.push(("below 0 pushes".into(), quiet));
        if pair && roomy {
            legend.push(entry(look, &look.quiet(), "undamped"));
        }
        let inside = title(app, buffer, at, "locked λ(Ω)", &legend);
        let Some(curves) = curves else { return };
        let Some(damped) = &curves.damped else {
            let text = "no corner between two blade groups: this wave never locks";
            print(buffer, inside, 1, text, quiet);
            return;
        };
        let lambdas = damped.points.iter().flat_map(|point| point.multipliers_n);
        // The scale follows the curves: the mean over an impact may be far outside.
        let (low, high) = lambdas
            .filter(|lambda| lambda.is_finite())
            .fold((0.0_f64, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
        let step = nice_step(high - low, 6).unwrap_or(1.0);
        let y = ChartAxis::scaled((low / step).floor() * step, (high / step).ceil() * step);
        let x = ChartAxis::plain(0.0, curves.fastest);
        let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
        at.note(app, plot.inner);
        let marks = thresholds(app);
        plot.level(0.0, look.either('┈', '.'), quiet);
        for (speed, _) in &marks {
            plot.upright(*speed, look.either('┊', ':'), quiet);
        }
        let speed = app.speed().abs();
        plot.upright(speed, look.either('│', '|'), look.style(Role::Focus));
        if let Some(undamped) = &curves.undamped {
            if roomy {
                curve(&mut plot, undamped, 0, &look.quiet());
            }
            curve(&mut plot, damped, 1, &look.second());
        }
        curve(&mut plot, damped, 0, &look.first());
        plot.ink();
        for force in points {
            let (sign, shown) = if force < y.low {
                (look.either('▼', 'v'), y.low)
            } else if force > y.high {
                (look.either('▲', '^'), y.high)
            } else {
                (point, force)
            };
            plot.point(speed, shown, sign, look.style(Role::Contact));
        }
        names(&mut plot, &marks, app);
    }

    fn csv(&self, app: &App) -> Result<String, String> {
        let damped = app.latest.results.locked.as_ref().and_then(|curves| curves.damped.as_ref());
        let points = damped.map_or(&[][..], |sweep| &sweep.points);
        let rows = points.iter().map(|point| {
            let [a, b] = point.multipliers_n;
            let [admissible, stable] =
                [point.admissible, point.stable].map(|is| f64::from(u8::from(is)));
            [point.speed_rad_s, a, b, admissible, stable]
        });
        let columns = ["speed_rad_s", "multiplier_a_n", "multiplier_b_n", "admissible", "stable"];
        csv(&columns.map(String::from), rows)
    }
}

fn curve(plot: &mut Plot, sweep: &Sweep, place: usize, pen: &Pen) {
    let lambda = |point: &LockedPoint| Some((point.speed_rad_s, *point.multipliers_n.get(place)?));
    plot.curve(sweep.points.iter().filter_map(lambda), pen);
}

/// Names of the thresholds in the upper rows, one below the other if close.
fn names(plot: &mut Plot, marks: &[(f64, &str)], app: &App) {
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

/// The threshold speeds, slowest first.
fn thresholds(app: &App) -> Vec<(f64, &'static str)> {
    let machine = &app.machine;
    let mut marks: Vec<(f64, &'static str)> = [
        (machine.critical_speed(), "Ω_c"),
        (machine.lock_speed(), "Ω_lock"),
        (machine.dangerous_speed(), "coincidence"),
    ]
    .into_iter()
    .filter_map(|(speed, name)| Some((speed?, name)))
    .collect();
    if machine.casing_damping == 0.0 {
        // Without damping the two thresholds are one.
        marks.retain(|(_, name)| *name != "Ω_lock");
    }
    marks.sort_by(|a, b| a.0.total_cmp(&b.0));
    marks
}

/// Mean multipliers of the running motion, while something touches.
fn running(app: &App) -> Vec<f64> {
    let Some(moment) = &app.latest.moment else { return Vec::new() };
    if moment.active_set == ActiveSet::Nothing {
        return Vec::new();
    }
    moment.multipliers.iter().map(|(_, force)| *force).filter(|force| force.is_finite()).collect()
}

/// A force in few characters.
fn short(force: f64) -> String {
    if force.abs() < 1e4 { format!("{force:.0}") } else { format!("{:.0}k", force / 1e3) }
}
