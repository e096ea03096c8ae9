//! Shared parts of figures: drawing scale, text and colours.

use plotters::coord::Shift;
use plotters::prelude::*;
use plotters::style::text_anchor::{HPos, Pos, VPos};

use rubscope_solver::motion::Verdict;
use rubscope_solver::scene::keys::is_plain;
use rubscope_solver::study::figures::Style;

/// Ratio of drawing units to displayed pixels. The backend rounds to whole units, which would make
/// smooth lines jagged at a scale of 1.
pub const FINE: u32 = 4;
/// Font size \[px\].
pub const TEXT: i32 = 15;
/// Average width of a character relative to the font size: an upper estimate, for wide fonts.
const LETTER: f64 = 0.47;

/// Colours that colour-blind readers can distinguish (hues of Okabe and Ito); their lightness
/// differs too, for print in grey.
const COLOURS: [RGBColor; 6] = [
    RGBColor(0, 96, 165),
    RGBColor(225, 110, 10),
    RGBColor(0, 150, 110),
    RGBColor(205, 130, 175),
    RGBColor(240, 175, 20),
    RGBColor(50, 50, 50),
];

pub type Area<'a> = DrawingArea<SVGBackend<'a>, Shift>;
pub type Drawn<T> = Result<T, Box<dyn std::error::Error>>;

/// Converts displayed pixels to drawing units.
pub fn px(length: i32) -> i32 {
    length * FINE as i32
}

pub fn font(size: i32) -> (&'static str, i32) {
    ("sans-serif", px(size))
}

/// Draws a text with its upper left corner at `(x, y)` \[px\].
pub fn write_at(area: &Area, text: &str, (x, y): (i32, i32), size: i32) -> Drawn<()> {
    // Scene text is checked, but library callers may pass any text.
    let text: String = text.chars().filter(|c| is_plain(*c)).collect();
    let style = font(size).into_text_style(area).pos(Pos::new(HPos::Left, VPos::Top));
    Ok(area.draw_text(&text, &style, (px(x), px(y)))?)
}

/// Returns how many characters of a font size fit into a width.
pub fn letters_in(width: u32, size: i32) -> usize {
    (f64::from(width) / (LETTER * f64::from(size))) as usize
}

/// Estimates the width of a text at the usual size \[px\].
pub fn width_of(text: &str) -> u32 {
    (LETTER * f64::from(TEXT) * text.chars().count() as f64).ceil() as u32
}

/// Returns the strokes of marker `number`, relative to its centre; a disc has none. The markers are
/// open shapes, so that several at one point stay visible, and there is one more than colours.
pub fn strokes(number: usize, radius: i32) -> Vec<Vec<(i32, i32)>> {
    let r = px(radius);
    let (low, wide) = (r / 2, r * 7 / 8);
    match number % 7 {
        0 => vec![],
        1 => vec![vec![(-r, -r), (r, -r), (r, r), (-r, r), (-r, -r)]],
        2 => vec![vec![(-r, -r), (r, r)], vec![(-r, r), (r, -r)]],
        3 => vec![vec![(0, -r), (wide, low), (-wide, low), (0, -r)]],
        4 => vec![vec![(0, -r), (r, 0), (0, r), (-r, 0), (0, -r)]],
        5 => vec![vec![(-r, 0), (r, 0)], vec![(0, -r), (0, r)]],
        _ => vec![vec![(0, r), (wide, -low), (-wide, -low), (0, r)]],
    }
}

pub fn colour(style: Style) -> RGBColor {
    let index = match style {
        Style::Faint => return RGBColor(130, 130, 130),
        Style::Line(n) | Style::Dashed(n) | Style::Dotted(n) | Style::Bars(n) => n,
        Style::Discs(n, _) | Style::Rings(n, _) => n,
        Style::Cells(verdict) => return colour_of(verdict),
        Style::Dots => return RGBColor(60, 60, 60),
        Style::Edge => return BLACK,
    };
    *COLOURS.get(index % COLOURS.len()).unwrap_or(&BLACK)
}

/// Returns the colour of a verdict. The colours differ in lightness, for colour-blind readers and
/// print in grey.
fn colour_of(verdict: Verdict) -> RGBColor {
    match verdict {
        Verdict::Decay => RGBColor(240, 240, 240),
        Verdict::Bounce => RGBColor(190, 210, 235),
        Verdict::Slip => RGBColor(235, 165, 40),
        Verdict::Whirl => RGBColor(80, 175, 120),
        Verdict::Forced => RGBColor(62, 10, 0),
        Verdict::Divergent => RGBColor(105, 50, 130),
        Verdict::Locked => RGBColor(25, 50, 110),
        Verdict::Adhesive => RGBColor(200, 65, 80),
        Verdict::Failed => RGBColor(0, 0, 0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn grey(RGBColor(red, green, blue): RGBColor) -> f64 {
        0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue)
    }

    fn assert_apart(colours: impl Iterator<Item = RGBColor>, least: f64) {
        let mut greys: Vec<f64> = colours.map(grey).collect();
        greys.sort_by(f64::total_cmp);
        assert!(greys.windows(2).all(|pair| pair[1] - pair[0] >= least), "{greys:?}");
    }

    #[test]
    fn colours_differ_in_grey() {
        assert_apart(Verdict::ALL.iter().map(|verdict| colour_of(*verdict)), 20.0);
        assert_apart(COLOURS.into_iter(), 10.0);
    }

    #[test]
    fn marks_differ_in_shape() {
        let mut all: Vec<_> = (0..7).map(|number| strokes(number, 4)).collect();
        all.sort();
        all.dedup();
        assert_eq!(all.len(), 7);
    }
}
