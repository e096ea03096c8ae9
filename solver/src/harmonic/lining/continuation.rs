//! A steady state on a lining followed while one parameter of the scene changes,
//! through folds: pseudo-arclength continuation, with bounded work
//! (docs/theory.md, section 10).
//!
//! The two equations `F(w, q) = 0` of the place `w` of the gaps and the part `q` of the way
//! of the parameter are a curve in three dimensions. Its direction is `dF_1 x dF_2`, the
//! minors of the derivatives by `w` and `q`. A step goes along it, and Newton's method comes
//! back to the curve in the plane across: `F = 0`, `along . (place - guess) = 0`.
//!
//! A branch turns back in a fold. With `eps = 0` the law has a kink, and the branch turns
//! in a corner where a group of blades begins or ends to push (a border collision). The
//! sense along a branch is that of the minors, which stays the same over both.

use nalgebra::{Matrix3, Vector2, Vector3};
use serde::Serialize;
use strum::AsRefStr;

use super::states::Balance;
use super::{Lining, LiningState};
use crate::harmonic::HarmonicError;
use crate::numeric::bisection::try_bisected;
use crate::scene::{Allowed, Scene, Value, keys};
use crate::tolerances::{
    AS_ZERO, FOLLOW_DIFFERENCE, FOLLOW_OVER_A_CORNER, FOLLOW_POINTS, FOLLOW_STEPS, FOLLOW_STRIDE,
};

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

/// Follows a steady state of a scene on a lining while one parameter goes `from` a value
/// `to` another: the stable state that pushes with the fewest groups, or rest where all
/// blades push at rest.
///
/// # Errors
/// A path of no real number, values that are not allowed, no such state at the first, or
/// a machine whose blades do not share one wave.
pub fn follow(scene: &Scene, path: &str, ends: [f64; 2]) -> Result<FollowedBranch, HarmonicError> {
    let mut way = Way::of(scene, path, ends)?;
    let start = way.start()?;
    way.walk(start)
}

/// A place on a branch: `[Re w, Im w]` over a length, and the part of the way of the
/// parameter.
type Place = Vector3<f64>;

/// A place on a branch, and how to go on from there.
#[derive(Clone, Copy, Debug)]
struct Stand {
    place: Place,
    /// Direction of the branch.
    along: Place,
    /// The sign with which the minors point along it.
    sense: f64,
    /// Arc to the next place.
    stride: f64,
    /// Whether the last step went over a corner of the branch.
    over_corner: bool,
}

/// The way of one key of a scene between two values, and the unit of lengths.
struct Way<'a> {
    scene: &'a Scene,
    key: &'static keys::Key,
    ends: [f64; 2],
    length: f64,
}

impl<'a> Way<'a> {
    fn of(scene: &'a Scene, path: &str, ends: [f64; 2]) -> Result<Self, HarmonicError> {
        let key = keys::find(path).map_err(|error| HarmonicError::Scene(error.to_string()))?;
        if !matches!(key.allowed, Allowed::Real { .. }) {
            let allowed = "a key whose values are numbers that need not be whole";
            return Err(HarmonicError::refused("followed key", path, allowed));
        }
        let [from, to] = ends;
        if from == to {
            let over = format!("{from}:{to}");
            return Err(HarmonicError::refused(key.path, over, "two different values"));
        }
        let way = Self { scene, key, ends, length: 1.0 };
        for end in [0.0, 1.0] {
            let scene = way.scene_at(end)?.checked();
            scene.map_err(|error| HarmonicError::Scene(error.to_string()))?;
        }
        Ok(way)
    }

    /// The state to start from, whose contact gives the unit of lengths.
    fn start(&mut self) -> Result<Place, HarmonicError> {
        let (states, length) = self.balance_at(0.0, |balance| {
            balance.lining.states(balance.speed()).map(|states| (states, balance.length()))
        })??;
        self.length = length;
        let pushing = || states.iter().filter(|state| state.pushing > 0);
        let Some(start) = pushing().find(|state| state.stable).or_else(|| pushing().next()) else {
            let allowed = "a first value with a steady state whose blades push";
            return Err(HarmonicError::refused(self.key.path, self.ends[0], allowed));
        };
        Ok(Place::new(start.gap_m[0] / length, start.gap_m[1] / length, 0.0))
    }

