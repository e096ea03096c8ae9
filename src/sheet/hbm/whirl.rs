//! The view `--whirl`: whirl of inclined tips in the limit of many blades, its onset, and the speed
//! at which a lock begins to flutter.

use super::view::{Request, View, all_speeds};
use crate::sheet::Sheet;
use crate::sheet::table::{Column, Table};
use rubscope_solver::harmonic::{
    RoundWhirl, RoundWhirlLoads, Rubbing, SpeedRanges, undamped_flutter_speed,
};
use rubscope_solver::model::Machine;
use rubscope_solver::scene::SceneError;

pub const WHIRL: View = View::new(
    "whirl",
    "View: whirl of inclined tips (limit of many blades), its onset, and the speeds at which a \
     lock flutters",
    fill,
);

fn fill(request: &Request<'_>, sheet: &mut Sheet<'_>) -> Result<(), SceneError> {
    let (machine, toward) = (&request.machine, request.fastest());
    let rows = request.speeds.iter().map(|&speed| WhirlRow::at(machine, speed));
    let rows: Vec<WhirlRow> = rows.collect();
    let ranges = SpeedRanges::new(machine, toward);
    let (whirls, flutter) = (ranges.whirls(), ranges.flutters());
    let mut title = match whirls {
        [] => "No whirl of constant amplitude is found on a rim of many blades".to_string(),
        spans => {
            format!(
                "On a rim of many blades whirl of constant amplitude lasts {}",
                all_speeds(spans)
            )
        }
    };
    if !ranges.growths().is_empty() {
        title += &format!("; a rub grows without bound {}", all_speeds(ranges.growths()));
    }
    title += &match ranges.locks() {
        [] => "; no lock holds at any speed".to_string(),
        locks => format!("; a lock holds {}", all_speeds(locks)),
    };
    if !flutter.is_empty() {
        title += &format!("; blades and casing in lasting contact flutter {}", all_speeds(flutter));
    }
    title.push('.');
    if rows.iter().any(|row| row.state == Rubbing::None) {
        title += UNSTEADY;
    }
    let fluttering: Vec<_> = flutter.iter().map(|range| [Some(range.from), range.to]).collect();
    sheet.fact("whirl_onset_rad_s", whirls.first().map(|span| span.from));
    sheet.fact("flutter_speed_rad_s", flutter.first().map(|range| range.from));
    sheet.fact("flutter_rad_s", fluttering);
    sheet.fact("flutter_undamped_rad_s", undamped_flutter_speed(machine, toward));
    let lock = ranges.locks().first();
    sheet.fact("lock_window_rad_s", lock.map(|window| [Some(window.from), window.to]));
    sheet.table("points", title, Table::of(rows, WHIRLS).shown(8));
    sheet.chart("push of all blades [N]", &[["push_n", "push"]]);
    sheet.chart("casing [m]", &[["casing_m", "casing"]]);
    Ok(())
}

/// Explanation of the state `none`. A wave of constant amplitude can lose its stability to one whose
/// amplitude swings, which no closed form describes.
const UNSTEADY: &str = " Where none is found, a rub may still whirl with an amplitude that swings or, \
    with few sides or little damping, whirl or grow; a run shows it.";

/// What a large rub becomes at a rotor speed \[rad/s\], and the whirl that attracts, with its loads;
/// `None` if none does.
#[derive(Clone, Copy, Debug)]
struct WhirlRow {
    speed_rad_s: f64,
    state: Rubbing,
    wave: Option<(RoundWhirl, RoundWhirlLoads)>,
}

impl WhirlRow {
    fn at(machine: &Machine, speed: f64) -> Self {
        let wave = RoundWhirl::lasting(machine, speed);
        let wave = wave.map(|wave| (wave, wave.loads(machine, speed)));
        Self { speed_rad_s: speed, state: Rubbing::at(machine, speed), wave }
    }
}

/// Columns of whirl. Where none attracts, all but the first two are empty.
const WHIRLS: &[Column<'_, WhirlRow>] = &[
    ("speed_rad_s", |row| row.speed_rad_s.into()),
    ("state", |row| <&str>::from(row.state).into()),
    ("omega_rad_s", |row| row.wave.map(|(wave, _)| wave.omega_rad_s).into()),
    ("s_rad_s", |row| row.wave.map(|(wave, _)| wave.s_rad_s).into()),
    ("growth_per_s", |row| row.wave.map(|(wave, _)| wave.growth_per_s).into()),
    ("push_n", |row| row.wave.map(|(_, loads)| loads.push_n).into()),
    ("casing_m", |row| row.wave.map(|(_, loads)| loads.casing_m).into()),
    ("blade_rad", |row| row.wave.map(|(_, loads)| loads.blade_rad).into()),
    ("stiffness_n_per_m", |row| row.wave.map(|(wave, _)| wave.stiffness_n_per_m).into()),
    ("casing_w", |row| row.wave.map(|(_, loads)| loads.casing_w).into()),
    ("blades_w", |row| row.wave.map(|(_, loads)| loads.blades_w).into()),
    ("friction_w", |row| row.wave.map(|(_, loads)| loads.friction_w).into()),
];
