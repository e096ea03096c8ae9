//! Proof that a contact is permanent: a lock whose blades have come to rest, or nearly.
//!
//! While the same rows are in contact the motion is linear, so its deviation from the equilibrium
//! obeys `x' = M x`. With `Q` from `M^T Q + Q M = -1`, `x^T Q x` never increases if `Q` is positive
//! definite. It thus bounds all future contact forces and gaps.

use nalgebra::{DMatrix, DVector};

use super::parameters::Parameters;
use super::stretch::Held;
use crate::motion::Plane;
use crate::motion::point::{Point, Units, one_of};
use crate::numeric::lyapunov::lyapunov;
use crate::tolerances::{CERTAIN_PUSH, LARGEST_BLADE_ANGLE};

/// Equilibrium of the motion with some rows in contact, and the bounds of deviations from it.
#[derive(Clone, Debug)]
pub(super) struct Rest {
    /// Equilibrium.
    point: Point,
    /// Matrix `Q`, in states of `units`.
    bound: DMatrix<f64>,
    /// For each contact force and each open gap: its value at equilibrium, and the largest change
    /// per unit of `sqrt(x^T Q x)`.
    rooms: Vec<(f64, f64)>,
}

/// Returns the units of the states.
fn units(parameters: &Parameters) -> Units {
    Units::of(parameters.clearance(), parameters.machine.blade_length, parameters.rates())
}

impl Rest {
    /// Creates the bounds for the motion with these rows in contact; `None` if it has no stable
    /// equilibrium, or one in which the contact would not last.
    pub(super) fn of(parameters: &Parameters, held: &Held) -> Option<Self> {
        let (units, rate) = (units(parameters), parameters.rates());
        // Without tip slope the blades do not affect the casing and are left out.
        let size = if parameters.arm() == 0.0 { 4 } else { 8 };
        let none = Point::default();
        let offset = units.states(&slope(parameters, held, &none, 1.0).0, size) / rate;
        let unit = |n: usize| units.point(&one_of(size, n));
        let change = |n| units.states(&slope(parameters, held, &unit(n), 0.0).0, size) / rate;
        let matrix = DMatrix::from_columns(&(0..size).map(change).collect::<Vec<_>>());
        let states = matrix.clone().lu().solve(&-offset)?;
        let bound = lyapunov(&matrix)?;
        let inverse = bound.clone().cholesky()?.inverse();
        let mut point = units.point(&states);
        if size == 4 {
            point.a = resting_blades(parameters, held, &point);
        }
        let per_unit = |row: &DVector<f64>| row.dot(&(&inverse * row)).max(0.0).sqrt();
        let pushes = slope(parameters, held, &point, 1.0).1;
        let mut rooms = Vec::new();
        for (k, &push) in pushes.iter().take(held.rows.len()).enumerate() {
            let row = DVector::from_fn(size, |n, _| slope(parameters, held, &unit(n), 0.0).1[k]);
            rooms.push((push, per_unit(&row)));
        }
        // A wave in a corner of the polygon is away from all other sides.
        let fixed = held.rows.len() == 2;
        for row in (0..parameters.rows.len()).filter(|row| !fixed && !held.rows.contains(row)) {
            let along = DVector::from_fn(size, |n, _| {
                let at = unit(n);
                parameters.along(row, at.z, at.a)
            });
            rooms.push((parameters.gap(row, &point), per_unit(&along)));
        }
        let bent = parameters.largest_angle(point.a);
        let turn = DVector::from_fn(size, |n, _| unit(n).a.norm());
        rooms.push((LARGEST_BLADE_ANGLE - bent, 2.0 * per_unit(&turn)));
        let machine = &parameters.machine;
        let least = CERTAIN_PUSH * machine.push_scale(parameters.nu) / machine.casing_mass;
        let certain = pushes.iter().take(held.rows.len()).all(|&push| push > least);
        let holds = certain && rooms.iter().all(|&(room, _)| room > 0.0);
        holds.then_some(Self { point, bound, rooms })
    }

