//! The survey in the library: its limits, and its picture. What it prints is in
//! `tests/transcripts`, its numbers are in `golden_outputs`.

use rubscope_solver::harmonic::{Form, locked_motion};
use rubscope_solver::study::margins::{LimitName, Margins};
use rubscope_solver::study::survey::Survey;

use crate::scene;

#[test]
fn the_lock_speed_of_a_row_is_that_of_its_own_blades() {
    let soft =
        [("bladed_disk.stiffness_nm_per_rad", "0.02"), ("bladed_disk.coupling_nm_per_rad", "0")];
    for (changes, bends) in [(&soft[..], true), (&[][..], false)] {
        let scene = scene("paper-nd3", changes);
        let row = &Survey::of(&scene, None, None).unwrap().rows[3];
        let lock = row.locks_in_range.as_ref().unwrap()[0][0];
        assert_eq!(Some(lock), Margins::of(&scene).limit(LimitName::OmegaLock).unwrap().value);
        let rigid = scene.machine().lock_speed().unwrap();
        assert_eq!((lock / rigid - 1.0).abs() > 2e-3, bends, "{lock} {rigid}");
        let here = |speed: f64| {
            locked_motion(&scene.machine(), Form::Modal, true, None, &[speed]).unwrap().points[0]
        };
        let beside = [0.997, 1.003].map(|part| here(lock * part).stable);
        assert_eq!(beside, [false, true]);
    }
}

#[test]
fn rows_without_modes_of_their_own_are_drawn_with_all_of_them() {
    let survey = Survey::of(&scene("paper-nd3", &[]), None, None).unwrap();
    let figure = |all| rubscope::report::survey::figure(&survey, all);
    let points = |all| {
        let [of, _] = &figure(all).panels[..] else { panic!() };
        of.series[..4].iter().map(|series| series.points.len()).collect::<Vec<_>>()
    };
    assert_eq!(points(false), [2, 0, 2, 0]);
    assert_eq!(points(true), [2, 10, 2, 10]);
    // A mark that is left out is counted.
    assert!(
        figure(true).note.contains("2 limits beyond 1000 rad/s left out."),
        "{}",
        figure(true).note
    );
}
