//! The contact polygon: with rigid blades the casing displacement `z` in the blade frame is a point
//! inside a fixed regular polygon (docs/theory.md, section 3).
//!
//! Its sides are the *phase groups*: the blades that share `psi = n_d Phi_i` modulo a full turn.
//! Side `k` has the phase `psi_k = 2 pi k/N'` and the outward normal `-exp(i psi_k)`; its gap is
//! `g0 + Re[z exp(-i psi_k)]`.

use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_4, PI, TAU};
use std::sync::OnceLock;

/// The phase groups of the blades and the polygon that they form.
#[derive(Clone, Debug, PartialEq)]
pub struct ContactPolygon {
    /// Number of blades `N`.
    pub blades: u32,
    /// Nodal diameters `n_d`.
    pub nodal_diameters: u32,
    /// Number of sides of the polygon, which is the number of phase groups, `N'`.
    pub sides: u32,
    /// Blades in each group, `q = gcd(N, n_d)`.
    pub blades_per_side: u32,
    /// Apothem of the polygon, the clearance `g0` \[m\].
    pub clearance: f64,
    /// Half the angle between neighbouring sides, `delta = pi/N'` \[rad\].
    pub delta: f64,
    directions: Directions,
}

/// Directions `(cos psi_k, sin psi_k)` of all sides. Computed on first use, because many studies of
/// large disks never need them.
#[derive(Clone, Debug, Default)]
struct Directions(OnceLock<Vec<(f64, f64)>>);

impl PartialEq for Directions {
    /// The sides of a polygon determine its directions.
    fn eq(&self, _: &Self) -> bool {
        true
    }
}

/// The part of a side that the other sides do not cut off.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SideLeft {
    /// Index of the side.
    pub side: u32,
    /// Ends of the part, measured from the foot of the normal and positive towards increasing
    /// phase; infinite without corners \[m\].
    pub reach: [f64; 2],
    /// Side that it meets at the upper end; the side itself if there are no corners.
    pub next: u32,
}

impl ContactPolygon {
    /// Returns the sides that remain part of the polygon for the given apothems \[m\].
    #[must_use]
    pub fn sides_left(&self, apothems: &[f64]) -> Vec<SideLeft> {
        let sides = self.sides;
        let turn = |k| (2.0 * self.delta * f64::from(k)).sin_cos();
        let turns: Vec<_> = (1..sides.div_ceil(2)).map(|k| (k, turn(k))).collect();
        let least = apothems.iter().copied().fold(f64::INFINITY, f64::min);
        let left = |(side, height): (u32, &f64)| {
            let reach = |backward: bool| {
                let (mut end, mut cutting) = (f64::INFINITY, side);
                for &(k, (sin, cos)) in &turns {
                    if least > 0.0 && (least - height * cos) / sin > end {
                        break;
                    }
                    let other = (side + if backward { sides - k } else { k }) % sides;
                    let cut = (apothems[other as usize] - height * cos) / sin;
                    if cut < end {
                        (end, cutting) = (cut, other);
                    }
                }
                (end, cutting)
            };
            let ((high, next), (low, _)) = (reach(false), reach(true));
            (-low < high).then_some(SideLeft { side, reach: [-low, high], next })
        };
        (0..sides).zip(apothems).filter_map(left).collect()
    }

    /// Creates the polygon of `blades >= 1` equal blades with the given nodal diameters and
    /// clearance \[m\].
    #[must_use]
    pub fn new(blades: u32, nodal_diameters: u32, clearance: f64) -> Self {
        let blades = blades.max(1);
        let blades_per_side = gcd(blades, nodal_diameters);
        let sides = blades / blades_per_side;
        Self {
            blades,
            nodal_diameters,
            sides,
            blades_per_side,
            clearance,
            delta: PI / f64::from(sides),
            directions: Directions::default(),
        }
    }

    /// Returns whether neighbouring sides meet in corners (`N' >= 3`). With one or two sides the
    /// point is unbounded along them and can never lock.
    #[must_use]
    pub fn has_corners(&self) -> bool {
        self.sides >= 3
    }

    /// Returns the distance from the middle of a side to its corner, `g0 tan delta` \[m\]; infinite
    /// without corners.
    #[must_use]
    pub fn half_side(&self) -> f64 {
        if self.has_corners() { self.clearance * self.delta.tan() } else { f64::INFINITY }
    }

