//! How far a run is from another verdict: one sentence, and a table with a row per quantity.

use super::words::margin;
use crate::report::number::{rounded, scaled, short, with_unit};
use crate::report::table::{Heading, Table, TableCell};
use rubscope_solver::scene::{ContactLaw, Scene, keys};
use rubscope_solver::study::margins::{ChangedVerdict, Margins, Robustness, parameter};

/// Digits of a value; the search tries values with this many digits.
const DIGITS: usize = 4;

/// Explanation of the mark `?`.
const MARKED: &str = " A ? marks a doubt (a tiny change, another step): run --plain.";

/// Iterates over the searches: with the contact law of the scene, then with push-only contact.
pub fn asked(margins: &Margins) -> impl Iterator<Item = &Robustness> {
    margins.robust.iter().chain(&margins.pushes_only)
}

/// States the verdict of the run, and the nearest change of a quantity that was found to alter it.
pub fn sentence(found: &Robustness, scene: &Scene) -> String {
    let law = match found.contact {
        ContactLaw::Unilateral if found.solver != scene.solver.kind => "pushes only, by events",
        ContactLaw::Unilateral => "pushes only",
        ContactLaw::Bilateral => "bilateral law",
        ContactLaw::Smooth => "smooth law",
    };
    let speed = with_unit(scene.operation.speed_rad_s, DIGITS, "rad/s");
    let mut parts = vec![format!("{speed}, {law}: {}", found.verdict)];
    if found.changes.len() < found.rows {
        parts.push(format!("{} of {} quantities tried", found.changes.len(), found.rows));
        return format!("{}.", parts.join("; "));
    }
    let each = found.changes.iter().filter_map(|row| Some((row, row.nearest()?)));
    let nearest = each.min_by(|(_, (_, a)), (_, (_, b))| a.abs().total_cmp(&b.abs()));
    parts.push(match nearest {
        Some((row, (changed, part))) => {
            let (what, at) = (row.name, amount(row.path, changed.value, changed.value).join(" "));
            format!(
                "nearest found: {}{} at {what} {} ({})",
                changed.verdict,
                mark(changed),
                at.trim_end(),
                margin(part)
            )
        }
        None => "no change found".into(),
    });
    let pulse = found.changes.iter().find(|row| row.path == keys::PULSE && row.present != 0.0);
    if let Some(row) = pulse.filter(|row| row.below.is_none() && row.above.is_none()) {
        let [from, to] = row.tried.map(|tried| short(rounded(tried / row.present, 3)));
        parts.push(format!("no pulse tried from {from} to {to} times this one ends otherwise"));
    }
    let mut ends = found.changes.iter().flat_map(|row| [row.below, row.above]).flatten();
    let foot = if ends.any(|end| end.sensitive) { MARKED } else { "" };
    format!("{}.{foot}", parts.join("; "))
}

/// Returns the mark of an altered verdict that is itself sensitive.
fn mark(changed: ChangedVerdict) -> &'static str {
    if changed.sensitive { "?" } else { "" }
}

/// Returns one row per quantity, all values of a row in one unit. `at` joins verdict and value.
pub fn table(found: &Robustness, at: &str) -> Table {
    let headings = ["what", "found below", "now", "found above"];
    let mut table = Table::new(headings.map(Heading::shown));
    for row in &found.changes {
        let [now, unit] = amount(row.path, row.present, row.present);
        let side = |found: Option<ChangedVerdict>, tried: f64| match found {
            Some(changed) => {
                let value = &amount(row.path, changed.value, row.present)[0];
                format!("{}{}{at}{value}", changed.verdict, mark(changed))
            }
            None if tried == row.present => "-".into(),
            None => format!("none to {}", amount(row.path, tried, row.present)[0]),
        };
        let what = if unit.is_empty() { row.name.into() } else { format!("{} [{unit}]", row.name) };
        let [low, high] = row.tried;
        let cells = [what, side(row.below, low), now, side(row.above, high)];
        table.push(cells.map(TableCell::Word).into());
    }
    table
}

/// Formats a value and its unit, with the prefix chosen for `of`.
fn amount(path: &str, value: f64, of: f64) -> [String; 2] {
    match parameter(path).map_or("", |by| by.unit()) {
        "" | "-" => [short(rounded(value, DIGITS)), String::new()],
        unit => scaled(value, of, DIGITS, unit),
    }
}
