//! What can touch: the blades that always touch together make one row.
//!
//! Where blades and casing have the same diameters that is a side of the polygon.
//! Otherwise blades of one side have different angles: only those whose phases agree
//! in both modes have one gap; without a slope of the tips the angles do not move the
//! gaps, and a side is one row whose torque is shared evenly.

use std::collections::BTreeMap;

use crate::model::{ContactPolygon, Machine};
use crate::motion::Plane;

/// Blades that touch together.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Row {
    /// The side of the polygon they belong to.
    pub side: u32,
    /// Direction `exp(i psi)` in which their push moves the casing.
    pub casing: Plane,
    /// Mean of `exp(i n_b Phi)` over them: how it turns the blade modes.
    pub tip: Plane,
}

/// Every row of a machine whose blades have the phases of `tips`.
pub(super) fn rows(machine: &Machine, tips: &ContactPolygon, moving: bool) -> Vec<Row> {
    let polygon = &machine.polygon;
    let plane = |(cos, sin): (f64, f64)| Plane::new(cos, sin);
    let same = tips.nodal_diameters == polygon.nodal_diameters;
    if same || !moving {
        let row = |side| {
            let casing = plane(polygon.direction(side));
            Row { side, casing, tip: casing }
        };
        return (0..polygon.sides).map(row).collect();
    }
    let apart = machine.radial_coupling != 0.0;
    let mut groups: BTreeMap<(u32, u32), (Plane, f64)> = BTreeMap::new();
    for blade in 1..=polygon.blades {
        let tip = tips.side_of_blade(blade);
        let key = (polygon.side_of_blade(blade), if apart { tip } else { 0 });
        let (sum, count) = groups.entry(key).or_default();
        *sum += plane(tips.direction(tip));
        *count += 1.0;
    }
    let row = |((side, _), (sum, count)): ((u32, u32), (Plane, f64))| Row {
        side,
        casing: plane(polygon.direction(side)),
        tip: sum / count,
    };
    groups.into_iter().map(row).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    fn found(blades: &str, casing: &str, disk: &str, slope: &str) -> Vec<Row> {
        let scene = Scene::base()
            .with(&[
                ("bladed_disk.blades", blades),
                ("operation.nodal_diameters", casing),
                ("bladed_disk.nodal_diameters", disk),
                ("bladed_disk.radial_coupling", slope),
            ])
            .unwrap();
        let (n, tips) = (scene.bladed_disk.blades, disk.parse().unwrap());
        rows(&scene.machine(), &ContactPolygon::new(n, tips, 1e-4), true)
    }

    #[test]
    fn blades_share_a_row_where_all_that_moves_their_gaps_agrees() {
        assert_eq!(found("22", "3", "3", "0.1").len(), 22);
        assert_eq!(found("22", "4", "4", "0.1").len(), 11);
        // Opposite blades agree in the casing's phase, and not in that of five diameters.
        assert_eq!(found("22", "4", "5", "0.1").len(), 22);
        assert_eq!(found("22", "4", "6", "0.1").len(), 11);
        let merged = found("22", "4", "5", "0");
        assert_eq!(merged.len(), 11);
        assert!(merged.iter().all(|row| row.tip.norm() < 1e-15));
        assert_eq!(found("22", "3", "25", "0.1").len(), 22);
    }
}
