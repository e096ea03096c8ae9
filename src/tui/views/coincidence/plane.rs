//! The joint compliance of blades and casing in the complex plane. A wave of pushes
//! lasts where it is real and below zero; on a lining, where it is `-1/S` of the
//! lining there.

use nalgebra::Complex;
use ratatui::buffer::Buffer;

use super::curves::frequencies;
use crate::harmonic::{Joint, Lining, RoundWhirl, round_whirls};
use crate::tui::app::App;
use crate::tui::axis::{ChartAxis, readable};
use crate::tui::plot::Plot;
use crate::tui::theme::Role;
use crate::tui::views::frame::square;
use crate::tui::views::panel::{ViewArea, entry, title};

/// How far the chart reaches beyond what is marked on it.
const MARGIN: f64 = 2.0;

/// Draws it at the present speed.
pub fn draw(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    let joint = Joint::at(&app.machine, app.speed());
    let waves = round_whirls(&joint);
    let marked_lining = marked_lining(app);
    let values: Vec<(f64, Complex<f64>)> =
        frequencies(&joint).into_iter().map(|w| (w, joint.compliance(w))).collect();
    let marked = waves
        .iter()
        .map(|wave| 1.0 / wave.stiffness_n_per_m)
        .chain(marked_lining.map(|(s, _)| 1.0 / s));
    let marked = marked.fold(0.0, f64::max);
    let largest = values.iter().map(|(_, b)| b.norm()).filter(|b| b.is_finite());
    let reach = if marked > 0.0 { MARGIN * marked } else { largest.fold(0.0, f64::max) };
    let (x, y) = square(at.area, reach);
    let point = look.either('◆', '@');
    let mut legend = vec![entry(look, &look.first(), &format!("B, {}m/N", x.scale.prefix))];
    let lining = Lining::of(&app.machine, &app.scene.contact).ok();
    let lining = lining.filter(|_| app.has_lining());
    // Of a pair over a clearance one attracts, the other is the threshold between it and
    // rest. On a lining a wave lasts at the amplitude that has its stiffness.
    let lasts = |wave: &RoundWhirl| {
        let on = |lining: &Lining| !lining.amplitudes(wave.stiffness_n_per_m).is_empty();
        lining.as_ref().map_or(wave.attracts, on)
    };
    let named = match lining {
        Some(_) => waves.iter().copied().find(lasts),
        None => RoundWhirl::lasting(&waves),
    };
    match named.or(waves.last().copied()) {
        Some(wave) => {
            let contact = look.style(Role::Contact);
            let (omega, s) = (wave.omega_rad_s, wave.stiffness_n_per_m);
            legend.push((format!("{point} ω {}", readable(omega, "rad/s")), contact));
            legend.push((format!("S {}", readable(s, "N/m")), contact));
        }
        None => legend.push(("no crossing".into(), quiet)),
    }
    legend.push((format!("at {}", readable(app.speed(), "rad/s")), quiet));
    legend.push(entry(look, &look.quiet(), "backward"));
    let inside = title(app, buffer, at, "compliance", &legend);
    let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
    plot.level(0.0, look.either('┈', '.'), quiet);
    plot.upright(0.0, look.either('┊', ':'), quiet);
    for (forward, pen) in [(false, look.quiet()), (true, look.first())] {
        let half = values.iter().filter(|(w, _)| (*w >= 0.0) == forward);
        plot.curve(half.map(|(_, b)| inside_of(*b, x, y)), &pen);
    }
    plot.ink();
    if let Some((stiffness, name)) = marked_lining {
        let place = -1.0 / stiffness;
        plot.point(place, 0.0, look.either('┃', '!'), look.style(Role::Text));
        if let Some(row) = plot.row(0.0) {
            plot.free_note(place, row + 1, name, look.style(Role::Text));
        }
    }
    for wave in &waves {
        let sign = if lasts(wave) { point } else { look.either('○', 'o') };
        plot.point(-1.0 / wave.stiffness_n_per_m, 0.0, sign, look.style(Role::Contact));
    }
    let ends = [(x.low, 0.0, "Re"), (0.0, y.high, "Im")];
    for (at_x, at_y, name) in ends {
        if let Some(row) = plot.row(at_y) {
            plot.free_note(at_x, row, name, quiet);
        }
    }
}

/// A place of the curve; far outside only its direction matters.
fn inside_of(b: Complex<f64>, x: ChartAxis, y: ChartAxis) -> (f64, f64) {
    let most = 20.0 * x.high.max(y.high);
    let scale = (most / b.norm()).min(1.0);
    (b.re * scale, b.im * scale)
}

/// The stiffness of all blades on a lining: of the blades that rub at rest, or the most
/// that those have which come to it.
fn marked_lining(app: &App) -> Option<(f64, &'static str)> {
    if !app.has_lining() {
        return None;
    }
    let blades = f64::from(app.machine.polygon.blades);
    let stiffness = 0.5 * blades * app.scene.contact.stiffness_n_per_m;
    Some((stiffness, if app.is_pressed() { "-1/S0" } else { "-2/(N k_p)" }))
}
