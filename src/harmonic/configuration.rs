//! The configuration of casing and blades in the blade frame: the point `z` and the
//! two blade modes, in numbers of order one. They determine every contact and gap.

use super::stability::ClosedSide;
use crate::model::ContactPolygon;

/// `z` in units of `g0`, and the turns `n_d alpha_c`, `n_d alpha_s` \[rad\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Configuration {
    pub z: (f64, f64),
    pub turn: (f64, f64),
}

impl Configuration {
    /// From the turns `n_d alpha` of two neighbouring sides, by Eq. (20).
    pub fn of_pair(
        polygon: &ContactPolygon,
        z: (f64, f64),
        sides: [u32; 2],
        turns: [f64; 2],
    ) -> Self {
        let [(c_a, s_a), (c_b, s_b)] = sides.map(|side| polygon.direction(side));
        let sine = c_a * s_b - s_a * c_b;
        let turn_c = (turns[0] * s_b - turns[1] * s_a) / sine;
        let turn_s = (turns[1] * c_a - turns[0] * c_b) / sine;
        Self { z, turn: (turn_c, turn_s) }
    }

    /// With the blade modes bent by these contacts, given as side, scaled
    /// multiplier and moment arm; `compliance` is softness times share.
    pub fn bent(
        polygon: &ContactPolygon,
        z: (f64, f64),
        compliance: f64,
        loads: &[(u32, f64, f64)],
    ) -> Self {
        let mut turn = (0.0, 0.0);
        for &(side, multiplier, arm) in loads {
            let (c, s) = polygon.direction(side);
            turn.0 -= compliance * multiplier * arm * c;
            turn.1 -= compliance * multiplier * arm * s;
        }
        Self { z, turn }
    }

    /// `exp(i (psi + n_d alpha))` of a side.
    pub fn direction(&self, polygon: &ContactPolygon, side: u32) -> (f64, f64) {
        let (c, s) = polygon.direction(side);
        let (sin, cos) = (c * self.turn.0 + s * self.turn.1).sin_cos();
        (c * cos - s * sin, s * cos + c * sin)
    }

    /// Gap of a side over `g0`.
    pub fn gap(&self, polygon: &ContactPolygon, side: u32) -> f64 {
        let (c, s) = self.direction(polygon, side);
        1.0 + self.z.0 * c + self.z.1 * s
    }

    /// Smallest gap over `g0` of the sides not in `contacts`; infinite if there
    /// are none.
    pub fn smallest_gap(&self, polygon: &ContactPolygon, contacts: &[u32]) -> f64 {
        (0..polygon.sides)
            .filter(|side| !contacts.contains(side))
            .map(|side| self.gap(polygon, side))
            .fold(f64::INFINITY, f64::min)
    }

    /// A side in contact with this (scaled) multiplier.
    pub fn held(&self, polygon: &ContactPolygon, side: u32, multiplier: f64) -> ClosedSide {
        let direction = self.direction(polygon, side);
        let arm = self.z.1 * direction.0 - self.z.0 * direction.1;
        ClosedSide { phase: polygon.direction(side), direction, arm, multiplier }
    }
}
