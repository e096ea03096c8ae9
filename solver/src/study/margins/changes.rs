//! Robustness of a verdict: for each quantity that an operator or a designer can change, the
//! nearest value below and above at which the verdict is found to change. Verdicts can have
//! islands: a nearer change may exist between two values that were tried.

use serde::Serialize;

use super::parameters::{CLEARANCE, acting, changed};
use super::touching;
use crate::motion::{GoOn, Verdict, VerdictReached, certainty, run_to_verdict};
use crate::numeric::rounding::rounded;
use crate::scene::{CheckedScene, ContactLaw, Key, Scene, SolverKind, keys};

/// Relative changes of a quantity at which runs are tried, in this order. Closer ones would find more
/// islands, at the cost of more runs.
const CHANGE_STEPS: [f64; 7] = [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0];

/// Number of digits of a value that is tried: one more than [`CHANGE_FOUND`] needs, and few enough
/// that the displayed value reproduces the run.
const CHANGE_DIGITS: usize = 4;

/// Relative accuracy to which a change of the verdict is located: three digits.
const CHANGE_FOUND: f64 = 1e-3;

/// Largest number of runs on one side of a quantity: the steps, and the halvings of the widest step
/// that locate a value of a hundredth of the present one to three digits.
const CHANGE_RUNS: usize = 20;

/// Largest value that is tried if a damping ratio is zero; few structures have more.
const CHANGE_OF_ZERO: f64 = 0.1;

/// Keys and names of the quantities that are varied; the last two only if they are not zero.
const CHANGED: [(&str, &str); 7] = [
    (keys::SPEED, "speed"),
    (keys::PULSE, "pulse"),
    (keys::CASING_DAMPING, "casing damping"),
    (keys::BLADE_DAMPING, "disk damping"),
    (CLEARANCE, "clearance"),
    (keys::LONGEST_TIP, "longest tip"),
    (keys::OUT_OF_ROUND, "out of round"),
];

/// Robustness of a verdict under one contact law.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Robustness {
    /// The contact law.
    pub contact: ContactLaw,
    /// Solver of the runs.
    pub solver: SolverKind,
    /// Verdict of the run.
    pub verdict: Verdict,
    /// Nearest changes of the verdict, one row for each quantity.
    pub changes: Vec<VerdictChange>,
    /// Final number of rows.
    #[serde(skip)]
    pub rows: usize,
}

/// Nearest changes of the verdict found for one quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct VerdictChange {
    /// Key of the quantity, or `clearance`.
    pub path: &'static str,
    /// Name of the quantity.
    #[serde(skip)]
    pub name: &'static str,
    /// Value in the scene.
    pub present: f64,
    /// Nearest change found below `present`; `None` if none was found.
    pub below: Option<ChangedVerdict>,
    /// Nearest change found above `present`; `None` if none was found.
    pub above: Option<ChangedVerdict>,
    /// On each side, the change, or without one the last value with the same verdict.
    pub tried: [f64; 2],
}

/// A value at which the verdict differs from that of the scene.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ChangedVerdict {
    /// The value.
    pub value: f64,
    /// Verdict at this value.
    pub verdict: Verdict,
    /// Whether a tiny change or another time step alters that verdict.
    pub sensitive: bool,
}

impl VerdictChange {
    /// Returns the nearer of both changes, and its distance relative to the present value, negative
    /// if it is below; `None` without a change, or if the present value is zero.
    #[must_use]
    pub fn nearest(&self) -> Option<(ChangedVerdict, f64)> {
        let part =
            |found: ChangedVerdict| (found, (found.value - self.present) / self.present.abs());
        let both = [self.below, self.above].into_iter().flatten().map(part);
        both.filter(|(_, part)| part.is_finite()).min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }
}

/// Returns the scenes to be examined: the given one, and for the bilateral law also the same scene
/// with contact that only pushes.
pub(super) fn scenes_to_run(scene: &CheckedScene) -> Vec<CheckedScene> {
    let mut scenes = vec![scene.clone()];
    if scene.solver.contact == ContactLaw::Bilateral {
        let mut by_steps = Scene::clone(scene);
        by_steps.solver.contact = ContactLaw::Unilateral;
        scenes.extend(scene.as_reference().checked().or_else(|_| by_steps.checked()).ok());
    }
    scenes
}

