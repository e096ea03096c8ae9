//! Compares the explicit motion of the program with the plain stepper, and
//! bounds the difference by round-off.

use rubscope_solver::motion::{ActiveSet, Change, FailureReason, Motion};
use rubscope_solver::scene::{ModelSize, Scene};

use super::{BREAK_STEPS, Failure, Plain, Why};

/// Displacement of the second stepper that shows how the motion amplifies, as a
/// part of the clearance: far above round-off, far below what changes contacts.
const PERTURBATION: f64 = 1e-9;
/// Times the estimated round-off that is still taken as round-off.
const ROOM: f64 = 100.0;
/// Amplification above which states are not compared.
const CHAOS: f64 = 1e5;

/// The program, the plain stepper, and a slightly displaced plain stepper.
#[derive(Clone)]
pub struct Pair {
    pub motion: Motion,
    pub plain: Plain,
    perturbed: Plain,
    /// Amplification when it was perturbed.
    amplified_before: f64,
    scene: Scene,
    /// Sum of `n_d |speed| h` over all steps, a bound on `n_d theta`.
    turned: f64,
    /// Impulses of the sides at the latest look, and its time.
    impulses: Vec<f64>,
    looked: f64,
    /// How much longer an early difference is by now, at least 1.
    pub amplified: f64,
}

impl Pair {
    pub fn new(scene: &Scene) -> Self {
        let plain = Plain::new(scene);
        let mut pair = Self {
            motion: Motion::new(&scene.checked().unwrap()),
            perturbed: plain.clone(),
            amplified_before: 1.0,
            scene: scene.clone(),
            turned: 0.0,
            impulses: vec![0.0; plain.impulses.len()],
            looked: 0.0,
            amplified: 1.0,
            plain,
        };
        pair.perturb();
        pair
    }

