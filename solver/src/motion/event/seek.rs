//! The event that ends a stretch: the first gap that closes or contact force that vanishes. No
//! change of contact is missed, however short (`series`).
//!
//! A gap that has just opened is stored separately, with its full relative accuracy, so that rocking
//! at a corner and bouncing on a side are resolved down to round-off.

use super::flow::{EVENT, Flow};
use super::series::{Gap, Terms, curved_step, gap, jounce};
use super::stretch::{Held, Stretch};

/// Evaluations of a gap in the search for its zero, at most.
const MOST_TRIES: f64 = 10_000.0;

/// Event that ends a stretch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Ending {
    /// The gap of a row closes with this rate, which is zero or negative \[m/s\].
    Touch(usize, f64),
    /// The contact force of a row vanishes.
    Release(usize),
    /// Rocking into a corner has come to rest.
    Lock,
    /// The series ends, without a change of contact.
    StretchEnd,
}

/// A gap that has just opened, stored separately to keep its relative accuracy.
#[derive(Clone, Copy, Debug)]
pub(super) struct OpenedGap {
    /// Index of the row.
    pub row: usize,
    /// Gap \[m\].
    pub gap: f64,
    /// Rate of the gap \[m/s\].
    pub rate: f64,
    /// Whether the contact force has just vanished, so that the acceleration is zero.
    pub released: bool,
    /// Whether an impact opened it.
    pub struck: bool,
}

impl OpenedGap {
    /// Returns the gap as a power series over the stretch: `x` to the returned power, times the rest.
    fn terms(&self, flow: &Flow, stretch: &Stretch) -> (usize, Terms) {
        let mut terms = stretch.gap(flow, self.row);
        (terms[0], terms[1]) = (self.gap, self.rate * stretch.length);
        if self.released {
            terms[2] = 0.0;
        }
        (leading_zeros(&terms), terms)
    }

    /// Advances the gap by `s` seconds.
    pub(super) fn later(&self, flow: &Flow, stretch: &Stretch, s: f64) -> Self {
        let (order, terms) = self.terms(flow, stretch);
        let (gap, rate) = grown(order, &terms[order..], s / stretch.length);
        Self { gap: gap.max(0.0), rate: rate / stretch.length, released: false, ..*self }
    }
}

/// Returns the number of leading zero terms, of the first three.
fn leading_zeros(terms: &[f64]) -> usize {
    terms.iter().take(3).take_while(|&&term| term == 0.0).count()
}

/// Returns value and derivative of `x^order left(x)`.
fn grown(order: usize, left: &[f64], x: f64) -> (f64, f64) {
    let Gap { gap: value, rate, .. } = gap(left, x);
    let power = |n: usize| x.powi(i32::try_from(n).unwrap_or(0));
    let grows = if order == 0 { 0.0 } else { order as f64 * power(order - 1) * value };
    (power(order) * value, grows + power(order) * rate)
}

/// Returns the first `x` up to `end` at which the series falls to `noise`, and its derivative there;
/// `None` if it does not.
fn first_zero(terms: &[f64], noise: f64, end: f64) -> Option<(f64, f64)> {
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
        if (now.gap <= noise && now.rate < 0.0) || looks > MOST_TRIES {
            return Some((x, now.rate));
        }
        x = (x + curved_step(now.above(noise), bound, 1.0 - x)).max(x.next_up());
    }
    None
}

/// Finds the event that ends a stretch, and its time \[s\].
pub(super) fn seek(
    flow: &Flow,
    stretch: &Stretch,
    held: &Held,
    opened: &[OpenedGap],
) -> (f64, Ending) {
    let (mut end, mut what) = (1.0, Ending::StretchEnd);
    for (&row, terms) in held.rows.iter().zip(&stretch.pushes) {
        if let Some(x) = vanishes(stretch, terms, flow.tolerance, end) {
            (end, what) = (x, Ending::Release(row));
        }
    }
    for open in opened {
        let (order, terms) = open.terms(flow, stretch);
        let left = &terms[order..];
        if left[0] < 0.0 {
            return (0.0, Ending::Touch(open.row, open.rate.min(0.0)));
        }
        let noise = flow.tolerance.max(EVENT) * left[0];
        if let Some((x, rate)) = first_zero(left, noise, end) {
            // At the zero itself only the derivative of the reduced series contributes.
            let slope = rate * x.powi(i32::try_from(order).unwrap_or(0));
            (end, what) = (x, Ending::Touch(open.row, (slope / stretch.length).min(0.0)));
        }
    }
    let [travel, reach] = stretch.travel;
    // A part of the stretch has at most that part of the travel.
    let travel = end * travel;
    if reach + travel >= flow.least_clearance() {
        let noise = flow.tolerance * (flow.clearance() + reach + travel);
        let from = &stretch.from;
        for row in flow.near(from, travel + noise, held.rows.first().copied()) {
            let known = || held.rows.contains(&row) || opened.iter().any(|gap| gap.row == row);
            if stretch.least_gap(flow, row, end) > noise || known() {
                continue;
            }
            if let Some((x, rate)) = first_zero(&stretch.gap(flow, row), noise, end) {
                (end, what) = (x, Ending::Touch(row, (rate / stretch.length).min(0.0)));
            }
        }
    }
    (end * stretch.length, what)
}

/// Returns the fraction of the stretch at which a contact force vanishes; `None` if it does not
/// before `end`, or if there is none: a row in contact without a force is not opened by round-off.
fn vanishes(stretch: &Stretch, terms: &[f64], tolerance: f64, end: f64) -> Option<f64> {
    let size: f64 = terms.iter().map(|term| term.abs()).sum();
    if terms[0] > stretch.noise {
        return first_zero(terms, tolerance * size, end).map(|(x, _)| x);
    }
    // The force starts at zero: its first nonzero term decides.
    let first = terms.iter().position(|term| term.abs() > stretch.noise)?;
    if terms[first] < 0.0 {
        return Some(0.0);
    }
    first_zero(&terms[first..], tolerance * size, end).map(|(x, _)| x)
}
