//! The scheme of Eqs. (8)-(16) in its plainest form, as a reference for the program. It shares
//! no code with `src/motion` or `src/numeric`: it reads a `Scene` and computes the rest, so a
//! difference from the program is round-off or an error.
//!
//! ```text
//! let mut plain = plain::Plain::new(&scene);   // any model, any law; solver.kind is not looked at
//! plain.advance(1e-3)?;                        // to step floor(t/h + 1e-6), as the program does; Err(Failure)
//! plain.fire(20e3, 50e-6);                     // another pulse from now on; cuts the one under way
//! plain.set_speed(450.0, -100.0);              // speed and ramp from now on; the angle goes on
//! plain.set_parameters(&other);                // masses, dampings, stiffnesses, law, excitation; motion goes on
//! ```
//!
//! Every step is computed, in the standing frame: predict, evaluate the gaps of
//! all blades from sines and cosines of `n_d (theta + Phi_i + alpha_i)`, correct
//! by one of two laws. *Bilateral* closes every `g* < 0` as an equality and no
//! other gap; *unilateral* solves the complementarity problem over all rows.
//! Rows are phase groups for rigid and modal blades, blades in the full model.
//!
//! A side is `n_d i / q` modulo `N/q` for blade `i` from 0, `q = gcd(N, n_d)`:
//! the program's numbering. A positive multiplier pulls.

pub mod compare;
mod contact;
mod disk;
mod law;
pub mod scenes;

use rubscope_solver::scene::{ContactLaw, Scene};

use contact::Sides;
use disk::{Coordinate, Disk, Oscillator};

/// A contact lasts over this many steps without a touch.
pub const BREAK_STEPS: u64 = 2;
/// Largest allowed blade angle \[rad\].
pub const LARGEST_ANGLE: f64 = 0.1;

/// The reason why a run stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Why {
    /// A predicted penetration deeper than the clearance.
    Penetration,
    /// A blade angle beyond 0.1 rad.
    BladeAngle,
    /// The casing farther than its own radius.
    Casing,
    /// Rows that contradict each other.
    Rows,
}

/// When and why a run stopped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Failure {
    pub t: f64,
    pub why: Why,
}

/// A rectangular force, cut where the next one begins.
#[derive(Clone, Copy, Debug)]
struct Pulse {
    start: f64,
    end: f64,
    force: f64,
}

/// Speed and acceleration from a step on.
#[derive(Clone, Copy, Debug)]
struct Rotor {
    since: u64,
    angle: f64,
    speed: f64,
    ramp: f64,
}

/// The stepper at some step of its motion.
#[derive(Clone, Debug)]
pub struct Plain {
    n: u64,
    h: f64,
    law: ContactLaw,
    casing: Oscillator,
    casing_radius: f64,
    disk: Disk,
    u: [Coordinate; 2],
    rotor: Rotor,
    pulses: Vec<Pulse>,
    /// Mean force that made `x[-1]`.
    first_force: f64,
    sides: Sides,
    /// Step of the latest touch of each side, from 1; 0 for never.
    touched: Vec<u64>,
    last: Vec<(u32, f64)>,
    failure: Option<Failure>,
    /// The step at which a side was met, and which.
    pub impacts: Vec<(u64, u32)>,
    /// Steps with a row that pulls.
    pub tensile_steps: u64,
    /// Largest blade angle of any step and blade \[rad\].
    pub widest: f64,
    /// Sum of the multipliers of each side over all steps, times the step
    /// \[N s\]; negative is a push.
    pub impulses: Vec<f64>,
}

fn casing_of(scene: &Scene, h: f64) -> Oscillator {
    let casing = &scene.casing;
    let (mass, stiffness) = (casing.modal_mass_kg, casing.modal_stiffness_n_per_m);
    Oscillator::new(mass, stiffness, casing.damping_ratio, h)
}

impl Plain {
    /// The motion of a checked scene at t = 0.
    pub fn new(scene: &Scene) -> Self {
        let (h, operation, initial) = (scene.solver.step_s, &scene.operation, &scene.initial);
        let (sides, casing) = (Sides::new(scene), casing_of(scene, h));
        let (speed, ramp) = (operation.speed_rad_s, operation.speed_ramp_rad_s2);
        let mut plain = Self {
            n: 0,
            h,
            law: scene.solver.contact,
            casing_radius: scene.casing.radius_m,
            disk: Disk::new(scene, h),
            u: [
                casing.start(initial.u_c_m, initial.v_c_m_s, 0.0, h),
                casing.start(initial.u_s_m, initial.v_s_m_s, 0.0, h),
            ],
            casing,
            rotor: Rotor { since: 0, angle: 0.0, speed, ramp },
            pulses: Vec::new(),
            first_force: 0.0,
            touched: vec![0; sides.count as usize],
            impulses: vec![0.0; sides.count as usize],
            sides,
            last: Vec::new(),
            failure: None,
            impacts: Vec::new(),
            tensile_steps: 0,
            widest: 0.0,
        };
        plain.fire(operation.pulse_n, operation.pulse_s);
        plain
    }

    /// Advances to the last step at or before `until`.
    pub fn advance(&mut self, until: f64) -> Result<(), Failure> {
        let target = (until / self.h + 1e-6).floor().max(0.0) as u64;
        while self.n < target {
            self.step()?;
        }
        Ok(())
    }

