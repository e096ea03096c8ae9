//! Coincidences of casing and disk: the intersections in a Campbell diagram, Eq. (30)
//! (docs/theory.md, section 4), and their effect as a function of speed, which the paper leaves to
//! later work: the growth rate if blades rub at rest, and the wave that persists (section 10).

use super::{Lining, RoundWhirl, error, joined_grow};
use crate::model::Machine;
use crate::scene::{ContactLaw, Scene, SceneError};

/// Line of a Campbell diagram, `frequency = +-sqrt(at_standstill^2 + stiffening Omega^2) + slope
/// Omega`, with the sign of `at_standstill`.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Label: the formula of the line, such as `n_d Omega + omega_bd`.
    pub name: String,
    /// Frequency at standstill \[rad/s\].
    pub at_standstill_rad_s: f64,
    /// Slope with respect to the rotor speed.
    pub slope: f64,
    /// Centrifugal stiffening `B`, which makes the lines of the blades curved.
    pub stiffening: f64,
}

impl Line {
    /// Returns the frequency at a rotor speed \[rad/s\]; negative for a wave that turns backward in
    /// the stationary frame.
    #[must_use]
    pub fn at(&self, speed: f64) -> f64 {
        let own = if self.stiffening == 0.0 {
            self.at_standstill_rad_s
        } else {
            self.at_standstill_rad_s
                .hypot(self.stiffening.sqrt() * speed)
                .copysign(self.at_standstill_rad_s)
        };
        own + self.slope * speed
    }
}

/// A coincidence of Eq. (30), `casing = n_d Omega + blades`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Coincidence {
    /// Casing frequency, `+omega_c` or `-omega_c` \[rad/s\].
    pub casing_rad_s: f64,
    /// Blade frequency at that speed, `+omega_bd` or `-omega_bd` \[rad/s\].
    pub blades_rad_s: f64,
    /// Rotor speed of the coincidence; negative for backward rotation \[rad/s\].
    pub speed_rad_s: f64,
    /// Whether it is the dangerous one for the rotor's direction, Eq. (31).
    pub dangerous: bool,
}

/// Lines and coincidences of a Campbell diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Campbell {
    /// Lines of the casing, the disk (forward and backward), and the engine orders.
    pub lines: Vec<Line>,
    /// Coincidences: four, unless centrifugal stiffening adds or removes some.
    pub coincidences: Vec<Coincidence>,
}

impl Campbell {
    /// Creates the diagram with the given engine orders, `order Omega`. The direction of rotation,
    /// which decides on the dangerous coincidence, is the sign of `speed`.
    ///
    /// ```
    /// use rubscope_solver::harmonic::Campbell;
    /// use rubscope_solver::scene::Scene;
    /// let machine = Scene::builtin("paper-nd3")?.machine();
    /// let campbell = Campbell::of(&machine, &[3], 500.0)?;
    /// let dangerous = campbell.coincidences.iter().find(|c| c.dangerous).unwrap();
    /// assert!((dangerous.speed_rad_s - 388.31).abs() < 0.005);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// `n_d = 0`, so that there are no travelling waves.
    pub fn of(machine: &Machine, orders: &[u32], speed: f64) -> Result<Self, SceneError> {
        let n_d = machine.nodal_diameters;
        error::refuse_no_wave(machine)?;
        let (omega_c, omega_bd) = (machine.omega_c, machine.omega_bd_at_rest());
        let sense = if speed < 0.0 { -1.0 } else { 1.0 };
        let line = |name: &str, at_standstill_rad_s, slope, stiffening| Line {
            name: name.to_string(),
            at_standstill_rad_s,
            slope,
            stiffening,
        };
        let stiffening = machine.stiffening();
        let mut lines = vec![
            line("omega_c", omega_c, 0.0, 0.0),
            line("-omega_c", -omega_c, 0.0, 0.0),
            line("n_d Omega + omega_bd", omega_bd, n_d, stiffening),
            line("n_d Omega - omega_bd", -omega_bd, n_d, stiffening),
        ];
        lines.extend(
            orders.iter().map(|&order| line(&format!("{order} Omega"), 0.0, f64::from(order), 0.0)),
        );
        let coincidence = |turns: f64, blades: f64, speed: f64| Coincidence {
            casing_rad_s: turns * omega_c,
            blades_rad_s: blades * machine.at(speed).omega_bd,
            speed_rad_s: turns * speed,
            // Backward rotation exchanges the two directions of every wave.
            dangerous: turns * sense > 0.0 && blades * sense < 0.0,
        };
        let (differences, sum) = machine.meetings(omega_c, omega_bd);
        let of_difference =
            |turns| differences.iter().map(move |&speed| coincidence(turns, turns, speed));
        let of_sum = |turns| sum.map(|speed| coincidence(turns, -turns, speed));
        let coincidences =
            of_difference(1.0).chain(of_sum(1.0)).chain(of_sum(-1.0)).chain(of_difference(-1.0));
        let coincidences = coincidences.collect();
        Ok(Self { lines, coincidences })
    }
}

