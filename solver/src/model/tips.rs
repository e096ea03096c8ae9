//! Unequal tips and an out-of-round casing (docs/theory.md, section 11).
//!
//! Both change the gap of blade `i` by `-b_i + e cos(m phi_i - psi)`. This module evaluates that
//! term, and the polygon in which the tips let the casing move: its sides have the apothems
//! `h_i = g0 - b_i`.

use std::f64::consts::TAU;

use nalgebra::Complex;

use super::{BladedDisk, Casing, ContactPolygon, Machine};
use crate::numeric::normal::normals;

type Plane = Complex<f64>;

/// Excess lengths of the tips, and the shape of the casing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tips {
    /// Excess length `b_i` of each blade over the nominal one, including the share of an eccentric
    /// rotor centre \[m\].
    longer: Vec<f64>,
    /// Largest excess length on each side \[m\].
    of_sides: Vec<f64>,
    /// Number of lobes `m`.
    pub lobes: u32,
    /// Height `e` \[m\] and phase `psi` \[rad\] of the lobes.
    pub out_of_round: f64,
    pub angle: f64,
}

impl Tips {
    /// Creates the tips of a machine, `None` for equal tips in a round casing, and returns by how much
    /// equal tips are longer, which leaves less clearance \[m\].
    pub fn new(
        disk: &BladedDisk,
        casing: &Casing,
        polygon: &ContactPolygon,
    ) -> (Option<Self>, f64) {
        let numbers = [disk.tip_scatter_m, disk.longest_tip_m, disk.orbit_m, casing.out_of_round_m];
        let own = disk.tips_m.iter().any(|b| *b != 0.0);
        if !own && numbers.iter().all(|number| *number == 0.0) {
            return (None, 0.0);
        }
        let drawn = match disk.tip_scatter_m {
            0.0 => Vec::new(),
            _ => normals(disk.tip_seed, disk.blades),
        };
        let mean = drawn.iter().sum::<f64>() / f64::from(disk.blades);
        let at = |list: &[f64], place: u32| list.get(place as usize).copied();
        let mut longer: Vec<f64> = (0..disk.blades)
            .map(|place| {
                let phi = TAU * f64::from(place) / f64::from(disk.blades);
                let scatter = at(&drawn, place).map_or(0.0, |x| x - mean);
                let first = if place == 0 { 1.0 } else { 0.0 };
                disk.tip_scatter_m * scatter
                    + disk.longest_tip_m * first
                    + disk.orbit_m * (phi - disk.orbit_angle_rad).cos()
                    + at(&disk.tips_m, place).unwrap_or(0.0)
            })
            .collect();
        let first = longer.first().copied().unwrap_or(0.0);
        // Without corners the casing can give way to equal tips beyond the clearance.
        let is_common = polygon.has_corners() && longer.iter().all(|b| *b == first);
        let common = if is_common { first } else { 0.0 };
        longer.iter_mut().for_each(|b| *b -= common);
        let mut of_sides: Vec<Option<f64>> = vec![None; polygon.sides as usize];
        for (blade, b) in (1..).zip(&longer) {
            let longest = &mut of_sides[polygon.side_of_blade(blade) as usize];
            *longest = Some(longest.filter(|known| known >= b).unwrap_or(*b));
        }
        let is_uneven = casing.out_of_round_m != 0.0 || longer.iter().any(|b| *b != 0.0);
        let tips = Self {
            longer,
            of_sides: of_sides.into_iter().flatten().collect(),
            lobes: casing.lobes,
            out_of_round: casing.out_of_round_m,
            angle: casing.out_of_round_angle_rad,
        };
        (is_uneven.then_some(tips), common)
    }

    /// Returns the excess length of a blade, numbered from 0 \[m\].
    pub fn longer(&self, blade: u32) -> f64 {
        self.longer.get(blade as usize).copied().unwrap_or(0.0)
    }

    /// Returns whether all tips have the same length.
    pub fn are_equal(&self) -> bool {
        let first = self.longer(0);
        self.longer.iter().all(|b| *b == first)
    }
}

impl Machine {
    /// Returns whether tips differ or the casing is out of round.
    #[must_use]
    pub fn is_uneven(&self) -> bool {
        self.tips.is_some()
    }

    /// Returns whether tips differ from each other.
    #[must_use]
    pub fn has_unequal_tips(&self) -> bool {
        self.tips.as_ref().is_some_and(|tips| !tips.are_equal())
    }

    /// Returns the lobe height `e` of the casing \[m\].
    #[must_use]
    pub fn out_of_round(&self) -> f64 {
        self.tips.as_ref().map_or(0.0, |tips| tips.out_of_round)
    }

    /// Returns the excess length of the longest tip on a side \[m\].
    #[must_use]
    pub fn longest_of_side(&self, side: u32) -> f64 {
        let of_side = |tips: &Tips| tips.of_sides.get(side as usize).copied();
        self.tips.as_ref().and_then(|tips| of_side(tips)).unwrap_or(0.0)
    }

    /// Returns the apothem of a side, `h = g0 - b` with its longest tip \[m\]. A negative apothem
    /// excludes the centre from the polygon.
    #[must_use]
    pub fn apothem(&self, side: u32) -> f64 {
        if self.tips.is_none() {
            self.clearance
        } else {
            self.clearance - self.longest_of_side(side)
        }
    }

