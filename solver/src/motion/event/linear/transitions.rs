//! Transitions between stretches: advancing the start, changes from outside, and gaps that close or
//! open.
//!
//! At an impact the impulses `p` satisfy `W p + (1 + e) g' >= 0` for closing gaps and
//! `W p + g' >= 0` for the others, complementary to `p >= 0` (Newton's law of restitution). Among
//! gaps that are closed and at rest the accelerations decide in the same way. A row whose contact
//! force has vanished opens and is not tested again.

use std::f64::consts::TAU;

use super::LinearEvents;
use super::parameters::size;
use super::stretch::{Ending, Held, OpenedGap, Stretch, seek};
use crate::motion::point::Point;
use crate::motion::{ActiveSet, FailureReason, Plane};
use crate::numeric::elimination::inverse;
use crate::tolerances::{
    AN_INSTANT, AS_ZERO, AT_A_CORNER, JUST_OPENED, MOST_HELD, MOST_TOUCHING, ROUND_OFF, ROUNDINGS,
    SOFT_TOUCH,
};

impl LinearEvents {
    /// Returns the time from the start of the stretch to `t` \[s\].
    pub(super) fn elapsed(&self, t: f64) -> f64 {
        self.run.clock.elapsed(t)
    }

    /// Ends the motion `s` seconds into the stretch.
    pub(super) fn fail(&mut self, s: f64, reason: FailureReason) {
        self.run.fail(s, reason);
        self.next = (f64::INFINITY, Ending::StretchEnd);
    }

    /// Returns whether the pulse acts from the start of the stretch on for more than an instant.
    fn pulses(&self) -> bool {
        self.run.pulse.at(self.run.clock.start()) != 0.0
            && self.elapsed(self.run.pulse.end) * self.parameters.rates() > AN_INSTANT
    }

    /// Returns the pulse force per unit casing mass at the start of the stretch, in the blade frame
    /// \[m/s^2\].
    pub(super) fn force(&self) -> Plane {
        if self.pulses() {
            Plane::cis(-self.phase) * (self.run.pulse.force / self.parameters.machine.casing_mass)
        } else {
            Plane::default()
        }
    }

    /// Ends the motion at this point, at the start of the next stretch.
    pub(super) fn fail_at(&mut self, point: &Point, reason: FailureReason) {
        self.held = Held::default();
        self.stretch = Stretch::to_the_end(*point);
        self.fail(0.0, reason);
    }

    /// Starts the next stretch from this point with the present rows in contact.
    pub(super) fn enter(&mut self, point: Point) {
        if self.run.failure.is_some() {
            return;
        }
        let pulses = self.pulses();
        let parameters = &self.parameters;
        let point = self.held.closed(parameters, &point);
        let gaps = self.held.rows.is_empty() && !pulses;
        if gaps && parameters.swing(&point) < parameters.least_clearance() * (1.0 - AS_ZERO) {
            self.stretch = Stretch::to_the_end(point);
            self.opened.clear();
            self.next = (f64::INFINITY, Ending::StretchEnd);
            return;
        }
        let most = if pulses { self.elapsed(self.run.pulse.end) } else { f64::INFINITY };
        let force = self.force();
        self.stretch.begin(&self.parameters, &self.held, point, force, most);
        if self.stretch.lost {
            self.fail(0.0, FailureReason::Series);
            return;
        }
        let still = ROUNDINGS * self.parameters.clearance();
        let tips = self.parameters.machine.blade_length * self.stretch.swing;
        let rests = !pulses && self.opened.is_empty();
        if rests && self.stretch.travel[0] <= still && tips <= still && self.held_for_good(0.0) {
            self.stretch.come_to_rest();
            self.next = (f64::INFINITY, Ending::StretchEnd);
            return;
        }
        self.next = seek(&self.parameters, &self.stretch, &self.held, &self.opened);
    }

