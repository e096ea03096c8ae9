//! Proof that a contact is permanent: a lock whose blades have come to rest, or nearly.
//!
//! While the same rows are in contact, a small deviation from the equilibrium obeys `x' = M x`. With
//! `Q` from `M^T Q + Q M = -1`, `x^T Q x` never increases if `Q` is positive definite. It thus bounds
//! all future contact forces and gaps. With slope or friction the motion is linear; without, it is
//! linearised, and half of each margin is reserved for the neglected terms.

use nalgebra::{DMatrix, DVector};

use super::flow::{Flow, pushed};
use super::stretch::{Held, MOST_HELD};
use crate::model::CERTAIN_PUSH;
use crate::model::LARGEST_BLADE_ANGLE;
use crate::motion::Plane;
use crate::motion::point::{Point, Units, one_of};
use crate::numeric::lyapunov::lyapunov;

/// Part of its unit by which a state is changed for a central difference. The function is nearly of
/// second degree, so the difference is exact to round-off.
const DIFFERENCE: f64 = 1e-2;

/// Steps of Newton's method to the equilibrium. Soft blades need them: the differences leave a
/// thousandth of each error.
const NEWTON_STEPS: u32 = 8;

/// Part of a margin that a deviation may use if the motion is linearised.
const LINEARISED: f64 = 0.5;

/// Equilibrium of the motion with some rows in contact, and the bounds of deviations from it.
#[derive(Clone, Debug)]
pub(super) struct Rest {
    /// Equilibrium.
    pub point: Point,
    /// Matrix `Q`, in states of `units`.
    bound: DMatrix<f64>,
    /// For each contact force, each open gap and the blade angle: the distance of its value at
    /// equilibrium from the value that it must not reach, and its largest change per unit of
    /// `sqrt(x^T Q x)`.
    rooms: Vec<(f64, f64)>,
    /// Part of the margins that a deviation may use.
    part: f64,
}

/// Returns the units of the states.
fn units(flow: &Flow) -> Units {
    Units::of(flow.clearance(), flow.machine.blade_length, flow.rates())
}

impl Rest {
    /// Creates the bounds for the motion with these rows in contact; `None` if it has no stable
    /// equilibrium, or one in which the contact would not last.
    pub(super) fn of(flow: &Flow, held: &Held) -> Option<Self> {
        let mut held = held.clone();
        if held.is_fixed(flow) {
            let mut point = Point::default();
            held.close(flow, &mut point)?;
            let (_, pushes) = slope(flow, &mut held, &point)?;
            let rest = Self { point, bound: DMatrix::zeros(0, 0), rooms: vec![], part: 1.0 };
            return is_certain(flow, &held, &pushes).then_some(rest);
        }
        let (units, rate, diameters) = (units(flow), flow.rates(), flow.diameters());
        // Blades that do not affect the casing are omitted.
        let size = if flow.arm() == 0.0 && diameters == 0.0 { 4 } else { 8 };
        let mut x = DVector::zeros(size);
        let mut matrix = DMatrix::zeros(size, size);
        let mut rows = DMatrix::zeros(MOST_HELD, size);
        let steps = if diameters == 0.0 { 2 } else { NEWTON_STEPS };
        for step in 0..steps {
            for n in 0..size {
                let change = one_of(size, n) * DIFFERENCE;
                let [more, less] =
                    [&x + &change, &x - &change].map(|x| slope(flow, &mut held, &units.point(&x)));
                let ((more, pushes), (less, others)) = (more?, less?);
                let change = units.states(&more, size) - units.states(&less, size);
                matrix.set_column(n, &(change / (2.0 * DIFFERENCE * rate)));
                for k in 0..MOST_HELD {
                    rows[(k, n)] = (pushes[k] - others[k]) / (2.0 * DIFFERENCE);
                }
            }
            if step + 1 < steps {
                let (offset, _) = slope(flow, &mut held, &units.point(&x))?;
                x -= matrix.clone().lu().solve(&(units.states(&offset, size) / rate))?;
            }
        }
        let mut point = units.point(&x);
        let (_, pushes) = slope(flow, &mut held, &point)?;
        if size == 4 {
            // The static angle of blades that do not affect the casing.
            let (_, tips) = pushed(held.facing(pushes));
            point.a = flow.blades.map_or_else(Plane::default, |b| tips / b.propagator.stiffness);
        }
        let bound = lyapunov(&matrix)?;
        let inverse = bound.clone().cholesky()?.inverse();
        let per_unit = |row: &DVector<f64>| row.dot(&(&inverse * row)).max(0.0).sqrt();
        let mut rooms = Vec::new();
        for (k, &push) in pushes.iter().take(held.rows.len()).enumerate() {
            rooms.push((push, per_unit(&rows.row(k).transpose())));
        }
        // A wave in a corner of the polygon is away from all other sides.
        let fixed = held.rows.len() == 2;
        let unit = |n: usize| units.point(&one_of(size, n));
        for row in (0..flow.rows.len()).filter(|row| !fixed && !held.rows.contains(row)) {
            let face = flow.face(row, &point);
            let along = DVector::from_fn(size, |n, _| face.along(unit(n).z, unit(n).a));
            rooms.push((flow.gap(row, &point), per_unit(&along)));
        }
        let bent = flow.largest_angle(point.a);
        let turn = DVector::from_fn(size, |n, _| unit(n).a.norm());
        rooms.push((LARGEST_BLADE_ANGLE - bent, 2.0 * per_unit(&turn)));
        let part = if diameters == 0.0 { 1.0 } else { LINEARISED };
        let certain = is_certain(flow, &held, &pushes);
        let holds = certain && rooms.iter().all(|&(room, _)| room > 0.0);
        holds.then_some(Self { point, bound, rooms, part })
    }

