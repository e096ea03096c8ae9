//! The mouse: whether it acts, and what is drawn where.

use std::cell::RefCell;

use ratatui::layout::Rect;

use super::{App, Cursor};
use crate::tui::bindings::Action;
use crate::tui::views::id::ViewId;

/// Something that is drawn and can be clicked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A key of the last line.
    Key(Action),
    /// The heading of a group of knobs, with its first knob.
    Group(usize),
    /// The line of a knob.
    Knob(usize),
    /// The bar of a knob.
    Bar(usize),
    /// A chart that is not the large one.
    View(ViewId),
    /// The data of the large chart, or a part of it: from where to where across, and up.
    Chart([(f64, f64); 2]),
    /// A lesson of the list.
    Lesson(usize),
}

/// The mouse.
#[derive(Clone, Debug)]
pub struct Mouse {
    /// Whether the mouse is used.
    pub on: bool,
    /// Cell at which the wheel turned a knob last, and that knob.
    pub wheeled: Option<((u16, u16), usize)>,
    /// Areas of the last frame; of those that overlap, the last one is on top.
    drawn: RefCell<Vec<(Rect, Target)>>,
}

impl Default for Mouse {
    fn default() -> Self {
        Self { on: true, wheeled: None, drawn: RefCell::default() }
    }
}

impl Mouse {
    /// Switches the mouse on or off; returns the message.
    pub fn toggle(&mut self) -> String {
        self.on = !self.on;
        let how = match self.on {
            true => "mouse on: click, wheel; with Shift it selects text",
            false => "mouse off: it selects text",
        };
        how.into()
    }
}

impl App {
    /// Forgets what was drawn, before the next frame.
    pub fn forget_drawn(&self) {
        self.mouse.drawn.take();
    }

    /// Records what is drawn in an area.
    pub fn note(&self, area: Rect, target: Target) {
        if let Ok(mut drawn) = self.mouse.drawn.try_borrow_mut() {
            drawn.push((area, target));
        }
    }

    /// Returns what is drawn in a cell of the screen, and its area.
    pub fn target(&self, at: (u16, u16)) -> Option<(Rect, Target)> {
        let drawn = self.mouse.drawn.try_borrow().ok()?;
        drawn.iter().rev().copied().find(|(area, _)| area.contains(at.into()))
    }
}

impl Cursor {
    /// Returns the place in the large chart that is drawn in a cell of an area with these parts
    /// of it.
    pub fn at((x, y): (u16, u16), area: Rect, parts: [(f64, f64); 2]) -> Self {
        let middle = |(low, high): (f64, f64), cells: u16, width: u16| {
            low + (high - low) * (f64::from(cells) + 0.5) / f64::from(width)
        };
        Self {
            across: middle(parts[0], x - area.x, area.width),
            up: middle(parts[1], area.bottom() - 1 - y, area.height),
        }
    }
}
