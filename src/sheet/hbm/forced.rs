//! The view `--forced`: the wave that an out-of-round casing drives while all blades rub its
//! lining.

use super::view::{Request, View};
use crate::sheet::Sheet;
use crate::sheet::number::count;
use crate::sheet::table::{Column, Table, columns};
use rubscope_solver::harmonic::{Forced, Lining};
use rubscope_solver::scene::{ContactLaw, SceneError, keys};

pub const FORCED: View = View {
    rigid: None,
    out_of_round: true,
    ..View::new(
        "forced",
        "View: the wave that an out-of-round casing drives if all blades rub its lining",
        fill,
    )
};

fn fill(request: &Request<'_>, sheet: &mut Sheet<'_>) -> Result<(), SceneError> {
    let Request { scene, machine, speeds, .. } = request;
    let (height, lobes) = (scene.casing.out_of_round_m, scene.casing.lobes);
    if scene.solver.contact != ContactLaw::Smooth {
        let allowed = "\"smooth\" with --forced: blades that all rub press a lining";
        return Err(SceneError::refused(keys::LAW, scene.solver.contact, allowed));
    }
    if height == 0.0 {
        let allowed = "above 0 with --forced: a round casing drives nothing";
        return Err(SceneError::refused(keys::OUT_OF_ROUND, height, allowed));
    }
    let lining = Lining::of(machine, &scene.contact)?;
    let forced: Vec<Forced> =
        speeds.iter().map(|speed| lining.forced(*speed, lobes, height)).collect();
    let still = forced.iter().all(|point| point.amplitude_m == 0.0);
    let diameters = machine.polygon.nodal_diameters;
    let title = match still {
        true => format!(
            "{lobes} lobes drive no wave of {}, whatever the speed:",
            count(u64::from(diameters), "nodal diameter")
        ),
        false => format!("{lobes} lobes of {height:e} m drive, where all blades press:"),
    };
    sheet.fact("lobes", lobes);
    sheet.fact("out_of_round_m", height);
    sheet.table("points", title, Table::of(forced, POINTS));
    sheet.chart("casing [m]", &[["amplitude_m", "amplitude"]]);
    Ok(())
}

const POINTS: &[Column<'_, Forced>] = &columns! {
    speed_rad_s, s_rad_s, omega_rad_s, amplitude_m, blade_angle_rad, all_press,
};
