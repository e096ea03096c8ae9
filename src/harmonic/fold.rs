//! The corner branch followed by its own geometry, so that a fold is passed
//! and not missed: blades so soft that the wave opens its corner run out of
//! stiffness at some speed, and the branch turns back.
//!
//! Points are spaced by arc length in the plane of speed (over `Omega_c`) and
//! opening, and each is exact: the branch is explicit in its opening.

use std::f64::consts::FRAC_PI_2;

use super::equations::{Equations, Wave};
use super::equilibria::{judged, loads_of};
use super::opening::Opening;
use super::posture::Posture;
use super::{Corner, Equilibrium, Form, HarmonicError, Kind};
use crate::model::Machine;

/// Where a branch turns back.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fold {
    /// The largest speed with a corner state \[rad/s\].
    pub speed: f64,
    /// Half the phase between the two bent contacts there \[rad\]; `delta` before
    /// they bend.
    pub opening: f64,
}

/// The corner states, in order along their branch.
#[derive(Clone, Debug, PartialEq)]
pub struct CornerBranch {
    /// Half the phase between the contacts \[rad\], and the state.
    pub points: Vec<(f64, Equilibrium)>,
    /// The fold; none for blades too stiff for one at any speed a number holds.
    pub fold: Option<Fold>,
}

/// Most points of one branch.
const MOST_POINTS: usize = 20_000;

/// Follows the corner states of the exact modal form from speed `from` to `to`
/// \[rad/s\]; where the branch folds before `to`, back to `from` or until the
/// corner stands open by nearly a half turn. `step` is the arc length between
/// points.
///
/// # Errors
/// A rim without corners, speeds that are not `0 <= from < to`, or a step
/// outside 1e-4 to 1.
pub fn corner_branch(
    machine: &Machine,
    side: u32,
    damped: bool,
    [from, to]: [f64; 2],
    step: f64,
) -> Result<CornerBranch, HarmonicError> {
    let corner = Corner::after(&machine.rim, side)?;
    let Some(critical) = machine.critical_speed() else { return Err(HarmonicError::NoWave) };
    if !(from >= 0.0 && to > from && to.is_finite()) {
        let allowed = "two speeds with 0 <= from < to".to_string();
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
    let opening = Opening::of(machine);
    let equations = Equations::new(machine, corner, Form::Modal);
    let walk = Walk { machine, corner, damped, critical, opening, equations };
    let widest = opening.at_fold();
    let fold = opening.kappa(widest).map(|(kappa, _)| Fold {
        speed: critical * (1.0 - kappa).sqrt(),
        opening: opening.delta + widest,
    });
    let points = walk.points([from, to], step, fold.map(|fold| (fold, widest)));
    Ok(CornerBranch { points, fold })
}

struct Walk<'a> {
    machine: &'a Machine,
    corner: Corner,
    damped: bool,
    critical: f64,
    opening: Opening,
    equations: Equations,
}

impl Walk<'_> {
    fn points(
        &self,
        [from, to]: [f64; 2],
        step: f64,
        fold: Option<(Fold, f64)>,
    ) -> Vec<(f64, Equilibrium)> {
        let mut points = Vec::new();
        let folds = fold.filter(|(fold, _)| fold.speed < to);
        // Not quite a right angle, where the amplitude would be infinite.
        let end = FRAC_PI_2 - 1e-3 - self.opening.delta;
        let Some(mut widening) = self.opening.at(self.kappa(from)) else { return points };
        let mut speed = from;
        let mut passed = false;
        while points.len() < MOST_POINTS {
            points.push(self.state(speed, widening));
            let Some((_, slope)) = self.opening.kappa(widening) else { break };
            // kappa = 1 - (Omega/Omega_c)^2, so Omega moves by -slope/(2 Omega).
            let rate = slope / (2.0 * (speed / self.critical).max(step));
            let next = widening + step / rate.hypot(1.0);
            match folds {
                Some((fold, widest)) if !passed && next >= widest => {
                    passed = true;
                    (speed, widening) = (fold.speed, widest);
                    continue;
                }
                _ => {}
            }
            let Some((kappa, _)) = self.opening.kappa(next) else { break };
            (speed, widening) = (self.critical * (1.0 - kappa).max(0.0).sqrt(), next);
            if passed && (speed < from || widening > end) {
                break;
            }
            if speed >= to {
                points.extend(self.opening.at(self.kappa(to)).map(|last| self.state(to, last)));
                break;
            }
        }
        points
    }

    fn kappa(&self, speed: f64) -> f64 {
        Wave::at(self.machine, speed, false).kappa
    }

    fn state(&self, speed: f64, widening: f64) -> (f64, Equilibrium) {
        let wave = Wave::at(self.machine, speed, self.damped);
        let unknowns = self.equations.opened(wave, widening);
        let (z, loads) = loads_of(self.machine, self.corner, &unknowns);
        let turns = [4, 5].map(|i| self.equations.softness() * unknowns[i]);
        let posture = Posture::of_pair(&self.machine.rim, z, self.corner.sides(), turns);
        let state = judged(self.machine, Kind::Corner, speed, self.damped, &posture, &loads);
        (self.opening.delta + widening, state)
    }
}
