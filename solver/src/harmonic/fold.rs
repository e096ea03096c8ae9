//! Very soft blades: the wave opens its corner, the stiffness is exhausted at some speed,
//! and the branch of the corner turns back there (docs/theory.md, section 8).
//!
//! The corner is one equation for its corner angle `Delta`, explicit in it, folds included:
//! `stiffness = -(Delta - delta) cos^3 Delta/(c sin Delta)`, `c` the theory's `chi`.
//!
//! The branch is followed by arc length, so that it passes a fold and does not miss it.
//! Points are spaced in the plane of speed (over `Omega_c`) and corner angle, and each is
//! exact. Up to the fold both coordinates only grow; behind it the speed only falls. So the
//! end of each leg is known in advance: the points hit an end or a fold exactly.

use std::f64::consts::FRAC_PI_2;

use super::corner::Configuration;
use super::equations::{Equations, Scales, Wave};
use super::equilibria::{judged, loads_of};
use super::{Corner, Equilibrium, Form, HarmonicError, Kind, error};
use crate::model::{Machine, Number};
use crate::numeric::bisection::{bisected, try_bisected};
use crate::tolerances::{APART, AS_GOOD_AS_RIGID, BRANCH_POINTS, CONVERGED, FASTEST, LEFT_OPEN};

/// The corner angle of one polygon's corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct CornerAngle<T = f64> {
    /// Half angle of the unbent corner, `delta` \[rad\].
    pub delta: f64,
    /// `c` above.
    compliance: T,
}

impl<T: Number> CornerAngle<T> {
    /// Of a machine's corners.
    pub fn of(machine: &Machine<T>) -> Self {
        let scales = Scales::of(machine);
        Self::new(machine.polygon.delta, scales.softness * scales.share)
    }

    /// With the (dimensionless) softness of the blades times their share.
    fn new(delta: f64, bend: T) -> Self {
        Self { delta, compliance: bend * delta.sin().powi(2) }
    }

    /// As `CornerAngle::at`, with its derivative by the implicit function theorem:
    /// one more step of Newton's method, whose slope needs none.
    pub fn derived(&self, stiffness: T) -> Option<T> {
        let plain = CornerAngle { delta: self.delta, compliance: self.compliance.re() };
        let angle_change = plain.at(stiffness.re())?;
        let (sin, cos) = (self.delta + angle_change).sin_cos();
        let pull = self.compliance * stiffness / (cos * cos);
        let value = pull * sin / cos + angle_change;
        let slope = pull.re() * (1.0 + 2.0 * sin * sin) / (cos * cos) + 1.0;
        Some(-value / slope + angle_change)
    }

    /// `stiffness` at the fold, where the branch turns back: `at_fold` depends on `delta`
    /// alone, so `stiffness` goes with one over the compliance.
    pub fn fold_stiffness(&self) -> Option<T> {
        let plain = CornerAngle { delta: self.delta, compliance: self.compliance.re() };
        let (stiffness, _) = plain.stiffness(plain.at_fold())?;
        Some(self.compliance.recip() * (stiffness * plain.compliance))
    }
}

impl CornerAngle {
    /// The change of the corner angle `Delta - delta` \[rad\] at `stiffness`, on the branch of stiff
    /// blades; `None` beyond its fold.
    pub fn at(&self, stiffness: f64) -> Option<f64> {
        let mut angle_change = 0.0;
        // Steps shrink at least by half (at the fold), until they are rounding.
        let mut last = f64::INFINITY;
        for _ in 0..100 {
            let angle = self.delta + angle_change;
            let (sin, cos) = angle.sin_cos();
            let pull = self.compliance * stiffness / (cos * cos);
            let value = angle_change + pull * sin / cos;
            let slope = 1.0 + pull * (1.0 + 2.0 * sin * sin) / (cos * cos);
            // The slope vanishes at the fold. Newton's steps from delta stay on
            // the near side of the root: the equation is convex there.
            if slope <= 0.0 {
                return None;
            }
            let step = value / slope;
            angle_change -= step;
            let angle = self.delta + angle_change;
            if !(angle > 0.0 && angle < FRAC_PI_2) {
                return None;
            }
            if step.abs() <= 2.0 * f64::EPSILON * angle_change.abs()
                || (step.abs() >= last && step.abs() <= CONVERGED * angle)
            {
                return Some(angle_change);
            }
            last = step.abs();
        }
        None
    }

