//! One scene under both contact laws: how it lasts, and what its blades bear.
//!
//! ```text
//! cargo run --release --package rubscope-solver --example run
//! ```

use std::error::Error;
use std::io::{Write, stdout};

use rubscope_solver::motion::simulate;
use rubscope_solver::scene::Scene;

fn main() -> Result<(), Box<dyn Error>> {
    show(&mut stdout())
}

/// Writes it to `out`.
pub fn show(out: &mut dyn Write) -> Result<(), Box<dyn Error>> {
    let mut scene = Scene::builtin("paper-nd3")?;
    for law in ["bilateral", "unilateral"] {
        scene.set("solver.contact", law)?; // any key, as in a scene file
        let outcome = simulate(&scene.checked()?).outcome;
        writeln!(out, "{law}: {}", outcome.verdict)?;
        for contact in outcome.contacts {
            writeln!(out, "  blades {:?}: {:.2} N", contact.blades, contact.multiplier_n)?;
        }
    }
    Ok(())
}
