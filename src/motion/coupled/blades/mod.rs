//! Three sizes of the bladed disk under contact that bends blades: rigid, two modes, or
//! every blade its own coordinate (docs/theory.md, section 10).
//!
//! Contact sees *rows* of blades that move alike, their angles, and what a torque does
//! to them in one step.

mod full;
mod mistuning;
mod modal;
mod rigid;

pub(in crate::motion) use full::FullTips;
pub(in crate::motion) use modal::ModalTips;
pub(in crate::motion) use rigid::RigidTips;

use std::fmt::Debug;

use super::rows::RowTable;
use crate::model::Machine;
use crate::motion::Plane;
use crate::motion::explicit::{Driven, Oscillator};
use crate::scene::Scene;

/// What the solver asks of the bladed disk.
pub(in crate::motion) trait TipModel:
    Clone + Debug + Send + Sync + 'static
{
    /// At rest, with the excitation that acts at the start.
    fn at_rest(scene: &Scene, machine: &Machine, driven: Driven<'_>) -> Self;
    /// These displacements and rates with the parameters of another scene.
    fn with_parameters(&self, scene: &Scene, machine: &Machine) -> Self;
    /// How many coordinates one step updates, those of the casing included.
    fn coordinates(&self) -> usize;
    /// Which blades are one row.
    fn table(&self) -> &RowTable;
    /// `alpha_c + i alpha_s`, where the blades have the phases of the casing wave, so
    /// that the gaps are those of the polygon at `z - kappa l_b (alpha_c + i alpha_s)`.
    fn wave(&self) -> Option<Plane>;
    /// One step without contact, which corrects it afterwards.
    fn predict(&mut self, driven: Driven<'_>);
    /// Angle of a row \[rad\].
    fn angle(&mut self, row: u32) -> f64;
    /// Angle of a row two steps before \[rad\].
    fn angle_before(&mut self, row: u32) -> f64;
    /// Angle of row `a` per unit torque on row `b` over one step \[rad/(N m)\].
    fn compliance(&self, a: u32, b: u32) -> f64;
    /// Correction of the step by a torque on a row \[N m\].
    fn correct(&mut self, row: u32, torque: f64);
    /// Corrects the start for a torque that acts at it: the step before it, only.
    fn begin(&mut self, row: u32, torque: f64);
    /// A bound on every blade angle now \[rad\].
    fn bound(&mut self) -> f64;
    /// The rows with their angles, and how far these may be off \[rad\].
    fn estimates(&mut self) -> (&RowTable, &[f64], f64);
    /// The largest blade angle now \[rad\].
    fn largest(&mut self) -> f64;
    /// The largest about the mean of all blades; of two modes, their amplitude \[rad\].
    fn swing(&mut self) -> f64;
    /// Energy between the last two steps \[J\].
    fn energy(&self) -> f64;
    /// Lost in the damping of the last step, and the work of the excitation in it \[J\].
    fn flows(&self) -> [f64; 2];
    /// A bound on every blade angle that free motion can still reach \[rad\].
    fn reach(&self) -> f64;
    /// `[alpha_c, alpha_s]`, and the means of their last two increments.
    fn modal(&self) -> ([f64; 2], [f64; 2]);
    /// The angle of every blade \[rad\].
    fn every_angle(&self) -> Vec<f64>;
}

/// Energy lost in damping is this times the square of two increments \[J/rad^2\] or
/// \[J/m^2\].
pub(super) fn loss_of(oscillator: &Oscillator) -> f64 {
    oscillator.loss / (4.0 * oscillator.compliance)
}

/// Half a step of acceleration by a unit force, `h^2/2m`.
pub(super) fn half_step(oscillator: &Oscillator) -> f64 {
    oscillator.compliance / (1.0 + oscillator.ratio)
}
