//! The knobs, and what can be undone. A value is checked first and refused at its knob.
//! Undo, and the end of a lesson, come back to a scene, and if another one was opened since,
//! also to where it is from and how it was shown.
//!
//! A sweep: the selected knob goes from its value to another by itself, one
//! value after the verdict of the one before is on the screen.

use crate::report::line::clean;
use crate::tui::app::play::Tempo;
use crate::tui::app::{App, InputMode, LessonProgress, Source};
use crate::tui::engine::FullRunState;
use crate::tui::knobs::{KNOBS, Knob, place_of};
use crate::tui::views::ViewId;
use rubscope_solver::motion::Change;
use rubscope_solver::scene::{CheckedScene, SceneError, Value};

/// The knobs, and what can be undone.
#[derive(Clone, Debug, Default)]
pub struct Knobs {
    /// The selected one.
    pub selected: usize,
    /// The reason if its last value was refused.
    pub refusal: Option<String>,
    /// Whether they act on the running motion.
    pub live: bool,
    /// The sweep of one that is under way.
    pub sweep: Option<Sweep>,
    undo: Vec<Past>,
    redo: Vec<Past>,
}

/// Number of changes that can be undone.
const KEPT: usize = 1000;

/// A state to come back to.
#[derive(Clone, Debug, PartialEq)]
pub struct Past {
    scene: CheckedScene,
    opened: CheckedScene,
    source: Option<Source>,
    views: Vec<ViewId>,
    pub(super) tempo: Tempo,
    pub(super) live: bool,
    pub(super) compare: bool,
    lesson: Option<LessonProgress>,
}

impl Knobs {
    /// Selects the one at a place of the table.
    pub(super) fn select(&mut self, place: usize) {
        (self.selected, self.refusal) = (place, None);
    }

    /// Selects the one above or below.
    pub(super) fn walk(&mut self, up: bool) {
        let count = KNOBS.len();
        let next = if up { self.selected + count - 1 } else { self.selected + 1 };
        self.select(next % count);
    }

    /// The last value of a knob was refused.
    pub(super) fn refuse(&mut self, knob: &Knob, error: &SceneError) {
        self.refusal = Some(clean(&knob.refusal(error)));
    }

    /// A refusal is not shown any more.
    pub(super) fn forget_refusal(&mut self) {
        self.refusal = None;
    }

    /// Why the last value was refused.
    pub(super) fn refusal(&self) -> Option<&String> {
        self.refusal.as_ref()
    }

    /// Whether they act on the running motion.
    pub(super) fn is_live(&self) -> bool {
        self.live
    }

    /// They act on the running motion, or no longer.
    pub(super) fn set_live(&mut self, live: bool) {
        self.live = live;
    }

    /// The same by its key; what to say.
    pub(super) fn turn_live(&mut self) -> String {
        self.live = !self.live;
        let how = match self.live {
            true => "live: knobs act on the running motion",
            false => "a knob restarts the run",
        };
        how.into()
    }

    /// Has undo come back to this state.
    pub(super) fn remember(&mut self, past: Past) {
        self.undo.push(past);
        if self.undo.len() > KEPT {
            self.undo.remove(0);
        }
        self.redo.clear();
    }

    /// Number of states that undo can come back to.
    pub(super) fn remembered(&self) -> usize {
        self.undo.len()
    }

    /// Undo comes back to the first so many states only.
    pub(super) fn merge(&mut self, known: usize) {
        self.undo.truncate(known);
    }

    /// The state before, or after, this one; none where there is no such state.
    pub(super) fn step_back(&mut self, redo: bool, now: Past) -> Option<Past> {
        let Self { undo, redo: redone, .. } = self;
        let (from, to) = if redo { (redone, undo) } else { (undo, redone) };
        let past = from.pop()?;
        to.push(now);
        Some(past)
    }
}

