//! Whirl in the limit of many blades, where the contact polygon becomes a circle (docs/theory.md,
//! section 10): a travelling wave of contact forces that both structures carry, each at its own
//! frequency, and the rotor speeds at which it begins. These are folds, where an attracting wave
//! and its threshold appear as a pair.
//!
//! The relative displacement of casing and tips, `w = z - kappa l_b a`, has a constant magnitude
//! and turns at `s` in the blade frame. The force `p = w/B(omega)` must point against it, so
//! `Im B = 0` and `Re B < 0`. `Im B |L_c|^2 |L_a|^2` is a polynomial of degree six in `omega`, all
//! of whose roots are found.
//!
//! Read [`round_whirls`] (the waves at a speed), then [`whirl_onsets`] (the folds over speed).

use nalgebra::{Complex, DMatrix};
use serde::Serialize;

use super::joint::Joint;
use crate::model::Machine;
use crate::numeric::bisection::bisected;
use crate::numeric::eigen::eigenvalues;
use crate::numeric::real_roots::{Coefficients, Point, product, real_roots, sum};
use crate::tolerances::{
    BESIDE_A_FOLD, BRANCH_CHANGES, ONSET_FURTHEST, ONSET_STRIDE, REAL_COMPLIANCE,
};

/// A wave that runs round both structures, per unit of `|w|`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
    /// Whether neighbouring motions with rigid contact converge to the wave. Of a pair it is the
    /// stiffer one that attracts; the other is the threshold between it and rest.
    pub attracts: bool,
    /// Growth rate of the least stable small motion about the wave with rigid contact, other than a
    /// shift in time; negative if the wave attracts \[1/s\].
    pub growth_per_s: f64,
}

/// Returns every round whirl at one speed, by increasing stiffness. Empty if blades and casing are
/// not coupled by a single wave ([`Joint::has_one_wave`]), and without any dissipation, where the
/// frequency is arbitrary.
#[must_use]
pub fn round_whirls(joint: &Joint) -> Vec<RoundWhirl> {
    let machine = &*joint.machine;
    if !Joint::has_one_wave(machine) {
        return Vec::new();
    }
    let scaled = Scaled::new(joint);
    let breaks = [
        0.0,
        1.0,
        -1.0,
        scaled.turn,
        scaled.turn + scaled.blade_rate,
        scaled.turn - scaled.blade_rate,
    ];
    let roots = real_roots(&|from, to| scaled.imaginary(from, to), &breaks);
    let waves = roots.iter().filter_map(|root| scaled.wave(joint, root * machine.omega_c));
    let mut waves: Vec<RoundWhirl> = waves.collect();
    waves.sort_by(|a, b| a.stiffness_n_per_m.total_cmp(&b.stiffness_n_per_m));
    waves
}

/// Loads of a round whirl with rigid contact, `|w| = g0`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
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
    /// Returns the loads at the clearance of the machine. Without friction the rotor power is the
    /// sum of both dampers: the casing receives the part `omega/nu` and the blades `|s|/nu` (Manley
    /// and Rowe).
    #[must_use]
    pub fn loads(&self, joint: &Joint) -> RoundWhirlLoads {
        let machine = &*joint.machine;
        let clearance = machine.clearance();
        let push = self.stiffness_n_per_m * clearance;
        let (casing, blades) = (self.casing_per_w * clearance, self.blades_per_w * clearance);
        let radius = machine.blade_length + clearance;
        let sliding = joint.nu.abs() / machine.nodal_diameters * radius;
        RoundWhirlLoads {
            push_n: push,
            casing_m: casing,
            blade_rad: blades,
            casing_w: machine.casing_damping * (self.omega_rad_s * casing).powi(2),
            blades_w: machine.blade_modal_damping * (self.s_rad_s * blades).powi(2),
            friction_w: machine.friction * push * sliding,
        }
    }

    /// Returns the stiffest wave that attracts.
    #[must_use]
    pub fn lasting(waves: &[Self]) -> Option<Self> {
        waves.iter().rev().find(|wave| wave.attracts).copied()
    }
}

/// Both structures in units of their stiffnesses, with frequencies in units of `omega_c`.
struct Scaled {
    /// Wave frequency in the blade frame, `nu/omega_c`.
    turn: f64,
    /// Blade frequency, `omega_bd/omega_c`.
    blade_rate: f64,
    casing_damping: f64,
    blade_damping: f64,
    casing_friction: f64,
    /// Coupling, `c2 k_c/k_a`.
    coupling: f64,
}

impl Scaled {
    fn new(joint: &Joint) -> Self {
        let machine = &*joint.machine;
        Self {
            turn: joint.nu / machine.omega_c,
            blade_rate: machine.omega_bd / machine.omega_c,
            casing_damping: 2.0 * machine.casing_damping_ratio,
            blade_damping: 2.0 * machine.blade_damping_ratio,
            casing_friction: joint.casing_friction,
            coupling: joint.coupling_product * machine.casing_stiffness
                / machine.blade_modal_stiffness,
        }
    }

