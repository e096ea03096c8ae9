//! Follows the corner branch by arc length, so that it passes a fold and does
//! not miss it. With blades so soft that the wave opens its corner, the
//! stiffness is exhausted at some speed, and the branch turns back.
//! (docs/theory.md, section 8.)
//!
//! Points are spaced by arc length in the plane of speed (over `Omega_c`) and
//! corner angle, and each is exact: the branch is explicit in its corner angle.
//! Up to the fold both coordinates only grow; behind it the speed only falls.
//! So the end of each leg is known in advance: the points hit an end or a fold
//! exactly and never step over it.

use std::f64::consts::FRAC_PI_2;

use super::configuration::Configuration;
use super::corner_angle::CornerAngle;
use super::equations::{Equations, Wave};
use super::equilibria::{judged, loads_of};
use super::{Corner, Equilibrium, Form, HarmonicError, Kind, error};
use crate::model::Machine;
use crate::tolerances::{APART, BRANCH_POINTS, FASTEST, LEFT_OPEN};

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
    error::refuse_joined(machine, "0 where the corner branch is followed; the lock takes it")?;
    let Some(critical) = machine.critical_speed() else { return Err(HarmonicError::NoWave) };
    if !(from >= 0.0 && to > from && to / critical <= FASTEST) {
        let allowed = format!("two speeds with 0 <= from < to, up to {FASTEST:e} critical speeds");
        return Err(HarmonicError::Refused {
            key: "speed",
            value: format!("{from}:{to}"),
            allowed,
        });
    }
    if !(1e-4..=1.0).contains(&step) {
        let (key, allowed) = ("step", "an arc length from 1e-4 to 1".to_string());
        return Err(HarmonicError::Refused { key, value: step.to_string(), allowed });
    }
    let corner_angle = CornerAngle::of(machine);
    let widest = corner_angle.at_fold();
    let top = corner_angle
        .kappa(widest)
        .map(|(kappa, _)| Place { speed: critical * (1.0 - kappa).sqrt(), angle_change: widest });
    let walk = Walk { machine, critical, corner_angle, top };
    let places = walk.places([from, to], step);
    let equations = Equations::new(machine, corner, Form::Modal);
    let state = |place: &Place| {
        let mut wave = Wave::at(machine, place.speed, damped);
        // Next to the fold, and with very soft blades, the corner angle gives
        // kappa to more digits than the speed does.
        if let Some((kappa, _)) = corner_angle.kappa(place.angle_change) {
            wave.kappa = kappa;
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
        // On one leg the distance from `here` only grows.
        let (mut near, mut far) = (here.angle_change, end.angle_change);
        for _ in 0..100 {
            let place = self.at(0.5 * (near + far))?;
            let apart = self.apart(here, place);
            if apart < least {
                near = place.angle_change;
            } else if apart > most {
                far = place.angle_change;
            } else {
                return Some(place);
            }
        }
        None
    }

    /// Chord between two places, speeds over `Omega_c`.
    fn apart(&self, a: Place, b: Place) -> f64 {
        ((b.speed - a.speed) / self.critical).hypot(b.angle_change - a.angle_change)
    }

    /// The place of this change of the corner angle.
    fn at(&self, angle_change: f64) -> Option<Place> {
        let (kappa, _) = self.corner_angle.kappa(angle_change)?;
        // kappa = 1 - (Omega/Omega_c)^2.
        Some(Place { speed: self.critical * (1.0 - kappa).max(0.0).sqrt(), angle_change })
    }

    /// The place of this speed on the way up to the fold; `None` beyond it.
    fn rising(&self, speed: f64) -> Option<Place> {
        let kappa = Wave::at(self.machine, speed, false).kappa;
        let found = self.corner_angle.at(kappa);
        let Some(top) = self.top else {
            return found.map(|angle_change| Place { speed, angle_change });
        };
        if speed >= top.speed {
            return (speed == top.speed).then_some(top);
        }
        // Newton's method stops if round-off hides the side of the fold.
        let angle_change =
            found.unwrap_or_else(|| self.corner_angle.between(kappa, [0.0, top.angle_change]));
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
        let kappa = Wave::at(self.machine, speed, false).kappa;
        Place { speed, angle_change: self.corner_angle.between(kappa, [top.angle_change, widest]) }
    }
}
