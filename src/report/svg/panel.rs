//! One panel of a figure: axes, ranges, ticks (powers of ten on a logarithmic axis), legend and
//! series.

use plotters::coord::CoordTranslate;
use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;
use plotters::prelude::*;

use super::paper::{Area, Drawn, FINE, TEXT, colour, font, px, strokes, width_of, write_at};
use super::{LEFT, LINE};
use crate::report::number::short;
use crate::report::ticks::{log_ticks, power_of_ten, scientific, ticks};
use rubscope_solver::study::figures::{Panel, Quantity, Series, Style};

/// Height of a panel's title \[px\].
const TITLE: u32 = 24;
/// Width of a legend sample, and distance between two legend entries \[px\].
const SAMPLE: u32 = 26;
const APART: u32 = 18;
/// Width of the tick labels and the axis label, left of the axis \[px\].
const LABELS: i32 = 72;
/// Half the width of a bar of [`Style::Bars`], in units of x.
const HALF: f64 = 0.3;

/// Returns the fill of a bar, pale enough for marks on it to stay visible.
fn pale(style: Style) -> ShapeStyle {
    colour(style).mix(0.2).filled()
}

///
/// # Errors
/// The drawing library failed.
pub fn draw(panel: &Panel, area: &Area) -> Drawn<()> {
    let (columns, rows) = tiles(panel);
    let half_tile = |count: usize| 0.5 / count as f64;
    let margins =
        if has_cells(panel) { (half_tile(columns), half_tile(rows)) } else { (0.0, 0.05) };
    let x = Scale::of(panel, &panel.x, |point| point.0, margins.0);
    let y = Scale::of(panel, &panel.y, |point| point.1, margins.1);
    write_at(area, &panel.title, (LEFT, 4), 17)?;
    let top = if panel.title.is_empty() { 0 } else { TITLE };
    let (_, rest) = area.split_vertically(FINE * top);
    let names = draw_names(panel, &rest)?;
    let (_, rest) = rest.split_vertically(FINE * names);
    let mut chart = ChartBuilder::on(&rest)
        .margin_top(px(if panel.marks.is_empty() { 6 } else { 22 }))
        .margin_bottom(px(8))
        .margin_left(px(16))
        .margin_right(px(24))
        .x_label_area_size(px(44))
        .y_label_area_size(px(LABELS))
        .build_cartesian_2d(x.axis(), y.axis())?;
    let (width, height) = chart.plotting_area().dim_in_pixel();
    let half =
        |pixels: u32, count: usize| 1 + (f64::from(pixels) * half_tile(count + 1)).ceil() as i32;
    let half = (half(width, columns), half(height, rows));
    let tile = f64::from(width) / (columns + 1) as f64;
    chart
        .configure_mesh()
        .bold_line_style(BLACK.mix(0.15).stroke_width(FINE))
        .axis_style(BLACK.stroke_width(FINE))
        .set_all_tick_mark_size(px(4))
        .x_desc(panel.x.label.as_ref())
        .y_desc(panel.y.label.as_ref())
        .x_label_formatter(&|tick| x.label(*tick))
        .y_label_formatter(&|tick| y.label(*tick))
        .label_style(font(TEXT))
        .draw()?;
    // Named series are drawn after faint ones, on top of them.
    let is_faint = |series: &&Series| series.style == Style::Faint;
    let (faint, named): (Vec<&Series>, Vec<&Series>) = panel.series.iter().partition(is_faint);
    // Lines and dots on cells get a white rim, to be visible on any colour.
    let rim = has_cells(panel).then(|| WHITE.stroke_width(4 * FINE));
    for series in faint.into_iter().chain(named) {
        let points = series.points.iter().map(|point| (x.shown(point.0), y.shown(point.1)));
        let ink = colour(series.style).stroke_width(FINE + FINE / 2);
        let is_line = matches!(series.style, Style::Line(_) | Style::Dashed(_) | Style::Dotted(_));
        if let Some(rim) = rim.filter(|_| is_line) {
            chart.draw_series(LineSeries::new(points.clone(), rim))?;
        }
        match series.style {
            Style::Faint => {
                let thin = colour(series.style).stroke_width(FINE / 2);
                chart.draw_series(LineSeries::new(points, thin))?;
            }
            Style::Line(_) => {
                chart.draw_series(LineSeries::new(points, ink))?;
            }
            Style::Dashed(_) => {
                chart.draw_series(DashedLineSeries::new(points, px(6), px(3), ink))?;
            }
            Style::Dotted(_) => {
                chart.draw_series(DashedLineSeries::new(points, px(2), px(3), ink))?;
            }
            Style::Cells(_) => {
                let fill = colour(series.style).filled();
                let pixels = |at: &(f64, f64)| chart.as_coord_spec().translate(at).0;
                let places: Vec<(f64, f64)> = points.collect();
                // Adjacent cells of a row are merged into one rectangle.
                let are_beside = |a: &(f64, f64), b: &(f64, f64)| {
                    let apart = f64::from(pixels(b) - pixels(a));
                    a.1 == b.1 && apart > 0.0 && apart < 1.5 * tile
                };
                let rows = places.chunk_by(are_beside).filter_map(|cells| {
                    let (first, last) = (cells.first()?, cells.last()?);
                    let corners =
                        [(-half.0, -half.1), (pixels(last) - pixels(first) + half.0, half.1)];
                    Some(EmptyElement::at(*first) + Rectangle::new(corners, fill))
                });
                let rows: Vec<_> = rows.collect();
                chart.draw_series(rows)?;
            }
            Style::Discs(number, radius) => {
                let strokes = strokes(number, radius);
                let ink = colour(series.style).stroke_width(2 * FINE);
                for stroke in &strokes {
                    let drawn = |at| EmptyElement::at(at) + PathElement::new(stroke.clone(), ink);
                    chart.draw_series(points.clone().map(drawn))?;
                }
                if strokes.is_empty() {
                    let fill = colour(series.style).filled();
                    chart.draw_series(points.map(|at| Circle::new(at, px(radius), fill)))?;
                }
            }
            Style::Rings(_, radius) => {
                let ink = colour(series.style).stroke_width(FINE);
                chart.draw_series(points.map(|at| Circle::new(at, px(radius), ink)))?;
            }
            Style::Bars(_) => {
                let ends: Vec<(f64, f64)> = points.collect();
                let bars = ends.chunks_exact(2).filter_map(|ends| {
                    let [(x, low), (_, high)] = ends else { return None };
                    Some(Rectangle::new([(x - HALF, *low), (x + HALF, *high)], pale(series.style)))
                });
                chart.draw_series(bars)?;
            }
            Style::Dots => {
                let around = points.clone().filter(|_| rim.is_some());
                chart.draw_series(around.map(|at| Circle::new(at, px(5) / 2, WHITE.filled())))?;
                let fill = colour(series.style).filled();
                chart.draw_series(points.map(|at| Circle::new(at, px(3) / 2, fill)))?;
            }
            Style::Edge => {
                let edge = points.map(|at| (at.0, y.low));
                chart.draw_series(edge.map(|at| TriangleMarker::new(at, px(5), ink)))?;
            }
        }
    }
    for mark in &panel.marks {
        let at = x.shown(mark.x);
        if (x.low..=x.high).contains(&at) {
            let line = [(at, y.low), (at, y.high)];
            if let Some(rim) = rim {
                chart.draw_series(LineSeries::new(line, rim))?;
            }
            let ink = BLACK.stroke_width(FINE);
            chart.draw_series(DashedLineSeries::new(line, px(3), px(3), ink))?;
            // The label is centred above the line.
            let (left, top) = rest.get_base_pixel();
            let (column, row) = chart.backend_coord(&(at, y.high));
            let half = px(width_of(mark.label) as i32) / 2;
            let place = (column - left - half, row - top - px(19));
            rest.draw_text(mark.label, &font(TEXT).into_text_style(&rest), place)?;
        }
    }
    Ok(())
}

