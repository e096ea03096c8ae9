//! The lock of a machine whose tips are inclined or rub (docs/theory.md, section 10):
//! two neighbouring phase groups hold the casing, and the casing bends all blades, which
//! opens or closes the gap. Exact in the blade angles.
//!
//! Lengths are counted in `g0`, pushes in `k_c g0`. With `b_i = psi_i + n_d alpha_i` and
//! `A_i = n_d Im[z exp(-i b_i)]`:
//!
//! - rows 1-2: `1 + Re[z exp(-i b_i)] - kappa l_b alpha_i = 0`
//! - rows 3-4: `(K + i D) z = (1 + i mu_c) sum P_i exp(i b_i)`
//! - rows 5-6: `k_a a = sum P_i (A_i - (kappa + mu) l_b) exp(i psi_i)`
//!
//! Newton's method from the closed form of the linearised gap.

use nalgebra::{Complex, SMatrix, SVector};
use num_dual::Dual64;

use super::Corner;
use super::stability::ClosedSide;
use crate::model::{Machine, Number};
use crate::tolerances::{NEWTON_SHRINK, NEWTON_STEPS, POLISHED};

/// `[x, y, alpha_c, alpha_s, P_a, P_b]`, scaled.
pub(super) type Held<T = f64> = [T; 6];

/// The equations of one corner at one speed.
#[derive(Clone, Copy, Debug)]
pub(super) struct TipEquations<T = f64> {
    /// `(cos psi, sin psi)` of both sides.
    pub phases: [(f64, f64); 2],
    pub diameters: f64,
    /// `(K, D)` over `k_c`.
    pub casing: (T, T),
    /// `mu_c`.
    pub friction: T,
    /// `kappa l_b/g0`.
    pub slope: T,
    /// `(kappa + mu) l_b/g0`.
    pub lever: T,
    /// Unit of blade angles \[rad\].
    pub angle: T,
    /// `k_c g0^2` over `k_a` and that unit.
    pub share: T,
}

/// A contact at a configuration: direction `(cos, sin)` of `b_i`, `Re` and `Im` of
/// `z exp(-i b_i)`, and the blade angle \[rad\].
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch<T> {
    pub direction: (T, T),
    pub along: T,
    pub across: T,
    pub alpha: T,
}

impl<T: Number> TipEquations<T> {
    /// Of a corner at a rotor speed \[rad/s\].
    pub fn at(machine: &Machine<T>, corner: Corner, speed: T) -> Self {
        let ratio = machine.nu(speed) / machine.omega_c;
        let clearance = machine.clearance();
        let kappa = machine.radial_coupling;
        let slope = kappa * machine.blade_length / clearance;
        let lever = (kappa + machine.friction_at(speed)) * machine.blade_length / clearance;
        let bend = machine.casing_stiffness * clearance * clearance / machine.blade_modal_stiffness;
        let angle = bend * (lever.abs() + machine.nodal_diameters);
        Self {
            phases: corner.sides().map(|side| machine.polygon.direction(side)),
            diameters: machine.nodal_diameters,
            casing: ((-ratio + 1.0) * (ratio + 1.0), machine.casing_damping_ratio * 2.0 * ratio),
            friction: machine.casing_friction_at(speed),
            slope,
            lever,
            angle,
            share: bend / angle,
        }
    }

    /// The same equations with other numbers.
    fn map<S>(&self, number: impl Fn(T) -> S) -> TipEquations<S> {
        TipEquations {
            phases: self.phases,
            diameters: self.diameters,
            casing: (number(self.casing.0), number(self.casing.1)),
            friction: number(self.friction),
            slope: number(self.slope),
            lever: number(self.lever),
            angle: number(self.angle),
            share: number(self.share),
        }
    }

    /// A group at this configuration.
    pub fn touch(&self, phase: (f64, f64), held: &Held<T>) -> Touch<T> {
        let [x, y, alpha_c, alpha_s, ..] = *held;
        let (c, s) = phase;
        let alpha = (alpha_c * c + alpha_s * s) * self.angle;
        let (sin, cos) = (alpha * self.diameters).sin_cos();
        let direction = (cos * c - sin * s, cos * s + sin * c);
        let along = x * direction.0 + y * direction.1;
        let across = y * direction.0 - x * direction.1;
        Touch { direction, along, across, alpha }
    }

    /// Gap of a group over `g0`.
    pub fn gap(&self, phase: (f64, f64), held: &Held<T>) -> T {
        let touch = self.touch(phase, held);
        touch.along + 1.0 - self.slope * touch.alpha
    }

    /// The six rows.
    pub fn residual(&self, held: &Held<T>) -> Held<T> {
        let [x, y, alpha_c, alpha_s, ..] = *held;
        let (stiff, drag) = self.casing;
        let mut rows = [T::zero(); 6];
        rows[2] = stiff * x - drag * y;
        rows[3] = stiff * y + drag * x;
        rows[4] = alpha_c;
        rows[5] = alpha_s;
        for (i, phase) in self.phases.into_iter().enumerate() {
            let touch = self.touch(phase, held);
            let (c, s) = touch.direction;
            let push = held[4 + i];
            rows[i] = touch.along + 1.0 - self.slope * touch.alpha;
            rows[2] -= push * (c - self.friction * s);
            rows[3] -= push * (s + self.friction * c);
            let torque = push * (touch.across * self.diameters - self.lever) * self.share;
            rows[4] -= torque * phase.0;
            rows[5] -= torque * phase.1;
        }
        rows
    }

