//! The interaction map as a sheet: `rubscope.map/1` in JSON, a row for each cell, a figure with the
//! boundary curves of its zones, and text with one character per cell.

use serde_json::json;

use super::line::wrapped;
use super::number::{count, per_speed, rounded, short, speed_unit};
use super::summary::OF_WHAT;
use super::symbols::greek;
use super::table::{Column, Table, TableCell, WIDTH};
use super::{CommandLine, Sheet};
use rubscope_solver::motion::Verdict;
use rubscope_solver::scene::{Key, keys};
use rubscope_solver::study::figures::{Figure, Panel, Quantity, Series, Style};
use rubscope_solver::study::{Axis, Cell, Doubt, Map, MapPlan, overlay};

/// Largest number of rows of the text map.
const TEXT_ROWS: usize = 40;
/// Number of characters to the left of a row of cells (label and frame), and on both sides of it.
const INDENT: usize = 14;
const FRAME: usize = INDENT + 1;

/// Returns the sheet of a map; its text is at most `width` characters wide.
pub fn sheet(map: &Map, width: usize) -> Sheet<'_> {
    let (plan, [x, y]) = (&map.plan, names(&map.plan));
    let mut sheet = Sheet::new("map", 1, command(map), &plan.scene);
    for (short, name, axis) in [("x", x, &plan.x), ("y", y, &plan.y)] {
        sheet.fact(short, json!({ "path": axis.path, "log": axis.log }));
        sheet.fact(name, axis.values());
    }
    for (name, value) in CELLS {
        let row = move |row| {
            let cells = (0..plan.x.count).map(|column| map.at(column, row as u32));
            cells.map(|cell| cell.as_ref().map(value).unwrap_or_default().value).collect()
        };
        sheet.list(name, plan.y.count as usize, row);
    }
    sheet.fact("wall_s", map.wall_s);
    sheet.fact("runs", map.runs);
    text(map, width).into_iter().for_each(|line| sheet.line(line));
    sheet.filed(None, table(map));
    sheet.picture(|| figure(map, &overlay::curves(plan)));
    sheet
}

/// Columns of the cells of the map.
const CELLS: [Column<'_, Cell>; 3] = [
    ("verdict", |cell| cell.verdict.into()),
    ("sensitive", |cell| (cell.doubt == Doubt::Sensitive).into()),
    ("depends_on_step", |cell| cell.depends_on_step().into()),
];

/// Returns the command that computes this map, all of its shares at once.
pub fn command(map: &Map) -> CommandLine {
    let plan = &map.plan;
    CommandLine::new("map", &plan.scene)
        .option("--x", &plan.x)
        .option("--y", &plan.y)
        .flag("--no-sensitivity", !plan.sensitivity)
}

/// Returns the last part of an axis key, such as `speed_rad_s`.
pub fn leaf(axis: &Axis) -> &str {
    axis.path.rsplit('.').next().unwrap_or(&axis.path)
}

/// Returns the names of the x and the y axis in files: the last parts of their keys, or the full
/// keys if the last parts are equal.
fn names(plan: &MapPlan) -> [&str; 2] {
    let MapPlan { x, y, .. } = plan;
    if leaf(x) == leaf(y) { [&x.path, &y.path] } else { [leaf(x), leaf(y)] }
}

/// Returns the table for files, one row per cell.
pub fn table(map: &Map) -> Table<'_> {
    Table::new(columns(&map.plan), map.plan.len(), |index| row(map, index))
}

/// Returns the names of the columns of [`row`].
pub(super) fn columns(plan: &MapPlan) -> Vec<String> {
    names(plan).into_iter().chain(CELLS.map(|(name, _)| name)).map(String::from).collect()
}

/// Returns the cells of the table for the map cell `index`.
pub(super) fn row(map: &Map, index: usize) -> Vec<TableCell> {
    let (x, y) = (&map.plan.x, &map.plan.y);
    let (row, column) = (index as u32 / x.count, index as u32 % x.count);
    let cell = map.at(column, row);
    // A plain number: `to_string` never uses a power of ten.
    let at = [x.value(column), y.value(row)].map(|value| value.to_string().into());
    let values = CELLS.map(|(_, value)| cell.as_ref().map(value).unwrap_or_default());
    at.into_iter().chain(values).collect()
}

/// Returns the factor from the SI unit of an axis to the unit shown: 1 except for speeds in rpm.
fn factor(axis: &Axis) -> f64 {
    if axis.path == keys::SPEED { per_speed(1.0) } else { 1.0 }
}

/// Returns the label of an axis, with the unit shown.
fn label(axis: &Axis) -> String {
    let title = greek(&keys::find(&axis.path).map_or_else(|_| axis.path.clone(), Key::title));
    if axis.path == keys::SPEED { title.replace("rad/s", speed_unit()) } else { title }
}

