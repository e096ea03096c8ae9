//! What a verdict rests on, and what changes it: proofs, the rate of a linear rest, another
//! step, and a tiny change.

use rubscope_solver::motion::{
    Basis, Certainty, Proof, RunReport, Script, Verdict, run_with_certainty, simulate, to_the_end,
};
use rubscope_solver::scene::{CheckedScene, Scene};

use crate::run_once;
use crate::tips_support::carried;

fn scene(base: &str, changes: &[(&str, &str)]) -> CheckedScene {
    Scene::builtin(base).unwrap().with(changes).unwrap()
}

fn is_proved(report: &RunReport) -> bool {
    matches!(report.outcome.basis, Some(Basis::Proved { .. }))
}

/// A blade that an engine order drives too far makes the run fail, though nothing touches.
#[test]
fn an_excitation_forbids_an_early_decay() {
    let scene = scene(
        "paper-nd3",
        &[
            ("excitation.amplitude_nm", "2000"),
            ("excitation.order", "3"),
            ("operation.speed_rad_s", "95.43"),
            ("operation.pulse_n", "100"),
            ("solver.step_s", "1e-6"),
            ("solver.end_s", "0.3"),
        ],
    );
    let early = rubscope_solver::motion::run_to_verdict(&scene, &to_the_end).unwrap();
    assert_eq!(
        (early.verdict, run_once(&scene).outcome.verdict),
        (Verdict::Failed, Verdict::Failed)
    );
}

#[test]
fn a_proved_lock_near_its_limit_holds_in_longer_runs() {
    let mut proved = [0; 2];
    for (blades, diameters, speed) in [
        ("12", "1", 1_057.757_253_947_363),
        ("30", "2", 1_016.582_588_883_935_2),
        ("22", "5", 545.492_786_902_743_2),
        ("12", "3", 323.627_027_949_711_5),
    ] {
        for apart in [-1e-8, -1e-9, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-5, 1e-3] {
            for (kind, model) in [("event", "modal"), ("event", "rigid"), ("explicit", "modal")] {
                let near = (speed * (1.0 + apart)).to_string();
                let run = |end: &str| {
                    let changes = [
                        ("solver.contact", "unilateral"),
                        ("solver.kind", kind),
                        ("solver.model", model),
                        ("solver.end_s", end),
                        ("bladed_disk.blades", blades),
                        ("operation.nodal_diameters", diameters),
                        ("operation.speed_rad_s", &near),
                    ];
                    let mut scene = scene("paper-nd3", &changes).into_scene();
                    let machine = scene.machine();
                    let corner = [machine.clearance(), machine.polygon.half_side()];
                    carried(&mut scene, corner.map(|part| (1e-11 - 1.0) * part));
                    simulate(&scene.checked().unwrap())
                };
                let [short, long] = ["0.0015", "0.024"].map(run);
                if is_proved(&short) {
                    let told =
                        |report: &RunReport| (report.outcome.verdict, report.outcome.lock_time_s);
                    assert_eq!(told(&short), told(&long), "{blades} {near} {kind} {model}");
                    proved[usize::from(short.outcome.verdict == Verdict::Locked)] += 1;
                }
            }
        }
    }
    assert!(proved[1] > 8, "{proved:?}");
}

/// Soft blades swing far enough to change a push: what holds now may not hold for good.
#[test]
fn a_corner_of_blades_one_by_one_is_proved_only_where_they_bend_little() {
    for (stiffness, proved) in [("15000", true), ("100", true), ("10", false), ("1", false)] {
        let report = run_once(&scene(
            "paper-nd3",
            &[
                ("solver.model", "full"),
                ("solver.end_s", "0.002"),
                ("bladed_disk.stiffness_nm_per_rad", stiffness),
                ("bladed_disk.coupling_nm_per_rad", "0"),
            ],
        ));
        assert_eq!(report.outcome.verdict, Verdict::Locked, "{stiffness}");
        assert_eq!(is_proved(&report), proved, "{stiffness}: {:?}", report.outcome.basis);
    }
}

#[test]
fn tips_without_a_slope_do_not_make_a_wave_slip_on_a_pressed_lining() {
    for end in ["0.1", "0.2", "0.6"] {
        for pulse in ["3000", "300"] {
            let report = simulate(&scene(
                "coincidence",
                &[
                    ("solver.end_s", end),
                    ("bladed_disk.radial_coupling", "0"),
                    ("bladed_disk.damping_ratio", "0"),
                    ("operation.pulse_n", pulse),
                ],
            ));
            assert_eq!(report.outcome.verdict, Verdict::Decay, "{end} {pulse}");
            assert!(report.outcome.decay_rate_per_s > Some(0.0), "{end} {pulse}");
        }
    }
}

