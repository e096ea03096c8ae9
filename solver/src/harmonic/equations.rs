//! The harmonic balance equations of a corner, Eq. (27), in three forms, their Jacobian and
//! their solution by Newton's method, in numbers of order one (docs/theory.md, section 8).
//!
//! Lengths are counted in `g0`, multipliers in `k_c g0` and blade angles in
//! `n_d k_c g0^2/(m_b omega_bd^2)`, so that `n_d alpha = softness * alpha~`.
//! With `x = (u_cc + u_ss)/2`, `y = (u_sc - u_cs)/2`, that is `z = x + i y`, and
//! `(C, S)` the direction of a contact, Eq. (27) reads
//!
//! - rows 1-2: `alpha_i + sum_j share_ij Lambda_j (y C_j - x S_j) = 0`
//! - rows 3-4: `1 + x C_i + y S_i = 0`
//! - rows 5, 8: `stiffness u_cc + drag u_cs + sum Lambda C = 0`, the same for `u_ss, -u_sc`
//! - rows 6, 7: `stiffness u_cs - drag u_cc - sum Lambda S = 0`, the same for `-u_sc, u_ss`
//!
//! Half the differences of rows 5-8 give a zero backward wave, `u_cc - u_ss`
//! and `u_cs + u_sc`; half their sums are one complex equation for `z`. So the
//! eight equations reduce to six, which Newton's method solves; the reported
//! residual is that of all eight.
//!
//! Far from the solution Newton's method is unreliable: it may miss the solution or
//! find another branch, at one speed and not at the next. So a start is accepted
//! only if its steps are small and shrink. If not, because blades are soft, the
//! solution is followed from rigid to soft blades; it ends where that branch folds.

use nalgebra::{SMatrix, SVector};
use serde::Serialize;
use strum::{AsRefStr, Display, EnumString, VariantNames};

use super::Corner;
use super::corner_angle::CornerAngle;
use crate::model::{Machine, Number};
use crate::tolerances::{
    NEWTON_ALIKE, NEWTON_LARGEST, NEWTON_SHRINK, NEWTON_STEPS, NEWTON_STRIDE, NEWTON_STRIDES,
    POLISHED,
};

/// `[x, y, Lambda_a, Lambda_b, alpha_a, alpha_b]`, scaled.
pub(super) type Unknowns = SVector<f64, 6>;
type Jacobian = SMatrix<f64, 6, 6>;

/// The casing at one speed: `stiffness = 1 - (nu/omega_c)^2` and
/// `drag = 2 zeta_c nu/omega_c`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wave<T = f64> {
    pub stiffness: T,
    pub drag: T,
}

impl<T: Number> Wave<T> {
    /// At rotor speed `speed` \[rad/s\], with or without the casing's damping.
    pub fn at(machine: &Machine<T>, speed: T, damped: bool) -> Self {
        let ratio = machine.nu(speed) / machine.omega_c;
        let damping = if damped { machine.casing_damping_ratio } else { T::zero() };
        // The factored difference keeps its digits near the critical speed.
        Self { stiffness: (-ratio + 1.0) * (ratio + 1.0), drag: damping * 2.0 * ratio }
    }
}

/// Units that make the equations dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scales<T = f64> {
    /// `g0` \[m\].
    pub length: T,
    /// `k_c g0` \[N\].
    pub force: T,
    /// `n_d k_c g0^2/(m_b omega_bd^2)` \[rad\].
    pub angle: T,
    /// `n_d` times `angle`.
    pub softness: T,
    /// Response of the blade modes to a torque on one blade: `2/N`, or `1/N` if
    /// there is only one mode.
    pub share: f64,
}

impl<T: Number> Scales<T> {
    pub fn of(machine: &Machine<T>) -> Self {
        let length = machine.clearance();
        let force = machine.casing_stiffness * length;
        let stiffness = machine.blade_inertia * machine.omega_bd * machine.omega_bd;
        let angle = force * machine.nodal_diameters * length / stiffness;
        let modes = if machine.has_sine_mode { 2.0 } else { 1.0 };
        let share = modes / f64::from(machine.polygon.blades);
        Self { length, force, angle, softness: angle * machine.nodal_diameters, share }
    }
}

