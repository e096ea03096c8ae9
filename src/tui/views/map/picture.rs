//! The picture of a map: two rows of cells per line, as letters on colours and coloured half blocks,
//! or one row of letters where there is no colour; and what is drawn over it.

use ratatui::style::{Color, Style};
use ratatui::{buffer::Buffer, layout::Rect};

use super::super::panel::ViewArea;
use super::plan::LiveMap;
use crate::sheet::map::mark;
use crate::tui::app::App;
use crate::tui::appearance::Appearance;
use crate::tui::axis::ChartAxis;
use crate::tui::knobs::{Knob, knob_of};
use crate::tui::plot::Plot;
use crate::tui::theme::{Role, Theme};
use crate::tui::views::id::ViewId;
use rubscope_solver::motion::Verdict;
use rubscope_solver::scene::keys::SPEED;
use rubscope_solver::study::overlay::Curve;
use rubscope_solver::study::{Axis, Cell};

/// Returns whether cells are letters without colours.
pub fn letters(look: &Appearance) -> bool {
    look.ascii() || look.theme == Theme::Mono
}

/// Returns the colour of a verdict; `None` for decay.
pub fn colour(look: &Appearance, verdict: Verdict) -> Option<Color> {
    let [dark, light, safe, safe_light] = match verdict {
        Verdict::Decay => return None,
        Verdict::Locked => [Color::LightBlue, Color::Blue, Color::LightBlue, Color::Blue],
        Verdict::Adhesive => [Color::LightRed, Color::Red, Color::LightYellow, Color::Red],
        Verdict::Slip => [Color::LightMagenta, Color::Magenta, Color::White, Color::Black],
        Verdict::Whirl => [Color::LightYellow, Color::Yellow, Color::LightRed, Color::Yellow],
        Verdict::Forced => [Color::LightGreen, Color::Green, Color::Gray, Color::DarkGray],
        Verdict::Divergent => [Color::Red, Color::LightRed, Color::Red, Color::LightRed],
        Verdict::Bounce => [Color::LightCyan, Color::Cyan, Color::Cyan, Color::Cyan],
        Verdict::Failed => [Color::White, Color::Black, Color::Magenta, Color::Magenta],
    };
    Some(match look.theme {
        Theme::Light => light,
        Theme::ColourBlind => safe,
        Theme::ColourBlindLight => safe_light,
        Theme::Dark | Theme::Mono => dark,
    })
}

pub fn draw(app: &App, live: &LiveMap, buffer: &mut Buffer, area: Rect, at: ViewArea) {
    let look = &app.appearance;
    let plan = &live.map.plan;
    let (x, y) = (chart_axis(&plan.x), chart_axis(&plan.y));
    let Some(plot) = Plot::new(buffer, area, x, y, look) else { return };
    let inner = plot.inner;
    at.note(app, inner);
    let mut picture = Picture { plot, look, live, inner };
    picture.cells();
    if plan.x.path == SPEED || plan.y.path == SPEED {
        live.lines.iter().for_each(|line| picture.line(line));
    }
    let [across, up] = [&plan.x, &plan.y].map(|axis| axis.place(present(app, axis)));
    if is_inside(&plan.x, across) && is_inside(&plan.y, up) {
        let (column, row) = (picture.column(across), picture.row(up));
        picture.over(column, row, look.either('╋', '+'), Role::Focus);
    }
    if let Some([column, row]) = app.cell_in(ViewId::Map).filter(|_| at.large) {
        let (x, y) = (picture.column(f64::from(column)), picture.row(f64::from(row)));
        for (x, sign) in [(x.checked_sub(1), '['), (x.checked_add(1), ']')] {
            if let Some(x) = x.filter(|x| (inner.x..inner.right()).contains(x)) {
                picture.over(x, y, sign, Role::Focus);
            }
        }
    }
}

