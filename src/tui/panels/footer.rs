//! The last line: the status message, or the keys that apply now, from the table of bindings. Help
//! and quit are always at its right end. A message that is longer than the line is wrapped, over the
//! rows above it.

use ratatui::{buffer::Buffer, layout::Rect};

use crate::tui::app::{App, InputMode};
use crate::tui::command::chord::Chord;
use crate::tui::command::table::{Binding, lookup, valid};
use crate::tui::command::{Command, Purpose};
use crate::tui::field::Field;
use crate::tui::text::{columns, overlay, pieces, print, shorten, wrap};
use crate::tui::theme::Role;

/// Gap between two entries.
const GAP: &str = "  ";

/// Width from which there is room for the key of the palette.
const PALETTE_FROM: u16 = 60;

/// Hint for new users.
const TRY: &str = "new here? → turns Ω, g: lessons";

pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    let look = &app.appearance;
    let mark = look.ellipsis();
    let asked = |question: &str, name: &Field| {
        let room = usize::from(area.width).saturating_sub(columns(question));
        format!("{question}{}", name.shown(room))
    };
    let question = match &app.dialogue.mode {
        InputMode::Naming(Purpose::Save, name) => Some(asked("save the scene as: ", name)),
        InputMode::Naming(Purpose::Export, name) => Some(asked("export as .csv or .svg: ", name)),
        InputMode::Replacing(_, name) => Some(format!("{name} exists: y replaces it, n leaves it")),
        InputMode::Leaving => {
            Some("the scene is changed: q quits, s saves it, Esc stays".to_string())
        }
        _ => None,
    };
    if let Some(question) = question.filter(|_| app.status.is_none()) {
        let shown = shorten(&question, usize::from(area.width), mark);
        print(buffer, area, 0, &shown, look.style(Role::Focus));
        return;
    }
    let hint = (app.dialogue.is_new && app.dialogue.mode == InputMode::Main).then_some(TRY);
    // The palette shows the message itself, below the typed text.
    let status =
        app.status.as_ref().filter(|_| !matches!(app.dialogue.mode, InputMode::Palette(..)));
    let message = match (status, hint) {
        (Some(status), _) => Some((look.spell(status), Role::Good)),
        (None, hint) => hint.map(|hint| (look.spell(hint), Role::Focus)),
    };
    let width = usize::from(area.width);
    let wanted = message.as_ref().map(|(text, _)| columns(text));
    let kept = kept(app, area.width, wanted);
    let kept_width: usize = kept.iter().map(|entry| entry.columns(app)).sum();
    let room = width.saturating_sub(kept_width + GAP.len());
    if let Some((text, role)) = message {
        let lines = wrap(&text, room);
        let (last, above) =
            lines.split_last().map_or((&text, &[][..]), |(last, above)| (last, above));
        let rows = u16::try_from(above.len()).unwrap_or(u16::MAX);
        if rows > area.y / 2 {
            print(buffer, area, 0, &shorten(&text, room, mark), look.style(role));
        } else {
            let place = Rect { y: area.y - rows, height: rows, ..area };
            overlay(buffer, place, above, look.style(role));
            print(buffer, area, 0, last, look.style(role));
        }
    } else {
        let room = Rect { width: u16::try_from(room).unwrap_or(0), ..area };
        keys(app, buffer, room);
    }
    let start = u16::try_from(width.saturating_sub(kept_width)).unwrap_or(0);
    let mut rest = Rect { x: area.x + start, width: area.width - start, ..area };
    for entry in kept {
        rest = entry.draw(app, buffer, rest);
    }
}

/// A binding as shown in the footer: its keys and one word.
struct Entry {
    binding: &'static Binding,
    gap: &'static str,
    keys: &'static str,
    word: &'static str,
}

impl Entry {
    fn columns(&self, app: &App) -> usize {
        let word = if self.word.is_empty() { 0 } else { 1 + columns(self.word) };
        self.gap.len() + columns(&app.appearance.spell(self.keys)) + word
    }

    /// Draws the entry, makes it clickable, and returns the rest of the row.
    fn draw(&self, app: &App, buffer: &mut Buffer, area: Rect) -> Rect {
        let look = &app.appearance;
        let wide = u16::try_from(self.columns(app)).unwrap_or(area.width).min(area.width);
        let keys = (format!("{}{}", self.gap, look.spell(self.keys)), look.style(Role::Focus));
        let word = if self.word.is_empty() { String::new() } else { format!(" {}", self.word) };
        pieces(buffer, area, 0, &[keys, (word, look.style(Role::Quiet))]);
        let gap = u16::try_from(self.gap.len()).unwrap_or(0).min(wide);
        let own = Rect { x: area.x + gap, width: wide - gap, height: 1, ..area };
        self.note(app, own);
        Rect { x: area.x + wide, width: area.width - wide, ..area }
    }

