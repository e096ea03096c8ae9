//! Those of the harmonic balance.

/// Newton steps from one start; five are usual.
pub(crate) const NEWTON_STEPS: usize = 40;

/// How much a Newton step must shrink: by half where the branch is about to
/// fold, and a little room. Larger: a start may end on another branch.
pub(crate) const NEWTON_SHRINK: f64 = 0.75;

/// Largest Newton step, as a part of the unknowns, and of the turns \[rad\], in
/// which alone the equations are not bilinear.
pub(crate) const NEWTON_LARGEST: f64 = 0.1;

/// How much the determinant may change from one softness to the next: it goes
/// to zero at a fold, and is another one on another branch.
pub(crate) const NEWTON_ALIKE: std::ops::Range<f64> = 0.5..2.0;

/// Shortest stride of the softness.
pub(crate) const NEWTON_STRIDE: f64 = 1e-6;

/// Most strides of the softness.
pub(crate) const NEWTON_STRIDES: usize = 500;

/// Part of an angle at which Newton steps that no longer shrink have converged.
pub(crate) const CONVERGED: f64 = 1e-7;

/// Most changes of character looked for between two neighbouring speeds.
pub(crate) const BRANCH_CHANGES: usize = 16;

/// Real parts of eigenvalues up to this part of the rate are round-off: a
/// nearly defective pair is known to half its digits.
pub(crate) const NEUTRAL: f64 = 1e-8;

/// Part of its terms that the last Hurwitz determinant must be for its sign to
/// be clear; else eigenvalues are asked.
pub(crate) const CLEAR_SIGN: f64 = 1e-9;

/// As `CLEAR_SIGN`, for the coefficients of odd order.
pub(crate) const CLEAR_DAMPING: f64 = 1e-6;

/// Imaginary part of the joint compliance at a root, as a part of the real part, up to
/// which it is round-off. Larger: an undamped resonance is taken for a whirl.
pub(crate) const REAL_COMPLIANCE: f64 = 1e-6;

/// Ratio of neighbouring speeds at which round whirls are counted, before the
/// speeds where their number changes are halved in. Larger: a pair that lives for less
/// than this is missed.
pub(crate) const ONSET_STRIDE: f64 = 1.05;

/// Onsets are looked for up to this many times the dangerous coincidence.
pub(crate) const ONSET_FURTHEST: f64 = 20.0;

/// Part of the speed beside a fold at which its two waves are told apart for certain.
/// Smaller: round-off of the double root is taken for a change.
pub(crate) const BESIDE_A_FOLD: f64 = 1e-10;

/// Part of the unknowns of a lock at which steps of Newton's method that no longer
/// shrink are round-off.
pub(crate) const POLISHED: f64 = 1e-11;

/// Flutter of a machine that changes with the speed is looked for up to so many critical
/// speeds, from as small a part of one. Beyond, no rotor turns.
pub(crate) const FLUTTER_FURTHEST: f64 = 100.0;

/// Factor between two speeds at which that growth is asked. Larger: a narrow range of
/// flutter is stepped over.
pub(crate) const FLUTTER_STRIDE: f64 = 1.01;

/// Part of the clearance to which usual casings are round: one per cent. A lock that needs
/// more says so. Larger: every lock says it; smaller: none does.
pub(crate) const ROUND_ENOUGH: f64 = 0.01;
