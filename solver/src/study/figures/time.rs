//! Figs. 4 to 7: one run, or the same run with three time steps.

use super::{Figure, Panel, Quantity, Series, Style, group_name};
use crate::motion::{RunReport, Sample, Sampling, Script, run_to_end};
use crate::numeric::rounding::rounded;
use crate::scene::keys;
use crate::scene::{CheckedScene, SolverKind};

/// Number of intervals between the samples of a run; the figure cannot resolve more.
const INTERVALS: u32 = 2000;
/// Time steps of Fig. 4 \[s\].
const STEPS: [f64; 3] = [1e-6, 5e-7, 1e-7];

/// Time interval of Fig. 4 that is shown enlarged \[s\].
const PARTING: [f64; 2] = [0.02, 0.05];

const U: Quantity = Quantity::new("u_m", "casing displacement [µm]", 1e6);
const U_C: Quantity = Quantity::new("u_m", "casing displacement u_c [µm]", 1e6);
const ALPHA: Quantity = Quantity::new("alpha_rad", "blade angle [nrad]", 1e9);
const GAP: Quantity = Quantity::new("gap_m", "gap between blade tip and casing [µm]", 1e6);

/// Statements common to the captions of Figs. 4 to 6.
const NOT_COMPARED: &str = "Cannot be compared: the force of the pulse, which the paper does not \
    print, and the scales of its picture. 43,400 N was found by search; 40 kN locks at 84 to \
    90 ms on other blades.";
const OTHER_DAMPING: &str = "Differs from the paper's Table 1: the casing has no damping here, and \
    contact only pushes. With ζ_c = 0.05 none of 2000 pulses from 3 kN to 30 MN locks later \
    than 36 ms (contact that only pushes), and none of 200 later than 10 ms (the paper's \
    equality), so no setting was found that gives Figs. 4 to 7 and Fig. 8 together.";

fn sampled(scene: &CheckedScene, gaps: bool) -> (RunReport, Vec<Sample>) {
    let mut samples = Vec::new();
    let sampling = Sampling { intervals: INTERVALS, gaps };
    let mut keep = |sample: &Sample| samples.push(sample.clone());
    let report = run_to_end(scene, &Script::default(), sampling, &mut keep);
    (report, samples)
}

/// Runs a scene without samples.
fn plain(scene: &CheckedScene) -> RunReport {
    run_to_end(scene, &Script::default(), Sampling::default(), &mut |_| {})
}

/// Describes the end of a run: "locked from 76.9 ms on #6 and #21".
fn ending(report: &RunReport) -> String {
    let held: Vec<String> =
        report.outcome.contacts.iter().map(|contact| group_name(&contact.blades)).collect();
    let verdict = report.outcome.verdict;
    match report.outcome.lock_time_s {
        Some(since) => format!("{verdict} from {:.1} ms on {}", 1e3 * since, held.join(" and ")),
        None => verdict.to_string(),
    }
}

/// Describes the conditions of a run and its end.
fn note(scene: &CheckedScene, report: &RunReport) -> String {
    let (operation, solver) = (&scene.operation, &scene.solver);
    let step = match solver.kind {
        SolverKind::Explicit => format!(", {}", step_words(solver.step_s)),
        SolverKind::Event => String::new(),
    };
    format!(
        "n_d = {}, Ω = {} rad/s, pulse of {} kN for {} µs, ζ_c = {}, ζ_bd = {}; {} solver, {} \
         contact{step}: {}.",
        operation.nodal_diameters,
        operation.speed_rad_s,
        1e-3 * operation.pulse_n,
        1e6 * operation.pulse_s,
        scene.casing_in_use().damping_ratio,
        scene.disk_in_use().damping_ratio,
        solver.kind,
        solver.contact,
        ending(report),
    )
}

fn series(label: &str, style: Style, samples: &[Sample], of: fn(&Sample) -> f64) -> Series {
    Series::new(label, style, samples.iter().map(|sample| (sample.state.t_s, of(sample))))
}

