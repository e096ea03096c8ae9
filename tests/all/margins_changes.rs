//! How far runs are from another verdict: each change that is found is one by plain runs, just
//! outside and not just inside.

use rubscope_solver::motion::{Verdict, run_to_verdict, to_the_end};
use rubscope_solver::scene::CheckedScene;
use rubscope_solver::study::margins::{Margins, Robustness, changed, parameter};

use crate::scene;

/// The same by events under contact that only pushes.
fn pushes_only(name: &str, changes: &[(&str, &str)]) -> CheckedScene {
    scene(name, changes).as_reference().checked().unwrap()
}

fn asked(scene: &CheckedScene) -> Margins {
    let mut margins = Margins::of(scene);
    let mut known = 0;
    margins.ask_runs(true, &to_the_end, &mut |_| known += 1).unwrap();
    assert_eq!(known, Margins::rows_asked(scene));
    margins
}

fn verdict(scene: &CheckedScene, path: &str, value: f64) -> Verdict {
    let changed = changed(parameter(path).unwrap(), scene, value).unwrap().checked().unwrap();
    run_to_verdict(&changed, &to_the_end).unwrap().verdict
}

/// Asserts by plain runs what was found of a scene.
fn assert_found(scene: &CheckedScene, found: &Robustness) {
    let own = run_to_verdict(scene, &to_the_end).unwrap().verdict;
    assert_eq!((found.contact, found.verdict), (scene.solver.contact, own));
    for row in &found.changes {
        assert_eq!(row.present, parameter(row.path).unwrap().real(scene));
        for (side, changed) in [(-1.0, row.below), (1.0, row.above)] {
            let Some(changed) = changed else { continue };
            let said = format!("{} {} {changed:?}", scene.title, row.path);
            assert_eq!(verdict(scene, row.path, changed.value), changed.verdict, "{said}");
            assert_ne!(changed.verdict, own, "{said}");
            assert!(side * (changed.value - row.present) > 0.0, "{said}");
            // A part in a thousand inside, or before it where verdicts have islands.
            let inside = |part: i32| changed.value * (1.0 - side * 1e-3 * f64::from(part) / 32.0);
            let is_own = |part| verdict(scene, row.path, inside(part)) == own;
            assert!((1..=32).rev().any(is_own), "{said}");
        }
        for (found, tried) in [row.below, row.above].into_iter().zip(row.tried) {
            let end = found.map_or(own, |found| found.verdict);
            assert_eq!(verdict(scene, row.path, tried), end, "{} {tried}", row.path);
        }
    }
}

#[test]
fn a_verdict_is_another_just_outside_of_what_is_found_and_not_just_inside() {
    let paper = scene("paper-nd3", &[]);
    let margins = asked(&paper);
    assert_found(&paper, margins.robust.as_ref().unwrap());
    let law = paper.as_reference().checked().unwrap();
    assert_found(&law, margins.pushes_only.as_ref().unwrap());
    for name in ["paper-fig-7", "slip", "rub"] {
        let scene = pushes_only(name, &[]);
        let margins = asked(&scene);
        assert_found(&scene, margins.robust.as_ref().unwrap());
        assert!(margins.pushes_only.is_none(), "{name}");
    }
}

#[test]
fn what_is_zero_is_searched_upward_and_only_what_is_there_is_changed() {
    let scene = pushes_only("paper-nd3", &[("operation.pulse_n", "0")]);
    let found = asked(&scene).robust.unwrap();
    let row = |path: &str| found.changes.iter().find(|row| row.path == path);
    let pulse = row("operation.pulse_n").unwrap();
    // Twice the pulse that touches.
    assert_eq!((pulse.below, pulse.tried[0]), (None, 0.0));
    // In the four digits of a value that is tried.
    assert_eq!(pulse.tried[1], 7590.0);
    assert!(row("bladed_disk.longest_tip_m").is_none() && row("casing.out_of_round_m").is_none());
    assert_eq!(found.changes.len(), 5);
    let long = crate::scene("long-tip", &[("solver.end_s", "1e-3"), ("solver.step_s", "1e-6")]);
    let found = asked(&long).robust.unwrap();
    assert!(found.changes.iter().any(|row| row.path == "bladed_disk.longest_tip_m"));
}
