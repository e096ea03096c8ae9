//! The interaction map as JSON (`rubscope.map/1`), as CSV, as a figure with the boundary curves of
//! its zones, and as text with one character per cell.

use std::io::{Result, Write};

use serde::ser::{Serialize, SerializeMap, Serializer};
use serde_json::json;

use super::number::{per_speed, rounded, short, speed_unit};
use super::summary::OF_WHAT;
use super::symbols::greek;
use super::{CommandLine, table};
use rubscope_solver::motion::Verdict;
use rubscope_solver::scene::{Key, keys};
use rubscope_solver::study::figures::{Figure, Panel, Quantity, Series, Style};
use rubscope_solver::study::{Axis, Cell, Map, MapPlan, overlay};

/// Largest number of rows of the text map.
const TEXT_ROWS: usize = 40;
/// Characters to the left of the cells, and on both sides together.
const INDENT: usize = 14;
const FRAME: usize = INDENT + 1;

/// The map as JSON, written cell by cell, because the text may be much larger than the map in
/// memory. Files omit the wall time, so that the same map gives the same file.
#[derive(Clone, Copy, Debug)]
pub struct MapJson<'a> {
    /// The map.
    pub map: &'a Map,
    /// Whether to include the wall time.
    pub with_time: bool,
}

impl Serialize for MapJson<'_> {
    fn serialize<S: Serializer>(&self, out: S) -> std::result::Result<S::Ok, S::Error> {
        let Self { map, with_time } = *self;
        let mut object = out.serialize_map(None)?;
        object.serialize_entry("schema", "rubscope.map/1")?;
        object.serialize_entry("program", &command(map).flag("--json", true).program())?;
        object.serialize_entry("scene", &map.plan.scene.reported())?;
        let names = names(&map.plan);
        for (short, name, axis) in [("x", names[0], &map.plan.x), ("y", names[1], &map.plan.y)] {
            object.serialize_entry(short, &json!({ "path": axis.path, "log": axis.log }))?;
            object.serialize_entry(name, &axis.values())?;
        }
        object.serialize_entry("verdict", &Rows { map, value: |cell| cell.verdict })?;
        object.serialize_entry("sensitive", &Rows { map, value: |cell| cell.sensitive })?;
        let value = |cell: Cell| cell.depends_on_step;
        object.serialize_entry("depends_on_step", &Rows { map, value })?;
        object.serialize_entry("wall_s", &with_time.then_some(map.wall_s))?;
        object.serialize_entry("runs", &map.runs)?;
        object.end()
    }
}

/// Returns the command that computes this map in one run.
pub fn command(map: &Map) -> CommandLine {
    let plan = &map.plan;
    CommandLine::new("map", &plan.scene)
        .option("--x", &plan.x)
        .option("--y", &plan.y)
        .flag("--no-sensitivity", !plan.sensitivity)
}

/// One value per cell, row by row; `null` for a cell that is not computed.
struct Rows<'a, T> {
    map: &'a Map,
    value: fn(Cell) -> T,
}

impl<T: Serialize> Serialize for Rows<'_, T> {
    fn serialize<S: Serializer>(&self, out: S) -> std::result::Result<S::Ok, S::Error> {
        out.collect_seq((0..self.map.plan.y.count).map(|row| Row { rows: self, row }))
    }
}

struct Row<'a, T> {
    rows: &'a Rows<'a, T>,
    row: u32,
}

impl<T: Serialize> Serialize for Row<'_, T> {
    fn serialize<S: Serializer>(&self, out: S) -> std::result::Result<S::Ok, S::Error> {
        let Rows { map, value } = self.rows;
        out.collect_seq((0..map.plan.x.count).map(|column| map.at(column, self.row).map(value)))
    }
}

/// Returns the last part of an axis key, such as `speed_rad_s`.
pub fn leaf(axis: &Axis) -> &str {
    axis.path.rsplit('.').next().unwrap_or(&axis.path)
}

/// Returns the column names of both axes: full keys if their last parts are equal.
pub(super) fn names(plan: &MapPlan) -> [&str; 2] {
    let MapPlan { x, y, .. } = plan;
    if leaf(x) == leaf(y) { [&x.path, &y.path] } else { [leaf(x), leaf(y)] }
}

/// Writes the map as CSV, one line per cell.
///
/// # Errors
/// The writer failed.
pub fn write_csv(map: &Map, out: &mut dyn Write) -> Result<()> {
    let (x, y) = (&map.plan.x, &map.plan.y);
    let [first, second] = names(&map.plan);
    let places = (0..y.count).flat_map(|row| (0..x.count).map(move |column| (row, column)));
    let rows = places.map(|(row, column)| {
        let cell = map.at(column, row);
        [
            // A plain number: `to_string` never uses a power of ten.
            x.value(column).to_string().into(),
            y.value(row).to_string().into(),
            cell.map(|cell| cell.verdict.to_string()).into(),
            cell.map(|cell| cell.sensitive).into(),
            cell.map(|cell| cell.depends_on_step).into(),
        ]
    });
    table::write_csv([first, second, "verdict", "sensitive", "depends_on_step"], rows, out)
}

