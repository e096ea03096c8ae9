//! The numbers that the formulas of the model take.

use num_dual::DualNum;

/// A real number, alone (`f64`) or with its derivative by a parameter (dual numbers
/// of the crate `num_dual`): the same formula gives a value and how it changes.
pub trait Number: DualNum<Primitive = f64> + Copy {}

impl<T: DualNum<Primitive = f64> + Copy> Number for T {}
