//! Mouse events: what a click, a drag or the wheel does at a position of the screen. Keys can do
//! the same.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};

use ratatui::layout::Rect;

use super::Effect;
use crate::tui::app::{App, Cursor, Grip, InputMode, Target};
use crate::tui::bindings::Action;
use crate::tui::knobs::KNOBS;
use crate::tui::views::id::ViewId;

/// What a mouse event did.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum MouseOutcome {
    /// Nothing visible.
    Nothing,
    /// The cursor followed the pointer; the next regular frame can show it.
    Pointed,
    /// An action like that of a key, with its effect.
    Acted(Effect),
}

impl App {
    /// Handles a mouse event.
    pub fn mouse(&mut self, event: &MouseEvent) -> MouseOutcome {
        let at = (event.column, event.row);
        if !self.mouse.on {
            return MouseOutcome::Nothing;
        }
        let left = event.kind == MouseEventKind::Down(MouseButton::Left);
        let key = match self.target(at) {
            Some((_, Target::Key(action))) if left => Some(action),
            _ => None,
        };
        let outcome = match (&self.dialogue.mode, event.kind, key) {
            // These prompts are confirmed or closed by a key only.
            (InputMode::Naming(..) | InputMode::Replacing(..), ..) => MouseOutcome::Nothing,
            (.., Some(action)) => self.acted(action),
            (InputMode::Main | InputMode::Typing(_), kind, _) => self.mouse_main(kind, event, at),
            (_, MouseEventKind::ScrollUp, _) => self.acted(Action::KnobAbove),
            (_, MouseEventKind::ScrollDown, _) => self.acted(Action::KnobBelow),
            (_, MouseEventKind::Down(MouseButton::Right), _) => self.acted(Action::Close),
            _ if left => self.choose(at),
            _ => MouseOutcome::Nothing,
        };
        if matches!(outcome, MouseOutcome::Acted(_)) {
            self.files.disturb();
            self.check_lesson();
        }
        outcome
    }

    fn acted(&mut self, action: Action) -> MouseOutcome {
        MouseOutcome::Acted(self.act(action))
    }

    fn mouse_main(
        &mut self,
        kind: MouseEventKind,
        event: &MouseEvent,
        at: (u16, u16),
    ) -> MouseOutcome {
        match kind {
            MouseEventKind::Down(MouseButton::Left) => self.click(at),
            MouseEventKind::Down(MouseButton::Right) => self.acted(Action::Close),
            MouseEventKind::Drag(MouseButton::Left) => self.drag(at),
            MouseEventKind::Up(_) => {
                self.mouse.grip = None;
                MouseOutcome::Nothing
            }
            MouseEventKind::Moved => self.hover(at),
            MouseEventKind::ScrollUp | MouseEventKind::ScrollDown => {
                let coarse = KeyModifiers::SHIFT | KeyModifiers::CONTROL;
                let up = kind == MouseEventKind::ScrollUp;
                self.wheel(at, up, event.modifiers.intersects(coarse))
            }
            _ => MouseOutcome::Nothing,
        }
    }

    fn click(&mut self, at: (u16, u16)) -> MouseOutcome {
        let Some((area, target)) = self.target(at) else { return MouseOutcome::Nothing };
        if matches!(&self.dialogue.mode, InputMode::Typing(_)) {
            self.act(Action::Close);
        }
        self.status = None;
        let again = self.mouse.clicked.replace(at) == Some(at);
        match target {
            Target::Group(knob) => self.knobs.select(knob),
            Target::Knob(knob) => {
                self.knobs.select(knob);
                self.mouse.grip = Some(Grip { knob, x: at.0, turned: false });
            }
            Target::Bar(knob) => {
                self.knobs.select(knob);
                self.mouse.grip = Some(Grip { knob, x: at.0, turned: true });
                self.set_part(knob, part(area, at.0));
            }
            Target::View(view) => self.show(view),
            Target::Chart(_) if again && self.reading.cursor.is_some() => self.open_cursor(),
            Target::Chart(parts) => {
                self.reading.on = true;
                self.put_cursor(Cursor::at(at, area, parts));
            }
            Target::Key(_) | Target::Lesson(_) => {}
        }
        MouseOutcome::Acted(Effect::None)
    }

    fn drag(&mut self, at: (u16, u16)) -> MouseOutcome {
        let Some(grip) = self.mouse.grip else { return self.hover(at) };
        if at.0 == grip.x && !grip.turned {
            return MouseOutcome::Nothing;
        }
        let Some(area) = self.bar_area() else { return MouseOutcome::Nothing };
        let known = self.knobs.remembered();
        self.set_part(grip.knob, part(area, at.0));
        if grip.turned {
            self.knobs.merge(known);
        }
        self.mouse.grip = Some(Grip { turned: true, ..grip });
        MouseOutcome::Acted(Effect::None)
    }

    fn hover(&mut self, at: (u16, u16)) -> MouseOutcome {
        if self.mouse.clicked.is_some_and(|clicked| clicked != at) {
            self.mouse.clicked = None;
        }
        let target = self.target(at).filter(|_| self.reading.on);
        let Some((area, Target::Chart(parts))) = target else { return MouseOutcome::Nothing };
        let cursor = Cursor::at(at, area, parts);
        let moved = self.reading.cursor != Some(cursor);
        self.put_cursor(cursor);
        if moved { MouseOutcome::Pointed } else { MouseOutcome::Nothing }
    }

    fn wheel(&mut self, at: (u16, u16), up: bool, coarse: bool) -> MouseOutcome {
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
            _ => MouseOutcome::Nothing,
        }
    }

    /// Opens the entry of the list that was clicked.
    fn choose(&mut self, at: (u16, u16)) -> MouseOutcome {
        let Some((_, Target::Lesson(place))) = self.target(at) else {
            return MouseOutcome::Nothing;
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
        assert_eq!(app.mouse(&event(LEFT, (3, 39))), MouseOutcome::Acted(Effect::None));
        assert!(matches!(app.dialogue.mode, InputMode::Help(_)));
        assert_eq!(app.mouse(&event(LEFT, (5, 39))), MouseOutcome::Nothing);
        assert_eq!(app.mouse(&event(LEFT, (9, 39))), MouseOutcome::Acted(Effect::Quit));
        assert_eq!(app.mouse(&event(MouseEventKind::Moved, (9, 39))), MouseOutcome::Nothing);
        // A name being typed is confirmed by a key only.
        app.dialogue.mode = InputMode::Naming(super::super::Purpose::Save, "a".into());
        assert_eq!(app.mouse(&event(LEFT, (9, 39))), MouseOutcome::Nothing);
    }

    #[test]
    fn a_mouse_that_is_off_does_nothing() {
        let mut app = on_screen();
        app.note(Rect::new(0, 39, 4, 1), Target::Key(Action::Help));
        assert!(app.mouse.toggle().contains("off") && !app.mouse.on);
        assert_eq!(app.mouse(&event(LEFT, (0, 39))), MouseOutcome::Nothing);
        assert!(app.mouse.toggle().contains("on") && app.dialogue.is_closed());
    }
}
