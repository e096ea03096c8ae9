//! A lock held by both laws alike: step after step the same corner closes.
//! (docs/theory.md, section 6.)
//!
//! In the frame of the blades the casing then follows from the blade angles
//! alone (two gaps are zero), and at constant speed one step maps the blade
//! modes `b = (alpha_c, alpha_s, increments)` to themselves. The map is affine to the
//! square of the blade phase that is left of their vibration, so any number of steps is
//! one small matrix power about the modes at rest; of a larger vibration its square and
//! cube are taken along (`unfolded`). The step
//! is worked out with its small parts apart (`CornerStep`), so that it carries
//! no round-off of the gaps; the map is used only while both multipliers and
//! both predicted gaps keep their signs with room to spare, and where every step leaves the
//! same gaps: a push turns the sides of its blades, by next to nothing in a short step, and
//! the corner that is held then has the gaps that steps leave at rest (`rest_in`).
//!
//! Beyond the paper tips may rise and rub, and the flows of energy go on: their sums over
//! many steps are closed, too.

use std::sync::Arc;

use nalgebra::SMatrix;

use super::corner_step::{CornerStep, Modes, Stepped};
use super::unfolded::{Deviations, Unfolded, unfold};
use crate::motion::ActiveSet;
use crate::motion::explicit::disk::{Disk, HeldModes};
use crate::motion::explicit::oscillator::{LARGEST, Leap};
use crate::motion::explicit::{Coordinate, Explicit};
use crate::tolerances::{
    ANGLE_LOOK, CERTAIN_PUSH, HELD_AFTER, HELD_AGAIN, HELD_CORRECTIONS, HELD_PROBE, MOST_GROWTH,
    ROOM_TO_CHANGE, SMALL_TURNS,
};

type StepMap = SMatrix<f64, 4, 4>;

/// The map of a held corner, from one step on.
#[derive(Clone, Debug)]
pub(in crate::motion::explicit) struct HeldCorner {
    step: CornerStep,
    /// Whether a multiplier pulls.
    pub pulls: bool,
    /// Whether the signs of both multipliers are certain.
    pub is_certain: bool,
    /// Blade modes at rest, and multipliers there \[N\].
    rest: Modes,
    multipliers: [f64; 2],
    /// Blade modes from the start on, less those at rest.
    deviations: Arc<dyn Deviations>,
    /// Whether flows of energy are counted.
    counts: bool,
    /// Bounds on angle and increment of the deviation from rest.
    swing: (f64, f64),
    /// How far the map lets the energy of a deviation grow at most, as a size.
    growth: f64,
}

impl HeldCorner {
    /// Values of the two sides, each with its side.
    pub fn by_side(&self, [a, b]: [f64; 2]) -> [(u32, f64); 2] {
        let [first, second] = self.step.sides();
        [(first, a), (second, b)]
    }

    /// Returns the blade modes after `steps` steps.
    fn modes(&self, steps: u64) -> Modes {
        self.rest + self.deviations.after(steps)
    }

    /// Returns the multipliers of the step that led to `steps` steps from the start, each with its
    /// side \[N\].
    pub fn pushes_by_side(&self, steps: u64) -> [(u32, f64); 2] {
        // The step itself knows them to the last digit, at any vibration.
        let step = self.step.from(self.modes(steps.saturating_sub(1)));
        self.by_side(step.map_or(self.multipliers, |step| step.multipliers))
    }

    /// Returns the sums of the multipliers of the steps after `before`, up to `steps` \[N\].
    pub fn sums(&self, before: u64, steps: u64) -> [f64; 2] {
        let [a, b, ..] = self.deviations.sums(before, steps);
        [a, b]
    }

    /// Flows of energy of the steps after `before`, up to `steps`; see `CornerStep::flows`
    /// \[J\].
    pub fn flows(&self, before: u64, steps: u64) -> Option<[f64; 4]> {
        let sums = || self.deviations.sums(before, steps);
        self.counts.then(sums).map(|[_, _, flows @ ..]| flows)
    }

