//! Blades and casing as one where they touch (docs/theory.md, section 10): the compliance
//! that a travelling wave of pushes meets, and the flutter of both where a lock joins them.
//! With the corner held, both move as one, `L_c(s) + (1 + i mu_c) L_a(s)/c2 = 0`, and from
//! some rotor speed on that motion grows. It is also where the pushes of a whirl grow without
//! bound, `B(omega) = 0` at a real frequency.
//!
//! In units of both stiffnesses, with `x = omega/omega_c`, `y = s/omega_bd`,
//! `c = c2 k_c/k_a`: `c (1 - x^2 + 2 i zeta_c x) + (1 + i mu_c)(1 - y^2 + 2 i zeta_bd y)`.

use nalgebra::Complex;

use crate::model::{Machine, Number};
use crate::numeric::real_roots::{Coefficients, Point, product, real_roots, sum};
use crate::tolerances::BESIDE_A_LIMIT;

/// The joint of blades and casing at one rotor speed.
#[derive(Clone, Copy, Debug)]
pub struct Joint<'a> {
    /// The machine, with its friction.
    pub machine: &'a Machine,
    /// Wave frequency in the frame of the blades, `nu = n_d Omega` \[rad/s\].
    pub nu: f64,
    /// Friction that the casing feels, `mu_c`.
    pub casing_friction: f64,
    /// Coupling product `c2 = kappa (kappa + mu) l_b^2` \[m^2\].
    pub coupling_product: f64,
}

impl<'a> Joint<'a> {
    /// At a rotor speed \[rad/s\].
    #[must_use]
    pub fn at(machine: &'a Machine, speed: f64) -> Self {
        Self {
            machine,
            nu: machine.nu(speed),
            casing_friction: machine.casing_friction_at(speed),
            coupling_product: machine.coupling_product_at(speed),
        }
    }

    /// Whether blades and casing meet in one travelling wave: `N' >= 3`, and the modes of
    /// the disk have the diameters of the casing or an alias of them, `+-n_d` modulo `N`.
    #[must_use]
    pub fn has_one_wave(machine: &Machine) -> bool {
        let blades = f64::from(machine.polygon.blades);
        let (disk, casing) = (machine.blade_diameters, machine.nodal_diameters);
        let meets = |sense: f64| (disk + sense * casing).rem_euclid(blades) == 0.0;
        machine.polygon.has_corners() && (meets(1.0) || meets(-1.0))
    }

    /// Dynamic stiffness of the casing at a frequency in the standing frame,
    /// `k_c - omega^2 m_c + i omega d_c` \[N/m\].
    #[must_use]
    pub fn casing_stiffness(&self, omega: f64) -> Complex<f64> {
        let m = self.machine;
        Complex::new(m.casing_stiffness - omega * omega * m.casing_mass, omega * m.casing_damping)
    }

    /// Dynamic stiffness of the blade modes at a frequency in the frame of the
    /// blades, `k_a - s^2 m_a + i s d_a` \[N m/rad\].
    #[must_use]
    pub fn blade_stiffness(&self, s: f64) -> Complex<f64> {
        let m = self.machine;
        let inertia = s * s * m.blade_modal_mass;
        Complex::new(m.blade_modal_stiffness - inertia, s * m.blade_modal_damping)
    }

    /// The joint compliance `B(omega) = (1 + i mu_c)/(casing) + c2/(blades)`, which a
    /// wave of pushes of casing frequency `omega` meets \[m/N\].
    #[must_use]
    pub fn compliance(&self, omega: f64) -> Complex<f64> {
        let turned = Complex::new(1.0, self.casing_friction);
        let casing = turned / self.casing_stiffness(omega);
        if self.coupling_product == 0.0 {
            return casing;
        }
        casing + self.blade_stiffness(omega - self.nu).inv() * self.coupling_product
    }

    /// Lever of a push at the blades, `|kappa + mu| l_b` \[m\].
    #[must_use]
    pub fn blade_lever(&self) -> f64 {
        let machine = self.machine;
        let friction = machine.friction_at(self.nu);
        (machine.radial_coupling + friction).abs() * machine.blade_length
    }
}

