//! Rows of blade tips, Eqs. (9)-(10) and section 10 of docs/theory.md: which blades are
//! one row, its gap, constraint and force direction, and which rows may touch now.
//!
//! All of it is in the frame of the blades, at `z = u exp(-i n_d theta)`, where the sides
//! stand still and only small blade angles turn them. With `n = exp(i (psi + n_d alpha))`
//! the gap is `g0 + Re[z conj(n)] - kappa l_b alpha`. Its derivatives, the constraint row,
//! are `n` and the lever `A - kappa l_b`; friction turns the force column to
//! `(1 + i mu_c) n` and `A - (kappa + mu) l_b`. The paper's tips have no slope `kappa` and
//! no friction.

use super::Explicit;
use super::disk::Disk;
use crate::model::{ContactPolygon, Machine};
use crate::motion::Plane;
use crate::tolerances::{SERIES_PHASE, SMALL_PHASE};

/// Geometry and friction of the tips at the current rotor speed.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::motion) struct TipLaw {
    pub clearance: f64,
    /// The smallest gap of a casing at rest: less by the longest tip and the highest lobe.
    pub least: f64,
    pub diameters: f64,
    /// `kappa l_b` \[m\].
    pub rise: f64,
    /// `(kappa + mu) l_b` \[m\].
    pub pushed: f64,
    /// `mu_c`.
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

    /// Returns the row of a blade of this direction, at this casing displacement and blade angle.
    #[inline(always)]
    pub fn place(&self, direction: (f64, f64), z: Plane, angle: f64) -> Place {
        let normal = turned(direction, self.diameters * angle);
        let gap = self.clearance + z.re * normal.re + z.im * normal.im - self.rise * angle;
        let moment_arm = self.diameters * (z.im * normal.re - z.re * normal.im);
        Place { gap, normal, moment_arm }
    }

    /// Returns the torque of the multiplier of a row on its blades, with its friction \[N m\].
    #[inline(always)]
    pub fn torque(&self, row: &Row) -> f64 {
        -row.lambda * (row.place.moment_arm - self.pushed)
    }

    /// Returns the direction of a push on the casing, with its friction.
    #[inline(always)]
    pub fn push_on_casing(&self, normal: Plane) -> Plane {
        Plane::new(
            normal.re - self.casing_friction * normal.im,
            normal.im + self.casing_friction * normal.re,
        )
    }
}

/// Position of a blade tip.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::motion) struct Place {
    /// \[m\]
    pub gap: f64,
    /// `n` above.
    pub normal: Plane,
    /// `A`, the change of the gap with the phase that an angle turns \[m\].
    pub moment_arm: f64,
}

/// A contact row of a step.
#[derive(Clone, Copy, Debug, Default)]
pub(in crate::motion) struct Row {
    pub index: u32,
    pub side: u32,
    /// Angle of its blades \[rad\].
    pub angle: f64,
    pub place: Place,
    /// Multiplier; negative is a push \[N\].
    pub lambda: f64,
}

/// Returns a direction turned by a small blade phase, exact to round-off.
#[inline(always)]
pub(super) fn turned((c, s): (f64, f64), phase: f64) -> Plane {
    let q = phase * phase;
    let (sin, cos) = if phase.abs() < SMALL_PHASE {
        (phase * (1.0 - q * (1.0 / 6.0)), 1.0 - 0.5 * q)
    } else if phase.abs() < SERIES_PHASE {
        (
            phase * (1.0 - q * (1.0 / 6.0) * (1.0 - q * (1.0 / 20.0) * (1.0 - q * (1.0 / 42.0)))),
            1.0 - q
                * 0.5
                * (1.0 - q * (1.0 / 12.0) * (1.0 - q * (1.0 / 30.0) * (1.0 - q * (1.0 / 56.0)))),
        )
    } else {
        phase.sin_cos()
    };
    Plane::new(c * cos - s * sin, s * cos + c * sin)
}

