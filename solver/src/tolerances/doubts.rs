//! From where on a number of a scene looks like a slip of the unit or of the decimal point.
//! Nothing is refused by them: they only make `rubscope check` ask.

/// Largest clearance as a part of the radius. Blade tips run within some tenths of a per
/// cent; larger: millimetres given as metres pass.
pub(crate) const DOUBTFUL_CLEARANCE: f64 = 0.01;

/// Smallest clearance \[m\]: below it surfaces are not round. Larger: machines of a
/// laboratory are doubted.
pub(crate) const DOUBTFUL_GAP: f64 = 1e-6;

/// Largest speed of blade tips \[m/s\]. Metal tips of engines reach some 500. Larger: turns
/// a minute given as radians a second pass for small machines.
pub(crate) const DOUBTFUL_TIP_SPEED: f64 = 800.0;

/// Frequencies of first modes, from and to \[Hz\].
pub(crate) const DOUBTFUL_FREQUENCY: [f64; 2] = [1.0, 2e4];

/// Largest damping ratio. Structures of metal have thousandths to hundredths; larger: per
/// cent given as parts pass.
pub(crate) const DOUBTFUL_DAMPING: f64 = 0.3;

/// Largest ratio of the modal masses of casing and disk, both ways. Larger: grams given as
/// kilograms pass.
pub(crate) const DOUBTFUL_MASSES: f64 = 300.0;
