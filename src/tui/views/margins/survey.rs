//! The survey of all numbers of diameters, in the place of the margins of one: a table, and
//! beside it where there is room the limits over the numbers of diameters.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::report::margins::words;
use crate::report::number::{speed, speed_unit};
use crate::report::survey::{present, rows as rows_of};
use crate::report::symbols::greek;
use crate::tui::app::{App, Cursor};
use crate::tui::axis::ChartAxis;
use crate::tui::plot::Plot;
use crate::tui::text::{print, shorten};
use crate::tui::theme::Role;
use crate::tui::views::Opening;
use crate::tui::views::panel::{ViewArea, not_yet, title};
use crate::tui::views::table::Rows;
use rubscope_solver::scene::keys::DIAMETERS;
use rubscope_solver::study::survey::{Survey, SurveyLimit, SurveyRow};

/// Width of a column with a chart beside the table, and of the first one.
const COLUMN: usize = 9;
const FIRST: usize = 6;
/// Columns before the limits: diameters, casing and disk.
const LEADING: usize = 3;
/// From this width on the chart stands beside the table.
const CHART_FROM: u16 = 96;
/// Least rows of the table with its foot.
const FOOT_FROM: u16 = 5;
/// How near to the present speed a limit is marked, as a part of it.
const NEAR: f64 = 0.1;
/// How far beyond the present speed the chart goes, as a factor.
const BEYOND: f64 = 2.0;
/// Limits in the foot.
const TOLD: usize = 3;

/// Draws it.
pub fn draw(app: &App, buffer: &mut Buffer, at: ViewArea, cell: Option<usize>) {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    let found = app.margins().and_then(|(live, old)| Some((live.survey.as_deref()?, old)));
    let mut legend = vec![(format!("speeds in {}, modes in Hz", speed_unit()), quiet)];
    legend.push(("within 10 % of now".to_string(), look.style(Role::Contact)));
    if found.is_some_and(|(_, old)| old) {
        legend.insert(0, ("of the knobs before".to_string(), look.style(Role::Focus)));
    }
    let wide = at.area.width >= CHART_FROM;
    let chart = found.filter(|_| wide).map(|(survey, _)| survey);
    if let Some(survey) = chart {
        let named = present(survey).map(|(_, letter, name)| format!("{letter} {}", greek(name)));
        legend.extend(named.map(|text| (text, look.style(Role::Text))));
    }
    let inside = title(app, buffer, at, "all diameters", &legend);
    let Some((survey, _)) = found else { return not_yet(app, buffer, inside) };
    let (left, right) = match chart {
        Some(_) => {
            let columns = 2 + present(survey).count().min(4);
            let width = u16::try_from(FIRST + COLUMN * columns).unwrap_or(u16::MAX);
            let width = width.min(inside.width / 2 + 8);
            // One column apart.
            let x = (inside.x + width + 1).min(inside.right());
            let right = Rect { x, width: inside.right() - x, ..inside };
            (Rect { width, ..inside }, Some(right))
        }
        None => (inside, None),
    };
    table(app, buffer, at, left, (survey, cell));
    if let Some(area) = right {
        over_diameters(app, buffer, area, survey);
    }
}

fn table(
    app: &App,
    buffer: &mut Buffer,
    at: ViewArea,
    area: Rect,
    (survey, cell): (&Survey, Option<usize>),
) {
    let look = &app.appearance;
    let foot = u16::from(area.height >= FOOT_FROM);
    let limits: Vec<_> = present(survey).collect();
    let table = rows_of(survey, &survey.rows.iter().collect::<Vec<_>>());
    let own = app.scene.operation.nodal_diameters as usize;
    let drawn = Rows {
        table: &table,
        cursor: [LEADING + limits.len(), 1],
        cell: cell.map(|row| [0, row]),
        home: own,
        marked: None,
    };
    let style = |place: usize, column: usize| {
        let Some(row) = survey.rows.get(place) else { return look.style(Role::Text) };
        let role = match column.checked_sub(LEADING).and_then(|column| limits.get(column)) {
            Some((name, ..)) => row
                .limit(*name, survey.is_forward())
                .map_or(Role::Quiet, |limit| role(is_near(limit), row)),
            None if column == 0 && place == own => Role::Focus,
            None => Role::Text,
        };
        look.style(role)
    };
    let above = Rect { height: area.height - foot, ..area };
    drawn.draw(app, buffer, (at, above), style);
    if foot > 0 {
        let text = foot_text(app, survey, cell);
        let text = shorten(&look.spell(&text), usize::from(area.width), look.ellipsis());
        print(buffer, area, area.height - 1, &text, look.style(Role::Quiet));
    }
}

