//! Blades and casing coupled at the contact (docs/theory.md, section 10): the compliance that a
//! travelling wave of contact forces encounters, and flutter of the locked motion.
//!
//! In a corner both structures move together, `L_c(s) + (1 + i mu_c) L_a(s)/c2 = 0`, and from some
//! rotor speed on this motion grows. That is also where the contact forces of a whirl become
//! infinite, `B(omega) = 0` at a real frequency.
//!
//! Dimensionless, with `x = omega/omega_c`, `y = s/omega_bd`, `c = c2 k_c/k_a`:
//! `c (1 - x^2 + 2 i zeta_c x) + (1 + i mu_c)(1 - y^2 + 2 i zeta_bd y) = 0` and
//! `nu/omega_c = x - (omega_bd/omega_c) y`. At a stability limit `x` and `y` are real:
//!
//! - real part: `c (1 - x^2) + 1 - y^2 - 2 mu_c zeta_bd y = 0`
//! - imaginary part: `2 c zeta_c x + 2 zeta_bd y + mu_c (1 - y^2) = 0`
//!
//! Read [`Joint`] (compliance), then [`flutters`] and [`lock_windows`] (results), then `HeldPair`
//! (the equations above).

use std::borrow::Cow;

use nalgebra::Complex;

use super::{Corner, Form, Locked};
use crate::model::{LockWindow, Machine};
use crate::numeric::bisection::bisected;
use crate::numeric::real_roots::{Coefficients, Point, product, real_roots, sum};
use crate::tolerances::{FLUTTER_FURTHEST, FLUTTER_STRIDE};

/// Coupling of blades and casing at one rotor speed.
#[derive(Clone, Debug)]
pub struct Joint<'a> {
    /// The machine at that speed.
    pub machine: Cow<'a, Machine>,
    /// Wave frequency in the blade frame, `nu = n_d Omega` \[rad/s\].
    pub nu: f64,
    /// Friction that acts on the casing mode, `mu_c`; negative for backward rotation.
    pub casing_friction: f64,
    /// Coupling product `c2 = kappa (kappa + mu) l_b^2` \[m^2\].
    pub coupling_product: f64,
}

impl<'a> Joint<'a> {
    /// Creates the joint at a rotor speed \[rad/s\].
    #[must_use]
    pub fn at(machine: &'a Machine, speed: f64) -> Self {
        Self::new(machine.at(speed), speed)
    }

    /// Creates the joint of a machine that is already evaluated at that speed.
    pub(super) fn new(machine: Cow<'a, Machine>, speed: f64) -> Self {
        Self {
            nu: machine.nu(speed),
            casing_friction: machine.casing_friction_at(speed),
            coupling_product: machine.coupling_product_at(speed),
            machine,
        }
    }

    /// Returns whether blades and casing are coupled by a single travelling wave: `N' >= 3`, and
    /// the disk modes have the nodal diameters of the casing or an alias of them, `+-n_d` modulo
    /// `N`.
    #[must_use]
    pub fn has_one_wave(machine: &Machine) -> bool {
        let blades = f64::from(machine.polygon.blades);
        let (disk, casing) = (machine.blade_diameters, machine.nodal_diameters);
        let meets = |sense: f64| (disk + sense * casing).rem_euclid(blades) == 0.0;
        machine.polygon.has_corners() && (meets(1.0) || meets(-1.0))
    }

    /// Returns the dynamic stiffness of the casing at a frequency in the stationary frame,
    /// `k_c - omega^2 m_c + i omega d_c` \[N/m\].
    #[must_use]
    pub fn casing_stiffness(&self, omega: f64) -> Complex<f64> {
        let m = &*self.machine;
        Complex::new(m.casing_stiffness - omega * omega * m.casing_mass, omega * m.casing_damping)
    }

    /// Returns the dynamic stiffness of the blade modes at a frequency in the blade frame,
    /// `k_a - s^2 m_a + i s d_a` \[N m/rad\].
    #[must_use]
    pub fn blade_stiffness(&self, s: f64) -> Complex<f64> {
        let m = &*self.machine;
        let inertia = s * s * m.blade_modal_mass;
        Complex::new(m.blade_modal_stiffness - inertia, s * m.blade_modal_damping)
    }

