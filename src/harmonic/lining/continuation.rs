//! A steady state on a lining followed while one parameter of the scene changes,
//! through folds: pseudo-arclength continuation, with bounded work
//! (docs/theory.md, section 10).
//!
//! A branch turns back in a fold. With `eps = 0` the law has a kink, and the branch turns
//! in a corner where a group of blades begins or ends to push (a border collision). The
//! sense along a branch is that of the minors of its two equations, which stays the same
//! over both.

use nalgebra::{Matrix3, Vector2, Vector3};
use serde::Serialize;
use strum::AsRefStr;

use super::states::Balance;
use super::{Lining, LiningState};
use crate::harmonic::HarmonicError;
use crate::scene::{Allowed, Scene, Value, keys};
use crate::tolerances::{
    FOLLOW_DIFFERENCE, FOLLOW_HALVINGS, FOLLOW_POINTS, FOLLOW_SETTLED, FOLLOW_STEPS, FOLLOW_STRIDE,
};

/// A place: `[Re w, Im w]` over a length, and the part of the way of the parameter.
type Place = Vector3<f64>;

struct Follow<'a> {
    scene: &'a Scene,
    key: &'static keys::Key,
    from: f64,
    to: f64,
    length: f64,
    /// Sense along the branch.
    sense: f64,
}

/// Follows a steady state of a scene on a lining while one parameter goes `from` a value
/// `to` another: the stable state that pushes with the fewest groups, or rest where all
/// blades push at rest.
///
/// # Errors
/// A path of no real number, values that are not allowed, no such state at the first, or
/// a machine whose blades do not share one wave.
pub fn follow(
    scene: &Scene,
    path: &str,
    [from, to]: [f64; 2],
) -> Result<FollowedBranch, HarmonicError> {
    let key = keys::find(path).map_err(|error| HarmonicError::Scene(error.to_string()))?;
    if !matches!(key.allowed, Allowed::Real { .. }) {
        let allowed = "a key whose values are numbers that need not be whole".to_string();
        return Err(HarmonicError::Refused { key: "--follow", value: path.to_string(), allowed });
    }
    let mut follow = Follow { scene, key, from, to, length: 1.0, sense: 1.0 };
    if from == to {
        let allowed = "two different values".to_string();
        return Err(HarmonicError::Refused {
            key: "--over",
            value: format!("{from}:{to}"),
            allowed,
        });
    }
    // Both ends must be scenes.
    follow.scene_at(0.0)?;
    follow.scene_at(1.0)?;
    let states = follow.with(0.0, |balance| {
        balance.lining.states(balance.speed()).map(|states| (states, balance.length()))
    })?;
    let (states, length) = states?;
    follow.length = length;
    let held = states.iter().find(|state| state.stable && state.pushing > 0);
    let Some(start) = held.or_else(|| states.iter().find(|state| state.pushing > 0)) else {
        return Err(HarmonicError::Refused {
            key: key.path,
            value: from.to_string(),
            allowed: "a first value with a steady state whose blades push".to_string(),
        });
    };
    let start = Place::new(start.gap_m[0] / length, start.gap_m[1] / length, 0.0);
    follow.run(start)
}

