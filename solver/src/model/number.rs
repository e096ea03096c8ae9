//! Number type of the model's formulas.

use num_dual::DualNum;

/// Real number: `f64`, or a dual number of the crate `num_dual`, which carries derivatives. The
/// same formula then yields a value and its sensitivity to a parameter.
pub trait Number: DualNum<Primitive = f64> + Copy {}

impl<T: DualNum<Primitive = f64> + Copy> Number for T {}
