//! View 2: the gap of every blade at one instant, over the fixed zero line of the casing, or
//! against time: a row for each blade, a column for each part of the page, and the smallest gap
//! as a shade, which needs no colour. Blades in contact have a mark and their number.

use ratatui::buffer::Buffer;

use crate::tui::app::{App, Cursor, cell_of};
use crate::tui::axis::{ChartAxis, instant};
use crate::tui::history::{Bin, Channel};
use crate::tui::plot::Plot;
use crate::tui::raster::Pen;
use crate::tui::theme::Role;
use crate::tui::views::ViewId;
use crate::tui::views::panel::{self, ViewArea, ViewPanel, csv, name_level, read_before, title};
use rubscope_solver::model::ContactPolygon;
use rubscope_solver::motion::ActiveSet;

/// The view.
pub struct GapsView;

impl ViewPanel for GapsView {
    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        if app.layout.heat { draw_heat(app, buffer, at) } else { draw(app, buffer, at) }
    }

    fn is_over_time(&self, app: &App) -> bool {
        app.layout.heat
    }

    fn grid(&self, app: &App) -> [u32; 2] {
        let blades = app.machine.polygon.blades;
        if app.layout.heat { [0, blades] } else { [blades, 0] }
    }

    fn here(&self, app: &App) -> Cursor {
        Cursor { across: if app.layout.heat { app.part_of_page() } else { 0.0 }, up: 1.0 }
    }

    fn csv(&self, app: &App) -> Result<String, String> {
        if app.layout.heat {
            return heat_csv(app);
        }
        let gaps = app.shown().map_or(&[][..], |moment| &moment.gaps);
        let rows = (1..).zip(gaps).map(|(blade, gap)| [f64::from(blade), *gap]);
        csv(&["blade", "gap_m"].map(String::from), rows)
    }
}

/// Draws the gaps of one instant.
fn draw(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    let contact = look.style(Role::Contact);
    let range = app.run.ranges.gaps;
    let y = ChartAxis::scaled(range.low, range.high);
    let count = app.machine.polygon.blades;
    let x = ChartAxis::plain(0.5, f64::from(count) + 0.5);
    let active_set = app.touching_blades();
    let mark = look.either('▲', '^');
    let shown = app.contact_shown();
    let style = if active_set.is_empty() { quiet } else { contact };
    let mut legend =
        vec![(format!("{}m by blade", y.scale.prefix), quiet), (format!("{mark} {shown}"), style)];
    if let Some(read) = reading(app) {
        legend.insert(0, (read, look.style(Role::Focus)));
    }
    let inside = title(app, buffer, at, "gaps", &legend);
    let y = y.evened(inside, look);
    let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
    at.note(app, plot.inner);
    plot.level(0.0, look.either('━', '='), look.style(Role::Text));
    plot.level(app.machine.clearance(), look.either('┈', '.'), quiet);
    let Some(moment) = app.shown() else { return };
    let gaps = || (1..=count).map(f64::from).zip(moment.gaps.iter().copied());
    // There are no values between blades: the line only joins the points.
    if app.is_still() || count > u32::from(plot.inner.width) {
        plot.curve(gaps(), &Pen { dashed: false, ..look.quiet() });
        plot.ink();
    }
    let room = u32::from(plot.inner.width);
    if count <= room {
        let sign =
            if 2 * count <= room { look.either('●', 'o') } else { look.either('•', 'o') };
        for (blade, gap) in gaps() {
            plot.point(blade, gap.clamp(range.low, range.high), sign, look.style(Role::First));
        }
    }
    if app.has_lining() {
        // What the level means must be said where it can be below the other.
        name_level(&mut plot, x, app.machine.clearance(), "g0", quiet);
    }
    let deep = |blade: u32| moment.gaps.get(blade.saturating_sub(1) as usize).copied();
    for blade in &active_set {
        // A rigid casing is touched at zero, a lining somewhere inside.
        let gap = deep(*blade).filter(|_| app.has_lining()).unwrap_or(0.0);
        plot.point(f64::from(*blade), gap.clamp(range.low, range.high), mark, contact);
    }
    label(&mut plot, &active_set, app);
    if let Some(cursor) = app.cursor_in(ViewId::Gaps) {
        let blade = cell_of(cursor.across, count) + 1;
        plot.upright(f64::from(blade), look.either('┊', ':'), look.style(Role::Focus));
    }
}

