//! The row of one limit: its symbol, value and words, where the scene stands, what moves it
//! most, and its bar: from zero to the limit, with the value of the scene on it; decades where
//! the pulse of the scene is factors apart from it.

use plotters::prelude::*;
use plotters::style::text_anchor::HPos;

use super::{LINE, Page, SMALL, TEXT, WIDTH};
use crate::report::line::wrapped;
use crate::report::margins::{STRONGEST, words};
use crate::report::number::{rounded, short};
use crate::report::svg::LEFT;
use crate::report::svg::paper::{Area, Drawn, FINE, letters_in, px, write_at, write_from};
use crate::report::symbols::{in_print, symbol};
use crate::report::ticks::{log_ticks, power_of_ten};
use rubscope_solver::study::margins::{Limit, Margins, Quantity};

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
    let rows: Vec<&Limit> = margins.limits.iter().filter(|limit| !limit.is_load()).collect();
    let changes = rows
        .iter()
        .flat_map(|limit| limit.sensitivities.strongest(STRONGEST))
        .map(|(_, by)| by.abs());
    let longest = changes.fold(CHANGES[0], f64::max).min(CHANGES[1]);
    write_at(page.area, "limit", (LEFT, page.y), SMALL)?;
    legend(page.area, page.y)?;
    let last = WIDTH as i32 - LEFT;
    let told = "+1 % of each of these moves it by";
    write_from(page.area, told, (last, page.y), SMALL, HPos::Right)?;
    page.y += LINE;
    for row in rows {
        page.rule()?;
        draw(row, longest, page)?;
    }
    Ok(())
}

fn draw(row: &Limit, longest: f64, page: &mut Page<'_, '_>) -> Drawn<()> {
    let (area, top) = (page.area, page.y);
    let value = row.value.map(|value| printed(&words::value(value, 6, row.quantity)));
    let value = value.as_deref().unwrap_or("none");
    write_at(area, &format!("{} = {value}", row.name.symbol()), (LEFT, top), TEXT)?;
    let room = letters_in((ENDS[0] - LEFT - 18) as u32, SMALL);
    let mut y = top + 20;
    for line in wrapped(&what(row), room) {
        write_at(area, &line, (LEFT, y), SMALL)?;
        y += LINE;
    }
    if let Some(value) = row.value {
        draw_bar(area, row, value, top)?;
        let margin = row.margin.map(words::margin).unwrap_or_default();
        write_at(area, &printed(&margin), (MARGIN, top + 11), SMALL)?;
        write_at(area, &row.way(), (MARGIN, top + 11 + LINE), SMALL)?;
        moves(row, longest, top, page)?;
    }
    page.y = y.max(top + HEIGHT);
    Ok(())
}

/// Returns what a limit is, and its note.
fn what(row: &Limit) -> String {
    let note = row.note.as_ref().map(|note| format!("; {note}"));
    format!("{}{}", row.name.what(), note.unwrap_or_default())
}

/// What moves a limit most, as bars on both sides of zero.
fn moves(row: &Limit, longest: f64, top: i32, page: &Page<'_, '_>) -> Drawn<()> {
    let strongest = row.sensitivities.strongest(STRONGEST);
    for ((path, by), y) in strongest.iter().zip((top + 3..).step_by(LINE as usize)) {
        let name = in_print(&symbol(path));
        write_from(page.area, &name, (ZERO - REACH - 4, y), SMALL, HPos::Right)?;
        let long = (f64::from(REACH) * (by.abs() / longest).min(1.0)).round().max(1.0) as i32;
        let (x, colour) =
            if *by > 0.0 { ([ZERO, ZERO + long], MORE) } else { ([ZERO - long, ZERO], LESS) };
        fill(page.area, x, [y + 3, y + 11], colour)?;
        if by.abs() > longest {
            // A gap near the end says that the bar is cut.
            let at = if *by > 0.0 { x[1] - 6 } else { x[0] + 4 };
            fill(page.area, [at, at + 2], [y + 3, y + 11], WHITE)?;
        }
        fill(page.area, [ZERO, ZERO + 1], [y, y + 14], BLACK)?;
        let change = printed(&words::change(*by));
        write_at(page.area, &change, (ZERO + REACH + 4, y), SMALL)?;
    }
    Ok(())
}

/// Left and right end of every bar.
pub(super) const ENDS: [i32; 2] = [318, 568];
/// Top and bottom of a bar, below the top of its row.
const BAR: [i32; 2] = [20, 32];
/// Pulses that are further apart than this factor are shown by decades.
const APART: f64 = 5.0;
/// Most labels of decades.
const LABELS: usize = 7;

/// Up to the limit.
const BELOW: RGBColor = RGBColor(224, 224, 224);
/// Beyond it.
const BEYOND: RGBColor = RGBColor(150, 150, 150);

/// The range of a bar.
#[derive(Clone, Copy, Debug)]
enum Range {
    /// From zero to this.
    Plain(f64),
    /// From one power of ten to another.
    Decades([f64; 2]),
}

