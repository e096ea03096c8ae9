//! The views of `rubscope hbm` for blades on a lining, `--smooth`, and of a
//! coincidence against speed, `--coincidence`.

use std::rc::Rc;

use clap::Args;

use super::hbm_views::{Answer, Asked};
use super::status::Refusal;
use crate::report::CommandLine;
use crate::report::hbm::{self as report, HbmReport, LiningReport};
use crate::report::number::{per_speed, short, speed, speed_unit};
use crate::report::table::Table;
use rubscope_solver::harmonic::{
    HarmonicError, HopfPoint, Lining, coincidence, growth_threshold, least_lock_stiffness,
    shifted_coincidence,
};
use rubscope_solver::scene::keys;
use rubscope_solver::scene::{ContactLaw, Scene};

/// What is asked of a lining.
#[derive(Args, Debug)]
pub struct LiningOptions {
    /// View: steady states of blades on a lining (solver.contact = "smooth"): rest, the
    /// waves it grows into, locks and which linings hold them
    #[arg(long, group = "view")]
    smooth: bool,
    /// View: what the coincidences do: growth of rest and the wave that lasts, against speed
    #[arg(long, group = "view")]
    coincidence: bool,
}

/// One of these views.
pub(super) enum LiningView {
    /// Steady states.
    Smooth,
    /// Growth and amplitude.
    Coincidence,
}

impl LiningOptions {
    /// The view that these options ask for, if any.
    pub fn view(&self) -> Option<LiningView> {
        match self {
            Self { smooth: true, .. } => Some(LiningView::Smooth),
            Self { coincidence: true, .. } => Some(LiningView::Coincidence),
            _ => None,
        }
    }

    /// These options, added to a command.
    pub fn add_to(&self, command: CommandLine) -> CommandLine {
        command.flag("--smooth", self.smooth).flag("--coincidence", self.coincidence)
    }
}

/// A lock and a slip need a clearance.
pub(super) fn clear(scene: &Scene) -> Result<(), Refusal> {
    if scene.clearance() > 0.0 {
        return Ok(());
    }
    let length = scene.bladed_disk.blade_length_m;
    let allowed = format!(
        "above bladed_disk.blade_length_m = {length} here: hbm --smooth has the steady states of \
         a preloaded lining"
    );
    Err(Refusal::of(keys::CASING_RADIUS, scene.casing.radius_m, allowed))
}

/// Computes a view.
///
/// # Errors
/// What has no meaning, refused by name.
pub(super) fn answer(asked: &Asked, view: &LiningView) -> Result<Answer, Refusal> {
    let scene = asked.scene;
    let machine = scene.machine();
    let json = HbmReport::new(scene, &machine, asked.form, asked.damped, asked.fastest());
    let rigid = scene.solver.contact != ContactLaw::Smooth;
    let option = match view {
        LiningView::Smooth => Some("--smooth"),
        LiningView::Coincidence => None,
    };
    if let Some(option) = option.filter(|_| rigid) {
        let allowed = format!("\"smooth\" with {option}: only a lining has these steady states");
        return Err(Refusal::of(keys::LAW, scene.solver.contact, allowed));
    }
    let answer = match view {
        LiningView::Smooth => smooth(json, asked),
        LiningView::Coincidence => curve(json, asked),
    };
    answer.map_err(|error| Refusal::because(error.to_string()))
}

