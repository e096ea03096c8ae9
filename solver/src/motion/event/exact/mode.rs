//! The modes of motion, seen alike: where the casing is, what pushes, what ends the mode, how
//! far blades bend, and where the energy goes.
//!
//! Each part of the energy balance is integrated on its own from the closed-form motion, so
//! that the balance can fail: dissipation from the exponentials of the flight or by
//! Gauss quadrature along a side, the rotor's work from the pushes (a push `N`
//! at `y` takes the power `-N nu y` from the rotor), the losses from the
//! closing speeds. Only the summed part of a rocking motion is booked at its
//! balance (docs/theory.md, section 7).

use std::f64::consts::FRAC_PI_2;

use super::free::Free;
use super::locked::{self, CornerSeries};
use super::parameters::{Parameters, Tips};
use super::slide::{Along, SideSeries, Slide};
use super::{ExactEvents, rocking};
use crate::motion::propagator::damped;
use crate::motion::{ActiveSet, Failure, FailureReason, Plane};
use crate::numeric::bisection::bisected;
use crate::numeric::maximum::highest;
use crate::numeric::quadrature::quadrature;
use crate::tolerances::{CORNER_ROOM, LARGEST_BLADE_ANGLE, PEAK_LOOKS};

/// How the casing moves until the next event.
#[derive(Clone, Debug)]
#[expect(clippy::large_enum_variant, reason = "modes change often and live in one place: no boxes")]
pub(super) enum Mode {
    /// Nothing touches.
    Free(Free),
    /// Along one side, at constant speed and without pulse.
    Slide(Slide),
    /// Along one side, while the pulse acts or the speed changes.
    Driven(SideSeries),
    /// From the corner of `a` and the next side with `speed` along the first or
    /// second of them, into the rest that comes after `time`.
    Rocking { a: u32, second: bool, speed: f64, time: f64, lost: f64 },
    /// At rest in the corner of this side and the next.
    Corner(u32),
    /// In a corner whose sides move with their blades.
    Held(CornerSeries),
}

/// What ends a mode.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ending {
    /// A side touches.
    Touch(u32),
    /// The upper (`true`) or lower end of the side is reached; without corners, the casing.
    Edge(bool),
    /// The only push vanishes.
    Release,
    /// The push of the first or second (`true`) side of a corner vanishes.
    Yield(bool),
    /// The crossings of a rocking motion have accumulated.
    Lock,
    /// The pulse ends.
    PulseEnd,
    /// The power series ends; the motion goes on.
    SeriesEnd,
    /// The motion left the casing.
    Gone,
    /// The motion grows too fast to be followed.
    Lost,
}

/// What one look ahead finds, in any mode.
#[derive(Clone, Copy, Debug)]
pub(super) enum Next {
    Until(f64),
    Now(Ending),
}

impl Mode {
    /// Looks ahead from `s` to at most `end`; events do not come before `s`.
    pub(super) fn look(&self, parameters: &Parameters, s: f64, end: f64) -> Next {
        match self {
            Self::Free(free) => free.look(parameters, s, end),
            Self::Slide(slide) => slide.look(parameters, s),
            Self::Driven(series) => series.look(parameters, s),
            Self::Rocking { time, .. } if s < *time => Next::Until(*time),
            Self::Rocking { .. } => Next::Now(Ending::Lock),
            Self::Corner(a) => locked::look(parameters, *a, s, end),
            Self::Held(held) => held.look(parameters, s),
        }
    }

    /// Returns how long the mode is defined for \[s\].
    pub(super) fn length(&self) -> f64 {
        match self {
            Self::Driven(series) => series.length,
            Self::Held(held) => held.length,
            _ => f64::INFINITY,
        }
    }

    /// Returns the side slid along and the motion along it; a corner counts as its
    /// first side.
    pub(super) fn along(&self, parameters: &Parameters, s: f64) -> Option<(u32, Along)> {
        match self {
            Self::Free(_) => None,
            Self::Slide(slide) => Some((slide.side, slide.at(parameters, s))),
            Self::Driven(series) => Some((series.side, series.at(s))),
            Self::Rocking { a, time, .. } if s >= *time => {
                Some((*a, Along { y: -parameters.half_side, rate: 0.0, push: 0.0 }))
            }
            Self::Rocking { a, second, speed, .. } => {
                let swing = rocking::replay(parameters, *a, *second, *speed, s);
                let (side, sign) = if swing.second {
                    (parameters.machine.polygon.next(*a), 1.0)
                } else {
                    (*a, -1.0)
                };
                let y = sign * (parameters.half_side - swing.distance);
                let rate = -sign * swing.speed;
                let pulse = parameters.pulse_on(side, s).re;
                let push = parameters.push(
                    parameters.drive.nu(s),
                    parameters.drive.nu_rate,
                    y,
                    rate,
                    pulse,
                );
                Some((side, Along { y, rate, push }))
            }
            Self::Corner(a) => {
                let [push, _] = locked::pushes(parameters, *a, s);
                Some((*a, Along { y: -parameters.half_side, rate: 0.0, push }))
            }
            Self::Held(held) => {
                let [push, _] = held.pushes(s);
                Some((held.a, Along { y: -held.half_side(parameters, s), rate: 0.0, push }))
            }
        }
    }

