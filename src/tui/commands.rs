//! The command palette: one list of everything that can be done, and what is
//! typed leaves what fits. A knob with a value behind its name sets that knob.

use super::{App, Effect, InputMode};
use crate::report::line::clean;
use crate::scene::{Scene, Value};
use crate::tui::appearance::Appearance;
use crate::tui::axis::readable;
use crate::tui::bindings::{self, Action, Context};
use crate::tui::knobs::{KNOBS, Knob, knob_of};
use crate::tui::lessons;
use crate::tui::scenes::builtin_scenes;
use crate::tui::{Marker, Theme};

/// The open palette.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PaletteState {
    /// What is looked for.
    pub typed: String,
    /// The chosen line of what was found.
    pub place: usize,
}

/// What a line of the palette does.
#[derive(Clone, Debug, PartialEq)]
enum Command {
    Act(Action),
    Open(&'static str),
    Learn(usize),
    Select(usize),
    Set(usize, String),
    GoTo(f64),
}

/// One line of the palette.
#[derive(Clone, Debug, PartialEq)]
pub struct PaletteItem {
    /// The kind of thing that it is.
    pub kind: &'static str,
    /// What it does.
    pub what: String,
    /// The key that does the same, or the present value of a knob.
    pub beside: String,
    command: Command,
    /// Other words by which it can be found.
    also: String,
}

impl App {
    /// What fits the typed words, the best first.
    pub fn palette_items(&self, typed: &str) -> Vec<PaletteItem> {
        let typed = typed.to_lowercase();
        let words: Vec<&str> = typed.split_whitespace().collect();
        let mut found: Vec<_> = self.going_to(&typed).into_iter().collect();
        found.extend(self.assignments(&typed));
        let fits = |item: PaletteItem| rank(&item, &words).map(|rank| (rank, item));
        let mut others: Vec<_> = self.everything().filter_map(fits).collect();
        // The order of equals is that of the list.
        others.sort_by_key(|(rank, _)| *rank);
        found.extend(others.into_iter().map(|(_, item)| item));
        found
    }

    fn everything(&self) -> impl Iterator<Item = PaletteItem> {
        let actions = bindings::of(Context::Main)
            .filter(|binding| !matches!(binding.action, Action::Palette | Action::Close));
        let actions = actions.map(|binding| PaletteItem {
            kind: "",
            what: binding.what.into(),
            beside: binding.keys.first().map(ToString::to_string).unwrap_or_default(),
            command: Command::Act(binding.action),
            also: bindings::keys_text(binding),
        });
        let knobs = KNOBS.iter().enumerate().map(|(place, knob)| PaletteItem {
            kind: "knob",
            what: format!("{}: {}", knob.label, knob.does),
            beside: knob.text(&self.scene),
            command: Command::Select(place),
            also: format!("{} {}", knob.path, plain(knob.label)),
        });
        let scenes = builtin_scenes().iter().map(|scene| PaletteItem {
            kind: "scene",
            what: match &scene.scene {
                Ok(read) => format!("{}: {}", scene.name, read.title),
                Err(_) => scene.name.clone(),
            },
            beside: String::new(),
            command: Command::Open(&scene.name),
            also: "open".into(),
        });
        let lessons = lessons::all().iter().enumerate().map(|(place, lesson)| PaletteItem {
            kind: "lesson",
            what: lesson.title.clone(),
            beside: String::new(),
            command: Command::Learn(place),
            also: "guide learn".into(),
        });
        actions.chain(scenes).chain(lessons).chain(knobs)
    }

    /// `t 0.3 ms`: an instant to go to.
    fn going_to(&self, typed: &str) -> Option<PaletteItem> {
        let text = typed.strip_prefix('t')?.trim_start_matches(['=', ' ']);
        let Value::Real(t) = knob_of("solver.end_s")?.parse(text).ok()? else { return None };
        Some(PaletteItem {
            kind: "go",
            what: format!("t = {}", readable(t, "s")),
            beside: format!("now {}", readable(self.now(), "s")),
            command: Command::GoTo(t),
            also: String::new(),
        })
    }

