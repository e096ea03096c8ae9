//! The lessons in `assets/lessons/`, embedded in the program. Each has a scene and a few steps. A
//! step asks a question, sets knobs when it is answered, and explains the answer; or it has a task.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::OnceLock;

use serde::{Deserialize, Serialize};

use rubscope_solver::scene::{CheckedScene, Scene, SceneError};
use rubscope_solver::study::margins::LimitName;

/// One lesson.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Lesson {
    /// Name of the lesson: that of its file, without `.toml`.
    #[serde(skip)]
    pub name: &'static str,
    /// Subject of the lesson.
    pub title: String,
    /// What the reader should know before.
    pub needs: String,
    /// The built-in scene at the start.
    pub scene: String,
    /// Steps of the lesson, in order.
    #[serde(rename = "step")]
    pub steps: Vec<LessonStep>,
}

/// Keys of a scene with their values, as text.
pub type Settings = Vec<(String, String)>;

/// One step of a lesson.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct LessonStep {
    /// Explanation of what the screen shows.
    pub text: String,
    /// Keys of the scene that are set when the step begins, before the question.
    #[serde(default)]
    pub begin: Settings,
    /// Question about what will happen; `None` for a step that only explains or has a task.
    pub question: Option<String>,
    /// The possible answers to the question, for the keys a, b and c.
    #[serde(default)]
    pub answers: Vec<String>,
    /// Letter of the right answer, a, b or c; `None` without a question.
    pub right: Option<char>,
    /// Explanation of the right answer, shown with the run after the question is answered.
    pub reason: Option<String>,
    /// The equation behind the explanation.
    pub equation: Option<String>,
    /// Keys that are set when the question is answered, or, without a question, when the step
    /// begins.
    #[serde(default)]
    pub set: Settings,
    /// The task, if the step has one.
    pub task: Option<String>,
    /// Condition that completes the task; `None` if the step has none.
    pub until: Option<Condition>,
    /// Settings of the scene that complete the task; the next step starts from them.
    #[serde(default)]
    pub doing: Settings,
    /// Name of the view shown; `None` leaves the view.
    pub view: Option<String>,
    /// Name of the view shown once the question is answered; `None` keeps `view`.
    pub then_view: Option<String>,
    /// The limit on which the margins view is centred.
    pub limit: Option<LimitName>,
    /// Minimum length of the time page \[s\].
    pub page_s: Option<f64>,
    /// Key of the knob that is selected; `None` leaves the selection.
    pub knob: Option<String>,
    /// Whether knobs act on the running motion.
    #[serde(default)]
    pub live: bool,
    /// Whether the run is compared with the other contact law, from the answer on.
    #[serde(default)]
    pub compare: bool,
    /// Statements about the completed step, which a test checks with the solvers.
    #[serde(default)]
    pub check: Vec<toml::Table>,
}

/// Condition that completes a task.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Condition {
    /// The run has this verdict.
    Verdict(String),
    /// A key of the scene has a value above this number, in its SI unit.
    Above(String, f64),
    /// A key of the scene has a value below this number, in its SI unit.
    Below(String, f64),
    /// A limit of the scene is above this number, in its SI unit.
    Limit(LimitName, f64),
}

impl LessonStep {
    /// Returns the index of the right answer; `None` if the step has no question.
    pub fn right_place(&self) -> Option<usize> {
        let right = self.right?;
        LETTERS.iter().position(|letter| *letter == right)
    }
}

/// Reading speed, including looks at the chart \[words/minute\].
const WORDS_A_MINUTE: usize = 100;
/// Time to think about a question, besides reading it \[minutes\].
const QUESTION: f64 = 0.5;
/// Time to do a task, besides reading it \[minutes\].
const TASK: f64 = 2.0;

impl Lesson {
    /// Returns the beginning of the title, up to the first comma, colon or "and".
    pub fn brief(&self) -> &str {
        let end = [",", ":", " and "].iter().filter_map(|sign| self.title.find(sign)).min();
        end.and_then(|end| self.title.get(..end)).unwrap_or(&self.title)
    }