    /// Returns the place and rate in the standing frame, `s` seconds on.
    pub(super) fn standing(&self, parameters: &Parameters, s: f64) -> (Plane, Plane) {
        if let Self::Free(free) = self {
            return free.at(parameters, s);
        }
        if let Self::Held(held) = self {
            return held.standing(parameters, s);
        }
        let Some((side, along)) = self.along(parameters, s) else {
            return Default::default();
        };
        let facing = parameters.facing(side, s, &self.tips(parameters, s));
        along.seen(parameters.clearance, facing)
    }

    /// Returns the place and rate of a free flight in the standing frame, `s` seconds on; none
    /// in contact.
    pub(super) fn flight(&self, parameters: &Parameters, s: f64) -> Option<(Plane, Plane)> {
        match self {
            Self::Free(free) => Some(free.at(parameters, s)),
            _ => None,
        }
    }

    /// Returns the place and rate as the rotor sees them, `s` seconds on, those of
    /// `u exp(-i n_d theta)`; from the motion along a side then, if there is one.
    pub(super) fn seen_by_rotor(
        &self,
        parameters: &Parameters,
        s: f64,
        along: Option<(u32, Along)>,
    ) -> (Plane, Plane) {
        if let Self::Free(_) | Self::Held(_) = self {
            let (place, rate) = self.standing(parameters, s);
            let back = Plane::cis(-parameters.drive.phase(s));
            return (place * back, (rate - Plane::i() * place * parameters.drive.nu(s)) * back);
        }
        let Some((side, along)) = along else {
            return Default::default();
        };
        let normal = parameters.normal(side, &self.tips(parameters, s));
        along.seen(parameters.clearance, normal)
    }

    /// Returns the first side of the corner that the mode is in or rocks into.
    pub(super) fn corner(&self) -> Option<u32> {
        match self {
            Self::Corner(a) | Self::Rocking { a, .. } | Self::Held(CornerSeries { a, .. }) => {
                Some(*a)
            }
            Self::Free(_) | Self::Slide(_) | Self::Driven(_) => None,
        }
    }

    /// Returns the blades, `s` seconds on.
    pub(super) fn tips(&self, parameters: &Parameters, s: f64) -> Tips {
        match self {
            Self::Free(free) => free.tips(parameters, s),
            Self::Driven(series) => series.tips(parameters, s),
            Self::Held(held) => held.tips(parameters, s),
            _ => Tips::default(),
        }
    }

    /// Returns the blades as they are reported: stiff ones follow the pushes.
    pub(super) fn reported(&self, parameters: &Parameters, s: f64) -> Tips {
        let Some(blades) = &parameters.following else { return self.tips(parameters, s) };
        let Some((_, along)) = self.along(parameters, s) else { return Tips::default() };
        let pushes = self.pushes(parameters, s);
        blades.following(parameters, pushes, [along.y, parameters.half_side])
    }

    /// Returns the largest angle of any blade over the first `s` seconds, `least` where
    /// none is larger \[rad\].
    pub(super) fn largest_angle(&self, parameters: &Parameters, s: f64, least: f64) -> f64 {
        let angle = |t: f64| parameters.largest(&self.reported(parameters, t));
        let bound = match self {
            Self::Free(free) => return free.largest_angle(parameters, s, least),
            Self::Driven(series) if parameters.blades.is_some() => series.largest_bound(),
            Self::Held(held) => held.largest_bound(),
            _ if parameters.following.is_some() => f64::INFINITY,
            _ => 0.0,
        };
        if bound <= least {
            return least;
        }
        let rate = match self {
            Self::Slide(slide) => slide.fastest(),
            Self::Corner(_) if parameters.drive.steady() => return least.max(angle(s)),
            _ => 1.0 / self.length().min(s),
        };
        peak(s, rate, angle).max(least)
    }

