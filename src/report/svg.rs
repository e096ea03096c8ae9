//! A figure as SVG.

use std::io::{Error, Result, Write};

use plotters::coord::Shift;
use plotters::prelude::*;

use super::number::short;
use crate::motion::Verdict;
use crate::scene::keys::is_plain;
use crate::study::figures::{Figure, Panel, Quantity, Series, Style};

/// Factor of the drawing size over the shown size: the backend has whole
/// numbers only, and smooth lines would get steps.
const FINE: u32 = 4;
/// Size of one panel in pixels shown.
const PANEL: (u32, u32) = (960, 400);
/// Height of the title and the note above the panels.
const HEAD: u32 = 60;
/// Width of the names of the series right of a panel, up to `SHORT` letters,
/// and of each letter more.
const NAMES: u32 = 130;
const SHORT: usize = 16;
const LETTER: u32 = 7;

/// Colours that colour-blind readers can distinguish (Okabe and Ito).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(60, 60, 60),
];

type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
type Drawn<T> = std::result::Result<T, Box<dyn std::error::Error>>;

/// Writes a figure.
///
/// # Errors
/// An error of the writer.
pub fn write(figure: &Figure, out: &mut dyn Write) -> Result<()> {
    let mut text = String::new();
    draw(figure, &mut text).map_err(|error| Error::other(error.to_string()))?;
    out.write_all(text.as_bytes())
}

fn draw(figure: &Figure, text: &mut String) -> Drawn<()> {
    let count = u32::try_from(figure.panels.len())?;
    let (width, height) = (PANEL.0, HEAD + PANEL.1 * count);
    let root = SVGBackend::with_string(text, (FINE * width, FINE * height)).into_drawing_area();
    root.fill(&WHITE)?;
    let (head, body) = root.split_vertically(FINE * HEAD);
    write_at(&head, &figure.title, (20, 10), 20)?;
    write_at(&head, &figure.note, (20, 38), 13)?;
    let labels = figure.panels.iter().flat_map(|panel| &panel.series);
    let longest = labels.map(|series| series.label.chars().count()).max().unwrap_or(0);
    let names = NAMES + LETTER * u32::try_from(longest.saturating_sub(SHORT))?;
    for (panel, area) in figure.panels.iter().zip(body.split_evenly((figure.panels.len(), 1))) {
        draw_panel(panel, &area, names)?;
    }
    root.present()?;
    drop((head, body, root));
    let fine = format!("width=\"{}\" height=\"{}\"", FINE * width, FINE * height);
    *text = text.replacen(&fine, &format!("width=\"{width}\" height=\"{height}\""), 1);
    Ok(())
}

/// A length in pixels shown, as drawn.
fn px(length: i32) -> i32 {
    length * FINE as i32
}

fn font(size: i32) -> (&'static str, i32) {
    ("sans-serif", px(size))
}

fn write_at(area: &Area, text: &str, (x, y): (i32, i32), size: i32) -> Drawn<()> {
    // Text of a scene is plain, that of a caller of the library need not be.
    let text: String = text.chars().filter(|c| is_plain(*c)).collect();
    Ok(area.draw_text(&text, &font(size).into_text_style(area), (px(x), px(y)))?)
}

