//! What a coincidence does, against speed (docs/theory.md, section 10): how fast a wave
//! grows where blades rub at rest, and the wave that lasts. The picture that the last
//! page of the paper promises.

use serde::Serialize;

use super::{HarmonicError, Joint, Lining, RimWave, Whirl, lock_roots, rim_waves};
use crate::model::Machine;
use crate::scene::{ContactLaw, Scene};

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

/// The coincidence of a scene over speeds \[rad/s\]. Under preload the wave is what rest
/// grows into; over a clearance it is one that a large enough pulse leaves behind.
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
        if !speed.is_finite() {
            return Err(HarmonicError::Speed(speed));
        }
        if smooth { on_lining(&lining, speed) } else { Ok(on_rim(&machine, speed)) }
    };
    speeds.iter().map(point).collect()
}

/// The coincidence that the lining of a scene shifts, for a rotor that turns in the sense
/// of `speed` \[rad/s\]; none where no blade rubs at rest.
#[must_use]
pub fn shifted_coincidence(scene: &Scene, speed: f64) -> Option<f64> {
    let machine = scene.machine();
    let lining = Lining::of(&machine, &scene.contact).ok()?;
    let smooth = scene.solver.contact == ContactLaw::Smooth;
    let found = smooth.then(|| lining.shifted_coincidence(speed)).flatten()?;
    Some(found.speed_rad_s)
}

fn on_lining(lining: &Lining, speed: f64) -> Result<CoincidencePoint, HarmonicError> {
    let rubs = lining.stiffness_at_rest() > 0.0;
    let whirl = lining.whirl(speed)?;
    let cycle = match whirl {
        Whirl::Cycle(cycle) => Some(cycle),
        Whirl::Decays | Whirl::Unbounded | Whirl::Unsteady => None,
    };
    Ok(CoincidencePoint {
        speed_rad_s: speed,
        growth_1_s: rubs.then(|| lining.rest(speed).worst().growth_1_s),
        blade_amplitude_rad: cycle.map(|cycle| cycle.blade_rad),
        casing_amplitude_m: cycle.map(|cycle| cycle.casing_m),
        omega_rad_s: cycle.map(|cycle| cycle.omega_rad_s),
        bounded: lining.is_bounded(speed),
    })
}

/// Rigid contact: the wave that attracts has the amplitude of the clearance. Waves stay
/// bounded unless the structures flutter as one.
fn on_rim(machine: &Machine, speed: f64) -> CoincidencePoint {
    let joint = Joint::at(machine, speed);
    let wave = RimWave::lasting(&rim_waves(&joint));
    let clearance = machine.clearance();
    CoincidencePoint {
        speed_rad_s: speed,
        growth_1_s: None,
        blade_amplitude_rad: wave.map(|wave| wave.blades_per_w * clearance),
        casing_amplitude_m: wave.map(|wave| wave.casing_per_w * clearance),
        omega_rad_s: wave.map(|wave| wave.omega_rad_s),
        bounded: lock_roots(&joint).iter().all(|root| root.re <= 0.0),
    }
}