    /// Returns the joint compliance `B(omega) = (1 + i mu_c)/L_c + c2/L_a` for a wave of contact
    /// forces with the casing frequency `omega`; `L_c`, `L_a` are the dynamic stiffnesses of casing
    /// and blades \[m/N\].
    #[must_use]
    pub fn compliance(&self, omega: f64) -> Complex<f64> {
        let turned = Complex::new(1.0, self.casing_friction);
        let casing = turned / self.casing_stiffness(omega);
        if self.coupling_product == 0.0 {
            return casing;
        }
        casing + self.blade_stiffness(omega - self.nu).inv() * self.coupling_product
    }

    /// Returns the lever arm of a contact force on the blade modes, `|kappa + mu| l_b` \[m\].
    #[must_use]
    pub fn blade_lever(&self) -> f64 {
        let machine = &*self.machine;
        let friction = machine.friction_at(self.nu);
        (machine.radial_coupling + friction).abs() * machine.blade_length
    }
}

/// Returns the flutter speed without any damping, as a magnitude \[rad/s\]:
/// `Omega_f = sqrt[(1/m_c + c2/m_a)(k_c + k_a/c2)]/n_d`, which is never below the dangerous
/// coincidence. `None` without corners, with disk modes of other nodal diameters, if the tips do
/// not couple blades and casing, or if the lock never flutters. The sign of `toward` is the
/// direction of rotation.
#[must_use]
pub fn undamped_flutter_speed(machine: &Machine, toward: f64) -> Option<f64> {
    let pair = HeldPair::new(&machine.at(0.0), toward)?;
    let rate = pair.rate * pair.rate;
    let square = (pair.coupling * rate + 1.0) * (pair.coupling.recip() + 1.0);
    let critical = machine.critical_speed()?;
    let mut speed = square.sqrt() * critical;
    if machine.changes_with_speed() {
        // The blade stiffness depends on the speed, so the equation is solved for it.
        let stiffer = machine.stiffening() * (critical / machine.omega_bd_at_rest()).powi(2);
        let left = 1.0 - (pair.coupling * rate + 1.0) / pair.coupling * stiffer;
        speed /= left.sqrt();
    }
    speed.is_finite().then_some(speed)
}

/// Returns the lowest rotor speed at which the damped lock flutters, as a magnitude \[rad/s\]; 0 if
/// it does from rest on. It is lower than without damping by a finite amount, however small the
/// damping (Ziegler's paradox). `None` as in [`undamped_flutter_speed`]. The sign of `toward` is
/// the direction of rotation.
#[must_use]
pub fn flutter_speed(machine: &Machine, toward: f64) -> Option<f64> {
    flutters(machine, toward).first().map(|flutter| flutter.from)
}

/// Returns every range of speeds in which the lock flutters, in increasing order; see
/// [`flutter_speed`]. If the machine changes with speed, only ranges that begin below
/// `FLUTTER_FURTHEST` critical speeds and before the clearance closes.
#[must_use]
pub fn flutters(machine: &Machine, toward: f64) -> Vec<LockWindow> {
    let (Some(pair), Some(critical)) = (HeldPair::new(machine, toward), machine.critical_speed())
    else {
        return Vec::new();
    };
    let furthest = critical * FLUTTER_FURTHEST;
    let closed = machine.closing_speed().map_or(f64::INFINITY, |closed| closed);
    if !pair.has_friction() && !pair.casing_is_damped() && pair.blades == 0.0 {
        let from = undamped_flutter_speed(machine, toward).filter(|from| *from < closed);
        return from.map(|from| LockWindow { from, to: None }).into_iter().collect();
    }
    let grows = |speed: f64| {
        HeldPair::new(&machine.at(speed), toward).is_some_and(|pair| {
            pair.roots(machine.nu(speed) / machine.omega_c).iter().any(|root| root.re > 0.0)
        })
    };
    let mut ends: Vec<f64> = if machine.changes_with_speed() {
        searched_limits(&grows, critical, closed.min(furthest))
    } else {
        pair.limits().into_iter().map(|turn| turn * critical).collect()
    };
    ends.retain(|end| *end > 0.0 && *end < closed);
    ends.sort_by(f64::total_cmp);
    let mut found: Vec<LockWindow> = Vec::new();
    let (mut below, mut inside) = (0.0, false);
    for place in 0..=ends.len() {
        let end = ends.get(place).copied();
        let between = end.map_or(below + critical, |end| 0.5 * (below + end));
        let above = grows(between.min(0.5 * (below + closed)));
        if above && !inside {
            found.push(LockWindow { from: below, to: None });
        } else if let Some(last) = found.last_mut().filter(|_| inside && !above) {
            last.to = Some(below);
        }
        (below, inside) = (end.unwrap_or(below), above);
    }
    found
}

