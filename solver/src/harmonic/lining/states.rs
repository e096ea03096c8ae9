//! Steady states on a lining in the blade frame (docs/theory.md, section 10): rest, and waves held
//! by one, two, three or more neighbouring groups of blades; the loads of a lock of two groups, and
//! the softest lining that holds one.
//!
//! Both structures are at rest in that frame, so one complex equation remains for
//! `w = z - kappa l_b a`: `w/H = p(w)`, with the joint compliance `H = B(nu)`. For `eps = 0` it is
//! linear for each set of groups in contact, and all sets of neighbours are tried. From these
//! solutions, and from a grid of points, Newton's method continues to `eps > 0`.
//!
//! For blades that do not turn the gap, a pair of groups holds the wave if
//! `-tan(delta) Re H - |Im H| >= 1/(k sin 2 delta)`, where `H = B(nu)` is the joint compliance and
//! `k` the stiffness of one group; without friction and inclined tips
//! `|K| tan delta >= D + (K^2 + D^2)/(k sin 2 delta)`. A lock therefore needs a minimum stiffness
//! at each speed, and a lining softer than the least of these never holds one. Above the last speed
//! of two groups three may hold the wave.

use std::borrow::Cow;

use nalgebra::{Complex, Matrix2, Vector2, Vector4};

use super::Lining;
use super::rest::LeastStiffness;
use crate::harmonic::LockLoads;
use crate::harmonic::held::{Held, NEWTON_STEPS};
use crate::harmonic::{error, has_one_wave};
use crate::model::{Frame, Machine, Row};
use crate::numeric::rounding::AS_ZERO;
use crate::numeric::search::highest_of;
use crate::scene::SceneError;

/// Range of `ln(speed/lock - 1)` in which the softest lining is searched, with the lock speed of rigid
/// contact. A smaller range would exclude the optimum of nearly rigid linings.
const WINDOW_REACH: [f64; 2] = [-30.0, 15.0];

/// Number of intervals of that range.
const WINDOW_LOOKS: u32 = 450;

/// Distance of two steady states, relative to the contact length, up to which they count as one. With
/// a larger one, two states near their fold would count as one.
const LINING_ALIKE: f64 = 1e-7;

/// Real part of an eigenvalue, relative to the largest eigenvalue, up to which it counts as
/// round-off.
const LINING_NEUTRAL: f64 = 1e-10;

/// Grid of starting points: angle in units of `delta`, and amplitude in units of the contact
/// length.
const GRID: ([f64; 5], [f64; 6]) =
    ([-1.0, -0.5, 0.01, 0.5, 1.0], [1.001, 1.02, 1.1, 1.5, 3.0, 10.0]);

/// A steady state on a lining.
#[derive(Clone, Debug, PartialEq)]
pub struct LiningState {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Number of groups in contact.
    pub pushing: usize,
    /// Groups in contact with their forces, the strongest first.
    pub pushes: Vec<GroupPush>,
    /// Relative displacement `w` in the blade frame, `[Re w, Im w]` \[m\].
    pub gap_m: [f64; 2],
    /// Amplitude of the casing wave \[m\].
    pub casing_m: f64,
    /// Amplitude of the two blade modes \[rad\].
    pub blade_rad: f64,
    /// Growth rate of the least stable motion about the state \[1/s\].
    pub growth_1_s: f64,
    /// Frequency of that motion in the blade frame; 0 if it does not oscillate \[rad/s\].
    pub frequency_rad_s: f64,
    /// Whether no motion grows.
    pub stable: bool,
}

/// Contact force of a phase group.
#[derive(Clone, Debug, PartialEq)]
pub struct GroupPush {
    /// Blades of the group, numbered from 1.
    pub blades: Vec<u32>,
    /// Sum of their contact forces \[N\].
    pub push_n: f64,
}

/// The equation `w/H = p(w)` at one speed.
#[derive(Clone, Debug)]
struct Balance<'a> {
    lining: Lining<'a>,
    /// Rotor speed \[rad/s\].
    speed: f64,
    frame: Frame,
    /// `1/H` \[N/m\].
    inverse: Complex<f64>,
    /// Magnitude of both terms per unit of `w` \[N/m\].
    scale: f64,
}

