//! The scheme of Eqs. (8)-(16) in its plainest form, as a reference for the
//! program. It shares no code with `src/motion` or `src/numeric`: it reads a
//! `Scene` and computes the rest in double-double (`dd`), so a difference from
//! the program is the round-off of the program or an error.
//!
//! ```text
//! let mut plain = plain::Plain::new(&scene);   // any model, any law; solver.kind is not looked at
//! plain.advance(1e-3)?;                        // to step floor(t/h + 1e-6), as the program does; Err(Failure)
//! plain.fire(20e3, 50e-6);                     // another pulse from now on; cuts the one under way
//! plain.set_speed(450.0, -100.0);              // speed and ramp from now on; the angle goes on
//! plain.set_parameters(&other);                // masses, dampings, stiffnesses, law, excitation; motion goes on
//! plain.time(); plain.steps();                 // n h, n
//! plain.u(); plain.increments();               // [u_c, u_s] and u[n] - u[n-1]
//! plain.rates();                               // as `Motion::state` defines them
//! plain.blade_angles(); plain.modal();         // every blade; [alpha_c, alpha_s] by projection
//! plain.multipliers();                         // (side, group sum) of the latest step that touched
//! plain.in_contact();                          // touched within the last two steps
//! plain.impacts; plain.tensile_steps;          // (t, side); steps with a tensile row
//! plain.widest; plain.deepest_predicted;       // over all steps: blade angle, -g*
//! plain.deepest;                               // what the corrections leave of it
//! plain.impulses;                              // of each side over all steps, N s
//! plain.window(0.01);                          // the last 10 ms: touched, unbroken, sides kept, pulled
//! plain.perturbation(1e-12);                          // moves u by that many metres, to see how the motion amplifies
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

pub mod checks;
pub mod compare;
pub mod contact;
pub mod dd;
pub mod disk;
pub mod history;
pub mod law;
pub mod scenes;

use rubscope_solver::scene::{ContactLaw, Scene};

use dd::{Dd, ZERO};
use disk::{Coordinate, Disk, Oscillator};
use history::{History, Window};

/// A contact lasts over this many steps without a touch.
pub const BREAK_STEPS: u64 = 2;
/// Largest allowed blade angle \[rad\].
pub const LARGEST_ANGLE: f64 = 0.1;

/// The reason why a run stopped, with its number.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Why {
    /// A predicted penetration deeper than the clearance \[m\].
    Penetration(f64),
    /// A blade angle beyond 0.1 rad.
    BladeAngle(f64),
    /// The casing farther than its own radius \[m\].
    Casing(f64),
    /// Rows that contradict each other: how many.
    Rows(usize),
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
    start: Dd,
    end: Dd,
    force: f64,
}

/// Speed and acceleration from a step on.
#[derive(Clone, Copy, Debug)]
struct Rotor {
    since: u64,
    angle: Dd,
    speed: f64,
    ramp: f64,
}

/// The stepper at some step of its motion.
#[derive(Clone, Debug)]
pub struct Plain {
    n: u64,
    h: Dd,
    law: ContactLaw,
    casing: Oscillator,
    casing_radius: f64,
    disk: Disk,
    u: [Coordinate; 2],
    rotor: Rotor,
    pulses: Vec<Pulse>,
    /// Mean force that made `x[-1]`.
    first_force: Dd,
    polygon: contact::ContactPolygon,
    /// Step of the latest touch of each side, from 1; 0 for never.
    touched: Vec<u64>,
    last: Vec<(u32, f64)>,
    last_touch: u64,
    history: History,
    failure: Option<Failure>,
    /// When a side was met, and which.
    pub impacts: Vec<(f64, u32)>,
    /// Steps with a row that pulls.
    pub tensile_steps: u64,
    /// Largest blade angle of any step and blade \[rad\].
    pub widest: f64,
    /// Deepest predicted penetration of any step \[m\].
    pub deepest_predicted: f64,
    /// Deepest penetration left after the correction of any step.
    pub deepest: f64,
    /// Sum of the multipliers of each side over all steps, times the step
    /// \[N s\]; negative is a push.
    pub impulses: Vec<f64>,
    /// The same of all rows without their signs \[N s\].
    pub impulse: f64,
}

