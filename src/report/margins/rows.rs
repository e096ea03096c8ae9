//! The text of margins: a row for each limit (speeds, pulses, the loads of the lock), then the
//! target.

use std::io::{Result, Write};

use super::{STRONGEST, WIDTH, tell, words};
use crate::report::number;
use crate::report::symbols::symbol;
use rubscope_solver::study::margins::{Limit, Margins, Quantity};

/// Between two columns.
const APART: usize = 2;

/// Writes them all.
pub(super) fn write(margins: &Margins, out: &mut dyn Write) -> Result<()> {
    let speed = number::speed(margins.scene.operation.speed_rad_s);
    let pulse = words::value(margins.scene.operation.pulse_n, 6, Quantity::Pulse);
    let of = |wanted: fn(&Limit) -> bool| -> Vec<&Limit> {
        margins.limits.iter().filter(|limit| wanted(limit)).collect()
    };
    let groups = [
        (
            format!("Speeds; the scene has {}:", speed.trim_start_matches('-')),
            of(|limit| limit.quantity == Quantity::Speed),
        ),
        (format!("Pulses; the scene has {pulse}:"), of(|limit| limit.quantity == Quantity::Pulse)),
        (format!("The locked motion at {speed}:"), of(Limit::is_load)),
    ];
    for (title, limits) in groups {
        if !limits.is_empty() {
            writeln!(out)?;
            group(&title, &limits, out)?;
        }
    }
    Ok(())
}

/// The limits of one kind under their title.
fn group(title: &str, limits: &[&Limit], out: &mut dyn Write) -> Result<()> {
    let note = limits.first().and_then(|limit| limit.note.as_ref());
    let none = |limit: &Limit| limit.value.is_none() && limit.present.is_none();
    if let Some(note) = note
        && limits.iter().all(|limit| none(limit) && limit.note.as_ref() == Some(note))
    {
        return tell(&format!("{title} none: {note}."), out);
    }
    let rows: Vec<[String; 4]> = limits.iter().map(|limit| cells(limit)).collect();
    let heads = heads(limits);
    let widths = [0, 1, 2, 3].map(|column: usize| {
        let all = rows.iter().chain([&heads]).map(|row| row[column].chars().count());
        all.max().unwrap_or(0)
    });
    let start: usize = widths.iter().filter(|width| **width > 0).map(|width| width + APART).sum();
    let line = |row: &[String; 4]| {
        let mut text = String::new();
        for (column, (cell, width)) in row.iter().zip(widths).enumerate().filter(|at| at.1.1 > 0) {
            // Numbers stand to the right, words to the left.
            let number = column == 1 || column == 2;
            let cell = if number { format!("{cell:>width$}") } else { format!("{cell:<width$}") };
            text.push_str(&cell);
            text.push_str("  ");
        }
        text
    };
    writeln!(out, "{title}")?;
    writeln!(out, "{}+1 % of each moves it by", line(&heads))?;
    for (limit, row) in limits.iter().zip(&rows) {
        let text = match limit.value {
            None => {
                let note = limit.note.as_deref().unwrap_or("no such limit");
                format!("{:<width$}  {note}", row[0], width = widths[0])
            }
            Some(_) => line(row) + &moving(limit, WIDTH.saturating_sub(start)),
        };
        writeln!(out, "{}", text.trim_end())?;
    }
    Ok(())
}

/// What stands above the columns.
fn heads(limits: &[&Limit]) -> [String; 4] {
    let stands = limits.iter().any(|limit| limit.margin.is_some());
    let name = if limits.iter().any(|limit| limit.present.is_some()) { "limit" } else { "load" };
    [name, "value", if stands { "margin" } else { "" }, ""].map(String::from)
}

/// Returns name, value, margin and side of a limit.
fn cells(limit: &Limit) -> [String; 4] {
    let value = limit.value.map(|value| words::value(value, 6, limit.quantity));
    let margin = limit.margin.map(words::margin);
    [limit.name.to_string(), value.unwrap_or_default(), margin.unwrap_or_default(), limit.way()]
}

/// Returns what moves a limit most, as much of it as there is room for; its note where nothing
/// does.
fn moving(limit: &Limit, room: usize) -> String {
    let strongest = limit.sensitivities.strongest(STRONGEST);
    if strongest.is_empty() {
        return limit.note.clone().unwrap_or_default();
    }
    let mut told = String::new();
    for (path, by) in &strongest {
        let next = format!("{} {}", symbol(path), words::change(*by));
        let apart = if told.is_empty() { 0 } else { APART };
        if told.chars().count() + apart + next.chars().count() > room {
            break;
        }
        told.extend(std::iter::repeat_n(' ', apart));
        told.push_str(&next);
    }
    told
}

/// What closed forms leave out in this scene, once for all limits of which it is so.
pub(super) fn notes(margins: &Margins, out: &mut dyn Write) -> Result<()> {
    let mut said: Vec<(&str, String)> = Vec::new();
    for limit in margins.limits.iter().filter(|limit| limit.value.is_some()) {
        let Some(note) = limit.note.as_deref() else { continue };
        match said.iter_mut().find(|(known, _)| *known == note) {
            Some((_, names)) => names.push_str(&format!(", {}", limit.name)),
            None => said.push((note, limit.name.to_string())),
        }
    }
    if !said.is_empty() {
        writeln!(out)?;
    }
    said.iter().try_for_each(|(note, names)| tell(&format!("{names}: {note}."), out))
}

/// The parameter that puts a limit where it is wanted, and the command that shows it.
pub(super) fn target(margins: &Margins, out: &mut dyn Write) -> Result<()> {
    let Some(found) = &margins.target else { return Ok(()) };
    writeln!(out)?;
    tell(&words::target(found, margins), out)?;
    match words::check(found, &margins.scene) {
        Some(command) => writeln!(out, "Check it: {command}"),
        None => Ok(()),
    }
}
