//! Equilibria in the frame of the blades (docs/theory.md, section 8): casing displacement and blade
//! modes at rest, held by the contact of no side, of one, or of two that form a corner; and the
//! motion about them with the contacts kept.
//!
//! With the rows of `model::frame`, each with its multiplier `Lambda`, the equations are
//!
//! - closed gaps: `h + Re[z exp(-i b)] - kappa l_b alpha = 0`
//! - casing and blades: `K w + sum Lambda f(w) = 0`
//!
//! For a corner these are the eight equations (27) with `u_cc = u_ss = x`, `u_sc = -u_cs = y`: half
//! the differences of their rows 5-8 give a zero backward wave, half their sums are the casing rows.
//! In the forms `printed` and `blade` every group turns against a spring of its own, so that blade
//! coordinates are the angles of both groups instead of the two modes, and `exp(i b)` is expanded to
//! first order, Eq. (26).
//!
//! Run, `hbm`, margins, survey, check and screen all judge a lock by [`Held`]. It includes the change
//! of the contact forces' directions as blades bend (the curvature of the pushes).

use nalgebra::{Complex, Matrix6, Vector4, Vector6};
use serde::Serialize;
use strum::{Display, EnumString, VariantNames};

use super::{Character, Corner};
use crate::model::{Frame, Machine, Row};
use crate::numeric::rounding::ROUND_OFF;

/// Real part of an eigenvalue, relative to the eigenvalue, up to which it counts as round-off: a
/// nearly defective pair of eigenvalues is accurate to half the digits only.
const NEUTRAL: f64 = 1e-8;

/// Largest number of Newton steps from one start; five are usual.
pub(super) const NEWTON_STEPS: usize = 40;

/// Each Newton step must shrink at least by this factor. Near a fold of the branch steps shrink by
/// half; with a larger factor a start could converge to another branch.
const NEWTON_SHRINK: f64 = 0.75;

/// Largest Newton step, relative to the unknowns, and largest change of a group's direction in it
/// \[rad\]: only in the directions are the equations not bilinear.
const NEWTON_LARGEST: f64 = 0.1;

/// Size of a Newton step, relative to the unknowns, after which the Jacobian is kept.
const NEWTON_SMALL: f64 = 1e-4;

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

/// Form of the equations for the blade angles. It hardly affects casing amplitude and multipliers,
/// but it changes the blade angles.
#[derive(
    Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Display, EnumString, VariantNames,
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

/// An equilibrium with the contact of some sides.
#[derive(Clone, Debug)]
pub(super) struct Held {
    pub frame: Frame,
    /// Casing displacement `(x, y)` \[m\] and blade modes \[rad\].
    pub at: Vector4<f64>,
    /// The sides in contact, with a row and a multiplier (negative is a push) \[N\] for each.
    pub sides: Vec<u32>,
    pub rows: Vec<Row>,
    pub multipliers: Vec<f64>,
    /// Residual of the equations in units of force, clearance and torque.
    pub residual: f64,
}

impl Held {
    /// Creates a state; `loads` are the sides in contact and their multipliers.
    pub fn new(
        machine: &Machine,
        frame: Frame,
        at: Vector4<f64>,
        loads: &[(u32, f64)],
        residual: f64,
    ) -> Self {
        let row = |&(side, multiplier): &(u32, f64)| {
            Row::new(&frame, machine.polygon.direction(side), &at, multiplier)
        };
        let (sides, multipliers) = loads.iter().copied().unzip();
        Self { rows: loads.iter().map(row).collect(), frame, at, sides, multipliers, residual }
    }

    /// Returns the state of rest without contact at a rotor speed \[rad/s\].
    pub fn rest(machine: &Machine, speed: f64) -> Self {
        Self::new(machine, Frame::at(machine, speed), Vector4::zeros(), &[], 0.0)
    }

