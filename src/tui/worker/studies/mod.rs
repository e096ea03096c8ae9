//! Studies for the views: curves, spectrum, map, margins, comparison of solvers. Each is a type here
//! (the map has a file of its own) and a row in the table below. It is computed in slices, only while
//! a view needs it, and its result is kept while its inputs stay the same.

mod map;
mod study;

use std::sync::Arc;
use std::time::{Duration, Instant};

pub use study::Extent;
use study::{Given, Study, StudySlot, Work};

use crate::tui::engine::{FORECAST_LIMIT, Found, Order, SLICE, Working};
use crate::tui::film::Film;
use crate::tui::views::id::ViewId;
use crate::tui::views::margins::live::LiveMargins;
use crate::tui::views::spectrum::lines::Spectrum;
use crate::tui::views::steady::coincidence_curves::CoincidenceCurves;
use crate::tui::views::steady::locked_curves::LockedCurves;
use crate::tui::worker::background::{Job, on_spare_cores};
use rubscope_solver::model::Machine;
use rubscope_solver::scene::{CheckedScene, ModelSize, Scene};
use rubscope_solver::study::margins::Margins;
use rubscope_solver::study::precision::{Effort, Measure, Precision, ways};
use rubscope_solver::study::survey::Survey;

macro_rules! studies {
    ($($name:ident: $study:ty,)*) => {
        /// The studies of one scene, in order of computation.
        #[derive(Debug, Default)]
        pub struct Studies {
            /// How much is computed.
            pub extent: Extent,
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
    locked: LockedStudy,
    spectrum: SpectrumStudy,
    coincidence: CoincidenceStudy,
    margins: MarginsStudy,
    cell: map::CellStudy,
    map: map::MapStudy,
    precision: PrecisionStudy,
}

impl Studies {
    fn given<'a>(&self, order: &'a Order, run: &'a Film) -> Given<'a> {
        Given { order, plan: order.map_plan(), run, extent: self.extent }
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
        match due.first().is_some_and(|first| first.is_slow()) {
            true => due.retain(|study| study.is_slow()),
            false => due.truncate(1),
        }
        // Wait for results of only one of them.
        while let Some(study) = due.pop() {
            study.work(given, if due.is_empty() { SLICE } else { Duration::ZERO });
        }
    }
}

/// The curves of view 3. They are closed forms, so they are computed at once, and several views use
/// them, so they are always computed.
#[derive(Debug)]
struct LockedStudy;

impl Study for LockedStudy {
    type Key = Scene;
    type Found = LockedCurves;
    const VIEW: ViewId = ViewId::Locked;

    fn key(given: &Given) -> Option<Scene> {
        Some(given.order.scene.clone().into_scene())
    }

    fn begin(scene: &Scene, _: &Given, _: Option<&Self::Found>) -> Job<Self::Found> {
        Job::done(LockedCurves::of(scene))
    }
}

/// The spectrum of the casing's motion at the end of the run.
#[derive(Debug)]
struct SpectrumStudy;

impl Study for SpectrumStudy {
    /// Number of the film.
    type Key = u64;
    type Found = Spectrum;
    const VIEW: ViewId = ViewId::Spectrum;
    const STAYS: bool = false;

    fn key(given: &Given) -> Option<u64> {
        given.order.shows(Self::VIEW).then_some(given.order.number)
    }

    fn begin(_: &u64, given: &Given, _: Option<&Self::Found>) -> Job<Self::Found> {
        let (scene, film) = (given.order.scene.clone(), given.run.clone());
        Job::by(move |to, go_on| {
            let began = Instant::now();
            let go_on = || go_on() && began.elapsed() < FORECAST_LIMIT;
            let signal = film.signal(Spectrum::longest_interval(&scene), &go_on);
            _ = to.send(Spectrum::of(&scene, signal));
        })
    }
}

/// The coincidence curves; with a lining each point is a search. `None` if the wave has no
/// coincidence.
#[derive(Debug)]
struct CoincidenceStudy;

impl Study for CoincidenceStudy {
    type Key = (Machine, ModelSize, f64);
    type Found = Option<CoincidenceCurves>;
    const VIEW: ViewId = ViewId::Coincidence;

    fn key(given: &Given) -> Option<Self::Key> {
        given.order.shows(Self::VIEW).then(|| CoincidenceCurves::key(&given.order.scene))
    }

    fn begin(_: &Self::Key, given: &Given, _: Option<&Self::Found>) -> Job<Self::Found> {
        let scene = given.order.scene.clone();
        Job::by(move |to, _| _ = to.send(CoincidenceCurves::of(&scene)))
    }
}

/// The margins of a scene: first for its own nodal diameters, then the survey over all of them, then
/// the nearest changes of the verdict, which take many runs.
#[derive(Debug)]
struct MarginsStudy;

impl Study for MarginsStudy {
    /// The scene, the speed range of the survey \[rad/s\] (`None` covers all speeds), and whether
    /// every law is searched.
    type Key = (CheckedScene, Option<[f64; 2]>, bool);
    type Found = LiveMargins;
    const VIEW: ViewId = ViewId::Margins;
    const SLOW: bool = true;

    fn key(given: &Given) -> Option<Self::Key> {
        let order = given.order;
        order.shows(Self::VIEW).then(|| (order.scene.clone(), order.range, order.every_law))
    }

    fn begin(
        (scene, range, every_law): &Self::Key,
        given: &Given,
        before: Option<&Self::Found>,
    ) -> Job<Self::Found> {
        let (scene, range, every_law) = (scene.clone(), *range, *every_law);
        // Before the first margins no knob was turned.
        let rest = before.map_or(Duration::ZERO, |_| given.extent.rest);
        let searches = given.extent.searches_changes;
        Job::by(move |to, go_on| {
            let mut margins = Margins::of(&scene);
            let send = |margins: &Margins, survey: &Option<Arc<Survey>>| {
                _ = to.send(LiveMargins { margins: margins.clone(), survey: survey.clone() });
            };
            send(&margins, &None);
            std::thread::sleep(rest);
            if !go_on() {
                return;
            }
            let survey = Survey::of(&scene, range, None).ok().map(Arc::new);
            send(&margins, &survey);
            let known = &mut |margins: &Margins| send(margins, &survey);
            if searches {
                on_spare_cores(|| margins.ask_runs(every_law, go_on, known));
            }
        })
    }
}

/// Speed against error of the solvers, row by row: a row can take seconds.
#[derive(Debug)]
struct PrecisionStudy;

impl Study for PrecisionStudy {
    type Key = Scene;
    type Found = Precision;
    const VIEW: ViewId = ViewId::Precision;

    fn key(given: &Given) -> Option<Scene> {
        given.order.shows(Self::VIEW).then(|| given.order.scene.clone().into_scene())
    }

    fn begin(scene: &Scene, _: &Given, _: Option<&Self::Found>) -> Job<Self::Found> {
        let scene = scene.clone();
        Job::by(move |to, go_on| {
            let Ok(Some(measure)) = Measure::new(&scene, Effort::QUICK, go_on) else { return };
            let reference = measure.reference().clone();
            let ways = ways(&scene, Effort::QUICK);
            let mut report = Precision { scene, reference, rows: Vec::new() };
            _ = to.send(report.clone());
            for way in ways {
                let row = measure.row(way, Effort::QUICK, go_on);
                if !go_on() {
                    return;
                }
                if let Ok(Some(row)) = row {
                    report.rows.push(row);
                    _ = to.send(report.clone());
                }
            }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::film::FilmPlan;
    use crate::tui::{App, Marker, Theme};

    /// Calls `with` with the inputs of a study that does not use the run.
    pub(super) fn with_given<T>(scene: &Scene, view: ViewId, with: impl Fn(&Given) -> T) -> T {
        let scene = scene.checked().unwrap();
        let run = Film::new(FilmPlan::new(&scene));
        let app = App::new(scene, Theme::Mono, Marker::Ascii);
        let order = Order { open: vec![view], ..app.order() };
        with(&Studies::default().given(&order, &run))
    }

    #[test]
    fn the_coincidence_does_not_depend_on_the_pulse_or_on_a_speed_inside_its_range() {
        let mut scene = Scene::base();
        scene.bladed_disk.radial_coupling = 0.3;
        let view = ViewId::Coincidence;
        let key =
            |scene: &Scene| with_given(scene, view, |given| CoincidenceStudy::key(given).unwrap());
        let own = key(&scene);
        let begin = |given: &Given| CoincidenceStudy::begin(&own, given, None);
        let mut job = with_given(&scene, view, begin);
        while !job.is_done() {
            job.work(Duration::from_millis(20));
        }
        let curves = CoincidenceCurves::of(&scene);
        let points = |curves: &Option<CoincidenceCurves>| curves.as_ref().unwrap().points.clone();
        assert_eq!(points(job.found.as_ref().unwrap()), points(&curves));
        scene.operation.pulse_n = 1e5;
        scene.operation.speed_rad_s = 300.0;
        assert!(key(&scene) == own);
        let moved = CoincidenceCurves::of(&scene).unwrap();
        assert_eq!(Some(moved.speeds.marks), curves.map(|curves| curves.speeds.marks));
        scene.operation.speed_rad_s = -300.0;
        assert!(key(&scene) != own);
        scene.operation.speed_rad_s = 300.0;
        scene.bladed_disk.radial_coupling = 0.5;
        assert!(key(&scene) != own);
    }

    #[test]
    fn a_search_ends_with_its_view_and_what_was_known_stays() {
        let app = App::new(Scene::base().checked().unwrap(), Theme::Mono, Marker::Ascii);
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
    }
}
