//! The margins as they are computed: those of one scene first, then the survey.

use std::sync::Arc;

use rubscope_solver::study::margins::Margins;
use rubscope_solver::study::survey::Survey;

/// The margins, and the survey once it is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveMargins {
    /// What is known.
    pub margins: Margins,
    /// The survey of all diameters, once it is computed.
    pub survey: Option<Arc<Survey>>,
}
