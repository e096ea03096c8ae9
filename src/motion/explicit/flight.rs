//! Free flight in blocks, and the turning phase of the rotor.
//!
//! The discrete energy bounds how far `|u|` can travel in one step
//! (docs/theory.md, section 6). So many steps as cannot reach the clearance form a
//! *block*: it is decided on once, looked at wherever asked, and taken at its end.
//! Looking never changes the trajectory.

use super::held_corner::HeldCorner;
use super::held_side::HeldSide;
use super::{BladeModel, Coordinate, Explicit};
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

/// Sides that close in every step of the open block.
#[derive(Clone, Debug)]
pub(super) enum Held {
    /// A lock.
    Corner(HeldCorner),
    /// A wave that slides along one side.
    Side(HeldSide),
}

impl Held {
    /// Multipliers of the step that led to `steps` steps from the start \[N\].
    pub fn multipliers(&self, steps: u64) -> impl Iterator<Item = (u32, f64)> {
        let pair = match self {
            Self::Corner(corner) => {
                let [a, b] = corner.multipliers(steps);
                let [first, second] = corner.sides();
                [Some((first, a)), Some((second, b))]
            }
            Self::Side(side) => [Some((side.side, side.multiplier(steps))), None],
        };
        pair.into_iter().flatten()
    }

    /// Sums of the multipliers of the steps after `before`, up to `steps` \[N\].
    fn sums(&self, before: u64, steps: u64) -> impl Iterator<Item = (u32, f64)> {
        let pair = match self {
            Self::Corner(corner) => {
                let [a, b] = corner.sums(before, steps);
                let [first, second] = corner.sides();
                [Some((first, a)), Some((second, b))]
            }
            Self::Side(side) => [Some((side.side, side.sum(before, steps))), None],
        };
        pair.into_iter().flatten()
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
        if length < self.blades.shortest_block() || self.blades.reach() > LARGEST_BLADE_ANGLE {
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
            Some(Held::Corner(held)) => held.largest_angle(used, least),
            _ => self.blades.peak(used, least),
        }
    }

    /// Whether no contact can ever come again: the casing, whatever the blades
    /// do, never reaches one.
    pub(super) fn no_contact_to_come(&self) -> bool {
        if self.held.is_some() || self.sliding.is_some() || self.pulse_to_come() {
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
        self.end_sliding();
        let used = self.block.used;
        if used > 0 && self.held.is_none() {
            let (largest, bound) = self.blades.fly(used, self.watch.largest());
            self.watch.skipped(largest, bound);
            self.u = self.u.map(|coordinate| self.casing.skip(coordinate, used));
        } else if used > 0 {
            let largest = self.largest_angle();
            (self.u, self.blades) = self.materialized();
            self.watch.skipped(largest, self.blades.look(largest).1);
        }
        self.n += used;
        self.skipped += used;
        if let Some(held) = self.held.take()
            && self.block.used > 0
        {
            self.last_touch = self.n;
            for (side, lambda) in held.multipliers(self.block.used) {
                self.touched[side as usize] = self.n;
                for row in self.rows.iter_mut().filter(|row| row.side == side) {
                    row.lambda = lambda;
                }
            }
            self.hold_tried = self.n;
        }
        self.block = Block::default();
    }

    /// Begins a block of steps in which the same sides close, if there are enough.
    fn hold(&mut self) -> bool {
        if let Some(corner) = self.hold_corner() {
            self.held = Some(Held::Corner(corner));
            self.block = Block { length: ENDLESS, used: 0 };
        } else if let Some(side) = self.hold_side() {
            let length = side.length;
            if length < SHORTEST_BLOCK {
                self.slide_tried = self.n + length;
                return false;
            }
            self.held = Some(Held::Side(side));
            self.block = Block { length, used: 0 };
        }
        self.held.is_some()
    }

    /// Whether neither pulse nor ramp nor excitation acts from now on.
    pub(super) fn is_steady(&self) -> bool {
        let after_pulse =
            self.pulse.force == 0.0 || self.time_of(self.n) > self.pulse.end + self.step;
        after_pulse && self.rotor.ramp() == 0.0 && self.excitation.is_none()
    }

    /// Keeps what the steps of held sides did since `before`.
    fn log_held(&mut self, held: &Held, before: u64) {
        let (used, t) = (self.block.used, self.time_of(self.latest_step()));
        for (side, sum) in held.sums(before, used) {
            self.impulses[side as usize] += sum * self.step;
        }
        self.log.touch(t, self.log.active_set);
        match held {
            Held::Corner(corner) if corner.pulls => {
                self.log.tensile_steps += used - before;
                self.log.last_tensile = Some(t);
            }
            Held::Corner(_) => {}
            Held::Side(side) => {
                let deepest = side.deepest(before, used);
                self.deepest_predicted = self.deepest_predicted.max(deepest);
            }
        }
    }

    /// Coordinates at the latest step, inside a block or not.
    pub(super) fn materialized(&self) -> ([Coordinate; 2], B) {
        if let Some(sliding) = &self.sliding {
            return self.slid(sliding);
        }
        let mut blades = self.blades.clone();
        let used = self.block.used;
        match &self.held {
            _ if used == 0 => (self.u, blades),
            Some(Held::Corner(corner)) => self.held_at(corner, used),
            Some(Held::Side(side)) => (self.along_side(side, used), blades),
            None => {
                blades.skip(used);
                (self.u.map(|coordinate| self.casing.skip(coordinate, used)), blades)
            }
        }
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
        self.from_block(self.at_block, n).unwrap_or_else(|| direction(n, rotor, diameters, step))
    }

    /// The same, for a step anywhere.
    pub(super) fn once(&self, n: u64, rotor: &Rotor, diameters: f64, step: f64) -> (f64, f64) {
        let block = direction(n / TABLE * TABLE, rotor, diameters, step);
        self.from_block(block, n).unwrap_or_else(|| direction(n, rotor, diameters, step))
    }

    fn from_block(&self, (c, s): (f64, f64), n: u64) -> Option<(f64, f64)> {
        let &(dc, ds) = self.table.get((n % TABLE) as usize)?;
        Some((c * dc - s * ds, s * dc + c * ds))
    }
}
