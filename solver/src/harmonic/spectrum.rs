//! The number of harmonics (23) that a steady state needs. A locked wave needs
//! exactly one; a slipping wave repeats itself from side to side and needs
//! infinitely many (docs/theory.md, section 8). Its coefficients come in closed form
//! from the exact orbit. The push has an impulse at a corner, and its coefficients
//! do not fall.

use std::f64::consts::TAU;

use nalgebra::Complex;
use serde::Serialize;

use super::slip::{Arc, SaddleFlow, repeating};
use super::{HarmonicError, NoSlip, error};
use crate::model::Machine;
use crate::tolerances::{HARMONICS, SMALL_RATE, SPECTRUM_SAMPLES};

/// One harmonic of the casing wave in the standing frame.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Harmonic {
    /// Its number; 0 is the travelling wave itself.
    pub number: i32,
    /// `omega_k` \[rad/s\]; negative turns backward.
    pub frequency_rad_s: f64,
    /// `|Z_k|` \[m\].
    pub amplitude_m: f64,
}

/// The error with only the harmonics `-H..=H`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Truncation {
    /// `H`.
    pub harmonics: u32,
    /// Root mean square of the error \[m\].
    pub rms_error_m: f64,
    /// Largest distance from the exact orbit \[m\].
    pub max_error_m: f64,
    /// Deepest penetration of the truncated orbit \[m\].
    pub penetration_m: f64,
}

/// The Fourier series of a lasting slip.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SlipSpectrum {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Time to cross one side, after which the orbit repeats, turned by one
    /// side \[s\].
    pub period_s: f64,
    /// Root mean square amplitude of the whole wave \[m\].
    pub amplitude_m: f64,
    /// Coefficients in the order 0, 1, -1, 2, -2, ...
    pub terms: Vec<Harmonic>,
    /// Truncation errors for `H = 0, 1, 2, 4, 8, ...`.
    pub truncations: Vec<Truncation>,
}

/// The Fourier series of the slip at one speed \[rad/s\], up to `most` harmonics.
///
/// # Errors
/// A polygon without corners, a speed that is not finite, more harmonics than
/// 512. The inner error: why there is no slip.
pub fn slip_spectrum(
    machine: &Machine,
    speed: f64,
    most: u32,
) -> Result<Result<SlipSpectrum, NoSlip>, HarmonicError> {
    error::refuse_no_corner(&machine.polygon)?;
    error::refuse_endless(&[speed])?;
    error::refuse_tips_on_casing(machine, "the series of slip")?;
    if most > HARMONICS {
        let allowed = format!("a whole number from 0 to {HARMONICS}");
        return Err(HarmonicError::refused("harmonics", most, allowed));
    }
    let machine = &*machine.at(speed);
    Ok(repeating(machine, speed).map(|(slide, arc)| {
        let orbit = Orbit { slide, arc, delta: machine.polygon.delta };
        orbit.spectrum(machine, speed, most)
    }))
}

struct Orbit {
    slide: SaddleFlow,
    arc: Arc,
    delta: f64,
}

impl Orbit {
    /// `z exp(-i psi)` of the side in contact, over `g0`.
    fn point(&self, time: f64) -> Complex<f64> {
        Complex::new(-1.0, self.slide.state(&self.arc, time).0)
    }

    /// Frequency of harmonic `k` in the blade frame, times `T` \[rad\].
    fn turn(&self, number: i32) -> f64 {
        TAU * f64::from(number) - 2.0 * self.delta
    }

    /// `Z_k` over `g0`, from the integrals of the orbit's exponentials.
    fn coefficient(&self, number: i32) -> Complex<f64> {
        let time = self.arc.time;
        let turn = Complex::new(0.0, -self.turn(number));
        let [up, down] = self.slide.roots;
        let i = Complex::new(0.0, 1.0);
        let steady = Complex::new(-1.0, self.slide.saddle) * mean_exponential(turn);
        let grow = i * self.arc.grow * mean_exponential(turn + up * time);
        let decay = i * self.arc.decay * mean_exponential(turn + down * time);
        steady + grow + decay
    }

    fn spectrum(&self, machine: &Machine, speed: f64, most: u32) -> SlipSpectrum {
        let length = machine.clearance();
        let period = self.arc.time / machine.omega_c;
        let times: Vec<f64> = (0..=SPECTRUM_SAMPLES)
            .map(|sample| self.arc.time * sample as f64 / SPECTRUM_SAMPLES as f64)
            .collect();
        let exact: Vec<Complex<f64>> = times.iter().map(|&time| self.point(time)).collect();
        let mut sum = vec![Complex::new(0.0, 0.0); exact.len()];
        // The mean square of |z| = 1 + y^2, by Simpson's rule on the samples.
        let mut left = simpson(&exact);
        let amplitude = length * left.sqrt();
        let (mut terms, mut truncations) = (Vec::new(), Vec::new());
        for harmonics in 0..=most {
            let number = i32::try_from(harmonics).unwrap_or(i32::MAX);
            let pair = if number == 0 { vec![0] } else { vec![number, -number] };
            for number in pair {
                let coefficient = self.coefficient(number);
                let turn = self.turn(number) / self.arc.time;
                for (sum, time) in sum.iter_mut().zip(&times) {
                    *sum += coefficient * Complex::new(0.0, turn * time).exp();
                }
                left -= coefficient.norm_sqr();
                let whirl = machine.nu(speed) + speed.signum() * self.turn(number) / period;
                terms.push(Harmonic {
                    number,
                    frequency_rad_s: whirl,
                    amplitude_m: length * coefficient.norm(),
                });
            }
            if harmonics == 0 || harmonics.is_power_of_two() || harmonics == most {
                truncations.push(Truncation {
                    harmonics,
                    rms_error_m: length * left.max(0.0).sqrt(),
                    max_error_m: length * largest(&exact, &sum),
                    penetration_m: length * self.penetration(&sum),
                });
            }
        }
        SlipSpectrum {
            speed_rad_s: speed,
            period_s: period,
            amplitude_m: amplitude,
            terms,
            truncations,
        }
    }

