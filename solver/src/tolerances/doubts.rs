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

/// Radius of a casing, from and to \[m\]: from turbochargers to steam turbines. Larger: a
/// radius in millimetres passes.
pub(crate) const DOUBTFUL_RADIUS: [f64; 2] = [0.02, 8.0];

/// Modal mass of casing or disk over the cube of the radius, from and to \[kg/m^3\]. The
/// paper's casing has 16, its disk 73, a whole disk of steel some 6000, a ring of sheet 2;
/// wider by a factor of a thousand: grams and tonnes pass.
pub(crate) const DOUBTFUL_DENSITY: [f64; 2] = [1.0, 6000.0];

/// How far two modes of a structure may lie apart, in frequency and in modal mass: by this
/// factor, times the ratio of their diameters to this power. Rings go with the square to
/// third power of few diameters. Larger: a decimal point that is off by one place passes.
pub(crate) const DOUBTFUL_COURSE: [f64; 2] = [3.0, 3.0];

/// Largest pulse \[N\]. Larger: kilonewtons given as newtons twice pass.
pub(crate) const DOUBTFUL_FORCE: f64 = 1e7;

/// Largest push on one blade tip in the lock \[N\], that of some square centimetres of metal
/// at their strength. Larger: a stiffness or a clearance that is off by a factor of ten passes.
pub(crate) const DOUBTFUL_PUSH: f64 = 2e4;
