//! Rest with all blades in contact with the lining (docs/theory.md, section 10): the four motions
//! about it, the speeds at which the fastest of them begins or ceases to grow (Hopf points), the
//! coincidence shifted by the lining, and the softest lining with growth.
//!
//! With `S0 = N k_p/2` the roots `s` of `e^{ist}` in the blade frame solve
//! `L_c L_a + S0 [(1 + i mu_c) L_a + c2 L_c] = 0`, with
//! `L_c = k_c - m_c (s + nu)^2 + i d_c (s + nu)` and `L_a = k_a - m_a s^2 + i d_a s`.
//!
//! The growth rate varies over a range of speed that is set by damping and coupling. The scan has
//! eight points in each such range around every coincidence, and a thousand over the whole
//! interval. Every extremum of the scan is refined, so that a pair of sign changes between two
//! points is not missed.

use std::iter::successors;

use nalgebra::Complex;

use super::Lining;
use crate::model::{Frame, Machine};
use crate::numeric::search::{bisected, highest_of, zeros};
use crate::scene::SceneError;

/// Without damping, growth rates up to this part of the fastest frequency count as round-off.
const UNDAMPED_GROWTH: f64 = 1e-11;

/// Number of equal intervals of speed in the scan for changes of the growth at rest.
const GROWTH_SCAN: u32 = 1000;

/// Number of additional speeds on each side of a coincidence, and the number of them in one width of
/// its range of growth. With fewer, both ends of a narrow range could be missed.
const TONGUE_SCAN: (i32, f64) = (240, 8.0);

/// Largest distance of the fastest growth from the coincidence, in widths of the range of growth.
const PEAK_REACH: f64 = 12.0;

/// A motion `e^{ist}` about rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RestRoot {
    /// Growth rate, `-Im s` \[1/s\].
    pub growth_1_s: f64,
    /// Frequency in the blade frame, `Re s`; negative for a wave that runs backward over the blades
    /// \[rad/s\].
    pub s_rad_s: f64,
    /// Frequency in the stationary frame, `Re s + nu` \[rad/s\].
    pub omega_rad_s: f64,
}

/// The four motions about rest at one rotor speed, in decreasing order of growth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rest {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Stiffness of the lining under all blades, `S0`; 0 with a clearance \[N/m\].
    pub stiffness_n_per_m: f64,
    /// The four motions.
    pub roots: [RestRoot; 4],
    /// Whether one of them grows by more than round-off.
    pub grows: bool,
    /// Largest growth rate less its round-off \[1/s\].
    excess_1_s: f64,
}

impl Rest {
    /// Creates the motions about rest at a rotor speed \[rad/s\] with this stiffness of all blades
    /// \[N/m\].
    pub(super) fn new(machine: &Machine, speed: f64, stiffness: f64) -> Self {
        let frame = Frame::at(machine, speed);
        let nu = frame.casing.turn;
        let root =
            |l: Complex<f64>| RestRoot { growth_1_s: l.re, s_rad_s: l.im, omega_rad_s: l.im + nu };
        let unknown = Complex::new(f64::NAN, f64::NAN);
        let rates = frame.round(stiffness).unwrap_or_default();
        let mut roots = [0, 1, 2, 3].map(|k| root(rates.get(k).copied().unwrap_or(unknown)));
        roots.sort_by(|a, b| b.growth_1_s.total_cmp(&a.growth_1_s));
        let fastest = rates.iter().map(|rate| rate.norm()).fold(0.0, f64::max);
        let damped = frame.casing.damping > 0.0 && frame.blades.damping > 0.0;
        let round_off = if damped { 0.0 } else { UNDAMPED_GROWTH * fastest };
        let excess_1_s = roots[0].growth_1_s - round_off;
        let grows = excess_1_s > 0.0;
        Self { speed_rad_s: speed, stiffness_n_per_m: stiffness, roots, grows, excess_1_s }
    }