    /// Returns the deepest penetration that its steps leave \[m\].
    pub fn deepest(&self) -> f64 {
        self.step.open.iter().fold(0.0, |deepest, gap| deepest.max(-gap))
    }

    /// Returns the amplitude of the blade modes after `steps` steps \[rad\].
    pub fn amplitude(&self, steps: u64) -> f64 {
        let modes = self.modes(steps);
        modes[0].hypot(modes[1])
    }

    /// Returns whether the steps leave the gaps they begin with, but for next to nothing of those
    /// predicted, at rest and as far from it as the modes swing.
    fn closes(&self, at_rest: &Stepped) -> Option<bool> {
        let closed = |step: &Stepped| self.step.is_closed_by(step, at_rest.gaps);
        let mut all = closed(at_rest);
        all &= closed(&self.step.from(self.modes(0))?);
        let (angle, increment) = self.swing;
        for (j, swing) in [angle, angle, increment, increment].into_iter().enumerate() {
            for end in [-swing, swing] {
                let mut modes = self.rest;
                modes[j] += end;
                all &= closed(&self.step.from(modes)?);
            }
        }
        Some(all)
    }

    /// Returns the largest blade angle over the first `steps` steps, `least` where none
    /// is larger \[rad\].
    pub fn largest_angle(&self, steps: u64, least: f64) -> f64 {
        let Some(blades) = self.step.blades() else { return least };
        let angle = |k: u64| {
            let modes = self.modes(k);
            blades.largest([modes[0], modes[1]])
        };
        let stride = (ANGLE_LOOK / blades.oscillator().turn()).clamp(1.0, 1e12) as u64;
        let mut most = least.max(angle(0)).max(angle(steps));
        let (mut before, mut here, mut at) = (0.0, angle(0), 0);
        while at < steps {
            // The deviation from rest never grows beyond its bound now.
            let deviation = self.deviations.after(at);
            let bound = blades.oscillator().reach_of(as_coordinates(deviation)).0;
            if self.rest[0].hypot(self.rest[1]) + self.growth * bound <= most {
                break;
            }
            let after = angle((at + stride).min(steps));
            // Between looks an angle rises by the square of half a look, at most; the last
            // stretch has its top before a higher end.
            let rises = after > here;
            let turns = if rises { at + stride >= steps } else { here >= before };
            if turns && here.max(after) * (1.0 + ANGLE_LOOK * ANGLE_LOOK) > most {
                let from = if rises { at } else { at.saturating_sub(stride) };
                most = most.max(top([from, (at + stride).min(steps)], angle));
            }
            (before, here, at) = (here, after, at + stride);
        }
        most
    }
}

/// Returns the largest value between two steps of a function with one top.
fn top([mut low, mut high]: [u64; 2], value: impl Fn(u64) -> f64) -> f64 {
    while high > low + 2 {
        let third = (high - low) / 3;
        let [first, second] = [low + third, high - third];
        if value(first) < value(second) { low = first + 1 } else { high = second }
    }
    (low..=high).map(value).fold(0.0, f64::max)
}

impl<B: Disk> Explicit<B> {
    /// Makes the map, if a corner has been held long enough and the map can be
    /// trusted for all later steps.
    #[inline]
    pub(in crate::motion::explicit) fn hold_corner(&mut self) -> Option<Box<HeldCorner>> {
        if !self.scene.solver.shortcuts.lock || self.sides_move() {
            return None;
        }
        let sides = self.steady_corner_since(self.leaps.hold_tried)?;
        self.leaps.hold_tried = self.n + HELD_AGAIN;
        self.make_map(sides)
    }

    /// Returns the corner in contact in this step, if neither pulse nor ramp nor
    /// excitation acts on it.
    fn steady_corner(&self) -> Option<[u32; 2]> {
        let ActiveSet::Corner(a, b) = self.record.log.active_set else { return None };
        (self.drive.is_steady(self.n) && self.record.last_touch == self.n).then_some([a, b])
    }

