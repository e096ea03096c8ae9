//! Figs. 4 to 7: one run, or the same run at three time steps.

use super::{Figure, Panel, Quantity, Series, Style};
use crate::motion::{RunReport, Sample, Sampling, Script, simulate_with};
use crate::scene::{CheckedScene, SolverKind};

/// Samples of a run; a line of a figure can show no more.
const INTERVALS: u32 = 1500;
/// The time steps of Fig. 4 \[s\].
const STEPS: [f64; 3] = [1e-6, 5e-7, 1e-7];

const U: Quantity = Quantity::new("u_m", "casing displacement [um]", 1e6);
const U_C: Quantity = Quantity::new("u_c_m", "u_c [um]", 1e6);
const ALPHA: Quantity = Quantity::new("alpha_rad", "blade angle [nrad]", 1e9);
const GAP: Quantity = Quantity::new("gap_m", "gap [um]", 1e6);

fn sampled(scene: &CheckedScene, gaps: bool) -> (RunReport, Vec<Sample>) {
    let mut samples = Vec::new();
    let sampling = Sampling { intervals: INTERVALS, gaps };
    let mut keep = |sample: &Sample| samples.push(sample.clone());
    let report = simulate_with(scene, &Script::default(), sampling, &mut keep);
    (report, samples)
}

/// One line that says what was run and how it ended.
fn note(scene: &CheckedScene, report: &RunReport) -> String {
    let lasting = match report.outcome.lock_time_s {
        Some(since) => format!("{} from {since:.4} s", report.outcome.verdict),
        None => report.outcome.verdict.to_string(),
    };
    let operation = &scene.operation;
    format!(
        "n_d = {}, {} rad/s, pulse {} N, zeta_c = {}, {} solver, {} contact, {lasting}",
        operation.nodal_diameters,
        operation.speed_rad_s,
        operation.pulse_n,
        scene.casing.damping_ratio,
        scene.solver.kind,
        scene.solver.contact,
    )
}

fn series(label: &str, style: Style, samples: &[Sample], of: fn(&Sample) -> f64) -> Series {
    Series::new(label, style, samples.iter().map(|sample| (sample.state.t_s, of(sample))))
}

/// Fig. 4: `u_c` at three time steps.
pub fn steps(scene: &CheckedScene) -> Figure {
    let mut lines = Vec::new();
    let mut told = String::new();
    for (index, step) in STEPS.into_iter().enumerate() {
        let mut scene = scene.clone().into_scene();
        scene.solver.kind = SolverKind::Explicit;
        scene.solver.step_s = step;
        let Ok(scene) = scene.checked() else { continue };
        let (report, samples) = sampled(&scene, false);
        let style = if index + 1 < STEPS.len() { Style::Dashed(index) } else { Style::Line(index) };
        lines.push(series(&format!("h = {step:e} s"), style, &samples, |sample| sample.state.u[0]));
        told = note(&scene, &report);
    }
    Figure {
        title: "Casing displacement u_c at three time steps".into(),
        note: told,
        panels: vec![Panel::new("", Quantity::TIME, U_C, lines)],
    }
}

/// Fig. 5: the gaps of all blades, those in contact at the end marked.
pub fn gaps(scene: &CheckedScene) -> Figure {
    let (report, samples) = sampled(scene, true);
    let held: Vec<u32> =
        report.outcome.contacts.iter().flat_map(|contact| contact.blades.clone()).collect();
    let lines: Vec<Series> = (1..=scene.bladed_disk.blades)
        .zip(0..)
        .map(|(blade, index): (u32, usize)| {
            let style =
                held.iter().position(|&other| other == blade).map_or(Style::Faint, |order| {
                    [Style::Line(order), Style::Dashed(order)][order % 2]
                });
            let gap = |sample: &Sample| Some((sample.state.t_s, *sample.gaps.get(index)?));
            Series::new(format!("gap {blade}"), style, samples.iter().filter_map(gap))
        })
        .collect();
    Figure {
        title: "Distances between the casing and the blade tips".into(),
        note: note(scene, &report),
        panels: vec![Panel::new("", Quantity::TIME, GAP, lines)],
    }
}

/// Figs. 6 and 7: the coordinates of casing and bladed disk.
pub fn response(scene: &CheckedScene) -> Figure {
    let (report, samples) = sampled(scene, false);
    let casing = vec![
        series("u_c", Style::Line(0), &samples, |sample| sample.state.u[0]),
        series("u_s", Style::Dashed(1), &samples, |sample| sample.state.u[1]),
    ];
    let blades = vec![
        series("alpha_c", Style::Line(0), &samples, |sample| sample.state.alpha[0]),
        series("alpha_s", Style::Dashed(1), &samples, |sample| sample.state.alpha[1]),
    ];
    Figure {
        title: "Modal vibrations of casing and bladed disk".into(),
        note: note(scene, &report),
        panels: vec![
            Panel::new("(a) casing", Quantity::TIME, U, casing),
            Panel::new("(b) bladed disk", Quantity::TIME, ALPHA, blades),
        ],
    }
}
