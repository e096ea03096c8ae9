//! Rocking into a corner: crossings that accumulate, summed to their limit.
//! (docs/theory.md, section 5.)
//!
//! Next to a corner the casing leaves along one side with speed `v`, is pulled
//! back by the acceleration `A` of that side, and crosses to the other side,
//! which keeps the fraction `cos 2 delta` of its speed. Both sides obey
//! `x'' + 2 c x' + stiffness x = -A`, so an excursion takes the time `tau(v/A)` and
//! comes back with the speed `A R(v/A)`, where `tau` and `R` are power series
//! that depend on `c` and `stiffness` alone. The time left to the limit obeys
//! `T_a(v) = tau + T_b(cos 2 delta A_a R)`, and likewise from `b`: solved order
//! by order, it is the geometric series with its corrections.
//!
//! The sum replaces the crossings once ten orders of it are exact to round-off
//! and nothing else can happen before its limit: both accelerations point to the
//! corner, both sides push at every speed still to come (speeds only shrink, as
//! a crossing loses speed and damping adds none), and every
//! excursion stays well short of the next corner. While the pulse or a ramp
//! acts, the accelerations must also keep their values to one part in 1e9 until
//! the limit.

use super::locked::opening;
use super::parameters::Parameters;
use super::slide;
use crate::motion::Plane;
use crate::tolerances::{ROCKING_MARGIN, ROCKING_STEADY, ROCKING_TAIL, ROCKING_TURN};

/// Orders of the series.
const ORDERS: usize = 10;

type PowerSeries = [f64; ORDERS + 1];

/// The limit of a rocking motion.
#[derive(Clone, Copy, Debug)]
pub(super) struct Limit {
    /// Time left until the casing rests in the corner \[s\].
    pub time: f64,
    /// Energy lost in the crossings still to come, per unit mass \[m^2/s^2\].
    pub lost: f64,
}

/// Returns the limit, if the motion that leaves the corner of `a` and the next side with
/// `speed > 0` along `a` (`second` false) or along the next side can do nothing
/// but rock into it.
pub(super) fn limit(
    parameters: &Parameters,
    tables: &mut Option<Box<Tables>>,
    a: u32,
    second: bool,
    speed: f64,
) -> Option<Limit> {
    let cos = parameters.turn.re;
    // A side alone pushes with minus its own opening acceleration.
    let [(qa, qa_rate), (qb, qb_rate)] = opening(parameters, a, 0.0);
    let sin = parameters.turn.im;
    let pulls = pulls(parameters, qa, qb);
    let change = (qa_rate.abs() + qb_rate.abs()) / sin;
    let own = if second { pulls[1] } else { pulls[0] };
    let weakest = pulls[0].min(pulls[1]);
    if weakest <= 0.0 || own <= 0.0 {
        return None;
    }
    let margin = ROCKING_MARGIN * parameters.drive.nu.abs() * speed;
    if -qa <= margin || -qb <= margin || speed * speed > weakest * parameters.half_side {
        return None;
    }
    let propagator = slide::propagator(parameters, parameters.drive.nu);
    let fastest = 2.0 * propagator.damping + propagator.stiffness.abs().sqrt();
    let start = speed / own;
    if start * fastest > ROCKING_TURN {
        return None;
    }
    let sums = Tables::of(tables, propagator.damping, propagator.stiffness).sums(cos, pulls);
    let times = if second { &sums.time[1] } else { &sums.time[0] };
    let time = exact(times, start)?;
    let losses = if second { &sums.lost[1] } else { &sums.lost[0] };
    if !parameters.drive.steady() && change * time > ROCKING_STEADY * weakest {
        return None;
    }
    let lost = value(losses, start);
    Some(Limit { time, lost: 0.5 * sin * sin * lost })
}

/// Where a rocking motion is some time after it left the corner.
#[derive(Clone, Copy, Debug)]
pub(super) struct Swing {
    /// Whether it is on the second side of the corner.
    pub second: bool,
    /// Distance from the corner \[m\].
    pub distance: f64,
    /// Speed away from the corner \[m/s\].
    pub speed: f64,
    /// Energy lost in crossings so far, per unit mass \[m^2/s^2\].
    pub lost: f64,
}

