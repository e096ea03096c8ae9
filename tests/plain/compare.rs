//! The program's explicit motion beside the plain stepper, and how far apart
//! round-off alone may put them.

use rubscope::motion::{Motion, Touching};
use rubscope::scene::{ModelSize, Scene};

use super::history::Span;
use super::{Failure, Plain, Why};

/// Displacement of the second stepper that shows how the motion amplifies, as a
/// part of the clearance: far above round-off, far below what changes contacts.
const NUDGE: f64 = 1e-9;
/// Times the estimated round-off that is still taken as round-off.
const ROOM: f64 = 20.0;
/// Relative error of modal blade angles once the program has held a corner in
/// closed form. A known fault: zero once it is mended (`blades_of_a_held_lock`).
const HELD: f64 = 1e-7;
/// Steps in a corner after which the program holds it.
const HELD_AFTER: u64 = 64;
/// Amplification beyond which states say nothing any more.
pub const CHAOS: f64 = 1e5;

/// The program, the plain stepper, and the plain stepper a little beside.
#[derive(Clone)]
pub struct Pair {
    pub motion: Motion,
    pub plain: Plain,
    nudged: Plain,
    scene: Scene,
    /// Sum of `n_d |speed| h` over all steps, a bound on `n_d theta`.
    turned: f64,
    /// Largest amplification seen so far.
    pub amplified: f64,
}

impl Pair {
    pub fn new(scene: &Scene) -> Self {
        let plain = Plain::new(scene);
        let mut nudged = plain.clone();
        nudged.nudge(NUDGE * scene.machine().clearance());
        let scene = scene.clone();
        Self { motion: Motion::new(&scene), plain, nudged, scene, turned: 0.0, amplified: 1.0 }
    }

