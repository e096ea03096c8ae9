//! Linear coordinates of the plain stepper, and the bladed disk as a list of modes over the blades.
//!
//! The stiffness of Eqs. (2)-(3), `k_b` on every blade and `k_bb` between
//! neighbours, is circulant, so `cos(k Phi_i)` and `sin(k Phi_i)` are its modes,
//! with `k_b + 2 k_bb (1 - cos(2 pi k/N))` a blade. *full* takes all N of them,
//! *modal* those of `n_d` diameters, *rigid* none.

use std::f64::consts::TAU;

use rubscope_solver::scene::{ModelSize, Scene};

/// One linear coordinate `m x'' + d x' + k x = F` by central differences, in
/// the summed form `(m/h^2 + d/2h) i[n+1] = (m/h^2 - d/2h) i[n] - k x[n] + F`
/// with `i[n] = x[n] - x[n-1]`.
#[derive(Clone, Debug)]
pub struct Oscillator {
    mass: f64,
    damping: f64,
    stiffness: f64,
    /// `(m/h^2 - d/2h)/(m/h^2 + d/2h)`.
    keep: f64,
    /// `1/(m/h^2 + d/2h)`: displacement per force of one step.
    pub compliance: f64,
}

/// `x[n]` and `x[n] - x[n-1]`.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Coordinate {
    pub x: f64,
    pub increment: f64,
}

impl Coordinate {
    /// Moves the latest step.
    pub fn shift(&mut self, by: f64) {
        self.x += by;
        self.increment += by;
    }
}

impl Oscillator {
    /// From mass, stiffness and the viscous damping ratio.
    pub fn new(mass: f64, stiffness: f64, ratio: f64, h: f64) -> Self {
        let damping = 2.0 * ratio * (mass * stiffness).sqrt();
        let (inertia, drag) = (mass / (h * h), damping / (2.0 * h));
        let sum = inertia + drag;
        Self { mass, damping, stiffness, keep: (inertia - drag) / sum, compliance: 1.0 / sum }
    }

    /// At n = 0: `x[-1] = x - h v + h^2/2 a`.
    pub fn start(&self, x: f64, v: f64, force: f64, h: f64) -> Coordinate {
        let a = (force - self.damping * v - self.stiffness * x) / self.mass;
        Coordinate { x, increment: h * v - 0.5 * h * h * a }
    }

    pub fn step(&self, at: Coordinate, force: f64) -> Coordinate {
        let increment =
            self.keep * at.increment + self.compliance * (force - self.stiffness * at.x);
        Coordinate { x: at.x + increment, increment }
    }
}

/// One mode of the disk.
#[derive(Clone, Debug)]
struct Mode {
    oscillator: Oscillator,
    at: Coordinate,
    /// Deflection of every blade at unit coordinate.
    shape: Vec<f64>,
    /// `sum_i shape_i Q (cos, sin)(E Phi_i)` of the excitation.
    drive: [f64; 2],
}

/// The disk and its motion.
#[derive(Clone, Debug)]
pub struct Disk {
    modes: Vec<Mode>,
    blades: usize,
    order: f64,
}

/// `2 pi k i/N` within a turn, so that blades of one phase group have the same angle.
pub fn phase(k: u64, blade: usize, blades: usize) -> f64 {
    TAU * (k * blade as u64 % blades as u64) as f64 / blades as f64
}

impl Disk {
    /// The disk of a scene, at rest at n = 0, before which it knows the torque at the rotor
    /// angle 0.
    pub fn new(scene: &Scene, h: f64) -> Self {
        let blades = scene.bladed_disk.blades as usize;
        let pairs: Vec<u64> = match scene.solver.model {
            ModelSize::Rigid => Vec::new(),
            ModelSize::Modal => vec![u64::from(scene.operation.nodal_diameters)],
            ModelSize::Full => (0..=blades as u64 / 2).collect(),
        };
        let mut modes = Vec::new();
        for k in pairs {
            modes.push(Mode::new(scene, k, false, h));
            if !(2 * k).is_multiple_of(blades as u64) {
                modes.push(Mode::new(scene, k, true, h));
            }
        }
        Self { modes, blades, order: f64::from(scene.excitation.order) }
    }

    /// Continues with the motion of another disk of the same kind.
    pub fn moving_as(mut self, other: &Self) -> Self {
        for (mode, was) in self.modes.iter_mut().zip(&other.modes) {
            mode.at = was.at;
        }
        self
    }

    /// One step without contact at the rotor angle `theta` it starts from.
    pub fn predict(&mut self, theta: f64) {
        let (sin, cos) = (self.order * theta).sin_cos();
        for mode in &mut self.modes {
            let torque = cos * mode.drive[0] - sin * mode.drive[1];
            mode.at = mode.oscillator.step(mode.at, torque);
        }
    }

    /// Angles of all blades \[rad\].
    pub fn angles(&self) -> Vec<f64> {
        let mut angles = vec![0.0; self.blades];
        for mode in self.modes.iter().filter(|mode| mode.at.x != 0.0) {
            for (angle, shape) in angles.iter_mut().zip(&mode.shape) {
                *angle += shape * mode.at.x;
            }
        }
        angles
    }

    /// Angle of blade `a` per unit torque on blade `b` in one step.
    pub fn compliance(&self, a: usize, b: usize) -> f64 {
        let mode = |mode: &Mode| mode.oscillator.compliance * mode.shape[a] * mode.shape[b];
        self.modes.iter().map(mode).sum()
    }

    /// Corrects the step by a torque on a blade, counted from 0; for the modal model, by the
    /// torque on its whole phase group.
    pub fn correct(&mut self, blade: usize, torque: f64) {
        for mode in &mut self.modes {
            mode.at.shift(mode.oscillator.compliance * mode.shape[blade] * torque);
        }
    }
}

impl Mode {
    fn new(scene: &Scene, k: u64, sine: bool, h: f64) -> Self {
        let (disk, excitation) = (&scene.bladed_disk, &scene.excitation);
        let blades = disk.blades as usize;
        let part = |blade| phase(k, blade, blades);
        let shape: Vec<f64> =
            (0..blades).map(|i| if sine { part(i).sin() } else { part(i).cos() }).collect();
        // sum_i shape_i^2: N/2 for a pair, N for a mode alone.
        let weight: f64 = shape.iter().map(|x| x * x).sum();
        let turn = 1.0 - part(1).cos();
        let stiffness = disk.stiffness_nm_per_rad + 2.0 * disk.coupling_nm_per_rad * turn;
        let mut drive = [0.0; 2];
        for (blade, x) in shape.iter().enumerate() {
            let (sin, cos) = phase(u64::from(excitation.order), blade, blades).sin_cos();
            drive[0] += excitation.amplitude_nm * x * cos;
            drive[1] += excitation.amplitude_nm * x * sin;
        }
        let (inertia, stiffness) = (weight * disk.inertia_kg_m2, weight * stiffness);
        let oscillator = Oscillator::new(inertia, stiffness, disk.damping_ratio, h);
        Self { at: oscillator.start(0.0, 0.0, drive[0], h), oscillator, shape, drive }
    }
}
