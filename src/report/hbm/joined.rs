//! Reports of blades and casing as one: whirl in the limit of many blades, and
//! the joint compliance, as JSON, tables and a chart of text.

use std::f64::consts::PI;
use std::rc::Rc;

use nalgebra::Complex;
use serde_json::{Value, json};

use super::parts::Parts;
use crate::report::table::MadeTable;
use crate::report::table::{Column, Table, TableCell};
use rubscope_solver::harmonic::{Joint, RoundWhirl, RoundWhirlLoads, round_whirls};
use rubscope_solver::model::Machine;

/// Columns and rows of the chart of the compliance.
const CHART: (usize, usize) = (72, 24);
/// Points of the chart about each resonance.
const CHART_POINTS: usize = 4000;
/// How far the chart goes beyond the crossing that is furthest left.
const CHART_REACH: f64 = 2.5;

/// The lasting whirl at one speed, if there is one, with its loads.
#[derive(Clone, Copy, Debug)]
pub struct WhirlRow {
    speed_rad_s: f64,
    wave: Option<(RoundWhirl, RoundWhirlLoads)>,
}

impl WhirlRow {
    /// Finds the lasting whirl of a machine at a speed \[rad/s\].
    #[must_use]
    pub fn at(machine: &Machine, speed: f64) -> Self {
        let joint = Joint::at(machine, speed);
        let lasting = RoundWhirl::lasting(&round_whirls(&joint));
        // Without a coupling every undamped resonance would do.
        let rubs = joint.machine.clearance() > 0.0 && joint.coupling_product != 0.0;
        let open = lasting.filter(|_| rubs);
        Self { speed_rad_s: speed, wave: open.map(|wave| (wave, wave.loads(&joint))) }
    }
}

/// The joint compliance at one frequency.
#[derive(Clone, Copy, Debug)]
pub struct CompliancePoint {
    omega_rad_s: f64,
    s_rad_s: f64,
    value: Complex<f64>,
}

impl CompliancePoint {
    /// At a frequency of the casing \[rad/s\].
    #[must_use]
    pub fn at(joint: &Joint, omega: f64) -> Self {
        Self { omega_rad_s: omega, s_rad_s: omega - joint.nu, value: joint.compliance(omega) }
    }
}

