//! Small numerical tools that know nothing of blades: each says its error and its bound
//! of work.

pub(crate) mod bisection;
pub(crate) mod eigen;
pub(crate) mod elimination;
pub(crate) mod lcp;
pub(crate) mod lyapunov;
pub(crate) mod maximum;
pub(crate) mod normal;
pub(crate) mod quadrature;
pub(crate) mod real_roots;
pub mod rounding;
pub(crate) mod sum;

/// Whether a number is zero; serde asks so what it may leave out.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde gives a reference")]
pub(crate) fn is_zero(number: &f64) -> bool {
    *number == 0.0
}
