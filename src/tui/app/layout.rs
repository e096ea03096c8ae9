//! Which views are on the screen, in which order, and the areas of all panels for each screen size.

use ratatui::layout::{Constraint, Layout as Split, Rect};

use super::knobs::strip;
use super::lesson::step_rows;
use super::model::{App, Layout};
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::{Scene, keys, speed_range};

/// Largest number of charts beside the large one.
pub const MOST_BESIDE: usize = 3;
/// Width from which the knobs have a column and the wheel is among the first charts \[columns\].
const WIDE: u16 = 100;
/// Smallest width and height of a screen with the overview \[columns, rows\].
const OVERVIEW: (u16, u16) = (76, 23);

impl Layout {
    /// Creates the layout with the views that the scene names in front.
    pub fn of(scene: &Scene) -> Self {
        let views = ViewId::all().collect();
        let (chosen, survey, range, full_screen) = (false, false, None, false);
        let (beside, size) = (MOST_BESIDE, (80, 24));
        let mut layout = Self { views, chosen, beside, survey, range, full_screen, size };
        layout.open(scene);
        layout
    }

    /// Moves the views that the scene names to the front, and takes the speeds of its machine.
    pub fn open(&mut self, scene: &Scene) {
        let charts = &scene.view.charts;
        let named = |view: &ViewId| charts.iter().position(|word| word == view.word());
        self.views.sort_by_key(|view| named(view).unwrap_or(charts.len()));
        self.chosen = false;
        self.range = speed_range(keys::VIEW_SPEEDS, &scene.view.speeds).ok().or(self.range);
    }

    /// Iterates over the views in the order of the screen. A narrow one has the wheel only if the
    /// user chose it.
    pub fn shown(&self) -> impl Iterator<Item = ViewId> {
        let chosen = self.chosen && self.views.first() == Some(&ViewId::Frame);
        let has_wheel = chosen || self.size.0 >= WIDE;
        self.views.iter().copied().filter(move |view| *view != ViewId::Frame || has_wheel)
    }

    /// Returns the large view.
    pub fn view(&self) -> ViewId {
        self.shown().next().unwrap_or(ViewId::Response)
    }

    /// Makes `view` the large one by swapping places; returns false if it was already large.
    pub fn show(&mut self, view: ViewId) -> bool {
        if view == self.view() {
            return false;
        }
        let place = self.views.iter().position(|other| *other == view).unwrap_or(0);
        self.views.swap(0, place);
        self.chosen = true;
        true
    }

    /// Puts `last` behind the other small charts, and slow studies behind quick ones.
    pub fn put_behind(&mut self, last: Option<ViewId>) {
        if let Some((_, others)) = self.views.split_first_mut() {
            others.sort_by_key(|view| match *view {
                view if Some(view) == last => 2,
                ViewId::Map | ViewId::Precision | ViewId::Margins => 1,
                _ => 0,
            });
        }
    }

    /// Returns the view `by` places after the large one in the table, cyclically.
    pub fn neighbour(&self, by: i64) -> ViewId {
        let place = (self.view() as i64 + by).rem_euclid(self.views.len() as i64);
        ViewId::all().nth(place as usize).unwrap_or(self.view())
    }
}

impl App {
    /// Returns the large view.
    pub fn view(&self) -> ViewId {
        self.layout.view()
    }

    /// Makes a view the large one; a cursor keeps its time.
    pub fn show(&mut self, view: ViewId) {
        if self.layout.show(view) {
            self.keep_instant();
        }
    }

    /// Makes a view the large one at the user's request. The map then gives the arrow keys to its
    /// cell cursor.
    pub fn walk(&mut self, view: ViewId) {
        self.show(view);
        if view == ViewId::Map && self.dialogue.is_closed() && !self.reading.on {
            self.toggle_reading();
        }
    }

    /// Returns whether `view` is the large one.
    pub fn is_large(&self, view: ViewId) -> bool {
        self.view() == view
    }

    /// Returns whether a narrow screen shows the overview: the run, the gaps, the locked motion and
    /// what ends the lock, which belongs to the margins.
    pub fn is_overview(&self) -> bool {
        let Layout { size: (width, height), beside, .. } = self.layout;
        let fits = (OVERVIEW.0..WIDE).contains(&width) && height >= OVERVIEW.1;
        let usual = beside == MOST_BESIDE && self.lessons.progress.is_none();
        let is_one = self.view() != ViewId::Margins && ViewId::OVERVIEW.contains(&self.view());
        fits && usual && !self.is_alone() && is_one
    }

