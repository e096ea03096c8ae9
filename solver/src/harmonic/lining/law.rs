//! Force law of a lining under one blade, and the stiffness of all blades against a travelling wave
//! (docs/theory.md, section 10).
//!
//! `P = 0` for `g >= 0`, `k_p g^2/(2 eps)` for `-eps < g < 0`, `k_p (-g - eps/2)` below. A wave
//! with the gap amplitude `r` encounters the stiffness
//! `S(r) = (N/(2 pi r)) int P(g0 - r cos f) cos f df`, which is evaluated here without quadrature
//! error: `S(r) = (N k_p/2 pi) mean(-g0/r, eps/r)`, the mean of `f - sin f cos f`, `cos f = -x`,
//! over `x` from `(-g0 - eps)/r` to `-g0/r`. For a wide range it is a difference of closed forms,
//! for a narrow one a sum without cancellation.

use crate::scene::keys;
use std::borrow::Cow;
use std::f64::consts::{PI, TAU};

use crate::harmonic::{HarmonicError, error, has_one_wave};
use crate::model::{ContactSurface, LiningLaw, Machine};
use crate::numeric::quadrature::GAUSS_8;
use crate::numeric::search::bisected;

/// Ratio of the smoothing depth to the amplitude above which the mean stiffness is computed as a
/// difference of closed forms. Below it the difference would lose digits, and quadrature with eight
/// nodes is exact to round-off.
const LINING_DIVIDED: f64 = 1e-3;

/// Smallest amplitude in the search, relative to preload plus smoothing depth: below it no blade
/// lifts off.
const LINING_NARROWEST: f64 = 1e-4;

/// Largest amplitude in the search, relative to the same length: there the stiffness differs from its
/// limit, contact over half of each revolution, by about 1e-9.
const LINING_WIDEST: f64 = 1e9;

/// Number of intervals of equal ratio between the two. Two solutions in one interval are missed,
/// which can happen where the preload is smaller than the smoothing depth.
const LINING_STRIDES: f64 = 400.0;

/// A machine whose casing has a lining.
#[derive(Clone, Debug)]
pub struct Lining<'a> {
    /// The machine, with its friction and its clearance (negative with preload).
    pub machine: Cow<'a, Machine>,
    /// Stiffness `k_p` under one blade \[N/m\].
    pub stiffness_n_per_m: f64,
    /// Smoothing depth `eps` \[m\].
    pub smoothing_m: f64,
}

impl<'a> Lining<'a> {
    /// Combines a machine with the lining properties of its contact surface.
    ///
    /// # Errors
    /// The blades do not share one travelling wave: no corners, or disk modes whose nodal diameters
    /// are not `+-n_d` modulo `N`.
    pub fn of(machine: &'a Machine, surface: &ContactSurface) -> Result<Self, HarmonicError> {
        let polygon = &machine.polygon;
        error::refuse_no_wave(machine)?;
        error::refuse_no_corner(polygon)?;
        if !has_one_wave(machine) {
            let (key, value) = (keys::DISK_DIAMETERS, machine.blade_diameters);
            let allowed = "those of the casing, or n_b = +-n_d modulo N, for one wave of both";
            return Err(HarmonicError::refused(key, value, allowed));
        }
        Ok(Self {
            machine: Cow::Borrowed(machine),
            stiffness_n_per_m: surface.stiffness_n_per_m,
            smoothing_m: surface.smoothing_m,
        })
    }

    /// Evaluates the machine at a rotor speed \[rad/s\].
    #[must_use]
    pub fn at(&self, speed: f64) -> Self {
        let machine = match self.machine.at(speed) {
            Cow::Borrowed(_) => self.machine.clone(),
            Cow::Owned(here) => Cow::Owned(here),
        };
        Self { machine, ..*self }
    }

    /// Returns the depth of every blade in the lining at rest, `-g0`; negative with a clearance
    /// \[m\].
    #[must_use]
    pub fn preload_m(&self) -> f64 {
        -self.machine.clearance()
    }

    /// Returns the contact force at a gap, positive in compression \[N\].
    #[must_use]
    pub fn push(&self, gap: f64) -> f64 {
        self.law().push(gap)
    }

    /// Returns the contact stiffness, `-dP/dg` \[N/m\].
    #[must_use]
    pub fn slope(&self, gap: f64) -> f64 {
        self.law().slope(gap)
    }

    pub(super) fn law(&self) -> LiningLaw {
        let &Self { stiffness_n_per_m, smoothing_m, .. } = self;
        LiningLaw { stiffness_n_per_m, smoothing_m }
    }

