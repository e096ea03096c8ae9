//! What follows the rows of the text: the bands of lasting pulses, the spread by
//! tolerances, and the target.

use std::io::{Result, Write};

use super::{tell, words};
use crate::report::table::{Table, TableCell};
use crate::study::margins::{Limit, Margins};

/// Most bands of one limit that are listed.
const BANDS: usize = 10;

/// Where pulses last under one law.
pub(super) fn bands(limit: &Limit, out: &mut dyn Write) -> Result<()> {
    let note = limit.note.as_deref().unwrap_or_default();
    let law = limit.contact.map_or_else(String::new, |law| format!(" ({law} law)"));
    tell(&format!("{}{law}: {note}.", limit.name), out)?;
    let mut table = Table::new(["from", "to", "the scene", "verdicts", ""]);
    for band in limit.bands.iter().take(BANDS) {
        let pulse = |pulse: f64| words::value(pulse, 5, limit.quantity);
        let verdicts: Vec<&str> = band.verdicts.iter().map(AsRef::as_ref).collect();
        table.push(vec![
            pulse(band.from_n).into(),
            band.to_n.map_or_else(|| "the largest tried".to_string(), pulse).into(),
            words::place(band, limit.present).into(),
            verdicts.join(", ").into(),
            if band.sensitive { "sensitive" } else { "" }.into(),
        ]);
    }
    table.write_text(out)?;
    match limit.bands.len().saturating_sub(BANDS) {
        0 => Ok(()),
        more => writeln!(out, "... and {more} more, see --json"),
    }
}

/// What closed forms leave out in this scene, once for all limits of which it is so.
pub(super) fn notes(margins: &Margins, out: &mut dyn Write) -> Result<()> {
    let noted = |limit: &&Limit| limit.value.is_some() && limit.contact.is_none();
    let mut said: Vec<(&str, String)> = Vec::new();
    for limit in margins.limits.iter().filter(noted) {
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

/// How far limits spread with the tolerances given.
pub(super) fn spread(margins: &Margins, out: &mut dyn Write) -> Result<()> {
    if margins.tolerances.is_empty() {
        return Ok(());
    }
    writeln!(out)?;
    tell(&words::tolerances(margins), out)?;
    let mut table = Table::new(["limit"].into_iter().chain(words::SPREAD));
    for limit in &margins.limits {
        if let Some((unit, told)) = words::spread(limit) {
            let name = [format!("{} [{unit}]", limit.name)];
            table.push(name.into_iter().chain(told).map(TableCell::from).collect());
        }
    }
    table.write_text(out)?;
    words::sampling(margins).iter().try_for_each(|line| tell(line, out))
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
