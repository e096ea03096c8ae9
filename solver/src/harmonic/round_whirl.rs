//! Whirl in the limit of many blades, in which the contact polygon becomes a circle (docs/theory.md,
//! section 10): a travelling wave of contact forces that drives casing and blades; the ranges of
//! rotor speed in which such a wave lasts, and those in which rubbing grows without bound.
//!
//! The relative displacement of casing and tips, `w = z - kappa l_b a`, has a constant magnitude
//! and turns at `s` in the blade frame. The force `p = w/B(omega)` must point against it, so
//! `Im B = 0` and `Re B < 0`. Waves appear and vanish in pairs, an attracting one and its threshold.
//! At a speed without an attracting wave at which blades and casing in lasting contact flutter
//! (`B = 0` has a growing root), a sufficiently large rub grows without bound.
//!
//! Read [`round_whirls`] (the waves at a speed), then [`Rubbing`] and [`whirl_spans`].

use strum::IntoStaticStr;

use super::windows::{FURTHEST, joined_grow, windows};
use crate::model::{Frame, LockWindow, Machine, Row, Structure, growth_about_wave};
use crate::numeric::real_roots::{product, real_roots};

/// Imaginary part of the joint compliance at a root, relative to the real part, up to which it counts
/// as round-off. With a larger one an undamped resonance would count as a whirl.
const REAL_COMPLIANCE: f64 = 1e-6;

/// Largest frequency in the search for waves, relative to the sum of all frequencies.
const WAVE_FURTHEST: f64 = 1e6;

/// Difference of frequencies, relative to that sum, below which two waves may be missed.
const WAVE_APART: f64 = 1e-10;

/// A wave that runs round both structures, per unit of `|w|`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundWhirl {
    /// Frequency in the stationary frame; negative turns backward \[rad/s\].
    pub omega_rad_s: f64,
    /// Frequency in the blade frame, `s = omega - nu`; negative if the contact passes backward over
    /// the blades of a rotor that turns forward \[rad/s\].
    pub s_rad_s: f64,
    /// Contact force divided by amplitude, `S = |p|/|w| = -1/Re B` \[N/m\].
    pub stiffness_n_per_m: f64,
    /// Amplitude of the casing, `|z|/|w|`.
    pub casing_per_w: f64,
    /// Amplitude of the blades, `|a|/|w|` \[rad/m\].
    pub blades_per_w: f64,
    /// Whether neighbouring motions with rigid contact converge to the wave. The stiffer wave of a
    /// pair attracts; the other is the threshold between it and rest.
    pub attracts: bool,
    /// Growth rate of the least stable small motion about the wave with rigid contact, other than a
    /// shift in time; negative if the wave attracts \[1/s\].
    pub growth_per_s: f64,
}

/// Returns every round whirl at one rotor speed \[rad/s\], by increasing stiffness. Empty if blades
/// and casing are not coupled by a single wave, and without any dissipation, where the frequency is
/// arbitrary.
#[must_use]
pub fn round_whirls(machine: &Machine, speed: f64) -> Vec<RoundWhirl> {
    let (frame, found) = pushing(machine, speed);
    found.into_iter().filter_map(|wave| RoundWhirl::new(&frame, wave)).collect()
}

/// Returns frequency \[rad/s\] and stiffness \[N/m\] of every wave whose contact pushes, by increasing
/// stiffness.
fn pushing(machine: &Machine, speed: f64) -> (Frame, Vec<(f64, f64)>) {
    let frame = Frame::at(machine, speed);
    if !has_one_wave(machine) {
        return (frame, Vec::new());
    }
    let roots = real_compliances(&frame);
    let mut waves: Vec<(f64, f64)> =
        roots.into_iter().filter_map(|omega| Some((omega, stiffness(&frame, omega)?))).collect();
    waves.sort_by(|a, b| a.1.total_cmp(&b.1));
    (frame, waves)
}

/// Returns whether blades and casing are coupled by a single travelling wave: `N' >= 3`, and the disk
/// modes have the nodal diameters of the casing or an alias of them, `+-n_d` modulo `N`.
#[must_use]
pub fn has_one_wave(machine: &Machine) -> bool {
    let blades = f64::from(machine.polygon.blades);
    let (disk, casing) = (machine.blade_diameters, machine.nodal_diameters);
    let meets = |sense: f64| (disk + sense * casing).rem_euclid(blades) == 0.0;
    machine.polygon.has_corners() && (meets(1.0) || meets(-1.0))
}

