//! Fig. 8: the verdict as a function of pulse and speed.

use rayon::prelude::*;

use super::{Figure, Panel, Quantity, Series, Style, speed_marks};
use crate::motion::{Verdict, run_to_verdict, to_the_end};
use crate::numeric::search::bisected_to;
use crate::scene::keys::{DIAMETERS, PULSE, SPEED};
use crate::scene::{CheckedScene, ContactLaw, Scene, SceneError, SolverKind};
use crate::study::{Axis, Map, MapPlan};

/// Number of speeds, from a fifth of the scene's speed up to it.
const SPEEDS: u32 = 41;
/// Number of pulses with equal ratios, fifteen a decade.
const PULSES: u32 = 46;
/// Smallest and largest pulse \[N\].
const PULSE_RANGE: (f64, f64) = (1e4, 1e7);
/// Relative accuracy of the threshold, and the number of rows above it in which the wave must be
/// held: half a decade.
const THRESHOLD: f64 = 1e-3;
const LASTING_ROWS: usize = 8;

const THRESHOLD_NAME: &str = "threshold";
const FORCE: Quantity = Quantity::log("pulse_n", "force of the pulse [N]");

/// Draws Fig. 8 for one machine with both contact laws, and for four nodal diameters.
pub fn zone(scene: &CheckedScene) -> Result<Figure, SceneError> {
    let four = scene.clone().into_scene().with(&[(DIAMETERS, "4")])?;
    let panels = [both_laws(scene, ["(a)", "(b)"]), both_laws(&four, ["(c)", "(d)"])].concat();
    let note = format!(
        "ζ_c = {}, ζ_bd = {}, pulse of {} µs, runs of {} s, {} solver in (a) and (c). Above the \
         line, the threshold, every pulse up to {} MN that was tried lasts.",
        scene.casing_in_use().damping_ratio,
        scene.disk_in_use().damping_ratio,
        1e6 * scene.operation.pulse_s,
        scene.solver.end_s,
        scene.solver.kind,
        1e-6 * PULSE_RANGE.1,
    );
    let title = "How the motion lasts, against pulse and rotor speed";
    let caption = CAPTION.map(String::from).to_vec();
    Ok(Figure { caption, columns: 2, ..Figure::new(title, note, panels) })
}

const CAPTION: [&str; 4] = [
    "Agrees with the paper: with its algorithm and its Table 1 (a), interaction needs a speed above \
     Ω_c, where every pulse above a threshold lasts: 0.85 MN at 300 rad/s, 0.54 MN at 400 rad/s, \
     0.38 MN at 500 rad/s. Some smaller ones last too, in islands. Nothing lasts below Ω_c; a cell \
     reaches to the middle between its speed and the next.",
    "Differs: with damping the zone begins a little above Ω_c, at 295 rad/s in (a) and 260 rad/s in \
     (c); without damping of the casing it would begin at Ω_c, and all locks would push. With it, \
     below Ω_lock everything that lasts is adhesive, held by a multiplier that pulls, which \
     no contact can do; the paper does not tell it from locked motion. With contact that only \
     pushes (b) the zone is gone, and single cells are left.",
    "With four nodal diameters and the paper's algorithm (c) the threshold is 36 to 61 kN. With \
     contact that only pushes (d) some pulses lock the wave and others do not, in bands.",
    "Cannot be compared: the scale of the paper's pulses. Figs. 4 to 7 need another setting, without \
     damping of the casing: no one setting gives all of them.",
];

/// Returns the panels for the paper's law and for contact that only pushes.
fn both_laws(scene: &Scene, letters: [&str; 2]) -> Vec<Panel> {
    let laws = [
        (SolverKind::Explicit, ContactLaw::Bilateral, "the paper's algorithm (bilateral)"),
        (SolverKind::Event, ContactLaw::Unilateral, "contact that only pushes (event solver)"),
    ];
    let panel = |((kind, contact, words), letter): ((_, _, &str), &str)| {
        let mut scene = scene.clone();
        scene.solver.contact = contact;
        scene.solver.kind = kind;
        if scene.checked().is_err() {
            scene.solver.kind = SolverKind::Explicit;
        }
        let marks = speed_marks(&scene.machine(), scene.operation.speed_rad_s);
        let title = format!("{letter} n_d = {}, {words}", scene.operation.nodal_diameters);
        Panel { marks, ..Panel::new(&title, Quantity::SPEED, FORCE, series(scene)) }
    };
    laws.into_iter().zip(letters).map(panel).collect()
}

/// Returns one series of cells for each verdict that occurs, and the threshold.
fn series(scene: Scene) -> Vec<Series> {
    let axis =
        |path: &str, (from, to), count, log| Axis { path: path.to_string(), from, to, count, log };
    let fastest = scene.operation.speed_rad_s;
    let x = axis(SPEED, (0.2 * fastest, fastest), SPEEDS, false);
    let y = axis(PULSE, PULSE_RANGE, PULSES, true);
    let mut map = Map::empty(MapPlan { scene, x, y, sensitivity: false });
    map.fill((0..map.plan.len()).into_par_iter(), &|| true, &|_, _| {});
    let (speeds, pulses) = (map.plan.x.values(), map.plan.y.values());
    let mut series: Vec<Series> = Verdict::ALL
        .into_iter()
        .map(|verdict| {
            let at = map.cells.iter().enumerate().filter_map(|(cell, found)| {
                found.filter(|found| found.verdict == verdict)?;
                Some((*speeds.get(cell % speeds.len())?, *pulses.get(cell / speeds.len())?))
            });
            Series::new(verdict.as_ref(), Style::Cells(verdict), at)
        })
        .collect();
    let edge =
        (0..SPEEDS).filter_map(|column| Some((map.plan.x.value(column), threshold(&map, column)?)));
    series.push(Series::new(THRESHOLD_NAME, Style::Line(5), edge));
    let is_seen = |series: &Series| match series.style {
        // A line with a single point is invisible.
        Style::Line(_) => series.points.len() > 1,
        _ => !series.points.is_empty(),
    };
    series.retain(is_seen);
    series
}

/// Returns the threshold of a column: the smallest pulse above which every larger one of the map
/// leads to a held wave, located by bisection between two cells. `None` if fewer than
/// [`LASTING_ROWS`] of the largest pulses do, or if all do.
fn threshold(map: &Map, column: u32) -> Option<f64> {
    let lasts = |row: u32| map.at(column, row).is_some_and(|cell| cell.verdict.is_held());
    let rows = map.plan.y.count;
    let lasting = (0..rows).rev().take_while(|row| lasts(*row));
    let above = lasting.skip(LASTING_ROWS - 1).last()?;
    let below = above.checked_sub(1)?;
    let (short, enough) = (map.plan.y.value(below), map.plan.y.value(above));
    let mut scene = map.plan.scene.clone();
    map.plan.x.apply(&mut scene, column).ok()?;
    let lasts = |force: f64| {
        scene.operation.pulse_n = force;
        let scene = scene.checked().ok();
        let reached = scene.and_then(|scene| run_to_verdict(&scene, &to_the_end));
        reached.is_some_and(|reached| reached.verdict.is_held())
    };
    Some(bisected_to([short, enough], THRESHOLD, lasts)[1])
}
