//! A lining in one step: it pushes by the gaps at the beginning of the step
//! (docs/theory.md, section 10).

use super::Coupled;
use super::blades::TipModel;
use super::rows::{Row, TipLaw};
use crate::motion::Plane;
use crate::motion::explicit::{Coordinate, Oscillator};

impl<B: TipModel> Coupled<B> {
    /// Corrects a predicted step by the pushes of its beginning.
    pub(super) fn push_lining(&mut self) {
        if self.rows.is_empty() {
            return;
        }
        let tips = self.tips_at(self.n);
        let (_, turn) = self.in_blade_frame();
        let Self { rows, casing, u, blades, .. } = self;
        push(rows, &tips, turn, casing, u, blades);
        if self.account.forgone {
            return;
        }
        // The step that is counted is the one that these pushes began.
        self.n += 1;
        for place in 0..self.rows.len() {
            let row = self.rows[place];
            self.count_push(&row, turn, &tips);
        }
        self.n -= 1;
    }

    /// The pushes of the lining at the latest step.
    pub(super) fn press(&mut self, tips: &TipLaw, bound: f64) {
        let (z, _) = self.in_blade_frame();
        self.find_pressed(z, tips, bound);
        if self.rows.is_empty() {
            self.part();
        } else {
            self.keep();
            let swing = self.swing_of_blades();
            let wave = self.blades.modal().0;
            let rise = Plane::new(wave[0], wave[1]) * tips.rise;
            self.lasting.look(self.time_of(self.n), z, rise, swing);
        }
    }

    /// Fills `rows` with those that press on the lining now.
    pub(super) fn find_pressed(&mut self, z: Plane, tips: &TipLaw, bound: f64) {
        let Some(lining) = self.lining else { return };
        self.find_candidates(z, tips, bound, 0.0);
        self.rows.clear();
        let each = f64::from(self.blades.table().blades_per_row);
        let (mut energy, mut deepest) = (0.0, 0.0_f64);
        for place in 0..self.candidates.len() {
            let mut row = self.row_at(self.candidates[place], z, tips);
            let gap = row.place.gap;
            if gap < 0.0 {
                row.lambda = -each * lining.push(gap);
                energy += each * lining.energy(gap);
                deepest = deepest.max(-gap);
                self.rows.push(row);
            }
        }
        self.record.deepest = self.record.deepest.max(deepest);
        self.account.press(energy);
    }
}

/// What these rows do to casing and blades in one step; the casing after it in the frame
/// of the blades has moved by the result.
pub(super) fn push<B: TipModel>(
    rows: &[Row],
    tips: &TipLaw,
    turn: Plane,
    casing: &Oscillator,
    u: &mut [Coordinate; 2],
    blades: &mut B,
) -> Plane {
    let mut shift = Plane::default();
    for row in rows.iter().filter(|row| row.lambda != 0.0) {
        shift -= tips.push_on_casing(row.place.normal) * (casing.compliance * row.lambda);
        blades.correct(row.index, -row.lambda * (row.place.moment_arm - tips.pushed));
    }
    let moved = shift * turn;
    for (coordinate, part) in u.iter_mut().zip([moved.re, moved.im]) {
        coordinate.x += part;
        coordinate.increment += part;
    }
    shift
}
