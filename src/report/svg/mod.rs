//! A figure as SVG: title, conditions, panels in rows and a caption; and text as an SVG page.

mod panel;
mod paper;

use std::io::{Error, Result, Write};

use plotters::prelude::*;

use super::Provenance;
use super::line::{harmless, wrapped};
use super::table;
use paper::{Drawn, FINE, TEXT, letters_in, write_at};
use rubscope_solver::study::figures::Figure;

/// Width of a figure with one panel per row, and of each further panel \[px\].
const WIDTH: u32 = 960;
const WIDTH_MORE: u32 = 240;
/// Height of a panel \[px\].
const PANEL: u32 = 400;
/// Font size of the title \[px\].
const TITLE: i32 = 21;
/// Height of a line of text \[px\].
const LINE: u32 = 19;
/// Left margin of the text \[px\].
const LEFT: i32 = 20;
/// Width and height of a character on a page of text \[px\].
const LETTER: [usize; 2] = [9, 19];

/// Writes a figure; its origin goes into the description element.
///
/// # Errors
/// The figure could not be drawn, or the writer failed.
pub fn write(figure: &Figure, origin: &Provenance, out: &mut dyn Write) -> Result<()> {
    let mut text = String::new();
    draw(figure, &describe(origin), &mut text).map_err(|error| Error::other(error.to_string()))?;
    out.write_all(text.as_bytes())
}

/// Writes text as a page in a monospaced font; its origin goes into the description element. Lines
/// that are too long are wrapped.
///
/// # Errors
/// The writer failed.
pub fn write_text(text: &str, origin: &Provenance, out: &mut dyn Write) -> Result<()> {
    let lines = text.lines().flat_map(|line| match line.chars().count() <= table::WIDTH {
        true => vec![line.to_string()],
        false => wrapped(line, table::WIDTH),
    });
    let lines: Vec<String> =
        lines.map(|line| escaped(&line.chars().map(harmless).collect::<String>())).collect();
    let [across, down] = LETTER;
    let (width, height) = (across * (table::WIDTH + 4), down * (lines.len() + 2));
    writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"monospace\" font-size=\"{TEXT}\">\n\
         {}<rect width=\"{width}\" height=\"{height}\" fill=\"#ffffff\"/>",
        describe(origin)
    )?;
    for (row, line) in (2..).zip(&lines) {
        let (x, y) = (2 * across, row * down);
        writeln!(out, "<text x=\"{x}\" y=\"{y}\" xml:space=\"preserve\">{line}</text>")?;
    }
    writeln!(out, "</svg>")
}

/// Returns the origin of a picture as a `<desc>` element.
pub fn describe(origin: &Provenance) -> String {
    // A file name may contain any character.
    let plain = |c: char| if c == '\n' { c } else { harmless(c) };
    let text: String = origin.text().chars().map(plain).collect();
    format!("<desc>{}</desc>\n", escaped(&text))
}

/// Escapes a text for XML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

fn draw(figure: &Figure, description: &str, text: &mut String) -> Drawn<()> {
    let columns = figure.columns.clamp(1, figure.panels.len().max(1));
    let rows = figure.panels.len().div_ceil(columns);
    let width = WIDTH + WIDTH_MORE * u32::try_from(columns - 1)?;
    let letters = letters_in(width - 2 * LEFT as u32, TEXT);
    let note = wrapped(&figure.note, letters);
    let caption: Vec<String> =
        figure.caption.iter().flat_map(|line| wrapped(line, letters)).collect();
    let head = 40 + LINE * u32::try_from(note.len())?;
    let foot = if caption.is_empty() { 0 } else { 16 + LINE * u32::try_from(caption.len())? };
    let body = PANEL * u32::try_from(rows)?;
    let height = head + body + foot;
    let root = SVGBackend::with_string(text, (FINE * width, FINE * height)).into_drawing_area();
    root.fill(&WHITE)?;
    let line = |index: usize| (LINE as usize * index) as i32;
    write_at(&root, &signed(&figure.title), (LEFT, 10), TITLE)?;
    for (index, words) in note.iter().enumerate() {
        write_at(&root, &signed(words), (LEFT, 38 + line(index)), TEXT)?;
    }
    let (_, below) = root.split_vertically(FINE * head);
    let (panels, _) = below.split_vertically(FINE * body);
    for (panel, area) in figure.panels.iter().zip(panels.split_evenly((rows, columns))) {
        panel::draw(panel, &area)?;
    }
    for (index, words) in caption.iter().enumerate() {
        write_at(&root, &signed(words), (LEFT, (head + body) as i32 + line(index)), TEXT)?;
    }
    root.present()?;
    drop((panels, below, root));
    let cells = figure.panels.iter().any(panel::has_cells);
    let style = if cells { STYLE } else { "" };
    finish(text, [width, height], &format!("{description}{style}"));
    Ok(())
}

/// Replaces the hyphen of negative numbers by a minus sign.
fn signed(text: &str) -> String {
    let mut before = ' ';
    let mut letters = text.chars().peekable();
    let mut out = String::new();
    while let Some(c) = letters.next() {
        let number = letters.peek().is_some_and(char::is_ascii_digit);
        out.push(if c == '-' && number && !before.is_alphanumeric() { '−' } else { c });
        before = c;
    }
    out
}

/// Lets adjacent cells meet without seams at any scale.
const STYLE: &str = "<style>rect{shape-rendering:crispEdges}</style>";

/// Completes the picture: displayed size, subscripts, and the description as its first element.
fn finish(text: &mut String, [width, height]: [u32; 2], description: &str) {
    let fine = format!("width=\"{}\" height=\"{}\"", FINE * width, FINE * height);
    *text = text.replacen(&fine, &format!("width=\"{width}\" height=\"{height}\""), 1);
    *text = with_subscripts(text);
    let start = text.find('>').map_or(0, |end| end + 1);
    text.insert_str(start, &format!("\n{}", description.trim_end()));
}

