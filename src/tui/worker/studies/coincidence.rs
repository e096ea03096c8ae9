//! The curves of the coincidence of one scene, in the background: on a lining each
//! point is a search.

use std::sync::Arc;
use std::time::Duration;

use super::{Given, Study};
use crate::tui::views::coincidence::curves::CoincidenceCurves;
use crate::tui::views::id::ViewId;
use crate::tui::worker::background::Background;
use rubscope_solver::scene::Scene;

/// The curves that are being computed; none where the wave has no coincidence.
#[derive(Debug)]
pub struct CoincidenceStudy {
    under_way: Background<Option<CoincidenceCurves>>,
    found: Option<Arc<Option<CoincidenceCurves>>>,
}

impl Study for CoincidenceStudy {
    type Key = Scene;
    type Found = Option<CoincidenceCurves>;
    const VIEW: ViewId = ViewId::Coincidence;

    fn key(given: &Given) -> Option<Scene> {
        let shown = given.order.shows(ViewId::Coincidence);
        shown.then(|| CoincidenceCurves::key(&given.order.scene))
    }

    fn begin(_: &Scene, given: &Given) -> Self {
        let theirs = given.order.scene.clone();
        let under_way = Background::start(move |to, _| {
            // Without a receiver nobody asks any more.
            let _ = to.send(CoincidenceCurves::of(&theirs));
        });
        Self { under_way, found: None }
    }

    fn is_done(&self) -> bool {
        self.found.is_some() || self.under_way.is_done()
    }

    fn work(&mut self, patience: Duration) {
        if let Some(curves) = self.under_way.receive(patience) {
            self.found = Some(Arc::new(curves));
        }
    }

    fn found(&self) -> Option<&Arc<Self::Found>> {
        self.found.as_ref()
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::with_given;
    use super::*;

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
