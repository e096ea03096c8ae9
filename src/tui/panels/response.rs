//! View 1: the casing coordinates against time on a page that fills, and the
//! blade coordinates below where there is room; with the other contact law or
//! a pinned run beside or behind.

use ratatui::{
    buffer::Buffer,
    layout::{Constraint, Layout, Rect},
};

use super::charts::{entry, title};
use super::wrap;
use crate::scene::ContactLaw;
use crate::tui::app::{App, View};
use crate::tui::axis::{AutoRange, readable};
use crate::tui::history::{Channel, History};
use crate::tui::plot::{Axis, Plot};
use crate::tui::theme::Role;

/// From this height on the blade coordinates have a chart of their own.
const TWO_FROM: u16 = 18;

/// What one chart shows.
struct Page<'a> {
    name: String,
    names: [&'static str; 2],
    channels: [Channel; 2],
    range: AutoRange,
    unit: &'static str,
    history: &'a History,
    /// Whether this is the running motion, with what belongs to it.
    own: bool,
}

impl<'a> Page<'a> {
    fn casing(app: &App, name: String, history: &'a History, own: bool) -> Self {
        let channels = [Channel::UC, Channel::US];
        Self {
            name,
            names: ["u_c", "u_s"],
            channels,
            range: app.ranges.casing,
            unit: "m",
            history,
            own,
        }
    }
}

/// Draws the view.
pub fn draw(app: &App, buffer: &mut Buffer, area: Rect) {
    if app.compare {
        beside(app, buffer, area);
    } else if area.height >= TWO_FROM {
        let halves = [Constraint::Percentage(60), Constraint::Percentage(40)];
        let [casing, blades] = Layout::vertical(halves).areas(area);
        page(
            app,
            buffer,
            casing,
            &Page::casing(app, "response, casing".into(), &app.history, true),
        );
        let channels = [Channel::AlphaC, Channel::AlphaS];
        let of_blades = Page {
            name: "response, blades".into(),
            names: ["α_c", "α_s"],
            channels,
            range: app.ranges.blades,
            unit: "rad",
            history: &app.history,
            own: true,
        };
        page(app, buffer, blades, &of_blades);
    } else {
        page(app, buffer, area, &Page::casing(app, "response, casing".into(), &app.history, true));
    }
}

/// The two contact laws side by side, or one above the other.
fn beside(app: &App, buffer: &mut Buffer, area: Rect) {
    let halves = [Constraint::Percentage(50), Constraint::Percentage(50)];
    let [first, second] = if area.width >= 70 {
        Layout::horizontal(halves).spacing(1).areas(area)
    } else {
        Layout::vertical(halves).areas(area)
    };
    let law = app.scene.solver.contact;
    let other = match law {
        ContactLaw::Unilateral => ContactLaw::Bilateral,
        ContactLaw::Bilateral => ContactLaw::Unilateral,
    };
    let own = format!("{law}: {}", app.verdict().word);
    let word = app.beside.as_ref().map_or("...".to_string(), |f| app.words(f).word);
    let theirs = format!("{other}: {word}");
    page(app, buffer, first, &Page::casing(app, own, &app.history, true));
    page(app, buffer, second, &Page::casing(app, theirs, &app.beside_history, false));
}

fn page(app: &App, buffer: &mut Buffer, area: Rect, what: &Page) {
    let skin = &app.skin;
    let (from, to) = app.page();
    let (x, y) = (Axis::scaled(from, to), Axis::scaled(what.range.low, what.range.high));
    let pens = [skin.first(), skin.second()];
    let quiet = skin.style(Role::Quiet);
    let mark = skin.either('▪', '#');
    let mut legend: Vec<_> =
        pens.iter().zip(what.names).map(|(pen, name)| entry(skin, pen, name)).collect();
    if let Some(read) = reading(app, what) {
        legend.push((read, skin.style(Role::Focus)));
    }
    legend.push((format!("{}{} over {}s", y.scale.prefix, what.unit, x.scale.prefix), quiet));
    if let Some(baseline) = app.baseline.as_ref().filter(|_| what.own) {
        legend.push(entry(skin, &skin.quiet(), &format!("pinned: {}", baseline.words.word)));
        legend.push((baseline.words.detail.clone(), quiet));
    }
    legend.push((format!("{mark} contact"), skin.style(Role::Contact)));
    let inside = title(app, buffer, area, View::Response, &what.name, &legend);
    let Some(mut plot) = Plot::new(buffer, inside, x, y, skin) else { return };
    plot.level(0.0, skin.either('┈', '.'), quiet);
    if let Some(t) = app.cursor_time() {
        plot.upright(t, skin.either('┊', ':'), skin.style(Role::Focus));
    }
    let columns = plot.columns();
    if let Some(baseline) = app.baseline.as_ref().filter(|_| what.own) {
        plot.spans(&baseline.history.columns(what.channels[0], from, to, columns), &skin.quiet());
    }
    for (channel, pen) in what.channels.iter().zip(&pens).rev() {
        plot.spans(&what.history.columns(*channel, from, to, columns), pen);
    }
    plot.ink();
    let cells = usize::from(plot.inner.width);
    // On the time axis where there is one, so that no data is covered.
    let row = plot.axis_row().unwrap_or(plot.inner.bottom() - 1);
    let contacts = what.history.contacts(from, to, cells);
    for (column, _) in (plot.inner.x..).zip(contacts).filter(|(_, touched)| *touched) {
        plot.text(column, row, &mark.to_string(), skin.style(Role::Contact));
    }
    if let Some(failure) = app.moment.as_ref().and_then(|moment| moment.failure.as_ref())
        && what.own
    {
        let inner = plot.inner;
        let width = usize::from(inner.width).saturating_sub(2);
        for (row, line) in (inner.y..inner.bottom()).zip(wrap(failure, width)) {
            plot.text(inner.x + 1, row, &skin.spell(&line), skin.style(Role::Trouble));
        }
    }
}

/// What stands under the cursor.
fn reading(app: &App, what: &Page) -> Option<String> {
    let t = app.cursor_time()?;
    let bin = what.history.at(t)?;
    let values = what.channels.map(|channel| {
        let place = channel as usize;
        let (low, high) = (bin.low.get(place)?, bin.high.get(place)?);
        Some(readable(0.5 * (low + high), what.unit))
    });
    let [first, second] = values;
    Some(format!("at {}: {}, {}", readable(t, "s"), first?, second?))
}
