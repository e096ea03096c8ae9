//! The sheet of a run: its summary in text, one fact a line, `rubscope.run/1` in JSON, and the
//! history.

use serde_json::{Value, json};

use super::line::{blades, capital};
use super::number::Digits;
use super::number::{count, grouped, rounded, short, speed, time, with_unit};
use super::sentence::Facts;
use super::{CommandLine, History, Sheet, Wall};
use rubscope_solver::harmonic::lock_window;
use rubscope_solver::model::Machine;
use rubscope_solver::motion::{Basis, Contact, Proof, RunReport};
use rubscope_solver::scene::{ContactLaw, Scene, SolverKind};

/// The inputs that are changed to test whether a run is sensitive, as the end of a phrase.
pub(super) const OF_WHAT: &str = "of the pulse, the speed or the motion";

/// Number of impacts that are listed one by one, the first of the run; the others are counted.
const IMPACTS_TOLD: usize = 4;

/// Largest number of groups in contact at the end that are listed one by one; more are summarised.
const CONTACTS_TOLD: usize = 4;
/// Penetration, relative to the clearance, up to which it counts as round-off: closing a gap in
/// double precision may leave a few hundred units in the last place.
const ROUND_OFF: f64 = 1e-13;

/// Returns the sheet of a run with its wall times, the `changes` made during the run, as text and as
/// JSON, and the samples for files. `command` reproduces it.
pub fn sheet<'a>(
    report: &RunReport,
    wall: Wall,
    (words, changes): (String, Vec<Value>),
    history: &'a History,
    command: CommandLine,
) -> Sheet<'a> {
    let mut sheet = Sheet::new("run", 1, command.clone(), &report.scene);
    let headline = Facts::of(report);
    let mut fields = json!(report);
    fields["solver"]["wall_s"] = json!(wall.run_s);
    fields["solver"]["certainty_s"] = json!(wall.certainty_s);
    let [state, _] = headline.forms();
    fields["outcome"]["state"] = match headline.is_of_this_step() {
        true => json!(format!("{}. {state}", capital(&verdict(&headline)))),
        false => json!(state),
    };
    fields["outcome"]["history"] = json!(headline.sentence(usize::MAX).history);
    if let Some(growth) = headline.growth {
        fields["outcome"]["growth_1_s"] = json!(growth);
    }
    sheet.facts(&fields);
    if let Some(note) = report.scene.share_note() {
        sheet.fact("notes", [note]);
    }
    lines(report, wall, &headline, command).into_iter().for_each(|line| sheet.line(line));
    if !changes.is_empty() {
        sheet.line(format!("Changed during the run: {words}."));
        sheet.fact("changes", changes);
    }
    sheet.filed(None, history.table());
    sheet.chart("casing [m]", &[["u_c_m", "u_c"], ["u_s_m", "u_s"]]);
    sheet.chart("smallest gap [m]", &[["gap_min_m", "gap"]]);
    sheet.chart(
        "multiplier [N]",
        &[["multiplier_min_n", "smallest"], ["multiplier_max_n", "largest"]],
    );
    sheet
}

/// Returns the summary as text, one fact a line; `command` is that of the run.
pub fn lines(report: &RunReport, wall: Wall, facts: &Facts, command: CommandLine) -> Vec<String> {
    let (scene, machine) = (&report.scene, report.scene.machine());
    let mut lines = Vec::new();
    if !scene.title.is_empty() {
        lines.push(scene.title.clone());
    }
    let mut conditions = conditions(scene);
    if report.solver.kind == SolverKind::Explicit {
        conditions += &format!(", step {}", time(scene.solver.step_s));
    }
    if scene.excitation.amplitude_nm > 0.0 {
        let torque = short(scene.excitation.amplitude_nm);
        let order = scene.excitation.order;
        conditions += &format!("; engine order {order} with {torque} N m on each blade");
    }
    lines.push(format!("{conditions}; simulated to {}.", time(scene.solver.end_s)));
    let notes = scene.modes_note().into_iter().chain(scene.start_note());
    let notes = notes.chain(scene.share_note().map(String::from));
    lines.extend(notes.map(|note| format!("{}.", capital(&note))));
    if report.solver.blades_follow {
        lines.push("Very stiff blades are solved as rigid.".into());
    }
    if report.solver.linearised {
        lines.push("Blade angles in the phase of the gap are neglected (linearised).".into());
    }
    lines.push(String::new());
    let [state, _] = facts.forms();
    lines.push(format!("Verdict: {}. {state}", verdict(facts)));
    lines.extend(facts.sentence(usize::MAX).history);
    lines.extend(report.outcome.message.as_ref().map(|message| format!("Reason: {message}.")));
    let outcome = &report.outcome;
    let doubtful = outcome.sensitive == Some(true)
        || outcome.depends_on_step == Some(true)
        || outcome.by_events.is_some();
    if doubtful && report.solver.steps_skipped.is_some_and(|skipped| skipped > 0) {
        let audit = command.flag("--plain", true);
        lines.push(format!("To audit this run, take each of its steps: {audit}"));
    }
    if let Some(t_s) = report.impacts_in_one_step_at_s {
        lines.push(format!("They hit at {}; ask --solver event which comes first.", time(t_s)));
    }
    lines.push(String::new());
    lines.extend(motion(report, &machine));
    lines.push(String::new());
    lines.extend(checks(report, &machine));
    lines.push(cost(report, wall));
    lines
}