    /// Returns the same, if it has lasted for `HELD_AFTER` steps, and as many since this one.
    #[inline]
    pub(super) fn steady_corner_since(&self, step: u64) -> Option<[u32; 2]> {
        let sides = self.steady_corner()?;
        let since = ((self.record.log.since / self.drive.step) as u64).max(step);
        (self.n >= since + HELD_AFTER).then_some(sides)
    }

    // Out of the steps: its stack is large.
    #[inline(never)]
    fn make_map(&self, sides: [u32; 2]) -> Option<Box<HeldCorner>> {
        let (machine, speed) = (&self.machine, self.drive.speed(self.n));
        let now = self.modes_of_sides()?;
        let turn = machine.nu(speed) * self.drive.step;
        let mut step = CornerStep::new(machine, self.tips, &self.casing, now.moving, sides, turn);
        let now = as_modes(now.modes);
        let resting = rest_in(&mut step, now)?;
        let start = now - resting.rest;
        let (mut swing, mut growth) = ((0.0, 0.0), 1.0);
        if let Some(blades) = step.blades() {
            let oscillator = blades.oscillator();
            growth = growth_of(&Leap::new(resting.change), oscillator.turn())?;
            let (angle, increment) = oscillator.reach_of(as_coordinates(start));
            swing = (growth * angle, growth * increment);
        }
        let phase = machine.nodal_diameters * swing.0;
        if phase > SMALL_TURNS[2] || !self.is_kept(&step, &resting, swing) {
            return None;
        }
        // Where steps leave gaps, the deepest prediction has been seen.
        let deepest = (2..4).map(|k| resting.at_rest.gaps[k - 2].abs() + resting.moves(k, swing));
        let leaves = !self.goes_beyond && step.open != [0.0; 2];
        if leaves && deepest.fold(0.0, f64::max) > self.record.deepest_predicted {
            return None;
        }
        let Resting { rest, at_rest, change, unchanged, slopes } = resting;
        let [a, b] = at_rest.multipliers;
        let (length, radius) = (machine.blade_length, self.scene.casing.radius_m);
        let rotor = speed * self.drive.step;
        let outcome = |deviation: Modes| {
            let modes = rest + deviation;
            let stepped = step.from(modes)?;
            let [a, b] = stepped.multipliers;
            let [work, casing, blades, heat] = step.flows(modes, &stepped, rotor, length, radius);
            Some((stepped.change, [a, b, work, casing, blades, heat]))
        };
        let [linear, square, _] = SMALL_TURNS;
        let counts = self.goes_beyond && !self.beyond.account.forgone;
        let (_, values) = outcome(Modes::zeros())?;
        let deviations: Arc<dyn Deviations> = match step.blades() {
            Some(blades) if phase > linear || counts => {
                let angle = swing.0.max(HELD_PROBE);
                let increment = swing.1.max(angle * blades.oscillator().turn());
                let scale = Modes::new(angle, angle, increment, increment);
                unfold(outcome, start, scale, phase > square)?.into()
            }
            _ => {
                Arc::new(Unfolded::linear(start, change, unchanged, values, [slopes[0], slopes[1]]))
            }
        };
        let pulls = a > 0.0 || b > 0.0;
        let multipliers = [a, b];
        let least = CERTAIN_PUSH * machine.push_scale(machine.nu(speed));
        let is_certain = multipliers.iter().all(|push| push.abs() > least);
        let held = HeldCorner {
            step,
            pulls,
            is_certain,
            rest,
            multipliers,
            deviations,
            counts,
            swing,
            growth,
        };
        held.closes(&at_rest)?.then(|| Box::new(held))
    }

