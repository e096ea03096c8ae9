//! Linear response of a locked motion to an engine-order excitation of the blades, with both
//! contacts kept (docs/theory.md, section 8).
//!
//! A load `Q cos(E (theta + Phi_i))`, fixed in the stationary frame, drives the modes with `n_d`
//! nodal diameters only if `E = +-n_d` modulo `N`, with the frequency `E Omega` in the blade frame:
//! `sum_i exp(i psi_i) Q_i = (N/2) Q exp(+-i E theta)`. In a corner only the blades are free to
//! move, and the casing follows them.

use nalgebra::{Complex, Matrix2, Vector2, Vector4};

use super::equations::{Equations, Scales, Wave};
use super::equilibria::{judged, loads_of};
use super::stability::{ClosedSide, Linearised, blade_scale};
use super::{Corner, Equilibrium, Form, HarmonicError, Kind, error};
use crate::model::{Excitation, Machine};

/// Locked motion and its response to an engine order at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct ExcitedLock {
    /// Locked motion without the excitation.
    pub state: Equilibrium,
    /// Frequency in the blade frame, `E |Omega|` \[rad/s\].
    pub frequency_rad_s: f64,
    /// Complex amplitudes, the coefficients of `exp(i frequency t)`, of `x`, `y` (casing in the
    /// blade frame) \[m\] and of `alpha_c`, `alpha_s` \[rad\].
    pub response: [Complex<f64>; 4],
    /// Complex amplitudes of both group multipliers \[N\].
    pub multipliers_n: [Complex<f64>; 2],
    /// Largest change of `|z|` relative to the locked motion.
    pub relative_amplitude: f64,
    /// Largest change of a multiplier relative to its mean.
    pub relative_multiplier: f64,
    /// Excitation torque at which a multiplier first reaches zero in the linear response; `None` if
    /// the excitation does not drive these modes \[N m\].
    pub release_torque_nm: Option<f64>,
}

impl ExcitedLock {
    /// Returns the amplitude of the casing response \[m\].
    #[must_use]
    pub fn casing_m(&self) -> f64 {
        self.response[0].norm().hypot(self.response[1].norm())
    }
}

/// Returns whether an engine order drives the modes of this machine.
#[must_use]
pub fn drives(machine: &Machine, order: u32) -> bool {
    let (forward, backward) = reach(machine, order);
    forward || backward
}

/// Returns whether `n_d + E` and `n_d - E` are multiples of `N`.
fn reach(machine: &Machine, order: u32) -> (bool, bool) {
    let blades = u64::from(machine.polygon.blades);
    let diameters = u64::from(machine.polygon.nodal_diameters) % blades;
    let order = u64::from(order) % blades;
    ((diameters + order).is_multiple_of(blades), diameters == order)
}

/// Responses of the damped locked motion (form `modal`) in one corner for a list of speeds. They
/// are computed on demand to save memory.
#[derive(Clone, Debug, PartialEq)]
pub struct ExcitedLocks {
    machine: Machine,
    corner: Corner,
    excitation: Excitation,
    speeds: Vec<f64>,
    /// Number of speeds with a locked motion.
    pub count: usize,
}

impl ExcitedLocks {
    /// Creates the responses for a list of speeds \[rad/s\].
    ///
    /// # Errors
    /// The polygon has no corners, the tips are inclined or rub, the disk modes have other nodal
    /// diameters, a speed is not finite, or eigenvalues cannot be computed.
    pub fn over(
        machine: &Machine,
        side: u32,
        excitation: &Excitation,
        speeds: &[f64],
    ) -> Result<Self, HarmonicError> {
        let corner = Corner::after(&machine.polygon, side)?;
        error::refuse_other_diameters(machine)?;
        error::refuse_tips(machine, "0 where a lock is excited")?;
        let (machine, excitation) = (machine.clone(), excitation.clone());
        let mut found = Self { machine, corner, excitation, speeds: speeds.to_vec(), count: 0 };
        for place in 0..speeds.len() {
            found.count += usize::from(found.lock_at(place)?.is_some());
        }
        Ok(found)
    }

    /// Returns the number of speeds.
    #[must_use]
    pub fn places(&self) -> usize {
        self.speeds.len()
    }

    /// Returns the excited locked motion at a speed, given by its index in the list; `None` if
    /// there is none.
    ///
    /// # Errors
    /// None, because [`over`](Self::over) has computed it before.
    pub fn lock_at(&self, place: usize) -> Result<Option<ExcitedLock>, HarmonicError> {
        let Some(&speed) = self.speeds.get(place) else { return Ok(None) };
        error::refuse_endless(&[speed])?;
        at(&self.machine, self.corner, &self.excitation, speed)
    }
}

