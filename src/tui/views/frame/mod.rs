//! View 4: the wheel, and where there is room the casing wave as a point in the frame that
//! turns with the blades, inside the polygon of phase groups, with its trail.

mod wheel;

use ratatui::{buffer::Buffer, layout::Rect};

use super::ViewId;
use super::panel::{ViewArea, ViewPanel, title};
use super::response::ResponseView;
use crate::motion::ActiveSet;
use crate::tui::app::App;
use crate::tui::axis::{ChartAxis, readable};
use crate::tui::history::Channel;
use crate::tui::plot::Plot;
use crate::tui::raster::Pen;
use crate::tui::theme::Role;
use crate::tui::worker::rim_point;

/// From this width on, the polygon is beside the wheel where nothing else is shown.
const BOTH_FROM: u16 = 76;

/// The view.
pub struct FrameView;

impl ViewPanel for FrameView {
    fn what(&self) -> &'static str {
        "the wheel, and the wave as the blades see it"
    }

    fn draw(&self, app: &App, buffer: &mut Buffer, at: ViewArea) {
        if at.area.width >= BOTH_FROM && app.is_alone() {
            let [left, right] = at.columns();
            wheel::draw(app, buffer, ViewArea { large: false, ..left });
            polygon(app, buffer, right);
        } else {
            wheel::draw(app, buffer, at);
        }
    }

    /// The trail is among the columns of the response.
    fn csv(&self, app: &App) -> Result<String, String> {
        ResponseView.csv(app)
    }
}

/// A square of half side `reach` fitted into an area of cells twice as high as wide.
pub fn square(area: Rect, reach: f64) -> (ChartAxis, ChartAxis) {
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
    (ChartAxis::scaled(-x, x), ChartAxis::scaled(-y, y))
}

/// The place under the reading cursor, and how far the nearest blade is from it
/// where blades are rigid.
fn reading(app: &App, x: ChartAxis, y: ChartAxis) -> Option<String> {
    let cursor = app.cursor_in(ViewId::Frame)?;
    let (x, y) = (x.at(cursor.across), y.at(cursor.up));
    let polygon = &app.machine.polygon;
    let gaps = (0..polygon.sides).map(|side| (side, polygon.gap(side, x, y)));
    let (side, gap) = gaps.min_by(|a, b| a.1.total_cmp(&b.1))?;
    let to = if app.has_lining() && gap < 0.0 { "," } else { " to" };
    let (blade, gap) = (app.blades_of([side].into_iter()), app.gap_words(gap));
    Some(format!("{gap}{to} {blade} at {}, {}", readable(x, "m"), readable(y, "m")))
}

/// What the point is: the casing, as the tips of the blades see it.
fn named(app: &App) -> &'static str {
    let machine = &app.machine;
    match machine.radial_coupling == 0.0 {
        true => "z",
        false if machine.blade_diameters == machine.nodal_diameters => "w",
        // No one point stands for all blades.
        false => "z, blades not bent",
    }
}

/// Which sides touch at the instant that is shown. In a lining the gaps say it.
fn touching_sides(app: &App) -> impl Fn(u32) -> bool {
    let polygon = &app.machine.polygon;
    let active_set = app.shown().map_or(ActiveSet::Nothing, |moment| moment.active_set);
    let deep: Option<Vec<u32>> = app
        .has_lining()
        .then(|| app.touching_blades().iter().map(|blade| polygon.side_of_blade(*blade)).collect());
    move |side| deep.as_ref().map_or(active_set.includes(side), |deep| deep.contains(&side))
}

fn polygon(app: &App, buffer: &mut Buffer, at: ViewArea) {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    let polygon = &app.machine.polygon;
    let (x, y) = square(at.area, app.usual_reach().max(app.run.ranges.rim.high));
    let point = look.either('●', 'O');
    let mut legend = vec![
        (format!("{}, {}m", named(app), x.scale.prefix), quiet),
        (format!("{point} now"), look.style(Role::Focus)),
        (app.contact_shown(), look.style(Role::Contact)),
    ];
    if app.is_pressed() {
        // A side is where its blade lifts off.
        legend.insert(1, ("inside all rub".into(), look.style(Role::Text)));
    }
    let read = reading(app, x, y);
    let name = if read.is_some() { "" } else { "blade frame" };
    if let Some(read) = read {
        legend.insert(0, (read, look.style(Role::Focus)));
    }
    let inside = title(app, buffer, at, name, &legend);
    let Some(mut plot) = Plot::new(buffer, inside, x, y, look) else { return };
    at.note(app, plot.inner);
    let outline = Pen { dashed: false, ..look.quiet() };
    let touched = Pen { style: look.style(Role::Contact), sign: '#', dashed: false };
    let touching = touching_sides(app);
    // An unbounded side is drawn as far as the chart reaches.
    let half = polygon.half_side().abs().min(20.0 * polygon.clearance.abs());
    for pass in [false, true] {
        for side in (0..polygon.sides).filter(|side| touching(*side) == pass) {
            let (cos, sin) = polygon.direction(side);
            let end = |along: f64| {
                (-polygon.clearance * cos - along * sin, -polygon.clearance * sin + along * cos)
            };
            plot.curve([end(-half), end(half)], if pass { &touched } else { &outline });
        }
    }
    let past = app.past_and_future(app.record()).0.iter();
    let trail = past.map(|bin| (bin.middle(Channel::RimX), bin.middle(Channel::RimY)));
    plot.curve(trail, &look.first());
    plot.ink();
    if let Some(cursor) = app.cursor_in(ViewId::Frame) {
        plot.point(x.at(cursor.across), y.at(cursor.up), '+', look.style(Role::Focus));
    }
    if let Some(moment) = app.shown() {
        let turned = app.machine.nodal_diameters * moment.angle;
        let [x, y] = rim_point(&app.machine, &moment.state, turned);
        plot.point(x, y, point, look.style(Role::Focus));
    }
}
