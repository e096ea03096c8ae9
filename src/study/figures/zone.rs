//! Fig. 8: which pulses at which speeds lead to which lasting motion, with the
//! paper's equality contact and with contact that only pushes.

use super::{Figure, Mark, Panel, Quantity, Series, Style};
use crate::motion::Verdict;
use crate::scene::{ContactLaw, Scene, SolverKind};
use crate::study::{Axis, Map, MapPlan, Progress};

/// Speeds, from standstill to that of the scene.
const SPEEDS: u32 = 51;
/// Pulses, by equal factors.
const PULSES: u32 = 31;
/// Smallest and largest pulse \[N\].
const PULSE_RANGE: (f64, f64) = (1e3, 1e6);

const PULSE: Quantity = Quantity { column: "pulse_n", label: "pulse [N]", factor: 1.0, log: true };

/// Fig. 8, once for each contact law.
pub fn zone(scene: &Scene) -> Figure {
    let mut panels = Vec::new();
    for (law, title) in [
        (ContactLaw::Bilateral, "(a) bilateral contact, the paper's algorithm"),
        (ContactLaw::Unilateral, "(b) unilateral contact"),
    ] {
        let mut scene = scene.clone();
        scene.solver.kind = SolverKind::Explicit;
        scene.solver.contact = law;
        let mut panel = Panel::new(title, Quantity::SPEED, PULSE, cells(scene.clone()));
        let machine = scene.machine();
        for (label, speed) in
            [("Omega_c", machine.critical_speed()), ("Omega_lock", machine.lock_speed())]
        {
            panel.marks.extend(speed.map(|x| Mark { x, label }));
        }
        panels.push(panel);
    }
    Figure {
        number: 8,
        title: "How the motion lasts, against pulse and rotor speed".into(),
        note: format!(
            "n_d = {}, zeta_c = {}, explicit solver, h = {:e} s",
            scene.operation.nodal_diameters, scene.casing.damping_ratio, scene.solver.step_s
        ),
        panels,
    }
}

/// One series of cells for each verdict that occurs.
fn cells(scene: Scene) -> Vec<Series> {
    let axis =
        |path: &str, (from, to), count, log| Axis { path: path.to_string(), from, to, count, log };
    let x = axis("operation.speed_rad_s", (0.0, scene.operation.speed_rad_s), SPEEDS, false);
    let y = axis("operation.pulse_n", PULSE_RANGE, PULSES, true);
    let mut map = Map::empty(MapPlan { scene, x, y, sensitivity: false });
    let all: Vec<usize> = (0..map.plan.len()).collect();
    map.fill(&all, &Progress::default(), &|_, _| {});
    let (speeds, pulses) = (map.plan.x.values(), map.plan.y.values());
    Verdict::ALL
        .into_iter()
        .map(|verdict| {
            let at = map.cells.iter().enumerate().filter_map(|(cell, found)| {
                found.filter(|found| found.verdict == verdict)?;
                Some((*speeds.get(cell % speeds.len())?, *pulses.get(cell / speeds.len())?))
            });
            Series::new(verdict.word(), Style::Cells(verdict), at)
        })
        .filter(|series| !series.points.is_empty())
        .collect()
}
