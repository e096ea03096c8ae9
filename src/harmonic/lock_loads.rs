//! What a lock takes, in closed form: pushes, torque, power, blade angle and energy,
//! and the speed at which its branch ends, of any kind of number, so that each comes
//! with its derivatives (docs/theory.md, sections 4 and 8).

use super::corner_angle::CornerAngle;
use super::equations::{Scales, Wave};
use super::{Corner, joined_lock, lining};
use crate::model::{Machine, Number};

/// The loads of the damped lock at one speed, exact for blades that move.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LockLoads<T = f64> {
    /// Pushes of the groups a and b, minus their multipliers; negative pulls \[N\].
    pub pushes_n: [T; 2],
    /// Angle of one blade of each group \[rad\].
    pub alpha_rad: [T; 2],
    /// Largest angle of any blade, in size: those a quarter of the wave away from the
    /// contacts bend most \[rad\].
    pub largest_alpha_rad: T,
    /// Amplitude `|z|` of the casing wave \[m\].
    pub amplitude_m: T,
    /// Torque the rotor must give to hold the wave, `n_d d_c nu |z|^2` without friction,
    /// beside the torque of friction itself \[N m\].
    pub torque_nm: T,
    /// Its power \[W\].
    pub power_w: T,
    /// Energy of the casing wave, `(k_c + m_c nu^2) |z|^2/2` \[J\].
    pub energy_j: T,
}

/// The loads of the lock of a machine at a speed \[rad/s\]; none without corners,
/// beyond the fold of very soft blades, and on a lining where no two groups hold it alone.
#[must_use]
pub fn lock_loads<T: Number>(machine: &Machine<T>, speed: T) -> Option<LockLoads<T>> {
    let clear = machine.clearance().re() > 0.0;
    if !machine.polygon.has_corners() || machine.has_other_diameters() || !clear {
        return None;
    }
    if machine.lining.is_some() {
        return lining::lock_loads(machine, speed);
    }
    if machine.is_joined() {
        return joined(machine, speed);
    }
    let (wave, scales) = (Wave::at(machine, speed, true), Scales::of(machine));
    let delta = machine.polygon.delta;
    let (sin, cos) = (CornerAngle::of(machine).derived(wave.kappa)? + delta).sin_cos();
    let (stiff, drag) = (wave.kappa / cos, wave.drag / sin);
    let pushes = [(drag - stiff) / (cos * 2.0), -(stiff + drag) / (cos * 2.0)];
    let arms = [pushes[0] * sin / cos, -pushes[1] * sin / cos];
    // Of a blade at a phase from the middle of the corner; side `k` after group a.
    let bent = |side: u32| {
        let phase = delta * (2.0 * f64::from(side) - 1.0);
        let torque = arms[0] * (phase + delta).cos() + arms[1] * (phase - delta).cos();
        -torque * scales.share * scales.angle
    };
    let angles = (0..machine.polygon.sides).map(|side| bent(side).abs());
    let largest = angles.fold(T::zero(), |most, angle| if angle > most { angle } else { most });
    let amplitude = scales.length / cos;
    let nu = machine.nu(speed);
    let torque = machine.casing_damping * nu * amplitude * amplitude * machine.nodal_diameters;
    let stored = machine.casing_stiffness + machine.casing_mass * nu * nu;
    Some(LockLoads {
        pushes_n: pushes.map(|push| push * scales.force),
        alpha_rad: [bent(0), bent(1)],
        largest_alpha_rad: largest,
        amplitude_m: amplitude,
        torque_nm: torque,
        power_w: torque * speed,
        energy_j: stored * amplitude * amplitude * 0.5,
    })
}

