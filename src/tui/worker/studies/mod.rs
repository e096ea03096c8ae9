//! Studies for the views: curves, spectrum, map, margins, comparison of solvers. Each has a file
//! here and a row in the table below. It is computed in slices, only while a view needs it, and its
//! result is kept while its inputs stay the same.

mod coincidence;
mod locked;
mod map;
mod margins;
mod precision;
mod spectrum;
mod study;

use std::time::Duration;

use study::{Given, StudySlot, Work};

use crate::tui::engine::{Found, Order, SLICE, Working};
use crate::tui::film::Film;

macro_rules! studies {
    ($($name:ident: $study:ty,)*) => {
        /// The studies of one scene, in order of computation.
        #[derive(Debug, Default)]
        pub struct Studies {
            /// Largest number of computed map cells, for tests; `None` computes all.
            pub most_cells: Option<usize>,
            $($name: StudySlot<$study>,)*
        }

        impl Studies {
            fn all(&self) -> impl Iterator<Item = &dyn Work> {
                [$(&self.$name as &dyn Work),*].into_iter()
            }

            fn all_mut(&mut self) -> impl Iterator<Item = &mut dyn Work> {
                [$(&mut self.$name as &mut dyn Work),*].into_iter()
            }

            /// Collects the results so far.
            pub fn found(&self, order: &Order, run: &Film) -> Found {
                let given = self.given(order, run);
                Found { $($name: self.$name.shown(&given),)* }
            }
        }
    };
}

studies! {
    locked: locked::LockedStudy,
    spectrum: spectrum::SpectrumStudy,
    coincidence: coincidence::CoincidenceStudy,
    margins: margins::MarginsStudy,
    cell: map::CellStudy,
    map: map::MapStudy,
    precision: precision::PrecisionStudy,
}

impl Studies {
    fn given<'a>(&self, order: &'a Order, run: &'a Film) -> Given<'a> {
        Given { order, plan: order.map_plan(), run, most_cells: self.most_cells }
    }

    /// Stops unneeded studies, so that the others have the processor.
    pub fn stop_unwanted(&mut self, order: &Order, run: &Film) {
        let given = self.given(order, run);
        self.all_mut().for_each(|study| study.stop_unwanted(&given));
    }

    /// Returns the progress of the studies that have been running for longer than `LONG`.
    pub fn working(&self, order: &Order, run: &Film) -> Vec<Working> {
        let given = self.given(order, run);
        self.all().filter_map(|study| study.working(&given)).collect()
    }

    /// Returns whether a needed study is incomplete.
    pub fn is_computing(&self, order: &Order, run: &Film) -> bool {
        let given = self.given(order, run);
        self.all().any(|study| !study.is_done(&given))
    }

    /// Computes one slice of the first incomplete study. If that is a slow one, the other slow ones
    /// also get a slice.
    pub fn compute(&mut self, order: &Order, run: &Film) {
        let given = &self.given(order, run);
        let mut due: Vec<_> = self.all_mut().filter(|study| !study.is_done(given)).collect();
        match due.first().is_some_and(|first| first.is_beside()) {
            true => due.retain(|study| study.is_beside()),
            false => due.truncate(1),
        }
        // Wait for results of only one of them.
        while let Some(study) = due.pop() {
            study.work(given, if due.is_empty() { SLICE } else { Duration::ZERO });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::film::FilmPlan;
    use crate::tui::views::id::ViewId;
    use crate::tui::{App, Marker, Theme};
    use rubscope_solver::scene::Scene;

    /// Calls `with` with the inputs of a study that does not use the run.
    pub(super) fn with_given<T>(scene: &Scene, view: ViewId, with: impl Fn(&Given) -> T) -> T {
        let scene = scene.checked().unwrap();
        let run = Film::new(FilmPlan::new(&scene));
        let app = App::new(scene, Theme::Mono, Marker::Ascii);
        let order = Order { open: vec![view], ..app.order() };
        with(&Studies::default().given(&order, &run))
    }

    #[test]
    fn a_search_ends_with_its_view_and_what_was_known_stays() {
        let scene = Scene::base().checked().unwrap();
        let app = App::new(scene, Theme::Mono, Marker::Ascii);
        let mut order = Order { open: vec![ViewId::Margins], ..app.order() };
        let mut studies = Studies::default();
        let run = &Film::new(FilmPlan::new(&order.scene));
        let shown = |studies: &Studies, order: &Order| studies.found(order, run).margins;
        while shown(&studies, &order).is_none() {
            studies.compute(&order, run);
        }
        assert!(studies.is_computing(&order, run));
        order.open.clear();
        studies.stop_unwanted(&order, run);
        assert!(studies.margins.study.is_none() && !studies.is_computing(&order, run));
        assert!(shown(&studies, &order).is_some());
        // For another scene, the old result stays until there is a new one.
        order.open.push(ViewId::Margins);
        let mut other = order.scene.clone().into_scene();
        other.casing.damping_ratio = 0.1;
        order.scene = other.checked().unwrap();
        studies.compute(&order, run);
        studies.compute(&order, run);
        assert!(shown(&studies, &order).is_some());
        while shown(&studies, &order).is_none_or(|live| live.margins.scene != order.scene) {
            studies.compute(&order, run);
        }
        assert!(studies.is_computing(&order, run));
    }
}
