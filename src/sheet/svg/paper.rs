//! Elements of a figure: texts, lines and markers, and the colours of the series.

use rubscope_solver::motion::Verdict;
use rubscope_solver::scene::keys::is_plain;
use rubscope_solver::study::figures::Style;

/// A place from the upper left corner of a panel or figure \[px\].
pub type Place = [f64; 2];

/// Distance between lines of text, also in legends \[px\].
pub const LINE: f64 = 19.0;
/// Left margin of titles, conditions and caption \[px\].
pub const LEFT: f64 = 20.0;
/// Font size of all text except titles \[px\].
pub const TEXT: f64 = 12.0;
/// Average width of a character relative to the font size: an upper estimate, for wide fonts.
const LETTER: f64 = 0.59;

/// Colours that colour-blind readers can distinguish (hues of Okabe and Ito); their lightness
/// differs too, for print in grey. Red, green and blue.
const COLOURS: [[u8; 3]; 6] =
    [[0, 96, 165], [225, 110, 10], [0, 150, 110], [205, 130, 175], [240, 175, 20], [50, 50, 50]];

/// Escapes a text for XML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// Returns how many characters of text fit into `width` \[px\].
pub fn letters_in(width: f64) -> usize {
    (width / (LETTER * TEXT)) as usize
}

/// Estimates the width of a text \[px\].
pub fn width_of(text: &str) -> f64 {
    (LETTER * TEXT * text.chars().count() as f64).ceil()
}

/// Returns a text that begins at `at`, on its base line; `more` are further attributes, such as the
/// anchor that puts its middle or its end there.
pub fn text(words: &str, [x, y]: Place, more: &str) -> String {
    // Scene text is checked, but library callers may pass any text.
    let plain: String = words.chars().filter(|c| is_plain(*c)).collect();
    let words = with_subscripts(&escaped(&signed(&plain)));
    format!("<text x=\"{x:.1}\" y=\"{y:.1}\" {more}>{words}</text>\n")
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

/// Turns what follows an underscore into a subscript: `u_c`, `n_d`.
fn with_subscripts(text: &str) -> String {
    let mut parts = text.split('_');
    let start = parts.next().unwrap_or_default().to_string();
    parts.fold(start, |start, part| {
        let end = part.find(|c: char| !c.is_alphanumeric()).unwrap_or(part.len());
        let (low, rest) = part.split_at(end);
        let low = format!("<tspan dy=\"3\" font-size=\"75%\">{low}</tspan>");
        format!("{start}{low}<tspan dy=\"-3\">{rest}</tspan>")
    })
}

/// Returns a line through these points; `more` are further attributes, such as the dashes.
pub fn line(points: &[Place], colour: &str, width: f64, more: &str) -> String {
    let points: Vec<String> = points.iter().map(|[x, y]| format!("{x:.1},{y:.1}")).collect();
    let points = points.join(" ");
    format!(
        "<polyline points=\"{points}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{width}\" \
         {more}/>\n"
    )
}

/// Returns a rectangle between two opposite corners.
pub fn rectangle([a, b]: [Place; 2], colour: &str, more: &str) -> String {
    let [[x, across], [y, down]] = [0, 1].map(|axis| {
        let (low, high) = (a[axis].min(b[axis]), a[axis].max(b[axis]));
        [low, high - low]
    });
    format!(
        "<rect x=\"{x:.2}\" y=\"{y:.2}\" width=\"{across:.2}\" height=\"{down:.2}\" \
         fill=\"{colour}\" {more}/>\n"
    )
}

/// Returns a circle with this fill and colour of its line.
pub fn circle([x, y]: Place, radius: f64, fill: &str, ink: &str) -> String {
    format!(
        "<circle cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"{radius}\" fill=\"{fill}\" stroke=\"{ink}\"/>\n"
    )
}

/// Returns the strokes of marker `number`, relative to its centre; a disc has none. The markers are
/// open shapes, so that several at one point stay visible, and there is one more than colours.
pub fn strokes(number: usize, r: f64) -> Vec<Vec<Place>> {
    let (low, wide) = (0.5 * r, 0.875 * r);
    match number % 7 {
        0 => vec![],
        1 => vec![vec![[-r, -r], [r, -r], [r, r], [-r, r], [-r, -r]]],
        2 => vec![vec![[-r, -r], [r, r]], vec![[-r, r], [r, -r]]],
        3 => vec![vec![[0.0, -r], [wide, low], [-wide, low], [0.0, -r]]],
        4 => vec![vec![[0.0, -r], [r, 0.0], [0.0, r], [-r, 0.0], [0.0, -r]]],
        5 => vec![vec![[-r, 0.0], [r, 0.0]], vec![[0.0, -r], [0.0, r]]],
        _ => vec![vec![[0.0, r], [wide, -low], [-wide, -low], [0.0, r]]],
    }
}

/// Returns the colour of a style as SVG writes it.
pub fn colour(style: Style) -> String {
    let numbered = |number: usize| COLOURS[number % COLOURS.len()];
    let [red, green, blue] = match style {
        Style::Faint => [130; 3],
        Style::Line(n) | Style::Dashed(n) | Style::Dotted(n) | Style::Bars(n) => numbered(n),
        Style::Discs(n, _) | Style::Rings(n, _) => numbered(n),
        Style::Cells(verdict) => colour_of(verdict),
        Style::Dots => [60; 3],
        Style::Edge => [0; 3],
    };
    format!("#{red:02x}{green:02x}{blue:02x}")
}

/// Returns the colour of a verdict. The colours differ in lightness, for colour-blind readers and
/// print in grey.
fn colour_of(verdict: Verdict) -> [u8; 3] {
    match verdict {
        Verdict::Decay => [240, 240, 240],
        Verdict::Bounce => [190, 210, 235],
        Verdict::Slip => [235, 165, 40],
        Verdict::Whirl => [80, 175, 120],
        Verdict::Forced => [62, 10, 0],
        Verdict::Divergent => [105, 50, 130],
        Verdict::Locked => [25, 50, 110],
        Verdict::Adhesive => [200, 65, 80],
        Verdict::Failed => [0, 0, 0],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_apart(colours: impl Iterator<Item = [u8; 3]>, least: f64) {
        let grey = |[red, green, blue]: [u8; 3]| {
            0.299 * f64::from(red) + 0.587 * f64::from(green) + 0.114 * f64::from(blue)
        };
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
        let mut all: Vec<_> = (0..7).map(|number| format!("{:?}", strokes(number, 4.0))).collect();
        all.sort();
        all.dedup();
        assert_eq!(all.len(), 7);
    }
}