    /// Processes the event that ends the stretch.
    pub(super) fn pass(&mut self) {
        let (s, what) = self.next;
        self.run.looks += 1;
        let phase = s * self.parameters.rates();
        if let Some(reason) = self.run.count(phase, what != Ending::StretchEnd) {
            return self.fail(s, reason);
        }
        let pulsed = self.pulses();
        let Some(mut point) = self.rebase(s) else { return };
        if what == Ending::StretchEnd && pulsed && !self.pulses() {
            // The contact forces jump together with the pulse.
            let rows = self.held.rows.clone();
            self.settle(&mut point, &rows);
        } else {
            self.follow(&mut point, what);
        }
    }

    /// Starts the motion after an event.
    fn follow(&mut self, point: &mut Point, what: Ending) {
        match what {
            Ending::StretchEnd => self.enter(*point),
            Ending::Touch(row, rate) => {
                let mut met = self.touching(point, row);
                met.push((row, rate));
                self.meet(point, &met);
            }
            Ending::Release(row) => {
                let still: Vec<usize> =
                    self.held.rows.iter().copied().filter(|&held| held != row).collect();
                self.opened.push(OpenedGap { row, gap: 0.0, rate: 0.0, released: true });
                self.settle(point, &still);
            }
        }
    }

    /// Returns the rows that touch besides one that has just closed, with the rates of their gaps.
    /// A closing gap within round-off is included: two rows that each open the other would
    /// otherwise impact in turn without end.
    fn touching(&self, point: &Point, hit: usize) -> Vec<(usize, f64)> {
        let parameters = &self.parameters;
        let size = parameters.clearance() + size(point.z) + parameters.arm().abs() * size(point.a);
        let limit = AT_A_CORNER * parameters.tolerance * size;
        let rate_if_near = |row: usize| {
            if row == hit {
                return None;
            }
            if self.held.rows.contains(&row) {
                return Some((row, 0.0));
            }
            if let Some(gap) = self.opened.iter().find(|gap| gap.row == row) {
                return (gap.gap <= limit && gap.rate <= 0.0).then_some((row, gap.rate));
            }
            let near = parameters.gap(row, point) <= limit;
            near.then(|| (row, parameters.along(row, point.dz, point.da)))
        };
        (0..parameters.rows.len()).filter_map(rate_if_near).collect()
    }

    /// Records the stretch up to `s`, moves the start of the next one there, and returns the point.
    /// `None` if the motion has left the range of the model; it then stays in the present stretch,
    /// so that everything reported refers to the same instant.
    fn rebase(&mut self, s: f64) -> Option<Point> {
        let point = self.stretch.point(&self.parameters, s);
        self.check_growth(s, &point);
        if self.run.failure.is_some() {
            return None;
        }
        let parameters = &self.parameters;
        if self.run.checked {
            self.energies.book(parameters, &self.held, &self.stretch, s);
            self.run.widest = self.widest_until(s);
            let [travel, reach] = self.stretch.travel;
            if reach + travel >= parameters.least_clearance() {
                let known = |row: usize| self.opened.iter().any(|gap| gap.row == row);
                let gaps = (0..parameters.rows.len()).filter(|&row| !known(row));
                let least = gaps.map(|row| parameters.gap(row, &point)).fold(0.0, f64::min);
                self.run.deepest = self.run.deepest.max(-least);
            }
        }
        let limit = JUST_OPENED * parameters.clearance();
        let later = self.opened.iter().map(|gap| gap.later(parameters, &self.stretch, s));
        self.opened = later.filter(|gap| gap.gap < limit).collect();
        self.phase = (self.phase + parameters.nu * s) % TAU;
        if self.pulses() && s >= self.elapsed(self.run.pulse.end) {
            self.run.clock.begin_at(self.run.pulse.end);
        } else {
            self.run.clock.pass(s);
        }
        self.swings.see(self.run.clock.start(), size(point.a));
        Some(point)
    }

    /// Returns the largest blade angle up to `s` seconds into the stretch \[rad\].
    pub(super) fn widest_until(&self, s: f64) -> f64 {
        if self.parameters.blades.is_none() {
            return 0.0;
        }
        // The largest amplitude of free blades occurs within their first period.
        let s = s.min(TAU / self.parameters.machine.omega_bd);
        let parts = if self.stretch.free { 64 } else { 4 };
        (0..=parts).fold(self.run.widest, |widest, part| {
            let point =
                self.stretch.point(&self.parameters, s * f64::from(part) / f64::from(parts));
            if point.a.norm() <= widest {
                widest
            } else {
                widest.max(self.parameters.largest_angle(point.a))
            }
        })
    }

