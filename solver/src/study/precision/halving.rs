//! Reference solution for scenes that the event solver does not support: the explicit solver with
//! successively halved time steps.
//!
//! If each halving changes the final state by a constant fraction of the previous change, that
//! fraction gives the order of convergence, and the final state is extrapolated to a step of zero
//! (Richardson). If the changes decrease without such a rule, the finest step is the reference; if
//! they do not decrease, there is none.
//!
//! An impact is late by the rest of its step. Halving the step moves it by half a step or not at
//! all, so the largest ratio of change to step bounds the error; and an impact just after a time
//! that all step grids share looks like first order, but converges to that shared time. Therefore
//! nothing is extrapolated after rigid impacts.

use super::ways::{Effort, LONGEST, Way};
use super::{Lack, Method, distance};
use crate::motion::VerdictReached;
use crate::scene::keys;
use crate::scene::{Scene, SceneError};
use crate::tolerances::{
    AS_ZERO, CHANGES_ASKED, ORDER_CLEAR, ORDER_LEAST, REFERENCE_STEPS, REFERENCE_STEPS_LEAST,
    REFERENCE_WORST,
};

/// Result of the run with one step.
#[derive(Clone, Copy, Debug)]
pub(super) struct Halved {
    pub(super) step_s: f64,
    /// Casing displacement at the time of comparison \[m\].
    pub(super) u: [f64; 2],
    /// Verdict with its times; `None` if the run failed.
    pub(super) reached: Option<VerdictReached>,
}

/// Combined result of the runs with all steps.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Settled {
    pub(super) method: Method,
    /// Observed order of convergence; `None` if all changes are round-off.
    pub(super) order: Option<f64>,
    /// Casing displacement of the reference \[m\], and a bound on its error in units of the
    /// clearance; `None` without a reference.
    pub(super) end: Option<([f64; 2], f64)>,
    /// Change of the casing displacement by each halving, in units of the clearance.
    pub(super) changes: Vec<f64>,
    /// Whether the finest runs agree in their verdict.
    pub(super) one_verdict: bool,
}

/// Returns the steps, each half of the previous one, down to the finest that `effort` allows,
/// without those that the scene does not allow; none if too few are left.
pub(super) fn steps(way: Way, scene: &Scene, effort: Effort) -> Vec<f64> {
    let end = scene.solver.end_s;
    let least = effort.finest_s.max(end / effort.most_steps);
    let finest = LONGEST * (least / LONGEST).log2().ceil().exp2();
    let all = (0..REFERENCE_STEPS as i32).rev().map(|k| finest * 2_f64.powi(k));
    let mut steps: Vec<f64> =
        all.filter(|&step| step <= end && way.at_step(step).of(scene).is_ok()).collect();
    if steps.len() < REFERENCE_STEPS_LEAST {
        steps.clear();
    }
    steps
}

/// Returns the steps used for rows of the comparison: the finest ones that determine the order,
/// without the last, which is the reference or close to it.
pub(super) fn rows(way: Way, scene: &Scene, effort: Effort) -> Vec<f64> {
    let mut steps = steps(way, scene, effort);
    _ = steps.pop();
    steps.split_off(steps.len().saturating_sub(CHANGES_ASKED))
}

/// Rejects a run that is too long for a reference with halved steps within this effort.
///
/// # Errors
/// States the end of the scene.
pub(super) fn check(way: Way, scene: &Scene, effort: Effort) -> Result<(), SceneError> {
    if !steps(way, scene, effort).is_empty() {
        return Ok(());
    }
    let allowed = format!(
        "fewer than {:e} steps of those the scene allows, for a reference by steps",
        effort.most_steps
    );
    Err(SceneError::refused(keys::END, scene.solver.end_s, allowed))
}

