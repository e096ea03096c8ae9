//! What a step leaves in the record: sides that touch, impacts, impulses, and what the
//! verdict needs.

use super::Coupled;
use super::blades::TipModel;
use super::lasting::mark;
use crate::motion::{ActiveSet, Plane};
use crate::tolerances::BREAK_STEPS;

impl<B: TipModel> Coupled<B> {
    /// Bookkeeping of a step without contact.
    pub(super) fn part(&mut self) {
        self.rows_are_open();
        self.dips = [0.0, self.dips[0]];
        self.look_at_swing();
    }

    fn rows_are_open(&mut self) {
        if self.log.active_set != ActiveSet::Nothing && self.n > self.last_touch + BREAK_STEPS {
            let t = self.time_of(self.n);
            self.log.touch(t, ActiveSet::Nothing);
            self.lasting.touch(t, 0, false);
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
    pub(super) fn record(&mut self) {
        let (n, t) = (self.n, self.time_of(self.n));
        let mut active_set = ActiveSet::Nothing;
        let (mut set, mut count, mut pulls) = (0_u64, 0, false);
        for row in self.rows.iter().filter(|row| row.lambda != 0.0) {
            let last = &mut self.touched[row.side as usize];
            // What is pressed at the start did not hit.
            if n > 0 && (*last == 0 || n + 1 > *last + BREAK_STEPS) {
                self.log.impact(t, row.side);
            }
            *last = n + 1;
            self.impulses[row.side as usize] += row.lambda * self.step;
            active_set = active_set.with(row.side);
            set = set.wrapping_add(mark(row.index));
            count += 1;
            pulls |= row.lambda > 0.0;
        }
        if active_set == ActiveSet::Nothing {
            self.rows_are_open();
            return;
        }
        self.last_touch = n;
        self.log.touch(t, active_set);
        let all = count == self.blades.table().count();
        let since = self.lasting.touch(t, set, all);
        if active_set == ActiveSet::Many {
            self.log.since = since;
        }
        if pulls {
            self.log.tensile(t);
        }
    }
}
