//! Whirl on the polygon of the blades (docs/theory.md, section 10): the wave slides along
//! one side, strikes the next group at the corner and passes on, for ever. A fixed point
//! of the map from corner to corner, in the linearised frame of the blades.
//!
//! Along a side one group holds while casing and blades move, linear in eight states. For a
//! given passing time the map is linear, so its fixed point is the solution of five linear
//! equations; one equation is left for the time itself, that the side ends.
//!
//! Lengths are counted in `g0`, blade angles in `g0/l_b`, pushes in `k_c g0`, time in
//! `1/omega_c`. The frame is turned so that the side that holds is at phase 0: there
//! `w = z - kappa l_b a = -1 + i y`, and the push is along the real axis.

use nalgebra::{Complex, DMatrix, SMatrix, SVector};
use serde::Serialize;
use strum::{Display, IntoStaticStr};

use super::joint::Joint;
use super::{HarmonicError, error};
use crate::model::Machine;
use crate::numeric::bisection::bisected;
use crate::numeric::eigen::eigenvalues;
use crate::tolerances::{WHIRL_ENDS, WHIRL_LOOKS, WHIRL_RATES, WHIRL_SAMPLES};

/// Why there is no whirl at some speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Display, IntoStaticStr)]
#[serde(rename_all = "kebab-case")]
#[strum(serialize_all = "kebab-case")]
pub enum NoWhirl {
    /// Tips that are not inclined, or whose blades give nothing back: `c2 = 0`.
    NotInclined,
    /// Corners of a right angle or less stop the wave.
    StopsAtCorner,
    /// No motion that the blades push repeats from corner to corner.
    NoBalance,
    /// One repeats, but the wave would have to be pulled to stay on a side.
    Lifts,
    /// One repeats, but neighbouring motions leave it.
    Unstable,
    /// Blades have grown into the casing.
    Closed,
}

/// A lasting whirl.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct WhirlOrbit {
    /// Time from corner to corner \[s\].
    pub passing_time_s: f64,
    /// Casing frequency in the standing frame \[rad/s\].
    pub omega_rad_s: f64,
    /// What the blades feel, `s = omega - nu`; negative where the contact passes against
    /// the phase \[rad/s\].
    pub s_rad_s: f64,
    /// Mean push of all blades, impulses included \[N\].
    pub mean_push_n: f64,
    /// Smallest push along a side \[N\].
    pub least_push_n: f64,
    /// Impulse on the group that is struck at a corner \[N s\].
    pub corner_impulse_n_s: f64,
    /// Largest `|z|` of the casing \[m\].
    pub casing_m: f64,
    /// Largest `|a|` of the blades \[rad\].
    pub blade_rad: f64,
    /// Size of the largest multiplier of the map; below one it is stable.
    pub multiplier: f64,
}

/// Whirl at one rotor speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WhirlPoint {
    /// Rotor speed \[rad/s\].
    pub speed_rad_s: f64,
    /// The lasting whirl, or why there is none.
    pub outcome: Result<WhirlOrbit, NoWhirl>,
}

/// Lasting whirl over a list of rotor speeds \[rad/s\].
///
/// # Errors
/// A polygon without corners, modes of the disk of other diameters than the casing, or a
/// speed that is not finite.
pub fn whirl_over(machine: &Machine, speeds: &[f64]) -> Result<Vec<WhirlPoint>, HarmonicError> {
    error::refuse_no_corner(&machine.polygon)?;
    error::refuse_other_diameters(machine)?;
    error::refuse_preload(&machine.at(0.0))?;
    error::refuse_endless(speeds)?;
    let point = |&speed: &f64| WhirlPoint { speed_rad_s: speed, outcome: at(machine, speed) };
    Ok(speeds.iter().map(point).collect())
}

/// Of all motions that repeat the one that lasts, or what is wrong with the best.
fn at(machine: &Machine, speed: f64) -> Result<WhirlOrbit, NoWhirl> {
    let joint = Joint::at(machine, speed);
    if joint.coupling_product == 0.0 {
        return Err(NoWhirl::NotInclined);
    }
    if joint.machine.clearance() <= 0.0 {
        return Err(NoWhirl::Closed);
    }
    // A wave that is slower than the rotor passes against the phase.
    let sense = if speed < 0.0 { -1.0 } else { 1.0 };
    let direction = -sense * joint.coupling_product.signum();
    let arc = WhirlArc::of(&joint, direction);
    if !arc.passes() {
        return Err(NoWhirl::StopsAtCorner);
    }
    let mut reason = NoWhirl::NoBalance;
    for (time, free) in repeating(&arc, &joint) {
        match orbit(&joint, &arc, time, &free) {
            Ok(orbit) => return Ok(orbit),
            Err(NoWhirl::Unstable) => reason = NoWhirl::Unstable,
            Err(other) if reason == NoWhirl::NoBalance => reason = other,
            Err(_) => {}
        }
    }
    Err(reason)
}

