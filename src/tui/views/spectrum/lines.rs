//! Amplitude spectrum of the casing motion at the end of a run: Hann window, then a Fourier sum for
//! each line.

use std::f64::consts::{PI, TAU};

use crate::tui::axis::{readable, round_out};
use rubscope_solver::numeric::spectrum::amplitudes;
use rubscope_solver::scene::Scene;
use rubscope_solver::study::figures::{Panel, Quantity, Series, Style};

/// Ends of the amplitude axis, as powers of ten of a metre.
pub const DECADES: (f64, f64) = (-10.0, -3.0);
/// Half the rate of the samples, in ends of the frequency axis. What impacts excite above it would
/// appear as lines below, so it is where little is left.
const ROOM: f64 = 8.0;

/// Amplitudes at equally spaced angular frequencies, from 0.
#[derive(Clone, Debug, PartialEq)]
pub struct Spectrum {
    /// Spacing of the lines \[rad/s\].
    pub resolution: f64,
    /// Amplitude of `u_c` in each line \[m\].
    pub cosine: Vec<f64>,
    /// Amplitude of `u_s` in each line \[m\].
    pub sine: Vec<f64>,
    /// End of the frequency axis \[rad/s\].
    pub highest: f64,
    /// The lines on the axis; its labels have SI units.
    pub panel: Panel,
    /// What it is computed from: `0.000 s to 100.0 ms, Hann window`.
    pub note: String,
}

impl Spectrum {
    /// Returns the longest interval between two samples of the motion of a scene \[s\].
    pub fn longest_interval(scene: &Scene) -> f64 {
        PI / (ROOM * highest(scene))
    }

    /// Computes the spectrum of samples of `u_c` and `u_s` \[m\] in the motion of a scene, from
    /// their start and interval \[s\]. Empty for fewer than 8 samples.
    pub fn of(scene: &Scene, (begin, interval, signal): (f64, f64, Vec<[f64; 2]>)) -> Self {
        let length = signal.len() as f64 * interval;
        let [from, to] = [begin, begin + length].map(|t| readable(t, "s"));
        let (resolution, highest, least) = (TAU / length, highest(scene), 10_f64.powf(DECADES.0));
        let [cosine, sine] = [0, 1].map(|k| amplitudes(signal.iter().map(|u| u[k]).collect()));
        let series = |number, label, amplitudes: &[f64]| {
            let points = amplitudes.iter().enumerate();
            let points = points.map(|(k, size)| (k as f64 * resolution, size.max(least)));
            Series::new(label, Style::Line(number), points.take_while(|(w, _)| *w <= highest))
        };
        let series = vec![series(0, "u_c", &cosine), series(1, "u_s", &sine)];
        let x = Quantity::new("frequency_rad_s", "frequency [rad/s]", 1.0);
        let panel = Panel::new("", x, Quantity::log("u_m", "amplitude [m]"), series);
        let note = format!("{from} to {to}, Hann window");
        Self { resolution, cosine, sine, highest, panel, note }
    }
}

/// Returns the end of the frequency axis \[rad/s\]: above the frequencies of casing and blades in
/// the fixed frame at every speed of the run.
fn highest(scene: &Scene) -> f64 {
    let (machine, operation) = (scene.machine(), &scene.operation);
    let end = operation.speed_rad_s + operation.speed_ramp_rad_s2 * scene.solver.end_s;
    let fastest = operation.speed_rad_s.abs().max(end.abs());
    let most = (machine.nu(fastest) + machine.omega_bd).max(machine.omega_c);
    round_out(0.0, 1.3 * most, 5).1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sine_on_a_line_shows_its_frequency_and_amplitude() {
        let signal = (1..=2048)
            .map(|k| {
                let t = 0.1 * f64::from(k) / 2048.0;
                let (sin, cos) = (TAU * 240.0 * t).sin_cos();
                [3e-4 * cos, 1e-4 * sin]
            })
            .collect();
        let spectrum = Spectrum::of(&Scene::base(), (0.0, 0.1 / 2048.0, signal));
        let line = (TAU * 240.0 / spectrum.resolution).round() as usize;
        assert_eq!(line, 24);
        // With a Hann window, a sine at a line keeps its amplitude exactly.
        assert!((spectrum.cosine[24] - 3e-4).abs() < 1e-12);
        assert!((spectrum.sine[24] - 1e-4).abs() < 1e-12);
        assert!(spectrum.cosine[30] < 1e-12);
    }

    #[test]
    fn signals_that_are_no_numbers_have_no_spectrum() {
        for signal in [vec![[f64::NAN, 0.0]; 64], Vec::new()] {
            assert!(Spectrum::of(&Scene::base(), (0.0, 1.0, signal)).cosine.is_empty());
        }
    }
}
