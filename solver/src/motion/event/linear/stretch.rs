//! A stretch of motion with the same rows in contact: casing, blades and contact forces as power
//! series summed to round-off, or free flight without further contact. It ends at the first gap
//! that closes or contact force that vanishes, or at the end of the series. No change of contact is
//! missed, however short (`event::series`).
//!
//! The contact forces follow order by order from the condition that the gaps stay closed: with
//! `c_j` the gradient of gap `j`, `c_j (free acceleration) + sum W_jk Q_k = 0`.

use super::parameters::{Parameters, along};
use crate::motion::Plane;
use crate::motion::event::series::{
    STRETCH, TERMS, Terms, curved_step, ended, gap, jounce, values,
};
use crate::motion::point::Point;
use crate::motion::propagator::Propagator;
use crate::numeric::elimination::{Square, inverse};
use crate::tolerances::{EVENT, MOST_HALVINGS, MOST_HELD, PEAK_LOOKS, ROUND_OFF};

/// Rows in contact.
#[derive(Clone, Debug, Default)]
pub(super) struct Held {
    pub rows: Vec<usize>,
    /// Directions of their contact forces.
    directions: [Plane; MOST_HELD],
    /// Inverse of their contact matrix `W`.
    pub inverse: Square<MOST_HELD>,
}

impl Held {
    /// Creates the set of rows; `None` if their contact matrix is singular or there are too many.
    pub(super) fn new(parameters: &Parameters, rows: Vec<usize>) -> Option<Self> {
        let mut matrix = [[0.0; MOST_HELD]; MOST_HELD];
        for (line, &row) in matrix.iter_mut().zip(&rows) {
            for (entry, &by) in line.iter_mut().zip(&rows) {
                *entry = parameters.joint(row, by);
            }
        }
        if rows.len() > MOST_HELD {
            return None;
        }
        let inverse = inverse(&matrix, rows.len())?;
        let mut directions = [Plane::default(); MOST_HELD];
        for (direction, &row) in directions.iter_mut().zip(&rows) {
            *direction = *parameters.rows.get(row)?;
        }
        Some(Self { rows, directions, inverse })
    }

    /// Returns the contact forces that compensate these accelerations of the gaps.
    pub(super) fn pushes(&self, openings: &[f64; MOST_HELD]) -> [f64; MOST_HELD] {
        let (mut pushes, held) = ([0.0; MOST_HELD], self.rows.len());
        for (push, row) in pushes.iter_mut().zip(&self.inverse).take(held) {
            *push = -row.iter().zip(openings).take(held).map(|(a, b)| a * b).sum::<f64>();
        }
        pushes
    }

    /// Returns the contact forces that keep the gaps closed against these accelerations of casing
    /// and blades.
    fn against(&self, arm: f64, casing: Plane, tips: Plane) -> [f64; MOST_HELD] {
        let mut openings = [0.0; MOST_HELD];
        for (opening, row) in openings.iter_mut().zip(&self.directions).take(self.rows.len()) {
            *opening = along(*row, arm, casing, tips);
        }
        self.pushes(&openings)
    }

    /// Evaluates a function for each row.
    pub(super) fn each(&self, opening: impl Fn(usize) -> f64) -> [f64; MOST_HELD] {
        let mut openings = [0.0; MOST_HELD];
        for (slot, &row) in openings.iter_mut().zip(&self.rows) {
            *slot = opening(row);
        }
        openings
    }

    /// Pairs each row with its contact force.
    pub(super) fn with(&self, pushes: [f64; MOST_HELD]) -> impl Iterator<Item = (usize, f64)> {
        self.rows.iter().copied().zip(pushes)
    }

    /// Projects a point so that the gaps in contact are closed and at rest to round-off.
    pub(super) fn closed(&self, parameters: &Parameters, point: &Point) -> Point {
        let mut point = *point;
        if self.rows.is_empty() {
            return point;
        }
        let apart = self.pushes(&self.each(|row| parameters.gap(row, &point)));
        let (z, a) = parameters.pushed(self.with(apart));
        (point.z, point.a) = (point.z + z, point.a + a);
        let rates = self.pushes(&self.each(|row| parameters.along(row, point.dz, point.da)));
        let (dz, da) = parameters.pushed(self.with(rates));
        (point.dz, point.da) = (point.dz + dz, point.da + da);
        point
    }
}

