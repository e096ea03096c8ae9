//! What all parts of a figure share: the scale of the drawing, text, colours.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use crate::motion::Verdict;
use crate::scene::keys::is_plain;
use crate::study::figures::Style;

/// Factor of the drawing size over the shown size: the backend has whole
/// numbers only, and smooth lines would get steps.
pub const FINE: u32 = 4;
/// Size of the text, in the units of the drawing library \[px\].
pub const TEXT: i32 = 15;
/// Width of a letter, on average, as a part of that size: enough for wide fonts.
const LETTER: f64 = 0.47;
/// Left and right of text that is wrapped \[px\].
const MARGINS: u32 = 40;

/// Colours that colour-blind readers can distinguish (Okabe and Ito).
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 114, 178),
    RGBColor(213, 94, 0),
    RGBColor(0, 158, 115),
    RGBColor(204, 121, 167),
    RGBColor(230, 159, 0),
    RGBColor(60, 60, 60),
];

pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub type Drawn<T> = Result<T, Box<dyn std::error::Error>>;

/// A length in pixels shown, as drawn.
pub fn px(length: i32) -> i32 {
    length * FINE as i32
}

pub fn font(size: i32) -> (&'static str, i32) {
    ("sans-serif", px(size))
}

pub fn write_at(area: &Area, text: &str, at: (i32, i32), size: i32) -> Drawn<()> {
    write_from(area, text, at, size, HPos::Left)
}

/// Text with its left end, its middle or its right end there.
pub fn write_from(area: &Area, text: &str, (x, y): (i32, i32), size: i32, end: HPos) -> Drawn<()> {
    // Text of a scene is plain, that of a caller of the library need not be.
    let text: String = text.chars().filter(|c| is_plain(*c)).collect();
    let style = font(size).into_text_style(area).pos(Pos::new(end, VPos::Top));
    Ok(area.draw_text(&text, &style, (px(x), px(y)))?)
}

/// Stands for an underscore that is one, in a name as it is typed.
pub const UNDERSCORE: char = '\u{e000}';

/// Text whose underscores are no subscripts.
pub fn typed(text: &str) -> String {
    text.replace('_', UNDERSCORE.encode_utf8(&mut [0; 4]))
}

/// How many letters of a size fit into a width.
pub fn letters_in(width: u32, size: i32) -> usize {
    (f64::from(width) / (LETTER * f64::from(size))) as usize
}

/// About how wide a text of the usual size is \[px\].
pub fn width_of(text: &str) -> u32 {
    (LETTER * f64::from(TEXT) * text.chars().count() as f64).ceil() as u32
}

/// A text in lines that fit into this width.
pub fn wrapped(text: &str, width: u32) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width_of(line) + width_of(word) + MARGINS <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_string()),
        }
    }
    lines
}

pub fn colour(style: Style) -> RGBColor {
    let index = match style {
        Style::Faint => return RGBColor(130, 130, 130),
        Style::Line(n) | Style::Dashed(n) | Style::Dotted(n) | Style::Discs(n, _) => n,
        Style::Cells(verdict) => return colour_of(verdict),
        Style::Dots => return RGBColor(120, 120, 120),
        Style::Edge => return BLACK,
    };
    *COLOURS.get(index % COLOURS.len()).unwrap_or(&BLACK)
}

/// Colour of a verdict; verdicts differ in lightness too, for colour-blind readers.
fn colour_of(verdict: Verdict) -> RGBColor {
    match verdict {
        Verdict::Decay => RGBColor(240, 240, 240),
        Verdict::Bounce => RGBColor(190, 210, 235),
        Verdict::Slip => RGBColor(240, 190, 70),
        Verdict::Whirl => RGBColor(60, 150, 90),
        Verdict::Divergent => RGBColor(110, 60, 130),
        Verdict::Locked => RGBColor(40, 70, 140),
        Verdict::Adhesive => RGBColor(200, 70, 90),
        Verdict::Failed => RGBColor(0, 0, 0),
    }
}
