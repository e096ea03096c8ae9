//! The numbers of docs/accuracy.md, docs/validation.md and the README that no other test checks,
//! outside their console blocks.

use rubscope_solver::harmonic::Lining;
use rubscope_solver::motion::{RunReport, Verdict, simulate};
use rubscope_solver::scene::Scene;
use rubscope_solver::study::{Cell, Doubt};

use super::read;
use crate::cli_support::{json, text};
use crate::close;
use crate::scene;

/// A run of a built-in scene with some keys set, without those that say how far to trust it.
fn run(name: &str, changes: &[(&str, &str)]) -> RunReport {
    crate::run_once(&scene(name, changes))
}

/// The number at the start of a cell.
fn number(cell: &str) -> f64 {
    cell.trim_matches('`').split([' ', ',']).next().unwrap().parse().unwrap()
}

#[test]
fn impacts_of_the_explicit_solver_are_as_late_as_the_document_says() {
    let weak = |key: &str, value: &str| {
        let push = ("solver.contact", "unilateral");
        run("paper-nd3", &[("operation.pulse_n", "2e4"), push, (key, value)])
    };
    let event = weak("solver.kind", "event");
    let header = "| time step | error of the two impact times | error of u_s at 0.1 s |";
    let rows = read("docs/accuracy.md").table(header);
    assert_eq!(rows.len(), 4);
    for row in rows {
        let found = weak("solver.step_s", &number(&row[0]).to_string());
        let told: Vec<f64> = row[1].split(", ").map(number).collect();
        for ((one, other), told) in found.impacts.iter().zip(&event.impacts).zip(told) {
            // One digit, and a tenth of a step is a digit of the last.
            let late = (one.t_s - other.t_s).abs();
            assert!((late - told).abs() <= 0.35 * told, "{late}, the document says {told}");
        }
        let (found, exact) = (found.r#final.u_s_m, event.r#final.u_s_m);
        close(100.0 * (found / exact - 1.0).abs(), number(&row[2]), 0.04);
    }
}

#[test]
fn a_lock_of_the_explicit_solver_has_the_forces_of_the_document_and_its_formula() {
    let scene = Scene::builtin("paper-nd3").unwrap();
    let machine = scene.machine();
    let speed = scene.operation.speed_rad_s;
    let (g0, delta) = (machine.clearance(), machine.polygon.delta);
    let nu = machine.nu(speed);
    let (k, d) =
        (machine.casing_stiffness - nu * nu * machine.casing_mass, machine.casing_damping * nu);
    // (K + iD) exp(-i nu h).
    let pushes = |step: f64| {
        let (sin, cos) = (nu * step).sin_cos();
        let (k, d) = (k * cos + d * sin, d * cos - k * sin);
        let half = g0 / (2.0 * delta.cos());
        [-1.0, 1.0].map(|sign| half * (k / delta.cos() + sign * d / delta.sin()))
    };
    let rows = read("docs/accuracy.md").table("| | larger push | smaller push |");
    assert_eq!(rows.len(), 4);
    for row in rows {
        let step = row[0].split("h = ").nth(1).map(number);
        let told = [number(&row[1]), number(&row[2])];
        let formula = pushes(step.unwrap_or(0.0));
        for (found, told) in formula.iter().zip(told) {
            close(-found, told, 4e-6);
        }
        let Some(step) = step else { continue };
        let changes = [("solver.step_s", &*step.to_string()), ("solver.end_s", "0.02")];
        let report = run("paper-nd3", &changes);
        assert_eq!(report.outcome.verdict, Verdict::Locked);
        for (contact, told) in report.outcome.contacts.iter().zip(told) {
            close(-contact.multiplier_n, told, 2e-5);
        }
    }
    let step = 1e-7;
    close(nu * step * k.abs() / d, 0.0017, 0.02);
    close(pushes(0.0)[0] - pushes(step)[0], 0.155, 0.01);
}

#[test]
fn the_bounds_of_the_step_are_those_of_the_document() {
    let scene = Scene::builtin("paper-nd3").unwrap();
    assert_eq!(scene.stable_step(), 2.276_257_268_029_927e-3);
    let document = read("docs/accuracy.md");
    assert!(document.says("2.276257e-3 s here"));
    // At 10 rad/s the stability limit is the lower one.
    for (step, allowed) in [("2.2762e-3", true), ("2.2763e-3", false)] {
        let set = [("solver.step_s", step), ("operation.speed_rad_s", "10")];
        assert_eq!(scene.clone().with(&set).is_ok(), allowed, "{step}");
    }
}

#[test]
fn steps_are_taken_and_skipped_as_the_document_counts() {
    let rows = read("docs/accuracy.md").table("| command | steps taken | steps skipped |");
    assert_eq!(rows.len(), 6);
    for row in rows {
        let command = row[0].trim_matches('`').strip_prefix("rubscope ").unwrap();
        let arguments: Vec<&str> = command.split(' ').chain(["--json"]).collect();
        let report = json(&arguments);
        for (name, told) in [("steps", &row[1]), ("steps_skipped", &row[2])] {
            // Round-off of another processor may move a stride.
            close(report["solver"][name].as_f64().unwrap(), number(&told.replace(',', "")), 0.02);
        }
    }
}

#[test]
fn errors_at_the_end_are_those_of_the_document() {
    let arguments = ["precision", "--pulse", "20e3", "--repeat", "1", "--json"];
    let report = json(&arguments);
    let rows = report["rows"].as_array().unwrap();
    let header = "| solver | step or tolerance | error at the end, in clearances | time | bench |";
    let told = read("docs/validation.md").table(header);
    assert_eq!(told.len(), 7);
    for row in told {
        let [solver, contact, model] = row[0].split(", ").collect::<Vec<_>>()[..] else {
            unreachable!("{row:?}")
        };
        let finest = number(&row[1]);
        let is = |found: &serde_json::Value| {
            let by = found["step_s"].as_f64().or(found["tolerance"].as_f64());
            found["solver"] == solver
                && found["contact"] == contact
                && found["model"] == model
                && by == Some(finest)
        };
        let found = rows.iter().find(|found| is(found)).unwrap()["error_final"].as_f64().unwrap();
        match row[2].as_str() {
            "reference" => assert_eq!(found, 0.0),
            told => close(found, number(told), 0.02),
        }
    }
}

/// The pages say what many impacts leave of an order.
#[test]
fn what_does_not_converge_is_in_the_documents() {
    let of = |key: &str, value: &str| {
        run("paper-nd3", &[("solver.contact", "unilateral"), (key, value)])
    };
    let exact = of("solver.kind", "event");
    assert_eq!(simulate(&exact.scene).outcome.sensitive, Some(false));
    let clearance = Scene::builtin("paper-nd3").unwrap().clearance();
    let told = read("docs/accuracy.md")
        .table("| solver | step | impacts | error at 0.1 s, in clearances |");
    assert_eq!(told.len(), 5);
    let by_steps = |step: f64| of("solver.step_s", &step.to_string());
    for row in &told {
        let Ok(step) = row[1].replace(" s", "").parse::<f64>() else {
            assert_eq!((&*row[0], &*row[1], &*row[3]), ("event", "none", "reference"));
            assert_eq!(row[2], exact.impact_count.to_string());
            continue;
        };
        let found = by_steps(step);
        let (u, right) = (&found.r#final, &exact.r#final);
        let error = (u.u_c_m - right.u_c_m).hypot(u.u_s_m - right.u_s_m) / clearance;
        close(error, number(&row[3]), 0.04);
        assert_eq!(found.outcome.verdict, Verdict::Decay);
        assert_eq!(found.impact_count.to_string(), row[2]);
    }
    // No nearer with a smaller step, until it is short.
    let errors: Vec<f64> = told[..4].iter().map(|row| number(&row[3])).collect();
    assert!(errors[..3].is_sorted() && errors[3] < errors[0], "{errors:?}");
    let of_events = &told[4][2];
    let impacts = |step: &f64| by_steps(*step).impact_count.to_string();
    assert!([3e-8, 2e-8, 1e-8].iter().all(|step| impacts(step) == *of_events));
    let said = format!(
        "do not improve the default scene down to {}; from 3e-8 s down it has the {of_events} impacts \
         of the event solver",
        told[2][1]
    );
    assert!(read("docs/accuracy.md").says(&said), "{said}");
}

#[test]
fn long_steps_lock_falsely_as_often_as_the_document_says() {
    let locks = |step: f64| {
        let changes = [("operation.pulse_n", "18e3"), ("solver.step_s", &*step.to_string())];
        match run("paper-nd3", &changes).outcome.verdict {
            Verdict::Locked => true,
            other => {
                assert_eq!(other, Verdict::Decay, "{step}");
                false
            }
        }
    };
    let part = |n: u32| f64::from(n) / 49.0;
    let long = (0..50).filter(|n| locks(5e-6 * (1.0 + part(*n)))).count();
    assert!((0..50).all(|n| !locks(1e-8 * 200_f64.powf(part(n)))));
    let said = format!("With {long} of 50 equally spaced step sizes from 5e-6 to 1e-5 s");
    assert!(read("docs/accuracy.md").says(&said), "{said}");
}

/// The map of the README with contact that only pushes.
#[test]
fn contact_that_only_pushes_locks_as_many_cells_as_the_readme_says() {
    let map = "map paper-fig-8 --speed 260:500:49 --pulse 1e5:1e6:10 --no-sensitivity";
    assert!(read("README.md").text.contains(map));
    let more = ["--contact", "unilateral", "--json"];
    let [steps, events] = [&[][..], &["--solver", "event"]].map(|solver| {
        let arguments: Vec<&str> = map.split(' ').chain(more).chain(solver.to_vec()).collect();
        let report = json(&arguments);
        let cells = report["verdict"].to_string();
        ["locked", "decay"].map(|word| cells.matches(word).count())
    });
    assert_eq!((steps, events), ([1, 489], [0, 490]));
    assert!(read("README.md").says(
        "the time-stepping solver still locks in 1 of the 490 cells; the event solver in none"
    ));
}

#[test]
fn every_verdict_has_its_word_and_its_signs_in_the_tables_and_legends() {
    let told = read("docs/accuracy.md").table("| verdict | in maps | meaning |");
    assert_eq!(told.len(), Verdict::ALL.len());
    let readme = read("README.md");
    for verdict in Verdict::ALL {
        let word = verdict.as_ref();
        assert!(readme.says(&format!("*{word}*")), "{word}");
        let [plain, letter] = [Doubt::None, Doubt::Sensitive].map(|doubt| {
            format!("`{}`", rubscope::sheet::map::mark(Some(Cell { verdict, doubt })))
        });
        let row = [word.to_string(), format!("{plain} {letter}")];
        assert!(told.iter().any(|told| told[..2] == row), "{row:?}: {told:?}");
    }
    // The legend of a map with a sensitive cell has all letters.
    let map = ["map", "--solver", "event", "--speed", "500:500:1", "--pulse", "2e5:2e5:1"];
    let printed = text(&map);
    let letters = Verdict::ALL
        .map(|verdict| rubscope::sheet::map::mark(Some(Cell { verdict, doubt: Doubt::Sensitive })));
    let told = format!("A letter ({}) marks", letters.map(String::from).join(" "));
    assert!(printed.contains(&told), "{printed}");
}

#[test]
fn the_explorer_has_the_views_and_limits_of_the_document() {
    let document = read("docs/explorer.md");
    let text = &document.text;
    let views = text.lines().filter(|line| {
        line.strip_prefix("### ").is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
    });
    assert_eq!(views.count(), rubscope_solver::scene::keys::CHARTS.len());
    let (columns, rows) = rubscope::tui::terminal::MOST;
    assert!(document.says(&format!("at most {columns} x {rows}")));
}

#[test]
fn the_readme_has_the_numbers_of_the_page_on_accuracy_and_the_speeds_of_the_machine() {
    let (readme, accuracy) = (read("README.md"), read("docs/accuracy.md"));
    let header = "| time step | error of the two impact times | error of u_s at 0.1 s |";
    let known = accuracy.table(header);
    let header =
        "| solver | step | error of the impact times | error of u_s at 0.1 s | time | bench |";
    let told = readme.table(header);
    let explicit: Vec<_> = told.iter().filter(|row| row[0] == "explicit").collect();
    assert_eq!(explicit.len(), 2);
    for row in explicit {
        assert!(known.iter().any(|other| other[..] == row[1..4]), "{row:?}");
    }
    let machine = Scene::builtin("paper-nd3").unwrap().machine();
    let rounded = |speed: Option<f64>| format!("{:.1} rad/s", speed.unwrap());
    assert!(readme.says(&format!("**Omega_c**, {} here", rounded(machine.critical_speed()))));
    assert!(readme.says(&format!("**Omega_lock**, {},", rounded(machine.lock_speed()))));
    assert!(readme.says(&format!("({:.0} rad/s here)", machine.dangerous_speed().unwrap())));
}

/// The note of the oval casing: the part of the lining's stiffness that its arcs have.
#[test]
fn the_arcs_of_the_oval_casing_have_the_stiffness_of_its_note() {
    let scene = scene("oval", &[]);
    assert!(scene.note.contains("a lining of 0.39 of the stiffness"), "{}", scene.note);
    let machine = scene.machine();
    let lining = Lining::of(&machine, &scene.contact).unwrap();
    let all = 11.0 * scene.contact.stiffness_n_per_m;
    close(lining.stiffness_at_rest() / all, 0.39, 0.012);
}
