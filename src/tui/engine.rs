//! Messages between the screen and the solver thread. The screen sends orders, of which only the
//! latest counts; the engine answers with snapshots. Both carry the number of the film, so that
//! outdated results are recognised.

use std::sync::Arc;
use std::time::Duration;

use super::film::plan::FilmPlan;
use super::history::Bin;
use super::trace::Mark;
use super::views::id::ViewId;
use super::views::map::plan::{CellRun, LiveMap, MapChoice};
use super::views::margins::live::LiveMargins;
use super::views::spectrum::lines::Spectrum;
use super::views::steady::coincidence_curves::CoincidenceCurves;
use super::views::steady::locked_curves::LockedCurves;
use crate::sheet::sentence::Facts;
use rubscope_solver::motion::{ActiveSet, Certainty, Hold, Motion, State, Verdict};
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::study::MapPlan;
use rubscope_solver::study::precision::Precision;

/// What the engine should show: a film and an instant of it.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// The scene with the current values of the knobs.
    pub scene: CheckedScene,
    /// The film of the run.
    pub film: FilmPlan,
    /// Number of the film; every film that differs from the one before has a new one.
    pub number: u64,
    /// Number of runs that were begun; live changes and pulses do not begin a run.
    pub run: u64,
    /// The film of the pinned run; `None` if none is pinned.
    pub pinned: Option<FilmPlan>,
    /// Whether to compute the film under the other contact law too.
    pub compare: bool,
    /// The moves in time that the engine has yet to make.
    pub moves: Moves,
    /// Whether the motion plays.
    pub playing: bool,
    /// Rate of the playback, simulated time per wall-clock time: 5e-3 plays five milliseconds per
    /// second.
    pub rate: f64,
    /// Whether playback slows down at changes of contact and speeds up between them.
    pub slow_at_events: bool,
    /// Start and end of the page on the screen \[s\].
    pub page: (f64, f64),
    /// Simulated time of the reading cursor \[s\]; `None` shows the instant played to.
    pub cursor_s: Option<f64>,
    /// The views on the screen; only their studies run.
    pub open: Vec<ViewId>,
    /// Axes and contact law of the map.
    pub map: MapChoice,
    /// Column and row of the map cell whose run is wanted; `None` if no cell is selected.
    pub cell: Option<[u32; 2]>,
    /// Range of rotor speeds of the survey \[rad/s\]; `None` for all speeds.
    pub range: Option<[f64; 2]>,
    /// Whether the margins are wanted under both laws if the law pulls, and not only under that of
    /// the scene.
    pub every_law: bool,
}

impl Order {
    /// Returns whether a view is on the screen.
    pub fn shows(&self, view: ViewId) -> bool {
        self.open.contains(&view)
    }

    /// Returns the plan of the map; `None` if its view is not on the screen or the scene allows no
    /// map of these axes.
    pub fn map_plan(&self) -> Option<MapPlan> {
        self.shows(ViewId::Map).then(|| self.map.plan(&self.scene).ok()).flatten()
    }
}

/// A move to another instant of the film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Move {
    /// To this simulated time \[s\]; it replaces the moves before it.
    To(f64),
    /// By one time step, or one sample if the solver has no steps.
    Step,
    /// To the next change of contact.
    NextChange,
}

/// Largest number of moves that wait.
const MOST_MOVES: usize = 1000;

/// The moves that were requested and not yet made. They are numbered, so that none is lost or made
/// twice when an order replaces an older one. Equal numbers of the last one mean that the same moves
/// were requested, wherever each was made.
#[derive(Clone, Debug, Default)]
pub struct Moves {
    /// Number of the last move that was requested.
    pub last: u64,
    /// The moves that wait, with their numbers.
    waiting: Vec<(u64, Move)>,
}

impl PartialEq for Moves {
    fn eq(&self, other: &Self) -> bool {
        self.last == other.last
    }
}

impl Moves {
    /// Requests a move; returns its number.
    pub fn push(&mut self, to: Move) -> u64 {
        if matches!(to, Move::To(_)) {
            self.waiting.clear();
        }
        if self.waiting.len() < MOST_MOVES {
            self.last += 1;
            self.waiting.push((self.last, to));
        }
        self.last
    }