/// Returns the matrix that multiplies `(Re, Im)` by a complex number.
fn as_matrix(number: Complex<f64>) -> Matrix2<f64> {
    Matrix2::new(number.re, -number.im, number.im, number.re)
}

impl<'a> Balance<'a> {
    fn at(lining: &Lining<'a>, speed: f64) -> Self {
        let lining = lining.at(speed);
        let machine = &*lining.machine;
        let frame = Frame::at(machine, speed);
        let inverse = frame.impedance();
        let together = lining.law.stiffness_n_per_m * f64::from(machine.polygon.blades_per_side);
        let scale = inverse.norm() + together;
        Self { lining, speed, frame, inverse, scale }
    }

    /// Returns index, direction and gap of every side at a displacement.
    fn gaps(&self, w: Vector2<f64>) -> impl Iterator<Item = (u32, Vector2<f64>, f64)> {
        let machine = &*self.lining.machine;
        let clearance = machine.clearance();
        (0..machine.polygon.sides).map(move |side| {
            let (cos, sin) = machine.polygon.direction(side);
            (side, Vector2::new(cos, sin), clearance + w.x * cos + w.y * sin)
        })
    }

    /// Returns the contact force of all blades at a displacement, and its derivative:
    /// `dp = -tangent dw`.
    fn pushes(&self, w: Vector2<f64>) -> (Vector2<f64>, Matrix2<f64>) {
        let each = f64::from(self.lining.machine.polygon.blades_per_side);
        self.gaps(w).fold((Vector2::zeros(), Matrix2::zeros()), |(push, slope), (_, n, gap)| {
            if gap >= 0.0 {
                return (push, slope);
            }
            let (here, stiff) =
                (self.lining.law.push(gap) * each, self.lining.law.slope(gap) * each);
            (push + n * here, slope + n * n.transpose() * stiff)
        })
    }

    /// Returns the residual of the equation, divided by `scale`, and its derivative with
    /// respect to `w`.
    fn residual(&self, w: Vector2<f64>) -> (Vector2<f64>, Matrix2<f64>) {
        let (push, slope) = self.pushes(w);
        let inverse = as_matrix(self.inverse);
        ((inverse * w - push) / self.scale, (inverse + slope) / self.scale)
    }

    /// Solves the equations by Newton's method; `None` if it does not converge.
    fn solve(&self, start: Vector2<f64>) -> Option<Vector2<f64>> {
        let length = self.length();
        let mut w = start;
        let (mut residual, mut jacobian) = self.residual(w);
        for _ in 0..NEWTON_STEPS {
            let step = jacobian.lu().solve(&residual)?;
            // The step is halved if it overshoots a kink of the law.
            let mut part = 1.0;
            let mut next = self.residual(w - step);
            while next.0.norm() > residual.norm() && part > 1.0 / 64.0 {
                part *= 0.5;
                next = self.residual(w - step * part);
            }
            w -= step * part;
            (residual, jacobian) = next;
            let size = w.norm().max(length);
            if !size.is_finite() {
                return None;
            }
            if step.norm() * part <= 4.0 * f64::EPSILON * size {
                break;
            }
        }
        (residual.norm() <= AS_ZERO * w.norm().max(length)).then_some(w)
    }

    /// Returns the characteristic length of the contact, clearance plus smoothing depth \[m\].
    fn length(&self) -> f64 {
        self.lining.machine.clearance().abs() + self.lining.law.smoothing_m
    }

    /// Returns the displacement that contact on the first `sides` neighbouring sides would hold with
    /// a linear lining (`eps = 0`) \[m\]; `None` if the equations are singular.
    fn sprung(&self, sides: u32) -> Option<Vector2<f64>> {
        let machine = &*self.lining.machine;
        let each = self.lining.law.stiffness_n_per_m * f64::from(machine.polygon.blades_per_side);
        let clearance = machine.clearance() + 0.5 * self.lining.law.smoothing_m;
        let (mut push, mut slope) = (Vector2::zeros(), Matrix2::zeros());
        for side in 0..sides {
            let (cos, sin) = machine.polygon.direction(side);
            let n = Vector2::new(cos, sin);
            push -= n * (each * clearance);
            slope += n * n.transpose() * each;
        }
        (as_matrix(self.inverse) + slope).lu().solve(&push)
    }

