//! Margins of scenes that others leave out: a ramp, pulses that pull, little damping, targets
//! far away.

use rubscope_solver::motion::Motion;
use rubscope_solver::study::margins::{LimitName, grazing_pulse};

use crate::margins::{close, of};
use crate::scene;

#[test]
fn a_sure_pulse_is_found_however_strong_the_first_guess_is() {
    let usual = of(&scene("paper-nd3", &[]), LimitName::TouchingPulse).value;
    // A run under this pulse ends at its first contact.
    close(grazing_pulse(&scene("paper-nd3", &[]), 1e12), usual.unwrap(), 1e-12, "1e12 N");
    // What drives the blades moves nothing before they touch.
    let driven = scene("paper-nd3", &[("excitation.amplitude_nm", "5")]);
    assert_eq!(of(&driven, LimitName::TouchingPulse).value, usual);
    // Ten times the critical damping: it creeps outward.
    let creeping = [("casing.damping_ratio", "10"), ("operation.pulse_s", "1e-6")];
    assert!(of(&scene("paper-nd3", &creeping), LimitName::TouchingPulse).value.is_some());
    // So heavy that it takes more than the key of the pulse allows.
    let heavy = [("casing.modal_mass_kg", "1e9"), ("casing.modal_stiffness_n_per_m", "1e15")];
    assert_eq!(of(&scene("slip", &heavy), LimitName::TouchingPulse).value, None);
}

#[test]
fn the_event_solver_touches_from_the_smallest_pulse_on_and_not_before() {
    let mut random = fastrand::Rng::with_seed(22);
    let mut found = 0;
    for _ in 0..60 {
        let blades = random.u32(1..40).to_string();
        let diameters = random.u32(0..12).to_string();
        let damping = 10_f64.powf(-4.0 * random.f64()).to_string();
        let speed = (1200.0 * random.f64() - 600.0).to_string();
        let long = 10_f64.powf(-6.0 + 4.5 * random.f64()).to_string();
        let pulse = if random.bool() { "1" } else { "-1" };
        let scene = scene(
            "slip",
            &[
                ("bladed_disk.blades", &blades),
                ("operation.nodal_diameters", &diameters),
                ("casing.damping_ratio", &damping),
                ("operation.speed_rad_s", &speed),
                ("operation.pulse_s", &long),
                ("operation.pulse_n", pulse),
                ("solver.model", "rigid"),
                ("solver.kind", "event"),
                ("solver.end_s", "0.08"),
            ],
        );
        let Some(touch) = of(&scene, LimitName::TouchingPulse).value else { continue };
        found += 1;
        let touches = |pulse: f64| {
            let mut scene = scene.clone().into_scene();
            scene.operation.pulse_n = pulse;
            let mut motion = Motion::new(&scene.checked().unwrap());
            let _ = motion.advance(0.08);
            motion.contacts().impact_count > 0
        };
        let sides = [1.0 - 1e-9, 1.0 + 1e-9].map(|part| touches(part * touch));
        assert_eq!(sides, [false, true], "{touch} of {:?}", scene.operation);
    }
    assert!(found > 40, "{found}");
}