/// Returns the blade under the reading cursor, from 0.
fn read_blade(app: &App) -> Option<u32> {
    let cursor = app.cursor_in(ViewId::Gaps)?;
    let part = if app.layout.heat { cursor.up } else { cursor.across };
    Some(cell_of(part, app.machine.polygon.blades))
}

/// Returns the blade under the reading cursor, its gap, and the instant that is read.
fn reading(app: &App) -> Option<String> {
    let moment = app.shown()?;
    let blade = read_blade(app).and_then(|blade| {
        let gap = moment.gaps.get(blade as usize)?;
        Some(format!("blade {}: {}", blade + 1, app.gap_words(*gap)))
    });
    let at = app.cursor_time().map(|_| format!("at {}", instant(moment.state.t_s)));
    let parts: Vec<String> = blade.into_iter().chain(at).collect();
    (!parts.is_empty()).then(|| parts.join(" "))
}

/// Numbers of the touching blades on the axis, or under the zero line where it is empty.
fn label(plot: &mut Plot, active_set: &[u32], app: &App) {
    if app.has_lining() && 2 * active_set.len() > app.machine.polygon.blades as usize {
        return;
    }
    let (look, below) = (&app.appearance, plot.row(0.0).map(|row| row + 1));
    let style = look.style(Role::Contact);
    for blade in active_set.iter().take(16) {
        let (at, name) = (f64::from(*blade), blade.to_string());
        if !plot.axis_note(at, &name, style, look)
            && let Some(row) = below
        {
            plot.free_note(at, row, &name, style);
        }
    }
}

/// Signs of contact and of the shades, the nearest first.
const SIGNS: [char; 4] = ['█', '▓', '▒', '░'];
/// The same in ASCII.
const ASCII: [char; 4] = ['#', '%', '+', '.'];
/// Gaps below which a shade is drawn, in clearances. Above the last, the casing
/// is farther away than at rest.
const SHADES: [f64; 3] = [0.1, 0.5, 1.0];
/// The same where all blades rub at rest, in interferences at rest, below which blades
/// are deeper than then, in the lining, hardly in it, and near it.
const DEPTHS: [f64; 4] = [-1.0, -0.5, 0.0, 1.0];

/// One blade in one column.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Spot {
    /// Smallest gap, in clearances.
    gap: f64,
    touched: bool,
}

/// Returns the smallest gap of a side over a bin \[m\], of blades whose modes are those of the
/// casing, without their small angles. A bin stores only the least and greatest coordinates of the
/// wave, so this is a lower bound.
fn least_gap(polygon: &ContactPolygon, side: u32, bin: &Bin) -> f64 {
    let (c, s) = polygon.direction(side);
    let [(x0, x1), (y0, y1)] = [Channel::RimX, Channel::RimY].map(|channel| bin.span(channel));
    polygon.clearance + (c * x0).min(c * x1) + (s * y0).min(s * y1)
}

/// Returns whether a side was touched in a bin. If a bin has more than two sides, only their number
/// is known; then these are all sides that came as near as the sides of a corner.
fn touches(polygon: &ContactPolygon, lining: bool, side: u32, bin: &Bin) -> bool {
    match bin.touched {
        // In a lining many blades touch: the gaps say which.
        ActiveSet::Many if lining => least_gap(polygon, side, bin) < 0.0,
        ActiveSet::Many => {
            least_gap(polygon, side, bin) < polygon.delta * polygon.delta * polygon.clearance
        }
        touched => touched.includes(side),
    }
}

