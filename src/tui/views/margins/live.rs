//! The margins in progress: closed forms first, then the survey and the searched changes.

use std::sync::Arc;

use rubscope_solver::study::margins::Margins;
use rubscope_solver::study::survey::Survey;

/// Margins of a scene, as far as computed.
#[derive(Clone, Debug, PartialEq)]
pub struct LiveMargins {
    /// Margins for the scene's own nodal diameters.
    pub margins: Margins,
    /// Survey over all nodal diameters; `None` until it is computed, and if the scene allows none.
    pub survey: Option<Arc<Survey>>,
}
