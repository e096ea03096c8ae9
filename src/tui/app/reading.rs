//! The cursor: a time in the run, which every panel then shows instead of the playing motion, and a
//! position in the large chart. Each view decides what it reads at that position.

use super::model::{App, Cursor, Reading};
use crate::tui::axis::{instant, readable};
use crate::tui::command::Effect;
use crate::tui::engine::Move;
use crate::tui::views::id::ViewId;

/// Step of the cursor in charts without cells, as a fraction of the width or height.
pub const STEP: f64 = 0.01;

/// Large step of the cursor in charts without cells, as a fraction of the width or height.
const LARGE_STEP: f64 = 0.1;
/// Large step of the cursor in charts with cells \[cells\].
const LARGE_CELLS: i64 = 5;

impl App {
    /// Returns the cursor; `None` if there is none, or `view` is not the large chart.
    pub fn cursor_in(&self, view: ViewId) -> Option<Cursor> {
        self.reading.cursor.filter(|_| self.is_large(view))
    }

    /// Removes the cursor, so that the page follows the motion again.
    pub fn stop_reading(&mut self) {
        (self.reading, self.play.middle_s) = (Reading::default(), None);
    }

    /// Goes to a simulated time \[s\].
    ///
    /// # Errors
    /// One line if the run does not include the time.
    pub fn go_to_asked(&mut self, t: f64) -> Result<(), String> {
        let end = self.end_s();
        if !(0.0..=end).contains(&t) {
            let [t, end] = [t, end].map(|t| readable(t, "s"));
            return Err(format!("t = {t}: from 0 to {end}, the end of the run"));
        }
        self.close_list();
        self.go_to(t);
        self.status = Some(format!("paused at {}", instant(t)));
        Ok(())
    }

    /// Moves the cursor to the time `t` \[s\] and pauses. Every panel then shows that time. The
    /// page stays if it includes `t`; otherwise it is centred on `t`.
    pub fn go_to(&mut self, t: f64) {
        let ((from, to), middle) = (self.page(), self.middle_s());
        self.play.middle_s = Some(if (from..=to).contains(&t) { middle } else { t });
        self.reading.at_s = Some(t);
        self.play.pause();
        self.reading.cursor = self.reading.cursor.map(|_| self.panel().here(self));
    }

    /// Moves the cursor to a position in the large chart. In the response, the motion pauses and
    /// every panel shows the time of that position; in the gaps and the wheel, it pauses at the
    /// time shown.
    pub fn put_cursor(&mut self, cursor: Cursor) {
        let (from, to) = self.page();
        match self.view() {
            ViewId::Response => self.go_to(from + cursor.across * (to - from)),
            ViewId::Gaps | ViewId::Frame => self.go_to(self.now()),
            _ => {}
        }
        self.reading.cursor = Some(cursor);
    }

    /// Puts the cursor on a blade in the gaps view; blades are numbered from 1.
    ///
    /// # Errors
    /// One line if there is no such blade.
    pub fn go_to_blade(&mut self, blade: u32) -> Result<(), String> {
        let all = self.machine.polygon.blades;
        if !(1..=all).contains(&blade) {
            return Err(format!("blade {blade}: from 1 to {all}"));
        }
        self.show(ViewId::Gaps);
        self.reading.on = true;
        let (part, here) = ((f64::from(blade) - 0.5) / f64::from(all), self.panel().here(self));
        self.put_cursor(Cursor { across: part, ..here });
        let gap = self.shown_now().and_then(|now| now.gaps.get(blade as usize - 1).copied());
        let at = instant(self.now());
        self.status = gap.map(|gap| format!("blade {blade}: gap {} at {at}", self.gap_words(gap)));
        Ok(())
    }

    /// Keeps the cursor's time when the large chart changes; removes a cursor without a time.
    pub fn keep_instant(&mut self) {
        match self.reading.at_s {
            Some(_) => self.reading.cursor = self.reading.cursor.map(|_| self.panel().here(self)),
            None => self.stop_reading(),
        }
    }

    /// Gives the arrow keys to the cursor, or back to the knobs.
    pub fn toggle_reading(&mut self) {
        if self.reading.on {
            self.reading.on = false;
            return self.keep_instant();
        }
        self.reading.on = true;
        if self.reading.cursor.is_none() {
            self.put_cursor(self.panel().here(self));
        }
    }

