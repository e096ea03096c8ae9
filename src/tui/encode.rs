//! Encodes a frame in as few bytes as possible, using only sequences that all terminals interpret
//! alike. Over SSH, the number of bytes determines the delay.

use std::io::{Error, Write};

use crossterm::style::Colored;
use ratatui::backend::IntoCrossterm;
use ratatui::buffer::{Cell, CellWidth};

/// Writes the changed cells of a frame, row by row, for a terminal of `columns` columns.
///
/// # Errors
/// Writing failed, usually because the terminal was closed.
pub fn write_cells<'a>(
    out: &mut impl Write,
    columns: u16,
    cells: impl Iterator<Item = (u16, u16, &'a Cell)>,
) -> Result<(), Error> {
    // Position and style are unknown at first: the previous frame may have been interrupted.
    let (mut at, mut last): (_, Option<&Cell>) = (None, None);
    for (x, y, cell) in cells {
        out.write_all(cursor_move(at, (x, y)).as_bytes())?;
        if last.is_none_or(|last| last.style() != cell.style()) {
            out.write_all(change(last.map(codes), codes(cell)).as_bytes())?;
        }
        out.write_all(cell.symbol().as_bytes())?;
        // After the last column, and after combined or recent characters, terminals disagree on
        // the position of the cursor.
        let is_usual = cell.symbol().len() < 4 && cell.symbol().chars().nth(1).is_none();
        let is_known = is_usual && cell.cell_width() == 1 && x + 1 < columns;
        (at, last) = (is_known.then_some((x + 1, y)), Some(cell));
    }
    // If no cell changed, nothing is sent, not even a reset.
    last.map_or(Ok(()), |_| out.write_all(b"\x1b[m"))
}

/// Returns the shortest escape sequence that moves the cursor from one (column, row) to another;
/// `from` is `None` if the position of the cursor is not known.
fn cursor_move(from: Option<(u16, u16)>, (x, y): (u16, u16)) -> String {
    let (start, across) = match from {
        Some((at, row)) if row == y && at <= x => ("", x - at),
        // A line feed alone may or may not return to column 0, depending on terminal settings.
        Some((_, row)) if row + 1 == y => ("\r\n", x),
        _ => return format!("\x1b[{};{}H", y + 1, x + 1),
    };
    let count = if across > 1 { across.to_string() } else { String::new() };
    if across == 0 { start.into() } else { format!("{start}\x1b[{count}C") }
}

/// Returns the escape sequence that switches from one style to another, given by their SGR codes;
/// `old` is `None` if the style of the terminal is not known.
fn change(old: Option<Vec<String>>, mut new: Vec<String>) -> String {
    // Codes can only be added or replaced by one of the same kind, otherwise a reset is needed. A
    // bright colour must replace a bright one, because some consoles keep its bold attribute.
    let kind = |code: &String| (code.len(), code.chars().next());
    match old.filter(|old| old.iter().all(|old| new.iter().any(|new| kind(new) == kind(old)))) {
        Some(old) => new.retain(|new| !old.contains(new)),
        None => new.insert(0, String::new()),
    }
    format!("\x1b[{}m", new.join(";"))
}

/// Returns the SGR codes of a cell's style: modifiers, then colours other than the default.
fn codes(cell: &Cell) -> Vec<String> {
    // The bits of the modifiers are in the order of their SGR codes.
    let modifiers = (0..9).filter(|k| cell.modifier.bits() >> k & 1 == 1);
    let [front, back] = [cell.fg, cell.bg].map(IntoCrossterm::into_crossterm);
    let colours = [Colored::ForegroundColor(front), Colored::BackgroundColor(back)].map(code);
    modifiers.map(|k| (k + 1).to_string()).chain(colours.into_iter().flatten()).collect()
}