impl Follow<'_> {
    fn parameter(&self, part: f64) -> f64 {
        // The last value is exact.
        if part == 1.0 { self.to } else { self.from + (self.to - self.from) * part }
    }

    fn scene_at(&self, part: f64) -> Result<Scene, HarmonicError> {
        let mut scene = self.scene.clone();
        let value = Value::Real(self.parameter(part));
        scene
            .set_value(self.key, value)
            .and_then(|()| scene.clone().checked().map(|_| scene))
            .map_err(|error| HarmonicError::Scene(error.to_string()))
    }

    /// Something of the equations at a part of the way.
    fn with<T>(&self, part: f64, of: impl FnOnce(&Balance) -> T) -> Result<T, HarmonicError> {
        let mut scene = self.scene.clone();
        scene
            .set_value(self.key, Value::Real(self.parameter(part)))
            .map_err(|error| HarmonicError::Scene(error.to_string()))?;
        let machine = scene.machine();
        let lining = Lining::of(&machine, &scene.contact)?;
        Ok(of(&Balance::at(lining, scene.operation.speed_rad_s)))
    }

    /// The residual, over the length, and its two rows of derivatives.
    fn rows(&self, at: Place) -> Option<(Vector2<f64>, [Vector3<f64>; 2])> {
        let w = Vector2::new(at.x, at.y) * self.length;
        let residual = |part: f64| self.with(part, |balance| balance.residual(w)).ok();
        let (here, slope) = residual(at.z)?;
        let ends = [at.z - FOLLOW_DIFFERENCE, at.z + FOLLOW_DIFFERENCE];
        // One-sided at the bound of a key.
        let change = match ends.map(residual) {
            [Some((low, _)), Some((high, _))] => (high - low) / (2.0 * FOLLOW_DIFFERENCE),
            [Some((low, _)), None] => (here - low) / FOLLOW_DIFFERENCE,
            [None, Some((high, _))] => (high - here) / FOLLOW_DIFFERENCE,
            [None, None] => return None,
        } / self.length;
        let row = |k: usize| Vector3::new(slope[(k, 0)], slope[(k, 1)], change[k]);
        Some((here / self.length, [row(0), row(1)]))
    }

    /// Direction of the branch at a place.
    fn tangent(&self, at: Place) -> Option<Place> {
        let (_, [first, second]) = self.rows(at)?;
        let along = first.cross(&second) * self.sense;
        let size = along.norm();
        (size > 0.0 && size.is_finite()).then(|| along / size)
    }

    /// The place of the branch in the plane across `along` through `guess`.
    fn settle(&self, guess: Place, along: Place) -> Option<Place> {
        let mut at = guess;
        for _ in 0..FOLLOW_STEPS {
            let (residual, [first, second]) = self.rows(at)?;
            let across = along.dot(&(at - guess));
            let matrix =
                Matrix3::from_rows(&[first.transpose(), second.transpose(), along.transpose()]);
            let step = matrix.lu().solve(&Vector3::new(residual.x, residual.y, across))?;
            at -= step;
            let size = step.norm();
            if !size.is_finite() || size > 1.0 {
                return None;
            }
            if size <= FOLLOW_SETTLED * (1.0 + at.norm()) {
                return Some(at);
            }
        }
        None
    }

    /// The next place of the branch, an arc of `stride` away, if it goes on alike.
    fn next(&self, here: Place, along: Place, stride: f64) -> Option<(Place, Place)> {
        let place = self.settle(here + along * stride, along)?;
        let ahead = self.tangent(place)?;
        let alike = (place - here).norm() <= 2.0 * stride;
        (alike && ahead.dot(&along) > 0.8).then_some((place, ahead))
    }

    fn state(&self, at: Place) -> Result<LiningState, HarmonicError> {
        let w = Vector2::new(at.x, at.y) * self.length;
        self.with(at.z, |balance| balance.state(w))?
    }

    fn point(&self, at: Place, special: Option<Special>) -> Result<BranchPoint, HarmonicError> {
        Ok(BranchPoint { parameter: self.parameter(at.z), state: self.state(at)?, special })
    }

    /// The place with the parameter at an end, near another.
    fn at_end(&self, near: Place, part: f64) -> Option<Place> {
        let w = Vector2::new(near.x, near.y) * self.length;
        let w = self.with(part, |balance| balance.solve(w)).ok().flatten()? / self.length;
        Some(Place::new(w.x, w.y, part))
    }

    fn run(&mut self, start: Place) -> Result<FollowedBranch, HarmonicError> {
        let lost = |points| FollowedBranch { path: self.key.path, points, end: BranchEnd::Lost };
        let Some(first) = self.tangent(start) else { return Ok(lost(Vec::new())) };
        let turn = if first.z < 0.0 { -1.0 } else { 1.0 };
        let mut points = vec![self.point(start, None)?];
        self.sense = turn;
        let (mut here, mut along, mut stride) = (start, first * turn, FOLLOW_STRIDE[1]);
        let mut end = BranchEnd::Most;
        for _ in 0..FOLLOW_POINTS {
            let step = self.step(here, along, &mut stride);
            let Some((place, ahead, cornered)) = step else {
                end = BranchEnd::Lost;
                break;
            };
            if place.z >= 1.0 || place.z <= 0.0 {
                let part = if place.z >= 1.0 { 1.0 } else { 0.0 };
                let share = (part - here.z) / (place.z - here.z);
                let last = self.at_end(here + (place - here) * share.clamp(0.0, 1.0), part);
                if let Some(last) = last {
                    self.mark(here, along, last, &mut points)?;
                    points.push(self.point(last, None)?);
                }
                end = if part == 1.0 { BranchEnd::Reached } else { BranchEnd::Returned };
                break;
            }
            if cornered && ahead.z * along.z < 0.0 {
                points.push(self.point(here, Some(self.turned()))?);
            } else {
                self.mark(here, along, place, &mut points)?;
            }
            let next = self.point(place, None)?;
            let gone = next.state.pushing == 0;
            points.push(next);
            if gone {
                end = BranchEnd::Gone;
                break;
            }
            (here, along) = (place, ahead);
        }
        Ok(FollowedBranch { path: self.key.path, points, end })
    }

    /// How a branch turns back on this lining.
    fn turned(&self) -> Special {
        if self.scene.contact.smoothing_m > 0.0 { Special::Fold } else { Special::Border }
    }

    /// One step, shorter where the branch bends; over a corner of it along what is
    /// behind the corner. Last: whether it is one.
    fn step(
        &mut self,
        here: Place,
        along: Place,
        stride: &mut f64,
    ) -> Option<(Place, Place, bool)> {
        let [least, most] = FOLLOW_STRIDE;
        while *stride >= least {
            if let Some((place, ahead)) = self.next(here, along, *stride) {
                *stride = (1.5 * *stride).min(most);
                return Some((place, ahead, false));
            }
            *stride *= 0.5;
        }
        for reach in [4.0, 64.0, 1024.0].map(|part| part * least) {
            *stride = reach;
            for sense in [self.sense, -self.sense] {
                let kept = self.sense;
                self.sense = sense;
                // Behind the corner the other law holds.
                let behind = self.tangent(here + along * reach);
                if let Some(behind) =
                    behind.filter(|behind| sense == kept || behind.dot(&along) > 0.0)
                    && let Some(place) = self.settle(here + behind * reach, behind)
                    && (place - here).norm() <= 3.0 * reach
                    && (place - here).dot(&behind) > 0.0
                    && let Some(ahead) = self.tangent(place)
                {
                    return Some((place, ahead, true));
                }
                self.sense = kept;
            }
        }
        None
    }

    /// Adds the special point between two neighbours of a branch, if there is one.
    fn mark(
        &self,
        here: Place,
        along: Place,
        next: Place,
        points: &mut Vec<BranchPoint>,
    ) -> Result<(), HarmonicError> {
        let Some(last) = points.last() else { return Ok(()) };
        let (before, after) = (last.state.stable, self.state(next)?.stable);
        let ahead = self.tangent(next).unwrap_or(along);
        let folds = along.z * ahead.z < 0.0;
        if !folds && before == after {
            return Ok(());
        }
        let changed = |place: Place| -> Option<bool> {
            if folds {
                return Some(self.tangent(place)?.z * along.z <= 0.0);
            }
            Some(self.state(place).ok()?.stable != before)
        };
        let whole = (next - here).dot(&along);
        let (mut near, mut far, mut found) = (0.0, whole, next);
        for _ in 0..FOLLOW_HALVINGS {
            let middle = 0.5 * (near + far);
            let Some(place) = self.settle(here + along * middle, along) else { break };
            match changed(place) {
                Some(true) => (far, found) = (middle, place),
                Some(false) => near = middle,
                None => break,
            }
        }
        let mut point = self.point(found, None)?;
        point.special = Some(if folds {
            self.turned()
        } else if point.state.frequency_rad_s > 0.0 {
            Special::Hopf
        } else {
            Special::Branch
        });
        points.push(point);
        Ok(())
    }
}

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