/// Turns what follows an underscore into a subscript: `u_c`, `n_d`. Works by line, because the
/// drawing library writes each text on its own line.
fn with_subscripts(svg: &str) -> String {
    let lowered = |line: &str| {
        let mut parts = line.split('_');
        let mut out = parts.next().unwrap_or_default().to_string();
        for part in parts {
            let end = part.find(|c: char| !c.is_alphanumeric()).unwrap_or(part.len());
            let (low, rest) = part.split_at(end);
            // SVG viewers drop a space at the start of an element, so it becomes an offset.
            let (space, rest) = match rest.strip_prefix(' ') {
                Some(rest) => (4 * FINE, rest),
                None => (0, rest),
            };
            let depth = 3 * FINE;
            out.push_str(&format!("<tspan dy=\"{depth}\" font-size=\"75%\">{low}</tspan>"));
            out.push_str(&format!("<tspan dx=\"{space}\" dy=\"-{depth}\">{rest}</tspan>"));
        }
        out
    };
    svg.lines()
        .map(|line| if line.starts_with('<') { line.to_string() } else { lowered(line) } + "\n")
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::CommandLine;
    use rubscope_solver::motion::Verdict;
    use rubscope_solver::scene::Scene;
    use rubscope_solver::study::figures::{Mark, Panel, Quantity, Series, Style};

    fn drawn(points: Vec<(f64, f64)>, log: bool) -> String {
        let x = Quantity { log, ..Quantity::SPEED };
        let y = Quantity::new("u_m", "u < [µm]", 1e6);
        let lines = [Style::Faint, Style::Line(0), Style::Dashed(1), Style::Dotted(2)];
        let others = [Style::Cells(Verdict::Slip), Style::Discs(2, 5), Style::Dots, Style::Edge];
        let series = |style: &Style| Series::new("a & b", *style, points.clone());
        let series = lines.iter().chain(&others).map(series).collect();
        let mut panel = Panel::new("(a)", x, y, series);
        panel.marks.push(Mark { x: 2.0, label: "Ω_c" });
        let caption = vec!["words ".repeat(60), "the end".to_string()];
        let panels = vec![panel; 3];
        let figure = Figure { title: "T".into(), note: "N".into(), caption, columns: 2, panels };
        let scene = Scene { title: "a < b".into(), ..Scene::base() };
        let origin = Provenance { command: CommandLine::new("figures", &scene), scene };
        let mut out = Vec::new();
        write(&figure, &origin, &mut out).unwrap();
        String::from_utf8(out).unwrap()
    }

    #[test]
    fn every_style_is_drawn_and_text_is_escaped() {
        let svg = drawn(vec![(1.0, 1e-6), (2.0, 3e-6), (4.0, -1e-6)], false);
        assert!(svg.starts_with("<svg") && svg.trim_end().ends_with("</svg>"));
        assert!(
            svg.contains(">\nT\n<")
                && svg.contains("Ω<tspan dy=\"12\" font-size=\"75%\">c</tspan>")
                && svg.contains(">\nthe end\n<")
        );
        assert!(svg.contains("a &amp; b") && svg.contains("u &lt; [µm]"));
        assert!(!svg.contains("NaN") && !svg.contains("inf"));
    }

    #[test]
    fn marks_are_not_joined_and_lines_over_cells_have_a_rim() {
        let draw = |styles: &[Style]| {
            let points = [(1.0, 1.0), (2.0, 3.0), (4.0, 2.0)];
            let series = styles.iter().map(|style| Series::new("a", *style, points)).collect();
            let panel = Panel::new("", Quantity::SPEED, Quantity::SPEED, series);
            let figure = Figure::new("at -5 N, so-called", "", vec![panel]);
            let mut text = String::new();
            super::draw(&figure, "", &mut text).unwrap();
            text
        };
        let lines = |text: &str| text.matches("<polyline").count();
        let none = lines(&draw(&[]));
        let disc = draw(&[Style::Discs(0, 5)]);
        assert_eq!((lines(&disc) - none, disc.matches("<circle").count()), (0, 4));
        // Three points and the legend, one square each.
        assert_eq!(lines(&draw(&[Style::Discs(1, 5)])) - none, 4);
        let rims = |styles: &[Style]| draw(styles).matches("stroke=\"#FFFFFF\"").count();
        assert_eq!(rims(&[Style::Line(2)]), 0);
        let whirl = Style::Cells(Verdict::Whirl);
        assert_eq!(rims(&[whirl, Style::Line(2)]), 1);
        assert!(draw(&[whirl]).contains(STYLE) && !disc.contains(STYLE));
        assert!(disc.contains(">\nat −5 N, so-called\n<"));
    }

    #[test]
    fn a_picture_says_where_it_comes_from() {
        let svg = drawn(vec![], false);
        let told = svg.split_once("<desc>").unwrap().1.split_once("</desc>").unwrap().0;
        let (version, commit) = (env!("CARGO_PKG_VERSION"), env!("RUBSCOPE_COMMIT"));
        let begins = format!("rubscope {version} {commit}\nrubscope figures ");
        assert!(told.starts_with(&begins), "{told}");
        assert!(told.contains("title = \"a &lt; b\"") && told.contains("[operation]"));
    }

    #[test]
    fn nothing_and_constants_can_be_drawn() {
        for points in [vec![], vec![(1.0, 0.0)], vec![(1.0, 5.0), (1.0, 5.0)]] {
            for log in [false, true] {
                assert!(!drawn(points.clone(), log).contains("NaN"));
            }
        }
    }
}
