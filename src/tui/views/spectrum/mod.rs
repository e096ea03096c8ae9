//! View 6: the spectrum of the casing motion at the end of the run, and the Campbell diagram, which
//! shows where frequencies coincide.

pub mod lines;

use ratatui::buffer::Buffer;

use crate::sheet::Sheet;
use crate::sheet::number::{frequency_unit, per_frequency, speed_unit};
use crate::sheet::table::{Table, TableCell};
use crate::tui::app::App;
use crate::tui::axis::{ChartAxis, readable};
use crate::tui::theme::Role;
use crate::tui::views::ViewId;
use crate::tui::views::chart::{Chart, Curve, curves, legend};
use crate::tui::views::panel::{ViewArea, ViewPanel, entry, message, not_yet};
use crate::tui::views::spectrum::lines::{DECADES, Spectrum};
use rubscope_solver::study::figures::{Figure, Panel, Quantity};

/// Number of parts of the speed axis in which the Campbell lines are drawn.
const SPEEDS: u32 = 60;

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
            [frequency, spectrum.cosine[place], spectrum.sine[place]].map(TableCell::from).into()
        });
        let mut sheet = Sheet::new("run", 1, app.view_command(), &app.scene);
        sheet.filed(None, table);
        sheet.picture(move || {
            let label = format!("frequency [{}]", frequency_unit()).into();
            let own = spectrum.panel.clone();
            let x = Quantity { label, factor: per_frequency(1.0), ..own.x };
            Figure::new(app.scene.title.clone(), &spectrum.note, vec![Panel { x, ..own }])
        });
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

fn amplitudes(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    let unit = (format!("m by {}", frequency_unit()), quiet);
    let Some(spectrum) = app.results().found.spectrum.as_deref() else {
        return message(app, buffer, at, ("spectrum", &[unit]), not_yet(app));
    };
    let x = ChartAxis::frequencies(0.0, spectrum.highest);
    let cursor = app.cursor_in(ViewId::Spectrum).map(|at| x.at(at.across));
    let marks = lines(app, app.speed());
    let mut chart = Chart::new("spectrum", x, ChartAxis::powers(DECADES.0, DECADES.1, None));
    chart.legend = vec![unit];
    chart.legend.extend(legend(look, &spectrum.panel).into_iter().flatten());
    chart.legend.push((spectrum.note.clone(), quiet));
    chart.reading = cursor.and_then(|frequency| reading(spectrum, frequency));
    (chart.marks, chart.read, chart.curves) = (&marks, cursor, curves(look, &spectrum.panel));
    chart.draw(app, buffer, at);
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
    let meet = look.either('◆', '@');
    let fastest =
        app.results().found.locked.as_ref().map_or(600.0, |curves| curves.speeds.range[1]);
    let top = app.machine.nu(fastest).max(1.5 * app.machine.omega_c);
    // The speed axis covers the current direction of rotation.
    let sense = if app.speed() < 0.0 { -1.0 } else { 1.0 };
    let x = ChartAxis::speeds((sense * fastest).min(0.0), (sense * fastest).max(0.0));
    let mut chart = Chart::new("Campbell", x, ChartAxis::frequencies(0.0, top));
    chart.legend = vec![
        entry(look, &look.first(), "n_d Ω"),
        entry(look, &look.second(), "n_d Ω±ω_bd"),
        (format!("{meet} meets ω_c"), look.style(Role::Contact)),
        (format!("{} by {}", frequency_unit(), speed_unit()), look.style(Role::Quiet)),
    ];
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
    chart.draw(app, buffer, at);
}