/// Eq. (27) for one corner and one form.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Equations {
    /// `(cos psi, sin psi)` of both sides.
    phases: [(f64, f64); 2],
    softness: f64,
    share: [[f64; 2]; 2],
    /// Whether the direction of a contact is exact in the blade angle, or
    /// expanded to first order, Eq. (26).
    corner_angle: Option<CornerAngle>,
}

/// A contact at these blade angles: direction, its derivative by the scaled
/// angle, and the moment arm `y C - x S`.
struct Lever {
    cos: f64,
    sin: f64,
    cos_slope: f64,
    sin_slope: f64,
    arm: f64,
    arm_slope: f64,
}

impl Equations {
    pub fn new(machine: &Machine, corner: Corner, form: Form) -> Self {
        let polygon = &machine.polygon;
        let each = 1.0 / f64::from(polygon.blades_per_side);
        let share = match form {
            // Rows 1-2 as printed carry -2 times the torque that (19) has.
            Form::Printed => [[-2.0 * each, 0.0], [0.0, -2.0 * each]],
            Form::Blade => [[each, 0.0], [0.0, each]],
            Form::Modal => {
                let own = Scales::of(machine).share;
                let other = own * (2.0 * polygon.delta).cos();
                [[own, other], [other, own]]
            }
        };
        Self {
            phases: corner.sides().map(|side| polygon.direction(side)),
            softness: Scales::of(machine).softness,
            share,
            corner_angle: (form == Form::Modal).then(|| CornerAngle::of(machine)),
        }
    }

    pub fn softness(&self) -> f64 {
        self.softness
    }

    /// The same corner with this part of the softness of the blades.
    pub fn stiffened(&self, part: f64) -> Self {
        Self { softness: part * self.softness, ..self.clone() }
    }

    /// Whether the predicted start is the solution itself.
    pub fn is_exact(&self) -> bool {
        self.corner_angle.is_some()
    }

    /// The start of Newton's method: for the exact form the closed form of the
    /// corner with its bent blades, for the others that of rigid blades. `None`
    /// if the exact branch has folded back.
    pub fn predict(&self, wave: Wave) -> Option<Unknowns> {
        match self.corner_angle {
            None => Some(self.opened(wave, 0.0)),
            Some(corner_angle) => Some(self.opened(wave, corner_angle.at(wave.stiffness)?)),
        }
    }

    /// The closed form with each side turned by `-+change of the corner angle`
    /// \[rad\]: moment arms, multipliers, blade angles, and `z`.
    pub fn opened(&self, wave: Wave, angle_change: f64) -> Unknowns {
        let [(c_a, s_a), (c_b, s_b)] = self.phases;
        // c_a + c_b = 2 cos(delta) cos(middle phase), and so for the sines.
        let (c, s) = (c_a + c_b, s_a + s_b);
        let twice_cos = c.hypot(s);
        let half = (0.5 * (c_a * s_b - s_a * c_b) / (0.5 * twice_cos)).atan2(0.5 * twice_cos);
        let (sin, cos) = (half + angle_change).sin_cos();
        let tangent = sin / cos;
        let (stiff, drag) = (wave.stiffness / cos, wave.drag / sin);
        let multipliers = [(stiff - drag) / (2.0 * cos), (stiff + drag) / (2.0 * cos)];
        let torque = [-multipliers[0] * tangent, multipliers[1] * tangent];
        let alpha = self.share.map(|[to_a, to_b]| -(to_a * torque[0] + to_b * torque[1]));
        // The expansion (26) is of first order, which is enough for such small turns.
        let middle = 0.5 * self.softness * (alpha[0] + alpha[1]);
        let (sin_middle, cos_middle) = middle.sin_cos();
        let size = -1.0 / (twice_cos * cos);
        let x = size * (c * cos_middle - s * sin_middle);
        let y = size * (s * cos_middle + c * sin_middle);
        Unknowns::from([x, y, multipliers[0], multipliers[1], alpha[0], alpha[1]])
    }

