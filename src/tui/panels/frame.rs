//! View 4: the casing wave as a point in the frame that turns with the blades,
//! inside the polygon of phase groups, with its trail; and the rim as a wheel.

use ratatui::{
    buffer::Buffer,
    layout::{Constraint, Layout, Rect},
};

use super::charts::title;
use super::wheel;
use crate::motion::Touching;
use crate::tui::app::{App, View};
use crate::tui::history::Channel;
use crate::tui::plot::{Axis, Plot};
use crate::tui::raster::Pen;
use crate::tui::theme::Role;
use crate::tui::worker::in_blade_frame;

/// Beyond the corners, so that the outline has air around it.
const MARGIN: f64 = 1.15;

/// Draws the view.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    if area.width >= 60 && area.height >= 10 {
        let halves = [Constraint::Percentage(50), Constraint::Percentage(50)];
        let [left, right] = Layout::horizontal(halves).spacing(1).areas(area);
        polygon(app, buffer, left);
        wheel::draw(app, buffer, right);
    } else {
        polygon(app, buffer, area);
    }
}

/// A square of half side `reach` fitted into an area of cells twice as high as wide.
pub fn square(area: Rect, reach: f64) -> (Axis, Axis) {
    // The labels take about six columns and two rows.
    let (width, height) = (
        f64::from(area.width.saturating_sub(6).max(1)),
        2.0 * f64::from(area.height.saturating_sub(2).max(1)),
    );
    let (x, y) = if width > height {
        (reach * width / height, reach)
    } else {
        (reach, reach * height / width)
    };
    (Axis::scaled(-x, x), Axis::scaled(-y, y))
}

fn polygon(app: &App, buffer: &mut Buffer, area: Rect) {
    let skin = &app.skin;
    let quiet = skin.style(Role::Quiet);
    let rim = &app.machine.rim;
    let corner = app.machine.locked_amplitude().unwrap_or(rim.clearance);
    let (x, y) = square(area, MARGIN * corner);
    let point = skin.either('●', 'O');
    let legend = [
        (format!("z, {}m", x.scale.prefix), quiet),
        (format!("{point} now"), skin.style(Role::Focus)),
        (app.contact_now(), skin.style(Role::Contact)),
    ];
    let inside = title(app, buffer, area, View::Frame, "blade frame", &legend);
    let Some(mut plot) = Plot::new(buffer, inside, x, y, skin) else { return };
    let outline = Pen { dashed: false, ..skin.quiet() };
    let touched = Pen { style: skin.style(Role::Contact), sign: '#', dashed: false };
    let touching = app.moment.as_ref().map_or(Touching::Nothing, |moment| moment.touching);
    // An unbounded side is drawn as far as the chart reaches.
    let half = rim.half_side().min(20.0 * rim.clearance);
    for pass in [false, true] {
        for side in (0..rim.sides).filter(|side| touching.includes(*side) == pass) {
            let (cos, sin) = rim.direction(side);
            let end = |along: f64| {
                (-rim.clearance * cos - along * sin, -rim.clearance * sin + along * cos)
            };
            plot.curve([end(-half), end(half)], if pass { &touched } else { &outline });
        }
    }
    let (from, to) = app.page();
    let trail = app.history.between(from, to).iter().map(|bin| {
        let middle = |channel: Channel| {
            let k = channel as usize;
            0.5 * (bin.low[k] + bin.high[k])
        };
        (middle(Channel::X), middle(Channel::Y))
    });
    plot.curve(trail, &skin.first());
    plot.ink();
    if let Some(moment) = &app.moment {
        let [x, y] = in_blade_frame(moment.state.u, app.machine.nodal_diameters * moment.angle);
        plot.point(x, y, point, skin.style(Role::Focus));
    }
}
