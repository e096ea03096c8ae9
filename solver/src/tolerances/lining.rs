//! Those of steady states on a lining.

/// Width of a lining over the amplitude of a wave from which its mean stiffness is a
/// difference of closed forms. Smaller: the difference loses digits. Larger: eight
/// nodes do not give all of them.
pub(crate) const LINING_DIVIDED: f64 = 1e-3;

/// Smallest amplitude of a wave that is looked for, over the preload and the width of
/// the lining: below it no blade lifts off.
pub(crate) const LINING_NARROWEST: f64 = 1e-4;

/// Largest one. Larger: the stiffness differs from that of half contact by less than
/// a part in a thousand million.
pub(crate) const LINING_WIDEST: f64 = 1e9;

/// Strides from one to the other. Fewer: of two amplitudes in one stride neither is
/// found, on a lining that is not pressed in by its whole width.
pub(crate) const LINING_STRIDES: f64 = 400.0;

/// Growth rates up to this part of the fastest frequency are round-off where nothing
/// is damped.
pub(crate) const UNDAMPED_GROWTH: f64 = 1e-11;

/// Speeds of an even scan for changes of the growth at rest.
pub(crate) const GROWTH_SCAN: u32 = 1000;

/// Speeds on each side of a coincidence, and how many of them are in one width of it.
/// Less of either: of a tongue as narrow as damping and lining make it the two ends may
/// be missed.
pub(crate) const TONGUE_SCAN: (i32, f64) = (240, 8.0);

/// Widths of a tongue between its coincidence and the fastest growth, at most.
pub(crate) const PEAK_REACH: f64 = 12.0;

/// Natural logarithms of the excess of a speed over the lock of rigid contact, between
/// which the softest lining is looked for, and looks between them. Smaller: a lining of
/// nearly rigid stiffness has its window outside.
pub(crate) const WINDOW_REACH: [f64; 2] = [-30.0, 15.0];
/// See `WINDOW_REACH`.
pub(crate) const WINDOW_LOOKS: u32 = 450;

/// Distance over the length of the contact up to which two steady states are one.
/// Larger: two that are about to meet in a fold are one too early.
pub(crate) const LINING_ALIKE: f64 = 1e-7;

/// Real part of an eigenvalue over the fastest that is round-off.
pub(crate) const LINING_NEUTRAL: f64 = 1e-10;
