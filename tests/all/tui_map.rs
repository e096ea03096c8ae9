//! The map of the explorer: it maps the scene's own law and solver, its cells
//! are those of `rubscope map`, and a cell opens exactly the run it shows.

use ratatui::style::Color;
use rubscope::tui::engine::FullRunState;
use rubscope::tui::{Marker, Theme};
use rubscope_solver::harmonic::{Form, locked_motion};
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
fn the_paper_scene_has_the_zone_of_the_paper_with_its_two_halves() {
    let session = map_of((120, 40), paper());
    let plan = shown_plan(&session);
    assert_eq!(plan.scene.solver.contact, ContactLaw::Bilateral);
    assert_eq!(plan.scene.solver.kind, SolverKind::Explicit);
    let text = session.text();
    assert!(text.contains("bilateral  pulse F over speed Ω [rad/s]  explicit"), "{text}");
    for word in ["Ω_c 292.9", "Ω_lock 411.9", "coincidence", "adhesive: held", "10 MN"] {
        assert!(text.contains(word), "no {word} in {text}");
    }
}

#[test]
fn the_map_of_a_rotor_that_turns_backward_has_its_thresholds() {
    let mut scene = event();
    scene.operation.speed_rad_s = -500.0;
    let session = map_of((120, 40), scene);
    let text = session.text();
    for word in
        ["Ω_c -292.9", "Ω_lock -411.9", "coincidence -388.3", "╋ now -500 rad/s, 50 kN", "-600"]
    {
        assert!(text.contains(word), "no {word} in {text}");
    }
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
fn a_key_switches_the_law_of_the_map_and_of_nothing_else() {
    let mut session = map_of((120, 40), event());
    assert!(
        session.text().contains("unilateral  pulse F over speed Ω [rad/s]  event"),
        "{}",
        session.text()
    );
    session.press("c");
    let solver = shown_plan(&session).scene.solver.clone();
    // The event solver does not know this law.
    assert_eq!((solver.kind, solver.contact), (SolverKind::Explicit, ContactLaw::Bilateral));
    assert!(
        session.text().contains("bilateral  pulse F over speed Ω [rad/s]  explicit"),
        "{}",
        session.text()
    );
    assert!(session.text().contains("c: unilateral"), "{}", session.text());
    assert!(*session.app.scene == event() && !session.app.run.compare);
    session.press("c");
    assert_eq!(shown_plan(&session).scene.solver, event().solver);
    // Elsewhere it compares laws.
    session.press("1c");
    assert!(session.app.run.compare && session.app.map.law.is_none());
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
        let [column, row] = session.app.map_cell().unwrap();
        assert!((plan.x.value(column) - 500.0).abs() < 4.0, "{column}");
        assert!((plan.y.value(row) / 1e6 - 1.0).abs() < 0.1, "{row}");
        session.press("←←←←←←↑↑");
        let cell = session.app.map_cell().unwrap();
        assert_eq!(cell, [column - 6, row + 2]);
        let text = session.text();
        let run = session.app.run.latest.results.found.cell.clone().unwrap();
        assert_eq!((run.cell, run.verdict), (cell, Verdict::Locked));
        assert!(text.contains("this cell:") && text.contains("440 rad/s, 1.585 MN"), "{text}");
        assert!(text.contains("locked") && text.contains("since"), "{text}");
        session.press("←←←←←←←");
        let [column, row] = session.app.map_cell().unwrap();
        session.press("\n");
        let scene = session.app.scene.clone();
        assert_eq!(scene.operation.speed_rad_s, plan.x.value(column));
        assert_eq!(scene.operation.pulse_n, plan.y.value(row));
        let direct = run_to_verdict(&scene, &to_the_end).unwrap().verdict;
        let Some(FullRunState::Done(run)) = &session.app.run.latest.results.full_run else {
            panic!("no run")
        };
        assert_eq!((run.verdict, direct), (Verdict::Adhesive, Verdict::Adhesive));
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
fn the_cell_of_the_scene_keeps_its_values() {
    let mut session = open((100, 30), event(), Theme::Dark, Marker::Braille);
    session.press(":pulse 450k\n5\n");
    assert_eq!(session.app.scene.operation.pulse_n, 450e3);
    session.press("→\n");
    assert_ne!(session.app.scene.operation.pulse_n, 450e3);
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
fn escape_gives_the_arrows_back_and_the_digit_takes_them_again() {
    let mut session = open((100, 30), event(), Theme::Dark, Marker::Braille);
    session.press("5\u{1b}");
    assert!(!session.app.reading.on && session.app.map_cell().is_none());
    session.press("→");
    assert_eq!(session.app.scene.operation.speed_rad_s, 505.0);
    session.press("5");
    assert!(session.app.reading.on);
    session.press("1");
    assert!(!session.app.reading.on, "another view leaves the knobs alone");
}

#[test]
fn any_two_knobs_are_on_the_axes_and_in_the_file() {
    let mut session = open((120, 40), event(), Theme::Dark, Marker::Braille);
    // From the speed on: the diameters, as the pulse is on the other axis.
    session.press("5Xdiam\n");
    let plan = shown_plan(&session);
    assert_eq!((plan.x.path.as_str(), plan.x.count), ("operation.nodal_diameters", 11));
    // The cursor is at the present knobs of the new map: n_d = 3.
    assert_eq!(session.app.map_cell().unwrap()[0], 2);
    assert!(session.text().contains("now n_d 3, 50 kN"), "{}", session.text());
    let text = session.text();
    assert!(text.contains("pulse F over diameters n_d"), "{text}");
    session.press("Xdamping\nYclearance\n");
    let plan = shown_plan(&session);
    assert_eq!(plan.x.path, "casing.damping_ratio");
    assert_eq!((plan.x.from, plan.x.to), (0.0, 0.2));
    assert_eq!(plan.y.path, "clearance");
    let file = session.app.panel().csv(&session.app).unwrap();
    let first = file.lines().next().unwrap();
    assert!(first.starts_with("damping_ratio,"), "{first}");
    assert_eq!(file.lines().count(), 1 + plan.len());
    // A scene from the list of keys has no range of more than this.
    assert!(session.app.status.as_ref().unwrap().starts_with("the map: damping"));
}

#[test]
fn a_map_reads_without_colour_and_in_ascii() {
    for (theme, marker) in [(Theme::Mono, Marker::Braille), (Theme::Dark, Marker::Ascii)] {
        let mut session = open((100, 30), paper(), theme, marker);
        session.press("5f");
        let text = session.text();
        assert!(text.contains('#') && text.contains('%') && text.contains("% adhesive"), "{text}");
        assert!(!text.contains('▀') && (marker != Marker::Ascii || text.is_ascii()), "{text}");
    }
    let mut session = open((100, 30), paper(), Theme::Dark, Marker::Braille);
    session.press("5f");
    let buffer = session.terminal.backend().buffer().clone();
    // A lock that pulls has a sign of its own.
    let locked = buffer.content.iter().filter(|cell| cell.bg == Color::LightBlue).count();
    let pulls = |cell: &&ratatui::buffer::Cell| cell.symbol() == "▒" && cell.fg == Color::LightRed;
    assert!(locked > 50 && buffer.content.iter().filter(pulls).count() > 20);
    assert!(session.text().contains("▒ adhesive"), "{}", session.text());
}

#[test]
fn knobs_outside_the_map_are_said_to_be() {
    let mut scene = event();
    scene.operation.pulse_n = 2e8;
    let session = map_of((120, 40), scene);
    let text = session.text();
    assert!(text.contains("now 500 rad/s, 200 MN: outside"), "{text}");
    assert!(!text.contains('╋'), "{text}");
}

#[test]
fn a_map_fits_every_size_and_progress_is_said_in_the_title() {
    for size in [(40, 12), (80, 24), (120, 40), (200, 50)] {
        let mut session = open(size, paper(), Theme::Dark, Marker::Braille);
        session.press("5f");
        let text = session.text();
        assert!(text.contains("5 map") && text.contains("bilateral"), "{text}");
        assert!(text.contains("locked"), "the cell under the cursor, at {size:?}: {text}");
        let progress = "computing 2 %";
        assert!(text.contains(progress), "{progress} at {size:?}: {text}");
    }
}

#[test]
fn cells_are_round_values_of_the_unit_that_is_shown() {
    let mut session = open((80, 24), paper(), Theme::Dark, Marker::Braille);
    session.press(":460\n5");
    assert!(session.text().contains("[ ] 460 rad/s, 1 MN"), "{}", session.text());
    session.press("\u{1b}U:4500\n5");
    assert!(session.text().contains("[ ] 4500 rpm, 1 MN"), "{}", session.text());
}

#[test]
fn view_3_reads_the_locked_motion_exactly_at_any_speed() {
    let mut session = open((120, 40), paper(), Theme::Dark, Marker::Braille);
    session.press("3f");
    let text = session.text();
    for chart in ["locked λ(Ω)", "locked α(Ω)", "locked u(Ω)", "now -245 -57"] {
        assert!(text.contains(chart), "no {chart} in {text}");
    }
    session.press("i");
    // Seven hundredths of 600 rad/s to the left; the curves have no point there.
    session.press("←←←←←←←");
    let machine = session.app.scene.machine();
    let at = session.app.reading.cursor.unwrap().across * 600.0;
    let sweep = locked_motion(&machine, Form::Modal, true, None, &[at]).unwrap();
    let point = sweep.points[0];
    let text = session.text();
    assert!((at - 458.0).abs() < 1e-9, "{at}");
    let [a, b] = point.multipliers_n;
    let (a, b) = (format!("λ_a {a:.1} N"), format!("λ_b {b:.2} N"));
    for part in
        ["at 458.0 rad/s", &a, &b, "|u| 1.0103 g0", "α_a -39.63 nrad", "u_cs -96.94", "both push"]
    {
        assert!(text.contains(part), "no {part} in {text}");
    }
    session.press("HH");
    assert!(session.text().contains("one pulls"), "{}", session.text());
    let file = session.app.panel().csv(&session.app).unwrap();
    assert!(file.starts_with("speed_rad_s,"));
    assert!(file.contains(",amplitude_m,") && file.contains(",u_ss_m,"), "{file}");
}

#[test]
fn view_3_of_a_rotor_that_turns_the_other_way_says_so() {
    let mut scene = paper();
    scene.operation.speed_rad_s = -430.0;
    let mut session = open((200, 50), scene, Theme::Dark, Marker::Braille);
    session.press("3");
    assert!(session.text().contains("turning backwards"), "{}", session.text());
    session.press("i");
    let text = session.text();
    assert!(text.contains("at -430.0 rad/s"), "{text}");
    let machine = session.app.scene.machine();
    let sweep = locked_motion(&machine, Form::Modal, true, None, &[-430.0]).unwrap();
    let push = sweep.points[0].multipliers_n[1];
    assert!(text.contains(&format!("λ_b {push:.1} N")), "{push} {text}");
}
