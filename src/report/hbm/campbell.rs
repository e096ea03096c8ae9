//! The view `--campbell`: frequencies against speed, engine orders, and the coincidences (30).

use serde_json::{Value, json};

use super::{Answer, LockBeside, Parts, Request, View};
use crate::report::table::{Column, Table, TableCell};
use rubscope_solver::harmonic::{Campbell, Coincidence, HarmonicError, Line};

pub const CAMPBELL: View = View {
    option: "campbell",
    help: "View: frequencies against speed, engine orders, and the coincidences (30)",
    always_damped: false,
    one_speed: false,
    // Frequencies exist without a corner, rigid contact or a harmonic balance.
    lock: LockBeside::Rigid(|error| {
        matches!(error, HarmonicError::NoCorner { .. } | HarmonicError::Refused { .. })
    }),
    answer,
};

/// Engine orders drawn in addition to the scene's.
const ORDERS: [u32; 4] = [1, 2, 3, 4];

fn answer(request: &Request<'_>) -> Result<Answer, HarmonicError> {
    let excitation = &request.scene.excitation;
    let mut orders = ORDERS.to_vec();
    if excitation.amplitude_nm > 0.0 && !orders.contains(&excitation.order) {
        orders.push(excitation.order);
    }
    let campbell = Campbell::of(&request.machine, &orders, request.fastest())?;
    let (lines, speeds) = (&campbell.lines, request.speeds);
    let json = Parts::default()
        .with("speed_rad_s", speeds)
        .with_rows("lines", lines, |line| value(line, speeds))
        .with("coincidences", &campbell.coincidences);
    let coincidences = "Coincidences +-omega_c = n_d Omega +- omega_bd, Eq. (30):".to_string();
    let title = "Frequencies in the standing frame [rad/s]:".to_string();
    let tables = vec![
        (coincidences, Table::of(&campbell.coincidences, COINCIDENCES)),
        (title, table(lines, speeds)),
    ];
    Ok(Answer::of(Parts::default().with("campbell", json), tables))
}

fn value(line: &Line, speeds: &[f64]) -> Value {
    let frequencies: Vec<f64> = speeds.iter().map(|&speed| line.at(speed)).collect();
    json!({
        "name": line.name,
        "at_standstill_rad_s": line.at_standstill_rad_s,
        "slope": line.slope,
        "frequency_rad_s": frequencies,
    })
}

/// Returns the lines over speed, one per column.
fn table(lines: &[Line], speeds: &[f64]) -> Table {
    let names = lines.iter().map(|line| line.name.clone());
    let mut table = Table::new(std::iter::once("speed_rad_s".to_string()).chain(names));
    for &speed in speeds {
        let lines = lines.iter().map(|line| line.at(speed));
        table.push(std::iter::once(speed).chain(lines).map(TableCell::from).collect());
    }
    table
}

const COINCIDENCES: &[Column<'_, Coincidence>] = &[
    ("speed_rad_s", |found| found.speed_rad_s.into()),
    ("casing_rad_s", |found| found.casing_rad_s.into()),
    ("blades_rad_s", |found| found.blades_rad_s.into()),
    ("dangerous", |found| if found.dangerous { "yes" } else { "no" }.into()),
];
