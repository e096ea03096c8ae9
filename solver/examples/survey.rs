//! One's own machine with its modes: which nodal diameters can lock at its speeds, and what
//! moves the lock speed most (`cargo run --release --package rubscope-solver --example survey`).

use std::error::Error;
use std::f64::consts::TAU;
use std::io::{Write, stdout};

use rubscope_solver::scene::Scene;
use rubscope_solver::study::margins::{LimitName, Margins};
use rubscope_solver::study::survey::Survey;

const STAGE: &str = r#"
title = "A stage"

[bladed_disk]
blades = 40
blade_length_m = 0.4197
inertia_kg_m2 = 0.0308
stiffness_nm_per_rad = 191.6e3
coupling_nm_per_rad = 0
damping_ratio = 0.01
modes = [
    { nodal_diameters = 4, frequency_hz = 386.0, at_speed_rad_s = 0, inertia_kg_m2 = 0.0317 },
    { nodal_diameters = 4, frequency_hz = 439.8, at_speed_rad_s = "10000 rpm" },
    { nodal_diameters = 5, frequency_hz = 397.0, at_speed_rad_s = 0, inertia_kg_m2 = 0.0308 },
    { nodal_diameters = 5, frequency_hz = 449.5, at_speed_rad_s = "10000 rpm" },
]

[casing]
radius_m = 0.42
damping_ratio = 0.01
modes = [
    { nodal_diameters = 4, frequency_hz = 440, modal_mass_kg = 8.6 },
    { nodal_diameters = 5, frequency_hz = 700, modal_mass_kg = 8.2 },
]

[operation]
nodal_diameters = 5
speed_rad_s = "9000 rpm"
pulse_n = "450 kN"
"#;

fn main() -> Result<(), Box<dyn Error>> {
    show(&mut stdout())
}

/// Writes it to `out`.
pub fn show(out: &mut dyn Write) -> Result<(), Box<dyn Error>> {
    let rpm = TAU / 60.0; // rad/s
    let range_rad_s = [7000.0 * rpm, 12_000.0 * rpm];
    let scene = Scene::from_toml(STAGE)?.checked()?;
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
