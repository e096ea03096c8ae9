//! Linear response of a locked motion to an engine-order excitation of the blades, with both
//! contacts kept (docs/theory.md, section 8).
//!
//! A load `Q cos(E (theta + Phi_i))`, fixed in the stationary frame, drives the modes with `n_d`
//! nodal diameters only if `E = +-n_d` modulo `N`, with the frequency `E Omega` in the blade frame:
//! `sum_i exp(i psi_i) Q_i = (N/2) Q exp(+-i E theta)`. In a corner the casing follows the blades,
//! because both gaps stay closed.

use nalgebra::{Complex, Matrix6, Vector6};

use super::equilibria::judged;
use super::held::Held;
use super::{Corner, Equilibrium, Form, Kind, error};
use crate::model::{Excitation, Machine};
use crate::scene::SceneError;

/// Locked motion and its response to an engine order at one speed.
#[derive(Clone, Debug, PartialEq)]
pub struct ExcitedLock {
    /// Locked motion without the excitation.
    pub state: Equilibrium,
    /// Frequency of the excitation in the blade frame, `E |Omega|` \[rad/s\].
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
    /// Returns the norm of the casing response, `sqrt(|x|^2 + |y|^2)` \[m\].
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

/// Returns the responses of the damped locked motion (form `modal`) in the corner after a side, for
/// each of a list of speeds \[rad/s\] with a lock and a clearance, unless it is that of an undamped
/// resonance.
///
/// # Errors
/// The polygon has no corners, the tips are inclined or rub, the disk modes have other nodal
/// diameters, a speed is not finite, or eigenvalues cannot be computed.
pub fn excited_locks(
    machine: &Machine,
    side: u32,
    excitation: &Excitation,
    speeds: &[f64],
) -> Result<Vec<ExcitedLock>, SceneError> {
    let corner = Corner::after(&machine.polygon, side)?;
    error::refuse_other_diameters(machine)?;
    error::refuse_tips(machine, "0 for an excited lock")?;
    error::refuse_endless(speeds)?;
    let at = |&speed: &f64| lock_at(machine, corner, excitation, speed).transpose();
    speeds.iter().filter_map(at).collect()
}

fn lock_at(
    machine: &Machine,
    corner: Corner,
    excitation: &Excitation,
    speed: f64,
) -> Result<Option<ExcitedLock>, SceneError> {
    let machine = &*machine.at(speed);
    let Some(held) = Held::in_corner(machine, speed, corner, Form::Modal) else { return Ok(None) };
    let state = judged(machine, Kind::Corner, speed, &held)?;
    let frequency = f64::from(excitation.order) * speed;
    let load = modal_load(machine, excitation.order).map(|part| part * excitation.amplitude_nm);
    let Some([x, y, c, s, a, b]) = forced(&held, load, frequency) else { return Ok(None) };
    let (response, multipliers) = ([x, y, c, s], [a, b]);
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

/// Returns the steady response to a load `exp(i frequency t)` on the blade modes with both contacts
/// of a corner kept: the four coordinates and both multipliers. `None` at an undamped resonance.
///
/// `(K + i frequency C - frequency^2 M) w + sum Lambda f = load` and `g . w = 0` for both rows.
fn forced(held: &Held, load: [Complex<f64>; 2], frequency: f64) -> Option<[Complex<f64>; 6]> {
    let [mass, damping, stiffness] = held.frame.matrices(&held.rows, &[]);
    // Blade coordinates are lengths at the tip of a lever that makes both stiffnesses equal.
    let lever = (held.frame.blades.stiffness / held.frame.casing.stiffness).sqrt();
    let unit = [1.0, 1.0, lever, lever].map(f64::recip);
    let scale = held.frame.casing.stiffness;
    let mut system = Matrix6::zeros();
    for (i, j) in (0..4).flat_map(|i| (0..4).map(move |j| (i, j))) {
        let still = stiffness[(i, j)] - frequency * frequency * mass[(i, j)];
        let entry = Complex::new(still, frequency * damping[(i, j)]);
        system[(i, j)] = entry * (unit[i] * unit[j] / scale);
    }
    for (place, row) in (4..).zip(&held.rows) {
        for i in 0..4 {
            system[(i, place)] = Complex::from(row.force[i] * unit[i]);
            system[(place, i)] = Complex::from(row.gap[i] * unit[i]);
        }
    }
    let mut right = Vector6::zeros();
    (right[2], right[3]) = (load[0] * (unit[2] / scale), load[1] * (unit[3] / scale));
    let found = system.lu().solve(&right)?;
    Some(std::array::from_fn(|i| found[i] * unit.get(i).copied().unwrap_or(scale)))
}
