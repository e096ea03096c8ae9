//! Wording of margins shared by text and picture.

use crate::sheet::CommandLine;
use crate::sheet::line::capital;
use crate::sheet::number::{rounded, short, with_unit};
use crate::sheet::table::TableCell;
use rubscope_solver::scene::Scene;
use rubscope_solver::study::margins::{
    Found, LimitName, MOST_TIMES, Margins, Quantity, changed, line, parameter,
};

/// Relative change above which the ratio of both values is shown (`10 x`) instead of per cent.
const FACTORS: f64 = 9.0;

/// Formats the change from a value of the scene to another one, as a part of the former: in per
/// cent, or as the ratio of both if it is large.
pub fn from_here(part: f64) -> String {
    if part > MOST_TIMES {
        return format!("> {} x", 1.0 + MOST_TIMES);
    }
    if part >= FACTORS {
        return format!("{} x", short(rounded(1.0 + part, 4)));
    }
    let percent = 100.0 * part;
    if percent.abs() < 99.95 { format!("{percent:+.1} %") } else { format!("{percent:+.0} %") }
}

/// Formats the change from the value of the scene to a limit with the margin `part`, which is that
/// value as a part of the limit, less one. A dash if the scene has a value of zero.
pub fn to_limit(part: f64) -> String {
    if part == -1.0 { "-".into() } else { from_here(1.0 / (1.0 + part) - 1.0) }
}

/// Returns a margin as a cell: on the screen as the change from here to the limit, in files as it
/// is, empty if it is above `MOST_TIMES`. `None` gives an empty cell.
pub fn margin_cell(part: Option<f64>) -> TableCell {
    let filed = |part: f64| if part > MOST_TIMES { f64::NAN } else { part };
    part.map(|part| TableCell::told(filed(part), to_limit(part))).unwrap_or_default()
}

/// Formats the change of a limit, in per cent, for a change of one per cent of a parameter.
pub fn change(by: f64) -> String {
    if (0.095..99.995).contains(&by.abs()) {
        return format!("{by:+.2} %");
    }
    let digits = if by.abs() < 1.0 { 2 } else { 4 };
    let sign = if by < 0.0 { "" } else { "+" };
    format!("{sign}{} %", short(rounded(by, digits)))
}

/// Returns the notes on the modes of the scene and on what its closed-form limits ignore; empty if
/// there are none.
pub fn note(margins: &Margins) -> String {
    let tuned = margins.note.as_ref().map(|note| format!("Speeds and loads are {note}."));
    let modes = margins.scene.modes_note().map(|note| format!("{}.", capital(&note)));
    modes.into_iter().chain(tuned).collect::<Vec<_>>().join(" ")
}

/// Returns the answer to `--target` as a sentence: the parameter value at which the limit has the
/// wanted value, or why none was found.
pub fn target(found: &Found, margins: &Margins) -> String {
    let Found { name, by, .. } = *found;
    let key = parameter(by).ok();
    let (of_limit, unit) = (name.quantity().unit(), key.map_or("", |by| by.unit));
    let unit = if unit == "-" { "" } else { unit };
    let wanted = with_unit(found.wanted, 6, of_limit);
    let parameter = |x: f64| format!("{} {unit}", short(x)).trim_end().to_string();
    let Some(to) = found.to else {
        let [least, most] = found.tried.map(parameter);
        if found.tried[0] == found.tried[1] {
            return format!(
                "No value of {by} was found for {name}: it could not be followed from that of the scene, {least}."
            );
        }
        let met = match found.met.map(|ends| ends.map(|end| with_unit(end, 6, of_limit))) {
            Some([least, most]) if least == most => "it does not depend on it".to_string(),
            Some([least, most]) => format!("it goes from {least} to {most}"),
            None => "there is no such limit with any of them".to_string(),
        };
        return format!("No value of {by} from {least} to {most} puts {name} at {wanted}: {met}.");
    };
    let before = margins.limit(name).and_then(|limit| limit.value);
    let gives = match before {
        Some(before) => {
            format!("{} gives {}", parameter(found.from), with_unit(before, 6, of_limit))
        }
        None => format!("the scene has {}", parameter(found.from)),
    };
    let line = key.and_then(|by| line(by, &margins.scene, to));
    let line = line.map_or(String::new(), |line| format!(" In the scene file: {line}."));
    format!("{by} = {} puts {name} at {wanted} ({gives}).{line}", parameter(to))
}

/// Returns a command that verifies the found parameter, with another solver than found it if
/// possible; `None` if no value was found.
pub fn check(found: &Found, scene: &Scene) -> Option<CommandLine> {
    let (to, reached) = found.to.zip(found.reached)?;
    let mut changed = changed(parameter(found.by).ok()?, scene, to).ok()?;
    if found.name.quantity() == Quantity::Pulse {
        changed.operation.pulse_n = reached * BEYOND;
        // The touching pulse is exact; the event solver confirms it exactly where it applies.
        if let Ok(checked) = changed.clone().checked()
            && let Ok(reference) = checked.as_reference().checked()
        {
            changed = reference.into_scene();
        }
        return Some(CommandLine::new("run", &changed));
    }
    let view = match found.name {
        LimitName::OmegaLock | LimitName::LockEnds if changed.lining().is_some() => "--smooth",
        LimitName::CoincidenceDifference => "--campbell",
        LimitName::WhirlOnset | LimitName::FlutterSpeed => "--whirl",
        LimitName::OmegaAdhesive | LimitName::Torque | LimitName::Power => "--json",
        _ => "",
    };
    let hbm = CommandLine::new("hbm", &changed).option("--speed", changed.operation.speed_rad_s);
    Some(hbm.flag(view, !view.is_empty()))
}

/// The verifying run uses this multiple of the smallest pulse: at the limit itself, round-off
/// decides.
const BEYOND: f64 = 1.001;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_and_sensitivities_have_the_digits_that_are_known() {
        for (part, told) in [
            (0.0, "+0.0 %"),
            (-0.1234, "-12.3 %"),
            (0.9994, "+99.9 %"),
            (-0.9996, "-100 %"),
            (8.99, "+899 %"),
            (9.0, "10 x"),
            (98.5, "99.5 x"),
            (262.5, "> 100 x"),
        ] {
            assert_eq!(from_here(part), told);
        }
        for (margin, told) in [(0.25, "-20.0 %"), (-0.5, "+100 %"), (-0.95, "20 x"), (-1.0, "-")] {
            assert_eq!(to_limit(margin), told);
        }
        for (by, told) in [
            (0.333, "+0.33 %"),
            (-0.5, "-0.50 %"),
            (0.01234, "+0.012 %"),
            (-0.01234, "-0.012 %"),
            (99.99, "+99.99 %"),
            (100.0, "+100 %"),
            (-100.0, "-100 %"),
        ] {
            assert_eq!(change(by), told);
        }
    }
}
