//! View 3: the multipliers of the locked motion against speed, the speeds
//! of the thresholds, the present speed, and the forces of the running motion;
//! blade angles and amplitudes below if there is room.

mod charts;
pub mod curves;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};

use super::marks;
use super::panel::{LEAST_ROWS, ViewArea, ViewPanel, csv, dots, entry, title};
use crate::harmonic::{LockedPoint, Sweep};
use crate::motion::ActiveSet;
use crate::tui::app::{App, Cursor};
use crate::tui::axis::ChartAxis;
use crate::tui::plot::Plot;
use crate::tui::raster::Pen;
use crate::tui::text::{print, shorten, wrap};
use crate::tui::theme::Role;
use charts::{AMPLITUDES, ANGLES};
use curves::LockedCurves;

/// From this height on, the large chart shows the undamped curve of the paper too.
const ROOMY: u16 = 14;
/// From this width on, the legend names the forces of the running motion.
const NAMED_FROM: u16 = 62;
/// Most rows of what the reading cursor reads.
const READ_ROWS: usize = 3;

/// The view.
pub struct LockedView;

impl ViewPanel for LockedView {
    fn what(&self) -> &'static str {
        "locked motion"
    }

    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let curves = app.results().found.locked.as_deref();
        let locks = curves.filter(|curves| curves.damped.is_some());
        let below: &[charts::Chart] = match at.area.height / LEAST_ROWS {
            3.. => &[ANGLES, AMPLITUDES],
            2 => &[ANGLES],
            _ => &[],
        };
        let Some(curves) = locks else { return multipliers(app, buffer, at) };
        let lower = at.area.height * 2 / (3 + 2 * u16::try_from(below.len()).unwrap_or(0));
        let mut rows = vec![Constraint::Min(1)];
        rows.extend(below.iter().map(|_| Constraint::Length(lower.max(LEAST_ROWS))));
        let areas = Layout::vertical(rows).split(at.area);
        let mut areas = areas.iter().map(|area| ViewArea { area: *area, ..at });
        if let Some(first) = areas.next() {
            multipliers(app, buffer, first);
        }
        for (chart, at) in below.iter().zip(areas) {
            chart.draw(app, curves, buffer, at);
        }
    }

    /// The present speed.
    fn here(&self, app: &App) -> Cursor {
        let fastest = app.results().found.locked.as_ref().map_or(1.0, |curves| curves.fastest);
        Cursor { across: (app.speed().abs() / fastest).clamp(0.0, 1.0), up: 0.5 }
    }

    fn csv(&self, app: &App) -> Result<String, String> {
        let damped = app.results().found.locked.as_ref().and_then(|curves| curves.damped.as_ref());
        let points = damped.map_or(&[][..], |sweep| &sweep.points);
        let rows = points.iter().map(|point| {
            let [a, b] = point.multipliers_n;
            let [admissible, stable] =
                [point.admissible, point.stable].map(|is| f64::from(u8::from(is)));
            let [turn_a, turn_b] = point.alpha_rad;
            let waves = [point.u_cc_m, point.u_cs_m, point.u_sc_m, point.u_ss_m];
            let first = [point.speed_rad_s, a, b, admissible, stable, turn_a, turn_b];
            first.into_iter().chain(waves).chain([point.amplitude_m])
        });
        let columns = [
            "speed_rad_s",
            "multiplier_a_n",
            "multiplier_b_n",
            "admissible",
            "stable",
            "alpha_a_rad",
            "alpha_b_rad",
            "u_cc_m",
            "u_cs_m",
            "u_sc_m",
            "u_ss_m",
            "amplitude_m",
        ];
        csv(&columns.map(String::from), rows)
    }
}

