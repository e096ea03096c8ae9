//! The survey of all numbers of diameters: aligned text for people, a table of every limit
//! (CSV), and the interference chart (SVG).

use std::borrow::Cow;
use std::f64::consts::TAU;
use std::io::{Result, Write};

use super::line::{capital, wrapped};
use super::margins::words;
use super::number::{count, per_speed, rounded, short, speed, speed_unit, time};
use super::symbols::symbol;
use super::table::{Heading, Table, TableCell, WIDTH};
use rubscope_solver::scene::Scene;
use rubscope_solver::study::figures::{Figure, Panel, Quantity, Series, Style};
use rubscope_solver::study::margins::{LimitName, Quantity as Kind};
use rubscope_solver::study::survey::{Scattered, Survey, SurveyLimit, SurveyRow};

/// Most rows of the text where every number of diameters has one.
const ROWS: usize = 64;
/// Most of the nearest limits that are listed.
const NEAREST: usize = 16;

/// The limits with their letter on a chart and their heading, the most important first.
pub const LIMITS: [(LimitName, char, &str); 10] = [
    (LimitName::OmegaC, 'c', "Omega_c"),
    (LimitName::OmegaLock, 'L', "Omega_lock"),
    (LimitName::Coincidence, 'x', "sum (31)"),
    (LimitName::LockEnds, 'e', "ends"),
    (LimitName::WhirlOnset, 'w', "whirl"),
    (LimitName::FlutterSpeed, 'f', "flutter"),
    (LimitName::OmegaAdhesive, 'a', "adhesive"),
    (LimitName::CoincidenceDifference, 'd', "diff (30)"),
    (LimitName::LockFold, 'g', "gives way"),
    (LimitName::FirstTouch, 't', "touches"),
];

/// Returns the limits that any number of diameters has.
pub fn present(survey: &Survey) -> impl Iterator<Item = &'static (LimitName, char, &'static str)> {
    let names = survey.names();
    LIMITS.iter().filter(move |(name, ..)| names.contains(name))
}

/// Every limit, one row each; a number of diameters without any has one row, too.
#[must_use]
pub fn table(survey: &Survey) -> Table {
    let mut table = Table::new([
        "nodal_diameters",
        "omega_c_rad_s",
        "omega_bd_rad_s",
        "name",
        "value_rad_s",
        "margin",
        "in_range",
        "by",
    ]);
    for row in &survey.rows {
        let own = [
            f64::from(row.nodal_diameters).into(),
            row.omega_c_rad_s.into(),
            row.omega_bd_rad_s.into(),
        ];
        if row.limits.is_empty() {
            table.push(own.to_vec());
        }
        for limit in &row.limits {
            let of_limit = [
                limit.name.to_string().into(),
                limit.value.into(),
                words::margin_cell(limit.margin),
                limit.in_range.into(),
                limit.by.into(),
            ];
            table.push(own.iter().cloned().chain(of_limit).collect());
        }
    }
    table
}

/// Writes the survey for people.
///
/// # Errors
/// An error of the writer.
pub fn write(survey: &Survey, out: &mut dyn Write) -> Result<()> {
    let scene = &survey.scene;
    let mut tell =
        |text: &str| wrapped(text, WIDTH).iter().try_for_each(|line| writeln!(out, "{line}"));
    tell(&scene.title)?;
    tell(&head(survey))?;
    if let Some(which) = unknown(survey) {
        tell(&format!(
            "Numbers of diameters with ? have no mode in the scene, and the own values of casing or \
             disk; they are not in the list below: {which}."
        ))?;
    }
    survey.note.iter().try_for_each(|note| tell(&format!("The limits are {note}.")))?;
    survey.scattered.iter().try_for_each(|scattered| tell(&of_scatter(scene, scattered)))?;
    if survey.rows.len() > 1 {
        tell("One nodal diameter also moves the shaft, which this model does not have.")?;
    }
    writeln!(out)?;
    shown(survey).write_text(out)?;
    writeln!(out)?;
    nearest(survey, out)?;
    writeln!(out)?;
    writeln!(out, "Computed in {}.", time(rounded(survey.wall_s, 2)))
}