    /// A solution of the plain numbers with its derivatives: each step of Newton's method
    /// with the plain slope adds an order.
    pub fn derived(&self, plain: &TipEquations, held: &Held) -> Option<Held<T>> {
        let slope = plain.jacobian(held).lu();
        let inverse = slope.try_inverse()?;
        let mut derived = held.map(T::from);
        for _ in 0..2 {
            let residual = self.residual(&derived);
            for (row, value) in derived.iter_mut().enumerate() {
                for (column, left) in residual.iter().enumerate() {
                    *value -= *left * inverse[(row, column)];
                }
            }
        }
        Some(derived)
    }
}

impl TipEquations {
    /// The groups of a lock, as the linearised motion sees them.
    pub fn closed(&self, held: &Held) -> Vec<ClosedSide> {
        let closed = |(phase, push): ((f64, f64), f64)| {
            let touch = self.touch(phase, held);
            ClosedSide {
                phase,
                direction: touch.direction,
                along: touch.along,
                arm: touch.across - self.slope / self.diameters,
                moment: touch.across - self.lever / self.diameters,
                multiplier: -push,
            }
        };
        self.phases.into_iter().zip([held[4], held[5]]).map(closed).collect()
    }

    fn jacobian(&self, held: &Held) -> SMatrix<f64, 6, 6> {
        let lifted = self.map(Dual64::from);
        let mut jacobian = SMatrix::zeros();
        for column in 0..6 {
            let mut seeded = held.map(Dual64::from);
            seeded[column].eps = 1.0;
            for (row, value) in lifted.residual(&seeded).iter().enumerate() {
                jacobian[(row, column)] = value.eps;
            }
        }
        jacobian
    }

    /// The closed form of the linearised gap; `None` where nothing resists.
    fn linearised(&self) -> Option<Held> {
        let [(c_a, s_a), (c_b, s_b)] = self.phases;
        let middle = Complex::new(c_a + c_b, s_a + s_b);
        // `w`, the corner of the polygon; |middle| = 2 cos(delta).
        let w = middle * (-2.0 / middle.norm_sqr());
        let turned = Complex::new(1.0, self.friction);
        let casing = Complex::new(self.casing.0, self.casing.1);
        // a = -bent p in the unit of angles.
        let bent = self.lever * self.share;
        let joined = turned + casing * (self.slope * self.angle * bent);
        let (z, p) = (w * turned / joined, w * casing / joined);
        let a = p * -bent;
        // p = P_a exp(i psi_a) + P_b exp(i psi_b).
        let sine = c_a * s_b - s_a * c_b;
        let push_a = (p.re * s_b - p.im * c_b) / sine;
        let push_b = (p.im * c_a - p.re * s_a) / sine;
        let held = [z.re, z.im, a.re, a.im, push_a, push_b];
        held.iter().all(|value| value.is_finite()).then_some(held)
    }

    /// The lock; `None` where Newton's method does not settle, as with blades that are
    /// so soft that the exact gap has no solution next to the linearised one.
    pub fn solve(&self) -> Option<Held> {
        let mut held = self.linearised()?;
        let mut last = f64::INFINITY;
        for _ in 0..NEWTON_STEPS {
            let residual = SVector::<f64, 6>::from(self.residual(&held));
            let step = self.jacobian(&held).lu().solve(&residual)?;
            let part = |i: usize| step[i].abs() / scale(&held, i);
            let length = (0..6).map(part).fold(0.0, f64::max);
            if !length.is_finite() || (length > NEWTON_SHRINK * last && length > POLISHED) {
                return None;
            }
            for (value, change) in held.iter_mut().zip(step.iter()) {
                *value -= change;
            }
            if length <= 4.0 * f64::EPSILON || (length <= POLISHED && length >= 0.5 * last) {
                return Some(held);
            }
            last = length;
        }
        None
    }
}

/// Size of the unknowns of one kind, which share a scale.
fn scale(held: &Held, i: usize) -> f64 {
    let pair = i & !1;
    held[pair].hypot(held[pair + 1]).max(f64::MIN_POSITIVE)
}

/// The lock of a machine in a corner at a speed \[rad/s\], with its equations, scaled;
/// `None` where there is none.
pub(super) fn held<T: Number>(
    machine: &Machine<T>,
    corner: Corner,
    speed: T,
) -> Option<(TipEquations<T>, Held<T>)> {
    let equations = TipEquations::at(machine, corner, speed);
    let plain = equations.map(|value| value.re());
    let found = plain.solve()?;
    Some((equations, equations.derived(&plain, &found)?))
}
