//! The lists that cover the charts: the command palette, and the scenes with the note of the
//! selected one. Also what all lists share: scrolling, and the style of the selected entry.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use crate::tui::app::{App, PaletteState, SceneEntry};
use crate::tui::appearance::Appearance;
use crate::tui::text::{columns, print, shorten, wrap};
use crate::tui::theme::Role;
use crate::tui::words;

/// Draws the command palette.
pub fn commands(app: &App, buffer: &mut Buffer, area: Rect, palette: &PaletteState) {
    let look = &app.appearance;
    let (width, mark) = (usize::from(area.width), look.ellipsis());
    let found = words::found(app, &palette.typed.text());
    let hint = match palette.typed.text().as_str() {
        "" => "  t 0.3 ms, speed 450, blade 7, scene rub, or any words",
        _ => "",
    };
    let typed = palette.typed.shown(width.saturating_sub(2));
    let head = shorten(&format!(": {typed}{hint}"), width, mark);
    print(buffer, area, 0, &head, look.style(Role::Focus));
    let status = app.status.as_ref().map_or(Vec::new(), |text| wrap(&look.spell(text), width));
    let mut said: Vec<_> = status.into_iter().map(|line| (line, Role::Trouble)).collect();
    if found.is_empty() {
        said.push(("nothing has these words".into(), Role::Quiet));
    }
    let mut top = 1;
    for (line, role) in said {
        print(buffer, area, top, &line, look.style(role));
        top += 1;
    }
    let rows = usize::from(area.height.saturating_sub(top));
    let place = palette.place.min(found.len().saturating_sub(1));
    let first = first_in_sight(place, rows);
    for (row, (index, item)) in (top..area.height).zip(found.iter().enumerate().skip(first)) {
        let (sign, style) = look_of(look, index == place, Role::Text);
        let kind = if item.kind.is_empty() { String::new() } else { format!("{} ", item.kind) };
        let beside = look.spell(&item.beside);
        let room = width.saturating_sub(columns(&beside) + 1);
        let what = shorten(&look.spell(&format!("{sign}{kind}{}", item.what)), room, mark);
        let pad = width.saturating_sub(columns(&what) + columns(&beside));
        print(buffer, area, row, &format!("{what}{}{beside}", " ".repeat(pad)), style);
    }
}

/// Returns the first visible entry of a list with `rows` rows, such that the selected one is
/// visible.
pub fn first_in_sight(chosen: usize, rows: usize) -> usize {
    (chosen + 1).saturating_sub(rows)
}

/// Returns marker and style of an entry: highlighted if selected, otherwise in the colour of
/// `role`.
pub fn look_of(look: &Appearance, is_chosen: bool, role: Role) -> (&'static str, Style) {
    match is_chosen {
        true => (look.either("▸", ">"), look.style(Role::Focus).add_modifier(Modifier::REVERSED)),
        false => (" ", look.style(role)),
    }
}

/// Width from which the note is beside the list.
const BESIDE_FROM: u16 = 100;
/// Width of the list beside a note.
const LIST_WIDTH: u16 = 64;
/// Widest scene name.
const NAME_WIDTH: usize = 24;

