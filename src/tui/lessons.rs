//! The lessons under `assets/lessons/`, embedded in the program: each has a
//! scene and a few steps of text that set knobs and give tasks.

use std::sync::OnceLock;

use serde::Deserialize;

/// One lesson.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct Lesson {
    /// What it is about.
    pub title: String,
    /// The built-in scene at its start.
    pub scene: String,
    /// Its steps.
    #[serde(rename = "step")]
    pub steps: Vec<LessonStep>,
}

/// One step of a lesson.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(deny_unknown_fields)]
pub struct LessonStep {
    /// What can be seen, and the reason.
    pub text: String,
    /// The equation behind it.
    pub equation: Option<String>,
    /// The task of the reader.
    pub task: Option<String>,
    /// Keys of the scene that are set when the step begins.
    #[serde(default)]
    pub set: Vec<(String, String)>,
    /// The view that is shown.
    pub view: Option<String>,
    /// Whether knobs act on the running motion.
    pub live: Option<bool>,
    /// When the task is done.
    pub until: Option<Condition>,
}

/// When a task is done.
#[derive(Clone, Debug, Deserialize, PartialEq)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Condition {
    /// The run has this verdict.
    Verdict(String),
    /// This view is the large one.
    View(String),
    /// The other contact law is compared, or not.
    Compare(bool),
    /// A key is above a number.
    Above(String, f64),
    /// A key is below a number.
    Below(String, f64),
    /// A key holds a word.
    Is(String, String),
}

const FILES: &[&str] = &[
    include_str!("../../assets/lessons/critical-speed.toml"),
    include_str!("../../assets/lessons/lock.toml"),
    include_str!("../../assets/lessons/sign.toml"),
    include_str!("../../assets/lessons/time-step.toml"),
    include_str!("../../assets/lessons/slip.toml"),
    include_str!("../../assets/lessons/polygon.toml"),
    include_str!("../../assets/lessons/speed-and-error.toml"),
];

/// Every lesson, in the order of the list.
pub fn all() -> &'static [Lesson] {
    static LESSONS: OnceLock<Vec<Lesson>> = OnceLock::new();
    // The files are part of the program, and a test reads each of them.
    LESSONS.get_or_init(|| FILES.iter().filter_map(|file| toml::from_str(file).ok()).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Scene, keys::CHARTS};

    #[test]
    fn every_lesson_is_read_and_its_steps_make_sense() {
        for file in FILES {
            toml::from_str::<Lesson>(file).unwrap();
        }
        assert_eq!(all().len(), FILES.len());
        for lesson in all() {
            let mut scene = Scene::builtin(&lesson.scene).unwrap();
            assert!(lesson.steps.len() >= 3, "{}", lesson.title);
            for step in &lesson.steps {
                for (path, value) in &step.set {
                    scene.set(path, value).unwrap();
                }
                scene.checked().unwrap();
                assert!(step.view.as_deref().is_none_or(|view| CHARTS.contains(&view)));
                assert_eq!(step.task.is_some(), step.until.is_some(), "{}", step.text);
            }
        }
    }
}