    /// Returns the motion with the largest growth rate.
    #[must_use]
    pub fn worst(&self) -> RestRoot {
        self.roots[0]
    }
}

impl Lining<'_> {
    /// Returns the motions about rest at a speed \[rad/s\]. With a clearance they are those of
    /// casing and blades without contact.
    #[must_use]
    pub fn rest(&self, speed: f64) -> Rest {
        Rest::new(&self.machine, speed, self.at(speed).stiffness_at_rest())
    }
}

/// A speed at which a wave about rest begins or ceases to grow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HopfPoint {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Frequency of the wave in the blade frame \[rad/s\].
    pub s_rad_s: f64,
    /// Frequency of the wave in the stationary frame \[rad/s\].
    pub omega_rad_s: f64,
    /// Whether the wave grows just above this speed; if not, it grows just below.
    pub grows_above: bool,
}

/// Smallest stiffness of a lining that holds a lock, or with which waves grow from rest, and the
/// speed at which it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LeastStiffness {
    /// Stiffness under one blade or of all blades together, as stated by the function that returns
    /// it \[N/m\].
    pub stiffness_n_per_m: f64,
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
}

/// Returns the coincidence of a machine on a lining with the total stiffness `stiffness` \[N/m\],
/// for the direction of rotation given by the sign of `sense` \[rad/s\]:
/// `(omega_c' +- omega_bd')/n_d`, with minus for a negative coupling product. `None` if the blades
/// are not coupled to the casing, if they have no restoring stiffness on the lining, or if
/// centrifugal stiffening leaves no such coincidence.
fn shifted_speed(machine: &Machine, stiffness: f64, sense: f64) -> Option<f64> {
    let product = machine.coupling_product_at(sense);
    let [casing, blades] = frequencies_on_lining(machine, stiffness, product)?;
    let (differences, sum) = machine.meetings(casing, blades);
    let speed = if product < 0.0 { differences.first().copied() } else { sum }?;
    Some(speed.copysign(sense))
}

/// Returns the frequencies at rest of casing and blades on a lining of this total stiffness
/// \[rad/s\]; `None` if the blades are not coupled to the casing, or have no restoring stiffness.
fn frequencies_on_lining(machine: &Machine, stiffness: f64, product: f64) -> Option<[f64; 2]> {
    let blades = machine.blade_stiffness_at_rest() + stiffness * product;
    if product == 0.0 || blades < 0.0 {
        return None;
    }
    let casing = ((machine.casing_stiffness + stiffness) / machine.casing_mass).sqrt();
    Some([casing, (blades / machine.blade_modal_mass).sqrt()])
}

/// Returns the range of speed over which growth varies around a coincidence \[rad/s\].
fn width(machine: &Machine, stiffness: f64, sense: f64) -> f64 {
    let product = machine.coupling_product_at(sense).abs();
    let casing = (machine.casing_stiffness + stiffness) * machine.casing_mass;
    let blades = machine.blade_modal_stiffness * machine.blade_modal_mass;
    let joined = stiffness * product.sqrt() / (2.0 * (casing * blades).sqrt().sqrt());
    let damped = machine.casing_damping_ratio * machine.omega_c
        + machine.blade_damping_ratio * machine.omega_bd;
    (damped + joined) / machine.nodal_diameters
}

/// Fraction of the fastest speed below which the rotor counts as standing still.
const STANDSTILL: f64 = 1e-9;