/// Returns the frequencies at which `Im B = 0` \[rad/s\]: the roots of a polynomial of degree 6,
/// `Im B |L_c|^2 |L_a|^2` in units of the stiffnesses.
fn real_compliances(frame: &Frame) -> Vec<f64> {
    let (friction, turn) = (frame.friction, frame.casing.turn);
    let coupling = frame.coupling() * frame.casing.stiffness / frame.blades.stiffness;
    let imaginary = |omega: f64| {
        let casing = frame.casing.dynamic_stiffness(omega) / frame.casing.stiffness;
        let blades = frame.blades.dynamic_stiffness(omega - turn) / frame.blades.stiffness;
        (friction * casing.re - casing.im) * blades.norm_sqr()
            - coupling * blades.im * casing.norm_sqr()
    };
    let between = |[from, to]: [f64; 2]| -> [f64; 7] {
        let casing = Between::of(&frame.casing, [from, to]);
        let blades = Between::of(&frame.blades, [from - turn, to - turn]);
        let of_casing: [f64; 3] =
            std::array::from_fn(|k| friction * casing.real[k] - casing.imaginary[k]);
        let left: [f64; 7] = product(of_casing, blades.norm_sqr());
        let right: [f64; 7] = product(blades.imaginary, casing.norm_sqr());
        std::array::from_fn(|k| left[k] - coupling * right[k])
    };
    let (casing, blades) = (frame.casing.own_frequency(), frame.blades.own_frequency());
    let fastest = casing + blades + turn.abs();
    let furthest = WAVE_FURTHEST * fastest;
    let mut ends = [-furthest, -casing, casing, turn - blades, turn, turn + blades, 0.0, furthest];
    ends.sort_by(f64::total_cmp);
    real_roots(&ends, WAVE_APART * fastest, imaginary, between)
}

/// Dynamic stiffness of a structure between two frequencies, in units of its stiffness, as lists of
/// `numeric::real_roots`.
struct Between {
    real: [f64; 3],
    imaginary: [f64; 3],
}

impl Between {
    fn of(of: &Structure, [from, to]: [f64; 2]) -> Self {
        let own = of.own_frequency();
        let slower = [from, to].map(|omega| (own - omega) / own);
        let faster = [from, to].map(|omega| (own + omega) / own);
        let damping = [from, to].map(|omega| omega * of.damping / of.stiffness);
        Self { real: product(slower, faster), imaginary: product(damping, [1.0; 2]) }
    }

    fn norm_sqr(&self) -> [f64; 5] {
        let [real, imaginary]: [[f64; 5]; 2] =
            [self.real, self.imaginary].map(|part| product(part, part));
        std::array::from_fn(|k| real[k] + imaginary[k])
    }
}

/// Returns the stiffness `-1/Re B` of the wave at a root \[rad/s\]; `None` if it would have to pull.
fn stiffness(frame: &Frame, omega: f64) -> Option<f64> {
    let compliance = frame.turning(omega - frame.casing.turn).compliance();
    // At an undamped resonance both parts of B change sign through infinity; such roots are dropped.
    let real = compliance.im.abs() <= REAL_COMPLIANCE * compliance.re.abs();
    let pushes = real && compliance.re < 0.0 && compliance.re.is_finite();
    pushes.then(|| -compliance.re.recip())
}

/// Loads of a round whirl with rigid contact, `|w| = g0`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoundWhirlLoads {
    /// Total contact force \[N\].
    pub push_n: f64,
    /// Amplitude `|z|` of the casing \[m\].
    pub casing_m: f64,
    /// Amplitude `|a|` of the blades \[rad\].
    pub blade_rad: f64,
    /// Power of the casing damping, `d_c omega^2 |z|^2` \[W\].
    pub casing_w: f64,
    /// Power of the blade damping, `d_a s^2 |a|^2` \[W\].
    pub blades_w: f64,
    /// Friction heat of tips sliding on the casing, `mu |p| |Omega| R_c` \[W\].
    pub friction_w: f64,
}

impl RoundWhirl {
    /// Creates the wave of a frequency \[rad/s\] and stiffness \[N/m\]; `None` if its small motions
    /// cannot be computed.
    fn new(frame: &Frame, (omega, stiffness): (f64, f64)) -> Option<Self> {
        let s = omega - frame.casing.turn;
        let turning = frame.turning(s);
        // The magnitude |w| is held, and the force keeps pointing against w.
        let [radial, tangential] = [(1.0, 0.0), (0.0, 1.0)].map(|way| Row::fixed(&turning, way));
        let growth = growth_about_wave(&turning.motion(&[radial], &[(tangential, stiffness)]))?;
        let [casing, blades] = [(&frame.casing, omega), (&frame.blades, s)]
            .map(|(of, at)| of.dynamic_stiffness(at).norm());
        Some(Self {
            omega_rad_s: omega,
            s_rad_s: s,
            stiffness_n_per_m: stiffness,
            casing_per_w: stiffness * frame.friction.hypot(1.0) / casing,
            blades_per_w: stiffness * frame.lever.abs() / blades,
            attracts: growth < 0.0,
            growth_per_s: growth,
        })
    }

