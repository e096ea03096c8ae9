//! What reports say of a result beside its numbers: which blades, angles and groups it is
//! of, where a lock ends, and how many steps a run may take.

use rubscope_solver::scene::{CheckedScene, Scene};

use crate::cli_support::{json, refusal, text};

const SLOPE: &str = "bladed_disk.radial_coupling";
const REBOUND: &str = "contact.restitution";

fn reference(model: &str, changes: &[(&str, f64)]) -> CheckedScene {
    let mut scene = Scene::base();
    scene.set("solver.kind", "event").unwrap();
    scene.set("solver.model", model).unwrap();
    for (key, value) in changes {
        scene.set(key, &value.to_string()).unwrap();
    }
    scene.checked().unwrap()
}

/// Blades that the casing cannot feel are solved as rigid, and the report says so.
#[test]
fn blades_that_follow_are_reported() {
    for (stiffness, follow) in [(1e13, true), (15_000.0, false)] {
        let mut scene = Scene::base().as_reference();
        scene.bladed_disk.stiffness_nm_per_rad = stiffness;
        let report = crate::run_once(&scene.checked().unwrap());
        assert_eq!(report.solver.blades_follow, follow, "{stiffness:e}");
        let text = crate::told(&report);
        assert_eq!(text.contains("modal model (blades too stiff to be felt"), follow, "{text}");
    }
}

#[test]
fn reports_say_that_angles_are_left_out_of_the_phases() {
    let told = |model: &str, changes: &[(&str, f64)]| {
        let report = crate::run_once(&reference(model, changes));
        let told = crate::told(&report).contains("(linearised)");
        assert_eq!(told, report.solver.linearised);
        told
    };
    assert!(told("modal", &[(SLOPE, 0.1)]));
    assert!(!told("modal", &[(REBOUND, 0.5)]));
    assert!(!told("rigid", &[(REBOUND, 0.5)]));
    assert!(!told("modal", &[]));
}

/// On a lining the closed form is of two groups alone, wherever it is told.
#[test]
fn a_lock_on_a_lining_is_said_to_be_of_two_groups() {
    let stiff = ["--set", "contact.stiffness_n_per_m=1e9"];
    let run = text(&[&["run", "soft-lining", "--end", "1e-4"][..], &stiff].concat());
    assert!(run.contains(", where locks of two groups begin"), "{run}");
    let hbm = text(&[&["hbm", "soft-lining", "--smooth", "--speed", "450"][..], &stiff].concat());
    assert!(hbm.contains(", lock of two groups from "), "{hbm}");
    let margins = text(&[&["margins", "soft-lining", "--no-search"][..], &stiff].concat());
    assert!(margins.contains(": of two groups on the lining"), "{margins}");
    // Rigid contact has no others.
    assert!(!text(&["run", "rub", "--end", "1e-4", "--step", "1e-6"]).contains("two groups"));
}

/// Where a lock begins and ends stands on a map over the speed, and in a run.
#[test]
fn maps_and_runs_name_the_end_of_a_lock() {
    let speeds = ["--speed", "400:700:31", "--pulse", "1e4:1e5:2", "--end", "1e-4"];
    let map = text(&[&["map", "rub"][..], &speeds].concat());
    assert!(map.contains("lock ends = 566.259"), "{map}");
    let run = text(&["run", "rub", "--speed", "600", "--end", "1e-4", "--step", "1e-6"]);
    assert!(run.contains("Omega_lock (472.117 rad/s, where locks begin; they end at 566.259)"));
    let paper = text(&["run", "--pulse", "1e4", "--end", "1e-4", "--step", "1e-6"]);
    assert!(paper.contains("of Omega_lock (411.934 rad/s)."), "{paper}");
}

/// What a result is of stands with it, in text and in JSON.
#[test]
fn results_of_equal_blades_say_so() {
    let full = ["--model", "full", "--set", "bladed_disk.mistuning=0.02", "--step", "1e-6"];
    for command in [
        &["hbm", "coincidence", "--smooth", "--speed", "406"][..],
        &["hbm", "coincidence", "--coincidence", "--speed", "406"],
        &["hbm", "rub", "--whirl", "--speed", "450"],
        &["hbm", "rub"],
        &["margins", "rub", "--no-search"],
    ] {
        for (more, count) in [(&[][..], 0), (&full, 1)] {
            let asked = [command, more].concat();
            let text = text(&asked).replace('\n', " ");
            let words = "equal blades in the modes of 3 nodal diameters";
            assert_eq!(text.matches(words).count(), count, "{asked:?}: {text}");
            assert_eq!(text.contains("differ by 0.02"), count == 1, "{asked:?}: {text}");
            let json = json(&[&asked[..], &["--json"]].concat());
            let notes = [&json["note"], &json["notes"][0]];
            let noted = notes.iter().filter(|note| note.is_string()).count();
            assert_eq!(noted, count, "{asked:?}");
        }
    }
}

#[test]
fn steps_of_the_full_disk_are_fewer_because_each_costs_more() {
    let blades = ["--set", "bladed_disk.blades=4092", "--model", "full", "--step", "1e-7"];
    let message = refusal(&[&["run", "--end", "1.5"], &blades[..]].concat());
    assert!(message.contains("for at most 9.77e6 steps to solver.end_s"), "{message}");
    // The paper's coordinates may take ten billion.
    let message = refusal(&["run", "--end", "1500", "--step", "1e-7"]);
    assert!(message.contains("for at most 1e10 steps to solver.end_s"), "{message}");
}