/// Returns the SGR code of a colour, in the short form for the first sixteen; `None` for the
/// default colour.
fn code(colour: Colored) -> Option<String> {
    let long = colour.to_string();
    match long.split_once(";5;").map(|(kind, index)| (kind.parse(), index.parse())) {
        Some((Ok::<u8, _>(kind), Ok::<u8, _>(index @ 0..8))) => {
            Some((kind - 8 + index).to_string())
        }
        Some((Ok(kind), Ok(index @ 8..16))) => Some((kind + 44 + index).to_string()),
        _ => Some(long).filter(|long| long.len() > 2),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::app::App;
    use crate::tui::{Marker, theme::Theme};
    use fastrand::Rng;
    use ratatui::Terminal;
    use ratatui::backend::{Backend, CrosstermBackend, TestBackend};
    use ratatui::buffer::Buffer;
    use ratatui::layout::Rect;
    use ratatui::style::{Color, Modifier, Style};
    use std::num::NonZeroU16;

    /// One cell of a frame: position, symbol, foreground, background and modifiers.
    type Drawn = (u16, u16, &'static str, Color, Color, Modifier);

    /// Narrow, wide, combined and recent characters, and those of charts.
    const SIGNS: [&str; 14] = [
        " ",
        " ",
        "a",
        "Z",
        "9",
        "│",
        "⣿",
        "█",
        "Ω",
        "漢",
        "🦀",
        "e\u{301}",
        "x\u{332}",
        "\u{1cd00}",
    ];

    const COLOURS: [Color; 10] = [
        Color::Reset,
        Color::Black,
        Color::Red,
        Color::Yellow,
        Color::Magenta,
        Color::Gray,
        Color::DarkGray,
        Color::LightRed,
        Color::LightCyan,
        Color::White,
    ];

    fn colour(rng: &mut Rng) -> Color {
        match rng.u8(..10) {
            0 => Color::Indexed(rng.u8(..)),
            1 => Color::Rgb(rng.u8(..), rng.u8(..), rng.u8(..)),
            _ => COLOURS[rng.usize(..COLOURS.len())],
        }
    }

    /// Modifiers that the test's terminal parser supports; it keeps only the later of bold and dim.
    fn modifier(rng: &mut Rng) -> Modifier {
        let weight = [Modifier::empty(), Modifier::BOLD, Modifier::DIM][rng.usize(..3)];
        let others = [Modifier::ITALIC, Modifier::UNDERLINED, Modifier::REVERSED];
        others.into_iter().filter(|_| rng.bool()).fold(weight, Modifier::union)
    }

    fn frames(rng: &mut Rng, size: Rect) -> Vec<Vec<Drawn>> {
        let counts: Vec<u8> = (0..rng.u8(1..6)).map(|_| rng.u8(..120)).collect();
        let frame = |cells: u8| {
            let styles: Vec<_> =
                (0..rng.u8(1..4)).map(|_| (colour(rng), colour(rng), modifier(rng))).collect();
            let cell = |_| {
                let (fg, bg, modifier) = styles[rng.usize(..styles.len())];
                let (x, y) = (rng.u16(..size.width), rng.u16(..size.height));
                (x, y, SIGNS[rng.usize(..SIGNS.len())], fg, bg, modifier)
            };
            (0..cells).map(cell).collect()
        };
        counts.into_iter().map(frame).collect()
    }

    fn terminal(size: Rect) -> vt100::Parser {
        let of = |cells| NonZeroU16::new(cells).unwrap();
        vt100::Parser::new(of(size.height), of(size.width), 0)
    }

    /// Returns every cell with its style, without the position of the cursor.
    fn shown(parser: &vt100::Parser, size: Rect) -> Vec<Option<vt100::Cell>> {
        let screen = parser.screen();
        size.positions().map(|place| screen.cell(place.y, place.x).cloned()).collect()
    }

    #[test]
    fn a_terminal_shows_the_same_as_with_the_usual_bytes() {
        for case in 0..256 {
            let rng = &mut Rng::with_seed(case);
            let size = Rect::new(0, 0, rng.u16(2..30), rng.u16(1..9));
            let frames = frames(rng, size);
            let torn = rng.bool();
            crossterm::style::force_color_output(true);
            let (mut usual, mut short) = (terminal(size), terminal(size));
            if torn {
                // An interrupted frame has changed the style and the cursor position.
                short.process(b"\x1b[1;4;7;31;42m\x1b[2;2H");
            }
            let mut before = Buffer::empty(size);
            for frame in frames {
                let mut after = before.clone();
                for (x, y, sign, fg, bg, modifier) in frame {
                    let style = Style::reset().fg(fg).bg(bg).add_modifier(modifier);
                    after.set_string(x, y, sign, style);
                }
                let mut bytes = Vec::new();
                let changed = before.diff(&after);
                CrosstermBackend::new(&mut bytes).draw(changed.iter().copied()).unwrap();
                usual.process(&bytes);
                bytes.clear();
                write_cells(&mut bytes, size.width, changed.into_iter()).unwrap();
                short.process(&bytes);
                assert_eq!(shown(&short, size), shown(&usual, size), "case {case}");
                before = after;
            }
        }
    }

    #[test]
    fn a_screen_takes_less_than_three_quarters_of_the_usual_bytes() {
        crossterm::style::force_color_output(true);
        let mut terminal = Terminal::new(TestBackend::new(80, 24)).unwrap();
        let scene = rubscope_solver::scene::Scene::base().checked().unwrap();
        let app = App::new(scene, Theme::Dark, Marker::Braille);
        terminal.draw(|frame| crate::tui::panels::draw(frame, &app)).unwrap();
        let screen = terminal.backend().buffer();
        let changed = Buffer::empty(screen.area).diff(screen);
        let (mut usual, mut short) = (Vec::new(), Vec::new());
        CrosstermBackend::new(&mut usual).draw(changed.iter().copied()).unwrap();
        write_cells(&mut short, 80, changed.into_iter()).unwrap();
        assert!(4 * short.len() < 3 * usual.len(), "{} of {}", short.len(), usual.len());
    }
}