/// Series of the real and the imaginary part.
type Wave = [Terms; 2];

/// Returns the magnitude of each complex term, because one part alone may pass through zero.
/// Magnitudes whose squares underflow are round-off.
fn lengths([re, im]: &Wave) -> Terms {
    let mut lengths = [0.0; TERMS];
    for (length, (re, im)) in lengths.iter_mut().zip(re.iter().zip(im)) {
        *length = (re * re + im * im).sqrt();
    }
    lengths
}

/// One stretch of motion.
#[derive(Clone, Debug)]
pub(super) struct Stretch {
    /// Duration; infinite if no event ends it \[s\].
    pub length: f64,
    /// Point at the start.
    from: Point,
    z: Wave,
    a: Wave,
    force: Wave,
    /// Contact forces of the rows per unit casing mass \[m/s^2\].
    pub pushes: [Terms; MOST_HELD],
    /// Contact forces below this are round-off of the terms that they consist of \[m/s^2\].
    pub noise: f64,
    /// Largest possible closing of any gap during the stretch, and largest displacement at its
    /// start \[m\].
    pub travel: [f64; 2],
    /// Largest possible change of a blade angle during the stretch \[rad\].
    pub swing: f64,
    /// Whether the series did not converge for any length.
    pub lost: bool,
    /// Whether the stretch is free flight without further contact.
    pub free: bool,
}

impl Stretch {
    /// Computes the stretch from a point with these rows in contact and the pulse `force` per unit
    /// casing mass, for at most `most` seconds. The length is halved until the series converge.
    pub(super) fn begin(
        &mut self,
        parameters: &Parameters,
        held: &Held,
        from: Point,
        force: Plane,
        most: f64,
    ) {
        let zero = [0.0; TERMS];
        let spread = held.inverse.iter().flatten().fold(0.0_f64, |sum, entry| sum.max(entry.abs()));
        (self.force, self.pushes) = ([zero; 2], [zero; MOST_HELD]);
        (self.from, self.free) = (from, false);
        self.length = (STRETCH / parameters.rates()).min(most);
        self.noise = ROUND_OFF * spread * parameters.size_of_free(&from, force);
        for _ in 0..MOST_HALVINGS {
            self.expand(parameters, held, force);
            self.lost = !self.summed(parameters.arm().abs(), held.rows.len());
            if !self.lost {
                break;
            }
            self.length *= 0.5;
        }
    }

    /// Creates the free flight without further contact.
    pub(super) fn to_the_end(from: Point) -> Self {
        let zero = [0.0; TERMS];
        Self {
            length: f64::INFINITY,
            from,
            z: [zero; 2],
            a: [zero; 2],
            force: [zero; 2],
            pushes: [zero; MOST_HELD],
            noise: 0.0,
            travel: [0.0; 2],
            swing: 0.0,
            lost: false,
            free: true,
        }
    }

    /// Makes the motion constant for ever, after its changes have fallen to round-off.
    pub(super) fn come_to_rest(&mut self) {
        let hold = |terms: &mut Terms| terms.iter_mut().skip(1).for_each(|term| *term = 0.0);
        self.z.iter_mut().chain(&mut self.a).chain(&mut self.pushes).for_each(hold);
        self.length = f64::INFINITY;
    }

