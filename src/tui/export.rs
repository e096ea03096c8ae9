//! The screen as a picture (SVG).

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::{Color, Modifier},
};

use super::app::{App, InputMode};
use super::panels;
use super::raster::sub_pixels;
use super::theme::Theme;

/// Size of a cell in the picture.
const CELL: (u32, u32) = (8, 17);

/// The screen as a picture: its size, and the background of its theme.
pub fn svg(app: &App) -> String {
    let area = Rect::new(0, 0, app.size.0, app.size.1);
    let (ground, ink) = match app.appearance.theme {
        Theme::Light => ("#ffffff", "#1a1a1a"),
        _ => ("#101418", "#e6e6e6"),
    };
    let mut buffer = Buffer::empty(area);
    let mut plain = app.clone();
    plain.mode = InputMode::Main;
    plain.status = None;
    panels::paint(&plain, &mut buffer, area);
    let (width, height) = (u32::from(area.width) * CELL.0, u32::from(area.height) * CELL.1);
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{width}\" height=\"{height}\" \
         viewBox=\"0 0 {width} {height}\" font-family=\"monospace\" font-size=\"13\">\n\
         <rect width=\"{width}\" height=\"{height}\" fill=\"{ground}\"/>\n"
    );
    for (index, cell) in buffer.content.iter().enumerate() {
        let column = u32::try_from(index % usize::from(area.width)).unwrap_or(0);
        let row = u32::try_from(index / usize::from(area.width)).unwrap_or(0);
        let (x, y) = (column * CELL.0, row * CELL.1);
        let colour = hex(cell.fg, app.appearance.theme).unwrap_or(ink);
        let reversed = cell.modifier.contains(Modifier::REVERSED);
        if reversed {
            out.push_str(&block(x, y, CELL.1, colour));
        }
        if let Some(behind) = hex(cell.bg, app.appearance.theme) {
            out.push_str(&block(x, y, CELL.1, behind));
        }
        // The halves of a block meet; letters of most fonts do not.
        let half = CELL.1 / 2;
        match cell.symbol() {
            " " => continue,
            "▀" => {
                out.push_str(&block(x, y, half, colour));
                continue;
            }
            "▄" => {
                out.push_str(&block(x, y + half, CELL.1 - half, colour));
                continue;
            }
            _ => {}
        }
        let fill = if reversed { ground } else { colour };
        if let Some(dots) = sub_pixels(cell.symbol()) {
            for (across, down) in dots {
                let cx = x + CELL.0 * (2 * across + 1) / 4;
                let cy = f64::from(y) + f64::from(CELL.1 * (2 * down + 1)) / 8.0;
                out.push_str(&format!(
                    "<circle cx=\"{cx}\" cy=\"{cy}\" r=\"1.4\" fill=\"{fill}\"/>\n"
                ));
            }
            continue;
        }
        // A letter and its accents are one cell.
        let text = cell.symbol().replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let weight =
            if cell.modifier.contains(Modifier::BOLD) { " font-weight=\"bold\"" } else { "" };
        let base = y + CELL.1 - 4;
        out.push_str(&format!(
            "<text x=\"{x}\" y=\"{base}\" fill=\"{fill}\"{weight}>{text}</text>\n"
        ));
    }
    out.push_str("</svg>\n");
    out
}

/// A filled part of a cell.
fn block(x: u32, y: u32, height: u32, fill: &str) -> String {
    let width = CELL.0;
    format!("<rect x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" fill=\"{fill}\"/>\n")
}

/// A named colour for its background: light on dark, dark on light. None for
/// the default colour of the text.
fn hex(colour: Color, theme: Theme) -> Option<&'static str> {
    let [light, dark] = match colour {
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
    Some(if theme == Theme::Light { dark } else { light })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;
    use crate::tui::Marker;
    use crate::tui::engine::Engine;
    use crate::tui::worker::Stepwise;

    #[test]
    fn a_picture_is_well_formed_and_says_what_the_screen_says() {
        let mut app = App::new(Scene::base().checked().unwrap(), Theme::Dark, Marker::Braille);
        let mut engine = Stepwise::new(5e-3);
        engine.order(&app.order());
        app.apply_snapshot(engine.take().unwrap());
        let svg = svg(&app);
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert_eq!(svg.matches("<text").count(), svg.matches("</text>").count());
        assert!(!svg.contains("NaN"));
        // The fonts of most viewers have no braille: curves are dots.
        assert!(svg.contains("<circle "));
        assert!(!svg.contains(|c: char| ('\u{2801}'..='\u{28ff}').contains(&c)));
    }

    #[test]
    fn a_picture_has_the_size_and_the_ground_of_the_screen() {
        let mut app = App::new(Scene::base().checked().unwrap(), Theme::Light, Marker::Braille);
        app.size = (100, 30);
        let light = svg(&app);
        assert!(light.contains("width=\"800\" height=\"510\""), "{}", &light[..200]);
        assert!(light.contains("fill=\"#ffffff\"/>") && !light.contains("#101418"));
        app.appearance.theme = Theme::Dark;
        assert!(svg(&app).contains("fill=\"#101418\"/>"));
    }

    #[test]
    fn no_data_is_said_and_not_written() {
        let app = App::new(Scene::base().checked().unwrap(), Theme::Dark, Marker::Braille);
        assert_eq!(app.view.panel().csv(&app).unwrap_err(), "there is no data yet");
    }
}
