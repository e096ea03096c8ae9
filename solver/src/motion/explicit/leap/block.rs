//! Steps decided on ahead: a *block* of flight, of a held lock or of a side that is slid
//! along. It is looked at wherever asked, and taken at its end; looking never changes the
//! trajectory. Then the verdicts that nothing to come can change (docs/theory.md, section
//! 9).

use super::held_corner::HeldCorner;
use crate::motion::explicit::disk::Disk;
use crate::motion::explicit::{Coordinate, Explicit};
use crate::motion::{EnergyAccount, Verdict};
use crate::tolerances::{CERTAIN_PUSH, HELD_AFTER, LIGHT_BLADES, ROOM_TO_CHANGE};

/// A block without end: no contact can ever come again.
pub(in crate::motion::explicit) const ENDLESS: u64 = u64::MAX;

/// Steps decided on, from the step the coordinates belong to.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(in crate::motion::explicit) struct Block {
    length: u64,
    used: u64,
}

impl Block {
    /// Of so many steps.
    pub(in crate::motion::explicit) fn new(length: u64) -> Self {
        Self { length, used: 0 }
    }
    pub(in crate::motion::explicit) fn is_open(self) -> bool {
        self.length > 0
    }
    pub(in crate::motion::explicit) fn used(self) -> u64 {
        self.used
    }
}

impl<B: Disk> Explicit<B> {
    /// Returns whether a block is open; begins one if it can be long enough to be worth it.
    pub(in crate::motion::explicit) fn open_block(&mut self) -> bool {
        if !self.leaps.block.is_open() {
            let lasts = !self.goes_beyond || self.leaps.same_sides >= HELD_AFTER;
            if !(lasts && self.record.last_touch == self.n && self.hold_lock()) {
                self.begin_flight();
            }
        }
        self.leaps.block.is_open()
    }

    /// Goes on inside the open block, up to `target`; takes it at its end.
    pub(in crate::motion::explicit) fn use_block(&mut self, target: u64) {
        let before = self.leaps.block.used;
        let wanted = target - self.n;
        self.leaps.block.used = wanted.min(self.leaps.block.length);
        if let Some(held) = self.leaps.held.take() {
            self.log_held(&held, before);
            self.leaps.held = Some(held);
        } else {
            self.log_flight(before);
        }
        if self.leaps.block.used == self.leaps.block.length {
            self.close_block();
        }
    }

    /// Takes the steps used so far and closes the block.
    pub(in crate::motion::explicit) fn close_block(&mut self) {
        self.end_sliding();
        let used = self.leaps.block.used;
        if used > 0 && self.leaps.held.is_none() {
            self.take_flight(used);
        } else if used > 0 {
            let largest = self.largest_angle();
            if let Some(corner) = &self.leaps.held {
                self.beyond.before = self.held_before(corner, used);
            }
            (self.u, self.blades) = self.materialized();
            self.watch.skipped(largest, self.blades.look(largest).1);
        }
        self.n += used;
        self.leaps.skipped += used;
        if let Some(held) = self.leaps.held.take()
            && self.leaps.block.used > 0
        {
            self.record.last_touch = self.n;
            for (side, lambda) in held.pushes_by_side(self.leaps.block.used) {
                self.record.keep_touching(self.n, side);
                for row in self.rows.iter_mut().filter(|row| row.side == side) {
                    row.lambda = lambda;
                }
            }
            self.leaps.hold_tried = self.n;
        }
        self.leaps.block = Block::default();
    }

    /// Returns the largest angle of any blade so far, the open block included \[rad\].
    pub(in crate::motion::explicit) fn largest_angle(&self) -> f64 {
        let (used, least) = (self.leaps.block.used, self.watch.largest());
        match &self.leaps.held {
            _ if used == 0 => least,
            Some(held) => held.largest_angle(used, least),
            _ => self.blades.peak(used, least),
        }
    }

    /// Returns the coordinates at the latest step, inside a block or not.
    pub(in crate::motion::explicit) fn materialized(&self) -> ([Coordinate; 2], B) {
        if let Some(sliding) = &self.leaps.sliding {
            return self.slid(sliding);
        }
        let used = self.leaps.block.used;
        match &self.leaps.held {
            _ if used == 0 => (self.u, self.blades.clone()),
            Some(corner) => self.held_at(corner, used),
            None => self.flown(used),
        }
    }
}

impl<B: Disk> Explicit<B> {
    /// Returns whether no contact can ever come again: the casing, whatever the blades
    /// do, never reaches one.
    pub(in crate::motion::explicit) fn no_contact_to_come(&self) -> bool {
        if !self.scene.solver.shortcuts.proofs
            || self.leaps.held.is_some()
            || self.leaps.sliding.is_some()
            || self.drive.pulse_to_come(self.n)
        {
            return false;
        }
        if self.goes_beyond {
            return self.rests();
        }
        let skipped = |coordinate| self.casing.skip(coordinate, self.leaps.block.used());
        self.leaps.block.length == ENDLESS
            || self.casing.reach_of(self.u.map(skipped)).0 < self.machine.polygon.clearance
    }
}