/// Returns the steps through the crossings that `limit` sums, up to the instant `s`.
pub(super) fn replay(parameters: &Parameters, a: u32, second: bool, speed: f64, s: f64) -> Swing {
    let Plane { re: cos, im: sin } = parameters.turn;
    let [(qa, _), (qb, _)] = opening(parameters, a, 0.0);
    let pulls = pulls(parameters, qa, qb);
    let propagator = slide::propagator(parameters, parameters.drive.nu);
    let (duration, back) = excursion(propagator.damping, propagator.stiffness);
    let mut swing = Swing { second, distance: 0.0, speed, lost: 0.0 };
    let mut left = s;
    loop {
        let pull = if swing.second { pulls[1] } else { pulls[0] };
        let start = swing.speed / pull;
        let time = value(&duration, start);
        if time >= left {
            let response = propagator.at(left);
            swing.distance = (swing.speed * response.unit - pull * response.ramp).max(0.0);
            swing.speed = swing.speed * response.slope - pull * response.unit;
            return swing;
        }
        if left - time == left {
            // The other crossings take less time than round-off.
            return Swing { distance: 0.0, speed: 0.0, ..swing };
        }
        left -= time;
        let arrived = pull * value(&back, start);
        swing.lost += 0.5 * sin * sin * arrived * arrived;
        swing.speed = cos * arrived;
        swing.second = !swing.second;
    }
}

/// Returns the accelerations towards the corner along either side, the other side open.
fn pulls(parameters: &Parameters, qa: f64, qb: f64) -> [f64; 2] {
    let Plane { re: cos, im: sin } = parameters.turn;
    [-(qb - cos * qa) / sin, -(qa - cos * qb) / sin]
}

fn value(series: &PowerSeries, x: f64) -> f64 {
    series.iter().rev().fold(0.0, |sum, term| sum * x + term)
}

/// Returns the series at `x`, if its last orders are round-off.
fn exact(series: &PowerSeries, x: f64) -> Option<f64> {
    let sum = value(series, x);
    let last = x.powi(ORDERS as i32 - 1);
    let tail = (series[ORDERS - 1] * last).abs() + (series[ORDERS] * last * x).abs();
    (tail <= ROCKING_TAIL * sum && sum.is_finite()).then_some(sum)
}

/// Series of one excursion: they depend on damping and stiffness along a side
/// alone, so at one speed of the rotor they are the same at every corner.
#[derive(Clone, Debug)]
pub(super) struct Tables {
    equation: [f64; 2],
    duration: PowerSeries,
    /// Powers of the return speed.
    powers: [PowerSeries; ORDERS + 1],
}

/// Sums over all crossings to come, from either side, in powers of `v/A`.
struct Sums {
    time: [PowerSeries; 2],
    lost: [PowerSeries; 2],
}

impl Tables {
    /// Those kept from before, or new ones where damping or stiffness are others.
    fn of(kept: &mut Option<Box<Self>>, c: f64, stiffness: f64) -> &Self {
        let old = kept.take().filter(|tables| tables.equation == [c, stiffness]);
        kept.insert(old.unwrap_or_else(|| Box::new(Self::new(c, stiffness))))
    }

    fn new(c: f64, stiffness: f64) -> Self {
        let (duration, back) = excursion(c, stiffness);
        Self { equation: [c, stiffness], duration, powers: powers(&back) }
    }

    fn sums(&self, cos: f64, pulls: [f64; 2]) -> Sums {
        let ratio = pulls[0] / pulls[1];
        let keep = [cos * ratio, cos / ratio];
        let time = accumulate(&self.powers, keep, [self.duration; 2]);
        let lost = pulls.map(|pull| self.powers[2].map(|x| pull * pull * x));
        Sums { time, lost: accumulate(&self.powers, keep, lost) }
    }
}

/// Solves `X_a(x) = F_a(x) + X_b(keep_a R(x))` and the same with `a` and `b`
/// exchanged, order by order.
fn accumulate(
    powers: &[PowerSeries; ORDERS + 1],
    keep: [f64; 2],
    each: [PowerSeries; 2],
) -> [PowerSeries; 2] {
    let mut sums = [[0.0; ORDERS + 1]; 2];
    // The sums found so far, times the powers of what is kept.
    let mut scaled = [[0.0; ORDERS + 1]; 2];
    let mut kept = [1.0, 1.0];
    for n in 1..=ORDERS {
        let mut known = [each[0][n], each[1][n]];
        for k in 1..n {
            known[0] += scaled[1][k] * powers[k][n];
            known[1] += scaled[0][k] * powers[k][n];
        }
        kept = [kept[0] * keep[0], kept[1] * keep[1]];
        let over = 1.0 / (1.0 - kept[0] * kept[1]);
        sums[0][n] = (known[0] + kept[0] * known[1]) * over;
        sums[1][n] = (known[1] + kept[1] * known[0]) * over;
        scaled[1][n] = sums[1][n] * kept[0];
        scaled[0][n] = sums[0][n] * kept[1];
    }
    sums
}

