//! The event-driven solver: the true motion, mode by mode (docs/theory.md, section 7).
//!
//! With rigid blades the casing wave is a point in a polygon that turns with
//! the rotor (`model::ContactPolygon`), and it moves in one of four modes: *free*,
//! *sliding* along a side, *rocking* into a corner, or *locked* in a corner.
//! Within a mode the motion is known in closed form or as a power series summed to
//! round-off (pulse or ramp while sliding). With blades that move (`parameters`) the sides
//! turn a little by themselves; sliding and locked motion are then power series too
//! (`slide`, `locked`), and impacts share their impulse with the blades (`impact`). Each
//! mode looks ahead for its end with bounds that cannot miss it (`event::series`), and the
//! next mode follows from plastic impact and from the pushes by cases (`transitions`), so
//! that no event is found twice.
//!
//! A segment is always evaluated from its start, never from an output time:
//! where one looks does not change the motion, not by one bit.
//!
//! Read `parameters`, `mode`, `free` with `bounds`, `slide`, `rocking`, `locked`, then
//! `impact` and `transitions`.

mod bounds;
mod free;
mod impact;
mod locked;
mod mode;
mod parameters;
mod rocking;
mod slide;
mod transitions;

use crate::model::Machine;
use crate::motion::event::Run;
use crate::motion::{
    Checks, ContactLog, Failure, FailureReason, GoOn, Plane, Pulse, Rotor, Solver, State, Verdict,
    to_the_end,
};
use crate::scene::{CheckedScene, SceneError};
use crate::tolerances::EVENT_RANGE;
use mode::{Ending, EnergyBalance, Mode, casing_energy};
use parameters::{Parameters, Tips};
use transitions::Passage;

/// The event-driven solver of one scene, at some instant of its motion.
///
/// ```
/// use rubscope_solver::{motion::{ExactEvents, Solver}, scene::Scene};
/// let mut motion = ExactEvents::new(&Scene::base().checked()?)?;
/// motion.advance(0.1)?;
/// assert!(motion.over());
/// assert_eq!(motion.contacts().impact_count, 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct ExactEvents {
    parameters: Parameters,
    run: Run,
    energy_balance: EnergyBalance,
    mode: Mode,
    /// Blades at the start of the segment.
    tips: Tips,
    /// No event of the segment comes before this \[s after its start\].
    safe: f64,
    /// The event that ends the segment, once found.
    found: Option<(f64, Ending)>,
    /// Looks ahead in this segment.
    looks: u64,
    /// Series of a rocking motion, once one was looked for.
    tables: Option<Box<rocking::Tables>>,
}

impl ExactEvents {
    /// Creates the motion of a scene at t = 0, whichever solver the scene names.
    ///
    /// # Errors
    /// The contact law, the model size or what goes beyond the paper is nothing that
    /// this solver knows.
    pub fn new(scene: &CheckedScene) -> Result<Self, SceneError> {
        scene.suits_events()?;
        scene.is_of_the_paper()?;
        Ok(Self::of(scene))
    }

    /// Same as for `new`, for a scene that names this solver or suits it.
    pub(in crate::motion) fn of(scene: &CheckedScene) -> Self {
        let parameters = Parameters::new(scene);
        let place = Plane::new(scene.initial.u_c_m, scene.initial.u_s_m);
        let rate = Plane::new(scene.initial.v_c_m_s, scene.initial.v_s_m_s);
        let energy_balance = EnergyBalance {
            start: casing_energy(&parameters, place, rate),
            ..EnergyBalance::default()
        };
        let mut event = Self {
            mode: Mode::Free(free::Free::new(place, rate, Tips::default())),
            parameters,
            energy_balance,
            run: Run::of(scene),
            safe: 0.0,
            found: None,
            looks: 0,
            tips: Tips::default(),
            tables: None,
        };
        event.parameters.drive = event.drive_now(0.0);
        event.begin(place, rate);
        event
    }

    /// Creates the same, with gaps below `tolerance` times the size of the motion taken
    /// as closed; 1e-15 otherwise.
    #[must_use]
    pub fn with_tolerance(mut self, tolerance: f64) -> Self {
        self.set_tolerance(tolerance);
        self
    }

    fn set_tolerance(&mut self, tolerance: f64) {
        self.parameters.tolerance = tolerance.clamp(*EVENT_RANGE.start(), *EVENT_RANGE.end());
    }

    /// Returns the tolerance in force.
    #[must_use]
    pub fn tolerance(&self) -> f64 {
        self.parameters.tolerance
    }

    /// Moves to the next change of mode, or to `limit` if none comes before
    /// \[s\]; returns the instant reached.
    ///
    /// # Errors
    /// As `advance`.
    pub fn next_event(&mut self, limit: f64) -> Result<f64, Failure> {
        let events = self.run.events;
        while events == self.run.events {
            if self.change(limit, &to_the_end)? == Passage::Later {
                self.arrive(limit)?;
                return Ok(self.run.clock.now);
            }
        }
        self.arrive(self.run.clock.start().max(self.run.clock.now))?;
        Ok(self.run.clock.now)
    }
}

