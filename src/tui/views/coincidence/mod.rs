//! View 9: the effect of a coincidence on blades in contact. It shows the amplitude of the limit
//! cycle over speed, both coincidence speeds, the running motion, and the growth rate of a small
//! wave.

pub mod curves;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::report::Sheet;
use crate::report::hbm::coincidence::add_points;
use crate::report::number::{frequency_unit, per_frequency, per_speed, speed_unit};
use crate::tui::app::{App, Cursor};
use crate::tui::axis::{ChartAxis, readable};
use crate::tui::plot::Plot;
use crate::tui::text::{print, wrap};
use crate::tui::theme::Role;
use crate::tui::views::ViewId;
use crate::tui::views::coincidence::curves::{CoincidenceCurves, points};
use crate::tui::views::panel::{
    ViewArea, ViewPanel, entry, lines_above, name_speeds, not_yet, title, uprights,
};
use rubscope_solver::harmonic::CoincidencePoint;
use rubscope_solver::motion::ActiveSet;
use rubscope_solver::scene::ModelSize;

/// The view of blade amplitude and growth rate over speed.
pub struct CoincidenceView;

impl ViewPanel for CoincidenceView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let Some(found) = app.results().found.coincidence.as_deref() else {
            let inside = title(app, buffer, at, AMPLITUDE.name, &[]);
            return not_yet(app, buffer, inside);
        };
        let Some(curves) = found else {
            let inside = title(app, buffer, at, AMPLITUDE.name, &[]);
            let quiet = app.appearance.style(Role::Quiet);
            print(buffer, inside, 1, "this wave has no coincidence", quiet);
            return;
        };
        let grows = curves.points.iter().any(|point| point.growth_1_s.is_some());
        let (first, second) = if grows { at.pair(40) } else { (at, None) };
        chart(app, buffer, first, curves, &AMPLITUDE);
        if let Some(second) = second {
            chart(app, buffer, second, curves, &GROWTH);
        }
    }

    /// Puts the cursor at the current speed.
    fn here(&self, app: &App) -> Cursor {
        let curves = app.results().found.coincidence.as_deref().and_then(Option::as_ref);
        let across = curves
            .map_or(0.5, |curves| (app.speed().abs() - curves.from) / (curves.to - curves.from));
        Cursor { across: across.clamp(0.0, 1.0), up: 0.5 }
    }

    fn sheet<'a>(&self, app: &'a App) -> Option<Sheet<'a>> {
        let curves = app.results().found.coincidence.as_deref()?.as_ref()?;
        let mut sheet = Sheet::new("hbm", 3, app.view_command(), &app.scene);
        add_points(&curves.points, "", &mut sheet);
        Some(sheet)
    }
}

/// A quantity that is drawn over speed.
struct Quantity {
    name: &'static str,
    /// Symbol of the curve in the legend.
    curve: &'static str,
    unit: &'static str,
    /// Its value at a point; `None` leaves a gap in the curve.
    of: fn(&CoincidencePoint) -> Option<f64>,
}

const AMPLITUDE: Quantity = Quantity {
    name: "coincidence",
    curve: "|a|",
    unit: "rad",
    of: |point| point.blade_amplitude_rad,
};

const GROWTH: Quantity =
    Quantity { name: "growth of rest", curve: "growth", unit: "1/s", of: |point| point.growth_1_s };

fn chart(
    app: &App,
    buffer: &mut Buffer,
    at: ViewArea,
    curves: &CoincidenceCurves,
    what: &Quantity,
) {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    let large = what.unit == AMPLITUDE.unit;
    let values = || curves.points.iter().filter_map(what.of).filter(|value| value.is_finite());
    let now = now(app).filter(|_| large);
    let y = ChartAxis::around(values().chain(now));
    let y = if y.high > y.low { y } else { ChartAxis::scaled(0.0, 1e-4) };
    let x = ChartAxis::speeds(curves.from, curves.to);
    let read = app.cursor_in(ViewId::Coincidence).map(|at| x.at(at.across));
    let point = look.either('◆', '@');
    let named = format!("{}, {}{} over {}", what.curve, y.scale.prefix, what.unit, speed_unit());
    let mut legend = vec![entry(look, &look.first(), &named)];
    if let Some(now) = now {
        legend.push((format!("{point} {}", readable(now, "rad")), look.style(Role::Contact)));
    }
    if app.speed() < 0.0 {
        legend.push(("|Ω|, turning backwards".into(), quiet));
    }
    let inside = title(app, buffer, at, what.name, &legend);
    let told = match read.filter(|_| large) {
        Some(speed) => (reading(app, speed), Role::Focus),
        None if large => (sentence(app, curves), Role::Quiet),
        None => (String::new(), Role::Quiet),
    };
    let inside = tell(app, buffer, inside, &told.0, told.1);
    let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
    if large {
        at.note(app, plot.inner);
    }
    plot.level(0.0, look.either('┈', '.'), quiet);
    uprights(&mut plot, app, &curves.markers, read);
    let points = curves.points.iter();
    plot.curve(
        points.map(|point| (point.speed_rad_s.abs(), (what.of)(point).unwrap_or(f64::NAN))),
        &look.first(),
    );
    plot.ink();
    for point in curves.points.iter().filter(|point| large && !point.bounded) {
        let sign = look.either('▲', '^');
        plot.point(point.speed_rad_s.abs(), y.high, sign, look.style(Role::Trouble));
    }
    if let Some(now) = now {
        plot.point(app.speed().abs(), now, point, look.style(Role::Contact));
    }
    if large {
        name_speeds(&mut plot, &curves.markers, app);
    }
}

/// Prints a text above the chart if it is short enough; returns the rest of the area.
fn tell(app: &App, buffer: &mut Buffer, inside: Rect, text: &str, role: Role) -> Rect {
    let look = &app.appearance;
    let most = usize::from(inside.height / 5).clamp(1, 3);
    let lines = wrap(&look.spell(text), usize::from(inside.width).saturating_sub(1));
    if text.is_empty() || lines.len() > most {
        return inside;
    }
    lines_above(app, buffer, inside, &lines, role)
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
        None => "no whirl lasts at any speed shown".into(),
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
fn now(app: &App) -> Option<f64> {
    let moment = app.run.latest.moment.as_ref()?;
    let [a_c, a_s] = moment.state.alpha;
    let bends = app.scene.solver.model != ModelSize::Rigid;
    let touches = moment.active_set != ActiveSet::Nothing;
    Some(a_c.hypot(a_s)).filter(|a| a.is_finite() && bends && touches)
}
