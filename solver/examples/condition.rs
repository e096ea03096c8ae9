//! Runs that stop on a condition of one's own, for three clearances: the first instant at which
//! one corner has held the wave for a millisecond.
//!
//! ```text
//! cargo run --release --package rubscope-solver --example condition
//! ```

use std::error::Error;
use std::io::{Write, stdout};

use rubscope_solver::motion::{ActiveSet, Motion};
use rubscope_solver::scene::Scene;

/// Interval between two evaluations of the condition \[s\].
const INTERVAL: f64 = 1e-4;

fn main() -> Result<(), Box<dyn Error>> {
    show(&mut stdout())
}

/// Returns whether one corner has held the wave for a millisecond.
fn is_caught(motion: &Motion) -> bool {
    let contacts = motion.contacts();
    matches!(contacts.active_set, ActiveSet::Corner(..)) && motion.t_s() - contacts.since >= 1e-3
}

/// Writes it to `out`.
pub fn show(out: &mut dyn Write) -> Result<(), Box<dyn Error>> {
    let mut scene = Scene::builtin("paper-nd3")?;
    for clearance_um in [50.0, 100.0, 400.0] {
        scene.set_clearance(1e-6 * clearance_um)?;
        let checked = scene.checked()?;
        let mut motion = Motion::new(&checked);
        while !is_caught(&motion) && motion.t_s() < checked.solver.end_s - INTERVAL {
            let until = motion.t_s() + INTERVAL;
            motion.advance(until)?;
        }
        let caught = if is_caught(&motion) { "caught" } else { "not caught" };
        let (t_ms, amplitude_um) = (1e3 * motion.t_s(), 1e6 * motion.state().amplitude());
        writeln!(
            out,
            "{clearance_um} um: {caught} at {t_ms:.1} ms, amplitude {amplitude_um:.2} um"
        )?;
    }
    Ok(())
}
