//! Contact rows: the gap of a tip, the direction in which it changes, and the direction of a push.
//!
//! In the frame of the blades, at `z = u exp(-i n_d theta)`, with `n = exp(i (psi + n_d alpha))`,
//!
//! - gap, Eq. (14): `g = g0 - b + s + Re[z conj(n)] - kappa l_b alpha`,
//! - its direction, a row of `C` in Eq. (9): `n` on the casing, `A - kappa l_b` on the blades, where
//!   `A = n_d Im[z conj(n)] + ds/dalpha` is the moment arm,
//! - direction of a push: `(1 + i mu_c) n` on the casing, `A - (kappa + mu) l_b` on the blades.
//!
//! The paper's tips have neither slope `kappa` nor friction `mu`; unequal tips have a length `b`
//! each, and a casing out of round has lobes `s = e cos(m (theta + Phi + alpha) - psi_e)`
//! (docs/theory.md, sections 10 and 11).

use super::disk::Disk;
use crate::model::Machine;
use crate::motion::{ActiveSet, Plane, across, dot, turned};

/// Geometry and friction of the tips at the current rotor speed.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct TipLaw {
    /// `g0` \[m\].
    pub clearance: f64,
    /// Smallest gap of a centred casing: `g0` less the longest tip and the highest lobe \[m\].
    pub least: f64,
    /// `n_d`.
    pub diameters: f64,
    /// `kappa l_b` \[m\].
    pub rise: f64,
    /// `(kappa + mu) l_b` \[m\].
    pub pushed: f64,
    /// `mu_c = mu tau`.
    pub casing_friction: f64,
    /// `mu`, with the sign of the rotor speed.
    pub friction: f64,
}

impl TipLaw {
    pub fn at(machine: &Machine, speed: f64) -> Self {
        let friction = machine.friction_at(speed);
        Self {
            clearance: machine.clearance(),
            least: machine.least_clearance(),
            diameters: machine.nodal_diameters,
            rise: machine.radial_coupling * machine.blade_length,
            pushed: (machine.radial_coupling + friction) * machine.blade_length,
            casing_friction: machine.casing_friction_at(speed),
            friction,
        }
    }

    /// Returns the direction on the casing of a push along `normal`, with its friction.
    #[inline(always)]
    pub fn push_on_casing(&self, normal: Plane) -> Plane {
        let mu = self.casing_friction;
        Plane::new(normal.re - mu * normal.im, normal.im + mu * normal.re)
    }
}

/// A row of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Row {
    pub index: usize,
    pub side: u32,
    /// `n` above.
    pub normal: Plane,
    /// `g` above \[m\].
    pub gap: f64,
    /// `A` above \[m\].
    pub arm: f64,
    /// Distance that is left to the target of the step: the gap, and with restitution
    /// `g[n+1] + e g[n-1]` \[m\].
    pub apart: f64,
    /// Multiplier; negative is a push \[N\].
    pub lambda: f64,
    /// Shapes of a pair of modes at its blades.
    pub shape: [f64; 2],
}

impl Row {
    /// Returns the torque of the contact force, with its friction, on the row's blades \[N m\].
    #[inline(always)]
    pub fn torque(&self, tips: &TipLaw) -> f64 {
        -self.lambda * (self.arm - tips.pushed)
    }
}

/// A side of the polygon that is one row.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Side {
    pub normal: Plane,
    pub row: usize,
}

/// The tips of a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Tip {
    pub side: u32,
    /// `exp(i psi)`.
    pub normal: Plane,
    /// `b` \[m\].
    pub longer: f64,
    /// Shapes of a pair of modes at its blades; zero for other disks.
    pub shape: [f64; 2],
}

/// Directions of the rows, and how their tips differ.
#[derive(Clone, Debug)]
pub(super) struct Tips {
    pub rows: Vec<Tip>,
    /// The last side of the polygon, all in their order, and the first, where each has one row and
    /// all tips are equal in a round casing; else empty.
    pub sides: Vec<Side>,
    /// `e exp(i (m Phi - psi_e))` of each row; none of a round casing \[m\].
    pub lobe: Vec<Plane>,
    /// `m` and `e`.
    pub lobes: f64,
    pub out_of_round: f64,
}

impl Tips {
    /// Creates the tips of the rows of a disk.
    pub fn new(machine: &Machine, disk: &Disk) -> Self {
        let (polygon, (count, _)) = (&machine.polygon, disk.rows());
        let tip = |row: u32| {
            let side = polygon.side_of_blade(row + 1);
            let (c, s) = polygon.direction(side);
            let (longer, shape) = (machine.longer(row), disk.shape_of(row as usize));
            Tip { side, normal: Plane::new(c, s), longer, shape }
        };
        let rows: Vec<Tip> = (0..count as u32).map(tip).collect();
        let uneven = machine.tips.as_deref();
        let mut sides = Vec::new();
        if uneven.is_none() && count == polygon.sides as usize {
            sides = vec![Side::default(); count + 2];
            for (row, tip) in rows.iter().enumerate() {
                sides[tip.side as usize + 1] = Side { normal: tip.normal, row };
            }
            (sides[0], sides[count + 1]) = (sides[count], sides[1]);
        }
        let lobed = uneven.filter(|tips| tips.out_of_round != 0.0);
        let lobe = |row: usize| {
            let tips = lobed?;
            let turns = u64::from(tips.lobes) * row as u64 % u64::from(polygon.blades);
            let phi = std::f64::consts::TAU * turns as f64 / f64::from(polygon.blades);
            Some(Plane::cis(phi - tips.angle) * tips.out_of_round)
        };
        Self {
            lobe: (0..count).filter_map(lobe).collect(),
            lobes: lobed.map_or(0.0, |tips| f64::from(tips.lobes)),
            out_of_round: lobed.map_or(0.0, |tips| tips.out_of_round),
            rows,
            sides,
        }
    }

