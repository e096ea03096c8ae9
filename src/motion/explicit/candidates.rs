//! Which rows may touch now: by the polygon where the blades move as the casing wave
//! does, otherwise one by one.

use super::Explicit;
use super::disk::Disk;
use super::rows::{Row, TipLaw};
use crate::model::ContactPolygon;
use crate::motion::Plane;

impl<B: Disk> Explicit<B> {
    /// The rows whose gaps may be below `reach` now, for blades within `bound`.
    pub(super) fn find_candidates(&mut self, z: Plane, tips: &TipLaw, bound: f64, reach: f64) {
        // A blade angle moves a gap by at most |z| n_d alpha beside its slope.
        let look = reach + tips.diameters * bound * (z.re.abs() + z.im.abs());
        self.beyond.candidates.clear();
        let wave = if tips.rise == 0.0 { Some(Plane::default()) } else { self.blades.wave() };
        match wave.filter(|_| self.blades.table().is_by_side()) {
            Some(wave) => self.walk(z - wave * tips.rise, look),
            None => {
                let polygon = &self.machine.polygon;
                let (table, angles, slack) = self.blades.estimates();
                let look = look + tips.rise.abs() * slack;
                for (row, (angle, &side)) in angles.iter().zip(&table.side).enumerate() {
                    if polygon.gap(side, z.re, z.im) - tips.rise * angle < look {
                        self.beyond.candidates.push(row as u32);
                    }
                }
            }
        }
    }

    /// The sides of the polygon whose gap at `w` is below `look`.
    fn walk(&mut self, w: Plane, look: f64) {
        self.near = self.follow(w);
        let polygon = &self.machine.polygon;
        let gap = |side| polygon.gap(side, w.re, w.im);
        let row = |side: u32| self.blades.table().of_side(side)[0];
        if gap(self.near) >= look {
            return;
        }
        self.beyond.candidates.push(row(self.near));
        let mut left = polygon.sides - 1;
        let ways: [fn(&ContactPolygon, u32) -> u32; 2] =
            [ContactPolygon::next, ContactPolygon::previous];
        for way in ways {
            let mut side = way(polygon, self.near);
            while left > 0 && gap(side) < look {
                self.beyond.candidates.push(row(side));
                side = way(polygon, side);
                left -= 1;
            }
        }
    }

    /// A candidate as a row, with its exact gap.
    pub(super) fn row_at(&mut self, index: u32, z: Plane, tips: &TipLaw) -> Row {
        let side = self.blades.table().side[index as usize];
        let angle = self.blades.angle(index);
        let place = tips.place(self.machine.polygon.direction(side), z, angle);
        Row { index, side, angle, place, lambda: 0.0 }
    }
}