/// Returns the rows for a scene: quantity, name, and unit of the search steps.
pub(super) fn rows(scene: &Scene) -> Vec<(&'static Key, &'static str, f64)> {
    let rows = CHANGED.iter().filter_map(|(path, name)| {
        let by = acting(scene).find(|by| by.path == *path)?;
        let step = match (by.real(scene), by.path) {
            (0.0, keys::PULSE) => 2.0 * touching::smallest(scene)?.pulse_n.abs(),
            (0.0, keys::SPEED) => scene.machine().omega_c,
            (0.0, CLEARANCE) => return None,
            (0.0, _) => CHANGE_OF_ZERO,
            (present, _) => present.abs(),
        };
        Some((by, *name, step))
    });
    rows.collect()
}

/// Search along one quantity.
pub(super) struct Search<'a> {
    pub scene: &'a CheckedScene,
    pub verdict: Verdict,
    /// Row as returned by [`rows`].
    pub row: (&'static Key, &'static str, f64),
    pub go_on: GoOn<'a>,
}

impl Search<'_> {
    /// Searches on both sides, from zero only upward; `None` if `go_on` stopped it.
    pub fn both(&self) -> Option<VerdictChange> {
        let (by, name, _) = self.row;
        let (path, present) = (by.path, by.real(self.scene));
        let down = || match present == 0.0 {
            true => Some((None, present)),
            false => self.search_side(-1.0),
        };
        let (below, above) = rayon::join(down, || self.search_side(1.0));
        let ((below, low), (above, high)) = (below?, above?);
        Some(VerdictChange { path, name, present, below, above, tried: [low, high] })
    }

    /// Searches on one side: outward until the verdict changes, then by bisection. Returns the
    /// change, if one was found, and the value for `VerdictChange::tried`; the outer `None` if
    /// `go_on` stopped the search.
    fn search_side(&self, sense: f64) -> Option<(Option<ChangedVerdict>, f64)> {
        let (by, _, step) = self.row;
        // Rounded, so that the value can be typed.
        let value = |steps: f64| rounded(by.real(self.scene) + sense * steps * step, CHANGE_DIGITS);
        let (mut same, mut runs) = (0.0, 0);
        let mut found: Option<(f64, (CheckedScene, VerdictReached))> = None;
        while runs < CHANGE_RUNS {
            let steps = match (&found, CHANGE_STEPS.get(runs)) {
                (Some((steps, _)), _) => 0.5 * (same + steps),
                (None, Some(steps)) => *steps,
                (None, None) => break,
            };
            runs += 1;
            match self.run_with(value(steps))? {
                None => break,
                Some((_, reached)) if reached.verdict == self.verdict => same = steps,
                Some(run) => found = Some((steps, run)),
            }
            let near = |(steps, _): &(f64, _)| {
                step * (steps - same) <= CHANGE_FOUND * f64::abs(value(*steps))
            };
            if found.as_ref().is_some_and(near) {
                break;
            }
        }
        let Some((at, (scene, reached))) = found else { return Some((None, value(same))) };
        let certainty = certainty(&scene, reached, true, self.go_on)?;
        let sensitive = certainty.ends_otherwise || certainty.depends_on_step == Some(true);
        let found = ChangedVerdict { value: value(at), verdict: reached.verdict, sensitive };
        Some((Some(found), found.value))
    }

    /// Runs the scene with this value; the inner `None` if the value is not allowed, the outer one
    /// if `go_on` stopped it.
    fn run_with(&self, value: f64) -> Option<Option<(CheckedScene, VerdictReached)>> {
        (self.go_on)().then_some(())?;
        let scene = changed(self.row.0, self.scene, value).and_then(|scene| scene.checked());
        let Ok(scene) = scene else { return Some(None) };
        run_to_verdict(&scene, self.go_on).map(|reached| Some((scene, reached)))
    }
}
