//! The figures of the paper: Figs. 4 to 8 in the time domain, 9 and 10 in the
//! frequency domain, as data that `report` can draw and write.
//!
//! Every figure has a scene of its own: the one that gives what the paper says, as far as one
//! was found. Captions say what agrees, what differs, and what cannot be compared, because the
//! paper prints neither its pulse nor the scales of its pictures in the text.

mod figure;
mod harmonic;
mod time;
mod which;
mod zone;

pub use figure::{Figure, Mark, Panel, Quantity, Series, Style};
pub use which::Which;

use crate::harmonic::lock_window;
use crate::model::Machine;

/// The blades of a phase group, such as "#6" or "#3+#14".
fn group_name(blades: &[u32]) -> String {
    blades.iter().map(|blade| format!("#{blade}")).collect::<Vec<_>>().join("+")
}

/// The speed above which the wave is pushed outwards, and those between which both
/// multipliers of a lock push, of a rotor that turns in the sense of `speed`.
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
