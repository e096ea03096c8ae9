//! What every solver offers, and one motion by whichever of them its scene asks
//! for.

use std::fmt::Debug;
use std::ops::{Deref, DerefMut};

use super::explicit::Explicit;
use super::verdict::judge;
use super::{
    Checks, ContactLog, EnergyAccount, ExactEvents, Failure, FailureReason, LinearEvents, Plane,
    Pulse, Rotor, State, Verdict,
};
use crate::model::Machine;
use crate::scene::{CheckedScene, SolverKind};
use crate::tolerances::WHIRL_SWING;

/// Asked on the way whether work shall go on: a flag that a signal sets, or a
/// limit of time.
pub type GoOn<'a> = &'a (dyn Fn() -> bool + Sync);

/// Goes on to the end, whatever the work.
#[must_use]
pub fn to_the_end() -> bool {
    true
}

/// A solver of one scene, at some instant of the motion.
pub trait Solver: Debug + Send + Sync {
    /// Advances to `until` \[s\] (the explicit solver: to its last step by then).
    /// The motion does not depend on the instants at which it is looked at.
    ///
    /// # Errors
    /// The run has failed, now or before. The state stays where it failed.
    fn advance(&mut self, until: f64) -> Result<(), Failure> {
        self.advance_while(until, &to_the_end).map(|_| ())
    }

    /// As `advance`, asking `go_on` at least every millisecond of work. Where it
    /// says no, the motion stays at an instant before `until`, from which it can
    /// be advanced later as if nothing had happened, and the result is false.
    ///
    /// # Errors
    /// As `advance`.
    fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure>;

    /// Time \[s\]; of the explicit solver, that of its latest step. It costs nothing,
    /// where `state` may have to take a power of a matrix.
    fn t_s(&self) -> f64;

    /// The four coordinates and their rates now.
    fn state(&self) -> State;

    /// The angle of every blade now \[rad\].
    fn blade_angles(&self) -> Vec<f64> {
        let (polygon, [c, s]) = (&self.machine().polygon, self.state().alpha);
        let angle = |blade| {
            let (p_c, p_s) = polygon.direction(polygon.side_of_blade(blade));
            p_c * c + p_s * s
        };
        (1..=polygon.blades).map(angle).collect()
    }

    /// The gap of every blade now, Eq. (14), with the slope of the tips; positive means
    /// open \[m\].
    fn blade_gaps(&self) -> Vec<f64> {
        let (machine, state) = (self.machine(), self.state());
        let (polygon, diameters) = (&machine.polygon, machine.nodal_diameters);
        // In the frame of the blades only their small angles differ from blade to blade.
        let theta = self.rotor().angle(state.t_s);
        let z = Plane::new(state.u[0], state.u[1]) * Plane::cis(-diameters * theta);
        let rise = machine.radial_coupling * machine.blade_length;
        let gap = |(blade, angle): (u32, f64)| {
            let (c, s) = polygon.direction(polygon.side_of_blade(blade));
            let normal = Plane::new(c, s) * Plane::cis(diameters * angle);
            let beside = machine.uneven_at(blade - 1, theta + angle);
            machine.clearance() + beside + (z * normal.conj()).re - rise * angle
        };
        (1..=polygon.blades).zip(self.blade_angles()).map(gap).collect()
    }

    /// Group multipliers of the sides in contact now, in phase order (`psi_a`,
    /// `psi_b`) \[N\]; negative is a push. In the explicit solver the peak of an
    /// impact grows like 1/h.
    fn multipliers(&self) -> Vec<(u32, f64)>;

    /// Mean force on each touched side since last asked \[N\]; negative is a
    /// push. A solver whose forces have no step to average over gives the forces
    /// now; its impacts are impulses without duration.
    fn take_mean_forces(&mut self) -> Vec<(u32, f64)> {
        self.multipliers()
    }

    /// Whether no contact can ever come again.
    fn over(&self) -> bool;

    /// The verdict, once nothing to come can change it: no contact can come
    /// again, or a corner can never let go.
    fn final_verdict(&self) -> Option<Verdict>;

    /// The rate at which the slowest wave that moves the tips in a lining dies, where all blades
    /// press it at constant speed and stay so through the whole beat; negative where it grows, 0
    /// where it does neither beyond round-off \[1/s\].
    fn rest_rate(&self) -> Option<f64> {
        None
    }

    /// The verdict over the last `window` seconds.
    fn lasting(&self, window: f64) -> Verdict {
        let clearance = self.machine().clearance().abs();
        let (contacts, now) = (self.contacts(), self.t_s());
        let verdict = match judge(contacts, now, window) {
            Verdict::Slip if self.swing() > WHIRL_SWING * clearance => Verdict::Whirl,
            other => other,
        };
        verdict.unless_forced(self.machine(), contacts, now - window)
    }

