//! Impacts, and which of the gaps that are closed and at rest stay in contact.
//!
//! At an impact the impulses `p` satisfy `W p + (1 + e) g' >= 0` for closing gaps and
//! `W p + g' >= 0` for the others, complementary to `p >= 0` (Newton's law of restitution). Among
//! gaps that are closed and at rest the accelerations decide in the same way. A row whose contact
//! force has vanished opens and is not tested again.

use super::Events;
use super::flow::{Face, pushed};
use super::seek::OpenedGap;
use super::stretch::{Held, MOST_HELD};
use crate::motion::point::Point;
use crate::motion::{ActiveSet, FailureReason, size};
use crate::numeric::lcp::complementary_of_two;
use crate::numeric::rounding::ROUND_OFF;

/// A closing rate below this part of `omega_c g0` is a touch and not an impact: round-off of the
/// rates of rows that stay in contact.
const SOFT_TOUCH: f64 = 1e-12;

/// A touch within this many tolerances of a corner finds the gaps of both its sides closed. Smaller:
/// sides of which each opens the other impact in turn without end.
const AT_A_CORNER: f64 = 16.0;

/// Largest number of rows in one impact, or in one contact problem at rest.
const MOST_TOUCHING: usize = 12;

/// A row that touches: one of several at one instant.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch {
    /// Index of the row.
    pub row: usize,
    pub face: Face,
    /// Rate of its gap \[m/s\], or its acceleration without contact forces \[m/s^2\].
    pub opening: f64,
    /// Impulse or contact force per unit casing mass.
    push: f64,
}

impl Events {
    /// Returns a row that touches at this point.
    pub(super) fn touch(&self, point: &Point, row: usize, opening: f64) -> Touch {
        Touch { row, face: self.flow.face(row, point), opening, push: 0.0 }
    }

    /// Returns rows whose gaps are closed at this point.
    pub(super) fn closed(&self, point: &Point, rows: &[usize]) -> Vec<Touch> {
        rows.iter().map(|&row| self.touch(point, row, 0.0)).collect()
    }

    /// Returns the rows that touch together with one that has just closed with the rate `closing`. A
    /// gap within round-off of closing that the other impact does not open is included. If it does
    /// open the gap, the two impacts follow each other, as they do next to such an instant.
    pub(super) fn touching(&self, point: &Point, hit: usize, closing: f64) -> Vec<Touch> {
        let flow = &self.flow;
        let reach = flow.arm().abs() + flow.diameters() * size(point.z);
        let limit = AT_A_CORNER
            * flow.tolerance
            * (flow.clearance() + size(point.z) + reach * size(point.a));
        let first = self.touch(point, hit, closing);
        let mut met = Vec::with_capacity(MOST_HELD);
        met.push(first);
        met.extend(self.held.rows.iter().map(|&row| self.touch(point, row, 0.0)));
        let known = |row| self.opened.iter().any(|gap| gap.row == row);
        let near = flow.near(point, limit, Some(hit)).filter(|&row| !known(row));
        let opened = self.opened.iter().map(|gap| (gap.row, Some(gap)));
        for (row, opened) in near.map(|row| (row, None)).chain(opened) {
            if row == hit || self.held.rows.contains(&row) {
                continue;
            }
            let mut touch = self.touch(point, row, 0.0);
            let (gap, rate) = match opened {
                Some(opened) => (opened.gap, opened.rate),
                None => {
                    (flow.gap_at(row, &touch.face, point), touch.face.along(point.dz, point.da))
                }
            };
            let apart = gap > limit || (opened.is_some() && rate > 0.0);
            let opens = rate < 0.0 && touch.face.joint(&first.face) > 0.0;
            if !apart && !opens {
                touch.opening = rate;
                met.push(touch);
            }
        }
        met
    }

    /// Finds the impulses or contact forces that solve the complementarity problem of these rows;
    /// `None` if there is no solution, or too many rows.
    fn complementary(&mut self, met: &mut [Touch]) -> Option<()> {
        if met.len() > MOST_TOUCHING {
            return None;
        }
        // Multipliers below zero push.
        if let [touch] = met {
            let push = -touch.opening / touch.face.joint(&touch.face);
            touch.push = if touch.opening < 0.0 { push } else { 0.0 };
            return (0.0..f64::INFINITY).contains(&touch.push).then_some(());
        }
        if let [a, b] = met {
            let [across, back] = [a.face.joint(&b.face), b.face.joint(&a.face)];
            let joint = [[a.face.joint(&a.face), across], [back, b.face.joint(&b.face)]];
            if let Some(found) = complementary_of_two(joint, [a.opening, b.opening]) {
                [a.push, b.push] = found.map(|multiplier| -multiplier);
                return Some(());
            }
        }
        let joint = |row: usize, by: usize| met[row].face.joint(&met[by].face);
        self.problem.fill(met.iter().map(|touch| touch.opening), joint);
        let found = self.problem.complementary(true)?;
        met.iter_mut().zip(found).for_each(|(touch, multiplier)| touch.push = -multiplier);
        Some(())
    }

