//! View 4: the bladed disk as a wheel, in the frame of the blades and inside the casing, with gaps
//! magnified by a stated factor. If there is room, the casing wave is also drawn as a point with
//! its trail, inside the polygon of the phase groups.

use std::f64::consts::TAU;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::sheet::Sheet;
use crate::tui::app::{App, Cursor};
use crate::tui::axis::{ChartAxis, instant, readable};
use crate::tui::film::{in_blade_frame, rim_point};
use crate::tui::history::Channel;
use crate::tui::raster::Pen;
use crate::tui::theme::Role;
use crate::tui::views::ViewId;
use crate::tui::views::chart::{Chart, Curve};
use crate::tui::views::panel::{ViewArea, ViewPanel};
use crate::tui::views::response::ResponseView;
use rubscope_solver::model::SideLeft;

/// Width from which the polygon is drawn beside the wheel, if the view is alone on the screen.
const BOTH_FROM: u16 = 76;

/// Length of the trail, and of its coarsest bin, in turns of the wave past the blades. More turns
/// would fill the disc, and the middle of a longer bin is not on the path.
const TRAIL: [f64; 2] = [30.0, 0.125];

/// The view of the wheel, and of the wave in the frame of the blades.
pub struct FrameView;

impl ViewPanel for FrameView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        if at.area.width >= BOTH_FROM && app.is_alone() {
            let [left, right] = at.columns();
            wheel(app, buffer, ViewArea { large: false, ..left });
            polygon(app, buffer, right);
        } else {
            wheel(app, buffer, at);
        }
    }

    /// Returns the sheet of the response view, which includes the trail (`z`).
    fn sheet<'a>(&self, app: &'a App) -> Option<Sheet<'a>> {
        ResponseView.sheet(app)
    }
}

/// Returns axes with equal scales that include a square of half side `reach`; cells are twice as
/// high as wide.
fn square(area: Rect, reach: f64) -> (ChartAxis, ChartAxis) {
    // The labels need about six columns and two rows.
    let (width, height) = (
        f64::from(area.width.saturating_sub(6).max(1)),
        2.0 * f64::from(area.height.saturating_sub(2).max(1)),
    );
    let reach = reach / width.min(height);
    let axis = |length| ChartAxis::scaled(-reach * length, reach * length);
    (axis(width), axis(height))
}

/// Describes the position under the cursor: the nearest blade group and its gap, for rigid blades.
/// `None` without a cursor in this view.
fn reading(app: &App, x: ChartAxis, y: ChartAxis, apothems: &[f64]) -> Option<String> {
    let cursor = app.cursor_in(ViewId::Frame)?;
    let (x, y) = (x.at(cursor.across), y.at(cursor.up));
    let polygon = &app.machine.polygon;
    let gaps = (0..).zip(apothems).map(|(side, apothem)| {
        let (c, s) = polygon.direction(side);
        (side, apothem + x * c + y * s)
    });
    let (side, gap) = gaps.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let to = if app.has_lining() && gap < 0.0 { "," } else { " to" };
    let (blade, gap) = (app.blades_of([side].into_iter()), app.gap_words(gap));
    Some(format!("{gap}{to} {blade} at {}, {}", readable(x, "m"), readable(y, "m")))
}

/// Returns the symbol of the point: the casing displacement `z`, or `w` relative to the tips.
fn named(app: &App) -> &'static str {
    let machine = &app.machine;
    match machine.radial_coupling == 0.0 {
        true => "z",
        false if machine.blade_diameters == machine.nodal_diameters => "w",
        // With different nodal diameters no single point represents all blades.
        false => "z, blades not bent",
    }
}