/// Searches for the speeds up to `last` at which growth begins or ends, for a machine that changes
/// with speed \[rad/s\]: sign changes over a geometric scan, refined by bisection.
fn searched_limits(grows: &dyn Fn(f64) -> bool, critical: f64, last: f64) -> Vec<f64> {
    let mut found = Vec::new();
    let mut high = critical / FLUTTER_FURTHEST;
    let (mut low, mut below) = (0.0, grows(0.0));
    while low < last {
        high = high.min(last);
        let above = grows(high);
        if above != below {
            let [before, after] = bisected([low, high], |speed| grows(speed) == above);
            found.push(0.5 * (before + after));
        }
        (low, below, high) = (high, above, high * FLUTTER_STRIDE);
    }
    found
}

/// Returns the window of [`lock_windows`] with the lowest speeds; `None` if there is no window.
#[must_use]
pub fn lock_window(machine: &Machine, toward: f64) -> Option<LockWindow> {
    lock_windows(machine, toward).into_iter().next()
}

/// Returns every window of speeds with a stable lock, in increasing order, for a rotor that turns
/// in the direction of the sign of `toward`: both groups push, and no motion that keeps the contact
/// grows. On a lining only the pushes are considered.
#[must_use]
pub fn lock_windows(machine: &Machine, toward: f64) -> Vec<LockWindow> {
    let pushed = machine.lock_windows(toward);
    if machine.lining.is_some() {
        return pushed;
    }
    let less = |windows: Vec<LockWindow>, flutter: &LockWindow| {
        windows.into_iter().flat_map(|window| window.without(flutter)).collect()
    };
    flutters(machine, toward).iter().fold(pushed, less)
}

/// Returns the growth rate of a lock that is held by pushes at a constant speed, without a lining
/// \[1/s\]. `None` if it is stable, or if there is no such lock.
#[must_use]
pub fn lock_growth(machine: &Machine, speed: f64) -> Option<f64> {
    let corner = Corner::of(machine, speed, None).ok().filter(|_| machine.lining.is_none())?;
    let locked = Locked::new(machine, corner, Form::Modal, true).ok()?;
    let point = locked.at(speed).ok()?;
    point.growth_1_s.filter(|_| point.admissible)
}

/// Returns the roots `l = i s` of the motion that keeps a lock, with gaps that do not turn with the
/// blade angle \[1/s\]. Empty without corners, with disk modes of other nodal diameters, and if the
/// tips do not couple blades and casing.
#[must_use]
pub fn lock_roots(joint: &Joint) -> Vec<Complex<f64>> {
    let Some(pair) = HeldPair::new(&joint.machine, joint.nu) else { return Vec::new() };
    let omega_c = joint.machine.omega_c;
    let turned = if joint.nu < 0.0 { Complex::conj } else { |value: &Complex<f64>| *value };
    pair.roots(joint.nu.abs() / omega_c).iter().map(|root| turned(root) * omega_c).collect()
}

/// Blades and casing that move together in a corner, in units of their stiffnesses, for forward
/// rotation. The speed is `turn = nu/omega_c`.
struct HeldPair {
    /// Coupling `c = c2 k_c/k_a`.
    coupling: f64,
    /// Frequency ratio `omega_bd/omega_c`.
    rate: f64,
    /// Casing damping `2 zeta_c`.
    casing: f64,
    /// Blade damping `2 zeta_bd`.
    blades: f64,
    /// Friction on the casing mode, `mu_c`.
    friction: f64,
}

