//! Slip: permanent contact that passes from side to side of the polygon (docs/theory.md, section
//! 5).
//!
//! The state is a single number, the speed just after a corner. A lasting slip is a fixed point of
//! the map from corner to corner; its wave turns slower than the rotor. Above the critical speed
//! the motion along a side has a saddle point. With lengths in `g0`, time in `1/omega_c` and
//! `f = nu/omega_c`:
//!
//! - `y'' + 2 zeta y' + (1 - f^2) y = 2 zeta f`
//! - contact force `N = f^2 - 1 - 2 f y' - 2 zeta f y`, in `k_c g0`
//!
//! Order in which to read: [`slip_over`] (result), `SaddleFlow` (motion on a side),
//! `SaddleFlow::repeating` (the fixed point).

use strum::{Display, IntoStaticStr};

use super::equilibria::changes;
use super::error;
use crate::model::Machine;
use crate::numeric::search::bisected;
use crate::scene::SceneError;

/// Reason why there is no lasting slip at a speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Display, IntoStaticStr)]
#[strum(serialize_all = "kebab-case")]
pub enum NoSlip {
    /// The angle between neighbouring sides is a right angle or less (`N' <= 4`): the impact at a
    /// corner stops the wave.
    StopsAtCorner,
    /// The speed is not above the critical speed, so nothing presses the wave onto the polygon.
    BelowCritical,
    /// The drag is zero, or too small to replace the speed that is lost at the corners.
    NoDrive,
    /// A pull would be needed to keep the wave on a side.
    Lifts,
    /// The blades have grown so that there is no clearance.
    Closed,
}

/// A lasting slip: the periodic motion from corner to corner.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipOrbit {
    /// Rotational speed of the casing wave, its frequency divided by `n_d`; between zero and the
    /// rotor speed \[rad/s\].
    pub wave_speed_rad_s: f64,
    /// Time to cross one side \[s\].
    pub period_s: f64,
    /// Speed along the side just after a corner \[m/s\].
    pub speed_after_corner_m_s: f64,
    /// Speed along the side just before the next corner \[m/s\].
    pub speed_before_corner_m_s: f64,
    /// Slope of the map at the fixed point, `cos^2(2 delta) exp(-2 zeta_c omega_c T)`. It is below
    /// one, so slip is stable where it exists.
    pub slope: f64,
    /// Smallest contact force along a side; a negative value would be a pull \[N\].
    pub least_push_n: f64,
    /// Impulse of the impact on the next side at a corner \[N s\].
    pub corner_impulse_ns: f64,
    /// Mean torque of the rotor, including the impulses \[N m\].
    pub torque_nm: f64,
    /// Mean power of the rotor \[W\].
    pub power_w: f64,
    /// Mean power dissipated by the casing damping \[W\].
    pub damper_power_w: f64,
    /// Mean power lost at the corners \[W\].
    pub corner_power_w: f64,
}

/// Slip at one rotor speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipPoint {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// The lasting slip, or the reason why there is none.
    pub outcome: Result<SlipOrbit, NoSlip>,
}

impl SlipPoint {
    /// Returns whether there is a lasting slip held by pushes.
    #[must_use]
    pub fn exists(&self) -> bool {
        self.outcome.is_ok()
    }

    /// Returns whether neighbouring motions converge to the slip.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.outcome.is_ok_and(|orbit| orbit.slope.abs() < 1.0)
    }
}

/// Computes lasting slip for a list of rotor speeds \[rad/s\].
///
/// # Errors
/// The polygon has no corners, the tips act on the casing otherwise than in the paper, there is no
/// clearance, or a speed is not finite.
pub fn slip_over(machine: &Machine, speeds: &[f64]) -> Result<Vec<SlipPoint>, SceneError> {
    refuse(machine, speeds)?;
    Ok(speeds.iter().map(|&speed| point(machine, speed)).collect())
}

/// Rejects machines without these equations, and speeds that are not finite.
fn refuse(machine: &Machine, speeds: &[f64]) -> Result<(), SceneError> {
    error::refuse_tips_on_casing(machine, "slip")?;
    error::refuse_preload(&machine.at(0.0))?;
    error::refuse_no_corner(&machine.polygon)?;
    error::refuse_endless(speeds)
}

/// A speed at which slip appears or vanishes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipLimit {
    /// Rotor speed, to the last digit \[rad/s\].
    pub speed_rad_s: f64,
    /// Whether slip exists above this speed and not below.
    pub appears: bool,
}

