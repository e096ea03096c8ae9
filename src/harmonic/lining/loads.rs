//! What a lock of two groups on a lining takes, of any kind of number
//! (docs/theory.md, section 10).

use nalgebra::Vector2;

use super::Lining;
use super::equilibria::Balance;
use crate::harmonic::Joint;
use crate::harmonic::lock_loads::LockLoads;
use crate::model::{Machine, Number};

/// A complex number, or a vector in the plane of the wave.
type Pair<T> = [T; 2];

fn times<T: Number>(a: Pair<T>, b: Pair<T>) -> Pair<T> {
    [a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0]]
}

fn dot<T: Number>(a: Pair<T>, n: [f64; 2]) -> T {
    a[0] * n[0] + a[1] * n[1]
}

/// The two groups of the corner that is looked at.
const SIDES: [u32; 2] = [0, 1];

/// The place of the wave that two groups alone hold; none where there is no such place, or
/// the smallest motion leaves it.
fn place(machine: &Machine, speed: f64) -> Option<(Vector2<f64>, Balance<'_>)> {
    let law = machine.lining.filter(|_| Joint::has_one_wave(machine))?;
    let lining =
        Lining { machine, stiffness_n_per_m: law.stiffness_n_per_m, smoothing_m: law.smoothing_m };
    let balance = Balance::at(lining, speed);
    let w = balance.solve(balance.sprung(2)?)?;
    let pushing = balance.gaps(w).filter(|(.., gap)| *gap < 0.0).map(|(side, ..)| side);
    let held = pushing.eq(SIDES) && balance.state(w).is_ok_and(|state| state.stable);
    held.then_some((w, balance))
}

/// The loads of a lock that two groups hold on the lining of a machine; none where no
/// two groups alone do.
pub(in crate::harmonic) fn lock_loads<T: Number>(
    machine: &Machine<T>,
    speed: T,
) -> Option<LockLoads<T>> {
    let (law, plain) = (machine.lining?, machine.plain());
    let (w, balance) = place(&plain, speed.re())?;
    let polygon = &machine.polygon;
    let each = f64::from(polygon.blades_per_side);
    let nu = machine.nu(speed);
    let casing =
        [machine.casing_stiffness - nu * nu * machine.casing_mass, machine.casing_damping * nu];
    let flexible = machine.coupling_product_at(speed) / machine.blade_modal_stiffness;
    let turned = [T::one(), machine.casing_friction_at(speed)];
    let pushed = [casing[0] * flexible + turned[0], casing[1] * flexible + turned[1]];
    let normals = SIDES.map(|side| <[f64; 2]>::from(polygon.direction(side)));
    let push = |w: Pair<T>| normals.map(|n| law.push(machine.clearance() + dot(w, n)) * each);
    let sum =
        |pushes: Pair<T>| [0, 1].map(|k| pushes[0] * normals[0][k] + pushes[1] * normals[1][k]);
    // One step of Newton's method from the root adds the derivatives.
    let root = [T::from(w.x), T::from(w.y)];
    let (held, forced) = (times(casing, root), times(pushed, sum(push(root))));
    let inverse = balance.residual(w).1.try_inverse()? / balance.scale;
    let residual = [held[0] - forced[0], held[1] - forced[1]];
    let w = [0, 1].map(|k| root[k] - residual[0] * inverse[(k, 0)] - residual[1] * inverse[(k, 1)]);
    let pushes = push(w);
    // a = sum P (A - (kappa + mu) l_b) e^{i psi}/k_a, z = w + kappa l_b a.
    let lead = (machine.radial_coupling + machine.friction_at(speed)) * machine.blade_length;
    let bent = sum(pushes).map(|p| -p * lead / machine.blade_modal_stiffness);
    let arm = machine.radial_coupling * machine.blade_length;
    let z = [w[0] + bent[0] * arm, w[1] + bent[1] * arm];
    let levers = normals.map(|n| (z[1] * n[0] - z[0] * n[1]) * machine.nodal_diameters);
    let torques = [pushes[0] * levers[0], pushes[1] * levers[1]];
    let swing = sum(torques).map(|torque| torque / machine.blade_modal_stiffness);
    let angle = |side: u32| {
        let n = polygon.direction(side).into();
        dot(bent, n) + dot(swing, n)
    };
    let larger = |most: T, angle: T| if angle > most { angle } else { most };
    let largest_alpha_rad = (0..polygon.sides).map(|side| angle(side).abs());
    let torque = -(torques[0] + torques[1]);
    let square = z[0] * z[0] + z[1] * z[1];
    let stored = machine.casing_stiffness + machine.casing_mass * nu * nu;
    Some(LockLoads {
        pushes_n: pushes,
        alpha_rad: SIDES.map(angle),
        largest_alpha_rad: largest_alpha_rad.fold(T::zero(), larger),
        amplitude_m: square.sqrt(),
        torque_nm: torque,
        power_w: torque * speed,
        energy_j: stored * square * 0.5,
    })
}