    /// Returns whether the same rows stay in contact for ever from this point on.
    pub(super) fn for_good(&self, flow: &Flow, point: &Point) -> bool {
        let left = Point {
            z: point.z - self.point.z,
            dz: point.dz,
            a: point.a - self.point.a,
            da: point.da,
        };
        let x = units(flow).states(&left, self.bound.nrows());
        let size = x.dot(&(&self.bound * &x)).max(0.0).sqrt();
        self.rooms.iter().all(|&(room, share)| share * size < self.part * room)
    }
}

/// Returns whether the contact forces push beyond doubt.
fn is_certain(flow: &Flow, held: &Held, pushes: &[f64; MOST_HELD]) -> bool {
    let machine = &flow.machine;
    let least = CERTAIN_PUSH * machine.push_scale(flow.nu) / machine.casing_mass;
    pushes.iter().take(held.rows.len()).all(|&push| push > least)
}

/// Returns the time derivative of a point, and the contact forces. A residual gap decays at the rate
/// of the casing, so that the equations have no neutral motion in directions that contact blocks.
/// `None` if the contact matrix is singular.
fn slope(flow: &Flow, held: &mut Held, point: &Point) -> Option<(Point, [f64; MOST_HELD])> {
    held.face(flow, point)?;
    let rate = flow.machine.omega_c;
    let free = flow.free(point, Plane::default());
    let pushes = held.pushes(&held.each(|row, face| {
        let (gap, opening) = (flow.gap_at(row, face, point), face.along(point.dz, point.da));
        flow.gap_bend(face, point, free) + rate * (2.0 * opening + rate * gap)
    }));
    let (casing, tips) = pushed(held.facing(pushes));
    Some((Point { z: point.dz, dz: free.0 + casing, a: point.da, da: free.1 + tips }, pushes))
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
            let flow = Flow::new(&scene.unwrap());
            let rows = [0, 1].map(|row| (row, flow.face(row, &Point::default())));
            let mut held = Held::new(rows.into_iter()).unwrap();
            let rest = Rest::of(&flow, &held).unwrap();
            let largest =
                rest.rooms.iter().map(|(room, share)| room / share).fold(f64::INFINITY, f64::min);
            let size = rest.bound.nrows();
            for turn in 0..400 {
                let x = DVector::from_fn(size, |_, _| random.f64() - 0.5);
                let part =
                    0.05 * f64::from(turn % 80) * largest / x.dot(&(&rest.bound * &x)).sqrt();
                let left = units(&flow).point(&(x * part));
                let point = Point {
                    z: rest.point.z + left.z,
                    dz: left.dz,
                    a: rest.point.a + left.a,
                    da: left.da,
                };
                let pushes = slope(&flow, &mut held, &point).unwrap().1;
                let for_good = rest.for_good(&flow, &point);
                let pulls = pushes.iter().take(2).any(|push| *push <= 0.0);
                assert!(!(for_good && pulls), "{kappa} {mu} {turn}: {pushes:?}");
                pulled += u32::from(pulls);
                kept += u32::from(for_good);
            }
        }
        assert!(pulled > 50 && kept > 100, "{pulled} {kept}");
    }
}