impl App {
    /// The selected knob.
    pub fn selected(&self) -> Option<&'static Knob> {
        KNOBS.get(self.knobs.selected)
    }

    /// Selects the knob of a key; false if there is none.
    pub fn select_path(&mut self, path: &str) -> bool {
        let place = place_of(path);
        if let Some(place) = place {
            self.knobs.select(place);
        }
        place.is_some()
    }

    pub(super) fn turn(&mut self, up: bool, coarse: bool) {
        if let Some(knob) = self.selected() {
            let value = knob.turned(&knob.get(&self.scene), up, coarse, &self.scene);
            self.set(knob, value);
        }
    }

    pub(super) fn reset(&mut self) {
        if let Some(knob) = self.selected() {
            self.set(knob, knob.get(self.files.opened()));
        }
    }

    /// Accepts the typed text; after a refusal it can be corrected.
    pub(super) fn accept(&mut self, text: &str) {
        let Some(knob) = self.selected() else { return };
        match knob.parse(text) {
            Ok(value) => {
                if self.set(knob, value) {
                    self.dialogue.close();
                }
            }
            Err(error) => self.knobs.refuse(knob, &error),
        }
    }

    /// Makes a scene that differs in knobs the current one; it can be undone.
    pub(super) fn turn_to(&mut self, scene: CheckedScene) {
        if scene != self.scene {
            self.knobs.remember(self.past());
            self.set_turned_scene(scene);
        }
    }

    /// Sets a knob; false where the value was refused.
    pub(super) fn set(&mut self, knob: &'static Knob, value: Value) -> bool {
        match knob.set(&self.scene, value) {
            Ok((scene, said)) => {
                self.knobs.refusal = None;
                if said.is_some() {
                    self.status = said;
                }
                self.turn_to(scene);
                true
            }
            Err(error) => {
                self.knobs.refuse(knob, &error);
                false
            }
        }
    }

    /// Uses the scene after a turn of a knob: live, if this is enabled and possible.
    pub(super) fn set_turned_scene(&mut self, scene: CheckedScene) {
        let failed = self.failure().is_some();
        let live = self.knobs.live && !failed && Change::acts_live(&self.scene, &scene);
        if self.knobs.live && !live && self.status.is_none() {
            self.status = Some("this cannot act on a running motion: restarted".into());
        }
        self.set_scene(scene, live);
    }

    /// The present state, to come back to.
    pub(super) fn past(&self) -> Past {
        Past {
            scene: self.scene.clone(),
            opened: self.files.opened().clone(),
            source: self.files.source().cloned(),
            views: self.layout.views().to_vec(),
            tempo: self.play.tempo(),
            live: self.knobs.is_live(),
            compare: self.run.is_compared(),
            lesson: self.lessons.progress().cloned(),
        }
    }

    /// Undoes the last change of the scene, or redoes the last that was undone.
    pub(super) fn step_back(&mut self, redo: bool) {
        match self.knobs.step_back(redo, self.past()) {
            Some(past) => self.come_back(past),
            None => {
                let word = if redo { "redo" } else { "undo" };
                self.status = Some(format!("nothing to {word}"));
            }
        }
    }

    /// Gives the user's own state back, as it was before a lesson.
    pub(super) fn give_back(&mut self, own: Past) {
        self.knobs.remember(self.past());
        self.play.set_tempo(own.tempo);
        self.come_back(own);
    }

    /// Makes a state the present one. If only knobs were turned since, their
    /// turning may act on the running motion; another scene starts from t = 0.
    pub(super) fn come_back(&mut self, past: Past) {
        self.knobs.forget_refusal();
        let step = |lesson: Option<&LessonProgress>| {
            lesson.map(|now| (now.lesson, now.step, now.now().answer))
        };
        let same_step = step(past.lesson.as_ref()) == step(self.lessons.progress());
        let same_file = past.source.as_ref() == self.files.source();
        if past.opened == *self.files.opened() && same_file && same_step {
            self.set_turned_scene(past.scene);
            return;
        }
        self.files.reopen(past.opened, past.source);
        self.lessons.set_progress(past.lesson);
        if self.lessons.is_open() {
            self.present(false);
        }
        self.knobs.set_live(past.live);
        if self.layout.set_views(past.views) {
            self.keep_instant();
        }
        self.run.set_compare(past.compare);
        if past.scene != self.scene {
            self.set_scene(past.scene, false);
        }
    }
}

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
    use crate::tui::{Marker, Theme};
    use rubscope_solver::scene::Scene;

    #[test]
    fn undo_and_redo_come_back_and_a_new_change_forgets_what_was_undone() {
        let app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Ascii);
        let (past, mut knobs) = (app.past(), Knobs::default());
        assert!(knobs.step_back(false, past.clone()).is_none());
        let lively = Past { live: true, ..past.clone() };
        (0..3).for_each(|_| knobs.remember(lively.clone()));
        knobs.merge(1);
        assert_eq!(knobs.step_back(false, past.clone()), Some(lively.clone()));
        assert_eq!((knobs.remembered(), knobs.step_back(true, lively)), (0, Some(past.clone())));
        knobs.step_back(false, past.clone());
        knobs.remember(past.clone());
        assert!(knobs.step_back(true, past).is_none());
    }

    #[test]
    fn the_knobs_go_round_and_another_one_has_no_refusal() {
        let mut knobs = Knobs::default();
        knobs.refuse(&KNOBS[1], &Scene::base().set("operation.pulse_n", "x").unwrap_err());
        assert!(knobs.refusal().is_some());
        knobs.walk(true);
        assert_eq!((knobs.selected, knobs.refusal()), (KNOBS.len() - 1, None));
        knobs.walk(false);
        assert_eq!(knobs.selected, 0);
    }

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
