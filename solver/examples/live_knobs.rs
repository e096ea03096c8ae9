//! A motion under way whose speed is turned, as the knobs of the explorer do: what
//! holds the wave now, and what would be at the end with this speed.
//!
//! ```text
//! cargo run --release --package rubscope-solver --example live_knobs
//! ```

use std::error::Error;
use std::io::{Write, stdout};

use rubscope_solver::motion::{Motion, verdict_of};
use rubscope_solver::scene::Scene;

fn main() -> Result<(), Box<dyn Error>> {
    show(&mut stdout())
}

/// Writes it to `out`.
pub fn show(out: &mut dyn Write) -> Result<(), Box<dyn Error>> {
    let scene = Scene::builtin("paper-nd3")?.checked()?;
    let (mut motion, end) = (Motion::new(&scene), scene.solver.end_s);
    for (until, speed) in [(0.02, 500.0), (0.04, 420.0), (0.06, 350.0), (0.08, 300.0)] {
        motion.set_speed(speed, 0.0); // rad/s, and no ramp
        if motion.multipliers().is_empty() {
            motion.fire(); // nothing touches: push again
        }
        let mut forecast = motion.clone(); // a copy that goes its own way
        forecast.advance(end)?;
        let verdict = verdict_of(&forecast, 0.1 * end);
        motion.advance(until)?;
        write!(out, "{speed} rad/s: {verdict} at {end} s; at {until} s")?;
        for (side, force) in motion.multipliers() {
            write!(out, " {:?} {force:.2} N", motion.machine().polygon.blades_of_side(side))?;
        }
        writeln!(out)?;
    }
    Ok(())
}
