//! Tips of their own and a casing that is out of round (docs/theory.md, section 11): what each
//! gap has beside the clearance, `-b_i + e cos(m phi_i - psi)`, and where the casing has room
//! among the tips, which are sides of a polygon with apothems `h_i = g0 - b_i`.

use std::f64::consts::TAU;

use nalgebra::Complex;

use super::{BladedDisk, Casing, ContactPolygon, Machine, Number};
use crate::numeric::normal::normals;

type Plane = Complex<f64>;

/// Tips that differ, and the shape of the casing.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Tips<T = f64> {
    /// `b_i` of each blade \[m\].
    longer: Vec<T>,
    /// The longest of each side \[m\].
    of_sides: Vec<T>,
    /// `m`.
    pub lobes: u32,
    /// `e` \[m\] and `psi` \[rad\].
    pub out_of_round: T,
    pub angle: T,
}

impl<T: Number> Tips<T> {
    /// Creates those of a machine; none where its tips are equal and its casing is round.
    pub fn of(disk: &BladedDisk<T>, casing: &Casing<T>, polygon: &ContactPolygon) -> Option<Self> {
        let numbers = [disk.tip_scatter_m, disk.longest_tip_m, disk.orbit_m, casing.out_of_round_m];
        let own = disk.tips_m.iter().any(|b| *b != 0.0);
        if !own && numbers.iter().all(|number| number.re() == 0.0) {
            return None;
        }
        let drawn = match disk.tip_scatter_m.re() {
            0.0 => Vec::new(),
            _ => normals(disk.tip_seed, disk.blades),
        };
        let mean = drawn.iter().sum::<f64>() / f64::from(disk.blades);
        let at = |list: &[f64], place: u32| list.get(place as usize).copied();
        let longer: Vec<T> = (0..disk.blades)
            .map(|place| {
                let phi = TAU * f64::from(place) / f64::from(disk.blades);
                let scatter = at(&drawn, place).map_or(0.0, |x| x - mean);
                let first = if place == 0 { 1.0 } else { 0.0 };
                disk.tip_scatter_m * scatter
                    + disk.longest_tip_m * first
                    + disk.orbit_m * (-disk.orbit_angle_rad + phi).cos()
                    + at(&disk.tips_m, place).unwrap_or(0.0)
            })
            .collect();
        let mut of_sides: Vec<Option<T>> = vec![None; polygon.sides as usize];
        for (blade, b) in (1..).zip(&longer) {
            let longest = &mut of_sides[polygon.side_of_blade(blade) as usize];
            *longest = Some(longest.filter(|known| known.re() >= b.re()).unwrap_or(*b));
        }
        Some(Self {
            longer,
            of_sides: of_sides.into_iter().flatten().collect(),
            lobes: casing.lobes,
            out_of_round: casing.out_of_round_m,
            angle: casing.out_of_round_angle_rad,
        })
    }

    /// Each number by a function.
    pub fn map<U: Number>(&self, of: impl Fn(T) -> U) -> Tips<U> {
        let all = |list: &[T]| list.iter().map(|b| of(*b)).collect();
        Tips {
            longer: all(&self.longer),
            of_sides: all(&self.of_sides),
            lobes: self.lobes,
            out_of_round: of(self.out_of_round),
            angle: of(self.angle),
        }
    }

    /// How much the tip of a blade is longer, which is numbered from 0 \[m\].
    pub fn longer(&self, blade: u32) -> T {
        self.longer.get(blade as usize).copied().unwrap_or_else(T::zero)
    }

    /// Whether no tip differs from another.
    pub fn are_equal(&self) -> bool {
        let first = self.longer(0).re();
        self.longer.iter().all(|b| b.re() == first)
    }
}

impl<T: Number> Machine<T> {
    /// Whether tips differ, or the casing is out of round.
    #[must_use]
    pub fn is_uneven(&self) -> bool {
        self.tips.is_some()
    }

    /// Whether tips differ from each other.
    #[must_use]
    pub fn has_unequal_tips(&self) -> bool {
        self.tips.as_ref().is_some_and(|tips| !tips.are_equal())
    }