/// Returns the speeds at which slip appears or vanishes, within the range of a list of speeds
/// \[rad/s\].
///
/// # Errors
/// As [`slip_over`].
pub fn slip_limits(machine: &Machine, speeds: &[f64]) -> Result<Vec<SlipLimit>, SceneError> {
    refuse(machine, speeds)?;
    let found = changes(speeds, &|speed| Ok(point(machine, speed).exists()))?;
    let limit = |(speed_rad_s, _, appears)| SlipLimit { speed_rad_s, appears };
    Ok(found.into_iter().map(limit).collect())
}

/// Returns the periodic arc at a speed, if contact can hold it all along.
fn repeating(machine: &Machine, speed: f64) -> Result<(SaddleFlow, Arc), NoSlip> {
    if machine.at(speed).clearance() <= 0.0 {
        return Err(NoSlip::Closed);
    }
    let slide = SaddleFlow::at(machine, speed).ok_or(NoSlip::BelowCritical)?;
    if slide.kept <= 0.0 {
        return Err(NoSlip::StopsAtCorner);
    }
    let arc = slide.repeating().ok_or(NoSlip::NoDrive)?;
    // NaN from an overflow counts as lift-off, too.
    if slide.least_push(&arc) >= 0.0 { Ok((slide, arc)) } else { Err(NoSlip::Lifts) }
}

fn point(machine: &Machine, speed: f64) -> SlipPoint {
    let machine = &*machine.at(speed);
    let outcome = repeating(machine, speed).map(|(slide, arc)| orbit(machine, speed, &slide, &arc));
    SlipPoint { speed_rad_s: speed, outcome }
}

/// Converts an arc to units, with its mean torque and powers, in which a side of the length `2 end`
/// takes the time `T`. The damping dissipates `2 zeta int |u'|^2`, with `|u'|^2 = (y' - f)^2 + f^2 y^2`.
/// The equation of motion, integrated over the arc alone, times `y'` and times `y`, gives
///
/// - `(1 - f^2) int y = 2 zeta f T - [y'] - 4 zeta end`
/// - `2 zeta int y'^2 = 4 zeta f end - [y'^2]/2`
/// - `(1 - f^2) int y^2 = 2 zeta f int y + int y'^2 - [y y']`
///
/// because `y` goes from `-end` to `end`. The rotor supplies what damping and corners take.
fn orbit(machine: &Machine, speed: f64, slide: &SaddleFlow, arc: &Arc) -> SlipOrbit {
    let &SaddleFlow { zeta, ratio: f, end, kept, struck, .. } = slide;
    let [after, before] = slide.end_speeds(arc);
    let pull = (1.0 - f) * (1.0 + f);
    let way = (2.0 * zeta * (f * arc.time - 2.0 * end) - (before - after)) / pull;
    let rates = 2.0 * f * end - (before - after) * (before + after) / (4.0 * zeta);
    let squares = (2.0 * zeta * f * way + rates - end * (before + after)) / pull;
    let against = rates - 4.0 * f * end + f * f * (arc.time + squares);
    let (length, impulse) = (machine.clearance(), before * struck);
    let force = machine.casing_stiffness * length;
    let power = force * length * machine.omega_c / arc.time;
    let (damper_power_w, corner_power_w) =
        (power * 2.0 * zeta * against, power * 0.5 * impulse * impulse);
    let power_w = damper_power_w + corner_power_w;
    let drift = 2.0 * machine.polygon.delta * machine.omega_c / arc.time / machine.nodal_diameters;
    SlipOrbit {
        wave_speed_rad_s: speed - speed.signum() * drift,
        period_s: arc.time / machine.omega_c,
        speed_after_corner_m_s: after * machine.omega_c * length,
        speed_before_corner_m_s: before * machine.omega_c * length,
        slope: kept * kept * (-2.0 * zeta * arc.time).exp(),
        least_push_n: slide.least_push(arc) * force,
        corner_impulse_ns: impulse * force / machine.omega_c,
        torque_nm: power_w / speed,
        power_w,
        damper_power_w,
        corner_power_w,
    }
}

/// Motion along one side above the critical speed, dimensionless.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SaddleFlow {
    zeta: f64,
    /// Speed ratio `nu/omega_c`, above one.
    ratio: f64,
    /// Half the length of the side in units of `g0`, `tan delta`.
    end: f64,
    /// Position `y*` of the saddle point along the side, in units of `g0`.
    saddle: f64,
    /// Growing and decaying eigenvalue `s+`, `s-` of the saddle point, in units of `omega_c`.
    roots: [f64; 2],
    /// Factor on the speed at a corner, `cos 2 delta`; 0 if the corner stops the wave.
    kept: f64,
    /// Impulse of the impact at a corner per unit of the speed before it, `sin 2 delta`.
    struck: f64,
}

/// Motion from corner to corner, `y = y* + grow e^(s+ t) + decay e^(s- t)` for `0 <= t <= time`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Arc {
    grow: f64,
    decay: f64,
    time: f64,
}