impl Lining<'_> {
    /// Returns the coincidence at which rest grows fastest, for a rotor that turns in the direction
    /// of the sign of `speed` \[rad/s\]; `None` with a clearance, if the blades are not coupled to
    /// the casing, and if no such coincidence exists.
    #[must_use]
    pub fn shifted_coincidence(&self, speed: f64) -> Option<f64> {
        let stiffness = self.at(speed).stiffness_at_rest();
        (stiffness > 0.0).then(|| shifted_speed(&self.machine, stiffness, speed)).flatten()
    }

    /// Returns every speed in an interval at which the largest growth rate about rest changes its
    /// sign, in increasing order \[rad/s\].
    ///
    /// # Errors
    /// The ends are not finite or not in increasing order.
    pub fn hopf_points(&self, [from, to]: [f64; 2]) -> Result<Vec<HopfPoint>, SceneError> {
        if !(from.is_finite() && to.is_finite() && from < to) {
            let (speeds, allowed) = (format!("{from}:{to}"), "two speeds, the lower one first");
            return Err(SceneError::refused("speed", speeds, allowed));
        }
        // Friction reverses with the rotor; the growth rate jumps there, which is not a Hopf point.
        let reverses = from <= 0.0 && to >= 0.0 && self.machine.friction != 0.0;
        let parts = match reverses {
            true => vec![[from, from * STANDSTILL], [to * STANDSTILL, to]],
            false => vec![[from, to]],
        };
        let points = |part: [f64; 2]| {
            let growth = |speed: f64| self.rest(speed).excess_1_s;
            let mut grows = growth(part[0]) > 0.0;
            zeros(&self.scan_speeds(part), growth).into_iter().map(move |speed_rad_s| {
                let worst = self.rest(speed_rad_s).worst();
                grows = !grows;
                HopfPoint {
                    speed_rad_s,
                    s_rad_s: worst.s_rad_s,
                    omega_rad_s: worst.omega_rad_s,
                    grows_above: grows,
                }
            })
        };
        Ok(parts.into_iter().filter(|[from, to]| from < to).flat_map(points).collect())
    }

    /// Returns the speeds of the scan, in increasing order.
    fn scan_speeds(&self, [from, to]: [f64; 2]) -> Vec<f64> {
        let mut linings = vec![self.at(from).stiffness_at_rest(), self.at(to).stiffness_at_rest()];
        linings.dedup();
        let part = |k: u32| f64::from(k) / f64::from(GROWTH_SCAN);
        let mut places: Vec<f64> =
            (0..=GROWTH_SCAN).map(|k| from + (to - from) * part(k)).collect();
        let (reach, fine) = TONGUE_SCAN;
        for (&stiffness, sense) in linings.iter().flat_map(|of| [(of, -1.0), (of, 1.0)]) {
            let product = self.machine.coupling_product_at(sense);
            let Some([casing, blades]) = frequencies_on_lining(&self.machine, stiffness, product)
            else {
                continue;
            };
            let stride = width(&self.machine, stiffness, sense) / fine;
            let (differences, sum) = self.machine.meetings(casing, blades);
            for middle in sum.into_iter().chain(differences) {
                let place = |k| sense * middle + stride * f64::from(k);
                places.extend((-reach..=reach).map(place));
            }
        }
        // Speed at which the clearance closes.
        places.extend(self.machine.closing_speed().into_iter().flat_map(|speed| [-speed, speed]));
        places.retain(|speed| (from..=to).contains(speed));
        places.sort_by(f64::total_cmp);
        places.dedup();
        places
    }
}