/// Returns the map as a figure, with the boundary curves `curves`.
pub fn figure(map: &Map, curves: &[overlay::Curve]) -> Figure {
    let (scene, x, y) = (&map.plan.scene, &map.plan.x, &map.plan.y);
    let quantity = |axis: &Axis| Quantity {
        column: leaf(axis).to_string().into(),
        label: label(axis).into(),
        factor: factor(axis),
        log: axis.log,
        whole: axis.is_whole(),
    };
    let places = |chosen: &dyn Fn(Cell) -> bool| -> Vec<(f64, f64)> {
        let found = map.cells.iter().enumerate().filter(|(_, cell)| cell.is_some_and(chosen));
        let at = |index: usize| (x.value(index as u32 % x.count), y.value(index as u32 / x.count));
        found.map(|(index, _)| at(index)).collect()
    };
    let mut series: Vec<Series> = Verdict::ALL
        .iter()
        .map(|verdict| {
            let cells = places(&|cell| cell.verdict == *verdict);
            Series::new(verdict.as_ref(), Style::Cells(*verdict), cells)
        })
        .collect();
    series.push(Series::new("doubtful", Style::Dots, places(&Cell::is_doubtful)));
    let inside =
        |axis: &Axis, value| (-0.5..=f64::from(axis.count) - 0.5).contains(&axis.place(value));
    let styles = [Style::Line(5), Style::Dashed(2), Style::Dotted(1), Style::Line(3)];
    for (curve, style) in curves.iter().zip(styles) {
        let shown = curve.points.iter().copied().filter(|at| inside(x, at.0) && inside(y, at.1));
        series.push(Series::new(greek(curve.name), style, shown).named(curve.name));
    }
    series.retain(|series| !series.points.is_empty());
    let title = format!("{} ({} contact)", scene.title, scene.solver.contact);
    let conditions = [
        (keys::DIAMETERS, format!("n_d = {}", scene.operation.nodal_diameters)),
        (keys::CASING_DAMPING, format!("ζ_c = {}", scene.casing_in_use().damping_ratio)),
        (keys::BLADE_DAMPING, format!("ζ_bd = {}", scene.disk_in_use().damping_ratio)),
        (keys::SOLVER, format!("{} solver", scene.solver.kind)),
        (keys::MODEL, format!("{} model", scene.solver.model)),
        (keys::END, format!("runs of {} s", scene.solver.end_s)),
    ];
    let fixed = conditions.into_iter().filter(|(path, _)| *path != x.path && *path != y.path);
    let note = fixed.map(|(_, text)| text).collect::<Vec<_>>().join(", ");
    Figure::new(title, note, vec![Panel::new("", quantity(x), quantity(y), series)])
}

/// Returns the character of a cell: a sign for its verdict, or a letter if the verdict is sensitive
/// or depends on the step; a space for a cell that is not computed.
pub fn mark(cell: Option<Cell>) -> char {
    let Some(cell) = cell else { return ' ' };
    let (sure, doubtful) = match cell.verdict {
        Verdict::Decay => ('.', 'd'),
        Verdict::Bounce => ('o', 'b'),
        Verdict::Slip => ('~', 's'),
        Verdict::Whirl => ('@', 'w'),
        Verdict::Forced => ('+', 'p'),
        Verdict::Divergent => ('^', 'g'),
        Verdict::Locked => ('#', 'l'),
        Verdict::Adhesive => ('%', 'a'),
        Verdict::Failed => ('!', 'f'),
    };
    if cell.is_doubtful() { doubtful } else { sure }
}

/// Returns the map as text with a legend, the row of the largest y first. If it is wider than
/// `width` characters or has more than `TEXT_ROWS` rows, only every n-th column or row is shown.
fn text(map: &Map, width: usize) -> Vec<String> {
    let (x, y) = (&map.plan.x, &map.plan.y);
    let most = width.saturating_sub(FRAME).max(10);
    let across = (x.count as usize).div_ceil(most);
    let down = (y.count as usize).div_ceil(TEXT_ROWS);
    let [up, right] = [y, x].map(|axis| match axis.path == keys::SPEED {
        true => axis.path.replace("rad_s", &speed_unit().replace('/', "_")),
        false => axis.path.clone(),
    });
    let mut lines = vec![format!("{up} (up) against {right} (right)")];
    let told = |axis: &Axis, at: u32| short(rounded(factor(axis) * axis.value(at), 12));
    let rows: Vec<u32> = (0..y.count).step_by(down).collect();
    for &row in rows.iter().rev() {
        let line: String =
            (0..x.count).step_by(across).map(|column| mark(map.at(column, row))).collect();
        lines.push(format!("{:>12} |{line}|", told(y, row)));
    }
    let columns = (x.count as usize).div_ceil(across);
    let (first, last) = (told(x, 0), told(x, x.count - 1));
    // On a map of very few columns, the last label extends past the cells.
    let room = columns.saturating_sub(first.len()).max(last.len() + 1);
    lines.push(format!("{:>INDENT$}{first}{last:>room$}", ""));
    lines.extend(speeds(map, across, columns));
    if across > 1 || down > 1 {
        let part = |of: usize, noun: &str| match of {
            1 => format!("every {noun}"),
            _ => format!("one {noun} of {of}"),
        };
        lines.push(format!("Shown is {} and {}.", part(across, "column"), part(down, "row")));
    }
    lines.extend(legend(map));
    lines
}

