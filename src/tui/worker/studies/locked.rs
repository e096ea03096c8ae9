//! The curves of the locked motion. They are closed forms, so they are cheap, and several views use
//! them, so they are always computed.

use std::sync::Arc;

use super::study::{Given, Study};
use crate::tui::views::id::ViewId;
use crate::tui::views::locked::curves::LockedCurves;
use rubscope_solver::scene::Scene;

/// Computes the curves of view 3.
#[derive(Debug)]
pub struct LockedStudy;

impl Study for LockedStudy {
    type Key = Scene;
    type Found = LockedCurves;
    type Job = Arc<LockedCurves>;
    const VIEW: ViewId = ViewId::Locked;

    fn key(given: &Given) -> Option<Scene> {
        Some(given.order.scene.clone().into_scene())
    }

    fn begin(scene: &Scene, _: &Given) -> Self::Job {
        Arc::new(LockedCurves::of(scene))
    }
}