/// Returns whether a limit is near the present speed.
fn is_near(limit: &SurveyLimit) -> bool {
    limit.margin.is_some_and(|margin| margin.abs() <= NEAR)
}

/// Diameters without a mode of their own, where others have one, are none of this machine.
fn role(near: bool, row: &SurveyRow) -> Role {
    match (row.modes_known, near) {
        (false, _) => Role::Quiet,
        (true, true) => Role::Contact,
        (true, false) => Role::Text,
    }
}

/// What is nearest to the present speed, or the row under the cursor.
fn foot_text(app: &App, survey: &Survey, cell: Option<usize>) -> String {
    let told = |diameters: u32, limit: &SurveyLimit| {
        let margin = limit.margin.map_or(String::new(), |part| format!(" {}", words::margin(part)));
        format!("{} of {diameters}{margin}", limit.name.symbol())
    };
    if let Some(row) = cell.and_then(|place| survey.rows.get(place)) {
        let known = if row.modes_known { "" } else { ", no mode of its own" };
        return format!("n_d {}{known}: Enter takes these diameters", row.nodal_diameters);
    }
    let nearest: Vec<String> =
        survey.nearest().iter().take(TOLD).map(|(n, limit)| told(*n, limit)).collect();
    format!("nearest to {}: {}", speed(app.scene.operation.speed_rad_s), nearest.join(", "))
}

/// The limits over the numbers of diameters.
fn over_diameters(app: &App, buffer: &mut Buffer, area: Rect, survey: &Survey) {
    let look = &app.appearance;
    let now = app.scene.operation.speed_rad_s.abs();
    let own = app.machine.critical_speed().unwrap_or(now);
    let top = BEYOND * now.max(own).max(f64::MIN_POSITIVE);
    let last = survey.rows.last().map_or(1.0, |row| f64::from(row.nodal_diameters));
    let x = ChartAxis::plain(0.0, last + 0.5);
    let Some(mut plot) = Plot::new(buffer, area, x, ChartAxis::speeds(0.0, top), look) else {
        return;
    };
    plot.level(now, look.either('┈', '.'), look.style(Role::Focus));
    plot.ink();
    for (name, letter, _) in present(survey).collect::<Vec<_>>().into_iter().rev() {
        for row in &survey.rows {
            let Some(limit) = row.limit(*name, survey.is_forward()) else { continue };
            let speed = limit.value.abs();
            if speed <= top {
                let style = look.style(role(is_near(limit), row));
                plot.point(f64::from(row.nodal_diameters), speed, *letter, style);
            }
        }
    }
}

/// The row under the cursor.
pub fn cell(app: &App) -> Option<usize> {
    let cursor = app.cursor_in(crate::tui::views::ViewId::Margins)?;
    let rows = rows(app);
    (rows > 0).then(|| rows as usize - 1 - crate::tui::app::cell_of(cursor.up, rows) as usize)
}

/// How many rows there are.
pub fn rows(app: &App) -> u32 {
    let survey = app.margins().and_then(|(live, _)| live.survey.as_deref());
    survey.map_or(0, |survey| u32::try_from(survey.rows.len()).unwrap_or(u32::MAX))
}

/// Where the cursor appears: on the diameters of the scene.
pub fn here(app: &App) -> Cursor {
    let rows = f64::from(rows(app).max(1));
    let own = f64::from(app.scene.operation.nodal_diameters).min(rows - 1.0);
    Cursor { across: 0.5, up: 1.0 - (own + 0.5) / rows }
}

/// Enter takes the diameters of the row.
pub fn opening(app: &App) -> Option<Opening> {
    let place = cell(app)?;
    let to = format!("{place} nodal diameters");
    Some(Opening::Jump { path: DIAMETERS, value: place as f64, to })
}