    /// Returns the state with contact on one side for the paper's tips; `None` with damping at the
    /// critical speed, where its contact force is infinite. `(K + i D) z = -Lambda exp(i b)` and the
    /// closed gap give `Lambda = h (K^2 + D^2)/K` and the lever `h D/K`; the blade angle only turns
    /// the direction.
    pub fn on_side(machine: &Machine, speed: f64, side: u32) -> Option<Self> {
        let (frame, height) = (Frame::at(machine, speed), machine.clearance());
        let own = frame.casing.dynamic_stiffness(frame.casing.turn);
        let lever = if own.im == 0.0 { 0.0 } else { own.im / own.re };
        let multiplier = height * (own.re + own.im * lever);
        if !(multiplier.is_finite() && lever.is_finite()) {
            return None;
        }
        let alpha = -multiplier * machine.nodal_diameters * lever * height / frame.blades.stiffness;
        let (c, s) = machine.polygon.direction(side);
        let turned = Complex::new(c, s) * Complex::cis(machine.nodal_diameters * alpha);
        let z = turned * Complex::new(-height, lever * height);
        let at = Vector4::new(z.re, z.im, alpha * c, alpha * s);
        Some(Self::new(machine, frame, at, &[(side, multiplier)], 0.0))
    }

    /// Returns the state with contact in a corner, on the branch that starts at rigid blades. `None`
    /// if the blades have grown into the casing, if the branch folds back before their softness, or if
    /// the equations are singular.
    pub fn in_corner(machine: &Machine, speed: f64, corner: Corner, form: Form) -> Option<Self> {
        if machine.clearance() <= 0.0 {
            return None;
        }
        let equations = Equations::new(machine, speed, corner, form);
        let (unknowns, residual) = equations.solve()?;
        let mut at = equations.state(&unknowns, 1.0);
        if form != Form::Modal {
            // Modes that turn both groups by these angles, Eq. (20).
            let [(c_a, s_a), (c_b, s_b)] = equations.directions;
            let ([a, b], sine) = ([at.z, at.w], c_a * s_b - s_a * c_b);
            (at.z, at.w) = ((a * s_b - b * s_a) / sine, (b * c_a - a * c_b) / sine);
        }
        let multipliers = [unknowns[4], unknowns[5]].map(|multiplier| equations.force * multiplier);
        let loads = [(corner.a, multipliers[0]), (corner.b, multipliers[1])];
        Some(Self::new(machine, equations.frame, at, &loads, residual))
    }

    /// Returns whether no multiplier is tensile.
    pub fn pushes(&self) -> bool {
        self.multipliers.iter().all(|multiplier| *multiplier <= 0.0)
    }

    /// Returns the amplitude `|z|` of the casing wave \[m\].
    pub fn amplitude(&self) -> f64 {
        self.at.x.hypot(self.at.y)
    }

    /// Returns the blade angle on a side with this direction \[rad\].
    pub fn alpha(&self, (c, s): (f64, f64)) -> f64 {
        c * self.at.z + s * self.at.w
    }

    /// Returns the torque of the rotor, `sum Lambda A`, without that of friction itself \[N m\]:
    /// `n_d (D |z|^2 + mu_c sum Lambda Re[z exp(-i b)])`.
    pub fn torque(&self) -> f64 {
        let drag = self.frame.casing.damping * self.frame.casing.turn;
        let along = |row: &Row| self.at.x * row.gap.x + self.at.y * row.gap.y;
        let loads = self.rows.iter().zip(&self.multipliers);
        let rubbed: f64 = loads.map(|(row, multiplier)| multiplier * along(row)).sum();
        let wave = self.amplitude();
        self.frame.diameters * (drag * wave * wave + self.frame.friction * rubbed)
    }

    /// Returns the smallest gap of the sides that are not in contact; infinite if there are none
    /// \[m\].
    pub fn smallest_gap(&self, machine: &Machine) -> f64 {
        let polygon = &machine.polygon;
        let [x, y, blade_c, blade_s]: [f64; 4] = self.at.into();
        // Bent blades reduce no gap by more than this.
        let turn = self.frame.diameters * self.amplitude() + self.frame.slope.abs();
        let nearer = blade_c.hypot(blade_s) * turn;
        let first = self.sides.last().map_or(0, |side| polygon.next(*side));
        let mut least = f64::INFINITY;
        for side in (first..polygon.sides).chain(0..first) {
            let (c, s) = polygon.direction(side);
            let apothem = machine.apothem(side);
            if apothem + x * c + y * s - nearer < least && !self.sides.contains(&side) {
                let row = Row::new(&self.frame, (c, s), &self.at, 0.0);
                least = least.min(apothem + row.opening);
            }
        }
        least
    }

