//! The mouse: what a click, a wheel or a drag at a place of the screen does.
//! Nothing needs it; a key does the same.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::Rect;

use super::{App, Cursor, InputMode};
use crate::tui::bindings::Action;
use crate::tui::knobs::KNOBS;
use crate::tui::panels::{self, Target};

/// What a mouse event has changed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Heard {
    /// Nothing on the screen.
    Nothing,
    /// The reading cursor follows the pointer: the next frame is soon enough.
    Pointed,
    /// As much as a key.
    Acted,
}

/// A knob whose bar is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grip {
    knob: usize,
    /// The column where it was taken.
    x: u16,
    /// Whether it has been turned since: one drag is undone in one step.
    turned: bool,
}

/// Where data of the large chart is drawn, and which part of it: from where to where
/// across, and up.
#[derive(Clone, Copy, Debug)]
pub(super) struct NotedChart {
    area: Rect,
    parts: [(f64, f64); 2],
}

impl App {
    /// Handles a mouse event.
    pub fn mouse(&mut self, event: &MouseEvent) -> Heard {
        let at = (event.column, event.row);
        if !self.mouse {
            return Heard::Nothing;
        }
        let heard = match (&self.mode, event.kind) {
            // A typed name is finished or left by a key.
            (InputMode::Naming(..) | InputMode::Replacing(..), _) => Heard::Nothing,
            (InputMode::Main | InputMode::Typing(_), kind) => self.mouse_main(kind, event, at),
            (_, MouseEventKind::ScrollUp) => self.acted(Action::KnobAbove),
            (_, MouseEventKind::ScrollDown) => self.acted(Action::KnobBelow),
            (_, MouseEventKind::Down(MouseButton::Right)) => self.acted(Action::Close),
            (_, MouseEventKind::Down(MouseButton::Left)) => self.choose(at),
            _ => Heard::Nothing,
        };
        if heard == Heard::Acted {
            self.disturb();
            self.check_lesson();
        }
        heard
    }

    /// The mouse asks for it, or no longer.
    pub(super) fn toggle_mouse(&mut self) {
        self.mouse = !self.mouse;
        self.grip = None;
        let how = match self.mouse {
            true => "mouse on: click, drag, wheel; with Shift it selects text",
            false => "mouse off: it selects text",
        };
        self.status = Some(how.into());
    }

    fn acted(&mut self, action: Action) -> Heard {
        self.act(action);
        Heard::Acted
    }

    fn mouse_main(&mut self, kind: MouseEventKind, event: &MouseEvent, at: (u16, u16)) -> Heard {
        match kind {
            MouseEventKind::Down(MouseButton::Left) => self.click(at),
            MouseEventKind::Down(MouseButton::Right) => self.acted(Action::Close),
            MouseEventKind::Drag(MouseButton::Left) => self.drag(at),
            MouseEventKind::Up(_) => {
                self.grip = None;
                Heard::Nothing
            }
            MouseEventKind::Moved => self.hover(at),
            MouseEventKind::ScrollUp | MouseEventKind::ScrollDown => {
                let coarse = KeyModifiers::SHIFT | KeyModifiers::CONTROL;
                let up = kind == MouseEventKind::ScrollUp;
                self.wheel(at, up, event.modifiers.intersects(coarse))
            }
            _ => Heard::Nothing,
        }
    }

    fn click(&mut self, at: (u16, u16)) -> Heard {
        let Some(target) = panels::target(self, at) else { return Heard::Nothing };
        if matches!(self.mode, InputMode::Typing(_)) {
            self.act(Action::Close);
        }
        self.status = None;
        let again = self.clicked.replace(at) == Some(at);
        match target {
            Target::Group(knob) => self.select_place(knob),
            Target::Knob(knob) => {
                self.select_place(knob);
                self.grip = Some(Grip { knob, x: at.0, turned: false });
            }
            Target::Bar(knob, part) => {
                self.select_place(knob);
                self.grip = Some(Grip { knob, x: at.0, turned: true });
                self.set_part(knob, part);
            }
            Target::View(view) => self.show(view),
            Target::Chart(_) if again && self.cursor.is_some() => self.open_cursor(),
            Target::Chart(cursor) => {
                self.reading = true;
                self.put_cursor(cursor);
            }
        }
        Heard::Acted
    }

