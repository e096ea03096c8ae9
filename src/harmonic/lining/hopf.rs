//! Where rest under preload begins to grow and ends to: Hopf points in speed, the
//! coincidence that the lining shifts, and the least lining that grows at all
//! (docs/theory.md, section 10).
//!
//! The growth changes over a width of speed that damping and joint stiffness set; the
//! scan has eight points in each such width around every coincidence, and a thousand
//! over the whole range. Every extremum of the scan is refined, so that a change of sign
//! and back between two points is seen too.

use serde::Serialize;

use super::law::between;
use super::roots::Quartic;
use super::{Lining, Rest};
use crate::harmonic::{HarmonicError, Joint};
use crate::model::Machine;
use crate::numeric::maximum::highest;
use crate::tolerances::{GROWTH_SCAN, PEAK_REACH, TONGUE_SCAN};

/// A speed where a wave about rest begins or ends to grow.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct HopfPoint {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Frequency of the wave in the frame of the blades \[rad/s\].
    pub s_rad_s: f64,
    /// Its frequency in the standing frame \[rad/s\].
    pub omega_rad_s: f64,
    /// Whether it grows at larger speeds.
    pub grows_above: bool,
}

/// The dangerous coincidence, with the frequencies that blades and casing have while
/// all blades touch the lining.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ShiftedCoincidence {
    /// `(omega_c' +- omega_bd')/n_d`, minus for a coupling product below zero \[rad/s\].
    pub speed_rad_s: f64,
    /// `omega_c' = sqrt((k_c + S0)/m_c)` \[rad/s\].
    pub casing_rad_s: f64,
    /// `omega_bd' = sqrt(omega_bd^2 + S0 c2/m_a)` \[rad/s\].
    pub blades_rad_s: f64,
}

/// The least lining that makes rest grow, at the speed where it grows first.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct GrowthThreshold {
    /// Stiffness `S0` of all blades together \[N/m\].
    pub stiffness_n_per_m: f64,
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
}

/// The coincidence of a machine whose blades together have a stiffness \[N/m\], in the
/// sense of rotation of `sense`; `None` for blades that nothing comes back to.
fn shifted(machine: &Machine, stiffness: f64, sense: f64) -> Option<ShiftedCoincidence> {
    let product = machine.coupling_product_at(sense);
    let blades = machine.blade_modal_stiffness + stiffness * product;
    if product == 0.0 || blades < 0.0 {
        return None;
    }
    let casing_rad_s = ((machine.casing_stiffness + stiffness) / machine.casing_mass).sqrt();
    let blades_rad_s = (blades / machine.blade_modal_mass).sqrt();
    let meeting = casing_rad_s + blades_rad_s.copysign(product);
    let speed_rad_s = (meeting / machine.nodal_diameters).copysign(sense);
    Some(ShiftedCoincidence { speed_rad_s, casing_rad_s, blades_rad_s })
}

/// Width in speed over which growth changes around a coincidence \[rad/s\].
fn width(machine: &Machine, stiffness: f64, sense: f64) -> f64 {
    let product = machine.coupling_product_at(sense).abs();
    let casing = (machine.casing_stiffness + stiffness) * machine.casing_mass;
    let blades = machine.blade_modal_stiffness * machine.blade_modal_mass;
    let joined = stiffness * product.sqrt() / (2.0 * (casing * blades).sqrt().sqrt());
    let damped = machine.casing_damping_ratio * machine.omega_c
        + machine.blade_damping_ratio * machine.omega_bd;
    (damped + joined) / machine.nodal_diameters
}

/// Part of the fastest speed up to which a rotor counts as standing.
const BESIDE_REST: f64 = 1e-9;

