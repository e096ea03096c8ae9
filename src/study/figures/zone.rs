//! Fig. 8: which pulses at which speeds lead to which lasting motion.

use super::{Figure, Panel, Quantity, Series, Style, speed_marks};
use crate::motion::Verdict;
use crate::scene::{ContactLaw, Scene, SolverKind};
use crate::study::{Axis, Map, MapPlan, Progress, Shard};

/// Speeds, from standstill to that of the scene.
const SPEEDS: u32 = 51;
/// Pulses, by equal factors.
const PULSES: u32 = 31;
/// Smallest and largest pulse \[N\].
const PULSE_RANGE: (f64, f64) = (1e3, 1e6);

const PULSE: Quantity = Quantity::log("pulse_n", "pulse [N]");

/// Fig. 8 for one machine with both contact laws, and with unilateral contact
/// for the machine of the time-domain figures, if its damping differs.
pub fn zone(scene: &Scene, other: &Scene) -> Figure {
    let bilateral = with(scene, SolverKind::Explicit, ContactLaw::Bilateral);
    let unilateral = with(scene, SolverKind::Event, ContactLaw::Unilateral);
    let mut panels = vec![
        panel("(a) bilateral contact, the paper's algorithm", bilateral),
        panel("(b) contact that only pushes", unilateral),
    ];
    if other.casing.damping_ratio != scene.casing.damping_ratio {
        let other = with(other, SolverKind::Event, ContactLaw::Unilateral);
        let title =
            format!("(c) contact that only pushes, zeta_c = {}", other.casing.damping_ratio);
        panels.push(panel(&title, other));
    }
    Figure {
        title: "How the motion lasts, against pulse and rotor speed".into(),
        note: format!(
            "n_d = {}, zeta_c = {}, {} s",
            scene.operation.nodal_diameters, scene.casing.damping_ratio, scene.solver.end_s
        ),
        panels,
    }
}

/// The scene with this contact law, and with this solver where it is possible.
fn with(scene: &Scene, kind: SolverKind, contact: ContactLaw) -> Scene {
    let mut scene = scene.clone();
    scene.solver.contact = contact;
    scene.solver.kind = kind;
    if scene.checked().is_err() {
        scene.solver.kind = SolverKind::Explicit;
    }
    scene
}

fn panel(title: &str, scene: Scene) -> Panel {
    let marks = speed_marks(&scene.machine());
    Panel { marks, ..Panel::new(title, Quantity::SPEED, PULSE, cells(scene)) }
}

/// One series of cells for each verdict that occurs.
fn cells(scene: Scene) -> Vec<Series> {
    let axis =
        |path: &str, (from, to), count, log| Axis { path: path.to_string(), from, to, count, log };
    let x = axis("operation.speed_rad_s", (0.0, scene.operation.speed_rad_s), SPEEDS, false);
    let y = axis("operation.pulse_n", PULSE_RANGE, PULSES, true);
    let mut map = Map::empty(MapPlan { scene, x, y, sensitivity: false });
    let all = Shard::WHOLE.indices(map.plan.len());
    map.fill(all, &Progress::default(), &|_, _| {});
    let (speeds, pulses) = (map.plan.x.values(), map.plan.y.values());
    Verdict::ALL
        .into_iter()
        .map(|verdict| {
            let at = map.cells.iter().enumerate().filter_map(|(cell, found)| {
                found.filter(|found| found.verdict == verdict)?;
                Some((*speeds.get(cell % speeds.len())?, *pulses.get(cell / speeds.len())?))
            });
            Series::new(verdict.as_ref(), Style::Cells(verdict), at)
        })
        .filter(|series| !series.points.is_empty())
        .collect()
}
