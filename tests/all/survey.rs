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
