//! One panel of a figure: axes, ranges, ticks (powers of ten on a logarithmic axis), legend and
//! series.

use super::paper::{LEFT, LINE, Place, circle, colour, line, rectangle, strokes, text, width_of};
use crate::sheet::number::short;
use crate::sheet::ticks::{log_ticks, power_of_ten, scientific, ticks};
use rubscope_solver::study::figures::{Panel, Quantity, Series, Style};

/// Height of a panel's title \[px\].
const TITLE: f64 = 24.0;
/// Width of a legend sample, and distance between two legend entries \[px\].
const SAMPLE: f64 = 26.0;
const APART: f64 = 18.0;
/// Distance of the axes from the left, the right and the lower edge \[px\].
const LABELS: f64 = 100.0;
const RIGHT: f64 = 24.0;
const BELOW: f64 = 52.0;
/// Largest number of ticks on an axis.
const MOST_TICKS: usize = 8;
/// Smallest distance between the labels of two ticks \[px\].
const TICKS_APART: f64 = 8.0;
/// Half the width of a bar of [`Style::Bars`], in units of x.
const HALF: f64 = 0.3;
/// Radius of a curve of one point \[px\].
const POINT: f64 = 2.0;
/// Style of the lines of marks.
const MARK: Style = Style::Dotted(5);

/// Returns a panel of this width and height \[px\].
pub fn draw(panel: &Panel, [width, height]: Place) -> String {
    let (mut svg, mut top) = (String::new(), 0.0);
    if !panel.title.is_empty() {
        svg += &text(&panel.title, [LEFT, 18.0], "font-size=\"14\"");
        top += TITLE;
    }
    top += legend(panel, [width, top], &mut svg);
    top += if panel.marks.is_empty() { 6.0 } else { 22.0 };
    let (right, bottom) = (width - RIGHT, height - BELOW);
    let on_cells = has_cells(panel);
    let (columns, rows) = (steps(panel, |point| point.0), steps(panel, |point| point.1));
    let margin = |steps: f64, otherwise| if on_cells { 0.5 / steps } else { otherwise };
    let x = Scale::of(panel, &panel.x, |point| point.0, margin(columns, 0.0), [LABELS, right]);
    let y = Scale::of(panel, &panel.y, |point| point.1, margin(rows, 0.05), [bottom, top]);
    let grid = "stroke-opacity=\"0.15\"";
    for (at, label) in x.ticks().into_iter().filter(|_| ranging(panel).next().is_some()) {
        svg += &line(&[[at, top], [at, bottom]], "black", 1.0, grid);
        svg += &text(&label, [at, bottom + 17.0], "text-anchor=\"middle\"");
    }
    for (at, label) in y.ticks().into_iter().filter(|_| !panel.is_bare()) {
        svg += &line(&[[LABELS, at], [right, at]], "black", 1.0, grid);
        svg += &text(&label, [LABELS - 8.0, at + 4.0], "text-anchor=\"end\"");
    }
    svg += &line(&[[LABELS, top], [LABELS, bottom], [right, bottom]], "black", 1.0, "");
    if panel.is_bare() {
        let middle = [0.5 * (LABELS + right), 0.5 * (top + bottom)];
        svg += &text("no curve here", middle, "text-anchor=\"middle\"");
    }
    let middle = [0.5 * (LABELS + right), bottom + 38.0];
    svg += &text(&panel.x.label, middle, "text-anchor=\"middle\"");
    let middle = 0.5 * (top + bottom);
    let turned = format!("text-anchor=\"middle\" transform=\"rotate(-90 17 {middle:.1})\"");
    svg += &text(&panel.y.label, [17.0, middle], &turned);
    let half = match on_cells {
        true => [0.5 * (right - LABELS) / (columns + 1.0), 0.5 * (bottom - top) / (rows + 1.0)],
        false => [x.place(HALF) - x.place(0.0), 0.0],
    };
    // Named series are drawn after faint ones, on top of them.
    let is_faint = |series: &&Series| series.style == Style::Faint;
    let (faint, named): (Vec<&Series>, Vec<&Series>) = panel.series.iter().partition(is_faint);
    for Series { style, points, .. } in faint.into_iter().chain(named) {
        let height = |point| if *style == Style::Edge { bottom } else { y.place(y.shown(point)) };
        // A curve over a map that is not complete may leave its cells.
        let is_inside = |[x, y]: &Place| (LABELS..=right).contains(x) && (top..=bottom).contains(y);
        for part in points.split(|point| !point.1.is_finite()).filter(|part| !part.is_empty()) {
            let at = part.iter().map(|point| [x.place(x.shown(point.0)), height(point.1)]);
            let at = at.filter(|at| !on_cells || is_inside(at));
            svg += &drawn(*style, &at.collect::<Vec<_>>(), half, on_cells);
        }
    }
    for mark in &panel.marks {
        let at = x.shown(mark.x);
        if (x.low..=x.high).contains(&at) {
            let at = x.place(at);
            svg += &drawn(MARK, &[[at, top], [at, bottom]], half, on_cells);
            svg += &text(mark.label, [at, top - 6.0], "text-anchor=\"middle\"");
        }
    }
    svg
}