    fn moment_arm(&self, side: usize, unknowns: &Unknowns) -> Lever {
        let (c, s) = self.phases[side];
        let turn = self.softness * unknowns[4 + side];
        let (x, y) = (unknowns[0], unknowns[1]);
        let (cos, sin, (cos_slope, sin_slope)) = if self.corner_angle.is_some() {
            let (sin_turn, cos_turn) = turn.sin_cos();
            let (cos, sin) = (c * cos_turn - s * sin_turn, s * cos_turn + c * sin_turn);
            (cos, sin, (-sin, cos))
        } else {
            (c - s * turn, s + c * turn, (-s, c))
        };
        let (cos_slope, sin_slope) = (self.softness * cos_slope, self.softness * sin_slope);
        Lever {
            cos,
            sin,
            cos_slope,
            sin_slope,
            arm: y * cos - x * sin,
            arm_slope: y * cos_slope - x * sin_slope,
        }
    }

    /// The six equations (rows 1-2, 3-4, and the half sums of rows 5-8).
    pub fn residual(&self, wave: Wave, unknowns: &Unknowns) -> Unknowns {
        let moment_arms = [self.moment_arm(0, unknowns), self.moment_arm(1, unknowns)];
        self.rows(wave, unknowns, &moment_arms)
    }

    fn rows(&self, wave: Wave, u: &Unknowns, moment_arms: &[Lever; 2]) -> Unknowns {
        let [a, b] = moment_arms;
        let torque = [u[2] * a.arm, u[3] * b.arm];
        Unknowns::from([
            u[4] + self.share[0][0] * torque[0] + self.share[0][1] * torque[1],
            u[5] + self.share[1][0] * torque[0] + self.share[1][1] * torque[1],
            1.0 + u[0] * a.cos + u[1] * a.sin,
            1.0 + u[0] * b.cos + u[1] * b.sin,
            wave.stiffness * u[0] - wave.drag * u[1] + u[2] * a.cos + u[3] * b.cos,
            wave.stiffness * u[1] + wave.drag * u[0] + u[2] * a.sin + u[3] * b.sin,
        ])
    }

    /// Residual and Jacobian together.
    pub fn linearised(&self, wave: Wave, u: &Unknowns) -> (Unknowns, Jacobian) {
        let moment_arms = [self.moment_arm(0, u), self.moment_arm(1, u)];
        let residual = self.rows(wave, u, &moment_arms);
        let mut jacobian = Jacobian::zeros();
        jacobian[(4, 0)] = wave.stiffness;
        jacobian[(4, 1)] = -wave.drag;
        jacobian[(5, 0)] = wave.drag;
        jacobian[(5, 1)] = wave.stiffness;
        for (j, moment_arm) in moment_arms.iter().enumerate() {
            let multiplier = u[2 + j];
            for i in 0..2 {
                let share = self.share[i][j];
                jacobian[(i, 0)] -= share * multiplier * moment_arm.sin;
                jacobian[(i, 1)] += share * multiplier * moment_arm.cos;
                jacobian[(i, 2 + j)] = share * moment_arm.arm;
                jacobian[(i, 4 + j)] =
                    share * multiplier * moment_arm.arm_slope + f64::from(u8::from(i == j));
            }
            jacobian[(2 + j, 0)] = moment_arm.cos;
            jacobian[(2 + j, 1)] = moment_arm.sin;
            jacobian[(2 + j, 4 + j)] = u[0] * moment_arm.cos_slope + u[1] * moment_arm.sin_slope;
            jacobian[(4, 2 + j)] = moment_arm.cos;
            jacobian[(5, 2 + j)] = moment_arm.sin;
            jacobian[(4, 4 + j)] = multiplier * moment_arm.cos_slope;
            jacobian[(5, 4 + j)] = multiplier * moment_arm.sin_slope;
        }
        (residual, jacobian)
    }

