//! Many steps at once of a map near its rest. A map that is not quite linear takes the
//! products of the deviations from rest, up to some degree, to linear combinations of such
//! products (Carleman): one larger matrix, of which powers are taken. So are sums over many
//! steps of what depends on the deviation: of `T^n y` they are `(T - 1)^-1` times the change
//! of `y` in all.

use std::fmt::Debug;

use nalgebra::{DMatrix, SMatrix, SVector};

use super::corner_step::Modes;
use crate::motion::explicit::oscillator::Leap;

/// Values of a step that are summed: two multipliers, and four flows of energy.
pub(super) const VALUES: usize = 6;
/// What a step changes of the modes, and its values.
pub(super) type Outcome = (Modes, [f64; VALUES]);
/// Products of four numbers up to the second and up to the third degree.
const QUADRATIC: usize = 14;
const CUBIC: usize = 34;

/// The deviation from rest over many steps.
pub(super) trait Deviations: Debug + Send + Sync {
    /// After so many steps.
    fn after(&self, steps: u64) -> Modes;
    /// Returns the sums of the values of the steps after `before`, up to `steps`.
    fn sums(&self, before: u64, steps: u64) -> [f64; VALUES];
}

/// Products of the deviations, each in parts of `scale`.
#[derive(Clone, Debug)]
pub(super) struct Unfolded<const N: usize> {
    leap: Leap<N>,
    start: SVector<f64, N>,
    scale: Modes,
    /// Values at rest, and what the products add to them.
    rest: [f64; VALUES],
    slopes: [SVector<f64, N>; VALUES],
    /// Inverse of what one step changes of the products.
    unchanged: SMatrix<f64, N, N>,
}

impl<const N: usize> Deviations for Unfolded<N> {
    fn after(&self, steps: u64) -> Modes {
        let products = self.leap.apply(self.start, steps);
        Modes::from_fn(|k, _| self.scale[k] * products[k])
    }

    fn sums(&self, before: u64, steps: u64) -> [f64; VALUES] {
        let [from, to] = [before, steps].map(|steps| self.leap.apply(self.start, steps));
        let sum = self.unchanged * (to - from);
        let count = (steps - before) as f64;
        std::array::from_fn(|k| count * self.rest[k] + self.slopes[k].dot(&sum))
    }
}

impl Unfolded<4> {
    /// Of a linear map, which adds `change` times the deviation to it; `unchanged` is the
    /// inverse of that. The values are those at rest, and the slopes those of the first two.
    pub fn linear(
        start: Modes,
        change: SMatrix<f64, 4, 4>,
        unchanged: SMatrix<f64, 4, 4>,
        rest: [f64; VALUES],
        multipliers: [Modes; 2],
    ) -> Self {
        let mut slopes = [Modes::zeros(); VALUES];
        slopes[..2].copy_from_slice(&multipliers);
        let scale = Modes::repeat(1.0);
        Self { leap: Leap::new(change), start, scale, rest, slopes, unchanged }
    }
}

/// Of a map up to the second or third degree in deviations as large as `scale`. None where
/// it fails there, or where what does not die leaves a sum without end.
pub(super) fn unfold(
    step: impl Fn(Modes) -> Option<Outcome>,
    start: Modes,
    scale: Modes,
    cubic: bool,
) -> Option<Box<dyn Deviations>> {
    Some(if cubic {
        Box::new(Unfolded::<CUBIC>::new(step, start, scale, 3)?)
    } else {
        Box::new(Unfolded::<QUADRATIC>::new(step, start, scale, 2)?)
    })
}

impl<const N: usize> Unfolded<N> {
    fn new(
        step: impl Fn(Modes) -> Option<Outcome>,
        start: Modes,
        scale: Modes,
        degree: u8,
    ) -> Option<Self> {
        let products = Products::of(degree);
        let outcomes = products.fit(step, scale)?;
        let row = |line: &[f64]| SVector::<f64, N>::from_fn(|k, _| line[k + 1]);
        let changes: [SVector<f64, N>; 4] = std::array::from_fn(|k| row(&outcomes[k]) / scale[k]);
        let mut change = SMatrix::<f64, N, N>::zeros();
        for place in 0..N {
            change.set_row(place, &products.change::<N>(place, &changes).transpose());
        }
        let unchanged = change.try_inverse().filter(|all| all.iter().all(|x| x.is_finite()))?;
        let parts = start.component_div(&scale);
        Some(Self {
            leap: Leap::new(change),
            start: SVector::from_fn(|k, _| products.at(k + 1, parts)),
            scale,
            rest: std::array::from_fn(|k| outcomes[4 + k][0]),
            slopes: std::array::from_fn(|k| row(&outcomes[4 + k])),
            unchanged,
        })
    }
}

/// The products of four numbers up to a degree, by their exponents: one, the numbers
/// themselves, those of the second degree, and so on.
struct Products {
    exponents: Vec<[u8; 4]>,
}

impl Products {
    fn of(degree: u8) -> Self {
        let mut exponents = vec![[0; 4]];
        let mut last: Vec<([u8; 4], usize)> = vec![([0; 4], 0)];
        for _ in 0..degree {
            let mut next = Vec::new();
            for (exponent, from) in &last {
                for k in *from..4 {
                    let mut higher = *exponent;
                    higher[k] += 1;
                    next.push((higher, k));
                }
            }
            exponents.extend(next.iter().map(|(exponent, _)| *exponent));
            last = next;
        }
        Self { exponents }
    }

