//! The margins of a scene as a table: one row per limit, with every number for files and the
//! strongest parameters for the screen.

pub mod robust;
pub mod words;

use std::io::{Result, Write};

use serde_json::json;

use super::command::{PROGRAM, VERSION};
use super::line::wrapped;
use super::symbols::symbol;
use super::table::{Heading, Table, TableCell, WIDTH};
use super::{Provenance, svg};
use rubscope_solver::study::margins::{LimitName, Margins, acting};

/// Number of parameters listed with each limit: those that move it most.
pub const STRONGEST: usize = 3;

/// Returns a table with one row per limit, under its name in files.
pub fn table(margins: &Margins) -> Table {
    titled(margins, |name| name.to_string())
}

/// As [`table`], with `title` making the name of each limit.
pub fn titled(margins: &Margins, title: fn(LimitName) -> String) -> Table {
    let parameters: Vec<&str> = acting(&margins.scene).map(|parameter| parameter.path).collect();
    let people = ["+1 % of", "each", "moves it by"].map(Heading::shown);
    let files = [Heading::filed("quantity"), "value".into(), Heading::filed("present")];
    let headings = std::iter::once(Heading::from("name").words("limit")).chain(files);
    let headings = headings.chain([Heading::from("margin").words("away")]).chain(people);
    let mut table = Table::new(headings.chain(parameters.iter().map(|path| Heading::filed(*path))));
    for limit in &margins.limits {
        // Same word as in JSON.
        let quantity = json!(limit.quantity).as_str().map_or(TableCell::Empty, TableCell::from);
        let value = limit.value.map_or(TableCell::Empty, |value| {
            TableCell::Told(value, words::value(value, 6, limit.quantity))
        });
        let own = [
            TableCell::Word(match limit.lobes {
                Some(lobes) => format!("{} m={lobes}", title(limit.name)),
                None => title(limit.name),
            }),
            quantity,
            value,
            limit.present.into(),
            words::margin_cell(limit.margin),
        ];
        let strongest = limit.sensitivities.strongest(STRONGEST);
        let moved = (0..STRONGEST).map(|place| {
            let found = strongest.get(place);
            let text = found.map(|(path, by)| format!("{} {}", symbol(path), words::change(*by)));
            TableCell::Word(text.unwrap_or_default())
        });
        let by = parameters.iter().map(|path| limit.sensitivities.by(path).into());
        table.push(own.into_iter().chain(moved).chain(by).collect());
    }
    for (note, names) in notes(margins) {
        table.note(format!("{names}: {note}."));
    }
    table
}

/// Groups equal notes of the limits: each note, and the names of the limits that have it.
fn notes(margins: &Margins) -> Vec<(String, String)> {
    let mut found: Vec<(String, String)> = Vec::new();
    for limit in &margins.limits {
        let Some(note) = &limit.note else { continue };
        let note = if limit.value.is_none() { format!("none, as {note}") } else { note.clone() };
        match found.iter_mut().find(|(known, _)| *known == note) {
            Some((_, names)) => names.push_str(&format!(", {}", limit.name)),
            None => found.push((note, limit.name.to_string())),
        }
    }
    found
}

/// Writes the limits and the computing time as text.
///
/// # Errors
/// The writer failed.
pub fn write(margins: &Margins, out: &mut dyn Write) -> Result<()> {
    write_limits(margins, out)?;
    writeln!(out)?;
    tell(&words::cost(margins), out)
}

/// Writes the limits as an SVG page, with the command that reproduces it.
///
/// # Errors
/// The writer failed.
pub fn write_page(margins: &Margins, origin: &Provenance, out: &mut dyn Write) -> Result<()> {
    let mut text = Vec::new();
    write_limits(margins, &mut text)?;
    writeln!(text, "\n{PROGRAM} {VERSION}: {}", origin.command)?;
    svg::write_text(&String::from_utf8_lossy(&text), origin, out)
}

/// Writes the limits without the computing time, so that the same scene gives the same text.
fn write_limits(margins: &Margins, out: &mut dyn Write) -> Result<()> {
    tell(&margins.scene.title, out)?;
    tell(&words::conditions(margins), out)?;
    words::note(margins).iter().try_for_each(|note| tell(note, out))?;
    writeln!(out)?;
    for found in robust::asked(margins) {
        tell(&robust::sentence(found, margins, true), out)?;
        robust::table(found, " at ").write_text_in(WIDTH, out)?;
        writeln!(out)?;
    }
    table(margins).write_text_in(WIDTH, out)?;
    if let Some(found) = &margins.target {
        writeln!(out)?;
        tell(&words::target(found, margins), out)?;
        // A command to copy is not wrapped.
        if let Some(command) = words::check(found, &margins.scene) {
            writeln!(out, "Check it: {command}")?;
        }
    }
    Ok(())
}

/// Writes a text wrapped to the line width.
fn tell(text: &str, out: &mut dyn Write) -> Result<()> {
    wrapped(text, WIDTH).iter().try_for_each(|line| writeln!(out, "{line}"))
}