impl Lining<'_> {
    /// The coincidence at which rest grows fastest, for a rotor that turns in the sense
    /// of `speed`; none with a clearance.
    #[must_use]
    pub fn shifted_coincidence(&self, speed: f64) -> Option<ShiftedCoincidence> {
        let stiffness = self.stiffness_at_rest();
        (stiffness > 0.0).then(|| shifted(self.machine, stiffness, speed)).flatten()
    }

    /// Every speed in a range \[rad/s\] at which the worst growth at rest changes its
    /// sign, in increasing order.
    ///
    /// # Errors
    /// Speeds that are not finite or not in order.
    pub fn hopf_points(&self, [from, to]: [f64; 2]) -> Result<Vec<HopfPoint>, HarmonicError> {
        if !(from.is_finite() && to.is_finite() && from < to) {
            return Err(HarmonicError::Refused {
                key: "speed",
                value: format!("{from}:{to}"),
                allowed: "two speeds, the lower one first".to_string(),
            });
        }
        // Friction turns round where the rotor does, with a jump and no Hopf point.
        if from <= 0.0 && to >= 0.0 && self.machine.friction != 0.0 {
            let mut points = Vec::new();
            for [from, to] in [[from, from * BESIDE_REST], [to * BESIDE_REST, to]] {
                if from < to {
                    points.extend(self.hopf_points([from, to])?);
                }
            }
            return Ok(points);
        }
        let mut rests: Vec<Rest> =
            self.places([from, to]).into_iter().map(|speed| self.rest(speed)).collect();
        let extremes: Vec<Rest> = rests
            .windows(3)
            .filter_map(|three| self.extreme([three[0], three[1], three[2]]))
            .collect();
        rests.extend(extremes);
        rests.sort_by(|a, b| a.speed_rad_s.total_cmp(&b.speed_rad_s));
        let changes = rests.windows(2).filter(|pair| pair[0].grows != pair[1].grows);
        Ok(changes
            .map(|pair| {
                let sign = |speed: f64| if self.rest(speed).grows { 1.0 } else { -1.0 };
                let speed_rad_s = between([pair[0].speed_rad_s, pair[1].speed_rad_s], sign);
                let worst = self.rest(speed_rad_s).worst();
                HopfPoint {
                    speed_rad_s,
                    s_rad_s: worst.s_rad_s,
                    omega_rad_s: worst.omega_rad_s,
                    grows_above: pair[1].grows,
                }
            })
            .collect())
    }

    /// The speeds of the scan, in order.
    fn places(&self, [from, to]: [f64; 2]) -> Vec<f64> {
        let stiffness = self.stiffness_at_rest();
        let part = |k: u32| f64::from(k) / f64::from(GROWTH_SCAN);
        let mut places: Vec<f64> =
            (0..=GROWTH_SCAN).map(|k| from + (to - from) * part(k)).collect();
        let (reach, fine) = TONGUE_SCAN;
        for sense in [-1.0, 1.0] {
            let Some(found) = shifted(self.machine, stiffness, sense) else { continue };
            let stride = width(self.machine, stiffness, sense) / fine;
            for blades in [found.blades_rad_s, -found.blades_rad_s] {
                let middle = sense * (found.casing_rad_s + blades) / self.machine.nodal_diameters;
                places.extend((-reach..=reach).map(|k| middle + stride * f64::from(k)));
            }
        }
        places.retain(|speed| (from..=to).contains(speed));
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    }

    /// The extremum among three neighbours, where it has another sign than they.
    fn extreme(&self, three: [Rest; 3]) -> Option<Rest> {
        let [before, here, after] = three.map(|rest| rest.worst().growth_1_s);
        let sense = if three[1].grows { -1.0 } else { 1.0 };
        let alike = three.iter().all(|rest| rest.grows == three[1].grows);
        if !(alike && sense * here >= sense * before && sense * here >= sense * after) {
            return None;
        }
        let ends = [three[0].speed_rad_s, three[2].speed_rad_s];
        let (speed, _) = highest(ends, |speed| sense * self.rest(speed).worst().growth_1_s);
        let found = self.rest(speed);
        (found.grows != three[1].grows).then_some(found)
    }
}

/// The least stiffness of a lining under preload that makes rest grow at the peak near
/// the coincidence, for a rotor that turns in the sense of `sense`; zero where blades or
/// casing have no damping, none for a machine whose blades and casing are not coupled.
#[must_use]
pub fn growth_threshold(machine: &Machine, sense: f64) -> Option<GrowthThreshold> {
    let product = machine.coupling_product_at(sense).abs();
    let plain = shifted(machine, 0.0, sense)?;
    let inertia = machine.casing_mass * machine.omega_c * machine.blade_modal_mass;
    let damping = machine.casing_damping_ratio * machine.omega_c * machine.blade_damping_ratio;
    // Of weak coupling, at the middle of the tongue.
    let guess = 2.0 * machine.omega_bd * (inertia * damping / product).sqrt();
    if guess == 0.0 {
        let speed_rad_s = plain.speed_rad_s;
        return Some(GrowthThreshold { stiffness_n_per_m: 0.0, speed_rad_s });
    }
    let peak = |stiffness: f64| peak(machine, stiffness, sense);
    let growth = |stiffness: f64| peak(stiffness).map_or(-1.0, |(_, growth)| growth);
    let mut ends = [0.5 * guess, 2.0 * guess];
    // Sixty doublings each way leave no lining that could be built.
    for _ in 0..60 {
        if growth(ends[0]) > 0.0 {
            ends = [0.5 * ends[0], ends[0]];
        } else if growth(ends[1]) <= 0.0 {
            ends = [ends[1], 2.0 * ends[1]];
        } else {
            let stiffness_n_per_m = between(ends, growth);
            let (speed_rad_s, _) = peak(stiffness_n_per_m)?;
            return Some(GrowthThreshold { stiffness_n_per_m, speed_rad_s });
        }
    }
    None
}

/// The speed of the fastest growth near a coincidence, and that growth \[1/s\].
fn peak(machine: &Machine, stiffness: f64, sense: f64) -> Option<(f64, f64)> {
    let middle = shifted(machine, stiffness, sense)?.speed_rad_s;
    let reach = PEAK_REACH * width(machine, stiffness, sense);
    let growth = |speed: f64| {
        Quartic::new(&Joint::at(machine, speed), stiffness).rest(speed).worst().growth_1_s
    };
    let parts = 6.0 * PEAK_REACH;
    let place = |k: f64| middle + reach * (2.0 * k / parts - 1.0);
    let looks = (0..=parts as u32).map(f64::from).map(|k| (k, growth(place(k))));
    let (best, _) = looks.max_by(|a, b| a.1.total_cmp(&b.1))?;
    Some(highest([place(best - 1.0), place(best + 1.0)], growth))
}