    /// Applies the impact of rows that touch.
    pub(super) fn meet(&mut self, point: &mut Point, mut met: Vec<Touch>) {
        let flow = &self.flow;
        let lift = flow.arm().abs() + flow.diameters() * size(point.z);
        // Slower rates count as rest; they are round-off of terms that cancel.
        let soft = SOFT_TOUCH * flow.machine.omega_c * flow.clearance()
            + ROUND_OFF * (size(point.dz) + lift * size(point.da));
        let restitution = flow.restitution;
        let rebound = |rate: f64| {
            let back = -restitution * rate;
            if back > soft { back } else { 0.0 }
        };
        let rates: [f64; MOST_TOUCHING] =
            std::array::from_fn(|k| met.get(k).map_or(0.0, |touch| touch.opening));
        met.iter_mut().for_each(|touch| touch.opening -= rebound(touch.opening));
        if self.complementary(&mut met).is_none() {
            self.fail_at(point, FailureReason::Singular { rows: met.len() });
            return;
        }
        let flow = &self.flow;
        let (z, a) = pushed(met.iter().map(|touch| (&touch.face, touch.push)));
        let before = *point;
        (point.dz, point.da) = (point.dz + z, point.da + a);
        let mut hits = met.iter().zip(rates).take(1);
        let ends = hits.any(|(touch, rate)| {
            let bounced = self.opened.iter().any(|gap| gap.struck && gap.row == touch.row);
            bounced && rebound(rate) == 0.0 && (restitution > 0.0 || rate >= -soft)
        });
        let t = self.run.clock.start();
        if ends {
            // The impacts of a series have become slower than round-off of rest.
            self.run.log.accumulate(t);
        }
        self.opened.retain(|gap| met.iter().all(|touch| touch.row != gap.row));
        for gap in &mut self.opened {
            gap.rate += flow.face(gap.row, point).along(z, a);
        }
        let mean =
            Point { dz: (before.dz + point.dz) * 0.5, da: (before.da + point.da) * 0.5, ..before };
        let directed = met.iter().map(|touch| ((touch.face.base, touch.face.normal), touch.push));
        self.ledger.sums.push(flow, &mean, 0.0, directed);
        let known = self.opened.len();
        let (mut rates, mut touched) = (rates.into_iter(), ActiveSet::Nothing);
        met.retain(|&Touch { row, face, push, .. }| {
            let rate = rates.next().unwrap_or(0.0);
            let after = if push > 0.0 { rebound(rate) } else { rate + face.along(z, a) };
            let opens = after > soft;
            if opens {
                let rate = after;
                self.opened.push(OpenedGap { row, gap: 0.0, rate, released: false, struck: true });
            }
            let lost = 0.5 * flow.machine.casing_mass * push * (rate + after);
            self.ledger.sums.impact_loss_j -= lost;
            if push > 0.0 {
                touched = touched.with(row as u32);
                if rate < -soft {
                    self.run.log.impact(t, row as u32);
                }
            }
            !opens
        });
        if touched != ActiveSet::Nothing {
            self.run.log.touch(t, touched);
        }
        if let ([held], [opened]) = (&met[..], &self.opened[known..])
            && let Some(time) = self.rocking(point, held.row, opened)
        {
            let rows = [held.row, opened.row];
            self.rock(point, rows, time);
            return;
        }
        self.settle(point, met);
    }