/// Draws the legend (without faint or empty series); returns its height.
fn draw_names(panel: &Panel, area: &Area) -> Drawn<u32> {
    let width = area.dim_in_pixel().0 / FINE;
    let start = LABELS as u32 + 16;
    let (mut left, mut row) = (start, 0);
    let is_named = |series: &&Series| series.style != Style::Faint && !series.points.is_empty();
    for series in panel.series.iter().filter(is_named) {
        let long = SAMPLE + width_of(&series.label);
        if left > start && left + long > width {
            (left, row) = (start, row + 1);
        }
        let at = (i32::try_from(left)?, i32::try_from(4 + LINE * row)?);
        draw_sample(series.style, at, area)?;
        write_at(area, &series.label, (at.0 + SAMPLE as i32, at.1), TEXT)?;
        left += long + APART;
    }
    Ok(if left == start { 0 } else { 4 + LINE * (row + 1) })
}

/// Draws the legend sample of a series.
fn draw_sample(style: Style, (left, top): (i32, i32), area: &Area) -> Drawn<()> {
    let at = |dx: i32, dy: i32| (px(left + dx), px(top + dy));
    let fill = colour(style);
    match style {
        Style::Cells(_) => {
            area.draw(&Rectangle::new([at(0, 2), at(18, 14)], fill.filled()))?;
        }
        Style::Dashed(_) => {
            for dash in [0, 11] {
                area.draw(&Rectangle::new([at(dash, 7), at(dash + 7, 10)], fill.filled()))?;
            }
        }
        Style::Dotted(_) => {
            for dot in [0, 6, 12] {
                area.draw(&Rectangle::new([at(dot, 7), at(dot + 3, 10)], fill.filled()))?;
            }
        }
        Style::Discs(number, radius) => {
            let strokes = strokes(number, radius);
            for stroke in &strokes {
                let ink = fill.stroke_width(2 * FINE);
                let drawn = PathElement::new(stroke.clone(), ink);
                area.draw(&(EmptyElement::at(at(9, 8)) + drawn))?;
            }
            if strokes.is_empty() {
                area.draw(&Circle::new(at(9, 8), px(radius), fill.filled()))?;
            }
        }
        Style::Rings(_, radius) => {
            area.draw(&Circle::new(at(9, 8), px(radius), fill.stroke_width(FINE)))?;
        }
        Style::Bars(_) => area.draw(&Rectangle::new([at(0, 2), at(18, 14)], pale(style)))?,
        Style::Dots => area.draw(&Circle::new(at(9, 8), px(3) / 2, fill.filled()))?,
        Style::Edge => {
            area.draw(&TriangleMarker::new(at(9, 9), px(5), fill.stroke_width(FINE)))?;
        }
        Style::Line(_) | Style::Faint => {
            area.draw(&Rectangle::new([at(0, 7), at(18, 10)], fill.filled()))?;
        }
    }
    Ok(())
}