/// The chart of the multipliers.
fn multipliers(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    let curves = app.results().found.locked.as_deref();
    let roomy = at.large && at.area.height >= ROOMY;
    let pair = curves.is_some_and(|curves| curves.undamped.is_some());
    let point = look.either('◆', '@');
    let prefix = curves.and_then(|curves| Some(force_axis(curves, curves.damped.as_ref()?)));
    let prefix = prefix.map_or("", |y| y.scale.prefix);
    let mut legend = vec![(format!("{prefix}N over rad/s"), quiet)];
    legend.push(entry(look, &look.first(), if pair { "λ_a" } else { "λ" }));
    if pair {
        legend.push(entry(look, &look.second(), "λ_b"));
    }
    let points = running(app);
    let forces: Vec<String> = points.iter().take(2).map(|force| short(*force)).collect();
    let now = if points.is_empty() { "no contact".to_string() } else { forces.join(" ") };
    let going_round = Pen { style: look.style(Role::Contact), sign: 'w', dashed: true };
    if curves.is_some_and(|curves| !curves.whirl.is_empty()) {
        legend.push(entry(look, &going_round, "whirl"));
    }
    // Beside another chart there is room for the numbers only.
    let mean = if at.area.width >= NAMED_FROM { "mean now " } else { "" };
    legend.push((format!("{point} {mean}{now}"), look.style(Role::Contact)));
    legend.push(("below 0 pushes".into(), quiet));
    if pair && roomy {
        legend.push(dots(look, "undamped"));
    }
    if app.has_lining() {
        legend.push(("of a rigid casing".into(), quiet));
    }
    legend.extend(app.tuned_note().map(|note| (note.into(), quiet)));
    if app.speed() < 0.0 {
        legend.push(("over |Ω|, turning backwards".into(), quiet));
    }
    let inside = title(app, buffer, at, "locked λ(Ω)", &legend);
    let Some(curves) = curves else { return };
    let Some(damped) = &curves.damped else {
        let text = if app.is_pressed() {
            "all blades rub at rest: nothing locks; view 9 has what grows"
        } else if app.machine.has_other_diameters() {
            "the disk has other diameters than the casing: no pair of blades locks"
        } else {
            "no corner between two blade groups: this wave never locks"
        };
        print(buffer, inside, 1, text, quiet);
        return;
    };
    let inside = if at.large { read(app, curves, buffer, inside) } else { inside };
    // The scale follows the curves: the mean over an impact may be far outside.
    let y = force_axis(curves, damped).evened(inside, look);
    let x = ChartAxis::plain(0.0, curves.fastest);
    let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
    at.note(app, plot.inner);
    plot.level(0.0, look.either('┈', '.'), quiet);
    uprights(&mut plot, app, curves);
    plot.curve(curves.whirl.iter().copied(), &going_round);
    if let Some(undamped) = &curves.undamped {
        if roomy {
            let points = undamped.points.iter();
            let points = points.map(|point| (point.speed_rad_s.abs(), point.multipliers_n[0]));
            plot.dotted(points, x.low, 1.0, &look.quiet());
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
        plot.point(app.speed().abs(), shown, sign, look.style(Role::Contact));
    }
    marks::names(&mut plot, &curves.marks, app);
}

/// The axis of the forces of locks and whirls.
fn force_axis(curves: &LockedCurves, damped: &Sweep) -> ChartAxis {
    let points = damped.points.iter().filter(|point| curves.scales(point.speed_rad_s));
    let whirl = curves.whirl.iter().filter(|(speed, _)| curves.scales(*speed));
    let locks = points.flat_map(|point| point.multipliers_n);
    charts::range(locks.chain(whirl.map(|(_, push)| *push)))
}

/// What the reading cursor reads, above the chart; returns the rest.
fn read(app: &App, curves: &LockedCurves, buffer: &mut Buffer, inside: Rect) -> Rect {
    let look = &app.appearance;
    let Some(speed) = charts::cursor_speed(app, curves) else { return inside };
    let width = usize::from(inside.width).saturating_sub(1);
    let mut lines = wrap(&look.spell(&charts::reading(app, speed)), width);
    // The chart keeps at least half of the rows.
    let most = READ_ROWS.min(usize::from(inside.height / 4)).max(1);
    if lines.len() > most {
        let rest = lines.split_off(most - 1).join(" ");
        lines.push(shorten(&rest, width, look.ellipsis()));
    }
    let rows = u16::try_from(lines.len()).unwrap_or(0).min(inside.height);
    let area = Rect { x: inside.x + 1, width: inside.width.saturating_sub(1), ..inside };
    for (row, line) in (0..rows).zip(&lines) {
        print(buffer, area, row, line, look.style(Role::Focus));
    }
    Rect { y: inside.y + rows, height: inside.height - rows, ..inside }
}

/// The threshold speeds, the present speed and the reading cursor.
fn uprights(plot: &mut Plot, app: &App, curves: &LockedCurves) {
    marks::uprights(plot, app, &curves.marks, charts::cursor_speed(app, curves));
}

fn curve(plot: &mut Plot, sweep: &Sweep, place: usize, pen: &Pen) {
    let lambda =
        |point: &LockedPoint| Some((point.speed_rad_s.abs(), *point.multipliers_n.get(place)?));
    plot.curve(sweep.points.iter().filter_map(lambda), pen);
}

/// Mean multipliers of the running motion, while something touches.
fn running(app: &App) -> Vec<f64> {
    let Some(moment) = &app.run.latest.moment else { return Vec::new() };
    if moment.active_set == ActiveSet::Nothing {
        return Vec::new();
    }
    moment.multipliers.iter().map(|(_, force)| *force).filter(|force| force.is_finite()).collect()
}

/// A force in few characters.
fn short(force: f64) -> String {
    if force.abs() < 1e4 { format!("{force:.0}") } else { format!("{:.0}k", force / 1e3) }
}
