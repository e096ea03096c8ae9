//! The survey of all numbers of diameters, in the place of the margins of one: a table, and
//! beside it where there is room the limits over the numbers of diameters.

use std::f64::consts::TAU;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Modifier, Style};

use crate::report::margins::words;
use crate::report::number::{per_speed, rounded, short, speed, speed_unit};
use crate::tui::app::{App, Cursor};
use crate::tui::axis::ChartAxis;
use crate::tui::plot::Plot;
use crate::tui::text::{print, shorten};
use crate::tui::theme::Role;
use crate::tui::views::Opening;
use crate::tui::views::panel::{ViewArea, not_yet, title};
use rubscope_solver::scene::keys::DIAMETERS;
use rubscope_solver::study::margins::LimitName;
use rubscope_solver::study::survey::{Survey, SurveyLimit, SurveyRow};

/// Width of a column, and of the first one.
const COLUMN: usize = 9;
const FIRST: usize = 6;
/// From this width on the chart stands beside the table.
const CHART_FROM: u16 = 96;
/// Least rows of the table with its head and foot.
const HEAD_FROM: u16 = 5;
/// How near to the present speed a limit is marked, as a part of it.
const NEAR: f64 = 0.1;
/// How far beyond the present speed the chart goes, as a factor.
const BEYOND: f64 = 2.0;
/// Limits in the foot.
const TOLD: usize = 3;

/// Limits with a letter and a title, the most important first.
const LIMITS: [(LimitName, char, &str); 9] = [
    (LimitName::OmegaC, 'c', "Ω_c"),
    (LimitName::OmegaLock, 'L', "Ω_lock"),
    (LimitName::Coincidence, 'x', "coinc."),
    (LimitName::LockEnds, 'e', "ends"),
    (LimitName::WhirlOnset, 'w', "whirl"),
    (LimitName::FlutterSpeed, 'f', "flutter"),
    (LimitName::OmegaAdhesive, 'a', "adhesive"),
    (LimitName::CoincidenceDifference, 'd', "differ."),
    (LimitName::LockFold, 'g', "gives way"),
];

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
        let named = shown(survey).map(|(_, letter, name)| format!("{letter} {name}"));
        legend.extend(named.map(|text| (text, look.style(Role::Text))));
    }
    let inside = title(app, buffer, at, "all diameters", &legend);
    let Some((survey, _)) = found else { return not_yet(app, buffer, inside) };
    let (left, right) = match chart {
        Some(_) => {
            let columns = 2 + shown(survey).count().min(4);
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

/// The limits that any number of diameters has.
fn shown(survey: &Survey) -> impl Iterator<Item = &'static (LimitName, char, &'static str)> {
    let names = survey.names();
    LIMITS.iter().filter(move |(name, ..)| names.contains(name))
}

fn table(
    app: &App,
    buffer: &mut Buffer,
    at: ViewArea,
    area: Rect,
    (survey, cell): (&Survey, Option<usize>),
) {
    let look = &app.appearance;
    let quiet = look.style(Role::Quiet);
    let columns = usize::from(area.width).saturating_sub(FIRST) / COLUMN;
    let limits: Vec<_> = shown(survey).take(columns.saturating_sub(2)).collect();
    let tall = area.height >= HEAD_FROM;
    let (head, foot) = if tall { (1, 1) } else { (0, 0) };
    if tall {
        let titles = ["casing", "disk"].into_iter().chain(limits.iter().map(|limit| limit.2));
        let titles: String =
            titles.take(columns).map(|title| format!("{:>COLUMN$}", look.spell(title))).collect();
        print(buffer, area, 0, &format!("{:<FIRST$}{titles}", " n_d"), quiet);
    }
    let room = usize::from(area.height.saturating_sub(head + foot)).max(1);
    let own = app.scene.operation.nodal_diameters as usize;
    let middle = cell.unwrap_or(own.min(survey.rows.len().saturating_sub(1)));
    let last = survey.rows.len().saturating_sub(room);
    let first = middle.saturating_sub(room / 2).min(last);
    let all = survey.rows.len().max(1) as f64;
    for (line, (place, row)) in survey.rows.iter().enumerate().skip(first).take(room).enumerate() {
        let Ok(y) = u16::try_from(line) else { break };
        let line = Rect { y: area.y + head + y, height: 1, ..area };
        at.note_part(
            app,
            line,
            [(0.0, 1.0), (1.0 - (place as f64 + 1.0) / all, 1.0 - place as f64 / all)],
        );
        let here = place == own;
        let sign = match (cell == Some(place), here) {
            (true, _) => look.either("▸", ">"),
            (false, true) => look.either("●", "*"),
            _ => " ",
        };
        let known = if row.modes_known { "" } else { "?" };
        let style = look.style(if here { Role::Focus } else { Role::Text });
        let style =
            if cell == Some(place) { style.add_modifier(Modifier::REVERSED) } else { style };
        print(buffer, line, 0, &format!("{sign}{}{known}", row.nodal_diameters), style);
        let hertz = |omega: f64| (short(rounded(omega / TAU, 5)), look.style(Role::Text));
        let mut cells = vec![hertz(row.omega_c_rad_s), hertz(row.omega_bd_rad_s)];
        cells.extend(limits.iter().map(|limit| value(app, survey, row, limit.0)));
        for (column, (text, style)) in cells.into_iter().take(columns).enumerate() {
            let Ok(x) = u16::try_from(FIRST + COLUMN * column) else { break };
            let place = Rect { x: line.x + x, width: COLUMN as u16, ..line };
            print(buffer, place, 0, &format!("{text:>COLUMN$}"), style);
        }
    }
    if tall {
        let text = foot_text(app, survey, cell);
        let text = shorten(&look.spell(&text), usize::from(area.width), look.ellipsis());
        print(buffer, area, area.height - 1, &text, quiet);
    }
}

/// A limit of a number of diameters: one that is near is marked.
fn value(app: &App, survey: &Survey, row: &SurveyRow, name: LimitName) -> (String, Style) {
    let look = &app.appearance;
    let Some(limit) = row.limit(name, survey.is_forward()) else {
        return ("-".to_string(), look.style(Role::Quiet));
    };
    let near = limit.margin.is_some_and(|margin| margin.abs() <= NEAR);
    let role = role(near, row);
    (short(rounded(per_speed(limit.value.abs()), 5)), look.style(role))
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
    let present = app.scene.operation.speed_rad_s.abs();
    let own = app.machine.critical_speed().unwrap_or(present);
    let top = BEYOND * present.max(own).max(f64::MIN_POSITIVE);
    let last = survey.rows.last().map_or(1.0, |row| f64::from(row.nodal_diameters));
    let x = ChartAxis::plain(0.0, last + 0.5);
    let Some(mut plot) = Plot::new(buffer, area, x, ChartAxis::speeds(0.0, top), look) else {
        return;
    };
    plot.level(present, look.either('┈', '.'), look.style(Role::Focus));
    plot.ink();
    for (name, letter, _) in shown(survey).collect::<Vec<_>>().into_iter().rev() {
        for row in &survey.rows {
            let Some(limit) = row.limit(*name, survey.is_forward()) else { continue };
            let speed = limit.value.abs();
            if speed <= top {
                let near = limit.margin.is_some_and(|margin| margin.abs() <= NEAR);
                let style = look.style(role(near, row));
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
