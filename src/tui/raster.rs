//! A grid of sub-pixels over terminal cells: braille, half blocks,
//! dots or plain ASCII. It accepts whole pixels only, so NaN and infinities
//! cannot reach the screen.

use ratatui::{
    buffer::Buffer,
    layout::{Position, Rect},
    style::Style,
    symbols::braille::BRAILLE,
};
use serde::{Deserialize, Serialize};
use strum::{Display, EnumString, VariantNames};

/// Characters with which curves are drawn.
#[derive(
    Clone,
    Copy,
    Debug,
    Default,
    PartialEq,
    Eq,
    Display,
    EnumString,
    VariantNames,
    Serialize,
    Deserialize,
)]
#[strum(serialize_all = "lowercase")]
#[serde(rename_all = "lowercase")]
pub enum Marker {
    /// Two columns of four dots per cell.
    #[default]
    Braille,
    /// Two blocks per cell, one above the other.
    HalfBlock,
    /// One round dot per cell.
    Dot,
    /// One ASCII character per cell, a different one for each series.
    Ascii,
}

impl Marker {
    /// Returns the next marker, after the last one the first.
    pub fn next(self) -> Self {
        const ALL: [Marker; 4] = [Marker::Braille, Marker::HalfBlock, Marker::Dot, Marker::Ascii];
        ALL[(self as usize + 1) % ALL.len()]
    }

    /// Returns the number of sub-pixels in a cell, horizontally and vertically.
    pub fn grain(self) -> (usize, usize) {
        match self {
            Self::Braille => (2, 4),
            Self::HalfBlock => (1, 2),
            Self::Dot | Self::Ascii => (1, 1),
        }
    }
}

/// How a series is drawn.
#[derive(Clone, Copy, Debug)]
pub struct Pen {
    /// Colour and weight.
    pub style: Style,
    /// Character of this series with the marker [`Marker::Ascii`].
    pub sign: char,
    /// Whether lines are dashed, so that two series differ without colour.
    pub dashed: bool,
}

#[derive(Clone, Copy, Default)]
struct Dots {
    bits: u8,
    sign: char,
    style: Style,
}

/// Sub-pixels over an area.
pub struct Raster {
    area: Rect,
    marker: Marker,
    dots: Vec<Dots>,
}

impl Raster {
    /// Creates an empty raster over `area`.
    pub fn new(area: Rect, marker: Marker) -> Self {
        Self { area, marker, dots: vec![Dots::default(); area.area() as usize] }
    }

    /// Returns the number of sub-pixels in a cell, horizontally and vertically.
    pub fn grain(&self) -> (i64, i64) {
        let (across, down) = self.marker.grain();
        // At most two and four, so the casts are exact.
        (across as i64, down as i64)
    }

    /// Returns the width and height of the raster \[sub-pixels\].
    pub fn size(&self) -> (usize, usize) {
        let (across, down) = self.marker.grain();
        (usize::from(self.area.width) * across, usize::from(self.area.height) * down)
    }

    /// Returns whether anything is drawn in the cell at column `x` and row `y` of the screen.
    pub fn is_drawn(&self, x: u16, y: u16) -> bool {
        let at = |x: u16, y: u16| usize::from(y) * usize::from(self.area.width) + usize::from(x);
        let place = x.checked_sub(self.area.x).zip(y.checked_sub(self.area.y));
        let dots = place.and_then(|(x, y)| self.dots.get(at(x, y)));
        dots.is_some_and(|dots| dots.bits != 0)
    }

    /// Draws one sub-pixel, at `x` from the left and `y` from the top of the raster; positions
    /// outside are ignored.
    pub fn set(&mut self, x: i64, y: i64, pen: &Pen) {
        let (width, height) = self.size();
        let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else { return };
        if x >= width || y >= height {
            return;
        }
        let (across, down) = self.marker.grain();
        let cell = (y / down) * usize::from(self.area.width) + x / across;
        if let Some(dots) = self.dots.get_mut(cell) {
            dots.bits |= 1 << ((y % down) * across + x % across);
            dots.sign = pen.sign;
            dots.style = pen.style;
        }
    }

    /// Draws a straight line between two sub-pixels. Dashes are counted by columns if it is flat
    /// and by rows if it is steep, so that they continue over the pieces of a curve.
    pub fn line(&mut self, from: (i64, i64), to: (i64, i64), pen: &Pen) {
        // Far ends are not visible, and would take many steps.
        let bound = |v: i64| v.clamp(-20_000, 20_000);
        let (x0, y0, x1, y1) = (bound(from.0), bound(from.1), bound(to.0), bound(to.1));
        let steps = (x1 - x0).abs().max((y1 - y0).abs()).max(1);
        let steep = (y1 - y0).abs() > (x1 - x0).abs();
        // In ASCII, lines are solid: series differ by character, and gaps would look like missing
        // data.
        let dashed = pen.dashed && self.marker != Marker::Ascii;
        let [dash, period] = if self.marker.grain().0 == 1 { [1, 2] } else { [3, 6] };
        for k in 0..=steps {
            let x = x0 + ((x1 - x0) * k + (x1 - x0).signum() * steps / 2) / steps;
            let y = y0 + ((y1 - y0) * k + (y1 - y0).signum() * steps / 2) / steps;
            let along = if steep { y } else { x };
            if !dashed || along.rem_euclid(period) < dash {
                self.set(x, y, pen);
            }
        }
    }

