//! Which linings hold a lock: closed forms for blades that do not turn the gap
//! (docs/theory.md, section 10).
//!
//! A pair of groups holds the wave where `-tan(delta) Re H - |Im H| >= 1/(k sin 2 delta)`, `H =
//! B(nu)` the joint compliance, `k` the stiffness of one group; without friction and inclined
//! tips `|K| tan delta >= D + (K^2 + D^2)/(k sin 2 delta)`. So a lining needs a least
//! stiffness at each speed, and one that is softer than the least of these never holds a
//! lock. Beyond the last speed of two groups three may go on.

use serde::Serialize;

use crate::harmonic::Joint;
use crate::model::Machine;
use crate::numeric::maximum::highest;
use crate::tolerances::{WINDOW_LOOKS, WINDOW_REACH};

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
    let joint = Joint::at(machine, speed);
    let compliance = joint.compliance(joint.nu);
    let left = -compliance.re * polygon.delta.tan() - compliance.im.abs();
    if left <= 0.0 {
        return f64::INFINITY;
    }
    1.0 / ((2.0 * polygon.delta).sin() * left * f64::from(polygon.blades_per_side))
}

/// The speed at this logarithm of its excess over the lock of rigid contact.
fn speed_at(lock: f64, excess: f64) -> f64 {
    lock * (1.0 + excess.exp())
}

/// The softest lining of this machine that holds a lock of a rotor that turns forward;
/// zero at the critical speed where the casing has no damping. None without a lock of
/// rigid contact.
#[must_use]
pub fn least_lock_stiffness(machine: &Machine) -> Option<LeastStiffness> {
    let lock = machine.clone().with_lining(None).lock_speed()?;
    if machine.casing_damping == 0.0 && !machine.casing_is_joined() {
        return Some(LeastStiffness { stiffness_n_per_m: 0.0, speed_rad_s: lock });
    }
    let excess = bottom(machine, lock);
    let speed_rad_s = speed_at(lock, excess);
    Some(LeastStiffness { stiffness_n_per_m: needed(machine, speed_rad_s), speed_rad_s })
}

/// Where the needed stiffness is least: it falls to one minimum and rises.
fn bottom(machine: &Machine, lock: f64) -> f64 {
    let of = |excess: f64| needed(machine, speed_at(lock, excess));
    let [low, high] = WINDOW_REACH;
    let place = |k: u32| low + (high - low) * f64::from(k) / f64::from(WINDOW_LOOKS);
    let best = (1..WINDOW_LOOKS).min_by(|&a, &b| of(place(a)).total_cmp(&of(place(b))));
    let best = best.unwrap_or(1);
    highest([place(best - 1), place(best + 1)], |excess| -of(excess)).0
}
