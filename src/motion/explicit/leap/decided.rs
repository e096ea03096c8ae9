//! Verdicts of the explicit solver that nothing to come can change
//! (docs/theory.md, section 9).

use super::held::Held;
use crate::motion::Verdict;
use crate::motion::explicit::Explicit;
use crate::motion::explicit::disk::Disk;
use crate::tolerances::{HELD_AFTER, LIGHT_BLADES, ROOM_TO_CHANGE};

impl<B: Disk> Explicit<B> {
    /// The verdict, once nothing to come can change it: no contact can come
    /// again, or a corner can never let go.
    pub(in crate::motion::explicit) fn decided(&self) -> Option<Verdict> {
        if let Some(failure) = &self.failure {
            let beyond = failure.verdict_beyond(&self.drive.pulse);
            Some(if self.goes_beyond { beyond } else { Verdict::Failed })
        } else if self.no_contact_to_come() {
            Some(Verdict::Decay)
        } else if let Some(Held::Corner(held)) = &self.leaps.held {
            Some(locked(held.pulls))
        } else if self.goes_beyond {
            None
        } else if self.blades.held_modes().is_none() {
            self.corner_for_good()
        } else {
            None
        }
    }

    /// A corner of blades of their own, if at constant speed its pushes cannot
    /// vanish any more: an angle, its rate and its acceleration enter them with
    /// at most all rates squared times the distance of the corner over its sine.
    fn corner_for_good(&self) -> Option<Verdict> {
        let sides = self.steady_corner()?;
        let since = (self.record.log.since / self.drive.step) as u64;
        let machine = &self.machine;
        if self.n < since + HELD_AFTER || !machine.polygon.has_corners() {
            return None;
        }
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
        let turned = machine.nodal_diameters * self.blades.reach();
        let distance = machine.clearance() / (sin * cos);
        let change = 2.0 * turned * rates * rates * distance * machine.casing_mass;
        let moment_arm = machine.nodal_diameters * machine.polygon.half_side();
        let light = moment_arm * moment_arm * self.blades.compliance(0, 0)
            < LIGHT_BLADES * self.casing.compliance;
        (light && change < ROOM_TO_CHANGE * least).then(|| locked(a > 0.0 || b > 0.0))
    }
}

fn locked(pulls: bool) -> Verdict {
    if pulls { Verdict::Adhesive } else { Verdict::Locked }
}
