//! The open dialogue: what the keyboard acts on.

use crate::tui::field::Field;

/// Target of the keyboard: the main screen or an open dialogue.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum InputMode {
    /// Knobs and charts.
    Main,
    /// The value of the selected knob is being typed.
    Typing(Field),
    /// The help is open.
    Help(HelpState),
    /// A command is being looked for.
    Palette(PaletteState),
    /// A file name is being typed.
    Naming(Purpose, Field),
    /// A question: replace the existing file?
    Replacing(Purpose, String),
    /// A lesson is being chosen.
    Lessons(usize),
    /// A scene is being chosen: its place in the list, or the open one.
    Scenes(Option<usize>),
}

/// The purpose of a file name that is typed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Purpose {
    /// The scene as a TOML file.
    Save,
    /// The large chart's data as CSV, or the screen as SVG.
    Export,
}

/// The open dialogue, if one is.
#[derive(Clone, Debug)]
pub struct Dialogue {
    /// Target of the keyboard: the main screen or an open dialogue.
    pub mode: InputMode,
    /// Page of the note of the selected scene, where it is long.
    pub note_page: usize,
    /// Whether the user is new and has pressed no key yet: the last line says
    /// what to try.
    pub is_new: bool,
    /// Whether the screen has shown the question that is open.
    pub asked: bool,
}

impl Default for Dialogue {
    fn default() -> Self {
        Self { mode: InputMode::Main, note_page: 0, is_new: false, asked: true }
    }
}

impl Dialogue {
    /// Returns whether none is open.
    pub fn is_closed(&self) -> bool {
        self.mode == InputMode::Main
    }

    /// Opens another, at its first page.
    pub fn open(&mut self, mode: InputMode) {
        (self.mode, self.note_page) = (mode, 0);
    }

    /// Opens a question, which is answered once the screen has shown it.
    pub fn ask(&mut self, mode: InputMode) {
        self.open(mode);
        self.asked = false;
    }

    /// Closes it.
    pub fn close(&mut self) {
        self.mode = InputMode::Main;
    }

    /// Returns the text that is being typed.
    pub fn typed(&mut self) -> Option<&mut Field> {
        match &mut self.mode {
            InputMode::Typing(text) | InputMode::Naming(_, text) => Some(text),
            InputMode::Help(help) => Some(&mut help.filter),
            InputMode::Palette(palette) => Some(&mut palette.typed),
            _ => None,
        }
    }

    /// Scrolls the list to its top after a change of what is searched.
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
    /// Only entries with these words are shown.
    pub filter: Field,
    /// Whether every letter is part of them, the first one too.
    pub searches: bool,
    /// Lines above the first that is shown.
    pub scroll: usize,
}

/// The open list.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct PaletteState {
    /// Text that is searched for.
    pub typed: Field,
    /// The chosen line of what was found.
    pub place: usize,
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