/// Returns the smallest stiffness `S0` (all blades together) of a lining under preload at which
/// waves grow from rest near the coincidence, for a rotor that turns in the direction of the sign of
/// `sense`. Zero if casing or blades are undamped; `None` if they are not coupled, if they have no
/// coincidence, or if no stiffness that can be built makes waves grow.
#[must_use]
pub fn growth_threshold(machine: &Machine, sense: f64) -> Option<LeastStiffness> {
    let product = machine.coupling_product_at(sense).abs();
    let speed_rad_s = shifted_speed(machine, 0.0, sense)?;
    let inertia = machine.casing_mass * machine.omega_c * machine.blade_modal_mass;
    let damping = machine.casing_damping_ratio * machine.omega_c * machine.blade_damping_ratio;
    // Estimate for weak coupling, at the coincidence.
    let guess = 2.0 * machine.omega_bd * (inertia * damping / product).sqrt();
    if guess == 0.0 {
        return Some(LeastStiffness { stiffness_n_per_m: 0.0, speed_rad_s });
    }
    let peak = |stiffness: f64| peak(machine, stiffness, sense);
    let grows = |stiffness: f64| peak(stiffness).is_some_and(|(_, growth)| growth > 0.0);
    let begins = grows(guess);
    let factor = if begins { 0.5 } else { 2.0 };
    // Sixty doublings each way cover any stiffness that can be built.
    let far = successors(Some(factor * guess), |stiffness| Some(factor * stiffness));
    let far = far.take(60).find(|&stiffness| grows(stiffness) != begins)?;
    let [_, stiffness_n_per_m] = bisected([far / factor, far], |at| grows(at) != begins);
    let (speed_rad_s, _) = peak(stiffness_n_per_m)?;
    Some(LeastStiffness { stiffness_n_per_m, speed_rad_s })
}