/// Position of the polygon of the tips, largest gap, and clearance, when candidates were found.
#[derive(Clone, Copy, Debug)]
pub(super) struct Found {
    place: Plane,
    reach: f64,
    clearance: f64,
}

impl<B: Disk> Explicit<B> {
    /// Finds the rows whose gaps may be below `reach`, for blade angles within `bound`, and those
    /// whose gaps are larger by up to a `margin`, which holds while the polygon moves by less.
    /// Returns whether they were searched for again.
    pub(super) fn find_candidates(
        &mut self,
        z: Plane,
        tips: &TipLaw,
        bound: f64,
        reach: f64,
        margin: f64,
    ) -> bool {
        // A blade angle moves a gap by at most |z| n_d alpha beside its slope.
        let look = reach + tips.diameters * bound * (z.re.abs() + z.im.abs());
        let wave = if tips.rise == 0.0 { Some(Plane::default()) } else { self.blades.wave() };
        let w = wave.map(|wave| z - wave * tips.rise);
        // No gap changes by more than the polygon moves and the casing comes nearer.
        let covers = |w: Plane, found: Found| {
            let moved = w - found.place;
            let closed = (found.clearance - tips.clearance).max(0.0);
            look + moved.re.abs() + moved.im.abs() + closed <= found.reach
        };
        if w.zip(self.beyond.found).is_some_and(|(w, found)| covers(w, found)) {
            return false;
        }
        self.beyond.candidates.clear();
        let margin = w.map_or(0.0, |w| margin * (tips.clearance.abs() + w.norm()));
        let look = look + margin;
        let (least, most) = (tips.clearance - tips.least, self.machine.out_of_round());
        self.beyond.found = w.map(|place| Found { place, reach: look, clearance: tips.clearance });
        match w {
            Some(w) => self.walk(w, look + least, false, |this, side| {
                let open = this.machine.polygon.gap(side, w.re, w.im) - most;
                let tips = &this.machine.tips;
                let is_near =
                    |row: &u32| tips.as_ref().is_none_or(|tips| open - tips.longer(*row) < look);
                let rows = this.blades.table().of_side(side).iter();
                this.beyond.candidates.extend(rows.copied().filter(is_near));
                false
            }),
            None => {
                let polygon = &self.machine.polygon;
                let (table, angles, slack) = self.blades.estimates();
                let look = look + least + tips.rise.abs() * slack;
                for (row, (angle, &side)) in angles.iter().zip(&table.side).enumerate() {
                    if polygon.gap(side, z.re, z.im) - tips.rise * angle < look {
                        self.beyond.candidates.push(row as u32);
                    }
                }
            }
        }
        true
    }

    /// Adds the nearest side of the polygon at `w` and those on either side of it, as long as their
    /// gaps are below `look` or, where `all` neighbours of a side may matter, `add` returned for
    /// the side before that they do.
    #[inline]
    pub(super) fn walk(
        &mut self,
        w: Plane,
        look: f64,
        all: bool,
        mut add: impl FnMut(&mut Self, u32) -> bool,
    ) {
        self.near = self.follow(w);
        let near = self.near;
        let is_close = |this: &Self, side| this.machine.polygon.gap(side, w.re, w.im) < look;
        if !(all || is_close(self, near)) {
            return;
        }
        add(self, near);
        let mut left = self.machine.polygon.sides - 1;
        let ways: [fn(&ContactPolygon, u32) -> u32; 2] =
            [ContactPolygon::next, ContactPolygon::previous];
        for way in ways {
            let (mut side, mut matters) = (way(&self.machine.polygon, near), all);
            // Not up to the first open side: beyond it, blades may be turned into the casing.
            while left > 0 && (matters || is_close(self, side)) {
                matters = add(self, side);
                side = way(&self.machine.polygon, side);
                left -= 1;
            }
        }
    }

