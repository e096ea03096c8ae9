//! Locked motion: two phase groups hold the casing wave in a corner of the polygon, where it is an
//! equilibrium of the blade frame (docs/theory.md, section 8).
//!
//! [`locked_motion`] computes it for a list of speeds, with its character and stability.
//! [`lock_loads`] gives contact forces, torque, power and blade angles.

use super::held::Held;
use super::{Character, Corner, Form, error, lining};
use crate::model::Machine;
use crate::scene::SceneError;

/// Locked motion at one rotor speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LockedPoint {
    /// Rotor speed `Omega` \[rad/s\].
    pub speed_rad_s: f64,
    /// Multipliers `[Lambda_a, Lambda_b]`, summed over each group; negative is a push \[N\].
    pub multipliers_n: [f64; 2],
    /// Blade angle of each group, `[alpha_a, alpha_b]` \[rad\].
    pub alpha_rad: [f64; 2],
    /// Cosine part `u_cc` of `u_c(t)`, Eq. (25) \[m\].
    pub u_cc_m: f64,
    /// Sine part `u_cs` of `u_c(t)` \[m\].
    pub u_cs_m: f64,
    /// Cosine part `u_sc` of `u_s(t)` \[m\].
    pub u_sc_m: f64,
    /// Sine part `u_ss` of `u_s(t)` \[m\].
    pub u_ss_m: f64,
    /// Amplitude `|z|` of the casing wave \[m\].
    pub amplitude_m: f64,
    /// Smallest gap of all groups that are not in contact; infinite if there are none \[m\].
    pub smallest_gap_m: f64,
    /// Torque of the rotor that sustains the wave, `sum Lambda A`, without the torque of friction
    /// itself, `mu sum P R_c` \[N m\].
    pub torque_nm: f64,
    /// Power of that torque, `torque Omega` \[W\].
    pub power_w: f64,
    /// Whether real contact can hold the state, and its stability. In every form the stability is
    /// that of the time model with two blade modes.
    pub character: Character,
    /// Whether pushes can hold the state: no multiplier is tensile, and every other gap is open.
    pub admissible: bool,
    /// Whether the state is admissible and no motion that keeps both contacts grows.
    pub stable: bool,
    /// Largest growth rate of the motions that keep both contacts; `None` if none grows, if the
    /// state is not admissible, or if the eigenvalues cannot be computed \[1/s\].
    pub growth_1_s: Option<f64>,
    /// Norm of the residuals of the equations, dimensionless: gaps in `g0`, forces in `k_c g0`, torques
    /// in the unit that the solver of the equations takes.
    pub residual: f64,
}

/// Solver of the locked motion of one machine, for one corner and one form of the equations.
#[derive(Clone, Debug)]
pub struct Locked {
    machine: Machine,
    corner: Corner,
    form: Form,
    damped: bool,
}

/// Locked motion for a list of speeds.
#[derive(Clone, Debug, PartialEq)]
pub struct Sweep {
    /// Corner that holds the wave.
    pub corner: Corner,
    /// Form of the equations.
    pub form: Form,
    /// Whether damping of casing and blades is included.
    pub damped: bool,
    /// One point for each speed with a locked motion, in the given order.
    pub points: Vec<LockedPoint>,
    /// Speeds without a locked motion: the branch of soft blades has folded back, or the blades
    /// have grown into the casing \[rad/s\].
    pub missing: Vec<f64>,
}

impl Locked {
    /// Creates the solver. Undamped it solves the paper's Eq. (27); damping adds `d_c` to the
    /// casing rows.
    ///
    /// # Errors
    /// The polygon has no corners, the disk modes have other nodal diameters than the casing, there
    /// is no clearance, or a form other than modal is combined with unequal, inclined or rubbing
    /// tips.
    pub fn new(
        machine: &Machine,
        corner: Corner,
        form: Form,
        damped: bool,
    ) -> Result<Self, SceneError> {
        let corner = match machine.has_unequal_tips() {
            true => corner,
            false => Corner::after(&machine.polygon, corner.a)?,
        };
        error::refuse_other_diameters(machine)?;
        error::refuse_preload(&machine.at(0.0))?;
        if form != Form::Modal && machine.has_unequal_tips() {
            let allowed = "modal with unequal tips";
            return Err(SceneError::refused("form", form, allowed));
        }
        if form != Form::Modal {
            let allowed = format!("0 with the form {form}; only the form modal includes it");
            error::refuse_tips(machine, &allowed)?;
        }
        Ok(Self {
            machine: if damped { machine.clone() } else { machine.clone().undamped() },
            corner,
            form,
            damped,
        })
    }

