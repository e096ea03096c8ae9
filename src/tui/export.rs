//! The screen as a picture (SVG): the export of the wheel, and the pictures of the pages.

use ratatui::{
    buffer::{Buffer, Cell},
    layout::Rect,
    style::{Color, Modifier},
};

use super::app::{App, InputMode};
use super::panels;
use super::raster::sub_pixels;
use super::theme::Theme;
use crate::sheet::Provenance;
use crate::sheet::svg::{describe, escaped};

/// Size of a cell in the picture \[px\].
const CELL: (u32, u32) = (8, 17);
/// Diameter of the dots of a curve \[px\].
const DOT: f64 = 2.8;

/// Returns the screen as an SVG picture, without prompts and messages.
pub fn svg(app: &App) -> String {
    let mut plain = app.clone();
    plain.dialogue.mode = InputMode::Main;
    plain.status = None;
    let scene = app.run.film.scene.clone().into_scene();
    let mut out = opening(app, 0, &describe(&Provenance { command: app.command_line(), scene }));
    out.extend(rows(&plain));
    out.push_str("</svg>\n");
    out
}

/// Returns the start of a picture with `below` more rows than the screen: its size, the elements in
/// `with`, and the background.
pub fn opening(app: &App, below: u32, with: &str) -> String {
    let (columns, rows) = (u32::from(app.layout.size.0), u32::from(app.layout.size.1) + below);
    let (width, height) = (columns * CELL.0, rows * CELL.1);
    let ground = Ink::of(app.appearance.theme).ground;
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"monospace\" font-size=\"13\">\n\
         {with}<rect width=\"{width}\" height=\"{height}\" fill=\"{ground}\"/>\n"
    )
}

/// Returns the rows of the screen from the top, each as SVG elements.
pub fn rows(app: &App) -> Vec<String> {
    let area = Rect::new(0, 0, app.layout.size.0, app.layout.size.1);
    let ink = Ink::of(app.appearance.theme);
    let mut buffer = Buffer::empty(area);
    panels::paint(app, &mut buffer, area);
    let columns = usize::from(area.width).max(1);
    let cells = (0..).zip(buffer.content.chunks(columns));
    cells.map(|(row, cells)| drawn_row(cells, row * CELL.1, &ink)).collect()
}

/// Returns a row of cells as SVG, with one element per run of equal style. An element contains no
/// double spaces, which browsers would collapse.
fn drawn_row(cells: &[Cell], y: u32, ink: &Ink) -> String {
    let mut looks: Vec<(Look, &Cell)> = Vec::with_capacity(cells.len());
    for cell in cells {
        let own = Look::of(cell, ink);
        let joined = looks.last().filter(|(before, last)| {
            (before.shape, own.shape) == (Shape::Letters, Shape::Blank)
                && before.behind == own.behind
                && last.symbol() != " "
        });
        looks.push((joined.map_or(own, |&(before, _)| before), cell));
    }
    let (mut x, mut out) = (0, String::new());
    for run in looks.chunk_by(|a, b| a.0 == b.0) {
        let Some(&(look, _)) = run.first() else { continue };
        let cells_wide = |count: usize| CELL.0 * u32::try_from(count).unwrap_or(0);
        let width = cells_wide(run.len());
        if let Some(behind) = look.behind {
            out.push_str(&block(x, y, width, CELL.1, behind));
        }
        match look.shape {
            Shape::Blank => {}
            // Blocks become rectangles, because block characters of most fonts leave gaps.
            Shape::Full => out.push_str(&block(x, y, width, CELL.1, look.fill)),
            Shape::Upper => out.push_str(&block(x, y, width, CELL.1 / 2, look.fill)),
            Shape::Lower => {
                let half = CELL.1 / 2;
                out.push_str(&block(x, y + half, width, CELL.1 - half, look.fill));
            }
            Shape::Dots => out.push_str(&dots(run, x, y, look.fill)),
            Shape::Letters => {
                let blanks = run.iter().rev().take_while(|(_, cell)| cell.symbol() == " ").count();
                let run = &run[..run.len() - blanks];
                let text: String = run.iter().map(|(_, cell)| escaped(cell.symbol())).collect();
                let weight = if look.bold { " font-weight=\"bold\"" } else { "" };
                let (base, fill, width) = (y + CELL.1 - 4, look.fill, cells_wide(run.len()));
                // `textLength` keeps characters in their cells whatever the font's width.
                out.push_str(&format!(
                    "<text x=\"{x}\" y=\"{base}\" textLength=\"{width}\" fill=\"{fill}\"{weight}>{text}</text>\n"
                ));
            }
        }
        x += width;
    }
    out
}