    /// Returns `Im B |L_c|^2 |L_a|^2` on an interval of frequencies.
    fn imaginary(&self, from: Point, to: Point) -> Coefficients {
        // Frequency seen by the blades, y = s/omega_bd.
        let seen = |u: Point| (u.p - self.turn * u.q) / self.blade_rate;
        let stiff = |x: f64, y: f64, u: Point, v: Point| u.q * v.q - x * y;
        let drag = |x: f64, y: f64, u: Point, v: Point| 0.5 * (x * v.q + y * u.q);
        let quadratic = |of: &dyn Fn(Point, Point) -> f64| Coefficients::quadratic(from, to, of);
        let casing = [
            quadratic(&|u, v| stiff(u.p, v.p, u, v)),
            quadratic(&|u, v| self.casing_damping * drag(u.p, v.p, u, v)),
        ];
        let blades = [
            quadratic(&|u, v| stiff(seen(u), seen(v), u, v)),
            quadratic(&|u, v| self.blade_damping * drag(seen(u), seen(v), u, v)),
        ];
        let square =
            |[re, im]: &[Coefficients; 2]| sum(1.0, &product(re, re), 1.0, &product(im, im));
        let driven = sum(self.casing_friction, &casing[0], -1.0, &casing[1]);
        let casing_part = product(&driven, &square(&blades));
        let blade_part = product(&blades[1], &square(&casing));
        sum(1.0, &casing_part, -self.coupling, &blade_part)
    }

    /// Returns the wave at a root \[rad/s\]; `None` if it would have to pull.
    fn wave(&self, joint: &Joint, omega: f64) -> Option<RoundWhirl> {
        let compliance = joint.compliance(omega);
        // At an undamped resonance both parts of B change sign through infinity; such roots are
        // dropped.
        let real = compliance.im.abs() <= REAL_COMPLIANCE * compliance.re.abs();
        if !(real && compliance.re < 0.0 && compliance.re.is_finite()) {
            return None;
        }
        let stiffness = -compliance.re.recip();
        let s = omega - joint.nu;
        let turned = Complex::new(1.0, joint.casing_friction);
        let growth = self.growth(joint, omega / joint.machine.omega_c)?;
        Some(RoundWhirl {
            omega_rad_s: omega,
            s_rad_s: s,
            stiffness_n_per_m: stiffness,
            casing_per_w: stiffness * (turned / joint.casing_stiffness(omega)).norm(),
            blades_per_w: stiffness * joint.blade_lever() / joint.blade_stiffness(s).norm(),
            attracts: growth < 0.0,
            growth_per_s: growth * joint.machine.omega_c,
        })
    }

    /// Returns the growth rate of small motions about a wave, in units of `omega_c`. If the wave
    /// runs slightly ahead, the contact force keeps its direction; with `G = 1/B` and the growth
    /// rate `l`, `G(x - i l) + conj G(x - i conj l) = 2 G(x)`. One root is zero, the shift in time,
    /// and is removed.
    fn growth(&self, joint: &Joint, x: f64) -> Option<f64> {
        let y = (x - self.turn) / self.blade_rate;
        let i = Complex::i();
        // Dynamic stiffnesses at x - i l, in powers of l.
        let structure = |x: f64, rate: f64, damping: f64| {
            [
                Complex::new(1.0 - x * x, damping * x),
                (i * 2.0 * x + damping) / rate,
                Complex::new(1.0 / (rate * rate), 0.0),
            ]
        };
        let casing = structure(x, 1.0, self.casing_damping);
        let blades = structure(y, self.blade_rate, self.blade_damping);
        let turned = Complex::new(1.0, self.casing_friction);
        let both = |j: usize| blades[j] * turned + casing[j] * self.coupling;
        let over = convolved(&casing, &blades);
        let under = [both(0), both(1), both(2)];
        let mirror: Vec<_> = under.iter().map(Complex::conj).collect();
        let (crossed, square) = (convolved(&over, &mirror), convolved(&under, &mirror));
        let here = (joint.compliance(x * joint.machine.omega_c) * joint.machine.casing_stiffness)
            .re
            .recip();
        let size = crossed.len() - 1;
        let row = |power: usize| {
            let squared = square.get(power).map_or(0.0, |value| value.re);
            2.0 * (crossed[power].re - here * squared)
        };
        let leading = row(size);
        // Companion matrix of the polynomial after the root at zero is removed.
        let matrix = DMatrix::from_fn(size - 1, size - 1, |r, c| match (r, c) {
            (0, c) => -row(size - 1 - c) / leading,
            (r, c) => f64::from(u8::from(r == c + 1)),
        });
        let values = eigenvalues(matrix)?;
        Some(values.iter().map(|value| value.re).fold(f64::NEG_INFINITY, f64::max))
    }
}

fn convolved(a: &[Complex<f64>], b: &[Complex<f64>]) -> Vec<Complex<f64>> {
    let mut product = vec![Complex::new(0.0, 0.0); (a.len() + b.len()).saturating_sub(1)];
    for (i, x) in a.iter().enumerate() {
        for (slot, y) in product.iter_mut().skip(i).zip(b) {
            *slot += x * y;
        }
    }
    product
}