/// The flutter speed without any damping, as a magnitude \[rad/s\]:
/// `Omega_f = sqrt[(1/m_c + c2/m_a)(k_c + k_a/c2)]/n_d`, never below the dangerous
/// coincidence. None where tips are not joined or never flutter; for a rotor that turns
/// in the sense of `toward`.
#[must_use]
pub fn undamped_flutter_speed<T: Number>(machine: &Machine<T>, toward: f64) -> Option<T> {
    let joined = Joined::of(machine, toward)?;
    let rate = joined.rate * joined.rate;
    let square = (joined.coupling * rate + 1.0) * (joined.coupling.recip() + 1.0);
    let speed = square.sqrt() * machine.critical_speed()?;
    speed.re().is_finite().then_some(speed)
}

/// The rotor speed above which the lock of a machine flutters, as a magnitude \[rad/s\],
/// with its damping; that is lower than without by a finite amount, however small the
/// damping is (Ziegler's paradox). None where tips are not joined or never flutter; for
/// a rotor that turns in the sense of `toward`.
#[must_use]
pub fn flutter_speed<T: Number>(machine: &Machine<T>, toward: f64) -> Option<T> {
    let joined = Joined::of(machine, toward)?;
    let friction = joined.friction.re() != 0.0;
    let damped = joined.casing.re() != 0.0 || joined.blades.re() != 0.0;
    if !friction && !damped {
        return undamped_flutter_speed(machine, toward);
    }
    let mut limits = match (friction, joined.casing.re() != 0.0) {
        (false, _) => joined.without_friction().into_iter().collect(),
        (true, true) => joined.with_friction(),
        (true, false) => joined.undamped_casing(),
    };
    limits.retain(|turn| turn.re() > 0.0 && turn.re().is_finite());
    limits.sort_by(|a, b| a.re().total_cmp(&b.re()));
    let grows = |turn: f64| joined.growth(turn) > 0.0;
    let starts = |turn: &T| {
        let turn = turn.re();
        !grows(turn * (1.0 - BESIDE_A_LIMIT)) && grows(turn * (1.0 + BESIDE_A_LIMIT))
    };
    let critical = machine.critical_speed()?;
    limits.into_iter().find(starts).map(|turn| turn * critical)
}

/// Growth of the motion that keeps a lock of joined tips, for a gap that does not turn
/// with the blades: the roots `l = i s` \[1/s\]. Empty without joined tips.
#[must_use]
pub fn lock_roots(joint: &Joint) -> Vec<Complex<f64>> {
    let Some(joined) = Joined::of(joint.machine, joint.nu) else { return Vec::new() };
    let omega_c = joint.machine.omega_c;
    let turned = if joint.nu < 0.0 { Complex::conj } else { |value: &Complex<f64>| *value };
    joined.roots(joint.nu.abs() / omega_c).iter().map(|root| turned(root) * omega_c).collect()
}

/// Both structures in units of their stiffnesses, turning forward.
struct Joined<T> {
    /// `c2 k_c/k_a`.
    coupling: T,
    /// `omega_bd/omega_c`.
    rate: T,
    /// `2 zeta_c`.
    casing: T,
    /// `2 zeta_bd`.
    blades: T,
    /// `mu_c`.
    friction: T,
}

impl<T: Number> Joined<T> {
    /// None where the corner cannot move: tips that no bending lifts.
    fn of(machine: &Machine<T>, toward: f64) -> Option<Self> {
        // A rotor that turns backward is the mirror image of one that turns forward.
        let coupling = machine.coupling_product_at(T::from(toward)) * machine.casing_stiffness
            / machine.blade_modal_stiffness;
        let corner = machine.polygon.has_corners() && !machine.has_other_diameters();
        (corner && coupling.re() != 0.0).then(|| Self {
            coupling,
            rate: machine.omega_bd / machine.omega_c,
            casing: machine.casing_damping_ratio * 2.0,
            blades: machine.blade_damping_ratio * 2.0,
            friction: machine.casing_friction_at(T::one()),
        })
    }

