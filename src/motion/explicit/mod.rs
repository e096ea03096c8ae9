//! The paper's time solver, Eqs. (8)-(16): explicit central differences with
//! Lagrange-multiplier contact (docs/theory.md, section 6). First order in the step
//! once contact happens.
//!
//! Each step predicts free motion, looks for penetrations and corrects them
//! with one of the two contact laws. Free steps (`flight`) and those of a held lock
//! (`held_corner`) are taken many at once, as plain stepping would take them.

mod blades;
mod corner_step;
mod correct;
mod decided;
mod excitation;
mod flight;
mod held_corner;
mod leap;
mod oscillator;
mod parameters;
mod watch;

pub use blades::{BladeModel, FullBlades, ModalBlades, RigidBlades};
pub use excitation::EngineOrderTorque;
pub use oscillator::{Coordinate, Oscillator};

use std::sync::Arc;

use super::{
    ActiveSet, Checks, ContactLog, Failure, FailureReason, GoOn, Pulse, Rotor, Solver, State,
    Verdict,
};
use crate::contact::{self, StepLaw, repeated::Repeated};
use crate::model::Machine;
use crate::scene::CheckedScene;
use crate::tolerances::{BREAK_STEPS, UPDATES_UNASKED};
use correct::ConstraintRow;
use flight::{Block, Phasor};
use held_corner::HeldCorner;
use watch::Watch;

/// The explicit solver on one size of bladed disk.
#[derive(Clone, Debug)]
pub struct Explicit<B: BladeModel> {
    scene: Arc<CheckedScene>,
    machine: Machine,
    law: &'static dyn StepLaw,
    step: f64,
    rotor: Rotor,
    pulse: Pulse,
    /// The pulse to fire next, from zero on.
    next_pulse: Pulse,
    /// A step, and the mean force in it of a pulse that another has replaced
    /// \[N\].
    left_over: (u64, f64),
    excitation: Option<EngineOrderTorque>,
    casing: Oscillator,
    /// Index of the step the coordinates belong to, `t = n h`.
    n: u64,
    u: [Coordinate; 2],
    blades: B,
    /// Free steps already decided on, not yet taken; see `flight`.
    block: Block,
    /// The corner that the open block holds, if it is one.
    held: Option<HeldCorner>,
    /// Step before which a corner is not tried to be held.
    hold_tried: u64,
    phasor: Phasor,
    /// Step of the latest contact of each side, from 1; 0 for never.
    touched: Vec<u64>,
    last_touch: u64,
    /// Side to begin the search for the deepest penetration at.
    near: u32,
    /// Multipliers of the latest step in contact, by row.
    rows: Vec<ConstraintRow>,
    /// Rows of which several belong to one side; see `solve_repeated`.
    repeated: Repeated,
    /// Whether the neighbours of a penetrating side always count; see `correct`.
    neighbours_matter: bool,
    /// Rigid gap beyond which no blade of a side can touch now \[m\].
    look: f64,
    /// Impulse on each side since `take_impulses` \[N s\].
    impulses: Vec<f64>,
    impulses_since: u64,
    log: ContactLog,
    deepest: f64,
    deepest_predicted: f64,
    watch: Watch,
    failure: Option<Failure>,
}

impl<B: BladeModel> Explicit<B> {
    /// The motion of a scene at t = 0.
    pub(super) fn new(scene: &CheckedScene) -> Self {
        let machine = scene.machine();
        let step = scene.solver.step_s;
        let rotor = Rotor::of(scene);
        let pulse = Pulse::of(scene);
        let casing = Oscillator::new(
            machine.casing_mass,
            machine.casing_damping,
            machine.casing_stiffness,
            step,
        );
        let first_force = pulse.mean(0.0, 0.5 * step);
        let initial = &scene.initial;
        let u = [
            casing.start(initial.u_c_m, initial.v_c_m_s, first_force),
            casing.start(initial.u_s_m, initial.v_s_m_s, 0.0),
        ];
        let sides = machine.polygon.sides as usize;
        let mut motion = Self {
            scene: Arc::new(scene.clone()),
            blades: B::at_rest(scene, &machine),
            phasor: Phasor::new(&rotor, machine.nodal_diameters, step),
            law: contact::law(scene.solver.contact),
            next_pulse: pulse,
            left_over: (0, 0.0),
            excitation: EngineOrderTorque::of(scene),
            touched: vec![0; sides],
            impulses: vec![0.0; sides],
            machine,
            step,
            rotor,
            pulse,
            casing,
            n: 0,
            u,
            block: Block::default(),
            held: None,
            hold_tried: 0,
            last_touch: 0,
            near: 0,
            rows: Vec::with_capacity(8),
            repeated: Repeated::default(),
            neighbours_matter: false,
            look: 0.0,
            impulses_since: 0,
            log: ContactLog::default(),
            deepest: 0.0,
            deepest_predicted: 0.0,
            watch: Watch::default(),
            failure: None,
        };
        motion.neighbours_matter = motion.neighbours_matter();
        motion
    }