    /// Returns whether the layout includes `view`; a small screen may still leave no room for it.
    pub fn is_open(&self, view: ViewId) -> bool {
        if self.is_overview() {
            return ViewId::OVERVIEW.contains(&view);
        }
        let shown = if self.is_alone() { 1 } else { 1 + self.layout.beside };
        self.layout.shown().take(shown).any(|other| other == view)
    }

    /// Returns whether the large chart is the only one on the screen.
    pub fn is_alone(&self) -> bool {
        self.layout.full_screen || self.compares()
    }
}

/// Smallest legible height of a chart: eight rows of data, title, axis and labels.
pub const LEAST_ROWS: u16 = 11;

/// Smallest width of a screen that is drawn \[columns\].
pub const LEAST_WIDTH: u16 = 40;
/// Smallest height of a screen that is drawn \[rows\].
pub const LEAST_HEIGHT: u16 = 12;

/// Width of the column of knobs.
const KNOBS_WIDTH: u16 = 27;
/// Width from which the column of knobs stays when two contact laws are compared.
const KNOBS_BESIDE_LAWS: u16 = 110;
/// Width from which two charts are side by side.
const PAIR_FROM: u16 = 76;
/// Height from which the strip of knobs has a row for the bar of the selected one.
const BAR_FROM: u16 = 16;

/// The areas of one frame.
pub struct Places {
    /// Verdict, title and speeds.
    pub header: Rect,
    /// Everything between header and footer.
    pub body: Rect,
    /// The knobs: a column, or a strip above the charts.
    pub knobs: Rect,
    /// Whether the knobs are a column.
    pub column: bool,
    /// The list of the knobs that the strip does not have, over the charts; `None` unless one of
    /// them is selected, and without room.
    pub list: Option<Rect>,
    /// The views on the screen with their areas.
    pub charts: Vec<(ViewId, Rect)>,
    /// The current lesson; `None` if none is open, or the screen is too low for it.
    pub lesson: Option<Rect>,
    /// Status message or keys.
    pub footer: Rect,
}

/// Computes the areas for a screen of this size.
pub fn places(area: Rect, app: &App) -> Places {
    let [header, body, footer] =
        Split::vertical([Constraint::Length(2), Constraint::Min(1), Constraint::Length(1)])
            .areas(area);
    let (lesson, rest) = lesson(body, app);
    let from = if app.compares() { KNOBS_BESIDE_LAWS } else { WIDE };
    let column = area.width >= from && !app.layout.full_screen;
    let [knobs, charts] = if column {
        Split::horizontal([Constraint::Length(KNOBS_WIDTH), Constraint::Min(1)]).areas(rest)
    } else {
        below(rest, if area.height < BAR_FROM { 1 } else { 2 })
    };
    // It would hide the chart that a lesson speaks of.
    let fits = charts.width >= PAIR_FROM && lesson.is_none();
    let listed = !column && fits && app.knobs.selected >= strip::count(app, knobs.width);
    let list = listed.then(|| halves(charts)[1]);
    let charts = if app.is_alone() {
        vec![(app.view(), charts)]
    } else if app.is_overview() {
        let rows = below(charts, charts.height / 2).map(halves);
        ViewId::OVERVIEW.into_iter().zip(rows.concat()).collect()
    } else {
        split(charts, app)
    };
    Places { header, body, knobs, column, list, charts, lesson, footer }
}

/// Splits an area into its left and its right half, with a gap between them. The right one is a
/// little wider, for a table.
fn halves(area: Rect) -> [Rect; 2] {
    let parts = [Constraint::Length((area.width - 3) / 2), Constraint::Min(1)];
    Split::horizontal(parts).spacing(1).areas(area)
}

/// Splits off the first `rows` rows of an area.
fn below(area: Rect, rows: u16) -> [Rect; 2] {
    Split::vertical([Constraint::Length(rows), Constraint::Min(1)]).areas(area)
}

/// Returns the area of the current lesson, and the rest below it.
fn lesson(body: Rect, app: &App) -> (Option<Rect>, Rect) {
    if app.lessons.progress.is_none() || body.height < 9 {
        return (None, body);
    }
    // An open question comes before the charts.
    let most = if app.is_asked() { body.height - 1 } else { body.height / 2 };
    let rows = step_rows(app, usize::from(body.width)).min(most);
    let [lesson, body] = below(body, rows);
    (Some(lesson), body)
}