    /// Classifies the state by its multipliers, its smallest other gap, and whether a motion about it
    /// grows.
    pub fn character(
        &self,
        machine: &Machine,
        smallest_gap: f64,
        grows: impl FnOnce() -> bool,
    ) -> Character {
        // The paper's equality algorithm holds a corner that it would close.
        let adhesive = || self.rows.len() == 2 && machine.contact_can_pull() && self.closes();
        match self.pushes() {
            false if adhesive() => Character::Adhesive,
            false => Character::Pulls,
            true if smallest_gap < 0.0 => Character::Penetrates,
            true if grows() => Character::Unstable,
            true => Character::Stable,
        }
    }

    /// Returns whether every contact would close if the contact forces were removed. The equality
    /// of Eq. (11) then holds this state whatever the signs.
    fn closes(&self) -> bool {
        let [casing, blades] = [self.frame.casing.mass, self.frame.blades.mass];
        let moved = |row: &Row, by: &Row| {
            let product = row.gap.component_mul(&by.force);
            (product.x + product.y) / casing + (product.z + product.w) / blades
        };
        let forces = || self.rows.iter().zip(&self.multipliers);
        self.rows
            .iter()
            .all(|row| forces().map(|(by, lambda)| lambda * moved(row, by)).sum::<f64>() < 0.0)
    }

    /// Returns the eigenvalues of the motion that keeps every contact \[1/s\]; `None` if they cannot
    /// be computed.
    pub fn eigenvalues(&self) -> Option<Vec<Complex<f64>>> {
        self.frame.motion(&self.rows, &[]).eigenvalues()
    }

    /// Returns the growth rate of the fastest motion that keeps every contact \[1/s\]; `None` if none
    /// grows, infinite if the eigenvalues cannot be computed.
    pub fn growth(&self) -> Option<f64> {
        let (motion, rate) =
            (self.frame.motion(&self.rows, &[]), self.frame.casing.own_frequency());
        if motion.is_bounded(NEUTRAL * rate) {
            return None;
        }
        let Some(values) = motion.eigenvalues() else { return Some(f64::INFINITY) };
        grows(&values, rate).then(|| largest_growth(&values))
    }
}

/// Returns whether a motion with one of these eigenvalues grows. Real parts up to [`NEUTRAL`] times
/// the eigenvalue or `rate` count as round-off, and so do those within the round-off of the largest
/// eigenvalue.
pub(super) fn grows(values: &[Complex<f64>], rate: f64) -> bool {
    let fastest = values.iter().map(|value| value.norm()).fold(0.0, f64::max);
    values
        .iter()
        .any(|value| value.re > (NEUTRAL * value.norm().max(rate)).max(ROUND_OFF * fastest))
}

/// Returns the largest real part of these eigenvalues.
pub(super) fn largest_growth(values: &[Complex<f64>]) -> f64 {
    values.iter().map(|value| value.re).fold(f64::NEG_INFINITY, f64::max)
}

/// Returns the eigenvalues of the motion about rest without contact \[1/s\]: those of the casing,
/// shifted by the rotation, and of the blades.
pub(super) fn at_rest(machine: &Machine, speed: f64) -> Vec<Complex<f64>> {
    let roots = |rate: f64, zeta: f64| {
        let root = Complex::new((zeta - 1.0) * (zeta + 1.0), 0.0).sqrt();
        // The slower of two real roots as a quotient, which avoids cancellation.
        let slow = if zeta > 1.0 { -1.0 / (root + zeta) } else { root - zeta };
        [slow * rate, (-root - zeta) * rate]
    };
    let casing = roots(machine.omega_c, machine.casing_damping_ratio);
    let turn = Complex::new(0.0, machine.nu(speed));
    let mut values: Vec<_> = casing.iter().flat_map(|root| [root + turn, root - turn]).collect();
    let modes = if machine.has_sine_mode { 2 } else { 1 };
    for _ in 0..modes {
        values.extend(roots(machine.omega_bd, machine.blade_damping_ratio));
    }
    values
}