/// Returns the factor from SI to the unit shown on an axis.
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

/// Returns the character of a cell: a mark for the verdict, or a letter if the verdict is sensitive
/// or depends on the step.
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

/// Writes the map as text with a legend, the highest row first. A row of cells is at most `width`
/// wide; larger maps are thinned.
///
/// # Errors
/// The writer failed.
pub fn write_text(map: &Map, width: usize, out: &mut dyn Write) -> Result<()> {
    let (x, y) = (&map.plan.x, &map.plan.y);
    let most = width.saturating_sub(FRAME).max(10);
    let across = (x.count as usize).div_ceil(most);
    let down = (y.count as usize).div_ceil(TEXT_ROWS);
    let [up, right] = [y, x].map(|axis| match axis.path == keys::SPEED {
        true => axis.path.replace("rad_s", &speed_unit().replace('/', "_")),
        false => axis.path.clone(),
    });
    writeln!(out, "{up} (up) against {right} (right)")?;
    let told = |axis: &Axis, at: u32| short(rounded(factor(axis) * axis.value(at), 12));
    let rows: Vec<u32> = (0..y.count).step_by(down).collect();
    for &row in rows.iter().rev() {
        let line: String =
            (0..x.count).step_by(across).map(|column| mark(map.at(column, row))).collect();
        writeln!(out, "{:>12} |{line}|", told(y, row))?;
    }
    let columns = (x.count as usize).div_ceil(across);
    let (first, last) = (told(x, 0), told(x, x.count - 1));
    // On a map of very few columns, the last label extends past the cells.
    let room = columns.saturating_sub(first.len()).max(last.len() + 1);
    writeln!(out, "{:>INDENT$}{first}{last:>room$}", "")?;
    write_speeds(map, across, columns, out)?;
    if across > 1 || down > 1 {
        let part = |of: usize, noun: &str| match of {
            1 => format!("every {noun}"),
            _ => format!("one {noun} of {of}"),
        };
        writeln!(out, "Shown is {} and {}.", part(across, "column"), part(down, "row"))?;
    }
    write_legend(map, out)
}

/// Marks the columns of the critical speed and the lock speed, if they are the same in every row.
fn write_speeds(map: &Map, across: usize, columns: usize, out: &mut dyn Write) -> Result<()> {
    for curve in overlay::speed_curves(&map.plan) {
        let Some(&(speed, _)) = curve.points.first() else { continue };
        let column = (map.plan.x.place(speed) / across as f64).round();
        let upright = curve.points.iter().all(|point| point.0 == speed);
        if map.plan.x.path != keys::SPEED || !upright || !(0.0..columns as f64).contains(&column) {
            continue;
        }
        let (column, name) =
            (column as usize, format!("{} = {}", curve.name, short(per_speed(speed))));
        if column + 2 + name.len() <= columns.max(40) {
            writeln!(out, "{:>1$}^ {name}", "", INDENT + column)?;
        } else {
            writeln!(out, "{name:>0$} ^", (INDENT + column).saturating_sub(1))?;
        }
    }
    Ok(())
}

/// Explains a verdict in a few words.
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

fn write_legend(map: &Map, out: &mut dyn Write) -> Result<()> {
    let (census, [sensitive, by_step]) = map.census();
    let cells = map.cells.len();
    for (verdict, count) in census.into_iter().filter(|&(_, count)| count > 0) {
        let plain = mark(Some(Cell::of(verdict)));
        let means = means(verdict);
        writeln!(out, "{plain}  {verdict}, {means}: {count} of {cells} cells")?;
    }
    if sensitive + by_step == 0 {
        return Ok(());
    }
    let doubtful = |verdict| Cell { sensitive: true, ..Cell::of(verdict) };
    let letters = Verdict::ALL.map(|verdict| mark(Some(doubtful(verdict))));
    let letters = letters.map(String::from).join(" ");
    let cells = |count: usize, what: &str| match count {
        1 => format!("the {what} cell"),
        _ => format!("the {count} {what} cells"),
    };
    if sensitive > 0 {
        let marked = cells(sensitive, "sensitive");
        writeln!(out, "A letter ({letters}) marks {marked}, where a change of 1e-9")?;
        writeln!(out, "{OF_WHAT} changes the verdict or the number of impacts.")?;
    }
    if by_step > 0 {
        let marked = cells(by_step, "doubtful");
        writeln!(out, "A letter ({letters}) marks {marked}, where another step ends otherwise.")?;
    }
    Ok(())
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

    #[test]
    fn the_ends_of_a_narrow_map_stay_apart() {
        let axis = |path: &str, to: f64| Axis::new(path, 300.0, to, 3, false).unwrap();
        let (x, y) = (axis(keys::SPEED, 430.5), axis(keys::PULSE, 1e4));
        let map = Map::empty(MapPlan { scene: Scene::base(), x, y, sensitivity: false });
        let mut text = Vec::new();
        write_text(&map, 80, &mut text).unwrap();
        let text = String::from_utf8(text).unwrap();
        assert!(text.contains("\n              300 430.5\n"), "{text}");
    }
}
