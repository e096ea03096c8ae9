//! A lock held by both laws alike: step after step the same corner closes.
//!
//! In the frame of the blades the casing then follows from the blade angles
//! alone (two gaps are zero), and at constant speed one step maps the blade
//! modes `b = (alpha_c, alpha_s, increments)` to themselves. The map is affine
//! to the square of the blade phase, some 1e-13 of the clearance, so any number
//! of steps is one small matrix power. Its coefficients are read off the real
//! step, and it is used only while both multipliers and both predicted gaps
//! keep their signs with room to spare.

use nalgebra::{SMatrix, SVector};

use super::{Blades, Coordinate, Explicit};
use crate::model::Rim;
use crate::motion::Touching;
use crate::scene::ContactLaw;

/// Steps a corner must have been closed before the map is read off.
const SETTLED_STEPS: u64 = 64;
/// Steps until it is tried again where it could not be used.
const TRY_AGAIN: u64 = 4096;
/// Change of a blade angle by which the step is differentiated \[rad\].
const PROBE: f64 = 1e-6;
/// Largest blade phase `n_d alpha` whose square the affine map may leave out
/// \[rad\].
const LARGEST_PHASE: f64 = 1e-5;
/// Part of a multiplier or gap that its changes may not exceed.
const ROOM: f64 = 0.5;

type Modes = SVector<f64, 4>;
type Affine = SMatrix<f64, 5, 5>;

/// The map of a held corner, from one step on.
#[derive(Clone, Debug)]
pub(super) struct Held {
    /// The two sides, in the order of `rows`.
    pub sides: [u32; 2],
    /// Whether a multiplier pulls.
    pub pulls: bool,
    /// Blade modes at the start.
    start: Modes,
    /// Powers `2^j` of the map of `(b - start, 1)`.
    powers: Vec<Affine>,
    /// Multipliers of the step from `b`: value at `start` and gradient \[N\].
    multipliers: [(f64, Modes); 2],
    /// Angle the wave turns in a step, `nu h` \[rad\].
    turn: f64,
    /// Bound on every blade angle while the corner is held \[rad\].
    pub farthest: f64,
}

impl Held {
    /// Blade modes after `steps` steps.
    fn modes(&self, steps: u64) -> Modes {
        let mut at = SVector::<f64, 5>::new(0.0, 0.0, 0.0, 0.0, 1.0);
        for (bit, power) in self.powers.iter().enumerate() {
            if steps >> bit & 1 == 1 {
                at = power * at;
            }
        }
        self.start + at.fixed_rows::<4>(0)
    }

    /// Multipliers of the step that led to `steps` steps from the start \[N\].
    pub fn multipliers(&self, steps: u64) -> [f64; 2] {
        let change = self.modes(steps.saturating_sub(1)) - self.start;
        self.multipliers.map(|(value, gradient)| value + gradient.dot(&change))
    }
}

impl<B: Blades> Explicit<B> {
    /// Reads the map off the step, if a corner has been held long enough and
    /// the map can be trusted for good.
    pub(super) fn hold(&mut self) -> bool {
        let Touching::Corner(a, b) = self.log.touching else { return false };
        let since = ((self.log.since / self.step) as u64).max(self.hold_tried);
        let steady = self.rotor.ramp() == 0.0 && self.excitation.is_none();
        let after_pulse =
            self.pulse.force == 0.0 || self.time_of(self.n) > self.pulse.end + self.step;
        if !steady || !after_pulse || self.last_touch != self.n || self.n < since + SETTLED_STEPS {
            return false;
        }
        self.hold_tried = self.n + TRY_AGAIN;
        self.held = self.read_map([a, b]);
        self.held.is_some()
    }

    fn read_map(&self, sides: [u32; 2]) -> Option<Held> {
        let start = as_modes(self.blades.held_modes()?);
        let turn = self.machine.nu(self.rotor.speed(self.time_of(self.n))) * self.step;
        let probe = |modes: Modes| self.probe(sides, turn, modes);
        let (next, lambda, gaps) = probe(start)?;
        let mut map = Affine::zeros();
        let mut slopes = [Modes::zeros(), Modes::zeros(), Modes::zeros(), Modes::zeros()];
        for j in 0..4 {
            let mut shift = Modes::zeros();
            shift[j] = PROBE;
            let (up, down) = (probe(start + shift)?, probe(start - shift)?);
            let column = (up.0 - down.0) / (2.0 * PROBE);
            map.fixed_view_mut::<4, 1>(0, j).copy_from(&column);
            for k in 0..2 {
                slopes[k][j] = (up.1[k] - down.1[k]) / (2.0 * PROBE);
                slopes[2 + k][j] = (up.2[k] - down.2[k]) / (2.0 * PROBE);
            }
        }
        map.fixed_view_mut::<4, 1>(0, 4).copy_from(&(next - start));
        map[(4, 4)] = 1.0;
        let mut held = Held {
            sides,
            pulls: lambda.iter().any(|&value| value > 0.0),
            start,
            powers: vec![map],
            multipliers: [(lambda[0], slopes[0]), (lambda[1], slopes[1])],
            turn,
            farthest: 0.0,
        };
        while held.powers.len() <= super::oscillator::LARGEST_BLOCK {
            let last = held.powers[held.powers.len() - 1];
            held.powers.push(last * last);
        }
        let values = [lambda[0], lambda[1], gaps[0], gaps[1]];
        held.farthest = self.farthest_if_kept(&held, values, slopes)?;
        Some(held)
    }