/// Returns the verdict as a word, or as `locked at this step only` where another step changes it.
fn verdict(facts: &Facts) -> String {
    let only = if facts.is_of_this_step() { " at this step only" } else { "" };
    format!("{}{only}", facts.verdict)
}

/// Describes the speed, the pulse, the contact law, the solver and the model of a scene.
pub(super) fn conditions(scene: &Scene) -> String {
    let (operation, solver) = (&scene.operation, &scene.solver);
    format!(
        "{}, pulse of {} for {}, {}; {} law, {} solver, {} model",
        speed(operation.speed_rad_s),
        with_unit(operation.pulse_n, 6, "N"),
        time(operation.pulse_s),
        count(u64::from(operation.nodal_diameters), "nodal diameter"),
        solver.contact,
        solver.kind,
        solver.model,
    )
}

/// Describes the evidence for the verdict: a proof, or the interval of the run that was judged. A
/// proof of a run whose verdict another step changes is one of its steps.
fn basis(basis: Basis, of_this_step: bool) -> String {
    let verdict = if of_this_step { "At this step the verdict" } else { "The verdict" };
    match basis {
        Basis::Proved { by: Proof::NoContact, since_s } => {
            let since = time(since_s);
            format!("{verdict} is proved: no blade has touched since {since}, and none can.")
        }
        Basis::Proved { by: Proof::HeldCorner, since_s } => format!(
            "{verdict} is proved: the forces of the blades that hold the wave since {} cannot \
             change their sign.",
            time(since_s)
        ),
        Basis::Judged { from_s, to_s } => {
            format!("The verdict is judged by the motion from {} to {}.", time(from_s), time(to_s))
        }
    }
}

fn motion(report: &RunReport, machine: &Machine) -> Vec<String> {
    let outcome = &report.outcome;
    let (spread, digits) = (outcome.spread.as_ref(), Digits::of(outcome.spread.is_some()));
    let mut lines = Vec::new();
    if let Some(since) = outcome.lock_time_s {
        let since = digits.shown(since, spread.and_then(|spread| spread.lock_time_s), time);
        lines.push(format!("Held by the same blades since {since}."));
    }
    let moved = |group: usize| *spread?.multipliers_n.get(group)?;
    let contacts = outcome.contacts.iter().cloned().enumerate();
    let mut contacts: Vec<(Contact, Option<f64>)> =
        contacts.map(|(group, contact)| (contact, moved(group))).collect();
    if contacts.len() > CONTACTS_TOLD {
        let multiplier_n = contacts.iter().map(|(contact, _)| contact.multiplier_n).sum();
        let moved = contacts.iter().map(|(_, moved)| *moved).sum();
        let blades = contacts.into_iter().flat_map(|(contact, _)| contact.blades).collect();
        contacts = vec![(Contact { blades, multiplier_n }, moved)];
    }
    lines.extend(contacts.iter().map(|(contact, moved)| touch(contact, *moved, &digits)));
    let (length, moved) = (outcome.amplitude_m, spread.and_then(|spread| spread.amplitude_m));
    let g0 = machine.clearance().abs();
    let part = digits.shown(length / g0, moved.map(|moved| moved / g0), short);
    lines.push(format!(
        "Amplitude of the casing wave at the end: {} m, {part} of the {}.",
        digits.shown(length, moved, short),
        room(machine)
    ));
    if let Some(wave) = outcome.wave_speed_rad_s {
        let wave = digits.shown(wave, spread.and_then(|spread| spread.wave_speed_rad_s), speed);
        lines.push(format!("The wave turns at {wave}."));
    }
    lines.extend(digits.note().map(String::from));
    lines.extend(
        outcome.basis.map(|evidence| basis(evidence, outcome.depends_on_step == Some(true))),
    );
    if let Some(rate) = outcome.decay_rate_per_s.filter(|rate| *rate != 0.0) {
        let does = if rate < 0.0 { "grows" } else { "decays" };
        lines.push(format!("The wave {does} at {} 1/s.", short(rate.abs())));
    }
    lines.push(speeds(report, machine));
    if let Some(dangerous) = machine.coincidence_felt_at(report.end_speed_rad_s) {
        lines.push(format!("Dangerous coincidence speed: {}.", speed(dangerous)));
    }
    lines.push(impacts(report));
    lines
}

