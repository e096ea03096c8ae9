//! Time on the screen: one instant in every panel, the run to come, and the copied command.

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
fn the_instant_and_the_end_are_said_at_every_size() {
    for name in ["paper-nd3", "run-down", "coincidence", "oval"] {
        for (width, height) in [(40, 12), (60, 18), (80, 24), (200, 50)] {
            let mut short = scene(name);
            (short.solver.end_s, short.view.begin_s) = (0.01, 0.0);
            let mut session = Session::open(width, height, short, Theme::Mono, Marker::Braille);
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
        let command = session.app.command_line().to_string();
        assert_eq!(command.matches(" --at ").count(), 3, "{command}");
        let run = session.app.full_run().unwrap();
        assert!(!command.contains('\''), "{command}");
        let report = json(&words(&format!("{command} --json"))[1..]);
        let outcome = &report["outcome"];
        assert_eq!(outcome["verdict"].as_str().unwrap(), run.facts.verdict.as_ref(), "{command}");
        assert_eq!(report["impact_count"].as_u64().unwrap(), run.facts.touches, "{command}");
        let last = report["final"]["u_c_m"].as_f64().unwrap();
        session.press_each(":end\n");
        let [end, _] = session.app.shown().unwrap().state.u;
        // The same instants, but for the step in which a change comes.
        assert!((end - last).abs() < 1e-9, "{name}: {end} {last}");
    }
}