    /// Moves the cursor by steps; a new cursor starts where the view puts it.
    pub fn move_cursor(&mut self, right: i64, up: i64, coarse: bool) {
        let panel = self.panel();
        let mut cursor = self.reading.cursor.unwrap_or_else(|| panel.here(self));
        if self.is_large(ViewId::Response) {
            // The page may have changed since the last move.
            cursor.across = self.part_of_page();
        }
        let [across, high] = panel.grid(self);
        let moved = |part: f64, by: i64, cells: u32| match cells {
            0 => (part + by as f64 * if coarse { LARGE_STEP } else { STEP }).clamp(0.0, 1.0),
            cells => {
                let by = if coarse { by * LARGE_CELLS } else { by };
                let last = i64::from(cells) - 1;
                let cell = (cell_of(part, cells) as i64 + by).clamp(0, last);
                (cell as f64 + 0.5) / f64::from(cells)
            }
        };
        let (across, up) = (moved(cursor.across, right, across), moved(cursor.up, up, high));
        match right {
            // A vertical move keeps the time, even if that is on another page.
            0 if self.reading.at_s.is_some() => self.reading.cursor = Some(Cursor { across, up }),
            _ => self.put_cursor(Cursor { across, up }),
        }
    }

    /// Puts the cursor at a position of the large chart, or, if it is there already, opens what the
    /// chart offers there.
    ///
    /// # Errors
    /// As [`Self::open_cursor`].
    pub fn click_cursor(&mut self, cursor: Cursor) -> Result<Effect, String> {
        if self.reading.on && self.reading.cursor == Some(cursor) {
            return self.open_cursor();
        }
        self.reading.on = true;
        self.put_cursor(cursor);
        Ok(Effect::None)
    }

    /// Opens what the large chart offers at the cursor.
    ///
    /// # Errors
    /// One line that says why there is nothing to open.
    pub fn open_cursor(&mut self) -> Result<Effect, String> {
        let command = self.opening().ok_or("Enter opens nothing in this chart")?;
        self.update(command)
    }

    /// Removes the cursor and moves the motion to its time.
    pub fn depart(&mut self) {
        let Some(t) = self.reading.at_s else { return };
        self.stop_reading();
        if t != self.played_s() {
            self.play.moves.push(Move::To(t));
        }
    }
}

/// Returns the index of the cell at the fraction `part`, 0 to 1, of a row of `cells` cells.
pub fn cell_of(part: f64, cells: u32) -> u32 {
    ((part * f64::from(cells)) as u32).min(cells.saturating_sub(1))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::app::tests::on_screen;
    use crate::tui::command::Command;

    #[test]
    fn a_blade_is_read_by_its_number() {
        let mut app = on_screen();
        app.go_to_blade(7).unwrap();
        let cursor = app.cursor_in(ViewId::Gaps).unwrap();
        assert_eq!((cell_of(cursor.across, 22), app.reading.on), (6, true));
        for blade in [0, 23] {
            let refused = format!("blade {blade}: from 1 to 22");
            assert_eq!(app.update(Command::Blade(blade)), Err(refused));
        }
    }

    #[test]
    fn the_cursor_goes_from_cell_to_cell_and_stops_at_the_ends() {
        let mut app = on_screen();
        app.walk(ViewId::Gaps);
        app.toggle_reading();
        let cell = |app: &App| cell_of(app.cursor_in(ViewId::Gaps).unwrap().across, 22);
        for (right, coarse, at) in [(1, false, 1), (1, true, 6), (-1, false, 5), (-1, true, 0)] {
            app.move_cursor(right, 0, coarse);
            assert_eq!(cell(&app), at);
        }
        (0..9).for_each(|_| app.move_cursor(1, 0, true));
        assert_eq!((cell(&app), cell_of(1.0, 22), cell_of(0.5, 0)), (21, 21, 0));
    }

    #[test]
    fn an_instant_that_is_read_stays_from_view_to_view() {
        let mut app = on_screen();
        app.walk(ViewId::Response);
        app.reading.on = true;
        app.put_cursor(Cursor { across: 0.25, up: 0.5 });
        let read = Some(5e-3);
        for view in ViewId::all().chain([ViewId::Gaps, ViewId::Response]) {
            app.walk(view);
            assert_eq!(app.reading.at_s, read, "{}", view.word());
            assert_eq!(app.order().cursor_s, read);
        }
        assert_eq!(app.cursor_in(ViewId::Response), Some(Cursor { across: 0.25, up: 0.5 }));
        // The time is kept even off the page, until the cursor moves across.
        app.play.tempo.zoom = 6;
        app.play.middle_s = None;
        assert!(app.page().1 < 5e-3);
        app.move_cursor(0, 1, false);
        assert_eq!(app.reading.at_s, read);
        app.move_cursor(-1, 0, false);
        assert!(app.reading.at_s.is_some_and(|t| t < app.page().1));
        app.stop_reading();
        assert_eq!((app.reading.at_s, app.reading.on), (None, false));
    }
}