    fn parameter(&self, part: f64) -> f64 {
        let [from, to] = self.ends;
        // The last value is exact.
        if part == 1.0 { to } else { from + (to - from) * part }
    }

    fn scene_at(&self, part: f64) -> Result<Scene, HarmonicError> {
        let mut scene = self.scene.clone();
        scene
            .set_value(self.key, Value::Real(self.parameter(part)))
            .map_err(|error| HarmonicError::Scene(error.to_string()))?;
        Ok(scene)
    }

    /// Something of the equations at a part of the way.
    fn balance_at<T>(&self, part: f64, of: impl FnOnce(&Balance) -> T) -> Result<T, HarmonicError> {
        let scene = self.scene_at(part)?;
        let machine = scene.machine();
        let lining = Lining::of(&machine, &scene.contact)?;
        Ok(of(&Balance::at(&lining, scene.operation.speed_rad_s)))
    }

    /// The place of the gaps \[m\].
    fn gap(&self, at: Place) -> Vector2<f64> {
        Vector2::new(at.x, at.y) * self.length
    }

    fn state(&self, at: Place) -> Result<LiningState, HarmonicError> {
        self.balance_at(at.z, |balance| balance.state(self.gap(at)))?
    }

    fn point(&self, at: Place, special: Option<Special>) -> Result<BranchPoint, HarmonicError> {
        Ok(BranchPoint { parameter: self.parameter(at.z), state: self.state(at)?, special })
    }

