//! Time on the screen: one instant in every panel, now and at the end, the run to
//! come, and changes of contact.

use ratatui::{Terminal, backend::TestBackend};
use rubscope::tui::{Marker, Source, Theme};
use rubscope_solver::motion::Motion;
use rubscope_solver::scene::Scene;

use crate::cli_support::{json, words};
use crate::tui_support::Session;

/// A wide explorer whose engine goes on by `stride` at each look.
fn open(scene: Scene, stride: f64) -> Session {
    Session::with_stride((170, 40), stride, scene, Theme::Mono, Marker::Braille)
}

fn row(session: &Session, y: usize) -> String {
    session.rows().swap_remove(y)
}

fn scene(name: &str) -> Scene {
    Scene::builtin(name).unwrap()
}

#[test]
fn the_first_line_says_what_is_now_and_what_will_be() {
    let mut session = open(scene("run-down"), 4e-3);
    let line = row(&session, 0);
    assert!(line.starts_with(" DECAY  The lock breaks at 410.4 rad/s; then the "), "{line}");
    let line = row(&session, 1);
    assert!(line.starts_with("NOW ") && line.contains(" held on 6 + 21 ► "), "{line}");
    assert!(
        line.contains("rad/s↓") && line.contains("AT 100 ms decay, locked until 48.91 ms"),
        "{line}"
    );
    // The speed that is shown is that of the ramp, with its sign.
    session.press_each("....");
    let speed = session.app.speed();
    assert!(speed < 430.0 && row(&session, 1).contains(&format!("{speed:.1} rad/s↓")));
    session.press_each("\n-430\n");
    let line = row(&session, 1);
    assert!(
        line.contains(" -430.") || line.contains(" -431.") || line.contains(" -429."),
        "{line}"
    );
    let limits = row(&session, 1);
    // A rotor that turns backward has its own coincidence.
    for number in ["Ω_c 292.9", "Ω_lock 411.9", "coincidence -388.3"] {
        assert!(limits.contains(number), "{number}: {limits}");
    }
}

#[test]
fn the_instant_and_the_end_are_said_at_every_size() {
    for name in ["paper-nd3", "run-down", "coincidence", "oval"] {
        for (width, height) in [(40, 12), (60, 18), (80, 24), (200, 50)] {
            let mut session =
                Session::open(width, height, scene(name), Theme::Mono, Marker::Braille);
            for key in ["U", "\n-12000\n", "U"] {
                let line = row(&session, 1);
                assert!(line.starts_with("NOW ") && line.contains(" AT "), "{width} {line}");
                session.press(key);
            }
        }
    }
}

#[test]
fn the_reading_cursor_reads_the_run_and_not_a_bin() {
    let mut session = open(scene("paper-nd3"), 3e-3);
    session.press_each("1fi←←←←←←←←←");
    let t = session.app.reading.at_s.unwrap();
    let mut motion = Motion::new(&session.app.scene);
    motion.advance(t).unwrap();
    let ([u_c, u_s], [alpha_c, _]) = (motion.state().u, motion.state().alpha);
    let text = session.text();
    for wanted in [
        format!("u_c {:.2} µm", 1e6 * u_c),
        format!("u_s {:.2} µm", 1e6 * u_s),
        format!("α_c {:.1} nrad", 1e9 * alpha_c),
        format!("at {:.4} ms", 1e3 * motion.state().t_s),
    ] {
        assert!(text.contains(&wanted), "{wanted} is not in\n{text}");
    }
    // Every panel shows that instant.
    let gaps = session.app.shown().unwrap().gaps.clone();
    assert_eq!(gaps, motion.blade_gaps());
    session.press_each("\u{1b}");
    assert!(session.app.reading.cursor.is_none() || !session.app.reading.on);
}

#[test]
fn a_jump_says_what_happened_and_when() {
    let mut session = open(scene("rocking"), 1e-9);
    let mut motion = Motion::new(&session.app.scene);
    motion.advance(0.01).unwrap();
    let first = motion.contacts().impacts[0].t_s;
    assert!((first - 1.0304252344738236e-4).abs() < 1e-15, "{first:e}");
    for zoom in ["", "++++++++", "--------"] {
        session.press_each(&format!("r={zoom}n"));
        let status = session.app.status.clone().unwrap();
        assert_eq!(status, "103.043 µs: touching 19");
    }
}

#[test]
fn the_run_to_come_is_on_the_chart_before_it_is_played() {
    let dots = |session: &Session| {
        let braille = |letter: &char| ('\u{2801}'..='\u{28ff}').contains(letter);
        (3..20).map(|y| row(session, y).chars().skip(30).filter(braille).count()).sum::<usize>()
    };
    let mut session = open(scene("rocking"), 1e-9);
    assert!(session.app.now() < 1e-6 && dots(&session) > 60, "{}", session.text());
    // A page ahead, too.
    session.press_each(">");
    assert!(session.app.page().0 > 0.0 && dots(&session) > 60, "{}", session.text());
}

#[test]
fn the_motion_stops_at_the_end_of_the_run_and_goes_on_when_asked() {
    let mut scene = scene("rocking");
    scene.solver.end_s = 5e-3;
    let mut session = open(scene, 5e-4);
    while session.app.play.playing {
        session.press_each("");
    }
    assert_eq!(session.app.now(), 5e-3);
    assert!(
        row(&session, 39).contains("the end of the run; Space goes on"),
        "{}",
        row(&session, 39)
    );
    assert!(row(&session, 1).contains("AT 5 ms"));
    session.press_each(" ");
    assert!(
        session.app.play.playing && row(&session, 1).contains("AT 10 ms"),
        "{}",
        row(&session, 1)
    );
    assert!(session.app.now() > 5e-3);
    while session.app.play.playing {
        session.press_each("");
    }
    session.press_each("l");
    assert!(session.app.play.playing && session.app.now() > 0.0);
    // But not after a pause by hand.
    session.press_each(" l");
    let last = row(&session, 39);
    assert!(!session.app.play.playing && last.contains("Space go on"), "{last}");
}

