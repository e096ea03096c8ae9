//! A figure as data: panels with series over two quantities, all in SI units.

use std::borrow::Cow;

use crate::motion::Verdict;

/// A figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// Title, one line.
    pub title: String,
    /// Conditions of the figure, shown below the title.
    pub note: String,
    /// Explanation in paragraphs, shown below the panels.
    pub caption: Vec<String>,
    /// Number of panels in a row.
    pub columns: usize,
    /// Panels, row by row.
    pub panels: Vec<Panel>,
}

/// A pair of axes with its series.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Title; empty if the figure has only one panel.
    pub title: String,
    /// Horizontal axis.
    pub x: Quantity,
    /// Vertical axis.
    pub y: Quantity,
    /// Series, in the order in which they are drawn.
    pub series: Vec<Series>,
    /// Marked values of x.
    pub marks: Vec<Mark>,
}

/// Quantity of an axis.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Column name in files, with the SI unit.
    pub column: Cow<'static, str>,
    /// Axis label, with the displayed unit.
    pub label: Cow<'static, str>,
    /// Displayed value of one SI unit.
    pub factor: f64,
    /// Whether the axis is logarithmic.
    pub log: bool,
    /// Whether the values are whole numbers.
    pub whole: bool,
}

/// A curve or a set of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in files.
    pub name: String,
    /// Name in the legend.
    pub label: String,
    /// Line or symbol.
    pub style: Style,
    /// Points `(x, y)`, in SI units; a curve is interrupted where y is not finite.
    pub points: Vec<(f64, f64)>,
}

/// Line or symbol style of a series. Colours are given by their index.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// Solid line of a colour.
    Line(usize),
    /// Dashed line of a colour.
    Dashed(usize),
    /// Dotted line of a colour.
    Dotted(usize),
    /// Thin grey line without a legend entry.
    Faint,
    /// Map cells in the colour of a verdict.
    Cells(Verdict),
    /// Discs of a colour and a radius in pixels.
    Discs(usize, i32),
    /// Rings of a colour and a radius in pixels.
    Rings(usize, i32),
    /// Pale vertical bars of a colour, each from a point to the next one.
    Bars(usize),
    /// Small grey dots.
    Dots,
    /// Triangles on the lower edge, for values that the axis cannot show.
    Edge,
}

/// A labelled vertical line.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Position, in SI units.
    pub x: f64,
    /// Label.
    pub label: &'static str,
}

impl Figure {
    /// Creates a figure with panels below each other, without a caption.
    #[must_use]
    pub fn new(title: impl Into<String>, note: impl Into<String>, panels: Vec<Panel>) -> Self {
        let (title, note) = (title.into(), note.into());
        Self { title, note, caption: Vec::new(), columns: 1, panels }
    }
}

impl Quantity {
    /// Time, displayed in milliseconds.
    pub const TIME: Self = Self::new("t_s", "time t [ms]", 1e3);
    /// Rotor speed.
    pub const SPEED: Self = Self::new("speed_rad_s", "rotor speed Ω [rad/s]", 1.0);

    /// Creates a quantity for a linear axis; `factor` is the displayed value of one SI unit.
    #[must_use]
    pub const fn new(column: &'static str, label: &'static str, factor: f64) -> Self {
        let (column, label) = (Cow::Borrowed(column), Cow::Borrowed(label));
        Self { column, label, factor, log: false, whole: false }
    }

    /// Creates a quantity for a logarithmic axis, displayed in SI units.
    #[must_use]
    pub const fn log(column: &'static str, label: &'static str) -> Self {
        let mut quantity = Self::new(column, label, 1.0);
        quantity.log = true;
        quantity
    }

    /// Creates a quantity of whole numbers.
    #[must_use]
    pub const fn whole(column: &'static str, label: &'static str) -> Self {
        let mut quantity = Self::new(column, label, 1.0);
        quantity.whole = true;
        quantity
    }
}

impl Series {
    /// Creates a series from the finite points.
    #[must_use]
    pub fn new(
        label: impl Into<String>,
        style: Style,
        points: impl IntoIterator<Item = (f64, f64)>,
    ) -> Self {
        let points = points.into_iter().filter(|(x, y)| x.is_finite() && y.is_finite()).collect();
        let label = label.into();
        Self { name: label.clone(), label, style, points }
    }

    /// Sets another name for files.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }
}

impl Panel {
    /// Creates a panel without marks.
    #[must_use]
    pub fn new(title: &str, x: Quantity, y: Quantity, series: Vec<Series>) -> Self {
        Self { title: title.to_string(), x, y, series, marks: Vec::new() }
    }

    /// Returns whether no series has a value.
    #[must_use]
    pub fn is_bare(&self) -> bool {
        !self.series.iter().flat_map(|series| &series.points).any(|point| point.1.is_finite())
    }

    /// Returns whether all series are curves over the same values of x.
    #[must_use]
    pub fn shares_x(&self) -> bool {
        let xs = |series: &Series| series.points.iter().map(|point| point.0).collect::<Vec<_>>();
        let mut all = self.series.iter().map(xs);
        let first = all.next();
        let is_cells = |series: &Series| matches!(series.style, Style::Cells(_));
        all.all(|xs| Some(xs) == first) && !self.series.iter().any(is_cells)
    }
}