fn polygon(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let polygon = &app.machine.polygon;
    let (x, y) = square(at.area, app.usual_reach().max(app.run.ranges.rim.high));
    let point = look.either('●', 'O');
    let mut chart = Chart::new("polygon", x, y);
    chart.legend = vec![
        (format!("{}, {}m", named(app), x.scale.prefix), look.style(Role::Quiet)),
        (format!("{point} now"), look.style(Role::Focus)),
        (app.state_now(), look.style(Role::Contact)),
    ];
    let turned = app.shown().map_or(0.0, |moment| moment.angle);
    let sides = 0..polygon.sides;
    let apothems: Vec<f64> = sides.map(|side| app.machine.apothem_at(side, turned)).collect();
    let mut left = polygon.sides_left(&apothems);
    if left.is_empty() {
        // No position leaves every gap open, so each side is drawn where its own blade lifts off.
        let inside = if app.is_pressed() { "inside all rub" } else { "some rub everywhere" };
        chart.legend.insert(1, (inside.into(), look.style(Role::Text)));
        let whole = |(side, apothem): (u32, &f64)| {
            let half = polygon.half_side() * (apothem / polygon.clearance);
            SideLeft { side, next: side, reach: [-half, half] }
        };
        left = (0..).zip(&apothems).map(whole).collect();
    }
    chart.reading = reading(app, x, y, &apothems);
    let outline = Pen { dashed: false, ..look.quiet() };
    let touched = Pen { style: look.style(Role::Contact), sign: '#', dashed: false };
    let touching: Vec<u32> =
        app.touching_blades().into_iter().map(|blade| polygon.side_of_blade(blade)).collect();
    // An unbounded side is drawn up to the edge of the chart.
    let most = 20.0 * polygon.clearance.abs();
    let side = |SideLeft { side, reach, .. }: &SideLeft| {
        let (cos, sin) = polygon.direction(*side);
        let apothem = apothems.get(*side as usize).copied().unwrap_or(polygon.clearance);
        let end = |along: f64| (-apothem * cos - along * sin, -apothem * sin + along * cos);
        let ends = reach.map(|along| end(along.clamp(-most, most)));
        (
            if touching.contains(side) { touched } else { outline },
            Curve::Line(Box::new(ends.into_iter())),
        )
    };
    let turn = TAU / (app.machine.omega_c + app.machine.nu(app.speed().abs()));
    let [past, longest] = TRAIL.map(|turns| turns * turn);
    let past = app.record().iter().filter(|bin| {
        (app.now() - past..app.now()).contains(&bin.from) && bin.to - bin.from <= longest
    });
    let trail = past.map(|bin| (bin.middle(Channel::RimX), bin.middle(Channel::RimY)));
    chart.curves.push((look.first(), Curve::Line(Box::new(trail))));
    left.sort_by_key(|left| !touching.contains(&left.side));
    chart.curves.extend(left.iter().map(side));
    let cursor = app.cursor_in(ViewId::Frame).map(|at| (x.at(at.across), y.at(at.up), '+'));
    let now = app.shown().map(|moment| {
        let turned = app.machine.nodal_diameters * moment.angle;
        let [x, y] = rim_point(&app.machine, &moment.state, turned);
        (x, y, point)
    });
    let signs = [cursor, now].into_iter().flatten();
    chart.points = signs.map(|(x, y, sign)| (x, y, sign, look.style(Role::Focus))).collect();
    chart.draw(app, buffer, at);
}

/// Clearance at rest as drawn at the usual magnification, in radii of the wheel.
const CLEARANCE: f64 = 0.16;
/// Largest amplitude of the wave that fits the wheel at the usual magnification, in clearances.
const MOST: f64 = 1.2;
/// Radius of the inner ends of the blades, in radii of the wheel.
const HUB: f64 = 0.5;
/// Number of points of the casing outline.
const OUTLINE: u32 = 240;
/// Radii at which the numbers of touching blades may be printed, in radii of the wheel: within the
/// hub, where nothing is drawn.
const NUMBERS: [f64; 3] = [0.76 * HUB, 0.5 * HUB, 0.3 * HUB];
/// Largest number of blade numbers printed.
const MOST_NUMBERS: usize = 8;

