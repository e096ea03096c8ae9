//! Checks of combinations of values. The bounds of single keys are in `keys`.

use super::beyond;
use super::error::refuse_if;
use super::keys;
use super::units::{Quantity, UnitError};
use super::{ContactLaw, ModelSize, Scene, SceneError, SolverKind};
use crate::numeric::rounding::rounded;

/// Part of a step by which the end of a run may fall short of a whole number of steps by round-off.
/// With a smaller value a run could end one step early.
pub(crate) const STEP_ROUND_OFF: f64 = 1e-6;

/// Largest number of coordinate updates in an explicit run: minutes of computing if nothing is
/// skipped.
const MOST_UPDATES: f64 = 4e10;
/// Largest number of steps of an explicit run, whatever the model size.
const MOST_STEPS: f64 = 1e10;
/// Largest rotation of the wave relative to the blades in one step \[rad\].
const MOST_TURN: f64 = 0.5;
/// Factor on a bound that allows for round-off of a product or quotient.
const ROUND_OFF: f64 = 1.0 + 1e-12;

/// Rejects combinations of values that are meaningless or that the chosen solver does not support.
///
/// # Errors
/// Names the key of the first such combination.
pub(super) fn check(scene: &Scene) -> Result<(), SceneError> {
    clearance(scene)?;
    growth(scene)?;
    frequencies(scene)?;
    beyond::tips(scene)?;
    initial_state(scene)?;
    excitation(scene)?;
    beyond::check(scene)?;
    if !scene.view.speeds.is_empty() {
        speed_range(keys::VIEW_SPEEDS, &scene.view.speeds)?;
    }
    match scene.solver.kind {
        SolverKind::Explicit => explicit(scene),
        SolverKind::Event => event(scene),
    }
}

/// Reads `FROM:TO` as rotor speeds \[rad/s\]. Errors refer to the option or key `name`.
///
/// # Errors
/// The text has another form, an end is of another quantity, or the first end is not the lower one.
pub fn speed_range(name: &str, text: &str) -> Result<[f64; 2], SceneError> {
    let (range, rest) = read_ends(name, text, Quantity::Speed, SPEED_RANGE)?;
    let is_wrong = rest.is_some() || !is_speed_range(range);
    refuse_if(is_wrong, name, text, SPEED_RANGE).map(|()| range)
}

/// Reads the ends of `FROM:TO` as numbers of a quantity, and returns the text after a second colon.
/// Errors refer to the option or key `name`, of which `allowed` is the form in words. The caller
/// checks whether the ends are finite.
///
/// # Errors
/// The text has another form, or an end is not of this quantity.
pub fn read_ends<'a>(
    name: &str,
    text: &'a str,
    of: Quantity,
    allowed: &str,
) -> Result<([f64; 2], Option<&'a str>), SceneError> {
    let mut parts = text.splitn(3, ':');
    let mut end = || {
        let part = parts.next().ok_or(UnitError::NoNumber);
        let read = part.and_then(|part| of.read(part));
        read.map_err(|why| SceneError::not_read(name, text, why, allowed))
    };
    let ends = [end()?, end()?];
    Ok((ends, parts.next()))
}

/// Description of a range of speeds.
pub(crate) const SPEED_RANGE: &str =
    "FROM:TO, two speeds, the lower one first, such as 6000rpm:11000rpm";

/// Returns whether the first end of a range is the lower one, and both are finite.
pub(crate) fn is_speed_range([from, to]: [f64; 2]) -> bool {
    from < to && (to - from).is_finite()
}

fn clearance(scene: &Scene) -> Result<(), SceneError> {
    let (clearance, smooth) = (scene.clearance(), scene.solver.contact == ContactLaw::Smooth);
    let allowed = if smooth {
        "other than 0 (casing.radius_m less bladed_disk.blade_length_m)"
    } else {
        "above 0 (casing.radius_m less bladed_disk.blade_length_m), or any other than 0 with \
         solver.contact = \"smooth\", whose lining blades may press at rest"
    };
    let has_room = clearance > 0.0 || (smooth && clearance < 0.0);
    // Without the round-off of the difference.
    refuse_if(!has_room, keys::CLEARANCE, format!("{} m", rounded(clearance, 9)), allowed)
}

/// Rejects rigid contact if blade growth closes the clearance during the run.
fn growth(scene: &Scene) -> Result<(), SceneError> {
    let (loss, fastest) = (scene.casing.clearance_loss_m_s2, scene.fastest_rad_s());
    let rigid = scene.solver.contact != ContactLaw::Smooth;
    if !(rigid && loss != 0.0 && scene.machine().at(fastest).clearance() <= 0.0) {
        return Ok(());
    }
    let allowed = format!(
        "at most {:e}, so that a clearance is left at {fastest} rad/s, or any with \
         solver.contact = \"smooth\", whose lining blades may press",
        below(scene.clearance() / (fastest * fastest))
    );
    Err(SceneError::refused(keys::CLEARANCE_LOSS, format!("{loss:e}"), allowed))
}