    /// The change of the corner angle \[rad\] between two others where `stiffness`
    /// is this, by halving: also next to the fold, where Newton's method has no
    /// slope, and behind it. `stiffness` must be monotonic between the two.
    pub fn between(&self, stiffness: f64, [near, far]: [f64; 2]) -> f64 {
        let at = |angle_change| {
            self.stiffness(angle_change).map_or(f64::NAN, |(stiffness, _)| stiffness)
        };
        let grows = at(near) < at(far);
        let [near, far] = bisected([near, far], |place| (at(place) < stiffness) != grows);
        0.5 * (near + far)
    }

    /// `stiffness` at a change of the corner angle, and its slope; `None` if the
    /// blades are too stiff for such an opening.
    pub fn stiffness(&self, angle_change: f64) -> Option<(f64, f64)> {
        if self.compliance < AS_GOOD_AS_RIGID {
            return None;
        }
        let (sin, cos) = (self.delta + angle_change).sin_cos();
        let scale = -cos * cos / (self.compliance * sin * sin);
        let stiffness = scale * angle_change * sin * cos;
        let slope = scale * (sin * cos - angle_change * (1.0 + 2.0 * sin * sin));
        (stiffness.is_finite() && slope.is_finite()).then_some((stiffness, slope))
    }

    /// The change of the corner angle at the fold \[rad\]: it depends on
    /// `delta` alone.
    pub fn at_fold(&self) -> f64 {
        let falls = |angle_change: f64| {
            let (sin, cos) = (self.delta + angle_change).sin_cos();
            sin * cos <= angle_change * (1.0 + 2.0 * sin * sin)
        };
        bisected([0.0, FRAC_PI_2 - self.delta], falls)[0]
    }
}

/// Where a branch turns back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold {
    /// The largest speed with a corner state \[rad/s\].
    pub speed_rad_s: f64,
    /// Half the phase between the two bent contacts there \[rad\]; `delta` for
    /// unbent blades.
    pub opening_rad: f64,
}

/// The corner states, in order along their branch.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerBranch {
    /// Half the phase between the contacts \[rad\], and the state.
    pub points: Vec<(f64, Equilibrium)>,
    /// The fold; none for blades that are too stiff at any speed that a number
    /// can represent.
    pub fold: Option<Fold>,
}

