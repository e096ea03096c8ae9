//! Equations of the lock (docs/theory.md, section 8): two neighbouring phase groups hold the casing
//! wave in a corner of the polygon, in the blade frame.
//!
//! Lengths are in units of `g0`, contact forces in `k_c g0`. With `z = x + i y`, the direction
//! `b_i = psi_i + n_d alpha_i` of a group and `A_i = n_d Im[z exp(-i b_i)]`:
//!
//! - rows 1-2, closed gaps: `1 + Re[z exp(-i b_i)] - kappa l_b alpha_i = 0`
//! - rows 3-4, casing: `(stiffness + i drag) z = (1 + i mu_c) sum P_i exp(i b_i)`
//! - rows 5-6, blades: `alpha_i = sum_j share_ij P_j (A_j - (kappa + mu) l_b)`
//!
//! These are the eight equations (27) for `u_cc = u_ss = x`, `u_sc = -u_cs = y`: half the
//! differences of their rows 5-8 give a zero backward wave, half their sums are rows 3-4. The forms
//! `printed` and `blade` expand `exp(i b_i)` to first order, Eq. (26), and differ in `share`.
//! Inclined or rubbing tips (section 10) are available in the form `modal` only.
//!
//! Far from the solution Newton's method is unreliable: it can fail, or converge to another branch,
//! at one speed and not at the next. A result is therefore accepted only if the steps are small and
//! shrink. The forms `printed` and `blade` are continued from rigid to soft blades, up to the fold of
//! that branch. The form `modal` starts from a closed form.

use nalgebra::{Complex, SMatrix, SVector};
use serde::Serialize;
use strum::{AsRefStr, Display, EnumString, VariantNames};

use super::Corner;
use super::corner::Configuration;
use super::corner_angle::CornerAngle;
use crate::model::Machine;

/// Largest number of Newton steps from one start; five are usual.
pub(super) const NEWTON_STEPS: usize = 40;

/// Each Newton step must shrink at least by this factor. Near a fold of the branch steps shrink by
/// half; with a larger factor a start could converge to another branch.
const NEWTON_SHRINK: f64 = 0.75;

/// Largest Newton step, relative to the unknowns, and largest change of a group's direction in it
/// \[rad\]: only in the directions are the equations not bilinear.
const NEWTON_LARGEST: f64 = 0.1;

/// Allowed ratio of the determinants of the Jacobian at successive softnesses: the determinant
/// vanishes at a fold, and jumps on the way to another branch.
const NEWTON_ALIKE: std::ops::Range<f64> = 0.5..2.0;

/// Smallest increment of the softness, as a part of its final value.
const NEWTON_STRIDE: f64 = 1e-6;

/// Largest number of increments of the softness.
const NEWTON_STRIDES: usize = 500;

/// Residual, relative to the magnitude of the equations, that is accepted when the Newton steps no
/// longer shrink.
const POLISHED: f64 = 1e-11;

/// Scaled unknowns `[x, y, P_a, P_b, alpha_a, alpha_b]`.
pub(super) type Unknowns = [f64; 6];

/// Casing impedance at one speed: `stiffness = 1 - (nu/omega_c)^2` and
/// `drag = 2 zeta_c nu/omega_c`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Wave {
    pub stiffness: f64,
    pub drag: f64,
}

impl Wave {
    /// Creates the casing impedance at a rotor speed \[rad/s\], with or without damping.
    pub fn at(machine: &Machine, speed: f64, damped: bool) -> Self {
        let ratio = machine.nu(speed) / machine.omega_c;
        let damping = if damped { machine.casing_damping_ratio } else { 0.0 };
        // The factored difference avoids cancellation near the critical speed.
        Self { stiffness: (1.0 - ratio) * (1.0 + ratio), drag: damping * 2.0 * ratio }
    }
}

