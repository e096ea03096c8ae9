//! The frame of a chart and its mapping from values to the screen: axis lines, round ticks, and
//! pens that draw finite values only. Panels draw their data on it.

use ratatui::{
    buffer::Buffer,
    layout::{Position, Rect},
    style::{Color, Style},
};

use super::appearance::Appearance;
use super::axis::{ChartAxis, nice_step};
use super::history::Span;
use super::raster::{Pen, Raster};
use super::theme::Role;

/// A framed chart under construction.
pub struct Plot<'a> {
    buffer: &'a mut Buffer,
    raster: Raster,
    /// Area of the data, inside the axes \[cells\].
    pub inner: Rect,
    x: ChartAxis,
    y: ChartAxis,
    rule: bool,
}

impl<'a> Plot<'a> {
    /// Creates a chart without axes, for drawings; `None` if the area is too small or a range is
    /// empty or not finite.
    pub fn bare(
        buffer: &'a mut Buffer,
        area: Rect,
        x: ChartAxis,
        y: ChartAxis,
        look: &Appearance,
    ) -> Option<Self> {
        let sound = x.is_sound() && y.is_sound() && area.width > 1 && area.height > 1;
        let raster = Raster::new(area, look.marker);
        sound.then_some(Self { buffer, raster, inner: area, x, y, rule: false })
    }

    /// Draws the frame in `area`; `None` if the area is too small or the range of an axis is empty
    /// or not finite.
    pub fn new(
        buffer: &'a mut Buffer,
        area: Rect,
        x: ChartAxis,
        y: ChartAxis,
        look: &Appearance,
    ) -> Option<Self> {
        if !x.is_sound() || !y.is_sound() || area.width < 10 || area.height < 3 {
            return None;
        }
        let rule = has_rule(area);
        let rows = rows(area);
        let grain = look.marker.grain();
        let (y_ticks, y_step) = even(&y, most_levels(rows), (usize::from(rows), grain.1), 0);
        let labels: Vec<String> =
            y_ticks.iter().map(|v| look.spell(&y.label(*v, y_step))).collect();
        let gutter = labels.iter().map(|label| label.chars().count()).max().unwrap_or(1).max(2);
        let gutter = u16::try_from(gutter).unwrap_or(6).min(area.width / 2) + 1;
        let inner = Rect::new(area.x + gutter, area.y, area.width - gutter, rows);
        let quiet = look.style(Role::Quiet);
        let raster = Raster::new(inner, look.marker);
        let mut plot = Self { buffer, raster, inner, x, y, rule };
        let [side, side_tick, ..] = look.axis_signs();
        for row in inner.y..inner.bottom() {
            plot.put(inner.x - 1, row, side, quiet);
        }
        for (value, label) in y_ticks.iter().zip(&labels) {
            if let Some(row) = plot.row(*value) {
                let wide = u16::try_from(label.chars().count()).unwrap_or(u16::MAX);
                let start = (inner.x - 1).saturating_sub(wide);
                plot.text(start.max(area.x), row, label, quiet);
                plot.put(inner.x - 1, row, side_tick, quiet);
            }
        }
        plot.x_axis(rule, look);
        Some(plot)
    }

    fn x_axis(&mut self, rule: bool, look: &Appearance) {
        let quiet = look.style(Role::Quiet);
        let [.., corner, floor, floor_tick] = look.axis_signs();
        let inner = self.inner;
        if rule {
            self.put(inner.x - 1, inner.bottom(), corner, quiet);
            for column in inner.x..inner.right() {
                self.put(column, inner.bottom(), floor, quiet);
            }
        }
        let labels_row = inner.bottom() + u16::from(rule);
        let most = usize::from(inner.width / 9).clamp(1, 10);
        let across = self.raster.grain().0.unsigned_abs() as usize;
        // Ticks are nine columns apart, so a difference of one column is not visible.
        let (values, step) = even(&self.x, most, (usize::from(inner.width), across), 1);
        let mut free = inner.x.saturating_sub(1);
        for value in values {
            let Some(column) = self.column(value) else { continue };
            if rule {
                self.put(column, inner.bottom(), floor_tick, quiet);
            }
            let label = look.spell(&self.x.label(value, step));
            let width = u16::try_from(label.chars().count()).unwrap_or(0);
            let start = column
                .saturating_sub(width / 2)
                .min(inner.right().saturating_sub(width))
                .max(inner.x.saturating_sub(1));
            if start >= free && start + width <= inner.right() {
                self.text(start, labels_row, &label, quiet);
                free = start + width + 1;
            }
        }
    }

