//! The help: the large view, every key by group, and the glossary. Typed words filter the entries.

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier};
use strum::IntoEnumIterator;

use super::glossary;
use super::layout::placed;
use super::model::App;
use crate::tui::command::table::{self, Binding, Group};
use crate::tui::field::Field;
use crate::tui::knobs::{KNOBS, Knob};
use crate::tui::text::{print, shorten, wrap};
use crate::tui::theme::Role;

/// Rows above the list, for the search text.
const ABOVE: u16 = 1;

/// A key or term, and its meaning.
struct Entry {
    left: String,
    right: String,
    /// Further words by which a search matches it.
    also: String,
}

impl Entry {
    fn of(binding: &Binding) -> Self {
        let (left, right) = (table::keys_text(binding), binding.what.to_string());
        Self { left, right, also: String::new() }
    }

    /// Returns whether the entry contains all these words. A single letter must be a key by itself.
    fn has(&self, heading: &str, words: &[String]) -> bool {
        let text = format!("{heading} {} {} {}", self.left, self.right, self.also).to_lowercase();
        let is_named = |letter: &str| {
            let names = self.left.to_lowercase();
            names.split([' ', ',']).any(|name| name == letter)
        };
        words.iter().all(|word| match word.chars().all(|c| c.is_ascii_alphanumeric()) {
            true if word.len() == 1 => is_named(word),
            _ => text.contains(word),
        })
    }
}

/// Returns the sections of the help: heading and entries.
fn sections(app: &App) -> Vec<(&'static str, Vec<Entry>)> {
    let look = &app.appearance;
    // What a key does everywhere is listed once.
    let everywhere = |b: &Binding| table::main().any(|main| main.what == b.what);
    let keys = |is_main: bool| {
        let groups = Group::iter().filter(move |group| group.is_main() == is_main);
        groups.map(move |group| {
            let own = table::of(group).filter(|b| is_main || !everywhere(b));
            (group.into(), own.map(Entry::of).collect())
        })
    };
    let words = glossary::sections().iter().map(|section| {
        let entry = |term: &glossary::Term| Entry {
            left: look.either(term.symbol.as_str(), term.name()).to_string(),
            right: look.spell(&term.text(app)),
            also: format!("glossary {} {} {}", term.symbol, term.name(), term.meaning),
        };
        (section.heading.as_str(), section.terms.iter().map(entry).collect())
    });
    let here = std::iter::once(("Here", here(app)));
    // The other knobs are explained by a term of the glossary.
    let explained = KNOBS.iter().filter(|knob| !glossary::explains(knob.path));
    let knob = |knob: &Knob| Entry {
        left: look.spell(knob.label),
        right: look.spell(&format!("{}; here {}", knob.does, knob.text(&app.scene))),
        also: format!("glossary {}", knob.path),
    };
    let knobs = std::iter::once(("What each knob does", explained.map(knob).collect()));
    here.chain(keys(true)).chain(words).chain(knobs).chain(keys(false)).collect()
}

/// Returns what the large chart shows, what to look for, and its keys.
fn here(app: &App) -> Vec<Entry> {
    let look = &app.appearance;
    let Some(words) = glossary::view(app.view()) else { return Vec::new() };
    let name = format!("{} {}", app.view().digit(), app.view().word());
    let rows =
        [(name, &words.drawn), ("look for".into(), &words.look), ("keys".into(), &words.keys)];
    let entry = |(left, text): (String, &String)| Entry {
        left,
        right: look.spell(text),
        also: String::new(),
    };
    rows.map(entry).into()
}

/// A line of the list: left column, right column, and whether it is a heading.
type Line = (String, String, bool);

fn keys_width(width: u16) -> u16 {
    if width >= 60 { 22 } else { 14 }
}

/// Returns the lines that match the filter, and the number of matching entries.
fn lines(app: &App, area: Rect, filter: &str) -> (Vec<Line>, usize) {
    let left = usize::from(keys_width(area.width));
    let width = usize::from(area.width).saturating_sub(left + 1);
    let words: Vec<String> = filter.split_whitespace().map(str::to_lowercase).collect();
    let (mut lines, mut count) = (Vec::new(), 0);
    for (heading, entries) in sections(app) {
        let mut found = entries.iter().filter(|entry| entry.has(heading, &words)).peekable();
        if found.peek().is_none() {
            continue;
        }
        if !lines.is_empty() {
            lines.push((String::new(), String::new(), false));
        }
        lines.push((heading.to_string(), String::new(), true));
        for entry in found {
            count += 1;
            // The keys may need more than one line too.
            let keys = wrap(&entry.left, left.saturating_sub(1));
            let what = wrap(&entry.right, width);
            for row in 0..keys.len().max(what.len()) {
                let part = |of: &[String]| of.get(row).cloned().unwrap_or_default();
                lines.push((part(&keys), part(&what), false));
            }
        }
    }
    (lines, count)
}

