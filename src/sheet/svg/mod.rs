//! A figure as SVG: title, conditions, panels in rows, a caption and the command; and text as an SVG page.

mod panel;
mod paper;

use std::io::{Result, Write};

use super::Provenance;
use super::line::{harmless, wrapped};
use super::table;
pub use paper::escaped;
use paper::{LEFT, LINE, TEXT, letters_in, text};
use rubscope_solver::study::figures::Figure;

/// Width of a figure with one panel per row, and what each further panel in a row adds \[px\].
const WIDTH: f64 = 960.0;
const WIDTH_MORE: f64 = 240.0;
/// Height of a panel \[px\].
const PANEL: f64 = 400.0;
/// Height of the title \[px\].
const HEAD: f64 = 40.0;
/// Width and height of a character on a page of text \[px\].
const LETTER: [f64; 2] = [9.0, 19.0];

/// Writes a figure; its origin goes into the description element.
///
/// # Errors
/// The writer failed.
pub fn write(figure: &Figure, origin: &Provenance, out: &mut dyn Write) -> Result<()> {
    let columns = figure.columns.clamp(1, figure.panels.len().max(1));
    let width = WIDTH + WIDTH_MORE * (columns - 1) as f64;
    let across = width / columns as f64;
    let letters = letters_in(width - 2.0 * LEFT);
    let lines_of = |text: &String| wrapped(text, letters);
    let mut svg = text(&figure.title, [LEFT, 25.0], "font-size=\"17\"");
    let mut down = HEAD;
    for line in lines_of(&figure.note) {
        svg += &text(&line, [LEFT, down + 11.0], "");
        down += LINE;
    }
    for row in figure.panels.chunks(columns) {
        for (place, panel) in (0..).map(f64::from).zip(row) {
            let (left, panel) = (across * place, panel::draw(panel, [across, PANEL]));
            svg += &format!("<g transform=\"translate({left} {down})\">\n{panel}</g>\n");
        }
        down += PANEL;
    }
    for line in figure.caption.iter().flat_map(lines_of) {
        svg += &text(&line, [LEFT, down + 13.0], "");
        down += LINE;
    }
    // Keys of the command have underscores, which are no subscripts.
    for line in lines_of(&origin.line()) {
        svg += &format!("<text x=\"{LEFT}\" y=\"{}\">{}</text>\n", down + 13.0, escaped(&line));
        down += LINE;
    }
    let size = [width, down + 16.0];
    writeln!(out, "{}{svg}</svg>", opening(size, "sans-serif", TEXT, origin))
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
    let size = [across * (table::WIDTH + 4) as f64, down * (lines.len() + 2) as f64];
    out.write_all(opening(size, "monospace", 15.0, origin).as_bytes())?;
    for (row, line) in (2..).map(f64::from).zip(&lines) {
        let (x, y) = (2.0 * across, row * down);
        writeln!(out, "<text x=\"{x}\" y=\"{y}\">{line}</text>")?;
    }
    writeln!(out, "</svg>")
}

/// Returns the start of a picture: its size and that of its font \[px\], its origin and a white
/// background.
fn opening([width, height]: [f64; 2], font: &str, letter: f64, origin: &Provenance) -> String {
    format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"{font}\" font-size=\"{letter}\" \
         xml:space=\"preserve\">\n{}<rect width=\"{width}\" height=\"{height}\" fill=\"white\"/>\n",
        describe(origin)
    )
}

/// Returns the origin of a picture as a `<desc>` element of SVG.
pub fn describe(origin: &Provenance) -> String {
    // A file name may contain any character.
    let plain = |c: char| if c == '\n' { c } else { harmless(c) };
    let text: String = origin.text().chars().map(plain).collect();
    format!("<desc>{}</desc>\n", escaped(&text))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sheet::CommandLine;
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
            svg.contains(">T<")
                && svg.contains("Ω<tspan dy=\"3\" font-size=\"75%\">c</tspan>")
                && svg.contains(">the end<")
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
            panel::draw(&panel, [WIDTH, PANEL])
        };
        let lines = |text: &str| text.matches("<polyline").count();
        let none = lines(&draw(&[Style::Dots]));
        let disc = draw(&[Style::Discs(0, 5)]);
        assert_eq!((lines(&disc) - none, disc.matches("<circle").count()), (0, 4));
        // Three points and the legend, one square each.
        assert_eq!(lines(&draw(&[Style::Discs(1, 5)])) - none, 4);
        let rims = |styles: &[Style]| draw(styles).matches("stroke=\"white\"").count();
        assert_eq!(rims(&[Style::Line(2)]), 0);
        let whirl = Style::Cells(Verdict::Whirl);
        assert_eq!(rims(&[whirl, Style::Line(2)]), 1);
        assert!(text("at -5 N, so-called", [0.0; 2], "").contains(">at −5 N, so-called<"));
    }
}
