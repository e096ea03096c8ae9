//! What comes after an event: impacts, and which rows hold.
//!
//! At an impact the impulses solve `W p + (1 + e) g' >= 0`, complementary, for gaps
//! that close, and `W p + g' >= 0` for the others (Newton). Among gaps that are closed
//! and at rest the accelerations decide in the same way. A row whose push has vanished
//! opens and is not tested again.

use super::Joined;
use super::complementarity::pushes;
use super::parameters::Point;
use super::search::Loose;
use super::stretch::Held;
use crate::motion::{ActiveSet, FailureReason, Plane};
use crate::tolerances::{ROUND_OFF, SOFT_TOUCH};

impl Joined {
    /// Rows that touch, each with the rate of its gap \[m/s\].
    pub(super) fn meet(&mut self, point: &mut Point, met: &[(usize, f64)]) {
        let parameters = &self.parameters;
        let arm = parameters.arm().abs();
        // Slower is at rest: the round-off of rates that cancel.
        let soft = SOFT_TOUCH * parameters.machine.omega_c * parameters.clearance()
            + ROUND_OFF * (point.dz.norm() + arm * point.da.norm());
        let rebound = |rate: f64| {
            let back = -parameters.restitution * rate;
            if back > soft { back } else { 0.0 }
        };
        let target: Vec<f64> = met.iter().map(|&(_, rate)| rate - rebound(rate)).collect();
        let joint = |row: usize, by: usize| match (met.get(row), met.get(by)) {
            (Some(row), Some(by)) => parameters.joint(row.0, by.0),
            _ => 0.0,
        };
        let noise = ROUND_OFF * target.iter().fold(soft, |sum, rate| sum + rate.abs());
        let Some(impulses) = pushes(joint, &target, noise) else {
            self.fail_at(point, FailureReason::Singular { rows: met.len() });
            return;
        };
        let struck = || met.iter().map(|&(row, _)| row).zip(impulses.iter().copied());
        let (z, a) = parameters.pushed(struck());
        let before = *point;
        (point.dz, point.da) = (point.dz + z, point.da + a);
        let (mut still, mut loose) = (Vec::new(), Vec::new());
        for (&(row, rate), &impulse) in met.iter().zip(&impulses) {
            let after =
                if impulse > 0.0 { rebound(rate) } else { rate + parameters.along(row, z, a) };
            if after > soft {
                loose.push(Loose { row, gap: 0.0, rate: after, released: false });
            } else {
                still.push(row);
            }
            self.ledger.impacts -= 0.5 * impulse * (rate + after);
        }
        let mean =
            Point { dz: (before.dz + point.dz) * 0.5, da: (before.da + point.da) * 0.5, ..before };
        self.ledger.push(parameters, &mean, struck());
        self.tell_impacts(met, &impulses, soft);
        self.loose.retain(|gap| met.iter().all(|&(row, _)| row != gap.row));
        self.loosen(z, a);
        self.loose.extend(loose);
        self.settle(point, &still);
    }

    /// The rates jump by `z` and `a`: those of gaps that have just opened too.
    pub(super) fn loosen(&mut self, z: Plane, a: Plane) {
        for gap in &mut self.loose {
            gap.rate += self.parameters.along(gap.row, z, a);
        }
    }

    /// Enters the impacts of rows that closed faster than `soft` \[m/s\].
    fn tell_impacts(&mut self, met: &[(usize, f64)], impulses: &[f64], soft: f64) {
        let t = self.clock.start();
        let mut touched = ActiveSet::Nothing;
        for (&(row, rate), &impulse) in met.iter().zip(impulses) {
            let Some(row) = self.parameters.rows.get(row).filter(|_| impulse > 0.0) else {
                continue;
            };
            touched = touched.with(row.side);
            if rate < -soft {
                self.log.impact(t, row.side);
            }
        }
        if touched != ActiveSet::Nothing {
            self.log.touch(t, touched);
        }
    }

    /// These gaps are closed and at rest: which of them hold?
    pub(super) fn settle(&mut self, point: &mut Point, still: &[usize]) {
        let force = self.force();
        let parameters = &self.parameters;
        let (z, a) = parameters.free(point, force);
        let noise = ROUND_OFF * parameters.size_of_free(point, force);
        let openings: Vec<f64> = still
            .iter()
            .map(|&row| {
                let opening = parameters.along(row, z, a);
                if opening.abs() <= noise { 0.0 } else { opening }
            })
            .collect();
        let joint = |row: usize, by: usize| match (still.get(row), still.get(by)) {
            (Some(&row), Some(&by)) => parameters.joint(row, by),
            _ => 0.0,
        };
        let Some(found) = pushes(joint, &openings, noise) else {
            self.fail_at(point, FailureReason::Singular { rows: still.len() });
            return;
        };
        let (z, a) = parameters.pushed(still.iter().copied().zip(found.iter().copied()));
        let mut rows = Vec::new();
        for ((&row, &push), &opening) in still.iter().zip(&found).zip(&openings) {
            if push > 0.0 || opening + parameters.along(row, z, a) <= noise {
                rows.push(row);
            } else {
                self.loose.push(Loose { row, gap: 0.0, rate: 0.0, released: false });
            }
        }
        let count = rows.len();
        let Some(held) = Held::new(parameters, rows) else {
            self.fail_at(point, FailureReason::Singular { rows: count });
            return;
        };
        self.hold(held);
        self.enter(*point);
    }

    /// From now on these rows are held.
    pub(super) fn hold(&mut self, held: Held) {
        if held.rows != self.held.rows {
            self.rest = std::sync::OnceLock::new();
        }
        let t = self.clock.start();
        let sides = held.rows.iter().filter_map(|&row| self.parameters.rows.get(row));
        let active_set = sides.fold(ActiveSet::Nothing, |set, row| set.with(row.side));
        let before = self.log.active_set;
        if before != ActiveSet::Nothing && before != active_set {
            // The old contact lasted until now.
            self.log.touch(t, before);
        }
        self.log.touch(t, active_set);
        if active_set == ActiveSet::Many && held.rows != self.held.rows {
            // Other sides, though as many.
            self.log.since = t;
        }
        self.held = held;
    }
}
