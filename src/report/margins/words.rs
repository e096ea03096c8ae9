//! What text and picture say of margins in the same words.

use crate::report::CommandLine;
use crate::report::line::capital;
use crate::report::number::{count, rounded, short, speed, time, with_unit};
use rubscope_solver::scene::{ContactLaw, Scene, SolverKind};
use rubscope_solver::study::margins::{
    Band, Found, LimitName, Margins, Quantity, parameter,
};

/// A margin from which on it is told as a factor.
const FACTORS: f64 = 9.0;

/// The value of a limit with its unit, in so many digits.
#[must_use]
pub fn value(x: f64, digits: usize, quantity: Quantity) -> String {
    with_unit(x, digits, quantity.unit())
}

/// How far beyond a limit the scene is: in per cent, and as a factor where it is far
/// beyond.
#[must_use]
pub fn margin(part: f64) -> String {
    if part >= FACTORS {
        return format!("{} times", short(rounded(1.0 + part, 4)));
    }
    let percent = 100.0 * part;
    if percent.abs() < 99.95 { format!("{percent:+.1} %") } else { format!("{percent:+.0} %") }
}

/// Where a pulse is beside a band: inside it, or how far from its beginning.
#[must_use]
pub fn place(band: &Band, pulse: Option<f64>) -> String {
    match pulse {
        Some(pulse) if band.holds(pulse) => "inside".to_string(),
        Some(pulse) => margin(pulse / band.from_n - 1.0),
        None => String::new(),
    }
}

/// A change in per cent, of one per cent of a parameter.
#[must_use]
pub fn change(by: f64) -> String {
    if (0.095..99.995).contains(&by.abs()) {
        return format!("{by:+.2} %");
    }
    let digits = if by.abs() < 1.0 { 2 } else { 4 };
    let sign = if by < 0.0 { "" } else { "+" };
    format!("{sign}{} %", short(rounded(by, digits)))
}

/// Speed, pulse, law and solver of the scene.
#[must_use]
pub fn conditions(margins: &Margins) -> String {
    let (operation, solver) = (&margins.scene.operation, &margins.scene.solver);
    format!(
        "{}, pulse of {} for {}, {}; {} law, {} solver, {} model.",
        speed(operation.speed_rad_s),
        value(operation.pulse_n, 6, Quantity::Pulse),
        time(operation.pulse_s),
        count(u64::from(operation.nodal_diameters), "nodal diameter"),
        solver.contact,
        solver.kind,
        solver.model,
    )
}

/// What the closed forms are of, where the scene asks for more.
#[must_use]
pub fn note(margins: &Margins) -> Option<String> {
    let tuned = margins.note.as_ref().map(|note| format!("Speeds and loads are {note}."));
    let modes = margins.scene.modes_note().map(|note| format!("{}.", capital(&note)));
    let notes: Vec<String> = modes.into_iter().chain(tuned).collect();
    (!notes.is_empty()).then(|| notes.join(" "))
}

/// The parameter that puts a limit where it is wanted, in a sentence.
#[must_use]
pub fn target(found: &Found, margins: &Margins) -> String {
    let Found { name, by, .. } = *found;
    let (quantity, unit) = (name.quantity(), parameter(by).map_or("", |by| by.unit()));
    let unit = if unit == "-" { "" } else { unit };
    let wanted = value(found.wanted, 6, quantity);
    let parameter = |x: f64| format!("{} {unit}", short(x)).trim_end().to_string();
    let Some(to) = found.to else {
        let [least, most] = found.tried.map(parameter);
        if found.tried[0] == found.tried[1] {
            return format!(
                "No value of {by} was found for {name}: it could not be followed from that of the scene, {least}."
            );
        }
        let met = match found.met {
            Some([least, most]) if least == most => "it does not depend on it".to_string(),
            Some([least, most]) => {
                format!(
                    "it goes from {} to {}",
                    value(least, 6, quantity),
                    value(most, 6, quantity)
                )
            }
            None => "there is no such limit with any of them".to_string(),
        };
        return format!("No value of {by} from {least} to {most} puts {name} at {wanted}: {met}.");
    };
    let before = margins.limit(name).and_then(|limit| limit.value);
    let gives = match before {
        Some(before) => format!("{} gives {}", parameter(found.from), value(before, 6, quantity)),
        None => format!("the scene has {}", parameter(found.from)),
    };
    format!("{by} = {} puts {name} at {wanted} ({gives}).", parameter(to))
}

