//! The locked motion against speed that view 3 draws: the harmonic balance
//! with and without damping, over a round range of speeds.

use crate::harmonic::{Form, Sweep, locked_motion};
use crate::scene::Scene;
use crate::tui::axis::nice_step;

/// Speeds of one curve.
const POINTS: u32 = 161;

/// Multipliers over speed of one machine.
#[derive(Clone, Debug, PartialEq)]
pub struct LockedCurves {
    /// The end of the speed range, which begins at 0 \[rad/s\].
    pub fastest: f64,
    /// With the damping of the scene; none where there is no locked motion.
    pub damped: Option<Sweep>,
    /// Without damping, as in the paper; none for a machine without damping.
    pub undamped: Option<Sweep>,
}

impl LockedCurves {
    /// The curves of a scene's machine.
    pub fn of(scene: &Scene) -> Self {
        let machine = scene.machine();
        let fastest = speed_range(scene);
        let step = fastest / f64::from(POINTS - 1);
        // A rotor that turns backwards has its own locked motion; it is drawn over |Ω|.
        let sense = scene.operation.speed_rad_s.signum();
        let speeds: Vec<f64> = (0..POINTS).map(|k| sense * f64::from(k) * step).collect();
        let curve = |damped| locked_motion(&machine, Form::Modal, damped, None, &speeds).ok();
        let has_damping = machine.casing_damping > 0.0;
        Self { fastest, damped: curve(true), undamped: has_damping.then(|| curve(false)).flatten() }
    }
}

/// A round speed above every threshold and the present speed \[rad/s\].
pub fn speed_range(scene: &Scene) -> f64 {
    let machine = scene.machine();
    let of_interest =
        [machine.lock_speed(), machine.dangerous_speed(), Some(scene.operation.speed_rad_s.abs())];
    let most = of_interest.into_iter().flatten().filter(|s| s.is_finite()).fold(1.0, f64::max);
    let step = nice_step(most * 1.1, 6).unwrap_or(most);
    (most * 1.05 / step).ceil() * step
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_curves_reach_beyond_every_threshold_and_meet_the_closed_form() {
        let scene = Scene::base();
        let curves = LockedCurves::of(&scene);
        let machine = scene.machine();
        assert!(curves.fastest > 500.0 && curves.fastest > machine.lock_speed().unwrap());
        let last = *curves.damped.unwrap().points.last().unwrap();
        let closed = machine.locked_multipliers(curves.fastest).unwrap();
        for (lambda, exact) in last.multipliers_n.iter().zip(closed) {
            // Flexible blades change a multiplier by parts in a million.
            assert!((lambda - exact).abs() < 1e-4 * exact.abs(), "{lambda} {exact}");
        }
    }

    #[test]
    fn a_wave_without_corners_has_no_curves() {
        let mut scene = Scene::base();
        scene.operation.nodal_diameters = 11;
        assert_eq!(LockedCurves::of(&scene).damped, None);
    }
}