    /// Makes the entry clickable: a single-character key performs its own action, the word and
    /// named keys (like `Enter`) that of the binding.
    fn note(&self, app: &App, own: Rect) {
        app.note(own, self.binding.command.clone());
        let mut at = own.x;
        for token in self.keys.split(' ') {
            let is_name = token.chars().nth(1).is_some_and(char::is_lowercase);
            for sign in token.chars() {
                let command = lookup(app.keyboard(), Chord::from(sign));
                if let Some(command) = command.filter(|_| !is_name && at < own.right()) {
                    app.note(Rect { x: at, width: 1, ..own }, command);
                }
                at = at.saturating_add(1);
            }
            at = at.saturating_add(1);
        }
    }
}

/// Returns whether a binding is always shown, at the right end.
fn is_kept(binding: &Binding) -> bool {
    matches!(binding.command, Command::Palette("") | Command::Help | Command::Leave | Command::Quit)
}

/// Returns the entries at the right end: with words if the message leaves room, otherwise keys
/// only.
fn kept(app: &App, width: u16, message: Option<usize>) -> Vec<Entry> {
    let asked = app.dialogue.mode == InputMode::Leaving;
    let closes = !asked && (app.has_open() || app.lessons.progress.is_some());
    let entries = |words: bool| {
        let has_palette = words && width >= PALETTE_FROM;
        let kept = valid(app.keyboard()).filter(|binding| is_kept(binding));
        let kept = kept.filter(|binding| binding.command != Command::Palette("") || has_palette);
        let entry = |binding: &'static Binding| {
            let (keys, word) = binding.footer?;
            let word = if closes && binding.command == Command::Leave { "close" } else { word };
            let (gap, word) = if words { (GAP, word) } else { (" ", "") };
            Some(Entry { binding, gap, keys, word })
        };
        let mut entries: Vec<Entry> = kept.filter_map(entry).collect();
        entries.first_mut().into_iter().for_each(|first| first.gap = "");
        entries
    };
    let whole: usize = entries(true).iter().map(|entry| entry.columns(app)).sum();
    entries(message.is_none_or(|message| message + GAP.len() + whole <= usize::from(width)))
}

/// Draws the other keys, the most important first, as long as whole entries fit.
fn keys(app: &App, buffer: &mut Buffer, area: Rect) {
    let mut rest = area;
    // Keys of the main screen have no room while a dialogue is open over it.
    let on_main = app.keyboard().is_main();
    let own = |binding: &&Binding| on_main || !binding.group.is_main();
    let others = valid(app.keyboard()).filter(own).filter(|b| !is_kept(b));
    for (binding, (keys, word)) in others.filter_map(|binding| Some((binding, binding.footer?))) {
        let word = match binding.command {
            Command::Pause if !app.play.playing => "go on",
            // Most charts have nothing to open at the cursor.
            Command::Open => match app.opening() {
                Some(Command::OpenRun(_)) => "open",
                Some(Command::JumpTo { .. }) => "jump",
                Some(Command::Select(_)) => "select",
                _ => continue,
            },
            _ => word,
        };
        let entry = Entry { binding, gap: if rest == area { "" } else { GAP }, keys, word };
        if entry.columns(app) > usize::from(rest.width) {
            return;
        }
        rest = entry.draw(app, buffer, rest);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::{raster::Marker, theme::Theme};
    use ratatui::style::Style;
    use rubscope_solver::scene::Scene;

    fn app() -> App {
        App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Braille)
    }

    #[test]
    fn a_long_message_is_wrapped_over_the_rows_above() {
        let mut app = app();
        let words: Vec<String> = (10..60).map(|n| format!("word{n}")).collect();
        app.status = Some(words.join(" "));
        let area = Rect::new(0, 0, 80, 24);
        let mut buffer = Buffer::empty(area);
        buffer.set_string(0, 22, "x".repeat(80), Style::new());
        draw(&app, &mut buffer, Rect { y: 23, height: 1, ..area });
        let shown: String = buffer.content.iter().map(|cell| cell.symbol()).collect();
        let shown: Vec<&str> = shown.split_whitespace().collect();
        assert_eq!(
            shown,
            [&words.iter().map(String::as_str).collect::<Vec<_>>()[..], &["?", "q"]].concat()
        );
    }
}
