//! What a click or the wheel at a place of the screen does. A key does the same.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};

use ratatui::layout::Rect;

use super::Effect;
use crate::tui::app::{App, Cursor, InputMode, Target};
use crate::tui::bindings::Action;
use crate::tui::knobs::KNOBS;
use crate::tui::views::id::ViewId;

impl App {
    /// Handles a mouse event; `None` if it does nothing.
    pub fn mouse(&mut self, event: &MouseEvent) -> Option<Effect> {
        let at = (event.column, event.row);
        if !self.mouse.on {
            return None;
        }
        let left = event.kind == MouseEventKind::Down(MouseButton::Left);
        let key = match self.target(at) {
            Some((_, Target::Key(action))) if left => Some(action),
            _ => None,
        };
        let outcome = match (&self.dialogue.mode, event.kind, key) {
            // A typed name is finished or left by a key.
            (InputMode::Naming(..) | InputMode::Replacing(..), ..) => None,
            (.., Some(action)) => self.acted(action),
            (InputMode::Main | InputMode::Typing(_), kind, _) => self.mouse_main(kind, event, at),
            (_, MouseEventKind::ScrollUp, _) => self.acted(Action::KnobAbove),
            (_, MouseEventKind::ScrollDown, _) => self.acted(Action::KnobBelow),
            (_, MouseEventKind::Down(MouseButton::Right), _) => self.acted(Action::Close),
            _ if left => self.choose(at),
            _ => None,
        };
        if outcome.is_some() {
            self.files.disturb();
            self.check_lesson();
        }
        outcome
    }

    fn acted(&mut self, action: Action) -> Option<Effect> {
        Some(self.act(action))
    }

    fn mouse_main(
        &mut self,
        kind: MouseEventKind,
        event: &MouseEvent,
        at: (u16, u16),
    ) -> Option<Effect> {
        match kind {
            MouseEventKind::Down(MouseButton::Left) => self.click(at),
            MouseEventKind::Down(MouseButton::Right) => self.acted(Action::Close),
            MouseEventKind::ScrollUp | MouseEventKind::ScrollDown => {
                let coarse = KeyModifiers::SHIFT | KeyModifiers::CONTROL;
                let up = kind == MouseEventKind::ScrollUp;
                self.wheel(at, up, event.modifiers.intersects(coarse))
            }
            _ => None,
        }
    }

    fn click(&mut self, at: (u16, u16)) -> Option<Effect> {
        let Some((area, target)) = self.target(at) else { return None };
        if matches!(&self.dialogue.mode, InputMode::Typing(_)) {
            self.act(Action::Close);
        }
        self.status = None;
        match target {
            Target::Group(knob) | Target::Knob(knob) => self.knobs.select(knob),
            Target::Bar(knob) => {
                self.knobs.select(knob);
                self.set_part(knob, part(area, at.0));
            }
            Target::View(view) => self.show(view),
            Target::Chart(parts) => {
                let cursor = Cursor::at(at, area, parts);
                if self.reading.on && self.reading.cursor == Some(cursor) {
                    self.open_cursor();
                } else {
                    self.reading.on = true;
                    self.put_cursor(cursor);
                }
            }
            Target::Key(_) | Target::Lesson(_) => {}
        }
        Some(Effect::None)
    }

    fn wheel(&mut self, at: (u16, u16), up: bool, coarse: bool) -> Option<Effect> {
        let target = self.target(at).map(|(_, target)| target);
        // Turning a knob can add or remove the row of its bar, which shifts the rows below under a
        // resting pointer: keep turning the same knob.
        let same = |(place, knob): &((u16, u16), usize)| {
            let is_chart = matches!(target, Some(Target::Chart(_) | Target::View(_)));
            let path = KNOBS.get(*knob).map(|knob| knob.path);
            *place == at && path == self.selected().map(|knob| knob.path) && !is_chart
        };
        let kept = self.mouse.wheeled.filter(same).map(|(_, knob)| Target::Knob(knob));
        match kept.or(target) {
            Some(Target::Knob(knob) | Target::Bar(knob)) => {
                self.mouse.wheeled = Some((at, knob));
                self.knobs.select(knob);
                self.acted(Action::Turn { up, coarse })
            }
            Some(Target::Chart(_)) if self.is_large(ViewId::Response) => {
                self.acted(if up { Action::ZoomIn } else { Action::ZoomOut })
            }
            _ => None,
        }
    }