    fn expand(&mut self, parameters: &Parameters, held: &Held, force: Plane) {
        let h = self.length;
        let (spring, drag) = (parameters.spring * (h * h), parameters.drag * h);
        let (stiffness, damping) = parameters.blades.map_or((0.0, 0.0), |blades| {
            let Propagator { damping, stiffness, .. } = blades.propagator;
            (stiffness * h * h, 2.0 * damping * h)
        });
        let spin = Plane::new(0.0, -parameters.nu * h);
        let put = |wave: &mut Wave, n: usize, value: Plane| {
            (wave[0][n], wave[1][n]) = (value.re, value.im);
        };
        let (arm, pulsed) = (parameters.arm(), force != Plane::default());
        let mut acting = force * (h * h);
        // Terms of this order and of the next.
        let (mut z, mut a) = (self.from.z, self.from.a);
        let (mut dz, mut da) = (self.from.dz * h, self.from.da * h);
        put(&mut self.z, 0, z);
        put(&mut self.z, 1, dz);
        put(&mut self.a, 0, a);
        put(&mut self.a, 1, da);
        for (n, over) in OVER.into_iter().enumerate() {
            let order = n as f64;
            let mut casing = acting - spring * z - drag * dz * (order + 1.0);
            let mut tips = -(a * stiffness + da * (damping * (order + 1.0)));
            if !held.rows.is_empty() {
                let pushes = held.against(arm, casing, tips);
                let each = held.directions.iter().copied().zip(pushes).take(held.rows.len());
                let (z, a) = parameters.moved(each);
                (casing, tips) = (casing + z, tips + a);
                for (terms, push) in self.pushes.iter_mut().zip(pushes).take(held.rows.len()) {
                    terms[n] = push / (h * h);
                }
            }
            (z, dz) = (dz, casing * over);
            (a, da) = (da, tips * over);
            put(&mut self.z, n + 2, dz);
            put(&mut self.a, n + 2, da);
            if pulsed {
                put(&mut self.force, n, acting / (h * h));
                acting = acting * spin / (order + 1.0);
            }
        }
    }

    /// Returns the point at the start.
    pub(super) fn from(&self) -> &Point {
        &self.from
    }

    /// Bounds the motion by the sum of its terms, and returns whether the terms left out are
    /// round-off.
    fn summed(&mut self, arm: f64, held: usize) -> bool {
        let (z, a) = (lengths(&self.z), lengths(&self.a));
        let each = |(z, a): (&f64, &f64)| z + arm * a;
        self.travel = [z.iter().zip(&a).skip(1).map(each).sum(), each((&z[0], &a[0]))];
        self.swing = a.iter().skip(1).sum();
        let moves = |size: &Terms| ended(size) && size.iter().all(|term| term.is_finite());
        moves(&z)
            && moves(&a)
            && self.pushes.iter().take(held).all(|terms| ended(terms) || self.is_noise(terms))
    }

    /// Returns whether a contact force is entirely round-off.
    pub(super) fn is_noise(&self, push: &Terms) -> bool {
        push.iter().map(|term| term.abs()).sum::<f64>() <= self.noise
    }

    /// Returns the fraction of the stretch after `s` seconds.
    fn part(&self, s: f64) -> f64 {
        if self.length.is_finite() && self.length > 0.0 { s / self.length } else { 0.0 }
    }

    /// Returns the point after `s` seconds.
    pub(super) fn point(&self, parameters: &Parameters, s: f64) -> Point {
        if self.free {
            return self.flown(parameters, s);
        }
        if self.length == f64::INFINITY {
            return self.from;
        }
        let x = self.part(s);
        let per = if self.length > 0.0 { 1.0 / self.length } else { 0.0 };
        let ([z_re, z_im], [a_re, a_im]) = (&self.z, &self.a);
        let (mut value, mut rate) = ([0.0; 4], [0.0; 4]);
        // All four series at once, so that their operations can overlap.
        for n in (0..TERMS).rev() {
            for (k, term) in [z_re[n], z_im[n], a_re[n], a_im[n]].into_iter().enumerate() {
                rate[k] = rate[k] * x + value[k];
                value[k] = value[k] * x + term;
            }
        }
        Point {
            z: Plane::new(value[0], value[1]),
            dz: Plane::new(rate[0], rate[1]) * per,
            a: Plane::new(value[2], value[3]),
            da: Plane::new(rate[2], rate[3]) * per,
        }
    }

