//! The interface of all solvers, and a motion with the solver that its scene selects.

use std::fmt::Debug;
use std::ops::{Deref, DerefMut};

use super::explicit::Explicit;
use super::{
    Checks, ContactLog, EnergyAccount, Events, Failure, FailureReason, Plane, Pulse, Rotor, State,
    Verdict, turned,
};
use crate::model::Machine;
use crate::scene::{CheckedScene, SolverKind};

/// Callback that decides during the computation whether to continue, for example a flag set by a
/// signal or a time limit.
pub type GoOn<'a> = &'a (dyn Fn() -> bool + Sync);

/// Always continues.
#[must_use]
pub fn to_the_end() -> bool {
    true
}

/// A solver of one scene, at some instant of the motion.
pub trait Solver: Debug + Send + Sync {
    /// Advances to `until` \[s\]; the explicit solver advances to its last step by then. The motion
    /// does not depend on the instants at which it is observed.
    ///
    /// # Errors
    /// The run has failed, now or before. The state stays where it failed.
    fn advance(&mut self, until: f64) -> Result<(), Failure> {
        self.advance_while(until, &to_the_end).map(|_| ())
    }

    /// As [`advance`](Self::advance), but calls `go_on` at least once in a millisecond of
    /// computing. If it returns false, the result is false and the motion stays at an instant
    /// before `until`, from which it can be continued with the same result.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure>;

    /// As [`advance_while`](Self::advance_while), but may stop before `until` where nothing but the
    /// state changes from there to `until`: no contact, and no verdict. It costs less than to look at
    /// the motion at `until`.
    ///
    /// # Errors
    /// As [`advance`](Self::advance).
    fn approach(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        self.advance_while(until, go_on)
    }

    /// Returns the time; for the explicit solver that of its latest step \[s\]. Costs nothing,
    /// whereas [`state`](Self::state) may have to compute a power of a matrix.
    fn t_s(&self) -> f64;

    /// Returns the present coordinates and their rates.
    fn state(&self) -> State;

    /// Returns the present angle of every blade \[rad\].
    fn blade_angles(&self) -> Vec<f64> {
        let (polygon, [c, s]) = (&self.machine().polygon, self.state().alpha);
        let angle = |blade| {
            let (p_c, p_s) = polygon.direction(polygon.side_of_blade(blade));
            p_c * c + p_s * s
        };
        (1..=polygon.blades).map(angle).collect()
    }

    /// Returns the present gap of every blade, Eq. (14), including tip slope and unevenness;
    /// positive is open \[m\].
    fn blade_gaps(&self) -> Vec<f64> {
        let (machine, state) = (self.machine(), self.state());
        let polygon = &machine.polygon;
        let diameters = if self.linearised() { 0.0 } else { machine.nodal_diameters };
        // In the blade frame only the small angles differ from blade to blade.
        let theta = self.rotor().angle(state.t_s);
        let z = Plane::new(state.u[0], state.u[1]) * Plane::cis(-machine.nu(theta));
        let rise = machine.radial_coupling * machine.blade_length;
        let gap = |(blade, angle): (u32, f64)| {
            let (c, s) = polygon.direction(polygon.side_of_blade(blade));
            let normal = turned(Plane::new(c, s), diameters * angle);
            let unevenness = machine.uneven_at(blade - 1, theta + angle);
            machine.clearance() + unevenness + (z * normal.conj()).re - rise * angle
        };
        (1..=polygon.blades).zip(self.blade_angles()).map(gap).collect()
    }

    /// Returns the multipliers of the groups in contact, in phase order (`psi_a`, `psi_b`);
    /// negative is a push \[N\]. In the explicit solver the peak value in an impact is proportional
    /// to 1/h.
    fn multipliers(&self) -> Vec<(u32, f64)>;

    /// Returns the mean force on each side in contact since the last call; negative is a push
    /// \[N\]. The event solvers return the present forces, since their impacts are impulses without
    /// duration.
    fn take_mean_forces(&mut self) -> Vec<(u32, f64)> {
        self.multipliers()
    }

    /// Returns whether no contact can occur any more.
    fn over(&self) -> bool;

    /// Returns the verdict once it is proved: no contact can occur any more, or a corner can never
    /// open. `None` until then.
    fn final_verdict(&self) -> Option<Verdict>;

