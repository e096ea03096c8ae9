//! What is at a place of the screen, for the mouse.

use ratatui::layout::{Position, Rect};

use super::column::{self, ColumnLine};
use super::layout::{LEAST_HEIGHT, LEAST_WIDTH, Places, places};
use super::{bar, knobs, lesson, presentation};
use crate::tui::app::{App, Cursor};
use crate::tui::views::ViewId;

/// Something that can be clicked.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Target {
    /// The heading of a group; its first knob.
    Group(usize),
    /// The line of a knob.
    Knob(usize),
    /// The bar of a knob, and a place on it, 0 to 1.
    Bar(usize, f64),
    /// A chart that is not the large one.
    View(ViewId),
    /// A place in the large chart.
    Chart(Cursor),
}

fn places_of(app: &App) -> Option<Places> {
    let (width, height) = app.layout.size;
    let drawn = width >= LEAST_WIDTH && height >= LEAST_HEIGHT;
    drawn.then(|| places(Rect::new(0, 0, width, height), app))
}

/// What is at a place of the screen while nothing is open over the charts.
pub fn target(app: &App, (x, y): (u16, u16)) -> Option<Target> {
    let places = places_of(app)?;
    let at = Position::new(x, y);
    if places.knobs.contains(at) {
        return knob_target(app, &places, (x, y));
    }
    let (view, _) = places.charts.iter().find(|(_, area)| area.contains(at))?;
    match *view == app.view() {
        true => app.cursor_at((x, y)).map(Target::Chart),
        false => Some(Target::View(*view)),
    }
}

fn knob_target(app: &App, places: &Places, (x, y): (u16, u16)) -> Option<Target> {
    if !places.column {
        let cells = alone(app, places).filter(|cells| cells.contains((x, y).into()));
        return Some(match cells {
            Some(cells) => Target::Bar(app.knobs.selected, bar::part(cells, x)),
            None => Target::Knob(app.knobs.selected),
        });
    }
    let area = column::inside(places.knobs);
    let line = *column::lines(app, area.height).get(usize::from(y - area.y))?;
    Some(match line {
        ColumnLine::Heading(group) | ColumnLine::Folded(group) => {
            Target::Group(group.places().next()?)
        }
        ColumnLine::Knob(place) => Target::Knob(place),
        ColumnLine::Bar(place) => Target::Bar(place, bar::part(column::bar_cells(area), x)),
    })
}

/// The cells of the bar of the selected knob where it is the only one.
fn alone(app: &App, places: &Places) -> Option<Rect> {
    match places.letters {
        Some(_) => Some(presentation::bar_cells(places.knobs)),
        None => knobs::strip_bar(app, places.knobs),
    }
}

/// The place on the bar of the selected knob at a column of the screen, 0 to 1.
pub fn part_of_bar(app: &App, x: u16) -> Option<f64> {
    let places = places_of(app)?;
    let cells = match places.column {
        true => column::bar_cells(column::inside(places.knobs)),
        false => alone(app, &places)?,
    };
    Some(bar::part(cells, x))
}

/// The lesson at a place of the screen while their list is open.
pub fn lesson_at(app: &App, (x, y): (u16, u16)) -> Option<usize> {
    let body = places_of(app)?.body;
    let inside = body.contains((x, y).into());
    if inside { lesson::place_at(app, body, y) } else { None }
}