    /// Returns the row of the horizontal axis line on the screen; `None` if the chart is not tall
    /// enough to have one.
    pub fn axis_row(&self) -> Option<u16> {
        self.rule.then(|| self.inner.bottom())
    }

    /// Returns the column of an x value on the screen; `None` outside the chart. It is derived from
    /// the sub-pixel, so that ticks, signs and curves agree.
    pub fn column(&self, value: f64) -> Option<u16> {
        let (across, _) = self.raster.grain();
        let pixel = self.pixel_x(value).filter(|_| is_inside(&self.x, value))?;
        let column = u16::try_from(pixel.max(0) / across).ok()?;
        Some(self.inner.x + column.min(self.inner.width.saturating_sub(1)))
    }

    /// Returns the row of a y value on the screen, derived from the sub-pixel; `None` outside the
    /// chart.
    pub fn row(&self, value: f64) -> Option<u16> {
        let (_, down) = self.raster.grain();
        let pixel = self.pixel_y(value).filter(|_| is_inside(&self.y, value))?;
        let row = u16::try_from(pixel.max(0) / down).ok()?;
        Some(self.inner.y + row.min(self.inner.height.saturating_sub(1)))
    }

    /// Returns the number of sub-pixel columns, into which signals are decimated.
    pub fn columns(&self) -> usize {
        self.raster.size().0
    }

    /// Returns the sub-pixel column of an x value, which may lie outside the chart; `None` if it is
    /// not finite.
    fn pixel_x(&self, value: f64) -> Option<i64> {
        let across = (value - self.x.low) / (self.x.high - self.x.low);
        whole(across * (self.raster.size().0.saturating_sub(1)) as f64)
    }

    /// Returns the sub-pixel row of a y value, which may lie outside the chart; `None` if it is not
    /// finite.
    fn pixel_y(&self, value: f64) -> Option<i64> {
        let up = (value - self.y.low) / (self.y.high - self.y.low);
        whole((1.0 - up) * (self.raster.size().1.saturating_sub(1)) as f64)
    }

    /// Draws a polyline, interrupted at values that are not finite.
    pub fn curve(&mut self, points: impl IntoIterator<Item = (f64, f64)>, pen: &Pen) {
        let mut last = None;
        for (x, y) in points {
            let here = self.pixel_x(x).zip(self.pixel_y(y));
            if let Some(here) = here {
                self.raster.line(last.unwrap_or(here), here, pen);
            }
            last = here;
        }
    }

    /// Draws a polyline as evenly spaced dots, `sparse` times as far apart as usual. Dots at x
    /// values below `from` are omitted; the others keep their places while `from` grows.
    pub fn dotted(
        &mut self,
        points: impl IntoIterator<Item = (f64, f64)>,
        from: f64,
        sparse: f64,
        pen: &Pen,
    ) {
        let (width, height) = self.raster.size();
        let (width, height) = (width as f64 - 1.0, height as f64 - 1.0);
        let across = |x: f64| (x - self.x.low) / (self.x.high - self.x.low) * width;
        // Far outside the chart, only the direction of the line matters.
        let down = |y: f64| {
            let part = (self.y.high - y) / (self.y.high - self.y.low);
            (part * height).clamp(-2.0 * height, 3.0 * height)
        };
        let stride = sparse * DOTS * self.raster.grain().0 as f64;
        let begin = across(from);
        let (mut last, mut gone): (Option<(f64, f64)>, f64) = (None, 0.0);
        let mut dots = Vec::new();
        for (x, y) in points {
            let here = (across(x), down(y));
            if !(here.0.is_finite() && here.1.is_finite()) {
                last = None;
                continue;
            }
            let there = last.replace(here).unwrap_or(here);
            let (dx, dy) = (here.0 - there.0, here.1 - there.1);
            let length = dx.hypot(dy);
            let mut at = stride - gone;
            while at <= length && dots.len() < MOST_DOTS {
                let part = at / length;
                let dot = (there.0 + part * dx, there.1 + part * dy);
                if dot.0 >= begin {
                    dots.push(dot);
                }
                at += stride;
            }
            gone = (length - (at - stride)).clamp(0.0, stride);
        }
        for (x, y) in dots {
            self.raster.set(x.round() as i64, y.round() as i64, pen);
        }
    }

