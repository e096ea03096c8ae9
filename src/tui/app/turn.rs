//! Turning knobs: values are checked first, refused at the knob, and can be undone.

use super::{App, InputMode, Ranges};
use crate::motion::Change;
use crate::report::line::clean;
use crate::scene::{CheckedScene, Value};
use crate::tui::engine::Snapshot;
use crate::tui::knobs::{KNOBS, Knob, place_of};

impl App {
    /// The selected knob.
    pub fn selected(&self) -> Option<&'static Knob> {
        KNOBS.get(self.knob)
    }

    /// Selects the knob of a key; false if there is none.
    pub fn select_path(&mut self, path: &str) -> bool {
        let place = place_of(path);
        if let Some(place) = place {
            self.select_place(place);
        }
        place.is_some()
    }

    /// Selects the knob at a place of the table.
    pub(super) fn select_place(&mut self, place: usize) {
        (self.knob, self.refusal) = (place, None);
    }

    pub(super) fn select(&mut self, up: bool) {
        let count = KNOBS.len();
        let next = if up { self.knob + count - 1 } else { self.knob + 1 };
        self.select_place(next % count);
    }

    pub(super) fn turn(&mut self, up: bool, coarse: bool) {
        if let Some(knob) = self.selected() {
            let value = knob.turned(&knob.get(&self.scene), up, coarse, &self.scene);
            self.set(knob, value);
        }
    }

    pub(super) fn reset(&mut self) {
        if let Some(knob) = self.selected() {
            self.set(knob, knob.get(&self.opened));
        }
    }

    /// Accepts the typed text; after a refusal it can be corrected.
    pub(super) fn accept(&mut self, text: &str) {
        let Some(knob) = self.selected() else { return };
        match knob.parse(text) {
            Ok(value) => {
                if self.set(knob, value) {
                    self.mode = InputMode::Main;
                }
            }
            Err(error) => self.refusal = Some(clean(&error.to_string())),
        }
    }

    /// Makes a scene that differs in knobs the current one; it can be undone.
    pub(super) fn turn_to(&mut self, scene: CheckedScene) {
        if scene != self.scene {
            self.remember(self.past());
            self.set_turned_scene(scene);
        }
    }

    /// Sets a knob; false where the value was refused.
    pub(super) fn set(&mut self, knob: &'static Knob, value: Value) -> bool {
        match knob.set(&self.scene, value) {
            Ok((scene, said)) => {
                self.refusal = None;
                if said.is_some() {
                    self.status = said;
                }
                self.turn_to(scene);
                true
            }
            Err(error) => {
                self.refusal = Some(clean(&error.to_string()));
                false
            }
        }
    }

    /// Uses the scene after a turn of a knob: live, if this is enabled and possible.
    pub(super) fn set_turned_scene(&mut self, scene: CheckedScene) {
        let failed = self.failure().is_some();
        let live = self.live && !failed && Change::acts_live(&self.scene, &scene);
        if self.live && !live && self.status.is_none() {
            self.status = Some("this cannot act on a running motion: restarted".into());
        }
        self.set_scene(scene, live);
    }

    /// Makes a scene the current one and starts its run, or, if live, applies
    /// it to the running motion.
    pub fn set_scene(&mut self, scene: CheckedScene, live: bool) {
        let clearance = self.machine.clearance();
        self.scene = scene;
        self.machine = self.scene.machine();
        if self.machine.clearance() != clearance {
            let follow = self.ranges.follow;
            self.ranges = Ranges { follow, ..Ranges::of(self.machine.clearance()) };
        }
        if live {
            self.counters.changes += 1;
            self.forget_forecasts();
        } else {
            self.restart();
        }
    }

    /// Drops what was computed for the motion before it was changed.
    pub(super) fn forget_forecasts(&mut self) {
        let results = &mut self.latest.results;
        (results.full_run, results.reference, results.comparison) = (None, None, None);
        (results.page, results.comparison_page) = (None, None);
        results.sensitive = false;
    }

    /// Restarts the run. Old studies stay until there are new ones.
    pub fn restart(&mut self) {
        self.counters.restarts += 1;
        self.started = self.scene.clone();
        if std::mem::take(&mut self.stopped_by_end) {
            self.playing = true;
        }
        self.history.clear();
        self.comparison_history.clear();
        self.pages_back = 0;
        (self.counters.ends, self.counters.extensions) = (0, 0);
        self.forget_forecasts();
        // Nobody waits for a jump of the motion before.
        self.counters.met = self.counters.jumps;
        let mut results = std::mem::take(&mut self.latest.results);
        results.applied.clear();
        (results.reading, results.end_s) = (None, 0.0);
        self.latest = Snapshot { results, ..Snapshot::default() };
        self.page = 0;
        self.go_to_s = self.begin_s();
    }
}
