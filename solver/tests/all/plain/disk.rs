//! The bladed disk of the plain stepper: a list of modes over the blades.
//!
//! The stiffness of Eqs. (2)-(3), `k_b` on every blade and `k_bb` between
//! neighbours, is circulant, so `cos(k Phi_i)` and `sin(k Phi_i)` are its modes,
//! with `k_b + 2 k_bb (1 - cos(2 pi k/N))` a blade. *full* takes all N of them,
//! *modal* those of `n_d` diameters, *rigid* none.

use rubscope_solver::scene::{ModelSize, Scene};

use super::dd::{Dd, ONE, TAU, ZERO};

/// One linear coordinate `m x'' + d x' + k x = F` by central differences, in
/// the summed form `(m/h^2 + d/2h) i[n+1] = (m/h^2 - d/2h) i[n] - k x[n] + F`
/// with `i[n] = x[n] - x[n-1]`.
#[derive(Clone, Debug)]
pub struct Oscillator {
    mass: Dd,
    damping: Dd,
    stiffness: Dd,
    /// `(m/h^2 - d/2h)/(m/h^2 + d/2h)`.
    keep: Dd,
    /// `1/(m/h^2 + d/2h)`: displacement per force of one step.
    pub compliance: Dd,
}

/// `x[n]` and `x[n] - x[n-1]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coordinate {
    pub x: Dd,
    pub increment: Dd,
}

impl Oscillator {
    /// From mass, stiffness and the viscous damping ratio.
    pub fn new(mass: Dd, stiffness: Dd, ratio: f64, h: Dd) -> Self {
        let two = Dd::from(2.0);
        let damping = two * Dd::from(ratio) * (mass * stiffness).sqrt();
        let (inertia, drag) = (mass / (h * h), damping / (two * h));
        let sum = inertia + drag;
        Self { mass, damping, stiffness, keep: (inertia - drag) / sum, compliance: ONE / sum }
    }

    /// At n = 0: `x[-1] = x - h v + h^2/2 a`.
    pub fn start(&self, x: f64, v: f64, force: Dd, h: Dd) -> Coordinate {
        let (x, v) = (Dd::from(x), Dd::from(v));
        let a = (force - self.damping * v - self.stiffness * x) / self.mass;
        Coordinate { x, increment: h * v - h * h * a / Dd::from(2.0) }
    }

    pub fn step(&self, at: Coordinate, force: Dd) -> Coordinate {
        let increment =
            self.keep * at.increment + self.compliance * (force - self.stiffness * at.x);
        Coordinate { x: at.x + increment, increment }
    }
}

/// One mode of the disk.
#[derive(Clone, Debug)]
pub struct Mode {
    pub oscillator: Oscillator,
    pub at: Coordinate,
    /// Deflection of every blade at unit coordinate.
    pub shape: Vec<Dd>,
    /// `sum_i shape_i Q (cos, sin)(E Phi_i)` of the excitation.
    drive: (Dd, Dd),
    rough: Vec<f64>,
}

/// The disk and its motion.
#[derive(Clone, Debug)]
pub struct Disk {
    pub modes: Vec<Mode>,
    blades: usize,
    order: Dd,
    driven: bool,
}

/// `2 pi k i/N`, whole turns dropped before rounding, so that blades of one
/// phase group have the same angle to the last digit.
pub fn phase(k: u64, blade: usize, blades: usize) -> Dd {
    let part = (u128::from(k) * blade as u128 % blades as u128) as u64;
    TAU * Dd::from(part) / Dd::from(blades as u64)
}

impl Disk {
    /// The disk of a scene, at rest.
    pub fn new(scene: &Scene, h: Dd) -> Self {
        let blades = scene.bladed_disk.blades as usize;
        let diameters = u64::from(scene.operation.nodal_diameters);
        let pairs: Vec<u64> = match scene.solver.model {
            ModelSize::Rigid => Vec::new(),
            ModelSize::Modal => vec![diameters],
            ModelSize::Full => (0..=blades as u64 / 2).collect(),
        };
        let mut modes = Vec::new();
        for k in pairs {
            modes.push(Mode::new(scene, k, false, h));
            if !(2 * k).is_multiple_of(blades as u64) {
                modes.push(Mode::new(scene, k, true, h));
            }
        }
        Self {
            modes,
            blades,
            order: Dd::from(u64::from(scene.excitation.order)),
            driven: scene.excitation.amplitude_nm != 0.0,
        }
    }

