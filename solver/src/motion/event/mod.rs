//! Event-driven solver: the true motion, from one change of contact to the next (docs/theory.md,
//! sections 7, 10 and 11).
//!
//! While the same rows are in contact, casing and blades obey equations with constant coefficients in
//! the blade frame (polynomials of time during a ramp of the rotor speed). The motion is a power
//! series, summed to round-off over one stretch after the other, or free flight in closed form; a
//! stretch ends at the first gap that closes or contact force that vanishes. Complementarity problems
//! determine what follows.
//!
//! A stretch is always evaluated from its start, never from an output time, so that output does not
//! change the motion, not even by one bit.
//!
//! Order in which to read: `flow` (the equations), `flight`, `series`, `stretch`, `seek`, `impact`,
//! `rocking`, `transitions`, then `energy`, `lasting` (proofs) and `run`.

mod energy;
mod flight;
mod flow;
mod impact;
mod lasting;
mod rocking;
mod run;
mod seek;
mod series;
mod stretch;
mod transitions;

use std::sync::OnceLock;

use crate::model::Machine;
use crate::motion::lasting::Lasting;
use crate::motion::point::Point;
use crate::motion::{
    Checks, ContactLog, EnergyAccount, Failure, FailureReason, GoOn, Ledger, Plane, Pulse, Rotor,
    Solver, State, Verdict, dot, in_phase_order,
};
use crate::numeric::lcp::Lcp;
use crate::scene::{CheckedScene, SceneError};
use flow::Flow;
use impact::Touch;
use lasting::Rest;
use run::Run;
use seek::{Ending, OpenedGap};
use stretch::{Held, Stretch};

pub(crate) use flow::EVENT;
pub use run::{MOST_EVENTS, MOST_EVENTS_AT_ONCE, MOST_LOOKS};

/// A start this close to a side, in parts of the clearance, is on it. A scene may have computed
/// coordinates; see its check.
pub(crate) const ON_A_SIDE: f64 = 1e-12;

/// Tolerances that may be chosen. Finer than round-off has no meaning; coarser moves impacts by more
/// than the clearance resolves.
const EVENT_RANGE: std::ops::RangeInclusive<f64> = 1e-16..=1e-3;

/// Event-driven solver of a scene, at some instant of its motion.
///
/// ```
/// use rubscope_solver::{motion::{Events, Solver, Verdict}, scene::Scene};
/// let scene = Scene::base().with(&[
///     ("solver.kind", "event"),
///     ("bladed_disk.radial_coupling", "0.3"),
///     ("operation.speed_rad_s", "450"),
///     ("operation.pulse_n", "1e5"),
/// ])?;
/// let mut motion = Events::new(&scene)?;
/// motion.advance(3e-3)?;
/// assert_eq!(motion.contacts().impact_count, 13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Events {
    flow: Flow,
    run: Run,
    /// The account; the largest angle and the deepest penetration are recorded with it.
    ledger: Ledger,
    /// Whether the scene goes beyond the paper's model.
    beyond: bool,
    /// Phase `n_d theta` at the start of the stretch, modulo a full turn \[rad\].
    phase: f64,
    /// Rows in contact.
    held: Held,
    /// Gaps that have just opened.
    opened: Vec<OpenedGap>,
    /// Present stretch of the motion.
    stretch: Stretch,
    /// Event that ends the stretch, and its time after the start of the stretch \[s\].
    next: (f64, Ending),
    /// Bounds that can prove the present contact permanent, computed on demand; `None` if it has no
    /// stable equilibrium, or would not last there.
    rest: OnceLock<Option<Rest>>,
    lasting: Lasting,
    /// Memory for the complementarity problems.
    problem: Lcp,
}

impl Events {
    /// Starts the motion of a scene at t = 0, whichever solver the scene names.
    ///
    /// # Errors
    /// The event solver does not support the contact law, the model size or the excitation.
    pub fn new(scene: &CheckedScene) -> Result<Self, SceneError> {
        scene.suits_events()?;
        Ok(Self::of(scene))
    }

