//! What single keys cannot say: combinations of a scene that have no meaning.

use super::{ContactLaw, ModelSize, Scene, SceneError, SolverKind};

/// Most steps one explicit run may take.
const MOST_STEPS: f64 = 1e10;
/// Largest angle the wave may turn against the blades in one step \[rad\].
const MOST_TURN: f64 = 0.5;

pub(super) fn check(scene: &Scene) -> Result<(), SceneError> {
    clearance(scene)?;
    frequencies(scene)?;
    initial_state(scene)?;
    excitation(scene)?;
    match scene.solver.kind {
        SolverKind::Explicit => explicit(scene),
        SolverKind::Event => event(scene),
    }
}

fn clearance(scene: &Scene) -> Result<(), SceneError> {
    let length = scene.bladed_disk.blade_length_m;
    if scene.casing.radius_m > length {
        return Ok(());
    }
    Err(SceneError::refused(
        "casing.radius_m",
        scene.casing.radius_m,
        format!("above bladed_disk.blade_length_m = {length}, so that there is a clearance"),
    ))
}

/// Frequencies whose squares leave the range of numbers make no model.
fn frequencies(scene: &Scene) -> Result<(), SceneError> {
    let machine = scene.machine();
    for (key, value, frequency) in [
        ("casing.modal_mass_kg", scene.casing.modal_mass_kg, machine.omega_c),
        ("bladed_disk.inertia_kg_m2", scene.bladed_disk.inertia_kg_m2, machine.omega_bd),
    ] {
        if !(1e-6..=1e15).contains(&frequency) {
            let allowed =
                format!("one that gives a frequency from 1e-6 to 1e15 rad/s, not {frequency:e}");
            return Err(SceneError::refused(key, format!("{value:e}"), allowed));
        }
    }
    Ok(())
}

fn initial_state(scene: &Scene) -> Result<(), SceneError> {
    let machine = scene.machine();
    let (x, y) = (scene.initial.u_c_m, scene.initial.u_s_m);
    let side = machine.rim.nearest_side(x, y);
    let gap = machine.rim.gap(side, x, y);
    // A point set on a side by a computed coordinate may miss it by round-off.
    if gap >= -1e-12 * machine.clearance() {
        return Ok(());
    }
    let deepest = format!("a casing position with every gap open; here the smallest is {gap:e} m");
    Err(SceneError::refused("initial.u_c_m", format!("{x:e}, u_s_m = {y:e}"), deepest))
}

fn excitation(scene: &Scene) -> Result<(), SceneError> {
    let amplitude = scene.excitation.amplitude_nm;
    let allowed = if amplitude == 0.0 {
        return Ok(());
    } else if scene.solver.kind == SolverKind::Event {
        "0 with solver.kind = \"event\""
    } else if scene.solver.model == ModelSize::Rigid {
        "0 with solver.model = \"rigid\", whose blades do not move"
    } else {
        return Ok(());
    };
    Err(SceneError::refused("excitation.amplitude_nm", amplitude, allowed))
}

fn explicit(scene: &Scene) -> Result<(), SceneError> {
    let step = scene.solver.step_s;
    let refused =
        |allowed: String| SceneError::refused("solver.step_s", format!("{step:e}"), allowed);
    let limit = scene.stable_step();
    if step >= limit {
        return Err(refused(format!(
            "above 0 and below the stability limit 2/omega_max = {limit:e}"
        )));
    }
    let operation = &scene.operation;
    let last = operation.speed_rad_s + operation.speed_ramp_rad_s2 * scene.solver.end_s;
    let fastest = operation.speed_rad_s.abs().max(last.abs());
    let turn = f64::from(operation.nodal_diameters) * fastest * step;
    if turn > MOST_TURN {
        let most = step * MOST_TURN / turn;
        return Err(refused(format!(
            "at most {most:e}, so that the wave turns at most {MOST_TURN} rad a step at {fastest} rad/s"
        )));
    }
    if scene.solver.end_s / step > MOST_STEPS {
        let least = scene.solver.end_s / MOST_STEPS;
        return Err(refused(format!(
            "at least {least:e}, for at most {MOST_STEPS:e} steps to solver.end_s"
        )));
    }
    Ok(())
}

fn event(scene: &Scene) -> Result<(), SceneError> {
    if scene.solver.contact == ContactLaw::Bilateral {
        return Err(SceneError::refused(
            "solver.contact",
            "\"bilateral\"",
            "\"unilateral\" with solver.kind = \"event\" (bilateral is a law of the time step)",
        ));
    }
    if scene.solver.model == ModelSize::Full {
        return Err(SceneError::refused(
            "solver.model",
            "\"full\"",
            "\"rigid\" or \"modal\" with solver.kind = \"event\"",
        ));
    }
    Ok(())
}