    /// Returns the smallest possible gap with the casing undeformed, `g0 - e - max b` \[m\].
    #[must_use]
    pub fn least_clearance(&self) -> f64 {
        self.clearance - self.most_uneven()
    }

    /// Returns the largest possible reduction of a gap below the clearance, `e + max b` \[m\].
    #[must_use]
    pub fn most_uneven(&self) -> f64 {
        let Some(tips) = &self.tips else { return 0.0 };
        let longest = tips.longer.iter().copied().reduce(f64::max);
        tips.out_of_round + longest.unwrap_or(0.0)
    }

    /// Returns the difference of a blade's gap from the clearance at the rotor angle `theta`,
    /// `e cos(m (theta + Phi_i) - psi) - b_i` \[m\]. The blade is numbered from 0.
    #[must_use]
    pub fn uneven_at(&self, blade: u32, theta: f64) -> f64 {
        let phi = theta + TAU * f64::from(blade) / f64::from(self.polygon.blades);
        self.shape_at(phi) - self.longer(blade)
    }

    /// Returns the outward deviation of the undeformed casing from a circle at the angle `phi` of
    /// the stationary frame, `e cos(m phi - psi)` \[m\].
    #[must_use]
    pub fn shape_at(&self, phi: f64) -> f64 {
        let shape =
            |tips: &Tips| tips.out_of_round * (f64::from(tips.lobes) * phi - tips.angle).cos();
        self.tips.as_deref().map_or(0.0, shape)
    }

    /// Returns the excess length of a blade, numbered from 0 \[m\].
    #[must_use]
    pub fn longer(&self, blade: u32) -> f64 {
        self.tips.as_ref().map_or(0.0, |tips| tips.longer(blade))
    }

    /// Returns the blades of a side that can touch, those with its longest tip, numbered from 1.
    #[must_use]
    pub fn first_of_side(&self, side: u32) -> Vec<u32> {
        let mut blades = self.polygon.blades_of_side(side);
        let tips = blades.iter().map(|blade| self.longer(blade - 1));
        let longest = tips.fold(f64::NEG_INFINITY, f64::max);
        blades.retain(|blade| self.longer(blade - 1) == longest);
        blades
    }

    /// Returns the apothem of a side at the rotor angle `theta`: that of its blade with the
    /// smallest gap \[m\].
    #[must_use]
    pub fn apothem_at(&self, side: u32, theta: f64) -> f64 {
        let blades = self.polygon.blades_of_side(side).into_iter();
        let unevenness = blades.map(|blade| self.uneven_at(blade - 1, theta));
        self.clearance + unevenness.reduce(f64::min).unwrap_or(0.0)
    }

    /// Returns the point nearest to `from` at which every gap is open, in the blade frame at the
    /// rotor angle `theta` \[m\]; `risen(blade)` is the outward displacement of a tip (numbered
    /// from 0). `None` if no such point exists.
    #[must_use]
    pub fn nearest_open(
        &self,
        from: (f64, f64),
        theta: f64,
        risen: impl Fn(u32) -> f64,
    ) -> Option<(f64, f64)> {
        let polygon = &self.polygon;
        let row = |blade: u32| {
            let (c, s) = polygon.direction(polygon.side_of_blade(blade + 1));
            (Plane::new(c, s), self.clearance + self.uneven_at(blade, theta) - risen(blade))
        };
        let rows: Vec<(Plane, f64)> = (0..polygon.blades).map(row).collect();
        nearest(&rows, Plane::new(from.0, from.1)).map(|z| (z.re, z.im))
    }

    /// Returns whether some casing position leaves every gap open, at every rotor angle. With lobes
    /// this is checked at 64 to 1024 angles.
    #[must_use]
    pub fn has_room(&self) -> bool {
        let Some(tips) = &self.tips else { return self.clearance > 0.0 };
        if self.least_clearance() > 0.0 {
            return true;
        }
        let turns = if tips.out_of_round == 0.0 { 1 } else { (16 * tips.lobes).clamp(64, 1024) };
        let theta = |k: u32| TAU * f64::from(k) / f64::from(turns);
        self.clearance > 0.0
            && (0..turns).all(|k| self.nearest_open((0.0, 0.0), theta(k), |_| 0.0).is_some())
    }
}

/// Returns the point nearest to `from` that satisfies every gap condition
/// `offset + Re[z conj(normal)] >= 0`; `None` if no point does. Incremental (Seidel): each violated
/// condition moves the point to its own line, within the range that the earlier conditions leave.
fn nearest(rows: &[(Plane, f64)], from: Plane) -> Option<Plane> {
    let mut place = from;
    for (k, &(normal, offset)) in rows.iter().enumerate() {
        if offset + (place * normal.conj()).re >= 0.0 {
            continue;
        }
        let foot = from - normal * (offset + (from * normal.conj()).re);
        let along = Plane::i() * normal;
        let (mut low, mut high) = (f64::NEG_INFINITY, f64::INFINITY);
        for &(other, offset) in &rows[..k] {
            let (gap, rate) = (offset + (foot * other.conj()).re, (along * other.conj()).re);
            let size = f64::EPSILON * (offset.abs() + foot.norm());
            if rate.abs() > f64::EPSILON {
                let end = -gap / rate;
                if rate > 0.0 { low = low.max(end) } else { high = high.min(end) }
            } else if gap < -4.0 * size {
                return None;
            }
        }
        if low > high {
            return None;
        }
        place = foot + along * 0.0_f64.clamp(low, high);
    }
    Some(place)
}
