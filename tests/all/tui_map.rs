//! The map of the explorer: it maps the scene's own law and solver, its cells
//! are those of `rubscope map`, and a cell opens exactly the run it shows.

use rubscope::tui::engine::FullRunState;
use rubscope::tui::{Marker, Theme};
use rubscope_solver::motion::{Verdict, run_to_verdict, to_the_end};
use rubscope_solver::scene::{ContactLaw, Scene, SolverKind};
use rubscope_solver::study::{Map, MapPlan};

use crate::cli_support::{json, words};
use crate::tui_support::Session;

fn open(size: (u16, u16), scene: Scene, theme: Theme, marker: Marker) -> Session {
    Session::with_stride(size, 1e-3, scene, theme, marker)
}

/// The map of a scene.
fn map_of(size: (u16, u16), scene: Scene) -> Session {
    let mut session = open(size, scene, Theme::Dark, Marker::Braille);
    session.press("5");
    session
}

fn shown_map(session: &Session) -> &Map {
    &session.app.run.latest.results.found.map.as_ref().unwrap().map
}

fn shown_plan(session: &Session) -> MapPlan {
    shown_map(session).plan.clone()
}

/// Column, row and verdict of each cell that is computed.
fn shown_cells(session: &Session) -> Vec<(u32, u32, Verdict)> {
    let map = shown_map(session);
    let (x, y) = (map.plan.x.count, map.plan.y.count);
    let places = (0..y).flat_map(|row| (0..x).map(move |column| (column, row)));
    places.filter_map(|(column, row)| Some((column, row, map.at(column, row)?.verdict))).collect()
}

/// The paper's scene, with a shorter run for speed.
fn paper() -> Scene {
    let mut scene = Scene::builtin("paper-nd3").unwrap();
    scene.solver.end_s = 0.02;
    scene
}

fn event() -> Scene {
    let mut scene = paper().as_reference();
    scene.operation.pulse_n = 5e4;
    scene
}

#[test]
fn cells_are_those_of_the_map_command() {
    let session = map_of((80, 24), paper());
    let plan = shown_plan(&session);
    for (column, row, verdict) in shown_cells(&session).into_iter().step_by(13) {
        let (speed, pulse) = (plan.x.value(column), plan.y.value(row));
        let axis = |path: &str, value: f64| format!("operation.{path}={value:?}:{value:?}:1");
        let (x, y) = (axis("speed_rad_s", speed), axis("pulse_n", pulse));
        let map = words("map paper-nd3 --end 0.02 --no-sensitivity --json --x");
        let json = json(&[&map[..], &[&x, "--y", &y]].concat());
        assert_eq!(json["verdict"][0][0], verdict.as_ref(), "{speed} {pulse}");
    }
}

#[test]
fn a_cell_opens_the_run_it_shows_and_undo_brings_the_other_back() {
    for (keys, live) in [("", false), ("x", true)] {
        let mut session = open((120, 40), paper(), Theme::Dark, Marker::Braille);
        session.press(keys);
        session.press("5");
        assert!(session.app.reading.on, "the arrows go to the cell at once");
        let plan = shown_plan(&session);
        // It begins at the present knobs, and every arrow is one cell.
        let [column, row] = session.app.order().cell.unwrap();
        assert!((plan.x.value(column) - 500.0).abs() < 4.0, "{column}");
        assert!((plan.y.value(row) / 1e6 - 1.0).abs() < 0.1, "{row}");
        session.press("←←←←←←↑↑");
        let cell = session.app.order().cell.unwrap();
        assert_eq!(cell, [column - 6, row + 2]);
        let text = session.text();
        let run = session.app.run.latest.results.found.cell.clone().unwrap();
        assert_eq!((run.cell, run.verdict), (cell, Verdict::Locked));
        assert!(text.contains("this cell:") && text.contains("440 rad/s, 1.585 MN"), "{text}");
        assert!(text.contains("locked") && text.contains("since"), "{text}");
        session.press("←←←←←←←");
        let [column, row] = session.app.order().cell.unwrap();
        session.press("\n");
        let scene = session.app.scene.clone();
        assert_eq!(scene.operation.speed_rad_s, plan.x.value(column));
        assert_eq!(scene.operation.pulse_n, plan.y.value(row));
        let direct = run_to_verdict(&scene, &to_the_end).unwrap().verdict;
        let Some(FullRunState::Done(run)) = &session.app.run.latest.results.full_run else {
            panic!("no run")
        };
        assert_eq!((run.facts.verdict, direct), (Verdict::Adhesive, Verdict::Adhesive));
        assert_eq!(session.app.knobs.live, live);
        assert!(
            session
                .app
                .status
                .as_ref()
                .unwrap()
                .starts_with("opened speed Ω 370 rad/s, pulse F 1.58")
        );
        session.press("u");
        assert_eq!(*session.app.scene, paper());
    }
}

#[test]
fn the_law_of_the_map_goes_with_the_run_it_opens() {
    let mut session = open((100, 30), event(), Theme::Dark, Marker::Braille);
    session.press("5c\n");
    assert_eq!(session.app.scene.solver.contact, ContactLaw::Bilateral);
    assert_eq!(session.app.scene.solver.kind, SolverKind::Explicit);
    let plan = shown_plan(&session);
    session.press("");
    // It is the same map: nothing is computed again.
    assert_eq!(shown_plan(&session), plan);
}

#[test]
fn any_two_knobs_are_on_the_axes_and_in_the_file() {
    let mut session = open((120, 40), event(), Theme::Dark, Marker::Braille);
    // From the speed on: the diameters, as the pulse is on the other axis.
    session.press("5Xdiam\n");
    let plan = shown_plan(&session);
    assert_eq!((plan.x.path.as_str(), plan.x.count), ("operation.nodal_diameters", 11));
    // The cursor is at the present knobs of the new map: n_d = 3.
    assert_eq!(session.app.order().cell.unwrap()[0], 2);
    assert!(session.text().contains("now n_d 3, 50 kN"), "{}", session.text());
    let text = session.text();
    assert!(text.contains("pulse F over diameters n_d"), "{text}");
    session.press("Xdamping\nYclearance\n");
    let plan = shown_plan(&session);
    assert_eq!(plan.x.path, "casing.damping_ratio");
    assert_eq!((plan.x.from, plan.x.to), (0.0, 0.2));
    assert_eq!(plan.y.path, "clearance");
    let file = session.app.panel().file(&session.app, "csv").unwrap();
    let first = file.lines().next().unwrap();
    assert!(first.starts_with("damping_ratio,"), "{first}");
    assert_eq!(file.lines().count(), 1 + plan.len());
    // A scene from the list of keys has no range of more than this.
    assert!(session.app.status.as_ref().unwrap().starts_with("the map: damping"));
}
