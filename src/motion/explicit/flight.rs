//! Free flight in blocks, and the turning phase of the rotor.
//!
//! The discrete energy bounds how far `|u|` can travel in one step
//! (docs/theory.md, section 6). So many steps as cannot reach the clearance form a
//! *block*: it is decided on once, looked at wherever asked, and taken at its end.
//! Looking never changes the trajectory.

use super::{BladeModel, Coordinate, Explicit, HeldCorner};
use crate::motion::{ActiveSet, Rotor};
use crate::tolerances::{BREAK_STEPS, LARGEST_BLADE_ANGLE, SHORTEST_BLOCK};

/// A block without end: no contact can ever come again.
const ENDLESS: u64 = u64::MAX;

/// Free steps decided on, from the step the coordinates belong to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Block {
    length: u64,
    used: u64,
}

impl Block {
    pub(super) fn is_open(self) -> bool {
        self.length > 0
    }
    pub(super) fn is_endless(self) -> bool {
        self.length == ENDLESS
    }
    pub(super) fn used(self) -> u64 {
        self.used
    }
}

impl<B: BladeModel> Explicit<B> {
    /// Whether a block of steps that cannot touch is open, deciding on one if
    /// it can be long enough to be worth it.
    pub(super) fn open_block(&mut self) -> bool {
        if self.block.is_open() {
            return true;
        }
        let clearance = self.machine.polygon.clearance;
        let distance2 = self.u[0].x * self.u[0].x + self.u[1].x * self.u[1].x;
        if self.last_touch == self.n && self.hold() {
            self.block = Block { length: ENDLESS, used: 0 };
            return true;
        }
        // Blades that are driven do not follow the free recurrence.
        let outside = distance2 >= clearance * clearance;
        if outside || self.pulse_to_come() || self.excitation.is_some() {
            return false;
        }
        let distance = distance2.sqrt();
        let (farthest, longest) = self.casing.reach_of(self.u);
        let length =
            if farthest < clearance { ENDLESS } else { ((clearance - distance) / longest) as u64 };
        // Blades that may swing too far are followed step by step.
        if length < SHORTEST_BLOCK || self.blades.reach() > LARGEST_BLADE_ANGLE {
            return false;
        }
        // Such a block is longer than the pause that ends a contact.
        if self.log.active_set != ActiveSet::Nothing {
            self.end_contact(self.n.max(self.last_touch + BREAK_STEPS + 1));
        }
        self.block = Block { length, used: 0 };
        true
    }

    /// The largest angle of any blade so far, the open block included \[rad\].
    pub(super) fn largest_angle(&self) -> f64 {
        let (used, least) = (self.block.used, self.watch.largest());
        match &self.held {
            _ if used == 0 => least,
            Some(held) => held.largest_angle(used, least),
            None => self.blades.peak(used, least),
        }
    }

    /// Whether no contact can ever come again: the casing, whatever the blades
    /// do, never reaches one.
    pub(super) fn no_contact_to_come(&self) -> bool {
        if self.held.is_some() || self.pulse_to_come() {
            return false;
        }
        let skipped = |coordinate| self.casing.skip(coordinate, self.block.used);
        self.block.is_endless()
            || self.casing.reach_of(self.u.map(skipped)).0 < self.machine.polygon.clearance
    }

    /// Whether the pulse still acts on this step or a later one.
    fn pulse_to_come(&self) -> bool {
        let left_over = self.left_over.0 == self.n && self.left_over.1 != 0.0;
        let acting = self.time_of(self.n) - 0.5 * self.step < self.pulse.end;
        left_over || (self.pulse.force != 0.0 && acting)
    }

    /// Goes on inside the open block, up to `target`; takes it at its end.
    pub(super) fn use_block(&mut self, target: u64) {
        let before = self.block.used;
        let wanted = target - self.n;
        self.block.used = wanted.min(self.block.length);
        if let Some(held) = self.held.take() {
            self.log_held(&held, before);
            self.held = Some(held);
        }
        if self.block.used == self.block.length {
            self.close_block();
        }
    }

    /// Takes the steps used so far and closes the block.
    pub(super) fn close_block(&mut self) {
        let (u, blades) = self.materialized();
        if self.block.used > 0 {
            self.watch.skipped(self.largest_angle(), blades.bound_now());
        }
        self.n += self.block.used;
        self.skipped += self.block.used;
        self.u = u;
        self.blades = blades;
        if let Some(held) = self.held.take()
            && self.block.used > 0
        {
            self.last_touch = self.n;
            let latest = held.sides().into_iter().zip(held.multipliers(self.block.used));
            for (side, lambda) in latest {
                self.touched[side as usize] = self.n;
                for row in self.rows.iter_mut().filter(|row| row.side == side) {
                    row.lambda = lambda;
                }
            }
            self.hold_tried = self.n;
        }
        self.block = Block::default();
    }

    /// Keeps what the steps of a held corner did since `before`.
    fn log_held(&mut self, held: &HeldCorner, before: u64) {
        let (used, t) = (self.block.used, self.time_of(self.latest_step()));
        for (side, sum) in held.sides().into_iter().zip(held.sums(before, used)) {
            self.impulses[side as usize] += sum * self.step;
        }
        self.log.touch(t, self.log.active_set);
        if held.pulls {
            self.log.tensile_steps += used - before;
            self.log.last_tensile = Some(t);
        }
    }

    /// Coordinates at the latest step, inside a block or not.
    pub(super) fn materialized(&self) -> ([Coordinate; 2], B) {
        if let Some(held) = self.held.as_ref().filter(|_| self.block.used > 0) {
            return self.held_at(held, self.block.used);
        }
        let mut blades = self.blades.clone();
        if self.block.used == 0 {
            return (self.u, blades);
        }
        blades.skip(self.block.used);
        (self.u.map(|coordinate| self.casing.skip(coordinate, self.block.used)), blades)
    }
}

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
    pub(super) fn new(rotor: &Rotor, diameters: f64, step: f64) -> Self {
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
    pub(super) fn at(&mut self, n: u64, rotor: &Rotor, diameters: f64, step: f64) -> (f64, f64) {
        if !self.table.is_empty() && n / TABLE != self.block {
            self.block = n / TABLE;
            self.at_block = exact(self.block * TABLE, rotor, diameters, step);
        }
        self.look(n, rotor, diameters, step)
    }

    /// The same, keeping nothing.
    pub(super) fn look(&self, n: u64, rotor: &Rotor, diameters: f64, step: f64) -> (f64, f64) {
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
