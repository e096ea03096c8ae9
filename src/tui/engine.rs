//! Messages between the screen and the solver. The screen sends orders, and
//! only the latest counts; the engine answers with snapshots. Both contain the
//! generation of the knobs.

use std::sync::Arc;
use std::time::Duration;

use super::history::{Bin, BinHistory};
use super::trace::{Mark, Trace};
use super::views::coincidence::curves::CoincidenceCurves;
use super::views::id::ViewId;
use super::views::locked::curves::LockedCurves;
use super::views::map::plan::{CellRun, LiveMap, MapChoice};
use super::views::margins::live::LiveMargins;
use super::views::spectrum::lines::Spectrum;
use rubscope_solver::motion::{
    ActiveSet, Certainty, Checks, Failure, Hold, Motion, State, Verdict,
};
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::study::MapPlan;
use rubscope_solver::study::precision::Precision;

/// The task of the engine. Counters only grow, so that no key press is lost
/// when an order replaces an older one.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// The scene with the current values of the knobs.
    pub scene: CheckedScene,
    /// Number of restarts of the run.
    pub restarts: u64,
    /// Number of live changes of the running motion.
    pub changes: u64,
    /// Number of requests for a single step.
    pub steps: u64,
    /// Number of requests to go to `go_to_s`.
    pub goes: u64,
    /// Instant to which the motion goes at once, also after a restart \[s\].
    pub go_to_s: f64,
    /// Number of requests to jump to the next change of contact.
    pub jumps: u64,
    /// Number of times the pulse was fired again.
    pub pulses: u64,
    /// Whether time passes.
    pub playing: bool,
    /// Number of times the user went on after the end of the run.
    pub extensions: u64,
    /// Simulated time per wall-clock time: 5e-3 plays five milliseconds per second.
    pub rate: f64,
    /// Length of one recorded bin \[s\].
    pub bin_s: f64,
    /// The page on the screen, from and to \[s\].
    pub page: (f64, f64),
    /// Whether to run the other contact law too, for comparison.
    pub compare: bool,
    /// Whether the motion slows down at changes of contact and hurries between.
    pub slow_at_events: bool,
    /// The instant to compute again, for the reading cursor \[s\].
    pub cursor_s: Option<f64>,
    /// The views on the screen: their studies are computed.
    pub open: Vec<ViewId>,
    /// Axes and contact law of the map.
    pub map: MapChoice,
    /// Column and row of the map's cell whose run is wanted.
    pub cell: Option<[u32; 2]>,
    /// The speeds that the survey is of \[rad/s\].
    pub range: Option<[f64; 2]>,
}

impl Order {
    /// Returns whether a view is on the screen.
    pub fn shows(&self, view: ViewId) -> bool {
        self.open.contains(&view)
    }

    /// Returns the map to compute, while its view is open and the scene has one.
    pub fn map_plan(&self) -> Option<MapPlan> {
        self.shows(ViewId::Map).then(|| self.map.plan(&self.scene).ok()).flatten()
    }

    /// Returns the number of the knobs' state: grows with every restart, live change and pulse.
    pub fn generation(&self) -> u64 {
        generation(self.restarts, self.changes, self.pulses)
    }
}

/// Returns the generation of the knobs after so many restarts, live changes and pulses.
pub fn generation(restarts: u64, changes: u64, pulses: u64) -> u64 {
    restarts + changes + pulses
}

/// Speed of the solver.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pace {
    /// Wall-clock time over the number of steps taken, if the solver has steps
    /// \[s\].
    pub step_s: Option<f64>,
    /// The part of the steps that was skipped, many at once.
    pub skipped: Option<f64>,
    /// Wall-clock time of the whole run to `solver.end_s` \[s\].
    pub run_s: Option<f64>,
    /// Motion over wall-clock time, as reached.
    pub reached: Option<f64>,
    /// Reason why the motion plays slower than requested.
    pub limit: Limit,
}

/// Limit of the rate of play.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Limit {
    /// Nothing.
    #[default]
    None,
    /// The solver is too slow.
    Solver,
    /// The wave would turn too far between two frames to be seen travelling.
    Wave,
}

/// Wall time after which the full run is given up: nobody waits longer for it,
/// and the motion itself goes on.
pub const FORECAST_LIMIT: Duration = Duration::from_secs(20);

/// Progress of the full run.
#[derive(Clone, Debug, PartialEq)]
pub enum FullRunState {
    /// The finished part of the run, 0 to 1.
    Computing(f64),
    /// Given up at this part: it takes too long.
    GivenUp(f64),
    /// Done.
    Done(Box<FullRun>),
}

/// The result of the run to `solver.end_s`, computed ahead of the playback.
#[derive(Clone, Debug, PartialEq)]
pub struct FullRun {
    /// The coordinates over the run.
    pub trace: Arc<Trace>,
    /// Changes of contact, in order of time, the first of them.
    pub marks: Arc<Vec<Mark>>,
    /// The longest hold of a corner that ended on the way, if it was as long as a
    /// casing period, and the rotor speed when it ended \[rad/s\].
    pub broken: Option<(Hold, f64)>,
    /// Rotor speed at which a run-up (true) or run-down came to its last contact \[rad/s\].
    pub caught: Option<(f64, bool)>,
    /// Verdict of the run.
    pub verdict: Verdict,
    /// Start of the final contact \[s\].
    pub since: Option<f64>,
    /// Sides in contact and their multipliers; negative is a push \[N\].
    pub multipliers: Vec<(u32, f64)>,
    /// Impacts in all.
    pub impacts: u64,
    /// Penetration, pulls and other checks.
    pub checks: Checks,
    /// Reason of a failure of the run, in the words of the solver.
    pub stopped: Option<String>,
    /// Reason of a failure of the run.
    pub failure: Option<Failure>,
}

