//! Random cases of laws, for the tests of the solver and of the program.

use std::ops::Range;

use fastrand::Rng;

/// Judges so many random cases, the same ones every time: the last one that is printed has failed.
/// `LAW_CASES` asks for another number of cases, `LAW_SEED` for other ones.
pub fn each_case(cases: u64, mut law: impl FnMut(&mut Rng)) {
    let asked = |name: &str| std::env::var(name).ok().map(|number| number.parse().unwrap());
    let mut rng = Rng::with_seed(asked("LAW_SEED").unwrap_or(20101));
    for case in 0..asked("LAW_CASES").unwrap_or(cases) {
        println!("case {case}");
        law(&mut rng.fork());
    }
}

/// A number of a range.
pub fn within(rng: &mut Rng, range: Range<f64>) -> f64 {
    range.start + (range.end - range.start) * rng.f64()
}

/// A number of a range, uniform in its logarithm.
pub fn scale(rng: &mut Rng, range: Range<f64>) -> f64 {
    range.start * (range.end / range.start).powf(rng.f64())
}

/// One of a list.
pub fn one_of<T: Clone>(rng: &mut Rng, list: &[T]) -> T {
    list[rng.usize(..list.len())].clone()
}

/// The first draw that is taken.
pub fn taken<T>(mut draw: impl FnMut() -> T, is_taken: impl Fn(&T) -> bool) -> T {
    (0..10_000).map(|_| draw()).find(is_taken).unwrap()
}
