//! Rocking into a corner: impacts on its two sides in turn that accumulate, summed to their limit
//! (docs/theory.md, section 5).
//!
//! On side `b` the gap of side `a` opens with the rate `v` and is pulled back by the acceleration
//! `A_a`; it closes after `t(v) = 2 v/A_a (1 - 2 c v/(3 A_a))` with the rate
//! `v (1 - 4 c v/(3 A_a))`, where `c` is the damping of the casing. The impact opens the gap of `b`
//! with the part `r_a = W_ba/W_aa` of that rate. The time left is
//! `T_a(v) = t(v) + T_b(r_a v (1 - ..)) = p_a v + q_a v^2`, of which
//!
//! - `p_a = 2/A_a + r_a p_b`
//! - `q_a = -4 c/(3 A_a) (1/A_a + r_a p_b) + r_a^2 q_b`
//!
//! and the same with `a` and `b` exchanged. The relative error is the square of `T` in radians of the
//! fastest rate. Meanwhile the casing is within the square of one excursion of its corner.

use super::Events;
use super::seek::{Ending, OpenedGap};
use super::stretch::Held;
use crate::motion::point::Point;
use crate::motion::{ActiveSet, FailureReason, Plane};

/// Rocking of rigid blades is summed once the rest of it takes less than this part of the time of
/// one radian of all rates. Larger: the state is wrong by more than 1e-10 of the clearance.
const BRIEF: f64 = 1e-3;

/// The same for moving blades, which vibrate meanwhile. Larger: the neglected rocking changes their
/// vibration.
const BRIEF_FOR_BLADES: f64 = 1e-6;

/// Rocking is summed if both sides push by more than this many Coriolis terms of the rate. Smaller: a
/// contact could open during the rocking.
const MARGIN: f64 = 4.0;

impl Events {
    /// Returns the time until the motion that touches the row `b` and has just left the row `a` rests
    /// in their corner, if it can do nothing else and the time is brief \[s\].
    pub(super) fn rocking(&self, point: &Point, b: usize, a: &OpenedGap) -> Option<f64> {
        let flow = &self.flow;
        let sloped = flow.blades.is_some() && flow.diameters() == 0.0;
        if self.force() != Plane::default() || flow.restitution != 0.0 || sloped {
            return None;
        }
        let [fa, fb] = [a.row, b].map(|row| flow.face(row, point));
        let own = [fa.joint(&fa), fb.joint(&fb)];
        let [r_a, r_b] = [fb.joint(&fa) / own[0], fa.joint(&fb) / own[1]];
        let rigid = flow.blades.is_none() && flow.turn.im == 0.0;
        let rest = if rigid { Point { dz: Plane::default(), ..*point } } else { *point };
        let free = flow.free(&rest, Plane::default());
        let [q_a, q_b] = [&fa, &fb].map(|face| flow.gap_bend(face, &rest, free));
        let margin = MARGIN * flow.nu.abs() * a.rate;
        let pulls = [r_b * q_b - q_a, r_a * q_a - q_b];
        let rocks = q_a.max(q_b) < -margin
            && pulls[0].min(pulls[1]) > 0.0
            && r_a.min(r_b) > 0.0
            && r_a * r_b < 1.0;
        if !rocks {
            return None;
        }
        let both = 1.0 / (1.0 - r_a * r_b);
        let first = [2.0 / pulls[0], 2.0 / pulls[1]];
        let p = [(first[0] + r_a * first[1]) * both, (first[1] + r_b * first[0]) * both];
        let rates = flow.rates();
        if p[0] * a.rate * rates > if rigid { BRIEF } else { BRIEF_FOR_BLADES } {
            return None;
        }
        let loss = 4.0 / 3.0 * flow.casing.damping;
        let second = [
            -loss / pulls[0] * (1.0 / pulls[0] + r_a * p[1]),
            -loss / pulls[1] * (1.0 / pulls[1] + r_b * p[0]),
        ];
        let q = (second[0] + r_a * r_a * second[1]) / (1.0 - (r_a * r_b).powi(2));
        Some(a.rate * (p[0] + q * a.rate))
    }

    /// Keeps the casing in the corner of two rows while it rocks for `time` seconds, in contact with
    /// the first of them, until it rests.
    pub(super) fn rock(&mut self, point: &mut Point, rows: [usize; 2], time: f64) {
        let before = self.flow.energy(point, 0.0);
        let closed = Held::new(rows.into_iter().map(|row| (row, self.flow.face(row, point))))
            .and_then(|mut held| held.close(&self.flow, point).map(|()| held));
        let Some(held) = closed else {
            self.fail_at(point, FailureReason::Singular { rows: 2 });
            return;
        };
        self.ledger.sums.impact_loss_j += before - self.flow.energy(point, 0.0);
        self.run.hold(ActiveSet::Nothing.with(rows[0] as u32));
        self.opened.retain(|gap| !rows.contains(&gap.row));
        self.rest = std::sync::OnceLock::new();
        self.stretch.begin(&self.flow, &held, *point, Plane::default(), time);
        self.held = held;
        self.next = (time, Ending::Lock);
    }
}
