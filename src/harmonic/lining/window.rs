//! Which linings hold a lock, and at which speeds: closed forms for blades that do not
//! give, with damping (docs/theory.md, section 10).
//!
//! A pair of groups holds the wave where `|K| tan delta >= D + (K^2 + D^2)/(k sin 2
//! delta)`, `K = m_c nu^2 - k_c`, `D = d_c nu`, with `k` the stiffness of one group. So a
//! lining needs a least stiffness at each speed, and one that is softer than the least
//! of these never holds a lock.

use serde::Serialize;

use super::Lining;
use super::law::between;
use crate::harmonic::HarmonicError;
use crate::model::Machine;
use crate::tolerances::{PEAK_STEPS, WINDOW_LOOKS, WINDOW_REACH};

/// The softest lining that holds a lock, and the speed where it does.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LeastStiffness {
    /// Stiffness `k_p` under one blade \[N/m\].
    pub stiffness_n_per_m: f64,
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
}

/// The stiffness that a lining needs at a speed \[N/m\]; infinite where no lock exists.
fn needed(machine: &Machine, speed: f64) -> f64 {
    let polygon = &machine.polygon;
    let nu = machine.nu(speed).abs();
    let outward = machine.casing_mass * nu * nu - machine.casing_stiffness;
    let drag = machine.casing_damping * nu;
    let left = outward * polygon.delta.tan() - drag;
    if left <= 0.0 {
        return f64::INFINITY;
    }
    let stiffness = outward.hypot(drag).powi(2) / ((2.0 * polygon.delta).sin() * left);
    stiffness / f64::from(polygon.blades_per_side)
}

/// The speed at this logarithm of its excess over the lock of rigid contact.
fn speed_at(lock: f64, excess: f64) -> f64 {
    lock * (1.0 + excess.exp())
}

/// The softest lining of this machine that holds a lock; zero at the critical speed
/// where the casing has no damping.
///
/// # Errors
/// Blades that give or rub (`kappa` or `mu` other than 0), a preload, or no corners.
pub fn least_lock_stiffness(machine: &Machine) -> Result<LeastStiffness, HarmonicError> {
    let lock = lock_of(machine)?;
    if machine.casing_damping == 0.0 {
        return Ok(LeastStiffness { stiffness_n_per_m: 0.0, speed_rad_s: lock });
    }
    let excess = bottom(machine, lock);
    let speed_rad_s = speed_at(lock, excess);
    Ok(LeastStiffness { stiffness_n_per_m: needed(machine, speed_rad_s), speed_rad_s })
}

/// The lock of rigid contact, where the closed form holds.
fn lock_of(machine: &Machine) -> Result<f64, HarmonicError> {
    for (key, value) in [
        ("bladed_disk.radial_coupling", machine.radial_coupling),
        ("contact.friction", machine.friction),
    ] {
        if value != 0.0 {
            let allowed = "0 for the window of a lock on a lining".to_string();
            return Err(HarmonicError::Refused { key, value: value.to_string(), allowed });
        }
    }
    if machine.clearance() <= 0.0 {
        return Err(HarmonicError::Refused {
            key: "casing.radius_m",
            value: (machine.blade_length + machine.clearance()).to_string(),
            allowed: "above bladed_disk.blade_length_m for a lock on a lining".to_string(),
        });
    }
    machine.lock_speed().ok_or_else(|| HarmonicError::no_corner(&machine.polygon))
}

/// Where the needed stiffness is least: it falls to one minimum and rises.
fn bottom(machine: &Machine, lock: f64) -> f64 {
    let of = |excess: f64| needed(machine, speed_at(lock, excess));
    let [low, high] = WINDOW_REACH;
    let place = |k: u32| low + (high - low) * f64::from(k) / f64::from(WINDOW_LOOKS);
    let best = (1..WINDOW_LOOKS).min_by(|&a, &b| of(place(a)).total_cmp(&of(place(b))));
    let best = best.unwrap_or(1);
    let (mut left, mut right) = (place(best - 1), place(best + 1));
    for _ in 0..2 * PEAK_STEPS {
        let [a, b] = [left + (right - left) / 3.0, right - (right - left) / 3.0];
        if of(a) <= of(b) {
            right = b;
        } else {
            left = a;
        }
    }
    0.5 * (left + right)
}

impl Lining<'_> {
    /// The speeds between which this lining holds a lock, of a rotor that turns forward
    /// \[rad/s\]; none where it is too soft at any speed. For `eps -> 0`.
    ///
    /// # Errors
    /// As [`least_lock_stiffness`].
    pub fn lock_window(&self) -> Result<Option<[f64; 2]>, HarmonicError> {
        let machine = self.machine;
        let lock = lock_of(machine)?;
        let [low, high] = WINDOW_REACH;
        let apart = |excess: f64| {
            let needed = needed(machine, speed_at(lock, excess));
            // A difference of logarithms: infinite where there is no lock.
            if needed > self.stiffness_n_per_m { 1.0 } else { -1.0 }
        };
        let ends = if machine.casing_damping == 0.0 { low } else { bottom(machine, lock) };
        if apart(ends) > 0.0 {
            return Ok(None);
        }
        let from =
            if apart(low) > 0.0 { speed_at(lock, between([low, ends], apart)) } else { lock };
        Ok(Some([from, speed_at(lock, between([ends, high], apart))]))
    }
}