/// Duration and return speed (over `A`) of an excursion that starts with the
/// speed `A x`, as series in `x`.
fn excursion(c: f64, stiffness: f64) -> (PowerSeries, PowerSeries) {
    // unit = sum a_n s^n with a_1 = 1, ramp its integral; x = ramp/unit.
    let mut unit = [0.0; ORDERS + 2];
    unit[1] = 1.0;
    for n in 1..=ORDERS {
        let order = n as f64;
        unit[n + 1] =
            -(2.0 * c * order * unit[n] + stiffness * unit[n - 1]) / (order * (order + 1.0));
    }
    // Coefficients e_n of ramp/unit: sum_k e_k unit_{n+1-k} = ramp_{n+1}.
    let mut ratio = [0.0; ORDERS + 1];
    for n in 1..=ORDERS {
        let ramp = unit[n] / (n as f64 + 1.0);
        let known: f64 = (1..n).map(|k| ratio[k] * unit[n + 1 - k]).sum();
        ratio[n] = ramp - known;
    }
    // Reversion: s(x) with sum e_k s^k = x. The powers of s are filled in order
    // by order: those above the first need no more than the orders known.
    let mut table = [[0.0; ORDERS + 1]; ORDERS + 1];
    table[0][0] = 1.0;
    for n in 1..=ORDERS {
        for k in 2..=n {
            table[k][n] = (1..n).map(|j| table[1][j] * table[k - 1][n - j]).sum();
        }
        let known: f64 = (2..=n).map(|k| ratio[k] * table[k][n]).sum();
        table[1][n] = (if n == 1 { 1.0 } else { 0.0 } - known) / ratio[1];
    }
    // Return speed over A: unit(s) - x unit'(s).
    let mut back = [0.0; ORDERS + 1];
    for n in 1..=ORDERS {
        for k in 1..=n {
            back[n] += unit[k] * table[k][n];
        }
        // unit' = 1 + sum_{k>=1} (k+1) a_{k+1} s^k.
        let slope: f64 = (1..n).map(|k| (k as f64 + 1.0) * unit[k + 1] * table[k][n - 1]).sum();
        back[n] -= slope + if n == 1 { 1.0 } else { 0.0 };
    }
    (table[1], back)
}

/// Returns the powers of a series without constant term, from the zeroth to the last order.
fn powers(series: &PowerSeries) -> [PowerSeries; ORDERS + 1] {
    let mut table = [[0.0; ORDERS + 1]; ORDERS + 1];
    table[0][0] = 1.0;
    for k in 1..=ORDERS {
        for n in k..=ORDERS {
            table[k][n] = (1..=n - k + 1).map(|j| series[j] * table[k - 1][n - j]).sum();
        }
    }
    table
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::motion::propagator::Propagator;

    /// One excursion by bisection on the closed form.
    fn stepped(propagator: &Propagator, pull: f64, speed: f64) -> (f64, f64) {
        let place = |s: f64| speed * propagator.at(s).unit - pull * propagator.at(s).ramp;
        let (mut low, mut high) = (1e-3 * speed / pull, 3.0 * speed / pull);
        for _ in 0..200 {
            let middle = 0.5 * (low + high);
            if place(middle) > 0.0 { low = middle } else { high = middle }
        }
        let response = propagator.at(low);
        (low, -(speed * response.slope - pull * response.unit))
    }

    #[test]
    fn one_excursion_and_the_sum_of_all_agree_with_stepping() {
        let (c, stiffness) = (44.0, -1.5e6);
        let propagator = Propagator::new(c, stiffness);
        let (duration, back) = excursion(c, stiffness);
        let pulls = [20.0, 55.0];
        let cos = (std::f64::consts::PI / 5.5).cos();
        let mut kept = None;
        // Tables of another speed are not used again.
        let _ = Tables::of(&mut kept, c, 0.9 * stiffness);
        let sums = Tables::of(&mut kept, c, stiffness).sums(cos, pulls);
        let start = 4e-6;
        let (time, speed) = stepped(&propagator, 1.0, start);
        assert!((value(&duration, start) / time - 1.0).abs() < 1e-13);
        assert!((value(&back, start) / speed - 1.0).abs() < 1e-13);
        let (mut total, mut lost, mut speed) = (0.0, 0.0, start * pulls[0]);
        for n in 0..400 {
            let (time, back) = stepped(&propagator, pulls[n % 2], speed);
            total += time;
            lost += back * back;
            speed = cos * back;
        }
        let summed = exact(&sums.time[0], start).unwrap();
        assert!((summed / total - 1.0).abs() < 1e-12, "{summed} {total}");
        assert!((value(&sums.lost[0], start) / lost - 1.0).abs() < 1e-12);
    }
}