/// Returns whether a position on an axis is within its cells. Positions count in cells; the centre
/// of the first cell is 0.
pub fn is_inside(axis: &Axis, place: f64) -> bool {
    (-0.5..=f64::from(axis.count) - 0.5).contains(&place)
}

/// Returns an axis of the map as that of a chart.
pub fn chart_axis(axis: &Axis) -> ChartAxis {
    let (from, to) = (axis.from, axis.to);
    match axis.log {
        true => ChartAxis::powers(from.log10(), to.log10(), Some(unit(&axis.path))),
        false if axis.path == SPEED => ChartAxis::speeds(from, to),
        false if axis.is_whole() => ChartAxis::whole(from, to),
        false => ChartAxis::scaled(from, to),
    }
}

struct Picture<'a> {
    plot: Plot<'a>,
    look: &'a Appearance,
    live: &'a LiveMap,
    inner: Rect,
}

impl Picture<'_> {
    fn cells(&mut self) {
        let (inner, look) = (self.inner, self.look);
        let plan = &self.live.map.plan;
        let cell_at = |place: u16, places: u16, count: u32| {
            let part = f64::from(place) / f64::from(places.max(2) - 1);
            ((part * f64::from(count.saturating_sub(1))).round() as u32)
                .min(count.saturating_sub(1))
        };
        let columns: Vec<u32> =
            (0..inner.width).map(|x| cell_at(x, inner.width, plan.x.count)).collect();
        let shown = |column: u32, place: u16, places: u16| {
            self.live.shown(column, cell_at(places - 1 - place, places, plan.y.count))
        };
        for row in 0..inner.height {
            for (x, &column) in (inner.x..).zip(&columns) {
                let (sign, style) = if letters(look) {
                    let cell = shown(column, row, inner.height);
                    (mark(cell), style(look, cell))
                } else {
                    let halves = 2 * inner.height;
                    block(look, [2 * row, 2 * row + 1].map(|half| shown(column, half, halves)))
                };
                self.plot.text(x, inner.y + row, sign.encode_utf8(&mut [0; 4]), style);
            }
        }
    }

    /// Returns the screen column of a position on the x axis (in cells).
    fn column(&self, place: f64) -> u16 {
        let part = place / f64::from(self.live.map.plan.x.count.max(2) - 1);
        self.inner.x + spread(part, self.inner.width)
    }

    /// Returns the screen row of a position on the y axis (in cells).
    fn row(&self, place: f64) -> u16 {
        let part = 1.0 - place / f64::from(self.live.map.plan.y.count.max(2) - 1);
        let from_top = match letters(self.look) {
            true => spread(part, self.inner.height),
            false => spread(part, 2 * self.inner.height) / 2,
        };
        self.inner.y + from_top
    }

    /// Draws one sign over the cells, in a colour that contrasts with the cell.
    fn over(&mut self, x: u16, y: u16, sign: char, role: Role) {
        if !(self.inner.y..self.inner.bottom()).contains(&y) {
            return;
        }
        let mut style = self.look.style(role);
        if let Some(ground) = self.plot.ground(x, y) {
            style = style.fg(ink(self.look, ground));
        }
        self.plot.text(x, y, sign.encode_utf8(&mut [0; 4]), style);
    }

    /// Draws a threshold speed over the map.
    fn line(&mut self, line: &Curve) {
        let (live, inner) = (self.live, self.inner);
        let (x, y) = (&live.map.plan.x, &live.map.plan.y);
        for &(across, up) in &line.points {
            let [across, up] = places(x, y, (across, up));
            if x.path == SPEED && is_inside(x, across) {
                // One cell can be several rows high.
                let (low, high) = (self.row(up - 0.5), self.row(up + 0.5));
                let column = self.column(across);
                for row in high.max(inner.y)..=low.min(inner.bottom().saturating_sub(1)) {
                    self.over(column, row, self.look.either('┊', ':'), Role::Text);
                }
            } else if x.path != SPEED && is_inside(y, up) {
                let row = self.row(up);
                let (left, right) = (self.column(across - 0.5), self.column(across + 0.5));
                for column in left.max(inner.x)..=right.min(inner.right().saturating_sub(1)) {
                    self.over(column, row, self.look.either('┈', '-'), Role::Text);
                }
            }
        }
    }
}

