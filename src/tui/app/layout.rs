//! Which charts are on the screen, and where.

use super::App;
use crate::report::number::speed_unit;
use crate::tui::bindings::Action;
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::Scene;

/// Most charts next to the large one.
const MOST_BESIDE: usize = 3;

/// The charts on the screen.
#[derive(Clone, Debug, PartialEq)]
pub struct Layout {
    /// Every view: the large chart, then the others in the order of their places.
    views: Vec<ViewId>,
    /// Number of charts next to the large one.
    pub beside: usize,
    /// Whether the margins are those of all diameters.
    pub survey: bool,
    /// The speeds that the survey is of; none for all of them \[rad/s\].
    pub range: Option<[f64; 2]>,
    /// Whether the large chart has the whole screen.
    pub full_screen: bool,
    /// Width and height of the screen, in cells.
    pub size: (u16, u16),
}

impl Layout {
    /// Creates the layout with the charts that a scene names first.
    pub fn of(scene: &Scene) -> Self {
        let views = ViewId::all().collect();
        let (survey, range, full_screen) = (false, None, false);
        let mut layout =
            Self { views, beside: MOST_BESIDE, survey, range, full_screen, size: (80, 24) };
        layout.open(scene);
        layout
    }

    /// Puts the charts that a scene names first.
    pub fn open(&mut self, scene: &Scene) {
        let named = scene.view.charts.iter().filter_map(|word| ViewId::from_word(word));
        let mut views: Vec<ViewId> = named.collect();
        views.extend(
            self.views.iter().copied().filter(|view| !views.contains(view)).collect::<Vec<_>>(),
        );
        self.views = views;
    }

    /// Returns the large chart.
    pub fn view(&self) -> ViewId {
        self.views.first().copied().unwrap_or(ViewId::Response)
    }

    /// Returns every view, the large one first.
    pub fn views(&self) -> &[ViewId] {
        &self.views
    }

    /// Restores the order of the charts; returns whether the large one is another.
    pub fn set_views(&mut self, views: Vec<ViewId>) -> bool {
        let before = self.view();
        self.views = views;
        self.view() != before
    }

    /// Makes a view the large one; the former one takes its place. False where it is large.
    pub fn show(&mut self, view: ViewId) -> bool {
        let place = self.views.iter().position(|other| *other == view).unwrap_or(0);
        self.views.swap(0, place);
        place > 0
    }

    /// Orders the charts beside the large one.
    pub fn order_beside(&mut self, rank: impl Fn(ViewId) -> u8) {
        if let Some((_, others)) = self.views.split_first_mut() {
            others.sort_by_key(|view| rank(*view));
        }
    }

    /// Shows the margins of all diameters, or of one; returns the message.
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

    /// Its keys.
    pub fn act(&mut self, action: Action) {
        match action {
            Action::Charts => self.beside = (self.beside + 1) % (MOST_BESIDE + 1),
            Action::FullScreen => self.full_screen = !self.full_screen,
            Action::Close => self.full_screen = false,
            _ => {}
        }
    }

    /// Returns the view some places after the large one in the table.
    pub fn neighbour(&self, by: i64) -> ViewId {
        let views: Vec<ViewId> = ViewId::all().collect();
        let place = (self.view() as i64 + by).rem_euclid(views.len() as i64);
        views.get(place as usize).copied().unwrap_or(self.view())
    }
}

impl App {
    /// Returns the large chart.
    pub fn view(&self) -> ViewId {
        self.layout.view()
    }

    /// Returns whether a view is the large chart.
    pub fn is_large(&self, view: ViewId) -> bool {
        self.view() == view
    }

    /// Returns whether a view can be on the screen.
    pub fn is_open(&self, view: ViewId) -> bool {
        let shown = if self.is_alone() { 1 } else { 1 + self.layout.beside };
        self.layout.views.iter().take(shown).any(|other| *other == view)
    }

    /// Returns whether only the large chart is on the screen.
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
        (0..3).for_each(|_| layout.act(Action::Charts));
        assert_eq!(layout.beside, 2);
    }
}
