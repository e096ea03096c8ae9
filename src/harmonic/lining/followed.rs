//! A branch of steady states as it was followed over one parameter: its points, what
//! happens at some of them, and where it ends.

use serde::Serialize;
use strum::AsRefStr;

use super::LiningState;

/// What happens at a special point of a branch.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, AsRefStr)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Special {
    /// The branch turns back.
    Fold,
    /// It turns back in a corner: a group begins or ends to push on a lining without
    /// smoothing.
    Border,
    /// An oscillation begins or ends to grow.
    Hopf,
    /// A motion without frequency begins or ends to grow: another branch meets it.
    Branch,
}

/// One steady state of a branch.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BranchPoint {
    /// Value of the parameter, in its unit.
    pub parameter: f64,
    /// The state.
    pub state: LiningState,
    /// What happens here, if anything.
    pub special: Option<Special>,
}

/// Where a branch ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, AsRefStr)]
#[serde(rename_all = "snake_case")]
#[strum(serialize_all = "snake_case")]
pub enum BranchEnd {
    /// At the last value that was asked for.
    Reached,
    /// Back at the first value, after a fold.
    Returned,
    /// Nothing touches any more: the wave is gone.
    Gone,
    /// No next point was found.
    Lost,
    /// At the bound of work.
    Most,
}

/// A branch of steady states.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FollowedBranch {
    /// Dotted path of the parameter.
    pub path: &'static str,
    /// Its points, in order along the branch.
    pub points: Vec<BranchPoint>,
    /// Where it ends.
    pub end: BranchEnd,
}
