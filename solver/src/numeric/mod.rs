//! Numerical methods without any mechanics. Each module states its error and its cost.

pub(crate) mod eigen;
pub(crate) mod elimination;
pub(crate) mod lcp;
pub(crate) mod lyapunov;
pub(crate) mod normal;
pub(crate) mod quadrature;
pub(crate) mod real_roots;
pub mod rounding;
pub(crate) mod search;
pub mod spectrum;
pub(crate) mod sum;

/// Returns whether a number is zero. Used with serde's `skip_serializing_if`.
#[expect(clippy::trivially_copy_pass_by_ref, reason = "serde gives a reference")]
pub(crate) fn is_zero(number: &f64) -> bool {
    *number == 0.0
}
