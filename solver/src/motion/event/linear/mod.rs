//! Event-driven solver for models beyond the paper: inclined tips, friction, restitution and
//! unequal tips (docs/theory.md, sections 10 and 11).
//!
//! If the blade angles are neglected in the phases of the gaps, casing and blades obey linear
//! equations with constant coefficients in the blade frame. While the same rows are in contact, the
//! motion is a power series, summed to round-off over one stretch after the other; a stretch ends
//! at the first gap that closes or contact force that vanishes (`stretch`). Nonsymmetric
//! complementarity problems determine what follows (`transitions`), and a Lyapunov function proves
//! when a contact is permanent (`decided`). A gap that has just opened is stored separately, with
//! its full relative accuracy, so that rocking at a corner and bouncing on a side are resolved down
//! to round-off.
//!
//! A stretch is always evaluated from its start, never from an output time, so that output does not
//! change the motion, not even by one bit.
//!
//! Order in which to read: `parameters`, `stretch`, `transitions`, then `energy` and `decided`.

mod decided;
mod energy;
mod parameters;
mod stretch;
mod transitions;

use std::sync::OnceLock;

use super::Run;
use crate::model::Machine;
use crate::motion::{
    Checks, ContactLog, EnergyAccount, Failure, FailureReason, GoOn, Plane, Pulse, Rotor, Solver,
    State, Verdict, in_phase_order,
};
use crate::scene::CheckedScene;
use crate::tolerances::{EVENT_RANGE, LOOKS_UNASKED, ON_A_SIDE};
use decided::Rest;

use crate::motion::point::Point;
use energy::{Energies, Swings};
use parameters::Parameters;

use stretch::{Ending, Held, OpenedGap, Stretch};

/// Event-driven solver of a scene beyond the paper's model, at some instant of its motion.
///
/// ```
/// use rubscope_solver::{motion::{LinearEvents, Solver, Verdict}, scene::Scene};
/// let scene = Scene::base().with(&[
///     ("solver.kind", "event"),
///     ("bladed_disk.radial_coupling", "0.3"),
///     ("operation.speed_rad_s", "450"),
///     ("operation.pulse_n", "1e5"),
/// ])?;
/// let mut motion = LinearEvents::new(&scene);
/// motion.advance(3e-3)?;
/// assert_eq!(motion.contacts().impact_count, 13);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct LinearEvents {
    parameters: Parameters,
    run: Run,
    energies: Energies,
    /// Phase `n_d theta` at the start of the stretch, modulo a full turn \[rad\].
    phase: f64,
    held: Held,
    opened: Vec<OpenedGap>,
    stretch: Stretch,
    /// Event that ends the stretch, and its time after the start of the stretch \[s\].
    next: (f64, Ending),
    /// Result of the proof that the present contact is permanent; computed on demand.
    rest: OnceLock<Option<Rest>>,
    swings: Swings,
}

impl LinearEvents {
    /// Starts the motion of a scene at t = 0 with the linearised equations, whether or not the
    /// scene is beyond the paper's model. Contact law and model size must be supported
    /// (`CheckedScene::suits_events`), and the speed must be constant.
    #[must_use]
    pub fn new(scene: &CheckedScene) -> Self {
        let parameters = Parameters::new(scene);
        let (initial, start) = (&scene.initial, scene.start());
        let z = Plane::new(start.0, start.1);
        let carried = Plane::i() * z * parameters.nu;
        let dz = Plane::new(initial.v_c_m_s, initial.v_s_m_s) - carried;
        Self::from_point(scene, parameters, Point { z, dz, ..Point::default() })
    }

    fn from_point(scene: &CheckedScene, parameters: Parameters, point: Point) -> Self {
        let mut motion = Self {
            energies: Energies { start: parameters.energy(&point), ..Energies::default() },
            run: Run::of(scene),
            phase: 0.0,
            held: Held::default(),
            opened: Vec::new(),
            stretch: Stretch::to_the_end(point),
            next: (f64::INFINITY, Ending::StretchEnd),
            rest: OnceLock::new(),
            swings: Swings::new(&parameters, scene.solver.end_s),
            parameters,
        };
        motion.begin(point);
        motion
    }

