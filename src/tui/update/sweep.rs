//! Sweeping a knob: one value after the verdict of the value before is on the screen.

use crate::tui::app::{App, InputMode, Sweep};
use crate::tui::engine::FullRunState;
use rubscope_solver::scene::Value;

impl App {
    /// Asks for the end of the sweep.
    pub(super) fn ask_sweep(&mut self) {
        let Some(knob) = self.selected() else { return };
        match knob.get(&self.scene) {
            Value::Real(_) | Value::Whole(_) => {
                self.knobs.refusal = None;
                self.dialogue.open(InputMode::Sweeping(String::new()));
            }
            _ => self.status = Some(format!("{} has no numbers to sweep", knob.label)),
        }
    }

    /// Starts the sweep to what was typed; it can be undone as one turn.
    pub(super) fn begin_sweep(&mut self, text: &str) {
        let Some(knob) = self.selected() else { return };
        let read = knob.parse(text);
        match read.and_then(|to| knob.set(&self.scene, to.clone()).map(|_| to)) {
            Ok(to) => {
                self.dialogue.close();
                self.knobs.remember(self.past());
                self.knobs.sweep = Some(Sweep::new(knob, &knob.get(&self.scene), &to));
            }
            Err(error) => {
                self.knobs.refuse(knob, &error);
                self.status = self.knobs.refusal.clone();
            }
        }
    }

    /// Goes on to the next value once a frame has shown the verdict of this one.
    pub(super) fn sweep_on(&mut self) {
        let verdict = match &self.results().full_run {
            None | Some(FullRunState::Computing(_)) => return,
            Some(FullRunState::Done(_) | FullRunState::GivenUp(_)) => self.verdict_word(),
        };
        let Some(sweep) = &mut self.knobs.sweep else { return };
        match sweep.go_on(verdict, &self.scene) {
            // Both ends were checked; a value between them may be refused alone.
            Some((knob, next)) => {
                if let Ok((scene, _)) = knob.set(&self.scene, next) {
                    self.set_turned_scene(scene);
                }
            }
            None => self.stop_sweep(),
        }
    }

    /// Ends a sweep where it is.
    pub(super) fn stop_sweep(&mut self) {
        if let Some(sweep) = self.knobs.sweep.take() {
            self.status = Some(sweep.summary());
        }
    }
}
