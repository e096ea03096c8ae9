//! The rows of the text, one a limit: speeds, pulses, and the loads of the lock.

use std::io::{Result, Write};

use super::{WIDTH, tell, words};
use crate::report::number::short;
use crate::report::symbols::symbol;
use crate::study::margins::{Limit, Margins, Quantity};

/// Between two columns.
const APART: usize = 2;

/// Writes them all.
pub(super) fn write(margins: &Margins, out: &mut dyn Write) -> Result<()> {
    let speed = short(margins.scene.operation.speed_rad_s);
    let pulse = words::value(margins.scene.operation.pulse_n, 6, Quantity::Pulse);
    let of = |wanted: fn(Quantity) -> bool| -> Vec<&Limit> {
        margins.limits.iter().filter(|limit| wanted(limit.quantity)).collect()
    };
    let groups = [
        (
            format!("Speeds; the scene has {} rad/s:", speed.trim_start_matches('-')),
            of(|quantity| quantity == Quantity::Speed),
        ),
        (format!("Pulses; the scene has {pulse}:"), of(|quantity| quantity == Quantity::Pulse)),
        (format!("The locked motion at {speed} rad/s:"), of(|quantity| quantity.path().is_none())),
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
    if let Some(note) = note
        && limits.iter().all(|limit| limit.value.is_none() && limit.note.as_ref() == Some(note))
        && limits.iter().all(|limit| limit.present.is_none())
    {
        return tell(&format!("{title} none: {note}."), out);
    }
    let rows: Vec<[String; 4]> = limits.iter().map(|limit| cells(limit)).collect();
    let heads = heads(limits);
    let width = |column: usize| {
        let all = rows.iter().chain([&heads]).filter_map(|row| row.get(column));
        all.map(|cell| cell.chars().count()).max().unwrap_or(0)
    };
    let widths = [0, 1, 2, 3].map(width);
    let start: usize = widths.iter().filter(|width| **width > 0).map(|width| width + APART).sum();
    let line = |row: &[String; 4]| {
        let mut text = String::new();
        for (column, (cell, width)) in row.iter().zip(widths).enumerate() {
            if width > 0 {
                // Numbers stand to the right, words to the left.
                let number = column == 1 || column == 2;
                let cell =
                    if number { format!("{cell:>width$}") } else { format!("{cell:<width$}") };
                text.push_str(&cell);
                text.push_str("  ");
            }
        }
        text
    };
    writeln!(out, "{title}")?;
    writeln!(out, "{}+1 % of each moves it by", line(&heads))?;
    for (limit, row) in limits.iter().zip(&rows) {
        let text = match (limit.value, &limit.note) {
            (None, note) => {
                let note = note.as_deref().unwrap_or("no such limit");
                format!("{:<width$}  {note}", row[0], width = widths[0])
            }
            (Some(_), _) => line(row) + &moving(limit, WIDTH.saturating_sub(start)),
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

/// Name, value, margin and side of a limit.
fn cells(limit: &Limit) -> [String; 4] {
    let value = limit.value.map(|value| words::value(value, 6, limit.quantity));
    let margin = limit.margin.map(words::margin);
    [
        limit.name.to_string(),
        value.unwrap_or_default(),
        margin.unwrap_or_default(),
        words::side(limit),
    ]
}

/// What moves a limit most, as much of it as there is room for; a note where nothing
/// does.
fn moving(limit: &Limit, room: usize) -> String {
    let strongest = limit.sensitivities.strongest(words::TOLD);
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
    if !strongest.is_empty() {
        return told;
    }
    let smooth = if limit.contact.is_some() { "no derivative: the edge is not smooth" } else { "" };
    let note = limit.note.as_deref().filter(|_| limit.contact.is_none());
    note.unwrap_or(smooth).to_string()
}