    /// Draws a decimated signal: one span per sub-pixel column, joined to the next.
    pub fn spans(&mut self, spans: &[Span], pen: &Pen) {
        let mut last: Option<(i64, i64)> = None;
        for (x, span) in (0..).zip(spans) {
            let shown = span.and_then(|(low, high)| self.pixel_y(high).zip(self.pixel_y(low)));
            if let Some((mut top, mut bottom)) = shown {
                if let Some((last_top, last_bottom)) = last {
                    // Touch the neighbouring span, so that steep parts stay connected.
                    if top > last_bottom + 1 {
                        top = last_bottom + 1;
                    } else if bottom < last_top - 1 {
                        bottom = last_top - 1;
                    }
                }
                self.raster.line((x, top), (x, bottom), pen);
            }
            last = shown;
        }
    }

    /// Draws a horizontal line across the chart; data drawn later covers it.
    pub fn level(&mut self, y: f64, sign: char, style: Style) {
        if let Some(row) = self.row(y) {
            for column in self.inner.x..self.inner.right() {
                self.put(column, row, sign, style);
            }
        }
    }

    /// Draws a vertical line; data drawn later covers it.
    pub fn upright(&mut self, x: f64, sign: char, style: Style) {
        if let Some(column) = self.column(x) {
            for row in self.inner.y..self.inner.bottom() {
                self.put(column, row, sign, style);
            }
        }
    }

    /// Copies the curves drawn so far into the buffer, below all signs drawn later.
    pub fn ink(&mut self) {
        self.raster.draw(self.buffer);
    }

    /// Draws one sign at a data point; points outside the chart are omitted.
    pub fn point(&mut self, x: f64, y: f64, sign: char, style: Style) {
        if let (Some(column), Some(row)) = (self.column(x), self.row(y)) {
            self.put(column, row, sign, style);
        }
    }

    /// Prints a short text beside the column of `x`, if the chart is empty there; returns whether
    /// it was printed.
    pub fn free_note(&mut self, x: f64, row: u16, text: &str, style: Style) -> bool {
        let Some(column) = self.column(x) else { return false };
        let width = u16::try_from(text.chars().count()).unwrap_or(u16::MAX);
        let starts = [Some(column.saturating_add(1)), column.checked_sub(width)];
        starts.into_iter().flatten().any(|start| self.free_text(start, row, text, style))
    }

    /// Prints a short text centred at a point of the chart, if the chart is empty there; returns
    /// whether it was printed.
    pub fn free_label(&mut self, (x, y): (f64, f64), text: &str, style: Style) -> bool {
        let half = u16::try_from(text.chars().count() / 2).unwrap_or(0);
        let Some((column, row)) = self.column(x).zip(self.row(y)) else { return false };
        self.free_text(column.saturating_sub(half).max(self.inner.x), row, text, style)
    }

    /// Prints a text inside the chart if it covers nothing; returns whether it was printed.
    fn free_text(&mut self, x: u16, row: u16, text: &str, style: Style) -> bool {
        let width = u16::try_from(text.chars().count()).unwrap_or(u16::MAX);
        let (inner, end) = (self.inner, x.saturating_add(width));
        if x < inner.x || end > inner.right() || !(inner.y..inner.bottom()).contains(&row) {
            return false;
        }
        // A label may interrupt a reference line.
        let empty = |x: u16| {
            let cell = self.buffer.cell(Position::new(x, row));
            let is_data = self.raster.is_drawn(x, row);
            let is_line = |sign: &str| matches!(sign, " " | "┈" | "┊" | "." | ":");
            !is_data && cell.is_some_and(|cell| is_line(cell.symbol()))
        };
        // Two labels must be at least two cells apart.
        let near = [x.saturating_sub(2), x.saturating_sub(1), end, end.saturating_add(1)];
        let apart = near.into_iter().filter(|x| (inner.x..inner.right()).contains(x)).all(|x| {
            let cell = self.buffer.cell(Position::new(x, row));
            cell.is_none_or(|cell| !cell.symbol().chars().any(char::is_alphanumeric))
        });
        let free = apart && (x..end).all(empty);
        if free {
            self.text(x, row, text, style);
        }
        free
    }

    /// Prints a short text on the horizontal axis line, if no tick or other text is there; returns
    /// whether it was printed.
    pub fn axis_note(&mut self, x: f64, text: &str, style: Style, look: &Appearance) -> bool {
        let Some((column, row)) = self.column(x).zip(self.axis_row()) else { return false };
        let width = u16::try_from(text.chars().count()).unwrap_or(u16::MAX);
        let [.., floor, _] = look.axis_signs();
        let start = column.min(self.inner.right().saturating_sub(width));
        let line = |x: u16| {
            let cell = self.buffer.cell(Position::new(x, row));
            cell.is_some_and(|cell| cell.symbol().starts_with([floor, contact(look)]))
        };
        let free = start >= self.inner.x && (start..start.saturating_add(width)).all(line);
        if free {
            self.text(start, row, text, style);
        }
        free
    }

