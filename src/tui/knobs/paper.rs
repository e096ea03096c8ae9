//! Which knobs have a scene leave the paper's model. A folded group shows these.

use std::sync::LazyLock;

use super::{Group, Knob};
use crate::scene::{ContactLaw, Scene};

/// The paper's values.
static PAPER: LazyLock<Scene> = LazyLock::new(Scene::base);

impl Knob {
    /// Whether it is one of those beyond the paper and has another value than there,
    /// or describes the lining that the scene has.
    pub fn leaves_the_paper(&self, scene: &Scene) -> bool {
        let lining = self.path.starts_with("contact.s");
        self.group == Group::Beyond
            && (self.get(scene) != self.get(&PAPER)
                || (lining && scene.solver.contact == ContactLaw::Smooth))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::knobs::KNOBS;

    #[test]
    fn those_that_are_turned_and_those_of_a_lining_leave_the_paper() {
        let of = |scene: &Scene| -> Vec<&str> {
            let knobs = KNOBS.iter().filter(|knob| knob.leaves_the_paper(scene));
            knobs.map(|knob| knob.label).collect()
        };
        let mut scene = Scene::base();
        scene.operation.speed_rad_s = 430.0;
        assert_eq!(of(&scene), [""; 0]);
        scene.bladed_disk.radial_coupling = 0.5;
        scene.solver.contact = ContactLaw::Smooth;
        assert_eq!(of(&scene), ["tip slope κ", "lining k_p", "lining eps"]);
    }
}