    /// The knobs that the first words name, set to what follows them.
    fn assignments(&self, typed: &str) -> Vec<PaletteItem> {
        let typed = typed.replacen('=', " ", 1);
        let words: Vec<&str> = typed.split_whitespace().collect();
        let mut found = Vec::new();
        for (place, knob) in KNOBS.iter().enumerate() {
            let names = names(knob);
            let named = |words: &[&str]| {
                !words.is_empty()
                    && words.iter().all(|word| names.iter().any(|name| name.starts_with(word)))
            };
            let splits = (1..words.len()).filter_map(|at| words.split_at_checked(at));
            let value = splits.rev().find_map(|(name, value)| {
                knob.parse(&value.join(" ")).ok().filter(|_| named(name)).map(|of| (of, value))
            });
            if let Some((value, text)) = value {
                found.push(PaletteItem {
                    kind: "set",
                    what: format!("{} = {}", knob.label, knob.shown(&value)),
                    beside: format!("now {}", knob.text(&self.scene)),
                    command: Command::Set(place, text.join(" ")),
                    also: String::new(),
                });
            }
        }
        found
    }

    /// Moves the choice; whether the action did that.
    pub(super) fn move_choice(&mut self, palette: &PaletteState, action: Action) -> bool {
        const PAGE: usize = 8;
        let last = self.palette_items(&palette.typed).len().saturating_sub(1);
        let place = match action {
            Action::KnobBelow => palette.place + 1,
            Action::KnobAbove => palette.place.saturating_sub(1),
            Action::PageForward => palette.place + PAGE,
            Action::PageBack => palette.place.saturating_sub(PAGE),
            _ => return false,
        };
        self.dialogue
            .open(InputMode::Palette(PaletteState { place: place.min(last), ..palette.clone() }));
        true
    }

    /// Does what was chosen.
    pub(super) fn choose_command(&mut self, palette: &PaletteState) -> Effect {
        let found = self.palette_items(&palette.typed).into_iter().nth(palette.place);
        let Some(item) = found else {
            self.status = Some("nothing has these words".into());
            return Effect::None;
        };
        self.dialogue.close();
        match item.command {
            Command::Act(action) => return self.act(action),
            Command::GoTo(t) => self.go_to(t),
            Command::Open(name) => self.open_builtin(name),
            Command::Learn(place) => self.begin_lesson(place),
            Command::Select(place) => self.knobs.select(place),
            Command::Set(place, text) => {
                self.knobs.select(place);
                self.accept(&text);
                if let Some(refusal) = self.knobs.refusal() {
                    self.status = Some(clean(refusal));
                }
            }
        }
        Effect::None
    }

    /// Makes a built-in scene the current one; undo brings the former one back.
    pub fn open_builtin(&mut self, name: &str) {
        match Scene::builtin(name).and_then(|scene| scene.checked()) {
            Ok(scene) => {
                self.open_scene(name.to_string(), scene);
                self.status = Some(format!("opened {name}"));
            }
            Err(error) => self.status = Some(clean(&error.to_string())),
        }
    }
}

/// The words by which a knob is named: those of its label, also without Greek
/// letters, its key, and the words of its key.
fn names(knob: &Knob) -> Vec<String> {
    let label = knob.label.to_lowercase();
    let plain = plain(knob.label).to_lowercase();
    let parts = label.split_whitespace().chain(plain.split_whitespace());
    let keys = knob.path.split(['.', '_']).chain([knob.path]);
    parts.chain(keys).map(String::from).collect()
}

/// A text in letters that every keyboard has.
fn plain(text: &str) -> String {
    Appearance::new(Theme::Mono, Marker::Ascii).spell(text)
}

/// How well a line fits all the words, the best being 0; none if it does not.
fn rank(item: &PaletteItem, words: &[&str]) -> Option<usize> {
    let what = item.what.to_lowercase();
    let all = format!("{} {what} {}", item.kind, item.also.to_lowercase());
    let each = words.iter().map(|word| match () {
        () if what.starts_with(word) => Some(0),
        () if all.split(|c: char| !c.is_alphanumeric()).any(|part| part.starts_with(word)) => {
            Some(1)
        }
        () if all.contains(word) => Some(2),
        () if has_in_order(&what, word) => Some(9),
        () => None,
    });
    each.sum()
}

/// Whether a text has the letters of a word in their order, with others between.
fn has_in_order(text: &str, word: &str) -> bool {
    let mut rest = text.chars();
    word.len() > 2 && word.chars().all(|letter| rest.any(|other| other == letter))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::BUILTIN;

    fn app() -> App {
        App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Braille)
    }

