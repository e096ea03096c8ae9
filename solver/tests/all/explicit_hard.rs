//! Hard cases of the explicit solver: each has a right answer or a clear error;
//! nothing hangs and no report contains NaN. A new case is some keys for `run`, which
//! checks the numbers of every report, and what must be true of it.

use rubscope_solver::motion::{RunReport, Verdict, simulate};
use rubscope_solver::scene::{Scene, SceneError};

/// Runs 2 ms of the paper's machine with changes, or says why it is refused.
fn run(changes: &[(&str, &str)]) -> Result<RunReport, SceneError> {
    let mut scene = Scene::base();
    scene.set("solver.end_s", "2e-3")?;
    scene.set("solver.step_s", "1e-6")?;
    let scene = scene.with(changes)?;
    let report = simulate(&scene.checked().unwrap());
    let numbers = [
        report.r#final.t_s,
        report.r#final.u_c_m,
        report.r#final.u_s_m,
        report.r#final.alpha_c_rad,
        report.r#final.alpha_s_rad,
        report.outcome.amplitude_m,
        report.checks.max_penetration_m,
        report.checks.max_blade_angle_rad,
    ];
    assert!(numbers.iter().all(|x| x.is_finite()), "{changes:?}: {report:?}");
    assert!(report.outcome.contacts.iter().all(|contact| contact.multiplier_n.is_finite()));
    // A failure says why; everything else has no penetration beyond round-off.
    assert_eq!(report.outcome.verdict == Verdict::Failed, report.outcome.message.is_some());
    Ok(report)
}

const LAWS: [&str; 2] = ["unilateral", "bilateral"];
const MODELS: [&str; 3] = ["rigid", "modal", "full"];

#[test]
fn diameters_of_every_kind_in_every_model_and_law() {
    for law in LAWS {
        for model in MODELS {
            for diameters in ["0", "1", "4", "11", "22", "47"] {
                for speed in ["0", "292.87843515318394", "-500"] {
                    let report = run(&[
                        ("operation.nodal_diameters", diameters),
                        ("operation.speed_rad_s", speed),
                        ("solver.contact", law),
                        ("solver.model", model),
                        // Both impacts of case A, and a little more.
                        ("solver.end_s", "5e-4"),
                    ])
                    .unwrap();
                    if law == "unilateral" && report.outcome.verdict != Verdict::Failed {
                        // Eq. (15) is linear in shift and blade angle: the
                        // error is their product, besides round-off.
                        let checks = &report.checks;
                        let product = checks.max_predicted_penetration_m.unwrap()
                            * diameters.parse::<f64>().unwrap()
                            * checks.max_blade_angle_rad;
                        let deepest = checks.max_penetration_m;
                        assert!(
                            deepest <= product + 1e-18,
                            "{diameters} {speed} {model}: {deepest:e}"
                        );
                        assert_eq!(report.checks.tensile_steps, 0);
                    }
                }
            }
        }
    }
}

#[test]
fn pulses_of_nothing_and_of_a_giganewton() {
    let quiet = run(&[("operation.pulse_n", "0")]).unwrap();
    assert_eq!((quiet.outcome.verdict, quiet.impact_count), (Verdict::Decay, 0));
    assert_eq!(quiet.r#final.u_c_m, 0.0);
    let wrecked = run(&[("operation.pulse_n", "1e9")]).unwrap();
    assert_eq!(wrecked.outcome.verdict, Verdict::Failed);
}

#[test]
fn clearances_and_blades_at_the_ends_of_the_scale() {
    // Next to the radius, 1e-12 m has a relative round-off of 1e-4.
    let narrow = run(&[("casing.radius_m", "0.499900000001"), ("operation.pulse_n", "1e-4")]);
    assert!(narrow.unwrap().impact_count > 0);
    let wide = run(&[("casing.radius_m", "1.4999")]).unwrap();
    assert_eq!((wide.outcome.verdict, wide.impact_count), (Verdict::Decay, 0));
    // Blades this stiff or light need too short steps.
    for change in
        [("bladed_disk.stiffness_nm_per_rad", "1e12"), ("bladed_disk.inertia_kg_m2", "1e-9")]
    {
        let refused = run(&[change]).unwrap_err().to_string();
        assert!(
            refused.starts_with("solver.step_s = 1e-6: allowed is above 0 and below"),
            "{refused}"
        );
        run(&[change, ("solver.model", "rigid")]).unwrap();
    }
}

#[test]
fn steps_under_at_and_over_the_stability_limit() {
    let limit = Scene::base().stable_step();
    let with = |step: f64| {
        run(&[
            ("solver.step_s", &step.to_string()),
            ("operation.speed_rad_s", "10"),
            ("solver.end_s", "0.1"),
        ])
    };
    let just_under = with(limit * (1.0 - 1e-9)).unwrap();
    // Stable but not accurate: bounded, or failed in contact.
    assert!(just_under.outcome.amplitude_m < 1.0);
    for step in [limit, limit * (1.0 + 1e-9), 10.0 * limit] {
        let refused = with(step).unwrap_err().to_string();
        assert!(refused.contains("stability limit 2/omega_max"), "{refused}");
    }
}

#[test]
fn undamped_flight_keeps_its_energy() {
    let report = run(&[
        ("casing.damping_ratio", "0"),
        ("operation.pulse_n", "3000"),
        ("solver.end_s", "10"),
    ])
    .unwrap();
    assert_eq!((report.outcome.verdict, report.impact_count), (Verdict::Decay, 0));
    // A standing vibration of u_c alone: |u| and its rate on one ellipse, to
    // the second order of the step.
    let omega = Scene::base().machine().omega_c;
    let amplitude = 3000.0 * 50e-6 / 2.0 / omega;
    assert!(report.r#final.u_s_m == 0.0 && report.r#final.u_c_m.abs() <= amplitude * (1.0 + 1e-3));
}

#[test]
fn a_start_may_be_round_off_beyond_a_side_and_no_more() {
    let depth = Scene::base().clearance();
    for (part, taken) in [(1e-13, true), (1e-11, false)] {
        let start = (-depth * (1.0 + part)).to_string();
        let ran = run(&[("initial.u_c_m", &start), ("operation.pulse_n", "0")]);
        assert_eq!(ran.is_ok(), taken, "{part}");
    }
}
