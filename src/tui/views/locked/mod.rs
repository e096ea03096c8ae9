//! View 3: the multipliers of the locked motion over speed, with threshold speeds, the current
//! speed, and the forces of the running motion. If there is room, blade angles and amplitudes
//! follow below over the same speeds (the paper's Fig. 10).

pub mod curves;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};

use crate::report::Sheet;
use crate::report::hbm::locked::add_points;
use crate::report::number::speed_unit;
use crate::tui::app::layout::LEAST_ROWS;
use crate::tui::app::reading::STEP;
use crate::tui::app::{App, Cursor};
use crate::tui::axis::{ChartAxis, readable};
use crate::tui::plot::Plot;
use crate::tui::raster::Pen;
use crate::tui::text::{print, whole_parts};
use crate::tui::theme::Role;
use crate::tui::views::locked::curves::LockedCurves;
use crate::tui::views::panel::{
    ViewArea, ViewPanel, dots, entry, lines_above, name_speeds, title, uprights,
};
use rubscope_solver::harmonic::{Form, LockedPoint, Sweep, lock_windows, locked_motion};
use rubscope_solver::motion::{ActiveSet, Verdict};

/// Height from which the large chart also shows the undamped curve of the paper.
const ROOMY: u16 = 14;
/// Width from which the title names the motion of the multipliers and gives their present values. A
/// narrower chart prints the values at their points \[columns\].
const NAMED_FROM: u16 = 46;
/// Largest number of rows for the values at the cursor.
const READ_ROWS: usize = 3;

/// The view of the locked motion over speed.
pub struct LockedView;

impl ViewPanel for LockedView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let curves = app.results().found.locked.as_deref();
        let locks = curves.filter(|curves| curves.damped.is_some());
        let below: &[Chart] = match at.area.height / LEAST_ROWS {
            3.. => &[ANGLES, AMPLITUDES],
            2 => &[ANGLES],
            _ => &[],
        };
        let Some(curves) = locks else { return multipliers(app, buffer, at) };
        let lower = at.area.height * 2 / (3 + 2 * u16::try_from(below.len()).unwrap_or(0));
        let mut rows = vec![Constraint::Min(1)];
        rows.extend(below.iter().map(|_| Constraint::Length(lower.max(LEAST_ROWS))));
        let areas = Layout::vertical(rows).split(at.area);
        let mut areas = areas.iter().map(|area| ViewArea { area: *area, ..at });
        if let Some(first) = areas.next() {
            multipliers(app, buffer, first);
        }
        for (chart, at) in below.iter().zip(areas) {
            chart.draw(app, curves, buffer, at);
        }
    }

    /// Puts the cursor at the current speed.
    fn here(&self, app: &App) -> Cursor {
        let fastest = app.results().found.locked.as_ref().map_or(1.0, |curves| curves.fastest);
        Cursor { across: (app.speed().abs() / fastest).clamp(0.0, 1.0), up: 0.5 }
    }

    fn text(&self, app: &App) -> String {
        reading(app, app.speed().abs())
    }

    fn sheet<'a>(&self, app: &'a App) -> Option<Sheet<'a>> {
        let damped = app.results().found.locked.as_ref()?.damped.as_ref()?;
        let mut sheet = Sheet::new("hbm", 3, app.view_command(), &app.scene);
        add_points(&damped.points, &mut sheet);
        Some(sheet)
    }
}