    /// Returns the phase `psi_k` of side `k`, in `[0, 2 pi)` \[rad\].
    #[must_use]
    pub fn phase(&self, side: u32) -> f64 {
        TAU * f64::from(side) / f64::from(self.sides)
    }

    /// Returns `(cos psi_k, sin psi_k)` of side `k`, taken modulo `N'`.
    #[must_use]
    pub fn direction(&self, side: u32) -> (f64, f64) {
        // Called in every step: the comparison avoids a slow division.
        let side = if side < self.sides { side } else { side % self.sides };
        let sides = self.sides;
        let all = || (0..sides).map(|k| fraction_of_turn(k, sides)).collect();
        self.directions.0.get_or_init(all)[side as usize]
    }

    /// Returns the side of a blade, which is numbered from 1 as in the paper.
    #[must_use]
    pub fn side_of_blade(&self, blade: u32) -> u32 {
        let reduced = u64::from(self.nodal_diameters / self.blades_per_side);
        let index = u64::from(blade.saturating_sub(1));
        u32::try_from(reduced * index % u64::from(self.sides)).unwrap_or(0)
    }

    /// Returns the blades of a side, numbered from 1, in increasing order.
    #[must_use]
    pub fn blades_of_side(&self, side: u32) -> Vec<u32> {
        let side = side % self.sides;
        let first = (1..=self.sides).find(|&blade| self.side_of_blade(blade) == side);
        let of_turn = |turn| first.map(|first| first + turn * self.sides);
        (0..self.blades_per_side).filter_map(of_turn).collect()
    }

    /// Returns the next side in the direction of increasing phase.
    #[must_use]
    pub fn next(&self, side: u32) -> u32 {
        if side + 1 < self.sides { side + 1 } else { 0 }
    }

    /// Returns the next side in the direction of decreasing phase.
    #[must_use]
    pub fn previous(&self, side: u32) -> u32 {
        if side == 0 { self.sides - 1 } else { side - 1 }
    }

    /// Returns the gap of a side at the point `z = (x, y)` in the blade frame for rigid blades,
    /// positive if open, Eq. (14) \[m\].
    #[must_use]
    pub fn gap(&self, side: u32, x: f64, y: f64) -> f64 {
        let (c, s) = self.direction(side);
        self.clearance + x * c + y * s
    }

    /// Returns the side with the smallest gap at `z = (x, y)`: its outward normal is nearest to the
    /// direction of `z`.
    #[must_use]
    pub fn nearest_side(&self, x: f64, y: f64) -> u32 {
        let turns = (-y).atan2(-x) / TAU;
        let sides = f64::from(self.sides);
        let index = (turns * sides).round().rem_euclid(sides);
        // `rem_euclid` can round up to `sides` itself.
        (index as u32) % self.sides
    }

    /// Returns the largest `|x cos psi + y sin psi|` over all sides: the largest blade angle for
    /// the modal displacements `(x, y)`.
    #[must_use]
    pub fn largest_component(&self, x: f64, y: f64) -> f64 {
        self.largest_component_near(x, y, &mut self.nearest_side(-x, -y))
    }

    /// As [`largest_component`](Self::largest_component), but starts at side `near` and sets it to the
    /// side of the maximum. Fast if successive points are close to each other.
    #[must_use]
    pub fn largest_component_near(&self, x: f64, y: f64, near: &mut u32) -> f64 {
        let along = |side: u32| {
            let (c, s) = self.direction(side);
            c * x + s * y
        };
        // The component is unimodal around the sides, with one maximum and one minimum.
        let climb = |from: u32, sign: f64| {
            let mut top = (from, sign * along(from));
            for way in [Self::next, Self::previous] {
                for _ in 0..self.sides {
                    let side = way(self, top.0);
                    let value = sign * along(side);
                    if value > top.1 {
                        top = (side, value);
                    } else {
                        break;
                    }
                }
            }
            top
        };
        let (side, top) = climb(*near, 1.0);
        *near = side;
        // With an even number of sides each has an opposite one, so the minimum is minus the
        // maximum.
        let even = self.sides.is_multiple_of(2);
        let opposite = (side + self.sides / 2) % self.sides;
        if even { top.abs() } else { top.max(climb(opposite, -1.0).1) }
    }
}

