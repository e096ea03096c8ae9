//! The bladed disk as a wheel, in the frame of the blades: blades as spokes, the casing
//! around them with its lobes magnified by a stated factor, and the blades that touch it
//! marked and numbered.

use std::f64::consts::TAU;

use ratatui::{buffer::Buffer, layout::Rect};

use super::super::panel::{ViewArea, title};
use super::square;
use crate::tui::app::{App, Cursor};
use crate::tui::axis::{ChartAxis, instant};
use crate::tui::plot::Plot;
use crate::tui::raster::Pen;
use crate::tui::theme::Role;
use crate::tui::views::ViewId;
use crate::tui::worker::in_blade_frame;

/// The clearance at rest, in radii of the wheel.
const CLEARANCE: f64 = 0.16;
/// The largest wave of the wheel, in clearances.
const MOST: f64 = 1.2;
/// Inner end of the blades, in radii.
const HUB: f64 = 0.5;
/// Points of the casing outline.
const OUTLINE: u32 = 240;
/// Where the numbers of touching blades can stand: in the hub, which has no data.
const NUMBERS: [f64; 3] = [0.76 * HUB, 0.5 * HUB, 0.3 * HUB];
/// Most numbers.
const MOST_NUMBERS: usize = 8;

/// Draws the wheel.
pub fn draw(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let machine = &app.machine;
    let polygon = &machine.polygon;
    // A wave that passes the clearance is less magnified, so that it stays on the chart.
    let unit = polygon.clearance.abs().max(app.run.ranges.rim.high / MOST).max(f64::MIN_POSITIVE);
    let exaggeration = CLEARANCE * app.scene.bladed_disk.blade_length_m / unit;
    let reach = 1.0 + 2.1 * CLEARANCE;
    let (x, y) =
        square(Rect { width: at.area.width + 6, height: at.area.height + 1, ..at.area }, reach);
    let quiet = look.style(Role::Quiet);
    let touching = app.touching_blades();
    let contact = if touching.is_empty() { quiet } else { look.style(Role::Contact) };
    let mark = look.either('▲', '^');
    let mut legend = vec![
        (format!("{mark} {}", app.contact_shown()), contact),
        (format!("gaps x {exaggeration:.0}"), quiet),
    ];
    let cursor = app.cursor_in(ViewId::Frame).filter(|_| at.large);
    let read = cursor.and_then(|cursor| reading(app, x, y, cursor));
    let name = if read.is_some() { "" } else { "wheel" };
    if let Some(read) = read {
        legend.insert(0, (read, look.style(Role::Focus)));
    }
    let inside = title(app, buffer, at, name, &legend);
    let Some(mut plot) = Plot::bare(buffer, inside, x, y, look) else { return };
    at.note(app, plot.inner);
    let Some(moment) = app.shown() else { return };
    let z = in_blade_frame(moment.state.u, machine.nodal_diameters * moment.angle);
    let casing = (0..=OUTLINE).map(|k| {
        let angle = TAU * f64::from(k) / f64::from(OUTLINE);
        let (sin, cos) = (machine.nodal_diameters * angle).sin_cos();
        let gap = (polygon.clearance + z[0] * cos + z[1] * sin) / unit;
        let radius = 1.0 + CLEARANCE * gap;
        (radius * angle.cos(), radius * angle.sin())
    });
    // A tip that moves outward meets the casing there.
    let outward = machine.radial_coupling * machine.blade_length * CLEARANCE / unit;
    let angle_of = |blade: u32| TAU * f64::from(blade - 1) / f64::from(polygon.blades);
    let tip = |blade: u32| {
        let (sin, cos) = angle_of(blade).sin_cos();
        let (b_sin, b_cos) = (machine.blade_diameters * angle_of(blade)).sin_cos();
        let [a_c, a_s] = moment.state.alpha;
        let radius = match outward == 0.0 {
            true => 1.0,
            false => 1.0 + outward * (a_c * b_cos + a_s * b_sin),
        };
        [radius * cos, radius * sin]
    };
    let spoke = |blade: u32, pen: &Pen, plot: &mut Plot| {
        let (sin, cos) = angle_of(blade).sin_cos();
        let [x, y] = tip(blade);
        plot.curve([(HUB * cos, HUB * sin), (x, y)], pen);
    };
    let blades = Pen { style: look.style(Role::Text), sign: '.', dashed: false };
    let touched = Pen { style: look.style(Role::Contact), sign: '#', dashed: false };
    // Spokes closer than a cell cannot be distinguished.
    let all = polygon.blades <= u32::from(inside.width) * 2;
    let touches = |blade: u32| touching.contains(&blade);
    for blade in (1..=polygon.blades).filter(|blade| all && !touches(*blade)) {
        spoke(blade, &blades, &mut plot);
    }
    plot.curve(casing, &look.first());
    for blade in (1..=polygon.blades).filter(|blade| touches(*blade)) {
        spoke(blade, &touched, &mut plot);
    }
    plot.ink();
    for blade in touching.iter().filter(|_| all) {
        let [x, y] = tip(*blade);
        plot.point(x, y, mark, look.style(Role::Contact));
    }
    // The names of nearly all say nothing.
    let named = if 2 * touching.len() > polygon.blades as usize { &[][..] } else { &touching };
    for blade in named.iter().copied().take(MOST_NUMBERS) {
        let (sin, cos) = angle_of(blade).sin_cos();
        let (name, style) = (blade.to_string(), look.style(Role::Contact));
        let mut places = NUMBERS.into_iter();
        let _ = places.any(|part| plot.free_label((part * cos, part * sin), &name, style));
    }
    if let Some(cursor) = cursor {
        plot.point(x.at(cursor.across), y.at(cursor.up), '+', look.style(Role::Focus));
    }
}

/// The blade next to the reading cursor, its gap, and the instant that is read.
fn reading(app: &App, x: ChartAxis, y: ChartAxis, cursor: Cursor) -> Option<String> {
    let moment = app.shown()?;
    let blades = app.machine.polygon.blades;
    let turn = y.at(cursor.up).atan2(x.at(cursor.across)).rem_euclid(TAU) / TAU;
    let blade = (turn * f64::from(blades)).round() as u32 % blades.max(1);
    let gap = app.gap_words(*moment.gaps.get(blade as usize)?);
    let at = app.cursor_time().map(|_| format!(" at {}", instant(moment.state.t_s)));
    Some(format!("blade {}: {gap}{}", blade + 1, at.unwrap_or_default()))
}