    /// Returns the modes of blades whose rows are sides, where the casing is rigid and gives
    /// nothing back.
    pub(super) fn modes_of_sides(&self) -> Option<HeldModes<'_>> {
        let plain = || {
            let by_side = self.blades.wave().is_some();
            let rigid = self.lining.is_none() && self.scene.contact.restitution == 0.0;
            by_side && rigid && self.beyond.long_steps == 0
        };
        if !self.goes_beyond || plain() { self.blades.held_modes() } else { None }
    }

    /// Returns whether predicted gaps and multipliers never come near a change of sign, and no
    /// blade of another side near the casing: neither at rest nor by a swing about it.
    fn is_kept(&self, step: &CornerStep, at: &Resting, swing: (f64, f64)) -> bool {
        let far = !self.goes_beyond || self.is_far_from_others(step, at, swing.0);
        far && (0..4).all(|k| {
            let value = at.value(k);
            let fits = value.is_finite() && ((k < 2 && self.law.pulls()) || value < 0.0);
            fits && at.moves(k, swing) < ROOM_TO_CHANGE * value.abs()
        })
    }

    /// Returns whether no swing by this angle brings a blade of another side near the casing. The
    /// two sides that are closed hold the polygon of the tips at its corner; only the phases of
    /// their blades and of the other side move it, across the corner by up to three times as much
    /// as along a normal.
    fn is_far_from_others(&self, step: &CornerStep, at: &Resting, angle: f64) -> bool {
        let (place, _) = step.casing(at.rest);
        let turn = self.machine.nodal_diameters * angle;
        let moves = 5.0 * turn * (place.norm() + self.tips.rise.abs() * angle);
        moves <= ROOM_TO_CHANGE * step.nearest_other(&self.machine, at.rest)
    }

    /// Returns the coordinates `steps` steps into the held corner.
    pub(in crate::motion::explicit) fn held_at(
        &self,
        held: &HeldCorner,
        steps: u64,
    ) -> ([Coordinate; 2], B) {
        let modes = held.modes(steps);
        let mut blades = self.blades.clone();
        let before = if self.goes_beyond && steps > 0 { held.modes(steps - 1) } else { modes };
        blades.set_held_modes(as_coordinates(modes), [before[2], before[3]]);
        let (c, s) = self.drive.look_at_turn(self.n + steps);
        let (place, change) = held.step.casing(modes);
        let u = [
            Coordinate { x: place.re * c - place.im * s, increment: change.re * c - change.im * s },
            Coordinate { x: place.re * s + place.im * c, increment: change.re * s + change.im * c },
        ];
        (u, blades)
    }

    /// Returns the increments of the casing in the step before the last of `steps` \[m\].
    pub(in crate::motion::explicit) fn held_before(
        &self,
        held: &HeldCorner,
        steps: u64,
    ) -> [f64; 2] {
        let before = steps.saturating_sub(1);
        let (c, s) = self.drive.look_at_turn(self.n + before);
        let (_, change) = held.step.casing(held.modes(before));
        [change.re * c - change.im * s, change.re * s + change.im * c]
    }
}

/// Returns how far a map lets a deviation grow at most, in the energy of free modes that turn by
/// `turn` in a step; none where it may grow on and on, or far.
fn growth_of(leap: &Leap<4>, turn: f64) -> Option<f64> {
    let scale = Modes::new(1.0, 1.0, turn, turn);
    let norm = |exponent| {
        let column = |k: usize| {
            let unit = Modes::from_fn(|row, _| if row == k { scale[k] } else { 0.0 });
            leap.doubled(unit, exponent).component_div(&scale)
        };
        let map = StepMap::from_columns(&[0, 1, 2, 3].map(column));
        map.tr_mul(&map).symmetric_eigenvalues().max().sqrt()
    };
    let norms: Vec<f64> = (0..=LARGEST).map(norm).collect();
    let growth = norms.iter().fold(1.0, |growth, norm| growth * norm.max(1.0));
    let ends = norms.last().is_some_and(|last| *last < MOST_GROWTH);
    (ends && growth < MOST_GROWTH).then_some(growth)
}

/// Blade modes at rest in a corner, the step from there, and the map of the deviation.
struct Resting {
    rest: Modes,
    at_rest: Stepped,
    /// The map, minus one, and its inverse; zero for rigid blades.
    change: StepMap,
    unchanged: StepMap,
    slopes: [Modes; 4],
}

impl Resting {
    /// Returns a push (0, 1 \[N\]) or a predicted gap (2, 3 \[m\]).
    fn value(&self, k: usize) -> f64 {
        let Stepped { multipliers: [a, b], gaps: [first, second], .. } = self.at_rest;
        [a, b, first, second][k]
    }

