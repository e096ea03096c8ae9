//! Margins: the limits of a scene (`listed`), their values (`evaluated`, `touching`), their
//! sensitivities to its parameters (`sensitivity`, `parameters`), the parameter value that moves a
//! limit to a given value (`target`), and the distance of a run from another verdict (`changes`).
//! See docs/theory.md, section 9.
//!
//! A *sensitivity* is `d ln(limit)/d ln(parameter)`: the change of the limit in per cent for one
//! per cent of the parameter.

mod changes;
mod evaluated;
mod limit;
mod listed;
mod parameters;
mod sensitivity;
mod target;
mod touching;

use std::time::Instant;

use serde::Serialize;

use crate::motion::{GoOn, run_to_verdict};
use crate::scene::CheckedScene;

pub use changes::{ChangedVerdict, Robustness, VerdictChange};
pub(super) use evaluated::speeds;
pub(super) use limit::shown_margin;
pub use limit::{Limit, LimitName, MOST_TIMES, Quantity, Sensitivities};
pub use parameters::{CLEARANCE, PARAMETERS, acting, changed, line, parameter};
pub use target::{Found, Target};
pub use touching::{FirstTouch, first_touch, grazing_pulse};

/// All limits of one scene.
///
/// ```
/// use rubscope_solver::scene::Scene;
/// use rubscope_solver::study::margins::{LimitName, Margins};
///
/// let margins = Margins::of(&Scene::base().checked()?);
/// let lock = margins.limit(LimitName::OmegaLock).ok_or("a machine with corners has one")?;
/// assert!((lock.value.unwrap_or_default() - 411.933_517).abs() < 1e-6);
/// // A casing mass larger by 1 % puts it 0.5 % lower.
/// assert_eq!(lock.sensitivities.by("casing.modal_mass_kg"), Some(-0.5));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Margins {
    /// The scene.
    pub scene: CheckedScene,
    /// Simplification of the closed forms compared with the scene, if any.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// Robustness of the verdict, if requested.
    #[serde(flatten)]
    pub robust: Option<Robustness>,
    /// Robustness with contact that only pushes; `None` unless requested for a scene whose law
    /// pulls.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub pushes_only: Option<Robustness>,
    /// Limits in the order in which they are shown.
    pub limits: Vec<Limit>,
    /// Parameter value that moves a limit to a given value, if requested.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<Found>,
    /// Cost of the computation.
    pub cost: Cost,
}

/// Cost of the computation.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// Wall time \[s\].
    pub wall_s: f64,
}

impl Margins {
    /// Computes every limit of a scene.
    #[must_use]
    pub fn of(scene: &CheckedScene) -> Self {
        let start = Instant::now();
        let limits = listed::limits(scene);
        let cost = Cost { wall_s: start.elapsed().as_secs_f64() };
        let (scene, note) = (scene.clone(), scene.tuned_note());
        Self { scene, note, robust: None, pushes_only: None, limits, target: None, cost }
    }

    /// Returns the number of rows that [`ask_runs`](Self::ask_runs) computes for a scene under
    /// every law.
    #[must_use]
    pub fn rows_asked(scene: &CheckedScene) -> usize {
        changes::scenes_to_run(scene).iter().map(|scene| changes::rows(scene).len()).sum()
    }

    /// Determines the robustness of the verdict by runs, with each quantity between zero and twice
    /// its value, and passes itself to `known` after each row. Fills `robust` and, with `every_law`
    /// if the law pulls, `pushes_only`. `None` if `go_on` returned false; the rows computed until
    /// then stay.
    pub fn ask_runs(
        &mut self,
        every_law: bool,
        go_on: GoOn<'_>,
        known: &mut dyn FnMut(&Self),
    ) -> Option<()> {
        let start = Instant::now();
        let laws = if every_law { usize::MAX } else { 1 };
        for (place, scene) in changes::scenes_to_run(&self.scene).iter().take(laws).enumerate() {
            let rows = changes::rows(scene);
            let mut found = Robustness {
                contact: scene.solver.contact,
                solver: scene.solver.kind,
                verdict: run_to_verdict(scene, go_on)?.verdict,
                changes: Vec::new(),
                rows: rows.len(),
            };
            let verdict = found.verdict;
            for row in rows {
                found.changes.push(changes::Search { scene, verdict, row, go_on }.both()?);
                let of_law = if place == 0 { &mut self.robust } else { &mut self.pushes_only };
                *of_law = Some(found.clone());
                known(self);
            }
        }
        self.cost.wall_s += start.elapsed().as_secs_f64();
        Some(())
    }

    /// Returns the larger contact force of a single tip in the lock, if both groups push \[N\].
    #[must_use]
    pub fn tip_push(&self) -> Option<f64> {
        let push = |name| self.limit(name)?.value.filter(|push| *push > 0.0);
        let larger = push(LimitName::PushA)?.max(push(LimitName::PushB)?);
        Some(larger / f64::from(self.scene.machine().polygon.blades_per_side.max(1)))
    }

    /// Returns the limit with this name, if the scene has it.
    #[must_use]
    pub fn limit(&self, name: LimitName) -> Option<&Limit> {
        self.limits.iter().find(|limit| limit.name == name)
    }
}
