//! Records of a motion in steps: contacts, impulses and penetrations.

use crate::model::ContactPolygon;
use crate::motion::contacts::in_phase_order;
use crate::motion::{ActiveSet, ContactLog};

/// Steps without contact before a contact counts as broken: the impact of the
/// scheme takes two steps, and its rounding may open one step between them.
/// More: two impacts count as one.
const BREAK_STEPS: u64 = 2;

/// Record of a motion in steps of constant length.
#[derive(Clone, Debug)]
pub(super) struct Record {
    pub log: ContactLog,
    pub last_touch: u64,
    /// Deepest penetration left by a step \[m\].
    pub deepest: f64,
    /// Deepest predicted one \[m\].
    pub deepest_predicted: f64,
    step: f64,
    /// Step of the latest contact of each side, plus one; 0 for none.
    touched: Vec<u64>,
    /// Impulse on each side since the start, and the part of it that `take_mean_forces` has returned,
    /// up to which step \[N s\].
    impulses: Vec<f64>,
    told: Vec<f64>,
    told_until: u64,
}

impl Record {
    /// Creates the record for a polygon with this number of sides and this step \[s\].
    pub fn of(sides: u32, step: f64) -> Self {
        Self {
            log: ContactLog::default(),
            last_touch: 0,
            deepest: 0.0,
            deepest_predicted: 0.0,
            step,
            touched: vec![0; sides as usize],
            impulses: vec![0.0; sides as usize],
            told: vec![0.0; sides as usize],
            told_until: 0,
        }
    }

    fn time_of(&self, n: u64) -> f64 {
        n as f64 * self.step
    }

    /// Records a multiplier on a side in step `n`.
    pub fn push(&mut self, n: u64, side: u32, lambda: f64) {
        self.meet(n, side);
        self.impulse(side, lambda);
    }

    /// Records that a side touches in step `n`. Contact at the start is not an impact.
    pub fn meet(&mut self, n: u64, side: u32) {
        let last = self.touched[side as usize];
        if n > 0 && (last == 0 || n + 1 > last + BREAK_STEPS) {
            self.log.impact(self.time_of(n), side);
        }
        self.keep_touching(n, side);
    }

    /// Records that a side, which touched before, still touches in step `n`.
    pub fn keep_touching(&mut self, n: u64, side: u32) {
        self.touched[side as usize] = n + 1;
    }

    /// Adds the sum of the multipliers of several steps on a side.
    pub fn impulse(&mut self, side: u32, sum: f64) {
        self.impulses[side as usize] += sum * self.step;
    }

    /// Records that these sides touch in step `n`, and whether any pulls.
    pub fn touch(&mut self, n: u64, active_set: ActiveSet, pulls: bool) {
        self.last_touch = n;
        self.log.touch(self.time_of(n), active_set);
        if pulls {
            self.log.tensile(self.time_of(n));
        }
    }

    /// Returns whether the contact is over at step `n`, in which nothing touches.
    pub fn is_over(&self, n: u64) -> bool {
        self.log.active_set != ActiveSet::Nothing && n > self.last_touch + BREAK_STEPS
    }

    /// Records that nothing touches from step `n` on.
    pub fn end_contact(&mut self, n: u64) {
        self.log.touch(self.time_of(n), ActiveSet::Nothing);
    }

    /// Returns the sums of the multipliers of each side, in order of phase; none without contact.
    pub fn by_side(
        &self,
        polygon: &ContactPolygon,
        rows: impl Iterator<Item = (u32, f64)>,
    ) -> Vec<(u32, f64)> {
        let mut sums: Vec<(u32, f64)> = Vec::new();
        if self.log.active_set == ActiveSet::Nothing {
            return sums;
        }
        for (side, lambda) in rows.filter(|(_, lambda)| *lambda != 0.0) {
            match sums.iter_mut().find(|(known, _)| *known == side) {
                Some((_, sum)) => *sum += lambda,
                None => sums.push((side, lambda)),
            }
        }
        in_phase_order(polygon, &mut sums);
        sums
    }

    /// Returns the mean forces on the sides since the last call, until step `n` \[N\].
    pub fn take_mean_forces(&mut self, polygon: &ContactPolygon, n: u64) -> Vec<(u32, f64)> {
        let span = self.time_of(n.saturating_sub(self.told_until));
        self.told_until = n;
        let mut means = Vec::new();
        for (side, (impulse, told)) in self.impulses.iter().zip(&mut self.told).enumerate() {
            if impulse != told && span > 0.0 {
                means.push((side as u32, (impulse - *told) / span));
                *told = *impulse;
            }
        }
        in_phase_order(polygon, &mut means);
        means
    }

    /// Copies the state of `take_mean_forces` from another record of the same motion.
    pub fn keep_told(&mut self, of: &mut Self) {
        self.told = std::mem::take(&mut of.told);
        self.told_until = of.told_until;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contact_is_over_and_a_new_one_an_impact_after_a_pause_of_more_than_two_steps() {
        for pause in 0..6 {
            let mut record = Record::of(11, 1e-6);
            record.push(10, 4, -1.0);
            record.touch(10, ActiveSet::Side(4), false);
            let next = 10 + pause;
            assert_eq!(record.is_over(next), pause > BREAK_STEPS, "{pause}");
            record.meet(next + 1, 4);
            assert_eq!(record.log.impact_count, 1 + u64::from(pause >= BREAK_STEPS), "{pause}");
        }
    }
}