    /// Returns how far a swing moves a push (0, 1 \[N\]) or a predicted gap (2, 3 \[m\]) at most.
    fn moves(&self, k: usize, swing: (f64, f64)) -> f64 {
        let ((angle, increment), slope) = (swing, self.slopes[k]);
        angle * slope[0].hypot(slope[1]) + increment * slope[2].hypot(slope[3])
    }
}

/// Returns the rest nearest to `now`. Where steps leave more than next to nothing of their gaps,
/// the corner of the step gets the gaps that they leave there.
fn rest_in(step: &mut CornerStep, now: Modes) -> Option<Resting> {
    let mut rest = now;
    for _ in 0..HELD_CORRECTIONS {
        let (change, slopes) = slopes(step, rest)?;
        let mut unchanged = StepMap::zeros();
        if step.blades().is_some() {
            unchanged = change.try_inverse()?;
            for _ in 0..HELD_CORRECTIONS {
                let correction = unchanged * step.from(rest)?.change;
                rest -= correction;
                if correction.amax() <= f64::EPSILON * rest.amax() {
                    break;
                }
            }
        } else {
            rest = Modes::zeros();
        }
        let at_rest = step.from(rest)?;
        if step.is_closed_by(&at_rest, at_rest.gaps) {
            return Some(Resting { rest, at_rest, change, unchanged, slopes });
        }
        step.open = at_rest.left;
    }
    None
}

/// Returns the map of the deviation from `at`, minus one, and the gradients of multipliers
/// and predicted gaps, by central differences.
fn slopes(step: &CornerStep, at: Modes) -> Option<(StepMap, [Modes; 4])> {
    let mut map = StepMap::zeros();
    let mut slopes = [Modes::zeros(); 4];
    for j in 0..4 {
        let mut shift = Modes::zeros();
        shift[j] = HELD_PROBE;
        let (up, down) = (step.from(at + shift)?, step.from(at - shift)?);
        map.set_column(j, &((up.change - down.change) / (2.0 * HELD_PROBE)));
        for k in 0..2 {
            slopes[k][j] = (up.multipliers[k] - down.multipliers[k]) / (2.0 * HELD_PROBE);
            slopes[2 + k][j] = (up.gaps[k] - down.gaps[k]) / (2.0 * HELD_PROBE);
        }
    }
    Some((map, slopes))
}

fn as_modes([c, s]: [Coordinate; 2]) -> Modes {
    Modes::new(c.x, s.x, c.increment, s.increment)
}