/// Every motion that repeats, with the time of its arc, the fastest first.
fn repeating(arc: &WhirlArc, joint: &Joint) -> Vec<(f64, Free)> {
    let machine = &*joint.machine;
    let side = 2.0 * machine.polygon.delta;
    // Passing times of waves that turn this fast in the frame of the blades.
    let [slow, fast] = WHIRL_RATES.map(|part| part * machine.omega_bd / machine.omega_c);
    let step = (fast / slow).powf(1.0 / WHIRL_LOOKS as f64);
    let mut found = Vec::new();
    let miss = |time: f64| balanced(arc, time).map(|(miss, _)| miss);
    let mut last = (side / fast, miss(side / fast));
    for _ in 0..WHIRL_LOOKS {
        let next = (last.0 * step, miss(last.0 * step));
        if let (Some(before), Some(after)) = (last.1, next.1)
            && (before > 0.0) != (after > 0.0)
        {
            let time = halved(&miss, last.0, next.0, before > 0.0);
            // A change of sign through infinity is no balance.
            if let Some((left, free)) = balanced(arc, time)
                && left.abs() <= WHIRL_ENDS * arc.half().abs()
            {
                found.push((time, free));
            }
        }
        last = next;
    }
    found
}

fn halved(miss: &impl Fn(f64) -> Option<f64>, low: f64, high: f64, above: bool) -> f64 {
    let stays = |time: f64| miss(time).is_some_and(|left| (left > 0.0) == above);
    let [low, high] = bisected([low, high], |time| !stays(time));
    0.5 * (low + high)
}

/// The motion that repeats after this time, and how far from the end of the side it is
/// then.
fn balanced(arc: &WhirlArc, time: f64) -> Option<(f64, Free)> {
    let motion = arc.over(time);
    let map = |free: &Free| arc.free(&arc.end(&motion, free).states);
    let still = map(&Free::zeros());
    let mut slope = SMatrix::<f64, 5, 5>::zeros();
    for k in 0..5 {
        let mut unit = Free::zeros();
        unit[k] = 1.0;
        slope.set_column(k, &(map(&unit) - still));
    }
    let free = (SMatrix::identity() - slope).lu().solve(&still)?;
    let miss = arc.end(&motion, &free).place + arc.half();
    miss.is_finite().then_some((miss, free))
}

/// The orbit of a fixed point, judged.
fn orbit(joint: &Joint, arc: &WhirlArc, time: f64, free: &Free) -> Result<WhirlOrbit, NoWhirl> {
    let machine = &*joint.machine;
    let end = arc.end(&arc.over(time), free);
    let samples = Samples::along(arc, time, &arc.start(free));
    let least = samples.extreme(|states| -arc.push(states)).map(|most| -most);
    // Along the side there is no way back over the corner behind.
    let half = arc.half().abs();
    let inside = |states: &States| arc.place(states).abs() <= half * (1.0 + WHIRL_ENDS);
    if end.pushed + end.impulse <= 0.0 {
        // It would hang on the blades as a whole.
        return Err(NoWhirl::NoBalance);
    }
    let least = least.filter(|least| *least >= 0.0 && end.impulse >= 0.0 && samples.all(inside));
    let least = least.ok_or(NoWhirl::Lifts)?;
    let multiplier = multiplier(arc, time, free).ok_or(NoWhirl::Unstable)?;
    if multiplier >= 1.0 {
        return Err(NoWhirl::Unstable);
    }
    let size =
        |k: usize| move |states: &States| states[k] * states[k] + states[k + 1] * states[k + 1];
    let largest = |k: usize| samples.extreme(size(k)).map_or(f64::NAN, f64::sqrt);
    let length = machine.clearance();
    let force = machine.casing_stiffness * length;
    let passing_time = time / machine.omega_c;
    let s = 2.0 * machine.polygon.delta * arc.half().signum() / passing_time;
    Ok(WhirlOrbit {
        passing_time_s: passing_time,
        omega_rad_s: joint.nu + s,
        s_rad_s: s,
        mean_push_n: (end.pushed + end.impulse) / time * force,
        least_push_n: least * force,
        corner_impulse_n_s: end.impulse * force / machine.omega_c,
        casing_m: largest(0) * length,
        blade_rad: largest(2) * length / machine.blade_length,
        multiplier,
    })
}