/// Units that make the equations dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scales {
    /// Length, `g0` \[m\].
    pub length: f64,
    /// Force, `k_c g0` \[N\].
    pub force: f64,
    /// Blade angle, `n_d k_c g0^2/(m_b omega_bd^2)` \[rad\].
    pub angle: f64,
    /// Softness of the blades, `n_d` times `angle`.
    pub softness: f64,
    /// Response of the blade modes to a torque on one blade: `2/N`, or `1/N` if there is only one
    /// mode.
    pub share: f64,
}

impl Scales {
    /// Creates the units of a machine.
    pub fn new(machine: &Machine) -> Self {
        let length = machine.clearance();
        let force = machine.casing_stiffness * length;
        let stiffness = machine.blade_inertia * machine.omega_bd * machine.omega_bd;
        let angle = force * machine.nodal_diameters * length / stiffness;
        let modes = if machine.has_sine_mode { 2.0 } else { 1.0 };
        let share = modes / f64::from(machine.polygon.blades);
        Self { length, force, angle, softness: angle * machine.nodal_diameters, share }
    }
}

/// The six equations of one corner at one speed, in one form.
#[derive(Clone, Debug)]
pub(super) struct Equations {
    /// Half the phase difference of both groups \[rad\].
    delta: f64,
    /// Directions `(cos psi, sin psi)` of both sides.
    phases: [(f64, f64); 2],
    /// Apothems of both sides, in units of `g0`.
    apothems: [f64; 2],
    form: Form,
    wave: Wave,
    /// Friction on the casing mode, `mu_c`.
    friction: f64,
    /// Scaled slope of the tip path, `kappa l_b/(n_d g0)`.
    slope: f64,
    /// Scaled lever of the contact force, `(kappa + mu) l_b/(n_d g0)`.
    lever: f64,
    /// Unit of blade angles \[rad\].
    pub angle: f64,
    /// Phase angle `n_d alpha` \[rad\] at a scaled blade angle of 1; 0 for rigid blades.
    pub softness: f64,
    /// Response of both scaled blade angles (rows) to the scaled torques `P (A/n_d - lever)` of
    /// both groups (columns).
    share: [[f64; 2]; 2],
}

/// A group in contact: its direction `(cos b, sin b)`, and real and imaginary part of
/// `z exp(-i b)`.
struct Touch {
    direction: (f64, f64),
    along: f64,
    across: f64,
}

impl Equations {
    /// Creates the equations of a machine at a rotor speed \[rad/s\] with the casing impedance
    /// `wave`.
    pub fn new(machine: &Machine, corner: Corner, form: Form, wave: Wave, speed: f64) -> Self {
        let polygon = &machine.polygon;
        let scales = Scales::new(machine);
        let reach = machine.blade_length / (machine.clearance() * machine.nodal_diameters);
        let lever = (machine.radial_coupling + machine.friction_at(speed)) * reach;
        let each = 1.0 / f64::from(polygon.blades_per_side);
        let apart = (corner.b + polygon.sides - corner.a) % polygon.sides;
        let delta = polygon.delta * f64::from(apart);
        let [own, other] = match form {
            // Rows 1-2 of (27) as printed have -2 times the torque of (19).
            Form::Printed => [-2.0 * each, 0.0],
            Form::Blade => [each, 0.0],
            Form::Modal => [scales.share, scales.share * (2.0 * delta).cos()],
        };
        let apothem = |side| machine.apothem(side) / machine.clearance();
        let equal = !machine.has_unequal_tips();
        // Keeps scaled angles of order one if the torque of the tips dominates.
        let unit = lever.abs() + 1.0;
        let [own, other] = [own, other].map(|share| unit.recip() * share);
        Self {
            delta,
            apothems: corner.sides().map(|side| if equal { 1.0 } else { apothem(side) }),
            phases: corner.sides().map(|side| polygon.direction(side)),
            form,
            wave,
            friction: machine.casing_friction_at(speed),
            slope: machine.radial_coupling * reach,
            lever,
            angle: scales.angle * unit,
            softness: scales.softness * unit,
            share: [[own, other], [other, own]],
        }
    }

