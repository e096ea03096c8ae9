//! The help: every binding, and a glossary.

use ratatui::{buffer::Buffer, layout::Rect, style::Modifier};

use crate::tui::app::App;
use crate::tui::bindings::{self, Context};
use crate::tui::text::{print, wrap};
use crate::tui::theme::Role;

/// The glossary, for a reader who does not know the paper.
const WORDS: &[(&str, &str)] = &[
    (
        "the machine",
        "a rotor of N flexible blades turns inside a flexible casing; both vibrate in one pattern of n_d nodal diameters",
    ),
    (
        "mouse",
        "click a knob or a chart, turn the wheel on a knob or over time, drag a bar, point in a chart to read it",
    ),
    ("pulse", "a short push on the casing that starts the motion"),
    ("gap", "distance from a blade tip to the casing; zero is contact"),
    (
        "multiplier λ",
        "contact force on a blade group: negative pushes; positive pulls, which a real contact cannot do",
    ),
    ("locked", "the same blades stay in contact and push: the casing wave turns with the rotor"),
    ("adhesive", "looks locked, but a blade pulls: only the equality (bilateral) law allows it"),
    (
        "slip",
        "contact without a break that no corner holds: its sides change, or there is one side",
    ),
    ("bounce", "contacts that come and go"),
    ("decay", "the motion dies away without further contact"),
    ("Ω_c", "critical speed: above it the turning blades push the casing outward"),
    ("Ω_lock", "above it both multipliers of a lock push"),
];

/// Draws the help, scrolled down by some lines.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect, scroll: u16) {
    let look = &app.appearance;
    let keys_width = if area.width >= 60 { 22 } else { 14 };
    let width = usize::from(area.width).saturating_sub(keys_width + 1);
    let mut lines: Vec<(String, String, bool)> = vec![("Keys".into(), String::new(), true)];
    for binding in bindings::of(Context::Main) {
        entry(&mut lines, &bindings::keys_text(binding), binding.what, width);
    }
    for (head, context) in [
        ("While a chart is read", Context::Reading),
        ("While typing", Context::Typing),
        ("Where a file exists", Context::Replacing),
        ("In the list of lessons", Context::Lessons),
        ("While a lesson asks", Context::Question),
        ("In the list of scenes", Context::Scenes),
    ] {
        lines.push((head.into(), String::new(), true));
        for binding in bindings::of(context) {
            entry(&mut lines, &bindings::keys_text(binding), binding.what, width);
        }
    }
    lines.push(("Words".into(), String::new(), true));
    for (word, meaning) in WORDS {
        entry(&mut lines, &look.spell(word), &look.spell(meaning), width);
    }
    let most = lines.len().saturating_sub(usize::from(area.height));
    let first = usize::from(scroll).min(most);
    for (row, (keys, what, head)) in (0..area.height).zip(lines.iter().skip(first)) {
        let style = if *head {
            look.style(Role::Text).add_modifier(Modifier::BOLD)
        } else {
            look.style(Role::Focus)
        };
        print(buffer, area, row, keys, style);
        let at = u16::try_from(keys_width).unwrap_or(0);
        let right = Rect { x: area.x + at, width: area.width.saturating_sub(at), ..area };
        print(buffer, right, row, what, look.style(Role::Text));
    }
}

fn entry(lines: &mut Vec<(String, String, bool)>, keys: &str, what: &str, width: usize) {
    for (place, part) in wrap(what, width).into_iter().enumerate() {
        lines.push((if place == 0 { keys.to_string() } else { String::new() }, part, false));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::tui::{raster::Marker, theme::Theme};

    #[test]
    fn every_binding_of_the_main_screen_is_in_the_help() {
        let app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Braille);
        let area = Rect::new(0, 0, 100, 200);
        let mut buffer = Buffer::empty(area);
        draw(&app, &mut buffer, area, 0);
        let text: String = buffer.content.iter().map(|cell| cell.symbol().to_string()).collect();
        for binding in bindings::BINDINGS.iter().filter(|b| b.context != Context::Help) {
            assert!(text.contains(binding.what), "{}", binding.what);
            assert!(text.contains(&bindings::keys_text(binding)), "{}", binding.what);
        }
    }
}