/// Follows the corner states of the exact modal form from speed `from` to `to`
/// \[rad/s\], both included; where the branch folds before `to`, through the
/// fold and back to `from` or until the corner is open by nearly a half turn.
/// Without points if it folds before `from`. `step` is the arc length between
/// points, more where these would be over 20,000.
///
/// # Errors
/// A polygon without corners, tips that are inclined or rub, speeds that are not
/// `0 <= from < to`, a step outside 1e-4 to 1, or eigenvalues that cannot be computed.
pub fn corner_branch(
    machine: &Machine,
    side: u32,
    damped: bool,
    [from, to]: [f64; 2],
    step: f64,
) -> Result<CornerBranch, HarmonicError> {
    let corner = Corner::after(&machine.polygon, side)?;
    error::refuse_other_diameters(machine)?;
    error::refuse_tips(machine, "0 where the corner branch is followed; the lock takes it")?;
    error::refuse_change(machine)?;
    let Some(critical) = machine.critical_speed() else { return Err(HarmonicError::NoWave) };
    if !(from >= 0.0 && to > from && to / critical <= FASTEST) {
        let allowed = format!("two speeds with 0 <= from < to, up to {FASTEST:e} critical speeds");
        return Err(HarmonicError::refused("speed", format!("{from}:{to}"), allowed));
    }
    if !(1e-4..=1.0).contains(&step) {
        return Err(HarmonicError::refused("step", step, "an arc length from 1e-4 to 1"));
    }
    let corner_angle = CornerAngle::of(machine);
    let widest = corner_angle.at_fold();
    let top = corner_angle.stiffness(widest).map(|(stiffness, _)| Place {
        speed: critical * (1.0 - stiffness).sqrt(),
        angle_change: widest,
    });
    let walk = Walk { machine, critical, corner_angle, top };
    let places = walk.places([from, to], step);
    let equations = Equations::new(machine, corner, Form::Modal);
    let state = |place: &Place| {
        let mut wave = Wave::at(machine, place.speed, damped);
        // Next to the fold, and with very soft blades, the corner angle gives
        // stiffness to more digits than the speed does.
        if let Some((stiffness, _)) = corner_angle.stiffness(place.angle_change) {
            wave.stiffness = stiffness;
        }
        let unknowns = equations.opened(wave, place.angle_change);
        let (z, loads) = loads_of(machine, corner, &unknowns);
        let turns = [4, 5].map(|i| equations.softness() * unknowns[i]);
        let configuration = Configuration::of_pair(&machine.polygon, z, corner.sides(), turns);
        let state = judged(machine, Kind::Corner, place.speed, damped, &configuration, &loads)?;
        Ok((corner_angle.delta + place.angle_change, state))
    };
    Ok(CornerBranch {
        points: places.iter().map(state).collect::<Result<_, _>>()?,
        fold: top.map(|top| Fold {
            speed_rad_s: top.speed,
            opening_rad: corner_angle.delta + top.angle_change,
        }),
    })
}

/// A place on a branch: speed \[rad/s\] and `Delta - delta` \[rad\].
#[derive(Clone, Copy, Debug, PartialEq)]
struct Place {
    speed: f64,
    angle_change: f64,
}

struct Walk<'a> {
    machine: &'a Machine,
    critical: f64,
    corner_angle: CornerAngle,
    /// The fold; none for practically rigid blades.
    top: Option<Place>,
}

