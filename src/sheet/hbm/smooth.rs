//! The view `--smooth`: steady states of blades on a lining. With a preload these are rest and its
//! limit cycles; with a clearance they are locks and whirl, with the least stiffness that holds a
//! lock.

use super::view::{Request, View, all_speeds};
use crate::sheet::Sheet;
use crate::sheet::number::{short, speed};
use crate::sheet::table::{Column, Table, TableCell, columns};
use rubscope_solver::harmonic::{
    Cycle, HopfPoint, Lining, LiningState, Rest, growth_threshold, least_lock_stiffness,
    lock_windows, shifted_coincidence,
};
use rubscope_solver::scene::{ContactLaw, SceneError, keys};

pub const SMOOTH: View = View {
    rigid: None,
    ..View::new(
        "smooth",
        "View: steady states of blades on a lining (solver.contact = \"smooth\"): rest, limit \
         cycles, locks, and the linings that can hold a lock",
        fill,
    )
};

/// Rest at one rotor speed, whether large waves stay bounded there, and the stable limit cycle, if
/// there is one.
type RestRow = (Rest, bool, Option<Cycle>);

fn fill(request: &Request<'_>, sheet: &mut Sheet<'_>) -> Result<(), SceneError> {
    let Request { scene, machine, speeds, .. } = request;
    if scene.solver.contact != ContactLaw::Smooth {
        let allowed = "\"smooth\" with --smooth: only a lining has these steady states";
        return Err(SceneError::refused(keys::LAW, scene.solver.contact, allowed));
    }
    let lining = Lining::of(machine, &scene.contact)?;
    let (mut states, mut cycles, mut rests): (Vec<LiningState>, Vec<Cycle>, Vec<RestRow>) =
        Default::default();
    for &speed in *speeds {
        states.extend(lining.states(speed)?);
        let here = lining.cycles(speed)?;
        let lasting = here.iter().find(|cycle| cycle.stable).copied();
        rests.push((lining.rest(speed), lining.is_bounded(speed), lasting));
        cycles.extend(here);
    }
    let from = speeds.iter().copied().fold(f64::INFINITY, f64::min);
    let to = speeds.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let fastest = request.fastest();
    let pressed = lining.stiffness_at_rest() > 0.0;
    let hopf = if pressed && from < to { lining.hopf_points([from, to])? } else { Vec::new() };
    let shifted = shifted_coincidence(scene, fastest);
    let threshold = growth_threshold(machine, fastest);
    let (locks, least) = (lock_windows(machine, fastest), least_lock_stiffness(machine));
    let window = locks.first();
    sheet.fact("preload_m", lining.preload_m());
    sheet.fact("stiffness_at_rest_n_per_m", lining.stiffness_at_rest());
    sheet.fact("shifted_coincidence_rad_s", shifted);
    sheet.fact("threshold_n_per_m", threshold.map(|least| least.stiffness_n_per_m));
    sheet.fact("threshold_rad_s", threshold.map(|least| least.speed_rad_s));
    sheet.fact("lock_from_rad_s", window.map(|window| window.from));
    sheet.fact("lock_to_rad_s", window.and_then(|window| window.to));
    sheet.fact("least_stiffness_n_per_m", least.map(|least| least.stiffness_n_per_m));
    sheet.fact("least_stiffness_rad_s", least.map(|least| least.speed_rad_s));
    let whirl = "Whirl, waves that turn against the blades:";
    match cycles.is_empty() || pressed {
        true => sheet.filed(Some("cycles"), Table::of(cycles, CYCLES)),
        false => sheet.table("cycles", whirl, Table::of(cycles, CYCLES)),
    }
    if pressed {
        let title = pressed_title(&lining, shifted, &hopf);
        sheet.filed(Some("hopf"), Table::of(hopf, HOPF));
        sheet.table("points", title, Table::of(rests, RESTS));
        sheet.chart("growth from rest [1/s]", &[["growth_1_s", "growth"]]);
        return Ok(());
    }
    let mut title = "Steady states in the frame of the blades.".to_string();
    if let Some(least) = least {
        let held = if locks.is_empty() { "at no speed".into() } else { all_speeds(&locks) };
        title += &format!(
            " Without smoothing a lock of two groups needs a lining of at least {} N/m (at {}); one \
             of {} N/m holds it {held}.",
            short(least.stiffness_n_per_m),
            speed(least.speed_rad_s),
            short(lining.law.stiffness_n_per_m)
        );
    }
    sheet.table("points", title, Table::of(states, STATES).shown(9));
    Ok(())
}

