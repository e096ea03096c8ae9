//! The margins of a scene as a table: one row per limit, with every number for files and the
//! strongest parameters for the screen.

pub mod robust;
pub mod words;

use super::line::wrapped;
use super::number::with_unit;
use super::summary::conditions;
use super::symbols::symbol;
use super::table::{Heading, Table, TableCell, WIDTH};
use super::{CommandLine, Sheet};
use rubscope_solver::study::margins::{Limit, LimitName, Margins, acting};

/// Number of parameters listed with each limit: those that move it most.
pub const STRONGEST: usize = 3;

/// Returns a table with one row per limit, named by `title`.
pub fn table(margins: &Margins, title: fn(LimitName) -> String) -> Table<'static> {
    let parameters: Vec<&str> = acting(&margins.scene).map(|parameter| parameter.path).collect();
    let people = ["+1 % of", "each", "moves it by"].map(Heading::shown);
    let files = [Heading::filed("quantity"), "value".into(), Heading::filed("present")];
    let headings = std::iter::once(Heading::from("name").words("limit")).chain(files);
    let headings = headings.chain([Heading::from("margin").words("away")]).chain(people);
    let headings = headings.chain(parameters.iter().map(|path| Heading::filed(*path)));
    let row = |limit: &Limit| {
        let lobes = limit.lobes.map_or(String::new(), |lobes| format!(" m={lobes}"));
        let value = limit
            .value
            .map(|value| TableCell::told(value, with_unit(value, 6, limit.quantity.unit())));
        let own = [
            (title(limit.name) + &lobes).into(),
            limit.quantity.into(),
            value.unwrap_or_default(),
            limit.present.into(),
            words::margin_cell(limit.margin),
        ];
        let strongest = limit.sensitivities.strongest(STRONGEST);
        let moved = (0..STRONGEST).map(|place| {
            let found = strongest.get(place);
            let text = found.map(|(path, by)| format!("{} {}", symbol(path), words::change(*by)));
            text.unwrap_or_default().into()
        });
        let by = parameters.iter().map(|path| limit.sensitivities.by(path).into());
        own.into_iter().chain(moved).chain(by).collect()
    };
    let mut table = Table::with_rows(headings, margins.limits.iter().map(row).collect());
    // Each note of the limits, with the names of those that have it.
    let mut notes: Vec<(String, String)> = Vec::new();
    for limit in &margins.limits {
        let Some(note) = &limit.note else { continue };
        let note = if limit.value.is_none() { format!("none, as {note}") } else { note.clone() };
        match notes.iter_mut().find(|(known, _)| *known == note) {
            Some((_, names)) => names.push_str(&format!(", {}", limit.name)),
            None => notes.push((note, limit.name.to_string())),
        }
    }
    notes.iter().for_each(|(note, names)| table.note(format!("{names}: {note}.")));
    table
}

/// Returns the sheet of the margins; `command` reproduces it.
pub fn sheet(margins: &Margins, command: CommandLine) -> Sheet<'_> {
    let mut sheet = Sheet::new("margins", 1, command, &margins.scene);
    sheet.facts(margins);
    sheet.paragraph(&margins.scene.title);
    sheet.paragraph(&(conditions(&margins.scene) + "."));
    sheet.paragraph(&words::note(margins));
    for found in robust::asked(margins) {
        let sentence = wrapped(&robust::sentence(found, margins, true), WIDTH).join("\n");
        sheet.table(None, sentence, robust::table(found, " at ").within(WIDTH));
    }
    sheet.table(None, "", table(margins, |name| name.to_string()).within(WIDTH));
    if let Some(found) = &margins.target {
        sheet.paragraph(&words::target(found, margins));
        // A command to copy is not wrapped.
        if let Some(command) = words::check(found, &margins.scene) {
            sheet.line(format!("Check it: {command}"));
        }
    }
    sheet
}