    /// Returns the corner that holds the wave.
    #[must_use]
    pub fn corner(&self) -> Corner {
        self.corner
    }

    /// Returns the locked motion at one speed \[rad/s\]; `None` if there is none: the branch of soft
    /// blades has folded back, or the blades have grown into the casing.
    #[must_use]
    pub fn at(&self, speed: f64) -> Option<LockedPoint> {
        let machine = &*self.machine.at(speed);
        let held = Held::in_corner(machine, speed, self.corner, self.form)?;
        let smallest_gap_m = held.smallest_gap(machine);
        let mut growth = None;
        let character = held.character(machine, smallest_gap_m, || {
            growth = held.growth();
            growth.is_some()
        });
        let LockLoads { pushes_n: [a, b], alpha_rad, amplitude_m, torque_nm, power_w } =
            LockLoads::of(machine, speed, &held)?;
        let (x, y) = (held.at.x, held.at.y);
        Some(LockedPoint {
            speed_rad_s: speed,
            multipliers_n: [-a, -b],
            alpha_rad,
            u_cc_m: x,
            u_cs_m: -y,
            u_sc_m: y,
            u_ss_m: x,
            amplitude_m,
            smallest_gap_m,
            torque_nm,
            power_w,
            character,
            admissible: character.is_admissible(),
            stable: character == Character::Stable,
            growth_1_s: growth.filter(|growth| growth.is_finite()),
            residual: held.residual,
        })
    }

    /// Returns the lock at a speed \[rad/s\] if it is admissible as in [`Self::at`].
    pub(super) fn admissible(&self, speed: f64) -> Option<Held> {
        let machine = &*self.machine.at(speed);
        let held = Held::in_corner(machine, speed, self.corner, self.form)?;
        (held.pushes() && held.smallest_gap(machine) >= 0.0).then_some(held)
    }

    /// Computes the locked motion at each speed \[rad/s\].
    ///
    /// # Errors
    /// A speed is not finite.
    pub fn sweep(&self, speeds: &[f64]) -> Result<Sweep, SceneError> {
        error::refuse_endless(speeds)?;
        let mut points = Vec::with_capacity(speeds.len());
        let mut missing = Vec::new();
        for &speed in speeds {
            match self.at(speed) {
                Some(point) => points.push(point),
                None => missing.push(speed),
            }
        }
        Ok(Sweep { corner: self.corner, form: self.form, damped: self.damped, points, missing })
    }
}

/// Computes the locked motion of a machine with rigid contact in a round casing for a list of
/// speeds \[rad/s\].
///
/// The wave is held between the groups of two blades. `None` selects the paper's pair for equal
/// tips, otherwise the corner that is held at the lowest speed ([`Corner::of`]). As in the paper's
/// equations there is no damping unless `damped` is set. A machine that changes with speed is
/// evaluated at each speed. Speeds without a solution have no point. On a lining use
/// [`super::lock_loads`].
///
/// ```
/// use rubscope_solver::harmonic::{Form, locked_motion};
/// use rubscope_solver::scene::Scene;
///
/// let machine = Scene::builtin("paper-nd3")?.machine();
/// let speeds: Vec<f64> = (0..=500).map(f64::from).collect();
/// let sweep = locked_motion(&machine, Form::Modal, false, Some([6, 21]), &speeds)?;
/// let last = sweep.points[500];
/// assert!((last.multipliers_n[0] - -150.85535).abs() < 1e-4);
/// assert!(last.admissible && last.stable);
/// assert!(!sweep.points[292].admissible && sweep.points[293].admissible);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// The polygon has no corners, the blades are not phase neighbours, a speed is not finite, there is
/// no clearance, the disk modes have other nodal diameters, or unequal, inclined or rubbing tips
/// are combined with a form other than [`Form::Modal`].
pub fn locked_motion(
    machine: &Machine,
    form: Form,
    damped: bool,
    blades: Option<[u32; 2]>,
    speeds: &[f64],
) -> Result<Sweep, SceneError> {
    let corner = Corner::of(machine, speeds.last().copied().unwrap_or(1.0), blades)?;
    Locked::new(machine, corner, form, damped)?.sweep(speeds)
}

