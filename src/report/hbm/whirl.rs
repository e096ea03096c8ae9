//! The view `--whirl`: whirl of inclined tips in the limit of many blades, its onset, and the speed
//! at which a lock begins to flutter.

use serde_json::{Value, json};

use super::{Answer, LockBeside, Parts, Request, View, speeds_of};
use crate::report::number::{speed, speed_unit};
use crate::report::table::{Column, Table, TableCell};
use rubscope_solver::harmonic::{
    HarmonicError, Joint, RoundWhirl, RoundWhirlLoads, flutters, lock_window, round_whirls,
    undamped_flutter_speed, whirl_onset,
};
use rubscope_solver::model::{LockWindow, Machine};

pub const WHIRL: View = View {
    option: "whirl",
    help: "View: whirl of inclined tips in the limit of many blades, where it begins, and where \
           a lock flutters",
    always_damped: true,
    one_speed: false,
    lock: LockBeside::Rigid(|_| false),
    answer,
};

fn answer(request: &Request<'_>) -> Result<Answer, HarmonicError> {
    let (machine, toward) = (&request.machine, request.fastest());
    let rows = request.speeds.iter().map(|&speed| WhirlRow::at(machine, speed));
    let rows: Vec<WhirlRow> = rows.collect();
    let (onset, flutter) = (whirl_onset(machine, toward), flutters(machine, toward));
    let window = lock_window(machine, toward);
    let mut title = match onset {
        Some(onset) => format!("On a rim of many blades whirl begins at {}", speed(onset)),
        None => "Nothing whirls on a rim of many blades".to_string(),
    };
    title += &match window {
        Some(window) => format!("; a lock holds from {} {}", speeds_of(window), speed_unit()),
        None => "; no lock holds at any speed".to_string(),
    };
    if !flutter.is_empty() {
        let ranges: Vec<String> = flutter.iter().map(|range| between(*range)).collect();
        title += &format!("; blades and casing as one flutter {}", ranges.join(" and "));
    }
    title.push('.');
    let ranges: Vec<_> = flutter.iter().map(|range| [Some(range.from), range.to]).collect();
    let json = Parts::default()
        .with("whirl_onset_rad_s", onset)
        .with("flutter_speed_rad_s", flutter.first().map(|range| range.from))
        .with("flutter_rad_s", ranges)
        .with("flutter_undamped_rad_s", undamped_flutter_speed(machine, toward))
        .with("lock_window_rad_s", window.map(|window| [Some(window.from), window.to]))
        .with_rows("whirl", &rows, value);
    Ok(Answer::of(json, vec![(title, Table::of(&rows, WHIRLS))]))
}

/// Describes a range of speeds.
fn between(range: LockWindow) -> String {
    match (range.from, range.to) {
        (0.0, None) => "at every speed".to_string(),
        (0.0, Some(to)) => format!("up to {}", speed(to)),
        (from, None) => format!("above {}", speed(from)),
        (from, Some(to)) => format!("from {} to {}", speed(from), speed(to)),
    }
}

/// The lasting whirl at one speed, if it exists, and its loads.
#[derive(Clone, Copy, Debug)]
struct WhirlRow {
    speed_rad_s: f64,
    wave: Option<(RoundWhirl, RoundWhirlLoads)>,
}

impl WhirlRow {
    fn at(machine: &Machine, speed: f64) -> Self {
        let joint = Joint::at(machine, speed);
        let lasting = RoundWhirl::lasting(&round_whirls(&joint));
        // Without coupling, every undamped resonance would count as a whirl.
        let rubs = joint.machine.clearance() > 0.0 && joint.coupling_product != 0.0;
        let open = lasting.filter(|_| rubs);
        Self { speed_rad_s: speed, wave: open.map(|wave| (wave, wave.loads(&joint))) }
    }
}

/// Returns the whirl at one speed as JSON, with `null` for a value that does not exist.
fn value(row: &WhirlRow) -> Value {
    let figure = |of: fn(&(RoundWhirl, RoundWhirlLoads)) -> f64| row.wave.as_ref().map(of);
    json!({
        "speed_rad_s": row.speed_rad_s,
        "exists": row.wave.is_some(),
        "omega_rad_s": figure(|(wave, _)| wave.omega_rad_s),
        "s_rad_s": figure(|(wave, _)| wave.s_rad_s),
        "growth_per_s": figure(|(wave, _)| wave.growth_per_s),
        "stiffness_n_per_m": figure(|(wave, _)| wave.stiffness_n_per_m),
        "push_n": figure(|(_, loads)| loads.push_n),
        "casing_m": figure(|(_, loads)| loads.casing_m),
        "blade_rad": figure(|(_, loads)| loads.blade_rad),
        "casing_w": figure(|(_, loads)| loads.casing_w),
        "blades_w": figure(|(_, loads)| loads.blades_w),
        "friction_w": figure(|(_, loads)| loads.friction_w),
    })
}

const WHIRLS: &[Column<'_, WhirlRow>] = &[
    ("speed_rad_s", |row| row.speed_rad_s.into()),
    ("whirl", |row| if row.wave.is_some() { "attracts" } else { "none" }.into()),
    ("omega_rad_s", |row| figure(row, |(wave, _)| wave.omega_rad_s)),
    ("s_rad_s", |row| figure(row, |(wave, _)| wave.s_rad_s)),
    ("growth_per_s", |row| figure(row, |(wave, _)| wave.growth_per_s)),
    ("push_n", |row| figure(row, |(_, loads)| loads.push_n)),
    ("casing_m", |row| figure(row, |(_, loads)| loads.casing_m)),
    ("blade_rad", |row| figure(row, |(_, loads)| loads.blade_rad)),
];

fn figure(row: &WhirlRow, of: fn(&(RoundWhirl, RoundWhirlLoads)) -> f64) -> TableCell {
    row.wave.as_ref().map(of).into()
}
