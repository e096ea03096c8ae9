//! The event-driven solver of what goes beyond the paper's model: tips whose path has
//! a slope, friction, restitution, and disks with other diameters than the casing
//! (docs/theory.md, section 10).
//!
//! In the frame of the blades casing and blades together obey linear equations with
//! constant coefficients, if the angles of the blades are left out of the phases of
//! the gaps (`linearised`). While the same rows are held the motion is a power series,
//! summed to round-off stretch by stretch (`stretch`); the first gap that closes or
//! push that vanishes ends it (`search`), and complementarity problems without
//! symmetry say what comes next (`transitions`, `complementarity`). A gap that has just
//! opened keeps digits of its own, so that rocking at a corner and bouncing on a side
//! are followed down to round-off.
//!
//! A stretch is always evaluated from its start, never from an output time: where one
//! looks does not change the motion, not by one bit.

mod complementarity;
mod decided;
mod growth;
mod ledger;
mod parameters;
mod rows;
mod search;
mod segment;
mod solver;
mod stretch;
mod transitions;

#[cfg(test)]
mod tests;

use std::sync::OnceLock;

use super::clock::Clock;
use crate::motion::{ContactLog, Failure, Plane, Pulse, Rotor};
use crate::scene::CheckedScene;
use crate::tolerances::ON_A_SIDE;
use decided::Rest;
use growth::Swings;
use ledger::Ledger;
use parameters::{Parameters, Point};
use search::{Loose, What};
use stretch::{Held, Stretch};

/// The event-driven solver of one scene that goes beyond the paper's model, at some
/// instant of its motion.
///
/// ```
/// use rubscope::{motion::{Joined, Solver, Verdict}, scene::Scene};
/// let scene = Scene::base().with(&[
///     ("solver.kind", "event"),
///     ("bladed_disk.radial_coupling", "0.3"),
///     ("operation.speed_rad_s", "450"),
///     ("operation.pulse_n", "1e5"),
/// ])?;
/// let mut motion = Joined::new(&scene);
/// motion.advance(3e-3)?;
/// assert_eq!(motion.contacts().impact_count, 13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Joined {
    parameters: Parameters,
    rotor: Rotor,
    pulse: Pulse,
    log: ContactLog,
    ledger: Ledger,
    clock: Clock,
    /// `n_d theta` at the start, modulo a turn \[rad\].
    phase: f64,
    held: Held,
    loose: Vec<Loose>,
    stretch: Stretch,
    /// The event that ends the stretch, and when \[s after its start\].
    next: (f64, What),
    /// What is known for good of the rows that are held, once asked.
    rest: OnceLock<Option<Rest>>,
    swings: Swings,
    events: u64,
    idle: u32,
    looks: u64,
    deepest: f64,
    widest: f64,
    /// Whether energies and the widest angle are followed.
    checked: bool,
    failure: Option<Failure>,
}

impl Joined {
    /// The motion of a scene at t = 0 by the linearised equations, whether the scene
    /// goes beyond the paper's model or not. Law and size must be ones that the event
    /// solvers know (`CheckedScene::suits_events`), and the speed constant.
    #[must_use]
    pub fn new(scene: &CheckedScene) -> Self {
        let parameters = Parameters::new(scene);
        let initial = &scene.initial;
        let z = Plane::new(initial.u_c_m, initial.u_s_m);
        let carried = Plane::i() * z * parameters.nu;
        let dz = Plane::new(initial.v_c_m_s, initial.v_s_m_s) - carried;
        Self::from_point(scene, parameters, Point { z, dz, ..Point::default() })
    }

    fn from_point(scene: &CheckedScene, parameters: Parameters, point: Point) -> Self {
        let mut joined = Self {
            rotor: Rotor::of(scene),
            pulse: Pulse::of(scene),
            log: ContactLog::default(),
            ledger: Ledger { start: parameters.energy(&point), ..Ledger::default() },
            clock: Clock::default(),
            phase: 0.0,
            held: Held::default(),
            loose: Vec::new(),
            stretch: Stretch::to_the_end(point),
            next: (f64::INFINITY, What::StretchEnd),
            rest: OnceLock::new(),
            swings: Swings::new(&parameters, scene.solver.end_s),
            events: 0,
            idle: 0,
            looks: 0,
            deepest: 0.0,
            widest: 0.0,
            checked: true,
            failure: None,
            parameters,
        };
        joined.begin(point);
        joined
    }

    /// The first stretch.
    fn begin(&mut self, mut point: Point) {
        let parameters = &self.parameters;
        let limit = ON_A_SIDE * parameters.clearance();
        // A rate against the blades that is round-off of its two parts is none.
        let noise =
            ON_A_SIDE * (parameters.carried(&point).norm() + parameters.nu.abs() * point.z.norm());
        let met: Vec<(usize, f64)> = (0..parameters.rows.len())
            .filter(|&row| parameters.gap(row, &point) <= limit)
            .map(|row| {
                let rate = parameters.along(row, point.dz, point.da);
                (row, if rate.abs() <= noise { 0.0 } else { rate })
            })
            .collect();
        if met.is_empty() {
            self.enter(point);
        } else {
            self.meet(&mut point, &met);
        }
    }

    /// Largest amplitude `|alpha_c + i alpha_s|` of the blade modes over the last one
    /// to two casing periods \[rad\]. Times `|kappa| l_b` it is how far the tips swing.
    #[must_use]
    pub fn recent_blade_amplitude(&self) -> f64 {
        self.swings.largest().max(self.point_now().a.norm())
    }

    /// The ledger until now.
    fn ledger_now(&self) -> Ledger {
        let mut ledger = self.ledger;
        ledger.book(&self.parameters, &self.held, &self.stretch, self.elapsed(self.clock.now));
        ledger
    }

    /// Where the motion is now.
    fn point_now(&self) -> Point {
        self.stretch.point(&self.parameters, self.elapsed(self.clock.now))
    }
}
