//! Slip on a polygon with corners: permanent contact, side after side
//! (docs/theory.md, section 5). Its state is one number, the speed just after a
//! corner; a lasting slip is a fixed point of the map from corner to corner, and its
//! wave turns slower than the rotor.
//!
//! Above the critical speed sliding along a side is a saddle. With lengths in `g0`, time in
//! `1/omega_c` and `f = nu/omega_c`:
//!
//! - `y'' + 2 zeta y' + (1 - f^2) y = 2 zeta f`
//! - push `N = f^2 - 1 - 2 f y' - 2 zeta f y`, in `k_c g0`

use serde::Serialize;
use strum::{Display, IntoStaticStr};

use super::equilibria::changes;
use super::{HarmonicError, error};
use crate::model::Machine;
use crate::numeric::bisection::bisected;

/// Why there is no lasting slip at some speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Display, IntoStaticStr)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum NoSlip {
    /// Corners of a right angle or less (`N' <= 4`) stop the wave.
    StopsAtCorner,
    /// Not above the critical speed: nothing presses the wave on the sides of
    /// the polygon.
    BelowCritical,
    /// Nothing replaces the speed that corners take: the drag is zero, or too
    /// small to pass the saddle.
    NoDrive,
    /// The wave would have to be pulled to stay on a side.
    Lifts,
    /// Blades have grown into the casing.
    Closed,
}

/// A lasting slip.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SlipOrbit {
    /// Angular speed of the casing wave over `n_d`; between zero and the
    /// rotor's \[rad/s\].
    pub wave_speed_rad_s: f64,
    /// Time to cross one side \[s\].
    pub period_s: f64,
    /// Speed along the side just after a corner \[m/s\].
    pub speed_after_corner_m_s: f64,
    /// Speed along the side just before the next corner \[m/s\].
    pub speed_before_corner_m_s: f64,
    /// Slope of the map at the fixed point, `cos^2(2 delta) exp(-2 zeta_c
    /// omega_c T)`; below one, so that slip is stable where it exists.
    pub slope: f64,
    /// Smallest push along a side; negative would be a pull \[N\].
    pub least_push_n: f64,
    /// Impulse on the side met at a corner \[N s\].
    pub corner_impulse_ns: f64,
    /// Mean torque the rotor must give, impulses included \[N m\].
    pub torque_nm: f64,
    /// Mean power it takes \[W\].
    pub power_w: f64,
    /// Mean power of the casing's damper \[W\].
    pub damper_power_w: f64,
    /// Mean power lost at the corners \[W\].
    pub corner_power_w: f64,
}

/// Slip at one rotor speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlipPoint {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// The lasting slip, or why there is none.
    pub outcome: Result<SlipOrbit, NoSlip>,
}

impl SlipPoint {
    /// Returns whether there is a lasting slip that contact can hold.
    #[must_use]
    pub fn exists(&self) -> bool {
        self.outcome.is_ok()
    }

    /// Returns whether neighbouring motions converge to it.
    #[must_use]
    pub fn stable(&self) -> bool {
        self.outcome.is_ok_and(|orbit| orbit.slope.abs() < 1.0)
    }
}

/// Computes lasting slip over a list of rotor speeds \[rad/s\].
///
/// # Errors
/// A polygon without corners, or a speed that is not finite.
pub fn slip_over(machine: &Machine, speeds: &[f64]) -> Result<Vec<SlipPoint>, HarmonicError> {
    error::refuse_tips_on_casing(machine, "slip")?;
    error::refuse_preload(&machine.at(0.0))?;
    error::refuse_no_corner(&machine.polygon)?;
    error::refuse_endless(speeds)?;
    Ok(speeds.iter().map(|&speed| point(machine, speed)).collect())
}

/// A speed where slip appears or vanishes.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct SlipLimit {
    /// Where, to the last digit \[rad/s\].
    pub speed_rad_s: f64,
    /// Whether there is slip above it and none below.
    pub appears: bool,
}

/// Returns the speeds between the least and the largest of a list \[rad/s\] where slip
/// appears or vanishes.
///
/// # Errors
/// As `slip_over`.
pub fn slip_limits(machine: &Machine, speeds: &[f64]) -> Result<Vec<SlipLimit>, HarmonicError> {
    slip_over(machine, speeds)?;
    let mut sorted = speeds.to_vec();
    sorted.sort_by(f64::total_cmp);
    let exists = |speed| Ok(point(machine, speed).exists());
    let mut limits = Vec::new();
    for pair in sorted.windows(2) {
        if let [low, high] = *pair {
            let found = changes(low, high, &exists)?;
            limits.extend(
                found.iter().map(|&(speed_rad_s, _, appears)| SlipLimit { speed_rad_s, appears }),
            );
        }
    }
    Ok(limits)
}

