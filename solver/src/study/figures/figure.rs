//! A figure as data: panels of series over two quantities, all in SI units.

use std::borrow::Cow;

use crate::motion::Verdict;

/// One figure.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// One line that says what it shows.
    pub title: String,
    /// The conditions.
    pub note: String,
    /// What it means, in paragraphs below it.
    pub caption: Vec<String>,
    /// How many panels stand in a row.
    pub columns: usize,
    /// Its panels, row by row.
    pub panels: Vec<Panel>,
}

/// One pair of axes.
#[derive(Clone, Debug, PartialEq)]
pub struct Panel {
    /// Title; empty for the only panel of a figure.
    pub title: String,
    /// Horizontal axis.
    pub x: Quantity,
    /// Vertical axis.
    pub y: Quantity,
    /// What is drawn, in order.
    pub series: Vec<Series>,
    /// Special values of x.
    pub marks: Vec<Mark>,
}

/// What an axis measures.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// Name in files, with the SI unit.
    pub column: Cow<'static, str>,
    /// Name on the axis, with the unit shown.
    pub label: Cow<'static, str>,
    /// Number of shown units in one SI unit.
    pub factor: f64,
    /// Whether the axis is logarithmic.
    pub log: bool,
}

/// One curve or set of points.
#[derive(Clone, Debug, PartialEq)]
pub struct Series {
    /// Name in files.
    pub name: String,
    /// Name in the legend.
    pub label: String,
    /// How it is drawn.
    pub style: Style,
    /// `(x, y)`, finite, in SI units.
    pub points: Vec<(f64, f64)>,
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Style {
    /// A line in the colour of this number.
    Line(usize),
    /// A dashed line in the colour of this number.
    Dashed(usize),
    /// A dotted line in the colour of this number.
    Dotted(usize),
    /// A thin grey line without a legend.
    Faint,
    /// Cells of a map, in the colour of this verdict.
    Cells(Verdict),
    /// Discs of this colour number and radius in pixels.
    Discs(usize, i32),
    /// Rings in the same way.
    Rings(usize, i32),
    /// Pale upright bars in the colour of this number, each from a point to the next one.
    Bars(usize),
    /// Small grey dots.
    Dots,
    /// Triangles on the lower edge, for values that the axis cannot show.
    Edge,
}

/// A vertical line.
#[derive(Clone, Debug, PartialEq)]
pub struct Mark {
    /// Where, in SI units.
    pub x: f64,
    /// Its name.
    pub label: &'static str,
}

impl Figure {
    /// A figure of panels below each other, without a caption.
    #[must_use]
    pub fn new(title: impl Into<String>, note: impl Into<String>, panels: Vec<Panel>) -> Self {
        let (title, note) = (title.into(), note.into());
        Self { title, note, caption: Vec::new(), columns: 1, panels }
    }
}

impl Quantity {
    /// Time, shown in milliseconds.
    pub const TIME: Self = Self::new("t_s", "time t [ms]", 1e3);
    /// Rotor speed.
    pub const SPEED: Self = Self::new("speed_rad_s", "rotor speed Ω [rad/s]", 1.0);

    /// A quantity on a linear axis.
    #[must_use]
    pub const fn new(column: &'static str, label: &'static str, factor: f64) -> Self {
        let (column, label) = (Cow::Borrowed(column), Cow::Borrowed(label));
        Self { column, label, factor, log: false }
    }

    /// A quantity on a logarithmic axis, shown in SI units.
    #[must_use]
    pub const fn log(column: &'static str, label: &'static str) -> Self {
        let (column, label) = (Cow::Borrowed(column), Cow::Borrowed(label));
        Self { column, label, factor: 1.0, log: true }
    }
}

impl Series {
    /// A series of the points that are numbers.
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

    /// With another name in files.
    #[must_use]
    pub fn named(self, name: impl Into<String>) -> Self {
        Self { name: name.into(), ..self }
    }
}

impl Panel {
    /// A panel without marks.
    #[must_use]
    pub fn new(title: &str, x: Quantity, y: Quantity, series: Vec<Series>) -> Self {
        Self { title: title.to_string(), x, y, series, marks: Vec::new() }
    }

    /// Whether all series are curves over the same values of x.
    #[must_use]
    pub fn shares_x(&self) -> bool {
        let xs = |series: &Series| series.points.iter().map(|point| point.0).collect::<Vec<_>>();
        let mut all = self.series.iter().map(xs);
        let first = all.next();
        let is_cells = |series: &Series| matches!(series.style, Style::Cells(_));
        all.all(|xs| Some(xs) == first) && !self.series.iter().any(is_cells)
    }
}
