//! Scenes that once went wrong, with values from codes that share nothing with
//! this one. Each is a whole command line of `run` or `map`.

#![expect(clippy::unwrap_used, reason = "a test states what must hold")]

use rubscope::motion::{RunReport, Sampling, Verdict, settle, simulate};
use rubscope::scene::Scene;

/// The report of `run BASE --set ...`.
fn run(base: &str, changes: &[(&str, &str)]) -> RunReport {
    simulate(&scene(base, changes), Sampling::default(), &mut |_| {})
}

fn scene(base: &str, changes: &[(&str, &str)]) -> Scene {
    Scene::builtin(base).unwrap().with(changes).unwrap()
}

/// Options of the command line as the keys they set.
fn options<'a>(words: &[&'a str]) -> Vec<(&'a str, &'a str)> {
    words
        .chunks(2)
        .map(|pair| {
            let key = match pair[0] {
                "speed" => "operation.speed_rad_s",
                "pulse" => "operation.pulse_n",
                "nd" => "operation.nodal_diameters",
                "zeta-casing" => "casing.damping_ratio",
                "zeta-disk" => "bladed_disk.damping_ratio",
                "solver" => "solver.kind",
                "contact" => "solver.contact",
                "model" => "solver.model",
                "step" => "solver.step_s",
                "end" => "solver.end_s",
                key => key,
            };
            (key, pair[1])
        })
        .collect()
}

