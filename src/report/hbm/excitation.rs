//! The response of a locked motion to an engine order.

use serde::Serialize;

use crate::harmonic::ExcitedLock;
use crate::model::Excitation;
use crate::report::table::Table;

/// The response in JSON.
#[derive(Clone, Debug, Serialize)]
pub struct ExcitationReport {
    amplitude_nm: f64,
    order: u32,
    /// Whether this order drives the modes of `n_d` diameters at all.
    drives: bool,
    points: Vec<ResponseReport>,
}

#[derive(Clone, Debug, Serialize)]
struct ResponseReport {
    speed_rad_s: f64,
    frequency_rad_s: f64,
    character: &'static str,
    casing_m: f64,
    alpha_c_rad: f64,
    alpha_s_rad: f64,
    multipliers_n: [f64; 2],
    relative_amplitude: f64,
    relative_multiplier: f64,
    release_torque_nm: Option<f64>,
}

impl ExcitationReport {
    /// Of these responses; amplitudes of oscillation.
    #[must_use]
    pub fn of(excitation: &Excitation, drives: bool, found: &[ExcitedLock]) -> Self {
        let point = |lock: &ExcitedLock| ResponseReport {
            speed_rad_s: lock.state.speed,
            frequency_rad_s: lock.frequency,
            character: lock.state.character.word(),
            casing_m: casing(lock),
            alpha_c_rad: lock.response[2].norm(),
            alpha_s_rad: lock.response[3].norm(),
            multipliers_n: lock.multipliers.map(|multiplier| multiplier.norm()),
            relative_amplitude: lock.relative_amplitude,
            relative_multiplier: lock.relative_multiplier,
            release_torque_nm: lock.release_torque,
        };
        Self {
            amplitude_nm: excitation.amplitude_nm,
            order: excitation.order,
            drives,
            points: found.iter().map(point).collect(),
        }
    }
}

fn casing(lock: &ExcitedLock) -> f64 {
    lock.response[0].norm().hypot(lock.response[1].norm())
}

/// The response, a row for each speed.
#[must_use]
pub fn excitation_table(found: &[ExcitedLock]) -> Table {
    let mut table = Table::new(&[
        "speed_rad_s",
        "frequency_rad_s",
        "alpha_c_rad",
        "casing_m",
        "change_of_amplitude",
        "change_of_multiplier",
        "release_torque_nm",
        "state",
    ]);
    for lock in found {
        table.push(vec![
            lock.state.speed.into(),
            lock.frequency.into(),
            lock.response[2].norm().into(),
            casing(lock).into(),
            lock.relative_amplitude.into(),
            lock.relative_multiplier.into(),
            lock.release_torque.into(),
            lock.state.character.word().into(),
        ]);
    }
    table
}
