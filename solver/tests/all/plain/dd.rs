//! Double-double arithmetic: a number as the unevaluated sum of two `f64`,
//! good to about 32 digits (Dekker 1971, Knuth TAOCP 4.2.2).
//!
//! The plain stepper computes in it so that its difference from the program is
//! the round-off of the program alone, even after a million steps and with
//! contact rows that are equal to 20 digits.

use std::cmp::Ordering;
use std::ops::{Add, AddAssign, Div, Mul, Neg, Sub, SubAssign};
use std::sync::LazyLock;

/// `0 + 1`, the second part at most half a unit in the last place of the first.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Dd(pub f64, pub f64);

pub const ZERO: Dd = Dd(0.0, 0.0);
pub const ONE: Dd = Dd(1.0, 0.0);
pub const TAU: Dd = Dd(std::f64::consts::TAU, 2.449_293_598_294_706_4e-16);
const HALF_PI: Dd = Dd(std::f64::consts::FRAC_PI_2, 6.123_233_995_736_766e-17);

/// `1/((j + 1)(j + 2))`: from each term of a sine or cosine to the next.
static RATIOS: LazyLock<[Dd; 30]> =
    LazyLock::new(|| std::array::from_fn(|j| ONE / Dd::from((j as f64 + 1.0) * (j as f64 + 2.0))));

/// `a + b` exactly.
#[inline(always)]
fn two_sum(a: f64, b: f64) -> Dd {
    let s = a + b;
    let t = s - a;
    Dd(s, (a - (s - t)) + (b - t))
}

/// `a + b` exactly where `|a| >= |b|`.
#[inline(always)]
fn quick_sum(a: f64, b: f64) -> Dd {
    let s = a + b;
    Dd(s, b - (s - a))
}

/// `a * b` exactly, by splitting both into halves of 26 digits.
#[inline(always)]
fn two_product(a: f64, b: f64) -> Dd {
    let split = |x: f64| {
        let t = 134_217_729.0 * x;
        let high = t - (t - x);
        (high, x - high)
    };
    let p = a * b;
    let ((ah, al), (bh, bl)) = (split(a), split(b));
    Dd(p, ((ah * bh - p) + ah * bl + al * bh) + al * bl)
}

impl Dd {
    pub fn value(self) -> f64 {
        self.0 + self.1
    }

    pub fn is_finite(self) -> bool {
        self.0.is_finite() && self.1.is_finite()
    }

    /// Square root of a number zero or more: one Newton step from the double.
    pub fn sqrt(self) -> Self {
        if self.0 <= 0.0 {
            return ZERO;
        }
        let near = Dd::from(self.0.sqrt());
        near + (self - near * near) / (near + near)
    }

    /// Rest of an angle in `[-pi, pi]`, to round-off of its ends.
    pub fn reduced(self) -> Self {
        self - TAU * Dd::from((self.0 / TAU.0).round())
    }

    /// `(sin, cos)` by their Taylor series after reduction to an eighth of a
    /// turn, where 30 terms leave 1e-33.
    pub fn sin_cos(self) -> (Self, Self) {
        let angle = self.reduced();
        let quarters = (angle.0 / HALF_PI.0).round();
        let x = angle - HALF_PI * Dd::from(quarters);
        let square = x * x;
        let series = |first: Dd, start: usize| {
            let (mut sum, mut term) = (first, first);
            for ratio in RATIOS.iter().skip(start).step_by(2) {
                term = -(term * square * *ratio);
                sum += term;
                if term.0.abs() < 1e-34 {
                    break;
                }
            }
            sum
        };
        let (sin, cos) = (series(x, 1), series(ONE, 0));
        match (quarters as i64).rem_euclid(4) {
            0 => (sin, cos),
            1 => (cos, -sin),
            2 => (-sin, -cos),
            _ => (-cos, sin),
        }
    }
}

impl From<f64> for Dd {
    fn from(x: f64) -> Self {
        Dd(x, 0.0)
    }
}

impl From<u64> for Dd {
    /// Exact below 2^53, beyond any number of steps.
    fn from(n: u64) -> Self {
        Dd(n as f64, 0.0)
    }
}

impl PartialOrd for Dd {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        match self.0.partial_cmp(&other.0) {
            Some(Ordering::Equal) => self.1.partial_cmp(&other.1),
            order => order,
        }
    }
}

impl Neg for Dd {
    type Output = Self;
    #[inline(always)]
    fn neg(self) -> Self {
        Dd(-self.0, -self.1)
    }
}

impl Add for Dd {
    type Output = Self;
    #[inline(always)]
    fn add(self, other: Self) -> Self {
        let (high, low) = (two_sum(self.0, other.0), two_sum(self.1, other.1));
        let first = quick_sum(high.0, high.1 + low.0);
        quick_sum(first.0, first.1 + low.1)
    }
}

impl Sub for Dd {
    type Output = Self;
    #[inline(always)]
    fn sub(self, other: Self) -> Self {
        self + -other
    }
}

impl Mul for Dd {
    type Output = Self;
    #[inline(always)]
    fn mul(self, other: Self) -> Self {
        let p = two_product(self.0, other.0);
        quick_sum(p.0, p.1 + (self.0 * other.1 + self.1 * other.0))
    }
}

impl Div for Dd {
    type Output = Self;
    fn div(self, other: Self) -> Self {
        let first = self.0 / other.0;
        let rest = self - other * Dd::from(first);
        let second = rest.0 / other.0;
        let rest = rest - other * Dd::from(second);
        quick_sum(first, second) + Dd::from(rest.0 / other.0)
    }
}

impl AddAssign for Dd {
    #[inline(always)]
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl SubAssign for Dd {
    #[inline(always)]
    fn sub_assign(&mut self, other: Self) {
        *self = *self - other;
    }
}

impl std::iter::Sum for Dd {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(ZERO, Add::add)
    }
}
