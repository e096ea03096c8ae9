//! The coincidence curves of a scene, computed in the background: with a lining each point is a
//! search.

use super::study::{Given, Sent, Study};
use crate::tui::views::coincidence::curves::CoincidenceCurves;
use crate::tui::views::id::ViewId;
use rubscope_solver::scene::Scene;

/// Computes the curves; `None` if the wave has no coincidence.
#[derive(Debug)]
pub struct CoincidenceStudy;

impl Study for CoincidenceStudy {
    type Key = Scene;
    type Found = Option<CoincidenceCurves>;
    type Job = Sent<Self::Found>;
    const VIEW: ViewId = ViewId::Coincidence;

    fn key(given: &Given) -> Option<Scene> {
        let shown = given.order.shows(ViewId::Coincidence);
        shown.then(|| CoincidenceCurves::key(&given.order.scene))
    }

    fn begin(_: &Scene, given: &Given) -> Self::Job {
        let theirs = given.order.scene.clone();
        Sent::by(move |to, _| _ = to.send(CoincidenceCurves::of(&theirs)))
    }
}

#[cfg(test)]
mod tests {
    use super::super::study::Job;
    use super::super::tests::with_given;
    use super::*;
    use std::time::Duration;

    #[test]
    fn the_curves_do_not_depend_on_the_pulse_or_on_a_speed_inside_their_range() {
        let mut scene = Scene::base();
        scene.bladed_disk.radial_coupling = 0.3;
        let key = |scene: &Scene| {
            with_given(scene, ViewId::Coincidence, |given| CoincidenceStudy::key(given).unwrap())
        };
        let own = key(&scene);
        let start = |given: &Given| CoincidenceStudy::begin(&own, given);
        let mut job = with_given(&scene, ViewId::Coincidence, start);
        while !job.is_done() {
            job.work(Duration::from_millis(20));
        }
        let curves = CoincidenceCurves::of(&scene);
        assert!(curves.is_some());
        assert_eq!(**job.found().unwrap(), curves);
        scene.operation.pulse_n = 1e5;
        scene.operation.speed_rad_s = 300.0;
        assert!(key(&scene) == own);
        let moved = CoincidenceCurves::of(&scene).unwrap();
        assert_eq!(Some(moved.markers), curves.map(|curves| curves.markers));
        scene.operation.speed_rad_s = -300.0;
        assert!(key(&scene) != own);
        scene.operation.speed_rad_s = 300.0;
        scene.bladed_disk.radial_coupling = 0.5;
        assert!(key(&scene) != own);
    }
}