    /// Returns whether the same rows stay in contact for ever from this point on.
    pub(super) fn for_good(&self, parameters: &Parameters, point: &Point) -> bool {
        let left = Point {
            z: point.z - self.point.z,
            dz: point.dz,
            a: point.a - self.point.a,
            da: point.da,
        };
        let x = units(parameters).states(&left, self.bound.nrows());
        let size = x.dot(&(&self.bound * &x)).max(0.0).sqrt();
        self.rooms.iter().all(|&(room, share)| share * size < room)
    }
}

/// Returns the time derivative of a point, and the contact forces. With `full = 1` gaps include the
/// clearance; with 0 they are differences. A residual gap decays at the rate of the casing, so that
/// the equations have no neutral motion in directions that contact blocks.
fn slope(
    parameters: &Parameters,
    held: &Held,
    point: &Point,
    full: f64,
) -> (Point, [f64; crate::tolerances::MOST_HELD]) {
    let rate = parameters.machine.omega_c;
    let (z, a) = parameters.free(point, Plane::default());
    let pushes = held.pushes(&held.each(|row| {
        let gap = full * parameters.apothem(row) + parameters.along(row, point.z, point.a);
        let opening = parameters.along(row, point.dz, point.da);
        parameters.along(row, z, a) + rate * (2.0 * opening + rate * gap)
    }));
    let (casing, tips) = parameters.pushed(held.with(pushes));
    (Point { z: point.dz, dz: z + casing, a: point.da, da: a + tips }, pushes)
}

/// Returns the static blade angle under the contact forces of a casing at rest, for blades that do
/// not affect it.
fn resting_blades(parameters: &Parameters, held: &Held, point: &Point) -> Plane {
    let pushes = slope(parameters, held, point, 1.0).1;
    let (_, tips) = parameters.pushed(held.with(pushes));
    parameters.blades.map_or_else(Plane::default, |blades| tips / blades.propagator.stiffness)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn nothing_is_held_for_good_where_a_push_is_none() {
        let mut random = fastrand::Rng::with_seed(3);
        let (mut pulled, mut kept) = (0, 0);
        for (kappa, mu, speed) in
            [("0.1", "0", "500"), ("0.1", "0.15", "500"), ("0", "0.15", "520")]
        {
            let scene = Scene::base().with(&[
                ("solver.kind", "event"),
                ("bladed_disk.radial_coupling", kappa),
                ("contact.friction", mu),
                ("operation.speed_rad_s", speed),
            ]);
            let parameters = Parameters::new(&scene.unwrap());
            let held = Held::new(&parameters, vec![0, 1]).unwrap();
            let rest = Rest::of(&parameters, &held).unwrap();
            let largest =
                rest.rooms.iter().map(|(room, share)| room / share).fold(f64::INFINITY, f64::min);
            let size = rest.bound.nrows();
            for turn in 0..400 {
                let x = DVector::from_fn(size, |_, _| random.f64() - 0.5);
                let part =
                    0.05 * f64::from(turn % 80) * largest / x.dot(&(&rest.bound * &x)).sqrt();
                let left = units(&parameters).point(&(x * part));
                let point = Point {
                    z: rest.point.z + left.z,
                    dz: left.dz,
                    a: rest.point.a + left.a,
                    da: left.da,
                };
                let pushes = slope(&parameters, &held, &point, 1.0).1;
                let for_good = rest.for_good(&parameters, &point);
                let pulls = pushes.iter().take(2).any(|push| *push <= 0.0);
                assert!(!(for_good && pulls), "{kappa} {mu} {turn}: {pushes:?}");
                pulled += u32::from(pulls);
                kept += u32::from(for_good);
            }
        }
        assert!(pulled > 50 && kept > 100, "{pulled} {kept}");
    }
}