/// A beat of nearly undamped blades has a rate, whatever part of it a run sees.
#[test]
fn the_rate_of_the_linear_rest_decides_on_a_beat() {
    for (coupling, damping, verdict) in
        [("0.398", "1e-7", Verdict::Decay), ("0.398", "0", Verdict::Slip)]
    {
        let run = |end: &str| {
            let report = run_once(&scene(
                "coincidence",
                &[
                    ("solver.end_s", end),
                    ("bladed_disk.blades", "12"),
                    ("operation.nodal_diameters", "1"),
                    ("casing.radius_m", "0.499898"),
                    ("bladed_disk.radial_coupling", coupling),
                    ("casing.damping_ratio", "0"),
                    ("bladed_disk.damping_ratio", damping),
                    ("contact.smoothing_m", "1e-8"),
                    ("operation.speed_rad_s", "20"),
                    ("operation.pulse_n", "1"),
                ],
            ));
            (report.outcome.verdict, report.outcome.decay_rate_per_s)
        };
        let [first, rest @ ..] = ["0.02", "0.05", "0.1", "0.15", "0.2", "0.4"].map(run);
        assert_eq!(first.0, verdict, "{first:?}");
        assert!(rest.iter().all(|other| *other == first), "{first:?} {rest:?}");
    }
}

/// Beats larger than the interference in which blades stay pressed, and one that lifts blades.
#[test]
fn a_beat_has_one_verdict_and_one_rate_whatever_part_of_it_is_seen() {
    let machine = |of: [&'static str; 8]| {
        [
            ("casing.radius_m", of[0]),
            ("casing.damping_ratio", of[1]),
            ("bladed_disk.damping_ratio", of[2]),
            ("bladed_disk.radial_coupling", of[3]),
            ("contact.stiffness_n_per_m", of[4]),
            ("operation.speed_rad_s", of[5]),
            ("operation.pulse_n", of[6]),
            ("bladed_disk.blades", of[7]),
            ("operation.nodal_diameters", "1"),
            ("contact.smoothing_m", "1e-8"),
        ]
    };
    let still =
        ["0.49983974", "1.2825e-6", "1.5532e-6", "-0.5479", "65252", "54.4787", "2209", "28"];
    let slow = ["0.4998971", "1.1e-6", "2.4036e-4", "-0.624", "6946", "579.6874", "76.42", "22"];
    let lifts = ["0.499898", "0", "1e-7", "0.398", "27e3", "406", "100", "12"];
    for (of, end, verdict) in [
        (still, 0.218, Verdict::Decay),
        (slow, 0.0943504, Verdict::Decay),
        (lifts, 0.05, Verdict::Slip),
    ] {
        let mut rates = [1.0, 0.4, 2.0, 3.0, 4.0, 6.0].map(|times| {
            let end = (times * end).to_string();
            let changes = [&machine(of)[..], &[("solver.end_s", &end)]].concat();
            let report = run_once(&scene("coincidence", &changes));
            assert_eq!(report.outcome.verdict, verdict, "{of:?} {end}");
            report.outcome.decay_rate_per_s
        });
        rates.sort_by(|a, b| a.partial_cmp(b).unwrap());
        assert!(
            rates[0] == rates[5] && rates[0].is_some() == (verdict == Verdict::Decay),
            "{rates:?}"
        );
    }
}

#[test]
fn a_verdict_says_what_it_rests_on() {
    let basis = |base: &str, changes: &[(&str, &str)]| {
        let report = run_once(&scene(base, changes));
        (report.outcome.verdict, report.outcome.basis, report.outcome.lock_time_s)
    };
    let (verdict, locked, since) = basis("paper-nd3", &[]);
    let proof = |by, since_s| Some(Basis::Proved { by, since_s });
    assert_eq!((verdict, locked), (Verdict::Locked, proof(Proof::HeldCorner, since.unwrap())));
    let (verdict, decay, _) = basis("paper-nd3", &[("operation.pulse_n", "1000")]);
    assert_eq!((verdict, decay), (Verdict::Decay, proof(Proof::NoContact, 0.0)));
    let (verdict, slip, _) = basis("slip", &[]);
    let Some(Basis::Judged { from_s, to_s }) = slip else { panic!("{verdict} {slip:?}") };
    assert_eq!(verdict, Verdict::Slip);
    assert!((from_s / to_s - 0.9).abs() < 1e-6, "{from_s} {to_s}");
    let (verdict, failed, _) = basis("paper-nd3", &[("solver.step_s", "1e-6")]);
    assert_eq!((verdict, failed), (Verdict::Failed, None));
}