/// Draws the list of scenes; `chosen` is selected, or else the open scene.
pub fn scenes(app: &App, buffer: &mut Buffer, area: Rect, chosen: Option<usize>) {
    let look = &app.appearance;
    let mark = look.ellipsis();
    let entries = app.scene_entries();
    let place = app.scene_place(&entries, chosen);
    let found = &app.files.found;
    let head = match (&found.missing, found.reading) {
        (_, true) => "Scenes: reading the files of this folder".to_string(),
        (Some(missing), false) => format!("Scenes: {missing}"),
        (None, false) => "Scenes: Enter opens one, u brings the former back".to_string(),
    };
    let bold = look.style(Role::Text).add_modifier(Modifier::BOLD);
    print(buffer, area, 0, &shorten(&look.spell(&head), usize::from(area.width), mark), bold);
    let area = Rect { y: area.y + 1, height: area.height.saturating_sub(1), ..area };
    let selected = entries.get(place);
    let beside = area.width >= BESIDE_FROM;
    let notes_width = if beside { area.width - LIST_WIDTH - 2 } else { area.width };
    let notes = selected.map_or(Vec::new(), |entry| notes(app, entry, usize::from(notes_width)));
    let (list, text) = if beside {
        let text = Rect { x: area.x + LIST_WIDTH + 2, width: notes_width, ..area };
        (Rect { width: LIST_WIDTH, ..area }, text)
    } else {
        let wanted = u16::try_from(notes.len() + 1).unwrap_or(u16::MAX);
        let rows = wanted.min(area.height / 2);
        let list = Rect { height: area.height.saturating_sub(rows), ..area };
        (list, Rect { y: list.bottom(), height: rows, ..area })
    };
    rows(app, buffer, list, &entries, place);
    if let Some(entry) = selected {
        note(app, buffer, text, entry, &notes);
    }
}

fn rows(app: &App, buffer: &mut Buffer, area: Rect, entries: &[SceneEntry], place: usize) {
    let look = &app.appearance;
    let mark = look.ellipsis();
    let names = entries.iter().map(|entry| columns(&entry.name));
    let wide = names.max().unwrap_or(0).min(NAME_WIDTH);
    let first = first_in_sight(place, usize::from(area.height));
    let shown = entries.iter().enumerate().skip(first);
    for (row, (index, entry)) in (0..area.height).zip(shown) {
        let role = if entry.scene.is_ok() { Role::Text } else { Role::Trouble };
        let (sign, style) = look_of(look, index == place, role);
        let open = if entry.open { '*' } else { ' ' };
        let name = shorten(&look.spell(&entry.name), wide, mark);
        let pad = " ".repeat(wide.saturating_sub(columns(&name)));
        let title = match &entry.scene {
            Ok(scene) => scene.title.as_str(),
            Err(_) => "cannot be read",
        };
        let title = look.spell(title);
        let text =
            shorten(&format!("{sign}{open} {name}{pad}  {title}"), usize::from(area.width), mark);
        print(buffer, area, row, &text, style);
    }
}

/// Returns the note of a scene, or why it cannot be opened, as lines.
fn notes(app: &App, entry: &SceneEntry, width: usize) -> Vec<(String, Role)> {
    let (text, role) = match &entry.scene {
        Ok(scene) if scene.note.is_empty() => ("It has no note.", Role::Quiet),
        Ok(scene) => (scene.note.as_str(), Role::Text),
        Err(error) => (error.as_str(), Role::Trouble),
    };
    wrap(&app.appearance.spell(text), width).into_iter().map(|line| (line, role)).collect()
}

/// Prints a page of the note below a rule with the scene's name.
fn note(app: &App, buffer: &mut Buffer, area: Rect, entry: &SceneEntry, lines: &[(String, Role)]) {
    let look = &app.appearance;
    let (width, mark) = (usize::from(area.width), look.ellipsis());
    let room = usize::from(area.height.saturating_sub(1)).max(1);
    let pages = lines.len().div_ceil(room).max(1);
    let page = app.dialogue.note_page % pages;
    let open = if entry.open { " (open)" } else { "" };
    let more = match pages {
        1 => String::new(),
        _ => format!("  {}/{pages}, Space: more", page + 1),
    };
    let left = width.saturating_sub(columns(open) + columns(&more) + 3);
    let name = shorten(&look.spell(&entry.name), left, mark);
    let dash = look.either("─", "-");
    let head = format!("{dash} {name}{open}{more} ");
    let rule = dash.repeat(width.saturating_sub(columns(&head)));
    print(buffer, area, 0, &format!("{head}{rule}"), look.style(Role::Quiet));
    let shown = lines.iter().skip(page * room);
    for (row, (text, role)) in (1..area.height).zip(shown) {
        print(buffer, area, row, text, look.style(*role));
    }
}