/// Returns every side in every column of the page.
fn spots(app: &App, columns: usize) -> Vec<Vec<Option<Spot>>> {
    let polygon = &app.machine.polygon;
    let (from, to) = app.page();
    let width = (to - from) / columns.max(1) as f64;
    let mut out = vec![vec![None; columns]; polygon.sides as usize];
    let place = |t: f64| (((t - from) / width).max(0.0) as usize).min(columns.saturating_sub(1));
    for bin in app.past_and_future(app.record()).0 {
        for (side, row) in (0..polygon.sides).zip(&mut out) {
            let gap = least_gap(polygon, side, bin) / polygon.clearance.abs();
            if !gap.is_finite() {
                continue;
            }
            let touched = touches(polygon, app.has_lining(), side, bin);
            let first = place(bin.from);
            // A bin may reach into a column in which nothing touches.
            let contact = bin.contact.map(|(from, to)| place(from)..=place(to));
            let contact = contact.filter(|_| touched);
            for (at, slot) in (first..).zip(row.iter_mut().take(place(bin.to) + 1).skip(first)) {
                let touched = contact.as_ref().is_some_and(|contact| contact.contains(&at));
                *slot = Some(slot.map_or(Spot { gap, touched }, |spot: Spot| Spot {
                    gap: spot.gap.min(gap),
                    touched: spot.touched || touched,
                }));
            }
        }
    }
    out
}

fn smallest(spots: &[Spot]) -> f64 {
    spots.iter().map(|spot| spot.gap).fold(f64::INFINITY, f64::min)
}

/// Returns the sign of the blades of one row where all rub at rest: the deeper, the darker, and the
/// lightest where they are off the lining.
fn sign_in_lining(spots: &[Spot], signs: [char; 4]) -> Option<(char, bool)> {
    let gap = smallest(spots);
    let place = DEPTHS.iter().position(|most| gap < *most)?;
    let sign = signs.get(place)?;
    Some((*sign, gap < 0.0))
}

/// Returns the sign of the blades of one row, lower blade first.
fn sign(spots: &[Spot], signs: [char; 4], ascii: bool) -> Option<(char, bool)> {
    let gap = smallest(spots);
    match spots {
        // Two blades per row: half a block marks the one that touches.
        [Spot { touched: true, .. }, Spot { touched: false, .. }] if !ascii => Some(('▄', true)),
        [Spot { touched: false, .. }, Spot { touched: true, .. }] if !ascii => Some(('▀', true)),
        _ if spots.iter().any(|spot| spot.touched) => Some((signs[0], true)),
        _ => {
            let shades = SHADES.iter().zip(&signs[1..]);
            shades.into_iter().find(|(most, _)| gap < **most).map(|(_, sign)| (*sign, false))
        }
    }
}

/// Returns the smallest gap of every blade in each bin of the page, as CSV.
///
/// # Errors
/// There is no data yet.
fn heat_csv(app: &App) -> Result<String, String> {
    let polygon = &app.machine.polygon;
    let mut columns = panel::names(&["from_s", "to_s"]);
    columns.extend((1..=polygon.blades).map(|blade| format!("least_gap_{blade}_m")));
    let rows = app.past_and_future(app.record()).0.iter().map(|bin| {
        let gaps =
            (1..=polygon.blades).map(|blade| least_gap(polygon, polygon.side_of_blade(blade), bin));
        [bin.from, bin.to].into_iter().chain(gaps)
    });
    panel::csv(&columns, rows)
}

