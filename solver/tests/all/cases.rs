//! Scenes that once failed, with values from independent codes. Each is a whole command line of
//! `run` or `map`, its options without their dashes. A new case is such a line and its numbers.

use rubscope_solver::motion::{
    RunReport, Sampling, Script, Verdict, run_to_end, run_to_verdict, simulate, to_the_end,
};
use rubscope_solver::scene::Scene;

/// The report of `run BASE OPTIONS`.
fn run(base: &str, options: &str) -> RunReport {
    simulate(&scene(base, options).checked().unwrap())
}

pub fn scene(base: &str, options: &str) -> Scene {
    let words: Vec<&str> = options.split_whitespace().collect();
    let key = |word| match word {
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
    let changes: Vec<_> = words.chunks(2).map(|pair| (key(pair[0]), pair[1])).collect();
    Scene::builtin(base).unwrap().with(&changes).unwrap().into_scene()
}

/// Half as many diameters as blades, which gives two parallel sides and no corner.
const HALF_N: &str =
    "nd 11 speed 100 pulse 20000 solver event contact unilateral model rigid end 0.012";
/// A start in a corner of the paper's machine with this rate.
const CORNER: &str =
    "initial.u_c_m -9.9999999999989e-05 initial.u_s_m -1.4377829399495726e-05 pulse 0";

#[test]
fn two_blades_a_side_move_as_their_modes_at_any_speed() {
    let machine = "bladed_disk.blades 12 nd 2 pulse 20e3 step 1e-6 end 0.005";
    for (speed, u_c) in [(0.1, -4.4171e-5), (10.0, -4.4187e-5)] {
        for contact in ["unilateral", "bilateral"] {
            let [modal, full] = ["modal", "full"].map(|model| {
                let how = format!("{machine} speed {speed} contact {contact} model {model}");
                run("paper-nd3", &how)
            });
            assert!((full.r#final.u_c_m - u_c).abs() < 5e-10, "{speed}: {:?}", full.r#final);
            // The blades answer an impact by all their modes: some 1e-10 of it.
            let apart = (full.r#final.u_c_m - modal.r#final.u_c_m).abs();
            assert!(apart < 1e-9 * 1e-4, "{speed} {contact}: {apart:e}");
            assert_eq!(full.checks.tensile_steps, 0);
        }
    }
    // Without any moment arm to speak of; the paper's law is bilateral.
    let full = run("paper-nd3", &format!("{machine} speed 1e-5 model full"));
    assert!((full.r#final.u_c_m + 4.4171e-5).abs() < 5e-10, "{:?}", full.r#final);
}

#[test]
fn bilateral_contact_leaves_the_open_side_of_two_alone() {
    for model in ["rigid", "modal", "full"] {
        let [unilateral, bilateral] = ["unilateral", "bilateral"].map(|contact| {
            let how = format!("solver explicit step 1e-6 contact {contact} model {model}");
            run("paper-nd3", &format!("{HALF_N} {how}"))
        });
        assert_eq!(bilateral.outcome.verdict, Verdict::Slip, "{model}: {:?}", bilateral.outcome);
        assert_eq!((bilateral.impact_count, bilateral.checks.tensile_steps), (4, 0));
        assert_eq!(bilateral.r#final, unilateral.r#final);
        assert!(bilateral.checks.max_blade_angle_rad < 2e-4);
        // Two sides of 11 blades, one of them in contact.
        assert_eq!(bilateral.outcome.contacts.len(), 1, "{:?}", bilateral.outcome.contacts);
    }
    let how = "solver explicit contact bilateral nd 2 bladed_disk.blades 4";
    let four = run("paper-nd3", &format!("{HALF_N} {how}"));
    assert_eq!((four.outcome.verdict, four.impact_count), (Verdict::Decay, 1));
}

#[test]
fn the_largest_blade_angle_does_not_depend_on_who_looks() {
    let scene = scene(
        "paper-nd3",
        "solver event model modal contact unilateral nd 3 zeta-casing 0.02 speed 664.34 \
         pulse 64692.5 end 0.02 bladed_disk.blades 13 bladed_disk.stiffness_nm_per_rad 708 \
         bladed_disk.blade_length_m 0.499526",
    );
    let angles = [0, 7, 4001].map(|intervals| {
        let sampling = Sampling { intervals, gaps: false };
        let scene = scene.checked().unwrap();
        run_to_end(&scene, &Script::default(), sampling, &mut |_| {}).checks.max_blade_angle_rad
    });
    assert_eq!(angles[0], angles[1]);
    assert_eq!(angles[0], angles[2]);
    assert!((angles[0] - 1.495e-6).abs() < 5e-10, "{angles:?}");
}

#[test]
fn the_largest_blade_angle_is_reached_and_no_bound() {
    let soft = "contact unilateral step 1e-6 end 0.01 pulse 1e6 zeta-disk 1 \
                bladed_disk.stiffness_nm_per_rad 100 bladed_disk.coupling_nm_per_rad 10 \
                bladed_disk.blade_length_m 0.495";
    for (how, angle) in [
        (format!("{soft} model modal bladed_disk.inertia_kg_m2 1e-5"), 0.0343),
        (format!("{soft} model full bladed_disk.inertia_kg_m2 1e-3"), 0.0443),
        // Of blades that never touch.
        ("pulse 0 excitation.amplitude_nm 3000 end 0.05".to_string(), 0.0348),
    ] {
        let report = run("paper-nd3", &how);
        assert_eq!(report.outcome.message, None);
        let found = report.checks.max_blade_angle_rad;
        assert!((found - angle).abs() < 5e-5, "{how}: {found}");
    }
}

#[test]
fn both_solvers_stop_when_a_blade_passes_a_tenth_of_a_radian() {
    let stop = |how: &str| {
        let report = run("paper-nd3", &format!("{HALF_N} model modal end 0.02 {how}"));
        assert_eq!(report.outcome.verdict, Verdict::Failed, "{:?}", report.outcome);
        assert!(report.outcome.message.unwrap().contains("beyond the 0.1 rad"));
        report.r#final.t_s
    };
    let event = stop("solver event");
    let [coarse, fine] = [1e-6, 5e-7].map(|h| event - stop(&format!("solver explicit step {h}")));
    // First order in the step.
    assert!(coarse.abs() < 2e-5 && (coarse / fine - 2.0).abs() < 0.2, "{coarse} {fine}");
}

#[test]
fn a_lock_under_excitation_is_not_taken_for_good() {
    // A resonance of the blades breaks the lock after 85 ms.
    let how = format!(
        "{CORNER} initial.v_c_m_s 0.017857264114173692 initial.v_s_m_s -0.12419999999998634 \
         speed 414 contact unilateral model modal step 1e-6 end 0.2 zeta-disk 0.002 \
         bladed_disk.stiffness_nm_per_rad 319168.11740367167 excitation.order 3 \
         excitation.amplitude_nm 1"
    );
    assert_eq!(
        run_to_verdict(&scene("paper-nd3", &how).checked().unwrap(), &to_the_end).unwrap().verdict,
        Verdict::Decay
    );
    let report = run("paper-nd3", &how);
    assert_eq!(report.outcome.verdict, Verdict::Decay);
    assert!(report.outcome.sensitive == Some(false));
}

#[test]
fn a_corner_that_lets_go_again_and_again_is_no_lock() {
    let how = "solver event model modal contact unilateral nd 2 pulse 0 zeta-casing 0.02 \
               zeta-disk 0 speed 459.3731941944803 end 9.5 bladed_disk.blades 5 \
               bladed_disk.blade_length_m 0.4981942166058344 \
               bladed_disk.inertia_kg_m2 0.00041897191625480334 \
               bladed_disk.stiffness_nm_per_rad 23.280659629323264 \
               bladed_disk.coupling_nm_per_rad 0 initial.u_c_m -0.0018057833941655947 \
               initial.u_s_m -0.0013119784322271717 initial.v_c_m_s 1.2053754462529247 \
               initial.v_s_m_s -1.6590569716023988";
    let settled = run_to_verdict(&scene("paper-nd3", how).checked().unwrap(), &to_the_end).unwrap();
    assert_eq!(settled.verdict, Verdict::Slip, "{settled:?}");
    assert!(settled.impact_count > 2000);
}

#[test]
fn only_sides_that_push_are_in_contact() {
    let how = "nd 1 speed 1500 pulse 20e3 contact unilateral step 1e-6 end 0.02 \
               bladed_disk.blades 3";
    let report = run("paper-nd3", how);
    let blades: Vec<_> = report.outcome.contacts.iter().map(|c| c.blades.clone()).collect();
    assert_eq!(blades, [[2], [3]]);
    assert!(report.outcome.contacts.iter().all(|contact| contact.multiplier_n < -500.0));
}

#[test]
fn a_count_that_a_tiny_change_alters_is_sensitive() {
    let how = "solver event model rigid contact unilateral zeta-casing 0.02 end 0.1 speed 355 \
               pulse 440000";
    let scene = scene("paper-nd3", how);
    let counts = [1.0, 1.0 + 1e-9, 1.0 - 1e-9].map(|factor| {
        let mut scene = scene.clone();
        scene.operation.pulse_n *= factor;
        run_to_verdict(&scene.checked().unwrap(), &to_the_end).unwrap().impact_count
    });
    assert!(counts.iter().any(|&count| count != counts[0]), "{counts:?}");
    assert!(run("paper-nd3", how).outcome.sensitive == Some(true));
}

#[test]
fn a_lock_whose_time_a_tiny_change_moves_is_sensitive() {
    // Also locked with a pulse changed by one part in a billion, but at other times.
    let how = "solver event model rigid contact unilateral nd 5 zeta-casing 0 speed 500 \
               end 0.114584672293341 bladed_disk.blades 12 pulse 5280.215591911308";
    let report = run("paper-nd3", how);
    assert_eq!(report.outcome.verdict, Verdict::Locked);
    assert!(report.outcome.sensitive == Some(true));
}

#[test]
fn a_start_that_a_tiny_change_turns_elsewhere_is_sensitive_without_a_pulse() {
    // Locked at the speed where one push vanishes.
    let how = format!(
        "{CORNER} solver event model rigid contact unilateral \
         initial.v_c_m_s 0.01776830 initial.v_s_m_s -0.1235800552 speed 411.93351729"
    );
    assert!(run("paper-nd3", &how).outcome.sensitive == Some(true));
    let inside = how.replace("411.93351729", "430");
    let start = "initial.v_c_m_s 0.018547399924 initial.v_s_m_s -0.12899999999998";
    assert!(run("paper-nd3", &format!("{inside} {start}")).outcome.sensitive == Some(false));
}

#[test]
fn blades_may_bend_as_far_as_a_tenth_of_a_radian() {
    // A start locked on blades so soft that they turn their sides by more than
    // half of a corner.
    let how = format!(
        "{CORNER} initial.v_c_m_s 0.021566744099243589 initial.v_s_m_s -0.149999999999983 \
         contact unilateral model modal speed 500 zeta-casing 0 zeta-disk 0.3 end 0.02 \
         bladed_disk.inertia_kg_m2 5.2e-8 bladed_disk.stiffness_nm_per_rad 3.75e-3 \
         bladed_disk.coupling_nm_per_rad 7.5e-4"
    );
    let largest = |solver: &str| {
        let report = run("paper-nd3", &format!("{how} {solver}"));
        assert_eq!(report.outcome.verdict, Verdict::Locked, "{:?}", report.outcome);
        report.checks.max_blade_angle_rad
    };
    let event = largest("solver event");
    let half_corner = 0.5 * std::f64::consts::PI / 22.0 / 3.0;
    assert!(event > half_corner && event < 0.1, "{event}");
    let [coarse, fine] = [1e-6, 5e-7].map(|h| largest(&format!("step {h}")) / event - 1.0);
    // First order in the step.
    assert!(coarse.abs() < 3e-3 && (coarse / fine - 2.0).abs() < 0.1, "{coarse} {fine}");
}

#[test]
fn a_corner_without_a_push_does_not_flicker() {
    for speed in ["292.87843515318394", "292.8784351531840", "292.87843515318390"] {
        let how = format!(
            "{CORNER} solver event model modal contact unilateral zeta-casing 0 speed {speed} \
             initial.v_c_m_s 0.01263286852627125 initial.v_s_m_s -0.0878635305459455"
        );
        let report = run("paper-nd3", &how);
        assert_ne!(report.outcome.verdict, Verdict::Failed, "{:?}", report.outcome);
        assert!(report.solver.events < Some(1000), "{:?}", report.solver);
    }
}

#[test]
fn a_soft_casing_costs_no_more_looks() {
    // It once took tens of seconds in one free flight.
    let how = "nd 429 end 3.16e-4 casing.modal_stiffness_n_per_m 4.1e-5 casing.radius_m 0.499901";
    let soft = run("paper-nd3", &format!("{HALF_N} {how}"));
    assert!(soft.outcome.message.unwrap().contains("no corner holds the casing wave"));
}