/// Size of the largest multiplier of the map from corner to corner; the time of an arc
/// changes so that it ends at the corner.
fn multiplier(arc: &WhirlArc, time: f64, free: &Free) -> Option<f64> {
    let motion = arc.over(time);
    let here = arc.end(&motion, free);
    let (before, _) = WhirlArc::moved(&motion, &arc.start(free));
    let rates = arc.rates(&before);
    // Both are linear in the states before the corner.
    let by_time = arc.free(&arc.corner(&rates, 0.0).states);
    let place_by_time = arc.place(&rates);
    let base = arc.free(&here.states);
    let mut map = DMatrix::zeros(5, 5);
    for k in 0..5 {
        let mut changed = *free;
        changed[k] += 1.0;
        let end = arc.end(&motion, &changed);
        let later = -(end.place - here.place) / place_by_time;
        let column = arc.free(&end.states) - base + by_time * later;
        for row in 0..5 {
            map[(row, k)] = column[row];
        }
    }
    let values = eigenvalues(map)?;
    Some(values.iter().map(|value| value.norm()).fold(0.0, f64::max))
}

/// States at equal times along an arc.
struct Samples(Vec<States>);

impl Samples {
    fn along(arc: &WhirlArc, time: f64, start: &States) -> Self {
        let motion = arc.over(time / WHIRL_SAMPLES as f64);
        let mut states = Vec::with_capacity(WHIRL_SAMPLES + 1);
        let mut here = *start;
        states.push(here);
        for _ in 0..WHIRL_SAMPLES {
            here = WhirlArc::moved(&motion, &here).0;
            states.push(here);
        }
        Self(states)
    }

    fn all(&self, holds: impl Fn(&States) -> bool) -> bool {
        self.0.iter().all(holds)
    }

    /// The largest of a smooth quantity, between samples by a parabola.
    fn extreme(&self, of: impl Fn(&States) -> f64) -> Option<f64> {
        let values: Vec<f64> = self.0.iter().map(of).collect();
        let (place, most) =
            values.iter().copied().enumerate().max_by(|a, b| a.1.total_cmp(&b.1))?;
        let neighbours =
            place.checked_sub(1).and_then(|i| values.get(i)).zip(values.get(place + 1));
        let Some((before, after)) = neighbours else { return Some(most) };
        let bend = before - 2.0 * most + after;
        if bend >= 0.0 {
            return Some(most);
        }
        Some(most - (after - before).powi(2) / (8.0 * bend))
    }
}

/// `z`, `l_b a/g0` and their rates, as real and imaginary parts.
pub(super) type States = SVector<f64, 8>;
/// The same and the integral of the push.
type Extended = SMatrix<f64, 9, 9>;
/// The blades and the rate of `y`: what is free just after a corner.
pub(super) type Free = SVector<f64, 5>;

/// The motion along a side and over a corner, at one speed and in one direction.
#[derive(Clone, Debug)]
pub(super) struct WhirlArc {
    rates: Extended,
    /// The push, a row over the states.
    push: SVector<f64, 8>,
    /// Change of the two rates by a unit of impulse at phase 0.
    struck: [Complex<f64>; 2],
    /// Change of the rate of `w` by it.
    response: Complex<f64>,
    kappa: f64,
    /// Half a side, `tan delta`.
    half: f64,
    /// Phase of the next side.
    turn: f64,
}

/// The end of an arc: the states just after the next corner, in its frame, the place
/// along the side just before it, the impulse, and the integral of the push.
#[derive(Clone, Copy, Debug)]
pub(super) struct ArcEnd {
    pub states: States,
    pub place: f64,
    pub impulse: f64,
    pub pushed: f64,
}