impl HeldPair {
    /// Creates the pair; `None` if the polygon has no corners, if the blades have modes with other
    /// nodal diameters than the casing, or if the tips do not couple blades and casing.
    fn new(machine: &Machine, toward: f64) -> Option<Self> {
        // A rotor that turns backward is the mirror image of one that turns forward.
        let coupling = machine.coupling_product_at(toward) * machine.casing_stiffness
            / machine.blade_modal_stiffness;
        let corner = machine.polygon.has_corners() && !machine.has_other_diameters();
        (corner && coupling != 0.0).then(|| Self {
            coupling,
            rate: machine.omega_bd / machine.omega_c,
            casing: machine.casing_damping_ratio * 2.0,
            blades: machine.blade_damping_ratio * 2.0,
            friction: machine.casing_friction_at(1.0),
        })
    }

    fn has_friction(&self) -> bool {
        self.friction != 0.0
    }

    fn casing_is_damped(&self) -> bool {
        self.casing != 0.0
    }

    /// Returns the speeds at which a motion neither grows nor decays, in the unit `turn`.
    fn limits(&self) -> Vec<f64> {
        match (self.has_friction(), self.casing_is_damped()) {
            (false, _) => self.limit_without_friction().into_iter().collect(),
            (true, true) => self.limits_with_friction(),
            (true, false) => self.limits_of_undamped_casing(),
        }
    }

    /// Without friction the imaginary part is `2 c zeta_c x = -2 zeta_bd y`; with it the real part
    /// gives the magnitude of both. `None` without damping, or if no real magnitude exists.
    fn limit_without_friction(&self) -> Option<f64> {
        let c = self.coupling;
        let square = (c + 1.0) / (c * (c * self.casing * self.casing + self.blades * self.blades));
        let turn = (self.blades + self.rate * c * self.casing).abs() * square.sqrt();
        turn.is_finite().then_some(turn)
    }

    /// With friction the imaginary part gives `x` as a function of `y`, and the real part becomes a
    /// quartic in `y`.
    fn limits_with_friction(&self) -> Vec<f64> {
        let roots = real_roots(&|from, to| self.quartic(from, to), &[-1.0, 0.0, 1.0]);
        let casing_at = |y: f64| {
            -(self.blades * y + self.friction * (1.0 - y * y)) / (self.coupling * self.casing)
        };
        roots.into_iter().map(|y| casing_at(y) - self.rate * y).collect()
    }

    /// Returns the real part times the square of `2 c zeta_c`, a quartic of `y` between two
    /// points.
    fn quartic(&self, from: Point, to: Point) -> Coefficients {
        let Self { coupling: c, casing, blades, friction: mu, .. } = *self;
        let mixed = |u: Point, v: Point| 0.5 * (u.p * v.q + v.p * u.q);
        let one = Coefficients::quadratic(from, to, |u, v| u.q * v.q);
        let x = Coefficients::quadratic(from, to, |u, v| {
            blades * mixed(u, v) + mu * (u.q * v.q - u.p * v.p)
        });
        let rest = Coefficients::quadratic(from, to, |u, v| {
            (c + 1.0) * u.q * v.q - u.p * v.p - mu * blades * mixed(u, v)
        });
        let weight = c * casing;
        sum(weight * weight, &product(&rest, &one), -c, &product(&x, &x))
    }

    /// Without damping of the casing the imaginary part is a quadratic in `y`, and the real part
    /// gives `x` up to its sign.
    fn limits_of_undamped_casing(&self) -> Vec<f64> {
        let Self { coupling: c, blades, friction: mu, rate, .. } = *self;
        let root = (blades * blades + mu * mu * 4.0).sqrt();
        let places = [(blades + root) / (mu * 2.0), (blades - root) / (mu * 2.0)];
        let turns = places.map(|y| {
            let x = ((1.0 - y * y - mu * blades * y) / c + 1.0).sqrt();
            [x - rate * y, -x - rate * y]
        });
        turns.concat()
    }

