//! A sweep: the selected knob goes from its value to another by itself, one
//! value after the verdict of the one before is on the screen.

use super::{App, InputMode};
use crate::scene::Value;
use crate::tui::engine::FullRunState;
use crate::tui::knobs::Knob;

/// Values of a sweep of a number that is not whole.
const VALUES: u32 = 200;
/// Most values of a whole number.
const MOST_WHOLE: u64 = 1000;
/// Stretches of one verdict that are told at the end.
const TOLD: usize = 4;

/// Neighbouring values with one verdict.
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
    /// How many values there are.
    all: usize,
    /// Stretches of one verdict so far.
    found: Vec<Stretch>,
}

impl App {
    /// Asks for the end of the sweep.
    pub(super) fn ask_sweep(&mut self) {
        let Some(knob) = self.selected() else { return };
        match knob.get(&self.scene) {
            Value::Real(_) | Value::Whole(_) => {
                self.knobs.forget_refusal();
                self.dialogue.open(InputMode::Sweeping(String::new()));
            }
            _ => self.status = Some(format!("{} has no numbers to sweep", knob.label)),
        }
    }

    /// The question in the last line.
    pub fn sweep_question(&self, typed: &str) -> Option<String> {
        let knob = self.selected()?;
        let now = knob.text(&self.scene);
        Some(format!("sweep {} from {now} to: {typed}_", knob.label))
    }

    /// Starts the sweep to what was typed; it can be undone as one turn.
    pub(super) fn begin_sweep(&mut self, text: &str) {
        let Some(knob) = self.selected() else { return };
        let to = match knob.parse(text).and_then(|to| knob.set(&self.scene, to.clone()).map(|_| to))
        {
            Ok(to) => to,
            Err(error) => {
                self.knobs.refuse(knob, &error);
                self.status = self.knobs.refusal().cloned();
                return;
            }
        };
        self.dialogue.close();
        let mut rest = values(&knob.get(&self.scene), &to);
        rest.reverse();
        self.knobs.remember(self.past());
        self.knobs.sweep = Some(Sweep { knob, all: rest.len(), rest, found: Vec::new() });
    }

    /// A frame has been shown: if it had a verdict, the next value.
    pub(super) fn sweep_on(&mut self) {
        let done = match &self.results().full_run {
            None | Some(FullRunState::Computing(_)) => return,
            Some(FullRunState::Done(_) | FullRunState::GivenUp(_)) => self.verdict_word(),
        };
        let Some(sweep) = &mut self.knobs.sweep else { return };
        let value = sweep.knob.shown(&sweep.knob.get(&self.scene));
        match sweep.found.last_mut().filter(|stretch| stretch.word == done) {
            Some(stretch) => (stretch.to, stretch.count) = (value, stretch.count + 1),
            None => {
                let (from, to) = (value.clone(), value);
                sweep.found.push(Stretch { word: done, from, to, count: 1 });
            }
        }
        match sweep.rest.pop() {
            Some(next) => {
                let knob = sweep.knob;
                // Both ends were checked; a value between them may be refused alone.
                if let Ok((scene, _)) = knob.set(&self.scene, next) {
                    self.set_turned_scene(scene);
                }
            }
            None => {
                let told = sweep.told();
                self.status = Some(told);
                self.knobs.sweep = None;
            }
        }
    }

    /// Ends a sweep where it is.
    pub(super) fn stop_sweep(&mut self) {
        if let Some(sweep) = self.knobs.sweep.take() {
            self.status = Some(sweep.told());
        }
    }
}

impl Sweep {
    /// How far it is, for the last line.
    pub fn progress(&self) -> String {
        let done = self.all.saturating_sub(self.rest.len());
        let part = 100 * done / self.all.max(1);
        format!("sweeping {}: {part} %; any key stops", self.knob.label)
    }

    /// The verdicts in one line, locks first, then the longest stretches:
    /// `speed: LOCKED 412 to 460 rad/s, DECAY 300 to 411 rad/s`.
    fn told(&self) -> String {
        let shown = |stretch: &Stretch| match stretch.from == stretch.to {
            true => format!("{} {}", stretch.word, stretch.from),
            false => format!("{} {} to {}", stretch.word, stretch.from, stretch.to),
        };
        let mut found: Vec<&Stretch> = self.found.iter().collect();
        if found.len() > TOLD {
            let locks = |stretch: &Stretch| stretch.word == "LOCKED";
            found.sort_by_key(|stretch| (!locks(stretch), std::cmp::Reverse(stretch.count)));
        }
        let mut parts: Vec<String> = found.iter().take(TOLD).map(|found| shown(found)).collect();
        if found.len() > TOLD {
            parts.push(format!("and {} shorter stretches", found.len() - TOLD));
        }
        format!("{}: {}", self.knob.label, parts.join(", "))
    }
}

/// The values after the first, up to the last: even steps, or even ratios where
/// both have one sign and are far apart.
fn values(from: &Value, to: &Value) -> Vec<Value> {
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
        (Value::Real(from), Value::Real(to)) => {
            let ratio = to / from;
            let far = ratio > 0.0 && ratio.is_finite() && !(0.1..=10.0).contains(&ratio);
            let value = |k: u32| {
                let part = f64::from(k) / f64::from(VALUES);
                let x = if far { from * ratio.powf(part) } else { from + part * (to - from) };
                // Few digits, as one would type them.
                format!("{x:.5e}").parse().unwrap_or(x)
            };
            let between = (1..VALUES).map(value);
            between.chain([*to]).map(Value::Real).collect()
        }
        _ => Vec::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_go_from_one_end_to_the_other() {
        let reals = values(&Value::Real(300.0), &Value::Real(500.0));
        assert_eq!((reals.len(), &reals[0]), (200, &Value::Real(301.0)));
        assert_eq!(reals.last(), Some(&Value::Real(500.0)));
        let powers = values(&Value::Real(1e3), &Value::Real(1e7));
        assert_eq!(powers[99], Value::Real(1e5));
        let down = values(&Value::Whole(5), &Value::Whole(2));
        assert_eq!(down, [4, 3, 2].map(Value::Whole));
        assert!(values(&Value::Whole(5), &Value::Whole(5)).is_empty());
    }
}
