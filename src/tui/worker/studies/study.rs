//! A study: the computation of what a view shows, with its inputs and its latest result.

use std::fmt;
use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::tui::engine::{Order, Working};
use crate::tui::film::Film;
use crate::tui::views::id::ViewId;
use crate::tui::worker::background::Job;
use rubscope_solver::study::MapPlan;

/// Wall-clock time after which the progress of a study is shown.
const LONG: Duration = Duration::from_millis(500);

/// Inputs common to all studies.
#[derive(Debug)]
pub struct Given<'a> {
    /// The current order.
    pub order: &'a Order,
    /// Plan of the map; `None` if its view is closed or the scene does not allow a map.
    pub plan: Option<MapPlan>,
    /// The run to its end.
    pub run: &'a Film,
    /// How much is computed.
    pub extent: Extent,
}

/// How much the studies compute. A test leaves out what it does not look at.
#[derive(Clone, Copy, Debug)]
pub struct Extent {
    /// Largest number of computed map cells.
    pub most_cells: usize,
    /// Whether the margins search the nearest changes of the verdict.
    pub searches_changes: bool,
    /// Wall-clock time for which a knob rests before the survey and the runs of the margins begin.
    pub rest: Duration,
}

impl Default for Extent {
    fn default() -> Self {
        let rest = Duration::from_millis(200);
        Self { most_cells: usize::MAX, searches_changes: true, rest }
    }
}

/// A study: its inputs, and the job that computes its result.
pub trait Study {
    /// Inputs; the result is kept while they are equal.
    type Key: fmt::Debug + PartialEq;
    /// The result, as the view draws it.
    type Found: Clone + fmt::Debug + Send + Sync + 'static;
    /// The view that shows it.
    const VIEW: ViewId;
    /// Whether the previous result stays on the screen until a new one arrives.
    const STAYS: bool = true;
    /// Whether it is slow: it runs side by side with other slow studies, and is dropped when it is
    /// no longer needed, to free the processor.
    const SLOW: bool = false;

    /// Returns the current inputs; `None` if no view needs the study.
    fn key(given: &Given) -> Option<Self::Key>;

    /// Starts the job; `before` is the latest result, of these inputs or earlier ones.
    fn begin(key: &Self::Key, given: &Given, before: Option<&Self::Found>) -> Job<Self::Found>;

    /// Returns whether a result may replace the previous one before it is complete.
    fn replaces(_: &Self::Found) -> bool {
        true
    }
}

/// A study, with the result for its previous inputs.
#[derive(Debug)]
pub struct StudySlot<S: Study> {
    /// The inputs and their job; `None` before the first, and after one that was dropped.
    pub(super) study: Option<(S::Key, Job<S::Found>)>,
    /// The result for earlier inputs; `None` if there is none.
    before: Option<Arc<S::Found>>,
    /// When the current job began; `None` before the first.
    since: Option<Instant>,
}

impl<S: Study> Default for StudySlot<S> {
    fn default() -> Self {
        Self { study: None, before: None, since: None }
    }
}

impl<S: Study> StudySlot<S> {
    /// Ends the job; its result stays if it may.
    fn end(&mut self) {
        let ended = self.study.take().filter(|_| S::STAYS);
        let found = ended.and_then(|(_, job)| Self::replaces(&job).cloned());
        self.before = found.or(self.before.take());
    }

    /// Returns the result of a job if it may replace the previous one: it may, or no other comes.
    fn replaces(job: &Job<S::Found>) -> Option<&Arc<S::Found>> {
        job.found.as_ref().filter(|found| job.is_done() || S::replaces(found))
    }

    fn of(&self, key: &S::Key) -> Option<&Job<S::Found>> {
        self.study.as_ref().filter(|(of, _)| of == key).map(|(_, job)| job)
    }

    /// Returns the result to show; `None` until there is one.
    pub fn shown(&self, given: &Given) -> Option<Arc<S::Found>> {
        let job = match S::STAYS {
            true => self.study.as_ref().map(|(_, job)| job),
            false => self.of(&S::key(given)?),
        };
        let found = job.and_then(Self::replaces).or(self.before.as_ref());
        found.or_else(|| job?.found.as_ref()).cloned()
    }
}

/// A study of any type, as a trait object.
pub trait Work {
    /// Returns whether it is slow, see [`Study::SLOW`].
    fn is_slow(&self) -> bool;
    /// Returns whether nothing is left to compute.
    fn is_done(&self, given: &Given) -> bool;
    /// Starts the job, and collects its results; waits up to `patience` for one.
    fn work(&mut self, given: &Given, patience: Duration);
    /// Stops the job if no view needs it.
    fn stop_unwanted(&mut self, given: &Given);
    /// Returns the progress; `None` unless the study has been running for longer than `LONG`.
    fn working(&self, given: &Given) -> Option<Working>;
}

impl<S: Study> Work for StudySlot<S> {
    fn is_slow(&self) -> bool {
        S::SLOW
    }

    fn is_done(&self, given: &Given) -> bool {
        S::key(given).is_none_or(|key| self.of(&key).is_some_and(Job::is_done))
    }

    fn work(&mut self, given: &Given, patience: Duration) {
        let Some(key) = S::key(given) else { return };
        if self.of(&key).is_none() {
            self.end();
            let job = S::begin(&key, given, self.before.as_deref());
            self.study = Some((key, job));
            self.since = Some(Instant::now());
        }
        if let Some((_, job)) = &mut self.study {
            job.work(patience);
        }
    }

    fn stop_unwanted(&mut self, given: &Given) {
        let is_wanted = S::key(given).is_some_and(|key| self.of(&key).is_some());
        if S::SLOW && !is_wanted && self.study.as_ref().is_some_and(|(_, job)| !job.is_done()) {
            self.end();
        }
    }

    fn working(&self, given: &Given) -> Option<Working> {
        let wall = self.since.filter(|_| !self.is_done(given))?.elapsed();
        (wall > LONG).then_some(Working { view: S::VIEW, seconds: wall.as_secs() })
    }
}