    /// `F` over the length, and the derivatives of its two rows by the place.
    fn linearised(&self, at: Place) -> Option<(Vector2<f64>, [Vector3<f64>; 2])> {
        let w = self.gap(at);
        let residual = |part: f64| self.balance_at(part, |balance| balance.residual(w)).ok();
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
    fn direction(&self, at: Place, sense: f64) -> Option<Place> {
        let (_, [first, second]) = self.linearised(at)?;
        let along = first.cross(&second) * sense;
        let size = along.norm();
        (size > 0.0 && size.is_finite()).then(|| along / size)
    }

    /// The place of the branch in the plane across `along` through `guess`.
    fn settle(&self, guess: Place, along: Place) -> Option<Place> {
        let mut at = guess;
        for _ in 0..FOLLOW_STEPS {
            let (residual, [first, second]) = self.linearised(at)?;
            let across = along.dot(&(at - guess));
            let matrix =
                Matrix3::from_rows(&[first.transpose(), second.transpose(), along.transpose()]);
            let step = matrix.lu().solve(&Vector3::new(residual.x, residual.y, across))?;
            at -= step;
            let size = step.norm();
            if !size.is_finite() || size > 1.0 {
                return None;
            }
            if size <= AS_ZERO * (1.0 + at.norm()) {
                return Some(at);
            }
        }
        None
    }

    /// Goes along the branch from its start towards the second value.
    fn walk(&self, start: Place) -> Result<FollowedBranch, HarmonicError> {
        let ended = |points, end| Ok(FollowedBranch { path: self.key.path, points, end });
        let Some(first) = self.direction(start, 1.0) else {
            return ended(Vec::new(), BranchEnd::Lost);
        };
        let sense = if first.z < 0.0 { -1.0 } else { 1.0 };
        let (along, stride) = (first * sense, FOLLOW_STRIDE[1]);
        let mut here = Stand { place: start, along, sense, stride, over_corner: false };
        let mut points = vec![self.point(start, None)?];
        for _ in 0..FOLLOW_POINTS {
            let Some(next) = self.step(&here) else { return ended(points, BranchEnd::Lost) };
            if let Some((part, end)) = end_of_the_way(next.place) {
                if let Some(last) = self.place_at_end(here.place, next.place, part) {
                    let next = Stand { place: last, over_corner: false, ..next };
                    self.add(&mut points, &here, &next)?;
                }
                return ended(points, end);
            }
            self.add(&mut points, &here, &next)?;
            if points.last().is_some_and(|point| point.state.pushing == 0) {
                return ended(points, BranchEnd::Gone);
            }
            here = next;
        }
        ended(points, BranchEnd::Most)
    }

    /// The next place of the branch.
    fn step(&self, here: &Stand) -> Option<Stand> {
        self.smooth_step(here).or_else(|| self.step_over_corner(here))
    }

    /// A step to where the branch goes on alike, shorter where it bends.
    fn smooth_step(&self, here: &Stand) -> Option<Stand> {
        let [least, most] = FOLLOW_STRIDE;
        let mut stride = here.stride;
        while stride >= least {
            let place = self.settle(here.place + here.along * stride, here.along);
            let near = place.filter(|place| (place - here.place).norm() <= 2.0 * stride);
            let ahead = near.and_then(|place| Some((place, self.direction(place, here.sense)?)));
            if let Some((place, along)) = ahead.filter(|(_, along)| along.dot(&here.along) > 0.8) {
                let stride = (1.5 * stride).min(most);
                return Some(Stand { place, along, stride, over_corner: false, ..*here });
            }
            stride *= 0.5;
        }
        None
    }

    /// A step over a corner of the branch, along what is behind it, where the other law
    /// holds; the minors may turn round there.
    fn step_over_corner(&self, here: &Stand) -> Option<Stand> {
        for stride in FOLLOW_OVER_A_CORNER {
            for sense in [here.sense, -here.sense] {
                let behind = self.direction(here.place + here.along * stride, sense);
                let onward = |behind: &Place| sense == here.sense || behind.dot(&here.along) > 0.0;
                let Some(behind) = behind.filter(onward) else { continue };
                let place = self.settle(here.place + behind * stride, behind);
                let gone = |place: Place| place - here.place;
                let near = place.filter(|&place| {
                    gone(place).norm() <= 3.0 * stride && gone(place).dot(&behind) > 0.0
                });
                if let Some(place) = near
                    && let Some(along) = self.direction(place, sense)
                {
                    return Some(Stand { place, along, sense, stride, over_corner: true });
                }
            }
        }
        None
    }

    /// The place with the parameter at an end of the way, on the way from one to another.
    fn place_at_end(&self, here: Place, next: Place, part: f64) -> Option<Place> {
        let share = (part - here.z) / (next.z - here.z);
        let near = self.gap(here + (next - here) * share.clamp(0.0, 1.0));
        let w = self.balance_at(part, |balance| balance.solve(near)).ok().flatten()? / self.length;
        Some(Place::new(w.x, w.y, part))
    }

    /// Adds the next place, and before it the special point on the way there.
    fn add(
        &self,
        points: &mut Vec<BranchPoint>,
        here: &Stand,
        next: &Stand,
    ) -> Result<(), HarmonicError> {
        let point = self.point(next.place, None)?;
        if next.over_corner && next.along.z * here.along.z < 0.0 {
            points.push(self.point(here.place, Some(self.turn()))?);
        } else if let Some(last) = points.last() {
            let stable = [last.state.stable, point.state.stable];
            points.extend(self.special_between(here, next, stable)?);
        }
        points.push(point);
        Ok(())
    }

    /// How a branch turns back on this lining.
    fn turn(&self) -> Special {
        if self.scene.contact.smoothing_m > 0.0 { Special::Fold } else { Special::Border }
    }

    /// The special point between two places that are stable or not: where the parameter
    /// turns back, or else where stability changes.
    fn special_between(
        &self,
        here: &Stand,
        next: &Stand,
        [before, after]: [bool; 2],
    ) -> Result<Option<BranchPoint>, HarmonicError> {
        let ahead = self.direction(next.place, next.sense).unwrap_or(here.along);
        let turns = here.along.z * ahead.z < 0.0;
        if !turns && before == after {
            return Ok(None);
        }
        let mut found = next.place;
        let changed = |arc: f64| {
            let place = self.settle(here.place + here.along * arc, here.along)?;
            let changed = if turns {
                self.direction(place, next.sense)?.z * here.along.z <= 0.0
            } else {
                self.state(place).ok()?.stable != before
            };
            if changed {
                found = place;
            }
            Some(changed)
        };
        let mut changed = changed;
        let whole = (next.place - here.place).dot(&here.along);
        // Where no place is found between, the nearest that was is taken.
        let _ = try_bisected([0.0, whole], f64::EPSILON, |arc| changed(arc).ok_or(()));
        let mut point = self.point(found, None)?;
        point.special = Some(match point.state.frequency_rad_s {
            _ if turns => self.turn(),
            frequency if frequency > 0.0 => Special::Hopf,
            _ => Special::Branch,
        });
        Ok(Some(point))
    }
}

/// The end of the way that a place is at or beyond, and what that makes of the branch.
fn end_of_the_way(place: Place) -> Option<(f64, BranchEnd)> {
    if place.z >= 1.0 {
        Some((1.0, BranchEnd::Reached))
    } else if place.z <= 0.0 {
        Some((0.0, BranchEnd::Returned))
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::CheckedScene;

    fn scene(name: &str) -> CheckedScene {
        let lining = [
            ("solver.contact", "smooth"),
            ("contact.stiffness_n_per_m", "1e7"),
            ("contact.smoothing_m", "1e-6"),
        ];
        Scene::builtin(name).unwrap().with(&lining).unwrap()
    }

    fn special(branch: &FollowedBranch, special: Special) -> Vec<f64> {
        let those = branch.points.iter().filter(|point| point.special == Some(special));
        those.map(|point| point.parameter).collect()
    }

    #[test]
    fn a_branch_turns_back_in_its_fold_and_all_of_it_are_steady_states() {
        let scene = scene("paper-nd4");
        let branch = follow(&scene, "operation.speed_rad_s", [500.0, 280.0]).unwrap();
        assert_eq!(branch.end, BranchEnd::Returned);
        let ends = [branch.points.first(), branch.points.last()];
        assert_eq!(ends.map(|point| point.unwrap().parameter), [500.0, 500.0]);
        let [fold] = special(&branch, Special::Fold)[..] else { panic!("{branch:?}") };
        // The fold is the extreme of the parameter, far below what a step changes it by.
        assert!(branch.points.iter().all(|point| point.parameter > fold - 1e-9));
        let machine = scene.machine();
        let lining = Lining::of(&machine, &scene.contact).unwrap();
        let mut seen = 0;
        for point in branch.points.iter().filter(|point| point.parameter > fold + 1.0) {
            let alike = |state: &LiningState| {
                state.pushing == point.state.pushing
                    && (state.casing_m / point.state.casing_m - 1.0).abs() < 1e-8
            };
            seen += usize::from(lining.states(point.parameter).unwrap().iter().any(alike));
        }
        assert!(seen > 20, "{seen} of {}", branch.points.len());
    }

    #[test]
    fn rest_loses_its_stability_where_it_begins_to_grow() {
        let scene = scene("coincidence");
        let branch = follow(&scene, "operation.speed_rad_s", [500.0, 280.0]).unwrap();
        assert_eq!(branch.end, BranchEnd::Reached);
        let [hopf] = special(&branch, Special::Hopf)[..] else { panic!("{branch:?}") };
        let machine = scene.machine();
        let points = Lining::of(&machine, &scene.contact).unwrap().hopf_points([280.0, 500.0]);
        let near = |speed: f64| (speed / hopf - 1.0).abs() < 1e-6;
        assert!(points.unwrap().iter().any(|point| near(point.speed_rad_s)), "{hopf}");
        assert_eq!(branch.points.last().unwrap().parameter, 280.0);
    }
}
