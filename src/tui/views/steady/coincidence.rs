//! View 9: the effect of a coincidence on blades in contact. It shows the amplitude of the limit
//! cycle over speed, both coincidence speeds, the running motion, and the growth rate of a small
//! wave.

use ratatui::buffer::Buffer;

use super::SpeedChart;
use super::coincidence_curves::{CoincidenceCurves, points};
use crate::sheet::Sheet;
use crate::sheet::hbm::coincidence::add_points;
use crate::sheet::number::{frequency_unit, per_frequency, per_speed, speed_unit};
use crate::tui::app::{App, Cursor};
use crate::tui::axis::{ChartAxis, readable};
use crate::tui::theme::Role;
use crate::tui::views::panel::{ViewArea, ViewPanel, message, not_yet};
use rubscope_solver::motion::ActiveSet;
use rubscope_solver::scene::ModelSize;

/// Names and units of the panels of the sheet.
const PANELS: [[&str; 2]; 2] = [["coincidence", "rad"], ["growth of rest", "1/s"]];

/// The view of blade amplitude and growth rate over speed.
pub struct CoincidenceView;

impl ViewPanel for CoincidenceView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let Some(curves) = curves(app) else {
            let why = match app.results().found.coincidence {
                Some(_) => ("this wave has no coincidence", Role::Quiet),
                None => not_yet(app),
            };
            return message(app, buffer, at, (PANELS[0][0], &[]), why);
        };
        let grows = curves.points.iter().any(|point| point.growth_1_s.is_some());
        let (first, second) = if grows { at.pair(40) } else { (at, None) };
        let first = second.map_or(first, |second| first.above(second.area));
        let areas = std::iter::once(first).chain(second);
        for ((panel, at), [name, unit]) in curves.speeds.panels.iter().zip(areas).zip(PANELS) {
            let (mut now, mut text, mut beyond) = (None, None, Vec::new());
            if unit == "rad" {
                now = amplitude(app).map(|angle| (angle, readable(angle, unit)));
                text = Some(match curves.speeds.read(app) {
                    Some(speed) => (reading(app, speed), Role::Focus),
                    None => (sentence(app, curves), Role::Quiet),
                });
                let unbounded = curves.points.iter().filter(|point| !point.bounded);
                beyond = unbounded.map(|point| point.speed_rad_s.abs()).collect();
            }
            let values = panel.series.iter().flat_map(|series| &series.points).map(|at| at.1);
            let y = ChartAxis::around(values.chain(now.iter().map(|now| now.0)));
            let y = if y.high > y.low { y } else { ChartAxis::scaled(0.0, 1e-4) };
            let now = Some(now.as_slice()).filter(|now| !now.is_empty());
            let chart = SpeedChart { name, y, unit, now, beyond, text, ..Default::default() };
            curves.speeds.draw(app, buffer, at, panel, chart);
        }
    }

    fn here(&self, app: &App) -> Cursor {
        curves(app).map_or(Cursor { across: 0.5, up: 0.5 }, |curves| curves.speeds.here(app))
    }

    fn sheet<'a>(&self, app: &'a App) -> Option<Sheet<'a>> {
        let mut sheet = Sheet::new("hbm", 3, app.view_command(), &app.scene);
        add_points(&curves(app)?.points, "", &mut sheet);
        Some(sheet)
    }
}

fn curves(app: &App) -> Option<&CoincidenceCurves> {
    app.results().found.coincidence.as_deref()?.as_ref()
}

/// Summarises the curves in one sentence.
fn sentence(app: &App, curves: &CoincidenceCurves) -> String {
    let waves = curves.points.iter().filter(|point| point.blade_amplitude_rad.is_some());
    let mut speeds = waves.map(|point| point.speed_rad_s.abs());
    let ends = speeds.next().map(|first| (first, speeds.next_back().unwrap_or(first)));
    let between = |(from, to): (f64, f64)| {
        format!("{:.0} to {:.0} {}", per_speed(from), per_speed(to), speed_unit())
    };
    let what = match ends {
        _ if app.scene.solver.model == ModelSize::Rigid => {
            "rigid blades have no coincidence: choose another model".to_string()
        }
        None if app.machine.has_other_diameters() => {
            "disk and casing have different nodal diameters: no common wave".into()
        }
        Some(ends) if app.is_pressed() => format!("this wave grows from rest: {}", between(ends)),
        Some((from, to))
            if curves.points.last().is_some_and(|last| last.speed_rad_s.abs() <= to) =>
        {
            format!("a whirl can last from {:.0} {} on", per_speed(from), speed_unit())
        }
        Some(ends) => format!("a whirl can last: {}", between(ends)),
        None if app.machine.radial_coupling == 0.0 => {
            "κ = 0: tips do not move outward, so no coincidence drives them".into()
        }
        None if app.is_pressed() => "rest is stable at every speed shown".into(),
        None => "no steady whirl is found at the speeds shown".into(),
    };
    app.tuned_note().map_or(what.clone(), |note| format!("{what} ({note})"))
}

/// Describes the wave at one speed, solved for that speed.
fn reading(app: &App, speed: f64) -> String {
    let speed = speed.copysign(app.speed());
    let at = format!("at {}: ", readable(speed, "rad/s"));
    let Some(point) = points(&app.scene, &[speed]).first().copied() else {
        return at + "no common wave";
    };
    let named = [
        ("|a|", point.blade_amplitude_rad, "rad"),
        ("|z|", point.casing_amplitude_m, "m"),
        ("ω", point.omega_rad_s.map(per_frequency), frequency_unit()),
        ("growth", point.growth_1_s, "1/s"),
    ];
    let named = named
        .iter()
        .filter_map(|(name, value, unit)| Some(format!("{name} {}", readable((*value)?, unit))));
    let mut parts: Vec<String> = named.collect();
    if !point.bounded {
        parts.push("grows without bound".into());
    }
    if point.blade_amplitude_rad.is_none() && point.bounded {
        parts.push("no wave lasts".into());
    }
    at + &parts.join(", ")
}

/// Returns the blade amplitude of the running motion \[rad\]; `None` without contact, and with
/// rigid blades.
fn amplitude(app: &App) -> Option<f64> {
    let moment = app.run.latest.moment.as_ref()?;
    let [a_c, a_s] = moment.state.alpha;
    let bends = app.scene.solver.model != ModelSize::Rigid;
    let touches = moment.active_set != ActiveSet::Nothing;
    Some(a_c.hypot(a_s)).filter(|a| a.is_finite() && bends && touches)
}
