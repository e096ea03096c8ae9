//! Margins of scenes that others leave out: a ramp, pulses that pull, little damping, targets
//! far away.

use rubscope_solver::motion::{Motion, to_the_end};
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::study::margins::{LimitName, Target, first_touch, grazing_pulse};

use crate::margins::{close, differenced, of};
use crate::scene;

#[test]
fn a_ramp_moves_the_touching_pulse() {
    for ramp in ["3e5", "-2e5"] {
        let scene = scene("slip", &[("operation.speed_ramp_rad_s2", ramp)]);
        let limit = of(&scene, LimitName::TouchingPulse);
        let found = limit.value.unwrap();
        let value = |scene: &CheckedScene| grazing_pulse(scene, 3.0 * found).unwrap();
        for path in ["operation.speed_ramp_rad_s2", "operation.speed_rad_s", "operation.pulse_s"] {
            let expected = differenced(&scene, path, &value);
            assert!(expected.abs() > 1e-4, "{path}: {expected}");
            close(limit.sensitivities.by(path), expected, 1e-6, path);
        }
    }
}

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

#[test]
fn a_later_swing_is_waited_for_where_little_is_damped() {
    let touch = |damping: &str| {
        let changes = [("casing.damping_ratio", damping), ("solver.end_s", "0.1")];
        let scene = scene("undamped", &changes);
        let period = std::f64::consts::TAU / scene.machine().omega_c;
        (first_touch(&scene, 1e6).unwrap(), scene.operation.pulse_s + period)
    };
    let ((little, swing), (much, _)) = (touch("1e-6"), touch("0.02"));
    assert!(little.t_s > swing && much.t_s < swing, "{little:?} {much:?}");
}

#[test]
fn a_search_stops_where_it_is_told_to() {
    let target = Target::parse("omega_lock=450", "casing.damping_ratio").unwrap();
    assert_eq!(target.solve(&scene("slip", &[]), &|| false), None);
}

#[test]
fn targets_far_away_and_at_zero() {
    let scene = scene("paper-nd3", &[]);
    let solve =
        |text: &str, by: &str| Target::parse(text, by).unwrap().solve(&scene, &to_the_end).unwrap();
    // A mass of a ten thousandth.
    let critical = of(&scene, LimitName::OmegaC).value.unwrap();
    let found = solve(&format!("omega_c={}", 100.0 * critical), "casing.modal_mass_kg");
    close(found.to, found.from * 1e-4, 1e-12, "mass");
    let (met, tried) = (found.met.unwrap(), found.tried);
    assert!(met[0] <= critical && met[1] >= 100.0 * critical && tried[1] >= found.from);
    // Damping of nearly nothing lowers the threshold to nearly the critical speed.
    let found = solve(&format!("omega_lock={}", critical * (1.0 + 1e-9)), "casing.damping_ratio");
    let to = found.to.unwrap();
    assert!(to > 0.0 && to < 1e-8, "{to}");
}

#[test]
fn a_pulse_is_below_at_or_beyond_its_limit() {
    let base = scene("slip", &[]);
    let value = of(&base, LimitName::TouchingPulse).value.unwrap();
    for change in [0.0, 1e-8, -1e-8] {
        let part = 1.0 + change;
        let there = scene("slip", &[("operation.pulse_n", &format!("{:?}", part * value))]);
        let margin = of(&there, LimitName::TouchingPulse).margin.unwrap();
        assert!((margin - change).abs() < 1e-9, "{change}: {margin}");
    }
}