    /// Returns the stiffness of all blades against a small wave about rest \[N/m\]: `S0 = N k_p/2`,
    /// zero with a clearance. If the lobes of the casing are higher than the gap or depth, blades
    /// rub on arcs only: then it is the fraction `acos(g0/e)/pi` of that, reduced by the smoothing.
    #[must_use]
    pub fn stiffness_at_rest(&self) -> f64 {
        let (gap, height) = (self.machine.clearance(), self.machine.out_of_round());
        if height > gap.abs() {
            let all = 0.5 * f64::from(self.machine.polygon.blades) * self.stiffness_n_per_m;
            let end = |depth: f64| ((gap + depth) / height).clamp(-1.0, 1.0).acos();
            let (rubs, whole) = (end(0.0), end(self.smoothing_m));
            let rise = height * (rubs.sin() - whole.sin()) - gap * (rubs - whole);
            let edge = if self.smoothing_m > 0.0 { rise / self.smoothing_m } else { 0.0 };
            return all * (whole + edge) / PI;
        }
        0.5 * f64::from(self.machine.polygon.blades) * self.slope(self.machine.clearance())
    }

    /// Returns the stiffness against a very large wave, at which blades lift off for half of each
    /// revolution, `N k_p/4` \[N/m\].
    #[must_use]
    pub fn stiffness_far_out(&self) -> f64 {
        0.25 * f64::from(self.machine.polygon.blades) * self.stiffness_n_per_m
    }

    /// Returns the stiffness `S(r)` of all blades, in the limit of many, against a wave with the
    /// gap amplitude `r > 0` \[N/m\].
    #[must_use]
    pub fn stiffness_of_wave(&self, r: f64) -> f64 {
        let depth = self.preload_m() / r;
        let scale = f64::from(self.machine.polygon.blades) * self.stiffness_n_per_m / TAU;
        scale * mean(depth, self.smoothing_m / r)
    }

    /// Returns the logarithmic derivative `r dS/dr` of that stiffness \[N/m\]. The mean depends on
    /// `r` only through its two ends.
    #[must_use]
    pub fn stiffness_change(&self, r: f64) -> f64 {
        let (depth, width) = (self.preload_m() / r, self.smoothing_m / r);
        let scale = f64::from(self.machine.polygon.blades) * self.stiffness_n_per_m / TAU;
        scale * mean_change(depth, width)
    }

    /// Returns every amplitude at which a wave encounters the given stiffness, in increasing order
    /// \[m\].
    #[must_use]
    pub fn amplitudes(&self, stiffness: f64) -> Vec<f64> {
        let length = self.preload_m().abs() + self.smoothing_m;
        let apart = |r: f64| self.stiffness_of_wave(r) - stiffness;
        let ratio = (LINING_WIDEST / LINING_NARROWEST).powf(1.0 / LINING_STRIDES);
        let mut found = Vec::new();
        let (mut near, mut far) = (length * LINING_NARROWEST, length * LINING_NARROWEST * ratio);
        while far < length * LINING_WIDEST {
            if apart(near) * apart(far) < 0.0 || apart(far) == 0.0 {
                found.push(between([near, far], apart));
            }
            (near, far) = (far, far * ratio);
        }
        found
    }
}

/// Returns the zero of a function between two points at which its signs differ.
pub(super) fn between([low, high]: [f64; 2], of: impl Fn(f64) -> f64) -> f64 {
    let (start, end) = (of(low), of(high));
    if start == 0.0 || end == 0.0 {
        return if start == 0.0 { low } else { high };
    }
    let [low, high] = bisected([low, high], |x| (of(x) > 0.0) != (start > 0.0));
    0.5 * (low + high)
}

/// Returns the contribution of a linear lining with its surface at `x` to the stiffness against a
/// wave of amplitude 1: `f - sin f cos f` with `cos f = -x`; `pi` if no blade lifts off.
fn share(x: f64) -> f64 {
    if x >= 1.0 {
        PI
    } else if x <= -1.0 {
        0.0
    } else {
        let angle = (-x).acos();
        let sin = ((1.0 - x) * (1.0 + x)).sqrt();
        angle + sin * x
    }
}

/// Returns the derivative of [`share`], `2 sin f`.
fn share_slope(x: f64) -> f64 {
    2.0 * ((1.0 - x) * (1.0 + x)).max(0.0).sqrt()
}

/// Returns the integral of [`share`] from minus infinity to `x`, `sin f - sin^3 f/3 - f cos f`.
fn whole(x: f64) -> f64 {
    if x >= 1.0 {
        return PI * x;
    }
    if x <= -1.0 {
        return 0.0;
    }
    let angle = (-x).acos();
    let sin = ((1.0 - x) * (1.0 + x)).sqrt();
    sin - sin * sin * sin / 3.0 + angle * x
}

/// Returns the mean of [`share`] between `depth - width` and `depth`.
pub(super) fn mean(depth: f64, width: f64) -> f64 {
    if width > LINING_DIVIDED {
        return (whole(depth) - whole(depth - width)) / width;
    }
    averaged(depth, width, share)
}

/// Returns the derivative of that mean with respect to the logarithm of the amplitude, to which
/// depth and width are inversely proportional: `mean - [x share]/width` between the ends.
pub(super) fn mean_change(depth: f64, width: f64) -> f64 {
    if width > LINING_DIVIDED {
        let low = depth - width;
        return mean(depth, width) - (depth * share(depth) - low * share(low)) / width;
    }
    -averaged(depth, width, |x| x * share_slope(x))
}