    fn at(&self, place: usize, parts: Modes) -> f64 {
        let powers = self.exponents[place].iter().zip(&parts);
        powers.map(|(&power, part)| part.powi(i32::from(power))).product()
    }

    /// Coefficients of each outcome of a step, from as many points as there are products.
    fn fit(&self, step: impl Fn(Modes) -> Option<Outcome>, scale: Modes) -> Option<Vec<Vec<f64>>> {
        const NODES: [f64; 4] = [0.0, 1.0, -1.0, 0.5];
        let count = self.exponents.len();
        let mut points = DMatrix::zeros(count, count);
        let mut found = DMatrix::zeros(count, 4 + VALUES);
        for (row, exponent) in self.exponents.iter().enumerate() {
            let parts = Modes::from_fn(|k, _| NODES[usize::from(exponent[k])]);
            for column in 0..count {
                points[(row, column)] = self.at(column, parts);
            }
            let (change, values) = step(parts.component_mul(&scale))?;
            let outcomes = change.iter().chain(&values);
            outcomes.enumerate().for_each(|(column, value)| found[(row, column)] = *value);
        }
        let fitted = points.lu().solve(&found)?;
        Some(fitted.column_iter().map(|column| column.iter().copied().collect()).collect())
    }

    /// What a step that adds `changes` to the four numbers adds to a product (from 0, the
    /// first number), up to the degree.
    fn change<const N: usize>(
        &self,
        place: usize,
        changes: &[SVector<f64, N>; 4],
    ) -> SVector<f64, N> {
        let (mut exponent, mut added) = ([0_u8; 4], SVector::<f64, N>::zeros());
        for (k, change) in changes.iter().enumerate() {
            for _ in 0..self.exponents[place + 1][k] {
                // (A + a)(y + c) - A y = A c + a y + a c
                let mut unit = [0; 4];
                unit[k] = 1;
                let mut next = self.times::<N>(exponent, change) + self.times::<N>(unit, &added);
                for (other, value) in self.exponents[1..].iter().zip(&added) {
                    if *value != 0.0 {
                        next += self.times::<N>(*other, change) * *value;
                    }
                }
                exponent[k] += 1;
                added = next;
            }
        }
        added
    }

    /// Returns a product times a sum of products, up to the degree.
    fn times<const N: usize>(&self, by: [u8; 4], sum: &SVector<f64, N>) -> SVector<f64, N> {
        let mut result = SVector::<f64, N>::zeros();
        for (exponent, value) in self.exponents[1..].iter().zip(sum) {
            let both: [u8; 4] = std::array::from_fn(|k| exponent[k] + by[k]);
            let place = self.exponents[1..].iter().position(|known| *known == both);
            if let Some(place) = place {
                result[place] += value;
            }
        }
        result
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A turn that loses energy, and bends as its square and cube.
    fn step(at: Modes) -> Modes {
        let pull = 1e-4 * (at[0] + 0.3 * at[0] * at[0] - 0.2 * at[1] * at[0] * at[0]);
        let other = 2e-4 * (at[1] - 0.2 * at[0] * at[1] + 0.1 * at[1] * at[1] * at[1]);
        let rates = [-pull - 1e-4 * at[2], -other - 1e-4 * at[3]];
        Modes::new(at[2] + rates[0], at[3] + rates[1], rates[0], rates[1])
    }

    #[test]
    fn many_steps_are_those_taken_one_by_one_to_the_power_that_is_left_out() {
        let error = |size: f64, cubic: bool| {
            let start = Modes::new(1.0, -0.7, 0.004, 0.006) * size;
            let scale = Modes::new(1.0, 1.0, 0.01, 0.01) * size;
            let of = |at: Modes| (step(at), [at[0], at[1] * at[1], 0.0, 0.0, 0.0, 1.0]);
            let map = unfold(|at| Some(of(at)), start, scale, cubic).unwrap();
            let (mut at, mut sums, mut worst) = (start, [0.0; VALUES], 0.0_f64);
            for n in 1..=4000_u64 {
                let (change, values) = of(at);
                sums.iter_mut().zip(values).for_each(|(sum, value)| *sum += value);
                at += change;
                if n % 50 == 0 {
                    let apart = (map.after(n) - at).component_div(&scale).amax();
                    worst = worst.max(apart);
                }
            }
            let found = map.sums(1000, 4000);
            let before = map.sums(0, 1000);
            assert!((found[5] + before[5] - 4000.0).abs() < 1e-9);
            for (k, most) in [(0, size), (1, size * size)] {
                // A mean of the steps; what dies by 2e-4 a step costs as many digits of its sum.
                let apart = (found[k] + before[k] - sums[k]).abs() / (4000.0 * most);
                assert!(apart < 1e-10 + worst, "{k} {apart:e} {worst:e}");
            }
            worst
        };
        for (cubic, power) in [(false, 2.0), (true, 3.0)] {
            let (coarse, fine) = (error(0.04, cubic), error(0.02, cubic));
            let found = (coarse / fine).log2();
            assert!((found - power).abs() < 0.3, "{cubic}: {coarse:e} {fine:e} {found}");
        }
        assert!(error(1e-4, true) < 1e-11);
    }
}
