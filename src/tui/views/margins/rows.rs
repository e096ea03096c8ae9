//! The rows of the margins: names, numbers, and what Enter does on them.

use super::{KNOBS, LiveMargins};
use crate::report::number::{rounded, short};
use crate::scene::ContactLaw;
use crate::study::margins::{Limit, LimitName, Margins, Quantity, Side};
use crate::tui::app::App;
use crate::tui::axis::readable;
use crate::tui::knobs::{Knob, knob_of, number};
use crate::tui::views::Opening;

/// Digits of a limit.
pub const DIGITS: usize = 5;

/// From this factor on, a margin is told as one.
const FACTORS: f64 = 10.0;

/// A row: a limit, or one that is still searched.
#[derive(Clone, Copy, Debug)]
pub enum Row<'a> {
    /// A limit that is known.
    Limit(&'a Limit),
    /// The smallest lasting pulse under a law.
    Searched(LimitName, ContactLaw),
}

impl LiveMargins {
    /// Margins in which nothing was searched yet.
    pub fn of(margins: Margins) -> Self {
        let awaited = margins.laws().to_vec();
        Self { margins, awaited }
    }

    /// The rows, in the order of the limits; what is searched is among the pulses.
    pub fn rows(&self) -> Vec<Row<'_>> {
        let limits = &self.margins.limits;
        let own = self.margins.scene.solver.contact;
        let searched =
            self.awaited.iter().map(|law| Row::Searched(LimitName::lasting(*law, own), *law));
        let place = limits.iter().rposition(|limit| limit.quantity == Quantity::Pulse);
        let (before, after) = limits.split_at(place.map_or(0, |place| place + 1));
        before.iter().map(Row::Limit).chain(searched).chain(after.iter().map(Row::Limit)).collect()
    }
}

impl<'a> Row<'a> {
    /// Which limit.
    pub fn name(&self) -> LimitName {
        match self {
            Self::Limit(limit) => limit.name,
            Self::Searched(name, _) => *name,
        }
    }