impl<B: Disk> Explicit<B> {
    /// Begins a block without end of a lock, if it can.
    fn hold_lock(&mut self) -> bool {
        let Some(corner) = self.hold_corner() else { return false };
        self.leaps.held = Some(corner);
        self.leaps.block = Block::new(ENDLESS);
        true
    }

    /// Keeps how a held lock beyond the paper goes on: flows of energy, and looks at the
    /// swing of the tips.
    fn log_lock(&mut self, corner: &HeldCorner, before: u64) {
        let used = self.leaps.block.used();
        if let Some([work, casing, blades, heat]) = corner.flows(before, used) {
            self.beyond.account.sums += EnergyAccount {
                rotor_work_j: work,
                casing_loss_j: casing,
                blade_loss_j: blades,
                friction_heat_j: heat,
                ..EnergyAccount::default()
            };
        }
        while let Some(n) = self.beyond.look_until(self.n + used) {
            let swing = self.tips.rise.abs() * corner.amplitude(n.saturating_sub(self.n));
            self.beyond.lasting.look_at_tips(self.time_of(n), swing);
        }
    }

    /// Records what the steps of a held lock did since `before`.
    fn log_held(&mut self, corner: &HeldCorner, before: u64) {
        let (used, t) = (self.leaps.block.used(), self.time_of(self.latest_step()));
        for (side, sum) in corner.by_side(corner.sums(before, used)) {
            self.record.impulse(side, sum);
        }
        self.record.log.touch(t, self.record.log.active_set);
        self.record.deepest = self.record.deepest.max(corner.deepest());
        if corner.pulls {
            self.record.log.tensile_steps += used - before;
            self.record.log.last_tensile = Some(t);
        }
        if self.goes_beyond {
            self.log_lock(corner, before);
        }
    }
}

impl<B: Disk> Explicit<B> {
    /// The verdict, once nothing to come can change it: no contact can come
    /// again, or a corner can never let go.
    pub(in crate::motion::explicit) fn decided(&self) -> Option<Verdict> {
        if let Some(failure) = &self.failure {
            let beyond = failure.verdict_beyond(&self.drive.pulse);
            Some(if self.goes_beyond { beyond } else { Verdict::Failed })
        } else if !self.scene.solver.shortcuts.proofs {
            None
        } else if self.no_contact_to_come() {
            Some(Verdict::Decay)
        } else if let Some(held) = &self.leaps.held {
            held.is_certain.then(|| locked(held.pulls))
        } else if self.goes_beyond || self.blades.held_modes().is_some() {
            self.dies().then_some(Verdict::Decay)
        } else {
            self.corner_for_good()
        }
    }

    /// A corner of blades one by one, if at constant speed its pushes cannot change their
    /// signs any more: an angle, its rate and its acceleration enter them with
    /// at most all rates squared times the distance of the corner over its sine. Pushes that
    /// stay swing the blades about another rest, which is no farther than the same torque
    /// brings all modes at the least stiffness.
    fn corner_for_good(&self) -> Option<Verdict> {
        let machine = &self.machine;
        let sides = self.steady_corner_since(0).filter(|_| machine.polygon.has_corners())?;
        let sum = |side| {
            let rows = self.rows.iter().filter(|row| row.side == side);
            rows.map(|row| row.lambda).sum::<f64>()
        };
        let [a, b] = sides.map(sum);
        let (sin, cos) = machine.polygon.delta.sin_cos();
        let turn = (2.0 * machine.polygon.delta).cos();
        let least = self.law.hold([a, b], turn);
        let damping = machine.casing_damping_ratio * machine.omega_c
            + machine.blade_damping_ratio * machine.omega_bd_max;
        let nu = machine.nu(self.drive.speed(self.n)).abs();
        let rates = nu + machine.omega_c + machine.omega_bd_max + 2.0 * damping;
        let moment_arm = machine.nodal_diameters * machine.polygon.half_side();
        let torque = moment_arm * (a.abs() + b.abs());
        let rest = 2.0 * torque / self.scene.disk_in_use().stiffness_nm_per_rad;
        let turned = machine.nodal_diameters * (self.blades.reach() + rest);
        let distance = machine.clearance() / (sin * cos);
        let change = 2.0 * turned * rates * rates * distance * machine.casing_mass;
        let light = moment_arm * moment_arm * self.blades.compliance(0, 0)
            < LIGHT_BLADES * self.casing.compliance;
        let least = if self.law.pulls() { least.min(a.abs()).min(b.abs()) } else { least };
        let certain = light && least > CERTAIN_PUSH * machine.push_scale(nu);
        (certain && change < ROOM_TO_CHANGE * least).then(|| locked(a > 0.0 || b > 0.0))
    }
}

fn locked(pulls: bool) -> Verdict {
    if pulls { Verdict::Adhesive } else { Verdict::Locked }
}