impl Range {
    /// Creates the range of one limit.
    fn of(limit: &Limit) -> Self {
        let sizes = [limit.value, limit.present].into_iter().flatten().map(f64::abs);
        let most = sizes.clone().fold(0.0, f64::max);
        let least = sizes.filter(|size| *size > 0.0).fold(f64::INFINITY, f64::min);
        if limit.quantity == Quantity::Pulse && most > APART * least {
            let low = least.log10().floor();
            return Self::Decades([low, most.log10().ceil().max(low + 1.0)]);
        }
        Self::Plain(if most > 0.0 { most } else { 1.0 })
    }

    /// Where a value is on the bar \[px\].
    fn place(self, value: f64) -> i32 {
        let part = match self {
            Self::Plain(most) => value.abs() / most,
            Self::Decades([low, high]) if value != 0.0 => {
                (value.abs().log10() - low) / (high - low)
            }
            Self::Decades(_) => 0.0,
        };
        let [left, right] = ENDS;
        left + (part.clamp(0.0, 1.0) * f64::from(right - left)).round() as i32
    }
}

/// A filled rectangle between these places \[px\].
pub(super) fn fill(area: &Area, x: [i32; 2], y: [i32; 2], colour: RGBColor) -> Drawn<()> {
    let corners = [(px(x[0]), px(y[0])), (px(x[1]), px(y[1]))];
    Ok(area.draw(&Rectangle::new(corners, colour.filled()))?)
}

/// What is on the bars, in a line at `y`.
fn legend(area: &Area, y: i32) -> Drawn<()> {
    let left = ENDS[0];
    let bar = [y, y + 11];
    marker(area, left + 5, y + 9)?;
    write_at(area, "scene", (left + 14, y), SMALL)?;
    fill(area, [left + 60, left + 63], bar, BLACK)?;
    write_at(area, "limit", (left + 69, y), SMALL)?;
    Ok(())
}

/// The triangle that stands on the value of the scene.
fn marker(area: &Area, at: i32, tip: i32) -> Drawn<()> {
    let corners = [(at, tip), (at - 4, tip - 7), (at + 4, tip - 7)];
    Ok(area.draw(&Polygon::new(corners.map(|(x, y)| (px(x), px(y))).to_vec(), BLACK.filled()))?)
}

/// Draws the bar of a limit with a value, in the row that begins at `top`.
fn draw_bar(area: &Area, limit: &Limit, value: f64, top: i32) -> Drawn<()> {
    let range = Range::of(limit);
    let [left, right] = ENDS;
    let y = BAR.map(|y| top + y);
    let at = range.place(value);
    fill(area, [left, at], y, BELOW)?;
    if let Some(present) = limit.present
        && limit.margin.is_some_and(|margin| margin > 0.0)
    {
        fill(area, [at, range.place(present)], y, BEYOND)?;
    }
    let corners = [(px(left), px(y[0])), (px(right), px(y[1]))];
    area.draw(&Rectangle::new(corners, BLACK.stroke_width(FINE)))?;
    // The limit itself is the thick line.
    fill(area, [at - 1, at + 2], [y[0] - 3, y[1] + 3], BLACK)?;
    labels(area, range, y[1])?;
    match limit.present {
        Some(present) => mark(area, range.place(present), present, limit.quantity, top),
        None => Ok(()),
    }
}

/// The value of the scene, above the bar.
fn mark(area: &Area, at: i32, present: f64, quantity: Quantity, top: i32) -> Drawn<()> {
    let tip = top + BAR[0];
    marker(area, at, tip)?;
    fill(area, [at, at + 1], [tip, top + BAR[1]], BLACK)?;
    let told = printed(&words::value(present, 5, quantity));
    let [left, right] = ENDS;
    let (at, end) = match at {
        at if at < left + 30 => (at.max(left) - 4, HPos::Left),
        at if at > right - 30 => (at.min(right) + 4, HPos::Right),
        at => (at, HPos::Center),
    };
    write_from(area, &told, (at, top), SMALL - 1, end)
}

/// What the ends of a bar are, or its decades.
fn labels(area: &Area, range: Range, bottom: i32) -> Drawn<()> {
    let y = bottom + 4;
    let [left, right] = ENDS;
    match range {
        Range::Plain(most) => {
            write_from(area, "0", (left, y), SMALL - 1, HPos::Left)?;
            let most = printed(&short(rounded(most, 5)));
            write_from(area, &most, (right, y), SMALL - 1, HPos::Right)
        }
        Range::Decades([low, high]) => {
            for power in log_ticks(low, high, LABELS) {
                let at = range.place(10_f64.powf(power));
                fill(area, [at, at + 1], [bottom, bottom + 4], BLACK)?;
                write_from(area, &power_of_ten(power), (at, y + 1), SMALL - 1, HPos::Center)?;
            }
            Ok(())
        }
    }
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