    /// As `new`, for a scene that names this solver or suits it.
    pub(in crate::motion) fn of(scene: &CheckedScene) -> Self {
        let flow = Flow::new(scene);
        let (initial, start) = (&scene.initial, scene.start());
        let z = Plane::new(start.0, start.1);
        let carried = Plane::i() * z * flow.nu;
        let dz = Plane::new(initial.v_c_m_s, initial.v_s_m_s) - carried;
        Self::from_point(scene, flow, Point { z, dz, ..Point::default() })
    }

    fn from_point(scene: &CheckedScene, flow: Flow, point: Point) -> Self {
        let mut motion = Self {
            ledger: Ledger { start: flow.energy(&point, 0.0), counts: true, ..Ledger::default() },
            run: Run::of(scene),
            beyond: scene.goes_beyond(),
            phase: 0.0,
            held: Held::default(),
            opened: Vec::new(),
            stretch: Stretch::default(),
            next: (f64::INFINITY, Ending::StretchEnd),
            rest: OnceLock::new(),
            lasting: Lasting::new(scene.solver.end_s),
            problem: Lcp::default(),
            flow,
        };
        motion.stretch.fly(point, f64::INFINITY);
        motion.begin(point);
        motion
    }

    /// Takes gaps below `tolerance` times the size of the motion as closed; 1e-15 otherwise.
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.flow.tolerance = tolerance.clamp(*EVENT_RANGE.start(), *EVENT_RANGE.end());
        self
    }

    /// Advances to the next change of contact, or to `limit` if none comes before \[s\]; returns the
    /// instant reached.
    ///
    /// # Errors
    /// As `advance`.
    pub fn next_event(&mut self, limit: f64) -> Result<f64, Failure> {
        let events = self.run.events;
        while self.run.failure.is_none()
            && events == self.run.events
            && self.next.0 <= self.elapsed(limit)
        {
            self.pass();
        }
        let reached = if events == self.run.events { limit } else { self.run.clock.start() };
        self.advance(reached.max(self.run.clock.now))?;
        Ok(self.run.clock.now)
    }

    /// Starts the first stretch.
    fn begin(&mut self, mut point: Point) {
        let flow = &self.flow;
        if flow.clearance() <= 0.0 {
            let speed_rad_s = flow.speed;
            self.fail_at(&point, FailureReason::Closed { speed_rad_s });
            return;
        }
        let limit = ON_A_SIDE * flow.clearance();
        // A closing rate within the round-off of its two contributions counts as zero.
        let noise = ON_A_SIDE * (flow.carried(&point, 0.0).norm() + flow.nu.abs() * point.z.norm());
        let met: Vec<Touch> = (0..flow.rows.len())
            .filter(|&row| flow.gap(row, &point) <= limit)
            .map(|row| {
                let rate = flow.gap_rate(row, &point);
                self.touch(&point, row, if rate.abs() <= noise { 0.0 } else { rate })
            })
            .collect();
        if met.is_empty() {
            self.enter(point);
        } else {
            self.meet(&mut point, met);
        }
    }

    /// Returns the energy account up to the present instant.
    fn account_now(&self) -> EnergyAccount {
        let (s, mut account) = (self.elapsed(self.run.clock.now), self.ledger.sums);
        account.book(&self.flow, &self.held, &self.stretch, s);
        let stored_j = self.flow.energy(&self.point_now(), s) - self.ledger.start;
        EnergyAccount { stored_j, ..account }
    }

    /// Returns the displacements and rates at the present instant.
    fn point_now(&self) -> Point {
        self.stretch.point(&self.flow, self.elapsed(self.run.clock.now))
    }
}

