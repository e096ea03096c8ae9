//! One motion, whichever solver and model size the scene asks for.

use super::explicit::{Explicit, FullBlades, ModalBlades, RigidBlades};
use super::{Checks, ContactLog, Event, Failure, Pulse, Rotor, State, Verdict};
use crate::model::Machine;
use crate::scene::{ModelSize, Scene, SolverKind};

/// A motion under way: advanced, looked at, cloned.
///
/// ```
/// use rubscope::{motion::Motion, scene::Scene};
/// let mut motion = Motion::new(&Scene::default());
/// motion.advance(1e-3)?;
/// assert_eq!(motion.contacts().impact_count, 2);
/// # Ok::<(), rubscope::motion::Failure>(())
/// ```
#[derive(Clone, Debug)]
pub enum Motion {
    /// Explicit, casing only.
    Rigid(Box<Explicit<RigidBlades>>),
    /// Explicit, the paper's four coordinates.
    Modal(Box<Explicit<ModalBlades>>),
    /// Explicit, every blade its own coordinate.
    Full(Box<Explicit<FullBlades>>),
    /// Event-driven closed forms.
    Event(Box<Event>),
}

macro_rules! each {
    ($motion:expr, $inner:ident => $do:expr) => {
        match $motion {
            Self::Rigid($inner) => $do,
            Self::Modal($inner) => $do,
            Self::Full($inner) => $do,
            Self::Event($inner) => $do,
        }
    };
}

impl Motion {
    /// The motion of a checked scene at t = 0.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        if scene.solver.kind == SolverKind::Event {
            return Self::Event(Box::new(Event::new(scene)));
        }
        match scene.solver.model {
            ModelSize::Rigid => Self::Rigid(Box::new(Explicit::new(scene))),
            ModelSize::Modal => Self::Modal(Box::new(Explicit::new(scene))),
            ModelSize::Full => Self::Full(Box::new(Explicit::new(scene))),
        }
    }

    /// Advances to `until` \[s\] (the explicit solver: to its last step by then).
    ///
    /// # Errors
    /// The run has failed, now or before.
    pub fn advance(&mut self, until: f64) -> Result<(), Failure> {
        each!(self, inner => inner.advance(until))
    }

    /// The four coordinates and their rates now.
    #[must_use]
    pub fn state(&self) -> State {
        each!(self, inner => inner.state())
    }

    /// The angle of every blade now \[rad\].
    #[must_use]
    pub fn blade_angles(&self) -> Vec<f64> {
        match self {
            Self::Rigid(inner) => inner.blade_angles(),
            Self::Modal(inner) => inner.blade_angles(),
            Self::Full(inner) => inner.blade_angles(),
            Self::Event(inner) => {
                let (rim, [c, s]) = (&inner.machine().rim, inner.state().alpha);
                let angle = |blade| {
                    let (p_c, p_s) = rim.direction(rim.side_of_blade(blade));
                    p_c * c + p_s * s
                };
                (1..=rim.blades).map(angle).collect()
            }
        }
    }

    /// The gap of every blade now, Eq. (14); positive means open \[m\].
    #[must_use]
    pub fn blade_gaps(&self) -> Vec<f64> {
        let (machine, state) = (self.machine(), self.state());
        let phase = machine.nodal_diameters * self.rotor().angle(state.t_s);
        let angles = self.blade_angles();
        (1..=machine.rim.blades)
            .zip(angles)
            .map(|(blade, angle)| {
                let psi = machine.rim.phase(machine.rim.side_of_blade(blade));
                let (sin, cos) = (phase + psi + machine.nodal_diameters * angle).sin_cos();
                machine.clearance() + state.u[0] * cos + state.u[1] * sin
            })
            .collect()
    }

    /// Group multipliers of the sides in contact now, in phase order \[N\];
    /// negative is a push.
    #[must_use]
    pub fn multipliers(&self) -> Vec<(u32, f64)> {
        each!(self, inner => inner.multipliers())
    }

    /// Mean force on each touched side since last asked \[N\]; negative is a
    /// push. The event solver, whose forces have no step to average over,
    /// gives the forces now; its impacts are impulses without duration.
    pub fn take_mean_forces(&mut self) -> Vec<(u32, f64)> {
        match self {
            Self::Rigid(inner) => inner.take_mean_forces(),
            Self::Modal(inner) => inner.take_mean_forces(),
            Self::Full(inner) => inner.take_mean_forces(),
            Self::Event(inner) => inner.multipliers(),
        }
    }

    /// Whether no contact can ever come again.
    #[must_use]
    pub fn over(&self) -> bool {
        each!(self, inner => inner.over())
    }

    /// The verdict, once nothing to come can change it: no contact can come
    /// again, or a corner can never let go.
    #[must_use]
    pub fn settled(&self) -> Option<Verdict> {
        each!(self, inner => inner.settled())
    }

    /// The pulse in force.
    #[must_use]
    pub fn pulse(&self) -> &Pulse {
        each!(self, inner => inner.pulse())
    }

    /// The record of contacts.
    #[must_use]
    pub fn contacts(&self) -> &ContactLog {
        each!(self, inner => inner.contacts())
    }

    /// The machine.
    #[must_use]
    pub fn machine(&self) -> &Machine {
        each!(self, inner => inner.machine())
    }

    /// The rotor.
    #[must_use]
    pub fn rotor(&self) -> &Rotor {
        each!(self, inner => inner.rotor())
    }

    /// Time steps taken; none for a solver without steps.
    #[must_use]
    pub fn steps(&self) -> Option<u64> {
        match self {
            Self::Rigid(inner) => Some(inner.steps()),
            Self::Modal(inner) => Some(inner.steps()),
            Self::Full(inner) => Some(inner.steps()),
            Self::Event(_) => None,
        }
    }

    /// Changes of mode computed; none for a solver that does not know them.
    #[must_use]
    pub fn events(&self) -> Option<u64> {
        match self {
            Self::Event(inner) => Some(inner.events()),
            _ => None,
        }
    }

    /// Why the run failed, if it did.
    #[must_use]
    pub fn failure(&self) -> Option<&Failure> {
        each!(self, inner => inner.failure())
    }

    /// What was kept watch on.
    #[must_use]
    pub fn checks(&self) -> Checks {
        each!(self, inner => inner.checks())
    }

    /// Fires the pulse again, from now on.
    pub fn fire(&mut self) {
        each!(self, inner => inner.fire());
    }

    /// From now on, turn with this speed \[rad/s\] and acceleration \[rad/s^2\].
    pub fn set_speed(&mut self, speed: f64, ramp: f64) {
        each!(self, inner => inner.set_speed(speed, ramp));
    }

    /// Multiplies the rate of the casing, as far as contact leaves it free, by
    /// `factor`: the noise that a trustworthy verdict does not notice.
    pub fn scale_rate(&mut self, factor: f64) {
        each!(self, inner => inner.scale_rate(factor));
    }

    /// From now on, moves with the parameters of a checked scene: dampings,
    /// masses, stiffnesses, contact law, and the pulse to fire next. False,
    /// and nothing changes, where that needs another motion: another solver or
    /// model, number of blades or diameters, clearance or step.
    pub fn adopt(&mut self, scene: &Scene) -> bool {
        if scene.solver.kind == SolverKind::Event {
            return false;
        }
        match (self, scene.solver.model) {
            (Self::Rigid(inner), ModelSize::Rigid) => inner.adopt(scene),
            (Self::Modal(inner), ModelSize::Modal) => inner.adopt(scene),
            (Self::Full(inner), ModelSize::Full) => inner.adopt(scene),
            _ => false,
        }
    }
}