/// Returns the positions of a point on both axes, in cells.
fn places(x: &Axis, y: &Axis, (across, up): (f64, f64)) -> [f64; 2] {
    [x.place(across), y.place(up)]
}

/// Returns a colour that contrasts with a background.
fn ink(look: &Appearance, ground: Color) -> Color {
    match (look.theme, ground) {
        (Theme::Light, _) | (_, Color::Black) => Color::White,
        _ => Color::Black,
    }
}

/// Maps a fraction, 0 to 1, to one of `places` positions.
fn spread(part: f64, places: u16) -> u16 {
    let last = f64::from(places.saturating_sub(1));
    (part * last).round().clamp(0.0, last) as u16
}

fn style(look: &Appearance, cell: Option<Cell>) -> Style {
    let quiet = look.style(Role::Quiet);
    match cell.map(|cell| (cell.verdict, colour(look, cell.verdict))) {
        // Weight distinguishes the letters in addition.
        Some((verdict, _)) if look.theme == Theme::Mono => match verdict {
            Verdict::Decay | Verdict::Bounce => quiet,
            _ => look.style(Role::Text),
        },
        Some((_, Some(colour))) => Style::new().fg(colour),
        _ => quiet,
    }
}

/// Draws two cells, one above the other, as one character: their letter on their colour or, if they
/// differ, a half block of two colours.
fn block(look: &Appearance, [above, below]: [Option<Cell>; 2]) -> (char, Style) {
    let of = |cell: Option<Cell>| cell.and_then(|cell| colour(look, cell.verdict));
    let plain = Style::new();
    match (of(above), of(below)) {
        (Some(above), Some(below)) if above != below => ('▀', plain.fg(above).bg(below)),
        (Some(above), None) => ('▀', plain.fg(above)),
        (None, Some(below)) => ('▄', plain.fg(below)),
        _ => above.or(below).map_or(('·', look.style(Role::Quiet)), |cell| lettered(look, cell)),
    }
}

/// Draws a cell as its letter, on the colour of its verdict if it has one.
fn lettered(look: &Appearance, cell: Cell) -> (char, Style) {
    let colour = colour(look, cell.verdict).filter(|_| !letters(look));
    let on = |colour| Style::new().fg(ink(look, colour)).bg(colour);
    (mark(Some(cell)), colour.map_or_else(|| style(look, Some(cell)), on))
}

/// Returns the sign of a verdict for the legend.
pub fn sign(look: &Appearance, verdict: Verdict) -> (char, Style) {
    lettered(look, Cell::of(verdict))
}

/// Returns the style of text in the colour of a verdict.
pub fn text_style(look: &Appearance, verdict: Verdict) -> Style {
    style(look, Some(Cell::of(verdict)))
}

/// Returns the unit of a key; empty if it has none, or no knob.
pub fn unit(path: &str) -> &'static str {
    knob_of(path).map_or("", Knob::unit)
}

/// Returns the current value of the key on an axis, in its unit; of the speed, that at the time
/// shown. NaN if the key has no number.
pub fn present(app: &App, axis: &Axis) -> f64 {
    if axis.path == SPEED {
        return app.speed();
    }
    knob_of(&axis.path).and_then(|knob| knob.number(&app.scene)).unwrap_or(f64::NAN)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::raster::Marker;

    #[test]
    fn signs_over_a_map_are_seen_on_every_colour_of_every_theme() {
        for theme in Theme::ALL {
            let look = Appearance::new(theme, Marker::Braille);
            for ground in Verdict::ALL.into_iter().filter_map(|verdict| colour(&look, verdict)) {
                assert_ne!(ink(&look, ground), ground, "{theme:?}");
            }
        }
    }
}