/// What the limits are of, and what tips that differ do to the lock.
#[must_use]
pub fn of_scatter(scene: &Scene, scattered: &Scattered) -> String {
    let [mean, equal] = [scattered.mean_rad_s, scattered.equal_rad_s].map(|x| speed(rounded(x, 4)));
    let of = match scene.is_uneven() {
        true => "the tips and the casing of the scene. Equal tips in a round one lock last",
        false => "equal tips and a round casing, which lock last",
    };
    format!(
        "The limits are those of {of}: tips that differ by 1 % of the clearance lock from {mean} \
         on, the mean of {} rotors, and not from {equal}.",
        scattered.rotors
    )
}

/// The numbers of diameters without a mode in the scene.
fn unknown(survey: &Survey) -> Option<String> {
    let without = survey.rows.iter().filter(|row| !row.modes_known);
    let all: Vec<String> = without.map(|row| row.nodal_diameters.to_string()).collect();
    let last = all.last()?;
    let many = all.len() > 12;
    Some(if many { format!("{} of them, up to {last}", all.len()) } else { all.join(", ") })
}

/// The machine and the range in a few sentences.
#[must_use]
pub fn head(survey: &Survey) -> String {
    let asked = match survey.range_rad_s {
        Some([from, to]) => {
            let other = if speed_unit() == "rpm" { String::new() } else { in_rpm([from, to]) };
            format!("* marks what lies from {} to {}{other}.", speed(from), speed(to))
        }
        None => "Without --range nothing is marked.".to_string(),
    };
    format!(
        "{}; speeds in {}, frequencies in Hz. {asked} {}",
        machine(survey),
        speed_unit(),
        sense(survey)
    )
}

fn machine(survey: &Survey) -> String {
    let blades = survey.scene.bladed_disk.blades;
    format!("{blades} blades, 0 to {}", count(u64::from(blades / 2), "nodal diameter"))
}

/// What the speeds of the other sense are.
fn sense(survey: &Survey) -> String {
    let mirrored = survey.rows.iter().all(|row| {
        let back = row.limits.iter().filter(|limit| limit.value.is_sign_negative());
        back.into_iter().all(|limit| {
            row.limit(limit.name, true).is_some_and(|forward| forward.value == -limit.value)
        })
    });
    match (survey.is_forward(), mirrored) {
        (forward, true) => {
            let other = if forward { "backward" } else { "forward" };
            format!("The same speeds with the other sign are those of a rotor that turns {other}.")
        }
        (true, false) => "Speeds of a rotor that turns forward; --json has the others.".into(),
        (false, false) => "Speeds of a rotor that turns backward; --json has the others.".into(),
    }
}

fn in_rpm([from, to]: [f64; 2]) -> String {
    let turns = |omega: f64| short(omega * 60.0 / TAU);
    format!(" ({} to {} rpm)", turns(from), turns(to))
}

/// Returns the rows of the text: every number of diameters where they are few, or else those
/// with something in the range.
fn shown(survey: &Survey) -> Table {
    let inside = |row: &&SurveyRow| row.limits.iter().any(|limit| limit.in_range == Some(true));
    let few = survey.rows.len() <= ROWS;
    let mut found: Vec<&SurveyRow> = survey.rows.iter().filter(|row| few || inside(row)).collect();
    if found.is_empty() {
        found = survey.rows.iter().collect();
    }
    found.truncate(ROWS);
    let mut table = rows(survey, &found);
    let left = survey.rows.len() - found.len();
    if left > 0 {
        table.note(format!("and {left} more: --json or --out"));
    }
    table
}

