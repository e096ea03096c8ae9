//! The margins of a scene as one page for a report: conditions, a row for each limit
//! (`row`), the loads of the lock and what was asked for
//! (`tables`), and at the foot the scene and the command.

mod row;
mod tables;

use std::io::{Error, Result, Write};

use plotters::prelude::*;

use super::paper::{Area, Drawn, FINE, letters_in, typed, write_at};
use super::{LEFT, TITLE, describe, finish};
use crate::report::line::wrapped;
use crate::report::margins::words;
use crate::report::{Provenance, command};
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

/// Draws the page on paper of this height; the height that it takes.
fn draw(margins: &Margins, origin: &Provenance, height: u32, text: &mut String) -> Drawn<u32> {
    let root = SVGBackend::with_string(text, (FINE * WIDTH, FINE * height)).into_drawing_area();
    root.fill(&WHITE)?;
    let mut page = Page { area: &root, y: 10 };
    page.lines(&margins.scene.title, TITLE, 25)?;
    let conditions = words::conditions(margins).replace('-', "−").replace(" us,", " µs,");
    page.lines(&conditions, TEXT, 19)?;
    words::note(margins).iter().try_for_each(|note| page.lines(note, TEXT, 19))?;
    page.y += 6;
    row::draw_all(margins, &mut page)?;
    tables::loads(margins, &mut page)?;
    tables::target(margins, &mut page)?;
    foot(margins, origin, &mut page)?;
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
    /// A text over the whole width, in as many lines as it takes.
    fn lines(&mut self, text: &str, size: i32, height: i32) -> Drawn<()> {
        for line in wrapped(text, letters_in(WIDTH - 2 * LEFT as u32, size)) {
            write_at(self.area, &line, (LEFT, self.y), size)?;
            self.y += height;
        }
        Ok(())
    }

    /// A line across, with room around it.
    fn rule(&mut self) -> Drawn<()> {
        self.y += 4;
        row::fill(self.area, [LEFT, WIDTH as i32 - LEFT], [self.y, self.y + 1], RULE)?;
        self.y += 6;
        Ok(())
    }
}

/// The scene and the command, at the foot.
fn foot(margins: &Margins, origin: &Provenance, page: &mut Page<'_, '_>) -> Drawn<()> {
    page.rule()?;
    let most = letters_in(WIDTH - 2 * LEFT as u32, SMALL);
    page.lines(&margins.scene.title, SMALL, LINE)?;
    for line in tables::parameters(&margins.scene, most) {
        write_at(page.area, &line, (LEFT, page.y), SMALL)?;
        page.y += LINE;
    }
    let told = format!("{} {}: {}", command::PROGRAM, command::VERSION, origin.command);
    let mut lines = wrapped(&typed(&told), most);
    if lines.len() > COMMAND {
        lines.truncate(COMMAND - 1);
        lines.push("... (the whole command is in the description of this picture)".to_string());
    }
    for line in lines {
        write_at(page.area, &line, (LEFT, page.y), SMALL)?;
        page.y += LINE;
    }
    Ok(())
}