/// Rejects frequencies whose squares overflow or underflow.
fn frequencies(scene: &Scene) -> Result<(), SceneError> {
    let machine = scene.machine();
    for (key, value, frequency) in [
        (keys::CASING_MASS, machine.casing_mass, machine.omega_c),
        (keys::BLADE_INERTIA, machine.blade_inertia, machine.omega_bd),
    ] {
        if !(1e-6..=1e15).contains(&frequency) {
            // Rounded away from the allowed range.
            let given = if frequency > 1.0 { up(frequency) } else { down(frequency) };
            let allowed =
                format!("one that gives a frequency from 1e-6 to 1e15 rad/s, not {given:e}");
            return Err(SceneError::refused(key, format!("{value:e}"), allowed));
        }
    }
    Ok(())
}

fn initial_state(scene: &Scene) -> Result<(), SceneError> {
    // A lining may be compressed at the start.
    if scene.solver.contact == ContactLaw::Smooth {
        return Ok(());
    }
    let machine = scene.machine();
    let (x, y) = scene.start();
    let gap = if machine.is_uneven() {
        let polygon = &machine.polygon;
        let gap = |blade: u32| {
            let side = polygon.side_of_blade(blade + 1);
            polygon.gap(side, x, y) + machine.uneven_at(blade, 0.0)
        };
        (0..polygon.blades).map(gap).fold(f64::INFINITY, f64::min)
    } else {
        machine.polygon.gap(machine.polygon.nearest_side(x, y), x, y)
    };
    // A computed point on a side may lie outside by round-off.
    if gap >= -1e-12 * machine.clearance() {
        return Ok(());
    }
    let deepest = down(gap);
    let deepest =
        format!("a casing position with every gap open; here the smallest is {deepest:e} m");
    Err(SceneError::refused(keys::INITIAL_U_C, format!("{x} with u_s = {y}"), deepest))
}

fn excitation(scene: &Scene) -> Result<(), SceneError> {
    let (amplitude, solver) = (scene.excitation.amplitude_nm, &scene.solver);
    let stands = solver.kind == SolverKind::Explicit && solver.model == ModelSize::Rigid;
    let allowed = "0 with solver.model = \"rigid\", whose blades do not move";
    refuse_if(stands && amplitude != 0.0, keys::EXCITATION, amplitude, allowed)
}

/// Rejects a step that is too long or too short. Each printed bound is itself accepted.
fn explicit(scene: &Scene) -> Result<(), SceneError> {
    let (step, end) = (scene.solver.step_s, scene.solver.end_s);
    let fastest = scene.fastest_rad_s();
    let turn = f64::from(scene.operation.nodal_diameters) * fastest;
    let stable = scene.stable_step();
    let is_stable = step < stable;
    let turns_little = turn * step <= MOST_TURN * ROUND_OFF;
    let most_steps = most_steps(scene);
    let is_affordable = end / step <= most_steps * ROUND_OFF;
    if is_stable && turns_little && is_affordable {
        return one_step(step, end);
    }
    let refused = |allowed: String| SceneError::refused(keys::STEP, format!("{step:e}"), allowed);
    let (most, least) = (below(stable).min(down(MOST_TURN / turn)), up(end / most_steps));
    if least > most {
        let until = below(most * most_steps);
        let allowed = format!(
            "at most {until:e}, for at most {most_steps:e} steps of solver.step_s = {most:e}, the longest allowed"
        );
        return Err(SceneError::refused(keys::END, format!("{end:e}"), allowed));
    }
    if !is_affordable {
        return Err(refused(format!(
            "at least {least:e}, for at most {most_steps:e} steps to solver.end_s"
        )));
    }
    let (limit, turns) = (below(stable), most < below(stable));
    let mut allowed = match (is_stable, turns) {
        (true, _) => format!("at most {most:e}"),
        (false, false) => {
            format!("above 0 and below the stability limit 2/omega_max, at most {most:e}")
        }
        (false, true) => format!(
            "above 0 and below the stability limit 2/omega_max, {limit:e}, and at most {most:e}"
        ),
    };
    if turns {
        let fastest = up(fastest);
        allowed.push_str(&format!(
            ", so that the wave turns at most {MOST_TURN} rad a step at {fastest} rad/s"
        ));
    }
    Err(refused(allowed))
}

/// Rejects a run that is shorter than one step.
fn one_step(step: f64, end: f64) -> Result<(), SceneError> {
    let allowed = format!("at least one step, solver.step_s = {step:e}");
    // Counted in the same way as in the solvers.
    let is_less = end / step + STEP_ROUND_OFF < 1.0;
    refuse_if(is_less, keys::END, format!("{end:e}"), &allowed)
}

