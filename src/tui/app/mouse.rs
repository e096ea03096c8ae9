//! The mouse: the bar being dragged, and what is drawn in which area of the screen.

use std::cell::RefCell;

use ratatui::layout::Rect;

use super::{App, Cursor};
use crate::tui::bindings::Action;
use crate::tui::views::id::ViewId;

/// A drag on the bar of a knob.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grip {
    /// Index of the knob in `KNOBS`.
    pub knob: usize,
    /// Column of the pointer when the drag began.
    pub x: u16,
    /// Whether the drag has changed the knob; later changes of the drag merge into one undo step.
    pub turned: bool,
}

/// Something clickable on the screen.
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
    /// The drag under way.
    pub grip: Option<Grip>,
    /// Cell of the last click, until the pointer leaves it.
    pub clicked: Option<(u16, u16)>,
    /// Cell and knob of the last turn of the wheel.
    pub wheeled: Option<((u16, u16), usize)>,
    /// Clickable areas of the last frame. Where they overlap, the later one is on top.
    drawn: RefCell<Vec<(Rect, Target)>>,
}

impl Default for Mouse {
    fn default() -> Self {
        Self { on: true, grip: None, clicked: None, wheeled: None, drawn: RefCell::default() }
    }
}

impl Mouse {
    /// Switches the mouse on or off; returns the status message.
    pub fn toggle(&mut self) -> String {
        (self.on, self.grip) = (!self.on, None);
        let how = match self.on {
            true => "mouse on: click, drag, wheel; with Shift it selects text",
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
        self.last_drawn(|(area, _)| area.contains(at.into()))
    }

    /// Returns the area of the selected knob's bar.
    pub fn bar_area(&self) -> Option<Rect> {
        self.last_drawn(|(_, target)| matches!(target, Target::Bar(_))).map(|(area, _)| area)
    }

    fn last_drawn(&self, is_wanted: impl Fn(&(Rect, Target)) -> bool) -> Option<(Rect, Target)> {
        let drawn = self.mouse.drawn.try_borrow().ok()?;
        drawn.iter().rev().copied().find(|noted| is_wanted(noted))
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
