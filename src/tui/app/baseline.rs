//! A run that stays on the chart behind the next ones.

use super::{App, VerdictText};
use crate::scene::CheckedScene;
use crate::tui::history::BinHistory;
use crate::tui::knobs::{KNOBS, Knob};

/// A pinned run, drawn behind the next ones.
#[derive(Clone, Debug)]
pub struct Baseline {
    /// Its record.
    pub history: BinHistory,
    /// Its verdict.
    pub words: VerdictText,
    /// Its scene.
    pub scene: CheckedScene,
}

impl Baseline {
    /// What was pinned: the knobs in which it differs from the present scene, and
    /// its verdict.
    pub fn what(&self, app: &App) -> String {
        let differs = |knob: &&Knob| knob.get(&self.scene) != knob.get(&app.scene);
        let shown = |knob: &Knob| format!("{} {}", knob.label, knob.text(&self.scene));
        let mut parts: Vec<String> = KNOBS.iter().filter(differs).take(2).map(shown).collect();
        parts.push(self.words.word.clone());
        parts.join(", ")
    }
}
