//! What a step leaves in the record: sides that touch, impacts, impulses, and what the
//! verdict needs.

use super::Coupled;
use super::blades::TipModel;
use super::lasting::mark;
use crate::motion::{ActiveSet, Plane};

impl<B: TipModel> Coupled<B> {
    /// Bookkeeping of a step without contact.
    pub(super) fn part(&mut self) {
        self.rows_are_open();
        self.dips = [0.0, self.dips[0]];
        self.look_at_swing();
    }

    fn rows_are_open(&mut self) {
        if self.record.is_over(self.n) {
            self.record.end_contact(self.n);
            self.lasting.touch(self.time_of(self.n), 0, false);
            self.rows.clear();
        }
    }

    /// Keeps how far the tips swing, as often as needed.
    pub(super) fn look_at_swing(&mut self) {
        if self.n >= self.next_look {
            self.next_look = self.n + self.steps_unseen;
            let swing = self.swing_of_blades();
            self.lasting.look(self.time_of(self.n), Plane::default(), Plane::default(), swing);
        }
    }

    /// How far the tips swing outward about their mean \[m\].
    pub(super) fn swing_of_blades(&mut self) -> f64 {
        let rise = self.machine.radial_coupling * self.machine.blade_length;
        if rise == 0.0 { 0.0 } else { rise.abs() * self.blades.swing() }
    }

    /// Keeps the contact of this step: the rows that push, the impacts.
    pub(super) fn keep(&mut self) {
        let (n, t) = (self.n, self.time_of(self.n));
        let mut active_set = ActiveSet::Nothing;
        let (mut set, mut count, mut pulls) = (0_u64, 0, false);
        for row in self.rows.iter().filter(|row| row.lambda != 0.0) {
            self.record.push(n, row.side, row.lambda);
            active_set = active_set.with(row.side);
            set = set.wrapping_add(mark(row.index));
            count += 1;
            pulls |= row.lambda > 0.0;
        }
        if active_set == ActiveSet::Nothing {
            self.rows_are_open();
            return;
        }
        self.record.touch(n, active_set, pulls);
        let all = count == self.blades.table().count();
        let since = self.lasting.touch(t, set, all);
        if active_set == ActiveSet::Many {
            self.record.log.since = since;
        }
    }
}
