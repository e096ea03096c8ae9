//! A lock held by both laws alike: step after step the same corner closes.
//! (docs/theory.md, section 6.)
//!
//! In the frame of the blades the casing then follows from the blade angles
//! alone (two gaps are zero), and at constant speed one step maps the blade
//! modes `b = (alpha_c, alpha_s, increments)` to themselves. The map is affine
//! to the square of the blade phase that is left of their vibration, so any
//! number of steps is one small matrix power about the modes at rest. The step
//! is worked out with its small parts apart (`CornerStep`), so that it carries
//! no round-off of the gaps; the map is used only while both multipliers and
//! both predicted gaps keep their signs with room to spare, and where no gap is
//! left: a push turns the sides of soft blades in a long step.
//!
//! The prediction of such a step (`CornerStep`) leaves the corner by some `h^2` of the
//! clearance, and a gap taken from the clearance itself would round that off. In the frame
//! of the blades, with `q = 1 - exp(-i nu h)`, `r = 1 - ratio` and the steps of the
//! oscillator, a casing that stood in the corners `z[n-1]` and `z[n]` is
//! predicted at
//!
//! ```text
//! z* = z[n] - (q (q + r - q r) + (1 - q) pull) z[n] + (1 - q)^2 (1 - r) (z[n] - z[n-1])
//! ```
//!
//! where nothing is added up that cancels. A side turned by `tau` from where it
//! touched at `y` opens by `2 g0 sin^2(tau/2) + y sin tau`.

use nalgebra::{SMatrix, SVector};

use crate::contact;
use crate::model::Machine;
use crate::motion::explicit::disk::{Disk, ModalBlades};
use crate::motion::explicit::oscillator::Leap;
use crate::motion::explicit::{Coordinate, Explicit, Oscillator};
use crate::motion::{ActiveSet, Plane};
use crate::tolerances::{
    ANGLE_LOOK, HELD_AFTER, HELD_AGAIN, HELD_CORRECTIONS, HELD_LEFT, HELD_PROBE, HELD_ROUNDINGS,
    ROOM_TO_CHANGE, SMALL_TURN,
};

/// A step from one corner to the next.
#[derive(Clone, Debug)]
pub(in crate::motion::explicit) struct CornerStep {
    sides: [u32; 2],
    /// `exp(i psi)` of both sides.
    directions: [Plane; 2],
    clearance: f64,
    diameters: f64,
    casing: Oscillator,
    blades: Option<ModalBlades>,
    /// `q` above.
    turned: Plane,
}

/// What a step does.
pub(in crate::motion::explicit) struct Stepped {
    /// Change of the blade modes.
    pub change: Modes,
    /// Multipliers of both sides \[N\].
    pub multipliers: [f64; 2],
    /// Predicted gaps of both sides \[m\].
    pub gaps: [f64; 2],
    /// What the correction leaves of them, as it turns the sides \[m\].
    pub left: [f64; 2],
}

impl CornerStep {
    /// For a wave that turns by `turn` a step against the standing frame.
    pub fn new(
        machine: &Machine,
        casing: &Oscillator,
        blades: Option<&ModalBlades>,
        sides: [u32; 2],
        turn: f64,
    ) -> Self {
        let half = (0.5 * turn).sin();
        Self {
            sides,
            directions: sides.map(|side| {
                let (c, s) = machine.polygon.direction(side);
                Plane::new(c, s)
            }),
            clearance: machine.clearance(),
            diameters: machine.nodal_diameters,
            casing: casing.clone(),
            blades: blades.cloned(),
            turned: Plane::new(2.0 * half * half, turn.sin()),
        }
    }

    pub fn sides(&self) -> [u32; 2] {
        self.sides
    }

    /// Sine of the angle between the sides.
    pub fn sine(&self) -> f64 {
        (self.directions[0].conj() * self.directions[1]).im
    }

    /// The blades that move, if any.
    pub fn blades(&self) -> Option<&ModalBlades> {
        self.blades.as_ref()
    }

    /// `n_d alpha` of both sides at these displacements of the modes.
    fn turns(&self, displacements: [f64; 2]) -> [f64; 2] {
        let Some(blades) = &self.blades else { return [0.0; 2] };
        self.sides.map(|side| {
            let (c, s) = blades.shape(side);
            self.diameters * (c * displacements[0] + s * displacements[1])
        })
    }