    fn limit(&self) -> Option<&'a Limit> {
        match *self {
            Self::Limit(limit) => Some(limit),
            Self::Searched(..) => None,
        }
    }

    /// Its value, if there is such a limit.
    pub fn value(&self) -> Option<f64> {
        self.limit()?.value
    }

    /// Whether it is a load, which limits nothing of the scene.
    pub fn is_load(&self) -> bool {
        self.name().quantity().path().is_none()
    }

    /// On which side of it the scene is.
    pub fn side(&self) -> Option<Side> {
        self.limit()?.side()
    }

    /// Its name in a column.
    pub fn symbol(&self, short: bool) -> &'static str {
        let law = match self {
            Self::Limit(limit) => limit.contact,
            Self::Searched(_, law) => Some(*law),
        };
        let [long, few] = match self.name() {
            LimitName::OmegaC => ["Ω_c"; 2],
            LimitName::OmegaLock => ["Ω_lock"; 2],
            LimitName::LockEnds => ["lock ends"; 2],
            LimitName::OmegaAdhesive => ["adhesive limit", "adhesive"],
            LimitName::LockFold => ["blades give way", "give way"],
            LimitName::WhirlOnset => ["whirl begins", "whirl"],
            LimitName::FlutterSpeed => ["lock flutters", "flutter"],
            LimitName::Coincidence => ["coincidence"; 2],
            LimitName::CoincidenceDifference => ["coincidence (30)", "coinc. (30)"],
            LimitName::TouchingPulse => ["F that touches", "F touches"],
            LimitName::LastingPulse
            | LimitName::LastingPulseUnilateral
            | LimitName::LastingPulseBilateral => match law {
                Some(ContactLaw::Bilateral) => ["F lasts, bilateral", "F lasts bil"],
                Some(ContactLaw::Smooth) => ["F lasts, smooth", "F lasts smo"],
                _ => ["F lasts, unilateral", "F lasts uni"],
            },
            LimitName::PushA => ["push of group a", "push a"],
            LimitName::PushB => ["push of group b", "push b"],
            LimitName::Torque => ["torque"; 2],
            LimitName::Power => ["power"; 2],
            LimitName::BladeAngle => ["blade angle"; 2],
            LimitName::LockEnergy => ["wave energy"; 2],
        };
        if short { few } else { long }
    }

    /// Its value, in a column whose speeds are in rad/s.
    pub fn value_text(&self) -> String {
        let Some(value) = self.value() else { return String::new() };
        match self.name().quantity() {
            Quantity::Speed => number(rounded(value, DIGITS), ""),
            _ => self.with_unit(value),
        }
    }

    /// A value of it, with its unit.
    pub fn with_unit(&self, value: f64) -> String {
        let quantity = self.name().quantity();
        match quantity {
            Quantity::Speed | Quantity::Pulse => number(rounded(value, DIGITS), quantity.unit()),
            _ => readable(value, quantity.unit()),
        }
    }

    /// How far beyond it the scene is, as a part of it.
    pub fn margin(&self) -> Option<f64> {
        self.limit().and_then(|limit| limit.margin)
    }

    /// The same in per cent, or as a factor where it is far.
    pub fn percent_text(&self) -> String {
        self.margin().map_or(String::new(), |margin| match 1.0 + margin {
            factor if factor >= FACTORS => format!("{} x", short(rounded(factor, 3))),
            _ => format!("{:+.1} %", 100.0 * margin),
        })
    }

    /// Why there is no value.
    pub fn reason(&self) -> Option<String> {
        match self {
            Self::Searched(..) => Some("searching ...".into()),
            Self::Limit(limit) if limit.value.is_none() => {
                Some(limit.note.as_ref().map_or("none".into(), |note| format!("none: {note}")))
            }
            Self::Limit(_) => None,
        }
    }

    /// What else is to be said of it.
    pub fn note(&self) -> Option<&'a str> {
        self.limit()?.note.as_deref()
    }

    /// The knobs that move it most.
    pub fn strongest(&self) -> Vec<(&'static str, f64)> {
        self.limit().map_or(Vec::new(), |limit| limit.sensitivities.strongest(KNOBS))
    }

    /// What Enter does on a column of it.
    pub fn opening(&self, column: usize, app: &App) -> Opening {
        let nothing = || Opening::Nothing(format!("{}: {}", self.symbol(false), self.none()));
        let select = |place: usize| {
            let knob = self.strongest().get(place).map(|knob| knob.0);
            knob.map_or_else(nothing, Opening::Select)
        };
        match (column.checked_sub(1), self.name().quantity().path(), self.value()) {
            (Some(place), ..) => select(place),
            (None, None, _) => select(0),
            (None, Some(_), None) => nothing(),
            (None, Some(path), Some(value)) => {
                // Limits of speed are magnitudes; the rotor keeps its sense.
                let backward = app.scene.operation.speed_rad_s < 0.0;
                let speed = self.name().quantity() == Quantity::Speed;
                let value = if speed && backward { -value } else { value };
                Opening::Jump { path, value, to: self.symbol(false).to_string() }
            }
        }
    }

    /// Why Enter does nothing.
    fn none(&self) -> String {
        self.reason().unwrap_or_else(|| "no such knob moves it".into())
    }
}

/// The symbol of a parameter: the last word of the name of its knob.
pub fn knob_symbol(path: &'static str) -> &'static str {
    knob_of(path).map_or(path, Knob::symbol)
}

/// The limit that is nearest to the scene.
pub fn nearest(rows: &[Row]) -> Option<usize> {
    let margins = rows.iter().enumerate();
    let margins = margins.filter_map(|(place, row)| Some((place, row.margin()?.abs())));
    margins.min_by(|a, b| a.1.total_cmp(&b.1)).map(|(place, _)| place)
}

/// A change in per cent by one per cent of a knob, in about three digits.
pub fn change_text(by: f64) -> String {
    match by.abs() {
        0.0..1e-3 => format!("{by:+.4}"),
        1e-3..10.0 => format!("{by:+.3}"),
        10.0..100.0 => format!("{by:+.2}"),
        100.0..1e3 => format!("{by:+.1}"),
        1e3..1e5 => format!("{by:+.0}"),
        _ => format!("{by:+.0e}"),
    }
}
