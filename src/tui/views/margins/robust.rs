//! The head of view 8: the distance of this run from another verdict, as a sentence and one row per
//! quantity, under each contact law examined.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::report::margins::robust;
use crate::tui::app::App;
use crate::tui::text::{print, wrap};
use crate::tui::theme::Role;
use rubscope_solver::study::margins::Margins;

/// Index of the column with the current value.
const NOW: usize = 2;
/// Width from which the sentence names the lobes that end a lock \[columns\].
const WIDE: usize = 70;
/// Rows of limits that stay visible below on a small screen.
const LEFT: usize = 6;

/// Draws the head at the top of an area; returns its height. The rows of the second law are shown
/// only if all `limits` fit below them.
pub fn draw(app: &App, margins: &Margins, buffer: &mut Buffer, area: Rect, limits: usize) -> u16 {
    let (look, mut lines) = (&app.appearance, Vec::new());
    let (height, width) = (usize::from(area.height), usize::from(area.width.saturating_sub(1)));
    for (place, found) in robust::asked(margins).enumerate() {
        let sentence = robust::sentence(found, margins, width >= WIDE);
        let sentence = wrap(&look.spell(&sentence), width);
        let shown = |at| robust::table(found, at).lines(usize::MAX, 1);
        let wide = |row: &Vec<String>| row.join(" ").chars().count() > width;
        let ways = [" at ", " "].map(shown).into_iter().find(|rows| !rows.iter().any(wide));
        let rows = ways.unwrap_or_else(|| {
            let mut rows = shown(" ");
            // The current values are at the knobs too, so drop their column first.
            rows.iter_mut().for_each(|row| drop(row.remove(NOW)));
            rows
        });
        if lines.len() + sentence.len() + LEFT > height {
            break;
        }
        lines.extend(sentence.into_iter().map(|line| (line, Role::Text)));
        let below = if place == 0 { LEFT } else { limits + 2 };
        if lines.len() + rows.len() + below <= height {
            let role = |row| if row == 0 { Role::Quiet } else { Role::Text };
            lines.extend(rows.iter().enumerate().map(|(row, cells)| (cells.join(" "), role(row))));
        }
    }
    let at = Rect { x: area.x + 1, width: area.width.saturating_sub(1), ..area };
    for (y, (text, role)) in (0..).zip(&lines) {
        print(buffer, at, y, &look.spell(text), look.style(*role));
    }
    u16::try_from(lines.len()).unwrap_or(area.height)
}