    fn flown(&self, parameters: &Parameters, s: f64) -> Point {
        let from = &self.from;
        let fly = |propagator: &Propagator, place: Plane, rate: Plane| {
            let response = propagator.at(s);
            let later = place * response.hold + rate * response.unit;
            let speed = rate * response.slope - place * (propagator.stiffness * response.unit);
            (later, speed)
        };
        let back = Plane::cis(-parameters.nu * s);
        let (u, v) = fly(&parameters.casing, from.z, parameters.carried(from));
        let (z, v) = (u * back, v * back);
        let (a, da) = parameters
            .blades
            .map_or_else(Default::default, |blades| fly(&blades.propagator, from.a, from.da));
        Point { z, dz: v - Plane::i() * z * parameters.nu, a, da }
    }

    /// Returns the contact forces per unit casing mass after `s` seconds \[m/s^2\].
    pub(super) fn pushes_at(&self, s: f64) -> [f64; MOST_HELD] {
        let x = self.part(s);
        self.pushes.map(
            |terms| {
                if self.is_noise(&terms) { 0.0 } else { values(&terms, x)[0].max(0.0) }
            },
        )
    }

    /// Returns the pulse force per unit casing mass after `s` seconds \[m/s^2\].
    pub(super) fn force_at(&self, s: f64) -> Plane {
        let x = self.part(s);
        Plane::new(values(&self.force[0], x)[0], values(&self.force[1], x)[0])
    }

    /// Returns the gap of a row as a power series \[m\].
    pub(super) fn gap(&self, parameters: &Parameters, row: usize) -> Terms {
        let arm = parameters.arm();
        let direction = parameters.rows.get(row).copied().unwrap_or_default();
        let ([z_re, z_im], [a_re, a_im]) = (&self.z, &self.a);
        let mut terms = [0.0; TERMS];
        let parts = z_re.iter().zip(z_im).zip(a_re.iter().zip(a_im));
        for (term, ((z_re, z_im), (a_re, a_im))) in terms.iter_mut().zip(parts) {
            *term = along(direction, arm, Plane::new(*z_re, *z_im), Plane::new(*a_re, *a_im));
        }
        terms[0] += parameters.apothem(row);
        terms
    }
}

/// Factors `1/((n + 1)(n + 2))`, by which term `n` of an acceleration gives term `n + 2` of the
/// displacement.
const OVER: [f64; TERMS - 2] = {
    let mut over = [0.0; TERMS - 2];
    let mut n = 0;
    while n < over.len() {
        over[n] = 1.0 / ((n as f64 + 1.0) * (n as f64 + 2.0));
        n += 1;
    }
    over
};

/// Event that ends a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ending {
    /// The gap of a row closes with this rate, which is zero or negative \[m/s\].
    Touch(usize, f64),
    /// The contact force of a row vanishes.
    Release(usize),
    /// The series ends, without a change of contact.
    StretchEnd,
}

/// A gap that has just opened, stored separately to keep its relative accuracy.
#[derive(Clone, Copy, Debug)]
pub(super) struct OpenedGap {
    pub row: usize,
    /// Gap \[m\].
    pub gap: f64,
    /// Rate of the gap \[m/s\].
    pub rate: f64,
    /// Whether the contact force has just vanished, so that the acceleration is zero.
    pub released: bool,
}

impl OpenedGap {
    /// Returns the gap as a power series over the stretch.
    fn terms(&self, parameters: &Parameters, stretch: &Stretch) -> Terms {
        let mut terms = stretch.gap(parameters, self.row);
        (terms[0], terms[1]) = (self.gap, self.rate * stretch.length);
        if self.released {
            terms[2] = 0.0;
        }
        terms
    }

    /// Advances the gap by `s` seconds.
    pub(super) fn later(&self, parameters: &Parameters, stretch: &Stretch, s: f64) -> Self {
        let terms = self.terms(parameters, stretch);
        let (order, left) = without_zeros(&terms);
        let (gap, rate) = grown(order, &left, s / stretch.length);
        Self { gap: gap.max(0.0), rate: rate / stretch.length, released: false, ..*self }
    }
}

/// Removes the leading zero terms; returns their number and the rest.
fn without_zeros(terms: &Terms) -> (usize, Terms) {
    let order = terms.iter().take(3).take_while(|&&term| term == 0.0).count();
    let mut left = [0.0; TERMS];
    for (slot, &term) in left.iter_mut().zip(terms.iter().skip(order)) {
        *slot = term;
    }
    (order, left)
}