/// Names the length that penetrations are compared with: a negative clearance is an interference.
fn room(machine: &Machine) -> &'static str {
    if machine.clearance() < 0.0 { "interference" } else { "clearance" }
}

/// Describes the force of a group of blades; `moved` is the deviation of the force in changed runs.
fn touch(contact: &Contact, moved: Option<f64>, digits: &Digits) -> String {
    let [one, several] = match contact.multiplier_n > 0.0 {
        true => ["pulls", "together pull"],
        false => ["pushes", "together push"],
    };
    let does = if contact.blades.len() == 1 { one } else { several };
    let force = digits.shown(contact.multiplier_n.abs(), moved, short);
    format!("{} {does} with {force} N at the end.", capital(&blades(&contact.blades)))
}

/// Compares the rotor speed at the end of the run with the critical speed and the lock speed, where
/// these exist.
fn speeds(report: &RunReport, machine: &Machine) -> String {
    let now = report.end_speed_rad_s;
    let lock = lock_window(machine, now);
    let at_end = if now == report.scene.operation.speed_rad_s { "" } else { " at the end" };
    let part_of = |name: &str, threshold: f64| {
        format!("{} of {name} ({})", short(now.abs() / threshold), speed(threshold))
    };
    let mut parts = vec![format!("Rotor speed{at_end}: {}", speed(now))];
    parts.extend(machine.critical_speed().map(|critical| part_of("Omega_c", critical)));
    if let Some(lock) = lock.filter(|lock| lock.from > 0.0) {
        // On a lining, groups of more blades may lock at other speeds.
        let groups = if machine.lining.is_some() { " of two groups" } else { "" };
        parts.push(part_of(&format!("Omega_lock{groups}"), lock.from));
        parts.extend(lock.to.map(|to| format!("locks{groups} end at {}", speed(to))));
    }
    format!("{}.", parts.join(", "))
}

fn impacts(report: &RunReport) -> String {
    if report.impact_count == 0 {
        return "No impact.".to_string();
    }
    let told = report.impacts.iter().take(IMPACTS_TOLD);
    let told: Vec<String> =
        told.map(|hit| format!("{} at {}", blades(&hit.blades), time(hit.t_s))).collect();
    let start = if told.len() as u64 == report.impact_count { "" } else { "the first ones " };
    let (least, series) = match report.impacts_accumulate_at_s {
        Some(t_s) => {
            let from = time(rounded(t_s, 6));
            ("At least ", format!(" From {from} on they accumulate: infinitely many."))
        }
        None => ("", String::new()),
    };
    let counted = count(report.impact_count, "impact");
    format!("{least}{counted}: {start}{}.{series}", told.join("; "))
}

fn checks(report: &RunReport, machine: &Machine) -> Vec<String> {
    let checks = &report.checks;
    let smooth = report.solver.contact == ContactLaw::Smooth;
    let name = if smooth { "Deepest in the lining" } else { "Deepest penetration" };
    let mut lines = Vec::new();
    if checks.max_penetration_m < ROUND_OFF * machine.clearance().abs() {
        lines.push(format!("{name}: none beyond round-off."));
    } else {
        let deepest = short(checks.max_penetration_m);
        let part = short(checks.max_penetration_m / machine.clearance().abs());
        lines.push(format!("{name}: {deepest} m, {part} of the {}.", room(machine)));
    }
    if let Some(predicted) = checks.max_predicted_penetration_m {
        let predicted = short(predicted);
        lines.push(format!("Deepest penetration predicted before correction: {predicted} m."));
    }
    lines.push(format!("Steps with a pulling multiplier: {}.", checks.tensile_steps));
    lines.push(format!("Blade angle: at most {} rad.", short(checks.max_blade_angle_rad)));
    if let Some(residual) = checks.energy_residual_j {
        lines.push(format!("Energy not accounted for: {} J.", short(residual)));
    }
    lines
}

fn cost(report: &RunReport, wall: Wall) -> String {
    let work = match report.solver.steps.zip(report.solver.steps_skipped) {
        Some((taken, skipped)) => {
            format!("{} taken, {} skipped", count(taken, "step"), grouped(skipped))
        }
        None => count(report.solver.events.unwrap_or(0), "event"),
    };
    let certainty = wall.certainty_s.map_or(String::new(), |s| format!(", certainty {}", time(s)));
    format!("Cost: {work}; run {}{certainty}.", time(wall.run_s))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn blades_push_or_pull_in_groups() {
        let touch = |blades: &[u32], multiplier_n| {
            super::touch(&Contact { blades: blades.into(), multiplier_n }, None, &Digits::default())
        };
        assert_eq!(touch(&[6], -244.416), "Blade 6 pushes with 244.416 N at the end.");
        assert_eq!(touch(&[6, 17], 3.0), "Blades 6 and 17 together pull with 3 N at the end.");
    }
}
