//! The speeds that a scene is measured by: of a lock, and of the coincidence that can
//! make it whirl.

use super::App;
use crate::model::LockWindow;
use crate::scene::ModelSize;

impl App {
    /// The speed from which on a lock only pushes \[rad/s\], 0 where it does so at
    /// standstill; none where nothing locks, as where all blades rub.
    pub fn lock_speed(&self) -> Option<f64> {
        self.lock_window().map(|window| window.from)
    }

    /// The speeds between which a lock only pushes.
    pub fn lock_window(&self) -> Option<LockWindow> {
        self.machine.lock_window(self.speed())
    }

    /// Whether blades and casing drive each other where they touch, so that a
    /// coincidence is dangerous: tips that move outward, or a lining.
    pub fn is_coupled(&self) -> bool {
        let bends = self.scene.solver.model != ModelSize::Rigid;
        self.has_lining() || (bends && self.machine.radial_coupling != 0.0)
    }

    /// What steady states are of where every blade of the run moves alone, in few words.
    pub fn tuned_note(&self) -> Option<&'static str> {
        self.scene.tuned_note().map(|_| "of equal blades, two modes")
    }

    /// The coincidence that is dangerous here \[rad/s\]: of the sum of the frequencies,
    /// or of their difference where the tips dig in.
    pub fn coincidence(&self) -> Option<f64> {
        self.machine.coincidence_felt_at(self.speed()).map(f64::abs)
    }
}
