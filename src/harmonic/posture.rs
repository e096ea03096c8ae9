//! How casing and blades stand in the blade frame: the point `z` and the two
//! blade modes, in numbers of order one; from them every contact and gap.

use super::stability::Held;
use crate::model::Rim;

/// `z` in units of `g0`, and the turns `n_d alpha_c`, `n_d alpha_s` \[rad\].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Posture {
    pub z: (f64, f64),
    pub turn: (f64, f64),
}

impl Posture {
    /// From the turns `n_d alpha` of two neighbouring sides, by Eq. (20).
    pub fn of_pair(rim: &Rim, z: (f64, f64), sides: [u32; 2], turns: [f64; 2]) -> Self {
        let [(c_a, s_a), (c_b, s_b)] = sides.map(|side| rim.direction(side));
        let sine = c_a * s_b - s_a * c_b;
        let turn_c = (turns[0] * s_b - turns[1] * s_a) / sine;
        let turn_s = (turns[1] * c_a - turns[0] * c_b) / sine;
        Self { z, turn: (turn_c, turn_s) }
    }

    /// With the blade modes bent by these contacts, given as side, scaled
    /// multiplier and lever; `compliance` is softness times share.
    pub fn bent(rim: &Rim, z: (f64, f64), compliance: f64, loads: &[(u32, f64, f64)]) -> Self {
        let mut turn = (0.0, 0.0);
        for &(side, multiplier, arm) in loads {
            let (c, s) = rim.direction(side);
            turn.0 -= compliance * multiplier * arm * c;
            turn.1 -= compliance * multiplier * arm * s;
        }
        Self { z, turn }
    }

    /// `exp(i (psi + n_d alpha))` of a side.
    pub fn direction(&self, rim: &Rim, side: u32) -> (f64, f64) {
        let (c, s) = rim.direction(side);
        let (sin, cos) = (c * self.turn.0 + s * self.turn.1).sin_cos();
        (c * cos - s * sin, s * cos + c * sin)
    }

    /// Gap of a side over `g0`.
    pub fn gap(&self, rim: &Rim, side: u32) -> f64 {
        let (c, s) = self.direction(rim, side);
        1.0 + self.z.0 * c + self.z.1 * s
    }

    /// Smallest gap over `g0` of the sides not in `contacts`; infinite with
    /// none left.
    pub fn smallest_gap(&self, rim: &Rim, contacts: &[u32]) -> f64 {
        (0..rim.sides)
            .filter(|side| !contacts.contains(side))
            .map(|side| self.gap(rim, side))
            .fold(f64::INFINITY, f64::min)
    }

    /// A side in contact with this (scaled) multiplier.
    pub fn held(&self, rim: &Rim, side: u32, multiplier: f64) -> Held {
        let direction = self.direction(rim, side);
        let arm = self.z.1 * direction.0 - self.z.0 * direction.1;
        Held { phase: rim.direction(side), direction, arm, multiplier }
    }
}
