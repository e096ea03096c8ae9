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

fn direction(n: u64, rotor: &Rotor, diameters: f64, step: f64) -> (f64, f64) {
    let (sin, cos) = (diameters * rotor.angle(n as f64 * step)).sin_cos();
    (cos, sin)
}

impl Phasor {
    pub(super) fn new(rotor: &Rotor, diameters: f64, step: f64) -> Self {
        let entry = |j: u64| {
            let (sin, cos) = (diameters * rotor.speed(0.0) * step * j as f64).sin_cos();
            (cos, sin)
        };
        let steady = rotor.ramp() == 0.0;
        let table = if steady { (0..TABLE).map(entry).collect() } else { Vec::new() };
        Self { table, block: u64::MAX, at_block: (1.0, 0.0) }
    }

    /// `(cos n_d theta, sin n_d theta)` at step `n`, for steps in a row.
    pub(super) fn at(&mut self, n: u64, rotor: &Rotor, diameters: f64, step: f64) -> (f64, f64) {
        if n / TABLE != self.block {
            self.block = n / TABLE;
            self.at_block = direction(self.block * TABLE, rotor, diameters, step);
        }
        self.turned_from(self.at_block, n).unwrap_or_else(|| direction(n, rotor, diameters, step))
    }

    /// The same, for a step anywhere.
    pub(super) fn once(&self, n: u64, rotor: &Rotor, diameters: f64, step: f64) -> (f64, f64) {
        let block = direction(n / TABLE * TABLE, rotor, diameters, step);
        self.turned_from(block, n).unwrap_or_else(|| direction(n, rotor, diameters, step))
    }

    fn turned_from(&self, (c, s): (f64, f64), n: u64) -> Option<(f64, f64)> {
        let &(dc, ds) = self.table.get((n % TABLE) as usize)?;
        Some((c * dc - s * ds, s * dc + c * ds))
    }
}
