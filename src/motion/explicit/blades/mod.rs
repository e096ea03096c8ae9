//! Three sizes of the bladed disk for the explicit solver: rigid blades, the
//! two modes of the paper, or every blade its own coordinate.
//!
//! To contact they all look alike: *rows*, each a constraint with a blade
//! angle, a side of the polygon, and the angle that torques on rows make in
//! one step.

mod angle_bounds;
mod full;
mod full_flight;
mod modal;
mod near;
mod ring;
mod shapes;

pub use full::FullBlades;
pub use modal::ModalBlades;
pub(in crate::motion) use near::NearRows;
pub(in crate::motion) use ring::Ring;
pub(in crate::motion) use shapes::product;

use super::drive::Driven;
use super::oscillator::Coordinate;
use crate::model::Machine;
use crate::scene::Scene;
use crate::tolerances::SHORTEST_BLOCK;

/// What the explicit solver asks of the bladed disk.
pub trait BladeModel: Clone + std::fmt::Debug + Send + Sync + 'static {
    /// The disk at rest, for this scene.
    fn at_rest(scene: &Scene, machine: &Machine) -> Self;
    /// These displacements and rates with the parameters of another scene of as
    /// many blades and diameters.
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self;
    /// How many coordinates one step updates, those of the casing included.
    fn coordinates(&self) -> usize;
    /// How many constraint rows a side of the polygon has.
    fn rows_of_side(&self, side: u32) -> usize;
    /// One of the rows of a side.
    fn row(&self, side: u32, place: usize) -> u32;
    /// One step without contact, which corrects it afterwards, under an
    /// excitation at its phase. Returns a bound on the change of any blade
    /// angle \[rad\].
    fn predict(&mut self, driven: Driven<'_>) -> f64;
    /// Blade angle of a row \[rad\].
    fn angle(&mut self, row: u32) -> f64;
    /// Angle of row `a` per unit torque on row `b` over one step
    /// \[rad/(N m)\]; for no pair larger than for a row itself.
    fn compliance(&self, a: u32, b: u32) -> f64;
    /// Correction of the predicted step by a torque on a row \[N m\].
    fn correct(&mut self, row: u32, torque: f64);
    /// `steps` free steps at once.
    fn skip(&mut self, steps: u64);
    /// Fewest free steps that are worth a block.
    fn shortest_block(&self) -> u64 {
        SHORTEST_BLOCK
    }
    /// The largest angle now of the blades that may be beyond `largest`, and a
    /// bound on that of every blade \[rad\].
    fn look(&mut self, largest: f64) -> (f64, f64);
    /// A bound on every blade angle that free motion can still reach \[rad\].
    fn reach(&self) -> f64;
    /// The largest angle of any blade over the next `steps` free steps; `least`
    /// where none is larger \[rad\].
    fn peak(&self, steps: u64, least: f64) -> f64;
    /// Takes that many free steps at once: their `peak`, and a bound on every
    /// blade angle at their end \[rad\].
    fn fly(&mut self, steps: u64, least: f64) -> (f64, f64) {
        let most = self.peak(steps, least);
        self.skip(steps);
        (most, self.look(most).1)
    }
    /// `[alpha_c, alpha_s]` and their rates.
    fn modal(&self) -> ([f64; 2], [f64; 2]);
    /// The angle of every blade \[rad\].
    fn every_angle(&self, machine: &Machine) -> Vec<f64>;
    /// The modes of a held corner; none where there are more than two.
    fn held_modes(&self) -> Option<HeldModes<'_>> {
        None
    }
    /// Puts the modes of a held corner back.
    fn set_held_modes(&mut self, _: [Coordinate; 2]) {}
}

/// The blade modes as a held corner knows them.
#[derive(Clone, Copy, Debug)]
pub struct HeldModes<'a> {
    /// `alpha_c` and `alpha_s`.
    pub modes: [Coordinate; 2],
    /// The blades that move, none for rigid ones.
    pub moving: Option<&'a ModalBlades>,
}

/// Blades that do not move.
#[derive(Clone, Debug)]
pub struct RigidBlades {
    blades: usize,
}

impl BladeModel for RigidBlades {
    fn at_rest(scene: &Scene, _: &Machine) -> Self {
        Self { blades: scene.bladed_disk.blades as usize }
    }
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self {
        Self::at_rest(scene, machine)
    }
    fn coordinates(&self) -> usize {
        2
    }
    fn rows_of_side(&self, _: u32) -> usize {
        1
    }
    fn row(&self, side: u32, _: usize) -> u32 {
        side
    }
    fn predict(&mut self, _: Driven<'_>) -> f64 {
        0.0
    }
    fn angle(&mut self, _: u32) -> f64 {
        0.0
    }
    fn compliance(&self, _: u32, _: u32) -> f64 {
        0.0
    }
    fn correct(&mut self, _: u32, _: f64) {}
    fn skip(&mut self, _: u64) {}
    fn look(&mut self, _: f64) -> (f64, f64) {
        (0.0, 0.0)
    }
    fn reach(&self) -> f64 {
        0.0
    }
    fn peak(&self, _: u64, least: f64) -> f64 {
        least
    }
    fn modal(&self) -> ([f64; 2], [f64; 2]) {
        ([0.0; 2], [0.0; 2])
    }
    fn every_angle(&self, _: &Machine) -> Vec<f64> {
        vec![0.0; self.blades]
    }
    fn held_modes(&self) -> Option<HeldModes<'_>> {
        Some(HeldModes { modes: [Coordinate::default(); 2], moving: None })
    }
}