fn draw_panel(panel: &Panel, area: &Area, names: u32) -> Drawn<()> {
    let (columns, rows) = tiles(panel);
    let half_tile = |count: usize| 0.5 / count as f64;
    let margins =
        if has_cells(panel) { (half_tile(columns), half_tile(rows)) } else { (0.0, 0.05) };
    let x = Scale::of(panel, &panel.x, |point| point.0, margins.0);
    let y = Scale::of(panel, &panel.y, |point| point.1, margins.1);
    let mut chart = ChartBuilder::on(area)
        .caption(&panel.title, font(16))
        .margin(px(12))
        .margin_right(FINE * names)
        .x_label_area_size(px(42))
        .y_label_area_size(px(78))
        .build_cartesian_2d(x.low..x.high, y.low..y.high)?;
    let (width, height) = chart.plotting_area().dim_in_pixel();
    let half = |pixels: u32, count: usize| (f64::from(pixels) * half_tile(count + 1)).ceil() as i32;
    let half = (half(width, columns), half(height, rows));
    chart
        .configure_mesh()
        .light_line_style(WHITE)
        .bold_line_style(BLACK.mix(0.15).stroke_width(FINE))
        .axis_style(BLACK.stroke_width(FINE))
        .set_all_tick_mark_size(px(4))
        .x_desc(panel.x.label.as_ref())
        .y_desc(panel.y.label.as_ref())
        .x_label_formatter(&|tick| x.label(*tick))
        .y_label_formatter(&|tick| y.label(*tick))
        .label_style(font(13))
        .draw()?;
    // A series with a name is drawn last, on top.
    let is_faint = |series: &&Series| series.style == Style::Faint;
    let (faint, named): (Vec<&Series>, Vec<&Series>) = panel.series.iter().partition(is_faint);
    for series in faint.into_iter().chain(named.iter().copied()) {
        let points = series.points.iter().map(|point| (x.shown(point.0), y.shown(point.1)));
        let ink = colour(series.style).stroke_width(FINE + FINE / 2);
        match series.style {
            Style::Faint => {
                let grey = BLACK.mix(0.25).stroke_width(FINE / 2);
                chart.draw_series(LineSeries::new(points, grey))?;
            }
            Style::Line(_) => {
                chart.draw_series(LineSeries::new(points, ink))?;
            }
            Style::Dashed(_) => {
                chart.draw_series(DashedLineSeries::new(points, px(6), px(3), ink))?;
            }
            Style::Cells(_) => {
                let corners = [(-half.0, -half.1), half];
                let fill = colour(series.style).filled();
                let tile = |at| EmptyElement::at(at) + Rectangle::new(corners, fill);
                chart.draw_series(points.map(tile))?;
            }
            Style::Discs(_, radius) => {
                let pale = colour(series.style).mix(0.5).stroke_width(FINE);
                chart.draw_series(LineSeries::new(points.clone(), pale))?;
                let fill = colour(series.style).filled();
                chart.draw_series(points.map(|at| Circle::new(at, px(radius), fill)))?;
            }
            Style::Dots => {
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
            let ink = BLACK.stroke_width(FINE);
            chart.draw_series(DashedLineSeries::new(line, px(3), px(3), ink))?;
            let style = font(13).into_text_style(area);
            chart.draw_series([Text::new(mark.label, (at, y.high), style)])?;
        }
    }
    draw_names(&named, area, names)
}

/// The names of the series, right of the panel.
fn draw_names(named: &[&Series], area: &Area, names: u32) -> Drawn<()> {
    let left = i32::try_from(PANEL.0.saturating_sub(names) + 10)?;
    for (series, row) in named.iter().zip(0..) {
        let top = 40 + 20 * row;
        let at = |dx: i32, dy: i32| (px(left + dx), px(top + dy));
        let fill = colour(series.style);
        match series.style {
            Style::Cells(_) => area.draw(&Rectangle::new([at(0, 0), at(18, 12)], fill.filled()))?,
            Style::Dashed(_) => {
                for dash in [0, 11] {
                    let bar = [at(dash, 5), at(dash + 7, 8)];
                    area.draw(&Rectangle::new(bar, fill.filled()))?;
                }
            }
            Style::Discs(_, radius) => {
                area.draw(&Circle::new(at(9, 6), px(radius), fill.filled()))?;
            }
            Style::Dots => area.draw(&Circle::new(at(9, 6), px(3) / 2, fill.filled()))?,
            Style::Edge => {
                area.draw(&TriangleMarker::new(at(9, 6), px(5), fill.stroke_width(FINE)))?;
            }
            Style::Line(_) | Style::Faint => {
                area.draw(&Rectangle::new([at(0, 5), at(18, 8)], fill.filled()))?;
            }
        }
        write_at(area, &series.label, (left + 24, top), 13)?;
    }
    Ok(())
}

/// One axis: its range in the units shown, powers of ten where logarithmic.
#[derive(Clone, Copy, Debug)]
struct Scale<'a> {
    quantity: &'a Quantity,
    low: f64,
    high: f64,
}

