//! The mouse: what is drawn where, and the command of a click or of the wheel there. A key does the
//! same.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use ratatui::layout::Rect;

use super::model::{App, InputMode, Parts, Spot};
use crate::tui::command::table::valid;
use crate::tui::command::{Command, Effect};
use crate::tui::knobs::KNOBS;
use crate::tui::views::id::ViewId;

impl Spot {
    /// Returns the command of a click at a cell, with its position.
    fn command_at(&self, (x, y): (u16, u16)) -> Command {
        let middle = |(low, high): (f64, f64), cells: u16, width: u16| {
            low + (high - low) * (f64::from(cells) + 0.5) / f64::from(width)
        };
        let across = middle(self.parts[0], x - self.area.x, self.area.width);
        let up = middle(self.parts[1], self.area.bottom() - 1 - y, self.area.height);
        match &self.command {
            Command::PutCursor(_) => Command::PutCursor([across, up]),
            Command::SetPart(knob, _) => Command::SetPart(*knob, across.clamp(0.0, 1.0)),
            other => other.clone(),
        }
    }
}

impl App {
    /// Clears what can be clicked, before the next frame is drawn.
    pub fn forget_drawn(&self) {
        self.mouse.drawn.take();
    }

    /// Records that a click in `area` executes `command`.
    pub fn note(&self, area: Rect, command: Command) {
        self.note_part(area, command, [(0.0, 1.0); 2]);
    }

    /// As [`Self::note`], for a command that needs a position; `parts` are the fractions that the
    /// area covers.
    pub fn note_part(&self, area: Rect, command: Command, parts: Parts) {
        if let Ok(mut drawn) = self.mouse.drawn.try_borrow_mut() {
            drawn.push(Spot { area, command, parts });
        }
    }

    /// Returns the command of a click at a cell; `None` if nothing there can be clicked.
    pub fn clicked(&self, at: (u16, u16)) -> Option<Command> {
        let drawn = self.mouse.drawn.try_borrow().ok()?;
        let top = drawn.iter().rev().find(|spot| spot.area.contains(at.into()));
        top.map(|spot| spot.command_at(at))
    }

    /// Handles a mouse event; `None` if it does nothing.
    pub fn mouse(&mut self, event: &MouseEvent) -> Option<Effect> {
        // A typed name is finished or left by a key.
        let named = matches!(self.dialogue.mode, InputMode::Naming(..) | InputMode::Replacing(..));
        if !self.mouse.on || named {
            return None;
        }
        let at = (event.column, event.row);
        let coarse = event.modifiers.intersects(KeyModifiers::SHIFT | KeyModifiers::CONTROL);
        let command = match event.kind {
            MouseEventKind::Down(MouseButton::Left) => self.clicked(at),
            MouseEventKind::Down(MouseButton::Right) => Some(Command::Close),
            MouseEventKind::ScrollUp => self.wheel(at, true, coarse),
            MouseEventKind::ScrollDown => self.wheel(at, false, coarse),
            _ => None,
        }?;
        self.files.disturb();
        // A command beside the open dialogue closes it.
        if !valid(self.keyboard()).any(|binding| binding.command == command) {
            self.dialogue.close();
        }
        let effect = self.act(command);
        self.check_lesson();
        Some(effect)
    }

    /// Returns the command of the wheel at a cell: it moves in lists, turns knobs, and zooms the
    /// response.
    fn wheel(&mut self, at: (u16, u16), up: bool, coarse: bool) -> Option<Command> {
        if !matches!(self.dialogue.mode, InputMode::Main | InputMode::Typing(_)) {
            return Some(if up { Command::Above } else { Command::Below });
        }
        let target = self.clicked(at);
        // Turning a knob can add or remove the row of its bar, which shifts the rows below under a
        // resting pointer: keep turning the same knob.
        let is_chart = matches!(target, Some(Command::PutCursor(_) | Command::View(_)));
        let same = |(place, knob): &((u16, u16), usize)| {
            *place == at && *knob == self.knobs.selected && !is_chart
        };
        let kept = self.mouse.wheeled.filter(same).map(|(_, knob)| Command::Select(knob));
        match kept.or(target) {
            Some(Command::Select(knob) | Command::SetPart(knob, _)) if knob < KNOBS.len() => {
                self.mouse.wheeled = Some((at, knob));
                self.knobs.select(knob);
                Some(Command::Turn { up, coarse })
            }
            Some(Command::PutCursor(_)) if self.is_large(ViewId::Response) => {
                Some(if up { Command::ZoomIn } else { Command::ZoomOut })
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::app::tests::on_screen;

    #[test]
    fn a_place_of_the_chart_is_the_middle_of_its_cell() {
        let app = on_screen();
        let chart = Command::PutCursor([0.0; 2]);
        app.note_part(Rect::new(10, 5, 20, 10), chart, [(0.0, 1.0), (0.5, 1.0)]);
        assert_eq!(app.clicked((10, 14)), Some(Command::PutCursor([0.025, 0.525])));
        assert_eq!(app.clicked((29, 5)), Some(Command::PutCursor([0.975, 0.975])));
        for at in [(9, 14), (30, 14), (10, 15)] {
            assert_eq!(app.clicked(at), None);
        }
        app.forget_drawn();
        assert_eq!(app.clicked((10, 14)), None);
    }

    fn event(kind: MouseEventKind, (column, row): (u16, u16)) -> MouseEvent {
        MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE }
    }

    const LEFT: MouseEventKind = MouseEventKind::Down(MouseButton::Left);

    #[test]
    fn a_mouse_that_is_off_does_nothing() {
        let mut app = on_screen();
        app.note(Rect::new(0, 39, 4, 1), Command::Help);
        assert_eq!(app.act(Command::Mouse), Effect::Mouse(false));
        assert_eq!(app.mouse(&event(LEFT, (0, 39))), None);
        assert_eq!(app.act(Command::Mouse), Effect::Mouse(true));
        assert!(app.dialogue.is_closed());
    }
}