    /// Returns the geometry of group `i` of the corner.
    fn touch(&self, i: usize, unknowns: &Unknowns) -> Touch {
        let [x, y, ..] = *unknowns;
        let (c, s) = self.phases[i];
        let turn = self.softness * unknowns[4 + i];
        let (sin, cos) = match self.form {
            Form::Modal => turn.sin_cos(),
            Form::Printed | Form::Blade => (turn, 1.0),
        };
        let direction = (cos * c - sin * s, cos * s + sin * c);
        let along = x * direction.0 + y * direction.1;
        Touch { direction, along, across: y * direction.0 - x * direction.1 }
    }

    /// Returns the residuals of the six equations.
    pub fn residual(&self, unknowns: &Unknowns) -> Unknowns {
        let [x, y, push_a, push_b, alpha_a, alpha_b] = *unknowns;
        let Wave { stiffness, drag } = self.wave;
        let mut casing = [stiffness * x - drag * y, stiffness * y + drag * x];
        let mut gaps = [0.0; 2];
        let mut blades = [alpha_a, alpha_b];
        for (i, (push, alpha)) in [(push_a, alpha_a), (push_b, alpha_b)].into_iter().enumerate() {
            let touch = self.touch(i, unknowns);
            let (c, s) = touch.direction;
            gaps[i] = touch.along + self.apothems[i] - self.slope * self.softness * alpha;
            casing[0] -= push * (c - self.friction * s);
            casing[1] -= push * (s + self.friction * c);
            let torque = push * (touch.across - self.lever);
            for (row, share) in blades.iter_mut().zip(self.share) {
                *row -= share[i] * torque;
            }
        }
        [gaps[0], gaps[1], casing[0], casing[1], blades[0], blades[1]]
    }

    /// Returns the scaled modal coordinates `(alpha_c, alpha_s)` of the blades, Eq. (20).
    pub fn blade_modes(&self, [.., a, b]: &Unknowns) -> [f64; 2] {
        let [(c_a, s_a), (c_b, s_b)] = self.phases;
        let sine = c_a * s_b - s_a * c_b;
        [(*a * s_b - *b * s_a) / sine, (*b * c_a - *a * c_b) / sine]
    }

    /// Returns the torque of the rotor in units of `n_d k_c g0^2`: `drag |z|^2`, minus the
    /// contribution of tangential forces on the casing.
    pub fn torque(&self, unknowns: &Unknowns) -> f64 {
        let [x, y, push_a, push_b, ..] = *unknowns;
        let along = push_a * self.touch(0, unknowns).along + push_b * self.touch(1, unknowns).along;
        self.wave.drag * (x * x + y * y) - self.friction * along
    }

    /// Returns the displacements of casing and blades.
    pub fn configuration(&self, unknowns: &Unknowns) -> Configuration {
        let [x, y, ..] = *unknowns;
        let [turn_c, turn_s] = self.blade_modes(unknowns).map(|alpha| self.softness * alpha);
        Configuration { z: (x, y), turn: (turn_c, turn_s), slope: self.slope }
    }