/// Returns cosine and sine of `2 pi k/parts` for `k < parts`, exact at multiples of a quarter turn.
pub(crate) fn fraction_of_turn(k: u32, parts: u32) -> (f64, f64) {
    // Reduction to the first octant makes symmetric points exact mirror images.
    let (k, n) = (u64::from(k) * 8, u64::from(parts));
    let octant = k / n;
    // Cosine and sine within an octant; at its end both are equal.
    let within = |numerator: u64| {
        let (sin, cos) = (FRAC_PI_4 * numerator as f64 / n as f64).sin_cos();
        if numerator == n { (FRAC_1_SQRT_2, FRAC_1_SQRT_2) } else { (cos, sin) }
    };
    let (low_cos, low_sin) = within(k - octant * n);
    let (high_cos, high_sin) = within((octant + 1) * n - k);
    match octant {
        0 => (low_cos, low_sin),
        1 => (high_sin, high_cos),
        2 => (-low_sin, low_cos),
        3 => (-high_cos, high_sin),
        4 => (-low_cos, -low_sin),
        5 => (-high_sin, -high_cos),
        6 => (low_sin, -low_cos),
        _ => (high_cos, -high_sin),
    }
}

/// Greatest common divisor, with `gcd(n, 0) = n`.
pub(crate) fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn degenerate_and_aliased_diameters() {
        assert_eq!(ContactPolygon::new(22, 0, 1.0).sides, 1);
        assert_eq!(ContactPolygon::new(22, 11, 1.0).sides, 2);
        assert_eq!(ContactPolygon::new(22, 22, 1.0).sides, 1);
        assert_eq!(ContactPolygon::new(22, 25, 1.0).side_of_blade(6), 15);
        assert_eq!(ContactPolygon::new(1, 3, 1.0).sides, 1);
    }

    #[test]
    fn directions_agree_with_the_phase_and_mirror_exactly() {
        for sides in [1, 2, 3, 4, 7, 8, 11, 22, 500] {
            let polygon = ContactPolygon::new(sides, 1, 1.0);
            for k in 0..sides {
                let (c, s) = polygon.direction(k);
                // The phase itself is rounded by up to half a unit in the last place of 2 pi.
                assert!((c - polygon.phase(k).cos()).abs() < 1.5e-15);
                assert!((s - polygon.phase(k).sin()).abs() < 1.5e-15);
                let (cm, sm) = polygon.direction((sides - k) % sides);
                assert_eq!((c, s), (cm, -sm), "side {k} of {sides}");
            }
        }
    }

    #[test]
    fn nearest_side_has_the_smallest_gap() {
        let polygon = ContactPolygon::new(22, 3, 1e-4);
        for step in 0..1000 {
            let angle = 0.006_3 * f64::from(step);
            let (y, x) = angle.sin_cos();
            let nearest = polygon.nearest_side(x, y);
            let smallest = (0..22).map(|k| polygon.gap(k, x, y)).fold(f64::INFINITY, f64::min);
            assert!(polygon.gap(nearest, x, y) <= smallest + 1e-12);
        }
    }

    #[test]
    fn the_blades_of_a_side_are_those_that_belong_to_it() {
        for blades in [1, 2, 3, 7, 12, 22, 36, 60] {
            for diameters in 0..=blades {
                let polygon = ContactPolygon::new(blades, diameters, 1e-4);
                for side in 0..=polygon.sides {
                    let of_side =
                        |&blade: &u32| polygon.side_of_blade(blade) == side % polygon.sides;
                    let expected: Vec<u32> = (1..=blades).filter(of_side).collect();
                    assert_eq!(
                        polygon.blades_of_side(side),
                        expected,
                        "{blades} {diameters} {side}"
                    );
                }
            }
        }
    }

    #[test]
    fn largest_component_is_that_of_all_sides() {
        for sides in [1, 2, 3, 4, 7, 22] {
            let polygon = ContactPolygon::new(sides, 1, 1e-4);
            for step in 0..200 {
                let (y, x) = (0.031_7 * f64::from(step)).sin_cos();
                let each = (0..sides).map(|k| {
                    let (c, s) = polygon.direction(k);
                    (c * x + s * y).abs()
                });
                let all = each.fold(0.0, f64::max);
                assert_eq!(polygon.largest_component(x, y), all, "{sides} {step}");
                for mut near in 0..sides {
                    let from = near;
                    let largest = polygon.largest_component_near(x, y, &mut near);
                    assert_eq!(largest, all, "{sides} {step} {from}");
                }
            }
        }
    }
}