/// The equations of a corner in one form. Lengths are in units of the clearance, contact forces of
/// `force`, blade angles of `angle`, torques of `bent n_d force clearance`.
struct Equations {
    frame: Frame,
    form: Form,
    /// Directions `(cos psi, sin psi)` of both sides.
    directions: [(f64, f64); 2],
    /// Apothems of both sides.
    apothems: [f64; 2],
    clearance: f64,
    /// Unit of force, `k_c g0` \[N\].
    force: f64,
    /// Unit of blade angles, the turn under the unit of torque \[rad\].
    angle: f64,
    /// Factor on torques that keeps angles of order one if the torque of the tips dominates.
    bent: f64,
    /// Sign of the blades' stiffness: that of the form `printed` is negative.
    sign: f64,
    /// Dynamic stiffness of the casing in units of its stiffness.
    casing: Complex<f64>,
}

impl Equations {
    fn new(machine: &Machine, speed: f64, corner: Corner, form: Form) -> Self {
        let (frame, polygon) = (Frame::at(machine, speed), &machine.polygon);
        let clearance = machine.clearance();
        let force = machine.casing_stiffness * clearance;
        let torque = machine.nodal_diameters * force * clearance;
        let one = machine.blade_inertia * machine.omega_bd * machine.omega_bd;
        let group = f64::from(polygon.blades_per_side) * one;
        let stiffness = match form {
            // Rows 1-2 of (27) as printed have -2 times the torque of (19).
            Form::Printed => -0.5 * group,
            Form::Blade => group,
            Form::Modal => frame.blades.stiffness,
        };
        let bent = 1.0 + frame.lever.abs() * force / torque;
        Self {
            frame,
            form,
            directions: corner.sides().map(|side| polygon.direction(side)),
            apothems: corner.sides().map(|side| machine.apothem(side) / clearance),
            clearance,
            force,
            angle: bent * torque / stiffness.abs(),
            bent,
            sign: stiffness.signum(),
            casing: frame.casing.dynamic_stiffness(frame.casing.turn) / machine.casing_stiffness,
        }
    }

    /// Returns casing displacement \[m\] and blade coordinates \[rad\] with blades softer by `part`.
    fn state(&self, unknowns: &Vector6<f64>, part: f64) -> Vector4<f64> {
        let (length, angle) = (self.clearance, part * self.angle);
        let units = Vector4::new(length, length, angle, angle);
        unknowns.fixed_rows::<4>(0).component_mul(&units)
    }

    /// Returns the residual of the equations and its derivatives.
    fn evaluate(&self, unknowns: &Vector6<f64>, part: f64) -> (Vector6<f64>, Matrix6<f64>) {
        let at = self.state(unknowns, part);
        let (c, mut jacobian) = (self.casing, Matrix6::zeros());
        (jacobian[(0, 0)], jacobian[(0, 1)]) = (c.re, -c.im);
        (jacobian[(1, 0)], jacobian[(1, 1)]) = (c.im, c.re);
        (jacobian[(2, 2)], jacobian[(3, 3)]) = (self.sign, self.sign);
        let mut residual = jacobian * unknowns;
        // Units of the unknowns, and of the equations of casing and blades.
        let (length, angle) = (self.clearance, part * self.angle);
        let torque = self.bent * self.frame.diameters * self.force * length;
        let units = [length, length, angle, angle];
        let sizes = [self.force, self.force, torque, torque];
        for (i, direction) in self.directions.into_iter().enumerate() {
            let shape = match self.form {
                Form::Modal => direction,
                Form::Printed | Form::Blade => [(1.0, 0.0), (0.0, 1.0)][i],
            };
            let (multiplier, first_order) = (unknowns[4 + i], self.form != Form::Modal);
            let load = self.force * multiplier;
            let row = Row::bent(&self.frame, direction, shape, first_order, &at, load);
            residual[4 + i] = self.apothems[i] + row.opening / length;
            for k in 0..4 {
                let force = row.force[k] * self.force / sizes[k];
                residual[k] += multiplier * force;
                jacobian[(k, 4 + i)] = force;
                jacobian[(4 + i, k)] = row.gap[k] * units[k] / length;
                for l in 0..4 {
                    jacobian[(k, l)] += row.turned[(k, l)] * units[l] / sizes[k];
                }
            }
        }
        (residual, jacobian)
    }

