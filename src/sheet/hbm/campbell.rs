//! The view `--campbell`: frequencies against speed, engine orders, and the coincidences (30).

use super::view::{Request, View};
use crate::sheet::Sheet;
use crate::sheet::table::{Column, Table, TableCell, columns};
use rubscope_solver::harmonic::{Campbell, Coincidence};
use rubscope_solver::scene::SceneError;

pub const CAMPBELL: View = View {
    always_damped: false,
    // Frequencies exist without a corner, rigid contact or a harmonic balance.
    rigid: Some(|error| !error.is_of("blades")),
    unequal_tips: true,
    out_of_round: true,
    ..View::new(
        "campbell",
        "View: frequencies against speed, engine orders, and the coincidences (30)",
        fill,
    )
};

/// Engine orders drawn in addition to the scene's.
const ORDERS: [u32; 4] = [1, 2, 3, 4];

fn fill(request: &Request<'_>, sheet: &mut Sheet<'_>) -> Result<(), SceneError> {
    let excitation = &request.scene.excitation;
    let mut orders = ORDERS.to_vec();
    if excitation.amplitude_nm > 0.0 && !orders.contains(&excitation.order) {
        orders.push(excitation.order);
    }
    let campbell = Campbell::of(&request.machine, &orders, request.fastest())?;
    let coincidences = "Coincidences +-omega_c = n_d Omega +- omega_bd, Eq. (30):";
    sheet.table("coincidences", coincidences, Table::of(campbell.coincidences, COINCIDENCES));
    let title = "Frequencies in the standing frame [rad/s]:";
    let names = campbell.lines.iter().map(|line| line.name.clone());
    let headings: Vec<String> = std::iter::once("speed_rad_s".into()).chain(names).collect();
    let row = |&speed: &f64| {
        let lines = campbell.lines.iter().map(|line| line.at(speed));
        std::iter::once(speed).chain(lines).map(TableCell::from).collect()
    };
    let rows = request.speeds.iter().map(row).collect();
    sheet.table("points", title, Table::with_rows(headings, rows));
    sheet.chart("frequency [rad/s]", &[]);
    Ok(())
}

const COINCIDENCES: &[Column<'_, Coincidence>] = &columns! {
    speed_rad_s, casing_rad_s, blades_rad_s, dangerous,
};