    fn put(&mut self, x: u16, y: u16, sign: char, style: Style) {
        if let Some(cell) = self.buffer.cell_mut(Position::new(x, y)) {
            cell.set_char(sign).set_style(style);
        }
    }

    /// Returns the background colour of a cell of the screen; `None` if it is that of the terminal.
    pub fn ground(&self, x: u16, y: u16) -> Option<Color> {
        let cell = self.buffer.cell(Position::new(x, y))?;
        Some(cell.bg).filter(|colour| *colour != Color::Reset)
    }

    /// Prints a text at a position; what does not fit is cut off.
    pub fn text(&mut self, x: u16, y: u16, text: &str, style: Style) {
        let area = *self.buffer.area();
        if y < area.bottom() && x < area.right() {
            self.buffer.set_stringn(x, y, text, usize::from(area.right() - x), style);
        }
    }
}

/// Returns the sign that marks contact on the time axis.
pub fn contact(look: &Appearance) -> char {
    look.either('━', '=')
}

/// Returns whether a chart of this size has a horizontal axis line above its labels.
fn has_rule(area: Rect) -> bool {
    area.height >= 7
}

/// Returns the number of data rows of a chart in this area.
fn rows(area: Rect) -> u16 {
    area.height.saturating_sub(if has_rule(area) { 2 } else { 1 })
}

/// Returns the largest number of ticks on a vertical axis of `rows` rows.
fn most_levels(rows: u16) -> usize {
    usize::from(rows.div_ceil(2)).clamp(1, 7)
}

/// A vertical axis may grow by at most this fraction to make its ticks evenly spaced.
const GROWS: f64 = 0.3;

impl ChartAxis {
    /// Extends the range of this vertical axis slightly, if that makes round ticks lie whole rows
    /// apart.
    pub fn evened(self, area: Rect, look: &Appearance) -> Self {
        let (_, grain) = look.marker.grain();
        let (rows, grain) = (rows(area), grain as f64);
        let pixels = f64::from(rows) * grain - 1.0;
        let span = self.high - self.low;
        let steps = (1..=most_levels(rows)).rev().filter_map(|most| nice_step(span, most));
        let spans = steps.filter_map(|step| {
            let apart = (pixels * step / (span * grain) + 1e-9).floor();
            let wider = pixels * step / (apart * grain);
            (apart >= 2.0 && wider <= (1.0 + GROWS) * span).then_some((step, wider))
        });
        let Some((step, wider)) = { spans }.next() else { return self };
        // Extend both ends equally, then shift so that ticks lie in the middle of rows.
        let pixel = wider / pixels;
        let high = self.high + 0.5 * (wider - span);
        let tick = (high / step).floor() * step;
        let off = ((high - tick) / pixel - (0.5 * grain - 0.5)).rem_euclid(grain);
        let off = if off > 0.5 * grain { off - grain } else { off };
        // Round-off can make the extension slightly negative.
        let most = (0.5 * (wider - span) / pixel).max(0.0);
        let high = high - off.clamp(-most, most) * pixel;
        let mut evened = self;
        (evened.low, evened.high) = ((high - wider).min(self.low), high.max(self.high));
        evened
    }
}

/// Returns the ticks of the smallest round step (at most `most` steps on the axis) that are evenly
/// spaced on the screen, and that step. The axis has `cells` cells of `grain` sub-pixels; spacings
/// may differ by `slack` cells.
fn even(
    axis: &ChartAxis,
    most: usize,
    (cells, grain): (usize, usize),
    slack: i64,
) -> (Vec<f64>, f64) {
    let pixels = (cells * grain).saturating_sub(1) as f64;
    let cell = |value: &f64| {
        let along = (axis.high - value) / (axis.high - axis.low) * pixels;
        whole(along).map_or(0, |pixel| pixel / grain.max(1) as i64)
    };
    let is_even = |values: &[f64]| {
        let places: Vec<i64> = values.iter().map(cell).collect();
        let gaps = || places.windows(2).filter_map(|pair| Some(pair.first()? - pair.last()?));
        let (least, greatest) = (gaps().min(), gaps().max());
        least.zip(greatest).is_none_or(|(least, most)| most - least <= slack && least > 1)
    };
    let found = (2..=most)
        .rev()
        .map(|most| axis.ticks(most))
        .find(|(values, _)| values.len() > 1 && is_even(values));
    // Without such a step, only the two outermost ticks are kept.
    found.unwrap_or_else(|| {
        let (values, step) = axis.ticks(most);
        let ends = [values.first(), values.last()].into_iter().flatten();
        let mut ends: Vec<f64> = ends.copied().collect();
        ends.dedup();
        (ends, step)
    })
}