/// Returns the area of the list within the body of the screen.
fn list(body: Rect) -> Rect {
    Rect { y: body.y + ABOVE, height: body.height.saturating_sub(ABOVE), ..body }
}

/// Returns the largest scroll position of the help.
pub fn help_bottom(app: &App, filter: &Field) -> usize {
    let area = list(placed(app).body);
    lines(app, area, &filter.text()).0.len().saturating_sub(usize::from(area.height))
}

/// Returns the entries of the help that match `words`, as lines of `width` columns.
pub fn help_text(app: &App, width: u16, words: &str) -> Vec<String> {
    let (lines, _) = lines(app, Rect::new(0, 0, width, 1), words);
    let left = usize::from(keys_width(width));
    lines
        .into_iter()
        .map(|(keys, what, _)| format!("{keys:left$}{what}").trim_end().into())
        .collect()
}

pub fn draw(app: &App, buffer: &mut Buffer, area: Rect, filter: &Field) {
    let look = &app.appearance;
    let width = usize::from(area.width);
    let below = list(area);
    let (lines, count) = lines(app, below, &filter.text());
    let first =
        app.dialogue.place.unwrap_or(0).min(lines.len().saturating_sub(usize::from(below.height)));
    let last = (first + usize::from(below.height)).min(lines.len());
    let place = format!("{last}/{}", lines.len());
    let room = width.saturating_sub(place.len() + 1);
    let found = match count {
        0 => "no match".to_string(),
        count => format!("{count} found"),
    };
    let head = match app.keyboard() {
        Group::Help => "Type to find a key, a word or a symbol".to_string(),
        _ => {
            let typed = filter.shown(room.saturating_sub(found.len() + 8));
            format!("find: {typed}  {found}")
        }
    };
    let head = shorten(&head, room, look.ellipsis());
    print(buffer, area, 0, &head, look.style(Role::Focus));
    let at = u16::try_from(place.len()).unwrap_or(0);
    let right = Rect { x: area.right().saturating_sub(at), width: at, ..area };
    print(buffer, right, 0, &place, look.style(Role::Quiet));
    for (row, (keys, what, is_heading)) in (0..below.height).zip(lines.iter().skip(first)) {
        let style = match is_heading {
            true => look.style(Role::Text).add_modifier(Modifier::BOLD | Modifier::UNDERLINED),
            false => look.style(Role::Focus),
        };
        print(buffer, below, row, keys, style);
        let at = keys_width(area.width);
        let right = Rect { x: area.x + at, width: area.width.saturating_sub(at), ..below };
        print(buffer, right, row, what, look.style(Role::Text));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::command::Command;
    use crate::tui::views::id::ViewId;
    use crate::tui::{raster::Marker, theme::Theme};
    use rubscope_solver::scene::Scene;

    fn text(filter: &str) -> String {
        let app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Braille);
        let area = Rect::new(0, 0, 130, 400);
        let mut buffer = Buffer::empty(area);
        draw(&app, &mut buffer, area, &filter.into());
        buffer.content.iter().map(|cell| cell.symbol().to_string()).collect()
    }

    #[test]
    fn every_binding_and_every_word_is_in_the_help() {
        let text = text("");
        for binding in table::BINDINGS.iter() {
            assert!(text.contains(binding.what), "{}", binding.what);
            for key in binding.keys {
                assert!(text.contains(&key.to_string()), "{}", binding.what);
            }
        }
        for group in Group::iter().filter(|group| *group != Group::Dialogue) {
            assert!(text.contains(<&str>::from(group)), "{group:?}");
        }
        for term in glossary::sections().iter().flat_map(|section| &section.terms) {
            assert!(text.contains(&term.symbol), "{}", term.symbol);
        }
    }

    #[test]
    fn it_begins_with_the_view_on_the_screen_in_five_lines_at_most() {
        let mut app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Braille);
        for view in ViewId::all() {
            app.act(Command::View(view));
            let (lines, _) = lines(&app, Rect::new(0, 0, 80, 24), "");
            let own: Vec<_> =
                lines.iter().skip(1).take_while(|(_, what, _)| !what.is_empty()).collect();
            assert_eq!(own[0].0, format!("{} {}", view.digit(), view.word()));
            assert!((3..=5).contains(&own.len()), "{own:?}");
        }
    }
}
