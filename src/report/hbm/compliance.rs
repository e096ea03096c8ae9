//! The view `--compliance`: the joint compliance `B(omega)` of casing and blades, and the whirl
//! frequencies, where it crosses the negative real axis.

use nalgebra::Complex;
use serde_json::{Value, json};

use super::{Answer, LockBeside, Parts, Request, View};
use crate::report::number::speed;
use crate::report::table::{Column, Table, TableCell};
use rubscope_solver::harmonic::{HarmonicError, RoundWhirl, RoundWhirlLoads, round_whirls};
use rubscope_solver::model::{Frame, Machine};
use rubscope_solver::scene::keys;

pub const COMPLIANCE: View = View {
    option: "compliance",
    help: "View: the joint compliance B(omega), in JSON and CSV; a whirl is where it crosses the \
           negative real axis",
    always_damped: true,
    one_speed: true,
    // The compliance belongs to the structures, with or without a preload.
    lock: LockBeside::Rigid(|error| {
        matches!(error, HarmonicError::Refused { key: keys::CASING_RADIUS, .. })
    }),
    answer,
};

/// Number of frequencies in the table, odd so that 0 is one of them.
const FREQUENCIES: usize = 201;
/// The table extends to this multiple of the highest resonance, in both directions of travel.
const BEYOND: f64 = 1.5;

fn answer(request: &Request<'_>) -> Result<Answer, HarmonicError> {
    let machine = &request.machine;
    let turning = request.fastest();
    let frame = Frame::at(machine, turning);
    let nu = frame.casing.turn;
    let waves = round_whirls(machine, turning).into_iter();
    let waves: Vec<Wave> = waves.map(|wave| (wave, wave.loads(machine, turning))).collect();
    let at = |omega: f64| (omega, omega - nu, frame.turning(omega - nu).compliance());
    let machine = &*machine.at(turning);
    let points: Vec<Point> = beyond_resonance(machine, nu).into_iter().map(at).collect();
    let json = Parts::default()
        .with("speed_rad_s", turning)
        .with_rows("omega_rad_s", &points, |point| json!(point.0))
        .with_rows("re_m_per_n", &points, |point| json!(finite(point.2.re)))
        .with_rows("im_m_per_n", &points, |point| json!(finite(point.2.im)))
        .with("waves", waves.iter().map(value).collect::<Vec<_>>());
    let shown = format!("at {}", speed(request.fastest()));
    let crossings = if waves.is_empty() {
        format!("B(omega) does not cross the negative real axis {shown}: nothing whirls.")
    } else {
        format!("Where B(omega) crosses the negative real axis {shown}:")
    };
    // On a preloaded lining, stability depends on the amplitude, which this view does not know.
    let columns = if machine.clearance() <= 0.0 { PRESSED } else { WAVES };
    let tables = vec![(crossings, Table::of(&waves, columns))];
    let json = Parts::default().with("compliance", json);
    Ok(Answer { json, tables, file: Some(Table::of(&points, POINTS)) })
}

/// A whirl (a wave that blades and casing carry round together), and its loads.
type Wave = (RoundWhirl, RoundWhirlLoads);

/// Frequency of the wave in the fixed frame and in the frame of the blades \[rad/s\], and the joint
/// compliance there \[m/N\].
type Point = (f64, f64, Complex<f64>);

/// Returns evenly spaced frequencies in the fixed frame \[rad/s\], symmetric about 0 and up to
/// beyond every resonance. Negative ones belong to waves that travel backward.
fn beyond_resonance(machine: &Machine, nu: f64) -> Vec<f64> {
    let reach = BEYOND * machine.omega_c.max(nu.abs() + machine.omega_bd);
    let part = |n: usize| n as f64 / (FREQUENCIES - 1) as f64;
    (0..FREQUENCIES).map(|n| reach * part(n) - reach * (1.0 - part(n))).collect()
}

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

/// Returns a whirl as JSON. Its loads and its stability are `null` if the loads are negative, which
/// means that they do not exist: there is no clearance.
fn value((wave, loads): &Wave) -> Value {
    let over = loads.casing_m >= 0.0;
    let loaded = |load: f64| over.then_some(load);
    json!({
        "omega_rad_s": wave.omega_rad_s,
        "s_rad_s": wave.s_rad_s,
        "attracts": over.then_some(wave.attracts),
        "growth_per_s": over.then_some(wave.growth_per_s),
        "stiffness_n_per_m": wave.stiffness_n_per_m,
        "push_n": loaded(loads.push_n),
        "casing_m": loaded(loads.casing_m),
        "blade_rad": loaded(loads.blade_rad),
        "casing_w": loaded(loads.casing_w),
        "blades_w": loaded(loads.blades_w),
        "friction_w": loaded(loads.friction_w),
    })
}

/// Columns of the whirls if there is a clearance.
const WAVES: &[Column<'_, Wave>] =
    &waves(|wave| if wave.0.attracts { "attracts" } else { "threshold" }.into());

/// Columns of the whirls on a preloaded lining.
const PRESSED: &[Column<'_, Wave>] = &waves(|_| "see --smooth".into());

const fn waves(state: fn(&Wave) -> TableCell) -> [Column<'static, Wave>; 7] {
    [
        ("omega_rad_s", |wave| wave.0.omega_rad_s.into()),
        ("s_rad_s", |wave| wave.0.s_rad_s.into()),
        ("state", state),
        ("stiffness_n_per_m", |wave| wave.0.stiffness_n_per_m.into()),
        ("push_n", |wave| loaded(wave.1.push_n)),
        ("casing_m", |wave| loaded(wave.1.casing_m)),
        ("blade_rad", |wave| loaded(wave.1.blade_rad)),
    ]
}

/// Returns the cell of a load; a negative value stands for a load that does not exist.
fn loaded(load: f64) -> TableCell {
    Some(load).filter(|load| *load >= 0.0).into()
}

const POINTS: &[Column<'_, Point>] = &[
    ("omega_rad_s", |point| point.0.into()),
    ("s_rad_s", |point| point.1.into()),
    ("re_m_per_n", |point| finite(point.2.re).into()),
    ("im_m_per_n", |point| finite(point.2.im).into()),
];
