//! Text on the screen: single rows, rows of styled pieces, and wrapped lines.

use ratatui::widgets::{Clear, Widget};
use ratatui::{buffer::Buffer, layout::Rect, style::Style};

use crate::sheet::line::{harmless, wrapped};

/// Upper bound on the average number of characters per cell. A letter may carry several accents;
/// longer sequences are cut.
const MOST_IN_CELL: usize = 4;

/// Default mark of a text that is cut off.
pub const CUT: char = '…';

/// Prints a text in one row of an area. A text that does not fit is cut, with a mark at the end;
/// control characters become spaces.
pub fn print(buffer: &mut Buffer, area: Rect, row: u16, text: &str, style: Style) {
    if row < area.height && area.width > 0 {
        let width = usize::from(area.width);
        // In an area of very few columns, a letter is more useful than the mark.
        let text = match width {
            0..4 => shorten(text, width, ""),
            _ => shorten(text, width, CUT.encode_utf8(&mut [0; 4])),
        };
        buffer.set_stringn(area.x, area.y + row, text, width, style);
    }
}

/// Prints lines over what an area shows, one in each row. The rows are cleared first.
pub fn overlay(buffer: &mut Buffer, area: Rect, lines: &[String], style: Style) {
    for (row, line) in (0..area.height).zip(lines) {
        Clear.render(Rect { y: area.y + row, height: 1, ..area }, buffer);
        print(buffer, area, row, line, style);
    }
}

/// Returns the number of columns that a text takes on the screen.
pub fn columns(text: &str) -> usize {
    ratatui::text::Span::raw(text).width()
}

/// Shortens a text to at most `width` columns; `mark` replaces the end if it is cut.
pub fn shorten(text: &str, width: usize, mark: &str) -> String {
    // Only a prefix is measured, because the text may be very long.
    let text: String = text.chars().take(MOST_IN_CELL * (width + 1)).map(harmless).collect();
    if columns(&text) <= width {
        return text;
    }
    let room = width.saturating_sub(columns(mark));
    let mut used = 0;
    let fits = |letter: &char| {
        used += columns(letter.encode_utf8(&mut [0; 4]));
        used <= room
    };
    let kept = text.chars().take_while(fits);
    kept.chain(mark.chars()).take(width).collect()
}

/// Prints pieces of text in one row, from the left, and stops at the first that does not fit.
pub fn pieces(buffer: &mut Buffer, area: Rect, row: u16, parts: &[(String, Style)]) {
    if row >= area.height {
        return;
    }
    let mut x = area.x;
    for (text, style) in parts {
        // A trailing space may extend past the edge.
        let left = usize::from(area.right().saturating_sub(x));
        if columns(text.trim_end_matches(' ')) > left {
            return;
        }
        buffer.set_stringn(x, area.y + row, text, left, *style);
        x = x.saturating_add(u16::try_from(columns(text)).unwrap_or(u16::MAX));
    }
}

/// Wraps a text to lines no wider than `width`; returns at least one.
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    let lines = wrapped(text, width.max(1));
    if lines.is_empty() { vec![String::new()] } else { lines }
}

/// Returns the first `rows` lines. If there are more, the last one continues with them, up to
/// `width`, and ends in `mark`.
pub fn first_lines(mut lines: Vec<String>, width: usize, rows: usize, mark: &str) -> Vec<String> {
    if lines.len() > rows && rows > 0 {
        let rest = lines.split_off(rows - 1).join(" ");
        lines.push(shorten(&rest, width, mark));
    }
    lines.truncate(rows);
    lines
}

/// Wraps a text to lines no wider than `width`, and drops parts at its end, each after a comma,
/// until it has at most `rows` lines or one part.
pub fn whole_parts(text: &str, width: usize, rows: usize) -> Vec<String> {
    let lines = wrap(text, width);
    match text.rsplit_once(", ") {
        Some((before, _)) if lines.len() > rows => whole_parts(before, width, rows),
        _ => lines,
    }
}

/// Lists the first three blade numbers, as in `1,2,3`; `,..` stands for more.
pub fn few(blades: &[u32]) -> String {
    let names: Vec<String> = blades.iter().take(3).map(ToString::to_string).collect();
    format!("{}{}", names.join(","), if blades.len() > 3 { ",.." } else { "" })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row(draw: impl Fn(&mut Buffer, Rect)) -> String {
        let area = Rect::new(0, 0, 10, 1);
        let mut buffer = Buffer::empty(area);
        draw(&mut buffer, area);
        buffer.content.iter().map(|cell| cell.symbol()).collect()
    }

    #[test]
    fn lines_that_have_no_room_are_told_by_a_mark() {
        let text = "one two three four five";
        let lines = |rows| first_lines(wrap(text, 9), 9, rows, "…");
        assert_eq!(lines(3), ["one two", "three", "four five"]);
        assert_eq!(lines(2), ["one two", "three fo…"]);
        assert!(lines(0).is_empty());
        assert_eq!(whole_parts("one, two three, four", 9, 2), ["one, two", "three"]);
        assert_eq!(whole_parts("one, two three, four", 7, 1), ["one"]);
        assert_eq!((few(&[1, 8, 15]), few(&[1, 7, 12, 18])), ("1,8,15".into(), "1,7,12,..".into()));
    }

    #[test]
    fn what_does_not_fit_ends_in_a_mark() {
        let print = |text: &str| row(|buffer, area| print(buffer, area, 0, text, Style::new()));
        assert_eq!(print("ten letter"), "ten letter");
        assert_eq!(print("eleven lett"), "eleven le…");
        let parts = |texts: &[&str]| {
            let parts: Vec<_> = texts.iter().map(|text| (text.to_string(), Style::new())).collect();
            row(|buffer, area| pieces(buffer, area, 0, &parts))
        };
        assert_eq!(parts(&[" abc ", " defg "]), " abc  defg");
        assert_eq!(parts(&[" abc ", " defgh "]), " abc      ");
    }
}
