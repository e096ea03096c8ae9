//! Coincidences of casing and blades: where the lines of a Campbell diagram cross, Eq. (30)
//! (docs/theory.md, section 4), and what they do against speed, the picture that the last
//! page of the paper promises: how fast a wave grows where blades rub at rest, and the wave
//! that lasts (section 10).

use serde::Serialize;

use super::{HarmonicError, Joint, Lining, RoundWhirl, error, lock_roots, round_whirls};
use crate::model::Machine;
use crate::numeric::is_zero;
use crate::scene::{ContactLaw, Scene};

/// A line `frequency = +-sqrt(at_standstill^2 + stiffening Omega^2) + slope * Omega`.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// What it is.
    pub name: String,
    /// At standstill \[rad/s\].
    pub at_standstill_rad_s: f64,
    /// Change with the rotor speed.
    pub slope: f64,
    /// Centrifugal stiffening `B` of the blades, which bends their lines.
    #[serde(skip_serializing_if = "is_zero")]
    pub stiffening: f64,
}

impl Line {
    /// Returns the frequency at a rotor speed \[rad/s\]; negative for a wave that turns
    /// backward in the standing frame.
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

/// One of the coincidences of Eq. (30), `casing = n_d Omega + blades`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Coincidence {
    /// `+omega_c` or `-omega_c` \[rad/s\].
    pub casing_rad_s: f64,
    /// `+omega_bd` or `-omega_bd`, at that speed \[rad/s\].
    pub blades_rad_s: f64,
    /// Rotor speed where they coincide \[rad/s\]; negative for the other sense
    /// of rotation.
    pub speed_rad_s: f64,
    /// Whether it is the dangerous one of the rotor's sense of rotation, Eq. (31).
    pub dangerous: bool,
}

/// The lines of a Campbell diagram.
#[derive(Clone, Debug, PartialEq)]
pub struct Campbell {
    /// Casing, bladed disk forward and backward, then engine orders.
    pub lines: Vec<Line>,
    /// The coincidences: four, unless blades stiffen so much that there are more or less.
    pub coincidences: Vec<Coincidence>,
}

impl Campbell {
    /// Creates the lines, with those of these engine orders, `order * Omega`. The dangerous
    /// coincidence is that of a rotor that turns in the sense of `speed`.
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
    /// No nodal diameters, so no travelling waves.
    pub fn of(machine: &Machine, orders: &[u32], speed: f64) -> Result<Self, HarmonicError> {
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
            // The two directions of every wave exchange with the sense of rotation.
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

/// Growth and lasting wave at one rotor speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct CoincidencePoint {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// Growth of the worst motion about rest, where all blades rub there; none with a
    /// clearance, where rest is always stable \[1/s\].
    pub growth_1_s: Option<f64>,
    /// Amplitude of the blades in the wave that lasts; none where every wave decays, and
    /// where none is large enough to last \[rad\].
    pub blade_amplitude_rad: Option<f64>,
    /// Amplitude of the casing in it \[m\].
    pub casing_amplitude_m: Option<f64>,
    /// Its frequency in the standing frame \[rad/s\].
    pub omega_rad_s: Option<f64>,
    /// Whether waves of any amplitude stay bounded in this model.
    pub bounded: bool,
}

/// Computes the coincidence of a scene over speeds \[rad/s\]. Under preload the wave is what
/// rest grows into; over a clearance it is one that a large enough pulse leaves behind.
///
/// # Errors
/// A machine without a travelling wave of blades and casing, or a speed that is not
/// finite.
pub fn coincidence(scene: &Scene, speeds: &[f64]) -> Result<Vec<CoincidencePoint>, HarmonicError> {
    let machine = scene.machine();
    // Also refuses what has no wave with rigid contact.
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

/// Returns the coincidence that the lining of a scene shifts, for a rotor that turns in the
/// sense of `speed` \[rad/s\]; none where no blade rubs at rest.
#[must_use]
pub fn shifted_coincidence(scene: &Scene, speed: f64) -> Option<f64> {
    let machine = scene.machine();
    let lining = Lining::of(&machine, &scene.contact).ok()?;
    let smooth = scene.solver.contact == ContactLaw::Smooth;
    smooth.then(|| lining.shifted_coincidence(speed)).flatten()
}

fn on_lining(lining: &Lining, speed: f64) -> Result<CoincidencePoint, HarmonicError> {
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

/// Computes the wave on a rigid casing: the one that attracts has the amplitude of the
/// clearance. Waves stay bounded unless the structures flutter as one.
fn on_rigid_casing(machine: &Machine, speed: f64) -> CoincidencePoint {
    let joint = Joint::at(machine, speed);
    let clearance = joint.machine.clearance();
    let wave = RoundWhirl::lasting(&round_whirls(&joint)).filter(|_| clearance > 0.0);
    CoincidencePoint {
        speed_rad_s: speed,
        growth_1_s: None,
        blade_amplitude_rad: wave.map(|wave| wave.blades_per_w * clearance),
        casing_amplitude_m: wave.map(|wave| wave.casing_per_w * clearance),
        omega_rad_s: wave.map(|wave| wave.omega_rad_s),
        bounded: lock_roots(&joint).iter().all(|root| root.re <= 0.0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::Scene;

    #[test]
    fn lines_cross_at_the_coincidences() {
        let machine = Scene::base().machine();
        let campbell = Campbell::of(&machine, &[1, 3], 500.0).unwrap();
        assert_eq!(campbell.lines.len(), 6);
        for found in &campbell.coincidences {
            let casing = if found.casing_rad_s > 0.0 { 0 } else { 1 };
            let blades = if found.blades_rad_s > 0.0 { 2 } else { 3 };
            let gap = campbell.lines[casing].at(found.speed_rad_s)
                - campbell.lines[blades].at(found.speed_rad_s);
            assert!(gap.abs() < 1e-12 * machine.omega_c);
        }
        for speed in [500.0, -430.0] {
            let campbell = Campbell::of(&machine, &[], speed).unwrap();
            let dangerous: Vec<_> = campbell.coincidences.iter().filter(|c| c.dangerous).collect();
            assert_eq!(dangerous.len(), 1);
            let expected = machine.dangerous_speed_toward(speed);
            assert_eq!(Some(dangerous[0].speed_rad_s), expected);
            assert!(expected.unwrap() * speed > 0.0);
        }
        let mut positive: Vec<f64> = campbell
            .coincidences
            .iter()
            .map(|c| c.speed_rad_s)
            .filter(|&speed| speed > 0.0)
            .collect();
        positive.sort_by(f64::total_cmp);
        assert_eq!(positive, machine.coincidence_speeds());
    }

    #[test]
    fn without_nodal_diameters_there_is_no_wave() {
        let mut scene = Scene::base();
        scene.set("operation.nodal_diameters", "0").unwrap();
        let message = Campbell::of(&scene.machine(), &[], 500.0).unwrap_err().to_string();
        assert!(message.starts_with("operation.nodal_diameters = 0: allowed is 1 or more"));
    }
}
