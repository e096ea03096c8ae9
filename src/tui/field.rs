//! The text of a prompt, with the editing keys of a shell.

use std::mem::take;

/// A text being typed, with its cursor.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Field {
    before: String,
    after: String,
}

/// An edit of the text, or a move of the cursor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edit {
    Left,
    Right,
    Start,
    End,
    DeleteBefore,
    DeleteAfter,
    DeleteWord,
    DeleteToStart,
    DeleteToEnd,
}

/// Combining underline that marks the cursor's letter until the screen is drawn.
pub const CURSOR: char = '\u{332}';

impl<T: Into<String>> From<T> for Field {
    /// Puts the cursor at the end.
    fn from(text: T) -> Self {
        Self { before: text.into(), after: String::new() }
    }
}

impl Field {
    /// Returns the whole text.
    pub fn text(&self) -> String {
        format!("{}{}", self.before, self.after)
    }

    /// Inserts a text at the cursor, unless the whole would exceed `most` bytes.
    pub fn insert(&mut self, text: &str, most: usize) -> bool {
        let fits = self.text().len().saturating_add(text.len()) <= most;
        self.before.push_str(if fits { text } else { "" });
        fits
    }

    /// Edits the text; returns whether anything changed.
    pub fn edit(&mut self, edit: Edit) -> bool {
        let old = self.clone();
        let (before, after) = (&mut self.before, &mut self.after);
        let mut rest = after.chars();
        match edit {
            Edit::Left => after.insert_str(0, &before.pop().map(String::from).unwrap_or_default()),
            Edit::Right => {
                before.extend(rest.next());
                *after = rest.as_str().into();
            }
            Edit::Start => *after = take(before) + after,
            Edit::End => before.push_str(&take(after)),
            Edit::DeleteBefore => _ = before.pop(),
            Edit::DeleteAfter => {
                rest.next();
                *after = rest.as_str().into();
            }
            Edit::DeleteWord => {
                let word = before.trim_end().rfind(' ');
                before.truncate(word.map_or(0, |space| space + 1));
            }
            Edit::DeleteToStart => before.clear(),
            Edit::DeleteToEnd => after.clear(),
        }
        *self != old
    }

    /// Returns the part around the cursor that fits into this many columns, with the cursor.
    pub fn shown(&self, columns: usize) -> String {
        let mut rest = self.after.chars();
        let under = rest.next().map_or("_".into(), |letter| format!("{letter}{CURSOR}"));
        let skip = (self.before.chars().count() + 1).saturating_sub(columns);
        let before: String = self.before.chars().skip(skip).collect();
        let room = columns.saturating_sub(before.chars().count() + 1);
        before + &under + &rest.take(room).collect::<String>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_edit_of_a_shell_does_what_it_does_there() {
        use Edit::*;
        for (edits, expected) in [
            (&[Left, Left, DeleteBefore][..], "one tw|es"),
            (&[Start, Right, DeleteAfter], "o|e twoes"),
            (&[DeleteWord], "one |"),
            (&[DeleteWord, DeleteWord, DeleteWord], "|"),
            (&[Left, DeleteToStart, Left], "|s"),
            (&[Start, Right, DeleteToEnd, Right], "o|"),
            (&[Start, End, DeleteAfter], "one twoes|"),
        ] {
            let mut field = Field::from("one twoes");
            edits.iter().for_each(|edit| _ = field.edit(*edit));
            assert_eq!(format!("{}|{}", field.before, field.after), expected, "{edits:?}");
        }
    }

    #[test]
    fn the_cursor_is_in_sight_in_any_width() {
        let mut field = Field::from("a/long/näme");
        assert_eq!((field.shown(20).as_str(), field.shown(4).as_str()), ("a/long/näme_", "äme_"));
        field.edit(Edit::Left);
        assert_eq!(field.shown(4), format!("näme{CURSOR}"));
        field.edit(Edit::Start);
        assert_eq!(field.shown(4), format!("a{CURSOR}/lo"));
        assert!(field.edit(Edit::Right) && field.edit(Edit::DeleteToEnd));
        assert!(!field.edit(Edit::Right) && !field.insert("long", 4) && field.insert("b", 4));
        assert_eq!(field.text(), "ab");
    }
}
