//! The drawer of charts: a title row with the legend, lines of text, and below them lines, curves
//! and signs over two axes, in the same order in every view.

use ratatui::buffer::Buffer;
use ratatui::style::Style;

use crate::tui::app::App;
use crate::tui::appearance::Appearance;
use crate::tui::axis::ChartAxis;
use crate::tui::history::Span;
use crate::tui::plot::Plot;
use crate::tui::raster::Pen;
use crate::tui::theme::Role;
use crate::tui::views::panel::{Lines, ViewArea, dots, entry, lines_above, title};
use rubscope_solver::study::figures::{Panel, Series, Style as Stroke};

/// A chart; what is drawn later covers what is drawn before it.
#[derive(Default)]
pub struct Chart<'a> {
    pub name: &'a str,
    pub legend: Vec<(String, Style)>,
    /// Values at the cursor. They stand in front of the legend, instead of the name, which may
    /// leave them no room.
    pub reading: Option<String>,
    /// Lines of text above the chart.
    pub lines: Lines,
    /// Whether the axes are left out.
    pub bare: bool,
    pub x: ChartAxis,
    pub y: ChartAxis,
    /// Horizontal lines with their labels, which may be empty; one of [`Role::Text`] is solid.
    pub levels: Vec<(f64, &'a str, Role)>,
    /// Marked values of x, with their labels.
    pub marks: &'a [(f64, &'static str)],
    /// The present value of x.
    pub now: Option<f64>,
    /// The value of x under the cursor.
    pub read: Option<f64>,
    /// Curves, from the top to the bottom one.
    pub curves: Vec<(Pen, Curve<'a>)>,
    /// Signs at x and y.
    pub points: Vec<(f64, f64, char, Style)>,
}

/// A curve of a chart.
pub enum Curve<'a> {
    /// A line, interrupted at values that are not finite.
    Line(Points<'a>),
    /// Dots from an x value on, some times as far apart as usual.
    Dots(Points<'a>, f64, f64),
    /// A signal in as many parts as the chart has columns.
    Spans(Box<dyn Fn(usize) -> Vec<Span> + 'a>),
}

type Points<'a> = Box<dyn Iterator<Item = (f64, f64)> + 'a>;

impl<'a> Chart<'a> {
    /// Creates a chart without content.
    pub fn new(name: &'a str, x: ChartAxis, y: ChartAxis) -> Self {
        Self { name, x, y, ..Self::default() }
    }

    /// Draws the chart; `None` if there is no room.
    pub fn draw<'b>(mut self, app: &App, buffer: &'b mut Buffer, at: ViewArea) -> Option<Plot<'b>> {
        let look = &app.appearance;
        let [quiet, focus] = [Role::Quiet, Role::Focus].map(|role| look.style(role));
        if let Some(reading) = self.reading {
            self.name = "";
            self.legend.insert(0, (reading, focus));
        }
        let inside = title(app, buffer, at, self.name, &self.legend);
        let inside = lines_above(app, buffer, inside, &self.lines);
        let plot = if self.bare { Plot::bare } else { Plot::new };
        let mut plot = plot(buffer, inside, self.x, self.y, look)?;
        at.note(app, plot.inner);
        for (level, _, role) in &self.levels {
            let sign = if *role == Role::Text { ['━', '='] } else { ['┈', '.'] };
            plot.level(*level, look.either(sign[0], sign[1]), look.style(*role));
        }
        for (x, _) in self.marks {
            plot.upright(*x, look.either('┊', ':'), quiet);
        }
        for (x, sign) in [(self.now, look.either('│', '|')), (self.read, look.either('╎', '!'))]
        {
            plot.upright(x.unwrap_or(f64::NAN), sign, focus);
        }
        for (pen, curve) in self.curves.into_iter().rev() {
            match curve {
                Curve::Line(points) => plot.curve(points, &pen),
                Curve::Dots(points, from, sparse) => plot.dotted(points, from, sparse, &pen),
                Curve::Spans(of) => plot.spans(&of(plot.columns()), &pen),
            }
        }
        plot.ink();
        for (level, name, _) in self.levels.iter().filter(|(_, name, _)| !name.is_empty()) {
            name_level(&mut plot, self.x, *level, &look.spell(name), quiet);
        }
        for (x, y, sign, style) in self.points {
            plot.point(x, y, sign, style);
        }
        name_marks(&mut plot, self.marks, app);
        Some(plot)
    }
}

/// Returns the pen of a series of a panel; `None` if it is dotted.
fn pen(look: &Appearance, series: &Series) -> Option<Pen> {
    match series.style {
        Stroke::Line(0) => Some(look.first()),
        Stroke::Line(1) => Some(look.second()),
        Stroke::Dashed(_) => {
            Some(Pen { style: look.style(Role::Trouble), sign: 'w', dashed: true })
        }
        _ => None,
    }
}

/// Returns the curves of a panel, over the magnitudes of x.
pub fn curves<'a>(look: &Appearance, panel: &'a Panel) -> Vec<(Pen, Curve<'a>)> {
    let log = panel.y.log;
    let y = move |y: f64| if log { y.log10() } else { y };
    let curve = |series: &'a Series| {
        let points = Box::new(series.points.iter().map(move |at| (at.0.abs(), y(at.1))));
        match pen(look, series) {
            Some(pen) => (pen, Curve::Line(points)),
            None => (look.quiet(), Curve::Dots(points, f64::NEG_INFINITY, 1.0)),
        }
    };
    panel.series.iter().map(curve).collect()
}

/// Returns the legend of a panel: its lines, and its dotted curves, which are less important.
pub fn legend(look: &Appearance, panel: &Panel) -> [Vec<(String, Style)>; 2] {
    let (mut lines, mut dotted) = (Vec::new(), Vec::new());
    for series in &panel.series {
        match pen(look, series) {
            Some(pen) => lines.push(entry(look, &pen, &series.label)),
            None => dotted.push(dots(look, &series.label)),
        }
    }
    [lines, dotted]
}

/// Prints the label of a horizontal level in the row of its line, at the rightmost free position;
/// prints nothing if none is free.
fn name_level(plot: &mut Plot, x: ChartAxis, level: f64, name: &str, style: Style) {
    let Some(row) = plot.row(level) else { return };
    let mut parts = (0..=LEVEL_PLACES).rev().map(|k| f64::from(k) / f64::from(LEVEL_PLACES));
    _ = parts.any(|part| plot.free_note(x.at(part), row, name, style));
}

/// Number of positions along a level that are tried for its label.
const LEVEL_PLACES: u32 = 40;

/// Prints the labels of marked values, each in the highest free row of the chart, otherwise on the
/// axis line. A label that would cover something is left out; its line remains.
fn name_marks(plot: &mut Plot, marks: &[(f64, &str)], app: &App) {
    let style = app.appearance.style(Role::Text);
    for (x, name) in marks {
        let name = app.appearance.spell(name);
        let mut rows = plot.inner.y..plot.inner.bottom();
        if !rows.any(|row| plot.free_note(*x, row, &name, style)) {
            plot.axis_note(*x, &name, style, &app.appearance);
        }
    }
}
