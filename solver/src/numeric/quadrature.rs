//! Gauss-Legendre quadrature of smooth oscillating functions: panels of four radians of the fastest
//! oscillation with eight nodes each, error about 1e-13.
//!
//! Cost: two evaluations a radian, but at least eight (four for an interval up to `FEW_NODES`) and
//! at most eight in each of `MOST_PANELS` panels.

/// Phase angle up to which four nodes are exact to round-off \[rad\].
const FEW_NODES: f64 = 0.3;

/// Largest number of panels.
const MOST_PANELS: f64 = 1e7;

/// Integrates two functions over `[0, s]`; `rate` is their highest angular frequency.
pub(crate) fn quadrature(s: f64, rate: f64, integrand: impl Fn(f64) -> [f64; 2]) -> [f64; 2] {
    let mut sums = [0.0; 2];
    if s <= 0.0 {
        return sums;
    }
    let turns = rate * s;
    // The relative error with four nodes is 6e-10 times the ninth power of the phase angle.
    let rule: &[(f64, f64)] = if turns < FEW_NODES { &GAUSS_4 } else { &GAUSS_8 };
    let panels = (0.25 * turns).ceil().clamp(1.0, MOST_PANELS);
    let half = 0.5 * s / panels;
    let mut panel = 0.0;
    while panel < panels {
        let middle = (2.0 * panel + 1.0) * half;
        for &(node, weight) in rule {
            for signed in [-node, node] {
                let values = integrand(middle + half * signed);
                for (sum, value) in sums.iter_mut().zip(values) {
                    *sum += half * weight * value;
                }
            }
        }
        panel += 1.0;
    }
    sums
}

/// Positive nodes on the interval [-1, 1], with their weights.
const GAUSS_4: [(f64, f64); 2] = [
    (0.339_981_043_584_856_26, 0.652_145_154_862_546_1),
    (0.861_136_311_594_052_6, 0.347_854_845_137_453_85),
];
/// As [`GAUSS_4`], with eight nodes.
pub(crate) const GAUSS_8: [(f64, f64); 4] = [
    (0.183_434_642_495_649_8, 0.362_683_783_378_362),
    (0.525_532_409_916_329, 0.313_706_645_877_887_3),
    (0.796_666_477_413_626_7, 0.222_381_034_453_374_48),
    (0.960_289_856_497_536_3, 0.101_228_536_290_376_26),
];

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadrature_is_exact_for_what_the_solver_asks() {
        for (s, rate) in [(1.0, 1.0), (7.0, 1.0), (0.04, 1.0), (3.0, 5.0)] {
            let [a, b] = quadrature(s, rate, |t| [(rate * t).sin(), 1.0]);
            // At these angles the error of both rules is round-off.
            assert!((a - (1.0 - (rate * s).cos()) / rate).abs() < 1e-13 * s.max(1.0));
            assert!((b - s).abs() < 1e-14 * s);
        }
    }
}
