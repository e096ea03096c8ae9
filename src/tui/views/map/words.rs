//! The text around a map: its axes, progress and legend, and the cell under the cursor.

use ratatui::style::Style;

use super::picture::{chart_axis, is_inside, present, sign, unit};
use super::plan::{CellRun, LiveMap};
use crate::sheet::map::means;
use crate::sheet::number::{count, from_shown, in_shown_unit, per_speed, rounded};
use crate::tui::app::App;
use crate::tui::axis::{number, readable};
use crate::tui::knobs::{Knob, knob_of};
use crate::tui::text::{columns, few, whole_parts, wrap};
use crate::tui::theme::Role;
use crate::tui::views::id::ViewId;
use rubscope_solver::motion::Verdict;
use rubscope_solver::scene::keys::SPEED;
use rubscope_solver::study::overlay::Curve;
use rubscope_solver::study::{Axis, MapPlan};

/// A line of text pieces with their styles.
pub type Line = Vec<(String, Style)>;

/// Formats a value of a key with four digits and its unit.
pub fn value_text(path: &str, value: f64) -> String {
    let unit = unit(path);
    number(from_shown(rounded(in_shown_unit(value, unit).0, 4), unit), unit)
}

/// As [`value_text`], but a value without a unit is preceded by its symbol, e.g. `n_d 3`.
fn named_value(axis: &Axis, value: f64) -> String {
    let symbol = knob_of(&axis.path).map(Knob::symbol);
    match symbol.filter(|_| unit(&axis.path).is_empty()) {
        Some(symbol) => format!("{symbol} {}", value_text(&axis.path, value)),
        None => value_text(&axis.path, value),
    }
}

/// Returns the label of an axis with its unit; logarithmic axes have the unit on their ticks.
fn axis_name(axis: &Axis) -> String {
    let name = knob_of(&axis.path).map_or(axis.path.as_str(), |knob| knob.label);
    match unit(&axis.path) {
        unit if axis.log || unit.is_empty() => name.to_string(),
        unit => {
            format!("{name} [{}{}]", chart_axis(axis).scale.prefix, in_shown_unit(0.0, unit).1)
        }
    }
}

/// Returns the entries of the title: progress, law, axes and solver.
pub fn title(app: &App, live: Option<&LiveMap>, wanted: Option<&MapPlan>) -> Line {
    let look = &app.appearance;
    let Some(plan) = live.map(|live| &live.map.plan).or(wanted) else { return Vec::new() };
    let progress = match live {
        Some(live) if wanted.is_some_and(|plan| *plan != live.map.plan) => {
            Some("new map ..".into())
        }
        Some(live) if !live.is_complete() => {
            Some(format!("computing {} %", 100 * live.tried / live.map.cells.len()))
        }
        _ => None,
    };
    let solver = &plan.scene.solver;
    let subjects = [
        solver.contact.to_string(),
        format!("{} over {}", axis_name(&plan.y), axis_name(&plan.x)),
        solver.kind.to_string(),
        format!("c: {}", app.map_law().other()),
    ];
    let progress = progress.into_iter().map(|text| (text, look.style(Role::Focus)));
    progress.chain(subjects.map(|text| (text, look.style(Role::Text)))).collect()
}

/// Returns the legend: the verdicts on the map, and the sign of the current knobs.
pub fn legend(app: &App, live: &LiveMap) -> Line {
    let look = &app.appearance;
    let mut line: Line = Vec::new();
    for verdict in occurring(live) {
        let (sign, style) = sign(look, verdict);
        line.push((sign.to_string(), style));
        line.push((format!(" {verdict}  "), look.style(Role::Text)));
    }
    line.push((now(app, live), look.style(Role::Focus)));
    line
}

fn occurring(live: &LiveMap) -> impl Iterator<Item = Verdict> {
    let (census, _) = live.map.census();
    census.into_iter().filter(|(_, count)| *count > 0).map(|(verdict, _)| verdict)
}

/// Returns the values of the current knobs, and whether they are on the map.
fn now(app: &App, live: &LiveMap) -> String {
    let axes = [&live.map.plan.x, &live.map.plan.y];
    let is_inside = axes.iter().all(|axis| is_inside(axis, axis.place(present(app, axis))));
    let [x, y] = axes.map(|axis| named_value(axis, present(app, axis)));
    match is_inside {
        true => format!("{} now {x}, {y}", app.appearance.either('╋', '+')),
        false => format!("now {x}, {y}: outside"),
    }
}

/// Returns one row about the cell under the cursor, or the names of the threshold lines.
pub fn row(app: &App, live: &LiveMap, width: usize) -> Line {
    let look = &app.appearance;
    let Some([head, verdict, detail]) = cell(app, live) else {
        return vec![(lines(live).join(", "), look.style(Role::Text))];
    };
    let taken = columns(&format!("[ ] {head}:   {verdict} "));
    let detail = whole_parts(&detail, width.saturating_sub(taken), 1).concat();
    let shown = app.cell_in(ViewId::Map).and_then(|[column, row]| live.shown(column, row));
    let (sign, style) =
        shown.map_or((' ', look.style(Role::Text)), |cell| sign(look, cell.verdict));
    vec![
        (format!("[ ] {head}: "), look.style(Role::Text)),
        // The sign has the verdict's colour, where there is no room for a legend.
        (sign.to_string(), style),
        (format!(" {verdict}"), look.style(Role::Focus)),
        (format!(" {detail}"), look.style(Role::Text)),
    ]
}

