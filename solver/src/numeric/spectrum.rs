//! Amplitude spectrum of a signal: Hann window, then a Fourier sum for each line.

use std::f64::consts::TAU;

/// Returns the amplitude of each line up to half the rate of the samples, scaled such that a sine at
/// the frequency of a line gives its own amplitude there.
/// Empty for fewer than 8 samples, or if one is not finite.
pub fn amplitudes(mut samples: Vec<f64>) -> Vec<f64> {
    let count = samples.len();
    if count < 8 || samples.iter().any(|x| !x.is_finite()) {
        return Vec::new();
    }
    let turns: Vec<_> = (0..count).map(|k| (TAU * k as f64 / count as f64).sin_cos()).collect();
    for (sample, (_, cos)) in samples.iter_mut().zip(&turns) {
        *sample *= 0.5 - 0.5 * cos;
    }
    let amplitude = |line: usize| {
        let (mut cosine, mut sine, mut turn) = (0.0, 0.0, 0);
        for sample in &samples {
            let (sin, cos) = turns[turn];
            cosine += sample * cos;
            sine += sample * sin;
            turn = if turn + line < count { turn + line } else { turn + line - count };
        }
        // The Hann window halves a sine's amplitude, and the sum is count/2 times it.
        4.0 / count as f64 * f64::hypot(cosine, sine)
    };
    (0..=count / 2).map(amplitude).collect()
}
