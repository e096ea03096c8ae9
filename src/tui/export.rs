//! What is on the screen, as data (CSV) and as a picture (SVG).

use std::fmt::Write;

use ratatui::{
    buffer::Buffer,
    layout::Rect,
    style::{Color, Modifier},
};

use super::app::{App, Mode, View};
use super::history::{Bin, Channel};
use super::panels;
use super::theme::Theme;

/// The data of the large chart.
///
/// # Errors
/// There is nothing to export yet; the reason in words.
pub fn csv(app: &App) -> Result<String, String> {
    let mut out = String::new();
    let rows = match app.view {
        View::Response | View::Frame => response(app, &mut out),
        View::Gaps if app.heat => gaps_in_time(app, &mut out),
        View::Gaps => gaps(app, &mut out),
        View::Locked => locked(app, &mut out),
        View::Map => return map(app),
        View::Spectrum => spectrum(app, &mut out),
        View::Precision => return Err("`rubscope precision` writes these rows".into()),
    };
    // Writing to a string cannot fail; no rows is what a user may meet.
    match rows {
        Ok(0) | Err(_) => Err("there is no data yet".into()),
        Ok(_) => Ok(out),
    }
}

type Rows = Result<usize, std::fmt::Error>;

fn response(app: &App, out: &mut String) -> Rows {
    let channels = [
        (Channel::UC, "u_c_m"),
        (Channel::US, "u_s_m"),
        (Channel::AlphaC, "alpha_c_rad"),
        (Channel::AlphaS, "alpha_s_rad"),
        (Channel::Gap, "smallest_gap_m"),
        (Channel::Push, "push_n"),
        (Channel::X, "z_real_m"),
        (Channel::Y, "z_imaginary_m"),
    ];
    write!(out, "from_s,to_s")?;
    for (_, name) in channels {
        write!(out, ",{name}_least,{name}_greatest")?;
    }
    writeln!(out, ",contact")?;
    let (from, to) = app.page();
    let bins: &[Bin] = app.history.between(from, to);
    for bin in bins {
        write!(out, "{:e},{:e}", bin.from, bin.to)?;
        for (channel, _) in channels {
            write!(out, ",{:e},{:e}", bin.low[channel as usize], bin.high[channel as usize])?;
        }
        writeln!(out, ",{}", u8::from(bin.contact))?;
    }
    Ok(bins.len())
}

fn gaps(app: &App, out: &mut String) -> Rows {
    writeln!(out, "blade,gap_m")?;
    let gaps = app.moment.as_ref().map_or(&[][..], |moment| &moment.gaps);
    for (blade, gap) in (1..).zip(gaps) {
        writeln!(out, "{blade},{gap:e}")?;
    }
    Ok(gaps.len())
}

fn gaps_in_time(app: &App, out: &mut String) -> Rows {
    let rim = &app.machine.rim;
    write!(out, "from_s,to_s")?;
    for blade in 1..=rim.blades {
        write!(out, ",least_gap_{blade}_m")?;
    }
    writeln!(out)?;
    let (from, to) = app.page();
    let bins = app.history.between(from, to);
    for bin in bins {
        write!(out, "{:e},{:e}", bin.from, bin.to)?;
        for blade in 1..=rim.blades {
            write!(out, ",{:e}", panels::heat::least_gap(rim, rim.side_of_blade(blade), bin))?;
        }
        writeln!(out)?;
    }
    Ok(bins.len())
}

fn locked(app: &App, out: &mut String) -> Rows {
    writeln!(out, "speed_rad_s,multiplier_a_n,multiplier_b_n,admissible,stable")?;
    let sweep = app.locked.as_ref().and_then(|curves| curves.damped.as_ref());
    let points = sweep.map_or(&[][..], |sweep| &sweep.points);
    for point in points {
        let [a, b] = point.multipliers_n;
        let (admissible, stable) = (u8::from(point.admissible), u8::from(point.stable));
        writeln!(out, "{:e},{a:e},{b:e},{admissible},{stable}", point.speed_rad_s)?;
    }
    Ok(points.len())
}

