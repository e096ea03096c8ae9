//! View 1: the casing coordinates against time on a page that fills, and the
//! blade coordinates below where there is room.

use ratatui::{
    buffer::Buffer,
    layout::{Constraint, Layout, Rect},
};

use super::charts::{entry, title};
use super::wrap;
use crate::tui::app::{App, View};
use crate::tui::axis::AutoRange;
use crate::tui::history::Channel;
use crate::tui::plot::{Axis, Plot};
use crate::tui::raster::Pen;
use crate::tui::theme::Role;

/// From this height on the blade coordinates have a chart of their own.
const TWO_FROM: u16 = 18;

/// Draws the view.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    if area.height >= TWO_FROM {
        let halves = [Constraint::Percentage(60), Constraint::Percentage(40)];
        let [casing, blades] = Layout::vertical(halves).areas(area);
        page(
            app,
            buffer,
            casing,
            "response, casing",
            ["u_c", "u_s"],
            [Channel::UC, Channel::US],
            app.ranges.casing,
            "m",
        );
        page(
            app,
            buffer,
            blades,
            "response, blades",
            ["α_c", "α_s"],
            [Channel::AlphaC, Channel::AlphaS],
            app.ranges.blades,
            "rad",
        );
    } else {
        page(
            app,
            buffer,
            area,
            "response, casing",
            ["u_c", "u_s"],
            [Channel::UC, Channel::US],
            app.ranges.casing,
            "m",
        );
    }
}

#[expect(clippy::too_many_arguments, reason = "one chart of two; a struct would only rename them")]
fn page(
    app: &App,
    buffer: &mut Buffer,
    area: Rect,
    name: &str,
    names: [&str; 2],
    channels: [Channel; 2],
    range: AutoRange,
    unit: &str,
) {
    let skin = &app.skin;
    let (from, to) = app.page();
    let (x, y) = (Axis::scaled(from, to), Axis::scaled(range.low, range.high));
    let pens: [Pen; 2] = [skin.first(), skin.second()];
    let quiet = skin.style(Role::Quiet);
    let legend = [
        entry(skin, &pens[0], names[0]),
        entry(skin, &pens[1], names[1]),
        (format!("{}{unit} over {}s", y.scale.prefix, x.scale.prefix), quiet),
        ("▪ contact".to_string(), skin.style(Role::Contact)),
    ];
    let legend: Vec<_> = legend
        .into_iter()
        .map(|(text, style)| (text.replace('▪', skin.either("▪", "#")), style))
        .collect();
    let inside = title(app, buffer, area, View::Response, name, &legend);
    let Some(mut plot) = Plot::new(buffer, inside, x, y, skin) else { return };
    plot.level(0.0, skin.either('┈', '.'), quiet);
    for (channel, pen) in channels.iter().zip(&pens).rev() {
        plot.spans(&app.history.columns(*channel, from, to, plot.columns()), pen);
    }
    plot.ink();
    let cells = usize::from(plot.inner.width);
    let sign = skin.either('▪', '#');
    // On the time axis where there is one, so that no data is covered.
    let row = plot.axis_row().unwrap_or(plot.inner.bottom() - 1);
    for (column, _) in
        (plot.inner.x..).zip(app.history.contacts(from, to, cells)).filter(|(_, touched)| *touched)
    {
        plot.text(column, row, &sign.to_string(), skin.style(Role::Contact));
    }
    if let Some(failure) = app.moment.as_ref().and_then(|moment| moment.failure.as_ref()) {
        let inner = plot.inner;
        for (row, line) in
            (inner.y..inner.bottom()).zip(wrap(failure, usize::from(inner.width) - 2))
        {
            plot.text(inner.x + 1, row, &skin.spell(&line), skin.style(Role::Trouble));
        }
    }
}
