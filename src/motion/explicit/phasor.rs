//! The turning phase of the rotor at the steps of the explicit solver.

use crate::motion::Rotor;

/// The phase of the wave frame, `exp(i n_d theta)`, at every step: an exact
/// sine and cosine each 64 steps and a table between them, so that the value at
/// a step does not depend on the steps before it.
#[derive(Clone, Debug)]
pub(super) struct Phasor {
    table: Vec<(f64, f64)>,
    block: u64,
    at_block: (f64, f64),
}

const TABLE: u64 = 64;

impl Phasor {
    pub fn new(rotor: &Rotor, diameters: f64, step: f64) -> Self {
        let entry = |j: u64| {
            let (sin, cos) = (diameters * rotor.speed(0.0) * step * j as f64).sin_cos();
            (cos, sin)
        };
        let steady = rotor.ramp() == 0.0;
        let table = if steady { (0..TABLE).map(entry).collect() } else { Vec::new() };
        Self { table, block: u64::MAX, at_block: (1.0, 0.0) }
    }

    /// `(cos n_d theta, sin n_d theta)` at step `n`, keeping the exact value for the
    /// steps after it.
    pub fn at(&mut self, n: u64, rotor: &Rotor, diameters: f64, step: f64) -> (f64, f64) {
        if !self.table.is_empty() && n / TABLE != self.block {
            self.block = n / TABLE;
            self.at_block = exact(self.block * TABLE, rotor, diameters, step);
        }
        self.look(n, rotor, diameters, step)
    }

    /// The same, keeping nothing.
    pub fn look(&self, n: u64, rotor: &Rotor, diameters: f64, step: f64) -> (f64, f64) {
        let Some((dc, ds)) = self.table.get((n % TABLE) as usize) else {
            return exact(n, rotor, diameters, step);
        };
        let (c, s) = match n / TABLE {
            block if block == self.block => self.at_block,
            block => exact(block * TABLE, rotor, diameters, step),
        };
        (c * dc - s * ds, s * dc + c * ds)
    }
}

/// `exp(i n_d theta)` at step `n` by its own sine and cosine.
fn exact(n: u64, rotor: &Rotor, diameters: f64, step: f64) -> (f64, f64) {
    let (sin, cos) = (diameters * rotor.angle(n as f64 * step)).sin_cos();
    (cos, sin)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn a_look_at_a_phase_is_the_phase_of_a_step_taken() {
        for ramp in ["0", "-300"] {
            let scene = Scene::base().with(&[("operation.speed_ramp_rad_s2", ramp)]).unwrap();
            let rotor = Rotor::of(&scene);
            let mut phasor = Phasor::new(&rotor, 3.0, 1e-6);
            for n in [0, 1, 63, 64, 65, 1000, 12_345, 12_346, 70] {
                let seen = phasor.look(n, &rotor, 3.0, 1e-6);
                let (sin, cos) = (3.0 * rotor.angle(n as f64 * 1e-6)).sin_cos();
                assert_eq!(seen, phasor.at(n, &rotor, 3.0, 1e-6));
                // Round-off of an angle of 18 rad, twice.
                let apart = (seen.0 - cos).hypot(seen.1 - sin);
                assert!(apart < 8e-15, "{n}: {apart}");
            }
        }
    }
}