fn at(
    machine: &Machine,
    corner: Corner,
    excitation: &Excitation,
    speed: f64,
) -> Result<Option<ExcitedLock>, HarmonicError> {
    let machine = &*machine.at(speed);
    if machine.clearance() <= 0.0 {
        return Ok(None);
    }
    let wave = Wave::at(machine, speed, true);
    let equations = Equations::new(machine, corner, Form::Modal, wave, speed);
    let Some(unknowns) = equations.locked() else { return Ok(None) };
    let configuration = equations.configuration(&unknowns);
    let loads = loads_of(machine, corner, &configuration, &unknowns);
    let held: Vec<ClosedSide> =
        loads.iter().map(|load| configuration.held(&machine.polygon, load.0, load.1)).collect();
    let state = judged(machine, Kind::Corner, speed, true, &configuration, &loads)?;
    let motion = Linearised::about(machine, speed, true, &held);

    let scales = Scales::new(machine);
    let angle = blade_scale(machine) / machine.nodal_diameters;
    let torque = excitation.amplitude_nm * angle / (scales.force * scales.length);
    let frequency = f64::from(excitation.order) * speed;
    let load = modal_load(machine, excitation.order).map(|part| part * torque);
    let forced = motion.forced(load, frequency / machine.omega_c);
    let Some((shape, pushes)) = forced else { return Ok(None) };
    let units = [scales.length, scales.length, angle, angle];
    let response = [0, 1, 2, 3].map(|i| shape[i] * units[i]);
    let multipliers = [0, 1].map(|i| pushes[i] * scales.force);
    let means = [0, 1].map(|i| state.contacts.get(i).map_or(0.0, |contact| contact.multiplier_n));
    let over = |change: f64, whole: f64| if change == 0.0 { 0.0 } else { change / whole.abs() };
    let relative = [0, 1].map(|i| over(multipliers[i].norm(), means[i]));
    let relative_multiplier = relative[0].max(relative[1]);
    Ok(Some(ExcitedLock {
        relative_amplitude: over(radial(&state, &response), state.amplitude_m),
        relative_multiplier,
        release_torque_nm: (relative_multiplier > 0.0)
            .then(|| excitation.amplitude_nm / relative_multiplier),
        state,
        frequency_rad_s: frequency.abs(),
        response,
        multipliers_n: multipliers,
    }))
}

/// Returns the load on `(alpha_c, alpha_s)` for a unit torque on each blade, as coefficients of
/// `exp(i E Omega t)`.
fn modal_load(machine: &Machine, order: u32) -> [Complex<f64>; 2] {
    let half = 0.5 * f64::from(machine.polygon.blades);
    let (forward, backward) = reach(machine, order);
    let part = |reached: bool| if reached { half } else { 0.0 };
    // exp(i E theta) = cos + i sin: the sine coordinate is a quarter period ahead or behind.
    [
        Complex::new(part(forward) + part(backward), 0.0),
        Complex::new(0.0, part(backward) - part(forward)),
    ]
}

/// Returns the largest change of `|z|`, which is the response in the direction of `z`.
fn radial(state: &Equilibrium, response: &[Complex<f64>; 4]) -> f64 {
    let amplitude = state.amplitude_m;
    ((response[0] * state.z_m[0] + response[1] * state.z_m[1]) / amplitude).norm()
}

/// Scaled coordinates and multipliers of a forced motion.
type Forced = (Vector4<Complex<f64>>, Vector2<Complex<f64>>);

impl Linearised {
    /// Returns the steady response to a load `exp(i ratio t)` on the blade modes with both contacts
    /// of a corner kept: scaled coordinates and multipliers. `None` at an undamped resonance.
    fn forced(&self, load: [Complex<f64>; 2], ratio: f64) -> Option<Forced> {
        let basis = self.corner_basis()?.map(real);
        let dynamic = self.dynamic_stiffness(ratio);
        let load = Vector4::new(real(0.0), real(0.0), load[0], load[1]);
        let reduced: Matrix2<Complex<f64>> = basis.transpose() * dynamic * basis;
        let motion = basis * reduced.try_inverse()? * (basis.transpose() * load);
        // The casing rows of the full equations give the multipliers.
        let left = dynamic * motion;
        let &[a, b] = self.gradients() else { return None };
        let contact = Matrix2::new(a[0], b[0], a[1], b[1]).map(real);
        let pushes = contact.try_inverse()? * Vector2::new(-left[0], -left[1]);
        Some((motion, pushes))
    }
}

fn real(x: f64) -> Complex<f64> {
    Complex::new(x, 0.0)
}
