//! Stiffnesses of a mistuned disk (docs/theory.md, section 10).

use std::f64::consts::TAU;

use crate::scene::Scene;

/// Stiffness of each blade beyond `k_b`, `sd x_i k_b` with `x_i` standard normal less
/// their mean, so that `k_b` is the mean stiffness \[N m/rad\]; none for a tuned disk.
pub(super) fn springs(scene: &Scene) -> Vec<f64> {
    let disk = &scene.bladed_disk;
    if disk.mistuning == 0.0 {
        return Vec::new();
    }
    let mut draw = fastrand::Rng::with_seed(u64::from(disk.mistuning_seed));
    let mut normal = || {
        // Box and Muller, from a number above 0 and one below 1.
        let (radius, angle) = ((-2.0 * (1.0 - draw.f64()).ln()).sqrt(), TAU * draw.f64());
        radius * angle.cos()
    };
    let drawn: Vec<f64> = (0..disk.blades).map(|_| normal()).collect();
    let mean = drawn.iter().sum::<f64>() / f64::from(disk.blades);
    // A spring may be soft, and none pushes away.
    let softest = drawn.iter().fold(0.0, |most: f64, x| most.max(mean - x));
    let spread = disk.stiffness_nm_per_rad * disk.mistuning.min(1.0 / softest);
    drawn.into_iter().map(|x| spread * (x - mean)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stiffnesses_are_drawn_alike_on_every_machine() {
        let mut scene = Scene::base();
        scene.bladed_disk.mistuning = 0.02;
        let drawn = springs(&scene);
        assert_eq!(drawn, springs(&scene));
        scene.bladed_disk.mistuning_seed = 2;
        assert_ne!(drawn, springs(&scene));
        scene.bladed_disk.blades = 4000;
        let part = |spring: &f64| spring / (0.02 * scene.bladed_disk.stiffness_nm_per_rad);
        let parts: Vec<f64> = springs(&scene).iter().map(part).collect();
        let square = parts.iter().map(|x| x * x).sum::<f64>() / 4000.0;
        // Four standard errors.
        assert!((square - 1.0).abs() < 0.09, "{square}");
    }

    #[test]
    fn the_mean_stiffness_of_a_draw_is_that_of_the_tuned_blade() {
        let mut scene = Scene::base();
        let stiffness = scene.bladed_disk.stiffness_nm_per_rad;
        // The last is more than some of its springs can lose.
        for (blades, seed, sd) in
            [(22, 1, 0.2), (22, 2, 0.05), (3, 5, 0.2), (1, 1, 0.2), (4000, 1, 0.4)]
        {
            let disk = &mut scene.bladed_disk;
            (disk.blades, disk.mistuning_seed, disk.mistuning) = (blades, seed, sd);
            let drawn = springs(&scene);
            let mean = drawn.iter().sum::<f64>() / f64::from(blades);
            assert!(mean.abs() < 1e-14 * stiffness, "{blades} {seed}: {mean}");
            assert!(blades == 1 || drawn.iter().any(|&x| x > 0.01 * stiffness));
            assert!(drawn.iter().all(|&x| x >= -stiffness * (1.0 + 1e-12)), "{blades} {seed}");
        }
    }
}
