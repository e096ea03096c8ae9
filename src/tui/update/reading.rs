//! Moving the reading cursor, in the chart and in time.

use crate::tui::app::{App, Cursor, STEP, cell_of};
use crate::tui::axis::{instant, readable};
use crate::tui::views::Opening;
use crate::tui::views::id::ViewId;

/// A large step of the cursor where the chart has no cells.
const LARGE_STEP: f64 = 0.1;
/// Cells of a large step in a chart of cells.
const LARGE_CELLS: i64 = 5;

impl App {
    /// Makes a view the large one; an instant that is read goes on being read.
    pub(super) fn show(&mut self, view: ViewId) {
        if self.layout.show(view) {
            self.keep_instant();
        }
    }

    /// Starts reading at the pointer.
    pub(super) fn point(&mut self, cursor: Cursor) {
        self.reading.on = true;
        self.put_cursor(cursor);
    }

    /// Reads this instant.
    pub(super) fn read_instant(&mut self, t: f64) {
        self.reading.at_s = Some(t);
        self.reading.cursor = Some(self.panel().here(self));
    }

    /// Puts the cursor at a place of the large chart; over time, that instant is read.
    pub(super) fn put_cursor(&mut self, cursor: Cursor) {
        if self.panel().is_over_time(self) {
            let (from, to) = self.page();
            self.reading.at_s = Some(from + cursor.across * (to - from));
        }
        self.reading.cursor = Some(cursor);
    }

    /// Moves the cursor up or down only: an instant that is read goes on being read, also
    /// where it is on another page.
    fn put_beside(&mut self, cursor: Cursor) {
        match self.cursor_time() {
            Some(_) => self.reading.cursor = Some(cursor),
            None => self.put_cursor(cursor),
        }
    }

    /// Reads the gap of a blade, numbered from 1.
    ///
    /// # Errors
    /// There is no such blade, in words.
    pub(super) fn go_to_blade(&mut self, blade: u32) -> Result<(), String> {
        let all = self.machine.polygon.blades;
        if !(1..=all).contains(&blade) {
            return Err(format!("blade {blade}: from 1 to {all}"));
        }
        self.show(ViewId::Gaps);
        self.reading.on = true;
        let (part, here) = ((f64::from(blade) - 0.5) / f64::from(all), self.panel().here(self));
        self.put_beside(Cursor { across: part, ..here });
        let gap = self.shown().and_then(|moment| moment.gaps.get(blade as usize - 1).copied());
        self.status = gap.map(|gap| format!("blade {blade}: gap {}", self.gap_words(gap)));
        Ok(())
    }

    /// Keeps the instant that is read after a change of the large chart.
    pub(super) fn keep_instant(&mut self) {
        match self.cursor_time() {
            Some(_) => self.reading.cursor = Some(self.panel().here(self)),
            None => self.reading.stop(),
        }
    }

    /// Gives the arrows to the cursor, or back to the knobs.
    pub(super) fn toggle_reading(&mut self) {
        if self.reading.on {
            return self.reading.stop();
        }
        self.reading.on = true;
        if self.reading.cursor.is_none() {
            self.put_cursor(self.panel().here(self));
        }
    }

    /// Moves the cursor by some steps; it appears where the motion is.
    pub(super) fn move_cursor(&mut self, right: i64, up: i64, coarse: bool) {
        let panel = self.panel();
        let mut cursor = self.reading.cursor.unwrap_or_else(|| panel.here(self));
        if panel.is_over_time(self) {
            // The page may be another one since.
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
            0 => self.put_beside(Cursor { across, up }),
            _ => self.put_cursor(Cursor { across, up }),
        }
    }

    /// Does what the large chart does at the cursor.
    pub(super) fn open_cursor(&mut self) {
        match self.opening() {
            None => self.status = Some("Enter opens nothing in this chart".into()),
            Some(Opening::Run(scene)) => self.open_run(*scene),
            Some(Opening::Jump { path, value, to }) => self.jump_to_limit(path, value, &to),
            Some(Opening::Select(path)) => self.select_to_turn(path),
            Some(Opening::Nothing(reason)) => self.status = Some(reason),
        }
    }

    /// Checks that the run has this instant.
    ///
    /// # Errors
    /// It has not, in words.
    pub(super) fn has_instant(&self, t: f64) -> Result<(), String> {
        let end = self.end_s();
        if (0.0..=end).contains(&t) {
            return Ok(());
        }
        let [t, end] = [t, end].map(|t| readable(t, "s"));
        Err(format!("t = {t}: from 0 to {end}, the end of the run"))
    }

    /// Goes to an instant: what is read, while a chart is read, otherwise the motion, which
    /// begins again where that is behind.
    pub(super) fn go_to(&mut self, t: f64) {
        if self.reading.on {
            self.play.pages_back = self.page_number() - self.page_of(t);
            self.read_instant(t);
            return;
        }
        if t < self.now() {
            self.restart();
        }
        (self.play.go_to_s, self.play.pages_back) = (t, 0);
        self.play.goes += 1;
        self.status = Some(format!("on to {}", instant(t)));
    }

    /// Goes a page back, or forward, as far as the forecast.
    pub(super) fn pan(&mut self, back: bool) {
        let last = self.page_of(self.end_s());
        let now = self.page_number();
        let pages = self.play.pages_back + if back { 1 } else { -1 };
        self.play.pages_back = pages.clamp((now - last).min(0), now);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::app::{PaletteState, on_screen};

    #[test]
    fn an_instant_that_is_read_stays_from_view_to_view() {
        let mut app = on_screen();
        app.walk(ViewId::Response);
        app.point(Cursor { across: 0.25, up: 0.5 });
        let read = Some(5e-3);
        for view in ViewId::all().chain([ViewId::Gaps, ViewId::Response]) {
            app.walk(view);
            assert_eq!(app.cursor_time(), read, "{}", view.word());
            assert_eq!(app.order().cursor_s, read);
        }
        assert_eq!(app.cursor_in(ViewId::Response), Some(Cursor { across: 0.25, up: 0.5 }));
        // On a page that it is not on, too, unless the cursor is moved across.
        app.play.zoom = 6;
        assert!(app.page().1 < 5e-3);
        app.move_cursor(0, 1, false);
        assert_eq!(app.cursor_time(), read);
        app.move_cursor(-1, 0, false);
        assert!(app.cursor_time().is_some_and(|t| t < app.page().1));
        app.reading.stop();
        assert_eq!((app.cursor_time(), app.reading.is_open()), (None, false));
    }

    #[test]
    fn a_blade_is_read_by_its_number() {
        let mut app = on_screen();
        app.go_to_blade(7).unwrap();
        let cursor = app.cursor_in(ViewId::Gaps).unwrap();
        assert_eq!((cell_of(cursor.across, 22), app.reading.on), (6, true));
        for blade in [0, 23] {
            app.choose_command(&PaletteState { typed: format!("blade {blade}").into(), place: 0 });
            let refused = format!("blade {blade}: from 1 to 22");
            assert_eq!(app.status.as_deref(), Some(refused.as_str()));
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
}
