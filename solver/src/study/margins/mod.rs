//! How far a scene is from every limit, and which of its parameters moves a limit
//! most: closed forms (`closed`), the smallest pulse that touches (`touching`) and
//! the smallest that lasts (`lasting`), and the value of a parameter that puts a limit
//! where it is wanted (`target`). docs/theory.md, section 9.
//!
//! A *sensitivity* is `d ln(limit)/d ln(parameter)`: the change of the limit in per
//! cent by one per cent of the parameter.

mod closed;
mod lasting;
mod limit;
mod parameters;
mod target;
mod touching;

use std::time::Instant;

use serde::Serialize;

use crate::motion::GoOn;
use crate::scene::{CheckedScene, ContactLaw};

pub(super) use closed::{speed_sensitivities, speeds};
pub use lasting::{Band, lasting_pulse};
pub use limit::{Limit, LimitName, Quantity, Sensitivities, Side};
pub use parameters::{CLEARANCE, PARAMETERS, Parameter, acting, parameter};
pub use target::{Found, Target, TargetError};
pub use touching::{FirstTouch, first_touch, grazing_pulse};

/// Every limit of one scene.
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
    /// What the closed forms are of, where the scene asks for more than they have.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub note: Option<String>,
    /// Its limits, in the order in which they are shown.
    pub limits: Vec<Limit>,
    /// The parameter that puts a limit where it is wanted, if asked.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub target: Option<Found>,
    /// What it took.
    pub cost: Cost,
}

/// What the answer took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Cost {
    /// Wall time of everything but the lasting pulses \[s\].
    pub wall_s: f64,
    /// Wall time of the search for the lasting pulses; none if not searched \[s\].
    pub search_wall_s: Option<f64>,
    /// Runs of that search.
    pub search_runs: u64,
}

impl Margins {
    /// Every limit that needs no search by runs over many pulses.
    #[must_use]
    pub fn of(scene: &CheckedScene) -> Self {
        let start = Instant::now();
        let mut limits = closed::limits(scene);
        // The pulse stands between the speeds and the loads of the lock.
        let place = limits.iter().position(|limit| limit.quantity != Quantity::Speed);
        limits.insert(place.unwrap_or(limits.len()), touching::limit(scene));
        let cost = Cost { wall_s: start.elapsed().as_secs_f64(), ..Cost::default() };
        let (scene, note) = (scene.clone(), scene.tuned_note());
        Self { scene, note, limits, target: None, cost }
    }

    /// The laws under which lasting pulses are searched: that of the scene first.
    #[must_use]
    pub fn laws(&self) -> [ContactLaw; 2] {
        match self.scene.solver.contact {
            ContactLaw::Unilateral => [ContactLaw::Unilateral, ContactLaw::Bilateral],
            own => [own, ContactLaw::Unilateral],
        }
    }

    /// Searches the smallest lasting pulse under one law and adds it; false where
    /// `go_on` said no on the way.
    pub fn search(&mut self, law: ContactLaw, go_on: GoOn<'_>) -> bool {
        let start = Instant::now();
        let Some((limit, runs)) = lasting_pulse(&self.scene, law, go_on) else { return false };
        let place = self.limits.iter().rposition(|limit| limit.quantity == Quantity::Pulse);
        self.limits.insert(place.map_or(self.limits.len(), |place| place + 1), limit);
        let wall_s = start.elapsed().as_secs_f64();
        self.cost.search_wall_s = Some(self.cost.search_wall_s.unwrap_or(0.0) + wall_s);
        self.cost.search_runs += runs;
        true
    }

    /// The limit of this name, if it is among them.
    #[must_use]
    pub fn limit(&self, name: LimitName) -> Option<&Limit> {
        self.limits.iter().find(|limit| limit.name == name)
    }
}