    /// Estimates the time that a reader needs for the lesson \[minutes\].
    pub fn minutes(&self) -> u32 {
        let of = |step: &LessonStep| {
            let texts = [&step.question, &step.reason, &step.task].into_iter().flatten();
            let words: usize = texts
                .chain([&step.text])
                .chain(&step.answers)
                .map(|text| text.split_whitespace().count())
                .sum();
            words as f64 / WORDS_A_MINUTE as f64
                + if step.question.is_some() { QUESTION } else { 0.0 }
                + if step.task.is_some() { TASK } else { 0.0 }
        };
        self.steps.iter().map(of).sum::<f64>().ceil() as u32
    }

    /// Returns the scene of a step, before or after its question is answered: the lesson's scene
    /// with the settings of all steps and tasks so far.
    ///
    /// # Errors
    /// A key or a value is refused.
    pub fn scene_at(&self, step: usize, answered: bool) -> Result<CheckedScene, SceneError> {
        let mut scene = Scene::builtin(&self.scene)?;
        for (place, found) in self.steps.iter().enumerate().take(step + 1) {
            let before = place < step;
            let acts = before || answered || found.question.is_none();
            let set = found.set.iter().filter(|_| acts);
            let done = found.doing.iter().filter(|_| before);
            for (path, value) in found.begin.iter().chain(set).chain(done) {
                scene.set(path, value)?;
            }
        }
        scene.checked()
    }
}

/// Letters of the answers, which are also their keys.
pub const LETTERS: [char; 3] = ['a', 'b', 'c'];

/// Completed steps by lesson name; the first step is 1.
#[derive(Clone, Debug, Default, Deserialize, PartialEq, Eq, Serialize)]
#[serde(transparent)]
pub struct LessonsDone(BTreeMap<String, BTreeSet<usize>>);

impl LessonsDone {
    /// Adds the steps completed in another record.
    pub fn join(&mut self, other: Self) {
        for (name, steps) in other.0 {
            self.0.entry(name).or_default().extend(steps);
        }
    }

    /// Returns whether no step is completed.
    pub fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    /// Records a completed step, counted from 0.
    pub fn add(&mut self, lesson: &Lesson, step: usize) {
        self.0.entry(lesson.name.to_string()).or_default().insert(step + 1);
    }

    /// Returns whether a step, counted from 0, is completed.
    pub fn has(&self, lesson: &Lesson, step: usize) -> bool {
        self.0.get(lesson.name).is_some_and(|steps| steps.contains(&(step + 1)))
    }

    /// Returns how many steps of a lesson are completed.
    pub fn count(&self, lesson: &Lesson) -> usize {
        (0..lesson.steps.len()).filter(|step| self.has(lesson, *step)).count()
    }

    /// Returns the first step of a lesson that is not completed, counted from 0; `None` if all are.
    pub fn next(&self, lesson: &Lesson) -> Option<usize> {
        (0..lesson.steps.len()).find(|step| !self.has(lesson, *step))
    }
}

macro_rules! lessons {
    ($($name:literal),+ $(,)?) => {
        &[$(($name, include_str!(concat!("../../assets/lessons/", $name, ".toml")))),+]
    };
}

/// Name and text of each lesson, in the order of the list.
const FILES: &[(&str, &str)] = lessons![
    "critical-speed",
    "lock",
    "sign",
    "run-down",
    "rocking",
    "slip",
    "polygon",
    "time-step",
    "speed-and-error",
    "what-if",
    "coincidence",
    "friction",
    "long-tip",
    "roundness",
    "your-machine",
];