    /// Returns the derivatives of the residuals (rows) with respect to the unknowns (columns).
    fn jacobian(&self, unknowns: &Unknowns) -> SMatrix<f64, 6, 6> {
        let [x, y, ..] = *unknowns;
        let Wave { stiffness, drag } = self.wave;
        let mut jacobian = SMatrix::zeros();
        (jacobian[(2, 0)], jacobian[(2, 1)]) = (stiffness, -drag);
        (jacobian[(3, 0)], jacobian[(3, 1)]) = (drag, stiffness);
        for i in 0..2 {
            let (push, of_push, of_alpha) = (unknowns[2 + i], 2 + i, 4 + i);
            let Touch { direction: (c, s), across, .. } = self.touch(i, unknowns);
            // Derivative of the direction with respect to the scaled blade angle.
            let (c_turned, s_turned) = match self.form {
                Form::Modal => (-s * self.softness, c * self.softness),
                Form::Printed | Form::Blade => {
                    let (c, s) = self.phases[i];
                    (-s * self.softness, c * self.softness)
                }
            };
            (jacobian[(i, 0)], jacobian[(i, 1)]) = (c, s);
            jacobian[(i, of_alpha)] = x * c_turned + y * s_turned - self.slope * self.softness;
            jacobian[(2, of_push)] = self.friction * s - c;
            jacobian[(3, of_push)] = -self.friction * c - s;
            jacobian[(2, of_alpha)] = push * (self.friction * s_turned - c_turned);
            jacobian[(3, of_alpha)] = push * (-self.friction * c_turned - s_turned);
            jacobian[(of_alpha, of_alpha)] += 1.0;
            for (row, share) in (4..).zip(self.share) {
                let load = share[i] * push;
                jacobian[(row, 0)] += load * s;
                jacobian[(row, 1)] -= load * c;
                jacobian[(row, of_push)] -= share[i] * (across - self.lever);
                jacobian[(row, of_alpha)] -= load * (y * c_turned - x * s_turned);
            }
        }
        jacobian
    }

    /// Returns whether the tips have neither slope nor friction.
    fn has_paper_tips(&self) -> bool {
        self.slope == 0.0 && self.lever == 0.0 && self.friction == 0.0
    }

