//! The margins of a scene as one page for a report: conditions, the table of the limits, the
//! target, and at the foot the scene and the command.

use std::io::{Error, Result, Write};

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::paper::{Area, Drawn, FINE, letters_in, px, typed, write_at, write_from};
use super::{LEFT, TITLE, describe, finish};
use crate::report::line::wrapped;
use crate::report::margins::{titled, words};
use crate::report::number::{time, with_unit};
use crate::report::symbols::{in_print, symbol};
use crate::report::table::Table;
use crate::report::ticks::power_of_ten;
use crate::report::{Provenance, command};
use rubscope_solver::scene::keys::{Allowed, KEYS};
use rubscope_solver::scene::{Scene, SolverKind, Value};
use rubscope_solver::study::margins::Margins;

/// Width of the page \[px\]: a line of it is one of a printed page.
const WIDTH: u32 = 840;
/// A height that no page has.
const TALL: u32 = 20_000;
/// Size of text, and of small text.
const TEXT: i32 = 15;
const SMALL: i32 = 13;
/// Height of a line of small text.
const LINE: i32 = 15;
/// Room for a letter of a table, and between two columns \[px\].
const LETTER: i32 = 7;
const APART: i32 = 14;
/// Most lines of the command; the whole of it is in the description of the picture.
const COMMAND: usize = 8;
/// Grey of lines between parts.
const RULE: RGBColor = RGBColor(150, 150, 150);

/// Writes the margins of a scene as one page.
///
/// # Errors
/// An error of the writer.
pub fn write_margins(margins: &Margins, origin: &Provenance, out: &mut dyn Write) -> Result<()> {
    let failed = |error: Box<dyn std::error::Error>| Error::other(error.to_string());
    // Drawn once to see how tall it gets.
    let height = draw(margins, origin, TALL, &mut String::new()).map_err(failed)?;
    let mut text = String::new();
    draw(margins, origin, height, &mut text).map_err(failed)?;
    finish(&mut text, [WIDTH, height], &describe(origin));
    out.write_all(text.as_bytes())
}

