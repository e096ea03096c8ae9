//! The decisions of the event solver at its events, each asked how nearly it was
//! another one, and what an event does to the columns (`variation`) by the time at
//! which it comes. What did not happen is asked in `misses`.

use super::Event;
use super::corner;
use super::misses::seen;
use super::mode::{Mode, What};
use super::parameters::{Drive, Parameters};
use super::rocking;
use super::slide;
use super::variation::{Column, Columns, Crossing, From, Local, Variation, floor};
use crate::motion::Plane;
use crate::tolerances::{BRIEF_ROCKING, PERTURBATION, SOFT_TOUCH, TIE, TIE_EXCURSION};

impl Variation {
    /// The columns at an event, as the side that it is of sees them.
    pub(super) fn cross(&mut self, event: &Event, s: f64, what: What) -> Crossing {
        let Event { parameters, drive, mode, .. } = event;
        let columns = self.carried(event, s);
        let t = event.start.0 + s;
        let crossing = match mode {
            Mode::Free(free) => {
                let touched = if let What::Touch(side) = what { Some(side) } else { None };
                let normal =
                    touched.map_or(Plane::new(1.0, 0.0), |side| parameters.direction(side));
                let now = free.at(parameters, drive, s);
                let local = seen(parameters, drive, s, now, normal);
                let back = Plane::cis(-drive.phase(s)) * normal.conj();
                let mut columns = columns.map(|Column { place, rate, delay }| {
                    let rate = (rate - Plane::i() * place * drive.nu) * back;
                    Column { place: place * back, rate, delay }
                });
                match touched {
                    Some(side) => self.touch(event, side, s, &local, &mut columns),
                    None => {
                        advance(&mut columns, &local, |column| -column.delay);
                        let from = From::Flight;
                        Crossing { from, side: 0, along: 0.0, columns }
                    }
                }
            }
            Mode::Slide(_) | Mode::Driven(_) => self.leave_side(event, s, what, columns),
            Mode::Corner(a) => self.leave_corner(event, *a, s, what, columns),
            Mode::Held(held) => self.leave_corner(event, held.a, s, what, columns),
            Mode::Rocking { .. } => {
                if what != What::Lock {
                    self.ties.give_up();
                }
                Crossing { from: From::Corner, side: 0, along: 0.0, columns }
            }
        };
        let delays = crossing.columns.map(|column| column.delay);
        if !matches!(what, What::PulseEnd | What::SeriesEnd) {
            let instant = floor(parameters) / parameters.omega;
            self.ties.date(t, delays, instant);
            if event.pulse.force != 0.0 {
                self.ties.tell(t - event.pulse.end, delays, instant);
            }
        }
        crossing
    }

    /// A side is touched: transversally, away from its ends, faster than nothing,
    /// and with a push or a pull that is clear.
    fn touch(
        &mut self,
        event: &Event,
        side: u32,
        s: f64,
        local: &Local,
        columns: &mut Columns,
    ) -> Crossing {
        let Event { parameters, drive, .. } = event;
        let part = floor(parameters);
        let (omega, clearance) = (parameters.omega, parameters.clearance);
        let (closing, y) = (-local.rate.re, local.place.im);
        let gaps = columns.map(|column| column.place.re);
        self.ties.transversal(closing, local.bend.re, gaps, part * clearance);
        advance(columns, local, |column| column.place.re / closing);
        let speeds = columns.map(|column| -column.rate.re);
        self.ties.tell(closing, speeds, part * omega * clearance);
        let places = columns.map(|column| column.place.im);
        self.ties.tell(parameters.half_side - y, places.map(|y| -y), part * clearance);
        self.ties.tell(parameters.half_side + y, places, part * clearance);
        let inward = drive.inward(parameters, side, s);
        self.push(parameters, drive, inward, (y, local.rate.im), columns);
        Crossing { from: From::Touch, side, along: local.rate.im, columns: *columns }
    }

    /// Whether a side pushes, at this place and rate along it.
    pub(super) fn push(
        &mut self,
        parameters: &Parameters,
        drive: &Drive,
        inward: Plane,
        (y, rate): (f64, f64),
        columns: &Columns,
    ) {
        let push = parameters.push(drive.nu, 0.0, y, rate, drive.pulse * inward.re);
        self.ties.tell(push, push_shifts(parameters, drive, inward, columns), least(parameters));
    }