    /// How deep these points penetrate the side in contact and its neighbours.
    fn penetration(&self, points: &[Complex<f64>]) -> f64 {
        let neighbours = [-2.0, 0.0, 2.0].map(|k| Complex::new(0.0, -k * self.delta).exp());
        let gaps = points.iter().flat_map(|z| neighbours.map(|turn| 1.0 + (z * turn).re));
        gaps.fold(0.0, |deepest, gap| deepest.max(-gap))
    }
}

fn largest(exact: &[Complex<f64>], sum: &[Complex<f64>]) -> f64 {
    exact.iter().zip(sum).fold(0.0, |worst, (z, s)| (z - s).norm().max(worst))
}

/// Mean of `|z|^2` over evenly spaced samples, an even number of intervals.
fn simpson(points: &[Complex<f64>]) -> f64 {
    let last = points.len().saturating_sub(1);
    let weight = |n: usize| match n {
        0 => 1.0,
        n if n == last => 1.0,
        n if n % 2 == 1 => 4.0,
        _ => 2.0,
    };
    let sum: f64 = points.iter().enumerate().map(|(n, z)| weight(n) * z.norm_sqr()).sum();
    sum / (3.0 * last.max(1) as f64)
}

/// Mean of `e^(rate t)` over `0 <= t <= 1`.
fn mean_exponential(rate: Complex<f64>) -> Complex<f64> {
    if rate.norm() < SMALL_RATE {
        // The series; the quotient would lose the digits of a small rate.
        Complex::new(1.0, 0.0) + rate * 0.5 + rate * rate / 6.0
    } else {
        (rate.exp() - 1.0) / rate
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn machine() -> Machine {
        let mut scene = Scene::base();
        scene.set("casing.damping_ratio", "0.01").unwrap();
        scene.machine()
    }

    #[test]
    fn the_series_converges_like_a_kink() {
        let spectrum = slip_spectrum(&machine(), 500.0, 256).unwrap().unwrap();
        let at = |h: u32| spectrum.truncations.iter().find(|t| t.harmonics == h).unwrap();
        for h in [16, 32, 64, 128] {
            // Coefficients like 1/k^2: the largest error falls like 1/H, the
            // root mean square like H^-3/2.
            let (now, next) = (at(h), at(2 * h));
            let max_ratio = now.max_error_m / next.max_error_m;
            let rms_ratio = now.rms_error_m / next.rms_error_m;
            assert!((1.9..2.1).contains(&max_ratio), "{h}: {max_ratio}");
            assert!((2.6..3.05).contains(&rms_ratio), "{h}: {rms_ratio}");
        }
        let total: f64 = spectrum.terms.iter().map(|term| term.amplitude_m.powi(2)).sum();
        let left = at(256).rms_error_m.powi(2);
        assert!((total + left - spectrum.amplitude_m.powi(2)).abs() < 1e-12 * total);
    }

    #[test]
    fn harmonic_zero_is_the_wave_and_the_kinks_set_the_rest() {
        let machine = machine();
        let spectrum = slip_spectrum(&machine, 500.0, 8).unwrap().unwrap();
        let orbit = super::super::slip_over(&machine, &[500.0]).unwrap()[0].outcome.unwrap();
        let wave = spectrum.terms[0].frequency_rad_s / 3.0;
        assert!((wave - orbit.wave_speed_rad_s).abs() < 1e-10);
        assert!(spectrum.terms[0].amplitude_m > 0.99 * spectrum.amplitude_m);
        // Far harmonics: |jump of z'| T/(2 pi k)^2, the jump along both normals.
        let jump = orbit.corner_impulse_ns / machine.casing_mass;
        let far = slip_spectrum(&machine, 500.0, 256).unwrap().unwrap();
        let last = far.terms.iter().find(|term| term.number == 256).unwrap();
        let expected = jump * orbit.period_s / (TAU * 256.0).powi(2);
        assert!((last.amplitude_m / expected - 1.0).abs() < 2e-2);
    }

    #[test]
    fn what_has_no_series_is_refused() {
        assert_eq!(slip_spectrum(&machine(), 200.0, 8), Ok(Err(NoSlip::BelowCritical)));
        let message = slip_spectrum(&machine(), 500.0, 9999).unwrap_err().to_string();
        assert_eq!(message, "harmonics = 9999: allowed is a whole number from 0 to 512");
    }
}