impl<'a> Scale<'a> {
    /// The range of the cells, or without any of all points, widened by this
    /// part of itself; a logarithmic axis without cells has whole decades.
    fn of(panel: &Panel, quantity: &'a Quantity, of: fn(&(f64, f64)) -> f64, margin: f64) -> Self {
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
        // A constant needs a range, or there is no axis.
        let smallest = 1e-9 * scale.low.abs().max(scale.high.abs()).max(1e-3);
        let widen = (margin * (scale.high - scale.low)).max(smallest);
        scale.low -= widen;
        scale.high += widen;
        scale
    }

    fn shown(&self, value: f64) -> f64 {
        let value = value * self.quantity.factor;
        if self.quantity.log { value.log10() } else { value }
    }

    fn label(&self, tick: f64) -> String {
        if !self.quantity.log {
            short(tick)
        } else if (tick - tick.round()).abs() < 1e-9 {
            short(10_f64.powf(tick))
        } else {
            String::new()
        }
    }
}

fn has_cells(panel: &Panel) -> bool {
    panel.series.iter().any(|series| matches!(series.style, Style::Cells(_)))
}

/// The points that set the range of the axes: those of cells, if there are any.
fn ranging(panel: &Panel) -> impl Iterator<Item = &(f64, f64)> {
    let only_cells = has_cells(panel);
    let chosen = move |series: &&Series| !only_cells || matches!(series.style, Style::Cells(_));
    panel.series.iter().filter(chosen).flat_map(|series| &series.points)
}

/// Steps between the different values of x and of y, at least one each.
fn tiles(panel: &Panel) -> (usize, usize) {
    let count = |of: fn(&(f64, f64)) -> f64| {
        let mut values: Vec<f64> = ranging(panel).map(of).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values.len().max(2) - 1
    };
    (count(|point| point.0), count(|point| point.1))
}

fn colour(style: Style) -> RGBColor {
    let index = match style {
        Style::Faint => 0,
        Style::Line(n) | Style::Dashed(n) | Style::Discs(n, _) => n,
        Style::Cells(verdict) => return colour_of(verdict),
        Style::Dots => return RGBColor(120, 120, 120),
        Style::Edge => return BLACK,
    };
    *COLOURS.get(index % COLOURS.len()).unwrap_or(&BLACK)
}

/// Colour of a verdict; verdicts differ in lightness too, for colour-blind readers.
fn colour_of(verdict: Verdict) -> RGBColor {
    match verdict {
        Verdict::Decay => RGBColor(240, 240, 240),
        Verdict::Bounce => RGBColor(190, 210, 235),
        Verdict::Slip => RGBColor(240, 190, 70),
        Verdict::Locked => RGBColor(40, 70, 140),
        Verdict::Adhesive => RGBColor(200, 70, 90),
        Verdict::Failed => RGBColor(0, 0, 0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::figures::Mark;

    fn drawn(points: Vec<(f64, f64)>, log: bool) -> String {
        let x = Quantity { log, ..Quantity::SPEED };
        let y = Quantity::new("u_m", "u < [um]", 1e6);
        let lines = [Style::Faint, Style::Line(0), Style::Dashed(1)];
        let others = [Style::Cells(Verdict::Slip), Style::Discs(2, 5), Style::Dots, Style::Edge];
        let series = |style: &Style| Series::new("a & b", *style, points.clone());
        let series = lines.iter().chain(&others).map(series).collect();
        let mut panel = Panel::new("(a)", x, y, series);
        panel.marks.push(Mark { x: 2.0, label: "Omega_c" });
        let figure = Figure { title: "T".into(), note: "N".into(), panels: vec![panel; 2] };
        let mut out = Vec::new();
        write(&figure, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn every_style_is_drawn_and_text_is_escaped() {
        let svg = drawn(vec![(1.0, 1e-6), (2.0, 3e-6), (4.0, -1e-6)], false);
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert!(svg.contains(">\nT\n<") && svg.contains("Omega_c"));
        assert!(svg.contains("a &amp; b") && svg.contains("u &lt; [um]"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn nothing_and_constants_can_be_drawn() {
        for points in [vec![], vec![(1.0, 0.0)], vec![(1.0, 5.0), (1.0, 5.0)]] {
            for log in [false, true] {
                assert!(!drawn(points.clone(), log).contains("NaN"));
            }
        }
    }
}
