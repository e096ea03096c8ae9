//! One's own machine from a table of modes: which nodal diameters can lock at its speeds, and what
//! moves the lock speed most (`cargo run --release --package rubscope-solver --example survey`).

use std::error::Error;
use std::f64::consts::TAU;
use std::io::{Write, stdout};

use rubscope_solver::scene::{ModalData, Scene, read_modes};
use rubscope_solver::study::margins::{LimitName, Margins};
use rubscope_solver::study::survey::Survey;

const TABLE: &str = "structure,nodal diameters,frequency [Hz],modal mass [kg],speed [rpm]
casing,4,440,8.6,\ncasing,5,700,8.2,\ndisk,4,386.0,3.6,0\ndisk,4,439.8,3.6,10000
disk,5,397.0,3.5,0\ndisk,5,449.5,3.5,10000";

fn main() -> Result<(), Box<dyn Error>> {
    show(&mut stdout())
}

/// Writes it to `out`.
pub fn show(out: &mut dyn Write) -> Result<(), Box<dyn Error>> {
    let rpm = TAU / 60.0; // rad/s
    let range_rad_s = [7000.0 * rpm, 12_000.0 * rpm];
    let [casing, disk] = read_modes(TABLE)?.modes;
    let data = ModalData {
        title: "A stage".into(),
        blades: 40,
        radius_m: 0.42,
        clearance_m: 0.3e-3,
        nodal_diameters: 5,
        casing,
        disk,
        damping_ratios: [0.01; 2],
        range_rad_s,
        speed_rad_s: 9000.0 * rpm,
        pulse_n: 450e3,
    };
    let scene = Scene::from_toml(&data.to_toml()?)?.checked()?;
    for row in Survey::of(&scene, Some(range_rad_s), None)?.shown(false) {
        for [from, to] in row.locks_in_range.iter().flatten() {
            writeln!(out, "{}: {:.1} to {:.1} rpm", row.nodal_diameters, from / rpm, to / rpm)?;
        }
    }
    let margins = Margins::of(&scene);
    let lock = margins.limit(LimitName::OmegaLock).ok_or("no lock")?;
    for (path, percent) in lock.sensitivities.strongest(2) {
        writeln!(out, "1 % of {path} moves it by {percent:.2} %")?;
    }
    Ok(())
}
