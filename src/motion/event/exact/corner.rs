//! Locked in a corner: the casing wave turns with the rotor, two sides push.
//! (docs/theory.md, section 4.)
//!
//! With `D = 2 c nu + nu'` and the side half-length `h = g0 tan delta`, a
//! casing held at rest in the corner of sides `a` and `b` (`psi_b = psi_a +
//! 2 delta`) and then let go would open the two gaps with
//! `q_a = f cos beta_a + (omega_c^2 - nu^2) g0 - D h` and
//! `q_b = f cos beta_b + (omega_c^2 - nu^2) g0 + D h`; the pushes cancel both.

use super::parameters::{Drive, Parameters};
use crate::motion::Plane;
use crate::motion::event::looks::safe_step;

/// What one look ahead in a corner finds.
#[derive(Clone, Copy, Debug)]
pub(super) enum Hold {
    /// No event before this time.
    Until(f64),
    /// The push of the first (`false`) or second side vanishes now.
    Yield(bool),
    /// The pushes do not change.
    Always,
    /// The motion grows too fast to be followed.
    Lost,
}

/// Opening accelerations `q_a`, `q_b` of a corner at rest, `s` seconds on, and
/// their rates.
pub(super) fn opening(parameters: &Parameters, drive: &Drive, a: u32, s: f64) -> [(f64, f64); 2] {
    let (nu, ramp, c2) = (drive.nu(s), drive.nu_rate, 2.0 * parameters.damping);
    let (g0, h) = (parameters.clearance, parameters.half_side);
    let pulse = drive.pulse_on(parameters, a, s);
    let centred = (parameters.omega - nu) * (parameters.omega + nu) * g0;
    let slack = -2.0 * nu * ramp * g0;
    let mut openings = [(0.0, 0.0); 2];
    for (opening, (pulse, sign)) in
        openings.iter_mut().zip([(pulse, -1.0), (pulse * parameters.turn, 1.0)])
    {
        *opening = (
            pulse.re + centred + sign * (c2 * nu + ramp) * h,
            slack - nu * pulse.im + sign * c2 * ramp * h,
        );
    }
    openings
}

/// Impulses or pushes that cancel two opening rates at once:
/// `p + [[1, cos 2 delta], [cos 2 delta, 1]]^-1 q = 0`.
pub(super) fn cancelled(parameters: &Parameters, a: f64, b: f64) -> [f64; 2] {
    let Plane { re: cos, im: sin } = parameters.turn;
    let scale = 1.0 / (sin * sin);
    [-(a - cos * b) * scale, -(b - cos * a) * scale]
}

/// Pushes per unit mass of both sides \[m/s^2\].
pub(super) fn pushes(parameters: &Parameters, drive: &Drive, a: u32, s: f64) -> [f64; 2] {
    let [first, second] = opening(parameters, drive, a, s);
    cancelled(parameters, first.0, second.0)
}

/// Looks ahead from `s` in the corner of `a` and the next side.
pub(super) fn look(parameters: &Parameters, drive: &Drive, a: u32, s: f64, end: f64) -> Hold {
    if drive.steady() {
        return Hold::Always;
    }
    let [first, second] = opening(parameters, drive, a, s);
    let pushes = cancelled(parameters, first.0, second.0);
    let rates = cancelled(parameters, first.1, second.1);
    let ramp = drive.nu_rate.abs();
    // A ramp may change the wave frequency by its own size, or by one turn a
    // period of it, in one look.
    let size = drive.nu(s).abs() + ramp.sqrt();
    let span = if ramp > 0.0 { (size / ramp).min(end - s) } else { end - s };
    let turning = drive.nu(s).abs().max(drive.nu(s + span).abs());
    let Plane { re: cos, im: sin } = parameters.turn;
    let spread = (1.0 + cos.abs()) / (sin * sin);
    let pulse = drive.pulse.abs();
    let bend =
        spread * (2.0 * ramp * ramp * parameters.clearance + pulse * (turning * turning + ramp));
    let square = (parameters.omega * parameters.omega).max(turning * turning);
    let noise = parameters.tolerance * spread * (square * parameters.clearance + pulse);
    let mut stride = span;
    for (second, (push, rate)) in [false, true].into_iter().zip(pushes.into_iter().zip(rates)) {
        if push <= noise && rate < 0.0 {
            return Hold::Yield(second);
        }
        stride = stride.min(safe_step(push.max(0.0) + noise, rate, bend));
    }
    Hold::Until((s + stride).max(s.next_up()))
}