    /// A side ends, lets go, or goes on.
    fn leave_side(&mut self, event: &Event, s: f64, what: What, mut columns: Columns) -> Crossing {
        let Event { parameters, drive, mode, .. } = event;
        let side = side_of(mode).unwrap_or_default();
        let inward = drive.inward(parameters, side, s);
        let Some((_, now)) = mode.along(parameters, drive, s) else {
            self.ties.give_up();
            return Crossing { from: From::Side, side, along: 0.0, columns };
        };
        self.passed(event, s, side, &columns);
        let (y, rate, half) = (now.y, now.rate, parameters.half_side);
        let bend = acceleration(parameters, drive, inward, now.y, now.rate);
        let local = Local {
            place: Plane::new(-parameters.clearance, y),
            rate: Plane::new(0.0, rate),
            bend: Plane::new(0.0, bend),
        };
        let places = columns.map(|column| column.place.im);
        // A short excursion from an end of the side is followed as such.
        let reached = (TIE_EXCURSION * rate.abs() * s).min(floor(parameters) * half);
        let mut crossing = Crossing { from: From::Side, side, along: rate, columns };
        match what {
            What::Edge(up) => {
                let sign = if up { 1.0 } else { -1.0 };
                self.ties.transversal(rate, -sign * bend, places, reached);
                advance(&mut columns, &local, |column| -column.place.im / rate);
                self.push(parameters, drive, inward, (y, rate), &columns);
                let polygon = &parameters.machine.polygon;
                let kept = parameters.turn.re;
                for column in &mut columns {
                    column.place = Plane::default();
                    column.rate *= kept;
                }
                let next = if up { polygon.previous(side) } else { polygon.next(side) };
                crossing = Crossing { from: From::Edge, side: next, along: kept * rate, columns };
                let inward = drive.inward(parameters, next, s);
                let place = (-sign * half, crossing.along);
                self.push(parameters, drive, inward, place, &columns);
                let counted = SOFT_TOUCH * parameters.omega * parameters.clearance;
                let closing = rate.abs() * parameters.turn.im;
                self.ties.tell(closing - counted, [0.0; 2], counted);
            }
            What::Release => {
                let pushes = push_shifts(parameters, drive, inward, &columns);
                let [fall, bent] = push_rates(parameters, drive, inward, rate, bend);
                self.ties.transversal(fall, bent, pushes, least(parameters) * 1e-3);
                let mut k = 0;
                advance(&mut columns, &local, |_| {
                    k += 1;
                    -pushes[k - 1] / fall
                });
                let places = columns.map(|column| column.place.im);
                self.ties.tell(half - y, places.map(|y| -y), reached);
                self.ties.tell(half + y, places, reached);
                crossing.columns = columns;
            }
            What::PulseEnd => {
                advance(&mut columns, &local, |column| -column.delay);
                let off = Drive { pulse: 0.0, ..*drive };
                self.push(parameters, &off, inward, (y, rate), &columns);
                crossing.columns = columns;
            }
            What::SeriesEnd => self.push(parameters, drive, inward, (y, rate), &columns),
            _ => self.ties.give_up(),
        }
        crossing
    }

    /// A corner lets go, or the pulse that held it ends.
    fn leave_corner(
        &mut self,
        event: &Event,
        a: u32,
        s: f64,
        what: What,
        mut columns: Columns,
    ) -> Crossing {
        let Event { parameters, drive, .. } = event;
        let off = Drive { pulse: 0.0, ..*drive };
        let mut crossing = Crossing { from: From::Corner, side: a, along: 0.0, columns };
        if what == What::SeriesEnd && drive.pulse == 0.0 {
            return crossing;
        }
        let mut slopes = [[0.0; 2]; 2];
        for part in [0.0, 0.5, 1.0] {
            let [now, without] =
                [drive, &off].map(|drive| corner::pushes(parameters, drive, a, part * s));
            let rates = corner::opening(parameters, drive, a, part * s).map(|(_, rate)| rate);
            let rates = corner::cancelled(parameters, rates[0], rates[1]);
            for k in 0..2 {
                slopes[k] = [now[k] - without[k], rates[k]];
                let yields = part == 1.0 && what == What::Yield(k == 1);
                if !yields {
                    let shifts = push_slopes(&columns, slopes[k]);
                    self.ties.tell(now[k], shifts, least(parameters));
                }
            }
        }
        match what {
            What::Yield(second) if drive.pulse != 0.0 => {
                let [grown, rate] = slopes[usize::from(second)];
                let shifts = push_slopes(&columns, [grown, rate]);
                for (column, shift) in columns.iter_mut().zip(shifts) {
                    column.delay -= shift / rate;
                }
                self.ties.tell(rate, [0.0; 2], least(parameters) * parameters.omega);
            }
            What::PulseEnd => {
                let openings = corner::opening(parameters, &off, a, s).map(|(opening, _)| opening);
                let pushes = corner::pushes(parameters, &off, a, s);
                for value in openings.into_iter().chain(pushes) {
                    self.ties.tell(value, [0.0; 2], least(parameters));
                }
                columns = Columns::default();
            }
            What::SeriesEnd => {}
            _ => self.ties.give_up(),
        }
        crossing.columns = columns;
        crossing
    }