    /// Starts the first stretch.
    fn begin(&mut self, mut point: Point) {
        let parameters = &self.parameters;
        let limit = ON_A_SIDE * parameters.clearance();
        // A closing rate within the round-off of its two contributions counts as zero.
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

    /// Returns the energies up to the present instant.
    fn energies_now(&self) -> Energies {
        let mut energies = self.energies;
        energies.book(
            &self.parameters,
            &self.held,
            &self.stretch,
            self.elapsed(self.run.clock.now),
        );
        energies
    }

    /// Returns the displacements and rates at the present instant.
    fn point_now(&self) -> Point {
        self.stretch.point(&self.parameters, self.elapsed(self.run.clock.now))
    }
}

impl Solver for LinearEvents {
    fn advance_while(&mut self, until: f64, go_on: GoOn<'_>) -> Result<bool, Failure> {
        loop {
            if let Some(failure) = &self.run.failure {
                return Err(failure.clone());
            }
            if self.next.0 > self.elapsed(until) {
                self.run.clock.arrive(until);
                if !self.held.rows.is_empty() {
                    self.run.log.touch(self.run.clock.now, self.run.log.active_set);
                }
                return Ok(true);
            }
            if self.run.looks.is_multiple_of(LOOKS_UNASKED) && !go_on() {
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
        let turn = Plane::cis(self.phase + self.parameters.nu * s);
        let (u, v) = (point.z * turn, self.parameters.carried(&point) * turn);
        State {
            t_s: self.run.clock.now,
            u: [u.re, u.im],
            v: [v.re, v.im],
            alpha: [point.a.re, point.a.im],
            alpha_rate: [point.da.re, point.da.im],
        }
    }

    fn blade_gaps(&self) -> Vec<f64> {
        let (parameters, point) = (&self.parameters, self.point_now());
        let polygon = &parameters.machine.polygon;
        let gap = |(blade, angle): (u32, f64)| {
            let (cos, sin) = polygon.direction(polygon.side_of_blade(blade));
            let open = parameters.clearance() + cos * point.z.re + sin * point.z.im;
            let unevenness = parameters.machine.uneven_at(blade - 1, 0.0);
            open + unevenness - parameters.arm() * angle
        };
        (1..=polygon.blades).zip(self.blade_angles()).map(gap).collect()
    }

    fn multipliers(&self) -> Vec<(u32, f64)> {
        let mass = self.parameters.machine.casing_mass;
        let pushes = self.held.with(self.stretch.pushes_at(self.elapsed(self.run.clock.now)));
        let mut sides: Vec<(u32, f64)> =
            pushes.map(|(row, push)| (row as u32, -push * mass)).collect();
        in_phase_order(&self.parameters.machine.polygon, &mut sides);
        sides
    }

    fn over(&self) -> bool {
        self.stretch.free
    }

    fn final_verdict(&self) -> Option<Verdict> {
        if let Some(failure) = &self.run.failure {
            Some(failure.verdict_beyond(&self.run.pulse))
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
        &self.parameters.machine
    }

    fn rotor(&self) -> &Rotor {
        &self.run.rotor
    }

    fn events(&self) -> Option<u64> {
        Some(self.run.events)
    }

    fn swing(&self) -> f64 {
        let rise = self.machine().radial_coupling * self.machine().blade_length;
        rise.abs() * self.swings.lasting()
    }

    fn linearised(&self) -> bool {
        self.parameters.blades.is_some()
    }

    fn failure(&self) -> Option<&Failure> {
        self.run.failure.as_ref()
    }

    fn checks(&self) -> Checks {
        let (s, parameters) = (self.elapsed(self.run.clock.now), &self.parameters);
        let residual = self.energies_now().residual(parameters.energy(&self.point_now()));
        Checks {
            max_penetration_m: self.run.deepest,
            max_blade_angle_rad: self.widest_until(s),
            energy_residual_j: Some(parameters.machine.casing_mass * residual),
            ..Checks::default()
        }
    }

    fn energy_account(&self) -> Option<EnergyAccount> {
        let mass = self.parameters.machine.casing_mass;
        let energies = self.run.checked.then(|| self.energies_now())?;
        let stored = self.parameters.energy(&self.point_now()) - energies.start;
        Some(EnergyAccount {
            pulse_work_j: mass * energies.pulse,
            // The rotor works against friction even with the casing at rest; that part is entirely
            // heat.
            rotor_work_j: mass * (energies.rotor + energies.sliding),
            growth_work_j: mass * energies.growth,
            casing_loss_j: mass * energies.casing,
            blade_loss_j: mass * energies.blades,
            friction_heat_j: mass * (energies.sliding - energies.dragged),
            impact_loss_j: mass * energies.impacts,
            stored_j: mass * stored,
        })
    }

    fn forgo_checks(&mut self) {
        self.run.checked = false;
    }

    fn fire(&mut self) {
        self.swings.forget();
        self.intervene(|motion, _| motion.run.fire());
    }

    /// This solver does not support a ramp and fails if there is one.
    fn set_speed(&mut self, speed: f64, ramp: f64) {
        self.swings.forget();
        self.intervene(|motion, point| {
            motion.run.rotor.change(motion.run.clock.now, speed, ramp);
            motion.change_speed(speed, point);
        });
        if ramp != 0.0 {
            self.fail(0.0, FailureReason::Ramp);
        } else if self.parameters.clearance() <= 0.0 {
            self.fail(0.0, FailureReason::Closed { speed_rad_s: speed });
        }
    }

    fn scale_rate(&mut self, factor: f64) {
        if self.over() || self.held.rows.len() > 1 {
            return;
        }
        self.intervene(|motion, point| {
            let side = motion.held.rows.first().and_then(|&row| motion.parameters.rows.get(row));
            let free = match side {
                None => motion.parameters.carried(point),
                Some(side) => {
                    let along = Plane::i() * side;
                    along * (along.conj() * point.dz).re
                }
            };
            point.dz += free * (factor - 1.0);
        });
    }

    fn scale_tolerance(&mut self, factor: f64) {
        let tolerance = factor * self.parameters.tolerance;
        self.parameters.tolerance = tolerance.clamp(*EVENT_RANGE.start(), *EVENT_RANGE.end());
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
    fn locked(scene: &CheckedScene) -> LinearEvents {
        let parameters = Parameters::new(scene);
        let (machine, nu) = (&parameters.machine, parameters.nu);
        let delta = machine.polygon.delta;
        let stiffness = machine.casing_stiffness - nu * nu * machine.casing_mass;
        let casing = parameters.turn / Plane::new(stiffness, nu * machine.casing_damping);
        let bending = machine.blade_modal_stiffness;
        let compliance = casing + machine.coupling_product_at(parameters.speed) / bending;
        let push = -Plane::cis(delta) * machine.clearance() / (compliance * delta.cos());
        let slope = machine.radial_coupling + parameters.friction;
        let (z, a) = (casing * push, -push * (slope * machine.blade_length / bending));
        LinearEvents::from_point(scene, parameters, Point { z, a, ..Point::default() })
    }

    #[test]
    fn a_lock_pushes_as_its_closed_form() {
        for (data, [first, second, z, a]) in [
            ([0.1, 0.0, 0.0, 500.0], [258.358348020, 55.600932525, 1.051647234e-4, 8.308641313e-5]),
            (
                [0.1, 0.15, 0.0, 500.0],
                [282.221918276, 52.075944593, 1.120426576e-4, 2.213009798e-4],
            ),
            (
                [0.0, 0.15, 1.0 / 3.0, 500.0],
                [295.465760024, 4.150702554, 1.010283227e-4, 1.195782347e-4],
            ),
            (
                [-0.05, 0.15, 0.0, 500.0],
                [237.953135565, 57.982055172, 9.907933261e-5, 7.827859089e-5],
            ),
        ] {
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
    fn a_lock_is_kept_above_its_speed_and_lost_below() {
        for ([kappa, mu, casing_friction], speed) in [
            ([0.0, 0.15, 0.05], 489.713631),
            ([0.0, 0.1, 0.1 / 3.0], 454.981573),
            ([0.0, 0.3, 0.1], 787.541069),
            ([0.1, 0.0, 0.0], 414.855),
            ([0.1, 0.15, 0.05], 548.980917),
            ([-0.1, 0.3, 0.0], 406.867471),
        ] {
            let tau = if mu > 0.0 { casing_friction / mu } else { 0.0 };
            // One unit of the last digit given above.
            let digit = if speed == 414.855 { 1e-3 } else { 2e-6 };
            // Very close to the limit a contact force is within round-off, so the lock is not
            // proved.
            for (at, kept) in [(speed + digit, true), (speed - digit, false), (speed + 0.5, true)] {
                let mut motion = locked(&scene(&keys([kappa, mu, tau, at])));
                motion.advance(0.3).unwrap();
                let held = motion.contacts().active_set == ActiveSet::Corner(0, 1);
                assert_eq!(held, kept, "{kappa} {mu} {at}: {:?}", motion.contacts());
                let proved = motion.final_verdict() == Some(Verdict::Locked);
                assert!(if at > speed + digit { proved } else { kept || !proved }, "{mu} {at}");
            }
        }
    }

    #[test]
    fn what_is_held_for_good_stays_and_what_swings_too_far_is_not() {
        let scene = scene(&keys([0.1, 0.15, 0.0, 500.0]));
        let calm = locked(&scene);
        let from = *calm.stretch.from();
        let mut proven = 0;
        for k in 0..200 {
            let size = if k == 0 { 0.0 } else { 1e-6 * 1.08_f64.powi(k) };
            let da = Plane::cis(f64::from(k)) * size;
            let point = Point { da, dz: da * calm.parameters.arm(), ..from };
            let mut motion = LinearEvents::from_point(&scene, calm.parameters.clone(), point);
            if motion.final_verdict() == Some(Verdict::Locked) {
                proven += 1;
                motion.advance(0.5).unwrap();
                assert_eq!(motion.contacts().since, 0.0, "{size}");
                assert_eq!(motion.contacts().active_set, ActiveSet::Corner(0, 1));
            }
        }
        assert!((2..200).contains(&proven), "{proven}");
    }

    #[test]
    fn a_growing_motion_is_told_as_one() {
        // Above the flutter speed, which is at most 516 rad/s here.
        let scene = scene(&keys([0.5, 0.0, 0.0, 560.0]));
        let mut motion = locked(&scene);
        let failure = motion.advance(5.0).unwrap_err();
        assert!(matches!(failure.reason, FailureReason::BladeAngle { .. }), "{failure}");
        assert_eq!(motion.final_verdict(), Some(Verdict::Divergent));
    }

    #[test]
    fn a_ramp_is_refused_by_name() {
        let mut motion = LinearEvents::new(&scene(&keys([0.1, 0.0, 0.0, 500.0])));
        motion.set_speed(480.0, 10.0);
        assert_eq!(motion.advance(0.1).unwrap_err().reason, FailureReason::Ramp);
        assert_eq!(motion.final_verdict(), Some(Verdict::Failed));
    }
}