/// Returns the braille dots of adjacent cells as one SVG path of round points in relative
/// coordinates; the first cell is at `left`, `top` \[px\].
fn dots(run: &[(Look, &Cell)], left: u32, top: u32, fill: &str) -> String {
    let mut points = String::new();
    let mut from = (0, 0);
    for (index, (_, cell)) in (0..).zip(run) {
        for (across, down) in sub_pixels(cell.symbol()).into_iter().flatten() {
            let x = i64::from(left + CELL.0 * index + CELL.0 * (2 * across + 1) / 4);
            // In tenths of a pixel, so that rounding errors do not add up.
            let y = i64::from(10 * top + 10 * CELL.1 * (2 * down + 1) / 8);
            let (right, below) = (x - from.0, y - from.1);
            let sign = if below < 0 { "-" } else { "" };
            let (whole, tenth) = (below.abs() / 10, below.abs() % 10);
            points.push_str(&format!("m{right} {sign}{whole}"));
            if tenth != 0 {
                points.push_str(&format!(".{tenth}"));
            }
            points.push_str("h0");
            from = (x, y);
        }
    }
    format!(
        "<path d=\"{points}\" stroke=\"{fill}\" stroke-width=\"{DOT}\" stroke-linecap=\"round\"/>\n"
    )
}

fn block(x: u32, y: u32, width: u32, height: u32, fill: &str) -> String {
    format!("<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"{fill}\"/>\n")
}

/// Kind of SVG element that draws a cell.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Shape {
    Blank,
    Full,
    Upper,
    Lower,
    Dots,
    Letters,
}

/// Shape, colours and weight of a cell.
#[derive(Clone, Copy, PartialEq, Eq)]
struct Look {
    shape: Shape,
    fill: &'static str,
    behind: Option<&'static str>,
    bold: bool,
}

impl Look {
    fn of(cell: &Cell, ink: &Ink) -> Self {
        let colour = ink.of_colour(cell.fg).unwrap_or(ink.text);
        let reversed = cell.modifier.contains(Modifier::REVERSED);
        let shape = match cell.symbol() {
            " " => Shape::Blank,
            "█" => Shape::Full,
            "▀" => Shape::Upper,
            "▄" => Shape::Lower,
            symbol if sub_pixels(symbol).is_some() => Shape::Dots,
            _ => Shape::Letters,
        };
        let behind = ink.of_colour(cell.bg).or(reversed.then_some(colour));
        // A blank cell looks the same in every text colour, so runs can be longer.
        let fill = match (shape, reversed) {
            (Shape::Blank, _) => ink.text,
            (Shape::Full | Shape::Upper | Shape::Lower, _) | (_, false) => colour,
            _ => ink.ground,
        };
        let bold = shape == Shape::Letters && cell.modifier.contains(Modifier::BOLD);
        Self { shape, fill, behind, bold }
    }
}

/// Colours of a picture: background and text of the theme, as SVG colours.
struct Ink {
    ground: &'static str,
    text: &'static str,
    light: bool,
}

impl Ink {
    fn of(theme: Theme) -> Self {
        match theme {
            Theme::Light | Theme::ColourBlindLight => {
                Self { ground: "#ffffff", text: "#1a1a1a", light: true }
            }
            _ => Self { ground: "#101418", text: "#e6e6e6", light: false },
        }
    }