/// With tips that are inclined or rub.
fn joined<T: Number>(machine: &Machine<T>, speed: T) -> Option<LockLoads<T>> {
    let corner = Corner::paper(&machine.polygon).ok()?;
    let (equations, held) = joined_lock::held(machine, corner, speed)?;
    let [x, y, alpha_c, alpha_s, push_a, push_b] = held;
    let touches = equations.phases.map(|phase| equations.touch(phase, &held));
    let bent = |side: u32| {
        let (c, s) = machine.polygon.direction(side);
        ((alpha_c * c + alpha_s * s) * equations.angle).abs()
    };
    let larger = |most: T, angle: T| if angle > most { angle } else { most };
    let Scales { length, force, .. } = Scales::of(machine);
    let amplitude = (x * x + y * y).sqrt() * length;
    let arms = push_a * touches[0].across + push_b * touches[1].across;
    let torque = -arms * force * length * machine.nodal_diameters;
    let nu = machine.nu(speed);
    let stored = machine.casing_stiffness + machine.casing_mass * nu * nu;
    Some(LockLoads {
        pushes_n: [push_a * force, push_b * force],
        alpha_rad: touches.map(|touch| touch.alpha),
        largest_alpha_rad: (0..machine.polygon.sides).map(bent).fold(T::zero(), larger),
        amplitude_m: amplitude,
        torque_nm: torque,
        power_w: torque * speed,
        energy_j: stored * amplitude * amplitude * 0.5,
    })
}

/// The largest speed with a lock \[rad/s\]: blades that are soft give way above it.
/// None without corners, with tips that are inclined or rub, on a lining, and where it is
/// beyond any speed that a number can square.
#[must_use]
pub fn lock_fold_speed<T: Number>(machine: &Machine<T>) -> Option<T> {
    if machine.is_joined() || machine.has_other_diameters() || machine.lining.is_some() {
        return None;
    }
    let critical = machine.critical_speed()?;
    let kappa = CornerAngle::of(machine).fold_kappa().filter(|_| machine.polygon.has_corners())?;
    Some(critical * (-kappa + 1.0).sqrt())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::harmonic::{Form, Kind, corner_branch, equilibria, locked_motion};
    use crate::scene::Scene;

    fn machine(set: &[(&str, &str)]) -> Machine {
        let mut scene = Scene::base();
        set.iter().for_each(|(path, value)| scene.set(path, value).unwrap());
        scene.machine()
    }

    fn close(value: f64, expected: f64, part: f64) {
        assert!((value - expected).abs() <= part * expected.abs(), "{value} is not {expected}");
    }

    /// The two blade coordinates of the lock.
    fn blade_modes(machine: &Machine, speed: f64) -> [f64; 2] {
        let states = equilibria(machine, speed, true).unwrap();
        let corner = states.iter().find(|state| state.kind == Kind::Corner).unwrap();
        [corner.alpha_c_rad, corner.alpha_s_rad]
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
                let polygon = &machine.polygon;
                let modes = blade_modes(&machine, speed);
                close(loads.largest_alpha_rad, polygon.largest_component(modes[0], modes[1]), 1e-7);
            }
        }
    }

    #[test]
    fn the_branch_ends_at_the_fold() {
        let machine = machine(&[
            ("bladed_disk.stiffness_nm_per_rad", "0.02"),
            ("bladed_disk.coupling_nm_per_rad", "0"),
        ]);
        let fold = lock_fold_speed(&machine).unwrap();
        let branch = corner_branch(&machine, 0, true, [0.0, 2.0 * fold], 0.02).unwrap();
        close(fold, branch.fold.unwrap().speed_rad_s, 1e-12);
        assert!(lock_loads(&machine, 0.999 * fold).is_some());
        assert_eq!(lock_loads(&machine, 1.001 * fold), None);
    }

    #[test]
    fn energy_is_that_of_two_modes_which_turn_the_wave() {
        let machine = machine(&[]);
        for speed in [0.0, 320.0, -430.0] {
            let loads = lock_loads(&machine, speed).unwrap();
            // At any instant, such as one where the wave is at 0.7 rad.
            let (y, x) = 0.7_f64.sin_cos();
            let nu = machine.nu(speed);
            let modes = [(x, -nu * y), (y, nu * x)].map(|(place, rate)| {
                let (place, rate) = (loads.amplitude_m * place, loads.amplitude_m * rate);
                let stretched = 0.5 * machine.casing_stiffness * place * place;
                stretched + 0.5 * machine.casing_mass * rate * rate
            });
            close(loads.energy_j, modes[0] + modes[1], 1e-12);
        }
    }

    #[test]
    fn nothing_is_loaded_without_corners() {
        for diameters in ["0", "11"] {
            let machine = machine(&[("operation.nodal_diameters", diameters)]);
            assert_eq!(lock_loads(&machine, 500.0), None);
            assert_eq!(lock_fold_speed(&machine), None);
        }
    }
}