fn casing_of(scene: &Scene, h: Dd) -> Oscillator {
    let casing = &scene.casing;
    let stiffness = Dd::from(casing.modal_stiffness_n_per_m);
    Oscillator::new(Dd::from(casing.modal_mass_kg), stiffness, casing.damping_ratio, h)
}

impl Plain {
    /// The motion of a checked scene at t = 0.
    pub fn new(scene: &Scene) -> Self {
        let h = Dd::from(scene.solver.step_s);
        let operation = &scene.operation;
        let polygon = contact::ContactPolygon::new(scene);
        let touched = vec![0; polygon.sides as usize];
        let impulses = vec![0.0; polygon.sides as usize];
        let mut plain = Self {
            n: 0,
            h,
            law: scene.solver.contact,
            casing: casing_of(scene, h),
            casing_radius: scene.casing.radius_m,
            disk: Disk::new(scene, h).starting(h),
            u: [Coordinate::default(); 2],
            rotor: Rotor {
                since: 0,
                angle: ZERO,
                speed: operation.speed_rad_s,
                ramp: operation.speed_ramp_rad_s2,
            },
            pulses: Vec::new(),
            first_force: ZERO,
            touched,
            polygon,
            last: Vec::new(),
            last_touch: 0,
            history: History::default(),
            failure: None,
            impacts: Vec::new(),
            tensile_steps: 0,
            widest: 0.0,
            deepest_predicted: 0.0,
            deepest: 0.0,
            impulse: 0.0,
            impulses,
        };
        let initial = &scene.initial;
        plain.u = [
            plain.casing.start(initial.u_c_m, initial.v_c_m_s, ZERO, h),
            plain.casing.start(initial.u_s_m, initial.v_s_m_s, ZERO, h),
        ];
        plain.fire(operation.pulse_n, operation.pulse_s);
        plain
    }

    /// Advances to the last step at or before `until`.
    pub fn advance(&mut self, until: f64) -> Result<(), Failure> {
        let target = (until / self.h.0 + 1e-6).floor().max(0.0) as u64;
        while self.n < target {
            self.step()?;
        }
        Ok(())
    }

    /// One step.
    pub fn step(&mut self) -> Result<(), Failure> {
        if let Some(failure) = self.failure {
            return Err(failure);
        }
        let (force, theta) = (self.force(), self.angle_at(self.n));
        self.u = [self.casing.step(self.u[0], force), self.casing.step(self.u[1], ZERO)];
        self.disk.predict(theta);
        self.n += 1;
        let met = self.meet();
        let widest = self.disk.angles().into_iter().fold(0.0, |most, x| f64::max(most, x.abs()));
        self.widest = self.widest.max(widest);
        // A failed step shows what failed first.
        let wide = if widest > LARGEST_ANGLE { Err(Why::BladeAngle(widest)) } else { Ok(()) };
        met.and(wide).map_err(|why| {
            let failure = Failure { t: self.time(), why };
            self.failure = Some(failure);
            failure
        })
    }

    /// Mean force over the step around `n`, between its midpoints. The half
    /// step before t = 0 carries what `x[-1]` was made with.
    fn force(&self) -> Dd {
        let (t, half) = (self.time_exact(), self.h / Dd::from(2.0));
        if self.n == 0 {
            return self.first_force / Dd::from(2.0) + self.impulse(ZERO, half) / self.h;
        }
        self.impulse(t - half, t + half) / self.h
    }

    /// Integral of the force from one instant to another.
    fn impulse(&self, from: Dd, to: Dd) -> Dd {
        let part = |pulse: &Pulse| {
            let start = if from < pulse.start { pulse.start } else { from };
            let end = if pulse.end < to { pulse.end } else { to };
            if start < end { (end - start) * Dd::from(pulse.force) } else { ZERO }
        };
        self.pulses.iter().map(part).sum()
    }

