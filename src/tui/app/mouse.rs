//! The mouse: whether it acts, what it holds, and what is drawn where.

use std::cell::RefCell;

use ratatui::layout::Rect;

use super::{App, Cursor};
use crate::tui::bindings::Action;

/// A knob whose bar is held.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grip {
    /// Its place in the table.
    pub knob: usize,
    /// The column where it was taken.
    pub x: u16,
    /// Whether it has been turned since: one drag is undone in one step.
    pub turned: bool,
}

/// Area in which data of the large chart is drawn, and the part of it: from where to where
/// across, and up.
#[derive(Clone, Copy, Debug)]
struct NotedChart {
    area: Rect,
    parts: [(f64, f64); 2],
}

/// The mouse.
#[derive(Clone, Debug)]
pub struct Mouse {
    /// Whether the mouse is used.
    pub on: bool,
    /// The knob whose bar it holds.
    pub grip: Option<Grip>,
    /// Cell of the last click, if the pointer is still there.
    pub clicked: Option<(u16, u16)>,
    /// Cell at which the wheel turned a knob last, and that knob.
    pub wheeled: Option<((u16, u16), usize)>,
    /// Areas of the data of the large chart in the last frame.
    charts: RefCell<Vec<NotedChart>>,
    /// Areas of the keys of the last line in the last frame.
    keys: RefCell<Vec<(Rect, Action)>>,
}

impl Default for Mouse {
    fn default() -> Self {
        Self {
            on: true,
            grip: None,
            clicked: None,
            wheeled: None,
            charts: RefCell::default(),
            keys: RefCell::default(),
        }
    }
}

impl Mouse {
    /// Switches the mouse on or off; returns the message.
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
    /// Forgets where the large chart and the keys were drawn, before the next picture.
    pub fn forget_places(&self) {
        if let Ok(mut places) = self.mouse.charts.try_borrow_mut() {
            places.clear();
        }
        if let Ok(mut places) = self.mouse.keys.try_borrow_mut() {
            places.clear();
        }
    }

    /// Notes where a key of the last line is drawn, and what it does.
    pub fn note_key(&self, area: Rect, action: Action) {
        if let Ok(mut places) = self.mouse.keys.try_borrow_mut() {
            places.push((area, action));
        }
    }

    /// Returns what the key does that is drawn in a cell of the screen.
    pub fn key_at(&self, at: (u16, u16)) -> Option<Action> {
        let places = self.mouse.keys.try_borrow().ok()?;
        places.iter().find(|(area, _)| area.contains(at.into())).map(|(_, action)| *action)
    }

    /// Notes where the data of the large chart is drawn, for the mouse, and which
    /// part of it: from where to where across, and up.
    pub fn note_chart(&self, inner: Rect, parts: [(f64, f64); 2]) {
        if let Ok(mut places) = self.mouse.charts.try_borrow_mut() {
            places.push(NotedChart { area: inner, parts });
        }
    }

    /// Returns the place in the large chart that is drawn in a cell of the screen.
    pub fn cursor_at(&self, (x, y): (u16, u16)) -> Option<Cursor> {
        let places = self.mouse.charts.try_borrow().ok()?;
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