/// Returns the repeating arc at a speed, held by contact all along.
fn repeating(machine: &Machine, speed: f64) -> Result<(SaddleFlow, Arc), NoSlip> {
    if machine.at(speed).clearance() <= 0.0 {
        return Err(NoSlip::Closed);
    }
    let slide = SaddleFlow::at(machine, speed).ok_or(NoSlip::BelowCritical)?;
    if slide.kept <= 0.0 {
        return Err(NoSlip::StopsAtCorner);
    }
    let arc = slide.repeating().ok_or(NoSlip::NoDrive)?;
    // NaN, from an overflow, is not a push either.
    if slide.least_push(&arc) >= 0.0 { Ok((slide, arc)) } else { Err(NoSlip::Lifts) }
}

fn point(machine: &Machine, speed: f64) -> SlipPoint {
    let machine = &*machine.at(speed);
    let outcome = repeating(machine, speed).map(|(slide, arc)| orbit(machine, speed, &slide, &arc));
    SlipPoint { speed_rad_s: speed, outcome }
}

/// Units of speed \[m/s\] and force \[N\] of the scaled flow.
struct Units {
    speed: f64,
    force: f64,
}

impl Units {
    fn of(machine: &Machine) -> Self {
        let length = machine.clearance();
        Self { speed: machine.omega_c * length, force: machine.casing_stiffness * length }
    }
}

/// Returns by how much areas of the sliding flow shrink along an arc.
fn contraction(slide: &SaddleFlow, arc: &Arc) -> f64 {
    (-2.0 * slide.zeta * arc.time).exp()
}

fn orbit(machine: &Machine, speed: f64, slide: &SaddleFlow, arc: &Arc) -> SlipOrbit {
    let units = Units::of(machine);
    let [after, before] = slide.end_speeds(arc);
    let impulse = before * slide.struck;
    let means = Means::of(slide, arc);
    // T = sum Lambda A with Lambda = -N, A = n_d y; the impulse comes at y = -end.
    let moment_arm = -means.push_lever + impulse * slide.end / arc.time;
    let unit = units.force * machine.clearance();
    let torque = machine.nodal_diameters * unit * moment_arm * speed.signum();
    let power = unit * machine.omega_c;
    let drift = 2.0 * machine.polygon.delta * machine.omega_c / arc.time / machine.nodal_diameters;
    SlipOrbit {
        wave_speed_rad_s: speed - speed.signum() * drift,
        period_s: arc.time / machine.omega_c,
        speed_after_corner_m_s: after * units.speed,
        speed_before_corner_m_s: before * units.speed,
        slope: slide.kept * slide.kept * contraction(slide, arc),
        least_push_n: slide.least_push(arc) * units.force,
        corner_impulse_ns: impulse * units.force / machine.omega_c,
        torque_nm: torque,
        power_w: torque * speed,
        damper_power_w: power * 2.0 * slide.zeta * means.rate_square,
        corner_power_w: power * 0.5 * impulse * impulse / arc.time,
    }
}

/// Means over an arc, from integrals of products of exponentials.
struct Means {
    /// Of `N y`.
    push_lever: f64,
    /// Of `|u'|^2 = (y' - f)^2 + f^2 y^2`.
    rate_square: f64,
}

impl Means {
    fn of(slide: &SaddleFlow, arc: &Arc) -> Self {
        let [up, down] = slide.roots;
        let rates = [0.0, up, down];
        let y = [slide.saddle, arc.grow, arc.decay];
        let speed = [0.0, arc.grow * up, arc.decay * down];
        let f = slide.ratio;
        let constant = [1.0, 0.0, 0.0];
        let combine =
            |a: f64, b: f64, c: f64| [0, 1, 2].map(|i| a * constant[i] + b * speed[i] + c * y[i]);
        let push = combine((f - 1.0) * (f + 1.0), -2.0 * f, -2.0 * slide.zeta * f);
        let against = combine(-f, 1.0, 0.0);
        let mean = |p: &[f64; 3], q: &[f64; 3]| {
            let mut sum = 0.0;
            for i in 0..3 {
                for j in 0..3 {
                    sum += p[i] * q[j] * mean_exponential(rates[i] + rates[j], arc.time);
                }
            }
            sum
        };
        Self {
            push_lever: mean(&push, &y),
            rate_square: mean(&against, &against) + f * f * mean(&y, &y),
        }
    }
}

/// Returns the mean of `e^(rate t)` over `[0, time]`.
fn mean_exponential(rate: f64, time: f64) -> f64 {
    let x = rate * time;
    if x == 0.0 { 1.0 } else { x.exp_m1() / x }
}