    /// Returns the starting points of Newton's method.
    fn starts(&self) -> Vec<Vector2<f64>> {
        let polygon = &self.lining.machine.polygon;
        let mut starts: Vec<Vector2<f64>> =
            (1..=polygon.sides).filter_map(|sides| self.sprung(sides)).collect();
        let (angles, sizes) = GRID;
        for angle in angles {
            // The first side is in contact where w points against its direction.
            let (sin, cos) = (polygon.delta * angle).sin_cos();
            starts.extend(sizes.map(|size| Vector2::new(-cos, -sin) * (size * self.length())));
        }
        starts
    }

    /// Returns whether two displacements are the same up to a rotation by whole sides.
    fn alike(&self, one: Vector2<f64>, other: Vector2<f64>) -> bool {
        let polygon = &self.lining.machine.polygon;
        let length = one.norm().max(self.length());
        (0..polygon.sides).any(|side| {
            let (cos, sin) = polygon.direction(side);
            let turned = Vector2::new(cos * other.x - sin * other.y, sin * other.x + cos * other.y);
            (one - turned).norm() <= LINING_ALIKE * length
        })
    }

    /// Evaluates the state at a displacement.
    fn state(&self, w: Vector2<f64>) -> Result<LiningState, SceneError> {
        let machine = &*self.lining.machine;
        let unsettled = || error::unsettled(self.speed);
        let (push, _) = self.pushes(w);
        let frame = &self.frame;
        let each = f64::from(machine.polygon.blades_per_side);
        let closed = self.gaps(w).filter(|(.., gap)| *gap < 0.0);
        let spring = |(_, n, gap): (u32, Vector2<f64>, f64)| {
            (Row::fixed(frame, (n.x, n.y)), self.lining.law.slope(gap) * each)
        };
        let springs: Vec<_> = closed.map(spring).collect();
        let values = frame.motion(&[], &springs).eigenvalues().ok_or_else(unsettled)?;
        let worst =
            values.iter().copied().max_by(|a, b| a.re.total_cmp(&b.re)).ok_or_else(unsettled)?;
        let fastest = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
        let mut pushes: Vec<GroupPush> = self
            .gaps(w)
            .filter(|(_, _, gap)| *gap < 0.0)
            .map(|(side, _, gap)| GroupPush {
                blades: machine.polygon.blades_of_side(side),
                push_n: self.lining.law.push(gap) * each,
            })
            .collect();
        pushes.sort_by(|a, b| b.push_n.total_cmp(&a.push_n));
        let push = Complex::new(push.x, push.y);
        // From z = w + kappa l_b a, a = -(kappa + mu) l_b p/k_a.
        let bent = push * (frame.lever / frame.blades.stiffness);
        let casing = Complex::new(w.x, w.y) - bent * frame.slope;
        Ok(LiningState {
            speed_rad_s: self.speed,
            pushing: pushes.len(),
            pushes,
            gap_m: [w.x, w.y],
            casing_m: casing.norm(),
            blade_rad: bent.norm(),
            growth_1_s: worst.re,
            frequency_rad_s: worst.im.abs(),
            stable: worst.re <= LINING_NEUTRAL * fastest,
        })
    }
}

impl Lining<'_> {
    /// Returns every steady state at a speed \[rad/s\], by the number of groups in contact; states
    /// that differ only by a rotation by whole groups are returned once.
    ///
    /// # Errors
    /// The speed is not finite, or the stiffnesses differ by too many powers of ten.
    pub fn states(&self, speed: f64) -> Result<Vec<LiningState>, SceneError> {
        error::refuse_endless(&[speed])?;
        let balance = Balance::at(self, speed);
        let mut places: Vec<Vector2<f64>> = vec![Vector2::zeros()];
        for start in balance.starts() {
            if let Some(w) = balance.solve(start)
                && !places.iter().any(|&known| balance.alike(known, w))
            {
                places.push(w);
            }
        }
        let mut states =
            places.into_iter().map(|w| balance.state(w)).collect::<Result<Vec<_>, _>>()?;
        states.sort_by_key(|state| state.pushing);
        Ok(states)
    }
}

/// The two groups of the corner considered.
const SIDES: [u32; 2] = [0, 1];

