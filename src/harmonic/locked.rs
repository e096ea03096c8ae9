//! Locked motion against speed: two phase groups hold the casing wave in a
//! corner of the blade frame, where it is an equilibrium (docs/theory.md, section 8).
//! Newton's method on Eq. (27), started from the closed form.

use serde::Serialize;

use super::configuration::Configuration;
use super::equations::{Equations, Scales, Unknowns, Wave};
use super::stability::{Linearised, grows};
use super::{Character, Corner, Form, HarmonicError, error, joined_lock, joined_stability};
use crate::model::Machine;

/// The locked motion at one rotor speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LockedPoint {
    /// Rotor speed `Omega` \[rad/s\].
    pub speed_rad_s: f64,
    /// `[Lambda_a, Lambda_b]`, summed over each group; negative is a push \[N\].
    pub multipliers_n: [f64; 2],
    /// Angle of one blade of each group, `[alpha_a, alpha_b]` \[rad\].
    pub alpha_rad: [f64; 2],
    /// `u_cc`, cosine part of `u_c(t)`, Eq. (25) \[m\].
    pub u_cc_m: f64,
    /// `u_cs`, sine part of `u_c(t)` \[m\].
    pub u_cs_m: f64,
    /// `u_sc`, cosine part of `u_s(t)` \[m\].
    pub u_sc_m: f64,
    /// `u_ss`, sine part of `u_s(t)` \[m\].
    pub u_ss_m: f64,
    /// Amplitude `|z|` of the casing wave \[m\].
    pub amplitude_m: f64,
    /// Smallest gap of all groups not in contact \[m\]; infinite if there are none.
    pub smallest_gap_m: f64,
    /// Torque the rotor must give to hold the wave, `sum Lambda A`, beside the torque of
    /// friction itself, `mu sum P R_c` \[N m\].
    pub torque_nm: f64,
    /// Its power, `torque * Omega` \[W\].
    pub power_w: f64,
    /// What holds it, if anything does. The motion that may grow is the time model's
    /// (two blade modes), in every form.
    pub character: Character,
    /// Whether pushes can hold it: both multipliers push (or vanish) and
    /// every other gap is open.
    pub admissible: bool,
    /// Whether it lasts by pushes alone: admissible, and no motion that keeps both
    /// contacts grows.
    pub stable: bool,
    /// Largest row of the eight equations (27), dimensionless: torques over
    /// `n_d k_c g0^2`, gaps over `g0`, forces over `k_c g0`.
    pub residual: f64,
}

/// Solver of the locked motion of one machine in one corner and one form.
#[derive(Clone, Debug)]
pub struct Locked {
    machine: Machine,
    corner: Corner,
    form: Form,
    damped: bool,
    scales: Scales,
    equations: Equations,
}

/// The locked motion over a list of speeds.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// The corner that holds the wave.
    pub corner: Corner,
    /// Which equations.
    pub form: Form,
    /// Whether they include the damping of casing and blades.
    pub damped: bool,
    /// One point for each speed with a locked motion, in the given order.
    pub points: Vec<LockedPoint>,
    /// The speeds without one: the blades are so soft that the branch has
    /// folded back \[rad/s\].
    pub missing: Vec<f64>,
}

impl Locked {
    /// Prepares the equations. Undamped is the paper's Eq. (27); damped adds
    /// `d_c` to its casing rows.
    ///
    /// # Errors
    /// A polygon without corners, disk modes of other diameters than the casing, an
    /// interference fit, and a
    /// form other than modal where tips are inclined or rub.
    pub fn new(
        machine: &Machine,
        corner: Corner,
        form: Form,
        damped: bool,
    ) -> Result<Self, HarmonicError> {
        let corner = Corner::after(&machine.polygon, corner.a)?;
        error::refuse_other_diameters(machine)?;
        error::refuse_preload(machine)?;
        if form != Form::Modal {
            let allowed = format!("0 with the form {form}; the form modal has it");
            error::refuse_joined(machine, &allowed)?;
        }
        Ok(Self {
            machine: machine.clone(),
            corner,
            form,
            damped,
            scales: Scales::of(machine),
            equations: Equations::new(machine, corner, form),
        })
    }

    /// The corner that holds the wave.
    #[must_use]
    pub fn corner(&self) -> Corner {
        self.corner
    }

    /// The locked motion at one speed \[rad/s\].
    ///
    /// # Errors
    /// A speed that is not finite, or one with no locked motion.
    pub fn at(&self, speed: f64) -> Result<LockedPoint, HarmonicError> {
        if !speed.is_finite() {
            return Err(HarmonicError::Speed(speed));
        }
        if self.machine.is_joined() {
            let softness = self.equations.softness();
            return self.joined(speed).ok_or(HarmonicError::NotFound { speed, softness });
        }
        let wave = Wave::at(&self.machine, speed, self.damped);
        match self.equations.locked(wave) {
            Some(unknowns) => Ok(self.point(speed, wave, &unknowns)),
            None => Err(HarmonicError::NotFound { speed, softness: self.equations.softness() }),
        }
    }

    /// The locked motion at each speed \[rad/s\].
    ///
    /// # Errors
    /// A speed that is not finite.
    pub fn sweep(&self, speeds: &[f64]) -> Result<Sweep, HarmonicError> {
        let mut points = Vec::with_capacity(speeds.len());
        let mut missing = Vec::new();
        for &speed in speeds {
            match self.at(speed) {
                Ok(point) => points.push(point),
                Err(HarmonicError::NotFound { .. }) => missing.push(speed),
                Err(error) => return Err(error),
            }
        }
        Ok(Sweep { corner: self.corner, form: self.form, damped: self.damped, points, missing })
    }

