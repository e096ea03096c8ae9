//! The margins of a scene as a table of every number (CSV), and as aligned text for
//! people: a row for each limit, then what more was asked for (`rows`).

mod rows;
pub mod words;

use std::io::{Result, Write};

use serde_json::json;

use super::line::wrapped;
use super::table::{Table, TableCell};
use rubscope_solver::study::margins::{Margins, acting};

/// Widest line of the text; a command to copy stays in one line.
pub const WIDTH: usize = 100;
/// Number of parameters that are listed with each limit.
pub const STRONGEST: usize = 3;

/// Every limit with its sensitivities, one row a limit.
#[must_use]
pub fn table(margins: &Margins) -> Table {
    let own = ["name", "quantity", "value", "present", "margin"];
    let parameters = acting(&margins.scene).map(|parameter| parameter.path);
    let mut table = Table::new(own.into_iter().chain(parameters));
    for limit in &margins.limits {
        let own = [
            limit.name.to_string().into(),
            // The same word as in JSON.
            json!(limit.quantity).as_str().map_or(TableCell::Empty, TableCell::from),
            limit.value.into(),
            limit.present.into(),
            limit.margin.into(),
        ];
        let by = |path| TableCell::from(limit.sensitivities.by(path));
        let all = own.into_iter().chain(acting(&margins.scene).map(|parameter| by(parameter.path)));
        table.push(all.collect());
    }
    table
}

/// Writes the limits for people.
///
/// # Errors
/// An error of the writer.
pub fn write(margins: &Margins, out: &mut dyn Write) -> Result<()> {
    tell(&margins.scene.title, out)?;
    tell(&words::conditions(margins), out)?;
    words::note(margins).iter().try_for_each(|note| tell(note, out))?;
    rows::write(margins, out)?;
    rows::notes(margins, out)?;
    rows::target(margins, out)?;
    writeln!(out)?;
    tell(&words::cost(margins), out)
}

/// Writes a text in lines that are not too wide.
fn tell(text: &str, out: &mut dyn Write) -> Result<()> {
    wrapped(text, WIDTH).iter().try_for_each(|line| writeln!(out, "{line}"))
}
