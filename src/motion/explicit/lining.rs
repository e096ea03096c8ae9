//! A lining in one step: it pushes by the gaps at the beginning of the step
//! (docs/theory.md, section 10).

use super::Explicit;
use super::disk::Disk;
use super::pushes::push;
use super::rows::TipLaw;
use crate::motion::Plane;

impl<B: Disk> Explicit<B> {
    /// Corrects a predicted step by the pushes of its beginning; whether to look at the
    /// blades.
    pub(super) fn push_lining(&mut self) -> bool {
        if self.rows.is_empty() {
            return false;
        }
        let n = self.n - 1;
        let tips = self.tips_at(n);
        let (c, s) = self.drive.turn(n);
        let turn = Plane::new(c, s);
        let Self { rows, casing, blades, .. } = self;
        let (shift, change) = push(rows, &tips, casing.compliance, blades);
        self.shift_casing(shift, turn);
        if !self.beyond.account.forgone {
            for place in 0..self.rows.len() {
                let row = self.rows[place];
                self.count_push(&row, turn, &tips);
            }
        }
        self.watch.moved(change)
    }

    /// The pushes of the lining at the latest step.
    pub(super) fn press(&mut self, tips: &TipLaw, bound: f64) {
        let (z, _) = self.in_blade_frame();
        self.find_pressed(z, tips, bound);
        if self.rows.is_empty() {
            self.part();
        } else {
            self.keep_rows();
            let swing = self.swing_of_blades();
            let wave = self.blades.modal();
            let rise = Plane::new(wave[0], wave[1]) * tips.rise;
            self.beyond.lasting.look(self.time_of(self.n), z, rise, swing);
        }
    }

    /// Fills `rows` with those that press on the lining now.
    pub(super) fn find_pressed(&mut self, z: Plane, tips: &TipLaw, bound: f64) {
        let Some(lining) = self.lining else { return };
        self.find_candidates(z, tips, bound, 0.0);
        self.rows.clear();
        let each = f64::from(self.blades.table().blades_per_row);
        let (mut energy, mut deepest) = (0.0, 0.0_f64);
        for place in 0..self.beyond.candidates.len() {
            let mut row = self.row_at(self.beyond.candidates[place], z, tips);
            let gap = row.place.gap;
            if gap < 0.0 {
                row.lambda = -each * lining.push(gap);
                energy += each * lining.energy(gap);
                deepest = deepest.max(-gap);
                self.rows.push(row);
            }
        }
        self.record.deepest = self.record.deepest.max(deepest);
        self.beyond.account.press(energy);
    }
}