/// Returns a row for each of these numbers of diameters: modes \[Hz\], and the limits of the
/// sense of rotation that is looked at.
#[must_use]
pub fn rows(survey: &Survey, shown: &[&SurveyRow]) -> Table {
    let limits: Vec<_> = present(survey).collect();
    let heads = ["n_d", "casing", "disk"].into_iter().chain(limits.iter().map(|limit| limit.2));
    let mut table = Table::new(heads.map(Heading::shown));
    let told = |x: f64, sign: &str| TableCell::Told(x, short(rounded(x, 5)) + sign);
    for row in shown {
        let here = row.nodal_diameters == survey.scene.operation.nodal_diameters;
        let (sign, known) = (if here { ">" } else { " " }, if row.modes_known { "" } else { "?" });
        let own = TableCell::Word(format!("{sign}{}{known}", row.nodal_diameters));
        let modes = [row.omega_c_rad_s, row.omega_bd_rad_s].map(|omega| told(omega / TAU, ""));
        let limits = limits.iter().map(|(name, ..)| {
            row.limit(*name, survey.is_forward()).map_or(TableCell::Empty, |limit| {
                let sign = if limit.in_range == Some(true) { "*" } else { "" };
                told(per_speed(limit.value.abs()), sign)
            })
        });
        table.push(std::iter::once(own).chain(modes).chain(limits).collect());
    }
    table
}

/// What lies in the range, the nearest to the scene first.
fn nearest(survey: &Survey, out: &mut dyn Write) -> Result<()> {
    let found = survey.nearest();
    let present = speed(survey.scene.operation.speed_rad_s);
    let what = match (survey.range_rad_s, found.len()) {
        (Some(_), 0) => return beside(survey, out),
        (Some(_), some) => format!("{} in the range", count(some as u64, "limit")),
        (None, _) => "Limits".to_string(),
    };
    writeln!(out, "{what}, the nearest to {present} first:")?;
    let by = survey.by.map(|path| format!("+1 % of {} moves it by", symbol(path)));
    let mut table = Table::new(
        ["n_d".into(), "limit".into(), "speed".into(), "now".to_string()].into_iter().chain(by),
    );
    for (diameters, limit) in found.iter().take(NEAREST) {
        table.push(line(*diameters, limit));
    }
    table.write_text(out)?;
    match found.len().saturating_sub(NEAREST) {
        0 => Ok(()),
        more => writeln!(out, "... and {more} more, see --json"),
    }
}

/// A limit of a number of diameters, in words.
fn line(diameters: u32, limit: &SurveyLimit) -> Vec<TableCell> {
    let margin = match limit.margin {
        None if limit.value == 0.0 => String::new(),
        margin => margin.map_or_else(|| "the other way round".into(), words::margin),
    };
    vec![
        diameters.to_string().into(),
        limit.name.to_string().into(),
        words::value(limit.value, 6, Kind::Speed).into(),
        margin.into(),
        limit.by.map_or_else(|| TableCell::from(""), |by| words::change(by).into()),
    ]
}

/// Nothing lies in the range: the nearest limits below and above it.
fn beside(survey: &Survey, out: &mut dyn Write) -> Result<()> {
    let Some([from, to]) = survey.range_rad_s else { return Ok(()) };
    let all = || {
        let of_row = |row: &SurveyRow| -> Vec<(u32, SurveyLimit)> {
            row.limits.iter().map(|limit| (row.nodal_diameters, limit.clone())).collect()
        };
        survey.rows.iter().filter(|row| row.modes_known).flat_map(of_row)
    };
    let below = all().filter(|(_, limit)| limit.value < from);
    let below = below.max_by(|a, b| a.1.value.total_cmp(&b.1.value));
    let above = all().filter(|(_, limit)| limit.value > to);
    let above = above.min_by(|a, b| a.1.value.total_cmp(&b.1.value));
    let told = |side: &str, found: &Option<(u32, SurveyLimit)>| match found {
        Some((diameters, limit)) => {
            let what = count(u64::from(*diameters), "diameter");
            format!("{side} it {} of {what} at {}", limit.name, speed(limit.value))
        }
        None => format!("none {side} it"),
    };
    let text = format!("{}; {}", told("below", &below), told("above", &above));
    writeln!(out, "No limit lies in the range: the nearest are {text}.")
}