    /// Returns the loads at the clearance of a machine at a rotor speed \[rad/s\]. Without friction
    /// the rotor power is the sum of both dampers: the casing receives the part `omega/nu` and the
    /// blades `|s|/nu` (Manley and Rowe).
    #[must_use]
    pub fn loads(&self, machine: &Machine, speed: f64) -> RoundWhirlLoads {
        let machine = &*machine.at(speed);
        let clearance = machine.clearance();
        let push = self.stiffness_n_per_m * clearance;
        let (casing, blades) = (self.casing_per_w * clearance, self.blades_per_w * clearance);
        let radius = machine.blade_length + clearance;
        RoundWhirlLoads {
            push_n: push,
            casing_m: casing,
            blade_rad: blades,
            casing_w: machine.casing_damping * (self.omega_rad_s * casing).powi(2),
            blades_w: machine.blade_modal_damping * (self.s_rad_s * blades).powi(2),
            friction_w: machine.friction * push * speed.abs() * radius,
        }
    }

    /// Returns the stiffest wave that attracts at a rotor speed \[rad/s\]. `None` if there is none,
    /// without clearance, if the tips do not couple casing and blades, and if the lining is too soft
    /// for it: the stiffness of a lining never exceeds `N k/4`, by lift-off for half of each
    /// revolution.
    #[must_use]
    pub fn lasting(machine: &Machine, speed: f64) -> Option<Self> {
        let open = machine.at(speed).clearance() > 0.0;
        // Without coupling, every undamped resonance would count as a whirl.
        if !open || machine.coupling_product_at(speed) == 0.0 {
            return None;
        }
        let softest = machine.lining.map_or(f64::INFINITY, |lining| {
            0.25 * f64::from(machine.polygon.blades) * lining.stiffness_n_per_m
        });
        let (frame, waves) = pushing(machine, speed);
        let mut stiffest_first = waves.into_iter().rev().filter(|wave| wave.1 <= softest);
        stiffest_first.find_map(|wave| Self::new(&frame, wave).filter(|wave| wave.attracts))
    }
}

/// What a sufficiently large rub becomes, in the limit of many blades.
#[derive(Clone, Copy, Debug, PartialEq, Eq, IntoStaticStr)]
#[strum(serialize_all = "lowercase")]
pub enum Rubbing {
    /// A wave of constant amplitude attracts.
    Whirls,
    /// No wave attracts, and motions with lasting contact grow without bound.
    Grows,
    /// Neither.
    None,
}

impl Rubbing {
    /// Classifies a rotor speed \[rad/s\].
    #[must_use]
    pub fn at(machine: &Machine, speed: f64) -> Self {
        if RoundWhirl::lasting(machine, speed).is_some() {
            Self::Whirls
        } else if grows(machine, speed) {
            Self::Grows
        } else {
            Self::None
        }
    }
}

/// Returns whether rubbing grows without bound at a speed at which no wave attracts \[rad/s\].
fn grows(machine: &Machine, speed: f64) -> bool {
    let rigid = machine.lining.is_none() && machine.at(speed).clearance() > 0.0;
    rigid && has_one_wave(machine) && joined_grow(machine, speed)
}

/// Returns the ranges of speed in which a wave attracts, in increasing order, for a rotor that turns
/// in the direction of the sign of `toward`.
#[must_use]
pub fn whirl_spans(machine: &Machine, toward: f64) -> Vec<LockWindow> {
    if machine.coupling_product_at(toward) == 0.0 || !has_one_wave(machine) {
        return Vec::new();
    }
    let sense = 1_f64.copysign(toward);
    let rigid = machine.clone().with_lining(None);
    let spans = windows(machine, FURTHEST, &[], |speed| {
        RoundWhirl::lasting(&rigid, sense * speed).is_some()
    });
    if machine.lining.is_none() {
        return spans;
    }
    // On a lining a range may end soon after it begins.
    let begins: Vec<f64> = spans.iter().map(|span| span.from).collect();
    windows(machine, FURTHEST, &begins, |speed| {
        RoundWhirl::lasting(machine, sense * speed).is_some()
    })
}