/// Largest number of ticks on an axis.
const MOST_TICKS: usize = 8;

/// Range of an axis, in its coordinates: shown unit, and logarithm on a logarithmic axis.
#[derive(Clone, Copy, Debug)]
pub struct Scale<'a> {
    quantity: &'a Quantity,
    pub low: f64,
    pub high: f64,
}

impl<'a> Scale<'a> {
    /// Creates the range of the cells or, without cells, of all points, widened at each end by the
    /// fraction `margin`. A logarithmic axis without cells covers whole decades instead. `of`
    /// returns the coordinate of a point on this axis.
    pub fn of(
        panel: &Panel,
        quantity: &'a Quantity,
        of: fn(&(f64, f64)) -> f64,
        margin: f64,
    ) -> Self {
        let mut scale = Self { quantity, low: f64::INFINITY, high: f64::NEG_INFINITY };
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
            widen = 1e-9 * scale.low.abs().max(1e-3);
        }
        scale.low -= widen;
        scale.high += widen;
        scale
    }

    /// Converts a value to axis coordinates: shown unit, and logarithm if the axis is logarithmic.
    pub fn shown(&self, value: f64) -> f64 {
        let value = value * self.quantity.factor;
        if self.quantity.log { value.log10() } else { value }
    }

    /// Returns the axis in the form the drawing library needs.
    pub fn axis(&self) -> Axis {
        let ticks = if self.quantity.log {
            log_ticks(self.low, self.high, MOST_TICKS)
        } else {
            ticks(self.low, self.high, MOST_TICKS).0
        };
        Axis { range: RangedCoordf64::from(self.low..self.high), ticks }
    }

    /// Formats the label of a tick, given in axis coordinates.
    pub fn label(&self, tick: f64) -> String {
        if self.quantity.log {
            return power_of_ten(tick);
        }
        // All ticks of an axis have the same notation.
        let most = self.low.abs().max(self.high.abs());
        let plain = tick == 0.0 || (1e-3..1e6).contains(&most);
        let text = if plain { short(tick) } else { scientific(tick) };
        text.replace('-', "−")
    }
}

/// A range with its own ticks; those of the drawing library are not always round.
pub struct Axis {
    range: RangedCoordf64,
    ticks: Vec<f64>,
}

impl Ranged for Axis {
    type FormatOption = DefaultFormatting;
    type ValueType = f64;

    fn map(&self, value: &f64, limit: (i32, i32)) -> i32 {
        self.range.map(value, limit)
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        // Minor grid lines are not drawn.
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.range.range()
    }
}

/// Returns whether a panel is a map, made of cells.
pub fn has_cells(panel: &Panel) -> bool {
    panel.series.iter().any(|series| matches!(series.style, Style::Cells(_)))
}

/// Iterates over the points that determine the axis ranges: the cells, if there are any.
fn ranging(panel: &Panel) -> impl Iterator<Item = &(f64, f64)> {
    let only_cells = has_cells(panel);
    let chosen = move |style: Style| !only_cells || matches!(style, Style::Cells(_));
    panel.series.iter().filter(move |series| chosen(series.style)).flat_map(|series| &series.points)
}

/// Returns the number of steps between the distinct values of x, and of those of y, at least one
/// each: on a map, one less than its columns and rows.
pub fn tiles(panel: &Panel) -> (usize, usize) {
    let count = |of: fn(&(f64, f64)) -> f64| {
        let mut values: Vec<f64> = ranging(panel).map(of).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values.len().max(2) - 1
    };
    (count(|point| point.0), count(|point| point.1))
}