fn as_coordinates(modes: Modes) -> [Coordinate; 2] {
    [
        Coordinate { x: modes[0], increment: modes[2] },
        Coordinate { x: modes[1], increment: modes[3] },
    ]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::Solver;
    use crate::motion::explicit::Oscillator;
    use crate::motion::explicit::disk::ModalBlades;
    use crate::motion::explicit::rows::TipLaw;
    use crate::scene::Scene;
    use crate::tolerances::HELD_LEFT;

    #[test]
    fn a_swing_that_changes_the_sign_of_a_push_or_a_gap_is_not_kept() {
        let (mut step, rest) = corner();
        let motion = Explicit::<ModalBlades>::new(&Scene::base().checked().unwrap());
        let resting = rest_in(&mut step, rest).unwrap();
        let turn = step.blades().unwrap().oscillator().turn();
        let (mut kept, mut changed) = (0, 0);
        for size in 0..80 {
            let angle = 1e-9 * 1.4_f64.powi(size);
            let keeps = motion.is_kept(&step, &resting, (angle, angle * turn));
            let changes = (0..16).any(|phase| {
                let (s, c) = (f64::from(phase) * std::f64::consts::PI / 8.0).sin_cos();
                let swing = Modes::new(c, s, -turn * s, turn * c) * angle;
                step.from(rest + swing).is_none_or(|Stepped { multipliers, gaps, .. }| {
                    let values = multipliers.into_iter().chain(gaps).enumerate();
                    values.into_iter().any(|(k, value)| value * resting.value(k) <= 0.0)
                })
            });
            assert!(!(keeps && changes), "{angle}");
            kept += u32::from(keeps);
            changed += u32::from(changes);
        }
        assert!(kept > 10 && changed > 10, "{kept} {changed}");
    }

    #[test]
    fn a_corner_is_steady_from_as_many_steps_after_a_change_on_as_after_its_start() {
        let mut scene = Scene::builtin("adhesive").unwrap();
        scene.solver.shortcuts.lock = false;
        let mut motion = Explicit::<ModalBlades>::new(&scene.checked().unwrap());
        for part in 1.. {
            motion.advance(1e-4 * f64::from(part)).unwrap();
            if motion.steady_corner_since(0).is_some() {
                break;
            }
        }
        let since = (motion.record.log.since / motion.drive.step) as u64;
        for n in since + HELD_AFTER..motion.n {
            assert!(motion.steady_corner_since(n - HELD_AFTER).is_some());
        }
        for steps in [0, 1, HELD_AFTER - 1, HELD_AFTER, HELD_AFTER + 1] {
            let found = motion.steady_corner_since(motion.n - steps);
            assert_eq!(found.is_some(), steps >= HELD_AFTER, "{steps}");
        }
    }

    /// A corner of the paper's blades, and their modes at rest in it.
    fn corner() -> (CornerStep, Modes) {
        let mut scene = Scene::base();
        scene.solver.step_s = 1e-5;
        let machine = scene.machine();
        let casing = Oscillator::of_casing(&machine, 1e-5);
        let blades = ModalBlades::at_rest(&scene, &machine, None);
        let turn = machine.nu(scene.operation.speed_rad_s) * 1e-5;
        let sides = [4, machine.polygon.next(4)];
        let tips = TipLaw::at(&machine, scene.operation.speed_rad_s);
        let step = CornerStep::new(&machine, tips, &casing, Some(&blades), sides, turn);
        let mut rest = Modes::zeros();
        let back = slopes(&step, rest).unwrap().0.try_inverse().unwrap();
        for _ in 0..HELD_CORRECTIONS {
            rest -= back * step.from(rest).unwrap().change;
        }
        (step, rest)
    }

    #[test]
    fn a_corner_closes_if_both_sides_do_at_rest_and_wherever_angles_and_increments_swing() {
        let (step, rest) = corner();
        let left = |modes: Modes| step.from(modes).unwrap().left.map(f64::abs);
        let mut open = Vec::new();
        for swing in [(0.0, 0.0), (1e-3, 0.0), (0.0, 1e-3), (1e-3, 1e-3)] {
            let ends = [swing.0, swing.0, swing.1, swing.1];
            let mut most = left(rest);
            for (j, end) in ends.into_iter().flat_map(|end| [end, -end]).enumerate() {
                let mut modes = rest;
                modes[j / 2] += end;
                let [a, b] = left(modes);
                most = [most[0].max(a), most[1].max(b)];
            }
            // Of predicted gaps so large that what is left is next to nothing, or not.
            for (a, b) in [(2.0, 2.0), (0.5, 2.0), (2.0, 0.5)] {
                let gaps = [a * most[0] / HELD_LEFT, b * most[1] / HELD_LEFT];
                let at_rest = Stepped { gaps, ..step.from(rest).unwrap() };
                let nothing = StepMap::zeros();
                let held = HeldCorner {
                    step: step.clone(),
                    pulls: false,
                    is_certain: true,
                    rest,
                    multipliers: [0.0; 2],
                    deviations: Arc::new(Unfolded::linear(
                        Modes::zeros(),
                        nothing,
                        nothing,
                        [0.0; 6],
                        [Modes::zeros(); 2],
                    )),
                    counts: false,
                    swing,
                    growth: 1.0,
                };
                let closes = (0..2).all(|k| most[k] <= HELD_LEFT * gaps[k]);
                assert_eq!(held.closes(&at_rest), Some(closes), "{swing:?} {a} {b} {most:?}");
                if !closes {
                    open.push((swing, a, b, most));
                }
            }
        }
        // Either side alone, by an angle, an increment and both.
        assert!(open.len() >= 6, "{open:?}");
    }
}