fn spectrum(app: &App, out: &mut String) -> Rows {
    writeln!(out, "frequency_rad_s,u_c_m,u_s_m")?;
    let Some(spectrum) = &app.spectrum else { return Ok(0) };
    for (k, (cosine, sine)) in spectrum.cosine.iter().zip(&spectrum.sine).enumerate() {
        writeln!(out, "{:e},{cosine:e},{sine:e}", k as f64 * spectrum.resolution)?;
    }
    Ok(spectrum.cosine.len())
}

fn map(app: &App) -> Result<String, String> {
    let map = app.map.as_ref().ok_or("there is no map yet")?;
    let mut bytes = Vec::new();
    crate::report::map::write_csv(map, &mut bytes).map_err(|error| error.to_string())?;
    String::from_utf8(bytes).map_err(|error| error.to_string())
}

/// Size of a cell in the picture.
const CELL: (u32, u32) = (8, 17);

/// The screen as a picture: its size, on the ground its theme is made for.
#[must_use]
pub fn svg(app: &App) -> String {
    let area = Rect::new(0, 0, app.size.0, app.size.1);
    let (ground, ink) = match app.skin.theme {
        Theme::Light => ("#ffffff", "#1a1a1a"),
        _ => ("#101418", "#e6e6e6"),
    };
    let mut buffer = Buffer::empty(area);
    let mut plain = app.clone();
    plain.mode = Mode::Main;
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
        let colour = hex(cell.fg, app.skin.theme).unwrap_or(ink);
        let reversed = cell.modifier.contains(Modifier::REVERSED);
        if reversed {
            let (w, h) = CELL;
            out.push_str(&format!(
                "<rect x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" fill=\"{colour}\"/>\n"
            ));
        }
        let text = match cell.symbol() {
            " " => continue,
            "&" => "&amp;",
            "<" => "&lt;",
            ">" => "&gt;",
            text => text,
        };
        let fill = if reversed { ground } else { colour };
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

/// A named colour on its ground: light on dark, dark on light. The text's own
/// is none.
fn hex(colour: Color, theme: Theme) -> Option<&'static str> {
    let [light, dark] = match colour {
        Color::DarkGray => ["#7f8790", "#6b7280"],
        Color::LightCyan => ["#5fd7e0", "#00707a"],
        Color::LightMagenta | Color::Magenta => ["#e58fe0", "#a020a0"],
        Color::LightRed | Color::Red => ["#ff6b6b", "#c01c28"],
        Color::LightGreen | Color::Green => ["#7bd88f", "#1a7f37"],
        Color::LightYellow | Color::Yellow => ["#f5d76e", "#8a6d00"],
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

    #[test]
    fn a_picture_is_well_formed_and_says_what_the_screen_says() {
        let app = App::new(Scene::default().checked().unwrap(), Theme::Dark, Marker::Braille);
        let svg = svg(&app);
        assert!(svg.starts_with("<svg ") && svg.ends_with("</svg>\n"));
        assert_eq!(svg.matches("<text").count(), svg.matches("</text>").count());
        assert!(!svg.contains("NaN"));
    }

    #[test]
    fn a_picture_has_the_size_and_the_ground_of_the_screen() {
        let mut app = App::new(Scene::default().checked().unwrap(), Theme::Light, Marker::Braille);
        app.size = (100, 30);
        let light = svg(&app);
        assert!(light.contains("width=\"800\" height=\"510\""), "{}", &light[..200]);
        assert!(light.contains("fill=\"#ffffff\"/>") && !light.contains("#101418"));
        app.skin.theme = Theme::Dark;
        assert!(svg(&app).contains("fill=\"#101418\"/>"));
    }

    #[test]
    fn no_data_is_said_and_not_written() {
        let app = App::new(Scene::default().checked().unwrap(), Theme::Dark, Marker::Braille);
        assert_eq!(csv(&app).unwrap_err(), "there is no data yet");
    }
}
