//! Sliding above the critical speed as a saddle: a rigid blade group holds the
//! wave on one side of the polygon, and the wave drifts along it
//! (docs/theory.md, section 5). This form answers what repeats, from corner to corner;
//! `motion::event::slide` has the form that starts from a state.
//!
//! With lengths in `g0`, time in `1/omega_c` and `f = nu/omega_c`:
//!
//! - `y'' + 2 zeta y' + (1 - f^2) y = 2 zeta f`
//! - push `N = f^2 - 1 - 2 f y' - 2 zeta f y`, in `k_c g0`

use crate::model::Machine;
use crate::numeric::bisection::bisected;

/// One side above the critical speed, in numbers of order one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct SaddleFlow {
    pub zeta: f64,
    /// `nu/omega_c`, above one.
    pub ratio: f64,
    /// Half the side, `tan delta`.
    pub end: f64,
    /// The saddle `y*`.
    pub saddle: f64,
    /// The two roots, growing and decaying.
    pub roots: [f64; 2],
    /// `cos 2 delta`, none if not positive.
    pub kept: f64,
    /// `sin 2 delta`.
    pub struck: f64,
}

/// `y = y* + grow e^(s+ t) + decay e^(s- t)`, until `time`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Arc {
    pub grow: f64,
    pub decay: f64,
    pub time: f64,
}

impl SaddleFlow {
    /// At a rotor speed `speed` \[rad/s\], taken without its sign; `None` without
    /// corners or not above the critical speed.
    pub fn at(machine: &Machine, speed: f64) -> Option<Self> {
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

    /// The arc that starts at the corner `y = -end` with this speed.
    fn starting(&self, speed: f64) -> (f64, f64) {
        let [up, down] = self.roots;
        let offset = -self.end - self.saddle;
        let grow = (speed - down * offset) / (up - down);
        (grow, offset - grow)
    }

    /// Speed just after a corner below which the wave turns back before the
    /// next: the stable manifold of the saddle.
    pub fn least_speed(&self) -> f64 {
        (self.roots[1] * (-self.end - self.saddle)).max(0.0)
    }

    /// Position and speed along an arc.
    pub fn state(&self, arc: &Arc, time: f64) -> (f64, f64) {
        let [up, down] = self.roots;
        let (grow, decay) = (arc.grow * (up * time).exp(), arc.decay * (down * time).exp());
        (self.saddle + grow + decay, grow * up + decay * down)
    }

    /// Push at a position and speed; negative would be a pull.
    pub fn push(&self, y: f64, speed: f64) -> f64 {
        let f = self.ratio;
        (f - 1.0) * (f + 1.0) - 2.0 * f * speed - 2.0 * self.zeta * f * y
    }

    /// Smallest push along an arc.
    pub fn least_push(&self, arc: &Arc) -> f64 {
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

    /// The arc from a speed just after one corner to the next corner; `None`
    /// where the wave turns back. Contact is not checked.
    pub fn cross(&self, speed: f64) -> Option<Arc> {
        if speed <= self.least_speed() {
            return None;
        }
        let (grow, decay) = self.starting(speed);
        let free = Arc { grow, decay, time: f64::INFINITY };
        let beyond = |time| self.state(&free, time).0 >= self.end;
        let time = first_time(beyond, 2.0 * self.end / speed)?;
        Some(Arc { grow, decay, time })
    }

    /// The arc that takes a given time from corner to corner.
    fn in_time(&self, time: f64) -> Arc {
        let [up, down] = self.roots;
        let (start, stop) = (-self.end - self.saddle, self.end - self.saddle);
        let (shrunk_up, shrunk_down) = ((-up * time).exp(), (down * time).exp());
        // grow e^(s+ t), the larger of the two, comes without overflow.
        let grown = (stop - start * shrunk_down) / (1.0 - shrunk_down * shrunk_up);
        let grow = grown * shrunk_up;
        Arc { grow, decay: start - grow, time }
    }

    /// Speeds just after the corner an arc starts at, and just before the next.
    pub fn end_speeds(&self, arc: &Arc) -> [f64; 2] {
        [self.state(arc, 0.0).1, self.state(arc, arc.time).1]
    }

    /// The arc that repeats itself: the drag restores on a side the speed lost
    /// at a corner. At most one exists, because the slope of the map from
    /// corner to corner is below one there; `None` if there is none.
    pub fn repeating(&self) -> Option<Arc> {
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

/// The first time from which a condition holds, to the last digit, found by
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