    /// Returns the shade of a named colour that suits the background; `None` for the terminal's
    /// default text colour.
    fn of_colour(&self, colour: Color) -> Option<&'static str> {
        let [on_dark, on_light] = match colour {
            Color::DarkGray => ["#7f8790", "#6b7280"],
            Color::LightCyan => ["#5fd7e0", "#00707a"],
            Color::LightMagenta | Color::Magenta => ["#e58fe0", "#a020a0"],
            Color::LightRed | Color::Red => ["#ff6b6b", "#c01c28"],
            Color::LightGreen | Color::Green => ["#7bd88f", "#1a7f37"],
            Color::LightYellow | Color::Yellow => ["#f5d76e", "#8a6d00"],
            Color::Cyan => ["#2fa8b5", "#00707a"],
            Color::White => ["#ffffff", "#9aa0a6"],
            Color::LightBlue | Color::Blue => ["#78a9ff", "#0b57d0"],
            _ => return None,
        };
        Some(if self.light { on_light } else { on_dark })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::Marker;
    use crate::tui::worker::Playback;
    use rubscope_solver::scene::Scene;

    #[test]
    fn a_picture_is_well_formed_and_says_what_the_screen_says() {
        let mut app = App::new(Scene::base().checked().unwrap(), Theme::Dark, Marker::Braille);
        let limit = std::time::Duration::MAX;
        let mut playback = Playback::new(app.order(), limit);
        while playback.is_computing() {
            playback.compute();
        }
        playback.play(5e-3, false);
        app.apply_snapshot(playback.snapshot());
        let svg = svg(&app);
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert_eq!(svg.matches("<text").count(), svg.matches("</text>").count());
        assert!(!svg.contains("NaN"));
        let texts = || svg.lines().filter(|line| line.starts_with("<text"));
        assert!(texts().count() > 20);
        assert_eq!(texts().find(|text| text.contains("  ")), None);
        // Most viewers lack braille fonts, so curves are drawn as dots.
        assert!(svg.contains("<path "));
        assert!(!svg.contains(|c: char| ('\u{2801}'..='\u{28ff}').contains(&c)));
        assert!(svg.contains("[operation]") && svg.contains("rubscope run paper-nd3"));
    }

    #[test]
    fn a_picture_has_the_size_and_the_ground_of_the_screen() {
        let mut app = App::new(Scene::base().checked().unwrap(), Theme::Light, Marker::Braille);
        app.layout.size = (100, 30);
        let light = svg(&app);
        assert!(light.contains("width=\"800\" height=\"510\""), "{}", &light[..200]);
        assert!(light.contains("fill=\"#ffffff\"/>") && !light.contains("#101418"));
        app.appearance.theme = Theme::Dark;
        assert!(svg(&app).contains("fill=\"#101418\"/>"));
    }

    #[test]
    fn a_blank_belongs_to_the_word_before_it_only_on_the_same_ground() {
        let ink = Ink::of(Theme::Dark);
        let mut buffer = Buffer::empty(Rect::new(0, 0, 3, 1));
        buffer[(0, 0)].set_symbol("a");
        buffer[(2, 0)].set_symbol("b");
        let texts = |buffer: &Buffer| drawn_row(&buffer.content, 0, &ink).matches("<text").count();
        assert_eq!(texts(&buffer), 1);
        buffer[(1, 0)].bg = Color::Cyan;
        let row = drawn_row(&buffer.content, 0, &ink);
        assert!(row.contains("<rect x=\"8\" y=\"0\" width=\"8\""), "{row}");
        assert_eq!(texts(&buffer), 2);
    }

    #[test]
    fn a_name_of_a_file_cannot_break_a_picture() {
        let scene = Scene::base();
        let mut app = App::new(scene.clone().checked().unwrap(), Theme::Dark, Marker::Braille);
        let name = "a\u{1b}[2J\u{202e}\u{ffff}]]></desc>\u{0}.toml".to_string();
        app.files.source = Some(crate::tui::Source { name, scene });
        let svg = svg(&app);
        let command =
            r"rubscope run $'a\x1b[2J\xe2\x80\xae\xef\xbf\xbf]]&gt;&lt;/desc&gt;\x00.toml'";
        assert!(svg.contains(command), "{}", &svg[..600]);
        let plain = |c: char| c == '\n' || rubscope_solver::scene::keys::is_plain(c);
        assert_eq!(svg.chars().find(|c| !plain(*c)), None);
    }

    #[test]
    fn no_data_is_said_and_not_written() {
        let app = App::new(Scene::base().checked().unwrap(), Theme::Dark, Marker::Braille);
        assert_eq!(app.panel().file(&app, "csv").unwrap_err(), "there is no data yet");
    }
}