impl WhirlArc {
    /// At the speed of a joint, where the contact passes over the blades in a direction
    /// (1 with the phase, -1 against it).
    pub fn of(joint: &Joint, direction: f64) -> Self {
        let machine = &*joint.machine;
        let kappa = machine.radial_coupling;
        let lever = kappa + machine.friction_at(joint.nu);
        let inertia = machine.blade_length * machine.blade_length * machine.casing_mass
            / machine.blade_modal_mass;
        let turn = joint.nu / machine.omega_c;
        let rate = machine.omega_bd / machine.omega_c;
        let drag = 2.0 * machine.casing_damping_ratio;
        let blade_drag = 2.0 * machine.blade_damping_ratio * rate;
        let struck =
            [Complex::new(1.0, joint.casing_friction), Complex::new(-lever * inertia, 0.0)];
        let response = struck[0] - struck[1] * kappa;
        // Accelerations without contact, a row of states each.
        let mut free = SMatrix::<f64, 4, 8>::zeros();
        let stiff = turn * turn - 1.0;
        for (row, other, sign) in [(0, 1, 1.0), (1, 0, -1.0)] {
            free[(row, row)] = stiff;
            free[(row, other)] = sign * drag * turn;
            free[(row, 4 + row)] = -drag;
            free[(row, 4 + other)] = sign * 2.0 * turn;
            free[(2 + row, 2 + row)] = -rate * rate;
            free[(2 + row, 6 + row)] = -blade_drag;
        }
        // Re w'' = 0 gives the push.
        let along = free.row(0) - free.row(2) * kappa;
        let push: SVector<f64, 8> = (along / -response.re).transpose();
        let mut rates = Extended::zeros();
        for k in 0..4 {
            rates[(k, 4 + k)] = 1.0;
        }
        let force = [struck[0].re, struck[0].im, struck[1].re, struck[1].im];
        for (k, part) in force.into_iter().enumerate() {
            for column in 0..8 {
                rates[(4 + k, column)] = free[(k, column)] + part * push[column];
            }
        }
        for column in 0..8 {
            rates[(8, column)] = push[column];
        }
        let delta = machine.polygon.delta;
        Self {
            rates,
            push,
            struck,
            response,
            kappa,
            half: delta.tan() * direction,
            turn: 2.0 * delta * direction,
        }
    }

    /// Whether a corner leaves the wave a part of its speed along the next side.
    pub fn passes(&self) -> bool {
        let kept = self.response * Complex::from_polar(1.0, self.turn);
        // At a right angle nothing is kept but round-off.
        self.response.re > 0.0 && kept.re > 4.0 * f64::EPSILON * kept.norm()
    }

    /// The states just after a corner.
    pub fn start(&self, free: &Free) -> States {
        let a = Complex::new(free[0], free[1]);
        let a_rate = Complex::new(free[2], free[3]);
        let z = Complex::new(-1.0, self.half) + a * self.kappa;
        let z_rate = Complex::new(0.0, free[4]) + a_rate * self.kappa;
        States::from([z.re, z.im, a.re, a.im, z_rate.re, z_rate.im, a_rate.re, a_rate.im])
    }

    /// What is free of such states.
    pub fn free(&self, states: &States) -> Free {
        Free::from([states[2], states[3], states[6], states[7], states[5] - self.kappa * states[7]])
    }

    /// The motion over a time.
    pub fn over(&self, time: f64) -> Extended {
        (self.rates * time).exp()
    }

    /// Applies a motion to states; the last is the integral of the push.
    pub fn moved(motion: &Extended, states: &States) -> (States, f64) {
        let after = motion.fixed_view::<8, 8>(0, 0) * states;
        let pushed = motion.fixed_view::<1, 8>(8, 0) * states;
        (after, pushed[0])
    }

    /// The push at some states.
    pub fn push(&self, states: &States) -> f64 {
        self.push.dot(states)
    }

    /// Place along the side, from `half` to `-half`.
    pub fn place(&self, states: &States) -> f64 {
        states[1] - self.kappa * states[3]
    }

    /// Half a side with the sign of the direction.
    pub fn half(&self) -> f64 {
        self.half
    }

    /// Rates of the states while the side holds.
    pub fn rates(&self, states: &States) -> States {
        self.rates.fixed_view::<8, 8>(0, 0) * states
    }

    /// Strikes the next side and turns the frame to it. Linear in the states.
    pub fn corner(&self, states: &States, pushed: f64) -> ArcEnd {
        let back = Complex::from_polar(1.0, -self.turn);
        let pair = |k: usize| Complex::new(states[k], states[k + 1]) * back;
        let [z, a, mut z_rate, mut a_rate] = [pair(0), pair(2), pair(4), pair(6)];
        let closing = (z_rate - a_rate * self.kappa).re;
        let impulse = -closing / self.response.re;
        z_rate += self.struck[0] * impulse;
        a_rate += self.struck[1] * impulse;
        let place = self.place(states);
        let states =
            States::from([z.re, z.im, a.re, a.im, z_rate.re, z_rate.im, a_rate.re, a_rate.im]);
        ArcEnd { states, place, impulse, pushed }
    }

    /// The end of an arc of this time.
    pub fn end(&self, motion: &Extended, free: &Free) -> ArcEnd {
        let (states, pushed) = Self::moved(motion, &self.start(free));
        self.corner(&states, pushed)
    }
}