/// Draws the legend (without faint or empty series); returns its height.
fn legend(panel: &Panel, [width, top]: Place, svg: &mut String) -> f64 {
    let (mut left, mut row) = (LABELS, 0.0);
    let is_named = |series: &&Series| {
        series.style != Style::Faint && series.points.iter().any(|point| point.1.is_finite())
    };
    for series in panel.series.iter().filter(is_named) {
        let long = SAMPLE + width_of(&series.label);
        if left > LABELS && left + long > width {
            (left, row) = (LABELS, row + 1.0);
        }
        let y = top + 12.0 + LINE * row;
        let sample: &[Place] = match series.style {
            Style::Line(_) | Style::Dashed(_) | Style::Dotted(_) => &[[left, y], [left + 18.0, y]],
            Style::Bars(_) => &[[left + 9.0, y - 6.0], [left + 9.0, y + 6.0]],
            _ => &[[left + 9.0, y]],
        };
        *svg += &drawn(series.style, sample, [9.0, 6.0], false);
        *svg += &text(&series.label, [left + SAMPLE, y + 4.0], "");
        left += long + APART;
    }
    if left == LABELS { 0.0 } else { 4.0 + LINE * (row + 1.0) }
}

/// Returns a series through these places, or a sample of it; `half` are half the width and height of
/// its cells, or half the width of its bars. On cells, lines and dots have a white rim, to be
/// visible on any colour.
fn drawn(style: Style, at: &[Place], half: Place, on_cells: bool) -> String {
    let ink = colour(style);
    let each =
        |symbol: &dyn Fn(Place) -> String| at.iter().copied().map(symbol).collect::<String>();
    let stroke = |dashes: &str| {
        if let [only] = at {
            return circle(*only, POINT, &ink, "none");
        }
        let rim = if on_cells { line(at, "white", 4.0, "") } else { String::new() };
        rim + &line(at, &ink, 1.5, dashes)
    };
    match style {
        Style::Faint => line(at, &ink, 0.5, ""),
        Style::Line(_) => stroke(""),
        Style::Dashed(_) => stroke("stroke-dasharray=\"6 3\""),
        Style::Dotted(_) => stroke("stroke-dasharray=\"2 3\""),
        Style::Cells(_) => {
            // Adjacent cells of a row are one rectangle. Crisp edges leave no seams between rows.
            let are_beside =
                |a: &Place, b: &Place| a[1] == b[1] && b[0] > a[0] && b[0] - a[0] < 3.0 * half[0];
            let [across, down] = half;
            let row = |row: &[Place]| {
                let ([left, y], [right, _]) = (row[0], row[row.len() - 1]);
                let corners = [[left - across, y - down], [right + across, y + down]];
                rectangle(corners, &ink, "shape-rendering=\"crispEdges\"")
            };
            at.chunk_by(are_beside).map(row).collect()
        }
        Style::Bars(_) => {
            let bar = |ends: &[Place]| {
                let ([x, low], [_, high]) = (ends[0], ends[1]);
                let corners = [[x - half[0], low], [x + half[0], high]];
                // Pale enough for marks on it to stay visible.
                rectangle(corners, &ink, "fill-opacity=\"0.2\"")
            };
            at.chunks_exact(2).map(bar).collect()
        }
        Style::Discs(number, radius) => each(&|[x, y]| match strokes(number, radius.into()) {
            none if none.is_empty() => circle([x, y], radius.into(), &ink, "none"),
            strokes => {
                let moved = |stroke: Vec<Place>| -> Vec<Place> {
                    stroke.into_iter().map(|[dx, dy]| [x + dx, y + dy]).collect()
                };
                strokes.into_iter().map(|stroke| line(&moved(stroke), &ink, 2.0, "")).collect()
            }
        }),
        Style::Rings(_, radius) => each(&|at| circle(at, radius.into(), "none", &ink)),
        Style::Dots => each(&|at| {
            let rim = if on_cells { circle(at, 2.5, "white", "none") } else { String::new() };
            rim + &circle(at, 1.5, &ink, "none")
        }),
        Style::Edge => each(&|[x, y]| {
            line(&[[x - 5.0, y], [x, y - 8.0], [x + 5.0, y], [x - 5.0, y]], &ink, 1.5, "")
        }),
    }
}