/// Returns values, verdict and details of the cell under the cursor; `None` without a cursor in the
/// map.
fn cell(app: &App, live: &LiveMap) -> Option<[String; 3]> {
    let [column, row] = app.cell_in(ViewId::Map)?;
    let plan = &live.map.plan;
    let values = [(&plan.x, column), (&plan.y, row)]
        .map(|(axis, place)| named_value(axis, axis.value(place)));
    let run = app.results().found.cell.as_deref();
    let run = run.filter(|run| run.cell == [column, row] && run.plan == *plan);
    let verdict = match (live.map.at(column, row), run) {
        (Some(cell), _) => cell.verdict.to_string(),
        (None, Some(run)) => run.verdict.to_string(),
        (None, None) if live.is_complete() => "takes too long".into(),
        (None, None) => "not computed yet".into(),
    };
    Some([values.join(", "), verdict, run.map(detail).unwrap_or_default()])
}

/// Describes the run of a cell: blades in contact, start, forces, impacts.
fn detail(run: &CellRun) -> String {
    let mut out = String::new();
    if let Some(since) = run.since {
        let mut contacts: Vec<_> = run.contacts.iter().collect();
        contacts.sort_by(|a, b| a.0.cmp(&b.0));
        let contacts = || contacts.iter().take(4);
        let groups: Vec<String> = contacts().map(|(blades, _)| few(blades)).collect();
        let forces: Vec<String> = contacts().map(|(_, force)| format!("{force:.0}")).collect();
        let held = run.verdict.is_held();
        let since = if held { format!(" since {}", readable(since, "s")) } else { String::new() };
        out = format!("on {}{since}, λ {} N, ", groups.join(" + "), forces.join(" "));
    }
    out + &count(run.impacts, "impact")
}

/// Returns the lines of the column beside the map.
pub fn column(app: &App, live: &LiveMap, width: usize) -> Vec<Line> {
    let look = &app.appearance;
    let [text, quiet, focus] = [Role::Text, Role::Quiet, Role::Focus].map(|role| look.style(role));
    let mut lines: Vec<Line> = Vec::new();
    for verdict in occurring(live) {
        let (sign, style) = sign(look, verdict);
        let mut meaning =
            wrap(&format!("{verdict}: {}", means(verdict)), width.saturating_sub(2)).into_iter();
        let first = meaning.next().unwrap_or_default();
        lines.push(vec![(sign.to_string(), style), (format!(" {first}"), text)]);
        lines.extend(meaning.map(|rest| vec![(format!("  {rest}"), text)]));
    }
    lines.push(Vec::new());
    let paragraph = |words: &str, style: Style| -> Vec<Line> {
        wrap(words, width).into_iter().map(|line| vec![(line, style)]).collect()
    };
    lines.extend(self::lines(live).iter().map(|name| vec![(format!("┊ {name}"), text)]));
    lines.extend(paragraph(&now(app, live), focus));
    lines.push(Vec::new());
    match cell(app, live) {
        Some([values, verdict, detail]) => {
            lines.push(vec![("[ ] this cell:".into(), text)]);
            lines.extend(paragraph(&values, text));
            lines.push(vec![(verdict, focus)]);
            lines.extend(paragraph(&detail, text));
            lines.push(vec![("Enter opens this run".into(), quiet)]);
        }
        None => lines.push(vec![("i reads a cell".into(), quiet)]),
    }
    lines.push(vec![("X Y other axes, c other law".into(), quiet)]);
    lines
}

/// Returns the labels of the threshold lines, in the order of speed.
fn lines(live: &LiveMap) -> Vec<String> {
    let on_x = live.map.plan.x.path == SPEED;
    let speed = |line: &&Curve| line.points.first().map_or(0.0, |p| if on_x { p.0 } else { p.1 });
    let mut lines: Vec<&Curve> = live.lines.iter().collect();
    lines.sort_by(|a, b| speed(a).total_cmp(&speed(b)));
    lines.into_iter().map(line_name).collect()
}

/// Returns the label of a threshold line, with its speed if that is constant over the map.
fn line_name(line: &Curve) -> String {
    let name = line.name.replace("Omega", "Ω");
    let Some(first) = line.points.first() else { return name };
    let [on_x, on_y] = [|p: &(f64, f64)| p.0, |p: &(f64, f64)| p.1]
        .map(|of| line.points.iter().all(|point| of(point) == of(first)));
    match (on_x, on_y) {
        (true, false) => format!("{name} {:.1}", per_speed(first.0)),
        (false, true) => format!("{name} {:.1}", per_speed(first.1)),
        _ => name,
    }
}