/// Draws the gaps against time.
fn draw_heat(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let (first, contact) = (look.style(Role::First), look.style(Role::Contact));
    let signs = look.either(SIGNS, ASCII);
    let (from, to) = app.page();
    let count = app.machine.polygon.blades;
    let x = ChartAxis::scaled(from, to);
    let y = ChartAxis::plain(0.5, f64::from(count) + 0.5);
    let quiet = look.style(Role::Quiet);
    let pressed = app.is_pressed();
    let mut legend = Vec::new();
    if pressed {
        for (sign, what) in signs.into_iter().zip(["deeper than at rest", ">50%", "in the lining"])
        {
            legend.push((format!("{sign} {what}"), contact));
        }
        legend.push((format!("{} off it", signs[3]), first));
        legend.push((format!("over {}s", x.scale.prefix), quiet));
    } else {
        legend.push((format!("{} contact", signs[0]), contact));
        for (sign, most) in signs.into_iter().skip(1).zip(SHADES) {
            legend.push((format!("{sign} <{:.0}%", 100.0 * most), first));
        }
        legend.push((format!("of clearance; over {}s", x.scale.prefix), quiet));
    }
    let read = reading(app).filter(|_| at.large);
    let name = read_before(look, &mut legend, read, "gaps in time");
    let inside = title(app, buffer, at, name, &legend);
    let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
    at.note(app, plot.inner);
    let inner = plot.inner;
    let spots = spots(app, usize::from(inner.width));
    let polygon = &app.machine.polygon;
    let rows = u64::from(inner.height.max(1));
    for up in 0..inner.height {
        let blade_at = |row: u64| (row * u64::from(count) / rows) as u32;
        let low = blade_at(u64::from(up));
        let high = blade_at(u64::from(up) + 1).max(low + 1).min(count);
        let row = inner.bottom() - 1 - up;
        for (place, column) in (inner.x..inner.right()).enumerate() {
            let of_blade = |blade: u32| {
                let side = polygon.side_of_blade(blade + 1) as usize;
                spots.get(side)?.get(place).copied().flatten()
            };
            let here: Vec<Spot> = (low..high).filter_map(of_blade).collect();
            let found = match pressed {
                true => sign_in_lining(&here, signs),
                false => sign(&here, signs, look.ascii()),
            };
            if let Some((sign, touched)) = found {
                let style = if touched { contact } else { first };
                plot.text(column, row, sign.encode_utf8(&mut [0; 4]), style);
            }
        }
    }
    if let Some(t) = app.cursor_time() {
        plot.upright(t, look.either('┊', ':'), look.style(Role::Focus));
        if let Some(blade) = read_blade(app) {
            plot.point(t, f64::from(blade + 1), '+', look.style(Role::Focus));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::history::CHANNELS;

    fn bin(x: f64, y: f64) -> Bin {
        let mut values = [0.0; CHANNELS];
        values[Channel::RimX as usize] = x;
        values[Channel::RimY as usize] = y;
        Bin::of(0.0, values)
    }

    #[test]
    fn the_gap_of_a_wave_that_stands_still_is_the_gap_of_the_rim() {
        let polygon = ContactPolygon::new(22, 3, 1e-4);
        for side in 0..polygon.sides {
            let gap = least_gap(&polygon, side, &bin(3e-5, -8e-5));
            // Two sums of the same three terms.
            assert!((gap - polygon.gap(side, 3e-5, -8e-5)).abs() < 1e-18);
        }
    }

    #[test]
    fn blades_that_rub_at_rest_are_darker_the_deeper_they_are() {
        let of = |gap| sign_in_lining(&[Spot { gap, touched: true }], SIGNS);
        assert_eq!(of(-1.2), Some(('█', true)));
        assert_eq!(of(-0.7), Some(('▓', true)));
        assert_eq!(of(-0.2), Some(('▒', true)));
        assert_eq!(of(0.2), Some(('░', false)));
        assert_eq!(of(1.2), None);
        // Two blades in a row: the deeper one counts.
        let two = [0.2, -0.7].map(|gap| Spot { gap, touched: gap < 0.0 });
        assert_eq!(sign_in_lining(&two, SIGNS), Some(('▓', true)));
        // A side in a bin of many touches where its gap says so.
        let polygon = ContactPolygon::new(22, 3, -2e-5);
        let mut bin = bin(3e-5, 0.0);
        bin.touched = ActiveSet::Many;
        let touched: Vec<u32> =
            (0..22).filter(|side| touches(&polygon, true, *side, &bin)).collect();
        assert!(
            !touched.contains(&0) && touched.contains(&11) && touched.len() > 11,
            "{touched:?}"
        );
    }

    #[test]
    fn half_blocks_tell_which_blade_touches() {
        let spot = |touched| Spot { gap: 0.3, touched };
        let of = |low, high| sign(&[spot(low), spot(high)], SIGNS, false);
        assert_eq!(of(true, false), Some(('▄', true)));
        assert_eq!(of(false, true), Some(('▀', true)));
        assert_eq!(of(true, true), Some(('█', true)));
        assert_eq!(of(false, false), Some(('▒', false)));
        assert_eq!(sign(&[Spot { gap: 1.2, touched: false }], SIGNS, false), None);
        assert_eq!(sign(&[spot(true), spot(false)], ASCII, true), Some(('#', true)));
    }
}