/// The command that shows the limit with the parameter found, by another way than the
/// one that found it where there is one; none where no parameter was found.
#[must_use]
pub fn check(found: &Found, scene: &Scene) -> Option<CommandLine> {
    let (to, reached) = found.to.zip(found.reached)?;
    let mut changed = parameter(found.by)?.set(scene, to).ok()?;
    let law = found.name.law(scene.solver.contact);
    if found.name.quantity() == Quantity::Pulse {
        changed.operation.pulse_n = reached * BEYOND;
        if let Some(law) = law {
            changed.solver.contact = law;
            // It knows both laws; the event solver knows one.
            changed.solver.kind = SolverKind::Explicit;
        }
        // As the limit was sought, where the event solver knows the scene.
        let by_events = law != Some(ContactLaw::Bilateral);
        if let Some(checked) = changed.clone().checked().ok().filter(|_| by_events)
            && let Ok(reference) = checked.as_reference().checked()
        {
            changed = reference.into_scene();
        }
        return Some(CommandLine::new("run", &changed));
    }
    let hbm = CommandLine::new("hbm", &changed);
    let speed = changed.operation.speed_rad_s;
    Some(match found.name {
        LimitName::OmegaLock | LimitName::LockEnds if changed.lining().is_some() => {
            hbm.option("--speed", speed).flag("--smooth", true)
        }
        LimitName::OmegaC | LimitName::OmegaLock | LimitName::LockEnds | LimitName::Coincidence => {
            hbm
        }
        LimitName::OmegaAdhesive => hbm.flag("--json", true),
        LimitName::Torque | LimitName::Power => hbm.option("--speed", speed).flag("--json", true),
        LimitName::CoincidenceDifference => hbm.flag("--campbell", true),
        LimitName::WhirlOnset | LimitName::FlutterSpeed => {
            hbm.option("--speed", speed).flag("--whirl", true)
        }
        LimitName::LockFold => hbm.option("--speed", format!("0:{reached}:2")).flag("--fold", true),
        LimitName::LockEnergy => CommandLine::new("margins", &changed).flag("--no-search", true),
        _ => hbm.option("--speed", speed),
    })
}

/// How far beyond the smallest pulse a run is shown: at the edge itself round-off
/// decides.
const BEYOND: f64 = 1.001;

/// What the answer took.
#[must_use]
pub fn cost(margins: &Margins) -> String {
    let cost = &margins.cost;
    let wall = |seconds: f64| time(rounded(seconds, 2));
    let search = match cost.search_wall_s {
        Some(seconds) => {
            format!("lasting pulses {}, {}", wall(seconds), count(cost.search_runs, "run"))
        }
        None => "lasting pulses not searched".to_string(),
    };
    format!("Cost: closed forms and the touching pulse {}; {search}.", wall(cost.wall_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn margins_and_changes_have_the_digits_that_are_known() {
        for (part, told) in [
            (0.0, "+0.0 %"),
            (-0.1234, "-12.3 %"),
            (0.9994, "+99.9 %"),
            (-0.9996, "-100 %"),
            (8.99, "+899 %"),
            (9.0, "10 times"),
            (262.5, "263.5 times"),
        ] {
            assert_eq!(margin(part), told);
        }
        for (by, told) in [
            (0.333, "+0.33 %"),
            (-0.5, "-0.50 %"),
            (0.01234, "+0.012 %"),
            (-0.01234, "-0.012 %"),
            (99.99, "+99.99 %"),
            (1234.56, "+1235 %"),
            (-1234.56, "-1235 %"),
        ] {
            assert_eq!(change(by), told);
        }
    }

    #[test]
    fn a_pulse_is_shown_under_its_law_and_by_its_solver() {
        let events = "--set solver.kind=event";
        let unilateral = "--set solver.contact=unilateral";
        let bilateral = "--set solver.contact=bilateral";
        // The first scene is of the explicit solver and the bilateral law, the other
        // of the event solver and the unilateral law.
        for (scene, name, has, has_not) in [
            ("paper-nd3", LimitName::TouchingPulse, &[events, unilateral][..], &[bilateral][..]),
            ("paper-nd3", LimitName::LastingPulse, &[], &[events, unilateral]),
            ("paper-nd3", LimitName::LastingPulseUnilateral, &[events, unilateral], &[]),
            ("slip", LimitName::LastingPulse, &[], &[bilateral, "solver.kind"]),
            ("slip", LimitName::LastingPulseBilateral, &[bilateral], &[unilateral]),
        ] {
            let found = Found {
                name,
                wanted: 1e5,
                by: "casing.damping_ratio",
                from: 0.01,
                to: Some(0.02),
                reached: Some(1e5),
                met: None,
                tried: [0.01, 0.02],
            };
            let told = check(&found, &Scene::builtin(scene).unwrap()).unwrap().to_string();
            assert!(told.starts_with(&format!("rubscope run {scene} ")), "{told}");
            assert!(told.contains("casing.damping_ratio=0.02"), "{told}");
            assert!(has.iter().all(|words| told.contains(words)), "{name}: {told}");
            assert!(!has_not.iter().any(|words| told.contains(words)), "{name}: {told}");
        }
    }
}
