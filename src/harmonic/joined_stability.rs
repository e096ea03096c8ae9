//! Stability of a lock of inclined or rubbing tips (docs/theory.md, section 10): the
//! motion that keeps both contacts, linearised. Rows of the gaps and columns of the
//! forces differ, so that it is seen in the null spaces of both.
//!
//! For a gap that does not turn with the blades it is the motion of casing and blades as
//! one, `L_c(s) + (1 + i mu_c) L_a(s)/c2 = 0`.

use nalgebra::{Complex, DMatrix, Matrix2, Matrix4, Matrix4x2, Vector4};

use super::joined_lock::{Held, JoinedEquations};
use crate::model::Machine;
use crate::numeric::eigen::eigenvalues;

/// Eigenvalues of the motion about a lock \[1/s\]; `None` where they cannot be computed.
pub(super) fn lock_eigenvalues(
    machine: &Machine,
    speed: f64,
    equations: &JoinedEquations,
    held: &Held,
) -> Option<Vec<Complex<f64>>> {
    let motion = Motion::about(machine, speed, equations, held);
    let rows = follow(&motion.gaps[0], &motion.gaps[1])?;
    let columns = follow(&motion.forces[0], &motion.forces[1])?;
    let reduced = |matrix: &Matrix4<f64>| -> Matrix2<f64> { columns.transpose() * matrix * rows };
    let inverse = reduced(&motion.mass).try_inverse()?;
    let (damping, stiffness) =
        (inverse * reduced(&motion.damping), inverse * reduced(&motion.stiffness));
    let companion = DMatrix::from_fn(4, 4, |row, column| match (row < 2, column < 2) {
        (true, _) => f64::from(u8::from(column == row + 2)),
        (false, true) => -stiffness[(row - 2, column)],
        (false, false) => -damping[(row - 2, column - 2)],
    });
    let values = eigenvalues(companion)?;
    Some(values.into_iter().map(|value| value * machine.omega_c).collect())
}

/// `M w'' + C w' + K w = sum dP G`, with the gaps `row . w = 0`; time in `1/omega_c`.
struct Motion {
    mass: Matrix4<f64>,
    damping: Matrix4<f64>,
    stiffness: Matrix4<f64>,
    gaps: [Vector4<f64>; 2],
    forces: [Vector4<f64>; 2],
}

impl Motion {
    fn about(machine: &Machine, speed: f64, equations: &JoinedEquations, held: &Held) -> Self {
        let turn = machine.nu(speed) / machine.omega_c;
        let rate = machine.omega_c / machine.omega_bd;
        let (casing, blades) =
            (2.0 * machine.casing_damping_ratio, 2.0 * machine.blade_damping_ratio * rate);
        let inertia = rate * rate;
        let mass = Matrix4::from_diagonal(&Vector4::new(1.0, 1.0, inertia, inertia));
        let mut damping = Matrix4::from_diagonal(&Vector4::new(casing, casing, blades, blades));
        damping[(0, 1)] = -2.0 * turn;
        damping[(1, 0)] = 2.0 * turn;
        let (stiff, drag) = equations.casing;
        let mut stiffness = Matrix4::from_diagonal(&Vector4::new(stiff, stiff, 1.0, 1.0));
        stiffness[(0, 1)] = -drag;
        stiffness[(1, 0)] = drag;
        let mut gaps = [Vector4::zeros(); 2];
        let mut forces = [Vector4::zeros(); 2];
        let (n_d, mu) = (equations.diameters, equations.friction);
        for (i, phase) in equations.phases.into_iter().enumerate() {
            let touch = equations.touch(phase, held);
            let push = held[4 + i];
            let (c, s) = touch.direction;
            let shape = [equations.angle * phase.0, equations.angle * phase.1];
            let arm = n_d * touch.across;
            let (row, torque) = (arm - equations.slope, (arm - equations.lever) * equations.share);
            gaps[i] = Vector4::new(c, s, row * shape[0], row * shape[1]);
            let force = [c - mu * s, s + mu * c];
            forces[i] = Vector4::new(force[0], force[1], torque * phase.0, torque * phase.1);
            // The turn of the direction, and the change of the arm.
            for k in 0..2 {
                let turned = n_d * shape[k];
                stiffness[(0, 2 + k)] += push * force[1] * turned;
                stiffness[(1, 2 + k)] -= push * force[0] * turned;
                let torque_of = [phase.0, phase.1][k] * push * n_d * equations.share;
                stiffness[(2 + k, 0)] += torque_of * s;
                stiffness[(2 + k, 1)] -= torque_of * c;
                for (j, bent) in shape.iter().enumerate() {
                    stiffness[(2 + k, 2 + j)] += torque_of * touch.along * n_d * bent;
                }
            }
        }
        Self { mass, damping, stiffness, gaps, forces }
    }
}

/// Null space of two rows: the casing follows the blades.
fn follow(a: &Vector4<f64>, b: &Vector4<f64>) -> Option<Matrix4x2<f64>> {
    let casing = Matrix2::new(a[0], a[1], b[0], b[1]).try_inverse()?;
    let blades = Matrix2::new(a[2], a[3], b[2], b[3]);
    let mut basis = Matrix4x2::zeros();
    basis.fixed_view_mut::<2, 2>(0, 0).copy_from(&(-casing * blades));
    basis.fixed_view_mut::<2, 2>(2, 0).copy_from(&Matrix2::identity());
    Some(basis)
}