#[test]
fn a_verdict_that_another_step_changes_says_so() {
    let depends = |changes: &[(&str, &str)]| {
        let scene = scene("paper-nd3", changes);
        let outcome = simulate(&scene).outcome;
        let (_, certainty) = run_with_certainty(&scene, &to_the_end).unwrap();
        let Certainty { sensitive, depends_on_step, .. } = certainty;
        // A cell of a map does not ask for it where it is sensitive.
        assert!(sensitive || depends_on_step == outcome.depends_on_step, "{changes:?}");
        outcome.depends_on_step
    };
    for (speed, pulse) in [("320", "30000"), ("350", "40000")] {
        let at = [("operation.speed_rad_s", speed), ("operation.pulse_n", pulse)];
        let long = [at.as_slice(), &[("solver.step_s", "1e-6")]].concat();
        assert_eq!((depends(&long), depends(&at)), (Some(true), Some(false)), "{speed}");
    }
    let undamped = [("casing.damping_ratio", "0"), ("solver.contact", "unilateral")];
    assert_eq!(depends(&[undamped.as_slice(), &[("solver.step_s", "1e-6")]].concat()), Some(true));
    assert_eq!(depends(&[("solver.kind", "event"), ("solver.contact", "unilateral")]), None);
    let digits = simulate(&scene("paper-nd3", &undamped)).outcome;
    let spread = digits.spread.unwrap().multipliers_n;
    assert!(spread.iter().all(|moved| *moved > Some(0.05)), "{spread:?}");
}

#[test]
fn a_step_that_is_too_long_is_blamed() {
    for step in ["1e-6", "6.18e-7"] {
        let report = simulate(&scene("paper-nd3", &[("solver.step_s", step)]));
        assert_eq!(report.outcome.verdict, Verdict::Failed);
        assert_eq!(report.outcome.depends_on_step, Some(true));
    }
    let shorter = run_once(&scene("paper-nd3", &[("solver.step_s", "1e-7")]));
    assert_eq!(shorter.outcome.verdict, Verdict::Locked);
    assert!((shorter.checks.max_blade_angle_rad - 5.7e-7).abs() < 0.6e-7);
}

#[test]
fn other_impacts_are_no_other_end() {
    let report = simulate(&scene(
        "paper-nd3",
        &[
            ("solver.kind", "event"),
            ("solver.model", "rigid"),
            ("solver.contact", "unilateral"),
            ("operation.pulse_n", "200000"),
        ],
    ));
    let outcome = &report.outcome;
    assert_eq!((outcome.sensitive, outcome.ends_otherwise), (Some(true), Some(false)));
}

#[test]
fn a_cell_of_a_map_and_a_run_are_sensitive_alike() {
    for contact in ["unilateral", "bilateral"] {
        let scene = scene(
            "paper-nd3",
            &[
                ("operation.speed_rad_s", "505.51449111241027"),
                ("operation.pulse_n", "48260.31404844014"),
                ("solver.model", "rigid"),
                ("solver.contact", contact),
                ("casing.damping_ratio", "0.01"),
                ("solver.end_s", "0.02"),
                ("solver.step_s", "1e-6"),
            ],
        );
        let (_, cell) = run_with_certainty(&scene, &to_the_end).unwrap();
        assert_eq!(simulate(&scene).outcome.sensitive, Some(cell.sensitive), "{contact}");
    }
}

#[test]
fn a_run_by_steps_knows_where_events_say_otherwise() {
    let by_events = |step: &str| {
        let keys = [
            ("operation.pulse_n", "50000"),
            ("solver.contact", "unilateral"),
            ("solver.step_s", step),
        ];
        let mut report = run_once(&scene("paper-nd3", &keys));
        report.ask_events(&Script::default(), &to_the_end);
        (report.outcome.verdict, report.outcome.by_events)
    };
    assert_eq!(by_events("1e-7"), (Verdict::Decay, None));
    assert_eq!(by_events("1e-6"), (Verdict::Locked, Some(Verdict::Decay)));
}