    /// Returns whether the same rows stay in contact for ever from `s` seconds into the stretch on.
    pub(super) fn held_for_good(&self, s: f64) -> bool {
        if self.pulses() || self.held.rows.len() < 2 || !self.opened.is_empty() {
            return false;
        }
        let rest = self.rest.get_or_init(|| super::Rest::of(&self.parameters, &self.held));
        let point = self.stretch.point(&self.parameters, s);
        rest.as_ref().is_some_and(|rest| rest.for_good(&self.parameters, &point))
    }

    /// Changes rotor, pulse or rate at the present instant. The casing keeps its position, and its
    /// velocity in the stationary frame except for `change`.
    pub(super) fn intervene(&mut self, change: impl FnOnce(&mut Self, &mut Point)) {
        if self.run.failure.is_some() {
            return;
        }
        let s = self.elapsed(self.run.clock.now);
        let Some(mut point) = self.rebase(s) else { return };
        self.run.clock.begin_at(self.run.clock.now);
        let (before, energy) = (self.parameters.nu, self.parameters.energy(&point));
        let clearance = self.parameters.clearance();
        let rate = point.dz;
        change(self, &mut point);
        let jump = before - self.parameters.nu;
        point.dz += Plane::i() * point.z * jump;
        self.energies.start += self.parameters.energy(&point) - energy;
        self.shift_opened(point.dz - rate, Plane::default());
        if self.parameters.clearance() != clearance {
            // A different clearance can open or close any gap.
            self.held = Held::default();
            self.opened.clear();
            self.rest = std::sync::OnceLock::new();
            self.begin(point);
            return;
        }
        if jump == 0.0 {
            let rows = std::mem::take(&mut self.held).rows;
            self.settle(&mut point, &rows);
            return;
        }
        // A sudden change of speed acts on closed gaps like an impact.
        self.rest = std::sync::OnceLock::new();
        let parameters = &self.parameters;
        let met: Vec<(usize, f64)> = std::mem::take(&mut self.held)
            .rows
            .into_iter()
            .map(|row| (row, parameters.along(row, point.dz, point.da)))
            .collect();
        self.meet(&mut point, &met);
    }
}

impl LinearEvents {
    /// Changes the machine to another speed. The change of blade stiffness at the present angles is
    /// work of the rotor. If a smaller clearance would leave tips inside the casing, all
    /// displacements are reduced by a common factor, which is work of the growing blades.
    pub(super) fn change_speed(&mut self, speed: f64, point: &mut Point) {
        let parameters = &mut self.parameters;
        // The energies refer to the present frame; the casing rate is converted to the new frame
        // afterwards.
        let before = parameters.energy(point);
        let turned = parameters.nu;
        parameters.machine.turn_at(speed);
        parameters.stiffen();
        let stiffened = parameters.energy(point);
        let part = (0..parameters.rows.len())
            .map(|row| (parameters.gap(row, point), parameters.apothem(row)))
            .filter(|(open, apothem)| *open < 0.0 && *apothem > 0.0)
            .fold(1.0, |part: f64, (open, apothem)| part.min(apothem / (apothem - open)));
        if part < 1.0 {
            point.dz += Plane::i() * point.z * ((1.0 - part) * turned);
            (point.z, point.a) = (point.z * part, point.a * part);
        }
        let after = parameters.energy(point);
        self.energies.rotor += stiffened - before;
        self.energies.growth += after - stiffened;
        self.energies.start -= after - before;
        parameters.turn_at(speed);
    }

