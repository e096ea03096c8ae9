//! The view `--excitation`: response of the damped lock to the engine order of the scene.

use super::view::{Request, View};
use crate::sheet::Sheet;
use crate::sheet::number::short;
use crate::sheet::table::{Column, Table};
use rubscope_solver::harmonic::{ExcitedLock, drives, excited_locks};
use rubscope_solver::scene::{SceneError, keys};

pub const EXCITATION: View = View::new(
    "excitation",
    "View: response of the damped lock to the scene's engine-order excitation",
    fill,
);

fn fill(request: &Request<'_>, sheet: &mut Sheet<'_>) -> Result<(), SceneError> {
    let (machine, excitation) = (request.scene.machine(), &request.scene.excitation);
    let side = request.lock()?.corner().a;
    if excitation.amplitude_nm <= 0.0 {
        let allowed = "above 0 with --excitation, such as --set excitation.amplitude_nm=10";
        return Err(SceneError::refused(keys::EXCITATION, excitation.amplitude_nm, allowed));
    }
    let reaches = drives(&machine, excitation.order);
    let locks = excited_locks(&machine, side, excitation, request.speeds)?;
    let words = match reaches {
        true => ": amplitudes about the damped lock.",
        false => " does not drive these modes: E is not +-n_d modulo N.",
    };
    let amplitude = short(excitation.amplitude_nm);
    let title =
        format!("Engine order {} with {amplitude} N m on each blade{words}", excitation.order);
    sheet.fact("amplitude_nm", excitation.amplitude_nm);
    sheet.fact("order", excitation.order);
    sheet.fact("drives", reaches);
    sheet.table("points", title, Table::of(locks, RESPONSE).shown(8));
    sheet.chart("casing [m]", &[["casing_m", "casing"]]);
    Ok(())
}

/// Columns of the response: amplitudes of the oscillation about the lock.
const RESPONSE: &[Column<'_, ExcitedLock>] = &[
    ("speed_rad_s", |lock| lock.state.speed_rad_s.into()),
    ("frequency_rad_s", |lock| lock.frequency_rad_s.into()),
    ("alpha_c_rad", |lock| lock.response[2].norm().into()),
    ("casing_m", |lock| lock.casing_m().into()),
    ("change_of_amplitude", |lock| lock.relative_amplitude.into()),
    ("change_of_multiplier", |lock| lock.relative_multiplier.into()),
    ("release_torque_nm", |lock| lock.release_torque_nm.into()),
    ("character", |lock| lock.state.character.into()),
    ("alpha_s_rad", |lock| lock.response[3].norm().into()),
    ("multiplier_a_n", |lock| lock.multipliers_n[0].norm().into()),
    ("multiplier_b_n", |lock| lock.multipliers_n[1].norm().into()),
];
