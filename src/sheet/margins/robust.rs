//! How far a run is from another verdict: one sentence, and a table with a row per quantity.

use super::words::from_here;
use crate::sheet::number::{count, micro, rounded, scaled, short, with_unit};
use crate::sheet::table::{Heading, Table, TableCell};
use rubscope_solver::scene::ContactLaw;
use rubscope_solver::study::margins::{
    ChangedVerdict, Limit, LimitName, Margins, Robustness, VerdictChange, parameter,
};

/// Significant digits shown of a value, as many as the values that the search tries have.
const DIGITS: usize = 4;

/// Explanation of the mark `?`, added to a sentence.
const MARKED: &str = " ? marks a verdict that a tiny change or another step changes.";

/// Iterates over the searches for another verdict: with the contact law of the scene, then with
/// push-only contact, as far as they were made.
pub fn asked(margins: &Margins) -> impl Iterator<Item = &Robustness> {
    margins.robust.iter().chain(&margins.pushes_only)
}

/// States the verdict of the run, with room (`wide`) the casing lobes and the tip deviation that end
/// its lock, and the nearest change of a quantity that was found to alter the verdict.
pub fn sentence(found: &Robustness, margins: &Margins, wide: bool) -> String {
    let scene = &margins.scene;
    let law = match found.contact {
        ContactLaw::Unilateral if found.solver != scene.solver.kind => "pushes only, event solver",
        ContactLaw::Unilateral => "pushes only",
        ContactLaw::Bilateral => "bilateral law",
        ContactLaw::Smooth => "smooth law",
    };
    let speed = with_unit(scene.operation.speed_rad_s, DIGITS, "rad/s");
    let mut parts = vec![format!("{speed}, {law}: {}", found.verdict)];
    if found.changes.len() < found.rows {
        parts.push(format!("{} of {} quantities tried", found.changes.len(), found.rows));
        return format!("{}.", parts.join("; "));
    }
    if wide {
        let held = found.verdict.is_held();
        parts.extend(out_of_round(margins).filter(|_| held));
        parts.extend(tips(margins, held));
    }
    let each = found.changes.iter().filter_map(|row| Some((row, row.nearest()?)));
    let nearest = each.min_by(|(_, (_, a)), (_, (_, b))| a.abs().total_cmp(&b.abs()));
    parts.push(match nearest {
        Some((row, (changed, part))) => {
            let (what, at) = (row.name, amount(row.path, changed.value, changed.value).join(" "));
            format!(
                "nearest found: {}{} at {what} {} ({})",
                changed.verdict,
                mark(changed),
                at.trim_end(),
                from_here(part)
            )
        }
        None => "no change found".into(),
    });
    let mut ends = found.changes.iter().flat_map(|row| [row.below, row.above]).flatten();
    let foot = if ends.any(|end| end.sensitive) { MARKED } else { "" };
    format!("{}.{foot}", parts.join("; "))
}

/// Returns the limit of roundness with the smallest lobes of the casing that end the lock, their
/// height \[m\] and their number; `None` if no number of lobes is known to end it.
pub fn smallest_lobes(margins: &Margins) -> Option<(&Limit, f64, u32)> {
    let heights = margins.limits.iter().filter(|limit| limit.name == LimitName::Roundness);
    let each = heights.filter_map(|limit| Some((limit, limit.value?, limit.lobes?)));
    each.min_by(|(_, a, _), (_, b, _)| a.total_cmp(b))
}

/// States the smallest lobes that end the lock, in micrometres and as a part of the clearance.
fn out_of_round(margins: &Margins) -> Option<String> {
    let (limit, height, lobes) = smallest_lobes(margins)?;
    let now = short(rounded(1e6 * limit.present?, 2));
    let [height, part] = um_and_part(height, margins);
    let lobes = count(u64::from(lobes), "lobe");
    Some(format!(
        "a casing out of round by {height} {}m ({lobes}; {part} % of the clearance; now {now}) ends it",
        micro()
    ))
}

/// Returns the tip deviation \[m\] beyond which the worst tips take a push from the lock or, if the run
/// is not `held`, the best tips let pushes hold one; `None` if it is not known.
pub fn tip_deviation(margins: &Margins, held: bool) -> Option<f64> {
    let scene = &margins.scene;
    let deviation = scene.machine().tip_deviation(scene.operation.speed_rad_s)?;
    (held == (deviation > 0.0)).then_some(deviation.abs())
}

/// States the tip deviation and its effect.
fn tips(margins: &Margins, held: bool) -> Option<String> {
    let [deviation, part] = um_and_part(tip_deviation(margins, held)?, margins);
    let does = if held { "may end it too" } else { "may let pushes hold a lock" };
    Some(format!("tips off by {deviation} {}m ({part} % of the clearance) {does}", micro()))
}

/// Returns a length in micrometres and in per cent of the clearance.
fn um_and_part(length: f64, margins: &Margins) -> [String; 2] {
    [1e6 * length, 100.0 * length / margins.scene.clearance()].map(|x| short(rounded(x, 2)))
}

/// Returns the mark of an altered verdict: `?` if it is itself sensitive, otherwise nothing.
fn mark(changed: ChangedVerdict) -> &'static str {
    if changed.sensitive { "?" } else { "" }
}

/// Returns a table with one row per quantity: the nearest values below and above the present one at
/// which another verdict was found, all in one unit. `at` joins verdict and value.
pub fn table(found: &Robustness, at: &str) -> Table<'static> {
    let headings = ["what", "found below", "now", "found above"].map(Heading::shown);
    let row = |row: &VerdictChange| {
        let [now, unit] = amount(row.path, row.present, row.present);
        let side = |found: Option<ChangedVerdict>, tried: f64| match found {
            Some(changed) => {
                let value = &amount(row.path, changed.value, row.present)[0];
                format!("{}{}{at}{value}", changed.verdict, mark(changed))
            }
            None if tried == row.present => "-".into(),
            None => format!("none to {}", amount(row.path, tried, row.present)[0]),
        };
        let what = if unit.is_empty() { row.name.into() } else { format!("{} [{unit}]", row.name) };
        let [low, high] = row.tried;
        let cells = [what, side(row.below, low), now, side(row.above, high)];
        cells.map(TableCell::from).into()
    };
    Table::with_rows(headings, found.changes.iter().map(row).collect())
}

/// Returns a value of the key `path` and its unit as text, with the SI prefix that suits `of`.
fn amount(path: &str, value: f64, of: f64) -> [String; 2] {
    match parameter(path).map_or("", |by| by.unit) {
        "" | "-" => [short(rounded(value, DIGITS)), String::new()],
        unit => scaled(value, of, DIGITS, unit),
    }
}