/// Computes the mean over a narrow range by quadrature, exact to round-off: the range is split at
/// the kinks, and a substitution removes their square-root singularity.
fn averaged(depth: f64, width: f64, of: impl Fn(f64) -> f64) -> f64 {
    if width == 0.0 {
        return of(depth);
    }
    let low = depth - width;
    let mut cuts = vec![0.0];
    cuts.extend([-1.0, 1.0].map(|kink| (kink - low) / width).iter().filter(|c| inside(**c)));
    cuts.push(1.0);
    let pieces = cuts.windows(2).map(|piece| {
        let [start, end] = [piece[0], piece[1]];
        let node = |u: f64, weight: f64| {
            let place = start + (end - start) * u * u * (3.0 - 2.0 * u);
            0.5 * weight * 6.0 * u * (1.0 - u) * of(low + width * place)
        };
        let both = |&(x, weight): &(f64, f64)| {
            node(0.5 * (1.0 - x), weight) + node(0.5 * (1.0 + x), weight)
        };
        (end - start) * GAUSS_8.iter().map(both).sum::<f64>()
    });
    pieces.sum()
}

fn inside(part: f64) -> bool {
    part > 0.0 && part < 1.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn machine(radius: &str) -> Machine {
        let mut scene = Scene::base();
        scene.set("casing.radius_m", radius).unwrap();
        scene.machine()
    }

    fn lining(machine: &Machine, smoothing_m: f64) -> Lining<'_> {
        let surface = ContactSurface { stiffness_n_per_m: 27e3, smoothing_m, ..Default::default() };
        Lining::of(machine, &surface).unwrap()
    }

    /// Evaluates the defining integral by the midpoint rule.
    fn plain(lining: &Lining, r: f64, parts: u32) -> f64 {
        let sum: f64 = (0..parts)
            .map(|k| {
                let cos = (TAU * (f64::from(k) + 0.5) / f64::from(parts)).cos();
                lining.push(lining.machine.clearance() - r * cos) * cos
            })
            .sum();
        f64::from(lining.machine.polygon.blades) * sum / (f64::from(parts) * r)
    }

    #[test]
    fn stiffness_of_a_wave_is_its_definition() {
        for radius in ["0.49988", "0.4999002", "0.50"] {
            let machine = machine(radius);
            for smoothing in [0.0, 1e-12, 1e-9, 1e-7, 1e-6, 3e-5, 1e-3] {
                let lining = lining(&machine, smoothing);
                for r in [1e-5, 2.1e-5, 5e-5, 1.2e-4, 1e-3] {
                    let (value, plain) = (lining.stiffness_of_wave(r), plain(&lining, r, 40_000));
                    assert!(
                        (value - plain).abs() < 1e-6 * 297e3,
                        "{smoothing} {r}: {value} {plain}"
                    );
                    let step = 1e-5 * r;
                    let slope = (lining.stiffness_of_wave(r + step)
                        - lining.stiffness_of_wave(r - step))
                        * r
                        / (2.0 * step);
                    let change = lining.stiffness_change(r);
                    assert!(
                        (change - slope).abs() < 1e-4 * 297e3,
                        "{smoothing} {r}: {change} {slope}"
                    );
                }
            }
        }
    }

    #[test]
    fn amplitudes_over_tips_that_just_touch_are_found() {
        let machine = machine("0.4999");
        let lining = lining(&machine, 3e-5);
        for r in [1e-6, 1e-5, 4e-5, 1e-3] {
            let found = lining.amplitudes(lining.stiffness_of_wave(r));
            assert!(found.iter().any(|at| (at / r - 1.0).abs() < 1e-9), "{r}: {found:?}");
        }
    }

    #[test]
    fn amplitudes_are_found_and_limits_kept() {
        let machine = machine("0.49988");
        let lining = lining(&machine, 1e-6);
        assert_eq!(lining.stiffness_at_rest(), 297e3);
        for r in [2.2e-5, 6.8e-5, 1e-2] {
            let found = lining.amplitudes(lining.stiffness_of_wave(r));
            assert_eq!(found.len(), 1);
            assert!((found[0] / r - 1.0).abs() < 1e-9, "{found:?} {r}");
        }
        assert!(lining.amplitudes(0.999 * lining.stiffness_far_out()).is_empty());
        assert!(lining.amplitudes(1.001 * lining.stiffness_at_rest()).is_empty());
        let step = (lining.push(-1e-6) - lining.push(-1e-6 - 1e-15)).abs();
        assert!(step < 1e-10 && lining.push(1e-9) == 0.0);
    }
}

#[cfg(test)]
mod share_tests {
    use super::*;

    #[test]
    fn closed_form_and_quadrature_meet_where_one_takes_over() {
        for depth in [-1.0003, -0.9999, -0.2, 0.0, 0.7, 0.9995, 1.0002, 1.3] {
            let width = LINING_DIVIDED;
            let closed = (whole(depth) - whole(depth - width)) / width;
            let summed = averaged(depth, width, share);
            assert!((closed - summed).abs() < 2e-12, "{depth}: {closed} {summed}");
        }
    }
}