    fn step(&mut self) -> Result<(), Failure> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        let (force, theta) = (self.force(), self.angle_at(self.n));
        self.u = [self.casing.step(self.u[0], force), self.casing.step(self.u[1], 0.0)];
        self.disk.predict(theta);
        self.n += 1;
        let met = self.meet(&self.disk.angles());
        let widest = self.disk.angles().into_iter().fold(0.0, |most, x| f64::max(most, x.abs()));
        self.widest = self.widest.max(widest);
        // A failed step shows what failed first.
        let wide = if widest > LARGEST_ANGLE { Err(Why::BladeAngle) } else { Ok(()) };
        met.and(wide).map_err(|why| {
            let failure = Failure { t: self.time(), why };
            self.failure = Some(failure);
            failure
        })
    }

    /// Mean force over the step around `n`, between its midpoints. The half
    /// step before t = 0 carries what `x[-1]` was made with.
    fn force(&self) -> f64 {
        let (t, half) = (self.time(), 0.5 * self.h);
        if self.n == 0 {
            return 0.5 * self.first_force + self.impulse(0.0, half) / self.h;
        }
        self.impulse(t - half, t + half) / self.h
    }

    /// Integral of the force from one instant to another.
    fn impulse(&self, from: f64, to: f64) -> f64 {
        let part =
            |pulse: &Pulse| (to.min(pulse.end) - from.max(pulse.start)).max(0.0) * pulse.force;
        self.pulses.iter().map(part).sum()
    }

    /// Rotor angle at a step.
    fn angle_at(&self, n: u64) -> f64 {
        let Rotor { since, angle, speed, ramp } = self.rotor;
        let elapsed = (n - since) as f64 * self.h;
        angle + (speed + 0.5 * ramp * elapsed) * elapsed
    }

    /// Another pulse from now on; the one under way ends. Before the first step,
    /// `x[-1]` is made with the new one.
    pub fn fire(&mut self, force: f64, duration: f64) {
        let now = self.time();
        for pulse in &mut self.pulses {
            pulse.end = pulse.end.min(now);
        }
        self.pulses.push(Pulse { start: now, end: now + duration, force });
        if self.n == 0 {
            let first = self.impulse(0.0, 0.5 * self.h) / (0.5 * self.h);
            let change = self.casing.start(0.0, 0.0, first - self.first_force, self.h);
            self.u[0].increment += change.increment;
            self.first_force = first;
        }
    }

    /// Turns with this speed and acceleration from now on.
    pub fn set_speed(&mut self, speed: f64, ramp: f64) {
        let angle = self.angle_at(self.n);
        self.rotor = Rotor { since: self.n, angle, speed, ramp };
    }

    /// Moves with the masses, dampings, stiffnesses, law and excitation of
    /// another scene; displacements, increments, rotor and pulse go on.
    pub fn set_parameters(&mut self, scene: &Scene) {
        self.casing = casing_of(scene, self.h);
        self.casing_radius = scene.casing.radius_m;
        self.law = scene.solver.contact;
        self.disk = Disk::new(scene, self.h).moving_as(&self.disk);
    }

    /// Moves the casing by so much, along `u_c` \[m\].
    fn perturb(&mut self, by: f64) {
        self.u[0].x += by;
    }

    pub fn time(&self) -> f64 {
        self.n as f64 * self.h
    }

    pub fn steps(&self) -> u64 {
        self.n
    }

    /// `[u_c, u_s]` \[m\].
    pub fn u(&self) -> [f64; 2] {
        self.u.map(|coordinate| coordinate.x)
    }

    /// `u[n] - u[n-1]` \[m\].
    fn increments(&self) -> [f64; 2] {
        self.u.map(|coordinate| coordinate.increment)
    }

    /// Rates as the program reports them: of the last step while in contact,
    /// otherwise `(u[n+1] - u[n-1])/2h` of the free step to come \[m/s\].
    fn rates(&self) -> [f64; 2] {
        if self.in_contact() {
            return self.increments().map(|increment| increment / self.h);
        }
        let centred = |at: Coordinate, force: f64| {
            (at.increment + self.casing.step(at, force).increment) / (2.0 * self.h)
        };
        [centred(self.u[0], self.force()), centred(self.u[1], 0.0)]
    }

    /// Angle of every blade \[rad\].
    fn blade_angles(&self) -> Vec<f64> {
        self.disk.angles()
    }

    /// `[alpha_c, alpha_s]`: the angles projected on `(cos, sin)(n_d Phi_i)`
    /// \[rad\].
    pub fn modal(&self) -> [f64; 2] {
        self.sides.project(&self.disk.angles())
    }

    /// Sums of the multipliers of each side in the latest step that touched,
    /// by side; negative is a push \[N\].
    pub fn multipliers(&self) -> &[(u32, f64)] {
        &self.last
    }

    /// The step of the latest touch; 0 for never.
    fn last_touch(&self) -> u64 {
        self.touched.iter().copied().max().unwrap_or(0)
    }

    /// Whether something touched within the last two steps.
    pub fn in_contact(&self) -> bool {
        self.last_touch() > 0 && self.n <= self.last_touch() + BREAK_STEPS
    }

    pub fn failure(&self) -> Option<Failure> {
        self.failure
    }
}