    /// Applies the impact of rows that touch, each with the rate of its gap \[m/s\].
    pub(super) fn meet(&mut self, point: &mut Point, met: &[(usize, f64)]) {
        let parameters = &self.parameters;
        let arm = parameters.arm().abs();
        // Slower rates count as rest; they are round-off of terms that cancel.
        let soft = SOFT_TOUCH * parameters.machine.omega_c * parameters.clearance()
            + ROUND_OFF * (size(point.dz) + arm * size(point.da));
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
        let (mut still, mut opened) = (Vec::new(), Vec::new());
        for (&(row, rate), &impulse) in met.iter().zip(&impulses) {
            let after =
                if impulse > 0.0 { rebound(rate) } else { rate + parameters.along(row, z, a) };
            if after > soft {
                opened.push(OpenedGap { row, gap: 0.0, rate: after, released: false });
            } else {
                still.push(row);
            }
            self.energies.impacts -= 0.5 * impulse * (rate + after);
        }
        let mean =
            Point { dz: (before.dz + point.dz) * 0.5, da: (before.da + point.da) * 0.5, ..before };
        self.energies.push(parameters, &mean, struck());
        self.log_impacts(met, &impulses, soft);
        self.opened.retain(|gap| met.iter().all(|&(row, _)| row != gap.row));
        self.shift_opened(z, a);
        self.opened.extend(opened);
        self.settle(point, &still);
    }

    /// Adds a jump of the rates `z` and `a` to the gaps that have just opened.
    pub(super) fn shift_opened(&mut self, z: Plane, a: Plane) {
        for gap in &mut self.opened {
            gap.rate += self.parameters.along(gap.row, z, a);
        }
    }

    /// Records the impacts of rows that closed faster than `soft` \[m/s\].
    fn log_impacts(&mut self, met: &[(usize, f64)], impulses: &[f64], soft: f64) {
        let t = self.run.clock.start();
        let mut touched = ActiveSet::Nothing;
        for (&(row, rate), &impulse) in met.iter().zip(impulses) {
            if impulse > 0.0 {
                touched = touched.with(row as u32);
                if rate < -soft {
                    self.run.log.impact(t, row as u32);
                }
            }
        }
        if touched != ActiveSet::Nothing {
            self.run.log.touch(t, touched);
        }
    }

    /// Determines which of these gaps, closed and at rest, stay in contact.
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
                self.opened.push(OpenedGap { row, gap: 0.0, rate: 0.0, released: false });
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