/// Returns the frame and the displacement of a wave held by two groups alone; `None` if there is
/// none, or if it is unstable.
fn place(machine: &Machine, speed: f64) -> Option<(Frame, Vector2<f64>)> {
    let law = machine.lining.filter(|_| has_one_wave(machine))?;
    let lining = Lining { machine: Cow::Borrowed(machine), law };
    let balance = Balance::at(&lining, speed);
    let w = balance.solve(balance.sprung(2)?)?;
    let pushing = balance.gaps(w).filter(|(.., gap)| *gap < 0.0).map(|(side, ..)| side);
    let held = pushing.eq(SIDES) && balance.state(w).is_ok_and(|state| state.stable);
    held.then_some((balance.frame, w))
}

/// Returns the loads of a lock held by two groups on the lining; `None` if no two groups alone hold
/// one.
pub(in crate::harmonic) fn lock_loads(machine: &Machine, speed: f64) -> Option<LockLoads> {
    let machine = &*machine.at(speed);
    let (law, (frame, w)) = (machine.lining?, place(machine, speed)?);
    let each = f64::from(machine.polygon.blades_per_side);
    let directions = SIDES.map(|side| machine.polygon.direction(side));
    let normals = directions.map(|(cos, sin)| Complex::new(cos, sin));
    let w = Complex::new(w.x, w.y);
    let pushes = normals.map(|n| law.push(machine.clearance() + (w * n.conj()).re) * each);
    let sum = |loads: [f64; 2]| normals[0] * loads[0] + normals[1] * loads[1];
    // From z = w + kappa l_b a, a = sum P (A - (kappa + mu) l_b) e^{i psi}/k_a; the gap neglects A.
    let bent = -sum(pushes) * (frame.lever / frame.blades.stiffness);
    let z = w + bent * frame.slope;
    let arms = normals.map(|n| (z * n.conj()).im * frame.diameters);
    let a = bent + sum([pushes[0] * arms[0], pushes[1] * arms[1]]) / frame.blades.stiffness;
    let loads = [(SIDES[0], -pushes[0]), (SIDES[1], -pushes[1])];
    let at = Vector4::new(z.re, z.im, a.re, a.im);
    LockLoads::of(machine, speed, &Held::new(machine, frame, at, &loads, 0.0))
}

/// Returns the smallest stiffness under one blade with which a lining holds a lock at a speed;
/// infinite if no lock exists \[N/m\].
fn needed(machine: &Machine, speed: f64) -> f64 {
    let polygon = &machine.polygon;
    let compliance = Frame::at(machine, speed).compliance();
    let left = -compliance.re * polygon.delta.tan() - compliance.im.abs();
    if left <= 0.0 {
        return f64::INFINITY;
    }
    1.0 / ((2.0 * polygon.delta).sin() * left * f64::from(polygon.blades_per_side))
}

/// Returns the softest lining, by its stiffness under one blade, that holds a lock for forward
/// rotation. Zero at the critical speed if the casing is undamped; `None` if rigid contact has no
/// lock.
#[must_use]
pub fn least_lock_stiffness(machine: &Machine) -> Option<LeastStiffness> {
    let lock = machine.clone().with_lining(None).lock_speed()?;
    if machine.casing_damping == 0.0 && !machine.casing_feels_tips() {
        return Some(LeastStiffness { stiffness_n_per_m: 0.0, speed_rad_s: lock });
    }
    let [low, high] = WINDOW_REACH;
    let place = |k: u32| low + (high - low) * f64::from(k) / f64::from(WINDOW_LOOKS);
    let speed_at = |excess: f64| lock * (1.0 + excess.exp());
    let needed_at = |excess: f64| needed(machine, speed_at(excess));
    let places: Vec<f64> = (0..=WINDOW_LOOKS).map(place).collect();
    let (excess, _) = highest_of(&places, |excess| -needed_at(excess))?;
    let stiffness_n_per_m = needed_at(excess);
    Some(LeastStiffness { stiffness_n_per_m, speed_rad_s: speed_at(excess) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn rest_under_preload_is_one_state() {
        let scene = Scene::builtin("coincidence").unwrap();
        let machine = scene.machine();
        let lining = Lining::of(&machine, &scene.contact).unwrap();
        for speed in [100.0, 390.0, 406.0, -445.0] {
            let states = lining.states(speed).unwrap();
            let rests = states.iter().filter(|state| state.casing_m < 1e-12);
            assert_eq!(rests.count(), 1, "{speed}: {states:?}");
        }
    }
}
