//! The charts of view 3 below the multipliers: blade angles and amplitudes of
//! the locked motion over the same speeds (the paper's Fig. 10), and the values
//! of all of them at one speed.

use ratatui::buffer::Buffer;

use super::curves::LockedCurves;
use crate::harmonic::{Form, LockedPoint, locked_motion};
use crate::motion::Verdict;
use crate::tui::app::{App, STEP};
use crate::tui::axis::{ChartAxis, nice_step, readable};
use crate::tui::plot::Plot;
use crate::tui::raster::Pen;
use crate::tui::theme::Role;
use crate::tui::views::panel::{ViewArea, dots, entry, title};

/// A quantity of the locked motion.
type Quantity = (&'static str, fn(&LockedPoint) -> f64);

/// One chart.
pub struct Chart {
    name: &'static str,
    unit: &'static str,
    quantities: &'static [Quantity],
    /// What is said about those that are not drawn.
    note: &'static str,
}

/// Angles of the blades that hold the wave.
pub const ANGLES: Chart = Chart {
    name: "locked α(Ω)",
    unit: "rad",
    quantities: &[("α_a", |p| p.alpha_rad[0]), ("α_b", |p| p.alpha_rad[1])],
    note: "one blade of each group",
};

/// Amplitudes of the casing.
pub const AMPLITUDES: Chart = Chart {
    name: "locked u(Ω)",
    unit: "m",
    quantities: &[("u_cc", |p| p.u_cc_m), ("u_cs", |p| p.u_cs_m), ("|u|", |p| p.amplitude_m)],
    note: "u_ss = u_cc, u_sc = -u_cs",
};

/// A range with round ends around values and zero.
pub fn range(values: impl Iterator<Item = f64>) -> ChartAxis {
    let (low, high) = values
        .filter(|value| value.is_finite())
        .fold((0.0_f64, 0.0_f64), |(a, b), v| (a.min(v), b.max(v)));
    let step = nice_step(high - low, 6).unwrap_or(1.0);
    ChartAxis::scaled((low / step).floor() * step, (high / step).ceil() * step)
}

impl Chart {
    /// Draws it.
    pub fn draw(&self, app: &App, curves: &LockedCurves, buffer: &mut Buffer, at: ViewArea) {
        let look = &app.appearance;
        let quiet = look.style(Role::Quiet);
        let Some(damped) = &curves.damped else { return };
        let points = &damped.points;
        let scaled = || points.iter().filter(|point| curves.scales(point.speed_rad_s));
        let values = self.quantities.iter().flat_map(|(_, of)| scaled().map(of));
        let (x, y) = (ChartAxis::plain(0.0, curves.fastest), range(values));
        let pens: [Pen; 2] = [look.first(), look.second()];
        let named = pens.iter().zip(self.quantities);
        let mut legend: Vec<_> = named.map(|(pen, (name, _))| entry(look, pen, name)).collect();
        let third = self.quantities.get(2);
        legend.extend(third.map(|(name, _)| dots(look, name)));
        legend.push((format!("{}{} over rad/s", y.scale.prefix, self.unit), quiet));
        legend.push((self.note.to_string(), quiet));
        let inside = title(app, buffer, at, self.name, &legend);
        let y = y.evened(inside, look);
        let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
        at.note(app, plot.inner);
        plot.level(0.0, look.either('┈', '.'), quiet);
        super::uprights(&mut plot, app, curves);
        if let Some((_, of)) = third {
            let curve = points.iter().map(|point| (point.speed_rad_s.abs(), of(point)));
            plot.dotted(curve, x.low, 1.0, &look.quiet());
        }
        for (pen, (_, of)) in pens.iter().zip(self.quantities).rev() {
            plot.curve(points.iter().map(|point| (point.speed_rad_s.abs(), of(point))), pen);
        }
        plot.ink();
    }
}

/// The speed under the reading cursor \[rad/s\].
pub fn cursor_speed(app: &App, curves: &LockedCurves) -> Option<f64> {
    let here = app.view() == crate::tui::views::ViewId::Locked;
    app.reading.cursor.filter(|_| here).map(|cursor| cursor.across * curves.fastest)
}

/// The locked motion at one speed, solved there, in words.
pub fn reading(app: &App, speed: f64) -> String {
    let speed = speed.copysign(app.speed());
    let at = format!("at {}: ", readable(speed, "rad/s"));
    let sweep = locked_motion(&app.machine, Form::Modal, true, None, &[speed]);
    let Some(point) = sweep.ok().and_then(|sweep| sweep.points.first().copied()) else {
        return at + "no locked motion";
    };
    let value = |name: &str, value: f64, unit: &str| format!("{name} {}", readable(value, unit));
    let ([a, b], [turn_a, turn_b]) = (point.multipliers_n, point.alpha_rad);
    let ratio = point.amplitude_m / app.machine.clearance();
    // The push of a lining is another one: only its window is known here.
    let lining = app.has_lining();
    let window = app.machine.lock_windows(speed).into_iter();
    let on_lining = || window.clone().any(|window| window.has(speed.abs()));
    let can_last = if lining { on_lining() } else { point.admissible && point.stable };
    let holds = match (a > 0.0 || b > 0.0, point.admissible, point.stable) {
        _ if lining && can_last => "of a rigid casing; on the lining a lock can last",
        _ if lining => "of a rigid casing; the lining holds no lock here",
        (true, ..) => "one pulls: only an adhesive lock",
        (_, true, true) => "both push: a lock can last",
        (_, true, false) => "both push, but it is unstable",
        _ => "another blade would touch",
    };
    let parts = [
        value("λ_a", a, "N"),
        value("λ_b", b, "N"),
        format!("|u| {ratio:.4} g0"),
        value("α_a", turn_a, "rad"),
        value("α_b", turn_b, "rad"),
        value("u_cc", point.u_cc_m, "m"),
        value("u_cs", point.u_cs_m, "m"),
        holds.to_string(),
        not_this_run(app, can_last).unwrap_or_default(),
    ];
    let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    at + &parts.join(", ")
}

/// That the run of this speed does not come to a lock that can last.
fn not_this_run(app: &App, can_last: bool) -> Option<String> {
    let (cursor, here) = (app.reading.cursor?, app.panel().here(app));
    let run = app.full_run().filter(|_| can_last && !app.is_asked())?;
    let elsewhere = (cursor.across - here.across).abs() > 0.5 * STEP;
    let locks = matches!(run.verdict, Verdict::Locked | Verdict::Adhesive);
    (!elsewhere && !locks).then(|| format!("but this run: {}", run.verdict.as_ref().to_uppercase()))
}