/// Draws the multipliers.
fn multipliers(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    let curves = app.results().found.locked.as_deref();
    let roomy = at.large && at.area.height >= ROOMY;
    // Without damping, equal tips have equal multipliers: one curve is enough.
    let uneven = app.machine.has_unequal_tips();
    let pair = uneven || curves.is_some_and(|curves| curves.undamped.is_some());
    let point = look.either('◆', '@');
    let prefix = curves.and_then(|curves| Some(force_axis(curves, curves.damped.as_ref()?)));
    let prefix = prefix.map_or("", |y| y.scale.prefix);
    let mut legend = vec![(format!("{prefix}N over {}", speed_unit()), quiet)];
    let corner = curves.and_then(|curves| Some(curves.damped.as_ref()?.corner.sides()));
    let named = |name: &str, place: usize| {
        let side = corner.filter(|_| uneven).map(|sides| [sides[place]].into_iter());
        side.map_or(name.into(), |side| format!("{name} {}", app.blades_of(side)))
    };
    legend.push(entry(look, &look.first(), &named(if pair { "λ_a" } else { "λ" }, 0)));
    if pair {
        legend.push(entry(look, &look.second(), &named("λ_b", 1)));
    }
    let points = running(app);
    let forces: Vec<String> = points.iter().take(2).map(|force| short(*force)).collect();
    let now = if points.is_empty() { "no contact".to_string() } else { forces.join(" ") };
    let going_round = Pen { style: look.style(Role::Trouble), sign: 'w', dashed: true };
    if curves.is_some_and(|curves| !curves.whirl.is_empty()) {
        legend.push(entry(look, &going_round, "whirl"));
    }
    legend.push((format!("{point} now {now}"), look.style(Role::Contact)));
    legend.push(("below 0 pushes".into(), quiet));
    let round = app.machine.out_of_round() != 0.0;
    let of = [(app.has_lining(), "of a rigid casing"), (round, "of a round casing")];
    legend.extend(of.into_iter().filter(|of| of.0).map(|of| (of.1.into(), quiet)));
    legend.extend(app.tuned_note().map(|note| (note.into(), quiet)));
    if pair && roomy {
        legend.push(dots(look, "undamped"));
    }
    if app.speed() < 0.0 {
        legend.push(("over |Ω|, turning backwards".into(), quiet));
    }
    let narrow = at.area.width < NAMED_FROM;
    let name = if narrow { "λ(Ω)" } else { "locked λ(Ω)" };
    let inside = title(app, buffer, at, name, &legend);
    let Some(curves) = curves else { return };
    let Some(damped) = &curves.damped else {
        let text = if app.is_pressed() {
            "all blades rub at rest: nothing locks; view 9 shows what grows"
        } else if app.machine.has_other_diameters() {
            "the disk has other diameters than the casing: no pair of blades locks"
        } else if uneven {
            "no lock speed is known for these tips; a run shows a lock"
        } else {
            "no corner between two blade groups: this wave never locks"
        };
        print(buffer, inside, 1, text, quiet);
        return;
    };
    let inside = if at.large { read(app, curves, buffer, inside) } else { inside };
    // The scale follows the curves, because the mean force over an impact can be far outside.
    let y = force_axis(curves, damped).evened(inside, look);
    let x = ChartAxis::speeds(0.0, curves.fastest);
    let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
    at.note(app, plot.inner);
    plot.level(0.0, look.either('┈', '.'), quiet);
    uprights(&mut plot, app, &curves.marks, cursor_speed(app, curves));
    plot.curve(curves.whirl.iter().copied(), &going_round);
    if let Some(undamped) = curves.undamped.as_ref().filter(|_| roomy) {
        let points = over_speed(undamped, |point| point.multipliers_n[0]);
        plot.dotted(points, x.low, 1.0, &look.quiet());
    }
    if pair {
        plot.curve(over_speed(damped, |point| point.multipliers_n[1]), &look.second());
    }
    plot.curve(over_speed(damped, |point| point.multipliers_n[0]), &look.first());
    plot.ink();
    for force in points {
        let (sign, shown) = if force < y.low {
            (look.either('▼', 'v'), y.low)
        } else if force > y.high {
            (look.either('▲', '^'), y.high)
        } else {
            (point, force)
        };
        let style = look.style(Role::Contact);
        plot.point(app.speed().abs(), shown, sign, style);
        if let Some(row) = plot.row(shown).filter(|_| narrow) {
            plot.free_note(app.speed().abs(), row, &short(force), style);
        }
    }
    name_speeds(&mut plot, &curves.marks, app);
}

/// Returns the force axis, scaled to locks and whirls.
fn force_axis(curves: &LockedCurves, damped: &Sweep) -> ChartAxis {
    let points = damped.points.iter().filter(|point| curves.scales(point.speed_rad_s));
    let whirl = curves.whirl.iter().filter(|(speed, _)| curves.scales(*speed));
    let locks = points.flat_map(|point| point.multipliers_n);
    ChartAxis::around(locks.chain(whirl.map(|(_, push)| *push)))
}

/// Prints the values at the cursor above the chart; returns the rest of the area.
fn read(app: &App, curves: &LockedCurves, buffer: &mut Buffer, inside: Rect) -> Rect {
    let look = &app.appearance;
    let Some(speed) = cursor_speed(app, curves) else { return inside };
    let width = usize::from(inside.width).saturating_sub(1);
    // The chart keeps at least half of the rows.
    let most = READ_ROWS.min(usize::from(inside.height / 4)).max(1);
    let lines = whole_parts(&look.spell(&reading(app, speed)), width, most);
    lines_above(app, buffer, inside, &lines, Role::Focus)
}

/// Returns a quantity of the locked motion over the magnitude of the speed.
fn over_speed(sweep: &Sweep, of: impl Fn(&LockedPoint) -> f64) -> impl Iterator<Item = (f64, f64)> {
    sweep.points.iter().map(move |point| (point.speed_rad_s.abs(), of(point)))
}

/// Returns the mean multipliers of the running motion \[N\]; negative pushes. Empty without
/// contact.
fn running(app: &App) -> Vec<f64> {
    let Some(moment) = &app.run.latest.moment else { return Vec::new() };
    if moment.active_set == ActiveSet::Nothing {
        return Vec::new();
    }
    moment.multipliers.iter().map(|(_, force)| *force).filter(|force| force.is_finite()).collect()
}