impl Solver for ExactEvents {
    fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        loop {
            match self.change(until, go_on)? {
                Passage::Passed => {}
                Passage::Later => return self.arrive(until).map(|()| true),
                // Nothing happens before `safe`.
                Passage::Paused => {
                    let reached = until.min(self.run.clock.start() + self.safe);
                    return self.arrive(reached).map(|()| false);
                }
            }
        }
    }

    fn t_s(&self) -> f64 {
        self.run.clock.now
    }

    fn state(&self) -> State {
        let s = self.elapsed(self.run.clock.now);
        let (u, v) = self.mode.standing(&self.parameters, s);
        let Tips { angle, rate } = self.mode.reported(&self.parameters, s);
        State {
            t_s: self.run.clock.now,
            u: [u.re, u.im],
            v: [v.re, v.im],
            alpha: [angle.re, angle.im],
            alpha_rate: [rate.re, rate.im],
        }
    }

    fn contacts(&self) -> &ContactLog {
        &self.run.log
    }

    fn multipliers(&self) -> Vec<(u32, f64)> {
        let s = self.elapsed(self.run.clock.now);
        let pushes = self.mode.pushes(&self.parameters, s);
        let multiplier = |(side, push): (u32, f64)| (side, -push * self.parameters.mass);
        pushes.into_iter().flatten().map(multiplier).collect()
    }

    fn over(&self) -> bool {
        let Mode::Free(free) = &self.mode else { return false };
        let (u, v) = free.at(&self.parameters, self.elapsed(self.run.clock.now));
        self.parameters.drive.pulse == 0.0 && free::Free::spent(&self.parameters, u, v)
    }

    fn final_verdict(&self) -> Option<Verdict> {
        if self.run.failure.is_some() {
            Some(Verdict::Failed)
        } else if self.over() {
            Some(Verdict::Decay)
        } else if let Mode::Corner(a) = self.mode
            && self.parameters.drive.steady()
        {
            let pushes = locked::pushes(&self.parameters, a, 0.0);
            let least = self.parameters.certain_push();
            pushes.iter().all(|&push| push > least).then_some(Verdict::Locked)
        } else if let Mode::Held(held) = &self.mode
            && let Some(blades) = &self.parameters.blades
            && self.parameters.drive.steady()
        {
            let s = self.elapsed(self.run.clock.now);
            held.for_good(&self.parameters, blades, s).then_some(Verdict::Locked)
        } else {
            None
        }
    }

    fn failure(&self) -> Option<&Failure> {
        self.run.failure.as_ref()
    }

    fn pulse(&self) -> &Pulse {
        &self.run.pulse
    }

    fn rotor(&self) -> &Rotor {
        &self.run.rotor
    }

    fn machine(&self) -> &Machine {
        &self.parameters.machine
    }

    fn checks(&self) -> Checks {
        let s = self.elapsed(self.run.clock.now);
        let mut energy_balance = self.energy_balance;
        self.mode.book(&self.parameters, s, &mut energy_balance);
        let residual = energy_balance.residual(self.mode.energy(&self.parameters, s));
        Checks {
            max_penetration_m: self.run.deepest,
            max_blade_angle_rad: self.mode.largest_angle(&self.parameters, s, self.run.widest),
            energy_residual_j: Some(self.parameters.mass * residual),
            ..Checks::default()
        }
    }

    fn forgo_checks(&mut self) {
        self.run.checked = false;
    }

    fn fire(&mut self) {
        self.intervene(|event| event.run.fire());
    }

    fn set_speed(&mut self, speed: f64, ramp: f64) {
        self.intervene(|event| {
            event.run.rotor.change(event.run.clock.now, speed, ramp);
            event.energy_balance.rotor += event.parameters.turn_at(speed, &event.tips);
        });
        if self.run.failure.is_none() && self.parameters.machine.changes_with_speed() {
            if ramp != 0.0 {
                self.fail(0.0, FailureReason::Ramp);
            } else if self.parameters.clearance <= 0.0 {
                self.fail(0.0, FailureReason::Closed { speed_rad_s: speed });
            }
        }
    }

    fn scale_rate(&mut self, factor: f64) {
        let free = matches!(self.mode, Mode::Free(_) | Mode::Slide(_) | Mode::Driven(_));
        if free && !self.over() {
            self.intervene_scaled(factor, |_| {});
        }
    }

    fn events(&self) -> Option<u64> {
        Some(self.run.events)
    }

    fn blades_follow(&self) -> bool {
        self.parameters.following.is_some()
    }

    fn scale_tolerance(&mut self, factor: f64) {
        self.set_tolerance(factor * self.parameters.tolerance);
    }

    fn fork(&self) -> Box<dyn Solver> {
        Box::new(self.clone())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::FailureReason;
    use crate::scene::Scene;
    use crate::tolerances::{MOST_EVENTS, MOST_LOOKS};

    #[test]
    fn a_motion_without_checks_is_the_same_to_the_bit() {
        for name in ["slip", "rocking", "undamped", "run-down"] {
            let scene = Scene::builtin(name).unwrap().as_reference().checked().unwrap();
            let mut full = ExactEvents::new(&scene).unwrap();
            let mut bare = full.clone();
            bare.forgo_checks();
            for k in 1..=10 {
                let t = 0.1 * scene.solver.end_s * f64::from(k);
                full.advance(t).unwrap();
                bare.advance(t).unwrap();
                assert_eq!(full.state(), bare.state(), "{name}");
                assert_eq!(full.contacts(), bare.contacts(), "{name}");
            }
            assert!(bare.energy_balance.dissipated == 0.0 && full.run.events > 3, "{name}");
        }
    }

    #[test]
    fn looks_and_events_of_one_run_are_bounded() {
        let mut scene = Scene::builtin("undamped").unwrap().as_reference();
        // Hours of bouncing.
        scene.solver.end_s = 1e6;
        let mut event = ExactEvents::new(&scene.checked().unwrap()).unwrap();
        event.run.looks = MOST_LOOKS - 100;
        let mut other = event.clone();
        (other.run.looks, other.run.events) = (0, MOST_EVENTS - 10);
        for (mut event, expected) in [(event, FailureReason::Looks), (other, FailureReason::Events)]
        {
            let failure = event.advance(1e6).unwrap_err();
            assert_eq!(failure.reason, expected);
            assert!(failure.t_s < 1.0 && event.final_verdict() == Some(Verdict::Failed));
        }
    }
}
