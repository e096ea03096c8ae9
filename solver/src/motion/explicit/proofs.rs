//! Verdicts that no later motion can change (docs/theory.md, section 9).

use super::{Explicit, Lining};
use crate::harmonic::Locks;
use crate::model::CERTAIN_PUSH;
use crate::model::LARGEST_BLADE_ANGLE;
use crate::motion::{ActiveSet, Verdict};

/// Steps a corner must have been closed before it counts as held. Fewer: a crossing counts.
const HELD_AFTER: u64 = 64;

/// Mass ratio of the blades in a corner below which their inertia changes its contact forces by less
/// than the room left to them.
const LIGHT_BLADES: f64 = 1e-3;

/// Largest bound on the change of a contact force, multiplier or gap, relative to its value, for which
/// its sign counts as certain: half of what would be needed, as a reserve.
const ROOM_TO_CHANGE: f64 = 0.5;

impl Explicit {
    /// Returns whether no contact can come again: once pulse and lining are over, the energies of
    /// casing and blades, which free steps never increase, do not reach the smallest clearance.
    pub(super) fn cannot_touch_again(&self) -> bool {
        let least = self.tips.least;
        let pressed = self.lining.as_ref().is_some_and(Lining::presses);
        if pressed
            || least <= 0.0
            || self.drive.pulse_to_come(self.n)
            || self.drive.excitation.is_some()
            || self.follows_speed()
        {
            return false;
        }
        let reach = self.disk.reach();
        // A blade that turns too far would make the run fail.
        if reach > LARGEST_BLADE_ANGLE {
            return false;
        }
        let rise = self.tips.rise.abs();
        let risen = if rise == 0.0 { 0.0 } else { rise * reach };
        risen < least && self.casing.reach(&self.u) + risen < least
    }

    /// Returns the verdict if no later motion can change it.
    pub(super) fn decided(&self) -> Option<Verdict> {
        if let Some(failure) = &self.failure {
            let beyond = self.scene.goes_beyond();
            return Some(if beyond {
                failure.verdict_beyond(&self.drive.pulse)
            } else {
                Verdict::Failed
            });
        }
        if self.scene.solver.plain {
            None
        } else if self.cannot_touch_again() {
            Some(Verdict::Decay)
        } else {
            self.corner_for_good()
        }
    }

    /// Returns the sides of a corner that has been closed for some steps without a break, where
    /// neither pulse nor ramp nor excitation acts.
    pub(super) fn held_corner(&self) -> Option<[u32; 2]> {
        let ActiveSet::Corner(a, b) = self.record.log.active_set else { return None };
        // Pushes after a change are known once steps are taken.
        let since = ((self.record.log.since / self.drive.step) as u64).max(self.changed);
        let steady = self.drive.is_steady(self.n) && self.record.last_touch == self.n;
        (steady && self.lining.is_none() && self.n >= since + HELD_AFTER).then_some([a, b])
    }

    /// Returns the verdict on a corner that can never let go, at constant speed, of equal tips without
    /// slope and restitution in a round casing.
    ///
    /// Two closed gaps fix the casing: `Re[z exp(-i(psi_j + n_d alpha_j))] = -h_j`. With blades at
    /// rest `z` is a constant and so are the pushes. Blades turn a side by at most
    /// `phi = n_d (reach + rest)`: `reach` bounds their free vibration by its energy, and pushes that
    /// stay bend them about another rest by twice what their torque does at the least stiffness.
    /// That moves `z` by `phi |z|/sin`, with `sin` of half the angle between the normals, and its
    /// rates by as much times the sum of all rates, each once. So a push changes by at most
    /// `2 phi rates^2 m_c |z|/sin`, and keeps its sign where this is a part of it. The inertia of
    /// the blades must be light beside that of the casing.
    fn corner_for_good(&self) -> Option<Verdict> {
        let (machine, tips) = (&self.machine, &self.tips);
        let plain = tips.rise == 0.0 && !machine.is_uneven() && self.restitution == 0.0;
        let corner = self.held_corner().filter(|_| plain && self.disk.is_tuned());
        let sides = corner.filter(|_| machine.polygon.has_corners())?;
        let sum = |side| {
            let rows = self.rows.iter().filter(|row| row.side == side);
            rows.map(|row| row.lambda).sum::<f64>()
        };
        let [a, b] = sides.map(sum);
        let [first, second] = sides.map(|side| machine.polygon.phase(side));
        let apart = (second - first).cos();
        let sin_half = (0.5 * (1.0 - apart)).sqrt();
        let least = self.law.hold([a, b], apart);
        let least = if self.law.pulls() { least.min(a.abs()).min(b.abs()) } else { least };
        let damping = machine.casing_damping_ratio * machine.omega_c
            + machine.blade_damping_ratio * machine.omega_bd_max;
        let nu = machine.nu(self.drive.speed(self.n)).abs();
        let rates = nu + machine.omega_c + machine.omega_bd_max + 2.0 * damping;
        let distance = self.u[0].x.hypot(self.u[1].x);
        let torque: f64 = self.rows.iter().map(|row| row.torque(tips).abs()).sum();
        let arm = self.rows.iter().fold(0.0, |most, row| f64::max(most, row.arm.abs()));
        let rest = 2.0 * torque / self.scene.disk_in_use().stiffness_nm_per_rad;
        let phase = machine.nodal_diameters * (self.disk.reach() + rest);
        let change = 2.0 * phase * rates * rates * machine.casing_mass * distance / sin_half;
        let own = self.rows.first().map_or(0.0, |row| self.disk.compliance(row, row));
        let inertia = arm * (arm + tips.pushed.abs()) * own;
        let light = inertia < LIGHT_BLADES * self.casing.compliance;
        let certain = light && least > CERTAIN_PUSH * machine.push_scale(nu);
        let verdict = if a > 0.0 || b > 0.0 { Verdict::Adhesive } else { Verdict::Locked };
        let certain = certain && change < ROOM_TO_CHANGE * least;
        let speed = self.drive.speed(self.n);
        let asked = verdict == Verdict::Locked && !machine.rigid_blades;
        let holds = || !asked || Locks::new(machine, speed).hold(speed);
        (certain && holds()).then_some(verdict)
    }
}
