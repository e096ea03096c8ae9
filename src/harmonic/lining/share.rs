//! How much of a wave meets a lining, and its mean over the depth in which the lining
//! sets in, both in lengths of the wave's amplitude (docs/theory.md, section 10).
//!
//! `S(r) = (N k_p/2 pi) mean(-g0/r, eps/r)`: the mean of `f - sin f cos f`, `cos f = -x`,
//! over `x` from `(-g0 - eps)/r` to `-g0/r`. A wide one is a difference of closed forms, a
//! narrow one is summed without losing a digit.

use std::f64::consts::PI;

use crate::numeric::quadrature::GAUSS_8;
use crate::tolerances::LINING_DIVIDED;

/// Share of a wave of amplitude 1 that meets a linear lining of depth `x`:
/// `f - sin f cos f` with `cos f = -x`; `pi` where no blade lifts off.
fn share(x: f64) -> f64 {
    if x >= 1.0 {
        PI
    } else if x <= -1.0 {
        0.0
    } else {
        let angle = (-x).acos();
        let sin = ((1.0 - x) * (1.0 + x)).sqrt();
        angle + sin * x
    }
}

/// Its derivative, `2 sin f`.
fn share_slope(x: f64) -> f64 {
    2.0 * ((1.0 - x) * (1.0 + x)).max(0.0).sqrt()
}

/// `int_{-inf}^{x} share`: `sin f - sin^3 f/3 - f cos f`.
fn whole(x: f64) -> f64 {
    if x >= 1.0 {
        return PI * x;
    }
    if x <= -1.0 {
        return 0.0;
    }
    let angle = (-x).acos();
    let sin = ((1.0 - x) * (1.0 + x)).sqrt();
    sin - sin * sin * sin / 3.0 + angle * x
}

/// The mean of `share` over a lining from `depth - width` to `depth`.
pub(super) fn mean(depth: f64, width: f64) -> f64 {
    if width > LINING_DIVIDED {
        return (whole(depth) - whole(depth - width)) / width;
    }
    averaged(depth, width, share)
}

/// How that mean changes with the logarithm of the amplitude, of which depth and width
/// are both parts: `mean - [x share]/width` between its ends.
pub(super) fn mean_change(depth: f64, width: f64) -> f64 {
    if width > LINING_DIVIDED {
        let low = depth - width;
        return mean(depth, width) - (depth * share(depth) - low * share(low)) / width;
    }
    -averaged(depth, width, |x| x * share_slope(x))
}

/// A mean by quadrature, exact to round-off over a narrow lining: cut at its kinks, with
/// a substitution that takes their roots away.
fn averaged(depth: f64, width: f64, of: impl Fn(f64) -> f64) -> f64 {
    if width == 0.0 {
        return of(depth);
    }
    let low = depth - width;
    let mut cuts = vec![0.0];
    cuts.extend([-1.0, 1.0].map(|kink| (kink - low) / width).iter().filter(|c| inside(**c)));
    cuts.push(1.0);
    let pieces = cuts.windows(2).map(|piece| {
        let [start, end] = [piece[0], piece[1]];
        let node = |u: f64, weight: f64| {
            let place = start + (end - start) * u * u * (3.0 - 2.0 * u);
            0.5 * weight * 6.0 * u * (1.0 - u) * of(low + width * place)
        };
        let both = |&(x, weight): &(f64, f64)| {
            node(0.5 * (1.0 - x), weight) + node(0.5 * (1.0 + x), weight)
        };
        (end - start) * GAUSS_8.iter().map(both).sum::<f64>()
    });
    pieces.sum()
}

fn inside(part: f64) -> bool {
    part > 0.0 && part < 1.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn closed_form_and_quadrature_meet_where_one_takes_over() {
        for depth in [-1.0003, -0.9999, -0.2, 0.0, 0.7, 0.9995, 1.0002, 1.3] {
            let width = LINING_DIVIDED;
            let closed = (whole(depth) - whole(depth - width)) / width;
            let summed = averaged(depth, width, share);
            assert!((closed - summed).abs() < 2e-12, "{depth}: {closed} {summed}");
        }
    }
}