    /// Returns the unknowns, casing, blades and multipliers, and the residual.
    fn solve(&self) -> Option<(Vector6<f64>, f64)> {
        // The corner of blades that their torques do not bend.
        let still = Vector6::zeros();
        let (apart, jacobian) = self.evaluate(&still, 1.0);
        let lu = jacobian.lu();
        let mut here = -lu.solve(&apart)?;
        let tips = [self.frame.slope, self.frame.lever, self.frame.friction];
        if tips != [0.0; 3] || self.apothems != [1.0; 2] {
            let (unknowns, residual, _) = self.newton(here, 1.0, f64::INFINITY)?;
            return Some((unknowns, residual));
        }
        let (bent, _) = self.evaluate(&here, 0.0);
        (here[2], here[3]) = (-self.sign * bent[2], -self.sign * bent[3]);
        let (mut part, mut stride, mut last) = (0.0, 1.0, lu.determinant());
        for _ in 0..NEWTON_STRIDES {
            let next = f64::min(part + stride, 1.0);
            let found = self.newton(here, next, NEWTON_LARGEST);
            match found.filter(|found| NEWTON_ALIKE.contains(&(found.2 / last))) {
                Some((found, residual, _)) if next == 1.0 => return Some((found, residual)),
                Some((found, _, determinant)) => {
                    (part, stride, here, last) = (next, 2.0 * stride, found, determinant);
                }
                None if stride < NEWTON_STRIDE => return None,
                None => stride *= 0.5,
            }
        }
        None
    }

    /// Solves the equations by Newton's method, with blades softer by `part`, and returns the
    /// unknowns, the residual and the determinant of the derivatives. It stops early if the first step
    /// exceeds about the fraction `largest` of the unknowns, if a step turns a group by more than
    /// `largest` \[rad\] or if steps do not shrink; `None` if the residual is not small then.
    fn newton(
        &self,
        start: Vector6<f64>,
        part: f64,
        largest: f64,
    ) -> Option<(Vector6<f64>, f64, f64)> {
        // The rows are of order one, so the attainable residual is a few units in the last place of
        // the largest term.
        let size = 1.0 + self.casing.re.abs() + self.casing.im.abs();
        let mut unknowns = start;
        let (mut residual, jacobian) = self.evaluate(&unknowns, part);
        let mut lu = jacobian.lu();
        let mut last = largest * unknowns.norm() / NEWTON_SHRINK;
        for _ in 0..NEWTON_STEPS {
            if residual.norm() <= 4.0 * f64::EPSILON * size {
                break;
            }
            let step = lu.solve(&residual)?;
            let length = step.norm();
            let turn = self.frame.diameters * part * self.angle * step[2].abs().max(step[3].abs());
            if length > NEWTON_SHRINK * last || turn > largest {
                break;
            }
            unknowns -= step;
            last = length;
            let (left, jacobian) = self.evaluate(&unknowns, part);
            residual = left;
            if length > NEWTON_SMALL * unknowns.norm() {
                lu = jacobian.lu();
            } else if length <= 4.0 * f64::EPSILON * unknowns.norm() {
                break;
            }
        }
        // Ill-conditioned near a fold: accept a residual that is small enough.
        let left = residual.norm();
        (left <= POLISHED * size).then(|| (unknowns, left, lu.determinant()))
    }
}