    /// One step: predict, look, correct.
    fn take_step(&mut self) -> Result<(), FailureReason> {
        let n = self.n;
        let force = self.force(n);
        self.u = [self.casing.step(self.u[0], force), self.casing.step(self.u[1], 0.0)];
        let excitation = self
            .excitation
            .as_ref()
            .map(|torque| (torque, torque.phase(&self.rotor, self.time_of(n))));
        let change = self.blades.predict(excitation);
        let mut unknown = self.watch.moved(change);
        self.n = n + 1;
        let distance2 = self.u[0].x * self.u[0].x + self.u[1].x * self.u[1].x;
        let clearance = self.machine.polygon.clearance;
        if distance2 < clearance * clearance {
            self.open_gap();
        } else {
            let change = self.meet(distance2)?;
            unknown = self.watch.moved(change);
        }
        if unknown {
            self.watch.look(self.blades.look(self.watch.largest()))?;
        }
        Ok(())
    }

    /// Bookkeeping of a step without contact.
    fn open_gap(&mut self) {
        if self.log.active_set != ActiveSet::Nothing && self.n > self.last_touch + BREAK_STEPS {
            self.end_contact(self.n);
        }
    }

    /// The contact is broken at step `n`.
    fn end_contact(&mut self, n: u64) {
        self.log.touch(self.time_of(n), ActiveSet::Nothing);
        self.rows.clear();
    }

    /// Mean force of the pulse over the step centred on `n`, whole at n = 0.
    fn force(&self, n: u64) -> f64 {
        let t = self.time_of(n);
        let half = 0.5 * self.step;
        let left_over = if n == self.left_over.0 { self.left_over.1 } else { 0.0 };
        self.pulse.mean(if n == 0 { 0.0 } else { t - half }, t + half) + left_over
    }

    fn time_of(&self, n: u64) -> f64 {
        n as f64 * self.step
    }

    /// Steps taken so far.
    fn steps_taken(&self) -> u64 {
        self.n + self.block.used()
    }

    /// Time of the latest step \[s\].
    fn time(&self) -> f64 {
        self.time_of(self.steps_taken())
    }

    /// Ends what was decided on ahead.
    fn interrupt(&mut self) {
        self.close_block();
        self.hold_tried = self.n;
    }
}

