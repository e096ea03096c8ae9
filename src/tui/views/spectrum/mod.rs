//! View 6: the spectrum of the casing motion over the whole run, and the Campbell diagram, which
//! shows where frequencies coincide.

pub mod lines;

use ratatui::buffer::Buffer;

use crate::report::Sheet;
use crate::report::number::{frequency_unit, per_frequency, speed_unit};
use crate::report::table::{Table, TableCell};
use crate::tui::app::App;
use crate::tui::axis::{ChartAxis, readable, round_out};
use crate::tui::plot::Plot;
use crate::tui::raster::Pen;
use crate::tui::theme::Role;
use crate::tui::views::ViewId;
use crate::tui::views::panel::{
    ViewArea, ViewPanel, entry, name_level, name_speeds, not_yet, read_before, title,
};
use crate::tui::views::spectrum::lines::Spectrum;
use rubscope_solver::study::figures::{Figure, Panel, Quantity, Series, Style};

/// Ends of the amplitude axis, as powers of ten of a metre.
const DECADES: (f64, f64) = (-10.0, -3.0);

/// The view of the spectrum, above the Campbell diagram.
pub struct SpectrumView;

impl ViewPanel for SpectrumView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let (first, second) = at.pair(50);
        amplitudes(app, buffer, first);
        if let Some(second) = second {
            campbell(app, buffer, second);
        }
    }

    fn sheet<'a>(&self, app: &'a App) -> Option<Sheet<'a>> {
        let spectrum = app.results().found.spectrum.as_deref()?;
        let names = ["frequency_rad_s", "u_c_m", "u_s_m"];
        let table = Table::new(names, spectrum.cosine.len(), |place| {
            let frequency = place as f64 * spectrum.resolution;
            let [cosine, sine] = [&spectrum.cosine, &spectrum.sine].map(|part| part[place]);
            [frequency, cosine, sine].map(TableCell::from).into()
        });
        let mut sheet = Sheet::new("run", 1, app.view_command(), &app.scene);
        sheet.filed(None, table);
        sheet.picture(move || figure(app, spectrum));
        Some(sheet)
    }
}

