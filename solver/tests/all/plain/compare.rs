//! Compares the explicit motion of the program with the plain stepper, and
//! bounds the difference by round-off.

use rubscope_solver::motion::{Change, Motion};
use rubscope_solver::scene::Scene;

use super::{Failure, Plain, Why};

/// Displacement of the second stepper that shows how the motion amplifies, as a
/// part of the clearance: far above round-off, far below what changes contacts.
const PERTURBATION: f64 = 1e-9;
/// Times the estimated round-off that is still taken as round-off.
pub(super) const ROOM: f64 = 40.0;
/// Amplification above which states are not compared.
pub const CHAOS: f64 = 1e5;

/// The program, the plain stepper, and a slightly displaced plain stepper.
#[derive(Clone)]
pub struct Pair {
    pub motion: Motion,
    pub plain: Plain,
    perturbed: Plain,
    /// Amplification when it was perturbed.
    amplified_before: f64,
    pub(super) scene: Scene,
    /// Sum of `n_d |speed| h` over all steps, a bound on `n_d theta`.
    pub(super) turned: f64,
    /// Impulses of the sides at the latest look.
    pub(super) impulses: Vec<f64>,
    /// Time of that look.
    pub(super) looked: f64,
    /// How much longer an early difference is by now, at least 1.
    pub amplified: f64,
}

impl Pair {
    pub fn new(scene: &Scene) -> Self {
        let (plain, scene) = (Plain::new(scene), scene.clone());
        let motion = Motion::new(&scene.checked().unwrap());
        let perturbed = plain.clone();
        let mut pair = Self {
            motion,
            plain,
            perturbed,
            amplified_before: 1.0,
            scene,
            turned: 0.0,
            impulses: Vec::new(),
            looked: 0.0,
            amplified: 1.0,
        };
        pair.perturbation();
        pair
    }

    /// Displaces the second stepper slightly from the first.
    fn perturbation(&mut self) {
        self.perturbed = self.plain.clone();
        self.perturbed.perturbation(PERTURBATION * self.clearance());
        self.amplified_before = self.amplified;
    }

    /// How far the perturbed motion is by now, in position and rate; perturbs
    /// it again if a contact has removed the difference.
    fn watch(&mut self) {
        let time = 1.0 / (self.h() * self.scene.machine().omega_c);
        let rates = time * distance(self.perturbed.increments(), self.plain.increments());
        let apart = distance(self.perturbed.u(), self.plain.u()).hypot(rates);
        let ratio = apart / (PERTURBATION * self.clearance());
        self.amplified = f64::max(1.0, self.amplified_before * ratio);
        if ratio < 0.1 {
            self.perturbation();
        }
    }

    /// Advances all; a failure must be at the same step for the same reason.
    pub fn advance(&mut self, until: f64) -> Result<(), Failure> {
        let before = self.plain.time();
        let met = self.plain.advance(until);
        let program = self.motion.advance(until);
        let rotor = self.motion.rotor();
        let fastest = rotor.speed(before).abs().max(rotor.speed(until).abs());
        self.turned += f64::from(self.scene.operation.nodal_diameters) * fastest * (until - before);
        assert_eq!(met.is_ok(), program.is_ok(), "plain {met:?}, program {program:?}");
        if let (Err(plain), Err(program)) = (met, program) {
            let word = match plain.why {
                Why::Penetration(_) => "predicted penetration",
                Why::BladeAngle(_) => "blade angle",
                Why::Casing(_) => "casing displacement",
                Why::Rows(_) => "cannot be told apart",
            };
            assert!(program.to_string().contains(word), "{plain:?} {program:?}");
            assert!((program.t_s - plain.t).abs() < 0.5 * self.h(), "{plain:?} {program:?}");
            return Err(plain);
        }
        // A perturbed motion may fail one step earlier or later.
        if self.perturbed.advance(until).is_err() {
            self.amplified = f64::INFINITY;
        } else {
            self.watch();
        }
        self.check_impulses();
        Ok(())
    }

    pub fn fire(&mut self) {
        let operation = &self.scene.operation;
        self.motion.fire();
        self.plain.fire(operation.pulse_n, operation.pulse_s);
        self.perturbed.fire(operation.pulse_n, operation.pulse_s);
    }

    pub fn set_speed(&mut self, speed: f64, ramp: f64) {
        self.motion.set_speed(speed, ramp);
        self.plain.set_speed(speed, ramp);
        self.perturbed.set_speed(speed, ramp);
    }

    pub fn adopt(&mut self, scene: &Scene) {
        assert!(Change::is_live(&self.scene, scene), "refused: {scene:?}");
        self.motion.set_parameters(&scene.checked().unwrap());
        self.plain.set_parameters(scene);
        self.perturbed.set_parameters(scene);
        self.scene = scene.clone();
    }

    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    pub(super) fn h(&self) -> f64 {
        self.scene.solver.step_s
    }

    pub(super) fn clearance(&self) -> f64 {
        self.scene.machine().clearance()
    }

    /// Position that the rounding of `n_d theta` gives a side, or the corner of
    /// two sides at a small angle; a step of the summed form sees it as a change
    /// of increment \[m\].
    pub(super) fn jitter(&self) -> f64 {
        let size = self.plain.u().iter().fold(self.clearance(), |most, x| most.max(x.abs()));
        2.3e-16 * (1.0 + self.turned) * size / self.acuteness()
    }

    /// Sine of half the angle between neighbouring sides.
    pub(super) fn acuteness(&self) -> f64 {
        self.scene.machine().polygon.delta.sin().max(1e-3)
    }

    /// Distance of casing positions that round-off explains: the jitter as a
    /// speed, over a radian of the casing's motion, and the rounding of the
    /// recurrence's coefficients, once a step; amplified as the motion does.
    pub fn round_off(&self) -> f64 {
        let omega = self.scene.machine().omega_c;
        let once = self.jitter() / (self.h() * omega).min(1.0)
            + 2.3e-16 * self.plain.steps() as f64 * self.clearance();
        ROOM * self.amplified * once
    }

    /// Whether states can still be compared.
    pub fn is_chaotic(&self) -> bool {
        self.amplified > CHAOS
    }
}

pub(super) fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