/// Returns every lesson, in the order of the list.
pub fn all() -> &'static [Lesson] {
    static LESSONS: OnceLock<Vec<Lesson>> = OnceLock::new();
    // The files are embedded, and a test checks that each parses.
    let read = |(name, text): &(&'static str, &str)| {
        toml::from_str(text).ok().map(|lesson| Lesson { name, ..lesson })
    };
    LESSONS.get_or_init(|| FILES.iter().filter_map(read).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::appearance::Appearance;
    use crate::tui::knobs::KNOBS;
    use crate::tui::{Marker, Theme};
    use rubscope_solver::scene::keys::CHARTS;

    #[test]
    fn every_lesson_is_read_and_its_steps_make_sense() {
        for (name, text) in FILES {
            toml::from_str::<Lesson>(text).unwrap_or_else(|error| panic!("{name}: {error}"));
        }
        assert_eq!(all().len(), FILES.len());
        for lesson in all() {
            assert!(lesson.steps.len() >= 3, "{}", lesson.title);
            assert!((3..=15).contains(&lesson.minutes()), "{}: {}", lesson.name, lesson.minutes());
            assert!(!lesson.needs.is_empty(), "{}", lesson.title);
            for (place, step) in lesson.steps.iter().enumerate() {
                for answered in [false, true] {
                    lesson.scene_at(place, answered).unwrap();
                }
                for view in [&step.view, &step.then_view].into_iter().flatten() {
                    assert!(CHARTS.contains(&view.as_str()), "{view}");
                }
                let knobs = KNOBS.iter().map(|knob| knob.path);
                assert!(step.knob.as_deref().is_none_or(|path| knobs.clone().any(|p| p == path)));
                assert_eq!(step.task.is_some(), step.until.is_some(), "{}", step.text);
                let asked = step.question.is_some();
                assert_eq!(step.answers.len(), if asked { 3 } else { 0 }, "{}", step.text);
                assert!(asked == step.right_place().is_some() && asked == step.reason.is_some());
            }
        }
    }

    #[test]
    fn the_right_answers_are_spread_over_their_places() {
        let right: Vec<char> =
            all().iter().flat_map(|lesson| &lesson.steps).filter_map(|step| step.right).collect();
        for letter in LETTERS {
            let count = right.iter().filter(|right| **right == letter).count();
            assert!(4 * count > right.len(), "{letter}: {count} of {}", right.len());
        }
        assert!(right.windows(4).all(|four| four.iter().any(|letter| *letter != four[0])));
    }

    #[test]
    fn no_task_stands_beside_its_answer() {
        for lesson in all() {
            for step in lesson.steps.iter().filter(|step| step.question.is_none()) {
                let Some(task) = &step.task else { continue };
                let limit = match &step.until {
                    Some(Condition::Above(_, limit) | Condition::Below(_, limit)) => {
                        limit.to_string()
                    }
                    _ => continue,
                };
                let done = step.doing.iter().map(|(_, value)| value.as_str());
                for told in done.chain([limit.as_str()]).filter(|told| !task.contains(*told)) {
                    assert!(!step.text.contains(told), "{}: {told} in {}", lesson.name, step.text);
                }
            }
        }
    }

    #[test]
    fn every_letter_of_the_lessons_has_a_spelling_in_ascii() {
        let look = Appearance::new(Theme::Mono, Marker::Ascii);
        let others = FILES.iter().flat_map(|(_, text)| text.chars()).filter(|c| !c.is_ascii());
        for letter in others {
            assert_ne!(look.spell(&letter.to_string()), "?", "{letter}");
        }
    }

    #[test]
    fn what_was_done_is_a_small_value_for_a_file() {
        let mut done = LessonsDone::default();
        let lesson = &all()[1];
        assert_eq!(done.next(lesson), Some(0));
        (0..2).for_each(|step| done.add(lesson, step));
        assert_eq!((done.count(lesson), done.next(lesson)), (2, Some(2)));
        let text = toml::to_string(&done).unwrap();
        assert_eq!(text, "lock = [1, 2]\n");
        assert_eq!(toml::from_str::<LessonsDone>(&text).unwrap(), done);
        // Records of lessons and steps that no longer exist are ignored.
        let old: LessonsDone = toml::from_str("lock = [77]\ngone = [1]").unwrap();
        assert_eq!((old.count(lesson), old.next(lesson)), (0, Some(0)));
    }
}