    /// Drops the moves up to a number.
    pub fn drop_made(&mut self, made: u64) {
        self.waiting.retain(|(number, _)| *number > made);
    }

    /// Returns whether all moves were made.
    pub fn is_empty(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Returns the time to which the motion goes next, if that is known \[s\].
    pub fn target(&self) -> Option<f64> {
        match self.waiting.last() {
            Some((_, Move::To(t))) => Some(*t),
            _ => None,
        }
    }

    /// Returns the first move after the one with the number `made`, and its number.
    pub fn after(&self, made: u64) -> Option<(u64, Move)> {
        self.waiting.iter().copied().find(|(number, _)| *number > made)
    }
}

/// Speed of the solver and of the playback.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pace {
    /// Wall-clock time per time step taken \[s\]; `None` for solvers without steps, and until it
    /// is measured.
    pub step_s: Option<f64>,
    /// Fraction of the time steps that was skipped in blocks, 0 to 1; `None` for solvers without
    /// steps.
    pub skipped: Option<f64>,
    /// Wall-clock time of the whole run to `solver.end_s` \[s\]; `None` until it is complete.
    pub run_s: Option<f64>,
    /// Rate reached by the playback, simulated time per wall-clock time; `None` if it is not known.
    pub reached: Option<f64>,
    /// Why the playback is slower than requested.
    pub limit: Limit,
}

/// What limits the rate of the playback.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Limit {
    /// The playback is as fast as requested.
    #[default]
    None,
    /// The solver is too slow.
    Solver,
    /// At the requested rate the wave would turn too far between two frames and seem to run
    /// backward.
    Wave,
}

/// Wall-clock time after which the full run is given up. The playback continues.
pub const FORECAST_LIMIT: Duration = Duration::from_secs(20);

/// Wall-clock time for which the engine computes before it looks at the next order.
pub const SLICE: Duration = Duration::from_millis(5);

/// State of the full run.
#[derive(Clone, Debug, PartialEq)]
pub enum FullRunState {
    /// Being computed; the finished fraction, 0 to 1.
    Computing(f64),
    /// Given up at this fraction, because it takes too long.
    GivenUp(f64),
    /// Complete, with its result.
    Done(Arc<FullRun>),
}

/// The run to `solver.end_s`, computed ahead of the playback.
#[derive(Clone, Debug, PartialEq)]
pub struct FullRun {
    /// The first changes of contact of the run, in order of time.
    pub marks: Vec<Mark>,
    /// The longest hold of a corner that ended during the run; `None` if no hold of at least a
    /// period of the casing ended.
    pub broken: Option<Hold>,
    /// Simulated time since which a corner is held at the end \[s\]; `None` if none is.
    pub locked_s: Option<f64>,
    /// What the headline says of the run alone.
    pub facts: Facts,
}

/// The curves of one page at the page's own zoom, up to the end of the run.
#[derive(Clone, Debug)]
pub struct PageRecord {
    /// Start and end of the page, in simulated time \[s\].
    pub page: (f64, f64),
    /// Bins of the page, as far as they are computed.
    pub bins: Vec<Bin>,
    /// Whether the whole page is computed.
    pub is_whole: bool,
}

/// The state of a motion at one time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moment {
    /// Coordinates and velocities of casing and blades, and their time.
    pub state: State,
    /// Rotor angle \[rad\].
    pub angle: f64,
    /// Rotor speed \[rad/s\].
    pub speed: f64,
    /// Sides of the polygon in contact.
    pub active_set: ActiveSet,
    /// Simulated time at which the sides in contact last changed \[s\].
    pub since: f64,
    /// Gap between the casing and the tip of every blade; positive is open \[m\].
    pub gaps: Vec<f64>,
    /// Sides in contact and their mean multipliers; negative pushes \[N\].
    pub multipliers: Vec<(u32, f64)>,
    /// The solver's message on why the motion stopped; `None` if it can go on.
    pub failure: Option<String>,
}

impl Moment {
    /// Captures the current state of a motion; forces are instantaneous.
    pub fn of(motion: &Motion) -> Self {
        let (state, log) = (motion.state(), motion.contacts());
        Self {
            state,
            angle: motion.rotor().angle(state.t_s),
            speed: motion.rotor().speed(state.t_s),
            active_set: log.active_set,
            since: log.since,
            gaps: motion.blade_gaps(),
            multipliers: motion.multipliers(),
            failure: motion.stopped(),
        }
    }
}