/// Colour number of the lines, apart from those of the limits.
const INK: usize = 5;
/// How far beyond the range limits are drawn, as a part of it.
const BEYOND: f64 = 0.25;

/// The interference chart: frequencies and the lines `n_d Omega` over the numbers of
/// diameters, and below it the limits over them.
#[must_use]
pub fn figure(survey: &Survey) -> Figure {
    let rows = &survey.rows;
    let over = |of: fn(&SurveyRow) -> f64| {
        rows.iter().map(move |row| (f64::from(row.nodal_diameters), of(row)))
    };
    let present = survey.scene.operation.speed_rad_s.abs();
    let mut frequencies = vec![
        Series::new("casing ω_c", Style::Discs(0, 4), over(|row| row.omega_c_rad_s))
            .named("omega_c"),
        Series::new("disk ω_bd", Style::Discs(1, 4), over(|row| row.omega_bd_rad_s))
            .named("omega_bd"),
    ];
    let last = rows.last().map_or(0.0, |row| f64::from(row.nodal_diameters));
    let most =
        rows.iter().fold(0.0_f64, |most, row| most.max(row.omega_c_rad_s + row.omega_bd_rad_s));
    // A line goes as far as the frequencies do.
    let turning = |omega: f64| {
        let end = if omega > 0.0 { (most / omega).min(last) } else { last };
        [(0.0, 0.0), (end, end * omega)]
    };
    frequencies.push(
        Series::new(format!("n_d Ω at {}", speed(present)), Style::Line(INK), turning(present))
            .named("now"),
    );
    let mut limits = Vec::new();
    if let Some([from, to]) = survey.range_rad_s {
        for (end, name) in [(from, "from"), (to, "to")] {
            let label = format!("n_d Ω at {}", speed(end));
            let points = turning(end.abs());
            frequencies.push(Series::new(label, Style::Dashed(INK), points).named(name));
            let level = [(0.0, end), (last, end)];
            limits.push(
                Series::new(format!("{name} {}", speed(end)), Style::Dashed(INK), level)
                    .named(name),
            );
        }
    }
    limits.push(
        Series::new(
            format!("now {}", speed(survey.scene.operation.speed_rad_s)),
            Style::Line(INK),
            [0.0, last].map(|n| (n, survey.scene.operation.speed_rad_s)),
        )
        .named("now"),
    );
    for (colour, name) in survey.names().into_iter().enumerate() {
        let points = rows.iter().filter_map(|row| {
            let limit = row.limit(name, survey.is_forward())?;
            let shown = survey.range_rad_s.is_none_or(|[from, to]| {
                let more = BEYOND * (to - from);
                (from - more..=to + more).contains(&limit.value)
            });
            shown.then(|| (f64::from(row.nodal_diameters), limit.value))
        });
        let points: Vec<_> = points.collect();
        if !points.is_empty() {
            limits.push(
                Series::new(name.symbol(), Style::Discs(colour, 4), points).named(name.to_string()),
            );
        }
    }
    let diameters = || Quantity::new("nodal_diameters", "nodal diameters n_d", 1.0);
    let frequency = Quantity::new("omega_rad_s", "frequency [Hz]", 1.0 / TAU);
    let panels = vec![
        Panel::new("(a) frequencies", diameters(), frequency, frequencies),
        Panel::new("(b) limits", diameters(), speed_axis(), limits),
    ];
    let own = unknown(survey).map_or_else(String::new, |which| {
        format!(" With the own values of casing or disk, as the scene has no mode of it: {which}.")
    });
    let note = format!("{}.{own} {}", machine(survey), sense(survey));
    Figure::new(survey.scene.title.clone(), capital(&note), panels)
}

fn speed_axis() -> Quantity {
    let label = Cow::Owned(format!("rotor speed Ω [{}]", speed_unit()));
    Quantity { column: "speed_rad_s".into(), label, factor: per_speed(1.0), log: false }
}
