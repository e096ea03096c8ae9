//! The bar of a limit: from zero to the limit, or to the present value where that is
//! beyond, with both on it; and the small bar of a sensitivity.

use ratatui::{buffer::Buffer, layout::Position, layout::Rect, style::Modifier};

use crate::report::margins::LimitRow;
use crate::study::margins::{Band, Limit, Quantity};
use crate::tui::appearance::Appearance;
use crate::tui::knobs::KnobRange;
use crate::tui::theme::Role;

/// How far the scale of a pulse goes below and above what is on it, as a factor: it
/// is one of factors, and has no zero.
const AROUND: f64 = 2.0;

/// Signs of a bar: below the present value, that value, above it, the limit, both in
/// one cell, and pulses that last.
pub fn signs(look: &Appearance) -> [&'static str; 6] {
    look.either(["▒", "█", "▁", "┃", "╋", "▄"], ["=", "#", ".", "|", "+", "o"])
}

/// A limit on its scale.
#[derive(Debug)]
pub struct LimitBar<'a> {
    limit: &'a Limit,
    value: f64,
    present: f64,
    range: KnobRange,
}

impl<'a> LimitBar<'a> {
    /// The bar of a row; none of a load, and none where there is no such limit.
    pub fn of(row: &LimitRow<'a>) -> Option<Self> {
        let limit = row.limit()?;
        let (value, present) = limit.value.zip(limit.present)?;
        // Magnitudes: a negative pulse has negative limits.
        let sign = if value < 0.0 { -1.0 } else { 1.0 };
        let (value, present) = (sign * value, sign * present);
        let log = limit.quantity == Quantity::Pulse;
        let ends = limit.bands.iter().flat_map(|band| [Some(band.from_n), band.to_n]);
        let ends = ends.flatten().map(|end| sign * end);
        let all = || ends.clone().chain([value, present]).filter(|x| *x > 0.0);
        let most = all().fold(0.0, f64::max);
        let range = match log {
            true => KnobRange::log(all().fold(most, f64::min) / AROUND, most * AROUND),
            false => KnobRange::linear(0.0, most),
        };
        (range.is_sound() && value > 0.0).then_some(Self { limit, value, present, range })
    }

    /// Draws it over the cells of one row.
    pub fn draw(&self, look: &Appearance, buffer: &mut Buffer, cells: Rect, old: bool) {
        if cells.width == 0 {
            return;
        }
        let [full, now, empty, limit, both, lasting] = signs(look);
        let width = f64::from(cells.width);
        let cell = |x: f64| ((self.range.part(x) * width) as u16).min(cells.width - 1);
        let (here, there) = (cell(self.present), cell(self.value));
        for k in 0..cells.width {
            let ends = [k, k + 1].map(|k| self.range.at(f64::from(k) / width));
            let lasts = self.limit.bands.iter().any(|band| reaches(band, ends));
            let (sign, role) = match () {
                () if k == here && k == there => (both, Role::Focus),
                () if k == here => (now, Role::Focus),
                () if k == there => (limit, Role::Text),
                () if lasts => (lasting, Role::Contact),
                () if k < here => (full, Role::Quiet),
                () => (empty, Role::Quiet),
            };
            let mut style = look.style(if old { Role::Quiet } else { role });
            if k == there && !old {
                style = style.add_modifier(Modifier::BOLD);
            }
            if let Some(cell) = buffer.cell_mut(Position::new(cells.x + k, cells.y)) {
                cell.reset();
                cell.set_symbol(sign).set_style(style);
            }
        }
    }
}

/// Whether a band has something between two pulses.
fn reaches(band: &Band, [from, to]: [f64; 2]) -> bool {
    band.from_n.abs() < to && band.to_n.is_none_or(|end| end.abs() >= from)
}

/// A part of the greatest change, -1 to 1, to the left or the right of the middle of
/// an odd number of cells.
pub fn signed(part: f64, width: u16, look: &Appearance) -> String {
    let side = usize::from(width / 2);
    // Half cells; the least is seen, too.
    let halves = (part.abs().min(1.0) * 2.0 * side as f64).round().max(1.0) as usize;
    let (whole, half) = (halves / 2, halves % 2);
    let [block, left, right, middle] = look.either(["█", "▐", "▌", "│"], ["=", "-", "-", "|"]);
    let blank = " ".repeat(side.saturating_sub(whole + half));
    let (blocks, empty) = (block.repeat(whole), " ".repeat(side));
    match part < 0.0 {
        true => format!("{blank}{}{blocks}{middle}{empty}", left.repeat(half)),
        false => format!("{empty}{middle}{blocks}{}{blank}", right.repeat(half)),
    }
}
