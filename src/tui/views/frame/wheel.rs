//! The bladed disk as a wheel, in the frame of the blades: blades as spokes,
//! the casing around them with its wave magnified by a stated factor.

use std::f64::consts::TAU;

use ratatui::buffer::Buffer;

use super::super::panel::{ViewArea, title};
use super::square;
use crate::tui::app::App;
use crate::tui::plot::Plot;
use crate::tui::raster::Pen;
use crate::tui::theme::Role;
use crate::tui::worker::in_blade_frame;

/// The clearance at rest, in radii of the wheel.
const CLEARANCE: f64 = 0.12;
/// The largest wave of the wheel, in clearances.
const MOST: f64 = 1.2;
/// Inner end of the blades, in radii.
const HUB: f64 = 0.55;
/// Points of the casing outline.
const OUTLINE: u32 = 240;

/// Draws the wheel.
pub fn draw(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let machine = &app.machine;
    let polygon = &machine.polygon;
    // A wave that passes the clearance is less magnified, so that it stays on the chart.
    let unit = polygon.clearance.abs().max(app.run.ranges.rim.high / MOST).max(f64::MIN_POSITIVE);
    let exaggeration = CLEARANCE * app.scene.bladed_disk.blade_length_m / unit;
    let legend = [
        (format!("gaps x {exaggeration:.0}"), look.style(Role::Quiet)),
        ("turning with the blades".to_string(), look.style(Role::Quiet)),
    ];
    let inside = title(app, buffer, at, "wheel", &legend);
    let (x, y) = square(at.area, 1.0 + 2.2 * CLEARANCE);
    let Some(mut plot) = Plot::bare(buffer, inside, x, y, look) else { return };
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
    let spoke = |blade: u32, pen: &Pen, plot: &mut Plot| {
        let angle = TAU * f64::from(blade - 1) / f64::from(polygon.blades);
        let (sin, cos) = angle.sin_cos();
        let (b_sin, b_cos) = (machine.blade_diameters * angle).sin_cos();
        let [a_c, a_s] = moment.state.alpha;
        let tip = match outward == 0.0 {
            true => 1.0,
            false => 1.0 + outward * (a_c * b_cos + a_s * b_sin),
        };
        plot.curve([(HUB * cos, HUB * sin), (tip * cos, tip * sin)], pen);
    };
    let quiet = Pen { dashed: false, ..look.quiet() };
    let touched = Pen { style: look.style(Role::Contact), sign: '#', dashed: false };
    // Spokes closer than a cell cannot be distinguished.
    let all = polygon.blades <= u32::from(inside.width) * 2;
    let touching = app.touching_blades();
    let touches = |blade: u32| touching.contains(&blade);
    for blade in (1..=polygon.blades).filter(|blade| all && !touches(*blade)) {
        spoke(blade, &quiet, &mut plot);
    }
    plot.curve(casing, &look.first());
    for blade in (1..=polygon.blades).filter(|blade| touches(*blade)) {
        spoke(blade, &touched, &mut plot);
    }
    plot.ink();
    // The names of nearly all say nothing.
    let named = if 2 * touching.len() > polygon.blades as usize { &[][..] } else { &touching };
    for blade in named.iter().copied().take(8) {
        let angle = TAU * f64::from(blade - 1) / f64::from(polygon.blades);
        let (sin, cos) = angle.sin_cos();
        plot.label(0.8 * HUB * cos, 0.8 * HUB * sin, &blade.to_string(), look.style(Role::Contact));
    }
}
