//! Force law of a lining under one blade, and the stiffness of all blades against a travelling wave
//! (docs/theory.md, section 10).
//!
//! A wave with the gap amplitude `r` encounters the stiffness
//! `S(r) = (N/(2 pi r)) int P(g0 - r cos f) cos f df` of the law of `model::LiningLaw`. It is
//! `S(r) = (N k_p/2 pi) mean(-g0/r, eps/r)`, the mean of `f - sin f cos f`, `cos f = -x`, over `x` from
//! `(-g0 - eps)/r` to `-g0/r`, which has a closed form.

use std::borrow::Cow;
use std::f64::consts::{PI, TAU};

use crate::harmonic::{error, has_one_wave};
use crate::model::{ContactSurface, LiningLaw, Machine};
use crate::numeric::search::{geometric, zeros};
use crate::scene::{SceneError, keys};

/// Range of amplitudes in the search, relative to preload plus smoothing depth: below it no blade
/// lifts off, and above it the stiffness differs from its limit, contact over half of each
/// revolution, by about 1e-9.
const AMPLITUDES: [f64; 2] = [1e-4, 1e9];

/// Ratio of neighbouring amplitudes in the search.
const AMPLITUDE_RATIO: f64 = 1.08;

/// A machine whose casing has a lining.
#[derive(Clone, Debug)]
pub struct Lining<'a> {
    /// The machine, with its friction and its clearance (negative with preload).
    pub machine: Cow<'a, Machine>,
    /// Force law under one blade.
    pub law: LiningLaw,
}