    /// Returns the number of sides of the polygon.
    #[inline(always)]
    pub fn sides(&self) -> usize {
        self.sides.len() - 2
    }

    /// Returns the row of a side.
    #[inline(always)]
    pub fn row_of(&self, side: usize) -> usize {
        self.sides[side + 1].row
    }

    /// Returns the gap of a side of the polygon at `w`, less the clearance \[m\].
    #[inline(always)]
    pub fn open(&self, side: usize, w: Plane) -> f64 {
        dot(self.sides[side + 1].normal, w)
    }

    /// Returns the side with the smallest gap at `w`, looked for from side `near`, and the gaps of the
    /// side before it, of itself, and of the side after it, each less the clearance \[m\].
    #[inline]
    pub fn nearest(&self, mut near: usize, w: Plane) -> (usize, [f64; 3]) {
        loop {
            let [below, own, above] = [0, 1, 2].map(|k| dot(self.sides[near + k].normal, w));
            if above < own {
                near = if near + 1 == self.sides() { 0 } else { near + 1 };
            } else if below < own {
                near = if near == 0 { self.sides() - 1 } else { near - 1 };
            } else {
                return (near, [below, own, above]);
            }
        }
    }

    /// Returns the least gap of blades at rest in a round casing at `z`, but for those of sides that
    /// are held \[m\].
    pub fn least_gap(&self, z: Plane, law: &TipLaw, held: ActiveSet) -> f64 {
        let open = self.rows.iter().filter(|tip| !held.includes(tip.side));
        let gaps = open.map(|tip| dot(tip.normal, z) - tip.longer);
        law.clearance + gaps.fold(f64::INFINITY, f64::min)
    }

    /// Returns `s` and `ds/dalpha` of a row, where the lobes have turned by `turn` against the
    /// rotor and its blades by `angle` \[m\].
    #[inline]
    pub fn shape(&self, row: usize, angle: f64, turn: Plane) -> [f64; 2] {
        let Some(lobe) = self.lobe.get(row) else { return [0.0; 2] };
        let at = turned(*lobe, self.lobes * angle) * turn;
        [at.re, -self.lobes * at.im]
    }

    /// Returns the row of a tip, for the casing at `z` and its blades at this angle.
    #[inline(always)]
    pub fn row(&self, index: usize, z: Plane, angle: f64, lobe_turn: Plane, tips: &TipLaw) -> Row {
        let Tip { side, normal, longer, shape } = self.rows[index];
        let normal = turned(normal, tips.diameters * angle);
        let [lobe, steep] = self.shape(index, angle, lobe_turn);
        let gap = tips.clearance - longer + lobe - tips.rise * angle + dot(normal, z);
        let arm = tips.diameters * across(normal, z) + steep;
        Row { index, side, normal, gap, arm, apart: gap, lambda: 0.0, shape }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{ModelSize, Scene};

    #[test]
    fn a_row_has_the_derivatives_of_its_gap() {
        let mut scene = Scene::base();
        (scene.bladed_disk.radial_coupling, scene.contact.friction) = (0.3, 0.15);
        (scene.casing.lobes, scene.casing.out_of_round_m) = (4, 2e-5);
        scene.solver.model = ModelSize::Full;
        let machine = scene.machine();
        let tips = Tips::new(&machine, &Disk::new(&scene, &machine));
        let law = TipLaw::at(&machine, 500.0);
        let (z, turn, step) = (Plane::new(-1.3e-4, 0.4e-4), Plane::cis(0.7), 1e-7);
        for angle in [0.0, 5e-5, 1e-3, -0.02, 0.05] {
            let row = tips.row(7, z, angle, turn, &law);
            let gap = |z: Plane, angle: f64| tips.row(7, z, angle, turn, &law).gap;
            let by_angle = (gap(z, angle + step) - gap(z, angle - step)) / (2.0 * step);
            assert!((by_angle - (row.arm - law.rise)).abs() < 1e-9, "{angle}");
            let length = 1e-6;
            let by_x = (gap(z + length, angle) - gap(z - length, angle)) / (2.0 * length);
            assert!((by_x - row.normal.re).abs() < 1e-9, "{angle}");
            assert!((row.normal.norm() - 1.0).abs() < 1e-15, "{angle}");
        }
    }
}
