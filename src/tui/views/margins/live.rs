//! The margins as they are computed: the closed forms first, then the survey.

use std::sync::Arc;

use rubscope_solver::study::margins::Margins;
use rubscope_solver::study::survey::Survey;

/// The margins, and the survey once it is computed.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveMargins {
    /// Margins of the scene.
    pub margins: Margins,
    /// Survey of all diameters, once it is computed.
    pub survey: Option<Arc<Survey>>,
}