    /// Returns the kinetic and potential energy per unit casing mass, `s` seconds on.
    pub(super) fn energy(&self, parameters: &Parameters, s: f64) -> f64 {
        let (u, v) = self.standing(parameters, s);
        let blades =
            parameters.blades.map_or(0.0, |blades| blades.energy(&self.tips(parameters, s)));
        casing_energy(parameters, u, v) + blades
    }

    /// Returns the sides in contact with their pushes per unit mass, in phase order.
    pub(super) fn pushes(&self, parameters: &Parameters, s: f64) -> [Option<(u32, f64)>; 2] {
        let corner = match self {
            Self::Corner(a) => Some((*a, locked::pushes(parameters, *a, s))),
            Self::Held(held) => Some((held.a, held.pushes(s))),
            _ => None,
        };
        if let Some((a, [first, second])) = corner {
            return [Some((a, first)), Some((parameters.machine.polygon.next(a), second))];
        }
        [self.along(parameters, s).map(|(side, along)| (side, along.push)), None]
    }

    /// Returns the sides in contact as the log of contacts names them.
    pub(super) fn active_set(&self, parameters: &Parameters) -> ActiveSet {
        match self {
            Self::Free(_) => ActiveSet::Nothing,
            Self::Slide(slide) => ActiveSet::Side(slide.side),
            Self::Driven(series) => ActiveSet::Side(series.side),
            Self::Rocking { a, second: false, .. } => ActiveSet::Side(*a),
            Self::Rocking { a, second: true, .. } => {
                ActiveSet::Side(parameters.machine.polygon.next(*a))
            }
            Self::Corner(a) | Self::Held(CornerSeries { a, .. }) => {
                ActiveSet::of(&[*a, parameters.machine.polygon.next(*a)])
            }
        }
    }

    /// Books the energies of the first `s` seconds of the mode.
    pub(super) fn book(&self, parameters: &Parameters, s: f64, energy_balance: &mut EnergyBalance) {
        let drive = &parameters.drive;
        let ends = || [0.0, s].map(|t| self.standing(parameters, t));
        let mut pulse = 0.0;
        if drive.pulse != 0.0 {
            let [before, after] = ends();
            pulse = drive.pulse * (after.0.re - before.0.re);
        }
        energy_balance.pulse += pulse;
        let drag = 2.0 * parameters.damping;
        let (nu, ramp) = (drive.nu.abs().max(drive.nu(s).abs()), drive.nu_rate.abs());
        let rate = 2.0 * (parameters.omega + drag + nu + ramp.sqrt());
        let power = |t: f64, y: f64, rate: f64, push: f64| {
            let nu = drive.nu(t);
            let (across, along) = (nu * y, rate - nu * parameters.clearance);
            [drag * (along * along + across * across), -nu * push * y]
        };
        // As above, where the side turns with its blades.
        let compliant = |t: f64, work: f64| {
            let (_, rate) = self.standing(parameters, t);
            let blades = parameters.blades.map_or(0.0, |blades| {
                2.0 * blades.propagator.damping
                    * blades.mass
                    * self.tips(parameters, t).rate.norm_sqr()
            });
            [drag * rate.norm_sqr() + blades, -drive.nu(t) * work]
        };
        let [dissipated, work] = match self {
            Self::Free(free) => [dissipated(parameters, free, s), 0.0],
            Self::Slide(slide) => quadrature(s, 2.0 * slide.fastest(), |t| {
                let Along { y, rate, push } = slide.at(parameters, t);
                power(t, y, rate, push)
            }),
            Self::Driven(series) => quadrature(s, 2.0 / series.length, |t| {
                let Along { y, rate, push } = series.at(t);
                if parameters.blades.is_some() {
                    compliant(t, push * y)
                } else {
                    power(t, y, rate, push)
                }
            }),
            Self::Held(held) => quadrature(s, 2.0 / held.length, |t| {
                let [first, second] = held.pushes(t);
                compliant(t, (second - first) * held.half_side(parameters, t))
            }),
            Self::Rocking { a, second, speed, time, lost } => {
                let lost = if s < *time {
                    rocking::replay(parameters, *a, *second, *speed, s).lost
                } else {
                    *lost
                };
                energy_balance.lost += lost;
                let [before, after] = ends();
                let dissipated = drag * drive.nu * drive.nu * before.0.norm_sqr() * s;
                let [before, after] = [before, after].map(|(u, v)| casing_energy(parameters, u, v));
                [dissipated, after - before + lost + dissipated - pulse]
            }
            Self::Corner(a) => {
                let power = |t: f64| {
                    let [first, second] = locked::pushes(parameters, *a, t);
                    let [dissipated, work] = power(t, -parameters.half_side, 0.0, first);
                    [dissipated, work - drive.nu(t) * second * parameters.half_side]
                };
                if drive.steady() { power(0.0).map(|x| x * s) } else { quadrature(s, rate, power) }
            }
        };
        energy_balance.dissipated += dissipated;
        energy_balance.rotor += work;
    }
}