    /// With tips that are inclined or rub.
    fn joined(&self, speed: f64) -> Option<LockedPoint> {
        let undamped;
        let machine = if self.damped {
            &self.machine
        } else {
            undamped = self.machine.clone().undamped();
            &undamped
        };
        let (equations, held) = joined_lock::held(machine, self.corner, speed)?;
        let [x, y, .., push_a, push_b] = held;
        let Scales { length, force, .. } = self.scales;
        let touches = equations.phases.map(|phase| equations.touch(phase, &held));
        let polygon = &machine.polygon;
        let smallest_gap = (0..polygon.sides)
            .filter(|side| !self.corner.sides().contains(side))
            .map(|side| equations.gap(polygon.direction(side), &held))
            .fold(f64::INFINITY, f64::min);
        let pushes = push_a >= 0.0 && push_b >= 0.0;
        // A pull has no friction. Without the contact forces both gaps close.
        let across = (2.0 * polygon.delta).cos();
        let closes = push_a + push_b * across > 0.0 && push_b + push_a * across > 0.0;
        let held_by_pulls = closes && machine.friction == 0.0;
        let character = Character::of(pushes, held_by_pulls, smallest_gap, || {
            joined_stability::lock_eigenvalues(machine, speed, &equations, &held)
                .is_none_or(|values| grows(&values, machine.omega_c))
        });
        let moment_arm = -(push_a * touches[0].across + push_b * touches[1].across);
        let torque = machine.nodal_diameters * force * length * moment_arm;
        let residual =
            equations.residual(&held).iter().fold(0.0, |most: f64, row| most.max(row.abs()));
        Some(LockedPoint {
            speed_rad_s: speed,
            multipliers_n: [-push_a * force, -push_b * force],
            alpha_rad: touches.map(|touch| touch.alpha),
            u_cc_m: x * length,
            u_cs_m: -y * length,
            u_sc_m: y * length,
            u_ss_m: x * length,
            amplitude_m: (x * length).hypot(y * length),
            smallest_gap_m: length * smallest_gap,
            torque_nm: torque,
            power_w: torque * speed,
            character,
            admissible: character.is_admissible(),
            stable: character == Character::Stable,
            residual,
        })
    }

    fn point(&self, speed: f64, wave: Wave, unknowns: &Unknowns) -> LockedPoint {
        let [x, y, lambda_a, lambda_b, alpha_a, alpha_b]: [f64; 6] = (*unknowns).into();
        let length = self.scales.length;
        let multipliers = [lambda_a, lambda_b];
        let (polygon, sides) = (&self.machine.polygon, self.corner.sides());
        let turns = [alpha_a, alpha_b].map(|angle| self.scales.softness * angle);
        let configuration = Configuration::of_pair(polygon, (x, y), sides, turns);
        let held = [0, 1].map(|i| configuration.held(polygon, sides[i], multipliers[i]));
        let smallest_gap = length * configuration.smallest_gap(polygon, &sides);
        let motion = Linearised::about(&self.machine, speed, self.damped, &held);
        let pushes = multipliers.iter().all(|&l| l <= 0.0);
        let character =
            Character::of(pushes, motion.closes(), smallest_gap, || !motion.is_stable());
        // Without drag the two moment arms cancel, and their sum is rounding only.
        let moment_arm = match wave.drag {
            0.0 => 0.0,
            _ => held.iter().map(|side| side.multiplier * side.arm).sum(),
        };
        let torque = self.machine.nodal_diameters * self.scales.force * length * moment_arm;
        LockedPoint {
            speed_rad_s: speed,
            multipliers_n: multipliers.map(|l| l * self.scales.force),
            alpha_rad: [alpha_a, alpha_b].map(|angle| angle * self.scales.angle),
            u_cc_m: x * length,
            u_cs_m: -y * length,
            u_sc_m: y * length,
            u_ss_m: x * length,
            amplitude_m: (x * length).hypot(y * length),
            smallest_gap_m: smallest_gap,
            torque_nm: torque,
            power_w: torque * speed,
            character,
            admissible: character.is_admissible(),
            stable: character == Character::Stable,
            residual: self.equations.printed_residual(wave, unknowns),
        }
    }
}

/// The locked motion of a machine over speeds \[rad/s\], held between the
/// groups of two blades (the paper's where `None`, see [`Corner::paper`]).
///
/// ```
/// use rubscope::harmonic::{Form, locked_motion};
/// use rubscope::scene::Scene;
///
/// let machine = Scene::builtin("paper-nd3")?.machine();
/// let speeds: Vec<f64> = (0..=500).map(f64::from).collect();
/// let sweep = locked_motion(&machine, Form::Modal, false, Some([6, 21]), &speeds)?;
/// let last = sweep.points[500];
/// assert!((last.multipliers_n[0] - -150.85535).abs() < 1e-4);
/// assert!(last.admissible && last.stable);
/// assert!(!sweep.points[292].admissible && sweep.points[293].admissible);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// A polygon without corners, blades that are not phase neighbours, or a speed
/// that is not finite.
pub fn locked_motion(
    machine: &Machine,
    form: Form,
    damped: bool,
    blades: Option<[u32; 2]>,
    speeds: &[f64],
) -> Result<Sweep, HarmonicError> {
    let corner = match blades {
        Some(pair) => Corner::of_blades(&machine.polygon, pair)?,
        None => Corner::paper(&machine.polygon)?,
    };
    Locked::new(machine, corner, form, damped)?.sweep(speeds)
}
