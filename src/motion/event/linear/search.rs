//! What ends a stretch: the first gap that closes, the first push that vanishes, or
//! its end. Nothing is passed, however short (`event::looks`).

use super::parameters::Parameters;
use super::stretch::{Held, Stretch};
use crate::motion::event::looks::curved_step;
use crate::motion::event::series::{TERMS, Terms, gap, jounce, values};
use crate::tolerances::{EVENT, PEAK_LOOKS};

/// What ends a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum What {
    /// A row touches with this rate, zero or less \[m/s\].
    Touch(usize, f64),
    /// The push of a row vanishes.
    Release(usize),
    /// The stretch ends; the motion goes on.
    StretchEnd,
}

/// A gap that has just opened, with digits of its own.
#[derive(Clone, Copy, Debug)]
pub(super) struct Loose {
    pub row: usize,
    /// \[m\]
    pub gap: f64,
    /// \[m/s\]
    pub rate: f64,
    /// Whether its push has just vanished: then its acceleration is zero.
    pub released: bool,
}

impl Loose {
    /// Its gap over the stretch, in powers of the part of it.
    fn terms(&self, parameters: &Parameters, stretch: &Stretch) -> Terms {
        let mut terms = stretch.gap(parameters, self.row);
        (terms[0], terms[1]) = (self.gap, self.rate * stretch.length);
        if self.released {
            terms[2] = 0.0;
        }
        terms
    }

    /// The same `s` seconds on.
    pub(super) fn later(&self, parameters: &Parameters, stretch: &Stretch, s: f64) -> Self {
        let terms = self.terms(parameters, stretch);
        let (order, left) = without_zeros(&terms);
        let (gap, rate) = grown(order, &left, s / stretch.length);
        Self { gap: gap.max(0.0), rate: rate / stretch.length, released: false, ..*self }
    }
}

/// The terms without their leading zeros, and how many those are.
fn without_zeros(terms: &Terms) -> (usize, Terms) {
    let order = terms.iter().take(3).take_while(|&&term| term == 0.0).count();
    let mut left = [0.0; TERMS];
    for (slot, &term) in left.iter_mut().zip(terms.iter().skip(order)) {
        *slot = term;
    }
    (order, left)
}

/// Value and rate of `x^order left(x)`.
fn grown(order: usize, left: &Terms, x: f64) -> (f64, f64) {
    let [value, rate, _] = values(left, x);
    let power = |n: usize| x.powi(i32::try_from(n).unwrap_or(0));
    let grows = if order == 0 { 0.0 } else { order as f64 * power(order - 1) * value };
    (power(order) * value, grows + power(order) * rate)
}

/// The first `x` up to `end` where the terms come down to `noise`.
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
        // So near to a touch for so long that it is one.
        if (now.gap <= noise && now.rate < 0.0) || looks > PEAK_LOOKS {
            return Some(x);
        }
        x = (x + curved_step(now.above(noise), bound, 1.0 - x)).max(x.next_up());
    }
    None
}

/// The event that ends a stretch, and when \[s\].
pub(super) fn seek(
    parameters: &Parameters,
    stretch: &Stretch,
    held: &Held,
    loose: &[Loose],
) -> (f64, What) {
    let (mut end, mut what) = (1.0, What::StretchEnd);
    for (&row, terms) in held.rows.iter().zip(&stretch.pushes) {
        if let Some(x) = vanishes(stretch, terms, parameters.tolerance, end) {
            (end, what) = (x, What::Release(row));
        }
    }
    for gap in loose {
        let (order, left) = without_zeros(&gap.terms(parameters, stretch));
        if left[0] < 0.0 {
            return (0.0, What::Touch(gap.row, gap.rate.min(0.0)));
        }
        let noise = parameters.tolerance.max(EVENT) * left[0];
        if let Some(x) = first_zero(&left, noise, end) {
            // At the zero itself only the slope of what is left counts.
            let slope = values(&left, x)[1] * x.powi(i32::try_from(order).unwrap_or(0));
            (end, what) = (x, What::Touch(gap.row, (slope / stretch.length).min(0.0)));
        }
    }
    let [travel, reach] = stretch.travel(parameters);
    let g0 = parameters.clearance();
    if reach + travel >= g0 {
        let noise = parameters.tolerance * (g0 + reach + travel);
        let open = |row: &usize| !held.rows.contains(row) && loose.iter().all(|l| l.row != *row);
        for row in (0..parameters.rows.len()).filter(open) {
            if parameters.gap(row, stretch.from()) > travel + noise {
                continue;
            }
            let terms = stretch.gap(parameters, row);
            if let Some(x) = first_zero(&terms, noise, end) {
                let rate = values(&terms, x)[1] / stretch.length;
                (end, what) = (x, What::Touch(row, rate.min(0.0)));
            }
        }
    }
    (end * stretch.length, what)
}

/// Where a push vanishes, before `end`.
fn vanishes(stretch: &Stretch, terms: &Terms, tolerance: f64, end: f64) -> Option<f64> {
    if stretch.is_noise(terms) {
        // A side that holds without a push is not opened by round-off.
        return None;
    }
    let size: f64 = terms.iter().map(|term| term.abs()).sum();
    if terms[0] > stretch.noise {
        return first_zero(terms, tolerance * size, end);
    }
    // It starts from nothing: what comes next decides.
    let mut left = *terms;
    let first = left.iter().position(|term| term.abs() > stretch.noise)?;
    left.iter_mut().take(first).for_each(|term| *term = 0.0);
    if left[first] < 0.0 {
        return Some(0.0);
    }
    let (_, left) = without_zeros(&left);
    first_zero(&left, tolerance * size, end)
}