    /// Chooses an entry of the list that is open.
    fn choose(&mut self, at: (u16, u16)) -> Option<Effect> {
        let Some((_, Target::Lesson(place))) = self.target(at) else {
            return None;
        };
        self.dialogue.open(InputMode::Lessons(place));
        self.acted(Action::Accept)
    }

    /// Sets a knob to a fraction of its bar.
    fn set_part(&mut self, place: usize, part: f64) {
        let Some(knob) = KNOBS.get(place) else { return };
        let range = knob.range(&self.scene, &self.files.opened, &self.machine);
        if let Some(value) = range.and_then(|range| knob.near(range.at(part))) {
            self.set(knob, value);
        }
    }
}

/// Returns the fraction of a bar at a column, 0 to 1.
fn part(bar: Rect, x: u16) -> f64 {
    let along = f64::from(x.saturating_sub(bar.x)) / f64::from(bar.width.max(2) - 1);
    along.clamp(0.0, 1.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::app::tests::on_screen;

    fn event(kind: MouseEventKind, (column, row): (u16, u16)) -> MouseEvent {
        MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE }
    }

    const LEFT: MouseEventKind = MouseEventKind::Down(MouseButton::Left);

    #[test]
    fn a_place_of_the_chart_is_the_middle_of_its_cell() {
        let app = on_screen();
        app.note(Rect::new(10, 5, 20, 10), Target::Chart([(0.0, 1.0), (0.5, 1.0)]));
        let at = |place| match app.target(place)? {
            (area, Target::Chart(parts)) => {
                let cursor = Cursor::at(place, area, parts);
                Some((cursor.across, cursor.up))
            }
            _ => None,
        };
        assert_eq!(at((10, 14)), Some((0.025, 0.525)));
        assert_eq!(at((29, 5)), Some((0.975, 0.975)));
        assert_eq!((at((9, 14)), at((30, 14)), at((10, 15))), (None, None, None));
        app.forget_drawn();
        assert_eq!(at((10, 14)), None);
    }

    #[test]
    fn a_key_of_the_last_line_acts_in_every_dialogue_and_nowhere_else() {
        let mut app = on_screen();
        app.note(Rect::new(0, 39, 4, 1), Target::Key(Action::Help));
        app.note(Rect::new(6, 39, 4, 1), Target::Key(Action::Quit));
        assert_eq!(app.mouse(&event(LEFT, (3, 39))), Some(Effect::None));
        assert!(matches!(app.dialogue.mode, InputMode::Help(_)));
        assert_eq!(app.mouse(&event(LEFT, (5, 39))), None);
        assert_eq!(app.mouse(&event(LEFT, (9, 39))), Some(Effect::Quit));
        assert_eq!(app.mouse(&event(MouseEventKind::Moved, (9, 39))), None);
        // A name that is typed is finished by a key.
        app.dialogue.mode = InputMode::Naming(super::super::Purpose::Save, "a".into());
        assert_eq!(app.mouse(&event(LEFT, (9, 39))), None);
    }

    #[test]
    fn a_mouse_that_is_off_does_nothing() {
        let mut app = on_screen();
        app.note(Rect::new(0, 39, 4, 1), Target::Key(Action::Help));
        assert!(app.mouse.toggle().contains("off") && !app.mouse.on);
        assert_eq!(app.mouse(&event(LEFT, (0, 39))), None);
        assert!(app.mouse.toggle().contains("on") && app.dialogue.is_closed());
    }
}