    /// Returns the side nearest to `z`, searched from the one found last: around the polygon the
    /// gap has a single minimum.
    fn follow(&self, z: Plane) -> u32 {
        let polygon = &self.machine.polygon;
        let gap = |side| polygon.gap(side, z.re, z.im);
        let here = gap(self.near);
        // On the far side of the polygon the gap has its maximum instead.
        if here < self.machine.polygon.clearance
            && here <= gap(polygon.previous(self.near))
            && here <= gap(polygon.next(self.near))
        {
            self.near
        } else {
            polygon.nearest_side(z.re, z.im)
        }
    }

    /// Returns the row of a candidate, with its exact gap; none where that is above `reach`.
    pub(super) fn row_at(
        &mut self,
        index: u32,
        z: Plane,
        tips: &TipLaw,
        reach: f64,
    ) -> Option<Row> {
        let side = self.blades.table().side[index as usize];
        let angle = self.blades.angle(index);
        let ((c, s), phase) = (self.machine.polygon.direction(side), tips.diameters * angle);
        // The normal by its first two terms: all others turn the gap by less than the square.
        let open = z.re * (c - phase * s) + z.im * (s + phase * c)
            - tips.rise * angle
            - phase * phase * (z.re.abs() + z.im.abs());
        if tips.clearance + open > reach && self.beyond.uneven.is_none() {
            return None;
        }
        let place = self.place_of((index, side), z, tips, angle, 0);
        Some(Row { index, side, angle, place, lambda: 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::explicit::RigidBlades;
    use crate::scene::Scene;

    #[test]
    fn candidates_hold_every_near_side_as_the_casing_comes_nearer() {
        let mut motion = Explicit::<RigidBlades>::new(&Scene::base().checked().unwrap());
        let (mut tips, clearance) = (motion.tips, motion.machine.clearance());
        let (reach, mut again) = (0.1 * clearance, 0);
        for z in [Plane::default(), Plane::new(-0.2 * clearance, 0.1 * clearance)] {
            for part in (1..=20).rev() {
                tips.clearance = 0.05 * f64::from(part) * clearance;
                tips.least = tips.clearance;
                motion.machine.polygon.clearance = tips.clearance;
                again += u32::from(motion.find_candidates(z, &tips, 0.0, reach, 0.5));
                let found = motion.beyond.candidates.iter();
                let sides: Vec<u32> =
                    found.map(|&row| motion.blades.table().side[row as usize]).collect();
                let polygon = &motion.machine.polygon;
                let near = (0..polygon.sides).filter(|&side| polygon.gap(side, z.re, z.im) < reach);
                let missed: Vec<u32> = near.filter(|side| !sides.contains(side)).collect();
                assert!(missed.is_empty(), "{z} {part}: {missed:?}");
            }
        }
        assert!(again < 40, "{again}");
    }

    #[test]
    fn a_row_is_the_derivative_of_its_gap() {
        let mut scene = Scene::base();
        (scene.bladed_disk.radial_coupling, scene.contact.friction) = (0.3, 0.15);
        let machine = scene.machine();
        let law = TipLaw::at(&machine, 500.0);
        let (z, step) = (Plane::new(-1.3e-4, 0.4e-4), 1e-7);
        for angle in [0.0, 1e-3, -0.02, 0.05] {
            let direction = machine.polygon.direction(7);
            let place = law.place(direction, z, angle);
            let gap = |z: Plane, angle: f64| law.place(direction, z, angle).gap;
            let by_angle = (gap(z, angle + step) - gap(z, angle - step)) / (2.0 * step);
            assert!((by_angle - (place.moment_arm - law.rise)).abs() < 1e-9, "{angle}");
            let length = 1e-6;
            let by_x = (gap(z + length, angle) - gap(z - length, angle)) / (2.0 * length);
            assert!((by_x - place.normal.re).abs() < 1e-9, "{angle}");
            assert!((place.normal.norm() - 1.0).abs() < 1e-15, "{angle}");
        }
    }
}