#[test]
fn two_blades_a_side_move_as_their_modes_at_any_speed() {
    for (speed, u_c) in [("0.1", -4.4171e-5), ("1", -4.4171e-5), ("10", -4.4187e-5)] {
        for contact in ["unilateral", "bilateral"] {
            let words = ["nd", "2", "speed", speed, "contact", contact, "pulse", "20e3"];
            let mut changes = options(&words);
            changes.extend([("bladed_disk.blades", "12"), ("solver.step_s", "1e-6")]);
            changes.push(("solver.end_s", "0.005"));
            let modal = run("paper-nd3", &changes);
            changes.push(("solver.model", "full"));
            let full = run("paper-nd3", &changes);
            assert!((full.r#final.u_c_m - u_c).abs() < 5e-10, "{speed}: {:?}", full.r#final);
            // The blades answer an impact by all their modes: some 1e-10 of it.
            let apart = (full.r#final.u_c_m - modal.r#final.u_c_m).abs();
            assert!(apart < 1e-9 * 1e-4, "{speed} {contact}: {apart:e}");
            assert_eq!(full.checks.tensile_steps, 0);
        }
    }
    // Without any moment arm to speak of.
    for speed in ["1e-3", "1e-5", "0"] {
        let mut changes = options(&["nd", "2", "speed", speed, "model", "full", "pulse", "20e3"]);
        changes.extend([("bladed_disk.blades", "12"), ("solver.step_s", "1e-6")]);
        changes.push(("solver.end_s", "0.005"));
        let full = run("paper-nd3", &changes);
        assert!((full.r#final.u_c_m + 4.4171e-5).abs() < 5e-10, "{speed}: {:?}", full.r#final);
    }
}

#[test]
fn three_blades_a_side_slip_as_their_modes() {
    let mut changes =
        options(&["solver", "explicit", "model", "full", "end", "0.02", "step", "1e-6"]);
    changes.push(("bladed_disk.blades", "66"));
    let full = run("slip", &changes);
    changes[1].1 = "modal";
    let modal = run("slip", &changes);
    assert_eq!(full.outcome.verdict, Verdict::Slip, "{:?}", full.outcome);
    assert_eq!(full.impact_count, modal.impact_count);
    assert_eq!(full.outcome.contacts[0].blades, modal.outcome.contacts[0].blades);
    let [a, b] = [&full, &modal].map(|report| report.outcome.contacts[0].multiplier_n);
    // Blades of their own are lighter at an impact: some 1e-4 later in the motion.
    assert!((a / b - 1.0).abs() < 1e-2, "{a} {b}");
}

#[test]
fn bilateral_contact_leaves_the_open_side_of_two_alone() {
    for model in ["rigid", "modal", "full"] {
        let both = ["unilateral", "bilateral"].map(|contact| {
            let words = ["solver", "explicit", "step", "1e-6", "contact", contact, "model", model];
            run("half-n", &options(&words))
        });
        let [unilateral, bilateral] = both;
        assert_eq!(bilateral.outcome.verdict, Verdict::Slip, "{model}: {:?}", bilateral.outcome);
        assert_eq!((bilateral.impact_count, bilateral.checks.tensile_steps), (4, 0));
        assert_eq!(bilateral.r#final, unilateral.r#final);
        assert!(bilateral.checks.max_blade_angle_rad < 2e-4);
        // 2 x 11 blades, one side of them in contact.
        assert_eq!(bilateral.outcome.contacts.len(), 1, "{:?}", bilateral.outcome.contacts);
    }
    let words =
        ["solver", "explicit", "contact", "bilateral", "nd", "2", "bladed_disk.blades", "4"];
    let four = run("half-n", &options(&words));
    assert_eq!((four.outcome.verdict, four.impact_count), (Verdict::Decay, 1));
}

#[test]
fn the_largest_blade_angle_does_not_depend_on_who_looks() {
    let mut changes = options(&[
        "solver",
        "event",
        "model",
        "modal",
        "contact",
        "unilateral",
        "nd",
        "3",
        "zeta-casing",
        "0.02",
        "speed",
        "664.34",
        "pulse",
        "64692.5",
        "end",
        "0.02",
        "bladed_disk.blades",
        "13",
    ]);
    changes.push(("bladed_disk.stiffness_nm_per_rad", "708"));
    changes.push(("bladed_disk.blade_length_m", "0.499526"));
    let scene = scene("paper-nd3", &changes);
    let angles = [0, 7, 4001].map(|intervals| {
        let sampling = Sampling { intervals, gaps: false };
        simulate(&scene, sampling, &mut |_| {}).checks.max_blade_angle_rad
    });
    assert_eq!(angles[0], angles[1]);
    assert_eq!(angles[0], angles[2]);
    assert!((angles[0] - 1.495e-6).abs() < 5e-10, "{angles:?}");
}

#[test]
fn the_largest_blade_angle_is_reached_and_no_bound() {
    let mut changes = options(&[
        "contact",
        "unilateral",
        "model",
        "modal",
        "step",
        "1e-6",
        "end",
        "0.01",
        "pulse",
        "1e6",
        "zeta-disk",
        "1",
        "bladed_disk.inertia_kg_m2",
        "1e-5",
    ]);
    changes.push(("bladed_disk.stiffness_nm_per_rad", "100"));
    changes.push(("bladed_disk.coupling_nm_per_rad", "10"));
    changes.push(("bladed_disk.blade_length_m", "0.495"));
    let modal = run("paper-nd3", &changes);
    assert_eq!(modal.outcome.message, None);
    assert!((modal.checks.max_blade_angle_rad - 0.0343).abs() < 5e-5, "{:?}", modal.checks);
    changes[1].1 = "full";
    changes[6].1 = "1e-3";
    let full = run("paper-nd3", &changes);
    assert_eq!(full.outcome.message, None);
    assert!((full.checks.max_blade_angle_rad - 0.0443).abs() < 5e-5, "{:?}", full.checks);
}

#[test]
fn the_largest_blade_angle_counts_blades_that_never_touch() {
    let words = ["pulse", "0", "excitation.amplitude_nm", "3000", "end", "0.05"];
    let report = run("paper-nd3", &options(&words));
    assert!((report.checks.max_blade_angle_rad - 0.0348).abs() < 5e-5, "{:?}", report.checks);
}

#[test]
fn a_locked_wave_turns_with_the_rotor_however_long_the_run() {
    for end in ["1000", "10000", "30000"] {
        let report = run("rocking", &options(&["end", end]));
        assert_eq!(report.outcome.wave_speed_rad_s, Some(500.0));
    }
}

#[test]
fn a_slipping_wave_keeps_its_speed_in_long_runs() {
    // So long that the last tenth of it cannot be looked at closely enough.
    let [short, long] = ["1", "200"]
        .map(|end| run("slip", &options(&["end", end])).outcome.wave_speed_rad_s.unwrap());
    assert!((short - 385.3).abs() < 0.3 && (long - short).abs() < 0.05, "{short} {long}");
}

/// A lock that a resonance of the blades breaks after 85 ms.
const RESONANCE: [&str; 26] = [
    "contact",
    "unilateral",
    "model",
    "modal",
    "step",
    "1e-6",
    "end",
    "0.5",
    "zeta-disk",
    "0.002",
    "bladed_disk.stiffness_nm_per_rad",
    "319168.11740367167",
    "excitation.order",
    "3",
    "excitation.amplitude_nm",
    "1",
    "initial.u_c_m",
    "-9.9999999999989e-05",
    "initial.u_s_m",
    "-1.4377829399495726e-05",
    "initial.v_c_m_s",
    "0.017857264114173692",
    "initial.v_s_m_s",
    "-0.12419999999998634",
    "speed",
    "414",
];

#[test]
fn a_lock_under_excitation_is_not_taken_for_good() {
    let mut changes = options(&RESONANCE);
    changes.push(("operation.pulse_n", "0"));
    let scene = scene("paper-nd3", &changes);
    let settled = settle(&scene);
    assert_eq!(settled.verdict, Verdict::Decay);
    let report = simulate(&scene, Sampling::default(), &mut |_| {});
    assert_eq!(report.outcome.verdict, Verdict::Decay);
    assert!(!report.outcome.sensitive);
}

#[test]
fn a_corner_that_lets_go_again_and_again_is_no_lock() {
    for end in ["9", "9.5", "9.9", "10", "10.1", "11"] {
        let changes = options(&[
            "solver",
            "event",
            "model",
            "modal",
            "contact",
            "unilateral",
            "nd",
            "2",
            "pulse",
            "0",
            "zeta-casing",
            "0.02",
            "zeta-disk",
            "0",
            "bladed_disk.blades",
            "5",
            "bladed_disk.blade_length_m",
            "0.4981942166058344",
            "bladed_disk.inertia_kg_m2",
            "0.00041897191625480334",
            "bladed_disk.stiffness_nm_per_rad",
            "23.280659629323264",
            "bladed_disk.coupling_nm_per_rad",
            "0",
            "speed",
            "459.3731941944803",
            "initial.u_c_m",
            "-0.0018057833941655947",
            "initial.u_s_m",
            "-0.0013119784322271717",
            "initial.v_c_m_s",
            "1.2053754462529247",
            "initial.v_s_m_s",
            "-1.6590569716023988",
            "end",
            end,
        ]);
        let settled = settle(&scene("paper-nd3", &changes));
        assert_eq!(settled.verdict, Verdict::Slip, "{end}: {settled:?}");
        assert!(settled.impact_count > 2000);
    }
}

#[test]
fn only_sides_that_push_are_in_contact() {
    let words = [
        "nd",
        "1",
        "speed",
        "1500",
        "pulse",
        "20e3",
        "contact",
        "unilateral",
        "step",
        "1e-6",
        "end",
        "0.02",
        "bladed_disk.blades",
        "3",
    ];
    let report = run("paper-nd3", &options(&words));
    let blades: Vec<_> = report.outcome.contacts.iter().map(|c| c.blades.clone()).collect();
    assert_eq!(blades, [[2], [3]]);
    assert!(report.outcome.contacts.iter().all(|contact| contact.multiplier_n < -500.0));
}

#[test]
fn a_count_that_a_larger_pulse_changes_is_sensitive() {
    let changes = options(&[
        "solver",
        "event",
        "model",
        "modal",
        "contact",
        "unilateral",
        "nd",
        "1",
        "zeta-casing",
        "0.1",
        "end",
        "0.02",
        "speed",
        "787.6785793180733",
        "pulse",
        "1754763.3519688118",
        "bladed_disk.blades",
        "19",
        "casing.modal_stiffness_n_per_m",
        "3088000.0",
        "bladed_disk.stiffness_nm_per_rad",
        "10431.031143012004",
        "bladed_disk.blade_length_m",
        "0.49954622457627873",
        "initial.u_c_m",
        "0.00016342475050572838",
        "initial.u_s_m",
        "0.00022537416230192586",
        "initial.v_c_m_s",
        "1.5705947499839639",
        "initial.v_s_m_s",
        "-0.5370902297361053",
    ]);
    let scene = scene("paper-nd3", &changes);
    let counts = [1.0, 1.0 + 1e-9, 1.0 - 1e-9].map(|factor| {
        let mut scene = scene.clone();
        scene.operation.pulse_n *= factor;
        settle(&scene).impact_count
    });
    assert_eq!(counts, [70, 71, 70]);
    assert!(simulate(&scene, Sampling::default(), &mut |_| {}).outcome.sensitive);
}

#[test]
fn a_held_lock_is_as_exact_as_stepping() {
    // 3.4492910e-8 by plain stepping, which is good to 3e-11 of it.
    let report = run("paper-nd3", &options(&["end", "0.4"]));
    let alpha = report.r#final.alpha_c_rad;
    assert!((alpha / 3.4492910e-8 - 1.0).abs() < 1e-8, "{alpha:e}");
}

#[test]
fn blades_may_bend_as_far_as_a_tenth_of_a_radian() {
    // A start locked on blades so soft that they turn their sides by more than
    // half of a corner.
    let mut changes = options(&[
        "contact",
        "unilateral",
        "model",
        "modal",
        "speed",
        "500",
        "pulse",
        "0",
        "zeta-casing",
        "0",
        "zeta-disk",
        "0.3",
        "end",
        "0.02",
        "bladed_disk.inertia_kg_m2",
        "5.2e-8",
        "bladed_disk.stiffness_nm_per_rad",
        "3.75e-3",
        "bladed_disk.coupling_nm_per_rad",
        "7.5e-4",
        "initial.u_c_m",
        "-9.9999999999989e-05",
        "initial.u_s_m",
        "-1.4377829399495726e-05",
        "initial.v_c_m_s",
        "0.021566744099243589",
        "initial.v_s_m_s",
        "-0.149999999999983",
    ]);
    changes.push(("solver.kind", "event"));
    let event = run("paper-nd3", &changes);
    assert_eq!(event.outcome.verdict, Verdict::Locked, "{:?}", event.outcome);
    let largest = event.checks.max_blade_angle_rad;
    let half_corner = 0.5 * std::f64::consts::PI / 22.0 / 3.0;
    assert!(largest > half_corner && largest < 0.1, "{largest}");
    changes.last_mut().unwrap().1 = "explicit";
    let [coarse, fine] = ["1e-6", "5e-7"].map(|step| {
        let mut changes = changes.clone();
        changes.push(("solver.step_s", step));
        let explicit = run("paper-nd3", &changes);
        assert_eq!(explicit.outcome.verdict, Verdict::Locked, "{:?}", explicit.outcome);
        explicit.checks.max_blade_angle_rad / largest - 1.0
    });
    // First order in the step.
    assert!(coarse.abs() < 3e-3 && (coarse / fine - 2.0).abs() < 0.1, "{coarse} {fine}");
}

#[test]
fn a_corner_without_a_push_does_not_flicker() {
    for speed in ["292.87843515318394", "292.8784351531840", "292.87843515318390"] {
        let report = run(
            "paper-nd3",
            &options(&[
                "solver",
                "event",
                "model",
                "modal",
                "contact",
                "unilateral",
                "zeta-casing",
                "0",
                "pulse",
                "0",
                "initial.u_c_m",
                "-9.9999999999989e-05",
                "initial.u_s_m",
                "-1.4377829399495726e-05",
                "initial.v_c_m_s",
                "0.01263286852627125",
                "initial.v_s_m_s",
                "-0.0878635305459455",
                "speed",
                speed,
            ]),
        );
        assert_ne!(report.outcome.verdict, Verdict::Failed, "{:?}", report.outcome);
        assert!(report.solver.events < Some(1000), "{:?}", report.solver);
    }
}

#[test]
fn a_strong_pulse_or_a_soft_casing_costs_no_more_looks() {
    // Each took tens of seconds in one free flight; their results are known.
    let words = [
        "solver",
        "event",
        "model",
        "rigid",
        "contact",
        "unilateral",
        "nd",
        "0",
        "pulse",
        "1e12",
        "end",
        "1e-6",
        "bladed_disk.blades",
        "1",
        "bladed_disk.blade_length_m",
        "0.4999999997604368",
        "operation.pulse_s",
        "0.0011",
    ];
    let thrown = run("paper-nd3", &options(&words));
    // F t^2/2m, the casing as good as free.
    assert!((thrown.r#final.u_c_m - 0.25).abs() < 1e-5, "{:?}", thrown.r#final);
    assert_eq!(thrown.impact_count, 0);
    let words = [
        "nd",
        "429",
        "end",
        "3.16e-4",
        "casing.modal_stiffness_n_per_m",
        "4.1e-5",
        "casing.radius_m",
        "0.499901",
    ];
    let soft = run("half-n", &options(&words));
    assert!(soft.outcome.message.unwrap().contains("no corner holds the casing wave"));
}
