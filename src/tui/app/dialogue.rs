//! The dialogue that has the keyboard: a prompt, a list, a question, or none.

use crate::tui::command::Purpose;
use crate::tui::field::Field;

/// What the keyboard acts on: the main screen, or one open dialogue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum InputMode {
    /// Knobs and charts.
    Main,
    /// Typing a value for the selected knob.
    Typing(Field),
    /// The help, with its search.
    Help(HelpState),
    /// The command palette: commands are searched by name.
    Palette(PaletteState),
    /// Typing a file name.
    Naming(Purpose, Field),
    /// Asking whether to replace the existing file of this name.
    Replacing(Purpose, String),
    /// The list of lessons, with the index of the selected one.
    Lessons(usize),
    /// The list of scenes, with the index of the selected one; `None` selects the open scene.
    Scenes(Option<usize>),
}

/// The state of the dialogues.
#[derive(Clone, Debug)]
pub struct Dialogue {
    /// What the keyboard acts on.
    pub mode: InputMode,
    /// How often the note of the selected scene was turned to its next page; after the last page
    /// follows the first.
    pub note_page: usize,
    /// Whether this is the first start and no key was pressed yet: the footer then says what to
    /// try.
    pub is_new: bool,
    /// Whether a frame has shown the open question. Keys typed ahead must not answer it unseen.
    pub asked: bool,
}

impl Default for Dialogue {
    fn default() -> Self {
        Self { mode: InputMode::Main, note_page: 0, is_new: false, asked: true }
    }
}

impl Dialogue {
    pub fn is_closed(&self) -> bool {
        self.mode == InputMode::Main
    }

    /// Opens a dialogue and resets the page of the note.
    pub fn open(&mut self, mode: InputMode) {
        (self.mode, self.note_page) = (mode, 0);
    }

    /// Opens a question, which keys can answer only after a frame has shown it.
    pub fn ask(&mut self, mode: InputMode) {
        self.open(mode);
        self.asked = false;
    }

    pub fn close(&mut self) {
        self.mode = InputMode::Main;
    }

    /// Returns the text field that has the keyboard; `None` if no dialogue with one is open.
    pub fn typed(&mut self) -> Option<&mut Field> {
        match &mut self.mode {
            InputMode::Typing(text) | InputMode::Naming(_, text) => Some(text),
            InputMode::Help(help) => Some(&mut help.filter),
            InputMode::Palette(palette) => Some(&mut palette.typed),
            _ => None,
        }
    }

    /// Goes to the top of the list after its search text has changed.
    pub fn look_again(&mut self) {
        match &mut self.mode {
            InputMode::Help(help) => help.scroll = 0,
            InputMode::Palette(palette) => palette.place = 0,
            _ => {}
        }
    }
}

/// The open help.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct HelpState {
    /// Search words: only entries that contain all of them are listed.
    pub filter: Field,
    /// Whether every letter goes into the search; otherwise the first one may be a key of the
    /// help, such as `q`.
    pub searches: bool,
    /// Number of lines scrolled past.
    pub scroll: usize,
}

impl HelpState {
    /// Returns whether the help is searched, so that every letter goes into the search.
    pub fn is_searched(&self) -> bool {
        self.searches || !self.filter.text().is_empty()
    }
}

/// The open command palette.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PaletteState {
    /// The command or search words typed so far.
    pub typed: Field,
    /// Index of the selected entry among the matches.
    pub place: usize,
}

impl PaletteState {
    /// Creates a palette in which `text` is typed.
    pub fn typing(text: &str) -> Self {
        Self { typed: text.into(), place: 0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_typed_is_of_the_open_dialogue_and_a_list_begins_at_its_top() {
        let mut dialogue = Dialogue::default();
        assert!(dialogue.is_closed() && dialogue.asked && dialogue.typed().is_none());
        dialogue.open(InputMode::Palette(PaletteState { typed: "ab".into(), place: 3 }));
        dialogue.look_again();
        let expected = PaletteState { typed: "ab".into(), place: 0 };
        assert_eq!(dialogue.mode, InputMode::Palette(expected));
        dialogue.ask(InputMode::Replacing(Purpose::Save, "a".into()));
        assert!(!dialogue.asked);
        dialogue.asked = true;
        dialogue.close();
        assert!(dialogue.asked && dialogue.is_closed());
    }
}