/// Formats a force in newtons without decimals, from 10 kN on in thousands: `12k`.
fn short(force: f64) -> String {
    if force.abs() < 1e4 { format!("{force:.0}") } else { format!("{:.0}k", force / 1e3) }
}

/// Symbol and value of a quantity of the locked motion.
type Quantity = (&'static str, fn(&LockedPoint) -> f64);

/// A chart of quantities over speed.
pub struct Chart {
    name: &'static str,
    unit: &'static str,
    quantities: &'static [Quantity],
    /// Remark in the legend about quantities that are not drawn.
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

impl Chart {
    /// Draws the chart; nothing if there is no locked motion.
    pub fn draw(&self, app: &App, curves: &LockedCurves, buffer: &mut Buffer, at: ViewArea) {
        let look = &app.appearance;
        let quiet = look.style(Role::Quiet);
        let Some(damped) = &curves.damped else { return };
        let points = &damped.points;
        let scaled = || points.iter().filter(|point| curves.scales(point.speed_rad_s));
        let values = self.quantities.iter().flat_map(|(_, of)| scaled().map(of));
        let (x, y) = (ChartAxis::speeds(0.0, curves.fastest), ChartAxis::around(values));
        let pens: [Pen; 2] = [look.first(), look.second()];
        let named = pens.iter().zip(self.quantities);
        let mut legend: Vec<_> = named.map(|(pen, (name, _))| entry(look, pen, name)).collect();
        let third = self.quantities.get(2);
        legend.extend(third.map(|(name, _)| dots(look, name)));
        legend.push((format!("{}{} over {}", y.scale.prefix, self.unit, speed_unit()), quiet));
        legend.push((self.note.to_string(), quiet));
        let inside = title(app, buffer, at, self.name, &legend);
        let y = y.evened(inside, look);
        let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
        at.note(app, plot.inner);
        plot.level(0.0, look.either('┈', '.'), quiet);
        uprights(&mut plot, app, &curves.marks, cursor_speed(app, curves));
        if let Some((_, of)) = third {
            plot.dotted(over_speed(damped, of), x.low, 1.0, &look.quiet());
        }
        for (pen, (_, of)) in pens.iter().zip(self.quantities).rev() {
            plot.curve(over_speed(damped, of), pen);
        }
        plot.ink();
    }
}

/// Returns the speed under the cursor, as a magnitude \[rad/s\]; `None` without a cursor, and if
/// this is not the large view.
pub fn cursor_speed(app: &App, curves: &LockedCurves) -> Option<f64> {
    let here = app.view() == crate::tui::views::ViewId::Locked;
    app.reading.cursor.filter(|_| here).map(|cursor| cursor.across * curves.fastest)
}

/// Describes the locked motion at one speed, solved for that speed.
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
    // With a lining the forces are different; only the speed range of the lock is known here.
    let lining = app.has_lining();
    let on_lining = || lock_windows(&app.machine, speed).iter().any(|lock| lock.has(speed.abs()));
    let can_last = if lining { on_lining() } else { point.admissible && point.stable };
    let holds = match (a > 0.0 || b > 0.0, point.admissible, point.stable) {
        _ if lining && can_last => "for a rigid casing; on the lining a lock can last",
        _ if lining => "for a rigid casing; the lining holds no lock here",
        (true, ..) if !app.machine.contact_can_pull() => "one pulls: no lock",
        (true, ..) => "one pulls: only an adhesive lock",
        (_, true, true) => "both push: a lock can last",
        (_, true, false) => "both push, but it is unstable",
        _ => "another blade would touch",
    };
    let parts = [
        value("λ_a", a, "N"),
        value("λ_b", b, "N"),
        holds.to_string(),
        not_this_run(app, can_last).unwrap_or_default(),
        format!("|u| {ratio:.4} g0"),
        value("α_a", turn_a, "rad"),
        value("α_b", turn_b, "rad"),
        value("u_cc", point.u_cc_m, "m"),
        value("u_cs", point.u_cs_m, "m"),
    ];
    let parts: Vec<String> = parts.into_iter().filter(|part| !part.is_empty()).collect();
    at + &parts.join(", ")
}

/// Notes that the run at this speed does not reach the lock, with its verdict. `None` if it does,
/// if no lock can last here, if the cursor is at another speed, and without a verdict to show.
fn not_this_run(app: &App, can_last: bool) -> Option<String> {
    let (cursor, here) = (app.reading.cursor?, app.panel().here(app));
    let run = app.full_run().filter(|_| can_last && !app.is_asked())?;
    let elsewhere = (cursor.across - here.across).abs() > 0.5 * STEP;
    let locks = matches!(run.verdict, Verdict::Locked | Verdict::Adhesive);
    (!elsewhere && !locks).then(|| format!("but this run: {}", run.verdict.as_ref().to_uppercase()))
}
