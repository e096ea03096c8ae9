//! Run time against error of the solvers: as a table, as CSV, and as a log-log figure.

use super::number::{count, rounded, short, time};
use super::summary::OF_WHAT;
use super::table::{Column, Heading, Table, TableCell};
use super::{CommandLine, Sheet};
use rubscope_solver::scene::{ContactLaw, ModelSize, SolverKind};
use rubscope_solver::study::figures::{Figure, Panel, Quantity, Series, Style};
use rubscope_solver::study::precision::{Method, Precision, Reference, Row, Way};

/// Returns the character of a series on the screen, and its style in a figure. Letter, digit and
/// colour follow from solver and contact law; case, digit and size from the model.
pub fn mark(way: &Way) -> (char, Style) {
    let (letter, digit, colour) = match (way.solver, way.contact) {
        (SolverKind::Event, _) => ('e', '2', 0),
        (SolverKind::Explicit, ContactLaw::Unilateral) => ('u', '1', 1),
        (SolverKind::Explicit, ContactLaw::Bilateral) => ('b', '2', 5),
        (SolverKind::Explicit, ContactLaw::Smooth) => ('s', '1', 9),
    };
    match way.model {
        ModelSize::Rigid => (letter, Style::Discs(colour, 3)),
        ModelSize::Modal => (letter.to_ascii_uppercase(), Style::Discs(colour, 5)),
        ModelSize::Full => (digit, Style::Discs(colour, 7)),
    }
}

/// Returns the name of a series: solver, contact law and model, and whether every step is taken.
pub fn series(way: &Way) -> String {
    let plain = if way.plain { " plain" } else { "" };
    format!("{} {} {}{plain}", way.solver, way.contact, way.model)
}

/// Reason why there is no reference, as the end of a sentence.
pub const WHY_NONE: &str = "the run of the reference fails before its end";

/// Describes verdict, method and error of the reference in a few words.
pub fn reference_words(reference: &Reference) -> String {
    let method = match reference.method {
        Method::Events => "no time steps",
        Method::FinestStep => "finest step",
        Method::None => return format!("none: {WHY_NONE}"),
    };
    let error = reference.error.map(|error| format!(", error {} g0", short(rounded(error, 1))));
    format!("{}, {method}{}", reference.verdict, error.unwrap_or_default())
}

/// Returns the measurements as a table; files get more columns than the screen.
pub fn table(report: &Precision) -> Table<'_> {
    let head = |name, words| Heading::from(name).words(words);
    let columns: Vec<Column<'_, Row, Heading>> = vec![
        ("solver".into(), |row| row.way.solver.into()),
        ("contact".into(), |row| row.way.contact.into()),
        ("model".into(), |row| row.way.model.into()),
        (Heading::filed("step_s"), |row| row.way.step_s.into()),
        (Heading::filed("tolerance"), |row| row.way.tolerance.into()),
        (Heading::filed("plain"), |row| row.way.plain.into()),
        (Heading::shown("step or tol."), |row| row.way.step_s.or(row.way.tolerance).into()),
        (head("error_final", "error [g0]"), |row| TableCell::digits(row.error_final, 2)),
        (head("error_impact_time_s", "impact error [s]"), |row| {
            TableCell::digits(row.error_impact_time_s, 2)
        }),
        (Heading::filed("max_penetration_m"), |row| row.max_penetration_m.into()),
        (head("wall_s", "time [us]"), |row| {
            TableCell::told(row.wall_s, short(rounded(1e6 * row.wall_s, 3)))
        }),
        (head("ns_per_step", "ns/step"), |row| TableCell::digits(row.ns_per_step, 3)),
        (head("steps", "taken"), |row| row.steps.into()),
        (head("steps_skipped", "skipped"), |row| row.steps_skipped.into()),
        (Heading::filed("events"), |row| row.events.into()),
        ("verdict".into(), |row| row.verdict.into()),
        (Heading::filed("verdict_right"), |row| row.verdict_right.into()),
        (Heading::filed("other_law"), |row| row.other_law.into()),
        (Heading::shown(""), |row| match row {
            Row { other_law: true, .. } => "other law".into(),
            Row { verdict_right: Some(false), .. } => "wrong".into(),
            Row { way: Way { plain: true, .. }, .. } => "every step".into(),
            _ => "".into(),
        }),
    ];
    let mut table = Table::of(&report.rows, columns);
    if report.rows.iter().any(|row| row.steps.is_some()) {
        table.note(
            "taken, skipped: steps computed one by one, and steps done many at once; ns/step: time \
             over those taken",
        );
    }
    if report.rows.iter().any(|row| row.other_law) {
        table.note(
            "other law: a different problem than the reference; a different answer is not an error, \
             and its end is not compared",
        );
    }
    table
}