    /// The point where both gaps are zero, and the normals there.
    fn corner(&self, turns: [f64; 2]) -> (Plane, [Plane; 2]) {
        let a = self.directions[0] * Plane::cis(turns[0]);
        let b = self.directions[1] * Plane::cis(turns[1]);
        let scale = -self.clearance / (a.conj() * b).im;
        (Plane::new(scale * (b.im - a.im), scale * (a.re - b.re)), [a, b])
    }

    /// Change of the corner where the sides turn by `change` to `turns`.
    fn moved(&self, turns: [f64; 2], change: [f64; 2]) -> Plane {
        // z = i g0 (b - a)/Im(conj(a) b), taken apart from its value before.
        let (now, [a, b]) = self.corner(turns);
        let back = |normal: Plane, by: f64| {
            let half = (0.5 * by).sin();
            // normal (1 - exp(-i by))
            normal * Plane::new(2.0 * half * half, by.sin())
        };
        let (da, db) = (back(a, change[0]), back(b, change[1]));
        let before = ((a - da).conj() * (b - db)).im;
        let spread = (da.conj() * b + a.conj() * db - da.conj() * db).im;
        // now = s/D, then = (s - ds)/(D - dD): now - then = (ds - now dD)/(D - dD).
        let shift = Plane::i() * (da - db) * -self.clearance;
        (shift - now * spread) / before
    }

    /// The casing in the corner of these modes, and what it moved in its last
    /// step, both in the frame of the blades now.
    pub fn casing(&self, modes: Modes) -> (Plane, Plane) {
        let turns = self.turns([modes[0], modes[1]]);
        let place = self.corner(turns).0;
        let moved = self.moved(turns, self.turns([modes[2], modes[3]]));
        // z[n] - exp(-i nu h) z[n-1]
        (place, moved + self.turned * (place - moved))
    }

    /// One step from these modes. `None` where the rows are dependent.
    pub fn from(&self, modes: Modes) -> Option<Stepped> {
        let turns = self.turns([modes[0], modes[1]]);
        let (place, normals) = self.corner(turns);
        let moved = self.moved(turns, self.turns([modes[2], modes[3]]));
        let (q, one) = (self.turned, Plane::new(1.0, 0.0));
        let (loss, pull) = (self.casing.loss, self.casing.pull);
        let pulled = q * (q + loss - q * loss) + (one - q) * pull;
        let shift = (one - q) * (one - q) * ((1.0 - loss) * moved) - place * pulled;
        // The blades predict, too: their change, which is their increment.
        let steps = self.blades.as_ref().map(|blades| {
            let at = |x, increment| Coordinate { x, increment };
            [at(modes[0], modes[2]), at(modes[1], modes[3])]
                .map(|mode| blades.oscillator().step(mode, 0.0).increment)
        });
        let steps = steps.unwrap_or_default();
        let bends = self.turns(steps);
        let ahead: [Plane; 2] = std::array::from_fn(|k| normals[k] * Plane::cis(bends[k]));
        // Gaps of a casing that has left the corner, of sides turned meanwhile.
        let opened = |shift: Plane, bends: [f64; 2]| -> [f64; 2] {
            std::array::from_fn(|k| {
                let half = (0.5 * bends[k]).sin();
                let along = (place * normals[k].conj()).im;
                let turned = 2.0 * self.clearance * half * half + along * bends[k].sin();
                (shift * (normals[k] * Plane::cis(bends[k])).conj()).re + turned
            })
        };
        let gaps = opened(shift, bends);
        let arms = ahead.map(|normal| self.diameters * ((place + shift) * normal.conj()).im);
        let bent = |j: usize, k: usize| {
            self.blades.as_ref().map_or(0.0, |blades| {
                let ((ca, sa), (cb, sb)) =
                    (blades.shape(self.sides[j]), blades.shape(self.sides[k]));
                blades.oscillator().compliance * (ca * cb + sa * sb)
            })
        };
        let entry = |j: usize, k: usize| {
            self.casing.compliance * (ahead[j] * ahead[k].conj()).re
                + arms[j] * arms[k] * bent(j, k)
        };
        let cross = entry(0, 1);
        let multipliers = contact::pair([[entry(0, 0), cross], [cross, entry(1, 1)]], gaps);
        let (mut change, mut left) = (Modes::zeros(), [0.0; 2]);
        if let Some(blades) = &self.blades {
            let (mut taken, mut moved) = (steps, shift);
            for k in 0..2 {
                let (c, s) = blades.shape(self.sides[k]);
                let torque = -arms[k] * multipliers[k] * blades.oscillator().compliance;
                taken[0] += torque * c;
                taken[1] += torque * s;
                moved -= ahead[k] * (self.casing.compliance * multipliers[k]);
            }
            change = Modes::new(taken[0], taken[1], taken[0] - modes[2], taken[1] - modes[3]);
            left = opened(moved, self.turns(taken));
        }
        let finite = multipliers.iter().all(|lambda| lambda.is_finite());
        finite.then_some(Stepped { change, multipliers, gaps, left })
    }
}

