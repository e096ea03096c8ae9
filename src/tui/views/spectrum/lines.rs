//! Amplitude spectrum of the casing motion over a run: Hann window, then a real Fourier transform.

use std::f64::consts::TAU;

use realfft::RealFftPlanner;

/// Amplitudes at equally spaced angular frequencies, from 0.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Spectrum {
    /// Spacing of the lines \[rad/s\].
    pub resolution: f64,
    /// Amplitude of `u_c` in each line \[m\].
    pub cosine: Vec<f64>,
    /// Amplitude of `u_s` in each line \[m\].
    pub sine: Vec<f64>,
}

impl Spectrum {
    /// Computes the spectrum of samples of `u_c` and `u_s` \[m\] at equal intervals over `length`
    /// seconds. Empty for fewer than 8 samples.
    pub fn of(signal: &[[f64; 2]], length: f64) -> Self {
        let of = |place: usize| {
            let samples: Vec<f64> =
                signal.iter().map(|pair| pair.get(place).copied().unwrap_or(0.0)).collect();
            amplitudes_of(samples)
        };
        Self { resolution: TAU / length, cosine: of(0), sine: of(1) }
    }
}

/// Returns the amplitude of each line, scaled such that a sine at the frequency of a line gives its
/// own amplitude there.
/// Empty for fewer than 8 samples, or if one is not finite.
fn amplitudes_of(mut samples: Vec<f64>) -> Vec<f64> {
    let count = samples.len();
    if count < 8 || samples.iter().any(|x| !x.is_finite()) {
        return Vec::new();
    }
    for (k, sample) in samples.iter_mut().enumerate() {
        *sample *= 0.5 - 0.5 * (TAU * k as f64 / count as f64).cos();
    }
    let transform = RealFftPlanner::<f64>::new().plan_fft_forward(count);
    let mut lines = transform.make_output_vec();
    if transform.process(&mut samples, &mut lines).is_err() {
        return Vec::new();
    }
    // The Hann window halves a sine's amplitude, and the transform gives count/2 times it: factor
    // 4/count.
    lines.iter().map(|line| 4.0 * line.norm() / count as f64).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_on_a_line_shows_its_frequency_and_amplitude() {
        let signal: Vec<[f64; 2]> = (1..=2048)
            .map(|k| {
                let t = 0.1 * f64::from(k) / 2048.0;
                let (sin, cos) = (TAU * 240.0 * t).sin_cos();
                [3e-4 * cos, 1e-4 * sin]
            })
            .collect();
        let spectrum = Spectrum::of(&signal, 0.1);
        let line = (TAU * 240.0 / spectrum.resolution).round() as usize;
        assert_eq!(line, 24);
        // With a Hann window, a sine at a line keeps its amplitude exactly.
        assert!((spectrum.cosine[24] - 3e-4).abs() < 1e-12);
        assert!((spectrum.sine[24] - 1e-4).abs() < 1e-12);
        assert!(spectrum.cosine[30] < 1e-12);
    }

    #[test]
    fn signals_that_are_no_numbers_have_no_spectrum() {
        assert!(Spectrum::of(&[[f64::NAN, 0.0]; 64], 1.0).cosine.is_empty());
        assert!(Spectrum::of(&[], 1.0).cosine.is_empty());
    }
}
