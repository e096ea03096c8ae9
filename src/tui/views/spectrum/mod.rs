//! View 6: the spectrum of the casing motion over the whole run, and the Campbell diagram, which
//! shows where frequencies coincide.

pub mod lines;

use ratatui::buffer::Buffer;

use crate::sheet::Sheet;
use crate::sheet::number::{frequency_unit, per_frequency, speed_unit};
use crate::sheet::table::{Table, TableCell};
use crate::tui::app::App;
use crate::tui::axis::{ChartAxis, readable, round_out};
use crate::tui::theme::Role;
use crate::tui::views::ViewId;
use crate::tui::views::chart::{Chart, Curve, curves, legend};
use crate::tui::views::panel::{ViewArea, ViewPanel, entry, not_yet, read_before, title};
use crate::tui::views::spectrum::lines::Spectrum;
use rubscope_solver::study::figures::{Figure, Panel, Quantity, Series, Style};

/// Ends of the amplitude axis, as powers of ten of a metre.
const DECADES: (f64, f64) = (-10.0, -3.0);
/// Number of parts of the speed axis in which the Campbell lines are drawn.
const SPEEDS: u32 = 60;
/// What the spectrum is computed from.
const NOTE: &str = "whole run, Hann window";

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
        let title = &app.scene.title;
        sheet.picture(move || Figure::new(title.clone(), NOTE, vec![panel(app, spectrum)]));
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

/// Returns the spectrum as a panel, over the range of the chart.
fn panel(app: &App, spectrum: &Spectrum) -> Panel {
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
    Panel::new("", x, Quantity::log("u_m", "amplitude [m]"), series.collect())
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
    let spectrum = app.results().found.spectrum.as_deref();
    let panel = spectrum.map(|spectrum| panel(app, spectrum));
    let mut entries = vec![(format!("m by {}", frequency_unit()), quiet)];
    entries.extend(panel.iter().flat_map(|panel| legend(look, panel)).flatten());
    let read = cursor.and_then(|frequency| reading(spectrum?, frequency));
    let name = read_before(look, &mut entries, read, "spectrum");
    entries.push((NOTE.to_string(), quiet));
    let inside = title(app, buffer, at, name, &entries);
    let Some(panel) = panel else { return not_yet(app, buffer, inside) };
    let marks = lines(app, app.speed());
    let mut chart = Chart::new(x, ChartAxis::powers(DECADES.0, DECADES.1, None));
    (chart.marks, chart.read, chart.curves) = (&marks, cursor, curves(look, &panel));
    chart.draw(app, buffer, at, inside);
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
    let fastest =
        app.results().found.locked.as_ref().map_or(600.0, |curves| curves.speeds.range[1]);
    let top = app.machine.nu(fastest).max(1.5 * app.machine.omega_c);
    // The speed axis covers the current direction of rotation.
    let sense = if app.speed() < 0.0 { -1.0 } else { 1.0 };
    let x = ChartAxis::speeds((sense * fastest).min(0.0), (sense * fastest).max(0.0));
    let mut chart = Chart::new(x, ChartAxis::frequencies(0.0, top));
    (chart.levels, chart.now) =
        (vec![(app.machine.omega_c, "ω_c", Role::Quiet)], Some(app.speed()));
    for (pen, place) in [(look.first(), 0), (look.second(), 2), (look.second(), 3)] {
        let speeds = (0..=SPEEDS).map(move |k| x.at(f64::from(k) / f64::from(SPEEDS)));
        let points = speeds.map(move |speed| (speed, lines(app, speed)[place].0));
        chart.curves.push((pen, Curve::Line(Box::new(points))));
    }
    let meets = app.machine.coincidence_speeds().into_iter().chain(app.machine.critical_speed());
    let contact = look.style(Role::Contact);
    chart.points = meets.map(|speed| (sense * speed, app.machine.omega_c, meet, contact)).collect();
    chart.draw(app, buffer, at, inside);
}
