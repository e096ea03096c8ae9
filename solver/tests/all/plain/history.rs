//! The contacts of each step, in runs of equal steps.

use super::BREAK_STEPS;

/// Steps in a row that all touch with the same sides.
#[derive(Clone, Debug, PartialEq)]
pub struct Span {
    pub first: u64,
    pub last: u64,
    /// In increasing order.
    pub sides: Vec<u32>,
    /// Whether a multiplier was tensile in each of these steps.
    pub pulled: bool,
}

/// Every step that touched so far.
#[derive(Clone, Debug, Default)]
pub struct History {
    pub spans: Vec<Span>,
}

/// The contacts in the last part of a run.
#[derive(Clone, Debug, PartialEq)]
pub struct Window {
    /// Something touched.
    pub touched: bool,
    /// Contact from before the window until now without more than two steps
    /// between touches.
    pub unbroken: bool,
    /// The sides, if they were the same from before the window until now
    /// without a break.
    pub kept: Option<Vec<u32>>,
    /// A multiplier was tensile.
    pub pulled: bool,
}

impl History {
    pub fn touch(&mut self, n: u64, sides: Vec<u32>, pulled: bool) {
        match self.spans.last_mut() {
            Some(span) if span.last + 1 == n && span.sides == sides && span.pulled == pulled => {
                span.last = n;
            }
            _ => self.spans.push(Span { first: n, last: n, sides, pulled }),
        }
    }

    /// First step since when something has touched without a break until `now`.
    pub fn unbroken_since(&self, now: u64) -> Option<u64> {
        self.back_while(now, |_, _| true)
    }

    /// First step since when the same sides have touched without a break.
    pub fn kept_since(&self, now: u64) -> Option<u64> {
        self.back_while(now, |a, b| a.sides == b.sides)
    }

    fn back_while(&self, now: u64, alike: impl Fn(&Span, &Span) -> bool) -> Option<u64> {
        let last = self.spans.last().filter(|span| now <= span.last + BREAK_STEPS)?;
        let mut first = last.first;
        for pair in self.spans.windows(2).rev() {
            if pair[1].first > pair[0].last + BREAK_STEPS + 1 || !alike(&pair[0], &pair[1]) {
                break;
            }
            first = pair[0].first;
        }
        Some(first)
    }

    /// The steps `from ..= now`.
    pub fn window(&self, from: u64, now: u64) -> Window {
        let within = || self.spans.iter().rev().take_while(|span| span.last >= from);
        let kept = self.kept_since(now).filter(|&first| first <= from);
        Window {
            touched: within().next().is_some(),
            unbroken: self.unbroken_since(now).is_some_and(|first| first <= from),
            kept: kept.and_then(|_| self.spans.last().map(|span| span.sides.clone())),
            pulled: within().any(|span| span.pulled),
        }
    }
}