fn pressed_title(lining: &Lining<'_>, shifted: Option<f64>, hopf: &[HopfPoint]) -> String {
    let mut title = format!(
        "At rest every blade is {} m deep in the lining; together they press with {} N/m.",
        short(lining.preload_m()),
        short(lining.stiffness_at_rest())
    );
    if let Some(shifted) = shifted {
        title += &format!(" Coincidence on the lining {}.", speed(shifted));
    }
    let change = |point: &HopfPoint| {
        let change = if point.grows_above { "grows from" } else { "decays from" };
        format!("{change} {}", speed(point.speed_rad_s))
    };
    let changes: Vec<String> = hopf.iter().map(change).collect();
    match changes.is_empty() {
        true => title + " Between these speeds no wave begins or ceases to grow.",
        false => title + &format!(" A wave {}.", changes.join(", ")),
    }
}

/// Columns of the Hopf points: the speeds at which a wave about rest begins or ceases to grow.
const HOPF: &[Column<'_, HopfPoint>] = &columns! {
    speed_rad_s, s_rad_s, omega_rad_s, grows_above,
};

/// Columns of rest under a preload, with its stable limit cycle.
const RESTS: &[Column<'_, RestRow>] = &[
    ("speed_rad_s", |row| row.0.speed_rad_s.into()),
    ("growth_1_s", |row| row.0.worst().growth_1_s.into()),
    ("s_rad_s", |row| row.0.worst().s_rad_s.into()),
    ("omega_rad_s", |row| row.0.worst().omega_rad_s.into()),
    ("cycle_omega_rad_s", |row| row.2.map(|cycle| cycle.omega_rad_s).into()),
    ("gap_amplitude_m", |row| row.2.map(|cycle| cycle.gap_amplitude_m).into()),
    ("casing_m", |row| row.2.map(|cycle| cycle.casing_m).into()),
    ("blade_rad", |row| row.2.map(|cycle| cycle.blade_rad).into()),
    ("rest", |(rest, bounded, cycle)| {
        match (rest.grows, cycle, bounded) {
            (false, None, _) => "decays",
            (false, Some(_), _) => "decays, a wave lasts",
            (true, Some(_), _) => "grows to a wave",
            (true, None, true) => "grows",
            (true, None, false) => "grows without bound",
        }
        .into()
    }),
];

/// Columns of the limit cycles.
const CYCLES: &[Column<'_, Cycle>] = &columns! {
    speed_rad_s, omega_rad_s, s_rad_s, gap_amplitude_m, casing_m, blade_rad, growth_1_s,
    character: |cycle| word(cycle.stable),
};

/// Columns of the waves that are at rest in the frame of the blades, with the first blade of each
/// group that pushes.
const STATES: &[Column<'_, LiningState>] = &columns! {
    speed_rad_s, pushing,
    push_a_n: |state| state.pushes.first().map(|push| push.push_n).into(),
    push_b_n: |state| state.pushes.get(1).map(|push| push.push_n).into(),
    push_c_n: |state| state.pushes.get(2).map(|push| push.push_n).into(),
    casing_m, blade_rad, growth_1_s,
    character: |state| word(state.stable),
    frequency_rad_s,
    blade_a: |state| state.pushes.first().and_then(|push| push.blades.first()).into(),
    blade_b: |state| state.pushes.get(1).and_then(|push| push.blades.first()).into(),
    blade_c: |state| state.pushes.get(2).and_then(|push| push.blades.first()).into(),
};

fn word(stable: bool) -> TableCell {
    if stable { "stable" } else { "unstable" }.into()
}
