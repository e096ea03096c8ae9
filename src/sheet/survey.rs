//! The survey of all nodal diameters: aligned text, a table of every limit (CSV), and the
//! interference chart (SVG).

use std::borrow::Cow;
use std::f64::consts::TAU;

use super::line::{capital, listed};
use super::margins::words;
use super::number::{count, per_speed, rounded, short, span, speed, speed_unit, with_unit};
use super::table::{Column, Heading, Table, TableCell};
use super::{CommandLine, Sheet};
use rubscope_solver::model::Mode;
use rubscope_solver::scene::Scene;
use rubscope_solver::study::figures::{Figure, Panel, Quantity, Series, Style};
use rubscope_solver::study::margins::LimitName;
use rubscope_solver::study::survey::{Scattered, Survey, SurveyLimit, SurveyRow};

/// Largest number of rows of the text, one per nodal diameter, and largest width of the table
/// \[characters\].
const ROWS: usize = 64;
const WIDEST: usize = 110;
/// Width of the range bar \[characters\].
const BAR: usize = 20;
/// Largest number of nodal diameters that the answer lists; more are counted.
const LISTED: usize = 8;

/// Limits with a column in the text, the most important first, and their headings.
const LIMITS: [(LimitName, &str); 6] = [
    (LimitName::OmegaLock, "Omega_lock"),
    (LimitName::LockEnds, "ends"),
    (LimitName::Coincidence, "sum (31)"),
    (LimitName::WhirlOnset, "onset"),
    (LimitName::FlutterSpeed, "flutter"),
    (LimitName::OmegaC, "Omega_c"),
];

/// Returns those of [`LIMITS`] that at least one of the rows has.
fn present<'a>(
    rows: &'a [&'a SurveyRow],
) -> impl Iterator<Item = &'static (LimitName, &'static str)> + 'a {
    let has = |row: &SurveyRow, name| row.limits.iter().any(|limit| limit.name == name);
    LIMITS.iter().filter(move |(name, _)| rows.iter().any(|row| has(row, *name)))
}

/// Nodal diameters and one of their limits; `None` if they have none.
type LimitRow<'a> = (&'a SurveyRow, Option<&'a SurveyLimit>);

/// Returns the table for files: one row per limit, and one for nodal diameters without any.
fn table(survey: &Survey) -> Table<'_> {
    let columns: Vec<Column<'_, LimitRow<'_>>> = vec![
        ("nodal_diameters", |row| row.0.nodal_diameters.into()),
        ("omega_c_rad_s", |row| row.0.omega_c_rad_s.into()),
        ("omega_bd_rad_s", |row| row.0.omega_bd_rad_s.into()),
        ("name", |row| row.1.map(|limit| limit.name.as_ref()).into()),
        ("value_rad_s", |row| row.1.map(|limit| limit.value).into()),
        ("margin", |row| words::margin_cell(row.1.and_then(|limit| limit.margin))),
        ("in_range", |row| row.1.and_then(|limit| limit.in_range).into()),
        ("by", |row| row.1.and_then(|limit| limit.by).into()),
    ];
    let mut rows: Vec<LimitRow<'_>> = Vec::new();
    for row in &survey.rows {
        rows.extend(row.limits.iter().map(|limit| (row, Some(limit))));
        if row.limits.is_empty() {
            rows.push((row, None));
        }
    }
    Table::of(rows, columns)
}

/// Returns the sheet of the survey; with `all`, its text and picture have nodal diameters without
/// modes of their own, too. `command` reproduces it.
pub fn sheet(survey: &Survey, all: bool, command: CommandLine) -> Sheet<'_> {
    let mut sheet = Sheet::new("survey", 1, command, &survey.scene);
    sheet.facts(survey);
    sheet.paragraph(&survey.scene.title);
    sheet.paragraph(&answer(survey, all));
    let marks = if survey.range_rad_s.is_some() { " * marks a limit in the range." } else { "" };
    sheet.paragraph(&(head(survey) + marks));
    let shown = survey.shown(all);
    notes(survey, &shown).iter().for_each(|note| sheet.paragraph(note));
    let mut rows = rows(survey, &shown[..shown.len().min(ROWS)]).within(WIDEST);
    let others = survey.rows.len() - shown.len();
    if shown.len() > ROWS {
        rows.note(format!("and {} more: --json or --out", shown.len() - ROWS));
    }
    if others > 0 {
        rows.note(format!("{others} more have no modes of their own: --all shows them, with ?."));
    }
    sheet.table(None, "", rows);
    sheet.filed(None, table(survey));
    sheet.picture(move || figure(survey, all));
    sheet
}