impl Walk<'_> {
    /// Both ends, the fold if it is passed, and the points between, in order.
    fn places(&self, [from, to]: [f64; 2], step: f64) -> Vec<Place> {
        let Some(first) = self.rising(from) else { return Vec::new() };
        let ends = match self.top {
            Some(top) if top.speed < to => vec![top, self.last(top, from)],
            _ => self.rising(to).into_iter().collect(),
        };
        // A leg is not longer than the sum of its two coordinate changes.
        let mut whole = 0.0;
        let mut start = first;
        for &end in &ends {
            whole += (end.speed - start.speed).abs() / self.critical;
            whole += (end.angle_change - start.angle_change).abs();
            start = end;
        }
        let step = step.max(1.2 * whole / BRANCH_POINTS as f64);
        let mut places = vec![first];
        let mut here = first;
        for end in ends {
            while here != end && places.len() < BRANCH_POINTS {
                here = self.onward(here, end, step).unwrap_or(end);
                places.push(here);
            }
        }
        places
    }

    /// One step from `here` towards the end of its leg; `None` if the end
    /// itself is the next point.
    fn onward(&self, here: Place, end: Place, step: f64) -> Option<Place> {
        let [least, most, last] = APART.map(|part| part * step);
        if self.apart(here, end) <= last {
            return None;
        }
        if self.top.is_none() {
            return self.rising(here.speed + step * self.critical);
        }
        // On one leg the distance from `here` only grows; a place within is good enough.
        let ends = [here.angle_change, end.angle_change];
        let halved = try_bisected(ends, 0.0, |angle_change| {
            let place = self.at(angle_change).ok_or(None)?;
            let apart = self.apart(here, place);
            if (least..=most).contains(&apart) { Err(Some(place)) } else { Ok(apart > most) }
        });
        halved.err().flatten()
    }

    /// Chord between two places, speeds over `Omega_c`.
    fn apart(&self, a: Place, b: Place) -> f64 {
        ((b.speed - a.speed) / self.critical).hypot(b.angle_change - a.angle_change)
    }

    /// The place of this change of the corner angle.
    fn at(&self, angle_change: f64) -> Option<Place> {
        let (stiffness, _) = self.corner_angle.stiffness(angle_change)?;
        // stiffness = 1 - (Omega/Omega_c)^2.
        Some(Place { speed: self.critical * (1.0 - stiffness).max(0.0).sqrt(), angle_change })
    }

    /// The place of this speed on the way up to the fold; `None` beyond it.
    fn rising(&self, speed: f64) -> Option<Place> {
        let stiffness = Wave::at(self.machine, speed, false).stiffness;
        let found = self.corner_angle.at(stiffness);
        let Some(top) = self.top else {
            return found.map(|angle_change| Place { speed, angle_change });
        };
        if speed >= top.speed {
            return (speed == top.speed).then_some(top);
        }
        // Newton's method stops if round-off hides the side of the fold.
        let angle_change =
            found.unwrap_or_else(|| self.corner_angle.between(stiffness, [0.0, top.angle_change]));
        Some(Place { speed, angle_change: angle_change.min(top.angle_change) })
    }

    /// Where the branch ends behind its fold: at this speed, or wide open.
    fn last(&self, top: Place, speed: f64) -> Place {
        if speed >= top.speed {
            return top;
        }
        let widest = FRAC_PI_2 - LEFT_OPEN - self.corner_angle.delta;
        if let Some(open) = self.at(widest).filter(|open| open.speed >= speed) {
            return open;
        }
        let stiffness = Wave::at(self.machine, speed, false).stiffness;
        Place {
            speed,
            angle_change: self.corner_angle.between(stiffness, [top.angle_change, widest]),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_branch_by_speed_is_the_branch_by_opening() {
        for (delta, bend) in [(0.1428, 1e-6), (0.1428, 40.0), (0.6, 3.0), (1.0, 0.3)] {
            let corner_angle = CornerAngle::new(delta, bend);
            let (limit, slope) = corner_angle.stiffness(corner_angle.at_fold()).unwrap();
            assert!(slope.abs() < 1e-12 * (limit / delta).abs());
            for part in [-3.0, -0.5, 0.0, 1e-9, 0.1, 0.5, 0.9, 0.999] {
                let angle_change = corner_angle.at(part * limit).unwrap();
                let (back, _) = corner_angle.stiffness(angle_change).unwrap();
                // Next to the fold the rounding of an angle is amplified a
                // hundred times.
                assert!((back - part * limit).abs() <= 1e-13 * limit.abs());
                assert_eq!(angle_change > 0.0, part > 0.0);
            }
            assert_eq!(corner_angle.at(1.001 * limit), None);
        }
    }

    #[test]
    fn the_slope_is_the_slope_and_the_fold_is_the_extreme() {
        let corner_angle = CornerAngle::new(0.3, 2.0);
        let at = |angle_change| corner_angle.stiffness(angle_change).unwrap().0;
        for angle_change in [-0.1, 0.05, 0.7] {
            let (_, slope) = corner_angle.stiffness(angle_change).unwrap();
            let measured = (at(angle_change + 1e-5) - at(angle_change - 1e-5)) / 2e-5;
            assert!((measured - slope).abs() < 1e-7 * slope.abs().max(1.0));
        }
        let fold = corner_angle.at_fold();
        assert!(at(fold) < at(fold - 1e-4) && at(fold) < at(fold + 1e-4));
    }
}
