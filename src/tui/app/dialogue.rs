//! The dialogue that has the keyboard: a prompt, a list, a question, or none; moving in its list,
//! and editing its text.

use super::App;
use super::help::{HelpState, help_bottom};
use super::layout::placed;
use super::palette::PaletteState;
use super::words;
use crate::tui::command::{Command, Purpose};
use crate::tui::field::{Edit, Field};
use crate::tui::lessons;

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
    /// Asking whether to quit with a changed scene.
    Leaving,
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

impl App {
    /// Returns whether a dialogue, a cursor or the full screen is open over the main screen.
    pub fn has_open(&self) -> bool {
        let reads = self.reading.on || self.reading.cursor.is_some();
        !self.dialogue.is_closed() || reads || self.layout.full_screen
    }

    /// Moves the selection of the open list, or scrolls the help; returns false for other
    /// commands.
    pub fn move_in_list(&mut self, command: &Command) -> bool {
        let last = |count: usize| count.saturating_sub(1);
        let (from, last) = match &self.dialogue.mode {
            InputMode::Help(help) => (help.scroll, help_bottom(self, help)),
            InputMode::Palette(palette) => {
                (palette.place, last(words::found(self, &palette.typed.text()).len()))
            }
            InputMode::Lessons(place) => (*place, last(lessons::all().len())),
            InputMode::Scenes(chosen) => {
                let entries = self.scene_entries();
                (self.scene_place(&entries, *chosen), last(entries.len()))
            }
            _ => return false,
        };
        // A resize can leave the place past the end; then a key up would have no visible effect at
        // first.
        let from = from.min(last);
        let page = usize::from(placed(self).body.height.saturating_sub(2)).max(1);
        let to = match command {
            Command::Below => from + 1,
            Command::Above => from.saturating_sub(1),
            Command::PageForward => from + page,
            Command::PageBack => from.saturating_sub(page),
            Command::First => 0,
            Command::Last => last,
            _ => return false,
        };
        let to = to.min(last);
        match &mut self.dialogue.mode {
            InputMode::Help(HelpState { scroll: place, .. })
            | InputMode::Palette(PaletteState { place, .. })
            | InputMode::Lessons(place) => *place = to,
            InputMode::Scenes(place) => *place = Some(to),
            _ => {}
        }
        self.dialogue.note_page = 0;
        true
    }

    /// Edits the text field. Home and End, if they do not move the text cursor, move in the list.
    pub fn edit(&mut self, edit: Edit) {
        match (self.dialogue.typed().is_some_and(|field| field.edit(edit)), edit) {
            (true, Edit::Left | Edit::Right | Edit::Start | Edit::End) => {}
            (false, Edit::Start) => _ = self.move_in_list(&Command::First),
            (false, Edit::End) => _ = self.move_in_list(&Command::Last),
            _ => self.typed_on(),
        }
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