/// Evaluates runs with halved steps, with rigid contact or on a lining. Lock times may differ by up
/// to `moment` \[s\].
pub(super) fn settle(runs: &[Halved], clearance: f64, moment: f64, rigid: bool) -> Settled {
    let none = |lack, changes, one_verdict| {
        let method = Method::None(lack);
        Settled { method, order: None, end: None, changes, one_verdict }
    };
    // Failed runs with coarse steps say nothing about finer steps.
    let solved = runs.iter().take_while(|run| run.reached.is_none()).count();
    let runs = runs.get(solved..).unwrap_or_default();
    if runs.iter().any(|run| run.reached.is_none()) {
        return none(Lack::StepsFailed, Vec::new(), false);
    }
    let changes: Vec<f64> =
        runs.windows(2).map(|pair| distance(pair[0].u, pair[1].u) / clearance).collect();
    let asked = runs.len().saturating_sub(CHANGES_ASKED + 1);
    let last = runs.get(asked..).unwrap_or_default();
    let one_verdict = last.windows(2).all(|pair| verdict(&pair[0]) == verdict(&pair[1]));
    let Some(finest) = runs.last().filter(|_| runs.len() >= REFERENCE_STEPS_LEAST) else {
        return none(Lack::TooFew, changes, one_verdict);
    };
    let hit = last.iter().any(|run| run.reached.is_some_and(|reached| reached.impact_count > 0));
    let same = |pair: &[Halved]| {
        let both = pair[0].reached.zip(pair[1].reached);
        both.is_some_and(|(one, other)| !one.differs_from(other, moment))
    };
    let extrapolated = extrapolate(runs, &changes, clearance).filter(|_| !(rigid && hit));
    let found = match (extrapolated, falling(runs, &changes)) {
        (Some((order, u, error)), _) => Ok((Method::Extrapolated, Some(order), u, error)),
        (None, None) if changes.len() < CHANGES_ASKED && falls(&changes) => Err(Lack::TooFew),
        (None, None) => Err(Lack::NotFalling),
        (None, Some(_)) if !last.windows(2).all(same) => Err(Lack::OtherMotions),
        (None, Some((order, error))) => Ok((Method::FinestStep, order, finest.u, error)),
    };
    match found {
        Ok((method, order, u, error)) if error <= REFERENCE_WORST => {
            Settled { method, order, end: Some((u, error)), changes, one_verdict }
        }
        Ok(_) => none(Lack::TooFar, changes, one_verdict),
        Err(lack) => none(lack, changes, one_verdict),
    }
}

/// Returns whether each change is smaller than the previous one.
fn falls(changes: &[f64]) -> bool {
    changes.windows(2).all(|pair| pair[1] < pair[0])
}

fn verdict(run: &Halved) -> Option<crate::motion::Verdict> {
    run.reached.map(|reached| reached.verdict)
}

/// Returns the order, the final state extrapolated with it, and the distance of that state from the
/// one extrapolated at twice the step. Uses the finest steps at which two successive orders round
/// to the same whole number; with even finer steps the order can be lost in round-off, but the
/// changes must not grow.
fn extrapolate(runs: &[Halved], changes: &[f64], clearance: f64) -> Option<(f64, [f64; 2], f64)> {
    let to_zero = |finer: usize, whole: f64| -> Option<[f64; 2]> {
        let (coarse, fine) = (runs.get(finer.checked_sub(1)?)?.u, runs.get(finer)?.u);
        let part = 1.0 / (whole.exp2() - 1.0);
        Some([0, 1].map(|i| fine[i] + part * (fine[i] - coarse[i])))
    };
    (2..changes.len()).rev().find_map(|at| {
        let orders = [1, 0].map(|back| (changes[at - back - 1] / changes[at - back]).log2());
        let whole = orders[1].round();
        let clear = orders.iter().all(|order| (order - whole).abs() <= ORDER_CLEAR);
        let holds = changes[at..].iter().all(|later| *later <= changes[at]);
        if !(clear && holds && (1.0..=2.0).contains(&whole)) {
            return None;
        }
        let (end, coarser) = (to_zero(at + 1, whole)?, to_zero(at, whole)?);
        Some((orders[1], end, distance(end, coarser) / clearance))
    })
}

