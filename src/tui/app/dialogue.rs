//! The dialogue that has the keyboard: a prompt, a list, a question, or none; moving in its list,
//! and editing its text.

use super::help::help_bottom;
use super::layout::placed;
use super::model::{App, Dialogue, InputMode, Reading};
use crate::tui::command::table::Group;
use crate::tui::command::{Command, Effect};
use crate::tui::field::{Edit, Field};

impl Dialogue {
    pub fn is_closed(&self) -> bool {
        self.mode == InputMode::Main
    }

    /// Opens a dialogue.
    pub fn open(&mut self, mode: InputMode) {
        (self.mode, self.place) = (mode, None);
    }

    /// Opens a question, which keys can answer only after a frame has shown it.
    pub fn ask(&mut self, mode: InputMode) {
        self.open(mode);
        self.unseen = true;
    }

    pub fn close(&mut self) {
        self.mode = InputMode::Main;
    }

    /// Returns the text field that has the keyboard; `None` if no dialogue with one is open.
    pub fn typed(&mut self) -> Option<&mut Field> {
        match &mut self.mode {
            InputMode::Typing(text)
            | InputMode::Naming(_, text)
            | InputMode::Palette(_, text)
            | InputMode::Help(text)
            | InputMode::Search(text) => Some(text),
            _ => None,
        }
    }
}

impl App {
    /// Returns the group of commands that has the keyboard; [`Group::Program`] on the main screen,
    /// where the keys of all its groups are valid.
    pub fn keyboard(&self) -> Group {
        match &self.dialogue.mode {
            // The letters on the screen answer, also while a chart is read.
            InputMode::Main if self.is_asked() => Group::Question,
            InputMode::Main if self.reading.on => Group::Reading,
            InputMode::Main => Group::Program,
            InputMode::Help(filter) if filter.text().is_empty() => Group::Help,
            InputMode::Help(_) | InputMode::Search(_) => Group::Filter,
            InputMode::Palette(..) => Group::Palette,
            InputMode::Typing(_) | InputMode::Naming(..) => Group::Typing,
            InputMode::Replacing(..) => Group::Replacing,
            InputMode::Leaving => Group::Leaving,
        }
    }

    /// Drops the refusal of the former text, and goes to the top of the list, after a text field was
    /// edited.
    pub fn typed_on(&mut self) {
        self.knobs.refusal = None;
        if self.dialogue.typed().is_some() {
            self.dialogue.place = None;
        }
    }

    /// Takes what is typed or selected in the open dialogue, or the selected answer of a lesson.
    pub fn accept(&mut self) -> Result<Effect, String> {
        match self.dialogue.mode.clone() {
            InputMode::Palette(word, typed) => return self.choose_command(word, &typed),
            InputMode::Naming(purpose, name) => return self.write(purpose, &name.text(), false),
            InputMode::Typing(text) => self.take_typed(&text.text()),
            InputMode::Main => {
                if let Some(choice) = self.lessons.progress.as_ref().map(|progress| progress.choice)
                {
                    self.answer(choice);
                }
            }
            InputMode::Replacing(purpose, name) if !self.dialogue.unseen => {
                return self.write(purpose, &name, true);
            }
            _ => {}
        }
        Ok(Effect::None)
    }

    /// Closes one level of what is open. On the main screen it quits, but asks where the scene is
    /// changed and not saved.
    pub fn leave(&mut self) -> Effect {
        if self.dialogue.mode == InputMode::Leaving {
            // A key typed before the question was drawn does not answer it.
            return if self.dialogue.unseen { Effect::None } else { Effect::Quit };
        }
        if self.has_open() {
            self.close();
        } else if self.lessons.progress.is_some() {
            self.leave_lesson();
        } else if self.files.is_changed(&self.scene) {
            self.dialogue.ask(InputMode::Leaving);
        } else {
            return Effect::Quit;
        }
        Effect::None
    }

    /// Closes what is open: the search of the help, a dialogue, the cursor, the list of knobs, the
    /// other law, or the full screen.
    pub fn close(&mut self) {
        self.knobs.refusal = None;
        if self.keyboard() == Group::Filter {
            self.dialogue.open(InputMode::Help(Field::default()));
        } else if !self.dialogue.is_closed() {
            self.dialogue.close();
        } else if self.reading != Reading::default() || self.play.middle_s.is_some() {
            self.stop_reading();
        } else if self.compares() {
            self.run.set_compare(false);
        } else if !self.close_list() {
            self.layout.full_screen = false;
        }
    }

    /// Closes the list of knobs over the charts; returns whether it was open.
    pub fn close_list(&mut self) -> bool {
        let is_open = placed(self).list.is_some();
        if is_open {
            self.knobs.select(0);
        }
        is_open
    }

    /// Returns whether a dialogue, a cursor, the list of knobs or the only chart is open over the
    /// main screen.
    pub fn has_open(&self) -> bool {
        let reads = self.reading.on || self.reading.cursor.is_some();
        !self.dialogue.is_closed() || reads || placed(self).list.is_some() || self.is_alone()
    }

    /// Moves the selection of the open list, or scrolls the help; returns false for other
    /// commands.
    pub fn move_in_list(&mut self, command: &Command) -> bool {
        let (from, last) = match &self.dialogue.mode {
            InputMode::Help(filter) | InputMode::Search(filter) => {
                let last = help_bottom(self, filter);
                (self.dialogue.place.unwrap_or(0).min(last), last)
            }
            InputMode::Palette(word, typed) => {
                let (found, place) = self.palette(word, typed);
                (place, found.len().saturating_sub(1))
            }
            _ => return false,
        };
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
        self.dialogue.place = Some(to.min(last));
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
    use crate::tui::app::tests::on_screen;
    use crate::tui::command::Purpose;

    #[test]
    fn what_is_typed_is_of_the_open_dialogue_and_a_list_begins_at_its_top() {
        let mut app = on_screen();
        assert!(app.dialogue.is_closed() && !app.dialogue.unseen && app.dialogue.typed().is_none());
        app.dialogue.open(InputMode::Palette("", "ab".into()));
        app.dialogue.place = Some(3);
        app.typed_on();
        assert_eq!(app.dialogue.place, None);
        app.dialogue.ask(InputMode::Replacing(Purpose::Save, "a".into()));
        assert!(app.dialogue.unseen);
        app.dialogue.unseen = false;
        app.dialogue.close();
        assert!(!app.dialogue.unseen && app.dialogue.is_closed());
    }
}
