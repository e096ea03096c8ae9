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

/// Imaginary part of the joint compliance at a root, as a part of the real part, up to
/// which it is round-off. Larger: an undamped resonance is taken for a whirl.
pub(crate) const REAL_COMPLIANCE: f64 = 1e-6;

/// Ratio of neighbouring distances from a resonance at which waves are searched. Larger: a pair of
/// waves closer than this may be missed.
pub(crate) const WAVE_RATIO: f64 = 1.6;

/// Waves are searched up to this many times the sum of all frequencies.
pub(crate) const WAVE_FURTHEST: f64 = 1e6;

/// First distance from an undamped resonance, as a part of that sum.
pub(crate) const NARROWEST_PEAK: f64 = 1e-10;

/// Part of the unknowns of a lock at which steps of Newton's method that no longer
/// shrink are round-off.
pub(crate) const POLISHED: f64 = 1e-11;

/// Part of the clearance to which usual casings are round: one per cent. A lock that needs
/// more says so. Larger: every lock says it; smaller: none does.
pub(crate) const ROUND_ENOUGH: f64 = 0.01;

/// Speeds are searched from the critical speed divided by this.
pub(crate) const NEAREST: f64 = 20.0;

/// Whirl and flutter are searched up to this many times the fastest of critical speed and
/// coincidence. Beyond, no rotor turns.
pub(crate) const FURTHEST: f64 = 50.0;

/// The same of a lock, whose pushes grow with the square of the speed.
pub(crate) const LOCK_FURTHEST: f64 = 10.0;

/// Ratio of neighbouring speeds of a search. Larger: a range narrower than this is stepped over.
pub(crate) const SCAN_RATIO: f64 = 1.03;

/// Part of a lock speed up to which it is that of rigid blades in closed form: the slope of the gap
/// beside the middle of a side makes a thousandth. Larger: blades that bend are said not to.
pub(crate) const CLOSED_FORM: f64 = 2e-3;

/// Part of a speed beside a known end at which a condition is asked.
pub(crate) const BESIDE_AN_END: f64 = 1e-6;

/// Turn of a side by its bent blades \[rad\], as a part of the damping ratio, up to which it makes no
/// motion grow. Larger: a lock that flutters is said to hold; smaller: only more is searched.
pub(crate) const TURN_BESIDE_DAMPING: f64 = 0.1;
