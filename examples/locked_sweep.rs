//! The contact forces of the locked motion over rotor speed, by harmonic balance
//! with damping, as CSV. A negative force is a push.
//!
//! ```text
//! cargo run --release --example locked_sweep
//! ```

use std::error::Error;
use std::io::{Write, stdout};

use rubscope::harmonic::{Form, locked_motion};
use rubscope::report::table::Table;
use rubscope::scene::Scene;

fn main() -> Result<(), Box<dyn Error>> {
    show(&mut stdout())
}

/// Writes it to `out`.
pub fn show(out: &mut dyn Write) -> Result<(), Box<dyn Error>> {
    let machine = Scene::builtin("paper-nd3")?.machine();
    let speeds: Vec<f64> = (0..=20).map(|step| 25.0 * f64::from(step)).collect();
    let sweep = locked_motion(&machine, Form::Modal, true, None, &speeds)?;
    let table = Table::of(
        &sweep.points,
        &[
            ("speed_rad_s", |point| point.speed_rad_s.into()),
            ("lambda_a_n", |point| point.multipliers_n[0].into()),
            ("lambda_b_n", |point| point.multipliers_n[1].into()),
            ("only_pushes", |point| point.admissible.into()),
        ],
    );
    Ok(table.write_csv(out)?)
}
