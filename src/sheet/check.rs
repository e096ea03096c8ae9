//! The text of `rubscope check`: the machine, its frequencies and limits, missing data, and likely
//! unit errors, in sentences.

use std::f64::consts::TAU;

use super::line::{capital, wrapped};
use super::margins::words;
use super::number::{count, rounded, short, speed, with_unit};
use super::survey;
use super::table::WIDTH;
use super::{CommandLine, Sheet};
use crate::machine::doubts;
use rubscope_solver::scene::{CheckedScene, ModelSize};
use rubscope_solver::study::margins::{LimitName, Margins, Quantity};
use rubscope_solver::study::survey::Scattered;

/// Returns the sentences, a paragraph for each subject.
pub fn sheet(scene: &CheckedScene, command: CommandLine) -> Sheet<'static> {
    let margins = Margins::of(scene);
    let mut sheet = Sheet::new("check", 1, command, scene);
    let mut paragraphs =
        vec![scene.title.clone(), machine(scene), frequencies(scene), limits(&margins)];
    paragraphs.extend(Scattered::of(scene).map(|found| survey::of_scatter(scene, &found)));
    paragraphs.extend(unknown(scene));
    let doubts = doubts(&margins);
    if doubts.is_empty() {
        paragraphs.push(CHECKED.to_string());
    }
    paragraphs.iter().for_each(|text| sheet.paragraph(text));
    doubt_lines(&doubts).into_iter().for_each(|line| sheet.line(line));
    sheet
}

/// Closing paragraph if no value looks like a unit error: the list of what was checked.
const CHECKED: &str = "Checked: radius, clearance, tip speed, pulse and the push of a tip; frequency, \
    modal mass and damping ratio of every mode, and how they vary with the nodal diameters. No value \
    looks like a unit error or a misplaced decimal point.";

/// Lists the likely unit errors, each in a sentence; there are no lines without one.
pub fn doubt_lines(doubts: &[String]) -> Vec<String> {
    let mut lines = match doubts.len() {
        0 => Vec::new(),
        1 => vec!["This value looks wrong:".to_string()],
        _ => vec!["These values look wrong:".to_string()],
    };
    for doubt in doubts {
        let wrapped = wrapped(doubt, WIDTH - 2).into_iter().enumerate();
        lines.extend(
            wrapped.map(|(row, line)| format!("{} {line}", if row == 0 { "-" } else { " " })),
        );
    }
    lines
}

fn machine(scene: &CheckedScene) -> String {
    let machine = scene.machine();
    let polygon = &machine.polygon;
    let clearance = scene.clearance();
    let room = if clearance > 0.0 { "a clearance of" } else { "an interference of" };
    let diameters = count(u64::from(polygon.nodal_diameters), "nodal diameter");
    let groups = match polygon.has_corners() {
        true => format!(
            "{} groups of {}, between which a wave can lock",
            polygon.sides, polygon.blades_per_side
        ),
        false => "no corner: no wave can lock".to_string(),
    };
    format!(
        "{} of {} in a casing of the radius {}: {room} {}, {} % of the radius. With \
         {diameters} the blades form {groups}.",
        count(u64::from(polygon.blades), "blade"),
        with_unit(machine.blade_length, 6, "m"),
        with_unit(scene.casing.radius_m, 6, "m"),
        with_unit(clearance.abs(), 6, "m"),
        short(rounded(100.0 * clearance.abs() / scene.casing.radius_m, 3)),
    )
}

fn frequencies(scene: &CheckedScene) -> String {
    let machine = scene.machine();
    let hertz = |omega: f64| format!("{} Hz", short(rounded(omega / TAU, 5)));
    let disk = machine.blade_modal_mass / (machine.blade_length * machine.blade_length);
    let rigid = match scene.solver.model {
        ModelSize::Rigid => " The model leaves the motion of the blades out.",
        _ => "",
    };
    format!(
        "The casing has {} ({} kg, damping ratio {}), the bladed disk {} ({} kg at the tips, \
         damping ratio {}).{rigid}",
        hertz(machine.omega_c),
        short(machine.casing_mass),
        short(machine.casing_damping_ratio),
        hertz(machine.omega_bd),
        short(rounded(disk, 5)),
        short(machine.blade_damping_ratio),
    )
}

/// Compares the scene with its limits: critical and lock speeds, touching pulse, tip force.
fn limits(margins: &Margins) -> String {
    let scene = &margins.scene;
    let now = speed(scene.operation.speed_rad_s);
    let mut told = vec![format!("The rotor turns at {now}.")];
    for limit in &margins.limits {
        let speeds = limit.quantity == Quantity::Speed;
        let Some(value) = limit.value else {
            let note = limit.note.as_deref().filter(|_| limit.name == LimitName::OmegaLock);
            told.extend(note.map(|note| format!("No lock: {note}.")));
            continue;
        };
        if !(speeds || limit.name == LimitName::TouchingPulse) {
            continue;
        }
        let value = with_unit(value, 6, limit.quantity.unit());
        let margin = limit
            .margin
            .map_or(String::new(), |part| format!(" ({} from here)", words::to_limit(part)));
        told.push(format!("{} {value}{margin}: {}.", limit.name, limit.name.what()));
    }
    let push = margins.tip_push().map(|push| with_unit(push, 4, "N"));
    told.extend(push.map(|push| format!("In the lock a blade tip pushes with up to {push}.")));
    told.join(" ")
}

/// Says for which nodal diameters the casing's modes are missing and what replaces them; `None` if
/// all are given. A note of the scene on its modes takes precedence.
fn unknown(scene: &CheckedScene) -> Option<String> {
    if let Some(note) = scene.modes_note() {
        return Some(format!("{}.", capital(&note)));
    }
    let all = scene.bladed_disk.blades / 2 + 1;
    let is_known = |n: &u32| scene.casing.modes.iter().any(|mode| mode.nodal_diameters == *n);
    // Without a list, the mode of the scene is that of its own nodal diameters.
    let known = (0..all).filter(is_known).count().max(1) as u32;
    (known < all).then(|| {
        format!(
            "Modes of the casing are known for {known} of {all} nodal diameters; for the others its \
             common values are used."
        )
    })
}