/// `(alpha_c, alpha_s)` and their increments.
pub(in crate::motion::explicit) type Modes = SVector<f64, 4>;
type StepMap = SMatrix<f64, 4, 4>;

/// The map of a held corner, from one step on.
#[derive(Clone, Debug)]
pub(in crate::motion::explicit) struct HeldCorner {
    step: CornerStep,
    /// Whether a multiplier pulls.
    pub pulls: bool,
    /// Blade modes at rest.
    rest: Modes,
    /// Blade modes at the start, less those at rest.
    start: Modes,
    /// Many steps of the deviation from rest.
    leap: Leap<4>,
    /// Inverse of what one step changes of it; zero for rigid blades.
    unchanged: StepMap,
    /// Multipliers of the step from `b`: value at rest and gradient \[N\].
    multipliers: [(f64, Modes); 2],
    /// Bounds on angle and increment of the deviation from rest.
    swing: (f64, f64),
}

impl HeldCorner {
    /// Values of the two sides, each with its side.
    pub fn by_side(&self, [a, b]: [f64; 2]) -> [Option<(u32, f64)>; 2] {
        let [first, second] = self.step.sides();
        [Some((first, a)), Some((second, b))]
    }

    /// Blade modes after `steps` steps.
    fn modes(&self, steps: u64) -> Modes {
        self.rest + self.leap.apply(self.start, steps)
    }

    /// Multipliers of the step that led to `steps` steps from the start \[N\].
    pub fn multipliers(&self, steps: u64) -> [f64; 2] {
        let from = steps.saturating_sub(1);
        // The step itself knows them to the last digit, at any vibration.
        self.step.from(self.modes(from)).map_or_else(
            || {
                let deviation = self.leap.apply(self.start, from);
                self.multipliers.map(|(value, gradient)| value + gradient.dot(&deviation))
            },
            |step| step.multipliers,
        )
    }

    /// Sums of the multipliers of the steps after `before`, up to `steps` \[N\].
    pub fn sums(&self, before: u64, steps: u64) -> [f64; 2] {
        let [from, to] = [before, steps].map(|steps| self.leap.apply(self.start, steps));
        // The sum of T^k b is (T - 1)^-1 times what they change in all.
        let deviation = self.unchanged * (to - from);
        let count = (steps - before) as f64;
        self.multipliers.map(|(value, gradient)| count * value + gradient.dot(&deviation))
    }

    /// Whether the steps leave next to nothing of their gaps, at rest and as far from it
    /// as the modes swing.
    fn closes(&self, at_rest: &Stepped) -> Option<bool> {
        let part = HELD_LEFT.max(HELD_ROUNDINGS * f64::EPSILON / self.step.sine().powi(2));
        let closed =
            |step: &Stepped| (0..2).all(|k| step.left[k].abs() <= part * at_rest.gaps[k].abs());
        let mut all = closed(at_rest);
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

    /// The largest blade angle over the first `steps` steps, `least` where none
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
            let deviation = self.leap.apply(self.start, at);
            let bound = blades.oscillator().reach_of(as_coordinates(deviation)).0;
            if self.rest[0].hypot(self.rest[1]) + bound <= most {
                break;
            }
            let after = angle((at + stride).min(steps));
            // Between looks an angle rises by the square of half a look, at most.
            if here >= before && here >= after && here * (1.0 + ANGLE_LOOK * ANGLE_LOOK) > most {
                let around = [at.saturating_sub(stride), (at + stride).min(steps)];
                most = most.max(top(around, angle));
            }
            (before, here, at) = (here, after, at + stride);
        }
        most
    }
}