    /// At rest at n = 0, before which it knows the torque at the rotor angle 0.
    pub fn starting(mut self, h: Dd) -> Self {
        for mode in &mut self.modes {
            mode.at = mode.oscillator.start(0.0, 0.0, mode.drive.0, h);
        }
        self
    }

    /// Continues with the motion of another disk of the same kind.
    pub fn moving_as(mut self, other: &Self) -> Self {
        for (mode, was) in self.modes.iter_mut().zip(&other.modes) {
            mode.at = was.at;
        }
        self
    }

    /// One step without contact at the rotor angle `theta` it starts from.
    pub fn predict(&mut self, theta: Dd) {
        if self.driven {
            let (sin, cos) = (self.order * theta).sin_cos();
            for mode in &mut self.modes {
                let torque = cos * mode.drive.0 - sin * mode.drive.1;
                mode.at = mode.oscillator.step(mode.at, torque);
            }
        } else if !self.is_at_rest() {
            for mode in &mut self.modes {
                mode.at = mode.oscillator.step(mode.at, ZERO);
            }
        }
    }

    fn is_at_rest(&self) -> bool {
        self.modes.iter().all(|mode| mode.at == Coordinate::default())
    }

    /// Angle of a blade, counted from 0 \[rad\].
    pub fn angle(&self, blade: usize) -> Dd {
        self.modes.iter().map(|mode| mode.shape[blade] * mode.at.x).sum()
    }

    /// All angles, to double precision \[rad\].
    pub fn angles(&self) -> Vec<f64> {
        let mut angles = vec![0.0; self.blades];
        if !self.is_at_rest() {
            for mode in &self.modes {
                for (angle, shape) in angles.iter_mut().zip(&mode.rough) {
                    *angle += shape * mode.at.x.0;
                }
            }
        }
        angles
    }

    /// Angle of blade `a` per unit torque on blade `b` in one step.
    pub fn compliance(&self, a: usize, b: usize) -> Dd {
        let mode = |mode: &Mode| mode.oscillator.compliance * mode.shape[a] * mode.shape[b];
        self.modes.iter().map(mode).sum()
    }

    /// Corrects the step by a torque on blade `blade`; for the modal model, by
    /// the torque on its whole phase group.
    pub fn correct(&mut self, blade: usize, torque: Dd) {
        for mode in &mut self.modes {
            let change = mode.oscillator.compliance * mode.shape[blade] * torque;
            mode.at.x += change;
            mode.at.increment += change;
        }
    }
}

impl Mode {
    fn new(scene: &Scene, k: u64, sine: bool, h: Dd) -> Self {
        let disk = &scene.bladed_disk;
        let blades = disk.blades as usize;
        let shape: Vec<Dd> = (0..blades)
            .map(|blade| {
                let (sin, cos) = phase(k, blade, blades).sin_cos();
                if sine { sin } else { cos }
            })
            .collect();
        // sum_i shape_i^2: N/2 for a pair, N for a mode alone.
        let weight: Dd = shape.iter().map(|&x| x * x).sum();
        let turn = ONE - phase(k, 1, blades).sin_cos().1;
        let stiffness = Dd::from(disk.stiffness_nm_per_rad)
            + Dd::from(2.0) * Dd::from(disk.coupling_nm_per_rad) * turn;
        let (amplitude, order) = (scene.excitation.amplitude_nm, scene.excitation.order);
        let driven = |blade: usize| {
            let (sin, cos) = phase(u64::from(order), blade, blades).sin_cos();
            let torque = Dd::from(amplitude) * shape[blade];
            (torque * cos, torque * sin)
        };
        let drive = (0..blades).map(driven).fold((ZERO, ZERO), |a, b| (a.0 + b.0, a.1 + b.1));
        let inertia = weight * Dd::from(disk.inertia_kg_m2);
        Self {
            oscillator: Oscillator::new(inertia, weight * stiffness, disk.damping_ratio, h),
            at: Coordinate::default(),
            drive,
            rough: shape.iter().map(|x| x.0).collect(),
            shape,
        }
    }
}