    /// Returns the two roots `l = i s/omega_c` at a speed, of `c [(l + i n)^2 + 2 zeta_c (l + i n)
    /// + 1] + (1 + i mu_c)[(l/r)^2 + 2 zeta_bd l/r + 1]`, `n = turn`, `r = omega_bd/omega_c`.
    fn roots(&self, turn: f64) -> [Complex<f64>; 2] {
        let Self { coupling: c, rate, casing: drag, .. } = *self;
        let turned = Complex::new(1.0, self.friction);
        let spin = Complex::new(0.0, turn);
        let square = turned / (rate * rate) + c;
        let linear = (spin * 2.0 + drag) * c + turned * (self.blades / rate);
        let constant = (spin * spin + spin * drag + 1.0) * c + turned;
        let half = linear / (square * 2.0);
        let root = (half * half - constant / square).sqrt();
        // The larger root first; the other from the product of both, which avoids cancellation.
        let far = if (half + root).norm_sqr() >= (half - root).norm_sqr() {
            -half - root
        } else {
            root - half
        };
        let near = if far.norm_sqr() > 0.0 { constant / (square * far) } else { far };
        [far, near]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    /// Returns the machine of Table 1 with `kappa`, `mu`, and both damping ratios.
    fn machine([kappa, mu, casing, blades]: [f64; 4]) -> Machine {
        let mut scene = Scene::base();
        for (path, value) in [
            ("bladed_disk.radial_coupling", kappa),
            ("contact.friction", mu),
            ("casing.tangential_ratio", 0.33),
            ("casing.damping_ratio", casing),
            ("bladed_disk.damping_ratio", blades),
        ] {
            scene.set(path, &value.to_string()).unwrap();
        }
        scene.machine()
    }

    #[test]
    fn a_lock_grows_between_the_ends_of_its_flutter_and_nowhere_else() {
        let choices =
            |kappa: f64| [0.1, 0.3, 0.6].map(|mu| [0.02, 0.1].map(|zeta| [kappa, mu, 0.0, zeta]));
        let others = [
            [0.5, 0.0, 0.05, 0.01],
            [0.5, 0.0, 0.0, 0.01],
            [0.5, 0.0, 0.05, 0.0],
            [0.5, 0.3, 0.05, 0.01],
            [0.5, 0.3, 0.05, 0.0],
            [1.0, 0.1, 0.02, 0.03],
        ];
        let undamped = [0.3, 0.7, 1.5].map(choices).into_iter().flatten().flatten();
        let mut from_rest = 0;
        for data in undamped.chain(others) {
            let machine = machine(data);
            let found = flutters(&machine, 1.0);
            from_rest += usize::from(found[0].from == 0.0);
            let growth = |speed: f64| {
                let roots = lock_roots(&Joint::at(&machine, speed));
                roots.iter().map(|root| root.re).fold(f64::NEG_INFINITY, f64::max)
            };
            for end in found.iter().flat_map(|range| [Some(range.from), range.to]).flatten() {
                assert!(end == 0.0 || growth(end).abs() < 1e-9 * machine.omega_c, "{data:?} {end}");
            }
            for speed in (1..200).map(|n| 7.3 * f64::from(n)) {
                let inside = found.iter().any(|range| range.has(speed));
                assert_eq!(inside, growth(speed) > 0.0, "{data:?} {speed} {found:?}");
            }
        }
        assert!(from_rest > 5, "{from_rest}");
    }

    #[test]
    fn flutter_speeds_of_table_1() {
        let flutter = |data| flutter_speed(&machine(data), 1.0).unwrap();
        let near = |value: f64, expected: f64| (value - expected).abs() < 5e-3;
        assert!(near(flutter([0.5, 0.0, 0.05, 0.04]), 452.804));
        let undamped = undamped_flutter_speed(&machine([0.5, 0.0, 0.05, 0.04]), 1.0).unwrap();
        assert!(near(undamped, 516.281) && near(flutter([0.5, 0.0, 0.0, 0.0]), 516.281));
        assert!(near(flutter([1.0, 0.0, 1e-5, 1e-5]), 341.120));
    }
}