    fn drag(&mut self, at: (u16, u16)) -> Heard {
        let Some(grip) = self.grip else { return self.hover(at) };
        if at.0 == grip.x && !grip.turned {
            return Heard::Nothing;
        }
        let Some(part) = panels::part_of_bar(self, grip.knob, at.0) else { return Heard::Nothing };
        let known = self.undo.len();
        self.set_part(grip.knob, part);
        if grip.turned {
            self.undo.truncate(known);
        }
        self.grip = Some(Grip { turned: true, ..grip });
        Heard::Acted
    }

    fn hover(&mut self, at: (u16, u16)) -> Heard {
        if self.clicked.is_some_and(|clicked| clicked != at) {
            self.clicked = None;
        }
        let Some(Target::Chart(cursor)) = panels::target(self, at).filter(|_| self.reading) else {
            return Heard::Nothing;
        };
        let moved = self.cursor != Some(cursor);
        self.put_cursor(cursor);
        if moved { Heard::Pointed } else { Heard::Nothing }
    }

    fn wheel(&mut self, at: (u16, u16), up: bool, coarse: bool) -> Heard {
        match panels::target(self, at) {
            Some(Target::Knob(knob) | Target::Bar(knob, _)) => {
                self.select_place(knob);
                self.acted(Action::Turn { up, coarse })
            }
            Some(Target::Chart(_)) if self.view.panel().is_over_time(self) => {
                self.acted(if up { Action::ZoomIn } else { Action::ZoomOut })
            }
            _ => Heard::Nothing,
        }
    }

    /// Chooses an entry of the list that is open.
    fn choose(&mut self, at: (u16, u16)) -> Heard {
        match (&self.mode, panels::lesson_at(self, at)) {
            (InputMode::Lessons(_), Some(place)) => {
                self.mode = InputMode::Lessons(place);
                self.acted(Action::Accept)
            }
            _ => Heard::Nothing,
        }
    }

    /// Turns a knob to a place of its bar.
    fn set_part(&mut self, place: usize, part: f64) {
        let Some(knob) = KNOBS.get(place) else { return };
        let range = knob.range(&self.scene, &self.opened, &self.machine);
        if let Some(value) = range.and_then(|range| knob.near(range.at(part))) {
            self.set(knob, value);
        }
    }

    /// Forgets where the large chart was drawn, before the next picture.
    pub fn forget_charts(&self) {
        if let Ok(mut places) = self.chart_places.try_borrow_mut() {
            places.clear();
        }
    }

    /// Notes where the data of the large chart is drawn, for the mouse, and which
    /// part of it: from where to where across, and up.
    pub fn note_chart(&self, inner: Rect, parts: [(f64, f64); 2]) {
        if let Ok(mut places) = self.chart_places.try_borrow_mut() {
            places.push(NotedChart { area: inner, parts });
        }
    }

    /// The place in the large chart that is drawn in a cell of the screen.
    pub fn cursor_at(&self, (x, y): (u16, u16)) -> Option<Cursor> {
        let places = self.chart_places.try_borrow().ok()?;
        let noted = places.iter().find(|noted| noted.area.contains((x, y).into()))?;
        let (inner, parts) = (noted.area, noted.parts);
        let middle = |(low, high): (f64, f64), cells: u16, width: u16| {
            low + (high - low) * (f64::from(cells) + 0.5) / f64::from(width)
        };
        Some(Cursor {
            across: middle(parts[0], x - inner.x, inner.width),
            up: middle(parts[1], inner.bottom() - 1 - y, inner.height),
        })
    }
}