/// Draws the disk and the casing as a wheel.
fn wheel(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let machine = &app.machine;
    let polygon = &machine.polygon;
    // A wave of more than `MOST` clearances, or tips and lobes that together take more than the
    // clearance, reduce the magnification, so that they stay on the chart.
    let most = (app.run.ranges.rim.high / MOST).max(machine.most_uneven());
    let unit = polygon.clearance.abs().max(most).max(f64::MIN_POSITIVE);
    let exaggeration = CLEARANCE * app.scene.bladed_disk.blade_length_m / unit;
    let reach = 1.0 + 2.1 * CLEARANCE;
    let (x, y) =
        square(Rect { width: at.area.width + 6, height: at.area.height + 1, ..at.area }, reach);
    let quiet = look.style(Role::Quiet);
    let touching = app.touching_blades();
    let contact = if touching.is_empty() { quiet } else { look.style(Role::Contact) };
    let mark = look.either('▲', '^');
    let mut chart = Chart { bare: true, ..Chart::new("wheel", x, y) };
    chart.legend = vec![
        (format!("{mark} {}", app.state_now()), contact),
        (format!("gaps x {exaggeration:.0}"), quiet),
    ];
    let cursor = app.cursor_in(ViewId::Frame).filter(|_| at.large);
    chart.reading = cursor.and_then(|cursor| blade_read(app, x, y, cursor));
    let Some(moment) = app.shown() else {
        chart.draw(app, buffer, at);
        return;
    };
    let z = in_blade_frame(moment.state.u, machine.nodal_diameters * moment.angle);
    let casing = (0..=OUTLINE).map(|k| {
        let angle = TAU * f64::from(k) / f64::from(OUTLINE);
        let (sin, cos) = (machine.nodal_diameters * angle).sin_cos();
        let shape = machine.shape_at(moment.angle + angle);
        let gap = (polygon.clearance + shape + z[0] * cos + z[1] * sin) / unit;
        let radius = 1.0 + CLEARANCE * gap;
        (radius * angle.cos(), radius * angle.sin())
    });
    // With radial coupling the tips move outward, and meet the casing there.
    let outward = machine.radial_coupling * machine.blade_length * CLEARANCE / unit;
    let angle_of = |blade: u32| TAU * f64::from(blade - 1) / f64::from(polygon.blades);
    let tip = |blade: u32| {
        let (sin, cos) = angle_of(blade).sin_cos();
        let (b_sin, b_cos) = (machine.blade_diameters * angle_of(blade)).sin_cos();
        let [a_c, a_s] = moment.state.alpha;
        let longer = CLEARANCE * machine.longer(blade - 1) / unit;
        let radius = 1.0 + longer + outward * (a_c * b_cos + a_s * b_sin);
        (radius.max(HUB) * cos, radius.max(HUB) * sin)
    };
    let spoke = |blade: u32, pen: Pen| {
        let (sin, cos) = angle_of(blade).sin_cos();
        let ends = [(HUB * cos, HUB * sin), tip(blade)];
        (pen, Curve::Line(Box::new(ends.into_iter())))
    };
    let blades = Pen { style: look.style(Role::Text), sign: '.', dashed: false };
    let touched = Pen { style: look.style(Role::Contact), sign: '#', dashed: false };
    // Spokes closer than a cell would merge.
    let all = polygon.blades <= u32::from(at.area.width) * 2;
    chart.curves.extend(touching.iter().map(|blade| spoke(*blade, touched)));
    chart.curves.push((look.first(), Curve::Line(Box::new(casing))));
    let free = (1..=polygon.blades).filter(|blade| all && !touching.contains(blade));
    chart.curves.extend(free.map(|blade| spoke(blade, blades)));
    let sign = |(x, y): (f64, f64), sign, role| (x, y, sign, look.style(role));
    let marked = touching.iter().filter(|_| all);
    chart.points = marked.map(|blade| sign(tip(*blade), mark, Role::Contact)).collect();
    chart.points.extend(cursor.map(|at| sign((x.at(at.across), y.at(at.up)), '+', Role::Focus)));
    let Some(mut plot) = chart.draw(app, buffer, at) else { return };
    // If most blades touch, their numbers say nothing useful.
    let named = if 2 * touching.len() > polygon.blades as usize { &[][..] } else { &touching };
    for blade in named.iter().copied().take(MOST_NUMBERS) {
        let (sin, cos) = angle_of(blade).sin_cos();
        let (name, style) = (blade.to_string(), look.style(Role::Contact));
        _ = NUMBERS.into_iter().any(|part| plot.free_label((part * cos, part * sin), &name, style));
    }
}

/// Describes the blade nearest to the cursor: number, gap, and the time if the cursor has one.
fn blade_read(app: &App, x: ChartAxis, y: ChartAxis, cursor: Cursor) -> Option<String> {
    let moment = app.shown()?;
    let blades = app.machine.polygon.blades;
    let turn = y.at(cursor.up).atan2(x.at(cursor.across)).rem_euclid(TAU) / TAU;
    let blade = (turn * f64::from(blades)).round() as u32 % blades.max(1);
    let gap = app.gap_words(*moment.gaps.get(blade as usize)?);
    let at = app.reading.at_s.map(|_| format!(" at {}", instant(moment.state.t_s)));
    Some(format!("blade {}: {gap}{}", blade + 1, at.unwrap_or_default()))
}