/// Usual distance between the dots of a dotted line \[columns\].
const DOTS: f64 = 1.5;
/// Largest number of dots in one line.
const MOST_DOTS: usize = 20_000;
/// Returns whether a value is within the range of an axis, allowing for round-off.
fn is_inside(axis: &ChartAxis, value: f64) -> bool {
    let part = (value - axis.low) / (axis.high - axis.low);
    (-1e-9..=1.0 + 1e-9).contains(&part)
}

/// Rounds to a sub-pixel; `None` for a value that is not finite. The small offset keeps values that
/// differ by round-off, such as a clearance and its tick, in one sub-pixel when they are half-way
/// between two.
fn whole(pixel: f64) -> Option<i64> {
    pixel.is_finite().then(|| (pixel + 1e-6).round().clamp(-1e5, 1e5) as i64)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::{raster::Marker, theme::Theme};
    use fastrand::Rng;
    use ratatui::style::Modifier;

    fn look() -> Appearance {
        Appearance::new(Theme::Mono, Marker::Ascii)
    }

    #[test]
    fn ends_of_the_axes_are_the_ends_of_the_chart() {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 40, 12));
        let area = *buffer.area();
        let axis = ChartAxis::plain(0.0, 500.0);
        let plot =
            Plot::new(&mut buffer, area, axis, ChartAxis::plain(-1.0, 1.0), &look()).unwrap();
        assert_eq!(plot.column(0.0), Some(plot.inner.x));
        assert_eq!(plot.column(500.0), Some(plot.inner.right() - 1));
        assert_eq!(plot.row(1.0), Some(plot.inner.y));
        assert_eq!(plot.row(-1.0), Some(plot.inner.bottom() - 1));
        assert_eq!(plot.column(501.0), None);
    }

    #[test]
    fn round_ticks_stand_at_equal_distances() {
        let look = Appearance::new(Theme::Dark, Marker::Braille);
        for (low, high) in [(-125.0, 125.0), (-20.0, 220.0), (-400.0, 100.0), (-1.1e-4, 1.3e-4)] {
            for height in 9..40 {
                let mut buffer = Buffer::empty(Rect::new(0, 0, 60, height));
                let area = *buffer.area();
                let y = ChartAxis::scaled(low, high).evened(area, &look);
                let grown = (y.high - y.low) / (high - low);
                let wide = y.low <= low && y.high >= high && grown <= 1.31;
                assert!(wide, "{low} {high} in {height} rows: {} {}", y.low, y.high);
                let x = ChartAxis::plain(0.0, 20.0);
                assert!(Plot::new(&mut buffer, area, x, y, &look).is_some());
                let tick =
                    |row: &u16| (0..60).any(|x| buffer.cell((x, *row)).unwrap().symbol() == "┤");
                let rows: Vec<u16> = (0..height).filter(tick).collect();
                let apart: Vec<u16> = rows.windows(2).map(|pair| pair[1] - pair[0]).collect();
                assert!(!apart.is_empty() && apart.iter().all(|d| *d == apart[0]), "{rows:?}");
            }
        }
    }

    #[test]
    fn a_label_covers_no_data() {
        let mut buffer = Buffer::empty(Rect::new(0, 0, 40, 12));
        let area = *buffer.area();
        let axis = ChartAxis::plain(0.0, 1.0);
        let mut plot = Plot::new(&mut buffer, area, axis, axis, &look()).unwrap();
        let pen = Pen { style: Style::new(), sign: '*', dashed: false };
        plot.curve([(0.0, 0.5), (1.0, 0.5)], &pen);
        plot.ink();
        let row = plot.row(0.5).unwrap();
        assert!(!plot.free_note(0.3, row, "name", Style::new()));
        assert!(plot.free_note(0.3, row - 1, "name", Style::new()));
        // Too close to another label: both would read as one.
        assert!(!plot.free_note(0.3, row - 1, "name", Style::new()));
        assert!(plot.free_note(0.8, row - 1, "name", Style::new()));
        // Not on another label, and not outside the chart.
        assert!(!plot.free_note(0.3, row - 1, "name", Style::new()));
        assert!(!plot.free_label((0.0, 0.9), &"x".repeat(99), Style::new()));
        assert!(plot.axis_note(0.3, "name", Style::new(), &look()));
        assert!(!plot.axis_note(0.3, "other", Style::new(), &look()));
    }

    #[test]
    fn a_name_stands_on_its_level_in_ascii_too_and_covers_no_data() {
        for marker in [Marker::Ascii, Marker::Braille] {
            let look = Appearance::new(Theme::Mono, marker);
            let mut buffer = Buffer::empty(Rect::new(0, 0, 40, 12));
            let area = *buffer.area();
            let axis = ChartAxis::plain(0.0, 1.0);
            let mut plot = Plot::new(&mut buffer, area, axis, axis, &look).unwrap();
            plot.level(0.5, look.either('┈', '.'), Style::new());
            plot.level(0.2, look.either('┈', '.'), Style::new());
            plot.curve([(0.0, 0.2), (1.0, 0.2)], &look.quiet());
            plot.ink();
            let [free, data] = [0.5, 0.2].map(|level| plot.row(level).unwrap());
            assert!(plot.free_note(0.5, free, "g0", Style::new()), "{marker}");
            assert!(!plot.free_note(0.5, data, "g0", Style::new()), "{marker}");
        }
    }

    #[test]
    fn ticks_and_signs_are_in_the_cell_of_the_data() {
        for case in 0..256 {
            println!("case {case}");
            let rng = &mut Rng::with_seed(case);
            let (width, height, marker) = (rng.u16(12..90), rng.u16(4..50), rng.usize(0..5));
            let (part, other) = (rng.f64(), rng.f64());
            let low = 1e6 * (2.0 * rng.f64() - 1.0);
            let span = 1e-6 + 1e6 * rng.f64();
            let marker = (0..marker).fold(Marker::Braille, |marker, _| marker.next());
            let look = Appearance::new(Theme::Dark, marker);
            let mut buffer = Buffer::empty(Rect::new(0, 0, width, height));
            let area = *buffer.area();
            let axis = ChartAxis::plain(low, low + span);
            let mut plot = Plot::new(&mut buffer, area, axis, axis, &look).unwrap();
            let (x, y) = (low + part * span, low + other * span);
            let pen = Pen { style: Style::new().bold(), sign: '*', dashed: false };
            plot.curve([(x, y)], &pen);
            plot.ink();
            let place = (plot.column(x).unwrap(), plot.row(y).unwrap());
            let cell = plot.buffer.cell(place).unwrap();
            assert!(cell.modifier.contains(Modifier::BOLD), "{place:?} {marker}");
        }
    }

    /// A number of any size, or none.
    fn any_number(rng: &mut Rng) -> f64 {
        const ODD: [f64; 7] =
            [0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, 5e-324];
        if rng.u8(..4) == 0 { ODD[rng.usize(..ODD.len())] } else { f64::from_bits(rng.u64(..)) }
    }

    #[test]
    fn any_numbers_at_any_size_are_drawn_without_panic() {
        for case in 0..256 {
            println!("case {case}");
            let rng = &mut Rng::with_seed(case);
            let (width, height) = (rng.u16(0..80), rng.u16(0..40));
            let xs = [(); 8].map(|()| any_number(rng));
            let x = ChartAxis::scaled(any_number(rng), any_number(rng));
            let mut buffer = Buffer::empty(Rect::new(0, 0, width, height));
            let area = *buffer.area();
            let pen = Pen { style: Style::new(), sign: '*', dashed: true };
            let look = Appearance::new(Theme::Dark, Marker::Braille);
            let y = ChartAxis::plain(-1.0, 1.0);
            if let Some(mut plot) = Plot::new(&mut buffer, area, x, y, &look) {
                plot.curve(xs.iter().map(|x| (*x, *x)), &pen);
                plot.spans(&xs.iter().map(|x| Some((*x, *x))).collect::<Vec<_>>(), &pen);
                for x in &xs {
                    plot.point(*x, *x, 'o', Style::new());
                    plot.free_note(*x, 0, "here", Style::new());
                    plot.level(*x, '-', Style::new());
                    plot.upright(*x, '|', Style::new());
                }
                plot.ink();
            }
        }
    }
}