    /// Largest of the eight rows of Eq. (27) as they are printed, for the eight
    /// unknowns `u_cc = u_ss = x`, `u_sc = -u_cs = y`.
    pub fn printed_residual(&self, wave: Wave, u: &Unknowns) -> f64 {
        let [a, b] = [self.moment_arm(0, u), self.moment_arm(1, u)];
        let six = self.rows(wave, u, &[a, b]);
        let (u_cc, u_cs, u_sc, u_ss) = (u[0], -u[1], u[1], u[0]);
        let push_cos = six[4] - (wave.stiffness * u[0] - wave.drag * u[1]);
        let push_sin = six[5] - (wave.stiffness * u[1] + wave.drag * u[0]);
        let rows = [
            six[0],
            six[1],
            six[2],
            six[3],
            wave.stiffness * u_cc + wave.drag * u_cs + push_cos,
            wave.stiffness * u_cs - wave.drag * u_cc - push_sin,
            wave.stiffness * u_sc + wave.drag * u_ss + push_sin,
            wave.stiffness * u_ss - wave.drag * u_sc + push_cos,
        ];
        rows.iter().fold(0.0, |largest, row| row.abs().max(largest))
    }
}

impl Equations {
    /// The corner that rigid blades grow into as they soften; `None` if it
    /// folds before they are this soft.
    pub fn locked(&self, wave: Wave) -> Option<Unknowns> {
        let start = self.predict(wave)?;
        if self.is_exact() {
            return self.solve(wave, start);
        }
        let slope =
            |equations: &Self, at: &Unknowns| equations.linearised(wave, at).1.determinant();
        let (mut part, mut stride, mut here) = (0.0, 1.0, start);
        let mut last = slope(&self.stiffened(part), &here);
        for _ in 0..NEWTON_STRIDES {
            let next = f64::min(part + stride, 1.0);
            let softer = self.stiffened(next);
            let found = softer.solve(wave, here).map(|found| (found, slope(&softer, &found)));
            match found.filter(|(_, slope)| NEWTON_ALIKE.contains(&(slope / last))) {
                Some((found, _)) if next == 1.0 => return Some(found),
                Some((found, slope)) => {
                    (part, stride, here, last) = (next, 2.0 * stride, found, slope);
                }
                None if stride < NEWTON_STRIDE => return None,
                None => stride *= 0.5,
            }
        }
        None
    }

    /// Newton's method from `start`; `None` where its steps are large or do not
    /// shrink.
    fn solve(&self, wave: Wave, start: Unknowns) -> Option<Unknowns> {
        // Rows are of order one, so rounding leaves a residual of a few units
        // in the last place of the largest term.
        let size = 1.0 + wave.stiffness.abs() + wave.drag.abs();
        let mut unknowns = start;
        let mut last = NEWTON_LARGEST * unknowns.amax() / NEWTON_SHRINK;
        for _ in 0..NEWTON_STEPS {
            let (residual, jacobian) = self.linearised(wave, &unknowns);
            let norm = residual.amax();
            if !norm.is_finite() {
                return None;
            }
            if norm <= 4.0 * f64::EPSILON * size {
                return Some(unknowns);
            }
            let step = jacobian.lu().solve(&residual)?;
            let length = step.amax();
            let turn = self.softness() * step[4].abs().max(step[5].abs());
            if length > NEWTON_SHRINK * last || turn > NEWTON_LARGEST {
                break;
            }
            unknowns -= step;
            if length <= 4.0 * f64::EPSILON * unknowns.amax() {
                return Some(unknowns);
            }
            last = length;
        }
        // Ill-conditioned, close to a fold: accept what is accurate enough.
        (self.residual(wave, &unknowns).amax() <= POLISHED * size).then_some(unknowns)
    }
}

/// The equations of the blade angles. Their choice hardly changes casing
/// amplitudes and multipliers, but it changes the blade angles.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Hash,
    Serialize,
    Display,
    EnumString,
    AsRefStr,
    VariantNames,
)]
#[serde(rename_all = "lowercase")]
#[strum(serialize_all = "lowercase")]
pub enum Form {
    /// Eq. (27) as printed: its first two rows have the contact torque of Eq.
    /// (19) times -2. Expansion (26).
    Printed,
    /// From Eq. (19) with the neighbours eliminated by (20): every contacting
    /// blade on its own spring `m_b omega_bd^2`. Expansion (26).
    Blade,
    /// The two blade modes of the time model, exact in the blade angle.
    #[default]
    Modal,
}

impl Form {
    /// Every form, in the order of the documentation.
    pub const ALL: [Self; 3] = [Self::Printed, Self::Blade, Self::Modal];
}