impl ExactEvents {
    /// Fails a motion whose blades go beyond small angles in the first `s` seconds
    /// of the segment, at the instant they do.
    ///
    /// # Errors
    /// They do.
    pub(super) fn check_angles(&mut self, s: f64) -> Result<(), Failure> {
        let beyond = |event: &Self, s: f64| {
            let Self { mode, parameters, .. } = event;
            mode.largest_angle(parameters, s, LARGEST_BLADE_ANGLE) > LARGEST_BLADE_ANGLE
        };
        if self.parameters.blades.is_none() || !beyond(self, s) {
            return Ok(());
        }
        // A bracket that does not depend on `s`: where one looks changes no bit.
        let (mut within, mut after) = (0.0, self.mode.length());
        if !after.is_finite() {
            after = 1.0 / self.parameters.omega;
            while after < s && !beyond(self, after) {
                (within, after) = (after, 2.0 * after);
            }
        }
        let [_, after] = bisected([within, after], |s| beyond(self, s));
        let angle_rad = self.mode.largest_angle(&self.parameters, after, 0.0);
        Err(self.fail(after, FailureReason::BladeAngle { angle_rad }))
    }

    /// Fails a motion whose blades have turned a corner so far that it nearly
    /// closes or opens to a half turn. Half its angle differs from `delta` by up to
    /// `n_d sin(delta) |a|`.
    pub(super) fn check_order(&mut self) {
        let Some(blades) = self.parameters.blades.filter(|_| self.parameters.corners) else {
            return;
        };
        let delta = self.parameters.machine.polygon.delta;
        let room = CORNER_ROOM * delta.min(FRAC_PI_2 - delta);
        let (size, most) = (self.tips.angle.norm(), room / (blades.diameters * delta.sin()));
        if size > most {
            self.fail(0.0, FailureReason::CornerAngle { angle_rad: size, most_rad: most });
        }
    }
}

/// Returns the largest value over `[0, s]` of a function that changes at `rate`.
pub(super) fn peak(s: f64, rate: f64, value: impl Fn(f64) -> f64) -> f64 {
    let parts = (8.0 * rate * s).ceil().clamp(2.0, PEAK_LOOKS);
    let at = |k: f64| s * (k / parts).clamp(0.0, 1.0);
    let (mut best, mut most, mut k) = (0.0, value(0.0), 1.0);
    while k <= parts {
        let here = value(at(k));
        if here > most {
            (best, most) = (k, here);
        }
        k += 1.0;
    }
    // The maximum lies next to the largest sample, and there is one.
    most.max(highest([at(best - 1.0), at(best + 1.0)], value).1)
}

/// Energies per unit casing mass \[m^2/s^2\].
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct EnergyBalance {
    /// Kinetic and potential energy at the start.
    pub start: f64,
    /// Work of the pulse.
    pub pulse: f64,
    /// Work of the rotor through the contact.
    pub rotor: f64,
    /// Work of blades that grow.
    pub growth: f64,
    /// Dissipated by the casing damping.
    pub dissipated: f64,
    /// Lost in impacts.
    pub lost: f64,
}

impl EnergyBalance {
    /// Returns what is missing from the balance at a final state of this energy.
    pub(super) fn residual(&self, energy: f64) -> f64 {
        self.pulse + self.rotor + self.growth - (energy - self.start) - self.dissipated - self.lost
    }
}

/// Returns the kinetic and potential energy of the casing per unit mass.
pub(super) fn casing_energy(parameters: &Parameters, u: Plane, v: Plane) -> f64 {
    0.5 * (v.norm_sqr() + parameters.propagator.stiffness * u.norm_sqr())
}

/// Returns the energy dissipated in `s` seconds of free flight, by the casing and by the
/// blades.
pub(super) fn dissipated(parameters: &Parameters, free: &Free, s: f64) -> f64 {
    let centre = parameters.drive.pulse / parameters.propagator.stiffness;
    let from = free.place - Plane::new(centre, 0.0);
    let casing = damped(&parameters.propagator, from, free.rate, s);
    let blades = parameters.blades.map_or(0.0, |blades| {
        blades.mass * damped(&blades.propagator, free.tips.angle, free.tips.rate, s)
    });
    casing + blades
}
