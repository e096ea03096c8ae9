//! The row of one limit: its symbol, value and words, its bar, where the scene stands,
//! and what moves it most.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::bar::{self, ENDS, Range};
use super::{LINE, Page, SMALL, TEXT, WIDTH};
use crate::report::line::wrapped;
use crate::report::margins::{LimitRow, words};
use crate::report::svg::LEFT;
use crate::report::svg::paper::{Drawn, letters_in, write_at, write_from};
use crate::report::symbols::{in_print, symbol};
use crate::report::ticks::power_of_ten;
use crate::study::margins::{LimitName, Margins, Quantity};

/// Left of what is said of the margin.
const MARGIN: i32 = 582;
/// Zero of the bars of what moves a limit, and their longest way from it.
const ZERO: i32 = 726;
const REACH: i32 = 30;
/// Least height of a row.
const HEIGHT: i32 = 51;
/// Least and most change in per cent at the end of a bar: a longer one is cut.
const CHANGES: [f64; 2] = [1.0, 4.0];
/// Bars of what moves a limit more, and less.
const MORE: RGBColor = RGBColor(60, 60, 60);
const LESS: RGBColor = RGBColor(170, 170, 170);

/// Said of a limit that is searched, where its search has no derivative.
const NOT_SMOOTH: &str = "not smooth here";

/// A number with its unit as print has it: `−4·10⁻⁸ rad`, `50 µs`, `kg m²`.
pub(super) fn printed(text: &str) -> String {
    let (number, unit) = text.split_once(' ').unwrap_or((text, ""));
    let unit = unit.strip_prefix('u').map_or_else(|| unit.to_string(), |unit| format!("µ{unit}"));
    let number = match number.split_once('e') {
        Some((digits, exponent)) => {
            format!("{digits}·{}", power_of_ten(exponent.parse().unwrap_or(0.0)))
        }
        None => number.to_string(),
    };
    format!("{number} {}", unit.replace("^2", "²")).trim_end().replace('-', "−")
}

/// Draws a row for each speed and each pulse.
pub(super) fn draw_all(margins: &Margins, page: &mut Page<'_, '_>) -> Drawn<()> {
    let all = LimitRow::all(margins, &[]);
    let rows: Vec<&LimitRow> = all.iter().filter(|row| !row.is_load()).collect();
    let changes = rows.iter().flat_map(|row| row.strongest()).map(|(_, by)| by.abs());
    let longest = changes.fold(CHANGES[0], f64::max).min(CHANGES[1]);
    let pulses = Range::of_pulses(&margins.limits);
    write_at(page.area, "limit", (LEFT, page.y), SMALL)?;
    let bands = margins.limits.iter().any(|limit| !limit.bands.is_empty());
    bar::legend(page.area, page.y, bands)?;
    let last = WIDTH as i32 - LEFT;
    let told = "+1 % of each of these moves it by";
    write_from(page.area, told, (last, page.y), SMALL, HPos::Right)?;
    page.y += LINE;
    for row in rows {
        page.rule()?;
        draw(row, pulses.filter(|_| row.quantity() == Quantity::Pulse), longest, page)?;
    }
    Ok(())
}

fn draw(row: &LimitRow, shared: Option<Range>, longest: f64, page: &mut Page<'_, '_>) -> Drawn<()> {
    let (area, top) = (page.area, page.y);
    let value = row.value().map(|value| printed(&words::value(value, 6, row.quantity())));
    let value = value.as_deref().unwrap_or("none");
    write_at(area, &format!("{} = {value}", row.name.symbol()), (LEFT, top), TEXT)?;
    let room = letters_in((ENDS[0] - LEFT - 18) as u32, SMALL);
    let mut y = top + 20;
    for line in wrapped(&what(row), room) {
        write_at(area, &line, (LEFT, y), SMALL)?;
        y += LINE;
    }
    if let Some((limit, value)) = row.limit().zip(row.value()) {
        bar::draw(area, limit, value, shared.unwrap_or_else(|| Range::of(limit)), top)?;
        let margin = row.margin().map(words::margin).unwrap_or_default();
        write_at(area, &printed(&margin), (MARGIN, top + 11), SMALL)?;
        write_at(area, &row.way(), (MARGIN, top + 11 + LINE), SMALL)?;
        moves(row, longest, top, page)?;
    }
    page.y = y.max(top + HEIGHT);
    Ok(())
}

/// What a limit is, under which law, and what else is to be said.
fn what(row: &LimitRow) -> String {
    let own = row.name == LimitName::LastingPulse;
    let law = row.law.filter(|_| own).map(|law| format!(", {law} law"));
    let note = row.note().map(|note| format!("; {note}"));
    format!("{}{}{}", row.name.what(), law.unwrap_or_default(), note.unwrap_or_default())
}

/// What moves a limit most, as bars on both sides of zero.
fn moves(row: &LimitRow, longest: f64, top: i32, page: &Page<'_, '_>) -> Drawn<()> {
    let strongest = row.strongest();
    if strongest.is_empty() && row.law.is_some() {
        return write_from(page.area, NOT_SMOOTH, (ZERO, top + 11), SMALL, HPos::Center);
    }
    for ((path, by), y) in strongest.iter().zip((top + 3..).step_by(LINE as usize)) {
        let name = in_print(&symbol(path));
        write_from(page.area, &name, (ZERO - REACH - 4, y), SMALL, HPos::Right)?;
        let long = (f64::from(REACH) * (by.abs() / longest).min(1.0)).round().max(1.0) as i32;
        let (x, colour) =
            if *by > 0.0 { ([ZERO, ZERO + long], MORE) } else { ([ZERO - long, ZERO], LESS) };
        bar::fill(page.area, x, [y + 3, y + 11], colour)?;
        if by.abs() > longest {
            // A gap near the end says that the bar is cut.
            let at = if *by > 0.0 { x[1] - 6 } else { x[0] + 4 };
            bar::fill(page.area, [at, at + 2], [y + 3, y + 11], WHITE)?;
        }
        bar::fill(page.area, [ZERO, ZERO + 1], [y, y + 14], BLACK)?;
        let change = printed(&words::change(*by));
        write_at(page.area, &change, (ZERO + REACH + 4, y), SMALL)?;
    }
    Ok(())
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