    /// Determines which of these gaps, closed and at rest, stay in contact.
    pub(super) fn settle(&mut self, point: &mut Point, mut met: Vec<Touch>) {
        let force = self.force();
        let flow = &self.flow;
        let free = flow.free(point, force);
        let noise = ROUND_OFF * flow.size_of_free(point, force);
        for touch in &mut met {
            let opening = flow.gap_bend(&touch.face, point, free);
            touch.opening = if opening.abs() <= noise { 0.0 } else { opening };
        }
        if self.complementary(&mut met).is_none() {
            self.fail_at(point, FailureReason::Singular { rows: met.len() });
            return;
        }
        let (z, a) = pushed(met.iter().map(|touch| (&touch.face, touch.push)));
        met.retain(|&Touch { row, face, opening, push }| {
            let stays = push > 0.0 || opening + face.along(z, a) <= noise;
            if !stays {
                let (gap, rate) = (0.0, 0.0);
                self.opened.push(OpenedGap { row, gap, rate, released: false, struck: false });
            }
            stays
        });
        let Some(held) = Held::new(met.iter().map(|touch| (touch.row, touch.face))) else {
            self.fail_at(point, FailureReason::Singular { rows: met.len() });
            return;
        };
        self.hold(held);
        self.enter(*point);
    }

    /// Sets the rows in contact.
    fn hold(&mut self, held: Held) {
        if held.rows != self.held.rows {
            self.rest = std::sync::OnceLock::new();
        }
        let t = self.run.clock.start();
        let sides = held.rows.iter().map(|&row| row as u32);
        let active_set = sides.fold(ActiveSet::Nothing, ActiveSet::with);
        self.run.hold(active_set);
        if active_set == ActiveSet::Many && held.rows != self.held.rows {
            // Other sides, although again three or more.
            self.run.log.since = t;
        }
        self.held = held;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Solver;
    use crate::scene::Scene;

    #[test]
    fn of_gaps_that_have_just_opened_only_those_at_rest_touch_if_another_closes() {
        let mut motion = Events::of(&Scene::base().checked().unwrap());
        let mut point = motion.stretch.from;
        // On side 1, whose impact opens the gaps next to it.
        point.z = -motion.flow.rows[1] * motion.flow.clearance();
        let opened = |row, rate| OpenedGap { row, gap: 0.0, rate, released: false, struck: false };
        motion.opened = vec![opened(0, 1e-3), opened(2, 0.0)];
        let met = motion.touching(&point, 1, -1.0);
        let rows: Vec<(usize, f64)> = met.iter().map(|touch| (touch.row, touch.opening)).collect();
        assert_eq!(rows, [(1, -1.0), (2, 0.0)]);
    }

    /// A gap that has just opened is stored separately, but must agree with the motion.
    #[test]
    fn an_opened_gap_is_small_and_moves_as_the_motion_whatever_changes_on_the_way() {
        let keys = [
            ("solver.kind", "event"),
            ("bladed_disk.radial_coupling", "0.2"),
            ("contact.friction", "0.1"),
            ("contact.restitution", "0.6"),
        ];
        let turns: [fn(&mut Events); 4] = [
            |_| (),
            |motion| motion.set_speed(460.0, 0.0),
            |motion| motion.scale_rate(1.01),
            |motion| motion.fire(),
        ];
        let mut looked = 0;
        for pulse in ["2e4", "5e4", "1e5", "2e5"] {
            let scene = Scene::base().with(&[&keys[..], &[("operation.pulse_n", pulse)]].concat());
            let start = Events::of(&scene.unwrap());
            let mut whole = start.clone();
            whole.advance(6e-3).unwrap();
            let hits = whole.contacts().impacts.iter().take(12).map(|hit| hit.t_s);
            for (t, turn) in hits.flat_map(|t| turns.map(|turn| (t, turn))) {
                let mut motion = start.clone();
                motion.advance(t + 1e-10).unwrap();
                turn(&mut motion);
                for part in 0..6 {
                    motion.advance(t + 1e-10 + 4e-6 * f64::from(part)).unwrap();
                    let (flow, point) = (&motion.flow, &motion.stretch.from);
                    let size = point.dz.norm() + flow.arm().abs() * point.da.norm();
                    for gap in &motion.opened {
                        let rate = flow.gap_rate(gap.row, point);
                        assert!(
                            (gap.rate - rate).abs() < 1e-9 * size,
                            "{t} {part}: {gap:?} {rate}"
                        );
                        assert!(gap.gap < 1e-6 * flow.clearance(), "{t}: {gap:?}");
                        looked += 1;
                    }
                    let mut rows: Vec<usize> = motion.opened.iter().map(|gap| gap.row).collect();
                    rows.extend(&motion.held.rows);
                    rows.sort_unstable();
                    assert!(rows.windows(2).all(|pair| pair[0] != pair[1]), "{t}: {rows:?}");
                }
            }
        }
        assert!(looked > 100, "{looked}");
    }
}
