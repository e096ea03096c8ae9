//! Which views are on the screen, and in which order.

use super::App;
use crate::report::number::speed_unit;
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::Scene;

/// Largest number of charts beside the large one.
const MOST_BESIDE: usize = 3;

/// Which views are on the screen, and where.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// All views: the large one, then the others in screen order. Only the first `1 + beside` are
    /// shown.
    views: Vec<ViewId>,
    /// Number of charts beside the large one.
    pub beside: usize,
    /// Whether the margins view shows the survey over all nodal diameters.
    pub survey: bool,
    /// Speed range of the survey \[rad/s\]; `None` covers all speeds.
    pub range: Option<[f64; 2]>,
    /// Whether the large chart fills the screen.
    pub full_screen: bool,
    /// Width and height of the screen \[cells\].
    pub size: (u16, u16),
}

impl Layout {
    /// Creates the layout with the views that the scene names in front.
    pub fn of(scene: &Scene) -> Self {
        let views = ViewId::all().collect();
        let (survey, range, full_screen) = (false, None, false);
        let mut layout =
            Self { views, beside: MOST_BESIDE, survey, range, full_screen, size: (80, 24) };
        layout.open(scene);
        layout
    }

    /// Moves the views that the scene names to the front.
    pub fn open(&mut self, scene: &Scene) {
        let named = scene.view.charts.iter().filter_map(|word| ViewId::from_word(word));
        let mut views: Vec<ViewId> = named.collect();
        views.extend(
            self.views.iter().copied().filter(|view| !views.contains(view)).collect::<Vec<_>>(),
        );
        self.views = views;
    }

    /// Returns the large view.
    pub fn view(&self) -> ViewId {
        self.views.first().copied().unwrap_or(ViewId::Response)
    }

    /// Returns all views: the large one, then the others in screen order.
    pub fn views(&self) -> &[ViewId] {
        &self.views
    }

    /// Restores an order of views; returns whether the large view changed.
    pub fn set_views(&mut self, views: Vec<ViewId>) -> bool {
        let before = self.view();
        self.views = views;
        self.view() != before
    }

    /// Makes `view` the large one by swapping places; returns false if it was already large.
    pub fn show(&mut self, view: ViewId) -> bool {
        let place = self.views.iter().position(|other| *other == view).unwrap_or(0);
        self.views.swap(0, place);
        place > 0
    }

    /// Sorts the views beside the large one by rank.
    pub fn order_beside(&mut self, rank: impl Fn(ViewId) -> u8) {
        if let Some((_, others)) = self.views.split_first_mut() {
            others.sort_by_key(|view| rank(*view));
        }
    }

    /// Switches between the survey over all nodal diameters and the margins of one; returns the
    /// status message.
    pub fn turn_survey(&mut self, on: bool) -> String {
        self.survey = on;
        let ends = if speed_unit() == "rpm" { "2000:6000" } else { "200:600" };
        match on {
            true => {
                format!("margins of all diameters; : range {ends} gives the speeds of a machine")
            }
            false => "margins of n_d alone".to_string(),
        }
    }

    /// Changes the number of charts beside the large one, from the most to none.
    pub fn next_count(&mut self) {
        self.beside = (self.beside + 1) % (MOST_BESIDE + 1);
    }

    /// Returns the view `by` places after the large one in the table, cyclically.
    pub fn neighbour(&self, by: i64) -> ViewId {
        let views: Vec<ViewId> = ViewId::all().collect();
        let place = (self.view() as i64 + by).rem_euclid(views.len() as i64);
        views.get(place as usize).copied().unwrap_or(self.view())
    }
}

impl App {
    /// Returns the large view.
    pub fn view(&self) -> ViewId {
        self.layout.view()
    }

    /// Returns whether `view` is the large one.
    pub fn is_large(&self, view: ViewId) -> bool {
        self.view() == view
    }

    /// Returns whether the layout includes `view`; a small screen may still leave no room for it.
    pub fn is_open(&self, view: ViewId) -> bool {
        let shown = if self.is_alone() { 1 } else { 1 + self.layout.beside };
        self.layout.views.iter().take(shown).any(|other| *other == view)
    }

    /// Returns whether the large chart is the only one on the screen.
    pub fn is_alone(&self) -> bool {
        self.layout.full_screen || self.compares()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chart_that_becomes_the_large_one_leaves_its_place_to_the_former() {
        let mut scene = Scene::base();
        scene.view.charts = vec!["map".into(), "gaps".into()];
        let mut layout = Layout::of(&scene);
        assert_eq!(layout.views()[..3], [ViewId::Map, ViewId::Gaps, ViewId::Response]);
        assert_eq!(layout.views().len(), ViewId::all().count());
        assert!(layout.show(ViewId::Response) && !layout.show(ViewId::Response));
        assert_eq!(layout.views()[..3], [ViewId::Response, ViewId::Gaps, ViewId::Map]);
        assert_eq!(layout.neighbour(-1), ViewId::Coincidence);
        (0..3).for_each(|_| layout.next_count());
        assert_eq!(layout.beside, 2);
    }
}
