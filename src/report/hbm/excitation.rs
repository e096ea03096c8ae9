//! The view `--excitation`: response of the damped lock to the engine order of the scene.

use serde_json::{Value, json};

use super::{Answer, LockBeside, Parts, Request, View};
use crate::report::number::short;
use crate::report::table::{Column, Table};
use rubscope_solver::harmonic::{ExcitedLock, ExcitedLocks, HarmonicError, drives};
use rubscope_solver::scene::keys;

pub const EXCITATION: View = View {
    option: "excitation",
    help: "View: response of the damped lock to the scene's engine-order excitation",
    always_damped: true,
    one_speed: false,
    lock: LockBeside::Rigid(|_| false),
    answer,
};

fn answer(request: &Request<'_>) -> Result<Answer, HarmonicError> {
    let (machine, excitation) = (request.scene.machine(), &request.scene.excitation);
    let side = request.corner()?.a;
    if excitation.amplitude_nm <= 0.0 {
        let allowed = "above 0 with --excitation, such as --set excitation.amplitude_nm=10";
        return Err(HarmonicError::refused(keys::EXCITATION, excitation.amplitude_nm, allowed));
    }
    let reaches = drives(&machine, excitation.order);
    let found = ExcitedLocks::over(&machine, side, excitation, request.speeds)?;
    let locks = (0..found.places()).filter_map(|place| found.lock_at(place).transpose());
    let locks = locks.collect::<Result<Vec<ExcitedLock>, _>>()?;
    let words = match reaches {
        true => ": amplitudes about the damped lock.",
        false => " does not drive the modes of these diameters: E is not +-n_d modulo N.",
    };
    let amplitude = short(excitation.amplitude_nm);
    let title =
        format!("Engine order {} with {amplitude} N m on each blade{words}", excitation.order);
    let json = Parts::default()
        .with("amplitude_nm", excitation.amplitude_nm)
        .with("order", excitation.order)
        .with("drives", reaches)
        .with_rows("points", &locks, value);
    let json = Parts::default().with("excitation", json);
    Ok(Answer::of(json, vec![(title, Table::of(&locks, RESPONSE))]))
}

/// Returns the response at one speed as JSON, with amplitudes of the oscillation.
fn value(lock: &ExcitedLock) -> Value {
    json!({
        "speed_rad_s": lock.state.speed_rad_s,
        "frequency_rad_s": lock.frequency_rad_s,
        "character": lock.state.character,
        "casing_m": lock.casing_m(),
        "alpha_c_rad": lock.response[2].norm(),
        "alpha_s_rad": lock.response[3].norm(),
        "multipliers_n": lock.multipliers_n.map(|multiplier| multiplier.norm()),
        "relative_amplitude": lock.relative_amplitude,
        "relative_multiplier": lock.relative_multiplier,
        "release_torque_nm": lock.release_torque_nm,
    })
}

const RESPONSE: &[Column<'_, ExcitedLock>] = &[
    ("speed_rad_s", |lock| lock.state.speed_rad_s.into()),
    ("frequency_rad_s", |lock| lock.frequency_rad_s.into()),
    ("alpha_c_rad", |lock| lock.response[2].norm().into()),
    ("casing_m", |lock| lock.casing_m().into()),
    ("change_of_amplitude", |lock| lock.relative_amplitude.into()),
    ("change_of_multiplier", |lock| lock.relative_multiplier.into()),
    ("release_torque_nm", |lock| lock.release_torque_nm.into()),
    ("state", |lock| lock.state.character.as_ref().into()),
];