    /// Displaces the second stepper slightly from the first.
    fn perturb(&mut self) {
        self.perturbed = self.plain.clone();
        self.perturbed.perturb(PERTURBATION * self.clearance());
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
            self.perturb();
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
            let alike = matches!(
                (plain.why, &program.reason),
                (Why::Penetration, FailureReason::Penetration { .. })
                    | (Why::BladeAngle, FailureReason::BladeAngle { .. })
                    | (Why::Casing, FailureReason::Displacement { .. })
                    | (Why::Rows, FailureReason::Singular { .. })
            );
            assert!(alike, "{plain:?} {program:?}");
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

    /// Whether states can still be compared.
    pub fn is_chaotic(&self) -> bool {
        self.amplified > CHAOS
    }

    fn h(&self) -> f64 {
        self.scene.solver.step_s
    }

    fn clearance(&self) -> f64 {
        self.scene.machine().clearance()
    }

    /// Sine of half the angle between neighbouring sides.
    fn acuteness(&self) -> f64 {
        self.scene.machine().polygon.delta.sin().max(1e-3)
    }

    /// Position that the rounding of `n_d theta` gives a side, or the corner of
    /// two sides at a small angle; a step of the summed form sees it as a change
    /// of increment \[m\].
    fn jitter(&self) -> f64 {
        let size = self.plain.u().iter().fold(self.clearance(), |most, x| most.max(x.abs()));
        2.3e-16 * (1.0 + self.turned) * size / self.acuteness()
    }

    /// Distance of casing positions that round-off explains: the jitter as a
    /// speed, over a radian of the casing's motion, and the rounding of the
    /// recurrence's coefficients, once a step; amplified as the motion does.
    fn round_off(&self) -> f64 {
        let omega = self.scene.machine().omega_c;
        let once = self.jitter() / (self.h() * omega).min(1.0)
            + 2.3e-16 * self.plain.steps() as f64 * self.clearance();
        ROOM * self.amplified * once
    }

    /// Whether an impact is under way or just over: it takes two steps, and the
    /// position it begins at says how it is shared between them.
    fn is_meeting(&self) -> bool {
        let latest = self.plain.impacts.last().map_or(0, |impact| impact.0);
        latest > 0 && self.plain.steps() < latest + 5
    }

    /// Error of a rate that round-off explains \[m/s\].
    fn rate_off(&self) -> f64 {
        let machine = self.scene.machine();
        let nu = machine.nu(self.motion.rotor().speed(self.plain.time())).abs();
        let meeting = if self.is_meeting() { self.round_off() / self.h() } else { 0.0 };
        self.round_off() * (machine.omega_c + nu) + ROOM * self.jitter() / self.h() + meeting
    }

    /// Whether rows of single blades share a side. Such rows are equal to 8 to 20 digits: which
    /// blade takes how much of a push is round-off, but not what all take together.
    fn shares(&self) -> bool {
        let polygon = &self.scene.machine().polygon;
        self.scene.solver.model == ModelSize::Full && polygon.sides < polygon.blades
    }

    /// Casing, blades, multipliers and records agree, each to its own round-off.
    pub fn check(&self, what: &str) {
        let (motion, plain) = (&self.motion, &self.plain);
        assert_eq!(motion.steps(), Some(plain.steps()), "{what}: steps");
        if self.is_chaotic() {
            return;
        }
        let state = motion.state();
        let (moved, rates) = (distance(state.u, plain.u()), distance(state.v, plain.rates()));
        assert!(
            moved <= self.round_off() && rates <= self.rate_off(),
            "{what}: {state:?} plain {:?} {:?}, {moved:e} of {:e} and {rates:e} of {:e} apart",
            plain.u(),
            plain.rates(),
            self.round_off(),
            self.rate_off()
        );
        self.check_blades(what);
        self.check_multipliers(what);
        self.check_records(what);
    }

    /// Blades answer impulses: the same relative error, on their own scale. The
    /// moment arm of an impulse adds the error of a position, and so does the
    /// excess push of the latest few steps, which the next ones correct.
    fn check_blades(&self, what: &str) {
        let machine = self.scene.machine();
        let inertia = match self.scene.solver.model {
            ModelSize::Full => machine.blade_inertia,
            ModelSize::Rigid | ModelSize::Modal => machine.blade_modal_mass,
        };
        let moment_arm = ROOM * self.amplified * machine.nodal_diameters * self.jitter();
        let impulse: f64 = self.plain.impulses.iter().map(|impulse| impulse.abs()).sum();
        let levers = moment_arm * impulse / (inertia * machine.omega_bd);
        let push = 4.0 * moment_arm * self.clearance() * machine.casing_mass
            / (inertia * self.acuteness());
        let relative = self.round_off() / self.clearance();
        let mut allowed = (relative + 1e-13) * self.plain.widest + levers + push + 1e-30;
        if self.shares() {
            allowed += 1e-5 * self.plain.widest + 1e-15;
        } else {
            let (found, expected) = (self.motion.blade_angles(), self.plain.blade_angles());
            assert_eq!(found.len(), expected.len(), "{what}: blades");
            for (blade, (a, b)) in found.iter().zip(&expected).enumerate() {
                let apart = (a - b).abs();
                assert!(
                    apart <= allowed,
                    "{what}: blade {blade} at {a:e}, plain {b:e}, {apart:e} of {allowed:e}"
                );
            }
        }
        for (a, b) in self.motion.state().alpha.iter().zip(self.plain.modal()) {
            let apart = (a - b).abs();
            assert!(apart <= 2.0 * allowed, "{what}: modes {a:e} {b:e}, {apart:e} of {allowed:e}");
        }
    }

    /// A multiplier is a second difference of positions; those of a corner push
    /// against each other, which costs the sine of its angle once more.
    fn check_multipliers(&self, what: &str) {
        let expected = if self.plain.in_contact() { self.plain.multipliers() } else { &[] };
        let m = self.scene.machine();
        let (h, off) = (self.h(), self.round_off());
        let largest = expected.iter().fold(0.0_f64, |most, x| most.max(x.1.abs()));
        let mass = m.casing_mass + 0.5 * h * m.casing_damping;
        let mut tolerance = ROOM * self.jitter() * mass / (h * h) / self.acuteness()
            + off * m.casing_mass * m.omega_c * (m.omega_c + 1.0 / h)
            + if expected.len() > 2 { 1e-8 } else { 1e-12 } * largest;
        if self.is_meeting() {
            tolerance += off * mass / (h * h);
        }
        let mut found = self.motion.multipliers();
        // Rows that end with no push are no contact, and one that was left may be none at once.
        found.retain(|(_, value)| *value != 0.0);
        found.sort_by_key(|&(side, _)| side);
        let alike =
            |(a, b): (&(u32, f64), &(u32, f64))| a.0 == b.0 && (a.1 - b.1).abs() <= tolerance;
        assert!(
            found.is_empty()
                || found.len() == expected.len() && found.iter().zip(expected).all(alike),
            "{what}: multipliers {found:?} plain {expected:?}, allowed {tolerance:e}"
        );
    }

    /// Mean forces since the latest look: a change of momentum, so their error
    /// is that of a rate.
    fn check_impulses(&mut self) {
        let (now, before) = (self.plain.time(), self.looked);
        let mut found = vec![0.0; self.plain.impulses.len()];
        for (side, force) in self.motion.take_mean_forces() {
            found[side as usize] = force * (now - before);
        }
        let allowed =
            2.0 * self.scene.machine().casing_mass * self.rate_off() / self.acuteness() + 1e-30;
        for (side, a) in found.iter().enumerate().filter(|_| !self.is_chaotic()) {
            let b = self.plain.impulses[side] - self.impulses[side];
            let total = 1e-12 * self.plain.impulses[side].abs();
            let apart = (a - b).abs();
            assert!(
                apart <= allowed + total,
                "impulse on side {side} {a} plain {b}, {apart:e} of {allowed:e}, until {now}"
            );
        }
        self.impulses.clone_from(&self.plain.impulses);
        self.looked = now;
    }

    fn check_records(&self, what: &str) {
        let (log, plain) = (self.motion.contacts(), &self.plain);
        assert_eq!(log.impact_count, plain.impacts.len() as u64, "{what}: impacts");
        // Sides met in the same step have no order.
        let steps = log.impacts.iter().map(|hit| ((hit.t_s / self.h()).round() as u64, hit.side));
        let mut found: Vec<(u64, u32)> = steps.collect();
        let mut expected = plain.impacts.clone();
        found.sort_unstable();
        expected.sort_unstable();
        assert!(found == expected[..found.len()], "{what}: impacts {found:?} plain {expected:?}");
        assert_eq!(log.tensile_steps, plain.tensile_steps, "{what}: tensile steps");
        let now = plain.steps();
        let sides: Vec<u32> = plain.multipliers().iter().map(|&(side, _)| side).collect();
        let in_contact = plain.in_contact() && now <= plain.last_touch() + BREAK_STEPS;
        let active = if in_contact { ActiveSet::of(&sides) } else { ActiveSet::Nothing };
        assert_eq!(log.active_set, active, "{what}: sides in contact");
        // Sampled every step, or at the peak of a closed form.
        let widest = self.motion.checks().max_blade_angle_rad;
        let reached = widest >= plain.widest * (1.0 - 1e-4) - 1e-12 || self.shares();
        assert!(reached, "{what}: {widest} {}", plain.widest);
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