/// Smallest height of the wheel above another chart \[rows\]; it needs no axis.
const WHEEL_ROWS: u16 = 10;

/// Splits the area into the large chart and as many smaller ones as remain legible. The wheel is
/// about square and shares its rows with another chart; any other large chart has the full width.
fn split(area: Rect, app: &App) -> Vec<(ViewId, Rect)> {
    let beside = app.layout.beside;
    let wheel = app.is_large(ViewId::Frame);
    let large = if wheel { WHEEL_ROWS } else { LEAST_ROWS };
    let below = area.height.saturating_sub(large) / LEAST_ROWS;
    let vertical = |parts: Vec<Constraint>| Split::vertical(parts).split(area).to_vec();
    if area.width < PAIR_FROM {
        let count = u16::try_from(beside).unwrap_or(below).min(below);
        let low = (area.height * 3 / (4 + 3 * count)).max(LEAST_ROWS);
        let mut rows = vec![Constraint::Min(1)];
        rows.extend((0..count).map(|_| Constraint::Length(low)));
        return app.layout.shown().zip(vertical(rows)).collect();
    }
    // Numbers of charts side by side, above and below.
    let [above, under] = match (wheel, beside) {
        (_, 0) => [1, 0],
        (true, _) if below == 0 => [2, 0],
        (false, _) if below == 0 => [1, 0],
        (true, more) => [2, more - 1],
        (false, more) => [1, more.min(2)],
    };
    // The margins table can use every row.
    let part = if app.is_large(ViewId::Margins) { 0 } else { LOWER };
    let lower = (area.height * part).div_ceil(100).max(LEAST_ROWS);
    let rows = match under {
        0 => vec![area],
        _ => vertical(vec![Constraint::Min(1), Constraint::Length(lower)]),
    };
    let left = match wheel {
        true if app.layout.size.0 < WIDE => 48,
        true => WHEEL_PART,
        false => 50,
    };
    let areas = rows.into_iter().zip([above, under]).flat_map(|(row, count)| match count {
        1 => vec![row],
        _ => {
            let parts = [Constraint::Percentage(left), Constraint::Percentage(100 - left)];
            Split::horizontal(parts).spacing(1).split(row).to_vec()
        }
    });
    app.layout.shown().zip(areas).collect()
}

/// Height of the charts below the large one on a wide screen \[% of the height of all charts\].
const LOWER: u16 = 45;
/// Width of the wheel beside another chart on a wide screen \[% of the width of both\].
const WHEEL_PART: u16 = 44;

/// Returns the areas on this screen.
pub fn placed(app: &App) -> Places {
    places(Rect::new(0, 0, app.layout.size.0, app.layout.size.1), app)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::command::Command;
    use crate::tui::{Marker, Theme};

    #[test]
    fn a_chart_that_becomes_the_large_one_leaves_its_place_to_the_former() {
        let mut scene = Scene::base();
        scene.view.charts = vec!["map".into(), "gaps".into()];
        let mut layout = Layout::of(&scene);
        assert_eq!(layout.views[..3], [ViewId::Map, ViewId::Gaps, ViewId::Response]);
        assert_eq!(layout.views.len(), ViewId::all().count());
        assert!(layout.show(ViewId::Response) && !layout.show(ViewId::Response));
        assert_eq!(layout.views[..3], [ViewId::Response, ViewId::Gaps, ViewId::Map]);
        assert_eq!(layout.neighbour(-1), ViewId::Coincidence);
    }

    fn app() -> App {
        App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Braille)
    }

    #[test]
    fn every_chart_beside_the_knobs_has_eight_rows_of_data() {
        for (width, height) in [(100, 30), (120, 40), (200, 50)] {
            for view in ViewId::all() {
                let mut app = app();
                app.layout.size = (width, height);
                app.act(Command::View(view));
                let charts = places(Rect::new(0, 0, width, height), &app).charts;
                for (shown, area) in charts {
                    // The wheel has no axis.
                    let axis = if shown == ViewId::Frame { 2 } else { 0 };
                    assert!(area.height + axis >= LEAST_ROWS, "{shown:?} {area:?}");
                }
            }
        }
    }
}