/// Returns the speed \[rad/s\] of fastest growth near the coincidence on a lining of this total
/// stiffness, and the growth rate there \[1/s\]; `None` without a coincidence.
fn peak(machine: &Machine, stiffness: f64, sense: f64) -> Option<(f64, f64)> {
    let middle = shifted_speed(machine, stiffness, sense)?;
    let reach = PEAK_REACH * width(machine, stiffness, sense);
    let growth = |speed: f64| Rest::new(machine, speed, stiffness).worst().growth_1_s;
    let parts = 6 * PEAK_REACH as u32;
    let place = |k| middle + reach * (2.0 * f64::from(k) / f64::from(parts) - 1.0);
    highest_of(&(0..=parts).map(place).collect::<Vec<_>>(), growth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::{ContactSurface, Row};
    use crate::scene::Scene;

    /// Returns `L_c L_a + S0 [(1 + i mu_c) L_a + c2 L_c]` at a rate, relative to the magnitude of
    /// its terms.
    fn residual(frame: &Frame, stiffness: f64, l: Complex<f64>) -> f64 {
        let [casing, blades] = [frame.casing.powers(), frame.blades.powers()];
        let value = |of: &[Complex<f64>; 3]| of[0] + of[1] * l + of[2] * l * l;
        let size = |of: &[Complex<f64>; 3]| {
            of[0].norm() + of[1].norm() * l.norm() + of[2].norm() * l.norm_sqr()
        };
        let turned = Complex::new(1.0, frame.friction);
        let (c, a) = (value(&casing), value(&blades));
        let rest = c * a + (turned * a + c * frame.coupling()) * stiffness;
        let coupled = turned.norm() * size(&blades) + size(&casing) * frame.coupling().abs();
        rest.norm() / (size(&casing) * size(&blades) + coupled * stiffness)
    }

    #[test]
    fn roots_solve_the_quartic_and_are_those_of_eight_states() {
        let mut random = fastrand::Rng::with_seed(4);
        for _ in 0..256 {
            let mut between = |low: f64, high: f64| low + (high - low) * random.f64();
            let mut scene = Scene::base();
            for (path, value) in [
                ("casing.radius_m", 0.49988),
                ("bladed_disk.radial_coupling", between(-1.0, 1.0)),
                ("contact.friction", between(0.0, 0.6)),
                ("casing.tangential_ratio", between(0.0, 0.4)),
                ("casing.damping_ratio", between(0.0, 0.3)),
                ("bladed_disk.damping_ratio", between(0.0, 0.3)),
            ] {
                scene.set(path, &value.to_string()).unwrap();
            }
            let (stiffness_n_per_m, speed) =
                (10_f64.powf(between(2.0, 8.0)), between(-900.0, 900.0));
            let machine = scene.machine();
            let surface = ContactSurface { stiffness_n_per_m, ..Default::default() };
            let lining = Lining::of(&machine, &surface).unwrap();
            let frame = Frame::at(&machine, speed);
            let rest = lining.rest(speed);
            let stiffness = rest.stiffness_n_per_m;
            for root in rest.roots {
                let l = Complex::new(root.growth_1_s, root.s_rad_s);
                assert!(residual(&frame, stiffness, l) < 1e-10, "{root:?}");
            }
            let springs = [(1.0, 0.0), (0.0, 1.0)].map(|n| (Row::fixed(&frame, n), stiffness));
            let values = frame.motion(&[], &springs).eigenvalues().unwrap();
            let growth = values.iter().map(|value| value.re).fold(f64::MIN, f64::max);
            // Nearly equal roots are accurate to half the digits.
            let near = rest.roots.iter().flat_map(|a| rest.roots.iter().map(move |b| (a, b)));
            let apart = near
                .filter(|(a, b)| a != b)
                .map(|(a, b)| (a.s_rad_s - b.s_rad_s).hypot(a.growth_1_s - b.growth_1_s))
                .fold(f64::INFINITY, f64::min);
            let size = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
            let bound = 1e-11 * size * (1.0 + size / apart);
            let worst = rest.worst().growth_1_s;
            assert!((worst - growth).abs() < bound, "{worst} is not {growth}");
        }
    }

    #[test]
    fn a_rotor_that_turns_backward_grows_at_the_mirrored_speeds() {
        for loss in ["0", "4e-10", "6.1e-10"] {
            let scene = Scene::base().with(&[
                ("solver.contact", "smooth"),
                ("bladed_disk.radial_coupling", "0.5"),
                ("casing.clearance_loss_m_s2", loss),
                ("casing.radius_m", if loss == "0" { "0.49988" } else { "0.5" }),
            ]);
            let machine = scene.unwrap().machine();
            let surface = ContactSurface { stiffness_n_per_m: 27e3, ..Default::default() };
            let lining = Lining::of(&machine, &surface).unwrap();
            for (from, to) in [(200.0, 700.0), (390.0, 410.0), (400.0, 500.0)] {
                let ahead = lining.hopf_points([from, to]).unwrap();
                let mut back = lining.hopf_points([-to, -from]).unwrap();
                back.reverse();
                assert_eq!(ahead.len(), back.len(), "{loss} {from}");
                for (ahead, back) in ahead.iter().zip(&back) {
                    let apart = ahead.speed_rad_s + back.speed_rad_s;
                    assert!(apart.abs() < 1e-9 * to, "{loss} {from}: {ahead:?} {back:?}");
                    assert_ne!(ahead.grows_above, back.grows_above);
                }
            }
        }
    }

    #[test]
    fn a_window_of_growth_just_above_the_threshold_is_found() {
        let mut scene = Scene::base();
        scene.set("casing.radius_m", "0.49988").unwrap();
        scene.set("bladed_disk.radial_coupling", "0.5").unwrap();
        let machine = scene.machine();
        let least = growth_threshold(&machine, 1.0).unwrap();
        let surface =
            |stiffness_n_per_m: f64| ContactSurface { stiffness_n_per_m, ..Default::default() };
        let whole =
            |stiffness: f64| Lining::of(&machine, &surface(stiffness)).unwrap().stiffness_at_rest();
        let stiffness = least.stiffness_n_per_m / whole(1e5) * 1e5;
        let around = [0.99 * least.speed_rad_s, 1.01 * least.speed_rad_s];
        for (more, changes) in
            [(-1e-6, vec![]), (1e-6, vec![true, false]), (1e-9, vec![true, false])]
        {
            let surface = surface(stiffness * (1.0 + more));
            let found = Lining::of(&machine, &surface).unwrap().hopf_points(around).unwrap();
            let above: Vec<bool> = found.iter().map(|point| point.grows_above).collect();
            assert_eq!(above, changes, "{more}");
            for point in found {
                assert!((point.speed_rad_s / least.speed_rad_s - 1.0).abs() < 1e-3, "{more}");
            }
        }
    }
}