    /// What the transition chose, against what the columns can follow.
    pub(super) fn settle(&mut self, event: &Event, crossing: &Crossing) {
        let Event { parameters, drive, mode, .. } = event;
        let expected = match (mode, crossing.from) {
            (Mode::Slide(_) | Mode::Driven(_), From::Corner) | (Mode::Free(_), _) => true,
            (Mode::Slide(_) | Mode::Driven(_), From::Flight) => false,
            (Mode::Slide(_) | Mode::Driven(_), _) => side_of(mode) == Some(crossing.side),
            (Mode::Rocking { .. }, from) => from == From::Edge,
            (Mode::Corner(_) | Mode::Held(_), from) => matches!(from, From::Edge | From::Corner),
        };
        if !expected {
            self.ties.give_up();
        }
        // How soon crossings are summed decides how many are counted. Without a
        // pulse they end in a lock, where none is.
        if crossing.from == From::Edge && drive.pulse != 0.0 && !matches!(mode, Mode::Free(_)) {
            let summed = side_of(mode).is_none();
            let [pulse, noise] = crossing.columns.map(|column| column.rate.im.abs());
            let part = TIE * PERTURBATION * pulse.max(noise) / crossing.along.abs();
            let part = part.max(floor(parameters));
            let speed =
                crossing.along.abs() * if summed { 1.0 + part } else { (1.0 - part).max(0.0) };
            let polygon = &parameters.machine.polygon;
            let second = crossing.along < 0.0;
            let a = if second { polygon.previous(crossing.side) } else { crossing.side };
            let limit = rocking::limit(parameters, drive, &mut None, a, second, speed);
            let again = limit.is_some_and(|limit| match parameters.blades {
                None => true,
                Some(blades) => {
                    let rates = parameters.omega + drive.nu.abs() + blades.omega;
                    limit.time * rates <= BRIEF_ROCKING
                }
            });
            if again != summed {
                self.ties.give_up();
            }
        }
    }
}

/// Moves columns on to the changed instant of an event, by what `shift` says of
/// each.
fn advance(columns: &mut Columns, local: &Local, mut shift: impl FnMut(&Column) -> f64) {
    for column in columns {
        let ds = shift(column);
        column.place += local.rate * ds;
        column.rate += local.bend * ds;
        column.delay += ds;
    }
}

/// Second derivative of the place along a side \[m/s^2\].
pub(super) fn acceleration(
    parameters: &Parameters,
    drive: &Drive,
    inward: Plane,
    y: f64,
    rate: f64,
) -> f64 {
    let (c, nu) = (parameters.damping, drive.nu);
    let stiffness = slide::propagator(parameters, nu).stiffness;
    2.0 * c * (nu * parameters.clearance - rate) - stiffness * y - drive.pulse * inward.im
}

/// First and second derivative of the push; the second leaves out what a pulse
/// does to it.
pub(super) fn push_rates(
    parameters: &Parameters,
    drive: &Drive,
    inward: Plane,
    rate: f64,
    bend: f64,
) -> [f64; 2] {
    let (c, nu) = (parameters.damping, drive.nu);
    let stiffness = slide::propagator(parameters, nu).stiffness;
    let twist = -2.0 * c * bend - stiffness * rate;
    [-2.0 * nu * (bend + c * rate) + drive.pulse * nu * inward.im, -2.0 * nu * (twist + c * bend)]
}

/// How the columns shift the push of a side.
fn push_shifts(
    parameters: &Parameters,
    drive: &Drive,
    inward: Plane,
    columns: &Columns,
) -> [f64; 2] {
    let (c, nu, pulse) = (parameters.damping, drive.nu, drive.pulse);
    let grown = [pulse, 0.0];
    std::array::from_fn(|k| {
        let Column { place, rate, delay } = columns[k];
        -2.0 * nu * (rate.im + c * place.im) - grown[k] * inward.re + pulse * nu * delay * inward.im
    })
}

/// As `push_shifts`, from the change by the pulse and by time.
fn push_slopes(columns: &Columns, [grown, rate]: [f64; 2]) -> [f64; 2] {
    [grown + rate * columns[0].delay, rate * columns[1].delay]
}

/// A push of which the sign is not known \[m/s^2\].
pub(super) fn least(parameters: &Parameters) -> f64 {
    floor(parameters) * parameters.omega * parameters.omega * parameters.clearance
}

/// The side slid along.
pub(super) fn side_of(mode: &Mode) -> Option<u32> {
    match mode {
        Mode::Slide(slide) => Some(slide.side),
        Mode::Driven(series) => Some(series.side),
        _ => None,
    }
}