impl<'a> Lining<'a> {
    /// Combines a machine with the lining properties of its contact surface.
    ///
    /// # Errors
    /// The blades do not share one travelling wave: no corners, or disk modes whose nodal diameters
    /// are not `+-n_d` modulo `N`.
    pub fn of(machine: &'a Machine, surface: &ContactSurface) -> Result<Self, SceneError> {
        let polygon = &machine.polygon;
        error::refuse_no_wave(machine)?;
        error::refuse_no_corner(polygon)?;
        if !has_one_wave(machine) {
            let (key, value) = (keys::DISK_DIAMETERS, machine.blade_diameters);
            let allowed = "those of the casing, or n_b = +-n_d modulo N, for one wave of both";
            return Err(SceneError::refused(key, value, allowed));
        }
        Ok(Self { machine: Cow::Borrowed(machine), law: LiningLaw::of(surface) })
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

    /// Returns the stiffness of all blades against a small wave about rest \[N/m\]: `S0 = N k_p/2`,
    /// zero with a clearance. If the lobes of the casing are higher than the gap or depth, blades
    /// rub on arcs only: then it is the fraction `acos(g0/e)/pi` of that, reduced by the smoothing.
    #[must_use]
    pub fn stiffness_at_rest(&self) -> f64 {
        let (gap, height) = (self.machine.clearance(), self.machine.out_of_round());
        if height > gap.abs() {
            let end = |depth: f64| ((gap + depth) / height).clamp(-1.0, 1.0).acos();
            let smoothing = self.law.smoothing_m;
            let (rubs, whole) = (end(0.0), end(smoothing));
            let rise = height * (rubs.sin() - whole.sin()) - gap * (rubs - whole);
            let edge = if smoothing > 0.0 { rise / smoothing } else { 0.0 };
            return 2.0 * self.stiffness_far_out() * (whole + edge) / PI;
        }
        0.5 * f64::from(self.machine.polygon.blades) * self.law.slope(gap)
    }

    /// Returns the stiffness against a very large wave, at which blades lift off for half of each
    /// revolution, `N k_p/4` \[N/m\].
    #[must_use]
    pub fn stiffness_far_out(&self) -> f64 {
        0.25 * f64::from(self.machine.polygon.blades) * self.law.stiffness_n_per_m
    }

    /// Returns the stiffness `S(r)` of all blades, in the limit of many, against a wave with the
    /// gap amplitude `r > 0`, and its logarithmic derivative `r dS/dr` \[N/m\].
    #[must_use]
    pub fn stiffness_of_wave(&self, r: f64) -> [f64; 2] {
        let scale = f64::from(self.machine.polygon.blades) * self.law.stiffness_n_per_m / TAU;
        mean(self.preload_m() / r, self.law.smoothing_m / r).map(|part| scale * part)
    }

    /// Returns every amplitude at which a wave encounters the given stiffness, in increasing order
    /// \[m\].
    #[must_use]
    pub fn amplitudes(&self, stiffness: f64) -> Vec<f64> {
        let length = self.preload_m().abs() + self.law.smoothing_m;
        let places: Vec<f64> =
            geometric(AMPLITUDES.map(|part| part * length), AMPLITUDE_RATIO).collect();
        zeros(&places, |r| self.stiffness_of_wave(r)[0] - stiffness)
    }
}

/// Returns the mean of `f - sin f cos f`, `cos f = -x`, over `x` from `depth - width` to `depth`, and
/// its derivative with respect to the logarithm of the amplitude, to which both are inversely
/// proportional. Below `x = -1` no blade touches (`f = 0`), above 1 none lifts off (`f = pi`).
///
/// Between these, with the middle `m` and half the difference `h` of `f` at both ends, the integral
/// `sin f - sin^3 f/3 - f cos f` over `dx = sin f df` gives
/// `m + [3/2 cos m + cos 3m sin 3h/(6 sin h) - 2 cos m h/tan h]/(2 sin m)`, without cancellation in a
/// narrow range. The derivative is the mean of `2 sin f cos f`.
fn mean(depth: f64, width: f64) -> [f64; 2] {
    // Of a range without width the parts are 0 or 1.
    let part = |beyond: f64| if beyond > 0.0 { (beyond / width).min(1.0) } else { 0.0 };
    let (above, below) = (part(depth - 1.0), part(width - 1.0 - depth));
    let inside = 1.0 - above - below;
    if inside <= 0.0 {
        return [PI * above, 0.0];
    }
    let [from, to] = [depth - width, depth].map(|x| (-x).clamp(-1.0, 1.0).acos());
    let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
    let (sin, cos) = middle.sin_cos();
    let thrice = 3.0 - 4.0 * half.sin().powi(2);
    let slower = if half == 0.0 { 1.0 } else { half / half.tan() };
    let curved = 1.5 * cos + (3.0 * middle).cos() * thrice / 6.0 - 2.0 * cos * slower;
    let (early, late) = (from.sin(), to.sin());
    let change = cos / sin * (early * early + early * late + late * late) / 1.5;
    [PI * above + inside * (middle + 0.5 * curved / sin), inside * change]
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
                lining.law.push(lining.machine.clearance() - r * cos) * cos
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
                    let [value, change] = lining.stiffness_of_wave(r);
                    let plain = plain(&lining, r, 40_000);
                    assert!(
                        (value - plain).abs() < 1e-6 * 297e3,
                        "{smoothing} {r}: {value} {plain}"
                    );
                    let step = 1e-5 * r;
                    let of = |r: f64| lining.stiffness_of_wave(r)[0];
                    let slope = (of(r + step) - of(r - step)) * r / (2.0 * step);
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
            let found = lining.amplitudes(lining.stiffness_of_wave(r)[0]);
            assert!(found.iter().any(|at| (at / r - 1.0).abs() < 1e-9), "{r}: {found:?}");
        }
    }

    #[test]
    fn amplitudes_are_found_and_limits_kept() {
        let machine = machine("0.49988");
        let lining = lining(&machine, 1e-6);
        assert_eq!(lining.stiffness_at_rest(), 297e3);
        for r in [2.2e-5, 6.8e-5, 1e-2] {
            let found = lining.amplitudes(lining.stiffness_of_wave(r)[0]);
            assert_eq!(found.len(), 1);
            assert!((found[0] / r - 1.0).abs() < 1e-9, "{found:?} {r}");
        }
        assert!(lining.amplitudes(0.999 * lining.stiffness_far_out()).is_empty());
        assert!(lining.amplitudes(1.001 * lining.stiffness_at_rest()).is_empty());
        let step = (lining.law.push(-1e-6) - lining.law.push(-1e-6 - 1e-15)).abs();
        assert!(step < 1e-10 && lining.law.push(1e-9) == 0.0);
    }
}