/// Growth rate and persistent wave at one rotor speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CoincidencePoint {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Growth rate of the least stable motion about rest, if all blades rub at rest; `None` with a
    /// clearance, where rest is always stable \[1/s\].
    pub growth_1_s: Option<f64>,
    /// Blade amplitude of the wave that persists; `None` if every wave decays \[rad\].
    pub blade_amplitude_rad: Option<f64>,
    /// Casing amplitude of the wave that persists; `None` if every wave decays \[m\].
    pub casing_amplitude_m: Option<f64>,
    /// Frequency of the wave that persists, in the stationary frame; `None` if every wave decays
    /// \[rad/s\].
    pub omega_rad_s: Option<f64>,
    /// Whether waves of any amplitude stay bounded in this model.
    pub bounded: bool,
}

/// Computes growth rate and persistent wave of a scene for a list of speeds \[rad/s\]. With
/// preload the wave grows from rest; with a clearance a sufficiently large pulse starts it.
///
/// # Errors
/// Blades and casing are not coupled by a single travelling wave, or a speed is not finite.
pub fn coincidence(scene: &Scene, speeds: &[f64]) -> Result<Vec<CoincidencePoint>, SceneError> {
    let machine = scene.machine();
    // Created for rigid contact, too, because it checks the machine.
    let lining = Lining::of(&machine, &scene.contact)?;
    let smooth = scene.solver.contact == ContactLaw::Smooth;
    let point = |&speed: &f64| {
        error::refuse_endless(&[speed])?;
        if smooth {
            on_lining(&lining.at(speed), speed)
        } else {
            Ok(on_rigid_casing(&machine, speed))
        }
    };
    speeds.iter().map(point).collect()
}

/// Returns the coincidence as shifted by the lining of a scene, for a rotor that turns in the
/// direction of the sign of `speed` \[rad/s\]. `None` for rigid contact, if no blade rubs at rest,
/// and if casing and blades are not coupled by a single travelling wave.
#[must_use]
pub fn shifted_coincidence(scene: &Scene, speed: f64) -> Option<f64> {
    let machine = scene.machine();
    let lining = Lining::of(&machine, &scene.contact).ok()?;
    let smooth = scene.solver.contact == ContactLaw::Smooth;
    smooth.then(|| lining.shifted_coincidence(speed)).flatten()
}

fn on_lining(lining: &Lining, speed: f64) -> Result<CoincidencePoint, SceneError> {
    let rubs = lining.stiffness_at_rest() > 0.0;
    let cycle = lining.cycles(speed)?.into_iter().find(|cycle| cycle.stable);
    Ok(CoincidencePoint {
        speed_rad_s: speed,
        growth_1_s: rubs.then(|| lining.rest(speed).worst().growth_1_s),
        blade_amplitude_rad: cycle.map(|cycle| cycle.blade_rad),
        casing_amplitude_m: cycle.map(|cycle| cycle.casing_m),
        omega_rad_s: cycle.map(|cycle| cycle.omega_rad_s),
        bounded: lining.is_bounded(speed),
    })
}

/// Computes the wave for rigid contact: the gaps of the attracting wave have the amplitude of the
/// clearance. Waves stay bounded unless casing and blades flutter in lasting contact.
fn on_rigid_casing(machine: &Machine, speed: f64) -> CoincidencePoint {
    let clearance = machine.at(speed).clearance();
    let wave = RoundWhirl::lasting(machine, speed);
    CoincidencePoint {
        speed_rad_s: speed,
        growth_1_s: None,
        blade_amplitude_rad: wave.map(|wave| wave.blades_per_w * clearance),
        casing_amplitude_m: wave.map(|wave| wave.casing_per_w * clearance),
        omega_rad_s: wave.map(|wave| wave.omega_rad_s),
        bounded: !joined_grow(machine, speed),
    }
}
