//! A study: the computation of what a view shows, in slices or in a thread of its own, with its
//! inputs and its latest result.

use std::fmt;
use std::sync::Arc;
use std::sync::mpsc::Sender;
use std::time::{Duration, Instant};

use crate::tui::engine::{Order, Working};
use crate::tui::film::Film;
use crate::tui::views::id::ViewId;
use crate::tui::worker::background::Background;
use rubscope_solver::motion::GoOn;
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
    /// Largest number of computed map cells, for tests; `None` computes all.
    pub most_cells: Option<usize>,
}

/// A study: its inputs, and the job that computes its result.
pub trait Study {
    /// Inputs; the result is kept while they are equal.
    type Key: fmt::Debug + PartialEq;
    /// The result, as the view draws it.
    type Found: fmt::Debug;
    /// The job that computes it.
    type Job: Job<Found = Self::Found>;
    /// The view that shows it.
    const VIEW: ViewId;
    /// Whether the previous result stays on the screen until a new one arrives.
    const STAYS: bool = true;
    /// Whether it is slow enough to run side by side with other slow studies.
    const BESIDE: bool = false;
    /// Whether it is dropped, not paused, when it is no longer needed, to free the processor.
    const ENDS: bool = false;

    /// Returns the current inputs; `None` if no view needs the study.
    fn key(given: &Given) -> Option<Self::Key>;

    /// Starts the job.
    fn begin(key: &Self::Key, given: &Given) -> Self::Job;

    /// Returns the finished fraction, 0 to 1; `None` if the study cannot tell.
    fn part(_: &Self::Found) -> Option<f64> {
        None
    }
}

/// The computation of a result, in slices.
pub trait Job: fmt::Debug {
    /// The result; it may be partial while the job is not done.
    type Found;

    /// Returns whether the job is complete.
    fn is_done(&self) -> bool;

    /// Does a slice of the work, or collects results of its threads; waits up to `patience`.
    fn work(&mut self, patience: Duration);

    /// Returns the result; `None` until it may replace the previous one.
    fn found(&self) -> Option<&Arc<Self::Found>>;

    /// Returns a partial result to show if there is no previous one; `None` if the job has none.
    fn first(&self) -> Option<&Arc<Self::Found>> {
        None
    }

    /// Frees the processor while the result is not needed.
    fn pause(&mut self) {}
}

/// A job in a background thread; the latest value it sends is the result. Dropping it ends the
/// thread.
#[derive(Debug)]
pub struct Sent<T> {
    coming: Background<T>,
    found: Option<Arc<T>>,
}

impl<T: Send + 'static> Sent<T> {
    /// Starts the thread. Sending fails only if the job was dropped.
    pub fn by(work: impl FnOnce(&Sender<T>, GoOn<'_>) + Send + 'static) -> Self {
        Self { coming: Background::start(work), found: None }
    }
}

impl<T: fmt::Debug + Send + 'static> Job for Sent<T> {
    type Found = T;

    fn is_done(&self) -> bool {
        self.coming.is_done()
    }

    fn work(&mut self, patience: Duration) {
        let latest = self.coming.receive(patience).map(Arc::new);
        self.found = latest.or(self.found.take());
    }

    fn found(&self) -> Option<&Arc<T>> {
        self.found.as_ref()
    }
}

/// A result that is computed at once.
impl<T: fmt::Debug> Job for Arc<T> {
    type Found = T;

    fn is_done(&self) -> bool {
        true
    }

    fn work(&mut self, _: Duration) {}

    fn found(&self) -> Option<&Self> {
        Some(self)
    }
}

/// A study, with the result for its previous inputs.
#[derive(Debug)]
pub struct StudySlot<S: Study> {
    /// The inputs and their job; `None` before the first, and after one that was dropped.
    pub(super) study: Option<(S::Key, S::Job)>,
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
    fn replace(&mut self, study: Option<(S::Key, S::Job)>) {
        let old = std::mem::replace(&mut self.study, study);
        let found = old.as_ref().and_then(|(_, old)| old.found()).filter(|_| S::STAYS).cloned();
        self.before = found.or(self.before.take());
    }

    fn of(&self, key: &S::Key) -> Option<&S::Job> {
        self.study.as_ref().filter(|(of, _)| of == key).map(|(_, study)| study)
    }

    /// Returns the result to show; `None` until there is one.
    pub fn shown(&self, given: &Given) -> Option<Arc<S::Found>> {
        let study = match S::STAYS {
            true => self.study.as_ref().map(|(_, study)| study),
            false => self.of(&S::key(given)?),
        };
        let found = study.and_then(Job::found).or(self.before.as_ref());
        found.or_else(|| study?.first()).cloned()
    }
}

/// A study of any type, as a trait object.
pub trait Work {
    /// Returns whether it is slow enough to run side by side with others.
    fn is_beside(&self) -> bool;
    /// Returns whether nothing is left to compute.
    fn is_done(&self, given: &Given) -> bool;
    /// Does a slice of the work; waits up to `patience` for the results of threads.
    fn work(&mut self, given: &Given, patience: Duration);
    /// Stops the job if no view needs it.
    fn stop_unwanted(&mut self, given: &Given);
    /// Returns the progress; `None` unless the study has been running for longer than `LONG`.
    fn working(&self, given: &Given) -> Option<Working>;
}

impl<S: Study> Work for StudySlot<S> {
    fn is_beside(&self) -> bool {
        S::BESIDE
    }

    fn is_done(&self, given: &Given) -> bool {
        S::key(given).is_none_or(|key| self.of(&key).is_some_and(Job::is_done))
    }

    fn work(&mut self, given: &Given, patience: Duration) {
        let Some(key) = S::key(given) else { return };
        if self.of(&key).is_none() {
            let study = S::begin(&key, given);
            self.replace(Some((key, study)));
            self.since = Some(Instant::now());
        }
        if let Some((_, study)) = &mut self.study {
            study.work(patience);
        }
    }

    fn stop_unwanted(&mut self, given: &Given) {
        let wanted = S::key(given).is_some_and(|key| self.of(&key).is_some());
        match &mut self.study {
            Some((_, study)) if !wanted && S::ENDS && !study.is_done() => self.replace(None),
            Some((_, study)) if !wanted => study.pause(),
            _ => {}
        }
    }

    fn working(&self, given: &Given) -> Option<Working> {
        let wall = self.since.filter(|_| !self.is_done(given))?.elapsed();
        let part = self.study.as_ref().and_then(|(_, study)| S::part(study.found()?));
        (wall > LONG).then_some(Working { view: S::VIEW, part, seconds: wall.as_secs() })
    }
}
