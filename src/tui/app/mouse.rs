//! The mouse: whether it acts, and what is drawn where.

use std::cell::RefCell;

use ratatui::layout::Rect;

use super::{App, Cursor};
use crate::tui::bindings::Action;
use crate::tui::views::id::ViewId;

/// Something that is drawn and can be clicked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// A key shown in the footer.
    Key(Action),
    /// The heading of a group of knobs, with the index of its first knob.
    Group(usize),
    /// The line of the knob with this index.
    Knob(usize),
    /// The bar of the knob with this index.
    Bar(usize),
    /// A chart beside the large one.
    View(ViewId),
    /// The data area of the large chart, as fractions of the whole: `[across, up]`, each from and
    /// to.
    Chart([(f64, f64); 2]),
    /// The lesson with this index in the list.
    Lesson(usize),
}

#[derive(Clone, Debug)]
pub struct Mouse {
    /// Whether mouse events are used.
    pub on: bool,
    /// Cell at which the wheel turned a knob last, and that knob.
    pub wheeled: Option<((u16, u16), usize)>,
    /// Clickable areas of the last frame. Where they overlap, the later one is on top.
    drawn: RefCell<Vec<(Rect, Target)>>,
}

impl Default for Mouse {
    fn default() -> Self {
        Self { on: true, wheeled: None, drawn: RefCell::default() }
    }
}

impl Mouse {
    /// Switches the mouse on or off; returns the status message.
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
    /// Clears the clickable areas before the next frame is drawn.
    pub fn forget_drawn(&self) {
        self.mouse.drawn.take();
    }

    /// Records that `target` is drawn in `area`.
    pub fn note(&self, area: Rect, target: Target) {
        if let Ok(mut drawn) = self.mouse.drawn.try_borrow_mut() {
            drawn.push((area, target));
        }
    }

    /// Returns the topmost target at a cell, with its area.
    pub fn target(&self, at: (u16, u16)) -> Option<(Rect, Target)> {
        let drawn = self.mouse.drawn.try_borrow().ok()?;
        drawn.iter().rev().copied().find(|(area, _)| area.contains(at.into()))
    }
}

impl Cursor {
    /// Converts a cell of `area` to chart fractions; `parts` are the fractions that `area` covers.
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