/// Returns the largest allowed number of steps, rounded down to four digits.
fn most_steps(scene: &Scene) -> f64 {
    // In these cases a step may evaluate every blade.
    let lining = scene.solver.contact == ContactLaw::Smooth;
    let other = scene.solver.model == ModelSize::Modal && scene.has_other_diameters();
    if scene.solver.model == ModelSize::Full || lining || other {
        down(MOST_UPDATES / f64::from(scene.bladed_disk.blades + 2)).min(MOST_STEPS)
    } else {
        MOST_STEPS
    }
}

/// Rounds down to four significant digits.
pub(super) fn down(x: f64) -> f64 {
    let near = rounded(x, 4);
    if near > x { rounded(near - unit(x), 4) } else { near }
}

/// Rounds up to four significant digits.
pub(super) fn up(x: f64) -> f64 {
    -down(-x)
}

/// Returns the largest number of four digits that is less than `x`.
fn below(x: f64) -> f64 {
    let near = down(x);
    if near < x { near } else { rounded(near - unit(x), 4) }
}

/// Returns one unit of the fourth significant digit.
fn unit(x: f64) -> f64 {
    if x == 0.0 || !x.is_finite() { 0.0 } else { 10_f64.powf(x.abs().log10().floor() - 3.0) }
}

/// Rejects what the event solver does not support.
///
/// # Errors
/// The scene has an excitation, a law other than the unilateral one, or the full model.
pub(super) fn event(scene: &Scene) -> Result<(), SceneError> {
    let some = scene.excitation.amplitude_nm;
    refuse_if(some != 0.0, keys::EXCITATION, some, "0 with solver.kind = \"event\"")?;
    let law = scene.solver.contact;
    if let Some(why) = law.lacks_events() {
        let allowed = format!("\"unilateral\" with solver.kind = \"event\" ({why})");
        return Err(SceneError::refused(keys::LAW, format!("\"{law}\""), allowed));
    }
    let allowed = "\"rigid\" or \"modal\" with solver.kind = \"event\"";
    refuse_if(scene.solver.model == ModelSize::Full, keys::MODEL, "\"full\"", allowed)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns the number that follows a word in a message.
    fn number_after(message: &str, word: &str) -> Option<f64> {
        let rest = message.split(word).nth(1)?.trim_start();
        rest.split([' ', ',']).next()?.parse().ok()
    }

    #[test]
    fn a_bound_as_it_is_printed_is_accepted() {
        let mut refusals = [0; 3];
        for model in [ModelSize::Rigid, ModelSize::Modal, ModelSize::Full] {
            for (mass, diameters) in [(2.0, 3), (0.5, 4), (1.544, 0), (2.31, 11), (1e-4, 3)] {
                for speed in [0.0, 10.0, 250.0, -500.0, 1e4, 9.7e5] {
                    for (end, ramp) in [(0.1, 0.0), (0.3, -77.7), (300.0, 0.0), (1e6, 0.0)] {
                        for step in [1e3, 0.01, 2.3e-3, 3.4e-4, 1e-7, 1.23e-11] {
                            let mut scene = Scene::base();
                            scene.casing.modal_mass_kg = mass;
                            scene.operation.nodal_diameters = diameters;
                            scene.operation.speed_rad_s = speed;
                            scene.operation.speed_ramp_rad_s2 = ramp;
                            scene.solver.model = model;
                            scene.solver.end_s = end;
                            scene.solver.step_s = step;
                            let Err(error) = check(&scene) else { continue };
                            let message = error.to_string();
                            let most = number_after(&message, "at most");
                            if message.starts_with("solver.end_s = ") {
                                scene.solver.end_s = most.unwrap();
                                scene.solver.step_s =
                                    number_after(&message, "solver.step_s =").unwrap();
                                refusals[2] += 1;
                            } else if let Some(least) = number_after(&message, "at least") {
                                scene.solver.step_s = least;
                                refusals[1] += 1;
                            } else {
                                scene.solver.step_s = most.unwrap();
                                refusals[0] += 1;
                            }
                            assert_eq!(check(&scene), Ok(()), "after {message}");
                        }
                    }
                }
            }
        }
        assert!(refusals.iter().all(|&count| count > 50), "{refusals:?}");
    }

    #[test]
    fn four_digits_on_the_safe_side() {
        for (x, under, least_under, over) in [
            (2.276_257_268e-3, 2.276e-3, 2.276e-3, 2.277e-3),
            (2e-3, 2e-3, 1.999e-3, 2e-3),
            (1e-3, 1e-3, 9.99e-4, 1e-3),
            (9.999_999e-7, 9.999e-7, 9.999e-7, 1e-6),
            (-1.234_56e5, -1.235e5, -1.235e5, -1.234e5),
        ] {
            assert_eq!((down(x), up(x)), (under, over), "{x}");
            // At a power of ten the next number below is up to a unit of the decade above.
            assert!((below(x) - least_under).abs() <= 1e-3 * x.abs() && below(x) < x, "{x}");
        }
        assert_eq!((down(0.0), down(f64::INFINITY)), (0.0, f64::INFINITY));
    }
}