    /// Returns the decay rate of the slowest wave that indents a lining, where all blades press it at
    /// constant speed and none has lifted lately; negative for growth, 0 for neither \[1/s\].
    fn rest_rate(&self) -> Option<f64> {
        None
    }

    /// Returns the verdict over the last `window` seconds.
    fn lasting(&self, window: f64) -> Verdict;

    /// Returns the latest pulse.
    fn pulse(&self) -> &Pulse;

    /// Returns the record of contacts.
    fn contacts(&self) -> &ContactLog;

    /// Returns the machine.
    fn machine(&self) -> &Machine;

    /// Returns the rotor.
    fn rotor(&self) -> &Rotor;

    /// Returns the number of time steps so far, computed or skipped; `None` for a solver without
    /// steps.
    fn steps(&self) -> Option<u64> {
        None
    }

    /// Returns the number of skipped time steps; `None` for a solver without steps.
    fn steps_skipped(&self) -> Option<u64> {
        None
    }

    /// Returns the number of time steps computed one by one; `None` for a solver without steps.
    fn steps_taken(&self) -> Option<u64> {
        Some(self.steps()?.saturating_sub(self.steps_skipped()?))
    }

    /// Returns the number of events; `None` for a solver without events.
    fn events(&self) -> Option<u64> {
        None
    }

    /// Returns whether the blades are so stiff that they are solved as rigid ones.
    fn blades_follow(&self) -> bool {
        false
    }

    /// Returns whether the blade angles are neglected in the phases of the gaps.
    fn linearised(&self) -> bool {
        false
    }

    /// Returns whether contact can pull, as under the bilateral law.
    fn pulls(&self) -> bool {
        false
    }

    /// Returns the failure that ended the run, if any.
    fn failure(&self) -> Option<&Failure>;

    /// Returns reason and time of an early stop, in words; `None` if the run has not failed.
    fn stopped(&self) -> Option<String> {
        let failure = self.failure()?;
        let message = match self.final_verdict() {
            Some(Verdict::Divergent) => failure.as_growth(),
            _ => failure.to_string(),
        };
        let speed = self.rotor().speed(failure.t_s);
        let digs_in = self.machine().coupling_product_at(speed) < 0.0;
        Some(match failure.reason {
            FailureReason::Singular { .. } if digs_in => format!(
                "{message}; where kappa (kappa + mu) < 0, a push may close the gap that it should open"
            ),
            _ => message,
        })
    }

    /// Returns the largest penetration, blade angle and energy error so far.
    fn checks(&self) -> Checks;

    /// Returns the energy account of a model beyond the paper; `None` within the paper's model, and
    /// after [`forgo_checks`](Self::forgo_checks).
    fn energy_account(&self) -> Option<EnergyAccount> {
        None
    }

    /// Stops the bookkeeping for [`checks`](Self::checks) that costs time. Used if only the verdict
    /// is needed; the motion is the same.
    fn forgo_checks(&mut self) {}

    /// Fires the pulse again at the present instant.
    fn fire(&mut self);

    /// Sets speed \[rad/s\] and acceleration \[rad/s^2\] of the rotor from now on. A sudden change
    /// of speed acts on sides in contact like an impact.
    fn set_speed(&mut self, speed: f64, ramp: f64);

    /// Multiplies the casing rate, as far as contact leaves it free, by `factor`: the noise of a
    /// sensitivity run.
    fn scale_rate(&mut self, factor: f64);

    /// Applies the parameters of a scene that satisfies
    /// [`Change::is_live`](super::Change::is_live): masses, stiffnesses, damping, contact law, and
    /// the next pulse.
    fn set_parameters(&mut self, _: &CheckedScene) {}

    /// Moves the end of the run \[s\], up to which the swing of the tips is followed.
    fn set_end(&mut self, end: f64);

    /// Multiplies the tolerance of the solver by `factor`, if it has one.
    fn scale_tolerance(&mut self, _factor: f64) {}

    /// Clones the motion.
    fn fork(&self) -> Box<dyn Solver>;
}

/// A motion in progress.
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
    /// Starts the motion of a scene at t = 0, with its solver and model size.
    #[must_use]
    pub fn new(scene: &CheckedScene) -> Self {
        match scene.solver.kind {
            SolverKind::Event => Events::of(scene).into(),
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