impl<B: BladeModel> Solver for Explicit<B> {
    fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        // A step that ends within a millionth of itself after `until` belongs to it.
        let target = (until / self.step + 1e-6).floor().max(0.0) as u64;
        let steps_unasked = UPDATES_UNASKED / self.blades.coordinates();
        let mut unasked = 0;
        while self.steps_taken() < target {
            unasked += 1;
            if unasked > steps_unasked {
                unasked = 0;
                if !go_on() {
                    return Ok(false);
                }
            }
            let moved = if self.open_block() {
                self.use_block(target);
                Ok(())
            } else {
                self.take_step()
            };
            if let Err(reason) = moved {
                let failure = Failure { t_s: self.time_of(self.n), reason };
                self.log.touch(failure.t_s, ActiveSet::Nothing);
                self.failure = Some(failure.clone());
                return Err(failure);
            }
        }
        Ok(true)
    }

    fn state(&self) -> State {
        let (u, blades) = self.materialized();
        let n = self.steps_taken();
        let in_contact = self.log.active_set != ActiveSet::Nothing;
        let rate = |coordinate: Coordinate, force: f64| {
            if in_contact {
                coordinate.increment / self.step
            } else {
                self.casing.rate(coordinate, force)
            }
        };
        let (alpha, alpha_rate) = blades.modal();
        State {
            t_s: self.time_of(n),
            u: u.map(|coordinate| coordinate.x),
            v: [rate(u[0], self.force(n)), rate(u[1], 0.0)],
            alpha,
            alpha_rate,
        }
    }

    fn blade_angles(&self) -> Vec<f64> {
        self.materialized().1.every_angle(&self.machine)
    }

    fn multipliers(&self) -> Vec<(u32, f64)> {
        if self.log.active_set == ActiveSet::Nothing {
            return Vec::new();
        }
        let mut sums: Vec<(u32, f64)> = Vec::new();
        if let Some(held) = self.held.as_ref().filter(|_| self.block.used() > 0) {
            sums.extend(held.sides().into_iter().zip(held.multipliers(self.block.used())));
            super::contacts::in_phase_order(&self.machine.polygon, &mut sums);
            return sums;
        }
        for row in self.rows.iter().filter(|row| row.lambda != 0.0) {
            match sums.iter_mut().find(|(side, _)| *side == row.side) {
                Some((_, sum)) => *sum += row.lambda,
                None => sums.push((row.side, row.lambda)),
            }
        }
        super::contacts::in_phase_order(&self.machine.polygon, &mut sums);
        sums
    }

    fn take_mean_forces(&mut self) -> Vec<(u32, f64)> {
        let span = self.steps_taken().saturating_sub(self.impulses_since) as f64 * self.step;
        self.impulses_since = self.steps_taken();
        let mut means = Vec::new();
        for (side, impulse) in self.impulses.iter_mut().enumerate() {
            if *impulse != 0.0 && span > 0.0 {
                means.push((side as u32, *impulse / span));
                *impulse = 0.0;
            }
        }
        super::contacts::in_phase_order(&self.machine.polygon, &mut means);
        means
    }

    fn over(&self) -> bool {
        self.no_contact_to_come()
    }

    fn final_verdict(&self) -> Option<Verdict> {
        self.decided()
    }

    fn pulse(&self) -> &Pulse {
        &self.pulse
    }

    fn contacts(&self) -> &ContactLog {
        &self.log
    }

    fn machine(&self) -> &Machine {
        &self.machine
    }

    fn rotor(&self) -> &Rotor {
        &self.rotor
    }

    fn steps(&self) -> Option<u64> {
        Some(self.steps_taken())
    }

    fn failure(&self) -> Option<&Failure> {
        self.failure.as_ref()
    }

    fn checks(&self) -> Checks {
        Checks {
            max_penetration_m: self.deepest,
            max_predicted_penetration_m: Some(self.deepest_predicted),
            tensile_steps: self.log.tensile_steps,
            max_blade_angle_rad: self.largest_angle(),
            energy_residual_j: None,
        }
    }

    /// What the pulse before gave in the half step until now is kept.
    fn fire(&mut self) {
        self.interrupt();
        let (start, next) = (self.time(), self.next_pulse);
        let half = 0.5 * self.step;
        let old = self.pulse;
        self.pulse = Pulse { start, end: start + next.end, force: next.force };
        if self.n == 0 {
            // The start knew the old force.
            let change = self.pulse.mean(0.0, half) - old.mean(0.0, half);
            self.u[0].increment -= 0.5 * self.step * self.step * change / self.machine.casing_mass;
        } else {
            let until_now = Pulse { end: old.end.min(start), ..old };
            let before = if self.left_over.0 == self.n { self.left_over.1 } else { 0.0 };
            self.left_over = (self.n, before + until_now.mean(start - half, start + half));
        }
    }

    fn set_speed(&mut self, speed: f64, ramp: f64) {
        self.interrupt();
        self.rotor.change(self.time(), speed, ramp);
        self.phasor = Phasor::new(&self.rotor, self.machine.nodal_diameters, self.step);
    }

    /// In a held corner the casing follows the blades: it has no free rate.
    fn scale_rate(&mut self, factor: f64) {
        if self.held.is_some() {
            return;
        }
        self.close_block();
        for coordinate in &mut self.u {
            coordinate.increment *= factor;
        }
    }

    fn set_parameters(&mut self, scene: &CheckedScene) {
        self.take_parameters(scene);
    }

    fn fork(&self) -> Box<dyn Solver> {
        Box::new(self.clone())
    }
}