/// Returns the mean order with which the last changes decrease, from the largest of the first three
/// to the larger of the last two, and a bound on the error of the finest step if they continue to
/// decrease in this way. The order is `None` if only round-off is left. Returns `None` if the
/// changes do not decrease.
fn falling(runs: &[Halved], changes: &[f64]) -> Option<(Option<f64>, f64)> {
    let first = changes.len().checked_sub(CHANGES_ASKED)?;
    let (changes, runs) = (changes.get(first..)?, runs.get(first..)?);
    let largest = |part: &[f64]| part.iter().fold(0.0_f64, |most, change| most.max(*change));
    if largest(changes) <= AS_ZERO {
        return Some((None, largest(changes)));
    }
    let (coarse, fine) = (changes.get(..3)?, changes.get(CHANGES_ASKED - 2..)?);
    let order = (largest(coarse) / largest(fine)).log2() / (CHANGES_ASKED - 2) as f64;
    // Largest ratio of change to step.
    let rates = runs.iter().zip(changes).map(|(run, change)| change / run.step_s);
    let error = 2.0 * rates.fold(0.0, f64::max) * runs.last()?.step_s;
    (order >= ORDER_LEAST).then_some((Some(order).filter(|order| order.is_finite()), error))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::ActiveSet;
    use crate::motion::Verdict;

    /// Returns runs with successively halved steps, starting at one second; `end` gives the final
    /// displacement for a step, `impacts` the number of impacts.
    fn runs(end: impl Fn(f64) -> f64, impacts: impl Fn(usize) -> u64) -> Vec<Halved> {
        (0..REFERENCE_STEPS)
            .map(|n| {
                let step_s = 0.5_f64.powi(n as i32);
                let reached = VerdictReached {
                    verdict: Verdict::Decay,
                    impact_count: impacts(n),
                    rested: false,
                    locked_s: None,
                    held: ActiveSet::Nothing,
                };
                Halved { step_s, u: [end(step_s), 0.0], reached: Some(reached) }
            })
            .collect()
    }

    fn settled(end: impl Fn(f64) -> f64) -> Settled {
        settle(&runs(end, |_| 5), 1.0, 1.0, false)
    }

    #[test]
    fn a_whole_order_is_seen_and_the_end_is_extrapolated() {
        for order in [1, 2] {
            let found = settled(|h| 3.0 + 0.2 * h.powi(order) + 0.01 * h.powi(order + 1));
            assert_eq!(found.method, Method::Extrapolated);
            assert!((found.order.unwrap() - f64::from(order)).abs() < 0.01);
            let (u, error) = found.end.unwrap();
            assert!((u[0] - 3.0).abs() <= error && error < 1e-5, "{order}: {} {error}", u[0] - 3.0);
        }
        // No scheme here has third order, and half an order is not accepted.
        assert_ne!(settled(|h| 1e-3 * h.powi(3)).method, Method::Extrapolated);
        assert_ne!(settled(|h| 1e-3 * h.sqrt()).method, Method::Extrapolated);
    }

    #[test]
    fn impacts_between_steps_leave_the_finest_step_with_a_bound_of_its_error() {
        // The second instant is just after one that all steps share, so the changes suggest an
        // order.
        for (instant, order) in [(0.618_033_9, false), (0.500_001, true)] {
            let end = |h: f64| 1.0 + 2e-4 * (h * (instant / h).ceil() - instant);
            let all = runs(end, |_| 5);
            let found = settle(&all, 1.0, 1.0, true);
            assert_eq!(found.method, Method::FinestStep);
            let (u, error) = found.end.unwrap();
            assert_eq!(u[0], end(0.5_f64.powi(REFERENCE_STEPS as i32 - 1)));
            assert!((u[0] - 1.0).abs() <= error && error < 1e-5, "{instant}: {error:e}");
            assert_eq!(settled(end).method == Method::Extrapolated, order);
            // The number of impacts differs between steps, so the motions differ.
            let other = runs(end, |n| n as u64);
            assert_eq!(settle(&other, 1.0, 1.0, true).method, Method::None(Lack::OtherMotions));
        }
    }

    #[test]
    fn changes_that_do_not_fall_leave_no_reference() {
        let found = settled(|h| 1e-3 * (11.7 / h).sin());
        let lack = Method::None(Lack::NotFalling);
        assert_eq!((found.method, found.end, found.order), (lack, None, None));
        assert_eq!(found.changes.len(), REFERENCE_STEPS - 1);
        // An error of a tenth of the clearance is no reference, either.
        let far = settled(|h| 100.0 * h * (1.0 + (97.0 / h).sin()));
        assert_eq!(far.method, Method::None(Lack::TooFar));
    }

    #[test]
    fn steps_too_long_to_be_solved_are_left_out_and_a_finer_one_that_failed_is_not() {
        let all = |failed: &[usize]| {
            let mut runs = runs(|h| 3.0 + h * h, |_| 5);
            failed.iter().for_each(|n| (runs[*n].reached, runs[*n].u) = (None, [f64::NAN; 2]));
            settle(&runs, 1.0, 1.0, false)
        };
        let whole = all(&[]);
        for failed in [&[0][..], &[0, 1], &[0, 1, 2, 3]] {
            let found = all(failed);
            assert_eq!((found.method, found.end), (whole.method, whole.end), "{failed:?}");
            assert_eq!(found.changes, whole.changes[failed.len()..]);
            assert!(found.one_verdict);
        }
        // Four changes that do not decrease, and four that decrease with too low an order.
        let last = |end: fn(f64) -> f64| settle(&runs(end, |_| 5)[3..], 1.0, 1.0, true).method;
        assert_eq!(last(|h| (11.7 / h).sin()), Method::None(Lack::NotFalling));
        assert_eq!(last(f64::sqrt), Method::None(Lack::TooFew));
        assert_eq!(all(&[0, 1, 2, 3, 4]).method, Method::None(Lack::TooFew));
        assert_eq!(all(&[0, 1, 2, 3, 4, 5, 6, 7]).method, Method::None(Lack::TooFew));
        for failed in [&[REFERENCE_STEPS - 2][..], &[0, 2]] {
            assert_eq!(all(failed).method, Method::None(Lack::StepsFailed), "{failed:?}");
        }
    }

    #[test]
    fn round_off_is_no_change_and_takes_no_order_away() {
        assert_eq!(settled(|_| 0.7).end, Some(([0.7, 0.0], 0.0)));
        // Second order down to a noise floor.
        let found = settled(|h| h * h + if h < 0.02 { 1e-6 * (97.0 / h).sin() } else { 0.0 });
        let (u, error) = found.end.unwrap();
        assert_eq!(found.method, Method::Extrapolated);
        assert!(u[0].abs() < 1e-5 && u[0].abs() <= error + 1e-6, "{u:?} {error}");
    }
}