fn smooth(json: HbmReport, asked: &Asked) -> Result<Answer, HarmonicError> {
    let (scene, speeds) = (asked.scene, asked.speeds);
    let machine = scene.machine();
    let lining = Lining::of(&machine, &scene.contact)?;
    let [from, to] = span(speeds);
    let rubs = lining.stiffness_at_rest() > 0.0;
    let mut found = LiningReport {
        preload_m: lining.preload_m(),
        stiffness_n_per_m: lining.stiffness_at_rest(),
        shifted_rad_s: shifted_coincidence(scene, asked.fastest()),
        threshold: growth_threshold(&machine, asked.fastest()),
        hopf: if rubs && from < to { lining.hopf_points([from, to])? } else { Vec::new() },
        rest: Vec::new(),
        cycles: Vec::new(),
        window: machine.lock_window(asked.fastest()),
        least: least_lock_stiffness(&machine),
        states: Vec::new(),
    };
    for &speed in speeds {
        found.states.extend(lining.states(speed)?);
        found.cycles.extend(lining.cycles(speed)?);
        found.rest.push((lining.rest(speed), lining.is_bounded(speed)));
    }
    let json = json.with("smooth", found.json());
    let tables = if rubs { under_preload(&found) } else { over_clearance(&found, &lining) };
    Ok(Answer::of(json, tables))
}

/// Least and largest speed.
fn span(speeds: &[f64]) -> [f64; 2] {
    let least = speeds.iter().copied().fold(f64::INFINITY, f64::min);
    [least, speeds.iter().copied().fold(f64::NEG_INFINITY, f64::max)]
}

fn under_preload(found: &LiningReport) -> Vec<(String, Table)> {
    let mut title = format!(
        "Rest with all blades pressed in by {} m, together {} N/m.",
        short(found.preload_m),
        short(found.stiffness_n_per_m)
    );
    if let Some(shifted) = found.shifted_rad_s {
        title.push_str(&format!(" Coincidence on the lining {}.", speed(shifted)));
    }
    let changes: Vec<String> = found.hopf.iter().map(change).collect();
    title.push_str(&match changes.len() {
        0 => " Between these speeds nothing begins or ends to grow.".to_string(),
        _ => format!(" A wave {}.", changes.join(", ")),
    });
    vec![(title, report::rest_table(&found.rest, &found.cycles))]
}

fn change(point: &HopfPoint) -> String {
    let change = if point.grows_above { "grows from" } else { "decays from" };
    format!("{change} {}", speed(point.speed_rad_s))
}

fn over_clearance(found: &LiningReport, lining: &Lining) -> Vec<(String, Table)> {
    let mut title = "Steady states in the frame of the blades.".to_string();
    if let Some(least) = found.least {
        title.push_str(&format!(
            " Without smoothing a lock of two groups needs a lining of at least {} N/m (at {}); one of {} N/m ",
            short(least.stiffness_n_per_m),
            speed(least.speed_rad_s),
            short(lining.stiffness_n_per_m)
        ));
        title.push_str(&match found.window {
            Some(window) => {
                format!("holds it from {} {}.", report::speeds_of(window), speed_unit())
            }
            None => "holds it at no speed.".to_string(),
        });
    }
    let states = (title, report::state_table(&found.states));
    if found.cycles.is_empty() {
        return vec![states];
    }
    let title = "Whirl, waves that turn against the blades:".to_string();
    vec![(title, report::cycle_table(&found.cycles)), states]
}

fn curve(json: HbmReport, asked: &Asked) -> Result<Answer, HarmonicError> {
    let scene = asked.scene;
    let points = Rc::new(coincidence(scene, asked.speeds)?);
    let sense = 1_f64.copysign(asked.fastest());
    let markers: Vec<f64> =
        scene.machine().coincidence_speeds().iter().map(|speed| sense * speed).collect();
    let shifted = shifted_coincidence(scene, asked.fastest());
    let shown: Vec<String> = markers.iter().map(|speed| short(per_speed(*speed))).collect();
    let mut title = format!("Coincidences (30) at {} {}", shown.join(" and "), speed_unit());
    if let Some(shifted) = shifted {
        title.push_str(&format!(", on the lining at {}", speed(shifted)));
    }
    let what = if scene.clearance() > 0.0 {
        "the wave that lasts once it touches"
    } else {
        "growth of rest, and the wave it grows into"
    };
    title.push_str(&format!("; {what}:"));
    let json = json.with_parts("coincidence", report::curve(&markers, shifted, &points));
    Ok(Answer::of(json, vec![(title, report::curve_table(&points))]))
}
