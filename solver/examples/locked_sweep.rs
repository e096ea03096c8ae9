//! The contact forces of the locked motion over rotor speed, by harmonic balance
//! with damping, as CSV. A negative force is a push.
//!
//! ```text
//! cargo run --release --package rubscope-solver --example locked_sweep
//! ```

use std::error::Error;
use std::io::{Write, stdout};

use rubscope_solver::harmonic::{Form, locked_motion};
use rubscope_solver::scene::Scene;

fn main() -> Result<(), Box<dyn Error>> {
    show(&mut stdout())
}

/// Writes it to `out`.
pub fn show(out: &mut dyn Write) -> Result<(), Box<dyn Error>> {
    let machine = Scene::builtin("paper-nd3")?.machine();
    let speeds: Vec<f64> = (0..=20).map(|step| 25.0 * f64::from(step)).collect();
    let sweep = locked_motion(&machine, Form::Modal, true, None, &speeds)?;
    writeln!(out, "speed_rad_s,lambda_a_n,lambda_b_n,only_pushes")?;
    for point in &sweep.points {
        let [a, b] = point.multipliers_n;
        writeln!(out, "{},{a},{b},{}", point.speed_rad_s, point.admissible)?;
    }
    Ok(())
}