#[test]
fn a_pin_says_what_it_pinned() {
    let mut session = open(scene("rocking"), 1e-3);
    session.press_each("1b");
    let status = session.app.status.clone().unwrap();
    assert!(status.starts_with("pinned behind the next runs: ") && status.contains("rad/s"));
    let speed = session.app.scene.operation.speed_rad_s;
    session.press_each("llll");
    assert!(
        session.text().contains(&format!("pinned: speed Ω {speed} rad/s")),
        "{}",
        session.text()
    );
}

#[test]
fn the_reading_cursor_reads_every_chart() {
    let mut session = open(scene("rocking"), 1e-3);
    // View 6: the line of the spectrum under the cursor; view 4: the place.
    session.press_each("6f i");
    let text = session.text();
    assert!(text.contains("rad/s: u_c ") && text.contains(", u_s "), "{text}");
    let before = session.app.reading.cursor.unwrap();
    session.press_each("lllll");
    assert!(session.app.reading.cursor.unwrap().across > before.across);
    session.press_each("4");
    assert!(session.app.reading.cursor.is_none());
    session.press_each("i");
    assert!(session.text().contains(" to blade "), "{}", session.text());
    // View 2: the gap of one blade, as the motion has it.
    session.press_each("2lll");
    let gap = session.app.shown().unwrap().gaps[3];
    let wanted = format!("blade 4: {:.2}", 1e6 * gap);
    assert!(session.text().contains(&wanted[..13]), "{wanted}\n{}", session.text());
}

#[test]
fn a_lesson_slows_down_at_changes_and_gives_the_pace_back() {
    let mut session = open(scene("rocking"), 1e-3);
    session.press_each("z");
    assert!(!session.app.play.slow_at_events);
    session.press_each("g\n");
    assert!(session.app.play.slow_at_events);
    session.press_each("G");
    assert!(!session.app.play.slow_at_events && session.app.lessons.progress.is_none());
}

#[test]
fn the_reading_cursor_names_the_nearest_run_of_the_comparison() {
    let mut scene = scene("rocking");
    scene.solver.end_s = 2e-3;
    let mut session = open(scene, 1e-4);
    session.press_each("7fi");
    let text = session.text();
    assert!(text.contains(": error ") && text.contains(" in "), "{text}");
}

#[test]
fn the_copied_command_repeats_live_changes_at_their_instants() {
    for name in ["rocking", "paper-nd3"] {
        let mut scene = scene(name);
        scene.solver.end_s = 0.02;
        let mut session = open(scene, 1e-4);
        let opened = Scene::builtin(name).unwrap();
        session.app.files.source = Some(Source { name: name.into(), scene: opened });
        session.press_each(" x");
        session.press_each("\n430\n");
        session.press_each(" ");
        session.press_each(" p");
        session.press_each("\n505\n");
        let app = &session.app;
        let command = app.command();
        assert_eq!(command.matches(" --at ").count(), 3, "{command}");
        let run = app.full_run().unwrap();
        assert!(!command.contains('\''), "{command}");
        let report = json(&words(&format!("{command} --json"))[1..]);
        let outcome = &report["outcome"];
        assert_eq!(outcome["verdict"].as_str().unwrap(), run.verdict.as_ref(), "{command}");
        assert_eq!(report["impact_count"].as_u64().unwrap(), run.impacts, "{command}");
        let end = run.trace.points.last().unwrap();
        let last = report["final"]["u_c_m"].as_f64().unwrap();
        // The same instants, but for the step in which a change comes.
        assert!((end[0] - last).abs() < 1e-9, "{name}: {} {last}", end[0]);
    }
}

#[test]
fn another_scene_has_scales_of_its_own() {
    // Two parallel sides and no corner: the wave leaves the casing far.
    let changes = [
        ("operation.nodal_diameters", "11"),
        ("operation.speed_rad_s", "100"),
        ("operation.pulse_n", "20000"),
        ("solver.model", "rigid"),
        ("solver.end_s", "0.012"),
    ];
    let half = crate::scene("paper-nd3", &changes).as_reference();
    let mut session = open(half, 1e-3);
    let before = session.app.run.ranges.casing;
    session.press_each(":paper-nd3\n");
    let after = session.app.run.ranges.casing;
    assert!(before.high > 1e-3 && after.high < 3e-4, "{before:?} {after:?}");
}

#[test]
fn a_blade_that_lets_go_is_named() {
    let mut session = open(scene("run-down"), 1e-3);
    session.press_each(" n");
    let status = session.app.status.clone().unwrap();
    assert_eq!(status, "48.9136 ms: 21 lets go, 6 still touches");
}

#[test]
fn a_reading_has_room_on_a_small_screen() {
    let mut session = open(scene("rocking"), 1e-3);
    for (width, height) in [(80, 24), (60, 20)] {
        session.terminal = Terminal::new(TestBackend::new(width, height)).unwrap();
        for (view, wanted) in [("1", "u_c "), ("6", "u_c "), ("4", "blade 1: ")] {
            session.press_each(&format!("{view}i"));
            let rows = session.text();
            assert!(rows.contains(wanted), "{view} at {width}x{height}\n{rows}");
            session.press_each("\u{1b}");
        }
    }
}