impl Solver for Events {
    fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        loop {
            if let Some(failure) = &self.run.failure {
                return Err(failure.clone());
            }
            if self.next.0 > self.elapsed(until) {
                self.check_angles(self.elapsed(until))?;
                self.run.clock.arrive(until);
                if !self.held.rows.is_empty() {
                    self.run.log.touch(self.run.clock.now, self.run.log.active_set);
                }
                return Ok(true);
            }
            if !go_on() {
                return Ok(false);
            }
            self.pass();
        }
    }

    fn t_s(&self) -> f64 {
        self.run.clock.now
    }

    fn state(&self) -> State {
        let (s, point) = (self.elapsed(self.run.clock.now), self.point_now());
        let turn = Plane::cis(self.phase + self.flow.turned(s));
        let (u, v) = (point.z * turn, self.flow.carried(&point, s) * turn);
        State {
            t_s: self.run.clock.now,
            u: [u.re, u.im],
            v: [v.re, v.im],
            alpha: [point.a.re, point.a.im],
            alpha_rate: [point.da.re, point.da.im],
        }
    }

    fn multipliers(&self) -> Vec<(u32, f64)> {
        let mass = self.flow.machine.casing_mass;
        let pushes = self.stretch.pushes_at(&self.held, self.elapsed(self.run.clock.now));
        let mut sides: Vec<(u32, f64)> =
            pushes.map(|(row, push)| (row as u32, 0.0 - push * mass)).collect();
        in_phase_order(&self.flow.machine.polygon, &mut sides);
        sides
    }

    fn over(&self) -> bool {
        let (now, point) = (self.run.clock.now, self.point_now());
        self.held.rows.is_empty()
            && self.run.pulse.at(now) == 0.0
            && self.flow.reach(&point, self.elapsed(now)) < self.flow.room(&point)
    }

    fn final_verdict(&self) -> Option<Verdict> {
        if let Some(failure) = &self.run.failure {
            let beyond = self.beyond.then(|| failure.verdict_beyond(&self.run.pulse));
            Some(beyond.unwrap_or(Verdict::Failed))
        } else if self.over() {
            Some(Verdict::Decay)
        } else {
            self.held_for_good(self.elapsed(self.run.clock.now)).then_some(Verdict::Locked)
        }
    }

    fn pulse(&self) -> &Pulse {
        &self.run.pulse
    }

    fn contacts(&self) -> &ContactLog {
        &self.run.log
    }

    fn machine(&self) -> &Machine {
        &self.flow.machine
    }

    fn rotor(&self) -> &Rotor {
        &self.run.rotor
    }

    fn events(&self) -> Option<u64> {
        Some(self.run.events)
    }

    fn lasting(&self, window: f64) -> Verdict {
        let (machine, now) = (self.machine(), self.run.clock.now);
        self.lasting.verdict(machine, &self.run.log, [now, window], || None)
    }

    fn blades_follow(&self) -> bool {
        self.flow.solved_as_rigid
    }

    fn linearised(&self) -> bool {
        self.flow.blades.is_some_and(|blades| blades.diameters == 0.0)
    }

    fn failure(&self) -> Option<&Failure> {
        self.run.failure.as_ref()
    }

    fn checks(&self) -> Checks {
        Checks {
            max_penetration_m: self.run.deepest,
            max_blade_angle_rad: self.widest_until(self.elapsed(self.run.clock.now)),
            energy_residual_j: Some(self.account_now().residual()),
            ..Checks::default()
        }
    }

    fn energy_account(&self) -> Option<EnergyAccount> {
        (self.beyond && self.ledger.counts).then(|| self.account_now())
    }

    fn forgo_checks(&mut self) {
        self.ledger.counts = false;
    }

    fn fire(&mut self) {
        self.lasting.change(self.run.clock.now);
        self.intervene(|motion, _| motion.run.fire());
    }

    fn set_end(&mut self, end: f64) {
        self.lasting.set_end(self.run.clock.now, end);
    }

    /// A ramp under which coefficients of the equations change in the blade frame is a failure.
    fn set_speed(&mut self, speed: f64, ramp: f64) {
        self.lasting.change(self.run.clock.now);
        self.intervene(|motion, point| {
            motion.run.rotor.change(motion.run.clock.now, speed, ramp);
            motion.change_speed(speed, ramp, point);
        });
        if self.run.failure.is_some() {
            return;
        }
        let machine = &self.flow.machine;
        let drags = self.linearised() && machine.friction != 0.0;
        let changes = machine.changes_with_speed() || drags || self.flow.turn.im != 0.0;
        if ramp != 0.0 && changes {
            self.fail(0.0, FailureReason::Ramp);
        }
    }

    fn scale_rate(&mut self, factor: f64) {
        if self.over() || self.held.rows.len() > 1 {
            return;
        }
        self.intervene(|motion, point| {
            let side = motion.held.rows.first().and_then(|&row| motion.flow.rows.get(row));
            let free = match side {
                None => motion.flow.carried(point, 0.0),
                Some(side) => {
                    let along = Plane::i() * side;
                    along * dot(along, point.dz)
                }
            };
            point.dz += free * (factor - 1.0);
        });
    }

    fn scale_tolerance(&mut self, factor: f64) {
        let tolerance = factor * self.flow.tolerance;
        self.flow.tolerance = tolerance.clamp(*EVENT_RANGE.start(), *EVENT_RANGE.end());
    }

    fn fork(&self) -> Box<dyn Solver> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    //! Motions that start in a corner with bent blades, an initial state that a scene cannot
    //! describe.

    use super::*;
    use crate::motion::ActiveSet;
    use crate::scene::Scene;

    fn scene(keys: &[(&str, f64)]) -> CheckedScene {
        let mut scene = Scene::base();
        scene.set("solver.kind", "event").unwrap();
        scene.set("operation.pulse_n", "0").unwrap();
        for (key, value) in keys {
            scene.set(key, &value.to_string()).unwrap();
        }
        scene.checked().unwrap()
    }

    /// Returns the keys of `kappa`, `mu`, `tau` and the speed.
    fn keys([kappa, mu, tau, speed]: [f64; 4]) -> [(&'static str, f64); 4] {
        [
            ("bladed_disk.radial_coupling", kappa),
            ("contact.friction", mu),
            ("casing.tangential_ratio", tau),
            ("operation.speed_rad_s", speed),
        ]
    }

    /// Starts a motion locked in the corner of sides 0 and 1, from the closed form with the joint
    /// compliance.
    fn locked(scene: &CheckedScene) -> Events {
        let flow = Flow::new(scene);
        let (machine, nu) = (&flow.machine, flow.nu);
        let delta = machine.polygon.delta;
        let stiffness = machine.casing_stiffness - nu * nu * machine.casing_mass;
        let casing = flow.turn / Plane::new(stiffness, nu * machine.casing_damping);
        let bending = machine.blade_modal_stiffness;
        let compliance = casing + machine.coupling_product_at(flow.speed) / bending;
        let push = -Plane::cis(delta) * machine.clearance() / (compliance * delta.cos());
        let slope = machine.radial_coupling + flow.friction;
        let (z, a) = (casing * push, -push * (slope * machine.blade_length / bending));
        Events::from_point(scene, flow, Point { z, a, ..Point::default() })
    }

    /// Slope, friction, its share on the casing and speed; the multipliers of both sides [N], `|z|` [m]
    /// and the blade amplitude [rad] of the closed form.
    const LOCKS: [([f64; 4], [f64; 4]); 4] = [
        ([0.1, 0.0, 0.0, 500.0], [258.358348020, 55.600932525, 1.051647234e-4, 8.308641313e-5]),
        ([0.1, 0.15, 0.0, 500.0], [282.221918276, 52.075944593, 1.120426576e-4, 2.213009798e-4]),
        (
            [0.0, 0.15, 1.0 / 3.0, 500.0],
            [295.465760024, 4.150702554, 1.010283227e-4, 1.195782347e-4],
        ),
        ([-0.05, 0.15, 0.0, 500.0], [237.953135565, 57.982055172, 9.907933261e-5, 7.827859089e-5]),
    ];

    #[test]
    fn a_lock_pushes_as_its_closed_form() {
        for (data, [first, second, z, a]) in LOCKS {
            let mut motion = locked(&scene(&keys(data)));
            for t in [0.0, 1e-3, 0.1, 1e5] {
                motion.advance(t).unwrap();
                assert_eq!(motion.final_verdict(), Some(Verdict::Locked), "{data:?} {t}");
                let [(0, one), (1, other)] = motion.multipliers()[..] else { panic!("{data:?}") };
                assert!(
                    (one + first).abs() < 1e-9 && (other + second).abs() < 1e-9,
                    "{one} {other}"
                );
                let state = motion.state();
                assert!((state.amplitude() / z - 1.0).abs() < 1e-9);
                assert!((state.alpha[0].hypot(state.alpha[1]) / a - 1.0).abs() < 1e-9);
            }
            assert!(motion.run.looks < 1000, "{} stretches of a motion at rest", motion.run.looks);
        }
    }

    #[test]
    fn a_casing_thrown_far_off_takes_few_stretches() {
        let mut motion = Events::of(&scene(&[
            ("bladed_disk.blades", 1.0),
            ("operation.nodal_diameters", 0.0),
            ("bladed_disk.blade_length_m", 0.4999999997604368),
            ("operation.pulse_n", 1e12),
            ("operation.pulse_s", 0.0011),
        ]));
        motion.advance(1e-6).unwrap();
        // F t^2/2m, the casing practically free: a billion clearances, once a million stretches.
        assert!((motion.state().amplitude() - 0.25).abs() < 1e-5, "{:?}", motion.state());
        assert!(motion.run.looks < 200 && motion.run.events == 0, "{}", motion.run.looks);
    }

    /// Slope, friction, its share on the casing and the lock speed, to a unit of its last digit.
    const LOCK_SPEEDS: [([f64; 3], f64, f64); 6] = [
        ([0.0, 0.15, 1.0 / 3.0], 489.713631, 2e-6),
        ([0.0, 0.1, 1.0 / 3.0], 454.981573, 2e-6),
        ([0.0, 0.3, 1.0 / 3.0], 787.541069, 2e-6),
        ([0.1, 0.0, 0.0], 414.855, 1e-3),
        ([0.1, 0.15, 1.0 / 3.0], 548.980917, 2e-6),
        ([-0.1, 0.3, 0.0], 406.867471, 2e-6),
    ];

    #[test]
    fn a_lock_is_kept_above_its_speed_and_lost_below() {
        for ([kappa, mu, tau], speed, digit) in LOCK_SPEEDS {
            for (at, kept) in [(speed + digit, true), (speed - digit, false), (speed + 0.5, true)] {
                let mut motion = locked(&scene(&keys([kappa, mu, tau, at])));
                motion.advance(0.3).unwrap();
                let held = motion.contacts().active_set == ActiveSet::Corner(0, 1);
                assert_eq!(held, kept, "{kappa} {mu} {at}: {:?}", motion.contacts());
                // Within round-off of the limit a lock is not proved.
                let proved = motion.final_verdict() == Some(Verdict::Locked);
                assert!(if at > speed + digit { proved } else { kept || !proved }, "{mu} {at}");
            }
        }
    }

    #[test]
    fn what_is_held_for_good_stays_and_what_swings_too_far_is_not() {
        let scene = scene(&keys([0.1, 0.15, 0.0, 500.0]));
        let calm = locked(&scene);
        let from = calm.stretch.from;
        let mut proven = 0;
        for k in 0..200 {
            let size = if k == 0 { 0.0 } else { 1e-6 * 1.08_f64.powi(k) };
            let da = Plane::cis(f64::from(k)) * size;
            let point = Point { da, dz: da * calm.flow.arm(), ..from };
            let mut motion = Events::from_point(&scene, calm.flow.clone(), point);
            if motion.final_verdict() == Some(Verdict::Locked) {
                proven += 1;
                motion.advance(0.5).unwrap();
                assert_eq!(motion.contacts().since, 0.0, "{size}");
                assert_eq!(motion.contacts().active_set, ActiveSet::Corner(0, 1));
            }
        }
        assert!((2..200).contains(&proven), "{proven}");
    }
}