/// Returns the whirl at one speed as JSON, with `null` for each figure where there is none.
#[must_use]
pub fn whirl(row: &WhirlRow) -> Value {
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

/// A wave on the rim in JSON.
fn wave((wave, loads): &(RoundWhirl, RoundWhirlLoads)) -> Value {
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

/// Columns of whirl against speed.
const WHIRL: &[Column<'_, WhirlRow>] = &[
    ("speed_rad_s", |row| row.speed_rad_s.into()),
    ("whirl", |row| if row.wave.is_some() { "attracts" } else { "none" }.into()),
    ("omega_rad_s", |row| row.wave.map(|(wave, _)| wave.omega_rad_s).into()),
    ("s_rad_s", |row| row.wave.map(|(wave, _)| wave.s_rad_s).into()),
    ("growth_per_s", |row| row.wave.map(|(wave, _)| wave.growth_per_s).into()),
    ("push_n", |row| row.wave.map(|(_, loads)| loads.push_n).into()),
    ("casing_m", |row| row.wave.map(|(_, loads)| loads.casing_m).into()),
    ("blade_rad", |row| row.wave.map(|(_, loads)| loads.blade_rad).into()),
];

/// Whirl against speed, a row for each.
#[must_use]
pub fn whirl_table(rows: &Rc<Vec<WhirlRow>>) -> MadeTable {
    MadeTable::over(WHIRL, rows)
}

/// The waves on a rim at one speed.
#[must_use]
pub fn wave_table(joint: &Joint, waves: &[RoundWhirl]) -> Table {
    // On a lining that blades press at rest it is the depth that decides.
    let pressed = joint.machine.clearance() <= 0.0;
    let state = |wave: &RoundWhirl| match (pressed, wave.attracts) {
        (true, _) => "see --smooth",
        (false, true) => "attracts",
        (false, false) => "threshold",
    };
    let rows: Vec<_> = waves.iter().map(|wave| (*wave, wave.loads(joint), state(wave))).collect();
    Table::of(
        &rows,
        &[
            ("omega_rad_s", |row| row.0.omega_rad_s.into()),
            ("s_rad_s", |row| row.0.s_rad_s.into()),
            ("state", |row| row.2.into()),
            ("stiffness_n_per_m", |row| row.0.stiffness_n_per_m.into()),
            ("push_n", |row| loaded(row.1.push_n)),
            ("casing_m", |row| loaded(row.1.casing_m)),
            ("blade_rad", |row| loaded(row.1.blade_rad)),
        ],
    )
}

/// A load of a wave as large as the clearance; none without a clearance.
fn loaded(load: f64) -> TableCell {
    Some(load).filter(|load| *load >= 0.0).into()
}

/// The joint compliance in JSON, at casing frequencies \[rad/s\].
#[must_use]
pub fn compliance(joint: &Joint, points: &Rc<Vec<CompliancePoint>>, waves: &[RoundWhirl]) -> Parts {
    let waves: Vec<_> = waves.iter().map(|found| wave(&(*found, found.loads(joint)))).collect();
    Parts::default()
        .with_whole("speed_rad_s", joint.nu / joint.machine.nodal_diameters)
        .with_rows("omega_rad_s", points, |point| json!(point.omega_rad_s))
        .with_rows("re_m_per_n", points, |point| json!(finite(point.value.re)))
        .with_rows("im_m_per_n", points, |point| json!(finite(point.value.im)))
        .with_whole("waves", waves)
}

fn finite(value: f64) -> Option<f64> {
    Some(value).filter(|value| value.is_finite())
}

/// Columns of the joint compliance.
const COMPLIANCE: &[Column<'_, CompliancePoint>] = &[
    ("omega_rad_s", |point| point.omega_rad_s.into()),
    ("s_rad_s", |point| point.s_rad_s.into()),
    ("re_m_per_n", |point| finite(point.value.re).into()),
    ("im_m_per_n", |point| finite(point.value.im).into()),
];

/// The same as a table for files.
#[must_use]
pub fn compliance_table(points: &Rc<Vec<CompliancePoint>>) -> MadeTable {
    MadeTable::over(COMPLIANCE, points)
}

/// The curve of the compliance in the complex plane, one line of text a row: the axes,
/// `*` where a wave attracts and `o` at its threshold.
#[must_use]
pub fn compliance_chart(joint: &Joint, waves: &[RoundWhirl]) -> Table {
    let machine = &*joint.machine;
    let resonances = [
        (machine.omega_c, machine.casing_damping_ratio * machine.omega_c),
        (-machine.omega_c, machine.casing_damping_ratio * machine.omega_c),
        (joint.nu + machine.omega_bd, machine.blade_damping_ratio * machine.omega_bd),
        (joint.nu - machine.omega_bd, machine.blade_damping_ratio * machine.omega_bd),
    ];
    // Equal angles about a resonance are nearly equal steps along its circle.
    let around = |(centre, width): (f64, f64)| {
        (1..CHART_POINTS).map(move |k| {
            let angle = PI * (k as f64 / CHART_POINTS as f64 - 0.5);
            centre + width * angle.tan()
        })
    };
    let curve: Vec<_> =
        resonances.into_iter().flat_map(around).map(|omega| joint.compliance(omega)).collect();
    let crossing = waves.iter().map(|wave| wave.stiffness_n_per_m.recip()).fold(0.0, f64::max);
    let largest = |most: f64, size: f64| if size.is_finite() { most.max(size) } else { most };
    let reach = if crossing > 0.0 {
        CHART_REACH * crossing
    } else {
        curve.iter().map(|value| value.re.abs().max(value.im.abs())).fold(0.0, largest)
    };
    let (columns, rows) = CHART;
    let mut cells = vec![vec![' '; columns + 1]; rows + 1];
    let mut put = |re: f64, im: f64, mark: char| {
        let column = (0.5 + 0.5 * re / reach) * columns as f64;
        let row = (0.5 - 0.5 * im / reach) * rows as f64;
        if column >= 0.0 && row >= 0.0 && column.is_finite() && row.is_finite() {
            let cell = cells.get_mut(row.round() as usize);
            if let Some(cell) = cell.and_then(|row| row.get_mut(column.round() as usize)) {
                *cell = mark;
            }
        }
    };
    for k in 0..=columns {
        put((2.0 * k as f64 / columns as f64 - 1.0) * reach, 0.0, '-');
    }
    for k in 0..=rows {
        put(0.0, (2.0 * k as f64 / rows as f64 - 1.0) * reach, '|');
    }
    put(0.0, 0.0, '+');
    for value in &curve {
        put(value.re, value.im, '.');
    }
    for wave in waves {
        let mark = if wave.attracts { '*' } else { 'o' };
        put(-wave.stiffness_n_per_m.recip(), 0.0, mark);
    }
    let title = format!("-{reach:.3e} to {reach:.3e} both ways; * attracts, o is the threshold");
    let mut chart = Table::new([title]);
    for row in cells {
        let line: String = row.into_iter().collect();
        chart.push(vec![line.trim_end().to_string().into()]);
    }
    chart
}
