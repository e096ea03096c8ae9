//! The margins of a scene, in the background: first for its own nodal diameters, then the survey
//! over all nodal diameters, then the nearest changes of the verdict, which take many runs.

use std::sync::Arc;

use super::study::{Given, Sent, Study};
use crate::tui::views::id::ViewId;
use crate::tui::views::margins::live::LiveMargins;
use crate::tui::worker::background::on_spare_cores;
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::study::margins::Margins;
use rubscope_solver::study::survey::Survey;

/// Computes the margins of a scene, and the survey over a speed range.
#[derive(Debug)]
pub struct MarginsStudy;

impl Study for MarginsStudy {
    /// The scene, and the speed range of the survey \[rad/s\]; `None` covers all speeds.
    type Key = (CheckedScene, Option<[f64; 2]>);
    type Found = LiveMargins;
    type Job = Sent<LiveMargins>;
    const VIEW: ViewId = ViewId::Margins;
    const BESIDE: bool = true;
    const ENDS: bool = true;

    fn key(given: &Given) -> Option<Self::Key> {
        let order = given.order;
        order.shows(ViewId::Margins).then(|| (order.scene.clone(), order.range))
    }

    fn begin((scene, range): &Self::Key, _: &Given) -> Self::Job {
        let (theirs, range) = (scene.clone(), *range);
        Sent::by(move |to, go_on| {
            let mut margins = Margins::of(&theirs);
            let send = |margins: &Margins, survey: &Option<Arc<Survey>>| {
                let _ = to.send(LiveMargins { margins: margins.clone(), survey: survey.clone() });
            };
            send(&margins, &None);
            // The survey and the runs are for a knob that rests.
            std::thread::sleep(std::time::Duration::from_millis(200));
            if !go_on() {
                return;
            }
            let survey = Survey::of(&theirs, range, None).ok().map(Arc::new);
            send(&margins, &survey);
            on_spare_cores(|| margins.ask_runs(go_on, &mut |margins| send(margins, &survey)));
        })
    }
}
