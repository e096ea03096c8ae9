//! One limit as the text, the page and the screen show it.

use rubscope_solver::scene::ContactLaw;
use rubscope_solver::study::margins::{Limit, LimitName, Margins, Quantity, Side};

/// Parameters that are told of a limit.
pub const TOLD: usize = 3;

/// A row: a limit, or one that is still searched.
#[derive(Clone, Copy, Debug)]
pub struct LimitRow<'a> {
    /// Which limit.
    pub name: LimitName,
    /// The contact law that it is of, if it depends on one.
    pub law: Option<ContactLaw>,
    /// None while it is searched.
    limit: Option<&'a Limit>,
}

impl<'a> LimitRow<'a> {
    /// The rows in the order of the limits; those whose laws are still searched are among
    /// the pulses.
    #[must_use]
    pub fn all(margins: &'a Margins, searched: &[ContactLaw]) -> Vec<Self> {
        let own = margins.scene.solver.contact;
        let known =
            |limit: &'a Limit| Self { name: limit.name, law: limit.contact, limit: Some(limit) };
        let mut rows: Vec<Self> = margins.limits.iter().map(known).collect();
        let place = rows.iter().rposition(|row| row.quantity() == Quantity::Pulse);
        let place = place.map_or(0, |place| place + 1);
        let coming = searched.iter().map(|&law| Self {
            name: LimitName::lasting(law, own),
            law: Some(law),
            limit: None,
        });
        rows.splice(place..place, coming);
        rows
    }

    /// The limit, if it is known.
    #[must_use]
    pub fn limit(&self) -> Option<&'a Limit> {
        self.limit
    }

    /// What it is a value of.
    #[must_use]
    pub fn quantity(&self) -> Quantity {
        self.name.quantity()
    }

    /// Whether it is a load of the lock, which limits nothing of the scene.
    #[must_use]
    pub fn is_load(&self) -> bool {
        self.quantity().path().is_none()
    }

    /// Its title in a table.
    #[must_use]
    pub fn title(&self, short: bool) -> String {
        let [long, few] = self.name.titles();
        match self.law {
            Some(law) if short => format!("{few} {:.3}", law.as_ref()),
            Some(law) => format!("{long}, {law}"),
            None => if short { few } else { long }.to_string(),
        }
    }

    /// Its value, if there is such a limit.
    #[must_use]
    pub fn value(&self) -> Option<f64> {
        self.limit?.value
    }

    /// The value of the scene that it limits.
    #[must_use]
    pub fn present(&self) -> Option<f64> {
        self.limit?.present
    }

    /// How far beyond it the scene is, as a part of it.
    #[must_use]
    pub fn margin(&self) -> Option<f64> {
        self.limit?.margin
    }

    /// On which side of it the scene is.
    #[must_use]
    pub fn side(&self) -> Option<Side> {
        self.limit?.side()
    }

    /// Which way a load of the lock acts, and on which side of another limit the scene is.
    #[must_use]
    pub fn way(&self) -> String {
        match (self.quantity(), self.value()) {
            (Quantity::Push, Some(push)) if push < 0.0 => "pulls".to_string(),
            (Quantity::Push, Some(_)) => "pushes".to_string(),
            _ => self.side().map_or_else(String::new, |side| side.to_string()),
        }
    }

    /// The parameters that move it most, most first.
    #[must_use]
    pub fn strongest(&self) -> Vec<(&'static str, f64)> {
        self.limit.map_or_else(Vec::new, |limit| limit.sensitivities.strongest(TOLD))
    }

    /// What else is to be said of it, such as why there is no value.
    #[must_use]
    pub fn note(&self) -> Option<&'a str> {
        self.limit?.note.as_deref()
    }
}
