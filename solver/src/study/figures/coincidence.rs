//! Blade amplitude against speed about the dangerous coincidence of blades that rub on a
//! lining from the start, at two dampings (docs/theory.md, section 10). No figure of the
//! paper: its last page names what is shown here as work to come.

use rayon::prelude::*;

use super::{Figure, Mark, Panel, Quantity, Series, Style};
use crate::harmonic::{CoincidencePoint, HarmonicError, Lining, coincidence, shifted_coincidence};
use crate::motion::{Sampling, Script, run_to_end};
use crate::scene::keys;
use crate::scene::{CheckedScene, Scene, SceneError};

/// Speeds of a curve, and of a part of it that one thread computes.
const SPEEDS: u32 = 401;
const SPEEDS_AT_ONCE: usize = 16;
/// Damping ratio of casing and blades in the second curve.
const LIGHT: f64 = 0.01;
/// Stiffness of all blades together in it, `N k_p/2` \[N/m\].
const LIGHT_STIFFNESS: f64 = 60e3;
/// How far the range reaches beyond the coincidences, in parts of them.
const BEYOND: f64 = 0.06;
/// Where runs in time are made, in parts of the range that grows.
const RUNS: [f64; 6] = [0.07, 0.17, 0.28, 0.42, 0.65, 0.9];
/// Samples of a run; the last tenth is looked at.
const SAMPLES: u32 = 2000;

const BLADES: Quantity = Quantity::new("blade_amplitude_rad", "blade amplitude |a| [µrad]", 1e6);

/// The scene of this figure.
///
/// # Errors
/// None, as these keys and values exist.
pub fn own_scene() -> Result<Scene, SceneError> {
    let mut scene = Scene::base();
    for (path, value) in [
        (keys::LAW, "smooth"),
        (keys::STEP, "5e-6"),
        (keys::END, "4"),
        (keys::CASING_RADIUS, "0.49988"),
        (keys::RADIAL_COUPLING, "0.5"),
        (keys::LINING_STIFFNESS, "27e3"),
        (keys::SPEED, "406"),
        (keys::PULSE, "20e3"),
    ] {
        scene.set(path, value)?;
    }
    Ok(scene)
}

/// The same machine with little damping, on a lining as soft as that asks for.
fn light(scene: &Scene) -> Scene {
    let mut scene = scene.clone();
    scene.casing.damping_ratio = LIGHT;
    scene.bladed_disk.damping_ratio = LIGHT;
    scene.contact.stiffness_n_per_m = 2.0 * LIGHT_STIFFNESS / f64::from(scene.bladed_disk.blades);
    scene
}

fn words(scene: &Scene) -> String {
    let (casing, blades) = (scene.casing_in_use().damping_ratio, scene.disk_in_use().damping_ratio);
    format!("ζ_c = {casing}, ζ_bd = {blades}")
}

/// The curve of a scene: zero where every wave decays.
fn curve(
    scene: &Scene,
    speeds: &[f64],
    name: &str,
    colour: usize,
) -> Result<Series, HarmonicError> {
    let amplitude = |point: &CoincidencePoint| match point.blade_amplitude_rad {
        Some(amplitude) => amplitude,
        None if point.bounded => 0.0,
        // Grows without bound: nothing to draw.
        None => f64::NAN,
    };
    let parts: Result<Vec<_>, _> =
        speeds.par_chunks(SPEEDS_AT_ONCE).map(|part| coincidence(scene, part)).collect();
    let found = parts?.concat();
    let points = found.iter().map(|point| (point.speed_rad_s, amplitude(point)));
    Ok(Series::new(words(scene), Style::Line(colour), points).named(name))
}

/// The amplitude of the blades at the end of runs in time at a few speeds.
fn runs(scene: &CheckedScene, [from, to]: [f64; 2]) -> Series {
    let run = |part: f64| {
        let speed = from + (to - from) * part;
        let scene = scene.perturbed(|scene| scene.operation.speed_rad_s = speed);
        let late = (1.0 - 0.1) * scene.solver.end_s;
        let mut largest = 0.0_f64;
        let sampling = Sampling { intervals: SAMPLES, gaps: false };
        run_to_end(&scene, &Script::default(), sampling, &mut |sample| {
            let [cos, sin] = sample.state.alpha;
            if sample.state.t_s >= late {
                largest = largest.max(cos.hypot(sin));
            }
        });
        (speed, largest)
    };
    let found: Vec<(f64, f64)> = RUNS.into_par_iter().map(run).collect();
    Series::new("runs in time", Style::Discs(0, 4), found).named("simulated")
}

/// The figure.
///
/// # Errors
/// None, for the scene of this figure.
pub fn peaks(scene: &CheckedScene) -> Result<Figure, HarmonicError> {
    let machine = scene.machine();
    let damped: &Scene = scene;
    let light = light(damped);
    let sense = 1_f64.copysign(scene.operation.speed_rad_s);
    let plain = machine.dangerous_speed_toward(sense).ok_or(HarmonicError::NoWave)?;
    let shifted = [damped, &light].map(|scene| shifted_coincidence(scene, sense));
    let labels = ["(31)", "lining", "soft lining"];
    let places = [Some(plain), shifted[0], shifted[1]];
    let marks: Vec<Mark> = places
        .into_iter()
        .zip(labels)
        .filter_map(|(x, label)| Some(Mark { x: x?, label }))
        .collect();
    let of_marks = || marks.iter().map(|mark| mark.x);
    let least = of_marks().fold(f64::INFINITY, f64::min);
    let most = of_marks().fold(f64::NEG_INFINITY, f64::max);
    let (from, to) = (least - BEYOND * least.abs(), most + BEYOND * most.abs());
    let part = |k: u32| f64::from(k) / f64::from(SPEEDS - 1);
    let speeds: Vec<f64> = (0..SPEEDS).map(|k| from + (to - from) * part(k)).collect();
    let mut series =
        vec![curve(damped, &speeds, "damped", 0)?, curve(&light, &speeds, "light", 1)?];
    let lining = Lining::of(&machine, &scene.contact)?;
    let hopf = lining.hopf_points([from, to])?;
    if let [first, .., last] = hopf.as_slice() {
        series.push(runs(scene, [first.speed_rad_s, last.speed_rad_s]));
    }
    let panel = Panel { marks, ..Panel::new("", Quantity::SPEED, BLADES, series) };
    let stiffness = |scene: &Scene| scene.contact.stiffness_n_per_m / 1e3;
    let note = format!(
        "n_d = {}, κ = {}, g_0 = {:.1} µm, k_p = {:.2} and {:.2} kN/m under each blade; harmonic \
         balance with the exact mean of the lining, linearised. Dashed: (ω_c + ω_bd)/n_d, Eq. (31), \
         and the same with the frequencies that each lining gives.",
        machine.nodal_diameters,
        scene.bladed_disk.radial_coupling,
        1e6 * machine.clearance(),
        stiffness(damped),
        stiffness(&light),
    );
    let mut figure =
        Figure::new("Blade amplitude against rotor speed about the coincidence", note, vec![panel]);
    figure.caption = [
        "Not a figure of the paper. Its last page expects a dangerous coincidence at \
             (ω_c + ω_bd)/n_d, Eq. (31), and leaves it to later work. Its own blades do not feel \
             the casing move; tips that move outward as blades bend do.",
        "All blades rub at rest. The lining stiffens casing and blades, so the peak stands \
             above Eq. (31); with less damping a softer lining is enough, and the peak comes \
             down to it. Where blades lift off for a part of each turn, the growth ends: that \
             gives the height.",
    ]
    .map(String::from)
    .to_vec();

    Ok(figure)
}
