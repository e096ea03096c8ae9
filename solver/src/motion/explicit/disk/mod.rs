//! Three sizes of the bladed disk for the explicit solver: rigid blades, two modes, or
//! every blade its own coordinate.
//!
//! To contact they all look alike: *rows* of blades that nothing tells apart, their
//! angles, and the angle that torques on rows make in one step.
//!
//! Read `table` (rows), `rigid`, `modal`; then `shapes`, `ring`, `full` and `full_at_once`.

mod full;
mod full_at_once;
mod modal;
mod rigid;
mod ring;
mod shapes;
mod table;

pub use full::FullBlades;
pub use modal::ModalBlades;
pub use rigid::RigidBlades;
pub(in crate::motion) use table::{Columns, Four, Lanes, RowTable, total};

use std::fmt::Debug;

use super::drive::Driven;
use super::oscillator::Coordinate;
use crate::model::Machine;
use crate::motion::Plane;
use crate::scene::Scene;
use crate::tolerances::SHORTEST_BLOCK;

/// Bladed disk as the explicit solver uses it.
pub(in crate::motion) trait Disk: Clone + Debug + Send + Sync + 'static {
    /// Creates the disk at rest, for this scene, with the excitation that acts at the start.
    fn at_rest(scene: &Scene, machine: &Machine, driven: Driven<'_>) -> Self;
    /// Returns the disk with these displacements and rates and the parameters of another scene with
    /// the same numbers of blades and diameters.
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self;
    /// Returns the number of coordinates that one step updates, with those of the casing.
    fn coordinates(&self) -> usize;
    /// Returns which blades form one row.
    fn table(&self) -> &RowTable;
    /// Takes one step under an excitation, without contact, which corrects it afterwards.
    /// Returns a bound on the change of any blade angle \[rad\].
    fn predict(&mut self, driven: Driven<'_>) -> f64;
    /// Returns the blade angle of a row \[rad\].
    fn angle(&mut self, row: u32) -> f64;
    /// Returns the blade angle of a row two steps before \[rad\].
    fn angle_before(&mut self, row: u32) -> f64;
    /// Returns the angle of row `a` per unit torque on row `b` over one step \[rad/(N m)\]; it is
    /// largest for `a = b`.
    fn compliance(&self, a: u32, b: u32) -> f64;
    /// Corrects the predicted step by a torque on a row \[N m\].
    fn correct(&mut self, row: u32, torque: f64);
    /// Returns the shapes of the two modes at a row, for a disk of two modes.
    fn shape_of(&self, _row: u32) -> (f64, f64) {
        (0.0, 0.0)
    }
    /// Returns the amplitudes \[rad\] of what these rows have as their shapes; a disk of more than
    /// two modes makes that the angle of each row.
    fn amplitudes(&mut self, _rows: &mut Columns) -> [f64; 2] {
        self.modal()
    }
    /// Corrects the predicted step by the torques on these rows, whose modal torques on two modes
    /// are `felt` \[N m\]. Returns a bound on the change of any blade angle \[rad\].
    fn push(&mut self, rows: &Columns, felt: [f64; 2]) -> f64;
    /// Sets the increase of the squared blade frequencies above those at rest \[rad^2/s^2\].
    /// Returns the change of their energy \[J\].
    fn stiffen(&mut self, _added: f64) -> f64 {
        0.0
    }
    /// Multiplies every angle by `part`, without a change of the rates.
    fn shrink(&mut self, _part: f64) {}
    /// Returns the sum of the pushes on these rows times the turn of their blades over the last two
    /// half steps \[N rad\].
    fn swept(&mut self, rows: &Columns) -> f64;
    /// Corrects the state at the start for torques that act there: only the step before it changes.
    fn begin(&mut self, rows: &Columns, felt: [f64; 2]);
    /// Returns `[alpha_c, alpha_s]` \[rad\].
    fn modal(&self) -> [f64; 2];
    /// Returns their rates, where `ahead` is the disk after the next step of length `step`
    /// \[rad/s\].
    fn modal_rates(&self, ahead: &Self, step: f64) -> [f64; 2];
    /// Returns the angle of every blade \[rad\].
    fn every_angle(&self) -> Vec<f64>;

    /// Returns the largest angle of the blades that may be beyond `largest`, and a bound on the
    /// angles of all blades \[rad\].
    fn look(&mut self, largest: f64) -> (f64, f64);
    /// Returns a bound on every blade angle in all free motion to come \[rad\].
    fn reach(&self) -> f64;
    /// Returns the largest angle of any blade over the next `steps` free steps; `least` where none
    /// is larger \[rad\].
    fn peak(&self, steps: u64, least: f64) -> f64;
    /// Takes `steps` free steps at once.
    fn skip(&mut self, steps: u64);
    /// Returns the smallest number of free steps that are faster taken at once.
    fn shortest_block(&self) -> u64 {
        SHORTEST_BLOCK
    }
    /// Returns the modes of a held corner; `None` where there are more than two.
    fn held_modes(&self) -> Option<HeldModes<'_>> {
        None
    }
    /// Sets the modes of a held corner, and their increments of the step before the last.
    fn set_held_modes(&mut self, _: [Coordinate; 2], _: [f64; 2]) {}

    /// Returns a bound on every blade angle now, tight enough to find candidates \[rad\].
    fn bound(&mut self) -> f64;
    /// Returns `alpha_c + i alpha_s`, where the blades have the phases of the casing wave, so
    /// that the gaps are those of the polygon at `z - kappa l_b (alpha_c + i alpha_s)`.
    fn wave(&self) -> Option<Plane>;
    /// Returns the rows with their approximate angles, and a bound on the error of these \[rad\].
    fn estimates(&mut self) -> (&RowTable, &[f64], f64);
    /// Returns the largest angle about the mean of all blades; for two modes, their amplitude
    /// \[rad\].
    fn swing(&mut self) -> f64;
    /// Returns the energy between the last two steps \[J\].
    fn energy(&self) -> f64;
    /// Returns the energy lost in damping in the last step, and the work of the excitation \[J\].
    fn flows(&self) -> [f64; 2];
}

/// Blade modes of a held corner.
#[derive(Clone, Copy, Debug)]
pub struct HeldModes<'a> {
    /// `alpha_c` and `alpha_s`.
    pub modes: [Coordinate; 2],
    /// The blades that move, none for rigid ones.
    pub moving: Option<&'a ModalBlades>,
}