    /// Returns the locked solution on the branch that starts at rigid blades; `None` if the branch
    /// folds back before this softness, or if the equations are singular.
    pub fn locked(&self) -> Option<Unknowns> {
        let paper = self.has_paper_tips() && self.apothems == [1.0; 2];
        let start = match self.form {
            _ if !paper => self.linearised()?,
            Form::Modal => {
                let angle = CornerAngle::new(self.delta, self.softness * self.share[0][0]);
                self.opened(angle.at(self.wave.stiffness)?)
            }
            Form::Printed | Form::Blade => self.opened(0.0),
        };
        if self.form == Form::Modal {
            return self.newton(start, if paper { NEWTON_LARGEST } else { f64::INFINITY });
        }
        let slope = |softer: &Self, at: &Unknowns| softer.jacobian(at).determinant();
        let softened = |part: f64| Self { softness: part * self.softness, ..self.clone() };
        let (mut part, mut stride, mut here) = (0.0, 1.0, start);
        let mut last = slope(&softened(part), &here);
        for _ in 0..NEWTON_STRIDES {
            let next = f64::min(part + stride, 1.0);
            let softer = softened(next);
            let found = softer.newton(here, NEWTON_LARGEST);
            let found = found.map(|found| (found, slope(&softer, &found)));
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

    /// Returns the closed form for the paper's tips with each side turned by `-+angle_change`
    /// \[rad\].
    fn opened(&self, angle_change: f64) -> Unknowns {
        let [(c_a, s_a), (c_b, s_b)] = self.phases;
        let (c, s) = (c_a + c_b, s_a + s_b);
        let (sin, cos) = (self.delta + angle_change).sin_cos();
        let (stiff, drag) = (self.wave.stiffness / cos, self.wave.drag / sin);
        let pushes = [(drag - stiff) / (2.0 * cos), -(stiff + drag) / (2.0 * cos)];
        let torques = [-pushes[0] * sin / cos, pushes[1] * sin / cos];
        let alpha = self.share.map(|share| share[0] * torques[0] + share[1] * torques[1]);
        // The expansion (26) is of first order; it is used for small turns only.
        let (sin_middle, cos_middle) = (0.5 * self.softness * (alpha[0] + alpha[1])).sin_cos();
        let size = -1.0 / (c.hypot(s) * cos);
        let x = size * (c * cos_middle - s * sin_middle);
        let y = size * (s * cos_middle + c * sin_middle);
        [x, y, pushes[0], pushes[1], alpha[0], alpha[1]]
    }

    /// Returns the closed form for linearised gaps, with blades bent by slope and friction of the
    /// tips only; `None` if the equations are singular.
    fn linearised(&self) -> Option<Unknowns> {
        let [(c_a, s_a), (c_b, s_b)] = self.phases;
        let middle = Complex::new(c_a + c_b, s_a + s_b);
        // Relative displacement w, the corner of the polygon; |middle| = 2 cos(delta).
        let mut w = middle * (-2.0 / middle.norm_sqr());
        if self.apothems != [1.0; 2] {
            let ([a, b], sine) = (self.apothems, c_a * s_b - s_a * c_b);
            w = Complex::new(b * s_a - a * s_b, a * c_b - b * c_a) / sine;
        }
        let turned = Complex::new(1.0, self.friction);
        let casing = Complex::new(self.wave.stiffness, self.wave.drag);
        // Blade angle a = -bent p, in units of `angle`.
        let bent = self.lever * self.share[0][0];
        let joined = turned + casing * (self.slope * self.softness * bent);
        let (z, p) = (w * turned / joined, w * casing / joined);
        // Contact forces from p = P_a exp(i psi_a) + P_b exp(i psi_b).
        let sine = c_a * s_b - s_a * c_b;
        let push_a = (p.re * s_b - p.im * c_b) / sine;
        let push_b = (p.im * c_a - p.re * s_a) / sine;
        let alpha = self.phases.map(|(c, s)| -bent * (p.re * c + p.im * s));
        let start = [z.re, z.im, push_a, push_b, alpha[0], alpha[1]];
        start.iter().all(|value| value.is_finite()).then_some(start)
    }

    /// Solves the equations by Newton's method. It stops early if the first step exceeds about the
    /// fraction `largest` of the unknowns, if a step turns a group by more than `largest` \[rad\]
    /// or if steps do not shrink; `None` if the residual is not small then.
    fn newton(&self, start: Unknowns, largest: f64) -> Option<Unknowns> {
        // The rows are of order one, so the attainable residual is a few units in the last place of
        // the largest term.
        let size = 1.0 + self.wave.stiffness.abs() + self.wave.drag.abs();
        let residual = |at: &SVector<f64, 6>| SVector::from(self.residual(&(*at).into()));
        let mut unknowns = SVector::from(start);
        let mut last = largest * unknowns.amax() / NEWTON_SHRINK;
        for _ in 0..NEWTON_STEPS {
            let left = residual(&unknowns);
            if !left.amax().is_finite() {
                return None;
            }
            if left.amax() <= 4.0 * f64::EPSILON * size {
                return Some(unknowns.into());
            }
            let step = self.jacobian(&unknowns.into()).lu().solve(&left)?;
            let length = step.amax();
            let turn = self.softness * step[4].abs().max(step[5].abs());
            if length > NEWTON_SHRINK * last || turn > largest {
                break;
            }
            unknowns -= step;
            if length <= 4.0 * f64::EPSILON * unknowns.amax() {
                return Some(unknowns.into());
            }
            last = length;
        }
        // Ill-conditioned near a fold: accept a residual that is small enough.
        (residual(&unknowns).amax() <= POLISHED * size).then(|| unknowns.into())
    }
}

/// Form of the equations for the blade angles. It hardly affects casing amplitude and multipliers,
/// but it changes the blade angles.
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
    /// Eq. (27) as printed: its first two rows have -2 times the contact torque of Eq. (19).
    /// Expansion (26).
    Printed,
    /// Eq. (19) with the neighbours eliminated by (20): every contacting blade acts on its own
    /// spring `m_b omega_bd^2`. Expansion (26).
    Blade,
    /// Two blade modes as in the time domain, exact in the blade angle.
    #[default]
    Modal,
}

impl Form {
    /// All forms, in the order of the documentation.
    pub const ALL: [Self; 3] = [Self::Printed, Self::Blade, Self::Modal];
}