/// Draws the page on paper of this height, and returns the height that it takes.
fn draw(margins: &Margins, origin: &Provenance, height: u32, text: &mut String) -> Drawn<u32> {
    let root = SVGBackend::with_string(text, (FINE * WIDTH, FINE * height)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut page = Page { area: &root, y: 10 };
    page.lines(&margins.scene.title, TITLE, 25)?;
    let conditions = words::conditions(margins).replace('-', "−").replace(" us,", " µs,");
    page.lines(&conditions, TEXT, 19)?;
    words::note(margins).iter().try_for_each(|note| page.lines(note, TEXT, 19))?;
    page.rule()?;
    page.table(&titled(margins, |name| name.symbol().to_string()))?;
    if let Some(found) = &margins.target {
        page.rule()?;
        page.lines(&typed(&words::target(found, margins)), TEXT, 19)?;
        if let Some(command) = words::check(found, &margins.scene) {
            page.lines(&typed(&format!("Check it: {command}")), SMALL, LINE)?;
        }
    }
    page.foot(&margins.scene, origin)?;
    let height = u32::try_from(page.y + 8)?;
    root.present()?;
    Ok(height)
}

/// The page as far as it is drawn: down to `y`.
struct Page<'a, 'b> {
    area: &'a Area<'b>,
    y: i32,
}

impl Page<'_, '_> {
    /// Draws a text over the whole width, in as many lines as it takes.
    fn lines(&mut self, text: &str, size: i32, height: i32) -> Drawn<()> {
        for line in wrapped(text, letters_in(WIDTH - 2 * LEFT as u32, size)) {
            write_at(self.area, &line, (LEFT, self.y), size)?;
            self.y += height;
        }
        Ok(())
    }

    /// Draws a line across, with room around it.
    fn rule(&mut self) -> Drawn<()> {
        self.y += 4;
        let corners = [(LEFT, self.y), (WIDTH as i32 - LEFT, self.y + 1)];
        let corners = corners.map(|(x, y)| (px(x), px(y)));
        self.area.draw(&Rectangle::new(corners, RULE.filled()))?;
        self.y += 6;
        Ok(())
    }

    /// Draws a table and its notes.
    fn table(&mut self, table: &Table) -> Drawn<()> {
        let room = (WIDTH as i32 - 2 * LEFT) / LETTER;
        for cells in table.lines(room as usize, (APART / LETTER) as usize) {
            let mut x = LEFT;
            for cell in cells {
                let width = LETTER * cell.chars().count() as i32;
                let text = printed(cell.trim());
                if cell.starts_with(' ') {
                    write_from(self.area, &text, (x + width, self.y), SMALL, HPos::Right)?;
                } else {
                    write_at(self.area, &text, (x, self.y), SMALL)?;
                }
                x += width + APART;
            }
            self.y += LINE + 2;
        }
        table.notes().iter().try_for_each(|note| self.lines(&typed(note), SMALL, LINE))
    }

    /// Draws the scene and the command.
    fn foot(&mut self, scene: &Scene, origin: &Provenance) -> Drawn<()> {
        self.rule()?;
        let most = letters_in(WIDTH - 2 * LEFT as u32, SMALL);
        self.lines(&scene.title, SMALL, LINE)?;
        let told = format!("{} {}: {}", command::PROGRAM, command::VERSION, origin.command);
        let mut command = wrapped(&typed(&told), most);
        if command.len() > COMMAND {
            command.truncate(COMMAND - 1);
            command.push("... (the whole command is in the description of this picture)".into());
        }
        for line in parameters(scene, most).into_iter().chain(command) {
            write_at(self.area, &line, (LEFT, self.y), SMALL)?;
            self.y += LINE;
        }
        Ok(())
    }
}

/// Returns a number with its unit as print has it: `−4·10⁻⁸ rad`, `50 µs`, `kg m²`; words as
/// they are, with Greek letters.
fn printed(text: &str) -> String {
    let is_power = |word: &str| word.parse::<f64>().is_ok() && word.contains('e');
    let words = text.split(' ').map(|word| match word.split_once('e') {
        Some((digits, power)) if is_power(word) => {
            format!("{digits}·{}", power_of_ten(power.parse().unwrap_or(0.0)))
        }
        _ => match word.strip_prefix('u') {
            Some(unit) if ["m", "s", "N", "W"].contains(&unit) => format!("µ{unit}"),
            _ => word.replace("^2", "²"),
        },
    });
    in_print(&words.collect::<Vec<_>>().join(" "))
}
/// Returns every parameter of a scene, but what it has at zero of its start and its ramp, in
/// lines of at most so many letters.
fn parameters(scene: &Scene, most: usize) -> Vec<String> {
    let mut told: Vec<String> = Vec::new();
    for key in KEYS {
        let number = matches!(key.allowed, Allowed::Real { .. } | Allowed::Whole { .. });
        let own =
            ["solver.", "excitation.", "view."].iter().any(|table| key.path.starts_with(table));
        if !number || own {
            continue;
        }
        let value = match (key.get)(scene) {
            Value::Real(0.0) if key.path.starts_with("initial.") || key.path.contains("ramp") => {
                continue;
            }
            Value::Real(x) => with_unit(x, 6, if key.unit == "-" { "" } else { key.unit }),
            other => other.to_string(),
        };
        told.push(format!("{} = {}", in_print(&symbol(key.path)), printed(&value)));
    }
    if scene.excitation.amplitude_nm != 0.0 {
        let torque = with_unit(scene.excitation.amplitude_nm, 6, "N m");
        told.push(format!("engine order {} with {torque}", scene.excitation.order));
    }
    let solver = &scene.solver;
    told.push(format!("{} solver, {} law, {} model", solver.kind, solver.contact, solver.model));
    if solver.kind == SolverKind::Explicit {
        told.push(format!("h = {}", printed(&time(solver.step_s))));
    }
    told.push(format!("runs of {}", printed(&time(solver.end_s))));
    let mut lines: Vec<String> = Vec::new();
    for one in told {
        match lines.last_mut() {
            // Nothing is broken within a value.
            Some(line) if line.chars().count() + one.chars().count() + 3 <= most => {
                line.push_str(", ");
                line.push_str(&one);
            }
            _ => lines.push(one),
        }
    }
    let last = lines.len().saturating_sub(1);
    lines.iter_mut().take(last).for_each(|line| line.push(','));
    lines
}
#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_printed_with_the_signs_of_print() {
        for (text, told) in [
            ("-4.35e-8 rad", "−4.35·10⁻⁸ rad"),
            ("1e6", "1·10⁶"),
            ("50 us", "50 µs"),
            ("0.2 kg m^2", "0.2 kg m²"),
            ("+0.50 %", "+0.50 %"),
            ("263.5 times", "263.5 times"),
        ] {
            assert_eq!(printed(text), told);
        }
    }
}
