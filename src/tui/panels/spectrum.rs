//! View 6: the spectrum of the casing motion over the whole run, and the
//! Campbell lines that say where frequencies meet.

use ratatui::{
    buffer::Buffer,
    layout::{Constraint, Layout, Rect},
};

use super::charts::{entry, title};
use super::print;
use crate::tui::app::{App, View};
use crate::tui::axis::{Scale, nice_step};
use crate::tui::plot::{Axis, Plot};
use crate::tui::raster::Pen;
use crate::tui::theme::Role;

/// From this height on the Campbell lines have a chart of their own.
const TWO_FROM: u16 = 16;
/// Smallest amplitude shown, as a power of ten of a metre, and the greatest.
const DECADES: (f64, f64) = (-10.0, -3.0);

/// Draws the view.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    if area.height >= TWO_FROM {
        let halves = [Constraint::Percentage(50), Constraint::Percentage(50)];
        let [top, bottom] = Layout::vertical(halves).areas(area);
        amplitudes(app, buffer, top);
        campbell(app, buffer, bottom);
    } else {
        amplitudes(app, buffer, area);
    }
}

fn highest(app: &App) -> f64 {
    let machine = &app.machine;
    let most = (machine.nu(app.speed().abs()) + machine.omega_bd).max(machine.omega_c);
    let step = nice_step(1.3 * most, 5).unwrap_or(most);
    (1.3 * most / step).ceil() * step
}

/// Frequencies of the standing frame, with their names \[rad/s\].
fn lines(app: &App, speed: f64) -> [(f64, &'static str); 4] {
    let machine = &app.machine;
    let wave = machine.nu(speed);
    [
        (wave, "n_d Ω"),
        (machine.omega_c, "ω_c"),
        ((wave - machine.omega_bd).abs(), "n_d Ω-ω_bd"),
        (wave + machine.omega_bd, "n_d Ω+ω_bd"),
    ]
}

fn amplitudes(app: &App, buffer: &mut Buffer, area: Rect) {
    let skin = &app.skin;
    let quiet = skin.style(Role::Quiet);
    let legend = [
        entry(skin, &skin.first(), "u_c"),
        entry(skin, &skin.second(), "u_s"),
        ("m by rad/s, whole run, Hann window".to_string(), quiet),
    ];
    let inside = title(app, buffer, area, View::Spectrum, "spectrum", &legend);
    let Some(spectrum) = &app.spectrum else {
        print(buffer, inside, 1, "computed while this view is open", quiet);
        return;
    };
    let x = Axis::plain(0.0, highest(app));
    let y = Axis { low: DECADES.0, high: DECADES.1, scale: Scale::plain() };
    let Some(mut plot) = Plot::powers(buffer, inside, x, y, skin) else { return };
    let marks = lines(app, app.speed().abs());
    for (frequency, _) in marks {
        plot.upright(frequency, skin.either('┊', ':'), quiet);
    }
    for (series, pen) in [(&spectrum.sine, skin.second()), (&spectrum.cosine, skin.first())] {
        let points = series.iter().enumerate().map(|(k, amplitude)| {
            (k as f64 * spectrum.resolution, amplitude.max(1e-30).log10().max(DECADES.0))
        });
        plot.curve(points.take_while(|(w, _)| *w <= x.high), &pen);
    }
    plot.ink();
    for ((frequency, name), row) in marks.iter().zip(plot.inner.y..) {
        plot.note(*frequency, row, &skin.spell(name), skin.style(Role::Text));
    }
}

fn campbell(app: &App, buffer: &mut Buffer, area: Rect) {
    let skin = &app.skin;
    let quiet = skin.style(Role::Quiet);
    let meet = skin.either('◆', '@');
    let legend = [
        entry(skin, &skin.first(), "n_d Ω"),
        entry(skin, &skin.second(), "n_d Ω±ω_bd"),
        (format!("{meet} meets ω_c"), skin.style(Role::Contact)),
        ("rad/s by rad/s".to_string(), quiet),
    ];
    let inside = title(app, buffer, area, View::Spectrum, "Campbell", &legend);
    let fastest = app.locked.as_ref().map_or(600.0, |curves| curves.fastest);
    let top = app.machine.nu(fastest).max(1.5 * app.machine.omega_c);
    let Some(mut plot) =
        Plot::new(buffer, inside, Axis::plain(0.0, fastest), Axis::plain(0.0, top), skin)
    else {
        return;
    };
    plot.level(app.machine.omega_c, skin.either('┈', '.'), skin.style(Role::Text));
    plot.upright(app.speed().abs(), skin.either('│', '|'), skin.style(Role::Focus));
    let pens: [Pen; 4] = [skin.first(), skin.quiet(), skin.second(), skin.second()];
    for (place, pen) in pens.iter().enumerate().filter(|(place, _)| *place != 1).rev() {
        let speeds = plot.column_values();
        let curve = speeds.iter().filter_map(|speed| {
            let (frequency, _) = *lines(app, *speed).get(place)?;
            (frequency <= top).then_some((*speed, frequency))
        });
        plot.curve(curve, pen);
    }
    plot.ink();
    let crossings =
        app.machine.coincidence_speeds().into_iter().chain(app.machine.critical_speed());
    for speed in crossings {
        plot.point(speed, app.machine.omega_c, meet, skin.style(Role::Contact));
    }
    if let Some(row) = plot.row(app.machine.omega_c) {
        plot.note(0.0, row, &skin.spell("ω_c"), skin.style(Role::Text));
    }
}