/// A verdict with its scene, which may be older than the current one.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The scene that was run.
    pub scene: CheckedScene,
    /// Its verdict.
    pub verdict: Verdict,
}

/// A study that has been running for a while.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Working {
    /// The view that shows its result.
    pub view: ViewId,
    /// Wall-clock time since it began, in whole seconds.
    pub seconds: u64,
}

/// Result of the sensitivity check: whether a tiny change of the input changes the verdict.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sensitive {
    /// Not known yet, or not requested.
    #[default]
    Unknown,
    /// The outcome of the changed runs.
    Known(Certainty),
    /// Given up, because it takes too long.
    GivenUp,
}

/// Results of the studies, one per view; `None` until a study has a first result.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// Locked motion against rotor speed.
    pub locked: Option<Arc<LockedCurves>>,
    /// Spectrum of the run.
    pub spectrum: Option<Arc<Spectrum>>,
    /// Waves near the coincidence; the inner `None` says that there is no coincidence.
    pub coincidence: Option<Arc<Option<CoincidenceCurves>>>,
    /// The margins; searched limits arrive later than closed-form ones.
    pub margins: Option<Arc<LiveMargins>>,
    /// The run of the map cell under the cursor.
    pub cell: Option<Arc<CellRun>>,
    /// The map; its cells arrive one by one.
    pub map: Option<Arc<LiveMap>>,
    /// Speed against error of the solvers; its rows arrive one by one.
    pub precision: Option<Arc<Precision>>,
}

impl Sensitive {
    /// Returns the known outcome, or the default (nothing known).
    pub fn known(self) -> Certainty {
        match self {
            Self::Known(certainty) => certainty,
            Self::Unknown | Self::GivenUp => Certainty::default(),
        }
    }
}

/// Results for one film; `None` for what is not known yet or not wanted.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// The run to `solver.end_s`.
    pub full_run: Option<FullRunState>,
    /// The verdict, which may be proved before the run is complete.
    pub verdict: Option<Verdict>,
    /// The latest known verdict, possibly of an older scene.
    pub answer: Option<Arc<Answer>>,
    /// Whether a tiny change of the pulse, the speed or the motion changes the verdict.
    pub sensitive: Sensitive,
    /// Verdict of the reference run: the event solver with push-only contact on the same scene.
    pub reference: Option<Verdict>,
    /// The run under the other contact law.
    pub comparison: Option<Arc<FullRun>>,
    /// Results of the studies.
    pub found: Found,
    /// The studies that have been running for a while.
    pub working: Vec<Working>,
    /// Curves of the page on the screen.
    pub page: Option<Arc<PageRecord>>,
    /// Curves of the same page under the other contact law.
    pub comparison_page: Option<Arc<PageRecord>>,
    /// Curves of the same page of the pinned run.
    pub pinned_page: Option<Arc<PageRecord>>,
    /// Speed of the solver and of the playback.
    pub pace: Pace,
}

/// What the engine reports to the screen.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// Number of the film to which the results belong.
    pub number: u64,
    /// Number of the run to which the instant belongs.
    pub run: u64,
    /// Simulated time played to \[s\].
    pub t_s: f64,
    /// The instant shown: that of the cursor, or the one played to; `None` until there is one. While
    /// another instant is computed it is the previous one.
    pub moment: Option<Arc<Moment>>,
    /// Number of the last move that was made.
    pub moved: u64,
    /// Number of the latest move to a change of contact, and the change it met; `None` if it met
    /// none.
    pub met: (u64, Option<Mark>),
    /// Results for this film.
    pub results: Results,
    /// Message on an internal error of the engine; `None` if it works.
    pub trouble: Option<String>,
}

/// The solver in its own thread, or a stand-in for tests.
pub trait Engine {
    /// Replaces the current order.
    fn order(&mut self, order: &Order);
    /// Returns the latest snapshot; `None` if it was returned before or there is none.
    fn take(&mut self) -> Option<Snapshot>;
    /// Reports that a frame was drawn. The turn of the wave per frame limits the playback rate.
    fn drawn(&mut self) {}
}

/// Called by the engine when a new snapshot is ready.
pub type Waker = Arc<dyn Fn() + Send + Sync>;
