//! The pulse from which on a blade touches, in closed form.

use crate::model::{Initial, Machine};
use crate::scene::Scene;

/// The force at which the free casing, at rest before the pulse, reaches the
/// clearance \[N\]. That is the least pulse that can make contact; the blades may
/// need up to `1/cos delta` times as much, until one passes the largest
/// displacement. None where something else moves the casing too, or where it does
/// not swing.
pub fn touching_pulse(scene: &Scene, machine: &Machine) -> Option<f64> {
    let (zeta, omega) = (machine.casing_damping_ratio, machine.omega_c);
    let (length, mass) = (scene.operation.pulse_s, machine.casing_mass);
    let at_rest = scene.initial == Initial::default();
    if !at_rest || !machine.polygon.has_corners() || zeta >= 1.0 || length <= 0.0 {
        return None;
    }
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let decay = zeta * omega;
    // The displacement under a force of 1 N is greatest after half a swing, or
    // where the pulse ends before, in the free swing that follows.
    let still = 1.0 / (mass * omega * omega);
    let most = if damped * length >= std::f64::consts::PI {
        still * (1.0 + (-decay * std::f64::consts::PI / damped).exp())
    } else {
        let (sin, cos) = (damped * length).sin_cos();
        let fade = (-decay * length).exp();
        let place = still * (1.0 - fade * (cos + decay / damped * sin));
        let speed = fade * sin / (mass * damped);
        // Free: u = e^{-decay t} (place cos + b sin), at rest where its rate is 0.
        let b = (speed + decay * place) / damped;
        let angle = (damped * b - decay * place).atan2(damped * place + decay * b);
        (-decay * angle / damped).exp() * (place * angle.cos() + b * angle.sin())
    };
    let force = machine.clearance() / most;
    (force.is_finite() && force > 0.0).then_some(force)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::study::margins::grazing_pulse;

    #[test]
    fn it_is_the_least_pulse_that_makes_contact_but_for_the_angle_between_blades() {
        for (name, pulse_s, zeta) in [
            ("paper-nd3", 50e-6, 0.05),
            ("paper-nd3", 50e-6, 0.0),
            ("paper-nd4", 1e-3, 0.02),
            ("paper-nd3", 4e-3, 0.05),
        ] {
            let mut scene = Scene::builtin(name).unwrap();
            (scene.operation.pulse_s, scene.casing.damping_ratio) = (pulse_s, zeta);
            let machine = scene.machine();
            let closed = touching_pulse(&scene, &machine).unwrap();
            let found = grazing_pulse(&scene, 1e6).unwrap();
            let most = closed / machine.polygon.delta.cos() * (1.0 + 1e-9);
            assert!((closed * (1.0 - 1e-9)..=most).contains(&found), "{closed} {found}");
        }
    }

    #[test]
    fn there_is_none_where_the_casing_moves_already_or_does_not_swing() {
        let scene = Scene::builtin("paper-nd3").unwrap();
        let of = |change: fn(&mut Scene)| {
            let mut scene = scene.clone();
            change(&mut scene);
            touching_pulse(&scene, &scene.machine())
        };
        assert!(of(|_| ()).is_some());
        assert_eq!(of(|scene| scene.operation.pulse_s = 0.0), None);
        assert_eq!(of(|scene| scene.initial.v_c_m_s = 0.1), None);
        assert_eq!(of(|scene| scene.casing.damping_ratio = 1.5), None);
    }
}
