//! How far a run is from another verdict: for each quantity that an operator or a designer may
//! change, the nearest value found below and above at which it ends otherwise. Verdicts have
//! islands: a nearer one may lie between two values that were tried.

use serde::Serialize;

use super::parameters::{CLEARANCE, Parameter, acting};
use super::touching;
use crate::motion::{GoOn, Verdict, VerdictReached, certainty, run_to_verdict};
use crate::numeric::rounding::rounded;
use crate::scene::{CheckedScene, ContactLaw, Scene, SolverKind, keys};
use crate::tolerances::{CHANGE_DIGITS, CHANGE_FOUND, CHANGE_OF_ZERO, CHANGE_RUNS, CHANGE_STEPS};

/// The quantities that are changed, and their names; the last two only where they are not zero.
const CHANGED: [(&str, &str); 7] = [
    (keys::SPEED, "speed"),
    (keys::PULSE, "pulse"),
    (keys::CASING_DAMPING, "casing damping"),
    (keys::BLADE_DAMPING, "disk damping"),
    (CLEARANCE, "clearance"),
    (keys::LONGEST_TIP, "longest tip"),
    (keys::OUT_OF_ROUND, "out of round"),
];

/// How far a run under one contact law is from another verdict.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Robustness {
    /// The contact law.
    pub contact: ContactLaw,
    /// The solver of the runs.
    pub solver: SolverKind,
    /// Verdict of the run.
    pub verdict: Verdict,
    /// The nearest changes of it, a row for each quantity.
    pub changes: Vec<VerdictChange>,
    /// How many rows there will be.
    #[serde(skip)]
    pub rows: usize,
}

/// The nearest changes of a verdict that were found by one quantity.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct VerdictChange {
    /// The path of the quantity, or `clearance`.
    pub path: &'static str,
    /// Its name.
    #[serde(skip)]
    pub name: &'static str,
    /// Its value in the scene.
    pub present: f64,
    /// The nearest change found below.
    pub below: Option<ChangedVerdict>,
    /// The nearest change found above.
    pub above: Option<ChangedVerdict>,
    /// The smallest and the largest value up to which every run tried on the way ended the same,
    /// or the change itself.
    pub tried: [f64; 2],
}

/// A value of a quantity at which a run ends otherwise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ChangedVerdict {
    /// The value.
    pub value: f64,
    /// Verdict of the run with it.
    pub verdict: Verdict,
    /// Whether a tiny change or another step makes that run end otherwise.
    pub sensitive: bool,
}

impl VerdictChange {
    /// Returns the nearer of both changes and by which part of the present value it is away, if
    /// that is not zero.
    #[must_use]
    pub fn nearest(&self) -> Option<(ChangedVerdict, f64)> {
        let part =
            |found: ChangedVerdict| (found, (found.value - self.present) / self.present.abs());
        let both = [self.below, self.above].into_iter().flatten().map(part);
        both.filter(|(_, part)| part.is_finite()).min_by(|a, b| a.1.abs().total_cmp(&b.1.abs()))
    }
}

/// The runs that are asked: of the scene, and where its law pulls, of contact that only pushes.
pub(super) fn asked(scene: &CheckedScene) -> Vec<CheckedScene> {
    let mut asked = vec![scene.clone()];
    if scene.solver.contact == ContactLaw::Bilateral {
        let mut by_steps = Scene::clone(scene);
        by_steps.solver.contact = ContactLaw::Unilateral;
        asked.extend(scene.as_reference().checked().or_else(|_| by_steps.checked()).ok());
    }
    asked
}

/// The rows of a run: a quantity, its name, and how far a step of one goes.
pub(super) fn rows(scene: &Scene) -> Vec<(&'static Parameter, &'static str, f64)> {
    let rows = CHANGED.iter().filter_map(|(path, name)| {
        let by = acting(scene).find(|by| by.path == *path)?;
        let step = match (by.of(scene), by.path) {
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

/// A search by one quantity.
pub(super) struct Search<'a> {
    pub scene: &'a CheckedScene,
    pub verdict: Verdict,
    /// Its row.
    pub row: (&'static Parameter, &'static str, f64),
    pub go_on: GoOn<'a>,
}

impl Search<'_> {
    /// Looks on both sides, only upward from zero; none where told to stop.
    pub fn both(&self) -> Option<VerdictChange> {
        let (by, name, _) = self.row;
        let (path, present) = (by.path, by.of(self.scene));
        let down = || match present == 0.0 {
            true => Some((None, present)),
            false => self.one(-1.0),
        };
        let (below, above) = rayon::join(down, || self.one(1.0));
        let ((below, low), (above, high)) = (below?, above?);
        Some(VerdictChange { path, name, present, below, above, tried: [low, high] })
    }

    /// Looks on one side: outward, then between the last two.
    fn one(&self, sense: f64) -> Option<(Option<ChangedVerdict>, f64)> {
        let (by, _, step) = self.row;
        // A value that was tried is one that can be typed.
        let value = |steps: f64| rounded(by.of(self.scene) + sense * steps * step, CHANGE_DIGITS);
        let (mut same, mut runs) = (0.0, 0);
        let mut found: Option<(f64, (CheckedScene, VerdictReached))> = None;
        while runs < CHANGE_RUNS {
            let steps = match (&found, CHANGE_STEPS.get(runs)) {
                (Some((steps, _)), _) => 0.5 * (same + steps),
                (None, Some(steps)) => *steps,
                (None, None) => break,
            };
            runs += 1;
            match self.ends(value(steps))? {
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
        let changed = ChangedVerdict { value: value(at), verdict: reached.verdict, sensitive };
        Some((Some(changed), changed.value))
    }

    /// Returns the scene with this value and how it ends; none inside where it is not allowed.
    fn ends(&self, value: f64) -> Option<Option<(CheckedScene, VerdictReached)>> {
        (self.go_on)().then_some(())?;
        let scene = self.row.0.set(self.scene, value).and_then(|scene| scene.checked());
        let Ok(scene) = scene else { return Some(None) };
        run_to_verdict(&scene, self.go_on).map(|reached| Some((scene, reached)))
    }
}