impl SaddleFlow {
    /// Creates the flow at the magnitude of a rotor speed \[rad/s\]; `None` without corners, and up
    /// to the critical speed.
    fn at(machine: &Machine, speed: f64) -> Option<Self> {
        let zeta = machine.casing_damping_ratio;
        let ratio = machine.nu(speed).abs() / machine.omega_c;
        let excess = (ratio - 1.0) * (ratio + 1.0);
        if !machine.polygon.has_corners() || excess <= 0.0 {
            return None;
        }
        let delta = machine.polygon.delta;
        let root = (zeta * zeta + excess).sqrt();
        // The growing root as a quotient, which avoids cancellation.
        let roots = [excess / (root + zeta), -root - zeta];
        let saddle = -2.0 * zeta * ratio / excess;
        let (struck, kept) = (2.0 * delta).sin_cos();
        // For N' <= 4 the impact at a corner stops the wave.
        let kept = if machine.polygon.sides <= 4 { 0.0 } else { kept };
        let slide = Self { zeta, ratio, end: delta.tan(), saddle, roots, kept, struck };
        saddle.is_finite().then_some(slide)
    }

    /// Returns the speed just after a corner below which the wave turns back before the next one:
    /// the stable manifold of the saddle point.
    fn least_speed(&self) -> f64 {
        (self.roots[1] * (-self.end - self.saddle)).max(0.0)
    }

    /// Returns position and speed at a time on an arc.
    fn state(&self, arc: &Arc, time: f64) -> (f64, f64) {
        let [up, down] = self.roots;
        let (grow, decay) = (arc.grow * (up * time).exp(), arc.decay * (down * time).exp());
        (self.saddle + grow + decay, grow * up + decay * down)
    }

    /// Returns the contact force at a position and speed; a negative value would be a pull.
    fn push(&self, y: f64, speed: f64) -> f64 {
        let f = self.ratio;
        (f - 1.0) * (f + 1.0) - 2.0 * f * speed - 2.0 * self.zeta * f * y
    }

    /// Returns the smallest contact force on an arc.
    fn least_push(&self, arc: &Arc) -> f64 {
        let at = |time| {
            let (y, speed) = self.state(arc, time);
            self.push(y, speed)
        };
        let ends = at(0.0).min(at(arc.time));
        // N' = 0 where grow s+ (s+ + zeta) e^(s+ t) = -decay s- (s- + zeta) e^(s- t).
        let [up, down] = self.roots;
        let ratio = -(arc.decay * down * (down + self.zeta)) / (arc.grow * up * (up + self.zeta));
        let time = ratio.ln() / (up - down);
        if time > 0.0 && time < arc.time { ends.min(at(time)) } else { ends }
    }

    /// Returns the arc from corner to corner that takes a given time.
    fn in_time(&self, time: f64) -> Arc {
        let [up, down] = self.roots;
        let (start, stop) = (-self.end - self.saddle, self.end - self.saddle);
        let (shrunk_up, shrunk_down) = ((-up * time).exp(), (down * time).exp());
        // grow e^(s+ t), the larger of the two terms, is computed first to avoid overflow.
        let grown = (stop - start * shrunk_down) / (1.0 - shrunk_down * shrunk_up);
        let grow = grown * shrunk_up;
        Arc { grow, decay: start - grow, time }
    }

    /// Returns the speeds at the beginning and at the end of an arc.
    fn end_speeds(&self, arc: &Arc) -> [f64; 2] {
        [self.state(arc, 0.0).1, self.state(arc, arc.time).1]
    }

    /// Returns the periodic arc, on which the drag restores the speed that is lost at a corner;
    /// `None` if there is none. At most one exists, because the slope of the map is below one
    /// there.
    fn repeating(&self) -> Option<Arc> {
        let [up, _] = self.roots;
        // The slowest crossing follows the manifolds of the saddle point.
        let slowest_gains = self.kept * up * (self.end - self.saddle) > self.least_speed();
        if !slowest_gains {
            return None;
        }
        let gains = |time: f64| {
            let [after, before] = self.end_speeds(&self.in_time(time));
            self.kept * before >= after
        };
        let time = first_time(gains, 1e-3 * self.end / self.ratio)?;
        Some(self.in_time(time))
    }
}

/// Returns the first time from which a condition is true, to the last digit: doubling from `guess`,
/// then bisection. `None` if it is still false at the largest number.
fn first_time(holds: impl Fn(f64) -> bool, guess: f64) -> Option<f64> {
    let (mut below, mut above) = (0.0, guess);
    while !holds(above) {
        (below, above) = (above, 2.0 * above);
        // Not even a guess of zero goes on for ever.
        if !above.is_normal() {
            return None;
        }
    }
    let [below, above] = bisected([below, above], holds);
    Some(0.5 * (below + above))
}
