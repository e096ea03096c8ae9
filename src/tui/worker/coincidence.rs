//! The curves of the coincidence of one scene, in the background: on a lining each
//! point is a search.

use std::sync::Arc;
use std::time::Duration;

use super::background::Background;
use crate::scene::Scene;
use crate::tui::views::coincidence::curves::CoincidenceCurves;

/// Curves, or none where the wave has no coincidence.
pub type Found = Arc<Option<CoincidenceCurves>>;

/// The curves that are being computed.
#[derive(Debug)]
pub struct CoincidenceJob {
    key: Scene,
    under_way: Background<Option<CoincidenceCurves>>,
    found: Option<Found>,
}

impl CoincidenceJob {
    /// Starts on a scene.
    pub fn of(scene: &Scene) -> Self {
        let theirs = scene.clone();
        let under_way = Background::start(move |to, _| {
            // Without a receiver nobody asks any more.
            let _ = to.send(CoincidenceCurves::of(&theirs));
        });
        Self { key: CoincidenceCurves::key(scene), under_way, found: None }
    }

    /// Whether they are those of this scene, too.
    pub fn is_of(&self, scene: &Scene) -> bool {
        self.key == CoincidenceCurves::key(scene)
    }

    /// Whether nothing more comes.
    pub fn is_done(&self) -> bool {
        self.found.is_some() || self.under_way.is_done()
    }

    /// What was found.
    pub fn found(&self) -> Option<&Found> {
        self.found.as_ref()
    }

    /// Takes what is found, waiting for it no longer than `patience`.
    pub fn receive(&mut self, patience: Duration) {
        if let Some(curves) = self.under_way.receive(patience) {
            self.found = Some(Arc::new(curves));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curves_do_not_depend_on_the_pulse_or_on_a_speed_inside_their_range() {
        let mut scene = Scene::base();
        scene.bladed_disk.radial_coupling = 0.3;
        let mut job = CoincidenceJob::of(&scene);
        while !job.is_done() {
            job.receive(Duration::from_millis(20));
        }
        let curves = CoincidenceCurves::of(&scene);
        assert!(curves.is_some());
        assert_eq!(**job.found().unwrap(), curves);
        scene.operation.pulse_n = 1e5;
        scene.operation.speed_rad_s = 300.0;
        assert!(job.is_of(&scene));
        let moved = CoincidenceCurves::of(&scene).unwrap();
        assert_eq!(Some(moved.markers), curves.map(|curves| curves.markers));
        scene.operation.speed_rad_s = -300.0;
        assert!(!job.is_of(&scene));
        scene.operation.speed_rad_s = 300.0;
        scene.bladed_disk.radial_coupling = 0.5;
        assert!(!job.is_of(&scene));
    }
}
