//! The examples print what their text promises. A new example is a module here and a test of its
//! lines.

use std::error::Error;
use std::io::Write;

#[path = "../../examples/condition.rs"]
#[expect(dead_code, reason = "its main is for cargo")]
mod condition;
#[path = "../../examples/live_knobs.rs"]
#[expect(dead_code, reason = "its main is for cargo")]
mod live_knobs;
#[path = "../../examples/locked_sweep.rs"]
#[expect(dead_code, reason = "its main is for cargo")]
mod locked_sweep;
#[path = "../../examples/run.rs"]
#[expect(dead_code, reason = "its main is for cargo")]
mod run;
#[path = "../../examples/study.rs"]
#[expect(dead_code, reason = "its main is for cargo")]
mod study;
#[path = "../../examples/survey.rs"]
#[expect(dead_code, reason = "its main is for cargo")]
mod survey;

/// The lines that an example prints.
fn lines(show: impl Fn(&mut dyn Write) -> Result<(), Box<dyn Error>>) -> Vec<String> {
    let mut out = Vec::new();
    show(&mut out).unwrap();
    String::from_utf8(out).unwrap().lines().map(str::to_string).collect()
}

#[test]
fn one_run_locks_under_one_law_and_decays_under_the_other() {
    let lines = lines(run::show);
    assert_eq!(lines[0], "bilateral: locked");
    assert_eq!(lines[1], "  blades [19]: -244.57 N");
    assert_eq!(lines[2], "  blades [12]: -57.14 N");
    assert_eq!(lines[3..], ["unilateral: decay"]);
}

#[test]
fn the_wave_is_caught_where_the_clearance_is_small() {
    let lines = lines(condition::show);
    assert_eq!(lines[0], "50 um: caught at 1.1 ms, amplitude 50.51 um");
    assert_eq!(lines[1], "100 um: caught at 1.1 ms, amplitude 101.03 um");
    assert!(lines[2].starts_with("400 um: not caught at 100.0 ms"), "{}", lines[2]);
}

#[test]
fn the_sweep_pushes_only_above_the_lock_speed() {
    let lines = lines(locked_sweep::show);
    assert_eq!(lines[0], "speed_rad_s,lambda_a_n,lambda_b_n,only_pushes");
    assert_eq!(lines.len(), 22);
    for line in &lines[1..] {
        let cells: Vec<&str> = line.split(',').collect();
        let [speed, a, b] = [0, 1, 2].map(|place| cells[place].parse::<f64>().unwrap());
        assert_eq!(cells[3].parse(), Ok(speed > 411.934), "{line}");
        assert_eq!(a < 0.0 && b < 0.0, speed > 411.934, "{line}");
    }
}

#[test]
fn the_study_needs_stronger_pulses_with_more_damping() {
    let lines = lines(study::show);
    assert_eq!(lines.len(), 6);
    let pulse = |line: &String| line.split(' ').nth_back(1).unwrap().parse::<f64>().unwrap();
    assert!(lines.iter().map(pulse).is_sorted(), "{lines:?}");
    assert_eq!(lines[5], "zeta_c 0.05: locked from 49000 N");
}

#[test]
fn a_knob_that_is_turned_changes_what_holds_and_what_will_be() {
    let lines = lines(live_knobs::show);
    let begin = |line: usize, text: &str| assert!(lines[line].starts_with(text), "{lines:?}");
    begin(0, "500 rad/s: locked at 0.1 s; at 0.02 s [19] -244.57 N [12] -57.14 N");
    begin(1, "420 rad/s: locked at 0.1 s; at 0.04 s [19] -161.91 N [12] -4.58 N");
    // Below the lock speed one side lets go, unless a pull holds it.
    assert!(!lines[2].contains(" locked ") && !lines[3].contains(" locked "), "{lines:?}");
}

#[test]
fn a_table_of_modes_becomes_a_survey_and_what_moves_its_limit() {
    assert_eq!(
        lines(survey::show),
        [
            "4: 7000.0 to 12000.0 rpm",
            "5: 8605.2 to 12000.0 rpm",
            "1 % of casing.frequency_hz moves it by 1.00 %",
            "1 % of casing.damping_ratio moves it by 0.02 %",
        ]
    );
}