/// A page of time, recorded at its own zoom as far as the run goes.
#[derive(Clone, Debug)]
pub struct PageRecord {
    /// Start and end \[s\].
    pub page: (f64, f64),
    /// Its bins.
    pub record: BinHistory,
}

/// The motion of one solver at one instant.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Moment {
    /// Coordinates and rates.
    pub state: State,
    /// Rotor angle \[rad\].
    pub angle: f64,
    /// Rotor speed \[rad/s\].
    pub speed: f64,
    /// Sides in contact.
    pub active_set: ActiveSet,
    /// Start of this contact \[s\].
    pub since: f64,
    /// Gap of every blade; positive is open \[m\].
    pub gaps: Vec<f64>,
    /// Sides and their mean multipliers; negative is a push \[N\].
    pub multipliers: Vec<(u32, f64)>,
    /// Reason why the motion stopped.
    pub failure: Option<String>,
    /// The latest jump to a change of contact: its number, and what it found.
    pub met: (u64, Option<Mark>),
    /// Number of times that the motion has come to the end of its forecast, where it waits.
    pub ends: u64,
}

impl Moment {
    /// Creates the instant at which a motion is; forces are those of this instant.
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
            ..Self::default()
        }
    }
}

/// The verdict of a scene, which may be an older one.
#[derive(Clone, Debug, PartialEq)]
pub struct Answer {
    /// The scene.
    pub scene: CheckedScene,
    /// Its verdict.
    pub verdict: Verdict,
}

/// A study that takes long.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Working {
    /// The view that shows it.
    pub view: ViewId,
    /// Completed part, 0 to 1, where that is known.
    pub part: Option<f64>,
    /// Seconds since it began.
    pub seconds: u64,
}

/// Whether a tiny change changes the outcome.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Sensitive {
    /// Not known yet, or not requested.
    #[default]
    Unknown,
    /// What changed runs say.
    Known(Certainty),
    /// Given up: it takes too long.
    GivenUp,
}

/// Results of the studies of the views.
#[derive(Clone, Debug, Default)]
pub struct Found {
    /// The locked motion against speed.
    pub locked: Option<Arc<LockedCurves>>,
    /// The spectrum of the run.
    pub spectrum: Option<Arc<Spectrum>>,
    /// Waves at the coincidence; an inner `None` where there is none.
    pub coincidence: Option<Arc<Option<CoincidenceCurves>>>,
    /// The margins; what is searched arrives later.
    pub margins: Option<Arc<LiveMargins>>,
    /// The run of the map's cell that was asked for.
    pub cell: Option<Arc<CellRun>>,
    /// The map; cells arrive one by one.
    pub map: Option<Arc<LiveMap>>,
    /// Speed against error; rows arrive one by one.
    pub precision: Option<Arc<Precision>>,
}

impl Sensitive {
    /// Returns what changed runs say, as far as it is known.
    pub fn known(self) -> Certainty {
        match self {
            Self::Known(certainty) => certainty,
            Self::Unknown | Self::GivenUp => Certainty::default(),
        }
    }
}

/// Results for one generation of the knobs.
#[derive(Clone, Debug, Default)]
pub struct Results {
    /// The run to the scene's end.
    pub full_run: Option<FullRunState>,
    /// Its verdict, which may be proved before its end.
    pub verdict: Option<Verdict>,
    /// The latest verdict there is, of this scene or of an older one.
    pub answer: Option<Arc<Answer>>,
    /// The end of that run \[s\].
    pub end_s: f64,
    /// Whether a tiny change of the pulse, the speed or the motion changes the outcome.
    pub sensitive: Sensitive,
    /// The event solver under unilateral contact, on the same scene.
    pub reference: Option<FullRun>,
    /// The same scene under the other contact law.
    pub comparison: Option<FullRun>,
    /// Results of the studies of the views.
    pub found: Found,
    /// The studies that take long.
    pub working: Vec<Working>,
    /// The page on the screen.
    pub page: Option<Arc<PageRecord>>,
    /// The same under the other contact law.
    pub comparison_page: Option<Arc<PageRecord>>,
    /// Solver speed.
    pub pace: Pace,
    /// Live changes and pulses so far, as `run --at` takes them: when \[s\], what.
    pub applied: Vec<(f64, String)>,
    /// The motion at the reading cursor, computed for that instant.
    pub reading: Option<Arc<Moment>>,
}

/// State of the engine at one instant of wall time.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// Generation of the knobs this belongs to.
    pub generation: u64,
    /// The run that the bins belong to.
    pub restarts: u64,
    /// The latest state of the motion that is played.
    pub moment: Option<Moment>,
    /// Bins recorded since the last snapshot.
    pub bins: Vec<Bin>,
    /// The same for the motion under the other contact law.
    pub comparison_bins: Vec<Bin>,
    /// Results for the scene of this generation.
    pub results: Results,
    /// The reason if the engine itself failed.
    pub trouble: Option<String>,
}

/// A solver in the background, or a replacement for tests.
pub trait Engine {
    /// Replaces what is wanted.
    fn order(&mut self, order: &Order);
    /// Returns the new snapshot, if there is one.
    fn take(&mut self) -> Option<Snapshot>;
    /// Tells the engine that a frame has been drawn: a turning picture may turn on.
    fn drawn(&mut self) {}
}

/// Called by the engine when a new snapshot can be taken.
pub type Waker = Arc<dyn Fn() + Send + Sync>;
