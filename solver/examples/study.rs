//! A study of one's own: the smallest pulse, among some, whose motion lasts, over
//! the damping of the casing. Every run is independent, so they use all cores.
//!
//! ```text
//! cargo run --release --package rubscope-solver --example study
//! ```

use std::error::Error;
use std::io::{Write, stdout};

use rayon::prelude::*;
use rubscope_solver::motion::{Verdict, run_to_verdict, to_the_end};
use rubscope_solver::scene::{Scene, SolverKind};

fn main() -> Result<(), Box<dyn Error>> {
    show(&mut stdout())
}

/// Writes it to `out`.
pub fn show(out: &mut dyn Write) -> Result<(), Box<dyn Error>> {
    let mut scene = Scene::base(); // the paper's machine at 500 rad/s, contact that only pushes
    scene.solver.kind = SolverKind::Event;
    for zeta in [0.0, 0.002, 0.005, 0.01, 0.02, 0.05] {
        scene.casing.damping_ratio = zeta;
        let pulses: Vec<u32> = (10_000..=100_000).step_by(1000).collect();
        let lasts = |&pulse: &u32| {
            let mut scene = scene.clone();
            scene.operation.pulse_n = pulse.into();
            let scene = scene.checked().ok()?;
            let verdict = run_to_verdict(&scene, &to_the_end)?.verdict;
            matches!(verdict, Verdict::Locked | Verdict::Slip).then_some((pulse, verdict))
        };
        match pulses.into_par_iter().find_map_first(|pulse| lasts(&pulse)) {
            Some((pulse, verdict)) => writeln!(out, "zeta_c {zeta}: {verdict} from {pulse} N")?,
            None => writeln!(out, "zeta_c {zeta}: nothing lasts")?,
        }
    }
    Ok(())
}
