//! View 3: the multipliers of the locked motion over speed, with threshold speeds, the current
//! speed, and the forces of the running motion. If there is room, blade angles and amplitudes
//! follow below over the same speeds (the paper's Fig. 10).

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout};

use super::locked_curves::{LockedCurves, UNDAMPED};
use super::{NAMED_FROM, SpeedChart, present};
use crate::sheet::Sheet;
use crate::sheet::hbm::locked::add_points;
use crate::sheet::number::speed_unit;
use crate::tui::app::layout::LEAST_ROWS;
use crate::tui::app::reading::STEP;
use crate::tui::app::{App, Cursor};
use crate::tui::axis::{ChartAxis, readable};
use crate::tui::theme::Role;
use crate::tui::views::panel::{ViewArea, ViewPanel, entry, message, not_yet};
use rubscope_solver::harmonic::{Form, lock_windows, locked_motion};
use rubscope_solver::motion::{ActiveSet, Verdict};
use rubscope_solver::study::figures::Panel;

/// Height from which the large chart also shows the undamped curve of the paper.
const ROOMY: u16 = 14;
/// Name of the chart of the multipliers.
const NAME: &str = "locked λ(Ω)";
/// Names, units and remarks of the charts; the lower two need room.
const CHARTS: [[&str; 3]; 3] = [
    [NAME, "N", "below 0 pushes"],
    ["locked α(Ω)", "rad", "one blade of each group"],
    ["locked u(Ω)", "m", "u_ss = u_cc, u_sc = -u_cs"],
];

/// The view of the locked motion over speed.
pub struct LockedView;

impl ViewPanel for LockedView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        let curves = app.results().found.locked.as_deref();
        let Some(curves) = curves.filter(|curves| curves.damped.is_some()) else {
            return nothing(app, buffer, at);
        };
        let below = (at.area.height / LEAST_ROWS).saturating_sub(1).min(CHARTS.len() as u16 - 1);
        let lower = (at.area.height * 2 / (3 + 2 * below)).max(LEAST_ROWS);
        let rows = std::iter::once(Constraint::Min(1));
        let rows = rows.chain((0..below).map(|_| Constraint::Length(lower)));
        let areas = Layout::vertical(rows).split(at.area);
        let placed = areas.iter().enumerate().map(|(place, area)| {
            let at = ViewArea { area: *area, ..at };
            areas.get(place + 1).map_or(at, |lower| at.above(*lower))
        });
        let now = running(app);
        let charts = curves.speeds.panels.iter().zip(placed).zip(CHARTS);
        for ((panel, at), [name, unit, note]) in charts {
            let (y, mut panel) = (scale(curves, panel), panel.clone());
            let mut chart = SpeedChart { name, y, unit, notes: vec![note], ..Default::default() };
            if name == NAME {
                let roomy = at.large && at.area.height >= ROOMY;
                panel.series.retain(|series| roomy || series.style != UNDAMPED);
                chart.name = if at.area.width < NAMED_FROM { "λ(Ω)" } else { NAME };
                chart.now = Some(&now);
                chart.notes.extend(app.has_lining().then_some("of a rigid casing"));
                let round = (app.machine.out_of_round() != 0.0).then_some("of a round casing");
                chart.notes.extend(round.into_iter().chain(app.tuned_note()));
                let read = curves.speeds.read(app).filter(|_| at.large);
                chart.text = read.map(|speed| (reading(app, speed), Role::Focus));
            }
            curves.speeds.draw(app, buffer, at, &panel, chart);
        }
    }

    fn here(&self, app: &App) -> Cursor {
        let curves = app.results().found.locked.as_deref();
        curves.map_or(Cursor { across: 0.5, up: 0.5 }, |curves| curves.speeds.here(app))
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

/// Returns the axis of a panel. It follows the damped curves, because the mean force over an impact
/// can be far outside.
fn scale(curves: &LockedCurves, panel: &Panel) -> ChartAxis {
    let series = panel.series.iter().filter(|series| series.style != UNDAMPED);
    let points = series.flat_map(|series| &series.points);
    ChartAxis::around(points.filter(|at| curves.scales(at.0)).map(|at| at.1))
}

/// Says why there is no curve.
fn nothing(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let unit = (format!("N over {}", speed_unit()), look.style(Role::Quiet));
    let legend = [unit, entry(look, &look.first(), "λ"), present(app, &running(app))];
    let text = if app.results().found.locked.is_none() {
        not_yet(app).0
    } else if app.is_pressed() {
        "all blades rub at rest: nothing locks; view 9 shows what grows"
    } else if app.machine.has_other_diameters() {
        "disk and casing have different nodal diameters: no pair of blades locks"
    } else if app.machine.has_unequal_tips() {
        "no lock speed is known for these tips; a run shows a lock"
    } else {
        "no corner between two blade groups: this wave never locks"
    };
    message(app, buffer, at, (NAME, &legend), (text, Role::Quiet));
}

/// Returns the mean multipliers of the running motion \[N\] with their text; negative pushes. Empty
/// without contact.
fn running(app: &App) -> Vec<(f64, String)> {
    let Some(moment) = &app.run.latest.moment else { return Vec::new() };
    if moment.active_set == ActiveSet::Nothing {
        return Vec::new();
    }
    let forces = moment.multipliers.iter().map(|(_, force)| *force);
    forces.filter(|force| force.is_finite()).map(|force| (force, short(force))).collect()
}

/// Formats a force in newtons without decimals, from 10 kN on in thousands: `12k`.
fn short(force: f64) -> String {
    if force.abs() < 1e4 { format!("{force:.0}") } else { format!("{:.0}k", force / 1e3) }
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
    let locks = matches!(run.facts.verdict, Verdict::Locked | Verdict::Adhesive);
    (!elsewhere && !locks)
        .then(|| format!("but this run: {}", run.facts.verdict.as_ref().to_uppercase()))
}
