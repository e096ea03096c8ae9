//! Whether a lock that swings too far to be leapt over lasts to the end: its linear motion about
//! rest is followed, a small part of a turn at a time, until bounds say the rest
//! (docs/theory.md, section 9). The pushes may change their signs under a law that pulls, if
//! one pulls at rest, and at some step of the part of the run that the verdict is about.

use super::held_corner::{Resting, Standing, as_coordinates};
use crate::motion::explicit::Explicit;
use crate::motion::explicit::disk::{Disk, ModalBlades};
use crate::motion::explicit::oscillator::{LARGEST, Leap};
use crate::tolerances::{ANGLE_LOOK, FOLLOWED_LOOKS, FOLLOWED_ROOM, KEPT_TURN, LAST_PART};

impl<B: Disk> Explicit<B> {
    /// Whether such a lock pulls, if nothing that matters to it ever changes its sign.
    pub(super) fn lock_for_good(&self) -> Option<bool> {
        let sides = self.steady_corner_since(0)?;
        let standing = self.stand_in(sides, true)?;
        let pulls = (0..2).any(|k| standing.resting.value(k) > 0.0);
        self.lasts(&standing, pulls).then_some(pulls)
    }

    /// Whether all gaps keep their signs from now on, and either all pushes do or one
    /// `pulls` before the end.
    fn lasts(&self, standing: &Standing, pulls: bool) -> bool {
        let Standing { step, resting, start, growth, swing } = standing;
        let all = !(pulls && self.law.pulls());
        let Some(blades) = step.blades() else {
            return self.is_kept(step, resting, *swing, true);
        };
        let (leap, exponent) = steps_of(resting, blades);
        let stride = (1_u64 << exponent) as f64;
        let end = self.scene.solver.end_s / self.drive.step;
        let verdict_from = (1.0 - LAST_PART) * end - self.n as f64;
        let (mut at, mut steps, mut pulled) = (*start, 0.0, all);
        for _ in 0..FOLLOWED_LOOKS {
            let reach = blades.oscillator().reach_of(as_coordinates(at));
            // What the modes turn between two looks bends a value by its square.
            let bends = |k: usize| ANGLE_LOOK * ANGLE_LOOK * resting.moves(k, reach);
            let moved = |k: usize| resting.slopes[k].dot(&at);
            pulled |= steps >= verdict_from
                && (0..2).any(|k| resting.value(k) > 0.0 && moved(k) + resting.value(k) > bends(k));
            let small = self.machine.nodal_diameters * reach.0 < KEPT_TURN;
            let grown = (growth * reach.0, growth * reach.1);
            if small && self.is_kept(step, resting, grown, all) {
                if pulled {
                    return true;
                }
                // Nothing but a push of the last part is left to find.
                let ahead = stride.max(verdict_from - steps).floor();
                (at, steps) = (leap.apply(at, ahead as u64), steps + ahead);
                continue;
            }
            let keeps = |k: usize| {
                let fits = resting.sign_fits(k, self.law.pulls());
                fits && moved(k).abs() + bends(k) < FOLLOWED_ROOM * resting.value(k).abs()
            };
            let far = !self.goes_beyond || self.is_far_from_others(step, resting, reach.0);
            if !(small && far && (0..4).filter(|&k| all || k >= 2).all(keeps)) {
                return false;
            }
            (at, steps) = (leap.doubled(at, exponent), steps + stride);
        }
        false
    }
}

/// The map of the deviation, and the exponent of so many steps that it turns by a look.
fn steps_of(resting: &Resting, blades: &ModalBlades) -> (Leap<4>, usize) {
    let turn = blades.oscillator().turn();
    let mut scaled = resting.change;
    for (row, column) in [(0, 2), (0, 3), (1, 2), (1, 3)] {
        scaled[(row, column)] *= turn;
        scaled[(column, row)] /= turn;
    }
    let steps = ANGLE_LOOK / scaled.norm();
    let exponent = (0..LARGEST).rev().find(|&k| (1_u64 << k) as f64 <= steps);
    (Leap::new(resting.change), exponent.unwrap_or(0))
}