/// Returns the sheet of the measurements; `command` reproduces it.
pub fn sheet(report: &Precision, command: CommandLine) -> Sheet<'_> {
    let reference = &report.reference;
    let mut sheet = Sheet::new("precision", 1, command, &report.scene);
    let Way { solver, contact, model, step_s, .. } = reference.way;
    let step = step_s.map_or(String::new(), |step| format!(", step {} s", short(step)));
    sheet.fact("reference", reference);
    sheet.line(&report.scene.title);
    sheet.line(format!(
        "Reference: {solver} solver, {contact}, {model} model{step}: {}, {}, {}.",
        reference_words(reference),
        count(reference.impact_count, "impact"),
        time(reference.wall_s),
    ));
    if report.scene.has_slope_or_friction() && reference.method == Method::Events {
        sheet.line(
            "The reference is linearised: it neglects blade angles in the phases of the gaps, which \
             the explicit solver includes. Errors do not fall below that difference.",
        );
    }
    if reference.sensitive {
        let same_law = || report.rows.iter().filter(|row| !row.other_law);
        let right = same_law().filter(|row| !row.is_wrong()).count();
        sheet.line(format!(
            "This scene is sensitive: a change of 1e-9 {OF_WHAT} changes its outcome. \
             End states are not compared; {right} of {} ways under the same contact law agree \
             with the verdict of the reference.",
            same_law().count()
        ));
    }
    sheet.table("rows", "", table(report));
    if let Some(figure) = figure(report) {
        sheet.picture(move || figure.clone());
    }
    sheet
}

/// Returns the wall time \[s\] of a row and its error at the end, a part of the clearance; `None` if
/// either was not measured.
pub fn place(row: &Row) -> Option<(f64, f64)> {
    row.error_final.filter(|_| row.wall_s > 0.0).map(|error| (row.wall_s, error))
}

/// Returns the figure: error at the end against wall time, both on logarithmic axes; `None` if no
/// row has an error above 0.
pub fn figure(report: &Precision) -> Option<Figure> {
    let is_zero = |row: &&Row| row.error_final == Some(0.0);
    let (zeros, placed): (Vec<&Row>, Vec<&Row>) =
        report.rows.iter().filter(|row| place(row).is_some()).partition(is_zero);
    if placed.is_empty() {
        return None;
    }
    let mut all: Vec<Series> = Vec::new();
    for group in placed.chunk_by(|a, b| name(a) == name(b)) {
        let Some(first) = group.first() else { continue };
        let points = group.iter().filter_map(|row| place(row));
        all.push(Series::new(name(first), mark(&first.way).1, points));
    }
    let zeros: Vec<_> = zeros.into_iter().filter_map(place).collect();
    if !zeros.is_empty() {
        all.push(Series::new("error 0, off this scale", Style::Edge, zeros));
    }
    let x = Quantity::log("wall_s", "wall time [s]");
    let y = Quantity::log("error_final", "error at the end [of the clearance]");
    let title = format!("Speed against error: {}", report.scene.title);
    Some(Figure::new(title, "", vec![Panel::new("", x, y, all)]))
}

/// Returns the name of a series, with a remark if its contact law is not the reference's.
fn name(row: &Row) -> String {
    let law = if row.other_law { ", other law" } else { "" };
    format!("{}{law}", series(&row.way))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rubscope_solver::motion::{Verdict, simulate, to_the_end};
    use rubscope_solver::scene::Scene;
    use rubscope_solver::study::precision::{Effort, Measure, ways};

    fn rows(scene: &Scene, chosen: impl Fn(&Way) -> bool) -> (Reference, Vec<Row>) {
        let measure = Measure::new(scene, Effort::QUICK, &to_the_end).unwrap().unwrap();
        let rows = ways(scene, Effort::QUICK)
            .into_iter()
            .filter(chosen)
            .map(|way| measure.row(way, Effort::QUICK, &to_the_end).unwrap().unwrap())
            .collect();
        (measure.reference().clone(), rows)
    }

    #[test]
    fn errors_of_the_explicit_solver_fall_with_its_step() {
        let (reference, rows) = rows(&Scene::base(), |way| {
            way.model == ModelSize::Rigid
                && way.contact == ContactLaw::Unilateral
                && way.solver == SolverKind::Explicit
        });
        assert!(reference.error.unwrap() < 1e-12 && !reference.sensitive);
        let errors: Vec<f64> = rows.iter().map(|row| row.error_final.unwrap()).collect();
        assert_eq!(errors.len(), 4);
        assert!(errors.windows(2).all(|pair| pair[1] < pair[0]), "{errors:?}");
        // First order in contact: two decades of step give two decades of error.
        assert!((errors[0] / errors[3]).log10() > 1.7, "{errors:?}");
        assert!(rows.iter().all(|row| row.verdict_right == Some(true)));
    }

    #[test]
    fn the_event_solver_is_exact_at_every_tolerance_that_is_tight() {
        let (_, rows) = rows(&Scene::base(), |way| {
            way.solver == SolverKind::Event && way.tolerance <= Some(1e-9)
        });
        assert!(rows.iter().all(|row| row.error_final.unwrap() < 1e-8), "{rows:?}");
    }

    /// Pulls are legitimate under the bilateral law unless the verdict is a lock by pushes.
    #[test]
    fn an_adhesive_contact_of_the_law_that_pulls_is_no_failure() {
        let changes = [("solver.contact", "bilateral"), ("operation.speed_rad_s", "400")];
        let scene = Scene::builtin("paper-nd3").unwrap().with(&changes).unwrap();
        let report = simulate(&scene);
        assert_eq!(report.outcome.verdict, Verdict::Adhesive);
        assert!(report.outcome.contacts.iter().any(|contact| contact.multiplier_n > 1.0));
        assert_eq!(report.failure, None);
    }
}