/// One side above the critical speed, in numbers of order one.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SaddleFlow {
    zeta: f64,
    /// `nu/omega_c`, above one.
    ratio: f64,
    /// Half the side, `tan delta`.
    end: f64,
    /// The saddle `y*`.
    saddle: f64,
    /// The two roots, growing and decaying.
    roots: [f64; 2],
    /// `cos 2 delta`, none if not positive.
    kept: f64,
    /// `sin 2 delta`.
    struck: f64,
}

/// `y = y* + grow e^(s+ t) + decay e^(s- t)`, until `time`.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Arc {
    grow: f64,
    decay: f64,
    time: f64,
}

impl SaddleFlow {
    /// Creates the flow at a rotor speed `speed` \[rad/s\], taken without its sign; `None`
    /// without corners or not above the critical speed.
    fn at(machine: &Machine, speed: f64) -> Option<Self> {
        let zeta = machine.casing_damping_ratio;
        let ratio = machine.nu(speed).abs() / machine.omega_c;
        let excess = (ratio - 1.0) * (ratio + 1.0);
        if !machine.polygon.has_corners() || excess <= 0.0 {
            return None;
        }
        let delta = machine.polygon.delta;
        let root = (zeta * zeta + excess).sqrt();
        // The growing root as a quotient, which keeps its digits.
        let roots = [excess / (root + zeta), -root - zeta];
        let saddle = -2.0 * zeta * ratio / excess;
        let (struck, kept) = (2.0 * delta).sin_cos();
        // Beyond a right angle the wave runs into the corner and stays there.
        let kept = if machine.polygon.sides <= 4 { 0.0 } else { kept };
        let slide = Self { zeta, ratio, end: delta.tan(), saddle, roots, kept, struck };
        saddle.is_finite().then_some(slide)
    }

    /// Returns the speed just after a corner below which the wave turns back before the
    /// next: the stable manifold of the saddle.
    fn least_speed(&self) -> f64 {
        (self.roots[1] * (-self.end - self.saddle)).max(0.0)
    }

    /// Returns position and speed along an arc.
    fn state(&self, arc: &Arc, time: f64) -> (f64, f64) {
        let [up, down] = self.roots;
        let (grow, decay) = (arc.grow * (up * time).exp(), arc.decay * (down * time).exp());
        (self.saddle + grow + decay, grow * up + decay * down)
    }

    /// Returns the contact force at a position and speed; negative would be a pull.
    fn push(&self, y: f64, speed: f64) -> f64 {
        let f = self.ratio;
        (f - 1.0) * (f + 1.0) - 2.0 * f * speed - 2.0 * self.zeta * f * y
    }

    /// Returns the smallest contact force along an arc.
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

    /// Returns the arc that takes a given time from corner to corner.
    fn in_time(&self, time: f64) -> Arc {
        let [up, down] = self.roots;
        let (start, stop) = (-self.end - self.saddle, self.end - self.saddle);
        let (shrunk_up, shrunk_down) = ((-up * time).exp(), (down * time).exp());
        // grow e^(s+ t), the larger of the two, comes without overflow.
        let grown = (stop - start * shrunk_down) / (1.0 - shrunk_down * shrunk_up);
        let grow = grown * shrunk_up;
        Arc { grow, decay: start - grow, time }
    }

    /// Returns the speeds just after the corner an arc starts at, and just before the next.
    fn end_speeds(&self, arc: &Arc) -> [f64; 2] {
        [self.state(arc, 0.0).1, self.state(arc, arc.time).1]
    }

    /// Returns the arc that repeats itself: the drag restores on a side the speed lost
    /// at a corner. At most one exists, because the slope of the map from
    /// corner to corner is below one there; `None` if there is none.
    fn repeating(&self) -> Option<Arc> {
        let [up, _] = self.roots;
        // The slowest crossing is along the manifolds of the saddle.
        let slowest_gains = self.kept * up * (self.end - self.saddle) > self.least_speed();
        if self.kept <= 0.0 || self.zeta <= 0.0 || !slowest_gains {
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

/// Returns the first time from which a condition holds, to the last digit, found by
/// doubling from `guess` and then halving.
fn first_time(holds: impl Fn(f64) -> bool, guess: f64) -> Option<f64> {
    let (mut below, mut above) = (0.0, guess);
    let mut doublings = 0;
    while !holds(above) {
        (below, above) = (above, 2.0 * above);
        doublings += 1;
        if doublings > 200 || !above.is_finite() {
            return None;
        }
    }
    let [below, above] = bisected([below, above], holds);
    Some(0.5 * (below + above))
}