/// Range of an axis in its coordinates (shown unit, and logarithm on a logarithmic axis), and the
/// places of its ends \[px\].
struct Scale<'a> {
    quantity: &'a Quantity,
    low: f64,
    high: f64,
    ends: [f64; 2],
}

impl<'a> Scale<'a> {
    /// Creates the range of the cells or, without cells, of all points, widened at each end by the
    /// fraction `margin`. A logarithmic axis without cells covers whole decades instead. `of`
    /// returns the coordinate of a point on this axis.
    fn of(
        panel: &Panel,
        quantity: &'a Quantity,
        of: fn(&(f64, f64)) -> f64,
        margin: f64,
        ends: [f64; 2],
    ) -> Self {
        let mut scale = Self { quantity, low: f64::INFINITY, high: f64::NEG_INFINITY, ends };
        for point in ranging(panel) {
            let shown = scale.shown(of(point));
            if shown.is_finite() {
                scale.low = scale.low.min(shown);
                scale.high = scale.high.max(shown);
            }
        }
        if scale.low > scale.high {
            (scale.low, scale.high) = (0.0, 1.0);
        }
        if quantity.log && !has_cells(panel) {
            scale.low = scale.low.floor();
            scale.high = scale.high.ceil().max(scale.low + 1.0);
            return scale;
        }
        let mut widen = margin * (scale.high - scale.low);
        if scale.low == scale.high {
            // A constant needs some range for an axis to exist.
            widen = if scale.low == 0.0 { 1.0 } else { 1e-9 * scale.low.abs() };
        }
        scale.low -= widen;
        scale.high += widen;
        scale
    }

    /// Converts a value to axis coordinates.
    fn shown(&self, value: f64) -> f64 {
        let value = value * self.quantity.factor;
        if self.quantity.log { value.log10() } else { value }
    }

    /// Returns the place of an axis coordinate \[px\].
    fn place(&self, at: f64) -> f64 {
        let [from, to] = self.ends;
        from + (at - self.low) / (self.high - self.low) * (to - from)
    }

    /// Returns the places of the ticks with their labels: as many as stand apart and differ, or the
    /// middle, where a constant is.
    fn ticks(&self) -> Vec<(f64, String)> {
        let ticks = |most| match self.quantity {
            Quantity { log: true, .. } => log_ticks(self.low, self.high, most),
            Quantity { whole: true, .. } => ticks(self.low, self.high, most, 1.0).0,
            _ => ticks(self.low, self.high, most, 0.0).0,
        };
        let label = |tick: f64| (self.place(tick), self.label(tick));
        let labels = |most| ticks(most).into_iter().map(label).collect::<Vec<_>>();
        let size = |label: &str| if self.ends[0] < self.ends[1] { width_of(label) } else { 0.0 };
        let stand_apart = |labels: &Vec<(f64, String)>| {
            let widest = labels.iter().map(|(_, label)| size(label)).fold(0.0, f64::max);
            let apart = |a: f64, b: f64| (b - a).abs() >= widest + TICKS_APART;
            let mut pairs = labels.windows(2);
            !labels.is_empty() && pairs.all(|two| two[0].1 != two[1].1 && apart(two[0].0, two[1].0))
        };
        let middle = || vec![label(0.5 * (self.low + self.high))];
        (1..=MOST_TICKS).rev().map(labels).find(stand_apart).unwrap_or_else(middle)
    }

    fn label(&self, tick: f64) -> String {
        // All ticks of an axis have the same notation.
        let most = self.low.abs().max(self.high.abs());
        match self.quantity.log {
            true => power_of_ten(tick),
            false if tick == 0.0 || (1e-3..1e6).contains(&most) => short(tick),
            false => scientific(tick),
        }
    }
}

/// Returns whether a panel is a map, made of cells.
fn has_cells(panel: &Panel) -> bool {
    panel.series.iter().any(|series| matches!(series.style, Style::Cells(_)))
}

/// Iterates over the points that determine the axis ranges: the cells, if there are any.
fn ranging(panel: &Panel) -> impl Iterator<Item = &(f64, f64)> {
    let only_cells = has_cells(panel);
    let chosen = move |style: Style| !only_cells || matches!(style, Style::Cells(_));
    panel.series.iter().filter(move |series| chosen(series.style)).flat_map(|series| &series.points)
}

/// Returns the number of steps between the distinct values of x, or of those of y, at least one: on
/// a map, one less than its columns or rows.
fn steps(panel: &Panel, of: fn(&(f64, f64)) -> f64) -> f64 {
    let mut values: Vec<f64> = ranging(panel).map(of).collect();
    values.sort_by(f64::total_cmp);
    values.dedup();
    (values.len().max(2) - 1) as f64
}
