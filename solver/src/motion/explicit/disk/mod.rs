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

/// What the explicit solver asks of the bladed disk.
pub(in crate::motion) trait Disk: Clone + Debug + Send + Sync + 'static {
    /// The disk at rest, for this scene, with the excitation that acts at the start.
    fn at_rest(scene: &Scene, machine: &Machine, driven: Driven<'_>) -> Self;
    /// These displacements and rates with the parameters of another scene of as
    /// many blades and diameters.
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self;
    /// How many coordinates one step updates, those of the casing included.
    fn coordinates(&self) -> usize;
    /// Which blades are one row.
    fn table(&self) -> &RowTable;
    /// One step without contact, which corrects it afterwards, under an excitation.
    /// Returns a bound on the change of any blade angle \[rad\].
    fn predict(&mut self, driven: Driven<'_>) -> f64;
    /// Blade angle of a row \[rad\].
    fn angle(&mut self, row: u32) -> f64;
    /// The same two steps before \[rad\].
    fn angle_before(&mut self, row: u32) -> f64;
    /// Angle of row `a` per unit torque on row `b` over one step
    /// \[rad/(N m)\]; for no pair larger than for a row itself.
    fn compliance(&self, a: u32, b: u32) -> f64;
    /// Correction of the predicted step by a torque on a row \[N m\].
    fn correct(&mut self, row: u32, torque: f64);
    /// The shapes of the two modes at a row, where they are all that moves.
    fn shape_of(&self, _row: u32) -> (f64, f64) {
        (0.0, 0.0)
    }
    /// The angles of the two modes, where they are all that moves \[rad\].
    fn modes(&self) -> Option<[f64; 2]> {
        None
    }
    /// Finds the angles of these rows \[rad\].
    fn angles(&mut self, rows: &mut Columns) {
        rows.put_angles(|row| self.angle(row));
    }
    /// Corrects the predicted step by the torques on these rows, of which two modes feel
    /// so much \[N m\]; a bound on the change of any blade angle \[rad\].
    fn push(&mut self, rows: &Columns, _felt: [f64; 2]) -> f64 {
        self.push_each(rows)
    }
    /// Does the same by one torque after the other.
    fn push_each(&mut self, rows: &Columns) -> f64 {
        let mut change = 0.0;
        for (row, _, torque) in rows.each(|four| four.torque) {
            if torque != 0.0 {
                self.correct(row, torque);
                change += self.compliance(row, row) * torque.abs();
            }
        }
        change
    }
    /// Blades whose frequencies squared are this much above those at rest from now on, in
    /// place of another much \[rad^2/s^2\]; what that gives them of energy \[J\].
    fn stiffen(&mut self, _added: f64) -> f64 {
        0.0
    }
    /// Leaves a part of every angle, and the rates.
    fn shrink(&mut self, _part: f64) {}
    /// The pushes on these rows times what their blades have turned over the last two half
    /// steps \[N rad\].
    fn swept(&mut self, rows: &Columns) -> f64 {
        let mut swept = 0.0;
        for (row, _, push) in rows.each(|four| four.push) {
            if push != 0.0 {
                swept += push * 0.5 * (self.angle(row) - self.angle_before(row));
            }
        }
        swept
    }
    /// Corrects the start for torques that act at it: the step before it, only.
    fn begin(&mut self, rows: &Columns, felt: [f64; 2]);
    /// `[alpha_c, alpha_s]` \[rad\].
    fn modal(&self) -> [f64; 2];
    /// Their rates where the next step of length `step` is `ahead` \[rad/s\].
    fn modal_rates(&self, ahead: &Self, step: f64) -> [f64; 2];
    /// The angle of every blade \[rad\].
    fn every_angle(&self) -> Vec<f64>;

    /// The largest angle now of the blades that may be beyond `largest`, and a
    /// bound on that of every blade \[rad\].
    fn look(&mut self, largest: f64) -> (f64, f64);
    /// A bound on every blade angle that free motion can still reach \[rad\].
    fn reach(&self) -> f64;
    /// The largest angle of any blade over the next `steps` free steps; `least`
    /// where none is larger \[rad\].
    fn peak(&self, steps: u64, least: f64) -> f64;
    /// `steps` free steps at once.
    fn skip(&mut self, steps: u64);
    /// Returns the number of free steps from which on it is faster to take them at once.
    fn shortest_block(&self) -> u64 {
        SHORTEST_BLOCK
    }
    /// The modes of a held corner; none where there are more than two.
    fn held_modes(&self) -> Option<HeldModes<'_>> {
        None
    }
    /// Puts the modes of a held corner back, and their increments of the step before the
    /// last.
    fn set_held_modes(&mut self, _: [Coordinate; 2], _: [f64; 2]) {}

    /// A bound on every blade angle now, as close as candidates need it \[rad\].
    fn bound(&mut self) -> f64;
    /// `alpha_c + i alpha_s`, where the blades have the phases of the casing wave, so
    /// that the gaps are those of the polygon at `z - kappa l_b (alpha_c + i alpha_s)`.
    fn wave(&self) -> Option<Plane>;
    /// The rows with their angles, and how far these may be off \[rad\].
    fn estimates(&mut self) -> (&RowTable, &[f64], f64);
    /// The largest about the mean of all blades; of two modes, their amplitude \[rad\].
    fn swing(&mut self) -> f64;
    /// Energy between the last two steps \[J\].
    fn energy(&self) -> f64;
    /// Lost in the damping of the last step, and the work of the excitation in it \[J\].
    fn flows(&self) -> [f64; 2];
}

/// The blade modes as a held corner knows them.
#[derive(Clone, Copy, Debug)]
pub struct HeldModes<'a> {
    /// `alpha_c` and `alpha_s`.
    pub modes: [Coordinate; 2],
    /// The blades that move, none for rigid ones.
    pub moving: Option<&'a ModalBlades>,
}