/// Returns the remarks of the survey, and those that apply to at least one of the rows shown.
pub fn notes(survey: &Survey, shown: &[&SurveyRow]) -> Vec<String> {
    let any = |has: fn(&SurveyRow) -> bool, note: &str| {
        shown.iter().any(|row| has(row)).then(|| note.to_string())
    };
    let tuned = survey.note.iter().map(|note| format!("The limits are {note}."));
    let scattered = survey.scattered.iter().map(|found| of_scatter(&survey.scene, found));
    let shaft = "One nodal diameter also moves the shaft, which this model does not have.";
    let shaft = any(|row| row.nodal_diameters == 1, shaft);
    let guessed =
        "Nodal diameters with ? have no modes of their own: they borrow the common values.";
    let guessed = any(|row| row.guessed, guessed);
    let halves = halves(&survey.scene);
    tuned
        .chain(scattered)
        .chain(guessed)
        .chain(halves)
        .chain(shaft)
        .chain(growth(survey, shown))
        .collect()
}

/// Names the nodal diameters with a mode of the casing or of the disk only, where both have lists.
fn halves(scene: &Scene) -> Vec<String> {
    let parts = [(&scene.casing.modes, "casing"), (&scene.bladed_disk.modes, "disk")];
    let of = |modes: &[Mode]| modes.iter().map(|mode| mode.nodal_diameters).collect::<Vec<_>>();
    let missing = |(own, name): (&Vec<Mode>, &str), (other, missing): (&Vec<Mode>, &str)| {
        let others = of(other);
        let mut lone = of(own);
        lone.retain(|diameters| !others.is_empty() && !others.contains(diameters));
        let waves = capital(&waves(&lone));
        let borrowed = format!("that of the {missing} is borrowed");
        (!lone.is_empty()).then(|| format!("{waves} have a mode of the {name} only; {borrowed}."))
    };
    [missing(parts[0], parts[1]), missing(parts[1], parts[0])].into_iter().flatten().collect()
}

/// Lists the nodal diameters that can lock: somewhere in the range or, without a range, at the scene's
/// speed. Nodal diameters with guessed modes, and those for which it is unknown, are listed separately.
/// `all` includes nodal diameters without modes of their own.
pub fn answer(survey: &Survey, all: bool) -> String {
    let now = survey.scene.operation.speed_rad_s;
    let at = match survey.range_rad_s {
        Some([from, to]) => format!("From {} to {}", speed(from), speed(to)),
        None => format!("At {}", speed(now)),
    };
    let locks = |row: &SurveyRow| match (&row.locks_in_range, survey.range_rad_s) {
        (Some(locks), Some(_)) => !locks.is_empty(),
        _ => row.locks_at(now),
    };
    let mut rows = survey.shown(all);
    rows.sort_by_key(|row| row.nodal_diameters);
    let of = |is: &dyn Fn(&SurveyRow) -> bool| {
        let rows = rows.iter().filter(|row| is(row));
        rows.map(|row| row.nodal_diameters).collect::<Vec<_>>()
    };
    let own = of(&|row| locks(row) && !row.guessed);
    let guessed = of(&|row| locks(row) && row.guessed);
    let unknown = of(&|row| row.locks_in_range.is_none());
    let mut told = match own.as_slice() {
        [] if !unknown.is_empty() => format!("{at} no wave is known that can lock"),
        [] if guessed.is_empty() => format!("{at} no wave can lock"),
        [] => format!("{at} no wave with modes of its own can lock"),
        own => format!("{at} {} can lock", waves(own)),
    };
    if !guessed.is_empty() {
        told += &format!("; with guessed modes {} could, too", waves(&guessed));
    }
    if !unknown.is_empty() {
        told += &format!(
            "; it is not known for {}: no formula is known for these tips or this casing; run a \
             speed to see",
            waves(&unknown)
        );
    }
    told + "."
}

