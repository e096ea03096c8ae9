//! The heading above the tables of `rubscope hbm`: the machine, its limits, and the assumptions
//! behind the numbers, in sentences.

use std::io::{Result, Write};

use super::{notes, speeds_of};
use crate::report::line::capital;
use crate::report::number::{self, count, short};
use rubscope_solver::harmonic::{Form, Sweep, lock_window};
use rubscope_solver::model::Machine;
use rubscope_solver::scene::Scene;

/// The heading of one view.
#[derive(Debug)]
pub struct Heading<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The machine as the view models it.
    pub machine: &'a Machine,
    /// Speed that determines the sense of rotation \[rad/s\].
    pub speed: f64,
    /// Whether the equations include the damping of the scene.
    pub damped: bool,
    /// The locked motion, if it is the subject of the view.
    pub sweep: Option<&'a Sweep>,
}

impl Heading<'_> {
    /// Writes the machine and the blades that hold the wave, one fact per line.
    ///
    /// # Errors
    /// The writer failed.
    pub fn write(&self, out: &mut dyn Write) -> Result<()> {
        let Self { scene, machine, speed, damped, sweep } = *self;
        if !scene.title.is_empty() {
            writeln!(out, "{}", scene.title)?;
        }
        if let Some(note) = scene.modes_note() {
            writeln!(out, "{}.", capital(&note))?;
        }
        let polygon = &machine.polygon;
        writeln!(
            out,
            "{} blades, {}: {} phase groups of {}, clearance {} m.",
            polygon.blades,
            count(u64::from(polygon.nodal_diameters), "nodal diameter"),
            polygon.sides,
            count(u64::from(polygon.blades_per_side), "blade"),
            short(machine.clearance())
        )?;
        if let Some(critical) = machine.critical_speed() {
            write!(out, "Critical speed {}", number::speed(critical))?;
            let lock_of = |machine: &Machine| lock_window(machine, speed).map(speeds_of);
            let (zeta, unit) = (short(machine.casing_damping_ratio), number::speed_unit());
            // On a lining, groups of more blades may lock at other speeds.
            let groups = if machine.lining.is_some() { " of two groups" } else { "" };
            match lock_of(machine) {
                Some(lock) if !damped => {
                    let without = lock_of(&machine.clone().undamped()).unwrap_or_default();
                    let words = format!("{unit} without damping");
                    write!(
                        out,
                        ", lock{groups} from {without} {words}, {lock} with zeta_c = {zeta}"
                    )?;
                }
                Some(lock) => {
                    write!(out, ", lock{groups} from {lock} {unit} (zeta_c = {zeta})")?;
                }
                None => {}
            }
            if let Some(dangerous) = machine.dangerous_speed_toward(speed) {
                write!(out, ", dangerous coincidence {}", number::speed(dangerous))?;
            }
            writeln!(out, ".")?;
        }
        if let Some(sweep) = sweep {
            let name = |side| {
                let list: Vec<String> =
                    polygon.blades_of_side(side).iter().map(|blade| format!("#{blade}")).collect();
                list.join(" ")
            };
            let damping = match (sweep.damped, sweep.form) {
                (true, _) => "damped",
                (false, Form::Printed) => "undamped as in the paper",
                (false, _) => "undamped",
            };
            writeln!(
                out,
                "Locked motion held between a: {} and b: {}; form {}, {damping}. A negative multiplier pushes; a positive one pulls, which a real contact cannot do.",
                name(sweep.corner.a),
                name(sweep.corner.b),
                sweep.form,
            )?;
        }
        for note in notes(scene, machine) {
            writeln!(out, "These numbers are {note}.")?;
        }
        Ok(())
    }
}
