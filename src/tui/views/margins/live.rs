//! The margins as they are computed: closed forms first, then what is searched.

use std::sync::Arc;

use crate::report::margins::LimitRow;
use rubscope_solver::scene::ContactLaw;
use rubscope_solver::study::margins::Margins;
use rubscope_solver::study::survey::Survey;

/// Margins of which something may still be searched.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveMargins {
    /// What is known.
    pub margins: Margins,
    /// The laws whose smallest lasting pulse is still searched.
    pub awaited: Vec<ContactLaw>,
    /// The survey of all diameters, once it is computed.
    pub survey: Option<Arc<Survey>>,
}

impl LiveMargins {
    /// Margins in which nothing was searched yet.
    pub fn of(margins: Margins) -> Self {
        let awaited = margins.laws().to_vec();
        Self { margins, awaited, survey: None }
    }

    /// The rows, in the order of the limits; what is searched is among the pulses.
    pub fn rows(&self) -> Vec<LimitRow<'_>> {
        LimitRow::all(&self.margins, &self.awaited)
    }
}
