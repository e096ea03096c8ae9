//! The margins of the explorer: they follow the knobs, are clicked on, and fit every size.

use crossterm::event::{KeyModifiers, MouseButton, MouseEvent, MouseEventKind};
use rubscope::tui::{Effect, Marker, Theme};
use rubscope_solver::scene::Scene;

use crate::tui_support::{Session, scene};

/// A short run.
fn short() -> Scene {
    let mut scene = scene();
    scene.solver.end_s = 5e-3;
    scene
}

fn open(size: (u16, u16), scene: Scene) -> Session {
    let mut session = Session::searched(size.0, size.1, scene, Theme::Dark, Marker::Braille);
    session.press("8");
    session
}

/// The line of a limit.
fn line(session: &Session, symbol: &str) -> String {
    let text = session.text();
    let beginning = ["▸", " ", "●"].map(|sign| format!("{sign}{symbol} "));
    let chart = |line: &str| {
        let at = beginning.iter().find_map(|start| line.find(start.as_str()))?;
        let knobs = usize::from(session.app.layout.size.0 >= 100) * 27;
        (line[..at].chars().count() == knobs).then(|| line[at..].to_string())
    };
    text.lines().find_map(chart).unwrap_or_else(|| panic!("no {symbol} in {text}"))
}

/// The cell under the cursor.
fn cell(session: &Session) -> [usize; 2] {
    session.app.margins_cell().unwrap()
}

fn selected(session: &Session) -> &'static str {
    session.app.selected().unwrap().path
}

#[test]
fn the_margins_follow_the_knobs_and_nothing_is_computed_while_they_are_closed() {
    let mut session = Session::searched(120, 40, short(), Theme::Dark, Marker::Braille);
    session.press("");
    assert!(session.app.margins().is_none());
    session.press("8");
    session.select("casing.damping_ratio");
    session.press("\n0.1\n");
    session.press("");
    let lock = session.app.machine.lock_speed().unwrap();
    assert!(line(&session, "Ω_lock").contains(&format!("{lock:.2}")), "{}", session.text());
    assert!(line(&session, "Ω_lock").contains(" -"), "{}", session.text());
    session.press("4");
    session.press("\n0.02\n");
    let (live, old) = session.app.margins().unwrap();
    assert!(old && live.margins.scene.casing.damping_ratio == 0.1);
}

#[test]
fn a_click_reads_a_row_and_a_second_one_jumps() {
    let mut session = open((120, 40), short());
    let click = |session: &mut Session, (column, row)| {
        let kind = MouseEventKind::Down(MouseButton::Left);
        let heard =
            session.app.mouse(&MouseEvent { kind, column, row, modifiers: KeyModifiers::NONE });
        session.press("");
        heard
    };
    let coincidence = session.find("388.31");
    assert_eq!(click(&mut session, coincidence), Some(Effect::None));
    assert_eq!(cell(&session), [0, 3]);
    click(&mut session, coincidence);
    let speed = session.app.machine.dangerous_speed().unwrap();
    assert_eq!(session.app.scene.operation.speed_rad_s, speed);
    let (_, row) = session.find("411.93");
    click(&mut session, (118, row));
    assert_eq!(cell(&session), [3, 2]);
    click(&mut session, (118, row));
    assert_eq!(selected(&session), "casing.damping_ratio");
}

#[test]
fn the_columns_and_rows_that_have_no_room_are_said_or_left_out() {
    let mut session = open((80, 24), short());
    session.press("ij ");
    session.press("kj");
    for (width, height) in [(80, 24), (120, 40), (40, 12), (200, 50)] {
        session.resize((width, height));
        insta::assert_snapshot!(format!("margins_{width}x{height}"), session.text());
        assert!(session.text().contains("Enter jump  "), "{}", session.text());
    }
    session.resize((80, 13));
    session.press("i");
    assert!(session.text().contains("↓"), "{}", session.text());
    session.press("i");
    session.press(&"j".repeat(20));
    assert_eq!(cell(&session), [0, 13]);
    assert!(session.text().contains("↑"), "{}", session.text());
    assert!(line(&session, "e_max m=2").contains(" nm"), "{}", session.text());
}

#[test]
fn a_companion_has_the_symbols_per_cents_and_words_and_mono_needs_no_colour() {
    let mut scene = short();
    scene.view.charts = vec!["response".into(), "margins".into(), "gaps".into()];
    let mut session = Session::searched(120, 40, scene.clone(), Theme::Dark, Marker::Braille);
    session.press(" ");
    assert!(session.text().contains("Ω_lock ") && session.text().contains("-17.6 %"));
    insta::assert_snapshot!("margins_companion", session.text());
    let mut plain = Session::searched(120, 40, short(), Theme::Mono, Marker::Ascii);
    plain.press("8 i");
    let text = plain.text();
    assert!(text.is_ascii() && text.contains("Om_lock"), "{text}");
    insta::assert_snapshot!("margins_ascii", text);
}

#[test]
fn every_limit_stays_in_sight_below_it_over_the_whole_screen() {
    let mut session = open((120, 40), short());
    session.press("f");
    let (live, _) = session.app.margins().unwrap();
    assert!(live.margins.robust.is_some() && live.margins.pushes_only.is_some());
    let text = session.text();
    for limit in &live.margins.limits {
        let start = format!("{} ", limit.name.titles()[1]);
        let is_here = |row: &str| row.trim_start_matches([' ', '●']).starts_with(&start);
        assert!(text.lines().any(is_here), "{start}\n{text}");
    }
}

#[test]
fn what_can_lock_has_the_colour_of_a_lock() {
    let mut session = open((120, 40), short());
    session.press("D");
    session.press("");
    let (y, row) = (0..).zip(session.rows()).find(|(_, row)| row.contains(" can lock: ")).unwrap();
    let x = row.split_once("can lock: ").unwrap().0.chars().count() as u16;
    let colour = session.terminal.backend().buffer().cell((x, y)).unwrap().fg;
    assert_eq!(colour, ratatui::style::Color::LightBlue, "{row}");
}