/// Formats a time step: "h = 0.5 µs".
fn step_words(step_s: f64) -> String {
    format!("h = {} µs", rounded(1e6 * step_s, 6))
}

/// Returns the scene with each of the time steps of Fig. 4 that it allows.
fn at_steps(scene: &CheckedScene) -> impl Iterator<Item = (f64, CheckedScene)> {
    STEPS.into_iter().filter_map(|step| {
        let mut scene = scene.clone().into_scene();
        scene.solver.kind = SolverKind::Explicit;
        scene.solver.step_s = step;
        Some((step, scene.checked().ok()?))
    })
}

/// Describes the end of the same run with the event solver; `None` if that does not support the
/// scene.
fn by_events(scene: &CheckedScene) -> Option<String> {
    let reference = scene.as_reference().checked().ok()?;
    Some(format!("event solver: {}", ending(&plain(&reference))))
}

/// Draws Fig. 4: `u_c` with three time steps.
pub fn steps(scene: &CheckedScene) -> Figure {
    let (mut lines, mut endings, mut conditions) = (Vec::new(), Vec::new(), String::new());
    for (index, (step, scene)) in at_steps(scene).enumerate() {
        let (report, samples) = sampled(&scene, false);
        // Line styles as in the paper: dotted, dashed and solid.
        let style = [Style::Dotted(index), Style::Dashed(index)].get(index).copied();
        let style = style.unwrap_or(Style::Line(index));
        let line = series(&step_words(step), style, &samples, |sample| sample.state.u[0]);
        lines.push(line.named(format!("u_c_h{step:e}")));
        endings.push(format!("{}: {}", step_words(step), ending(&report)));
        conditions = note(&scene, &report);
    }
    endings.extend(by_events(scene));
    let [from, to] = PARTING;
    let parting = lines.iter().map(|line: &Series| {
        let shown = line.points.iter().copied().filter(|point| (from..=to).contains(&point.0));
        Series { points: shown.collect(), ..line.clone() }
    });
    let parting = parting.collect();
    let panels = vec![
        Panel::new("(a) whole run", Quantity::TIME, U_C, lines),
        Panel::new("(b) where the phases part", Quantity::TIME, U_C, parting),
    ];
    let mut figure = Figure::new("Casing displacement u_c at three time steps", conditions, panels);
    figure.caption.push(format!("{}.", endings.join("; ")));
    figure.caption.push(
        "Agrees with the paper: the motion is locked from about 0.08 s at each of its three steps \
         and looks the same from then on, but its phase depends on the step. So do the blades: at \
         each of 50 steps from 0.01 to 1 µs it locks from 75 to 81 ms, at some 30 of them on #6 \
         and #21. Round-off moves the lock too: steps of 1 µs with twice the digits lock at 79.6 ms."
            .into(),
    );
    figure.caption.extend([NOT_COMPARED, OTHER_DAMPING].map(String::from));

    figure
}

/// Draws Fig. 5: the gaps of all blades, highlighting those in contact at the end.
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
            let line = Series::new(format!("#{blade}"), style, samples.iter().filter_map(gap));
            line.named(format!("gap {blade}"))
        })
        .collect();
    let panels = vec![Panel::new("", Quantity::TIME, GAP, lines)];
    let title = "Distances between the casing and the blade tips";
    let mut figure = Figure::new(title, note(scene, &report), panels);
    let deepest = report.checks.max_penetration_m;
    figure.caption.push(format!(
        "Thin lines are the blades that are not in contact at the end. Deepest penetration of the \
         whole run: {}.",
        if deepest > 1e-15 { format!("{:.2} µm", 1e6 * deepest) } else { "none".into() }
    ));
    figure.caption.push(
        "Agrees with the paper: blades #6 and #21 are in permanent contact, which begins at \
             about 0.08 s; no gap is negative."
            .into(),
    );
    figure.caption.extend([NOT_COMPARED, OTHER_DAMPING].map(String::from));

    figure
}

fn casing_lines(samples: &[Sample]) -> Vec<Series> {
    vec![
        series("u_c", Style::Line(0), samples, |sample| sample.state.u[0]),
        series("u_s", Style::Dashed(1), samples, |sample| sample.state.u[1]),
    ]
}