/// Names waves by their nodal diameters; more than [`LISTED`] by their number only.
fn waves(diameters: &[u32]) -> String {
    match diameters {
        [1] => "waves of 1 nodal diameter".to_string(),
        [.., last] if diameters.len() > LISTED => {
            format!("waves of {} different nodal diameters, up to {last},", diameters.len())
        }
        _ => format!("waves of {} nodal diameters", listed(diameters, "and")),
    }
}

/// Returns the ends of an interval that lie inside the speeds of the survey, and those speeds in
/// words.
fn within(survey: &Survey, &[from, to]: &[f64; 2]) -> ([Option<f64>; 2], String) {
    let [least, most] = survey.speeds();
    let ends = [Some(from).filter(|from| *from > least), Some(to).filter(|to| *to < most)];
    (ends, span(ends[0], ends[1], 4))
}

/// Returns two texts for a row: the speeds of the range at which its wave can lock, and those at which
/// it whirls or rubbing grows without bound (may be empty).
fn verdict(survey: &Survey, row: &SurveyRow) -> [String; 2] {
    let locks = match &row.locks_in_range {
        None => "unknown: see a run".to_string(),
        Some(locks) if locks.is_empty() => "no lock".to_string(),
        Some(locks) => {
            let each = locks.iter().map(|lock| match within(survey, lock) {
                ([None, None], _) if survey.range_rad_s.is_some() => "whole range".to_string(),
                (_, speeds) => speeds,
            });
            format!("can lock: {}", each.collect::<Vec<_>>().join(", "))
        }
    };
    let onset = row.limits.iter().any(|limit| limit.name == LimitName::WhirlOnset);
    let from = if onset { "from " } else { "" };
    let whirls = row.whirls_in_range.iter().copied();
    let whirl = whirls.min_by(|a, b| a.abs().total_cmp(&b.abs()));
    let whirl = whirl.map(|omega| format!("{from}{}", with_unit(omega, 4, "rad/s")));
    let grows = if row.growth_spans.is_empty() { "" } else { "grows" };
    [locks, whirl.unwrap_or_else(|| grows.to_string())]
}

/// Returns the speeds at which a large rub whirls or grows without bound, one sentence for all rows
/// with the same speeds. Rows with guessed modes have no sentence.
fn growth(survey: &Survey, shown: &[&SurveyRow]) -> Vec<String> {
    let mut told: Vec<(Vec<u32>, String)> = Vec::new();
    for row in shown.iter().filter(|row| !row.guessed && !row.growth_spans.is_empty()) {
        let all = [(&row.whirl_spans, "whirls"), (&row.growth_spans, "grows without bound")];
        let each = all.iter().flat_map(|(spans, does)| {
            spans.iter().map(move |span| format!("{does} {}", within(survey, span).1))
        });
        let all = each.collect::<Vec<_>>().join(", ");
        match told.iter_mut().find(|(_, other)| *other == all) {
            Some((diameters, _)) => diameters.push(row.nodal_diameters),
            None => told.push((vec![row.nodal_diameters], all)),
        }
    }
    let sentence = |(mut diameters, all): (Vec<u32>, String)| {
        diameters.sort_unstable();
        format!("A large rub in {} {all}.", waves(&diameters))
    };
    told.into_iter().take(LISTED).map(sentence).collect()
}

/// Returns the speed range covered by the bar, the lower end first \[rad/s\]: the range of the
/// survey or, without one, from rest to [`REACH`] times the scene's speed.
fn ends(survey: &Survey) -> [f64; 2] {
    let far = REACH * survey.scene.operation.speed_rad_s;
    survey.range_rad_s.unwrap_or([far.min(0.0), far.max(0.0)])
}

/// Draws the range bar: `w` where whirl begins, `#` where the wave can lock at the middle of the
/// character's range, `.` elsewhere.
fn bar(survey: &Survey, row: &SurveyRow) -> String {
    let [from, to] = ends(survey);
    let part = (to - from) / BAR as f64;
    let sign = |place: usize| {
        let start = from + part * place as f64;
        let begins = row.whirls_in_range.iter().any(|at| (start..start + part).contains(at));
        let locks = row.locks_at(start + 0.5 * part);
        if begins {
            'w'
        } else if locks {
            '#'
        } else {
            '.'
        }
    };
    (0..BAR).map(sign).collect()
}