/// Returns value and derivative of `x^order left(x)`.
fn grown(order: usize, left: &Terms, x: f64) -> (f64, f64) {
    let [value, rate, _] = values(left, x);
    let power = |n: usize| x.powi(i32::try_from(n).unwrap_or(0));
    let grows = if order == 0 { 0.0 } else { order as f64 * power(order - 1) * value };
    (power(order) * value, grows + power(order) * rate)
}

/// Returns the first `x` up to `end` at which the series falls to `noise`.
fn first_zero(terms: &Terms, noise: f64, end: f64) -> Option<f64> {
    let falls: f64 = terms.iter().skip(1).map(|term| term.abs()).sum();
    if terms[0] > falls {
        return None;
    }
    let bound = jounce(terms);
    let (mut x, mut looks) = (0.0, 0.0);
    while x < end {
        let now = gap(terms, x);
        looks += 1.0;
        // A gap that stays this close to contact for so many evaluations counts as contact.
        if (now.gap <= noise && now.rate < 0.0) || looks > PEAK_LOOKS {
            return Some(x);
        }
        x = (x + curved_step(now.above(noise), bound, 1.0 - x)).max(x.next_up());
    }
    None
}

/// Finds the event that ends a stretch, and its time \[s\].
pub(super) fn seek(
    parameters: &Parameters,
    stretch: &Stretch,
    held: &Held,
    opened: &[OpenedGap],
) -> (f64, Ending) {
    let (mut end, mut what) = (1.0, Ending::StretchEnd);
    for (&row, terms) in held.rows.iter().zip(&stretch.pushes) {
        if let Some(x) = vanishes(stretch, terms, parameters.tolerance, end) {
            (end, what) = (x, Ending::Release(row));
        }
    }
    for gap in opened {
        let (order, left) = without_zeros(&gap.terms(parameters, stretch));
        if left[0] < 0.0 {
            return (0.0, Ending::Touch(gap.row, gap.rate.min(0.0)));
        }
        let noise = parameters.tolerance.max(EVENT) * left[0];
        if let Some(x) = first_zero(&left, noise, end) {
            // At the zero itself only the derivative of the reduced series contributes.
            let slope = values(&left, x)[1] * x.powi(i32::try_from(order).unwrap_or(0));
            (end, what) = (x, Ending::Touch(gap.row, (slope / stretch.length).min(0.0)));
        }
    }
    let [travel, reach] = stretch.travel;
    let g0 = parameters.clearance();
    if reach + travel >= parameters.least_clearance() {
        let noise = parameters.tolerance * (g0 + reach + travel);
        let open = |row: &usize| !held.rows.contains(row) && opened.iter().all(|l| l.row != *row);
        let from = stretch.from();
        let near = |row: &usize| parameters.gap(*row, from) <= travel + noise;
        for row in (0..parameters.rows.len()).filter(near).filter(open) {
            let terms = stretch.gap(parameters, row);
            if let Some(x) = first_zero(&terms, noise, end) {
                let rate = values(&terms, x)[1] / stretch.length;
                (end, what) = (x, Ending::Touch(row, rate.min(0.0)));
            }
        }
    }
    (end * stretch.length, what)
}

/// Returns the fraction of the stretch at which a contact force vanishes, before `end`.
fn vanishes(stretch: &Stretch, terms: &Terms, tolerance: f64, end: f64) -> Option<f64> {
    if stretch.is_noise(terms) {
        // A row in contact without a force is not opened by round-off.
        return None;
    }
    let size: f64 = terms.iter().map(|term| term.abs()).sum();
    if terms[0] > stretch.noise {
        return first_zero(terms, tolerance * size, end);
    }
    // The force starts at zero: its first nonzero term decides.
    let mut left = *terms;
    let first = left.iter().position(|term| term.abs() > stretch.noise)?;
    left.iter_mut().take(first).for_each(|term| *term = 0.0);
    if left[first] < 0.0 {
        return Some(0.0);
    }
    let (_, left) = without_zeros(&left);
    first_zero(&left, tolerance * size, end)
}