fn blade_lines(samples: &[Sample]) -> Vec<Series> {
    vec![
        series("α_c", Style::Line(0), samples, |sample| sample.state.alpha[0]).named("alpha_c"),
        series("α_s", Style::Dashed(1), samples, |sample| sample.state.alpha[1]).named("alpha_s"),
    ]
}

/// Returns the title of a panel of the disk, with its damping.
fn blade_title(letter: &str, scene: &CheckedScene) -> String {
    format!(
        "{letter} bladed disk, ζ_bd = {}",
        (1e3 * scene.disk_in_use().damping_ratio).round() / 1e3
    )
}

/// Draws the coordinates of casing and disk over time.
fn coordinates(scene: &CheckedScene) -> Figure {
    let (report, samples) = sampled(scene, false);
    let panels = vec![
        Panel::new("(a) casing", Quantity::TIME, U, casing_lines(&samples)),
        Panel::new(&blade_title("(b)", scene), Quantity::TIME, ALPHA, blade_lines(&samples)),
    ];
    Figure::new("Modal vibrations of casing and bladed disk", note(scene, &report), panels)
}

/// Draws Fig. 6: the coordinates of casing and disk, also with the paper's blade damping taken
/// literally.
pub fn response(scene: &CheckedScene) -> Figure {
    let mut figure = coordinates(scene);
    // The paper prints d_bd = 2 omega_bd zeta_bd next to m_b; without the inertia, the damping
    // ratio is larger by the factor 1/m_b.
    let disk = scene.disk_in_use();
    let literal = disk.damping_ratio / disk.inertia_kg_m2;
    let text = literal.to_string();
    if let Ok(damped) = scene.clone().into_scene().with(&[(keys::BLADE_DAMPING, &text)]) {
        let (_, samples) = sampled(&damped, false);
        let title = blade_title("(c)", &damped);
        let panel = Panel::new(&title, Quantity::TIME, ALPHA, blade_lines(&samples));
        figure.panels.push(panel);
        figure.caption = [
            "Agrees with the paper: from about 0.08 s a forward travelling wave turns with the \
             rotor in the casing. (c) has the d_bd = 2 ω_bd ζ_bd that the paper prints, taken \
             literally beside m_b: the disk comes to a static deformation at about the same time, \
             as in the paper's Fig. 6(b).",
            "Differs: with the printed ζ_bd (b) the bladed disk has not reached its static \
             deformation; it still swings by 19 nrad about it at the end.",
            NOT_COMPARED,
            OTHER_DAMPING,
        ]
        .map(String::from)
        .to_vec();
    }
    figure
}

/// Draws Fig. 7: as Fig. 6, for four nodal diameters.
pub fn four_diameters(scene: &CheckedScene) -> Figure {
    let mut figure = coordinates(scene);
    let at = |(step, scene): (f64, CheckedScene)| {
        format!("{}: {}", step_words(step), ending(&plain(&scene)))
    };
    let mut endings: Vec<String> = at_steps(scene).map(at).collect();
    endings.extend(by_events(scene));
    figure.caption.push(format!("{}.", endings.join("; ")));
    figure.caption.extend(
        [
            "Agrees with the paper: the same kind of motion as with three nodal diameters, held \
             by two neighbouring groups of blades, which are two blades each.",
            "Differs: the paper's lock begins at about 0.08 s. No setting that gives this was \
             found that does not depend on the step. Of 50 steps from 0.01 to 1 µs, each longer \
             by the same factor, 50 kN locks at 50, from 22 to 152 ms, half of them by 28 ms; \
             42 kN locks at 32, from 32 to 89 ms, half of them by 48 ms; other steps give other \
             times. The bladed disk has not reached its static deformation: it still swings by 26 \
             nrad about it at the end. The casing has no damping, and the modal stiffness that \
             the printed Ω_c = 256.12 rad/s implies.",
            "Cannot be compared: the force of the pulse and the scales of the picture.",
        ]
        .map(String::from),
    );
    figure
}