/// The largest value between two steps of a function with one top.
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
    pub(in crate::motion::explicit) fn hold_corner(&mut self) -> Option<HeldCorner> {
        let sides = self.steady_corner()?;
        let since = ((self.record.log.since / self.drive.step) as u64).max(self.leaps.hold_tried);
        if self.n < since + HELD_AFTER {
            return None;
        }
        self.leaps.hold_tried = self.n + HELD_AGAIN;
        self.make_map(sides)
    }

    /// The corner in contact in this step, if neither pulse nor ramp nor
    /// excitation acts on it.
    pub(in crate::motion::explicit) fn steady_corner(&self) -> Option<[u32; 2]> {
        let ActiveSet::Corner(a, b) = self.record.log.active_set else { return None };
        (self.drive.is_steady(self.n) && self.record.last_touch == self.n).then_some([a, b])
    }

    fn make_map(&self, sides: [u32; 2]) -> Option<HeldCorner> {
        let now = self.blades.held_modes()?;
        let turn = self.machine.nu(self.drive.speed(self.n)) * self.drive.step;
        let step = CornerStep::new(&self.machine, &self.casing, now.moving, sides, turn);
        let now = as_modes(now.modes);
        let mut rest = now;
        let (change, slopes) = slopes(&step, rest)?;
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
        let [a, b] = at_rest.multipliers;
        let start = now - rest;
        let swing = step
            .blades()
            .map_or((0.0, 0.0), |blades| blades.oscillator().reach_of(as_coordinates(start)));
        let held = HeldCorner {
            pulls: a > 0.0 || b > 0.0,
            rest,
            start,
            leap: Leap::new(change),
            unchanged,
            multipliers: [(a, slopes[0]), (b, slopes[1])],
            swing,
            step,
        };
        let [first, second] = at_rest.gaps;
        let kept = self.is_kept(&held, [a, b, first, second], slopes);
        (kept && held.closes(&at_rest)?).then_some(held)
    }

    /// Whether multipliers and predicted gaps never come near a change of sign:
    /// neither at rest nor by the vibration before it.
    fn is_kept(&self, held: &HeldCorner, rest: [f64; 4], slopes: [Modes; 4]) -> bool {
        let (angle, increment) = held.swing;
        if self.machine.nodal_diameters * angle > SMALL_TURN {
            return false;
        }
        (0..4).all(|k| {
            let swing = angle * (slopes[k][0].hypot(slopes[k][1]))
                + increment * (slopes[k][2].hypot(slopes[k][3]));
            let sign_fits = if k < 2 { self.law.pulls() || rest[k] < 0.0 } else { rest[k] < 0.0 };
            sign_fits && rest[k].is_finite() && swing < ROOM_TO_CHANGE * rest[k].abs()
        })
    }

    /// Coordinates `steps` steps into the held corner.
    pub(in crate::motion::explicit) fn held_at(
        &self,
        held: &HeldCorner,
        steps: u64,
    ) -> ([Coordinate; 2], B) {
        let modes = held.modes(steps);
        let mut blades = self.blades.clone();
        blades.set_held_modes(as_coordinates(modes));
        let (c, s) = self.drive.look_at_turn(self.n + steps);
        let (place, change) = held.step.casing(modes);
        let u = [
            Coordinate { x: place.re * c - place.im * s, increment: change.re * c - change.im * s },
            Coordinate { x: place.re * s + place.im * c, increment: change.re * s + change.im * c },
        ];
        (u, blades)
    }
}

/// The map of the deviation from `at`, minus one, and the gradients of multipliers
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
    use crate::scene::Scene;

    /// A corner of the paper's blades, and their modes at rest in it.
    fn corner() -> (CornerStep, Modes) {
        let mut scene = Scene::base();
        scene.solver.step_s = 1e-5;
        let machine = scene.machine();
        let casing = Oscillator::of_casing(&machine, 1e-5);
        let blades = ModalBlades::at_rest(&scene, &machine, None);
        let turn = machine.nu(scene.operation.speed_rad_s) * 1e-5;
        let sides = [4, machine.polygon.next(4)];
        let step = CornerStep::new(&machine, &casing, Some(&blades), sides, turn);
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
                let held = HeldCorner {
                    step: step.clone(),
                    pulls: false,
                    rest,
                    start: Modes::zeros(),
                    leap: Leap::new(StepMap::zeros()),
                    unchanged: StepMap::zeros(),
                    multipliers: [(0.0, Modes::zeros()); 2],
                    swing,
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
