//! The views of `rubscope hbm` on blades and casing as one: whirl, and the joint
//! compliance in the complex plane.

use std::rc::Rc;

use super::hbm_views::Answer;
use super::range::linspace;
use crate::harmonic::{
    HarmonicError, Joint, WhirlPoint, flutter_speed, round_whirls, undamped_flutter_speed,
    whirl_onset, whirl_over,
};
use crate::model::Machine;
use crate::report::hbm::{self as report, CompliancePoint, HbmReport, WhirlRow};
use crate::report::number::short;

/// Frequencies of the table of the compliance.
const FREQUENCIES: usize = 201;
/// How far beyond the fastest resonance they go.
const BEYOND: f64 = 1.5;

/// Whirl against speed, and where it begins and ends.
pub(super) fn whirling(
    json: HbmReport,
    machine: &Machine,
    speeds: &[f64],
    fastest: f64,
) -> Result<Answer, HarmonicError> {
    let row = |point: WhirlPoint| WhirlRow::of(machine, point);
    let rows: Rc<Vec<WhirlRow>> =
        Rc::new(whirl_over(machine, speeds)?.into_iter().map(row).collect());
    let onset = whirl_onset(machine, fastest);
    let [flutter, undamped] =
        [flutter_speed(machine, fastest), undamped_flutter_speed(machine, fastest)];
    let window = machine.lock_window(fastest);
    let told = |speed: f64| format!("{} rad/s", short(speed));
    let mut title = match onset {
        Some(onset) => format!("On a rim of many blades whirl begins at {}", told(onset)),
        None => "Nothing whirls on a rim of many blades".to_string(),
    };
    title += &match window {
        Some(window) => format!("; a lock holds from {} rad/s", report::speeds_of(window)),
        None => "; no lock holds at any speed".to_string(),
    };
    title += &match flutter {
        Some(limit) => format!("; blades and casing as one flutter above {}.", told(limit)),
        None => ".".to_string(),
    };
    let json = json
        .with("whirl_onset_rad_s", onset)
        .with("flutter_speed_rad_s", flutter)
        .with("flutter_undamped_rad_s", undamped)
        .with("lock_window_rad_s", window.map(|window| [Some(window.from), window.to]))
        .with_rows("whirl", &rows, report::whirl);
    Ok(Answer::of(json, vec![(title, report::whirl_table(&rows))]))
}

/// The joint compliance at one speed, over frequencies of the casing \[rad/s\].
pub(super) fn compliance(
    json: HbmReport,
    machine: &Machine,
    speed: f64,
    omegas: Option<&[f64]>,
) -> Result<Answer, HarmonicError> {
    let joint = Joint::at(machine, speed);
    let resonances = [machine.omega_c, joint.nu.abs() + machine.omega_bd];
    let reach = BEYOND * resonances[0].max(resonances[1]);
    let range = omegas.map_or_else(|| linspace(-reach, reach, FREQUENCIES), <[f64]>::to_vec);
    let waves = round_whirls(&joint);
    let chart = report::compliance_chart(&joint, &waves);
    let at = format!("at {} rad/s", short(speed));
    let title = format!("B(omega) {at}, real part to the right, imaginary part up [m/N]:");
    let crossings = if waves.is_empty() {
        format!("B(omega) does not cross the negative real axis {at}: nothing whirls.")
    } else {
        format!("Where B(omega) crosses the negative real axis {at}:")
    };
    let points = Rc::new(range.iter().map(|&omega| CompliancePoint::at(&joint, omega)).collect());
    let file = report::compliance_table(&points);
    let json = json.with_parts("compliance", report::compliance(&joint, &points, &waves));
    let tables = vec![(title, chart), (crossings, report::wave_table(&joint, &waves))];
    Ok(Answer { file, ..Answer::of(json, tables) })
}