    /// Height of the lobes of a casing out of round, `e` \[m\].
    #[must_use]
    pub fn out_of_round(&self) -> T {
        self.tips.as_ref().map_or_else(T::zero, |tips| tips.out_of_round)
    }

    /// How much the longest tip of a side is longer than its blades \[m\].
    #[must_use]
    pub fn longest_of_side(&self, side: u32) -> T {
        let of_side = |tips: &Tips<T>| tips.of_sides.get(side as usize).copied();
        self.tips.as_ref().and_then(|tips| of_side(tips)).unwrap_or_else(T::zero)
    }

    /// Apothem of a side, `h = g0 - b` of its longest tip, below zero where that leaves the
    /// centre outside \[m\].
    #[must_use]
    pub fn apothem(&self, side: u32) -> T {
        if self.tips.is_none() {
            self.clearance
        } else {
            self.clearance - self.longest_of_side(side)
        }
    }

    /// The smallest gap that a casing at rest can have, `g0 - e - max b` \[m\].
    #[must_use]
    pub fn least_clearance(&self) -> T {
        self.clearance - self.most_uneven()
    }

    /// What the gaps have less than the clearance at most, `e + max b` \[m\].
    #[must_use]
    pub fn most_uneven(&self) -> T {
        let Some(tips) = &self.tips else { return T::zero() };
        let longest =
            tips.longer.iter().copied().reduce(|a, b| if a.re() < b.re() { b } else { a });
        tips.out_of_round + longest.unwrap_or_else(T::zero)
    }
}

impl Machine {
    /// What the gap of a blade, numbered from 0, has beside the clearance where the rotor has
    /// turned by `theta`, `e cos(m (theta + Phi_i) - psi) - b_i` \[m\].
    #[must_use]
    pub fn uneven_at(&self, blade: u32, theta: f64) -> f64 {
        let phi = theta + TAU * f64::from(blade) / f64::from(self.polygon.blades);
        self.shape_at(phi) - self.longer(blade)
    }

    /// How much farther a casing at rest is at an angle in the standing frame,
    /// `e cos(m phi - psi)` \[m\].
    #[must_use]
    pub fn shape_at(&self, phi: f64) -> f64 {
        let shape =
            |tips: &Tips| tips.out_of_round * (f64::from(tips.lobes) * phi - tips.angle).cos();
        self.tips.as_deref().map_or(0.0, shape)
    }

    /// How much the tip of a blade is longer, which is numbered from 0 \[m\].
    #[must_use]
    pub fn longer(&self, blade: u32) -> f64 {
        self.tips.as_ref().map_or(0.0, |tips| tips.longer(blade))
    }

    /// Returns the blades of a side that touch, those with its longest tip, numbered from 1.
    #[must_use]
    pub fn first_of_side(&self, side: u32) -> Vec<u32> {
        let mut blades = self.polygon.blades_of_side(side);
        let tips = blades.iter().map(|blade| self.longer(blade - 1));
        let longest = tips.fold(f64::NEG_INFINITY, f64::max);
        blades.retain(|blade| self.longer(blade - 1) == longest);
        blades
    }

    /// Apothem of a side where the rotor has turned by `theta`: that of its blade with the
    /// least gap \[m\].
    #[must_use]
    pub fn apothem_at(&self, side: u32, theta: f64) -> f64 {
        let blades = self.polygon.blades_of_side(side).into_iter();
        let beside = blades.map(|blade| self.uneven_at(blade - 1, theta));
        self.clearance + beside.reduce(f64::min).unwrap_or(0.0)
    }

    /// The place with every gap open that is nearest to another, in the frame of the blades
    /// where the rotor has turned by `theta` and the tip of each blade has risen by so much;
    /// none where there is no room \[m\].
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

    /// Whether rigid tips leave room to the casing at every angle of the rotor.
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

/// The place nearest to another with every gap `offset + Re[z conj(normal)]` open: one gap
/// after the other, each that is closed moves the place along its own line (Seidel).
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
