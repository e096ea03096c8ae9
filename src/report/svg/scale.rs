//! One axis of a panel: its range in the units shown, its ticks and their
//! labels; exponents of ten where it is logarithmic.

use plotters::coord::ranged1d::{DefaultFormatting, KeyPointHint, Ranged};
use plotters::coord::types::RangedCoordf64;

use crate::report::number::short;
use crate::report::ticks::{log_ticks, power_of_ten, ticks};
use crate::study::figures::{Panel, Quantity, Style};

/// Most ticks of an axis.
const MOST_TICKS: usize = 8;

/// The range of an axis.
#[derive(Clone, Copy, Debug)]
pub struct Scale<'a> {
    quantity: &'a Quantity,
    pub low: f64,
    pub high: f64,
}

impl<'a> Scale<'a> {
    /// The range of the cells, or without any of all points, widened by this
    /// part of itself; a logarithmic axis without cells has whole decades.
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
            // A constant needs a range, or there is no axis.
            widen = 1e-9 * scale.low.abs().max(1e-3);
        }
        scale.low -= widen;
        scale.high += widen;
        scale
    }

    /// A value in the units shown.
    pub fn shown(&self, value: f64) -> f64 {
        let value = value * self.quantity.factor;
        if self.quantity.log { value.log10() } else { value }
    }

    /// The axis as the drawing library needs it.
    pub fn axis(&self) -> Axis {
        let ticks = if self.quantity.log {
            log_ticks(self.low, self.high, MOST_TICKS)
        } else {
            ticks(self.low, self.high, MOST_TICKS).0
        };
        Axis { range: RangedCoordf64::from(self.low..self.high), ticks }
    }

    /// The label of a tick.
    pub fn label(&self, tick: f64) -> String {
        if self.quantity.log { power_of_ten(tick) } else { short(tick).replace('-', "−") }
    }
}

/// A range with ticks of our own; the library's are not always round.
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
        // Lines are drawn at ticks only.
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> std::ops::Range<f64> {
        self.range.range()
    }
}

/// Whether a panel is a map.
pub fn has_cells(panel: &Panel) -> bool {
    panel.series.iter().any(|series| matches!(series.style, Style::Cells(_)))
}

/// The points that set the range of the axes: those of cells, if there are any.
fn ranging(panel: &Panel) -> impl Iterator<Item = &(f64, f64)> {
    let only_cells = has_cells(panel);
    let chosen = move |style: Style| !only_cells || matches!(style, Style::Cells(_));
    panel.series.iter().filter(move |series| chosen(series.style)).flat_map(|series| &series.points)
}

/// Steps between the different values of x and of y, at least one each.
pub fn tiles(panel: &Panel) -> (usize, usize) {
    let count = |of: fn(&(f64, f64)) -> f64| {
        let mut values: Vec<f64> = ranging(panel).map(of).collect();
        values.sort_by(f64::total_cmp);
        values.dedup();
        values.len().max(2) - 1
    };
    (count(|point| point.0), count(|point| point.1))
}