/// A speed at which a pair of waves appears or vanishes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WhirlOnset {
    /// Rotor speed; negative for backward rotation \[rad/s\].
    pub speed_rad_s: f64,
    /// Whether the pair exists above this speed and not below.
    pub appears: bool,
    /// One of the two waves, which are equal there.
    pub wave: RoundWhirl,
}

/// Returns the lowest speed at which whirl begins, for a rotor that turns in the direction of the
/// sign of `toward` \[rad/s\]. `None` if there is none up to `ONSET_FURTHEST` times the dangerous
/// coincidence, or if the lining is too soft for that wave.
#[must_use]
pub fn whirl_onset(machine: &Machine, toward: f64) -> Option<f64> {
    beginnings(machine, toward, true).first().copied()
}

/// Returns every speed at which whirl begins, in increasing order; see [`whirl_onset`].
#[must_use]
pub fn whirl_beginnings(machine: &Machine, toward: f64) -> Vec<f64> {
    beginnings(machine, toward, false)
}

fn beginnings(machine: &Machine, toward: f64, first: bool) -> Vec<f64> {
    // Pairs of waves exist only if both structures are coupled.
    if machine.coupling_product_at(toward) == 0.0 {
        return Vec::new();
    }
    // The wave stiffness of a lining never exceeds N k/4 by lift-off for half of each revolution.
    let softest = machine.lining.map(|lining| lining.stiffness_n_per_m);
    let most = softest.map_or(f64::INFINITY, |k| 0.25 * f64::from(machine.polygon.blades) * k);
    let onsets = search_onsets(machine, toward, first).into_iter();
    let begin = onsets.filter(|onset| onset.appears && onset.wave.stiffness_n_per_m <= most);
    begin.map(|onset| onset.speed_rad_s).collect()
}

/// Returns every fold of round whirl, in increasing order of speed, for a rotor that turns in the
/// direction of the sign of `toward`.
#[must_use]
pub fn whirl_onsets(machine: &Machine, toward: f64) -> Vec<WhirlOnset> {
    search_onsets(machine, toward, false)
}

/// Searches for the folds: all of them, or up to the first at which a pair appears, which is much
/// faster.
fn search_onsets(machine: &Machine, toward: f64, first: bool) -> Vec<WhirlOnset> {
    if machine.nodal_diameters == 0.0 {
        return Vec::new();
    }
    // Scale of the search: the coincidence without stiffening.
    let dangerous = (machine.omega_c + machine.omega_bd_at_rest()) / machine.nodal_diameters;
    let closed = machine.closing_speed().filter(|_| machine.lining.is_none());
    let sense = if toward < 0.0 { -1.0 } else { 1.0 };
    let waves = |speed: f64| round_whirls(&Joint::at(machine, sense * speed));
    let mut found: Vec<WhirlOnset> = Vec::new();
    let mut low = dangerous / ONSET_FURTHEST;
    let mut at_low = waves(low);
    while low < dangerous * ONSET_FURTHEST && !(first && found.iter().any(|onset| onset.appears)) {
        let high = low * ONSET_STRIDE;
        let at_high = waves(high);
        for (speed, below, above) in changes((low, at_low), (high, at_high.len()), &waves) {
            // A single wave that appears or vanishes does so with an infinite force and is not a
            // fold.
            let appears = above.len() > below.len();
            let (few, many) = if appears { (below, above) } else { (above, below) };
            if many.len() < few.len() + 2 || closed.is_some_and(|closed| speed >= closed) {
                continue;
            }
            let there = waves(speed);
            let distinct = if there.len() == many.len() { there } else { many };
            let speed_rad_s = sense * speed;
            found.extend(closest(&distinct).map(|wave| WhirlOnset { speed_rad_s, appears, wave }));
        }
        (low, at_low) = (high, at_high);
    }
    found
}

/// Returns the speeds between two at which the number of waves changes, with the waves slightly
/// below and above. Closer to the fold, round-off can merge or lose its two waves.
fn changes(
    (low, mut before): (f64, Vec<RoundWhirl>),
    (high, last): (f64, usize),
    waves: &impl Fn(f64) -> Vec<RoundWhirl>,
) -> Vec<(f64, Vec<RoundWhirl>, Vec<RoundWhirl>)> {
    let mut found = Vec::new();
    let mut start = low;
    while before.len() != last && found.len() < BRANCH_CHANGES {
        let [below, above] = bisected([start, high], |speed| waves(speed).len() != before.len());
        start = (above * (1.0 + BESIDE_A_FOLD)).min(high);
        let after = waves(start);
        let less = waves(below * (1.0 - BESIDE_A_FOLD));
        found.push((above, less, after.clone()));
        before = after;
    }
    found
}

/// Returns the stiffer of the two waves that are nearest to each other in frequency.
fn closest(waves: &[RoundWhirl]) -> Option<RoundWhirl> {
    let apart = |pair: &[RoundWhirl]| match pair {
        [one, other] => (one.omega_rad_s - other.omega_rad_s).abs(),
        _ => f64::INFINITY,
    };
    let nearest = waves.windows(2).min_by(|a, b| apart(a).total_cmp(&apart(b)))?;
    nearest.last().copied()
}