    /// `nu/omega_c` of the limit without friction: both parts hold where
    /// `2 zeta_c c x = -2 zeta_bd y`.
    fn without_friction(&self) -> Option<T> {
        let c = self.coupling;
        let square = (c + 1.0) / (c * (c * self.casing * self.casing + self.blades * self.blades));
        let turn = (self.blades + self.rate * c * self.casing).abs() * square.sqrt();
        turn.re().is_finite().then_some(turn)
    }

    /// The same with friction, where the imaginary part gives `x` as a quadratic of `y`
    /// and the real part is a quartic.
    fn with_friction(&self) -> Vec<T> {
        let [c, drag, blades, mu] = [self.coupling, self.casing, self.blades, self.friction];
        let weight = c.re() * drag.re();
        let on = |from: Point, to: Point| -> Coefficients {
            let quadratic = |of: &dyn Fn(Point, Point) -> f64| {
                Coefficients::from([of(from, from), 2.0 * of(from, to), of(to, to)])
            };
            let mixed = |u: Point, v: Point| 0.5 * (u.p * v.q + v.p * u.q);
            let one = quadratic(&|u, v| u.q * v.q);
            let x =
                quadratic(&|u, v| blades.re() * mixed(u, v) + mu.re() * (u.q * v.q - u.p * v.p));
            let rest = quadratic(&|u, v| {
                (c.re() + 1.0) * u.q * v.q - u.p * v.p - mu.re() * blades.re() * mixed(u, v)
            });
            sum(weight * weight, &product(&rest, &one), -c.re(), &product(&x, &x))
        };
        let casing_at = |y: T| -(blades * y + mu * (-(y * y) + 1.0)) / (c * drag);
        let turns = real_roots(&on, &[-1.0, 0.0, 1.0]).into_iter().map(|root| {
            let mut y = T::from(root);
            for _ in 0..2 {
                let x = casing_at(y);
                let value = c * (-(x * x) + 1.0) - y * y + 1.0 - mu * blades * y;
                let x_slope = -(blades - mu * y * 2.0) / (c * drag);
                let slope = c * x * x_slope * -2.0 - y * 2.0 - mu * blades;
                let step = value / slope;
                if step.re().is_finite() {
                    y -= step;
                }
            }
            casing_at(y) - self.rate * y
        });
        turns.collect()
    }

    /// With friction and without damping of the casing.
    fn undamped_casing(&self) -> Vec<T> {
        let [c, blades, mu] = [self.coupling, self.blades, self.friction];
        let mut turns = Vec::with_capacity(4);
        let root = (blades * blades + mu * mu * 4.0).sqrt();
        for y in [(blades + root) / (mu * 2.0), (blades - root) / (mu * 2.0)] {
            let x = ((-(y * y) + 1.0 - mu * blades * y) / c + 1.0).sqrt();
            turns.extend([x - self.rate * y, -x - self.rate * y]);
        }
        turns
    }

    /// The two roots of the joined motion over `omega_c`, at a speed `nu/omega_c`.
    fn roots(&self, turn: f64) -> [Complex<f64>; 2] {
        let [c, rate, drag] = [self.coupling.re(), self.rate.re(), self.casing.re()];
        let turned = Complex::new(1.0, self.friction.re());
        let spin = Complex::new(0.0, turn);
        // c [(l + i n)^2 + 2 zeta_c (l + i n) + 1] + (1 + i mu_c)[(l/r)^2 + 2 zeta_bd l/r + 1].
        let square = turned / (rate * rate) + c;
        let linear = (spin * 2.0 + drag) * c + turned * (self.blades.re() / rate);
        let constant = (spin * spin + spin * drag + 1.0) * c + turned;
        let half = linear / (square * 2.0);
        let root = (half * half - constant / square).sqrt();
        // The larger first; the other without cancellation.
        let far = if (half + root).norm_sqr() >= (half - root).norm_sqr() {
            -half - root
        } else {
            root - half
        };
        let near = if far.norm_sqr() > 0.0 { constant / (square * far) } else { far };
        [far, near]
    }

    fn growth(&self, turn: f64) -> f64 {
        self.roots(turn).iter().map(|root| root.re).fold(f64::NEG_INFINITY, f64::max)
    }
}