/// Explains how tips that differ by 1 % of the clearance move the lock speed.
pub fn of_scatter(scene: &Scene, scattered: &Scattered) -> String {
    let speeds = [scattered.mean_rad_s, scattered.equal_rad_s];
    let [mean, equal] = speeds.map(|omega| with_unit(omega, 4, "rad/s"));
    let of = match scene.is_uneven() {
        true => "the tips and the casing of the scene. In a round casing tips",
        false => "equal tips in a round casing; unequal tips lock at lower speeds. Tips",
    };
    format!(
        "The limits are for {of} that differ by 1 % of the clearance lock from {mean} instead of \
         {equal} (mean of {} rotors).",
        scattered.rotors
    )
}

/// Describes the machine and the units, in a sentence.
fn head(survey: &Survey) -> String {
    let blades = survey.scene.bladed_disk.blades;
    let most = count(u64::from(blades / 2), "nodal diameter");
    let back = if survey.is_forward() { "" } else { ", of a rotor that turns backward" };
    let (unit, disk) = (speed_unit(), at_speed(survey));
    let disk = if disk.is_empty() { disk } else { format!(", that of the disk{disk}") };
    format!("{blades} blades, 0 to {most}; speeds in {unit}{back}; frequencies in Hz{disk}.")
}

/// Says at which speed the disk frequencies apply, if the blades stiffen with speed.
fn at_speed(survey: &Survey) -> String {
    let stiffens = survey.scene.bladed_disk.stiffens();
    let now = survey.scene.operation.speed_rad_s.abs();
    if stiffens { format!(" at {}", speed(now)) } else { String::new() }
}

/// Returns a row for each of these nodal diameters: verdict, bar, modes \[Hz\], and the limits for
/// the sense of rotation of the survey.
pub fn rows(survey: &Survey, shown: &[&SurveyRow]) -> Table<'static> {
    let limits: Vec<_> = present(shown).collect();
    let [from, to] = ends(survey).map(|end| short(rounded(per_speed(end), 4)));
    let of_bar = format!("{from:<0$}{to}", BAR.saturating_sub(to.len()));
    // Whirl has its own column, because both in one would be wider than a small screen.
    let moves = |row: &&SurveyRow| !(row.whirls_in_range.is_empty() && row.growth_spans.is_empty());
    let whirls = shown.iter().any(moves);
    let heads = ["n_d", "verdict"].into_iter().chain(whirls.then_some("whirl"));
    let heads = heads.chain([of_bar.as_str(), "casing", "disk"]);
    let heads = heads.chain(limits.iter().map(|limit| limit.1));
    let heads: Vec<Heading> = heads.map(|head| Heading::shown(head.to_string())).collect();
    let cell = |x: f64, sign: &str| TableCell::told(x, short(rounded(x, 5)) + sign);
    let row = |row: &&SurveyRow| {
        let here = row.nodal_diameters == survey.scene.operation.nodal_diameters;
        let (sign, known) = (if here { ">" } else { " " }, if row.guessed { "?" } else { "" });
        let own = format!("{sign}{}{known}", row.nodal_diameters);
        let [locks, whirl] = verdict(survey, row);
        let words = [own, locks].into_iter().chain(whirls.then_some(whirl));
        let words = words.chain([bar(survey, row)]).map(TableCell::from);
        let modes = [row.omega_c_rad_s, row.omega_bd_rad_s].map(|omega| cell(omega / TAU, ""));
        let limits = limits.iter().map(|(name, _)| {
            let limit = row.limit(*name, survey.is_forward()).map(|limit| {
                let sign = if limit.in_range == Some(true) { "*" } else { "" };
                let by = limit.by.map_or(String::new(), |by| format!(" ({})", words::change(by)));
                cell(per_speed(limit.value.abs()), &format!("{sign}{by}"))
            });
            limit.unwrap_or_default()
        });
        words.chain(modes).chain(limits).collect()
    };
    Table::with_rows(heads, shown.iter().map(row).collect())
}

/// Colour number of lines that are not limits.
const INK: usize = 5;
/// Without a range, the bar ends at this multiple of the scene's speed. The chart leaves out limits
/// above this multiple of the fastest of the scene's speed and the ends of the range.
const REACH: f64 = 2.0;

