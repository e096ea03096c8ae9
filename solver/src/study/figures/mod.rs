//! The figures of the paper as data that `report` can draw and write: Figs. 4 to 8 from the time
//! domain (`time`, `zone`), 9 and 10 from the frequency domain (`harmonic`).
//!
//! Every figure has its own scene, which reproduces the paper's statements as far as such a scene
//! could be found. Captions state what agrees, what differs, and what cannot be compared, because
//! the paper prints neither its pulse nor, in the text, the scales of its figures.

mod figure;
mod harmonic;
mod time;
mod which;
mod zone;

pub use figure::{Figure, Mark, Panel, Quantity, Series, Style};
pub use which::Which;

use crate::harmonic::lock_window;
use crate::model::Machine;

/// Returns the name of a phase group, such as "#6" or "#3+#14".
fn group_name(blades: &[u32]) -> String {
    blades.iter().map(|blade| format!("#{blade}")).collect::<Vec<_>>().join("+")
}

/// Returns marks at the critical speed and at the ends of the lock, for a rotor that turns in the
/// direction of the sign of `speed`.
fn speed_marks(machine: &Machine, speed: f64) -> Vec<Mark> {
    let sense = 1_f64.copysign(speed);
    let window = lock_window(machine, sense);
    let lock = window.filter(|_| !machine.locks_from_critical_speed()).map(|window| window.from);
    let ends = window.and_then(|window| window.to);
    [("Ω_c", machine.critical_speed()), ("Ω_lock", lock), ("lock ends", ends)]
        .into_iter()
        .filter_map(|(label, speed)| Some(Mark { x: sense * speed?, label }))
        .collect()
}