    /// Rotor angle at a step.
    pub fn angle_at(&self, n: u64) -> Dd {
        let Rotor { since, angle, speed, ramp } = self.rotor;
        let elapsed = Dd::from(n - since) * self.h;
        angle + (Dd::from(speed) + Dd::from(0.5 * ramp) * elapsed) * elapsed
    }

    /// Another pulse from now on; the one under way ends. Before the first step,
    /// `x[-1]` is made with the new one.
    pub fn fire(&mut self, force: f64, duration: f64) {
        let now = self.time_exact();
        for pulse in &mut self.pulses {
            if now < pulse.end {
                pulse.end = now;
            }
        }
        self.pulses.push(Pulse { start: now, end: now + Dd::from(duration), force });
        if self.n == 0 {
            let half = self.h / Dd::from(2.0);
            let first = self.impulse(ZERO, half) / half;
            let change = self.casing.start(0.0, 0.0, first - self.first_force, self.h);
            self.u[0].increment += change.increment;
            self.first_force = first;
        }
    }

    /// Whether the pulse under way still acts on a step to come.
    pub fn is_pulsed(&self) -> bool {
        let from = self.time_exact() - self.h / Dd::from(2.0);
        self.pulses.iter().any(|pulse| pulse.force != 0.0 && from < pulse.end)
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
    pub fn perturbation(&mut self, by: f64) {
        self.u[0].x += Dd::from(by);
    }

    fn time_exact(&self) -> Dd {
        Dd::from(self.n) * self.h
    }

    pub fn time(&self) -> f64 {
        self.time_exact().value()
    }

    pub fn steps(&self) -> u64 {
        self.n
    }

    /// `[u_c, u_s]` \[m\].
    pub fn u(&self) -> [f64; 2] {
        self.u.map(|coordinate| coordinate.x.value())
    }

    /// `u[n] - u[n-1]` \[m\].
    pub fn increments(&self) -> [f64; 2] {
        self.u.map(|coordinate| coordinate.increment.value())
    }

    /// Rates as the program reports them: of the last step while in contact,
    /// otherwise `(u[n+1] - u[n-1])/2h` of the free step to come \[m/s\].
    pub fn rates(&self) -> [f64; 2] {
        if self.in_contact() {
            return self.increments().map(|increment| increment / self.h.0);
        }
        let centred = |at: Coordinate, force: Dd| {
            let next = self.casing.step(at, force);
            ((at.increment + next.increment) / (Dd::from(2.0) * self.h)).value()
        };
        [centred(self.u[0], self.force()), centred(self.u[1], ZERO)]
    }

    /// Angle of every blade \[rad\].
    pub fn blade_angles(&self) -> Vec<f64> {
        self.disk.angles()
    }

    /// `[alpha_c, alpha_s]`: the angles projected on `(cos, sin)(n_d Phi_i)`
    /// \[rad\].
    pub fn modal(&self) -> [f64; 2] {
        self.polygon.project(&self.disk.angles())
    }

    /// Sums of the multipliers of each side in the latest step that touched,
    /// by side; negative is a push \[N\].
    pub fn multipliers(&self) -> &[(u32, f64)] {
        &self.last
    }

    /// Whether something touched within the last two steps.
    pub fn in_contact(&self) -> bool {
        self.last_touch > 0 && self.n <= self.last_touch + BREAK_STEPS
    }

    /// Every step that touched.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// The contacts of the last `seconds`.
    pub fn window(&self, seconds: f64) -> Window {
        let steps = (seconds / self.h.0).round() as u64;
        self.history.window(self.n.saturating_sub(steps).max(1), self.n)
    }

    /// Since when the same sides have been in contact without a break \[s\].
    pub fn kept_since(&self) -> Option<f64> {
        let first = self.history.kept_since(self.n)?;
        Some((Dd::from(first) * self.h).value())
    }

    pub fn failure(&self) -> Option<Failure> {
        self.failure
    }
}