    /// How far the blades can swing, if multipliers and predicted gaps never
    /// come near a change of sign: neither at the end of the transient nor by
    /// the swing on the way there.
    fn farthest_if_kept(&self, held: &Held, values: [f64; 4], slopes: [Modes; 4]) -> Option<f64> {
        let step = held.powers[0];
        let drift = step.fixed_view::<4, 1>(0, 4).into_owned();
        let map = step.fixed_view::<4, 4>(0, 0).into_owned();
        let rest = if self.blades.is_rigid() {
            Modes::zeros()
        } else {
            (SMatrix::<f64, 4, 4>::identity() - map).lu().solve(&drift)?
        };
        let (angle, increment) = self.blades.swing(as_coordinates(-rest));
        let end = held.start + rest;
        let farthest = end[0].hypot(end[1]) + angle;
        if self.machine.nodal_diameters * farthest > LARGEST_PHASE {
            return None;
        }
        let unilateral = self.law == ContactLaw::Unilateral;
        let kept = (0..4).all(|k| {
            let end = values[k] + slopes[k].dot(&rest);
            let swing = angle * (slopes[k][0].hypot(slopes[k][1]))
                + increment * (slopes[k][2].hypot(slopes[k][3]));
            let sign_fits = if k < 2 { !unilateral || end < 0.0 } else { end < 0.0 };
            sign_fits && end.is_finite() && swing < ROOM * end.abs() && values[k] * end > 0.0
        });
        kept.then_some(farthest)
    }

    /// One real step from these blade modes, with the casing in the corner they
    /// make: the modes after it, the multipliers, and the predicted gaps.
    fn probe(
        &self,
        sides: [u32; 2],
        turn: f64,
        modes: Modes,
    ) -> Option<(Modes, [f64; 2], [f64; 2])> {
        let mut trial = self.clone();
        let (u, blades) = self.in_corner(sides, turn, modes, self.n);
        trial.u = u;
        trial.blades = blades;
        trial.take_step().ok()?;
        let row = |side: u32| trial.rows.iter().find(|row| row.side == side);
        let (a, b) = (row(sides[0])?, row(sides[1])?);
        let next = as_modes(trial.blades.held_modes()?);
        (trial.rows.len() == 2).then_some((next, [a.lambda, b.lambda], [a.gap, b.gap]))
    }

    /// Coordinates at step `n` of a casing held in the corner of these modes.
    fn in_corner(&self, sides: [u32; 2], turn: f64, modes: Modes, n: u64) -> ([Coordinate; 2], B) {
        let mut blades = self.blades.clone();
        blades.set_held_modes(as_coordinates(modes));
        let before = [modes[0] - modes[2], modes[1] - modes[3]];
        let rim = &self.machine.rim;
        let diameters = self.machine.nodal_diameters;
        let angles = |modes: [f64; 2]| sides.map(|side| diameters * blades.held_angle(side, modes));
        let now = corner(rim, sides, angles([modes[0], modes[1]]));
        let then = corner(rim, sides, angles(before));
        // z[n] - z[n-1] exp(-i nu h), with its small parts kept apart.
        let (sin, half) = (turn.sin(), (0.5 * turn).sin());
        let versine = 2.0 * half * half;
        let change = (
            now.0 - then.0 + then.0 * versine - then.1 * sin,
            now.1 - then.1 + then.1 * versine + then.0 * sin,
        );
        let mut phasor = self.phasor.clone();
        let (c, s) = phasor.at(n, &self.rotor, diameters, self.step);
        let u = [
            Coordinate { x: now.0 * c - now.1 * s, increment: change.0 * c - change.1 * s },
            Coordinate { x: now.0 * s + now.1 * c, increment: change.0 * s + change.1 * c },
        ];
        (u, blades)
    }

    /// Coordinates `steps` steps into the held corner.
    pub(super) fn held_at(&self, held: &Held, steps: u64) -> ([Coordinate; 2], B) {
        self.in_corner(held.sides, held.turn, held.modes(steps), self.n + steps)
    }
}

/// The point where both gaps are zero, blades turned by these phases \[rad\].
fn corner(rim: &Rim, sides: [u32; 2], angles: [f64; 2]) -> (f64, f64) {
    let a = super::correct::turned(rim.direction(sides[0]), angles[0]);
    let b = super::correct::turned(rim.direction(sides[1]), angles[1]);
    let determinant = a.0 * b.1 - a.1 * b.0;
    let scale = -rim.clearance / determinant;
    (scale * (b.1 - a.1), scale * (a.0 - b.0))
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