/// Marks the columns of the critical speed and the lock speed below a map with speeds to the right,
/// unless they depend on the row. Every `across`-th column of the map is shown.
fn speeds(map: &Map, across: usize, columns: usize) -> Vec<String> {
    let line = |curve: overlay::Curve| {
        let &(speed, _) = curve.points.first()?;
        let column = (map.plan.x.place(speed) / across as f64).round();
        let upright = curve.points.iter().all(|point| point.0 == speed);
        if map.plan.x.path != keys::SPEED || !upright || !(0.0..columns as f64).contains(&column) {
            return None;
        }
        let (column, name) =
            (column as usize, format!("{} = {}", curve.name, short(per_speed(speed))));
        Some(match column + 2 + name.len() <= columns.max(40) {
            true => format!("{:>1$}^ {name}", "", INDENT + column),
            false => format!("{name:>0$} ^", (INDENT + column).saturating_sub(1)),
        })
    };
    overlay::speed_curves(&map.plan).into_iter().filter_map(line).collect()
}

/// Explains a verdict in a few words, for the legend.
pub fn means(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Decay => "contact ends",
        Verdict::Bounce => "contacts come and go",
        Verdict::Slip => "contact without a break, but not held",
        Verdict::Whirl => "contact passes from blade to blade and swings them",
        Verdict::Forced => "one blade or group presses without a break, no corner is held",
        Verdict::Divergent => "nothing bounds the growth",
        Verdict::Locked => "held by the same blades, which push",
        Verdict::Adhesive => "held by the same blades, some of which pull",
        Verdict::Failed => "the computation broke down",
    }
}

fn legend(map: &Map) -> Vec<String> {
    let (census, [sensitive, by_step]) = map.census();
    let cells = map.cells.len();
    let present = census.into_iter().filter(|&(_, count)| count > 0);
    let mut lines: Vec<String> = present
        .map(|(verdict, count)| {
            let plain = mark(Some(Cell::of(verdict)));
            format!("{plain}  {verdict}, {}: {count} of {cells} cells", means(verdict))
        })
        .collect();
    let doubtful = |verdict| Cell { verdict, doubt: Doubt::Sensitive };
    let letters = Verdict::ALL.map(|verdict| mark(Some(doubtful(verdict))));
    let letters = letters.map(String::from).join(" ");
    let whys = [
        (
            sensitive,
            format!("a change of 1e-9 {OF_WHAT} changes the verdict or the number of impacts"),
        ),
        (by_step, "another step changes the verdict".to_string()),
    ];
    for (marked, why) in whys.iter().filter(|(marked, _)| *marked > 0) {
        let marked = count(*marked as u64, "cell");
        let told = format!("A letter ({letters}) marks {marked}, where {why}.");
        lines.extend(wrapped(&told, WIDTH));
    }
    lines
}

#[cfg(test)]
mod tests {
    use super::*;
    use rubscope_solver::scene::Scene;

    #[test]
    fn every_curve_over_a_map_is_drawn_apart_from_the_others_without_colour() {
        let axis = |path: &str, from, to, log| Axis::new(path, from, to, 5, log).unwrap();
        let (x, y) = (axis(keys::SPEED, 250.0, 700.0, false), axis(keys::PULSE, 1e3, 1e5, true));
        let scene = Scene::builtin("rub").unwrap();
        let map = Map::empty(MapPlan { scene, x, y, sensitivity: false });
        let curves = overlay::curves(&map.plan);
        assert_eq!(curves.len(), 4);
        let drawn = &figure(&map, &curves).panels[0].series;
        let names: Vec<_> = drawn.iter().map(|series| &*series.name).collect();
        assert_eq!(names, ["Omega_c", "Omega_lock", "lock ends", "grazing pulse"]);
        // The curves of speed limits differ in style; the pulse curve crosses them.
        let kinds: Vec<_> = drawn[..3].iter().map(|it| std::mem::discriminant(&it.style)).collect();
        assert!(kinds[0] != kinds[1] && kinds[1] != kinds[2] && kinds[2] != kinds[0]);
    }
}
