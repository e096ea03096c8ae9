//! What the screen and the solver tell each other. The screen states what it
//! wants as one value, the latest one counts; the engine answers with
//! snapshots that carry the generation of the knobs they belong to.

use std::sync::Arc;

use super::history::Bin;
use super::locked_curve::LockedCurves;
use super::spectrum::Spectrum;
use crate::motion::{Checks, State, Touching, Verdict};
use crate::scene::CheckedScene;
use crate::study::Map;
use crate::study::precision::Precision;

/// Everything the screen wants. Counters only ever grow, so that an order
/// that replaces another loses none of its presses.
#[derive(Clone, Debug, PartialEq)]
pub struct Order {
    /// The scene as the knobs have it.
    pub scene: CheckedScene,
    /// How often the run was begun anew.
    pub restarts: u64,
    /// How often a knob acted on the running motion.
    pub changes: u64,
    /// How often a single step was asked for.
    pub steps: u64,
    /// How often a jump to the next change of contact was asked for.
    pub jumps: u64,
    /// How often the pulse was fired again.
    pub pulses: u64,
    /// Whether time passes.
    pub playing: bool,
    /// Motion per wall-clock time: 5e-3 plays five milliseconds a second.
    pub rate: f64,
    /// Length of one recorded bin \[s\].
    pub bin_s: f64,
    /// Whether to run the other contact law beside this one.
    pub beside: bool,
    /// What the open views need.
    pub wants: Wants,
}

/// Studies that are computed only while their view is open.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wants {
    /// The spectrum of the run.
    pub spectrum: bool,
    /// The map over speed and pulse.
    pub map: bool,
    /// Speed against error.
    pub precision: bool,
}

impl Order {
    /// Number of the knobs' state: grows with every restart and live change.
    #[must_use]
    pub fn generation(&self) -> u64 {
        self.restarts + self.changes
    }
}

/// How fast the solver is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Pace {
    /// Wall-clock time of one step, where the solver steps \[s\].
    pub step_s: Option<f64>,
    /// Wall-clock time of the whole run to `solver.end_s` \[s\].
    pub run_s: Option<f64>,
    /// Whether the motion plays slower than asked, the solver being at its limit.
    pub limited: bool,
}

/// The run to the scene's end, computed ahead of what is played.
#[derive(Clone, Debug, PartialEq)]
pub enum Ahead {
    /// Under way: the part of the run that is done, 0 to 1.
    Computing(f64),
    /// Done.
    Done(Forecast),
}

/// What the run comes to at `solver.end_s`.
#[derive(Clone, Debug, PartialEq)]
pub struct Forecast {
    /// How the motion lasts.
    pub verdict: Verdict,
    /// Since when the final contact holds without a change \[s\].
    pub since: Option<f64>,
    /// Sides in contact and their multipliers; negative is a push \[N\].
    pub multipliers: Vec<(u32, f64)>,
    /// Amplitude at the end \[m\].
    pub amplitude: f64,
    /// Impacts in all.
    pub impacts: u64,
    /// What was kept watch on.
    pub checks: Checks,
    /// Why the run failed.
    pub failure: Option<String>,
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
    pub touching: Touching,
    /// Since when \[s\].
    pub since: f64,
    /// Impacts so far.
    pub impacts: u64,
    /// Gap of every blade; positive is open \[m\].
    pub gaps: Vec<f64>,
    /// Sides and their mean multipliers; negative is a push \[N\].
    pub multipliers: Vec<(u32, f64)>,
    /// What was kept watch on.
    pub checks: Checks,
    /// Whether no contact can ever come again.
    pub over: bool,
    /// Why the motion stopped.
    pub failure: Option<String>,
}

/// What the engine says.
#[derive(Clone, Debug, Default)]
pub struct Snapshot {
    /// Generation of the knobs this belongs to.
    pub generation: u64,
    /// Which run the bins belong to.
    pub restarts: u64,
    /// The motion played.
    pub moment: Moment,
    /// What was recorded since the last snapshot.
    pub bins: Vec<Bin>,
    /// The run ahead.
    pub ahead: Option<Ahead>,
    /// Whether a tiny change of the pulse changes the outcome under the event
    /// solver; false until it is known.
    pub sensitive: bool,
    /// The event solver under unilateral contact, on the same scene.
    pub reference: Option<Forecast>,
    /// The same scene under the other contact law.
    pub beside: Option<Forecast>,
    /// What was recorded of it since the last snapshot.
    pub beside_bins: Vec<Bin>,
    /// The locked motion against speed, once it is computed.
    pub locked: Option<Arc<LockedCurves>>,
    /// The spectrum of the run, while wanted.
    pub spectrum: Option<Arc<Spectrum>>,
    /// The map, while wanted; cells come one by one.
    pub map: Option<Arc<Map>>,
    /// Speed against error, while wanted; rows come one by one.
    pub precision: Option<Arc<Precision>>,
    /// Solver speed.
    pub pace: Pace,
    /// Something broke in the engine itself.
    pub trouble: Option<String>,
}

/// A solver in the background, or a stand-in for one.
pub trait Engine {
    /// Replaces what is wanted.
    fn order(&mut self, order: &Order);
    /// Takes what is new, if anything is.
    fn take(&mut self) -> Option<Snapshot>;
}

/// An engine that never answers, for screens without motion.
#[derive(Debug, Default)]
pub struct Silent;

impl Engine for Silent {
    fn order(&mut self, _: &Order) {}
    fn take(&mut self) -> Option<Snapshot> {
        None
    }
}

/// Called by the engine when something new can be taken.
pub type Nudge = Arc<dyn Fn() + Send + Sync>;