    fn first(typed: &str) -> PaletteItem {
        app().palette_items(typed).into_iter().next().unwrap()
    }

    #[test]
    fn every_action_scene_lesson_view_and_knob_is_found_by_its_name() {
        let app = app();
        let found = |typed: &str| app.palette_items(typed);
        for binding in bindings::of(Context::Main) {
            let wanted = Command::Act(binding.action);
            let known = found(binding.what).iter().any(|item| item.command == wanted);
            assert_eq!(known, !matches!(binding.action, Action::Palette | Action::Close));
        }
        for scene in BUILTIN {
            assert_eq!(found(scene.name)[0].command, Command::Open(scene.name), "{}", scene.name);
        }
        for (place, lesson) in lessons::all().iter().enumerate() {
            // A scene may have the title of its lesson.
            let first = &found(&lesson.title)[..2.min(found(&lesson.title).len())];
            let known = first.iter().any(|item| item.command == Command::Learn(place));
            assert!(known, "{}", lesson.title);
        }
        for (place, knob) in KNOBS.iter().enumerate() {
            let items = found(knob.path);
            assert!(items.iter().any(|item| item.command == Command::Select(place)));
        }
        assert_eq!(first("undo").beside, "u");
        assert_eq!(first("theme").kind, "");
    }

    #[test]
    fn a_name_and_a_value_set_a_knob() {
        for (typed, path, shown) in [
            ("speed 430", "operation.speed_rad_s", "430 rad/s"),
            ("Speed -430", "operation.speed_rad_s", "-430 rad/s"),
            ("pulse 20k", "operation.pulse_n", "20 kN"),
            ("pulse time 20u", "operation.pulse_s", "20 µs"),
            ("operation.pulse_n=1e6", "operation.pulse_n", "1 MN"),
            ("n_d 4", "operation.nodal_diameters", "4"),
            ("zeta_c 0.01", "casing.damping_ratio", "0.01"),
            ("contact bi", "solver.contact", "bilateral"),
            ("speed ramp -400", "operation.speed_ramp_rad_s2", "-400 rad/s^2"),
        ] {
            let item = first(typed);
            assert_eq!(item.kind, "set", "{typed}");
            let Command::Set(place, _) = item.command else { panic!("{typed}") };
            assert_eq!(KNOBS[place].path, path, "{typed}");
            assert!(item.what.ends_with(shown), "{typed}: {}", item.what);
        }
        assert_ne!(first("speed").kind, "set");
        assert_eq!(app().palette_items("speed qqq"), []);
    }

    #[test]
    fn a_value_that_is_refused_changes_nothing_and_says_so() {
        let mut app = app();
        let before = app.scene.clone();
        app.choose_command(&PaletteState { typed: "blades 0".into(), place: 0 });
        assert_eq!(app.scene, before);
        assert!(app.status.is_some_and(|status| status.contains("bladed_disk.blades")));
    }

    #[test]
    fn a_scene_that_is_opened_can_be_undone() {
        let mut app = app();
        let before = app.scene.clone();
        app.knobs.live = true;
        app.open_builtin("rocking");
        assert_eq!(*app.scene, Scene::builtin("rocking").unwrap());
        assert_eq!((&app.files.opened, app.knobs.live), (&app.scene, true));
        assert_eq!(app.files.source.as_ref().map(|source| source.name.as_str()), Some("rocking"));
        app.act(Action::Undo);
        assert_eq!(app.scene, before);
    }
}