    /// Advances all; what fails must fail at the same step for the same reason.
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
            assert!(program.reason.contains(word), "{plain:?} {program:?}");
            assert!((program.t_s - plain.t).abs() < 0.5 * self.h(), "{plain:?} {program:?}");
            return Err(plain);
        }
        // A nudged motion may wreck itself a step earlier or later.
        if self.nudged.advance(until).is_ok() {
            let apart = distance(self.nudged.u(), self.plain.u());
            self.amplified = self.amplified.max(apart / (NUDGE * self.clearance()));
        } else {
            self.amplified = f64::INFINITY;
        }
        Ok(())
    }

    pub fn fire(&mut self) {
        let operation = &self.scene.operation;
        self.motion.fire();
        self.plain.fire(operation.pulse_n, operation.pulse_s);
        self.nudged.fire(operation.pulse_n, operation.pulse_s);
    }

    pub fn set_speed(&mut self, speed: f64, ramp: f64) {
        self.motion.set_speed(speed, ramp);
        self.plain.set_speed(speed, ramp);
        self.nudged.set_speed(speed, ramp);
    }

    pub fn adopt(&mut self, scene: &Scene) {
        assert!(self.motion.adopt(scene), "refused: {scene:?}");
        self.plain.set_parameters(scene);
        self.nudged.set_parameters(scene);
        self.scene = scene.clone();
    }

    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    fn h(&self) -> f64 {
        self.scene.solver.step_s
    }

    fn clearance(&self) -> f64 {
        self.scene.machine().clearance()
    }

    /// Position that the rounding of `n_d theta` gives a side, and that a step
    /// of the summed form sees as a change of increment \[m\].
    fn jitter(&self) -> f64 {
        let size = self.plain.u().iter().fold(self.clearance(), |most, x| most.max(x.abs()));
        2.3e-16 * (1.0 + self.turned) * size
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

    /// Casing, blades, multipliers and records agree, each to its own round-off.
    pub fn check(&self, what: &str) {
        self.check_casing(what);
        let long = |span: &Span| span.sides.len() == 2 && span.last >= span.first + HELD_AFTER;
        let held = self.scene.solver.model == ModelSize::Modal
            && self.plain.history().spans.iter().any(long);
        self.check_blades(what, if held { HELD } else { 0.0 });
    }

    /// The same, without allowance for known faults.
    pub fn check_strictly(&self, what: &str) {
        self.check_casing(what);
        self.check_blades(what, 0.0);
    }

    /// The same but for blade angles.
    fn check_casing(&self, what: &str) {
        let (motion, plain) = (&self.motion, &self.plain);
        assert_eq!(motion.steps(), Some(plain.steps()), "{what}: steps");
        let state = motion.state();
        assert!((state.t_s - plain.time()).abs() <= 4.0 * f64::EPSILON * state.t_s, "{what}: time");
        if self.is_chaotic() {
            return;
        }
        let allowed = self.round_off();
        let apart = distance(state.u, plain.u());
        assert!(
            apart <= allowed,
            "{what}: u {:?} plain {:?}, {apart:e} apart, allowed {allowed:e} (amplified {:e}) at {}",
            state.u,
            plain.u(),
            self.amplified,
            state.t_s
        );
        self.check_rates(what, allowed);
        self.check_multipliers(what, allowed);
        self.check_records(what, allowed);
    }

    fn check_rates(&self, what: &str, allowed: f64) {
        let (found, expected) = (self.motion.state().v, self.plain.rates());
        let apart = distance(found, expected);
        let omega = self.scene.machine().omega_c;
        let nu = self.scene.machine().nu(self.motion.rotor().speed(self.plain.time())).abs();
        let allowed = allowed * (omega + nu) + ROOM * self.jitter() / self.h();
        assert!(
            apart <= allowed,
            "{what}: v {found:?} plain {expected:?}, {apart:e} of {allowed:e}"
        );
    }

    /// Blades answer impulses: the same relative error, on their own scale.
    fn check_blades(&self, what: &str, known: f64) {
        if self.is_chaotic() {
            return;
        }
        let relative = self.round_off() / self.clearance() + known;
        let (found, expected) = (self.motion.blade_angles(), self.plain.blade_angles());
        assert_eq!(found.len(), expected.len(), "{what}: blades");
        let size = self.plain.widest + 1e-14;
        for (blade, (a, b)) in found.iter().zip(&expected).enumerate() {
            assert!(
                (a - b).abs() <= (relative + 1e-13) * size,
                "{what}: blade {} at {a:e}, plain {b:e}, {:e} of {:e} apart",
                blade + 1,
                (a - b).abs(),
                (relative + 1e-13) * size
            );
        }
        for (a, b) in self.motion.state().alpha.iter().zip(self.plain.modal()) {
            assert!((a - b).abs() <= 2.0 * (relative + 1e-13) * size, "{what}: modes {a:e} {b:e}");
        }
    }

    /// A multiplier is a second difference of positions.
    fn check_multipliers(&self, what: &str, allowed: f64) {
        let found = self.motion.multipliers();
        let mut expected = if self.plain.in_contact() { self.plain.multipliers() } else { &[] };
        let m = self.scene.machine();
        let (h, largest) = (self.h(), expected.iter().fold(0.0_f64, |s, x| s.max(x.1.abs())));
        let mass = m.casing_mass + 0.5 * h * m.casing_damping;
        let tolerance = ROOM * self.jitter() * mass / (h * h)
            + allowed * m.casing_mass * m.omega_c * (m.omega_c + 1.0 / h)
            + 1e-12 * largest;
        let mut sorted: Vec<(u32, f64)> = found.clone();
        // Rows that ended with nothing to push are no contact.
        sorted.retain(|(_, value)| *value != 0.0);
        sorted.sort_by_key(|&(side, _)| side);
        if expected.len() != sorted.len() {
            expected = &[];
        }
        assert_eq!(
            sorted.len(),
            expected.len(),
            "{what}: {found:?} {:?}",
            self.plain.multipliers()
        );
        for (a, b) in sorted.iter().zip(expected) {
            assert!(
                a.0 == b.0 && (a.1 - b.1).abs() <= tolerance,
                "{what}: multipliers {found:?} plain {:?}, allowed {tolerance:e}",
                self.plain.multipliers()
            );
        }
    }

    fn check_records(&self, what: &str, allowed: f64) {
        let (log, plain) = (self.motion.contacts(), &self.plain);
        let half = 0.5 * self.h();
        assert_eq!(log.impact_count, plain.impacts.len() as u64, "{what}: impacts");
        // Sides met in the same step have no order.
        let ordered = |impacts: Vec<(f64, u32)>| {
            let mut steps: Vec<(u64, u32)> =
                impacts.iter().map(|(t, side)| ((t / self.h()).round() as u64, *side)).collect();
            steps.sort_unstable();
            steps
        };
        let found = ordered(log.impacts.iter().map(|impact| (impact.t_s, impact.side)).collect());
        let expected = ordered(plain.impacts.clone());
        assert!(
            found == expected[..found.len()],
            "{what}: impacts {found:?} plain {expected:?} (in steps)"
        );
        assert_eq!(log.tensile_steps, plain.tensile_steps, "{what}: tensile steps");
        let sides: Vec<u32> = plain.history().spans.last().map_or(Vec::new(), |s| s.sides.clone());
        let expected = if plain.in_contact() { Touching::of(&sides) } else { Touching::Nothing };
        assert_eq!(log.touching, expected, "{what}: sides in contact");
        let kept = plain.kept_since();
        if let Some(since) = kept {
            assert!((log.since - since).abs() < half, "{what}: since {} {since}", log.since);
        }
        let unbroken = plain.history().unbroken_since(plain.steps()).map(|n| n as f64 * self.h());
        assert_eq!(log.unbroken_since.is_some(), unbroken.is_some(), "{what}: unbroken");
        for (a, b) in log.unbroken_since.iter().zip(unbroken) {
            assert!((a - b).abs() < half, "{what}: unbroken since {a} {b}");
        }
        let deepest = self.motion.checks().max_predicted_penetration_m.unwrap_or(f64::NAN);
        assert!(
            (deepest - plain.deepest_predicted).abs() <= allowed + 1e-12 * deepest,
            "{what}: deepest {deepest:e} {:e}",
            plain.deepest_predicted
        );
    }
}

fn distance(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}
