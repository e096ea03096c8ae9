//! A sweep: the selected knob goes from its value to another by itself, one value after
//! the verdict of the value before is on the screen.

use crate::report::number::{from_shown, in_shown_unit, rounded};
use crate::tui::app::App;
use crate::tui::knobs::Knob;
use rubscope_solver::scene::{Scene, Value};

/// Values of a sweep of a number that is not whole.
const VALUES: u32 = 200;

/// Most values of a whole number.
const MOST_WHOLE: u64 = 1000;

/// Most ranges of one verdict in the summary.
const STRETCHES: usize = 4;

/// Range of neighbouring values with one verdict.
#[derive(Clone, Debug)]
struct Stretch {
    word: String,
    from: String,
    to: String,
    count: usize,
}

/// A sweep under way.
#[derive(Clone, Debug)]
pub struct Sweep {
    knob: &'static Knob,
    /// The values to come, the next one last.
    rest: Vec<Value>,
    /// Number of values.
    all: usize,
    /// Ranges of one verdict so far.
    found: Vec<Stretch>,
}

impl App {
    /// Returns the question in the last line.
    pub fn sweep_question(&self, typed: &str) -> Option<String> {
        let knob = self.selected()?;
        let now = knob.text(&self.scene);
        Some(format!("sweep {} from {now} to: {}", knob.label, knob.typed(typed)))
    }
}

impl Sweep {
    /// Creates a sweep of a knob from one value, which is the present one, to another.
    pub fn new(knob: &'static Knob, from: &Value, to: &Value) -> Self {
        let mut rest = values(from, to, knob.unit());
        rest.reverse();
        Self { knob, all: rest.len(), rest, found: Vec::new() }
    }

    /// Records the verdict at the present value, and returns the knob with its next value.
    pub fn go_on(&mut self, verdict: String, scene: &Scene) -> Option<(&'static Knob, Value)> {
        let value = self.knob.text(scene);
        match self.found.last_mut().filter(|stretch| stretch.word == verdict) {
            Some(stretch) => (stretch.to, stretch.count) = (value, stretch.count + 1),
            None => {
                let (from, to) = (value.clone(), value);
                self.found.push(Stretch { word: verdict, from, to, count: 1 });
            }
        }
        Some((self.knob, self.rest.pop()?))
    }

    /// Returns how far it is, for the last line.
    pub fn progress(&self) -> String {
        let done = self.all.saturating_sub(self.rest.len());
        let part = 100 * done / self.all.max(1);
        format!("sweeping {}: {part} %; any key stops", self.knob.label)
    }

    /// Returns the verdicts in one line, locks first, then the longest stretches: `speed: LOCKED
    /// 412 to 460 rad/s, DECAY 300 to 411 rad/s`.
    pub fn summary(&self) -> String {
        let shown = |stretch: &Stretch| match stretch.from == stretch.to {
            true => format!("{} {}", stretch.word, stretch.from),
            false => format!("{} {} to {}", stretch.word, stretch.from, stretch.to),
        };
        let mut found: Vec<&Stretch> = self.found.iter().collect();
        if found.len() > STRETCHES {
            let locks = |stretch: &Stretch| stretch.word == "LOCKED";
            found.sort_by_key(|stretch| (!locks(stretch), std::cmp::Reverse(stretch.count)));
        }
        let mut parts: Vec<String> =
            found.iter().take(STRETCHES).map(|found| shown(found)).collect();
        if found.len() > STRETCHES {
            parts.push(format!("and {} shorter stretches", found.len() - STRETCHES));
        }
        format!("{}: {}", self.knob.label, parts.join(", "))
    }
}

/// Returns the values after the first, up to the last: even steps, or even ratios where both have
/// one sign and are far apart.
fn values(from: &Value, to: &Value, unit: &str) -> Vec<Value> {
    match (from, to) {
        (Value::Whole(from), Value::Whole(to)) => {
            let count = from.abs_diff(*to).min(MOST_WHOLE);
            let value = |k: u64| if to > from { from + k } else { from - k };
            let mut values: Vec<Value> = (1..=count).map(|k| Value::Whole(value(k))).collect();
            if let Some(last) = values.last_mut() {
                *last = Value::Whole(*to);
            }
            values
        }
        (Value::Real(from), Value::Real(last)) => {
            let [from, to] = [*from, *last].map(|end| in_shown_unit(end, unit).0);
            let ratio = to / from;
            let far = ratio > 0.0 && ratio.is_finite() && !(0.1..=10.0).contains(&ratio);
            let value = |k: u32| {
                let part = f64::from(k) / f64::from(VALUES);
                let x = if far { from * ratio.powf(part) } else { from + part * (to - from) };
                // Few digits, as one would type them.
                from_shown(rounded(x, 6), unit)
            };
            let between = (1..VALUES).map(value);
            between.chain([*last]).map(Value::Real).collect()
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_go_from_one_end_to_the_other() {
        let values = |from, to| super::values(&from, &to, "rad/s");
        let reals = values(Value::Real(300.0), Value::Real(500.0));
        assert_eq!((reals.len(), &reals[0]), (200, &Value::Real(301.0)));
        assert_eq!(reals.last(), Some(&Value::Real(500.0)));
        let powers = values(Value::Real(1e3), Value::Real(1e7));
        assert_eq!(powers[99], Value::Real(1e5));
        let down = values(Value::Whole(5), Value::Whole(2));
        assert_eq!(down, [4, 3, 2].map(Value::Whole));
        assert!(values(Value::Whole(5), Value::Whole(5)).is_empty());
    }
}