    /// Draws the grid into the buffer; empty cells are left unchanged.
    pub fn draw(&self, buffer: &mut Buffer) {
        for (index, dots) in self.dots.iter().enumerate().filter(|(_, dots)| dots.bits != 0) {
            let width = usize::from(self.area.width).max(1);
            let (row, column) = (index / width, index % width);
            let place = Position::new(
                self.area.x.saturating_add(u16::try_from(column).unwrap_or(u16::MAX)),
                self.area.y.saturating_add(u16::try_from(row).unwrap_or(u16::MAX)),
            );
            let sign = match self.marker {
                Marker::Braille => BRAILLE.get(usize::from(dots.bits)).copied().unwrap_or(' '),
                Marker::HalfBlock => match dots.bits {
                    1 => '▀',
                    2 => '▄',
                    _ => '█',
                },
                Marker::Dot => '•',
                Marker::Ascii => dots.sign,
            };
            if let Some(cell) = buffer.cell_mut(place) {
                cell.set_char(sign).set_style(dots.style);
            }
        }
    }
}

/// Returns the dots of a braille character as (column, row), counted from 0 at the top left, for
/// viewers whose fonts have no braille; `None` for any other text.
pub fn sub_pixels(sign: &str) -> Option<impl Iterator<Item = (u32, u32)>> {
    let mut signs = sign.chars();
    let (Some(sign), None) = (signs.next(), signs.next()) else { return None };
    let bits = BRAILLE.iter().position(|&other| other == sign)?;
    Some((0..8).filter(move |k| bits >> k & 1 == 1).map(|k| (k % 2, k / 2)))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PEN: Pen = Pen { style: Style::new(), sign: '*', dashed: false };

    fn drawn(marker: Marker, draw: impl Fn(&mut Raster)) -> String {
        let area = Rect::new(0, 0, 4, 2);
        let mut raster = Raster::new(area, marker);
        draw(&mut raster);
        let mut buffer = Buffer::empty(area);
        raster.draw(&mut buffer);
        buffer.content.iter().map(|cell| cell.symbol().to_string()).collect()
    }

    #[test]
    fn one_corner_dot_in_every_marker() {
        assert_eq!(drawn(Marker::Braille, |r| r.set(0, 0, &PEN)), "⠁       ");
        assert_eq!(drawn(Marker::HalfBlock, |r| r.set(0, 1, &PEN)), "▄       ");
        assert_eq!(drawn(Marker::Dot, |r| r.set(3, 1, &PEN)), "       •");
        assert_eq!(drawn(Marker::Ascii, |r| r.set(1, 0, &PEN)), " *      ");
    }

    #[test]
    fn a_sign_gives_back_the_dots_it_was_made_of() {
        for dots in [&[(0, 0)][..], &[(1, 3), (0, 2)], &[(1, 0), (1, 1), (0, 3)]] {
            let draw = |r: &mut Raster| dots.iter().for_each(|&(x, y)| r.set(x, y, &PEN));
            let sign: String = drawn(Marker::Braille, draw).chars().take(1).collect();
            let mut found: Vec<(i64, i64)> =
                sub_pixels(&sign).unwrap().map(|(x, y)| (x.into(), y.into())).collect();
            let mut dots = dots.to_vec();
            found.sort_unstable();
            dots.sort_unstable();
            assert_eq!(found, dots, "{sign}");
        }
        assert!(["a", "", " ", "ab", "█", "•"].iter().all(|sign| sub_pixels(sign).is_none()));
    }

    #[test]
    fn anything_outside_is_ignored() {
        let blank = " ".repeat(8);
        assert_eq!(drawn(Marker::Braille, |r| r.set(-1, 0, &PEN)), blank);
        assert_eq!(drawn(Marker::Braille, |r| r.set(8, 0, &PEN)), blank);
        let far = |r: &mut Raster| r.line((i64::MIN / 4, -5), (i64::MAX / 4, -5), &PEN);
        assert_eq!(drawn(Marker::Braille, far), blank);
    }

    #[test]
    fn a_dashed_line_has_every_other_place_of_a_solid_one() {
        let dotted = Pen { dashed: true, ..PEN };
        assert_eq!(drawn(Marker::Dot, |r| r.line((0, 0), (3, 0), &PEN)), "••••    ");
        assert_eq!(drawn(Marker::Dot, |r| r.line((0, 0), (3, 0), &dotted)), "• •     ");
        assert_eq!(drawn(Marker::Ascii, |r| r.line((0, 0), (3, 0), &dotted)), "****    ");
        // ASCII lines have no gaps either when they are steep.
        for to in [(7, 0), (0, 7), (3, 7), (7, 3), (7, 7)] {
            for mirror in [false, true] {
                let area = Rect::new(0, 0, 4, 2);
                let [mut solid, mut dashes] = [0, 1].map(|_| Raster::new(area, Marker::Braille));
                let place = |(x, y)| if mirror { (x, 7 - y) } else { (x, y) };
                solid.line(place((0, 0)), place(to), &PEN);
                dashes.line(place((0, 0)), place(to), &dotted);
                let count = |r: &Raster| r.dots.iter().map(|d| d.bits.count_ones()).sum::<u32>();
                assert_eq!((count(&solid), count(&dashes)), (8, 5), "{to:?} {mirror}");
            }
        }
    }
}
