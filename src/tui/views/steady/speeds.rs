//! The speeds that a view shows, with the curves over them.

use crate::sheet::{CommandLine, Sheet};
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::Scene;
use rubscope_solver::study::figures::Panel;

/// The speeds of a view, as magnitudes \[rad/s\], and what its sheet draws over them.
#[derive(Clone, Debug)]
pub struct Speeds {
    pub view: ViewId,
    /// Ends of the range.
    pub range: [f64; 2],
    /// Marked speeds in ascending order, with their labels.
    pub marks: Vec<(f64, &'static str)>,
    /// The panels of the sheet.
    pub panels: Vec<Panel>,
}

impl Speeds {
    /// Adds the panels of the sheet that `fill` makes, which are drawn in every frame.
    pub fn with_panels<'a>(self, scene: &Scene, fill: impl FnOnce(&mut Sheet<'a>)) -> Self {
        let mut sheet = Sheet::new("hbm", 3, CommandLine::without_scene("hbm"), scene);
        fill(&mut sheet);
        Self { panels: sheet.panels(), ..self }
    }
}