    /// How far blade tips swing outward over the last part of the run,
    /// `|kappa| l_b |a|` \[m\].
    fn swing(&self) -> f64 {
        0.0
    }

    /// The pulse in force.
    fn pulse(&self) -> &Pulse;

    /// The record of contacts.
    fn contacts(&self) -> &ContactLog;

    /// The machine.
    fn machine(&self) -> &Machine;

    /// The rotor.
    fn rotor(&self) -> &Rotor;

    /// Time steps from the start until now, taken or skipped; none for a solver
    /// without steps.
    fn steps(&self) -> Option<u64> {
        None
    }

    /// The time steps skipped: done many at once, with the result of taking each.
    fn steps_skipped(&self) -> Option<u64> {
        None
    }

    /// The time steps taken: computed one by one.
    fn steps_taken(&self) -> Option<u64> {
        Some(self.steps()?.saturating_sub(self.steps_skipped()?))
    }

    /// Changes of mode computed; none for a solver that does not know them.
    fn events(&self) -> Option<u64> {
        None
    }

    /// Whether the blades of a scene with moving blades are so stiff that they are
    /// solved as rigid ones, whose angles follow the pushes at once.
    fn blades_follow(&self) -> bool {
        false
    }

    /// Whether the angles of the blades are left out of the phases of the gaps.
    fn linearised(&self) -> bool {
        false
    }

    /// Whether contact can pull: under the bilateral law.
    fn pulls(&self) -> bool {
        false
    }

    /// Why the run failed, if it did.
    fn failure(&self) -> Option<&Failure>;

    /// Why and when the run stopped early, in words.
    fn stopped(&self) -> Option<String> {
        let failure = self.failure()?;
        let told = match self.final_verdict() {
            Some(Verdict::Divergent) => failure.as_growth(),
            _ => failure.to_string(),
        };
        let speed = self.rotor().speed(failure.t_s);
        let digs_in = self.machine().coupling_product_at(speed) < 0.0;
        Some(match failure.reason {
            FailureReason::Singular { .. } if digs_in => format!(
                "{told}; where kappa (kappa + mu) < 0, a push may close the gap that it is to open"
            ),
            _ => told,
        })
    }

    /// Largest penetration, blade angle and other checks so far.
    fn checks(&self) -> Checks;

    /// Where energy came from and went to, beyond the paper.
    fn energy_account(&self) -> Option<EnergyAccount> {
        None
    }

    /// From now on keeps no account of `checks` that costs time; for a run of which
    /// only the verdict is asked. The motion is the same.
    fn forgo_checks(&mut self) {}

    /// Fires the pulse again, from now on.
    fn fire(&mut self);

    /// Turns the rotor from now on with this speed \[rad/s\] and acceleration
    /// \[rad/s^2\]. A sudden change of speed acts on sides in contact as an impact
    /// does.
    fn set_speed(&mut self, speed: f64, ramp: f64);

    /// Multiplies the rate of the casing, as far as contact leaves it free, by
    /// `factor`: the noise that a trustworthy verdict does not notice.
    fn scale_rate(&mut self, factor: f64);

    /// From now on, moves with the parameters of a scene for which
    /// `Change::is_live` holds: dampings, masses, stiffnesses, contact law, and
    /// the pulse to fire next.
    fn set_parameters(&mut self, _: &CheckedScene) {}

    /// Multiplies the solver's own tolerance by `factor`, if it has one.
    fn scale_tolerance(&mut self, _factor: f64) {}

    /// A copy that goes its own way.
    fn fork(&self) -> Box<dyn Solver>;
}

/// A motion under way: advanced, looked at, cloned.
///
/// ```
/// use rubscope_solver::{motion::Motion, scene::Scene};
/// let mut motion = Motion::new(&Scene::base().checked()?);
/// motion.advance(1e-3)?;
/// assert_eq!(motion.contacts().impact_count, 2);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Motion(Box<dyn Solver>);

impl Motion {
    /// The motion of a scene at t = 0, by the solver and model size it names.
    #[must_use]
    pub fn new(scene: &CheckedScene) -> Self {
        match scene.solver.kind {
            SolverKind::Event if scene.has_other_tips() => LinearEvents::new(scene).into(),
            SolverKind::Event => ExactEvents::of(scene).into(),
            SolverKind::Explicit => Explicit::new(scene).into(),
        }
    }
}

impl<S: Solver + 'static> From<S> for Motion {
    fn from(solver: S) -> Self {
        Self(Box::new(solver))
    }
}

impl Clone for Motion {
    fn clone(&self) -> Self {
        Self(self.0.fork())
    }
}

impl Deref for Motion {
    type Target = dyn Solver;
    fn deref(&self) -> &Self::Target {
        &*self.0
    }
}

impl DerefMut for Motion {
    fn deref_mut(&mut self) -> &mut Self::Target {
        &mut *self.0
    }
}