/// Returns the interference chart: the frequencies and the lines `n_d Omega` over `n_d`, and below
/// them the limits and the speeds at which waves can lock.
pub fn figure(survey: &Survey, all: bool) -> Figure {
    let rows = survey.shown(all);
    let at = |row: &SurveyRow| f64::from(row.nodal_diameters);
    let over = |of: fn(&SurveyRow) -> f64, known: bool| {
        let rows = rows.iter().filter(move |row| row.guessed != known);
        rows.map(move |row| (at(row), of(row))).collect::<Vec<_>>()
    };
    let now = survey.scene.operation.speed_rad_s;
    let mut frequencies = Vec::new();
    let casing: fn(&SurveyRow) -> f64 = |row| row.omega_c_rad_s;
    let disk: fn(&SurveyRow) -> f64 = |row| row.omega_bd_rad_s;
    let of_disk = format!("disk ω_bd{}", at_speed(survey));
    for (label, number, radius, of) in [("casing ω_c", 0, 4, casing), (&of_disk, 1, 3, disk)] {
        // A multiple of 7 gives a filled disc, and (with six colours) the colour of `number`.
        frequencies.push(Series::new(label, Style::Discs(7 * number, radius), over(of, true)));
        let assumed = format!("{label}, assumed");
        frequencies.push(Series::new(assumed, Style::Rings(number, radius), over(of, false)));
    }
    // Half a nodal diameter more, for the last bar; both panels have the same axis.
    let last = 0.5 + rows.iter().map(|row| at(row)).fold(0.0, f64::max);
    frequencies.push(Series::new("", Style::Faint, [(0.0, 0.0), (last, 0.0)]));
    let most =
        rows.iter().fold(0.0_f64, |most, row| most.max(row.omega_c_rad_s + row.omega_bd_rad_s));
    // The lines end at the highest frequency.
    let turning = |omega: f64| {
        let end = if omega > 0.0 { (most / omega).min(last) } else { last };
        [(0.0, 0.0), (end, end * omega)]
    };
    let [from, to] = survey.range_rad_s.unwrap_or([now; 2]);
    let reach = REACH * [from, to, now].map(f64::abs).into_iter().fold(0.0, f64::max);
    let spans = rows.iter().flat_map(|row| {
        let locks = row.locks_in_range.iter().flatten();
        locks.flat_map(move |span| span.map(|end| (at(row), end.clamp(-reach, reach))))
    });
    let mut limits = vec![Series::new("can lock", Style::Bars(0), spans)];
    let ends = [("now", now, Style::Line(INK)), ("from", from, Style::Dotted(INK))];
    let ends = ends.into_iter().chain([("to", to, Style::Dashed(INK))]);
    for (name, end, style) in ends.take(if survey.range_rad_s.is_some() { 3 } else { 1 }) {
        let label = format!("n_d Ω at {}", speed(end.abs()));
        frequencies.push(Series::new(label, style, turning(end.abs())));
        let level = [(0.0, end), (last, end)];
        limits.push(Series::new(format!("{name} {}", speed(end)), style, level));
    }
    let mut outside = 0;
    for (colour, (name, _)) in present(&rows).enumerate() {
        let value = |row: &&SurveyRow| Some(row.limit(*name, survey.is_forward())?.value);
        let points = rows.iter().filter_map(|row| Some((at(row), value(row)?)));
        let (points, beyond): (Vec<_>, Vec<_>) = points.partition(|point| point.1.abs() <= reach);
        outside += beyond.len();
        limits.push(Series::new(name.symbol(), Style::Discs(colour, 4), points));
    }
    let diameters = || Quantity::whole("nodal_diameters", "nodal diameters n_d");
    let frequency = Quantity::new("omega_rad_s", "frequency [Hz]", 1.0 / TAU);
    let label = Cow::Owned(format!("rotor speed Ω [{}]", speed_unit()));
    let speeds = Quantity { label, factor: per_speed(1.0), ..Quantity::SPEED };
    let panels = vec![
        Panel::new("(a) frequencies", diameters(), frequency, frequencies),
        Panel::new("(b) limits", diameters(), speeds, limits),
    ];
    let beyond = match outside {
        0 => String::new(),
        some => format!(" {} beyond {} left out.", count(some as u64, "limit"), speed(reach)),
    };
    let note = format!("{} {}{beyond}", answer(survey, all), head(survey));
    Figure::new(survey.scene.title.clone(), note, panels)
}