/// Returns the frequencies of the wave, the casing and the blades in the fixed frame at a speed
/// \[rad/s\], as magnitudes \[rad/s\] with their labels.
fn lines(app: &App, speed: f64) -> [(f64, &'static str); 4] {
    let machine = app.machine.at(speed);
    let wave = machine.nu(speed);
    [
        (wave.abs(), "n_d Ω"),
        (machine.omega_c, "ω_c"),
        ((wave - machine.omega_bd).abs(), "n_d Ω-ω_bd"),
        ((wave + machine.omega_bd).abs(), "n_d Ω+ω_bd"),
    ]
}

/// Returns the spectrum as a figure, over the range of the chart.
fn figure(app: &App, spectrum: &Spectrum) -> Figure {
    let (least, highest) = (10_f64.powf(DECADES.0), highest(app));
    let series = |(number, (label, amplitudes)): (usize, (&str, &Vec<f64>))| {
        let points = amplitudes.iter().enumerate();
        let points = points.map(|(k, size)| (k as f64 * spectrum.resolution, size.max(least)));
        Series::new(label, Style::Line(number), points.take_while(|(w, _)| *w <= highest))
    };
    let series =
        [("u_c", &spectrum.cosine), ("u_s", &spectrum.sine)].into_iter().enumerate().map(series);
    let x = Quantity {
        label: format!("frequency [{}]", frequency_unit()).into(),
        ..Quantity::new("frequency_rad_s", "", per_frequency(1.0))
    };
    let panel = Panel::new("", x, Quantity::log("u_m", "amplitude [m]"), series.collect());
    Figure::new(app.scene.title.clone(), "whole run, Hann window", vec![panel])
}

/// Returns the end of the frequency axis \[rad/s\].
fn highest(app: &App) -> f64 {
    let most = (app.machine.nu(app.speed().abs()) + app.machine.omega_bd).max(app.machine.omega_c);
    round_out(0.0, 1.3 * most, 5).1
}

fn amplitudes(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    let x = ChartAxis::frequencies(0.0, highest(app));
    let cursor = app.cursor_in(ViewId::Spectrum).map(|at| x.at(at.across));
    let spectrum = app.results().found.spectrum.as_ref();
    let mut legend = vec![(format!("m by {}", frequency_unit()), quiet)];
    legend.extend([entry(look, &look.first(), "u_c"), entry(look, &look.second(), "u_s")]);
    let read = cursor.and_then(|frequency| reading(spectrum?, frequency));
    let name = read_before(look, &mut legend, read, "spectrum");
    legend.push(("whole run, Hann window".to_string(), quiet));
    let inside = title(app, buffer, at, name, &legend);
    let Some(spectrum) = spectrum else {
        return not_yet(app, buffer, inside);
    };
    let y = ChartAxis::powers(DECADES.0, DECADES.1, None);
    let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
    at.note(app, plot.inner);
    let marks = lines(app, app.speed());
    for (frequency, _) in marks {
        plot.upright(frequency, look.either('┊', ':'), quiet);
    }
    if let Some(frequency) = cursor {
        plot.upright(frequency, look.either('┊', ':'), look.style(Role::Focus));
    }
    for (series, pen) in [(&spectrum.sine, look.second()), (&spectrum.cosine, look.first())] {
        let points = series.iter().enumerate().map(|(k, amplitude)| {
            (k as f64 * spectrum.resolution, amplitude.max(1e-30).log10().max(DECADES.0))
        });
        plot.curve(points.take_while(|(w, _)| *w <= x.high), &pen);
    }
    plot.ink();
    name_speeds(&mut plot, &marks, app);
}

/// Describes the spectral line nearest to a frequency \[rad/s\]; `None` beyond the last line.
fn reading(spectrum: &Spectrum, frequency: f64) -> Option<String> {
    let line = (frequency / spectrum.resolution).round().max(0.0) as usize;
    let (u_c, u_s) = (spectrum.cosine.get(line)?, spectrum.sine.get(line)?);
    let at = readable(per_frequency(line as f64 * spectrum.resolution), frequency_unit());
    Some(format!("at {at}: u_c {}, u_s {}", readable(*u_c, "m"), readable(*u_s, "m")))
}

fn campbell(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    let meet = look.either('◆', '@');
    let legend = [
        entry(look, &look.first(), "n_d Ω"),
        entry(look, &look.second(), "n_d Ω±ω_bd"),
        (format!("{meet} meets ω_c"), look.style(Role::Contact)),
        (format!("{} by {}", frequency_unit(), speed_unit()), quiet),
    ];
    let inside = title(app, buffer, at, "Campbell", &legend);
    let fastest = app.results().found.locked.as_ref().map_or(600.0, |curves| curves.fastest);
    let top = app.machine.nu(fastest).max(1.5 * app.machine.omega_c);
    // The speed axis covers the current direction of rotation.
    let sense = if app.speed() < 0.0 { -1.0 } else { 1.0 };
    let x = ChartAxis::speeds((sense * fastest).min(0.0), (sense * fastest).max(0.0));
    let Some(mut plot) = Plot::new(buffer, inside, x, ChartAxis::frequencies(0.0, top), look)
    else {
        return;
    };
    at.note(app, plot.inner);
    plot.level(app.machine.omega_c, look.either('┈', '.'), look.style(Role::Text));
    plot.upright(app.speed(), look.either('│', '|'), look.style(Role::Focus));
    let pens: [Pen; 4] = [look.first(), look.quiet(), look.second(), look.second()];
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
        plot.point(sense * speed, app.machine.omega_c, meet, look.style(Role::Contact));
    }
    name_level(&mut plot, x, app.machine.omega_c, &look.spell("ω_c"), look.style(Role::Text));
}