    /// Sets the rows in contact.
    pub(super) fn hold(&mut self, held: Held) {
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

/// Finds `p >= 0` with `W p + opening >= 0` and `p (W p + opening) = 0`, where magnitudes up to
/// `noise` count as zero; `None` if there is no solution, or too many rows. All subsets are tried
/// instead of `contact::Several`, because with friction pivoting may cycle.
pub(super) fn pushes(
    joint: impl Fn(usize, usize) -> f64,
    opening: &[f64],
    noise: f64,
) -> Option<Touching> {
    let n = opening.len();
    if n > MOST_TOUCHING {
        return None;
    }
    let mut matrix = [[0.0; MOST_TOUCHING]; MOST_TOUCHING];
    for (row, line) in matrix.iter_mut().enumerate().take(n) {
        for (by, entry) in line.iter_mut().enumerate().take(n) {
            *entry = joint(row, by);
        }
    }
    (0..=n.min(MOST_HELD)).rev().find_map(|size| {
        (0_u32..1 << n)
            .filter(|choice| choice.count_ones() as usize == size)
            .find_map(|choice| try_choice(&matrix, opening, noise, choice))
    })
}

/// One number for each row that touches.
type Touching = [f64; MOST_TOUCHING];

/// Returns the contact forces for one subset of rows, if they satisfy all conditions.
fn try_choice(
    matrix: &[Touching; MOST_TOUCHING],
    opening: &[f64],
    noise: f64,
    choice: u32,
) -> Option<Touching> {
    let is_chosen = |row: usize| (choice >> row) & 1 == 1;
    let chosen = || (0..opening.len()).filter(|&row| is_chosen(row)).take(MOST_HELD);
    let mut square = [[0.0; MOST_HELD]; MOST_HELD];
    let mut right = [0.0; MOST_HELD];
    for (k, row) in chosen().enumerate() {
        right[k] = -opening[row];
        for (l, by) in chosen().enumerate() {
            square[k][l] = matrix[row][by];
        }
    }
    let inverse = inverse(&square, chosen().count())?;
    let mut pushes = [0.0; MOST_TOUCHING];
    for (row, line) in chosen().zip(&inverse) {
        let push: f64 = line.iter().zip(&right).map(|(a, b)| a * b).sum();
        let least: f64 = line.iter().map(|entry| entry.abs()).sum();
        if push.is_nan() || push < -noise * least {
            return None;
        }
        pushes[row] = push.max(0.0);
    }
    let open = |row: usize| {
        let lifted: f64 = matrix[row].iter().zip(&pushes).map(|(a, b)| a * b).sum();
        is_chosen(row) || opening[row] + lifted >= -noise
    };
    (0..opening.len()).all(open).then_some(pushes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Solver;
    use crate::scene::Scene;

    #[test]
    fn two_rows_by_cases() {
        let matrix = [[1.0, 0.9], [0.7, 1.2]];
        let joint = |row: usize, by: usize| matrix[row][by];
        for opening in [[-1.0, -1.0], [-1.0, 0.5], [0.5, -1.0], [1.0, 1.0], [-1.0, 0.0]] {
            let found = pushes(joint, &opening, 1e-14).unwrap();
            for row in 0..2 {
                let rate = opening[row] + matrix[row][0] * found[0] + matrix[row][1] * found[1];
                assert!(found[row] >= 0.0 && rate > -1e-14 && (rate * found[row]).abs() < 1e-13);
            }
        }
        assert_eq!(pushes(joint, &[1.0, 1.0], 1e-14).unwrap()[..2], [0.0, 0.0]);
        assert_eq!(pushes(joint, &[-1.0, 1.0], 1e-14).unwrap()[..2], [1.0, 0.0]);
    }

    #[test]
    fn of_gaps_that_have_just_opened_only_those_that_close_again_touch() {
        let mut motion = LinearEvents::new(&Scene::base().checked().unwrap());
        let opened = |row, rate| OpenedGap { row, gap: 0.0, rate, released: false };
        motion.opened = vec![opened(1, 1e-3), opened(2, -1e-3), opened(3, 0.0)];
        let met = motion.touching(motion.stretch.from(), 0);
        assert_eq!(met, [(2, -1e-3), (3, 0.0)]);
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
        let turns: [fn(&mut LinearEvents); 4] = [
            |_| (),
            |motion| motion.set_speed(460.0, 0.0),
            |motion| motion.scale_rate(1.01),
            |motion| motion.fire(),
        ];
        let mut looked = 0;
        for pulse in ["2e4", "5e4", "1e5", "2e5"] {
            let scene = Scene::base().with(&[&keys[..], &[("operation.pulse_n", pulse)]].concat());
            let start = LinearEvents::new(&scene.unwrap());
            let mut whole = start.clone();
            whole.advance(6e-3).unwrap();
            let hits = whole.contacts().impacts.iter().take(12).map(|hit| hit.t_s);
            for (t, turn) in hits.flat_map(|t| turns.map(|turn| (t, turn))) {
                let mut motion = start.clone();
                motion.advance(t + 1e-10).unwrap();
                turn(&mut motion);
                for part in 0..6 {
                    motion.advance(t + 1e-10 + 4e-6 * f64::from(part)).unwrap();
                    let (parameters, point) = (&motion.parameters, motion.stretch.from());
                    let size = point.dz.norm() + parameters.arm().abs() * point.da.norm();
                    for gap in &motion.opened {
                        let rate = parameters.along(gap.row, point.dz, point.da);
                        assert!(
                            (gap.rate - rate).abs() < 1e-9 * size,
                            "{t} {part}: {gap:?} {rate}"
                        );
                        assert!(gap.gap < JUST_OPENED * parameters.clearance(), "{t}: {gap:?}");
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

    #[test]
    fn equal_rows_share_a_push_somehow_and_no_push_is_made_up() {
        let found = pushes(|_, _| 2.0, &[-1.0, -1.0, -1.0], 1e-14).unwrap();
        assert!((found.iter().sum::<f64>() - 0.5).abs() < 1e-15);
        assert_eq!(pushes(|_, _| -1.0, &[-1.0], 1e-14), None);
        assert_eq!(pushes(|_, _| 1.0, &[-1.0; MOST_TOUCHING + 1], 1e-14), None);
    }
}
