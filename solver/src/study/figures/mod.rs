//! The figures of the paper: Figs. 4 to 8 in the time domain, 9 and 10 in the
//! frequency domain, as data that `report` can draw and write; and one of the
//! coincidence, which the paper only names.
//!
//! Every figure is made of one scene. The built-in ones are those that give
//! what the paper says, as far as one was found; their captions say what agrees,
//! what differs, and what cannot be compared, because the paper prints neither
//! its pulse nor the scales of its pictures in the text.

mod coincidence;
mod figure;
mod harmonic;
mod time;
mod which;
mod zone;

pub use figure::{Figure, Mark, Panel, Quantity, Series, Style};
pub use which::Which;

use crate::harmonic::HarmonicError;
use crate::model::Machine;
use crate::scene::{CheckedScene, Scene, SceneError};

/// The numbers of the figures.
pub const NUMBERS: [u32; 7] = [4, 5, 6, 7, 8, 9, 10];

/// The built-in scene of a figure.
#[must_use]
pub fn name_of(number: u32) -> &'static str {
    match number {
        4..=6 => "paper-figs-4-6",
        7 => "paper-fig-7",
        8 => "paper-fig-8",
        _ => "paper-nd3",
    }
}

/// The built-in scene of a figure, checked.
///
/// # Errors
/// None, as the built-in scenes exist.
pub fn scene_of(number: u32) -> Result<CheckedScene, SceneError> {
    Scene::builtin(name_of(number))?.checked()
}

/// The blades of a phase group, such as "#6" or "#3+#14".
fn group_name(blades: &[u32]) -> String {
    blades.iter().map(|blade| format!("#{blade}")).collect::<Vec<_>>().join("+")
}

/// The speed above which the wave is pushed outwards, and those between which both
/// multipliers of a lock push, of a rotor that turns in the sense of `speed`.
fn speed_marks(machine: &Machine, speed: f64) -> Vec<Mark> {
    let sense = 1_f64.copysign(speed);
    let window = machine.lock_window(sense);
    let lock = window.filter(|_| !machine.locks_from_critical_speed()).map(|window| window.from);
    let ends = window.and_then(|window| window.to);
    [("Ω_c", machine.critical_speed()), ("Ω_lock", lock), ("lock ends", ends)]
        .into_iter()
        .filter_map(|(label, speed)| Some(Mark { x: sense * speed?, label }))
        .collect()
}

/// One figure by its number in the paper, of this scene; none for a number not
/// in `NUMBERS`. With the built-in scene it has a caption that compares it with
/// the paper.
///
/// # Errors
/// A machine that has no locked motion (Figs. 9 and 10).
pub fn figure(number: u32, scene: &CheckedScene) -> Result<Option<Figure>, HarmonicError> {
    let as_paper = scene_of(number).is_ok_and(|paper| paper == *scene);
    let mut figure = match number {
        4 => time::steps(scene, as_paper),
        5 => time::gaps(scene, as_paper),
        6 => time::response(scene, as_paper),
        7 => time::four_diameters(scene, as_paper),
        8 => zone::zone(scene, as_paper),
        9 => harmonic::multipliers(scene, as_paper)?,
        10 => harmonic::amplitudes(scene, as_paper)?,
        _ => return Ok(None),
    };
    figure.title = format!("Figure {number}. {}", figure.title);
    Ok(Some(figure))
}