/// Loads of the damped lock at one speed, with moving blades.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LockLoads {
    /// Contact forces of groups a and b, the negative multipliers; negative is a pull \[N\].
    pub pushes_n: [f64; 2],
    /// Blade angle of each group \[rad\].
    pub alpha_rad: [f64; 2],
    /// Amplitude `|z|` of the casing wave \[m\].
    pub amplitude_m: f64,
    /// Torque of the rotor that sustains the wave, `n_d d_c nu |z|^2` without friction; the torque
    /// of friction itself is not included \[N m\].
    pub torque_nm: f64,
    /// Power of that torque \[W\].
    pub power_w: f64,
}

/// Returns the loads of the lock at a speed \[rad/s\]. `None` without corners or clearance, with
/// disk modes of other nodal diameters, if no corner of unequal tips is held, beyond the fold of
/// very soft blades, and on a lining if no two groups alone hold the wave.
#[must_use]
pub fn lock_loads(machine: &Machine, speed: f64) -> Option<LockLoads> {
    let machine = &*machine.at(speed);
    let clear = machine.clearance() > 0.0;
    if !machine.polygon.has_corners() || machine.has_other_diameters() || !clear {
        return None;
    }
    if machine.lining.is_some() {
        return lining::lock_loads(machine, speed);
    }
    let corner = Corner::of(machine, speed, None).ok()?;
    LockLoads::of(machine, speed, &Held::in_corner(machine, speed, corner, Form::Modal)?)
}

impl LockLoads {
    /// Returns the loads of a state in a corner at a speed \[rad/s\].
    pub(super) fn of(machine: &Machine, speed: f64, held: &Held) -> Option<Self> {
        let (&[a, b], &[of_a, of_b]) = (held.sides.as_slice(), held.multipliers.as_slice()) else {
            return None;
        };
        let torque_nm = held.torque();
        Some(Self {
            pushes_n: [-of_a, -of_b],
            alpha_rad: [a, b].map(|side| held.alpha(machine.polygon.direction(side))),
            amplitude_m: held.amplitude(),
            torque_nm,
            power_w: torque_nm * speed,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::harmonic::{Form, locked_motion};
    use crate::scene::Scene;

    fn machine(set: &[(&str, &str)]) -> Machine {
        let mut scene = Scene::base();
        set.iter().for_each(|(path, value)| scene.set(path, value).unwrap());
        scene.machine()
    }

    fn close(value: f64, expected: f64, part: f64) {
        assert!((value - expected).abs() <= part * expected.abs(), "{value} is not {expected}");
    }

    #[test]
    fn loads_are_those_of_the_harmonic_balance() {
        for (set, part) in [
            (&[][..], 1e-12),
            (&[("operation.nodal_diameters", "4")], 1e-12),
            (
                &[
                    ("bladed_disk.stiffness_nm_per_rad", "0.02"),
                    ("bladed_disk.coupling_nm_per_rad", "0"),
                ],
                1e-10,
            ),
        ] {
            let machine = machine(set);
            for speed in [320.0, 500.0, -430.0] {
                let sweep = locked_motion(&machine, Form::Modal, true, None, &[speed]).unwrap();
                let point = sweep.points[0];
                let loads = lock_loads(&machine, speed).unwrap();
                for i in [0, 1] {
                    close(-loads.pushes_n[i], point.multipliers_n[i], part);
                    close(loads.alpha_rad[i], point.alpha_rad[i], 1e-7);
                }
                close(loads.torque_nm, point.torque_nm, 1e-9);
                close(loads.power_w, point.power_w, 1e-9);
                close(loads.amplitude_m, point.amplitude_m, part);
            }
        }
    }

    #[test]
    fn nothing_is_loaded_without_corners() {
        for diameters in ["0", "11"] {
            let machine = machine(&[("operation.nodal_diameters", diameters)]);
            assert_eq!(lock_loads(&machine, 500.0), None);
        }
    }
}
