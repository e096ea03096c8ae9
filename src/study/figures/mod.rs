//! The figures of the paper: Figs. 4 to 8 in the time domain, 9 and 10 in the
//! frequency domain, as data that `report` can draw and write.
//!
//! The paper does not print the pulse of its figures, and with the damping of
//! its Table 1 no pulse gives the long transient they show. Without casing
//! damping, a pulse of 40 kN and contact that only pushes, the motion locks at
//! 0.085 s at every time step of Fig. 4, as in the paper: Figs. 4 to 6 use
//! that. Fig. 7 uses 42 kN, which locks at 0.038 s.

mod figure;
mod harmonic;
mod time;
mod zone;

pub use figure::{Figure, Mark, Panel, Quantity, Series, Style};

use crate::harmonic::HarmonicError;
use crate::model::Machine;
use crate::scene::{CheckedScene, Scene, SceneError};

/// The numbers of the figures.
pub const NUMBERS: [u32; 7] = [4, 5, 6, 7, 8, 9, 10];

/// The scenes of the figures.
#[derive(Clone, Debug, PartialEq)]
pub struct Scenes {
    /// Figs. 4 to 6: three nodal diameters in time.
    pub three: CheckedScene,
    /// Fig. 7: four nodal diameters in time.
    pub four: CheckedScene,
    /// Figs. 8 to 10: the machine of Table 1.
    pub machine: CheckedScene,
}

impl Scenes {
    /// The paper's.
    ///
    /// # Errors
    /// None, as the built-in scenes exist.
    pub fn paper() -> Result<Self, SceneError> {
        let transient = |name: &str, pulse: &str| {
            Scene::builtin(name)?.with(&[
                ("casing.damping_ratio", "0"),
                ("operation.pulse_n", pulse),
                ("solver.contact", "unilateral"),
            ])
        };
        Ok(Self {
            three: transient("paper-nd3", "40000")?,
            four: transient("paper-nd4", "42000")?,
            machine: Scene::builtin("paper-nd3")?.checked()?,
        })
    }
}

/// The speeds above which the wave is pushed outwards, and above which both
/// multipliers of a lock push; equal without casing damping.
fn speed_marks(machine: &Machine) -> Vec<Mark> {
    let critical = machine.critical_speed();
    let lock = machine.lock_speed().filter(|_| machine.casing_damping_ratio > 0.0);
    [("Omega_c", critical), ("Omega_lock", lock)]
        .into_iter()
        .filter_map(|(label, speed)| Some(Mark { x: speed?, label }))
        .collect()
}

/// One figure by its number in the paper; none for a number not in `NUMBERS`.
///
/// # Errors
/// A machine that has no locked motion (Figs. 9 and 10).
pub fn figure(number: u32, scenes: &Scenes) -> Result<Option<Figure>, HarmonicError> {
    let mut figure = match number {
        4 => time::steps(&scenes.three),
        5 => time::gaps(&scenes.three),
        6 => time::response(&scenes.three),
        7 => time::response(&scenes.four),
        8 => zone::zone(&scenes.machine, &scenes.three),
        9 => harmonic::multipliers(&scenes.machine)?,
        10 => harmonic::amplitudes(&scenes.machine)?,
        _ => return Ok(None),
    };
    figure.title = format!("Figure {number}. {}", figure.title);
    Ok(Some(figure))
}
